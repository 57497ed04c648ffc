"""Heuristics: what draws an ant from cell i to its neighbour j, eta_ij of eq. (3.1), as an array over the edges."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from antnav.colony.parts import names
from antnav.colony.parts.blocks import estimated_costs
from antnav.colony.parts.ground import Ground
from antnav.colony.parts.parameter import parameter
from antnav.colony.parts.part import Part, Share
from antnav.colony.parts.places import at_neighbour, straight
from antnav.errors import ParameterError
from antnav.kernels.graph import SQRT2, PlacedGraph
from antnav.planner.facts import Basis, Knows
from antnav.world.moves import SLOT_ANGLES

if TYPE_CHECKING:
    from antnav.colony.parameters import Settings

#: Distance in cells that stands for 0 at the goal, so that 1/distance is finite [calibrated: 0.001 to 0.5 do alike].
AT_GOAL = 0.1
#: Distance in cells that stands for infinity, so that differences are numbers.
NOWHERE = 1e12
#: Longer side in cells up to which the heuristic "auto" is `target`: the paper's range. At 50 cells its median gap is
#: 17-53 % on generated maps, at 100 cells 118-210 %.
LARGEST_TARGET_SIDE = 40


class HeuristicPart(Part):
    """A heuristic, with its formula."""

    headings = 1  #: rows of weights a cell: 9 where they depend on the ant's last move
    estimates = ""  #: what it works out beforehand, short of exact distances, as its certainty says it

    def eta(self, grid_graph: PlacedGraph, start: int, goal: int) -> NDArray[np.float64]:
        """eta_ij.

        Returns
        -------
        ndarray of float64
            Shape (n, 8) by edge; (n,) where only the cell j matters that an edge leads to; (n, 9, 8) by the ant's last
            move, 0 for none, else 1 + slot.

        Raises
        ------
        ParameterError
            It has no formula.
        """
        rule = "every heuristic has its formula in `eta`; `auto` becomes another one in `Algorithm.suited`"
        raise ParameterError(f"heuristic {self}", rule, "add the formula, or choose another heuristic")

    def on_ground(self, ground: Ground) -> NDArray[np.float64]:
        """The same, of what a user's formula sees."""
        return self.eta(ground.placed, ground.start, ground.goal)

    def share(self, schedule: int) -> Share:
        """Whether weights depend on the last move."""
        return {"headings": self.headings}


class Auto(HeuristicPart):
    """`target` on maps of up to 40 cells a side, where cells cost `blocks`; `detour` on larger ones [calibrated].

    On larger maps `target` gets lost; of costs it knows nothing.
    """

    name, basis = names.Heuristic.AUTO, Basis.CALIBRATED

    def on(self, side: int, algorithm: Settings, *, dear: bool) -> HeuristicPart:
        """The heuristic for this map; on a graph of regions always `Detour`."""
        if side > LARGEST_TARGET_SIDE or algorithm.coarse:
            return Detour()
        return Blocks() if dear else Target()


class Edge(HeuristicPart):
    """1 / d_ij: eq. (3.2) taken literally [paper]."""

    name, basis = names.Heuristic.EDGE, Basis.PAPER
    no_regions = "edges inside a region have length 0"

    def eta(self, grid_graph: PlacedGraph, start: int, goal: int) -> NDArray[np.float64]:
        """By edge."""
        return 1.0 / grid_graph.graph.lengths


class Target(HeuristicPart):
    """1 / straight distance from j to the goal [calibrated]."""

    name, basis = names.Heuristic.TARGET, Basis.CALIBRATED

    def eta(self, grid_graph: PlacedGraph, start: int, goal: int) -> NDArray[np.float64]:
        """By cell."""
        return 1.0 / np.maximum(straight(grid_graph, goal), AT_GOAL)


class Sum(HeuristicPart):
    """1 / (d_ij + straight distance from j to the goal); common in the literature [source]."""

    name, basis = names.Heuristic.SUM, Basis.SOURCE

    def eta(self, grid_graph: PlacedGraph, start: int, goal: int) -> NDArray[np.float64]:
        """By edge."""
        ahead = grid_graph.graph.lengths + at_neighbour(grid_graph, straight(grid_graph, goal))
        return 1.0 / np.maximum(ahead, AT_GOAL)


class Geodesic(HeuristicPart):
    """1 / true remaining length from j, from an exact backward search [ours]."""

    name, basis, knows = names.Heuristic.GEODESIC, Basis.OURS, Knows.TO_GOAL

    def eta(self, grid_graph: PlacedGraph, start: int, goal: int) -> NDArray[np.float64]:
        """By cell."""
        return 1.0 / np.maximum(grid_graph.distances_to(goal), AT_GOAL)


class Detour(HeuristicPart):
    """1 / (1 + d_ij + G_j - G_i), G the true remaining length: guides at any distance [ours]."""

    name, basis, knows = names.Heuristic.DETOUR, Basis.OURS, Knows.TO_GOAL

    def eta(self, grid_graph: PlacedGraph, start: int, goal: int) -> NDArray[np.float64]:
        """By edge."""
        return _by_detour(grid_graph, grid_graph.distances_to(goal))


class Blocks(HeuristicPart):
    """1 / (1 + d_ij + G_j - G_i), G the remaining cost as estimated on a coarser map [ours].

    It respects walls and costs that are wider than a block, and knows no exact distance.

    Parameters
    ----------
    block : int
        Side of a block in cells.
    """

    name, basis = names.Heuristic.BLOCKS, Basis.OURS
    no_regions = "regions are blocks themselves"
    estimates = "it estimates the remaining costs on a coarser map"

    block: int = parameter(2, least=2, most=64, sane=(2, 4), certainty=Basis.OURS)

    def eta(self, grid_graph: PlacedGraph, start: int, goal: int) -> NDArray[np.float64]:
        """By edge."""
        return _by_detour(grid_graph, estimated_costs(grid_graph, goal, self.block))


class Octile(HeuristicPart):
    """1 / (1 + d_ij + h_j - h_i), h the octile distance to the goal, as if there were no walls [ours].

    It draws ants as firmly from afar as from near, which `target` does not.
    """

    name, basis = names.Heuristic.OCTILE, Basis.OURS

    def eta(self, grid_graph: PlacedGraph, start: int, goal: int) -> NDArray[np.float64]:
        """By edge."""
        rows, cols = np.abs(grid_graph.cells - grid_graph.cells[goal]).T.astype(np.float64)
        return _by_detour(grid_graph, np.maximum(rows, cols) + (SQRT2 - 1.0) * np.minimum(rows, cols))


def _by_detour(grid_graph: PlacedGraph, remaining: NDArray[np.float64]) -> NDArray[np.float64]:
    remaining = np.minimum(remaining, NOWHERE)
    extra = grid_graph.graph.lengths + at_neighbour(grid_graph, remaining) - remaining[:, None]
    eta: NDArray[np.float64] = 1.0 / (1.0 + np.maximum(extra, 0.0))
    return eta


class Astar(HeuristicPart):
    """Q2 / (h + bend), h from j to the goal, bend by the last direction (Dai et al.) [reconstruction].

    bend = phi turn + psi theta; doi 10.3389/fnbot.2019.00015

    Parameters
    ----------
    bend_turn, bend_angle : float
        phi, for each turn, and psi, by radian.
    bend_with_start : bool
        Whether to add g, the straight distance to the start: with g the map is almost flat.
    q2 : float
        Q2.
    """

    name, basis = names.Heuristic.ASTAR, Basis.RECONSTRUCTION
    no_regions = "edges between regions have no direction"
    headings = 9

    bend_turn: float = parameter(2.0, most=1e6, sane=(0, 5), symbol="phi", certainty=Basis.PAPER)
    bend_angle: float = parameter(10.0 / math.pi, most=1e6, sane=(0, 5), symbol="psi", certainty=Basis.PAPER)
    bend_with_start: bool = parameter(False, certainty=Basis.CALIBRATED)
    q2: float = parameter(1.5, most=1e6, above=True, symbol="Q2", certainty=Basis.PAPER)

    def eta(self, grid_graph: PlacedGraph, start: int, goal: int) -> NDArray[np.float64]:
        """By the last move."""
        distance = straight(grid_graph, goal)
        if self.bend_with_start:
            distance = distance + straight(grid_graph, start)
        ahead = at_neighbour(grid_graph, distance)
        bend = np.zeros((9, 8))
        bend[1:] = self.bend_turn * (SLOT_ANGLES > 0) + self.bend_angle * SLOT_ANGLES
        cost = np.maximum(ahead[:, None, :] + bend, AT_GOAL)
        eta: NDArray[np.float64] = self.q2 / cost
        return eta
