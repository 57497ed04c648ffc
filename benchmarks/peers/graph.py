"""Graph: for libraries of graphs, whose users build it; here without cut corners."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .task import Points, Task

SQRT2 = math.sqrt(2.0)
STEPS = ((-1, -1), (-1, 0), (-1, 1), (0, -1), (0, 1), (1, -1), (1, 0), (1, 1))


class Graph(NamedTuple):
    """The edges of a map, each in both directions."""

    source: NDArray[np.int64]
    target: NDArray[np.int64]
    length: NDArray[np.float64]


def graph_of(blocked: NDArray[np.bool_], *, allow: bool = False) -> Graph:
    """Edges between neighbouring free cells; diagonals between two blocked ones only where `allow`."""
    rows, cols = blocked.shape
    free = np.pad(~blocked, 1)
    number = np.pad(np.arange(rows * cols).reshape(rows, cols), 1)
    parts: list[tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]] = []

    def shifted(array: NDArray[Any], row: int, col: int) -> NDArray[Any]:
        return array[1 + row : 1 + row + rows, 1 + col : 1 + col + cols]

    for row, col in STEPS:
        legal = shifted(free, 0, 0) & shifted(free, row, col)
        if row and col and not allow:
            legal &= shifted(free, row, 0) & shifted(free, 0, col)
        lengths = np.full(np.count_nonzero(legal), SQRT2 if row and col else 1.0)
        parts.append((shifted(number, 0, 0)[legal], shifted(number, row, col)[legal], lengths))
    return Graph(*(np.concatenate(part) for part in zip(*parts, strict=True)))


def nodes(task: Task) -> tuple[int, int]:
    """Start and goal as numbers of cells in map order."""
    cols = task.blocked.shape[1]
    return task.start[0] * cols + task.start[1], task.goal[0] * cols + task.goal[1]


def cells(path: Any, task: Task) -> Points:
    """Numbers of cells as rows and columns."""
    return [divmod(int(node), task.blocked.shape[1]) for node in path]


def octile(task: Task, node: int) -> float:
    """Distance to the goal on an empty map."""
    row, col = divmod(node, task.blocked.shape[1])
    rows, cols = abs(row - task.goal[0]), abs(col - task.goal[1])
    return float(max(rows, cols) + (SQRT2 - 1) * min(rows, cols))
