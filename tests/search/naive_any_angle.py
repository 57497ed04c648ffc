"""The shortest line at any angle as a student would find it: every corner, every pair that sees one another."""

from __future__ import annotations

import itertools
import math

import numpy as np
from scipy.sparse.csgraph import dijkstra

Point = tuple[float, float]
_NEAR = 1e-9


def shortest(closed: np.ndarray, start: Point, goal: Point, *, squeeze: bool) -> float:
    """Length in cells; x and y as in `any_angle_kernels`, and the map has one closed cell all round."""
    rows, cols = closed.shape
    pinches = {(x, y) for x in range(1, cols) for y in range(1, rows) if _is_pinch(closed, x, y)}
    corners = [(x, y) for x in range(1, cols) for y in range(1, rows) if closed[y - 1 : y + 1, x - 1 : x + 1].any()]
    if not squeeze:
        corners = [corner for corner in corners if corner not in pinches]
    points = list(dict.fromkeys([start, goal, *corners]))
    lengths = np.zeros((len(points), len(points)))
    for (i, one), (j, other) in itertools.combinations(enumerate(points), 2):
        if _sees(closed, one, other) and (squeeze or not any(_within(pinch, one, other) for pinch in pinches)):
            lengths[i, j] = math.dist(one, other)
    return float(dijkstra(lengths, directed=False, indices=0)[points.index(goal)])


def _is_pinch(closed: np.ndarray, x: int, y: int) -> bool:
    (a, b), (c, d) = closed[y - 1 : y + 1, x - 1 : x + 1]
    return bool(a and d and not (b or c)) or bool(b and c and not (a or d))


def _within(point: Point, one: Point, other: Point) -> bool:
    around = math.dist(one, point) + math.dist(point, other) - math.dist(one, other)
    return around < _NEAR and point not in (one, other)


def _sees(closed: np.ndarray, one: Point, other: Point) -> bool:
    """Whether no closed square, and no edge between two of them, has an inner point on the segment."""
    boxes = [(x, y, x + 1, y + 1) for y, x in np.argwhere(closed).tolist()]
    for y, x in np.argwhere(closed[:, 1:] & closed[:, :-1]).tolist():
        boxes.append((x, y, x + 2, y + 1))
    for y, x in np.argwhere(closed[1:] & closed[:-1]).tolist():
        boxes.append((x, y, x + 1, y + 2))
    return not any(_crosses(one, other, box) for box in boxes)


def _crosses(one: Point, other: Point, box: tuple[int, int, int, int]) -> bool:
    enter, leave = 0.0, 1.0
    for at, end, low, high in zip(one, other, box[:2], box[2:], strict=True):
        if at == end:
            if not low + _NEAR < at < high - _NEAR:
                return False
        else:
            first, second = sorted(((low - at) / (end - at), (high - at) / (end - at)))
            enter, leave = max(enter, first), min(leave, second)
    return leave - enter > _NEAR
