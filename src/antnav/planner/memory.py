"""Memory: the pheromone and the paths that a run leaves to others."""

from __future__ import annotations

import os
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from antnav.errors import ParameterError, check_type, shown
from antnav.kernels.graph import Graph
from antnav.values import finite_number, is_whole, read_only
from antnav.world.grid_graph import GridGraph

#: Paths that a memory keeps of the latest run, and of the runs before it.
PATHS, EARLIER = 10, 10
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
    paths : tuple of ndarray of int32, each of shape (k,)
        Of the latest run: its best path, then others of its last iteration, the cheapest first; flat cells like `flat`.
    earlier : tuple of ndarray of int32
        Best paths of the runs before it, the latest first.

    Raises
    ------
    ParameterError
        One of them is something else.
    """

    shape: tuple[int, int]
    flat: NDArray[np.int32]
    tau: NDArray[np.float64]
    tau0: float
    paths: tuple[NDArray[np.int32], ...] = ()
    earlier: tuple[NDArray[np.int32], ...] = ()

    def __post_init__(self) -> None:
        self._check()
        read_only(self.tau)
        for cells in (self.flat, *self.paths, *self.earlier):
            read_only(cells)

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
        for name in ("paths", "earlier"):
            check_type(name, getattr(self, name), tuple, _REMEDY)
            for path in getattr(self, name):
                self._check_path(name, path)

    def _check_path(self, name: str, path: NDArray[np.int32]) -> None:
        rows, cols = self.shape
        check_type(name, path, np.ndarray, _REMEDY)
        cells = path.dtype == np.int32 and path.ndim == 1 and path.size > 0
        if not cells or path.min() < 0 or path.max() >= (rows + 2) * (cols + 2):
            raise ParameterError(f"{name} {shown(path)}", "each is a row of int32 cells of the padded map", _REMEDY)

    def __reduce__(self) -> tuple[Any, ...]:  # pickled arrays come back open to writing
        return Memory, (self.shape, self.flat, self.tau, self.tau0, self.paths, self.earlier)

    def __repr__(self) -> str:
        rows, cols = self.shape
        paths = f", {count} path{'s' * (count != 1)}" if (count := len(self.paths)) else ""
        return f"Memory({len(self.flat)} of {rows} x {cols} cells, tau0 {self.tau0:g}{paths})"

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

    @property
    def pheromone(self) -> NDArray[np.float32]:
        """Mean pheromone of each cell's edges, shape (rows, cols), nan where none is known, as `Result.pheromone`."""
        rows, cols = self.shape
        known = ~np.isnan(self.tau)
        count = known.sum(axis=1)
        field = np.full((rows + 2) * (cols + 2), np.nan, np.float32)
        total = np.where(known, self.tau, 0.0).sum(axis=1)
        field[self.flat[count > 0]] = total[count > 0] / count[count > 0]
        return field.reshape(rows + 2, cols + 2)[1:-1, 1:-1]

    def cleared(self) -> Memory:
        """Memory of the same cells that knows no pheromone and no path."""
        return Memory(self.shape, self.flat, np.full(self.tau.shape, np.nan), self.tau0)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write it as an .npz file, whole or not at all.

        Raises
        ------
        OutputError
            The file cannot be written.
        """
        from antnav.planner.memory_file import write

        write(msgspec.structs.asdict(self), path)

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Memory:
        """Read what `save` has written. Nothing is unpickled.

        Raises
        ------
        ResultFormatError
            The file cannot be read, is something else or damaged.
        """
        from antnav.planner.memory_file import read

        return read(path, cls)


def turned(tau: NDArray[np.float64], graph: Graph) -> NDArray[np.float64]:
    """Pheromone for ants that walk the other way, shape (n, 8): each edge has that of its way back."""
    there = np.minimum(graph.neighbours, len(tau) - 1)  # where there is no edge, it means nothing
    back: NDArray[np.float64] = tau[there, graph.reverse]
    return back
