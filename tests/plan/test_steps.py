"""Any algorithm one iteration at a time: the same bytes as `solve`, and PACO's stages in view."""

from __future__ import annotations

import math
from collections import Counter
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import antnav as an
from antnav.ants.presets import PRESETS
from tests.conftest import grid_of
from tests.kernels.test_ant_kernels import random_problem


@pytest.mark.parametrize("name", PRESETS)
@pytest.mark.parametrize("seed", [3, 4])
def test_steps_end_where_solve_does(name: str, seed: int) -> None:
    problem, algorithm = random_problem(seed, side=14), PRESETS[name](ants=9, iterations=9)
    steps = an.Steps(problem, algorithm, seed=seed)
    taken = list(steps)
    count = Counter(step.stage for step in taken if step.colonies)
    stepped, solved = steps.result, an.solve(problem, algorithm, seed=seed)
    assert stepped is not None
    assert not taken or taken[-1].best == pytest.approx(solved.length)
    paths = [None if result.path is None else result.path.cells.tolist() for result in (stepped, solved)]
    assert paths[0] == paths[1]
    assert [column.tobytes() for column in stepped.history] == [column.tobytes() for column in solved.history]
    assert stepped.pheromone.tobytes() == solved.pheromone.tobytes()
    assert (stepped.auxiliary_cell, stepped.notes) == (solved.auxiliary_cell, solved.notes)
    with_ants = [stage for stage in solved.stages if stage.colonies]
    assert count == {stage.name: max(colony.iterations for colony in stage.colonies) for stage in with_ants}


def test_both_stages_of_paco_are_in_view(equivalent: an.Problem) -> None:
    steps = an.Steps(equivalent, an.paco(axis="row"), seed=7)
    seen = [(step.stage, step.number, step.auxiliary_cell, step.best, len(step.colonies)) for step in steps]
    assert [stage for stage, *_ in seen] == ["stage one"] * 3 + ["stage two"] * 47
    assert [number for _, number, *_ in seen] == [*range(1, 4), *range(1, 48)]
    assert {auxiliary for _, _, auxiliary, _, _ in seen[:3]} == {None}
    assert {auxiliary for _, _, auxiliary, _, _ in seen[3:]} == {steps.result.auxiliary_cell}
    assert {colonies for *_, colonies in seen} == {2}
    np.testing.assert_allclose([best for *_, best, _ in seen], steps.result.history.best)
    assert math.isclose(seen[-1][3], steps.result.length)


def test_pheromone_written_on_the_way_counts() -> None:
    problem, algorithm = random_problem(1, side=14), an.paco(ants=5, iterations=9)
    steps = an.Steps(problem, algorithm, seed=1)
    for step in steps:
        for colony in step.colonies:
            colony.tau[:] = 1.0
    assert steps.result.history.iteration_best.tolist() != an.solve(problem, algorithm, seed=1).history[1].tolist()


def test_steps_can_be_taken_again_and_left_early() -> None:
    steps = an.Steps(random_problem(1), an.paco(ants=5, iterations=9), seed=1)
    next(iter(steps))
    assert steps.result is None
    first = [step.best for step in steps]
    assert [step.best for step in steps] == first


def test_without_ants_there_is_no_step() -> None:
    steps = an.Steps(an.Problem.from_cells(grid_of(".#."), (0, 0), (0, 2)))
    assert list(steps) == []
    assert steps.result.status is an.Status.UNREACHABLE


@pytest.mark.parametrize("algorithm", [an.paco(), an.paco_large(), an.npaco(windows=9)], ids=lambda each: each.name)
def test_a_colony_refuses_what_runs_several(algorithm: an.Algorithm) -> None:
    with pytest.raises(an.errors.ParameterError, match=r"an\.Steps"):
        an.Colony(random_problem(1), algorithm)


@pytest.mark.parametrize("wrong", [{"problem": 3}, {"algorithm": "paco"}, {"algorithm": an.paco}, {"seed": -1}])
def test_bad_arguments_are_refused(wrong: dict) -> None:
    with pytest.raises(an.errors.ParameterError):
        an.Steps(**{"problem": random_problem(1)} | wrong)


def test_the_last_step_tells_the_cost_where_there_are_costs() -> None:
    plain = random_problem(3, side=14)
    cost = an.costs.array(np.random.default_rng(1).gamma(1.0, 2.0, plain.grid.shape))
    problem = an.Problem.from_cells(plain.grid, plain.start_cell, plain.goal_cell, corner_rule="allow", cost=cost)
    steps = an.Steps(problem, an.paco_ls(ants=9, iterations=9), seed=3)
    assert list(steps)[-1].best == steps.result.cost > steps.result.length


def test_steps_may_be_taken_by_any_thread(equivalent: an.Problem) -> None:
    steps = an.Steps(equivalent, an.paco(ants=5, iterations=6), seed=1)
    iterator = iter(steps)
    with ThreadPoolExecutor(3) as workers:
        while workers.submit(next, iterator, None).result() is not None:
            pass
    assert steps.result is not None
    assert 0 <= steps.result.cpu_seconds <= 60
