"""What exact replanners with memory share: they go on where they stood, and count costs in whole numbers."""

from __future__ import annotations

import math
from abc import abstractmethod
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from antnav.kernels.graph import SQRT2
from antnav.kernels.grid_kernels import Prices
from antnav.kernels.replan_kernels import FAR, GRAIN, Scale
from antnav.live.replanner import Path, Replanner
from antnav.live.terrain import LiveTerrain

_NOTHING = np.empty(0, np.int32)


class Incremental(Replanner):
    """A replanner that goes on with what it knows of a terrain and a goal, also where an end was closed for a while."""

    exact: ClassVar[bool] = True
    #: Grains by which bounds lie below the least cost of each move.
    less: ClassVar[int] = 0

    _terrain: LiveTerrain
    _goal: int
    _prices: Prices
    _scale: Scale
    _most: float  #: the largest price that can be counted
    _version = -1  #: of the terrain, as far as it has been told
    _unseen: NDArray[np.int32]  #: cells that the search has yet to look at

    def begin(self, terrain: LiveTerrain, start: int, goal: int) -> Path:
        """Go on, or search anew where it is another goal or terrain, or not all changes have been told."""
        told = self._version == terrain.version and self._terrain is terrain and self._prices is terrain.prices
        if not told or goal != self._goal:
            self._terrain, self._goal = terrain, goal
            self._anew(start)
        return self.changed(_NOTHING, start)

    def changed(self, cells: NDArray[np.int32], start: int) -> Path:
        """Mend what is known, as far as it is needed."""
        self.altered(cells)
        beyond = self._terrain.priced and bool((self._prices.cells[self._unseen] > self._most).any())
        if beyond or self._worn:
            self._anew(start)
        path = self._search(self._unseen, start)
        self._unseen = _NOTHING
        return path if path.size else None

    def moved(self, start: int) -> Path:
        """Search on."""
        return self.changed(_NOTHING, start)

    def altered(self, cells: NDArray[np.int32]) -> None:
        """Keep in mind what is to be mended."""
        if self._version < 0:
            return
        self._version = self._terrain.version
        self._unseen = np.concatenate((self._unseen, cells)) if self._unseen.size else cells

    @property
    def _worn(self) -> bool:
        """Whether numbers have grown so large that it is time to begin anew."""
        return False

    def _anew(self, start: int) -> None:
        terrain = self._terrain
        self._prices, self._version, self._unseen = terrain.prices, terrain.version, _NOTHING
        self._scale, self._most = scale_of(terrain, self.less)
        self._forget(start)

    @abstractmethod
    def _forget(self, start: int) -> None:
        """Know nothing but the goal."""

    @abstractmethod
    def _search(self, cells: NDArray[np.int32], start: int) -> NDArray[np.int32]:
        """Flat cells from start to goal, none where there is no way, after changes of some cells."""


def scale_of(terrain: LiveTerrain, less: int) -> tuple[Scale, float]:
    """How the costs of a terrain become grains, and the largest price with which that can go on.

    Parameters
    ----------
    terrain : LiveTerrain
    less : int
        Grains by which bounds lie below the least cost of each move.

    Notes
    -----
    A cost is rounded by less than 1e-9 of itself unless cells cost more than some thousands per metre: grains grow with
    the dearest cell then, so that a path of eight times a map's perimeter can be counted.
    """
    if not terrain.priced:
        spare = 62 - math.ceil(math.log2(SQRT2 * GRAIN * terrain.moves.size))
        return Scale(GRAIN, round(GRAIN) - less, round(SQRT2 * GRAIN) - less, spare), math.inf
    prices, moves = terrain.prices, 16 * sum(terrain.shape)
    climb = float(np.ptp(prices.heights)) if prices.heights.size else 0.0
    dearest = float(prices.cells.max()) + climb
    grain = min(GRAIN, 2.0 ** math.floor(math.log2(float(FAR) / (moves * dearest))))
    most = min(64 * dearest, float(FAR) / (moves * grain))
    spare = 62 - math.ceil(math.log2(moves * most * grain))
    least = prices.cheapest * grain
    return Scale(grain, int(least) - less, int(SQRT2 * least) - less, spare), most - climb
