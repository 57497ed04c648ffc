"""View: how a colony stands, as arrays that nobody may write to."""

from __future__ import annotations

from enum import IntEnum

import msgspec
import numpy as np
from numpy.typing import NDArray

from antnav.kernels import ant_kernels


class Fate(IntEnum):
    """What became of an ant in the last iteration.

    - WALKING: it has not begun
    - ARRIVED: it reached its goal
    - DEAD: it met a dead end that it did not leave
    """

    WALKING = ant_kernels.WALKING
    ARRIVED = ant_kernels.ARRIVED
    DEAD = ant_kernels.DEAD


class View(msgspec.Struct, frozen=True, eq=False):
    """A colony after an iteration. Its arrays are the colony's own: copy what must outlast the call.

    Attributes
    ----------
    iteration : int
        t, iterations done.
    cells : ndarray of int64, shape (n, 2)
        (row, col) of each node.
    neighbours : ndarray of int32, shape (n, 8)
        Node at the end of each edge; n where there is none.
    tau : ndarray of float64, shape (n, 8)
        Pheromone of each edge; means nothing where there is none.
    order : ndarray of int64, shape (arrived,)
        Ants that arrived, the cheapest path first.
    lengths : ndarray of float64, shape (m,)
        Cost of each ant's path, which is length where the problem has no costs; means nothing where it did not arrive.
    fates : ndarray of uint8, shape (m,)
        A `Fate` for each ant.
    steps : ndarray of int64, shape (m,)
        Moves that each ant's path has.
    paths : ndarray of int32, shape (m, n)
        Nodes of each ant's path: see `path`.
    best : ndarray of int32
        Nodes of the best path so far; empty before the first.
    best_length : float
        Its cost, as of `lengths`; inf before the first.
    """

    iteration: int
    cells: NDArray[np.int64]
    neighbours: NDArray[np.int32]
    tau: NDArray[np.float64]
    order: NDArray[np.int64]
    lengths: NDArray[np.float64]
    fates: NDArray[np.uint8]
    steps: NDArray[np.int64]
    paths: NDArray[np.int32]
    best: NDArray[np.int32]
    best_length: float

    def path(self, ant: int) -> NDArray[np.int32]:
        """Nodes of an ant's path, from its start to where it arrived or died."""
        return self.paths[ant, : self.steps[ant] + 1]
