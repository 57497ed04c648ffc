"""Pheromone as shades, against NumPy."""

from __future__ import annotations

import numpy as np
import pytest

import antnav as an
from antnav.kernels.view_kernels import shade
from antnav.maps import generate
from antnav.world.problem import Problem


@pytest.mark.parametrize("seed", range(5))
def test_shades_are_those_of_numpy(seed):
    grid = generate("caves", 30, 40, seed=seed)
    free = np.argwhere(grid.cells == 0)
    problem = Problem.from_cells(grid, tuple(free[0].tolist()), tuple(free[-1].tolist()), corner_rule="allow")
    colony = an.Colony(problem, an.npaco(), seed=seed)
    colony.step(3)
    graph, neighbours = problem.graph, problem.graph.graph.neighbours
    found = np.zeros(grid.shape, np.uint8)
    shade(colony.tau, neighbours, graph.cells, 0.01, found)
    tau = np.where(neighbours < len(graph), colony.tau, 0.0).max(axis=1)
    low, high = max(np.median(tau), tau.max() / 100), tau.max()
    wanted = np.zeros(grid.shape)
    wanted[tuple(graph.cells.T)] = 255 * np.log(np.clip(tau, low, high) / low) / np.log(high / low)
    assert found.max() >= 254
    np.testing.assert_allclose(found, wanted, atol=1)
    before = found.copy()
    shade(np.full_like(colony.tau, 2.0), neighbours, graph.cells, 0.01, found)  # even pheromone: nothing to see
    np.testing.assert_array_equal(found, before)
