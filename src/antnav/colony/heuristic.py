"""What a colony is given before the first ant walks: weights and pheromone, as arrays over the edges."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from antnav.colony.parameters import Settings
from antnav.colony.parts.ground import Ground
from antnav.colony.parts.places import at_neighbour
from antnav.kernels.graph import PlacedGraph

#: Floor of eta^beta: a weight that underflowed to 0 would look like a dead end.
LEAST = 1e-200


def heuristic_weights(algorithm: Settings, grid_graph: PlacedGraph, start: int, goal: int) -> NDArray[np.float64]:
    """eta_ij^beta for every edge.

    Parameters
    ----------
    algorithm : Settings
    grid_graph : PlacedGraph
    start, goal : int
        Nodes.

    Returns
    -------
    ndarray of float64, shape (n, 8), or (9 n, 8) for heuristics that depend on the last move
        0 where there is no neighbour. Row 9 i + d holds node i for an ant that came by slot d - 1, d = 0 for none.
    """
    eta = algorithm.heuristic.on_ground(Ground(grid_graph, start, goal, algorithm.tau0))
    weights = np.maximum(power(eta, algorithm.beta), LEAST)
    if weights.ndim == 1:
        weights = at_neighbour(grid_graph, weights, none=0.0)
    else:
        missing = grid_graph.graph.neighbours == len(grid_graph)
        np.copyto(weights, 0.0, where=missing if weights.ndim == 2 else missing[:, None])
    weights = weights.reshape(-1, 8)
    if algorithm.openness > 0:
        rows = algorithm.heuristic.headings
        exits = (grid_graph.graph.neighbours < len(grid_graph)).sum(axis=1) / 8.0
        weights *= np.repeat(at_neighbour(grid_graph, power(exits, algorithm.openness)), rows, axis=0)
    return weights


def initial_pheromone(algorithm: Settings, grid_graph: PlacedGraph, start: int, goal: int) -> NDArray[np.float64]:
    """Pheromone before the first iteration, shape (n, 8)."""
    return algorithm.initial.tau(algorithm.tau0, grid_graph, start, goal)


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
