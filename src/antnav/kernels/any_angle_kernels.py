"""The shortest line at any angle among closed squares, compiled.

Intervals of rows are searched as by Anya (Harabor, Grastien, Oz & Aksakalli 2016, doi 10.1613/jair.5007); here a corner
waits in the queue itself, with the length to it, before intervals are seen from it. So each corner is left once.

A cone is what a root sees of a row line: an interval between two rays, known by their columns for each row away from
the root. Corners of cells are whole numbers: the cell (row, col) covers the square from (col, row) to
(col + 1, row + 1). The map has one closed cell all round.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from antnav.kernels import heap
from antnav.kernels.jit import jit

_NEAR = 1e-9  #: What counts as the same column; different ones of rays between corners are 1 / rows apart.
_push, _pop = jit(heap.push), jit(heap.pop)


class _Space(NamedTuple):
    closed: np.ndarray  #: uint8 (rows, cols)
    squeeze: bool  #: whether a line passes between two closed cells that touch at a corner
    ends: np.ndarray  #: float64 (2, 2), x and y of start and goal
    length: np.ndarray  #: float64, shortest so far to each corner, then to start and goal
    parent: np.ndarray  #: int64, the corner before
    left: np.ndarray  #: bool, corners that have left the queue


class _Queue(NamedTuple):
    keys: np.ndarray
    items: np.ndarray  #: int64, a cone, or -1 - a corner
    cones: np.ndarray  #: float64 (n, 4), root, row line, columns for each row of the left ray and of the right one
    counts: np.ndarray  #: int64, of items and of cones


@jit
def shortest_line(closed, squeeze, ends):
    """The shortest line from start to goal on which no point lies inside a closed cell or between two.

    Parameters
    ----------
    closed : uint8 (rows, cols)
        The map with one closed cell all round.
    squeeze : bool
        Whether the line may pass between two closed cells that touch at a corner.
    ends : float64 (2, 2)
        x and y of start and goal, both in open cells.

    Returns
    -------
    (line, popped)
        float64 (k, 2), x and y, empty where no line exists; what was taken from the queue.
    """
    rows, cols = closed.shape
    corners = (rows + 1) * (cols + 1)
    length = np.full(corners + 2, np.inf)
    parent = np.full(corners + 2, -1, np.int64)
    space = _Space(closed, squeeze, ends, length, parent, np.zeros(corners + 2, np.bool_))
    room = 4 * cols + 64  # for what comes of one item
    queue = _Queue(np.empty(2 * room), np.empty(2 * room, np.int64), np.empty((2 * room, 4)), np.zeros(2, np.int64))
    length[corners] = 0.0
    space.left[corners] = True
    _from_start(space, queue, corners)
    popped = 0
    while queue.counts[0] > 0:
        if max(queue.counts[0], queue.counts[1]) + room > queue.keys.size:
            queue = _grown(queue)
        item = _pop(queue.keys, queue.items, queue.counts[0])
        queue.counts[0] -= 1
        popped += 1
        if item == -1 - (corners + 1):
            break
        if item >= 0:
            _onwards(space, queue, item)
        elif not space.left[-1 - item]:
            space.left[-1 - item] = True
            _around(space, queue, -1 - item)
    return _traced(space, corners), popped


@jit
def _grown(queue):
    size = queue.keys.size
    keys, items, cones = np.empty(2 * size), np.empty(2 * size, np.int64), np.empty((2 * size, 4))
    keys[:size], items[:size], cones[:size] = queue.keys, queue.items, queue.cones
    return _Queue(keys, items, cones, queue.counts)


@jit
def _traced(space, corners):
    """The line from the goal's parents, without points on a straight stretch."""
    line = np.empty((corners + 2, 2))
    count = 0
    at = corners + 1 if np.isfinite(space.length[corners + 1]) else -1
    while at >= 0:
        x, y = _place(space, at)
        if count > 1:
            ax, ay = line[count - 1, 0] - line[count - 2, 0], line[count - 1, 1] - line[count - 2, 1]
            bx, by = x - line[count - 1, 0], y - line[count - 1, 1]
            if abs(ax * by - ay * bx) <= _NEAR * (abs(ax) + abs(ay)) * (abs(bx) + abs(by)):
                count -= 1
        line[count, 0], line[count, 1] = x, y
        count += 1
        at = space.parent[at]
    return line[:count][::-1].copy()


@jit
def _place(space, corner):
    wide = space.closed.shape[1] + 1
    corners = space.length.size - 2
    if corner >= corners:
        return space.ends[corner - corners, 0], space.ends[corner - corners, 1]
    return float(corner % wide), float(corner // wide)


@jit
def _offer(space, queue, corner, root):
    """A corner, or the goal, that a root sees."""
    (x, y), (root_x, root_y) = _place(space, corner), _place(space, root)
    length = space.length[root] + np.sqrt((x - root_x) ** 2 + (y - root_y) ** 2)
    if length < space.length[corner] and not space.left[corner]:
        space.length[corner], space.parent[corner] = length, root
        goal_x, goal_y = space.ends[1]
        key = length + np.sqrt((x - goal_x) ** 2 + (y - goal_y) ** 2)
        _push(queue.keys, queue.items, queue.counts[0], key, -1 - corner)
        queue.counts[0] += 1


@jit
def _bend(space, x, y, dx, dy, side, down):
    """Into which quadrant a line that comes by (dx, dy) may bend at a corner around the cell in quadrant (side, down).

    Returns
    -------
    (aside, on, level)
        Signs of x and y, 0 where it may not; whether the bend ends level, along the cell, or upright.
    """
    if not _closed_at(space, x, y, side, down) or (_closed_at(space, x, y, -side, -down) and not space.squeeze):
        return 0, 0, False
    if dx * side >= 0 and dy * down < 0 and not _closed_at(space, x, y, side, -down):
        return side, -down, True
    if dx * side < 0 and dy * down >= 0 and not _closed_at(space, x, y, -side, down):
        return -side, down, False
    return 0, 0, False


@jit
def _closed_at(space, x, y, side, down):
    return space.closed[y - (down < 0), x - (side < 0)] != 0


@jit
def _offer_bend(space, queue, x, y, root):
    """The corner at (x, y) if a line from the root may bend there."""
    root_x, root_y = _place(space, root)
    for side in (-1, 1):
        for down in (-1, 1):
            if _bend(space, x, y, x - root_x, y - root_y, side, down)[1] != 0:
                _offer(space, queue, y * (space.closed.shape[1] + 1) + x, root)
                return


@jit
def _from_start(space, queue, start):
    """All that the start sees of its row, and of the next one where it lies on a line between two."""
    x, y = _place(space, start)
    last = int(np.floor(x))
    first = last - (last == x)
    for on in (-1, 1):
        line = np.floor(y) + (on > 0) if y != np.floor(y) else y + on
        row = int(line) - (on > 0)
        for col in range(first, last + 1):
            if space.closed[row, col] == 0:
                begin, end = col, col + 1
                while space.closed[row, begin - 1] == 0:
                    begin -= 1
                while space.closed[row, end] == 0:
                    end += 1
                _through(space, queue, start, y, line, begin, end, -np.inf, np.inf)
                break
    if y == np.floor(y):
        for side in (-1, 1):
            _along(space, queue, start, side)


@jit
def _around(space, queue, corner):
    """All that is seen from a corner of what a bend there leads to."""
    x, y = corner % (space.closed.shape[1] + 1), corner // (space.closed.shape[1] + 1)
    before_x, before_y = _place(space, space.parent[corner])
    dx, dy = x - before_x, y - before_y
    for one in (-1, 1):
        for other in (-1, 1):
            side, on, level = _bend(space, x, y, dx, dy, one, other)
            if on == 0:
                continue
            slope = dx / abs(dy) if dy != 0 else side * np.inf
            near, far = (slope, side * np.inf) if level else (0.0, slope)
            row, wall = y - (on < 0), x
            reach = x + far
            while (reach - wall) * side > 0 and space.closed[row, wall - (side < 0)] == 0:
                wall += side
            if side > 0:
                _through(space, queue, corner, float(y), float(y + on), x, wall, near, far)
            else:
                _through(space, queue, corner, float(y), float(y + on), wall, x, far, near)
            if level:
                _along(space, queue, corner, side)


@jit
def _along(space, queue, root, side):
    """Corners, and the goal, on a root's row line, as far as a line gets along it."""
    x, y = _place(space, root)
    row, goal_x, goal_y = int(y), space.ends[1, 0], space.ends[1, 1]
    at = int(np.floor(x)) if side > 0 else int(np.ceil(x))
    above = below = True
    while True:
        col = at - (side < 0)
        now_above, now_below = space.closed[row - 1, col] == 0, space.closed[row, col] == 0
        if not ((now_above and (above or space.squeeze)) or (now_below and (below or space.squeeze))):
            return
        if goal_y == y and (goal_x - x) * side >= 0 and (at + side - goal_x) * side >= 0:
            _offer(space, queue, space.length.size - 1, root)
            return
        above, below = now_above, now_below
        at += side
        _offer_bend(space, queue, at, row, root)


@jit
def _onwards(space, queue, cone):
    """The next row of a cone: what it sees through each open run of cells there."""
    root, line = int(queue.cones[cone, 0]), queue.cones[cone, 1]
    left_slope, right_slope = queue.cones[cone, 2], queue.cones[cone, 3]
    x, y = _place(space, root)
    on = 1 if line > y else -1
    away = abs(line - y)
    left, right = _snapped(x + left_slope * away), _snapped(x + right_slope * away)
    row = int(line) - (on < 0)
    col, end = int(np.floor(left)), int(np.ceil(right))
    while col < end:
        if space.closed[row, col] != 0:
            col += 1
            continue
        from_slope, to_slope, begin = left_slope, right_slope, col
        if begin <= left:  # the run may go on to the left of the cone
            reach = _snapped(left + left_slope)
            while begin > reach and space.closed[row, begin - 1] == 0:
                begin -= 1
        else:
            from_slope = (begin - x) / away
            _offer_bend(space, queue, begin, int(line), root)
        while col < end and space.closed[row, col] == 0:
            col += 1
        stop = col
        if stop >= right:
            reach = _snapped(right + right_slope)
            while stop < reach and space.closed[row, stop] == 0:
                stop += 1
        else:
            to_slope = (stop - x) / away
            _offer_bend(space, queue, stop, int(line), root)
        _through(space, queue, root, line, line + on, begin, stop, from_slope, to_slope)


@jit
def _snapped(x):
    return np.rint(x) if abs(x - np.rint(x)) < _NEAR else x


@jit
def _through(space, queue, root, line, following, begin, end, left_slope, right_slope):
    """What a root sees, between two rays, through a run of open cells from one row line to the following one."""
    x, y = _place(space, root)
    on = 1 if following > line else -1
    goal_x, goal_y = space.ends[1]
    if (goal_y - line) * on >= 0 and (following - goal_y) * on >= 0:
        away = abs(goal_y - y)
        low, high = float(begin), float(end)
        if away > 0:
            low, high = max(low, x + left_slope * away), min(high, x + right_slope * away)
        elif not (np.isinf(left_slope) and np.isinf(right_slope)):
            low = np.inf  # only the start sees along its row
        if low - _NEAR <= goal_x <= high + _NEAR:
            _offer(space, queue, space.length.size - 1, root)
    away = abs(following - y)
    left, right = _snapped(x + left_slope * away), _snapped(x + right_slope * away)
    if left < begin:
        left, left_slope = float(begin), (begin - x) / away
    if right > end:
        right, right_slope = float(end), (end - x) / away
    if left > right:
        return
    if left == np.rint(left):
        _offer_bend(space, queue, int(left), int(following), root)
    if right - left < _NEAR:
        return
    if right == np.rint(right):
        _offer_bend(space, queue, int(right), int(following), root)
    if (goal_y - following) * on < 0:
        goal_y = 2 * following - goal_y  # mirrored: as far from the interval as the goal
    at = x + (goal_x - x) * away / abs(goal_y - y)
    at = min(max(at, left), right)
    key = space.length[root] + np.sqrt((at - x) ** 2 + away**2)
    key += np.sqrt((goal_x - at) ** 2 + (goal_y - following) ** 2)
    cone = queue.counts[1]
    queue.cones[cone, 0], queue.cones[cone, 1] = root, following
    queue.cones[cone, 2], queue.cones[cone, 3] = left_slope, right_slope
    _push(queue.keys, queue.items, queue.counts[0], key, cone)
    queue.counts[0] += 1
    queue.counts[1] += 1


@jit
def cells_along(closed, line, ends):
    """Cells that a line passes, so that each move between two is straight, or diagonal and as free as the line is.

    Parameters
    ----------
    closed : uint8 (rows, cols)
        As in `shortest_line`.
    line : float64 (k, 2)
        x and y; no point inside a closed cell.
    ends : int64 (2, 2)
        Row and column of the first and the last cell, on which the line ends.

    Returns
    -------
    int64 (n, 2)
        Row and column.
    """
    room = 8
    for i in range(line.shape[0] - 1):
        room += int(2 * (abs(line[i + 1, 0] - line[i, 0]) + abs(line[i + 1, 1] - line[i, 1]))) + 8
    cells = np.empty((room, 2), np.int64)
    cells[0] = ends[0]
    count = 1
    for i in range(line.shape[0] - 1):
        x, y = line[i]
        dx, dy = line[i + 1, 0] - x, line[i + 1, 1] - y
        t = 0.0
        while t < 1:
            following = min(_crossing(x, dx, t), _crossing(y, dy, t), 1.0)
            middle = (t + following) / 2
            row, col = _snapped(y + middle * dy), _snapped(x + middle * dx)
            # on a whole number it runs between two cells, of which one is open
            row -= row == np.floor(row) and closed[int(row), int(col)] != 0
            col -= col == np.floor(col) and closed[int(row), int(col)] != 0
            count = _joined(closed, cells, count, int(row), int(col))
            t = following
    count = _joined(closed, cells, count, ends[1, 0], ends[1, 1])
    return cells[:count].copy()


@jit
def _crossing(at, step, t):
    """When a number that grows by `step` from t = 0 to 1 is whole again after t."""
    now = at + t * step
    if step > 0:
        return (np.floor(now + _NEAR) + 1 - at) / step
    if step < 0:
        return (np.ceil(now - _NEAR) - 1 - at) / step
    return np.inf


@jit
def _joined(closed, cells, count, row, col):
    """Add a cell that shares a side or a corner with the last one; returns how many there are."""
    last_row, last_col = cells[count - 1]
    if row == last_row and col == last_col:
        return count
    if row != last_row and col != last_col and closed[row, last_col] != closed[last_row, col]:
        by_row = closed[row, last_col] == 0
        count = _joined(closed, cells, count, row if by_row else last_row, last_col if by_row else col)
    elif count > 1:
        from_row, from_col = cells[count - 2]
        if (
            abs(row - from_row) == 1
            and abs(col - from_col) == 1
            and not (closed[row, from_col] or closed[from_row, col])
        ):
            count -= 1
    cells[count] = row, col
    return count + 1
