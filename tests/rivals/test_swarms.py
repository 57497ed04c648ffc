"""WOA, MFO, SMA and HHO: each against its twin, and on functions whose minimum is known."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from antnav.rivals import swarms
from tests.rivals import naive_swarms

Vector = NDArray[np.float64]

DIMENSION = 10
SHIFT = np.random.default_rng(1).uniform(-60, 60, DIMENSION)
BOX = (np.full(DIMENSION, -100.0), np.full(DIMENSION, 100.0))

every_swarm = pytest.mark.parametrize("method", swarms.ALGORITHMS)


def sphere(x: Vector) -> float:
    return float(np.sum((x - SHIFT) ** 2))


@every_swarm
@pytest.mark.parametrize(("seed", "budget"), [(0, 48), (1, 60), (2, 41), (3, 120), (4, 120), (5, 120)])
def test_every_point_is_that_of_the_twin(method: str, seed: int, budget: int) -> None:
    half, centre = [3.0, 1.0, 2.0], [1.0, -0.4, 0.3]

    def cost(x: object) -> float:
        return sum((value - target) ** 2 for value, target in zip(np.asarray(x).tolist(), centre, strict=True))

    asked: list[Vector] = []

    def recorded(x: Vector) -> float:
        asked.append(x.copy())
        return cost(x)

    box = (-np.array(half), np.array(half))
    swarms.minimise(method, recorded, box, population=8, evaluations=budget, seed=seed)
    twin = getattr(naive_swarms, method)(cost, half, 8, budget, seed)
    np.testing.assert_allclose(asked, twin, rtol=0, atol=1e-9)


@every_swarm
def test_a_shifted_sphere_is_found_far_better_than_by_random_search(method: str) -> None:
    found = [swarms.minimise(method, sphere, BOX, population=50, evaluations=6000, seed=seed)[1] for seed in range(5)]
    points = np.random.default_rng(0).uniform(*BOX, (5, 6000, DIMENSION))
    at_random = np.sum((points - SHIFT) ** 2, axis=2).min(axis=1)
    assert np.median(found) < np.median(at_random) / 20


@every_swarm
@pytest.mark.parametrize("budget", [50, 53, 217])
def test_the_budget_is_spent_within_the_bounds(method: str, budget: int) -> None:
    box = (np.array([-0.5, -0.5, 2.0]), np.array([19.5, 0.1, 2.3]))
    asked: list[Vector] = []

    def cost(x: Vector) -> float:
        asked.append(x.copy())
        return float(np.sum(x))  # least at the lower corner

    best, least = swarms.minimise(method, cost, box, population=10, evaluations=budget, seed=0)
    assert len(asked) == budget
    assert np.all((box[0] <= asked) & (asked <= box[1]))
    costs = np.sum(asked, axis=1)
    assert least == costs.min()
    np.testing.assert_allclose(best, asked[int(costs.argmin())], rtol=0, atol=1e-12)


@every_swarm
def test_seeds_decide(method: str) -> None:
    def run(seed: int) -> list[float]:
        return swarms.minimise(method, sphere, BOX, population=10, evaluations=100, seed=seed)[0].tolist()

    assert run(5) == run(5)
    assert run(5) != run(6) != run(2**64 - 1)


@every_swarm
def test_it_does_not_matter_where_the_box_lies(method: str) -> None:
    here, least = swarms.minimise(method, sphere, BOX, population=10, evaluations=300, seed=3)
    moved = (BOX[0] + 128.0, BOX[1] + 128.0)
    there = swarms.minimise(method, lambda x: sphere(x - 128.0), moved, population=10, evaluations=300, seed=3)
    np.testing.assert_allclose(there[0] - 128.0, here, rtol=0, atol=1e-6)
    assert there[1] == pytest.approx(least)


@every_swarm
def test_equal_costs_do_no_harm(method: str) -> None:
    best, least = swarms.minimise(method, lambda _: 7.0, BOX, population=10, evaluations=300, seed=0)
    assert least == 7.0
    assert np.all(np.isfinite(best))
