"""D* Lite: a search from the goal that is repaired, not made anew."""

from __future__ import annotations

from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from antnav.kernels import replan_kernels
from antnav.kernels.replan_kernels import FAR, SHIFT, Tree
from antnav.live.grains import NOTHING, scale_of
from antnav.live.replanner import Path, Replanner
from antnav.live.terrain import LiveTerrain


class DStarLite(Replanner):
    """The optimised D* Lite: costs to the goal, kept right as far as the robot needs them; k_m for one that moves."""

    name: ClassVar[str] = "dstar_lite"
    exact: ClassVar[bool] = True
    source: ClassVar[str] = "Koenig & Likhachev 2005, doi 10.1109/TRO.2004.838026"
    #: Whether a move of the robot gives all keys of the queue anew, instead of raising k_m.
    reorder: ClassVar[bool] = False

    def begin(self, terrain: LiveTerrain, start: int, goal: int) -> Path:
        """Search from the goal to the robot."""
        size = terrain.moves.size
        self._terrain, self._goal = terrain, goal
        self._scale, self._limit = scale_of(terrain, less=1)
        self._tree = Tree(
            node=np.empty((size, 4), np.int64),
            price=terrain.prices.cells.copy(),
            numbers=np.empty(4, np.int64),
        )
        self._keys, self._items = np.empty(4096, np.int64), np.empty(4096, np.int32)
        graph = terrain.width, terrain.prices, self._scale
        replan_kernels.root(self._tree, start, goal, *graph, self._keys, self._items)
        return self.moved(start)

    def changed(self, cells: NDArray[np.int32], start: int) -> Path:
        """Repair what the changes touch and the robot needs."""
        terrain, tree = self._terrain, self._tree
        outgrown = terrain.priced and bool((terrain.prices.cells[cells] > self._limit).any())
        if outgrown or tree.numbers[SHIFT] > FAR:
            return self.begin(terrain, start, self._goal)
        graph = terrain.moves, terrain.width, terrain.prices, self._scale
        path, self._keys, self._items = replan_kernels.repair(
            *graph, tree, self._keys, self._items, cells, start, self.reorder
        )
        return path if path.size else None

    def moved(self, start: int) -> Path:
        """Repair what the robot needs."""
        return self.changed(NOTHING, start)
