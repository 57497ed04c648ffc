"""Instances that tests of fronts share."""

from __future__ import annotations

import numpy as np

import antnav as an
from antnav import costs, objectives
from tests.conftest import grid_of

#: Three ways of 7, 11 and 15 m. People stand in the first two: their risks are 12, 9 and 0. No weighted sum of length
#: and risk likes the second best, though no way beats it: halfway between the others would be 11 m at a risk of 6.
BLIND_SPOT = grid_of("........", ".######.", "........", ".######.", "........")
PEOPLE = np.zeros(BLIND_SPOT.cells.shape)
PEOPLE[0, 1:7], PEOPLE[2, 1:7] = 2.0, 1.5
BLIND_PROBLEM = an.Problem.from_cells(BLIND_SPOT, (0, 0), (0, 7))
BLIND_OBJECTIVES = [objectives.Length(), objectives.Risk(costs.array(PEOPLE))]
BLIND_FRONT = [[7.0, 12.0], [11.0, 9.0], [15.0, 0.0]]


def drawn(side: int, seed: int, k: int) -> tuple[an.Problem, list[objectives.Objective]]:
    """A random map with k objectives that have little to do with each other."""
    grid = an.maps.generate("random", side, side, seed=seed, density=0.15)
    rng = np.random.default_rng(seed)
    fields = [costs.array(rng.integers(1, 9, grid.cells.shape).astype(float)) for _ in range(4)]
    asked: list[objectives.Objective] = [
        objectives.Length(),
        objectives.Risk(fields[0], name="first"),
        objectives.Turns(),
        objectives.Risk(fields[1], name="second"),
        objectives.Time(1.0, fields[2]),
    ]
    return an.Problem.from_cells(grid, *an.maps.ends(grid)), asked[:k]
