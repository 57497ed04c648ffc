"""Walks on the padded map of legal moves, compiled: of the path encoding and of the potential field.

Cells are flat indices into `moves.legal_moves`, moves its bits. No kernel draws a random number.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from antnav.kernels.graph import SQRT2
from antnav.kernels.jit import jit

Flat = NDArray[np.int64]
Moves = NDArray[np.uint8]


@jit
def _move(row: int, col: int) -> int:
    """Index in `STEPS` of the move by (row, col), each in -1..1, not both 0."""
    k = 3 * (row + 1) + col + 1
    return k - 1 if k > 4 else k


@jit
def _offsets(width: int) -> Flat:
    return np.array([-width - 1, -width, -width + 1, -1, 1, width - 1, width, width + 1], np.int64)


@jit
def stops_of(vector: NDArray[np.float64], nearest: Flat, start: int, goal: int) -> Flat:
    """Start, the nearest reachable cell of each control point (row, col, row, col, ...), goal.

    `nearest`, shape (rows, cols), holds the flat index of the nearest reachable cell.
    """
    rows, cols = nearest.shape
    points = vector.size // 2
    stops = np.empty(points + 2, np.int64)
    stops[0], stops[-1] = start, goal
    for i in range(points):
        row = min(max(int(np.floor(vector[2 * i] + 0.5)), 0), rows - 1)
        col = min(max(int(np.floor(vector[2 * i + 1] + 0.5)), 0), cols - 1)
        stops[i + 1] = nearest[row, col]
    return stops


@jit
def straight_walk(moves: Moves, width: int, stops: Flat) -> tuple[Flat, float, int]:
    """Join stops by digital straight lines: (cells, length, illegal moves).

    Step i of n = max(|rows|, |cols|) of a line goes to the cell nearest to the point i / n along it, halves rounded up.
    Where that is an illegal diagonal and the two straight moves past one of its corners are legal, they are made
    instead::

        . b        . b
        a x   ->   a-+   (corner rule "forbid")
    """
    most = 1
    for i in range(1, stops.size):
        rows = abs(stops[i] // width - stops[i - 1] // width)
        cols = abs(stops[i] % width - stops[i - 1] % width)
        most += 2 * max(rows, cols)
    cells = np.empty(most, np.int64)
    cells[0] = stops[0]
    count, diagonal, illegal = 1, 0, 0
    for i in range(1, stops.size):
        first_row, first_col = stops[i - 1] // width, stops[i - 1] % width
        rows, cols = stops[i] // width - first_row, stops[i] % width - first_col
        n = max(abs(rows), abs(cols))
        row, col = first_row, first_col
        for step in range(1, n + 1):
            down = first_row + (2 * step * rows + n) // (2 * n) - row
            right = first_col + (2 * step * cols + n) // (2 * n) - col
            cell = row * width + col
            row += down
            col += right
            legal = moves[cell] >> _move(down, right) & 1
            if not legal and down != 0 and right != 0:
                corner = -1
                for k, other in ((_move(down, 0), cell + down * width), (_move(0, right), cell + right)):
                    if moves[cell] >> k & 1 and moves[other] >> (_move(0, right) + _move(down, 0) - k) & 1:
                        corner = other  # the other one is blocked, or the diagonal would be legal
                if corner >= 0:
                    cells[count] = corner
                    cells[count + 1] = row * width + col
                    count += 2
                    continue
            illegal += 1 - legal
            diagonal += int(down != 0 and right != 0)
            cells[count] = row * width + col
            count += 1
    return cells[:count], count - 1 - diagonal + SQRT2 * diagonal, illegal


@jit
def descend(moves: Moves, width: int, potential: NDArray[np.float64], start: int, goal: int) -> Flat:
    """Steepest descent of `potential` (flat, padded) over legal moves, from `start` to a local minimum.

    Always the legal neighbour of least potential, the first of equals, as long as it lies lower. A neighbouring goal
    is taken at once, and ends the descent.
    """
    offsets = _offsets(width)
    cells = np.empty(moves.size, np.int64)
    cells[0] = start
    count = 1
    cell = start
    while cell != goal:
        best, least = cell, potential[cell]
        for k in range(8):
            if moves[cell] >> k & 1:
                other = cell + offsets[k]
                if other == goal:
                    best = goal
                    break
                if potential[other] < least:
                    best, least = other, potential[other]
        if best == cell:
            break
        cell = best
        cells[count] = cell
        count += 1
    return cells[:count].copy()


@jit
def wander(moves: Moves, width: int, start: int, goal: int, draws: NDArray[np.float64]) -> Flat:
    """Random walk over legal moves, one move a draw in [0, 1), ended early by the goal."""
    offsets = _offsets(width)
    cells = np.empty(draws.size + 1, np.int64)
    cells[0] = start
    count = 1
    cell = start
    for i in range(draws.size):
        legal = 0
        for k in range(8):
            legal += moves[cell] >> k & 1
        if cell == goal or legal == 0:
            break
        chosen = int(draws[i] * legal)
        for k in range(8):
            if moves[cell] >> k & 1:
                if chosen == 0:
                    cell += offsets[k]
                    break
                chosen -= 1
        cells[count] = cell
        count += 1
    return cells[:count].copy()
