"""solve_many: the same as one by one, whoever does the work."""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
from collections.abc import Iterator
from concurrent.futures import Executor, ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

import antnav as an
from antnav import maps
from antnav.errors import OccupiedError, OutsideMapError, ParameterError, WorkerLostError
from antnav.run import spmd
from antnav.world.cost import CostField

GRID = maps.builtin("equiv30")


def pairs(count: int, seed: int = 1, grid: an.GridMap = GRID) -> list[tuple[tuple[int, int], tuple[int, int]]]:
    """Random free cells."""
    free = np.argwhere(grid.cells == an.Cell.FREE)
    drawn = free[np.random.default_rng(seed).integers(len(free), size=(count, 2))]
    return [(tuple(start), tuple(goal)) for start, goal in drawn.tolist()]


def digest(results: list[an.Result]) -> list[tuple[object, ...]]:
    """What two runs of one query share: all but seconds."""
    return [
        (result.status, result.cost, result.seed, result.history.best.tolist(), result.steps)
        + (() if result.path is None else (result.path.cells.tolist(), result.path.points.tolist()))
        for result in results
    ]


@pytest.fixture(scope="module")
def processes() -> Iterator[Executor]:
    with spmd.Processes(2) as pool:
        yield pool


@pytest.mark.parametrize("algorithm", [an.astar(), an.paco(ants=5, iterations=6)])
def test_as_one_by_one_whoever_works(algorithm: an.Planner, processes: Executor) -> None:
    asked = pairs(40)
    problems = [an.Problem.from_cells(GRID, *ends) for ends in asked]
    alone = digest([an.solve(problem, algorithm, seed=7) for problem in problems])
    with ThreadPoolExecutor(3) as threads:
        for executor, workers in ((None, None), (None, 1), (spmd.Serial(), None), (threads, 3), (processes, 2)):
            found = an.solve_many(asked, algorithm, grid=GRID, cells=True, seed=7, executor=executor, workers=workers)
            assert digest(list(found)) == alone
            results = list(an.solve_many(problems, algorithm, seed=7, executor=executor, workers=workers))
            assert digest(results) == alone
            assert [result.problem for result in results] == problems  # the very ones


def test_several_maps_and_pairs_in_one_stream(processes: Executor) -> None:
    """Maps change with each query, and those that come again are known."""
    grids = [maps.builtin(name) for name in ("equiv20", "equiv30", "equiv40")]
    problems = [
        an.Problem.from_cells(grid, *ends, corner_rule="allow", turning=float(place % 2))
        for place, group in enumerate(zip(*(pairs(6, 3, grid) for grid in grids), strict=True))
        for grid, ends in zip(grids, group, strict=True)
    ]
    queries = [*problems, *pairs(5)]
    alone = [an.solve(problem, an.astar()) for problem in problems]
    alone += [an.solve(an.Problem.from_cells(GRID, *ends), an.astar()) for ends in pairs(5)]
    found = an.solve_many(queries, an.astar(), grid=GRID, cells=True, executor=processes, workers=2)
    assert digest(list(found)) == digest(alone)


def test_costs_and_tolerances_of_pairs(processes: Executor) -> None:
    choices = {"corner_rule": "allow", "goal_tolerance": 12.0, "start_tolerance": 12.0, "turning": 0.5}
    choices["cost"] = an.costs.array(np.linspace(0, 2, GRID.rows * GRID.cols).reshape(GRID.shape))
    asked = [((x, 28.5 - x), (28.5 - x / 2, x)) for x in np.linspace(1.5, 27.5, 9).tolist()]
    problems = [an.Problem(GRID, *ends, **choices) for ends in asked]
    alone = [an.solve(problem, an.astar()) for problem in problems]
    assert any(problem.moved_ends for problem in problems)
    for given, more in ((asked, {"grid": GRID, **choices}), (problems, {})):
        results = list(an.solve_many(given, an.astar(), executor=processes, workers=2, **more))
        assert digest(results) == digest(alone)
        assert [result.notes for result in results] == [result.notes for result in alone]
    closed = CostField(np.zeros(GRID.shape), np.eye(*GRID.shape, dtype=bool))
    more = choices | {"grid": GRID, "cost": closed}
    results = list(an.solve_many(asked, an.astar(), executor=processes, **more))
    assert all(result.problem.grid is GRID.closed(closed.blocked) for result in results), "the one map, not a copy"


def test_pheromone_stays_where_it_is_and_the_optimum_comes_if_wanted(processes: Executor) -> None:
    ants = an.npaco(ants=4, iterations=3)
    for executor in (None, processes):
        results = list(an.solve_many(pairs(4), ants, grid=GRID, cells=True, executor=executor, optimum=True))
        assert all(result.pheromone is None for result in results)
        assert all(result.certificate is not None for result in results if result.problem.connected)
    (result,) = an.solve_many(pairs(1), ants, grid=GRID, cells=True)
    assert result.certificate is None


@pytest.mark.parametrize("workers", [None, 2])
def test_errors_are_raised_in_their_place_or_stand_there(workers: int | None, processes: Executor) -> None:
    wall = tuple(np.argwhere(GRID.cells == an.Cell.OCCUPIED)[0].tolist())
    good = pairs(3)
    asked = [good[0], (wall, good[0][1]), good[1], (good[0][0], (99, 99)), good[2], 7]
    executor = None if workers is None else processes
    answers = list(an.solve_many(asked, an.astar(), grid=GRID, cells=True, executor=executor, errors="return"))
    assert [type(answer) for answer in answers] == [
        *(an.Result, OccupiedError, an.Result, OutsideMapError, an.Result, ParameterError)
    ]
    stream = an.solve_many(asked, an.astar(), grid=GRID, cells=True, executor=executor)
    assert next(stream).path is not None
    with pytest.raises(OccupiedError) as raised:
        next(stream)
    assert raised.value.__notes__ == ["query 1, counted from 0"]


def test_a_stream_is_read_no_further_than_needed(processes: Executor) -> None:
    for executor in (None, processes, ThreadPoolExecutor(2)):
        read = 0

        def endless() -> Iterator[tuple[tuple[int, int], tuple[int, int]]]:
            nonlocal read
            while True:
                read += 1
                yield pairs(1)[0]

        stream = an.solve_many(endless(), an.astar(), grid=GRID, cells=True, executor=executor, workers=2)
        for _ in range(5):
            next(stream)
        stream.close()
        assert read < 1000


@pytest.mark.parametrize("kind", ["turn", "threads", "processes"])
def test_cancel_ends_a_stream(kind: str, processes: Executor) -> None:
    cancel = threading.Event()
    executor = {"turn": None, "threads": ThreadPoolExecutor(2), "processes": processes}[kind]
    ants = an.npaco(ants=3, iterations=2)
    stream = an.solve_many(pairs(5000), ants, grid=GRID, cells=True, executor=executor, cancel=cancel)
    first = [next(stream) for _ in range(3)]
    cancel.set()
    rest = list(stream)
    assert len(first + rest) < 5000
    alone = [an.solve(result.problem, ants) for result in rest]
    assert digest(rest) == digest(alone), "whole ones"


def test_processes_of_its_own_end_with_the_stream() -> None:
    before = set(multiprocessing.active_children())
    stream = an.solve_many(pairs(200), an.astar(), grid=GRID, cells=True, workers=2)
    next(stream)
    assert len(set(multiprocessing.active_children()) - before) == 2
    stream.close()
    assert set(multiprocessing.active_children()) <= before


@dataclass(frozen=True)
class Deadly(an.Planner):
    """A* that kills its process once for a marker, or always without."""

    folder: str = ""
    name: str = "deadly"

    def plan(self, problem: an.Problem, call: an.Call) -> an.Plan:
        marker = Path(self.folder, f"{problem.start_cell[0] % 2}")  # two deaths: fewer than a job survives
        if not self.folder or not marker.exists():
            if self.folder:
                marker.touch()
            os.kill(os.getpid(), signal.SIGKILL)
        return an.astar().plan(problem, call)


def test_a_lost_worker_costs_a_retry_and_no_result(tmp_path: Path) -> None:
    alone = digest([an.solve(an.Problem.from_cells(GRID, *ends), an.astar()) for ends in pairs(30)])
    with spmd.Processes(2) as pool:
        found = an.solve_many(pairs(30), Deadly(str(tmp_path)), grid=GRID, cells=True, executor=pool, workers=2)
        assert digest(list(found)) == alone
        with pytest.raises(WorkerLostError, match="3 times"):
            list(an.solve_many(pairs(3), Deadly(), grid=GRID, cells=True, executor=pool))


@pytest.mark.slow
def test_on_dask() -> None:
    distributed = pytest.importorskip("distributed", reason="the extra antnav[cluster] is not installed")
    alone = digest([an.solve(an.Problem.from_cells(GRID, *ends), an.astar()) for ends in pairs(20)])
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
    ):
        found = an.solve_many(pairs(20), an.astar(), grid=GRID, cells=True, executor=client.get_executor(), workers=2)
        assert digest(list(found)) == alone


class Local:
    """Makes planners whose class cannot be sent."""

    @staticmethod
    def planner() -> an.Planner:
        @dataclass(frozen=True)
        class Inner(an.Planner):
            name: str = "inner"

            def plan(self, problem: an.Problem, call: an.Call) -> an.Plan:
                return an.astar().plan(problem, call)

        return Inner()


def test_what_cannot_be_sent_is_refused(processes: Executor) -> None:
    with pytest.raises(ParameterError, match="it cannot be sent"):
        list(an.solve_many(pairs(2), Local.planner(), grid=GRID, cells=True, executor=processes))
    assert len(list(an.solve_many(pairs(2), Local.planner(), grid=GRID, cells=True))) == 2


@pytest.mark.parametrize(
    ("given", "rule"),
    [
        ({"queries": 7}, "there are several"),
        ({"algorithm": "astar"}, "its type is Planner"),
        ({"grid": "map"}, "its type is GridMap"),
        ({"seed": -1}, "a seed is"),
        ({"workers": 0}, "at least 1 worker"),
        ({"executor": 2}, "it is an Executor"),
        ({"errors": "ignore"}, "raised or returned"),
        ({"goal_tolerance": -1}, "tolerance"),
        ({"turning": -1}, "turning"),
        ({"corner_rule": "never"}, "corner rule"),
        ({"cancel": 1}, "is_set"),
        ({"stop": 1}, "stop"),
    ],
)
def test_wrong_parameters_are_refused_at_the_call(given: dict[str, object], rule: str) -> None:
    with pytest.raises(ParameterError, match=rule):
        an.solve_many(**{"queries": pairs(1), "grid": GRID, "cells": True, **given})


def test_a_pair_needs_a_map() -> None:
    with pytest.raises(ParameterError, match="no map of its own"):
        list(an.solve_many([((1, 1), (2, 2))]))
    assert list(an.solve_many([])) == []


@pytest.mark.parametrize("errors", ["ignore", True, None, ["raise"]])
def test_errors_are_raised_or_returned(errors: object) -> None:
    with pytest.raises(an.errors.ParameterError, match="raised or returned"):
        an.solve_many(pairs(1), an.astar(), grid=GRID, cells=True, errors=errors)


@pytest.mark.parametrize("executor", [None, "serial"])
def test_exact_searches_in_turn_are_cancelled_between_queries(executor: str | None) -> None:
    cancel = threading.Event()
    ends = an.maps.builtin_query("equiv20")
    found = an.solve_many(
        [ends] * 50,
        an.astar(),
        grid=an.maps.builtin("equiv20"),
        cells=True,
        corner_rule="allow",
        executor=an.spmd.Serial() if executor else None,
        cancel=cancel,
    )
    answers = [next(found), next(found)]
    cancel.set()
    assert len([*answers, *found]) == 2
