"""PACO's scheme with pieces of `two_ended`."""

from __future__ import annotations

import numpy as np
import pytest

import antnav as an
from antnav import maps
from antnav.planner.facts import Knows
from antnav.planner.phases import Phase


@pytest.fixture(scope="module")
def problem() -> an.Problem:
    grid = maps.generate("random", 30, 30, seed=4, density=0.35)
    return an.Problem.from_cells(grid, *maps.ends(grid))


def test_it_keeps_to_the_scheme_of_the_paper(problem: an.Problem) -> None:
    """Two colonies from either end, then a half each."""
    result = an.solve(problem, an.paco_taut(), seed=1)
    start, goal, auxiliary = problem.start_cell, problem.goal_cell, result.auxiliary_cell
    assert [stage.name for stage in result.stages] == [Phase.STAGE_ONE, Phase.STAGE_TWO]
    assert [[(one.start, one.goal) for one in stage.colonies] for stage in result.stages] == [
        [(start, goal), (goal, start)],
        [(start, auxiliary), (auxiliary, goal)],
    ]
    assert result.algorithm.walks == sum(one.walks for stage in result.stages for one in stage.colonies)
    an.check_path(result.path, problem)


@pytest.mark.parametrize("side", [20, 30, 40])
def test_half_of_the_steps_of_npaco_and_every_run_optimal(side: int) -> None:
    name = f"equiv{side}"
    problem = an.Problem.from_cells(maps.builtin(name), *maps.builtin_query(name), corner_rule="allow")
    for seed in range(10):
        taut, npaco = (an.solve(problem, algorithm, seed=seed) for algorithm in (an.paco_taut(), an.npaco()))
        assert taut.gap == pytest.approx(0)
        assert 2 * taut.critical_steps < npaco.steps


def test_it_knows_no_exact_distances() -> None:
    large = an.Problem.from_cells(an.GridMap(np.zeros((60, 60), np.uint8)), (0, 0), (59, 59))
    assert an.paco_taut().suited(large).knows is Knows.NOTHING
