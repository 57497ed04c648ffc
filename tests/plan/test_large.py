"""paco_large: ants on regions, routes on cells, windows."""

from __future__ import annotations

import threading
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import antnav as an
from antnav import maps
from antnav.errors import ParameterError
from antnav.run import spmd
from antnav.search import exact
from antnav.world.moves import CornerRule
from tests.conftest import grid_of

Told = an.events.Iterated | an.events.Improved


SHORT = an.paco_large(coarse=4, windows=9)


def everything(result: an.Result) -> tuple:
    path = None if result.path is None else result.path.cells.tolist()
    return result.status, path, [column.tobytes() for column in result.history], result.notes


@pytest.fixture(scope="module")
def caves() -> an.Problem:
    grid = maps.generate("caves", 150, 200, seed=2)
    return an.Problem.from_cells(grid, *maps.ends(grid))


@pytest.mark.slow
@settings(max_examples=60, deadline=None, derandomize=True)
@given(
    rows=st.integers(2, 40),
    cols=st.integers(2, 40),
    density=st.floats(0, 0.5),
    seed=st.integers(0, 2**32 - 1),
    rule=st.sampled_from(list(CornerRule)),
)
def test_a_path_is_found_where_one_exists(rows: int, cols: int, density: float, seed: int, rule: CornerRule) -> None:
    cells = (np.random.default_rng(seed).random((rows, cols)) < density).astype(np.uint8)
    cells[0, 0] = cells[-1, -1] = 0
    problem = an.Problem.from_cells(an.GridMap(cells), (0, 0), (rows - 1, cols - 1), corner_rule=rule)
    result = an.solve(problem, SHORT, seed=seed)
    if np.isfinite(exact.shortest_path(problem).length):
        an.check_path(result.path, problem)
        assert result.gap >= -1e-12
    else:
        assert (result.status, result.path, result.steps) == (an.Status.UNREACHABLE, None, 0)


def test_close_to_the_optimum_on_published_maps(data: Path) -> None:
    """Ends far apart on three maps whose optimal lengths were published; the length that the file prints."""
    cases = (
        ("dao/brc202d", 2500, 1.0),
        ("mazes/maze512-1-0", 11900, 0.01),
        ("rooms/32room_000", 1850, 5.0),
        ("random/random512-40-0", 3000, 1.0),
    )
    for name, number, most in cases:
        lines = (data / "movingai" / f"{name}.map.scen").read_text().splitlines()
        col, row, to_col, to_row, length = (float(part) for part in lines[number].split()[4:9])
        grid = an.load_map(data / "movingai" / f"{name}.map")
        problem = an.Problem.from_cells(grid, (int(row), int(col)), (int(to_row), int(to_col)))
        result = an.solve(problem, an.paco_large(), seed=1)
        assert an.check_path(result.path, problem) < length * (1 + most / 100) + 0.01


def test_the_same_bytes_whatever_the_workers(caves: an.Problem) -> None:
    once = everything(an.solve(caves, SHORT, seed=5))
    with ThreadPoolExecutor(8) as eight, spmd.Processes(2) as processes:
        for executor in (spmd.Serial(), eight, processes):
            assert everything(an.solve(caves, SHORT, seed=5, executor=executor)) == once
    assert everything(an.solve(caves, SHORT, seed=6)) != once


def test_stages_are_accounted_for(caves: an.Problem) -> None:
    result = an.solve(caves, SHORT, seed=5)
    assert [stage.name for stage in result.stages] == ["abstraction", "regions", "routes", "windows"]
    assert [len(stage.colonies) for stage in result.stages] == [0, 2, 0, 0]
    forward, backward = result.stages[1].colonies
    assert forward.steps != backward.steps  # each has its own random numbers
    assert (forward.start, forward.goal) == (backward.goal, backward.start) == (caves.start_cell, caves.goal_cell)
    assert sum(stage.seconds for stage in result.stages) <= result.seconds_run
    assert np.isfinite(result.pheromone[caves.start_cell])
    walked = ~np.isnan(result.pheromone)  # the cells of regions near the route
    assert np.all(caves.reachable[walked])
    assert 0.2 * caves.reachable.sum() < walked.sum() < caves.reachable.sum()


def test_windows_and_more_routes_help(caves: an.Problem) -> None:
    gaps = [
        np.mean([an.solve(caves, an.paco_large(coarse=8, **choice), seed=seed).gap for seed in range(4)])
        for choice in ({"windows": 0, "routes": 1}, {"windows": 0, "routes": 4}, {"windows": 60, "routes": 4})
    ]
    assert gaps[0] > gaps[1] > gaps[2]


def test_start_and_goal_in_one_region() -> None:
    problem = an.Problem.from_cells(an.GridMap(np.zeros((5, 5), np.uint8)), (0, 0), (4, 4))
    result = an.solve(problem, an.paco_large())
    assert (result.gap, result.steps) == (0, 0)
    assert result.notes == ("start and goal lie in one region; no ant walked",)


def test_one_region_left_by_a_shorter_way() -> None:
    """Inside the right block the way from start to goal leads round a wall; windows find the one through the left."""
    grid = grid_of("..........", "..........", "..........", ".....####.", "..........")
    problem = an.Problem.from_cells(grid, (4, 5), (2, 5), corner_rule="allow")
    inside, whole = (an.solve(problem, an.paco_large(coarse=5, windows=windows)) for windows in (0, 12))
    assert inside.notes == whole.notes == ("start and goal lie in one region; no ant walked",)
    assert inside.length == pytest.approx(6 + 2 * 2**0.5)
    assert whole.length == pytest.approx(2 * 2**0.5)


def test_a_time_limit_and_a_cancelled_run_still_give_a_path(caves: an.Problem) -> None:
    result = an.solve(caves, SHORT, stop=an.stop.Seconds(1e-6))
    an.check_path(result.path, caves)
    assert result.stopped_by == "criterion"
    assert result.notes == ("the run ended before its windows did",)
    cancel = threading.Event()
    seen = []
    result = an.solve(
        caves, SHORT, cancel=cancel, events=lambda event: isinstance(event, Told) and (seen.append(event), cancel.set())
    )
    an.check_path(result.path, caves)
    assert result.stopped_by == "cancelled"
    assert {event.stage for event in seen} == {"regions", "windows"}


def test_iterations_count_for_ants_and_a_target_for_paths(caves: an.Problem) -> None:
    whole = an.solve(caves, SHORT, seed=5)
    for stop in (an.stop.Iterations(10), an.stop.Stagnation(9), an.stop.Seconds(60)):
        assert an.solve(caves, SHORT, seed=5, stop=stop).path.cells.tolist() == whole.path.cells.tolist()
    told = []
    rough = an.solve(caves, replace(SHORT, windows=0), seed=5)
    easy = an.solve(caves, SHORT, seed=5, stop=an.stop.TargetLength(rough.length), events=told.append)
    assert easy.length == rough.length > whole.length
    assert easy.stopped_by == "criterion"
    assert [event.best for event in told if isinstance(event, an.events.Improved)][-1] == rough.length


def test_no_loop_is_left() -> None:
    for seed in (*range(40), 404, 610):  # in the last two windows close a loop
        cells = (np.random.default_rng(seed).random((24, 27)) < 0.4).astype(np.uint8)
        cells[0, 0] = cells[-1, -1] = 0
        problem = an.Problem.from_cells(an.GridMap(cells), (0, 0), (23, 26), corner_rule="allow")
        for choice in ({}, {"windows": 0}, {"iterations": 1}):
            few = {"coarse": 8, "windows": 9, "ants": 4, "iterations": 2}
            result = an.solve(problem, an.paco_large(**few | choice), seed=seed)
            assert (result.path is not None) == problem.connected
            if result.path:
                assert len(np.unique(result.path.cells, axis=0)) == len(result.path)


def test_a_map_in_two_parts(tmp_path: Path) -> None:
    cells = np.zeros((40, 60), np.uint8)
    cells[:, 30] = 1
    problem = an.Problem.from_cells(an.GridMap(cells), (0, 0), (39, 29))
    result = an.solve(problem, an.paco_large(coarse=8), seed=1)
    assert np.array_equal(np.isfinite(result.pheromone), problem.reachable)
    result.save(tmp_path / "plan.json")
    again = an.Result.load(tmp_path / "plan.json")
    assert (again.algorithm, again.gap, again.stages) == (result.algorithm, result.gap, result.stages)
    beyond = an.Problem.from_cells(problem.grid, (0, 0), (39, 59))
    assert an.solve(beyond, an.paco_large(coarse=8)).status == "unreachable"


def test_the_optimum_is_searched_only_when_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    calls = []
    search = exact.shortest_path
    monkeypatch.setattr(exact, "shortest_path", lambda problem: (calls.append(problem), search(problem))[1])
    problem = an.Problem.from_cells(an.GridMap(np.zeros((40, 50), np.uint8)), (0, 0), (39, 49))
    result = an.solve(problem, an.paco_large())
    assert calls == []
    assert result.gap == pytest.approx(0)
    assert an.solve(problem, an.paco_large(), seed=1).optimum == result.optimum
    assert calls == [problem]


@pytest.mark.parametrize(
    ("choices", "reason"),
    [
        ({"heuristic": "edge"}, "length 0"),
        ({"heuristic": "astar"}, "no direction"),
        ({"pheromone": "best_and_turns"}, "no direction"),
        ({"local_search": "shortcut"}, "need not be shorter"),
        ({"decomposition": an.Decomposition()}, "divide the map already"),
        ({"coarse": 3}, "from 4 to 128"),
        ({"coarse": True}, "from 4 to 128"),
        ({"windows": 2}, "from 3 to"),
        ({"routes": 0}, "from 1"),
    ],
)
def test_what_does_not_fit_is_refused_with_the_reason(choices: dict, reason: str) -> None:
    with pytest.raises(ParameterError, match=reason):
        an.paco_large(**choices)
