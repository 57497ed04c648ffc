"""solve_many: the same as one by one, whoever does the work."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import Executor, ThreadPoolExecutor

import numpy as np
import pytest

import antnav as an
from antnav import maps
from antnav.run import spmd

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
            many = an.solve_many(asked, algorithm, grid=GRID, cells=True, seed=7, executor=executor, workers=workers)
            assert digest(list(many)) == alone
            results = list(an.solve_many(problems, algorithm, seed=7, executor=executor, workers=workers))
            assert digest(results) == alone
            assert [result.problem for result in results] == problems  # the very ones
