"""Ground: where things may happen on a map, and near the way that the robot would take."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from antnav.search.exact import shortest_path
from antnav.world.problem import CellIndex, Problem

#: Places tried near the way before one on it is taken.
_TRIES = 30


@dataclass(frozen=True)
class Ground:
    """A problem at rest, and for how many ticks how fast a robot crosses it.

    Attributes
    ----------
    problem : Problem
    ticks : int
    speed : int
        Moves of the robot in a tick.
    """

    problem: Problem
    ticks: int
    speed: int

    @cached_property
    def reached(self) -> NDArray[np.int64]:
        """Cells that the robot can reach, by number."""
        return np.flatnonzero(self.problem.reachable)

    @cached_property
    def way(self) -> NDArray[np.int32]:
        """The cheapest path at rest, shape (k, 2); no cells where there is none."""
        path = shortest_path(self.problem, "astar").path
        return np.empty((0, 2), np.int32) if path is None else path.cells

    def spot(self, rng: np.random.Generator, *, near_way: bool, reach: int) -> CellIndex:
        """A cell that the robot can reach: at most `reach` rows and columns from its way, or anywhere."""
        rows, cols = self.problem.grid.shape
        if near_way and len(self.way):
            on_way = self.way[int(rng.integers(len(self.way)))]
            for _ in range(_TRIES):
                row, col = (on_way + rng.integers(-reach, reach + 1, 2)).tolist()
                if 0 <= row < rows and 0 <= col < cols and self.problem.reachable[row, col]:
                    return row, col
            return int(on_way[0]), int(on_way[1])
        row, col = divmod(int(self.reached[int(rng.integers(len(self.reached)))]), cols)
        return row, col

    def disc(self, cell: CellIndex, radius: int) -> NDArray[np.int64]:
        """Numbers of the passable cells within radius + 1/2 of a cell, measured between centres."""
        (row, col), cols = cell, self.problem.grid.cols
        top, left = max(row - radius, 0), max(col - radius, 0)
        window = self.problem.passable[top : row + radius + 1, left : col + radius + 1]
        down, aside = np.ogrid[top - row : top - row + window.shape[0], left - col : left - col + window.shape[1]]
        inside = window & (down**2 + aside**2 <= radius * (radius + 1))  # (radius + 1/2)**2, in whole numbers
        found_rows, found_cols = np.nonzero(inside)
        return (top + found_rows) * cols + left + found_cols

    def apart_from_ends(self, cells: NDArray[np.int64]) -> NDArray[np.int64]:
        """The cells without start and goal."""
        cols = self.problem.grid.cols
        ends = [row * cols + col for row, col in (self.problem.start_cell, self.problem.goal_cell)]
        return cells[~np.isin(cells, ends)]

    def stay(self, rng: np.random.Generator) -> tuple[int, int]:
        """When something comes, anywhere in the scenario, and when it goes: after an eighth to a half of its ticks."""
        begin = int(rng.integers(self.ticks))
        least, most = max(self.ticks // 8, 1), max(self.ticks // 2, 1)
        return begin, begin + int(rng.integers(least, most + 1))
