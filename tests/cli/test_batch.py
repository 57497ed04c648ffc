"""`antnav batch`: rows in, rows out, in their order; a bad row costs no other."""

from __future__ import annotations

import csv
import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import antnav as an
from antnav import maps

psutil = pytest.importorskip("psutil", reason="comes with the extra antnav[cluster]")

PAIRS = """id,start_row,start_col,goal_row,goal_col
a,21,0,1,25
b,1,2,3
c,5,5,five,5

d,1,25,21,0
e,99,0,0,0
"""
RULE = ("--corner-rule", "allow")
#: Hears SIGINT even where the test run, as a background job of a shell, does not.
PROGRAM = """
import signal, sys
signal.signal(signal.SIGINT, signal.default_int_handler)
from antnav.cli import main
sys.exit(main(sys.argv[1:]))
"""


def test_rows_come_out_as_they_went_in_and_bad_ones_are_told(cli, tmp_path: Path) -> None:
    tmp_path.joinpath("pairs.csv").write_text(PAIRS)
    code, out, err = cli("batch", "equiv30", "pairs.csv", "-o", "paths.jsonl", "--algorithm", "astar", *RULE)
    assert code == 3
    assert "5, 2 with a path; 3 bad rows" in out
    told = [line.split(": ", 2)[2] for line in err.splitlines()]
    assert [line.split(":")[0] for line in told] == [f"pairs.csv, line {number}" for number in (3, 4, 7)]
    rows = [json.loads(line) for line in (tmp_path / "paths.jsonl").read_text().splitlines()]
    assert [(row["line"], row["id"], row["status"]) for row in rows] == [
        (2, "a", "found"),
        (3, None, "error"),
        (4, "c", "error"),
        (6, "d", "found"),
        (7, "e", "error"),
    ]
    grid = maps.builtin("equiv30")
    result = an.solve(an.Problem.from_cells(grid, (21, 0), (1, 25), corner_rule="allow"), an.astar())
    assert rows[0]["cells"] == result.path.cells.tolist()
    assert rows[0]["path"] == result.path.points.tolist()
    assert (rows[0]["length"], rows[0]["optimum"]) == (result.length, None)


def test_the_same_bytes_whatever_the_workers(cli, tmp_path: Path) -> None:
    tmp_path.joinpath("pairs.csv").write_text(PAIRS)
    ants = (*RULE, "--ants", 4, "--iterations", 20, "--optimum", "-q")
    for workers in (1, 2):
        assert cli("batch", "equiv30", "pairs.csv", "-o", f"{workers}.csv", "--workers", workers, *ants)[0] == 3
    assert (tmp_path / "1.csv").read_bytes() == (tmp_path / "2.csv").read_bytes()
    rows = list(csv.DictReader((tmp_path / "1.csv").open()))
    assert float(rows[0]["gap"]) == float(rows[0]["length"]) / float(rows[0]["optimum"]) - 1
    assert rows[0]["path"].startswith("LINESTRING (0.5 8.5, ")


def many_pairs(folder: Path, count: int) -> None:
    free = np.argwhere(maps.builtin("equiv30").cells == an.Cell.FREE)
    drawn = free[np.random.default_rng(1).integers(len(free), size=(count, 2))].reshape(-1, 4)
    heads = "start_row,start_col,goal_row,goal_col"
    np.savetxt(folder / "pairs.csv", drawn, "%d", delimiter=",", header=heads, comments="")


def started(folder: Path, *arguments: object) -> subprocess.Popen[bytes]:
    """A batch in a session of its own, all of which hears Ctrl-C."""
    command = [sys.executable, "-c", PROGRAM, "batch", "equiv30", "pairs.csv", *map(str, arguments)]
    pipe = subprocess.PIPE
    return subprocess.Popen(command, stdout=pipe, stderr=pipe, cwd=folder, start_new_session=True)


@pytest.mark.skipif(os.name != "posix", reason="signals")
@pytest.mark.parametrize("executor", ["threads", "processes"])
def test_the_same_bytes_whatever_the_executor(cli, tmp_path: Path, executor: str) -> None:
    tmp_path.joinpath("pairs.csv").write_text(PAIRS)
    ants = ("--algorithm", "npaco", "--ants", 5, "--iterations", 5, *RULE, "-q")
    for name, options in {"usual": (), "other": ("--executor", executor, "--workers", 2)}.items():
        assert cli("batch", "equiv30", "pairs.csv", "-o", f"{name}.csv", *options, *ants)[0] == 3
    assert (tmp_path / "usual.csv").read_bytes() == (tmp_path / "other.csv").read_bytes()


def test_an_executor_that_is_none(cli, tmp_path: Path) -> None:
    tmp_path.joinpath("pairs.csv").write_text(PAIRS)
    code, _, err = cli("batch", "equiv30", "pairs.csv", "-o", "paths.csv", "--executor", "cluster")
    assert (code, err.count("\n")) == (2, 1)
    assert "dask://HOST:PORT" in err
    assert not tmp_path.joinpath("paths.csv").exists()


@pytest.mark.parametrize("workers", [1, 2])
def test_ctrl_c_keeps_the_rows_that_are_done(tmp_path: Path, workers: int) -> None:
    many_pairs(tmp_path, 100_000)
    arguments = ("--workers", workers, "--ants", 20, *RULE)
    process = started(tmp_path, *arguments)
    try:
        assert process.stdout and process.stderr
        seen = [process.stdout.readline() for _ in range(3)]
        children = psutil.Process(process.pid).children(recursive=True)
        os.killpg(process.pid, signal.SIGINT)  # as a terminal does
        rows = [*seen, *process.stdout]
        err = process.stderr.read()
        assert process.wait(60) == 130, err
    finally:
        process.kill()
    said = err.decode().splitlines()
    assert len(said) == 2, "no worker complains"
    assert f"interrupted after {len(rows)} of 100000 rows" in said[1]
    assert [json.loads(row)["line"] for row in rows] == [*range(2, len(rows) + 2)]
    assert not psutil.wait_procs(children, timeout=30)[1]


@pytest.mark.skipif(os.name != "posix", reason="signals")
def test_workers_end_with_a_process_that_is_killed(tmp_path: Path) -> None:
    many_pairs(tmp_path, 100_000)
    process = started(tmp_path, "--workers", 2, "-o", "paths.jsonl")
    try:
        watched = psutil.Process(process.pid)
        while len(workers := watched.children(recursive=True)) < 3 and process.poll() is None:
            pass
    finally:
        process.kill()
        process.communicate()
    assert len(workers) == 3, "two, and one that tracks their resources"
    assert not psutil.wait_procs(workers, timeout=60)[1]
    assert not (tmp_path / "paths.jsonl").exists()


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("pairs.txt",), "its ending is one of"),
        (("none.csv",), "pairs none.csv: No such file"),
        (("pairs.csv", "-o", "pairs.csv"), "overwrite"),
        (("pairs.csv", "-o", "paths.xml"), "its ending must be one of"),
        (("pairs.csv", "--workers", "0"), "--workers 0: at least 1 worker"),
        (("pairs.csv", "--algorithm", "best"), "--algorithm 'best'"),
        (("pairs.csv", "--goal-tolerance", "-1"), "--goal-tolerance -1"),
    ],
)
def test_bad_input_ends_before_any_work(cli, tmp_path: Path, arguments: tuple[str, ...], said: str) -> None:
    tmp_path.joinpath("pairs.csv").write_text(PAIRS)
    code, out, err = cli("batch", "equiv30", *arguments)
    assert (code, out) == (2, "")
    assert said in err
    assert [file.name for file in tmp_path.iterdir()] == ["pairs.csv"]


def test_exit_codes_tell_of_paths_that_are_missing(cli, tmp_path: Path) -> None:
    tmp_path.joinpath("a.jsonl").write_text('{"start_cell": [21, 0], "goal_cell": [1, 25]}\n')
    assert cli("batch", "equiv30", "a.jsonl", "--algorithm", "astar", *RULE)[0] == 0
    np.save(tmp_path / "wall.npy", np.eye(3, dtype=np.uint8))
    tmp_path.joinpath("a.jsonl").write_text('{"start_cell": [0, 1], "goal_cell": [1, 0]}\n')
    code, out, _ = cli("batch", "wall.npy", "a.jsonl", "--algorithm", "astar")
    assert (code, json.loads(out)["status"]) == (1, "unreachable")


def test_many_bad_rows_are_counted(cli, tmp_path: Path) -> None:
    tmp_path.joinpath("a.jsonl").write_text("{\n" * 30)
    code, out, err = cli("batch", "equiv30", "a.jsonl")
    assert (code, len(out.splitlines()), len(err.splitlines())) == (3, 30, 21)
    assert "10 more rows" in err


def test_the_radius_is_kept_from_the_walls_edges_and_costs_count(cli, tmp_path: Path) -> None:
    grid = maps.builtin("warehouse")
    tmp_path.joinpath("pairs.jsonl").write_text('{"start": [1, 1], "goal": [18, 6]}\n')
    asked = ("batch", "warehouse", "pairs.jsonl", "--algorithm", "astar", "--robot-radius", "0.25", "-q")
    cost = an.costs.clearance(grid, 0.8, weight=3)
    for radius, options, strict, prices in (
        (0.25, (), True, {}),
        (0.25, ("--nav2-radius",), False, {}),
        (0.25, ("--cost", "clearance:0.8:3", "--turning", "0.5"), True, {"cost": cost, "turning": 0.5}),
    ):
        code, out, _ = cli(*asked, *options)
        assert code == 0
        row = json.loads(out)
        problem = an.Problem(grid.inflated(radius, strict=strict), (1.0, 1.0), (18.0, 6.0), **prices)
        assert row["cells"] == an.solve(problem, an.astar()).path.cells.tolist()
