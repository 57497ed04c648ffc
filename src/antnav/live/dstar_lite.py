"""D* Lite: a search from the goal that is repaired, not made anew."""

from __future__ import annotations

from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from antnav.kernels import replan_kernels
from antnav.kernels.replan_kernels import FAR, SHIFT, Tree
from antnav.live.incremental import Incremental


class DStarLite(Incremental):
    """The optimised D* Lite: costs to the goal, kept right as far as the robot needs them; k_m for one that moves."""

    name: ClassVar[str] = "dstar_lite"
    source: ClassVar[str] = "Koenig & Likhachev 2005, doi 10.1109/TRO.2004.838026"
    less: ClassVar[int] = 1
    #: Whether a move of the robot gives all keys of the queue anew, instead of raising k_m.
    reorder: ClassVar[bool] = False

    @property
    def _worn(self) -> bool:
        return bool(self._tree.numbers[SHIFT] > FAR)

    def _forget(self, start: int) -> None:
        terrain = self._terrain
        self._tree = Tree(
            node=np.empty((terrain.moves.size, 4), np.int64),
            price=terrain.prices.cells.copy(),
            numbers=np.empty(4, np.int64),
        )
        self._keys, self._items = np.empty(4096, np.int64), np.empty(4096, np.int32)
        graph = terrain.width, terrain.prices, self._scale
        replan_kernels.root(self._tree, start, self._goal, *graph, self._keys, self._items)

    def _search(self, cells: NDArray[np.int32], start: int) -> NDArray[np.int32]:
        terrain = self._terrain
        graph = terrain.moves, terrain.width, terrain.prices, self._scale
        path: NDArray[np.int32]
        path, self._keys, self._items = replan_kernels.repair(
            *graph, self._tree, self._keys, self._items, cells, start, self.reorder
        )
        return path
