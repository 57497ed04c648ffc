"""`antnav study --executor ... --shard ...` and `antnav merge`: engines, errors in one line, Ctrl-C, shards."""

from __future__ import annotations

import gc
import os
import signal
import sqlite3
import subprocess
import sys
import time
from pathlib import Path

import pytest

from antnav.cli import engines, main
from antnav.study.store import VERSION
from tests.cli.test_study import CONFIG, figures_of

pytest.importorskip("matplotlib", reason="the extra antnav[plot] is not installed")


@pytest.fixture
def config(tmp_path: Path) -> str:
    path = tmp_path / "study.toml"
    path.write_text(CONFIG)
    return str(path)


def test_processes_write_the_same_report(config: str, tmp_path: Path) -> None:
    for name in ("threads", "processes"):
        assert main(["study", config, "-o", str(tmp_path / name), "-q", "--executor", name, "--workers", "2"]) == 0
    assert figures_of(tmp_path / "threads") == figures_of(tmp_path / "processes")


@pytest.mark.slow
def test_on_dask(config: str, tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed", reason="the extra antnav[cluster] is not installed")
    out = tmp_path / "out"
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        address = f"dask://{cluster.scheduler_address.removeprefix('tcp://')}"
        assert main(["study", config, "-o", str(out), "-q", "--executor", address]) == 0
    assert main(["study", config, "-o", str(tmp_path / "one"), "-q"]) == 0
    assert figures_of(out) == figures_of(tmp_path / "one")


@pytest.mark.parametrize(
    ("executor", "rule"),
    [
        ("cluster", "it is one of threads, processes, dask://HOST:PORT, mpi"),
        ("dask://", "it is one of threads"),
        ("dask://127.0.0.1:9", "no scheduler answers there"),
        ("dask://127.0.0.1:port", "no scheduler answers there"),
    ],
)
def test_executors_that_are_none(
    config: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture,
    monkeypatch: pytest.MonkeyPatch,
    executor: str,
    rule: str,
) -> None:
    if "127" in executor:
        pytest.importorskip("distributed", reason="the extra antnav[cluster] is not installed")
    monkeypatch.setattr(engines, "CONNECTING", 0.5)
    assert main(["study", config, "-o", str(tmp_path / "out"), "-q", "--executor", executor]) == 2
    told = capsys.readouterr().err
    assert told.startswith(f"antnav: error: --executor {executor}: {rule}")
    assert len(told.splitlines()) == 1
    assert not (tmp_path / "out").exists()
    gc.collect()  # a client that came to nothing wants its library then


@pytest.mark.parametrize(
    ("executor", "library", "extra"), [("dask://127.0.0.1:9", "distributed", "cluster"), ("mpi", "mpi4py", "mpi")]
)
def test_a_missing_extra_is_named(
    config: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture,
    monkeypatch: pytest.MonkeyPatch,
    executor: str,
    library: str,
    extra: str,
) -> None:
    for name in [name for name in sys.modules if name.partition(".")[0] == library] + [library]:
        monkeypatch.setitem(sys.modules, name, None)
    assert main(["study", config, "-o", str(tmp_path / "out"), "-q", "--executor", executor]) == 2
    assert capsys.readouterr().err == (
        f'antnav: error: --executor {executor}: {library} is not installed; pip install "antnav[{extra}]"\n'
    )


@pytest.mark.skipif(os.name != "posix", reason="needs POSIX signals")
def test_ctrl_c_at_a_terminal_keeps_what_processes_have_done(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(CONFIG.replace("seeds = 3", "seeds = 50000"))
    out = tmp_path / "out"
    command = [sys.executable, "-m", "antnav", "study", str(tmp_path / "study.toml"), "-o", str(out), "-q"]
    process = subprocess.Popen(
        [*command, "--executor", "processes", "--workers", "2"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    deadline = time.monotonic() + 90
    store = out / "runs.sqlite"
    while time.monotonic() < deadline and not (store.exists() and store.stat().st_size > 40_000):
        time.sleep(0.1)
    os.killpg(process.pid, signal.SIGINT)
    _, err = process.communicate(timeout=60)
    assert process.returncode == 130, err
    assert "goes on from there" in err
    assert "Traceback" not in err
    assert sqlite3.connect(store).execute("SELECT count(*) FROM records").fetchone()[0] > 0


def test_shards_are_merged_and_reported(config: str, tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    out, one = tmp_path / "out", tmp_path / "one"
    for number in (1, 2):
        assert main(["study", config, "-o", str(out), "-q", "--shard", f"{number}/2"]) == 0
        told = capsys.readouterr().out
        assert told.startswith(f"3 runs in {out / f'runs-{number}-of-2.sqlite'}; with all shards: antnav merge ")
    assert sorted(path.name for path in out.iterdir()) == ["runs-1-of-2.sqlite", "runs-2-of-2.sqlite"]
    parts = [str(path) for path in sorted(out.iterdir())]
    assert main(["merge", parts[0], "-o", str(tmp_path / "some")]) == 0
    assert capsys.readouterr().err == "antnav: part 2 of 2 is missing\n"
    assert main(["study", "merge", *parts, "-o", str(out)]) == 0
    assert capsys.readouterr() == (f"6 runs added to {out / 'runs.sqlite'}\n", "")
    assert main(["merge", *parts, "-o", str(out)]) == 0
    assert "6 were known" in capsys.readouterr().out
    stamp = (out / "runs.sqlite").stat().st_mtime_ns
    for folder in (out, one):
        assert main(["study", config, "-o", str(folder), "-q"]) == 0
    assert (out / "runs.sqlite").stat().st_mtime_ns == stamp, "nothing was left to run"
    assert figures_of(out) == figures_of(one)


@pytest.mark.parametrize("shard", ["3", "0/2", "3/2", "a/b"])
def test_shards_that_are_none(config: str, tmp_path: Path, capsys: pytest.CaptureFixture, shard: str) -> None:
    assert main(["study", config, "-o", str(tmp_path / "out"), "-q", "--shard", shard]) == 2
    told = capsys.readouterr().err
    assert "shard" in told
    assert len(told.splitlines()) == 1
    assert not (tmp_path / "out").exists()


def test_what_cannot_be_merged_is_told_in_one_line(
    config: str, tmp_path: Path, capsys: pytest.CaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["study", config, "-o", "out", "-q", "--shard", "1/1"]) == 0
    Path("text").write_text("no store")
    old = sqlite3.connect("old")
    old.executescript(f"PRAGMA application_id = {0x616E746E}; PRAGMA user_version = {VERSION - 1}; CREATE TABLE a (b)")
    old.close()
    capsys.readouterr()
    for given, told in (("absent", "no such file"), ("text", "no store, or is damaged"), ("old", f"not {VERSION}")):
        assert main(["merge", "out/runs-1-of-1.sqlite", given, "-o", "both"]) == 2
        err = capsys.readouterr().err
        assert told in err
        assert len(err.splitlines()) == 1
        assert not Path("both/runs.sqlite").exists()
