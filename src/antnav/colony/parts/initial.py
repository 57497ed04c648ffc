"""Initial pheromone: what lies on the edges before the first iteration."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from antnav.colony.parts import names
from antnav.colony.parts.parameter import parameter
from antnav.colony.parts.part import Part
from antnav.colony.parts.places import at_neighbour, straight
from antnav.kernels.graph import PlacedGraph
from antnav.planner.facts import Basis


class InitialPart(Part):
    """An initial pheromone."""

    def tau(self, tau0: float, grid_graph: PlacedGraph, start: int, goal: int) -> NDArray[np.float64]:
        """Pheromone of every edge, shape (n, 8)."""
        raise NotImplementedError


class Uniform(InitialPart):
    """tau0 everywhere [paper]."""

    name, basis = names.InitialPheromone.UNIFORM, Basis.PAPER

    def tau(self, tau0: float, grid_graph: PlacedGraph, start: int, goal: int) -> NDArray[np.float64]:
        """tau0."""
        return np.full(grid_graph.graph.neighbours.shape, float(tau0))


class Unequal(InitialPart):
    """More on the way: tau0 (1 + w d_SG / (d_Sj + d_jG)) (Luo et al.) [reconstruction].

    Parameters
    ----------
    initial_weight : float
        w.
    """

    name, basis = names.InitialPheromone.UNEQUAL, Basis.RECONSTRUCTION

    initial_weight: float = parameter(1.0, most=1e6, sane=(0, 5), symbol="w", certainty=Basis.CALIBRATED)

    def tau(self, tau0: float, grid_graph: PlacedGraph, start: int, goal: int) -> NDArray[np.float64]:
        """The mean of both ends' values for an edge, so that it is the same in both directions."""
        detour = straight(grid_graph, start) + straight(grid_graph, goal)
        at_node = 1.0 + self.initial_weight * detour[start] / detour
        tau: NDArray[np.float64] = tau0 * (at_node[:, None] + at_neighbour(grid_graph, at_node)) / 2.0
        return tau
