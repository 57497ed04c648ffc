"""`antnav bench` from outside: tables, files, errors, Ctrl-C."""

from __future__ import annotations

import csv
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from antnav.bench import peers
from antnav.cli import main
from antnav.cli.terminal import PIPE_WIDTH, say_table
from tests.bench.files import write_map, write_scenarios

FILES = {"summary.csv", "summary.md", "figure.svg", "figure.png"}


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """MovingAI files in the working folder's `data`."""
    monkeypatch.chdir(tmp_path)
    write_scenarios(tmp_path / "data" / "rooms.map.scen", write_map(tmp_path / "data", "rooms"))
    return tmp_path


def rows_of(path: Path) -> list[dict[str, str]]:
    with path.open(newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


@pytest.mark.parametrize("command", ["bench", "bench --help", "bench movingai --help", "bench peers --help"])
def test_help(capsys: pytest.CaptureFixture, command: str) -> None:
    assert main(command.split()) == 0
    assert "Usage: antnav bench" in capsys.readouterr().out


def test_movingai_prints_a_table_and_writes_files(folder: Path, capsys: pytest.CaptureFixture) -> None:
    pytest.importorskip("matplotlib", reason="the extra antnav[plot] is not installed")
    command = [
        "bench",
        "movingai",
        "data",
        "--queries",
        "3",
        "--hardest",
        "1",
        "--algorithms",
        "npaco,astar",
        "-o",
        "out",
        "-q",
    ]
    assert main(command) == 0
    out, err = capsys.readouterr()
    assert err == ""
    assert "rooms" in out
    assert "6 of 6 searches, files: out" in out
    assert {path.name for path in (folder / "out").iterdir()} == {*FILES, "queries.csv"}
    raw = rows_of(folder / "out" / "queries.csv")
    assert [row["algorithm"] for row in raw] == ["npaco", "astar"] * 3
    summary = rows_of(folder / "out" / "summary.csv")
    assert [(row["map"], row["algorithm"], row["queries"]) for row in summary] == [
        ("rooms", "npaco", "3"),
        ("rooms", "astar", "3"),
    ]
    assert (summary[1]["optimal %"], summary[1]["gap %, max"], summary[1]["x astar"]) == ("100.0", "0.0", "1.0")


def test_peers_print_a_table_and_name_the_absent(
    folder: Path, capsys: pytest.CaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("matplotlib", reason="the extra antnav[plot] is not installed")
    here = peers.installed([sys.executable])
    monkeypatch.setattr(peers, "installed", lambda _: {"antnav-astar": here["antnav-astar"]})
    chosen = ["--peers", "antnav-astar,tcod,igraph", "--maps", "u20,equiv20,data/rooms.map", "--runs", "1"]
    assert main(["bench", "peers", *chosen, "-o", "out", "-q"]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    assert "Not installed: tcod, igraph." in out
    assert {path.name for path in (folder / "out").iterdir()} == {*FILES, "runs.csv"}
    found = rows_of(folder / "out" / "summary.csv")
    assert [row["map"] for row in found] == ["u20", "equiv20", "rooms"]
    assert all((row["gap %"], row["success %"], row["corner rule"]) == ("0.0", "100.0", "forbid") for row in found)
    assert "Not installed" in (folder / "out" / "summary.md").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    "arguments",
    [
        ["movingai", "absent"],
        ["movingai", "empty"],
        ["movingai", "data", "--algorithms", "ants"],
        ["movingai", "data", "--algorithms", ","],
        ["movingai", "data", "--queries", "0"],
        ["movingai", "data", "--hardest", "1.5"],
        ["movingai", "data", "--workers", "0"],
        ["movingai", "data", "--seed", "-1"],
        ["movingai", "data", "--time-limit", "0"],
        ["movingai", "data", "-o", "file"],
        ["movingai", "data", "-o", "file/out"],
        ["movingai", "wrong"],
        ["peers", "--peers", "nobody"],
        ["peers", "--peers", ","],
        ["peers", "--maps", "nowhere"],
        ["peers", "--peers", "antnav-astar", "--maps", ","],
        ["peers", "--peers", "antnav-astar", "--maps", "u20", "--timeout", "0"],
        ["peers", "--python", "no-such-python"],
        ["peers", "--peers", "antnav-astar", "-o", "file"],
    ],
)
def test_bad_input_is_one_line(folder: Path, capsys: pytest.CaptureFixture, arguments: list[str]) -> None:
    (folder / "file").write_text("")
    (folder / "empty").mkdir()
    write_scenarios(folder / "wrong" / "maze.map.scen", write_map(folder / "wrong", "maze", "maze"), off=2.0)
    before = {path.name for path in folder.iterdir()}
    assert main(["bench", *arguments, "-q"]) == 2
    captured = capsys.readouterr()
    assert captured.err.startswith("antnav: error: ")
    assert len(captured.err.splitlines()) == 1
    assert {path.name for path in folder.iterdir()} == before


def test_peers_say_at_once_what_they_do(
    folder: Path, capsys: pytest.CaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    told = []
    monkeypatch.setattr(peers, "installed", lambda _: told.append(capsys.readouterr()) or {})
    assert main(["bench", "peers", "--peers", "tcod,igraph", "--maps", "u20"]) == 2
    assert told[0].err == "antnav: looking for 2 peers, then timing each that is installed, 5 times on 1 map...\n"


def test_no_peer_installed(folder: Path, capsys: pytest.CaptureFixture, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(peers, "installed", lambda _: {})
    assert main(["bench", "peers", "--peers", "tcod,igraph", "--maps", "u20", "-q"]) == 2
    assert "peers tcod, igraph: none is installed" in capsys.readouterr().err


def test_missing_matplotlib_is_told_before_the_run(
    folder: Path, capsys: pytest.CaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    assert main(["bench", "movingai", "data", "-o", "out", "-q"]) == 2
    assert "matplotlib is not installed" in capsys.readouterr().err
    assert not (folder / "out").exists()


@pytest.mark.slow
@pytest.mark.skipif(os.name != "posix", reason="needs POSIX signals")
@pytest.mark.parametrize(
    "arguments",
    [
        ["movingai", "data", "--algorithms", "npaco", "--queries", "8"],
        ["movingai", "data", "--algorithms", "npaco", "--queries", "8", "--workers", "2"],
        ["peers", "--peers", "antnav-npaco", "--maps", "equiv40", "--runs", "1000000", "--timeout", "1000"],
    ],
)
def test_ctrl_c_writes_nothing(folder: Path, arguments: list[str]) -> None:
    pytest.importorskip("matplotlib", reason="the extra antnav[plot] is not installed")
    # A benchmark that takes for ever: each query again and again, and a line once it runs.
    script = (
        "import sys, signal; signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        "from antnav.bench import movingai, peers, scenarios\n"
        "from antnav.cli import bench, main, running\n"
        "read = bench.read_queries\n"
        "bench.read_queries = lambda *given: read(*given) * 100_000\n"
        "movingai.check_published = lambda query: None\n"
        "run = bench.run_interruptibly\n"
        "def told(work, watch):\n"
        "    print('running', file=sys.stderr, flush=True)\n"
        "    return run(work, watch)\n"
        "bench.run_interruptibly = told\n"
        "sys.exit(main(sys.argv[1:]))"
    )
    command = [sys.executable, "-c", script, "bench", *arguments, "-o", "out", "-q"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert process.stderr is not None
    assert process.stderr.readline() == "running\n"
    time.sleep(1.0)
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=60)
    assert process.returncode == 130, err
    assert "no file was written" in err
    assert "Traceback" not in err
    assert {path.name for path in folder.iterdir()} == {"data"}


def test_numbers_in_tables_are_whole_however_narrow_the_terminal(capsys: pytest.CaptureFixture) -> None:
    heads = ["name", *(f"number, {index}" for index in range(20))]
    say_table(heads, [["a name", *(f"{index}234567.891" for index in range(20))]], [False, *[True] * 20])
    out = capsys.readouterr().out
    assert all(f" {index}234567.891" in out for index in range(20))
    say_table(["note"], [["word " * 50]], [False])
    assert all(len(line) <= PIPE_WIDTH for line in capsys.readouterr().out.splitlines())
