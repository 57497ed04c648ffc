"""What is said of routes, as plainly as it is defined."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
from scipy import ndimage
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import dijkstra

import antnav as an
from antnav.world.moves import STEPS


def near_cells(cells: np.ndarray, problem: an.Problem, reach: float) -> set[tuple[int, int]]:
    """Cells from which legal moves of no more than that length lead to a path, by SciPy."""
    rows, cols = problem.grid.shape
    moves = problem.moves[1:-1, 1:-1]
    ends = []
    for k, (down, right) in enumerate(STEPS):
        for row, col in np.argwhere(moves >> k & 1):
            ends.append((row * cols + col, (row + down) * cols + col + right, math.hypot(down, right)))
    if not ends:
        return set(map(tuple, cells.tolist()))
    one, other, length = zip(*ends, strict=True)
    graph = coo_matrix((length, (one, other)), (rows * cols, rows * cols))
    away = dijkstra(graph, indices=[row * cols + col for row, col in cells], min_only=True)
    return {(int(n) // cols, int(n) % cols) for n in np.flatnonzero(away <= reach + 1e-9)}


def shared_share(cells: np.ndarray, other: np.ndarray, problem: an.Problem, reach: float) -> float:
    """Share of a path's length whose moves lie near another path with both their cells."""
    near = near_cells(other, problem, reach)
    path = list(map(tuple, cells.tolist()))
    inside = sum(math.dist(a, b) for a, b in pairwise(path) if a in near and b in near)
    whole = sum(math.dist(a, b) for a, b in pairwise(path))
    return inside / whole if whole else 1.0


def winding(loop: list[tuple[int, int]], cell: tuple[int, int]) -> int:
    """How often a closed polygon winds around a cell, by the angles seen from it."""
    angles = [math.atan2(row - cell[0], col - cell[1]) for row, col in loop]
    return round(sum(math.remainder(b - a, math.tau) for a, b in pairwise(angles)) / math.tau)


def enclosed(cells: np.ndarray, other: np.ndarray, problem: an.Problem) -> int:
    """Obstacles around which the loop of two paths winds."""
    loop = list(map(tuple, [*cells.tolist(), *other[::-1].tolist()]))
    corners = 1 if problem.corner_rule is an.CornerRule.ALLOW else 2
    parts, count = ndimage.label(~problem.passable, ndimage.generate_binary_structure(2, corners))
    return sum(winding(loop, tuple(np.argwhere(parts == part)[0].tolist())) != 0 for part in range(1, count + 1))
