"""Result: summary, JSON and CSV round trips, broken files."""

from __future__ import annotations

import contextlib
import csv
import gc
import json
import math
import os
import tracemalloc
from dataclasses import replace
from pathlib import Path

import msgspec
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import antnav as an
from antnav.errors import AntnavError, OutputError, ParameterError, ResultFormatError
from antnav.planner import nav2
from antnav.planner.result import History
from antnav.run import stop
from tests.conftest import grid_of

GRID = an.GridMap(grid_of("....", ".##.", "....").cells, 0.5, (1.0, 2.0, 0.3), "tiny")


@pytest.fixture(scope="module")
def results() -> dict[str, an.Result]:
    found = an.solve(an.Problem.from_cells(GRID, (0, 0), (2, 3)), an.paco(ants=5, iterations=6), seed=3)
    walled = an.Problem.from_cells(grid_of(".#."), (0, 0), (0, 2))
    lost = an.Problem.from_cells(grid_of("....."), (0, 2), (0, 4))  # half of the ants go west and die
    one_ant = an.traditional(ants=1, iterations=1)
    return {
        "found": found,
        "unreachable": an.solve(walled),
        "lost": next(r for r in (an.solve(lost, one_ant, seed=s) for s in range(20)) if r.path is None),
        "stopped": an.solve(found.problem, an.npaco(), stop=stop.Iterations(2)),
        "same cell": an.solve(an.Problem.from_cells(GRID, (0, 0), (0, 0))),
    }


def test_the_lost_case_is_one(results: dict[str, an.Result]) -> None:
    assert results["lost"].status == an.Status.NO_ANT_ARRIVED


@pytest.mark.parametrize("name", ["found", "unreachable", "lost", "stopped", "same cell"])
def test_json_round_trip(results: dict[str, an.Result], tmp_path: Path, name: str) -> None:
    result = results[name]
    path = tmp_path / "plan.json"
    result.save(path)
    loaded = an.Result.load(path)
    assert loaded.to_dict() == result.to_dict()
    assert loaded.summary() == result.summary()
    assert loaded.problem.grid == result.problem.grid
    assert loaded.problem.grid.name == result.problem.grid.name
    for mine, theirs in zip(result.history, loaded.history, strict=True):
        np.testing.assert_array_equal(mine, theirs)
        assert mine.dtype == theirs.dtype
    assert loaded.pheromone is None
    again = an.solve(loaded.problem, loaded.algorithm, seed=loaded.seed)
    if name != "stopped":
        assert again.length == result.length


def test_json_is_plain_and_complete(results: dict[str, an.Result], tmp_path: Path) -> None:
    result = results["found"]
    result.save(tmp_path / "plan.json")
    document = json.loads((tmp_path / "plan.json").read_text(), parse_constant=pytest.fail)  # no NaN, no Infinity
    assert document["schema"] == "antnav/result"
    assert document["length_m"] == pytest.approx(result.length * 0.5)
    assert document["gap"] == result.gap
    assert document["path"][0] == [0, 0]
    assert document["problem"]["map"]["digest"] == GRID.digest
    assert set(document["history"]) == set(History._fields)
    assert set(document["versions"]) == {"python", "antnav", "numpy", "numba"}
    assert json.loads(msgspec.json.encode(results["unreachable"].to_dict()))["length"] is None


def test_csv_holds_the_path_in_metres(results: dict[str, an.Result], tmp_path: Path) -> None:
    result = results["found"]
    result.save(tmp_path / "plan.csv")
    with (tmp_path / "plan.csv").open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert [(int(row["row"]), int(row["col"])) for row in rows] == [tuple(cell) for cell in result.path.cells.tolist()]
    points = [(float(row["x_m"]), float(row["y_m"])) for row in rows]
    np.testing.assert_array_equal(points, result.path.points)
    assert tuple(GRID.world_to_cell(points[-1])) == (2, 3)
    results["unreachable"].save(tmp_path / "none.csv")
    assert (tmp_path / "none.csv").read_text() == "row,col,x_m,y_m,heading_rad\n"


def test_one_truth_about_metres(tmp_path: Path) -> None:
    """Ends off the centres: metres are the polyline's in every place, cells stay between centres."""
    grid = an.GridMap(np.zeros((6, 8), np.uint8), 0.1)
    result = an.solve(an.Problem(grid, (0.02, 0.03), (0.74, 0.55)), an.paco(), seed=1)
    points = result.path.points
    metres = float(np.hypot(*np.diff(points, axis=0).T).sum())
    document = result.to_dict()
    assert document["path_m"] == points.tolist()
    assert document["length_m"] == result.length_m == result.path.length_m == pytest.approx(metres)
    assert metres != pytest.approx(result.length * 0.1, rel=0.01)
    assert f"{result.length:.4f} cells between centres, {metres:.3f} m from start to goal" in result.summary()
    assert "on the grid's eight directions" in result.summary()


def test_two_points_in_one_cell_go_into_every_file(tmp_path: Path) -> None:
    grid = an.GridMap(np.zeros((2, 2), np.uint8))
    result = an.solve(an.Problem(grid, (0.1, 0.2), (0.9, 0.7)))
    assert result.to_dict()["path_m"] == [[0.1, 0.2], [0.9, 0.7]]
    result.save(tmp_path / "plan.csv")
    lines = (tmp_path / "plan.csv").read_text().splitlines()
    assert [line.rsplit(",", 1)[0] for line in lines[1:]] == ["1,0,0.1,0.2", "1,0,0.9,0.7"]
    result.save(tmp_path / "plan.json")
    assert an.Result.load(tmp_path / "plan.json").path.points.tolist() == result.path.points.tolist()


def test_a_moved_start_is_told_and_loaded(tmp_path: Path) -> None:
    grid = grid_of("....#").inflated(1.0)
    result = an.solve(an.Problem.from_cells(grid, (0, 3), (0, 0), start_tolerance=2.0))
    assert "the start (3.5, 0.5) m was moved by 1 m to (2.5, 0.5) m" in result.notes
    result.save(tmp_path / "plan.json")
    loaded = an.Result.load(tmp_path / "plan.json").problem
    assert (loaded.requested_start, loaded.start, loaded.start_tolerance) == ((3.5, 0.5), (2.5, 0.5), 2.0)


def test_the_gap_is_a_share_of_the_optimum() -> None:
    """Three moves to and fro, where one would do."""
    problem = an.Problem.from_cells(grid_of(".."), (0, 0), (0, 1))
    to_and_fro = an.Path(np.array([(0, 0), (0, 1), (0, 0), (0, 1)], np.int32), problem.grid)
    result = replace(an.solve(problem, an.npaco(ants=2, iterations=1)), path=to_and_fro)
    assert (result.length, result.optimum, result.gap) == (3.0, 1.0, 2.0)


def test_statuses_and_numbers_without_a_path(results: dict[str, an.Result]) -> None:
    unreachable, lost = results["unreachable"], results["lost"]
    assert math.isnan(unreachable.gap)
    assert unreachable.length == unreachable.length_m == math.inf
    assert math.isfinite(lost.optimum)
    assert [nav2.code_of(result) for result in (unreachable, lost, results["found"])] == [208, 208, 0]
    assert "optimum" in results["found"].summary()


def test_files_are_written_whole_or_not_at_all(results: dict[str, an.Result], tmp_path: Path) -> None:
    with pytest.raises(OutputError):
        results["found"].save(tmp_path / "missing" / "plan.json")
    with pytest.raises(ParameterError, match=r"\.json or \.csv"):
        results["found"].save(tmp_path / "plan.txt")
    (tmp_path / "folder.json").mkdir()
    with pytest.raises(OutputError):
        results["found"].save(tmp_path / "folder.json")
    assert [path.name for path in tmp_path.iterdir()] == ["folder.json"]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"schema": "other"}, "does not say"),
        ({"version": 99}, "reads version 1"),
        ({"seed": "seven"}, "seed"),
        ({"algorithm": {}}, "algorithm"),
        ({"history": {}}, "best"),
        ({"problem": None}, "problem"),
        ({"path": [[0, 0], [9, 9]]}, "path must lead"),
        ({"path": [[0, 0], [2, 3]]}, "not neighbours"),
    ],
)
def test_broken_documents_are_refused(
    results: dict[str, an.Result], tmp_path: Path, change: dict, message: str
) -> None:
    path = tmp_path / "plan.json"
    path.write_text(json.dumps(results["found"].to_dict() | change))
    with pytest.raises(ResultFormatError, match=message):
        an.Result.load(path)


@pytest.mark.parametrize(
    ("name", "change", "message"),
    [
        ("found", {"optimum": -5}, ">= 0"),
        ("found", {"optimum": 1.0}, "straight"),
        ("found", {"optimum": 99.0}, "the path"),
        ("found", {"optimum": None}, "where a path exists"),
        ("found", {"length": 3.0}, "the rest of the file makes it"),
        ("found", {"length": None}, "the rest of the file makes it"),
        ("found", {"seconds_run": -1.0}, ">= 0"),
        ("found", {"cpu_seconds": -1.0}, ">= 0"),
        ("found", {"stages": []}, "as the stages say"),
        ("found", {"status": "unreachable", "path": None, "length": None, "optimum": None}, "on this map"),
        ("unreachable", {"status": "no_ant_arrived"}, "on this map"),
        ("lost", {"status": "unreachable"}, "on this map"),
        ("lost", {"optimum": None}, "where a path exists"),
        ("lost", {"length": 3.0}, "the rest of the file makes it"),
        ("same cell", {"optimum": 1.0}, "straight"),
    ],
)
def test_what_cannot_be_true_is_refused(results: dict, tmp_path: Path, name: str, change: dict, message: str) -> None:
    path = tmp_path / "plan.json"
    path.write_text(json.dumps(results[name].to_dict() | change))
    with pytest.raises(ResultFormatError, match=message):
        an.Result.load(path)


@pytest.mark.parametrize(
    ("place", "value"),
    [
        (("stages", 0, "colonies", 0, "steps"), -7),
        (("stages", 0, "colonies", 0, "steps"), 8),
        (("stages", 0, "colonies", 0, "iterations"), -1),
        (("stages", 0, "colonies", 0, "length"), -1.0),
        (("stages", 0, "seconds"), -0.5),
        (("history", "lost", 0), -1),
        (("history", "lost", 0), 1.5),
        (("history", "arrived", 0), None),
        (("history", "steps", 0), 8),
        (("history", "best", 0), -2.0),
        (("path", 1, 0), 2**32),
    ],
)
def test_counts_that_cannot_be_true_are_refused(results: dict, tmp_path: Path, place: tuple, value: object) -> None:
    document = json.loads(json.dumps(results["found"].to_dict()))
    *inner, last = place
    part = document
    for key in inner:
        part = part[key]
    part[last] = value
    (tmp_path / "plan.json").write_text(json.dumps(document))
    with pytest.raises(ResultFormatError):
        an.Result.load(tmp_path / "plan.json")


@pytest.mark.skipif(os.name != "posix", reason="needs named pipes")
def test_pipes_and_devices_are_refused(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "plan.json")
    for path in (tmp_path / "plan.json", os.devnull, tmp_path, "a\0b"):
        with pytest.raises(ResultFormatError):
            an.Result.load(path)


@pytest.mark.parametrize(
    "part", [{"cells": "!"}, {"cells": ""}, {"rows": 10**9}, {"rows": 2}, {"digest": "0"}, {"name": 3}]
)
def test_broken_maps_in_documents_are_refused(results: dict, tmp_path: Path, part: dict) -> None:
    document = results["found"].to_dict()
    document["problem"]["map"] |= part
    path = tmp_path / "plan.json"
    path.write_text(json.dumps(document))
    with pytest.raises(ResultFormatError):
        an.Result.load(path)


@pytest.mark.parametrize("content", [b"", b"{", b"[]", b"\xff\xfe", b"[" * 100_000, b"null", b"1e999"])
def test_files_that_are_no_documents_are_refused(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "plan.json").write_bytes(content)
    with pytest.raises(ResultFormatError):
        an.Result.load(tmp_path / "plan.json")
    with pytest.raises(ResultFormatError):
        an.Result.load(tmp_path / "absent.json")


@settings(
    max_examples=300, deadline=None, derandomize=True, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(place=st.integers(0, 10**6), byte=st.integers(0, 255))
def test_a_flipped_byte_gives_a_result_or_a_clear_error(results: dict, tmp_path: Path, place: int, byte: int) -> None:
    results["found"].save(tmp_path / "plan.json")
    content = bytearray((tmp_path / "plan.json").read_bytes())
    content[place % len(content)] = byte
    (tmp_path / "plan.json").write_bytes(content)
    with contextlib.suppress(AntnavError):
        assert isinstance(an.Result.load(tmp_path / "plan.json").summary(), str)


@pytest.mark.parametrize("preset", ["paco", "npaco", "paco_levels", "paco_extended", "paco_large"])
def test_many_results_of_one_map_take_little_memory(preset: str) -> None:
    """10,000 of them stay under 115 MB; pheromone and history are most of it.

    An algorithm of 30 choices is 1.3 kB of that: Python 3.11 shares the names of 29 at most between objects.
    """
    grid = an.maps.builtin("equiv40")
    start, goal = an.maps.builtin_query("equiv40")

    def solved(seed: int) -> an.Result:
        problem = an.Problem.from_cells(grid, start, goal, corner_rule="allow")
        return an.solve(problem, an.preset(preset), seed=seed)

    first = solved(0)
    tracemalloc.start()
    results = [solved(seed) for seed in range(100)]
    gc.collect()
    used = tracemalloc.get_traced_memory()[0]
    assert all(np.shares_memory(result.problem.moves, first.problem.moves) for result in results)
    np.testing.assert_array_equal(results[0].pheromone, first.pheromone)
    results.clear()
    gc.collect()
    used -= tracemalloc.get_traced_memory()[0]
    tracemalloc.stop()
    assert used < 100 * 11_500, used
