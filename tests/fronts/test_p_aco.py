"""P-ACO: its update by hand, legal paths, the same for the same seed."""

from __future__ import annotations

import numpy as np
import pytest

import antnav as an
from antnav import fronts
from antnav.errors import ParameterError
from antnav.fronts import archive as archives
from antnav.fronts.instance import Instance
from antnav.kernels import front_ant_kernels as kernels
from antnav.run.spmd import Serial
from antnav.run.stop import Iterations
from tests.fronts.instances import drawn


def test_it_finds_much_of_a_small_front() -> None:
    problem, asked = drawn(12, 3, 3)
    exact = {tuple(values) for values in an.pareto(problem, asked, algorithm="exact").values.round(6).tolist()}
    front = an.pareto(problem, asked, algorithm="p-aco")
    assert len(exact & {tuple(values) for values in front.values.round(6).tolist()}) > len(exact) / 2
    for path in front.paths:
        an.check_path(path, problem)
        assert len(np.unique(path.cells, axis=0)) == len(path.cells)


def test_a_seed_is_the_same_front() -> None:
    problem, asked = drawn(16, 2, 4)
    method = fronts.PAco(iterations=10)
    one = an.pareto(problem, asked, algorithm=method, seed=3)
    other = an.pareto(problem, asked, algorithm=method, seed=3, executor=Serial())
    assert one.values.tobytes() == other.values.tobytes()
    assert one.work == other.work != an.pareto(problem, asked, algorithm=method, seed=4).work


def test_it_ends_when_it_is_told_to() -> None:
    problem, asked = drawn(12, 3, 3)
    front = an.pareto(problem, asked, algorithm="p-aco", stop=Iterations(3))
    assert front.stopped_by == "criterion"
    assert front.work["walks"] == 3 * fronts.PAco().ants


def test_the_best_two_of_each_objective_lay_pheromone() -> None:
    """Three paths that share no move: 10 rho for the best, 5 rho for the second, nothing for the third."""
    problem, asked = drawn(12, 3, 2)
    instance = Instance.of(problem, asked)
    neighbours = instance.graph.graph.neighbours
    pairs = [(i, s) for i in range(3) for s in range(8) if neighbours[i, s] < len(neighbours)][:3]
    nodes = np.array([[i, neighbours[i, s]] for i, s in pairs], np.int32).ravel()
    found: archives.Paths = (np.array([[1, 9], [2, 8], [3, 7]]), np.full(3, 2, np.int32), nodes)
    tau = np.ones((2, len(neighbours), 8))
    fronts.PAco(rho=0.5)._update(instance, tau, found)
    laid = [[matrix[i, s] for i, s in pairs] for matrix in tau]
    assert laid == [[0.5 + 5.0, 0.5 + 2.5, 0.5], [0.5, 0.5 + 2.5, 0.5 + 5.0]]
    assert np.count_nonzero(tau == 0.5) == tau.size - 4


def test_moves_are_drawn_in_proportion_to_pheromone_and_attraction() -> None:
    """One move of many ants from the start, without local update, against the formula."""
    problem, asked = drawn(12, 3, 3)
    instance = Instance.of(problem, asked)
    ranges, weights = np.array([900.0, 1500.0, 6.0]), np.array([0.2, 0.5, 0.3])
    tau = np.random.default_rng(1).random((3, len(instance.graph), 8)) + 0.5
    neighbours, start = instance.graph.graph.neighbours, instance.start
    slots = [s for s in range(8) if neighbours[start, s] < len(neighbours)]
    eta = []
    for s in slots:
        rise = instance.costs[start, s] + instance.ideal[neighbours[start, s]] - instance.ideal[start]
        eta.append(1 / (1 + (weights / ranges) @ (rise + instance.turns[0, s]) / 0.01))
    odds = np.array([weights @ tau[:, start, s] for s in slots]) * np.array(eta) ** 2
    ants = 20_000
    values, lengths, nodes = kernels.iterate(
        *instance.arrays,
        instance.ideal,
        ranges,
        0.01,
        tau,
        np.tile(weights, (ants, 1)),
        (start, instance.goal),
        0.0,
        0.0,
        1.0,
        2,
        np.uint64(7),
        0,
    )
    first = nodes[np.cumsum(lengths) - lengths + 1]
    share = np.array([(first == neighbours[start, s]).mean() for s in slots])
    np.testing.assert_allclose(share, odds / odds.sum(), atol=0.02)
    assert (instance.steps([nodes[: lengths[0]]]) == values[:1]).all()


@pytest.mark.parametrize(
    ("name", "value"), [("iterations", 0), ("ants", 0), ("q0", 1.5), ("rho", -0.1), ("tau0", 0.0), ("unit", np.nan)]
)
def test_parameters_out_of_range_are_refused(name: str, value: float) -> None:
    with pytest.raises(ParameterError, match=name):
        fronts.PAco(**{name: value})
