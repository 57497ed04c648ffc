"""Costs that come and go: plans with what a place will cost when the robot gets there."""

from __future__ import annotations

import copy
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from antnav.errors import ParameterError, check_type, shown
from antnav.kernels import grid_kernels
from antnav.kernels.graph import SQRT2
from antnav.live.astar import AStar
from antnav.live.replanner import Path, Replanner
from antnav.live.terrain import LiveTerrain
from antnav.values import finite_number

#: What a cell is thought to have been before it was watched: for so long, so great a share of it at its first other
#: price, and changing once in so long a time.
BEFORE, SHARE, QUIET = 20.0, 0.2, 400.0
#: Prices are told to the planner where they are others by more than this share.
TOLERANCE = 0.05

_NONE = np.empty(0, np.int32)


class CostMemory(Replanner):
    """A replanner with a memory of prices: near the robot those of now count, far from it what they are in the mean.

    A cell is watched from its first change of price on. Where the robot has t to go to it, it is planned with
    m + (p - m) exp(-t / T): p is its price, m the mean of what it was, and T the time in which a price loses its worth,
    learned from how often watched cells change. The mean is a trail of pheromone: what was laid down evaporates,
    m <- m + (1 - exp(-dt / evaporation)) (p - m) [ours].

    Time is what the robot has driven, in cells times price. Costs ought to be times, then. None passes while it stands.
    Prices count as those of now, so it is for robots that are told of every change, not only of those that they see.

    Parameters
    ----------
    planner : Replanner, optional
        What plans; default: A* anew. Its paths are the shortest for prices as they are expected, not as they are.
    evaporation : float
        Time after which 1/e of what was remembered is left, > 0.
    """

    name: ClassVar[str] = "cost_memory"
    exact: ClassVar[bool] = False
    source: ClassVar[str] = "antnav"

    def __init__(self, planner: Replanner | None = None, evaporation: float = 1000.0) -> None:
        number = finite_number(evaporation)
        if not number > 0:
            rule = "it is a time in cells times price, > 0"
            raise ParameterError(f"evaporation {shown(evaporation)}", rule, "give one, such as 1000")
        check_type("planner", planner, Replanner | None, "hand in one, such as antnav.live.dstar_lite.DStarLite()")
        self._planner, self._evaporation = AStar() if planner is None else planner, number
        self.certain = self._planner.certain
        self._true: LiveTerrain | None = None
        self._path: Path = None
        self._robot = 0

    def begin(self, terrain: LiveTerrain, start: int, goal: int) -> Path:
        """Plan anew; what is remembered of a terrain stays."""
        if self._true is not terrain or self._expected.prices.cells.size != terrain.prices.cells.size:
            self._forget(terrain)
        else:
            self._drive(start)
            self._planner.altered(self._expect(_NONE, start))
        self._robot = start
        self._path = self._planner.begin(self._expected, start, goal)
        return self._path

    def _forget(self, terrain: LiveTerrain) -> None:
        self._true = terrain
        self._expected = copy.copy(terrain)  # the same moves, prices of its own
        self._expected.prices = terrain.prices._replace(cells=terrain.prices.cells.copy())
        self._cells = _NONE  #: that are watched
        self._watched = np.zeros(terrain.moves.size, np.bool_)
        self._price, self._weight, self._sum, self._squares = np.empty((4, 0))
        self._jumps, self._seconds = 0.0, 0.0  #: squares of all changes, time that cells were watched

    def altered(self, cells: NDArray[np.int32]) -> None:
        """Watch what changes."""
        if self._true is not None and self._expected.priced == self._true.priced:
            self._planner.altered(np.union1d(cells, self._expect(cells, self._robot)))

    def changed(self, cells: NDArray[np.int32], start: int) -> Path:
        """Let the planner know what is expected now."""
        assert self._true is not None
        self._drive(start)
        self._robot = start
        expected = self._expect(cells, start)
        if len(cells):
            self._expected.opened = np.union1d(self._true.opened, self._expected.opened).astype(np.int32)
        self._path = self._planner.changed(np.union1d(cells, expected).astype(np.int32), start)
        return self._path

    def moved(self, start: int) -> Path:
        """Go on from there; other places are near."""
        return self.changed(_NONE, start)

    def improve(self, rounds: int) -> Path:
        """Leave it to the planner."""
        self._path = self._planner.improve(rounds)
        return self._path

    @property
    def improves(self) -> bool:
        """Whether the planner can."""
        return self._planner.improves

    def _drive(self, start: int) -> None:
        """Time has passed while the robot drove to where it is; watched cells had their prices."""
        terrain, path = self._true, self._path
        assert terrain is not None
        if path is None or start == self._robot:
            return
        at = np.flatnonzero(path == start)
        driven = path[: int(at[0]) + 1] if len(at) else np.array([self._robot, start], np.int32)
        passed = float(grid_kernels.cost_along(driven, terrain.width, terrain.prices))
        kept = np.exp(-passed / self._evaporation)
        amount = self._evaporation * (1 - kept)
        self._weight = kept * self._weight + amount
        self._sum = kept * self._sum + amount * self._price
        self._squares = kept * self._squares + amount * self._price**2
        self._seconds += passed * len(self._cells)

    def _watch(self, cells: NDArray[np.int32]) -> None:
        """Take in the prices of cells that may have changed."""
        terrain = self._true
        assert terrain is not None
        cells = np.unique(cells)
        now, before = terrain.prices.cells[cells], self._expected.prices.cells[cells]
        fresh = ~self._watched[cells] & (now != before)
        new, now, before = cells[fresh], now[fresh], before[fresh]
        jumps = terrain.prices.cells[self._cells] - self._price
        self._price = np.append(self._price + jumps, now)
        self._jumps += float((jumps**2).sum() + ((now - before) ** 2).sum())
        self._seconds += QUIET * len(new)
        self._weight = np.append(self._weight, np.full(len(new), BEFORE))
        self._sum = np.append(self._sum, BEFORE * ((1 - SHARE) * before + SHARE * now))
        self._squares = np.append(self._squares, BEFORE * ((1 - SHARE) * before**2 + SHARE * now**2))
        self._cells = np.append(self._cells, new).astype(np.int32)
        self._watched[new] = True

    def _expect(self, cells: NDArray[np.int32], start: int) -> NDArray[np.int32]:
        """Write into the terrain planned with what watched cells will cost. Returns those where that is another now."""
        terrain = self._expected
        terrain.opened = terrain.raised = _NONE
        if terrain.priced:
            self._watch(cells)
        if not len(self._cells):
            return _NONE
        mean = self._sum / self._weight
        spread = np.maximum(self._squares / self._weight - mean**2, 0).mean()
        lasting = 2 * spread * self._seconds / self._jumps
        rows = np.abs(self._cells // terrain.width - start // terrain.width)
        cols = np.abs(self._cells % terrain.width - start % terrain.width)
        away = np.maximum(rows, cols) + (SQRT2 - 1) * np.minimum(rows, cols)
        expected = mean + (self._price - mean) * np.exp(-away / max(lasting, 1e-9))
        expected = np.maximum(expected, terrain.prices.cheapest)
        before = terrain.prices.cells[self._cells]
        other = np.abs(expected - before) > TOLERANCE * before
        repriced: NDArray[np.int32] = self._cells[other]
        terrain.prices.cells[repriced] = expected[other]
        terrain.opened = self._cells[other & (expected < before)]
        terrain.raised = self._cells[other & (expected > before)]
        return repriced
