"""Memory: the pheromone that a run leaves to others."""

from __future__ import annotations

from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from antnav.errors import ParameterError, check_type, shown
from antnav.kernels.graph import Graph
from antnav.values import finite_number, is_whole, read_only
from antnav.world.grid_graph import GridGraph

_REMEDY = "take result.memory of a run with remember=True"


class Memory(msgspec.Struct, frozen=True, eq=False):
    """Pheromone at the end of a run, by cells and moves: it fits any start, goal, corner rule and map of its shape.

    Attributes
    ----------
    shape : (int, int)
        Rows and columns of the map.
    flat : ndarray of int32, shape (n,)
        Each node's cell as an index in the flattened padded map, (row + 1) (cols + 2) + col + 1, in ascending order.
    tau : ndarray of float64, shape (n, 8)
        Pheromone of each edge, for ants from start to goal, in the unit of tau0; nan where no edge is known. Column k
        is the edge of move k, as in `Colony.tau`.
    tau0 : float
        Initial pheromone of the algorithm that ran, > 0.

    Raises
    ------
    ParameterError
        One of them is something else.
    """

    shape: tuple[int, int]
    flat: NDArray[np.int32]
    tau: NDArray[np.float64]
    tau0: float

    def __post_init__(self) -> None:
        self._check()
        read_only(self.flat)
        read_only(self.tau)

    def _check(self) -> None:
        for name in ("flat", "tau"):
            check_type(name, getattr(self, name), np.ndarray, _REMEDY)
        shape, flat, tau = self.shape, self.flat, self.tau
        pair = isinstance(shape, tuple) and len(shape) == 2
        if not pair or not all(is_whole(side) and side > 0 for side in shape):
            raise ParameterError(f"shape {shown(shape)}", "it is (rows, cols) of a map", _REMEDY)
        if flat.dtype != np.int32 or flat.ndim != 1 or not flat.size or (np.diff(flat) <= 0).any():
            raise ParameterError(f"flat {shown(flat)}", "it is ascending int32, one or more cells", _REMEDY)
        if flat[0] < 0 or flat[-1] >= (shape[0] + 2) * (shape[1] + 2):
            raise ParameterError(f"flat from {flat[0]} to {flat[-1]}", "its cells lie in the padded map", _REMEDY)
        if tau.dtype != np.float64 or tau.shape != (len(flat), 8):
            rule = f"it is float64 of shape ({len(flat)}, 8), a row for each cell of flat"
            raise ParameterError(f"tau of shape {tau.shape} and type {tau.dtype}", rule, _REMEDY)
        if (tau < 0).any() or np.isinf(tau).any():
            raise ParameterError("tau", "each value is finite and >= 0, or nan", _REMEDY)
        if not finite_number(self.tau0) > 0:
            raise ParameterError(f"tau0 {shown(self.tau0)}", "it is a number > 0", _REMEDY)

    def __reduce__(self) -> tuple[Any, ...]:  # pickled arrays come back open to writing
        return Memory, (self.shape, self.flat, self.tau, self.tau0)

    def __repr__(self) -> str:
        rows, cols = self.shape
        return f"Memory({len(self.flat)} of {rows} x {cols} cells, tau0 {self.tau0:g})"

    def on(self, grid_graph: GridGraph, tau0: float, least: float) -> NDArray[np.float64]:
        """Initial pheromone on a graph, shape (n, 8), scaled to that tau0, and tau0 where no edge is known.

        Parameters
        ----------
        least : float
            Lower bound of the pheromone.
        """
        place = np.minimum(np.searchsorted(self.flat, grid_graph.flat), len(self.flat) - 1)
        scaled = np.maximum(self.tau[place] * (tau0 / self.tau0), least)
        known = (self.flat[place] == grid_graph.flat)[:, None] & ~np.isnan(scaled)
        tau: NDArray[np.float64] = np.where(known, scaled, tau0)
        return tau


def turned(tau: NDArray[np.float64], graph: Graph) -> NDArray[np.float64]:
    """Pheromone for ants that walk the other way, shape (n, 8): each edge has that of its way back."""
    there = np.minimum(graph.neighbours, len(tau) - 1)  # where there is no edge, it means nothing
    back: NDArray[np.float64] = tau[there, graph.reverse]
    return back
