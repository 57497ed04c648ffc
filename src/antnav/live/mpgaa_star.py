"""MPGAA*: A* whose lower bounds learn, and which ends where it meets an earlier path that still holds."""

from __future__ import annotations

from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from antnav.kernels import replan_kernels
from antnav.kernels.replan_kernels import Guide
from antnav.live.incremental import Incremental


class MPGAAStar(Incremental):
    """Multipath Generalized Adaptive A*: bounds are raised by each search, and lowered again where a way has opened."""

    name: ClassVar[str] = "mpgaa_star"
    source: ClassVar[str] = "Hernandez, Asin & Baier, AAAI 2015"

    def _forget(self, start: int) -> None:
        size = self._terrain.moves.size
        self._guide = Guide(
            g=np.empty(size, np.int64),
            h=np.empty(size, np.int64),
            seen=np.empty(size, np.int32),
            parent=np.empty(size, np.uint8),
            following=np.empty(size, np.uint8),
            order=np.empty(size, np.int32),
            numbers=np.empty(3, np.int64),
        )
        self._keys, self._items = np.empty(4096, np.int64), np.empty(4096, np.int32)
        replan_kernels.aim(self._guide, self._goal)

    def _search(self, cells: NDArray[np.int32], start: int) -> NDArray[np.int32]:
        terrain = self._terrain
        graph = terrain.moves, terrain.width, terrain.prices, self._scale
        path: NDArray[np.int32]
        path, self._keys, self._items = replan_kernels.adapt(*graph, self._guide, self._keys, self._items, cells, start)
        return path
