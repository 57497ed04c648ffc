"""What the generators share: checks of their options, and a way from corner to corner."""

from __future__ import annotations

from collections import deque

import numpy as np
from numpy.typing import NDArray

from antnav.errors import ParameterError, shown
from antnav.values import is_whole
from antnav.world.grid import MAX_CELLS, Cell

Cells = NDArray[np.uint8]


def check_count(name: str, value: float, low: int, high: int = MAX_CELLS) -> int:
    """Refuse what is not a whole number in low..high; no map has more than `MAX_CELLS` of anything."""
    if not is_whole(value) or not low <= value <= high:
        rule = f"{name} is a whole number from {low} to {high}"
        raise ParameterError(f"{name} {shown(value)}", rule, f"try {name}={low}")
    return int(value)


def check_share(name: str, value: float) -> int:
    """Refuse what is not a number in 0..1; return it in thousandths.

    Shares are compared with whole random numbers: a float near a threshold could differ between machines.
    """
    number = isinstance(value, int | float | np.integer | np.floating) and not isinstance(value, bool)
    if not number or not 0 <= value <= 1:
        raise ParameterError(f"{name} {shown(value)}", f"{name} is a number from 0 to 1", f"try {name}=0.3")
    return round(float(value) * 1000)


def join_corners(cells: Cells) -> None:
    """Free the first and the last cell of an area and join them, in place, by moves in four directions.

    Parameters
    ----------
    cells : ndarray of uint8, shape (rows, cols)
        The area, a view of a map without the outer walls. Opened are the fewest cells that need to be.
    """
    from scipy import ndimage

    cells[0, 0] = cells[-1, -1] = Cell.FREE
    labels, _ = ndimage.label(cells == Cell.FREE)
    if labels[0, 0] != labels[-1, -1]:
        for row, col in _cheapest_way(cells != Cell.FREE):
            cells[row, col] = Cell.FREE


def _cheapest_way(blocked: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Cells of a way from the first to the last across the fewest blocked ones: breadth-first, free moves first."""
    width = blocked.shape[1] + 2
    outside = 2
    costs = np.pad(blocked.astype(np.uint8), 1, constant_values=outside).tobytes()
    start, goal = width + 1, len(costs) - width - 2
    parent = [0] * len(costs)  # 0, which lies outside: not reached
    parent[start] = start
    queue = deque([start])
    while not parent[goal]:
        cell = queue.popleft()
        for neighbour in (cell + 1, cell + width, cell - 1, cell - width):
            if parent[neighbour] or costs[neighbour] == outside:
                continue  # the first way into a cell is the cheapest: entering costs the same from all sides
            parent[neighbour] = cell
            if costs[neighbour]:
                queue.append(neighbour)
            else:
                queue.appendleft(neighbour)
    way = [goal]
    while way[-1] != start:
        way.append(parent[way[-1]])
    return [(cell // width - 1, cell % width - 1) for cell in way]
