"""Heuristics: what a colony knows before the first ant walks, as an array over the edges."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from antnav.colony.parts import Heuristic
from antnav.problem import GridGraph

#: Distance in cells that stands for 0 at the goal, so that 1/distance is finite [calibrated: 0.001 to 0.5 do alike].
AT_GOAL = 0.1
#: Floor of eta^beta: a weight that underflowed to 0 would look like a dead end.
LEAST = 1e-200


def heuristic_weights(name: Heuristic, grid_graph: GridGraph, goal: int, beta: float) -> NDArray[np.float64]:
    """eta_ij^beta for every edge.

    Parameters
    ----------
    name : Heuristic
    grid_graph : GridGraph
    goal : int
        Node of the goal.
    beta : float

    Returns
    -------
    ndarray of float64, shape (n, 8)
        0 where there is no neighbour.
    """
    graph = grid_graph.graph
    if name in {Heuristic.TARGET, Heuristic.GEODESIC}:
        distance = _straight(grid_graph, goal) if name is Heuristic.TARGET else grid_graph.distances_to(goal)
        at_node = np.maximum(power(1.0 / np.maximum(distance, AT_GOAL), beta), LEAST)
        return _at_neighbour(grid_graph, at_node, none=0.0)
    if name is Heuristic.EDGE:
        weights = power(1.0 / graph.lengths, beta)
    elif name is Heuristic.SUM:
        weights = power(1.0 / (graph.lengths + _at_neighbour(grid_graph, _straight(grid_graph, goal))), beta)
    else:
        remaining = grid_graph.distances_to(goal)
        extra = graph.lengths + _at_neighbour(grid_graph, remaining) - remaining[:, None]
        weights = power(1.0 / (1.0 + np.maximum(extra, 0.0)), beta)
    np.maximum(weights, LEAST, out=weights)
    weights[graph.neighbours == len(graph.neighbours)] = 0.0
    return weights


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


def _straight(grid_graph: GridGraph, goal: int) -> NDArray[np.float64]:
    """Straight distance in cells from every node to the goal, by sqrt alone: hypot differs between machines."""
    rows, cols = (grid_graph.cells - grid_graph.cells[goal]).T.astype(np.float64)
    distance: NDArray[np.float64] = np.sqrt(rows * rows + cols * cols)
    return distance


def _at_neighbour(grid_graph: GridGraph, values: NDArray[np.float64], none: float = 1.0) -> NDArray[np.float64]:
    """Value of a node, seen from each of its neighbours: shape (n, 8), `none` where there is no neighbour."""
    seen: NDArray[np.float64] = np.append(values, none)[grid_graph.graph.neighbours]
    return seen
