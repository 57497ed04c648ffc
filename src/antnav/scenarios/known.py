"""Known: the map as it is at a moment of a scenario, and as the robot knows it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from antnav.scenarios.scenario import Event
from antnav.world.cost import CostField
from antnav.world.grid import Cell, GridMap
from antnav.world.problem import CellIndex, Problem


class Noticed(NamedTuple):
    """What is news to the robot.

    Attributes
    ----------
    blocked, freed, priced : ndarray of int32, shape (k, 2)
        Row and column of cells that it learns are closed, free, of another price.
    prices : ndarray of float64, shape (k,)
        What each of the priced cells costs per metre now, on top of the problem's own cost.
    left_out : int
        1 where something stands on the robot's own cell, which is kept free.
    """

    blocked: NDArray[np.int32]
    freed: NDArray[np.int32]
    priced: NDArray[np.int32]
    prices: NDArray[np.float64]
    left_out: int

    @property
    def cells(self) -> int:
        """How many cells are news."""
        return len(self.blocked) + len(self.freed) + len(self.priced)


class Known:
    """Two maps of a moment: the true one, and what the robot has noticed of it.

    Parameters
    ----------
    problem : Problem
        The map at rest.
    sensor : int or None
        See `Scenario`. With one, the robot begins with a free map of the same size.
    """

    def __init__(self, problem: Problem, sensor: int | None) -> None:
        grid, self.sensor, self.resting = problem.grid, sensor, problem
        self._closed = ~problem.passable.ravel()
        self._prices = np.zeros(self._closed.size)
        self._cols = grid.cols
        if sensor is not None:
            free = GridMap(np.zeros(grid.shape, np.uint8), grid.resolution, grid.origin, grid.name)
            ends = (problem.start, problem.goal)
            self.resting = Problem(free, *ends, problem.corner_rule, cost=problem.cost, turning=problem.turning)
        self._at_first = ~self.resting.passable.ravel()
        self._noticed = self._at_first.copy()
        self._known_prices = np.zeros(self._closed.size)
        self._pending = np.empty(0, np.int64)

    def happen(self, event: Event) -> None:
        """Let an event change the true map."""
        blocked, freed, priced = map(self._numbers, (event.blocked, event.freed, event.priced))
        self._closed[blocked] = True
        self._closed[freed] = False
        self._prices[priced] = event.prices
        self._pending = np.unique(np.concatenate((self._pending, blocked, freed, priced)))

    def notice(self, robot: CellIndex) -> Noticed:
        """Let the robot see, from its cell, what it has not noticed yet; its own cell is never closed to it."""
        seen = self._pending if self.sensor is None else self._around(robot, self.sensor)
        own = robot[0] * self._cols + robot[1]
        blocked = seen[self._closed[seen] & ~self._noticed[seen] & (seen != own)]
        freed = seen[~self._closed[seen] & self._noticed[seen]]
        priced = seen[self._prices[seen] != self._known_prices[seen]]
        self._noticed[blocked], self._noticed[freed] = True, False
        self._known_prices[priced] = self._prices[priced]
        left_out = bool(self._closed[own])
        self._pending = np.array([own] if left_out else [], np.int64)
        return Noticed(
            self._places(blocked), self._places(freed), self._places(priced), self._prices[priced], int(left_out)
        )

    def is_closed(self, cell: CellIndex) -> bool:
        """Whether a cell is truly closed."""
        return bool(self._closed[cell[0] * self._cols + cell[1]])

    def price(self, cell: CellIndex) -> float:
        """What a cell truly costs per metre, on top of the problem's own cost."""
        return float(self._prices[cell[0] * self._cols + cell[1]])

    def grid(self, radius: float) -> GridMap:
        """The map as the robot knows it, made anew, for a robot of that radius."""
        grid = self.resting.grid
        other = np.where(self._noticed, np.uint8(Cell.OCCUPIED), np.uint8(Cell.FREE))
        cells = np.where(self._noticed == self._at_first, grid.cells.ravel(), other)
        return GridMap(cells.reshape(grid.shape), grid.resolution, grid.origin).inflated(radius)

    def cost(self) -> CostField | None:
        """What cells cost as the robot knows it; None where length is all."""
        field = self.resting.cost
        if not self._known_prices.any():
            return field
        prices = CostField(self._known_prices.reshape(self.resting.grid.shape))
        return prices if field is None else field + prices

    def _numbers(self, cells: NDArray[np.int32]) -> NDArray[np.int64]:
        return cells[:, 0].astype(np.int64) * self._cols + cells[:, 1]

    def _places(self, numbers: NDArray[np.int64]) -> NDArray[np.int32]:
        return np.stack(np.divmod(numbers, self._cols), axis=-1).astype(np.int32)

    def _around(self, robot: CellIndex, radius: int) -> NDArray[np.int64]:
        """Numbers of the cells within radius + 1/2 of a cell."""
        (row, col), (rows, cols) = robot, self.resting.grid.shape
        down = np.arange(max(row - radius, 0), min(row + radius + 1, rows))[:, None]
        aside = np.arange(max(col - radius, 0), min(col + radius + 1, cols))
        inside = (down - row) ** 2 + (aside - col) ** 2 <= radius * (radius + 1)
        found: NDArray[np.int64] = (down * cols + aside)[inside]
        return found
