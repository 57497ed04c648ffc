"""What is told about runs, worked out by hand."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest

import antnav as an
from antnav.ants.accounts import Run, heat, joined_history, memory
from antnav.kernels.ant_kernels import History


def outcome(best: list, iteration_best: list, mean: list, arrived: list, lost: list, steps: list) -> SimpleNamespace:
    history = History(
        *(np.array(column, float) for column in (best, iteration_best, mean)),
        *(np.array(column, np.int64) for column in (arrived, lost, steps)),
        np.full(len(best), 1.0),
    )
    return SimpleNamespace(history=history, iterations=len(best))


ONE = outcome([9, 7], [9, 7], [10, 8], [2, 4], [3, 1], [50, 40])
OTHER = outcome([math.inf], [math.inf], [math.nan], [0], [5], [30])


def test_side_by_side_the_better_colony_counts() -> None:
    history = Run("stage one", False, 0.0, (), (ONE, OTHER)).history()
    assert history.best.tolist() == [9, 7]
    assert history.mean.tolist() == [10, 8]  # of those that arrived
    assert history.arrived.tolist() == [2, 4]
    assert history.lost.tolist() == [8, 1]
    assert history.steps.tolist() == [80, 40]


def test_halves_add_up_and_hold_their_last_values() -> None:
    short = outcome([3], [3], [4], [6], [0], [20])
    history = Run("stage two", True, 0.0, (), (ONE, short)).history()
    assert history.best.tolist() == [12, 10]
    assert history.mean.tolist() == [14, 12]
    assert history.arrived.tolist() == [8, 4]
    assert history.steps.tolist() == [70, 40]


def test_means_are_weighted_by_arrivals() -> None:
    few = outcome([5], [5], [6], [1], [0], [9])
    many = outcome([4], [4], [10], [3], [0], [9])
    assert Run("stage one", False, 0.0, (), (few, many)).history().mean.tolist() == [9.0]


def test_runs_follow_each_other() -> None:
    first, second = Run("a", False, 0.0, (), (ONE,)), Run("b", False, 0.0, (), (OTHER,))
    assert joined_history([first, second]).steps.tolist() == [50, 40, 30]
    assert len(joined_history([]).best) == 0


def test_heat_is_the_better_colonys_and_the_sum_of_parts() -> None:
    problem = an.Problem.from_cells(an.GridMap(np.zeros((1, 3), np.uint8)), (0, 0), (0, 2))
    task = SimpleNamespace(grid_graph=problem.graph, goal=2)
    worse, better = (
        SimpleNamespace(tau=np.full((3, 8), tau), length=length) for tau, length in ((5.0, 9.0), (2.0, 4.0))
    )
    last = Run("windows", False, 0.0, (), ())
    assert heat(problem, [Run("regions", False, 0.0, (task, task), (worse, better)), last])().tolist() == [[2, 2, 2]]
    assert heat(problem, [Run("stage two", True, 0.0, (task, task), (worse, better)), last])().tolist() == [[7, 7, 7]]
    assert np.isnan(heat(problem, [last])()).all()


def test_memory_is_the_better_colonys_from_start_to_goal_and_the_most_of_parts() -> None:
    problem = an.Problem.from_cells(an.GridMap(np.zeros((1, 3), np.uint8)), (0, 0), (0, 2))
    nan, left, right = math.nan, 3, 4

    def remembered(name: str, parts: bool, *colonies: tuple[int, list, list, float]) -> list[list[float]]:
        tasks, outcomes = [], []
        for start, to_left, to_right, length in colonies:
            tau = np.full((3, 8), 9.0)
            tau[:, left], tau[:, right] = to_left, to_right
            tasks.append(SimpleNamespace(grid_graph=problem.graph, start=start))
            outcomes.append(SimpleNamespace(tau=tau, length=length, paths=[]))
        found = memory(problem, [Run(name, parts, 0.0, tasks, outcomes), Run("windows", False, 0.0, (), ())], 2.0)
        assert (found.shape, found.tau0, found.flat.tolist()) == ((1, 3), 2.0, [6, 7, 8])
        assert np.isnan(np.delete(found.tau, [left, right], axis=1)).all()
        return found.tau[:, [left, right]].tolist()

    forward, backward = (0, [9, 1, 2], [3, 4, 9], 5.0), (2, [9, 5, 6], [7, 8, 9], 4.0)
    assert str(remembered("stage one", False, forward, backward)) == str([[nan, 5.0], [7.0, 6.0], [8.0, nan]])
    assert str(remembered("stage one", False, forward)) == str([[nan, 3.0], [1.0, 4.0], [2.0, nan]])
    first, second = (0, [9, 1, 6], [3, 4, 9], 5.0), (1, [9, 5, 2], [7, 2, 9], 4.0)
    assert str(remembered("stage two", True, first, second)) == str([[nan, 7.0], [5.0, 4.0], [6.0, nan]])
    assert memory(problem, [Run("windows", False, 0.0, (), ())], 2.0) is None


@pytest.mark.parametrize("touched", [0, 1, 40, 10_000])
@pytest.mark.parametrize("usual", [0.1, 0.59049, 2.0**-40])
def test_heat_is_each_nodes_mean_to_the_last_bit(touched: int, usual: float) -> None:
    grid = an.maps.generate("caves", 40, 40, seed=5)
    problem = an.Problem.from_cells(grid, *an.maps.ends(grid))
    rng, n = np.random.default_rng(touched), len(problem.graph)
    tau = np.full((n, 8), usual)
    tau[rng.integers(0, n, touched), rng.integers(0, 8, touched)] = rng.random(touched)
    edges = problem.graph.graph.neighbours < n
    means = [np.where(edges[i], tau[i], 0.0).sum() / edges[i].sum() for i in range(n)]
    task, outcome = SimpleNamespace(grid_graph=problem.graph, goal=0), SimpleNamespace(tau=tau, length=1.0)
    found = heat(problem, [Run("whole map", False, 0.0, (task,), (outcome,))])
    np.testing.assert_array_equal(found(), problem.graph.on_map(np.array(means, np.float32)))
    assert len(found.packed) < 300 + 8 * touched, "what is like most takes no room"
