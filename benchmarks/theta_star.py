"""Theta* (Nash, Daniel, Koenig & Felner 2007) and Lazy Theta* (Nash, Koenig & Tovey 2010, doi 10.1609/aaai.v24i1.7566).

Written from the papers. Vertices are the cells' centres; two see one another where a disc that moves straight between
them keeps off the squares of occupied cells, by the test that trajectories use.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

import antnav as an
from antnav.kernels import heap
from antnav.kernels.jit import jit
from antnav.kernels.trajectory_kernels import Ground, clear
from antnav.trajectories.ground import ground_of

_push, _pop = jit(heap.push), jit(heap.pop)
_ROWS = np.array([-1, -1, -1, 0, 0, 1, 1, 1])
_COLS = np.array([-1, 0, 1, -1, 1, -1, 0, 1])


def theta_star(problem: an.Problem, need: float, *, lazy: bool = False) -> NDArray[np.float64]:
    """A short line from the centre of the start's cell to that of the goal's.

    Parameters
    ----------
    need : float
        Metres that the line keeps from the squares of occupied cells.

    Returns
    -------
    ndarray of float64, shape (k, 2)
        x and y in metres; empty where none was found.
    """
    ground = ground_of(problem, body=need > 0)
    start, goal = np.array([problem.start_cell, problem.goal_cell])
    line = _search(np.array(problem.moves), ground, start, goal, need / problem.grid.resolution, lazy)
    return problem.grid.cell_to_world(line)


@jit
def _search(moves, ground: Ground, start, goal, need, lazy):
    rows, cols = ground.closed.shape
    size = rows * cols
    length, parent, left = np.full(size, np.inf), np.full(size, -1, np.int64), np.zeros(size, np.bool_)
    keys, items = np.empty(8 * size + 8), np.empty(8 * size + 8, np.int64)
    first, last = start[0] * cols + start[1], goal[0] * cols + goal[1]
    length[first], parent[first] = 0.0, first
    _push(keys, items, 0, 0.0, first)
    count = 1
    while count > 0:
        at = _pop(keys, items, count)
        count -= 1
        if left[at]:
            continue
        left[at] = True
        row, col = at // cols, at % cols
        if lazy and at != first and not _sees(ground, parent[at], at, need):
            length[at] = np.inf
            for k in range(8):  # the best of the neighbours that were expanded
                if moves[row + 1, col + 1] >> k & 1:
                    near = at + _ROWS[k] * cols + _COLS[k]
                    through = length[near] + _apart(near, at, cols)
                    if left[near] and through < length[at]:
                        length[at], parent[at] = through, near
        if at == last:
            break
        for k in range(8):
            near = at + _ROWS[k] * cols + _COLS[k]
            if not moves[row + 1, col + 1] >> k & 1 or left[near]:
                continue
            by = parent[at] if lazy or _sees(ground, parent[at], near, need) else at
            through = length[by] + _apart(by, near, cols)
            if through < length[near]:
                length[near], parent[near] = through, by
                _push(keys, items, count, through + _apart(near, last, cols), near)
                count += 1
    line = np.empty((size, 2))
    count = 0
    at = last if np.isfinite(length[last]) else -1
    while at >= 0:
        line[count] = at // cols, at % cols
        count += 1
        at = parent[at] if at != first else -1
    return line[:count][::-1].copy()


@jit
def _apart(one, other, cols):
    return np.sqrt(float((one // cols - other // cols) ** 2 + (one % cols - other % cols) ** 2))


@jit
def _sees(ground, one, other, need):
    cols = ground.closed.shape[1]
    return clear(ground, float(one % cols), float(one // cols), float(other % cols), float(other // cols), need)
