"""A* anew after every change: what replanners with memory are measured against."""

from __future__ import annotations

from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from antnav.kernels import grid_kernels
from antnav.live.replanner import Path, Replanner
from antnav.live.terrain import LiveTerrain


class AStar(Replanner):
    """A* with the octile heuristic, whenever something has changed."""

    name: ClassVar[str] = "astar"
    exact: ClassVar[bool] = True
    source: ClassVar[str] = "Hart, Nilsson & Raphael 1968, doi 10.1109/TSSC.1968.300136"

    def begin(self, terrain: LiveTerrain, start: int, goal: int) -> Path:
        """Search."""
        self._terrain, self._goal = terrain, goal
        return self.moved(start)

    def changed(self, cells: NDArray[np.int32], start: int) -> Path:
        """Search."""
        return self.moved(start)

    def moved(self, start: int) -> Path:
        """Search."""
        terrain, goal = self._terrain, self._goal
        length, parent, _ = grid_kernels.search(terrain.moves, terrain.width, start, goal, True, terrain.prices)
        if not length[goal] < np.inf:
            return None
        path: NDArray[np.int32] = grid_kernels.trace(parent, terrain.width, start, goal)
        return path
