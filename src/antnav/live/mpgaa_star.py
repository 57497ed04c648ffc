"""MPGAA*: A* whose lower bounds learn, and which ends where it meets an earlier path that still holds."""

from __future__ import annotations

from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from antnav.kernels import replan_kernels
from antnav.kernels.replan_kernels import Guide
from antnav.live.grains import NOTHING, scale_of
from antnav.live.replanner import Path, Replanner
from antnav.live.terrain import LiveTerrain


class MPGAAStar(Replanner):
    """Multipath Generalized Adaptive A*: bounds are raised by each search, and lowered again where a way has opened."""

    name: ClassVar[str] = "mpgaa_star"
    exact: ClassVar[bool] = True
    source: ClassVar[str] = "Hernandez, Asin & Baier 2015, doi 10.1609/aaai.v29i1.9362"

    def begin(self, terrain: LiveTerrain, start: int, goal: int) -> Path:
        """Search, with the octile distance as the bound."""
        size = terrain.moves.size
        self._terrain, self._goal = terrain, goal
        self._scale, self._limit = scale_of(terrain)
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
        replan_kernels.aim(self._guide, goal)
        return self.moved(start)

    def changed(self, cells: NDArray[np.int32], start: int) -> Path:
        """Lower the bounds where a way has opened, then search."""
        terrain = self._terrain
        if terrain.priced and bool((terrain.prices.cells[cells] > self._limit).any()):
            return self.begin(terrain, start, self._goal)
        graph = terrain.moves, terrain.width, terrain.prices, self._scale
        path, self._keys, self._items = replan_kernels.adapt(*graph, self._guide, self._keys, self._items, cells, start)
        return path if path.size else None

    def moved(self, start: int) -> Path:
        """Search."""
        return self.changed(NOTHING, start)
