"""Heuristics: what a colony knows before the first ant walks, as an array over the edges."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from antnav.colony.parameters import Algorithm
from antnav.colony.parts import Heuristic, InitialPheromone
from antnav.errors import ParameterError
from antnav.kernels.graph import PlacedGraph
from antnav.world.moves import STEPS

#: Distance in cells that stands for 0 at the goal, so that 1/distance is finite [calibrated: 0.001 to 0.5 do alike].
AT_GOAL = 0.1
#: Distance in cells that stands for infinity, so that differences are numbers.
NOWHERE = 1e12
#: Floor of eta^beta: a weight that underflowed to 0 would look like a dead end.
LEAST = 1e-200
#: Angle in radians between the directions of two slots, shape (8, 8).
SLOT_ANGLES = np.array(
    [[abs(math.atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1])) for b in STEPS] for a in STEPS]
)


def heuristic_weights(algorithm: Algorithm, grid_graph: PlacedGraph, start: int, goal: int) -> NDArray[np.float64]:
    """eta_ij^beta for every edge.

    Parameters
    ----------
    algorithm : Algorithm
    grid_graph : PlacedGraph
    start, goal : int
        Nodes.

    Returns
    -------
    ndarray of float64, shape (n, 8), or (9 n, 8) for the heuristic `astar`
        0 where there is no neighbour. Row 9 i + d holds node i for an ant that came by slot d - 1, d = 0 for none.
    """
    weights = _guidance(algorithm, grid_graph, start, goal)
    if algorithm.openness > 0:
        exits = (grid_graph.graph.neighbours < len(grid_graph)).sum(axis=1) / 8.0
        factor = _at_neighbour(grid_graph, power(exits, algorithm.openness))
        weights *= np.repeat(factor, len(weights) // len(factor), axis=0)
    return weights


def _guidance(algorithm: Algorithm, grid_graph: PlacedGraph, start: int, goal: int) -> NDArray[np.float64]:
    """eta_ij^beta of the heuristic alone."""
    name = algorithm.heuristic
    if name is Heuristic.ASTAR:
        return _bending(algorithm, grid_graph, start, goal)
    if name not in ETA:
        rule = "every heuristic has its formula in `heuristic.ETA`; `auto` becomes another one in `Algorithm.on`"
        raise ParameterError(f"heuristic {name}", rule, "add the formula, or choose another heuristic")
    weights = np.maximum(power(ETA[name](grid_graph, goal), algorithm.beta), LEAST)
    if weights.ndim == 1:
        weights = _at_neighbour(grid_graph, weights)
    weights[grid_graph.graph.neighbours == len(grid_graph)] = 0.0
    return weights


def _edge(grid_graph: PlacedGraph, goal: int) -> NDArray[np.float64]:
    return 1.0 / grid_graph.graph.lengths


def _target(grid_graph: PlacedGraph, goal: int) -> NDArray[np.float64]:
    return 1.0 / np.maximum(_straight(grid_graph, goal), AT_GOAL)


def _sum(grid_graph: PlacedGraph, goal: int) -> NDArray[np.float64]:
    ahead = grid_graph.graph.lengths + _at_neighbour(grid_graph, _straight(grid_graph, goal))
    return 1.0 / np.maximum(ahead, AT_GOAL)


def _geodesic(grid_graph: PlacedGraph, goal: int) -> NDArray[np.float64]:
    return 1.0 / np.maximum(grid_graph.distances_to(goal), AT_GOAL)


def _detour(grid_graph: PlacedGraph, goal: int) -> NDArray[np.float64]:
    remaining = np.minimum(grid_graph.distances_to(goal), NOWHERE)
    extra = grid_graph.graph.lengths + _at_neighbour(grid_graph, remaining) - remaining[:, None]
    return 1.0 / (1.0 + np.maximum(extra, 0.0))


#: eta_ij of each heuristic that does not depend on the ant's last move; see `Heuristic` for the formulas. Shape (n, 8)
#: by edge, or (n,) where only the cell j matters that an edge leads to.
ETA: dict[Heuristic, Callable[[PlacedGraph, int], NDArray[np.float64]]] = {
    Heuristic.EDGE: _edge,
    Heuristic.TARGET: _target,
    Heuristic.SUM: _sum,
    Heuristic.GEODESIC: _geodesic,
    Heuristic.DETOUR: _detour,
}


def _bending(algorithm: Algorithm, grid_graph: PlacedGraph, start: int, goal: int) -> NDArray[np.float64]:
    """Q2 / (h + g + bend), bend = phi turn + psi theta (Dai et al. 2019, doi 10.3389/fnbot.2019.00015).

    [reconstruction]
    """
    distance = _straight(grid_graph, goal)
    if algorithm.bend_with_start:
        distance = distance + _straight(grid_graph, start)
    ahead = _at_neighbour(grid_graph, distance)
    bend = np.zeros((9, 8))
    bend[1:] = algorithm.bend_turn * (SLOT_ANGLES > 0) + algorithm.bend_angle * SLOT_ANGLES
    cost = np.maximum(ahead[:, None, :] + bend, AT_GOAL)
    weights = np.maximum(power(algorithm.q2 / cost, algorithm.beta), LEAST)
    weights *= (grid_graph.graph.neighbours < len(grid_graph))[:, None, :]
    return np.ascontiguousarray(weights.reshape(-1, 8))


def initial_pheromone(algorithm: Algorithm, grid_graph: PlacedGraph, start: int, goal: int) -> NDArray[np.float64]:
    """Pheromone before the first iteration, shape (n, 8).

    `unequal`: tau0_ij = tau0 (1 + w d_SG / (d_Sj + d_jG)), the mean of both ends' values for an edge, so that it is the
    same in both directions (after Luo et al. 2020) [reconstruction].
    """
    shape = grid_graph.graph.neighbours.shape
    if algorithm.initial is InitialPheromone.UNIFORM:
        return np.full(shape, float(algorithm.tau0))
    detour = _straight(grid_graph, start) + _straight(grid_graph, goal)
    at_node = 1.0 + algorithm.initial_weight * detour[start] / detour
    tau: NDArray[np.float64] = algorithm.tau0 * (at_node[:, None] + _at_neighbour(grid_graph, at_node)) / 2.0
    return tau


def power(base: NDArray[np.float64], exponent: float) -> NDArray[np.float64]:
    """Base ** exponent; by multiplications alone where the exponent is whole, so that every machine agrees."""
    whole = int(exponent)
    if whole != exponent:
        powers: NDArray[np.float64] = np.power(base, exponent)
        return powers
    result: NDArray[np.float64] = np.ones_like(base)
    square: NDArray[np.float64] = base
    while whole:
        if whole & 1:
            result = result * square
        whole >>= 1
        if whole:
            square = square * square
    return result


def _straight(grid_graph: PlacedGraph, goal: int) -> NDArray[np.float64]:
    """Straight distance in cells from every node to the goal, by sqrt alone: hypot differs between machines."""
    rows, cols = (grid_graph.cells - grid_graph.cells[goal]).T.astype(np.float64)
    distance: NDArray[np.float64] = np.sqrt(rows * rows + cols * cols)
    return distance


def _at_neighbour(grid_graph: PlacedGraph, values: NDArray[np.float64], none: float = 1.0) -> NDArray[np.float64]:
    """Value of a node, seen from each of its neighbours: shape (n, 8), `none` where there is no neighbour."""
    seen: NDArray[np.float64] = np.append(values, none)[grid_graph.graph.neighbours]
    return seen
