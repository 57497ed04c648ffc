"""Distances on a graph whose nodes have places, as formulas of parts need them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from antnav.kernels.graph import PlacedGraph


def straight(grid_graph: PlacedGraph, goal: int) -> NDArray[np.float64]:
    """Straight distance in cells from every node to the goal, by sqrt alone: hypot differs between machines."""
    rows, cols = (grid_graph.cells - grid_graph.cells[goal]).T.astype(np.float64)
    distance: NDArray[np.float64] = np.sqrt(rows * rows + cols * cols)
    return distance


def at_neighbour(grid_graph: PlacedGraph, values: NDArray[np.float64], none: float = 1.0) -> NDArray[np.float64]:
    """Value of a node, seen from each of its neighbours: shape (n, 8), `none` where there is no neighbour."""
    seen: NDArray[np.float64] = np.concatenate((values, (none,))).take(grid_graph.graph.neighbours)
    return seen
