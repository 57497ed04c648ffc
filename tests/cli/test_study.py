"""`antnav reproduce` and `antnav study` from outside: reports, resuming, errors, Ctrl-C."""

from __future__ import annotations

import csv
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from antnav.cli import main

pytest.importorskip("matplotlib", reason="the extra antnav[plot] is not installed")

CONFIG = """
title = "tiny"
seeds = 3

[[maps]]
builtin = "equiv20"
corner_rule = "allow"

[[algorithms]]
preset = "npaco"
ants = 5
iterations = 5

[[algorithms]]
preset = "luo"
ants = 5
iterations = 5
"""


def figures_of(folder: Path) -> list[dict[str, str]]:
    """The raw runs without what depends on the machine's mood."""
    with (folder / "runs.csv").open(newline="", encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    return [{name: value for name, value in row.items() if "seconds" not in name and name != "marks"} for row in rows]


def test_study_writes_a_report_and_goes_on_where_it_stopped(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    config = tmp_path / "study.toml"
    config.write_text(CONFIG)
    first, second = tmp_path / "first", tmp_path / "second"
    assert main(["study", str(config), "-o", str(first), "-q"]) == 0
    assert "6 runs" in capsys.readouterr().out
    assert (first / "as_run.toml").read_text() == CONFIG
    assert "data:image/" in (first / "report.html").read_text(encoding="utf-8")
    stored = (first / "runs.sqlite").stat().st_mtime_ns
    assert main(["study", str(config), "-o", str(first), "-q"]) == 0
    assert (first / "runs.sqlite").stat().st_mtime_ns == stored, "nothing was left to run"
    assert main(["study", str(config), "-o", str(second), "-q", "--workers", "2"]) == 0
    assert figures_of(first) == figures_of(second)
    assert len(figures_of(first)) == 6


@pytest.mark.slow
def test_reproduce_has_all_tables_and_figures(tmp_path: Path) -> None:
    assert main(["reproduce", "--runs", "1", "-o", str(tmp_path / "out"), "-q"]) == 0
    for name in ("table_2_equiv20", "table_3_equiv30", "table_4_equiv40", "saved_time", "auxiliary_cells", "claims"):
        assert (tmp_path / "out" / "tables" / f"{name}.csv").stat().st_size > 0
        assert (tmp_path / "out" / "tables" / f"{name}.tex").stat().st_size > 0
    figures = {path.name.split(".")[0] for path in (tmp_path / "out" / "figures").iterdir()}
    assert {"figure_5_best_length", "figure_6_lost_ants", "figure_7_equiv20", "figure_9_equiv40"} <= figures
    text = (tmp_path / "out" / "report.md").read_text(encoding="utf-8")
    assert "reconstruction" in text
    assert "published" in text


@pytest.mark.parametrize(
    "arguments",
    [
        ["study", "absent.toml"],
        ["study", "broken.toml"],
        ["reproduce", "--runs", "0"],
        ["reproduce", "--runs", "5", "--paper"],
        ["reproduce", "--maps", "nowhere"],
        ["reproduce", "-o", "file"],
    ],
)
def test_bad_input_is_one_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture, arguments: list[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("broken.toml").write_text("title = ")
    Path("file").write_text("")
    before = {path.name for path in tmp_path.iterdir()}
    assert main([*arguments, "-q"]) == 2
    captured = capsys.readouterr()
    assert captured.err.startswith("antnav: error: ")
    assert len(captured.err.splitlines()) == 1
    assert {path.name for path in tmp_path.iterdir()} == before


def test_a_missing_library_is_told_before_the_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture
) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    assert main(["reproduce", "--runs", "1", "-o", str(tmp_path / "out"), "-q"]) == 2
    assert "matplotlib is not installed" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


@pytest.mark.skipif(os.name != "posix", reason="needs POSIX signals")
def test_ctrl_c_keeps_the_runs(tmp_path: Path) -> None:
    out = tmp_path / "out"
    command = [sys.executable, "-m", "antnav", "reproduce", "--runs", "2000", "-o", str(out), "-q"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    deadline = time.monotonic() + 60
    while time.monotonic() < deadline and not (
        (out / "runs.sqlite").exists() and (out / "runs.sqlite").stat().st_size > 40_000
    ):
        time.sleep(0.1)
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=60)
    assert process.returncode == 130, err
    assert "goes on from there" in err
    assert "best so far" not in err
    assert "Traceback" not in err


@pytest.mark.skipif(os.name != "posix", reason="needs POSIX signals")
@pytest.mark.parametrize("module", ["antnav", "numba", "antnav.cli.study"])
def test_ctrl_c_while_python_imports(module: str) -> None:
    script = (
        "import os, signal, sys, antnav_command\n"
        "class Finder:\n"
        "    def find_spec(self, name, path, target=None):\n"
        f"        if name == {module!r}:\n"
        "            os.kill(os.getpid(), signal.SIGINT)\n"
        "sys.meta_path.insert(0, Finder())\n"
        "sys.exit(antnav_command.main())"
    )
    ended = subprocess.run(
        [sys.executable, "-c", script, "study", "absent.toml"], capture_output=True, text=True, check=False
    )
    assert (ended.returncode, ended.stderr) == (130, "antnav: interrupted\n")


FRONTS = """
title = "tiny fronts"
seeds = 2
objectives = ["length", "risk:clearance:3"]

[[maps]]
builtin = "equiv20"

[[algorithms]]
method = "exact"

[[algorithms]]
method = "sweep"
searches = 9
"""


def test_study_compares_fronts(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    pytest.importorskip("moocore")
    config, out = tmp_path / "fronts.toml", tmp_path / "out"
    config.write_text(FRONTS)
    assert main(["study", str(config), "-o", str(out), "-q"]) == 0
    assert "4 runs" in capsys.readouterr().out
    stored = (out / "runs.sqlite").stat().st_mtime_ns
    assert main(["study", str(config), "-o", str(out), "-q", "--workers", "2"]) == 0
    assert (out / "runs.sqlite").stat().st_mtime_ns == stored, "nothing was left to run"
    assert "sweep" in (out / "tables" / "fronts_1_equiv20.tex").read_text()


@pytest.mark.parametrize(("library", "extra"), [("moocore", "fronts"), ("pygmo", "rivals")])
def test_a_missing_library_is_named_before_the_runs(
    tmp_path: Path,
    capsys: pytest.CaptureFixture,
    monkeypatch: pytest.MonkeyPatch,
    library: str,
    extra: str,
) -> None:
    pytest.importorskip("moocore")
    config = tmp_path / "fronts.toml"
    config.write_text(FRONTS.replace('method = "sweep"\nsearches = 9', 'method = "nsga2"'))
    monkeypatch.setitem(sys.modules, library, None)
    assert main(["study", str(config), "-o", str(tmp_path / "out"), "-q"]) == 2
    assert f"antnav[{extra}]" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()
