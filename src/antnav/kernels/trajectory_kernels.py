"""A disc that moves over squares, compiled: whether it touches one, the shortest line near a path, the least distance.

Lines lie in cells: x is the column and y the row, whole numbers at centres of cells.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from antnav.kernels.jit import jit

_TOUCH = 1e-9  #: What rounding may add to a distance in cells.
_SAGITTA = 0.003  #: How far chords of an arc may lie off it, in cells.
_ROUNDS = 12
_HALVINGS = 12


class Ground(NamedTuple):
    """What a robot keeps off."""

    to_wall: np.ndarray  #: int32 (rows, cols), as `GridMap.rows_to_wall`
    closed: np.ndarray  #: uint8 (rows, cols), cells that its centre does not enter
    price: np.ndarray  #: float64 (rows, cols), what a cell costs on top of 1 for each cell of way; (0, 0) for nothing


@jit
def _lowest(x, ax, ay, bx, by, radius):
    """The largest y of a disc's trace at x; a disc that moves from a to b, ax <= bx."""
    dx, dy = bx - ax, by - ay
    length = np.sqrt(dx * dx + dy * dy)
    aside = -dy / length if length > 0 else 0.0
    if x <= ax + radius * aside:
        return ay + np.sqrt(max(radius * radius - (x - ax) ** 2, 0.0))
    if x >= bx + radius * aside:
        return by + np.sqrt(max(radius * radius - (x - bx) ** 2, 0.0))
    return ay + radius * dx / length + (x - ax - radius * aside) * dy / dx


@jit
def clear(ground, ax, ay, bx, by, need):
    """Whether a disc that moves straight from a to b touches no square, and its centre enters no closed cell.

    Column by column: the trace covers an interval of rows there, and the nearest occupied cell to the middle of the
    interval tells whether one lies in it.
    """
    rows, cols = ground.closed.shape
    if ax > bx:
        ax, ay, bx, by = bx, by, ax, ay
    first, last = int(np.floor(ax + 0.5)), int(np.floor(bx + 0.5))
    if first < 0 or last >= cols or min(ay, by) < -0.5 or max(ay, by) >= rows - 0.5:
        return False
    for col in range(first, last + 1):
        left, right = max(ax, col - 0.5), min(bx, col + 0.5)
        if right - left < _TOUCH and first != last:
            continue
        one, other = ay, by
        if bx > ax:
            one = ay + (left - ax) * (by - ay) / (bx - ax)
            other = ay + (right - ax) * (by - ay) / (bx - ax)
        top, bottom = min(one, other), max(one, other)
        row, end = int(np.floor(top + 0.5 + _TOUCH)), int(np.floor(bottom + 0.5 - _TOUCH))
        for at in range(row, max(row, end) + 1):
            if 0 <= at < rows and ground.closed[at, col]:
                return False
    radius = need - _TOUCH
    if radius <= 0:
        return True
    top_x = ax if ay < by else bx  # where the trace is highest, and lowest
    bottom_x = ax if ay > by else bx
    first, last = max(int(np.floor(ax - radius + 0.5)), 0), min(int(np.floor(bx + radius + 0.5)), cols - 1)
    for col in range(first, last + 1):
        left, right = max(ax - radius, col - 0.5), min(bx + radius, col + 0.5)
        if right <= left:
            continue
        bottom = _lowest(min(max(bottom_x, left), right), ax, ay, bx, by, radius)
        top = -_lowest(min(max(top_x, left), right), ax, -ay, bx, -by, radius)
        row, end = max(int(np.floor(top + 0.5)), 0), min(int(np.ceil(bottom - 0.5)), rows - 1)
        if row > end:
            continue
        middle = (row + end) // 2
        away = ground.to_wall[middle, col]
        if away <= middle - row or (middle + away <= end and ground.to_wall[middle + away, col] == 0):
            return False
    return True


@jit
def line_clear(ground, line, need):
    """The first segment of a line, shape (k, 2) as x and y, that is not `clear`; -1 where all are."""
    for i in range(line.shape[0] - 1):
        if not clear(ground, line[i, 0], line[i, 1], line[i + 1, 0], line[i + 1, 1], need):
            return i
    return -1


@jit
def pieces_clear(ground, pieces, need):
    """Whether straight lines and arcs are `clear`, by chords, which arcs leave by less than is added to the need.

    Parameters
    ----------
    pieces : float64 (n, 5)
        x and y where it begins, heading, length and curvature.
    """
    for i in range(pieces.shape[0]):
        x, y, heading, length, curvature = pieces[i]
        chords, extra = 1, 0.0
        if curvature != 0:
            chords = int(np.ceil(length * np.sqrt(abs(curvature) / (8 * _SAGITTA)))) + 1
            extra = (length / chords) ** 2 * abs(curvature) / 8
        from_x, from_y = x, y
        for k in range(1, chords + 1):
            s = length * k / chords
            if curvature == 0:
                to_x, to_y = x + s * np.cos(heading), y + s * np.sin(heading)
            else:
                to_x = x + (np.sin(heading + curvature * s) - np.sin(heading)) / curvature
                to_y = y - (np.cos(heading + curvature * s) - np.cos(heading)) / curvature
            if not clear(ground, from_x, from_y, to_x, to_y, need + extra if need > 0 else 0.0):
                return False
            from_x, from_y = to_x, to_y
    return True


@jit
def _price(ground, ax, ay, bx, by):
    """What a segment costs, by the cells at the middles of pieces of half a cell; its length where nothing costs."""
    length = np.sqrt((bx - ax) ** 2 + (by - ay) ** 2)
    if ground.price.size == 0:
        return length
    count = int(np.ceil(2 * length))
    total = 0.0
    for k in range(count):
        share = (k + 0.5) / count
        total += ground.price[int(np.floor(ay + share * (by - ay) + 0.5)), int(np.floor(ax + share * (bx - ax) + 0.5))]
    return length + total * length / max(count, 1)


@jit
def _better(ground, ax, ay, bx, by, need, limit):
    """Whether a segment is clear, and costs no more than a limit where cells cost."""
    if not clear(ground, ax, ay, bx, by, need):
        return False
    return ground.price.size == 0 or _price(ground, ax, ay, bx, by) <= limit + _TOUCH


@jit
def pulled(ground, line, need):
    """A short line with few corners beside a given one: a string that is pulled taut.

    Corners are left out, slid along their legs, or cut, as far as the disc stays clear; each of these shortens it, and
    none makes it dearer where cells cost.

    Parameters
    ----------
    line : float64 (k, 2)
        x and y, each segment clear.
    """
    line = _pruned(ground, line, need)
    for _ in range(_ROUNDS if line.shape[0] > 2 else 0):
        before = _spent(ground, line)[-1]
        line = _cut(ground, _pruned(ground, line, need), need)
        for i in range(1, line.shape[0] - 1):
            _slide(ground, line, i, i - 1, i + 1, need)
            _slide(ground, line, i, i + 1, i - 1, need)
        if before - _spent(ground, line)[-1] < 1e-4 * before:
            break
    return _pruned(ground, line, need)


@jit
def _spent(ground, line):
    """What a line has cost up to each of its points."""
    spent = np.zeros(line.shape[0])
    for i in range(1, line.shape[0]):
        spent[i] = spent[i - 1] + _price(ground, line[i - 1, 0], line[i - 1, 1], line[i, 0], line[i, 1])
    return spent


@jit
def _pruned(ground, line, need):
    """The line without corners that can be left out: from each the farthest that galloping finds clear."""
    spent = _spent(ground, line)
    kept = np.empty_like(line)
    kept[0] = line[0]
    count, at, last = 1, 0, line.shape[0] - 1
    while at < last:
        good, bad, step = at + 1, last + 1, 2
        while good < last and bad > last:
            ahead = min(at + step, last)
            saved = spent[ahead] - spent[at]
            if _better(ground, line[at, 0], line[at, 1], line[ahead, 0], line[ahead, 1], need, saved):
                good = ahead
            else:
                bad = ahead
            step *= 2
        while bad - good > 1 and bad <= last:
            middle = (good + bad) // 2
            saved = spent[middle] - spent[at]
            if _better(ground, line[at, 0], line[at, 1], line[middle, 0], line[middle, 1], need, saved):
                good = middle
            else:
                bad = middle
        kept[count] = line[good]
        count += 1
        at = good
    return kept[:count].copy()


@jit
def _slide(ground, line, i, towards, other, need):
    """Move a corner along one of its legs, as far as the other leg stays clear."""
    from_x, from_y = line[i]
    dx, dy = line[towards, 0] - from_x, line[towards, 1] - from_y
    to_x, to_y = line[other]
    leg = _price(ground, from_x, from_y, to_x, to_y)
    low, high = 0.0, 1.0
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        x, y = from_x + middle * dx, from_y + middle * dy
        if _better(ground, x, y, to_x, to_y, need, leg + _price(ground, from_x, from_y, x, y)):
            low = middle
        else:
            high = middle
    line[i, 0], line[i, 1] = from_x + low * dx, from_y + low * dy


@jit
def _cut(ground, line, need):
    """The line with two corners for one, where more can be cut off than an arc of the disc's radius does."""
    new = np.empty((2 * line.shape[0], 2))
    new[0] = line[0]
    count = 1
    for i in range(1, line.shape[0] - 1):
        x, y = line[i]
        back_x, back_y = new[count - 1, 0] - x, new[count - 1, 1] - y
        on_x, on_y = line[i + 1, 0] - x, line[i + 1, 1] - y
        back, on = np.sqrt(back_x**2 + back_y**2), np.sqrt(on_x**2 + on_y**2)
        if back > 0 and on > 0:
            cosine = (back_x * on_x + back_y * on_y) / (back * on)
            arc = need * np.sqrt(max(1 + cosine, 0.0) / max(1 - cosine, 1e-9))
            low, high = 0.0, 0.95 * min(back, on)
            for _ in range(_HALVINGS):
                d = (low + high) / 2
                share, other = d / back, d / on
                from_x, from_y = x + share * back_x, y + share * back_y
                to_x, to_y = x + other * on_x, y + other * on_y
                legs = _price(ground, from_x, from_y, x, y) + _price(ground, x, y, to_x, to_y)
                if _better(ground, from_x, from_y, to_x, to_y, need, legs):
                    low = d
                else:
                    high = d
            if low > 1.3 * arc + 1:
                new[count, 0], new[count, 1] = x + low / back * back_x, y + low / back * back_y
                new[count + 1, 0], new[count + 1, 1] = x + low / on * on_x, y + low / on * on_y
                count += 2
                continue
        new[count] = line[i]
        count += 1
    new[count] = line[-1]
    return new[: count + 1].copy()


@jit
def _to_square(ax, ay, bx, by, col, row):
    """Distance of a segment from a square of side 1 around a centre."""
    dx, dy = bx - ax, by - ay
    enter, leave = 0.0, 1.0
    for at, step, centre in ((ax, dx, col), (ay, dy, row)):
        if step == 0:
            if abs(at - centre) >= 0.5:
                enter = 2.0
        else:
            one, other = (centre - 0.5 - at) / step, (centre + 0.5 - at) / step
            enter, leave = max(enter, min(one, other)), min(leave, max(one, other))
    if enter < leave:
        return 0.0
    least = np.inf  # squared; of two shapes that are convex and apart a corner of one is nearest
    for x, y in ((ax, ay), (bx, by)):
        least = min(least, max(abs(x - col) - 0.5, 0.0) ** 2 + max(abs(y - row) - 0.5, 0.0) ** 2)
    length = dx * dx + dy * dy
    for aside in (-0.5, 0.5):
        for down in (-0.5, 0.5):
            x, y = col + aside - ax, row + down - ay
            share = min(max((x * dx + y * dy) / length, 0.0), 1.0) if length > 0 else 0.0
            least = min(least, (x - share * dx) ** 2 + (y - share * dy) ** 2)
    return np.sqrt(least)


@jit
def least_distance(cells, line, reach):
    """Least distance between a line and the squares of occupied cells, as far as `reach`; else `reach`.

    Square by square around each segment; shares no code with `clear`.

    Parameters
    ----------
    cells : uint8 (rows, cols)
        Occupied where 1.
    line : float64 (k, 2)
        x and y, k > 1.
    """
    rows, cols = cells.shape
    least = reach
    free = 0.0  # at the end of the segment before, at least
    for i in range(line.shape[0] - 1):
        ax, ay = line[i]
        bx, by = line[i + 1]
        length = np.sqrt((bx - ax) ** 2 + (by - ay) ** 2)
        free -= length
        if free > least:
            continue
        here = least + 2.0 * length + 1.0
        top, bottom = int(np.floor(min(ay, by) - here)), int(np.ceil(max(ay, by) + here))
        left, right = int(np.floor(min(ax, bx) - here)), int(np.ceil(max(ax, bx) + here))
        for row in range(max(top, 0), min(bottom + 1, rows)):
            if max(min(ay, by) - row, row - max(ay, by)) - 0.5 >= here:
                continue
            for col in range(max(left, 0), min(right + 1, cols)):
                if cells[row, col] == 1:
                    here = min(here, _to_square(ax, ay, bx, by, float(col), float(row)))
        least = min(least, here)
        free = here
    return least
