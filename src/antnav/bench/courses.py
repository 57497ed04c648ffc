"""Maps on which peers are compared: blocks and traps from a fixed seed, from the top left to the bottom right."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from antnav.errors import MapError
from antnav.maps import ends
from antnav.world.grid import Cell, GridMap
from antnav.world.problem import CellIndex, Problem

Cells = NDArray[np.uint8]

SEED = 2024
ATTEMPTS = 1000


@dataclass(frozen=True, eq=False)
class Course:
    """A map with a start and a goal (row, col), and a name for tables."""

    name: str
    grid: GridMap
    start: CellIndex
    goal: CellIndex

    @classmethod
    def on(cls, name: str, grid: GridMap) -> Course:
        """A course on any map, between two free cells far apart."""
        return cls(name, grid, *ends(grid))


def _u_traps(side: int, rng: np.random.Generator) -> Cells:
    """U-shaped traps along the diagonal that open towards the start, and small blocks: 25 to 30 % blocked."""
    cells = np.zeros((side, side), np.uint8)
    traps = max(3, side // 8)
    for number in range(traps):
        size = int(rng.integers(max(4, side // 6), max(6, side // 4) + 1))
        along = (number + 1) * (side - size) // (traps + 1)
        across = int(rng.integers(-side // 8, side // 8 + 1))
        row, col = np.clip([along + across, along - across], 1, side - size - 1)
        square = cells[row : row + size, col : col + size]
        trap = square if number % 2 else square.T
        trap[:, 0] = trap[:, -1] = trap[-1, :] = Cell.OCCUPIED
    while cells.mean() < 0.28:
        _block(cells, rng, 1, 3)
    cells[:2, :2] = cells[-2:, -2:] = Cell.FREE
    return cells


def _rectangles(side: int, rng: np.random.Generator) -> Cells:
    """Rectangles of many sizes: about 25 % blocked."""
    cells = np.zeros((side, side), np.uint8)
    while cells.mean() < 0.25:
        _block(cells, rng, max(2, side // 64), max(3, side // 10))
    cells[:3, :3] = cells[-3:, -3:] = Cell.FREE
    return cells


def _block(cells: Cells, rng: np.random.Generator, least: int, most: int) -> None:
    height, width = rng.integers(least, most + 1, size=2)
    row, col = rng.integers(0, len(cells) - height + 1), rng.integers(0, len(cells) - width + 1)
    cells[row : row + height, col : col + width] = Cell.OCCUPIED


_DRAWN: dict[str, tuple[Callable[[int, np.random.Generator], Cells], int]] = {
    **{f"u{side}": (_u_traps, side) for side in (20, 30, 40)},
    **{f"r{side}": (_rectangles, side) for side in (256, 1024)},
}
#: Names of the courses that need no map file.
COURSES = tuple(_DRAWN)


def course(name: str) -> Course:
    """The course of that name, the same on every machine: the first drawing whose corners a path joins."""
    draw, side = _DRAWN[name]
    for attempt in range(ATTEMPTS):
        cells = draw(side, np.random.default_rng([SEED, side, attempt]))
        if draw is _u_traps and not 0.25 <= cells.mean() <= 0.30:
            continue
        grid = GridMap(cells, name=name)
        found = Course(name, grid, (0, 0), (side - 1, side - 1))
        if Problem.from_cells(grid, found.start, found.goal).connected:
            return found
    raise MapError(f"course {name}", f"no path joined its corners in {ATTEMPTS} drawings", "report this as an error")
