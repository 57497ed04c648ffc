"""Colonies from either end for the whole schedule."""

from __future__ import annotations

import numpy as np
import pytest

import antnav as an
from antnav import maps
from antnav.errors import ParameterError
from antnav.planner.facts import Knows
from antnav.run import spmd
from tests.conftest import grid_of


@pytest.fixture(scope="module")
def problem() -> an.Problem:
    grid = maps.generate("random", 25, 25, seed=4, density=0.35)
    return an.Problem.from_cells(grid, *maps.ends(grid))


@pytest.mark.parametrize("colonies", [1, 2, 5])
def test_colonies_walk_by_turns_from_either_end(colonies: int, problem: an.Problem) -> None:
    result = an.solve(problem, an.two_ended(colonies=colonies, iterations=6), seed=1)
    (stage,) = result.stages
    ends = [(problem.start_cell, problem.goal_cell), (problem.goal_cell, problem.start_cell)]
    assert [(one.start, one.goal) for one in stage.colonies] == [ends[index % 2] for index in range(colonies)]
    assert len({one.steps for one in stage.colonies}) == colonies, "each has random numbers of its own"
    assert result.length == pytest.approx(min(one.length for one in stage.colonies))
    assert result.algorithm.walks == sum(one.walks for one in stage.colonies)
    an.check_path(result.path, problem)


def test_either_end_wins(problem: an.Problem) -> None:
    """The path of a colony from the goal is turned round, and its pheromone, too."""
    winners = set()
    for seed in range(12):
        result = an.solve(problem, an.two_ended(ants=3, iterations=2), seed=seed, remember=True)
        lengths = [one.length or np.inf for one in result.stages[0].colonies]
        winners.add(int(np.argmin(lengths)) if lengths[0] != lengths[1] else -1)
        assert result.path.cells[0].tolist() == list(problem.start_cell)
        an.check_path(result.path, problem)
        assert an.solve(problem, an.two_ended(ants=3, iterations=2), warm=result, seed=seed).path is not None
    assert winners >= {0, 1}


def test_any_executor_gives_the_same_bytes(problem: an.Problem) -> None:
    algorithm = an.two_ended(colonies=4, iterations=8)
    results = [an.solve(problem, algorithm, seed=3), an.solve(problem, algorithm, seed=3, executor=spmd.Serial())]
    with spmd.Processes(2) as processes:
        results.append(an.solve(problem, algorithm, seed=3, executor=processes))
    steps = an.Steps(problem, algorithm, seed=3)
    bests = [step.best for step in steps]
    results.append(steps.result)
    first = results[0]
    assert bests[-1] == pytest.approx(first.length)
    for result in results[1:]:
        assert result.path.cells.tobytes() == first.path.cells.tobytes()
        assert [column.tobytes() for column in result.history] == [column.tobytes() for column in first.history]


def test_where_costs_depend_on_the_direction(problem: an.Problem) -> None:
    rows = np.arange(25.0)[:, None]
    slope = an.costs.slope(np.broadcast_to(10 * np.abs(np.sin(rows)), (25, 25)), up=2.0)
    hilly = an.Problem.from_cells(problem.grid, problem.start_cell, problem.goal_cell, cost=slope)
    result = an.solve(hilly, an.two_ended(), seed=0)
    assert result.cost == pytest.approx(min(one.length for one in result.stages[0].colonies))


def test_it_knows_no_exact_distances() -> None:
    large = an.Problem.from_cells(an.GridMap(np.zeros((60, 60), np.uint8)), (0, 0), (59, 59))
    assert an.two_ended().suited(large).knows is Knows.NOTHING


def test_pieces_are_options_of_other_presets(problem: an.Problem) -> None:
    usual, grafting = (an.solve(problem, an.paco(graft=graft, ants=20), seed=2) for graft in (False, True))
    assert "graft True" in str(grafting.algorithm.certainty)
    assert np.all(grafting.history.best[:3] <= usual.history.best[:3])


@pytest.mark.parametrize("choices", [{"decomposition": an.Decomposition()}, {"coarse": 16}])
def test_stages_have_their_own_colonies(choices: dict) -> None:
    with pytest.raises(ParameterError, match="colonies 2 with"):
        an.npaco(colonies=2, **choices)


def test_a_colony_by_hand_is_one() -> None:
    problem = an.Problem.from_cells(grid_of("..", ".."), (0, 0), (1, 1))
    with pytest.raises(ParameterError, match="colonies=1"):
        an.Colony(problem, an.two_ended())
    assert an.Colony(problem, an.two_ended(colonies=1)).iteration == 0


def test_equal_budgets_count_every_colony() -> None:
    assert an.two_ended(colonies=5).with_walks(an.npaco().walks).walks == an.npaco().walks
