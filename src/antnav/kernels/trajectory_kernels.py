"""A robot that moves over squares, compiled: whether it touches one, the shortest line near a path, the least distance.

The robot is a disc, or a convex polygon with a margin around it that turns as it drives.

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
NO_BODY = np.zeros((0, 2))


class Ground(NamedTuple):
    """What a robot keeps off."""

    to_wall: np.ndarray  #: int32 (rows, cols), as `GridMap.rows_to_wall`
    closed: np.ndarray  #: uint8 (rows, cols), cells that its centre does not enter
    price: np.ndarray  #: float64 (rows, cols), what a cell costs on top of 1 for each cell of way; (0, 0) for nothing
    body: np.ndarray = NO_BODY  #: float64 (n, 2), corners of a convex robot that heads along x, in order; none: a disc
    inscribed: float = 0.0  #: radius of the largest disc around its centre that the body holds


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
def _walled(ground, col, row, end):
    """Whether a cell of a column is occupied, from one row to another: the nearest one to the middle tells."""
    middle = (row + end) // 2
    away = ground.to_wall[middle, col]
    return away <= middle - row or (middle + away <= end and ground.to_wall[middle + away, col] == 0)


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
        if row <= end and _walled(ground, col, row, end):
            return False
    return True


@jit
def _corners(ground, ax, ay, heading_a, bx, by, heading_b):
    """The convex hull of the body in two poses, shape (n + 1, 2), closed: the last corner is the first."""
    n = ground.body.shape[0]
    points = np.empty((2 * n, 2))
    for k in range(2 * n):
        x, y, heading = (ax, ay, heading_a) if k < n else (bx, by, heading_b)
        ahead, aside = ground.body[k % n]
        x += ahead * np.cos(heading) - aside * np.sin(heading)
        y += ahead * np.sin(heading) + aside * np.cos(heading)
        at = k
        while at > 0 and (points[at - 1, 0] > x or (points[at - 1, 0] == x and points[at - 1, 1] > y)):
            points[at] = points[at - 1]
            at -= 1
        points[at, 0], points[at, 1] = x, y
    hull = np.empty((4 * n + 1, 2))
    count = 0
    for way in range(2):  # one side from left to right, the other one back
        base = count
        for k in range(2 * n):
            x, y = points[k] if way == 0 else points[2 * n - 1 - k]
            while count >= base + 2 - way:
                one, other = hull[count - 2], hull[count - 1]
                if (other[0] - one[0]) * (y - one[1]) - (other[1] - one[1]) * (x - one[0]) > 0:
                    break
                count -= 1
            if way == 0 or k > 0:
                hull[count, 0], hull[count, 1] = x, y
                count += 1
    return hull[:count]


@jit
def body_clear(ground, ax, ay, heading_a, bx, by, heading_b, margin):
    """Whether the hull of the body in two poses, and what is nearer to it than a margin, touches no square.

    Column by column, as `clear`: the hull with its margin is the union of the traces of a disc along its edges, and of
    what lies between.
    """
    rows, cols = ground.closed.shape
    hull = _corners(ground, ax, ay, heading_a, bx, by, heading_b)
    radius = max(margin - _TOUCH, 0.0)
    low, high = hull[:, 0].min() - radius + _TOUCH, hull[:, 0].max() + radius - _TOUCH
    for col in range(max(int(np.floor(low + 0.5)), 0), min(int(np.floor(high + 0.5)), cols - 1) + 1):
        top, bottom = np.inf, -np.inf
        for i in range(hull.shape[0] - 1):
            from_x, from_y = hull[i]
            to_x, to_y = hull[i + 1]
            if from_x > to_x:
                from_x, from_y, to_x, to_y = to_x, to_y, from_x, from_y
            left, right = max(from_x - radius, col - 0.5, low), min(to_x + radius, col + 0.5, high)
            if right < left:
                continue
            top_x, bottom_x = (from_x, to_x) if from_y < to_y else (to_x, from_x)
            bottom = max(bottom, _lowest(min(max(bottom_x, left), right), from_x, from_y, to_x, to_y, radius))
            top = min(top, -_lowest(min(max(top_x, left), right), from_x, -from_y, to_x, -to_y, radius))
        row, end = max(int(np.floor(top + 0.5 + _TOUCH)), 0), min(int(np.ceil(bottom - 0.5 - _TOUCH)), rows - 1)
        if row <= end and _walled(ground, col, row, end):
            return False
    return True


@jit
def _outer(ground):
    """How far the body's farthest corner lies from its centre."""
    most = 0.0
    for k in range(ground.body.shape[0]):
        most = max(most, ground.body[k, 0] ** 2 + ground.body[k, 1] ** 2)
    return np.sqrt(most)


@jit
def swept_clear(ground, ax, ay, heading_a, bx, by, heading_b, curvature, need):
    """Whether the robot is clear on its way along a line, or an arc of less than a half turn, between two poses.

    All points of the robot move on circles around one centre, and leave the hull of both poses by no more than the
    largest of these arcs leaves its chord.
    """
    half = abs(heading_b - heading_a) / 2
    extra = (1 - np.cos(half)) / abs(curvature) if curvature != 0 else 0.0
    if not clear(ground, ax, ay, bx, by, need + extra if need > 0 else 0.0):
        return False
    if ground.body.shape[0] == 0:
        return True
    outer, margin = _outer(ground), need - ground.inscribed
    if clear(ground, ax, ay, bx, by, outer + margin + extra):
        return True
    return body_clear(ground, ax, ay, heading_a, bx, by, heading_b, margin + extra + outer * (1 - np.cos(half)))


@jit
def straight_clear(ground, ax, ay, bx, by, need):
    """Whether the robot is clear as it drives straight from a to b."""
    if ground.body.shape[0] == 0:
        return clear(ground, ax, ay, bx, by, need)
    heading = np.arctan2(by - ay, bx - ax)
    return swept_clear(ground, ax, ay, heading, bx, by, heading, 0.0, need)


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
        chords = 1
        if curvature != 0:
            chords = int(np.ceil(length * np.sqrt(abs(curvature) / (8 * _SAGITTA)))) + 1
        from_x, from_y, from_heading = x, y, heading
        for k in range(1, chords + 1):
            s = length * k / chords
            to_heading = heading + curvature * s
            if curvature == 0:
                to_x, to_y = x + s * np.cos(heading), y + s * np.sin(heading)
            else:
                to_x = x + (np.sin(to_heading) - np.sin(heading)) / curvature
                to_y = y - (np.cos(to_heading) - np.cos(heading)) / curvature
            if not swept_clear(ground, from_x, from_y, from_heading, to_x, to_y, to_heading, curvature, need):
                return False
            from_x, from_y, from_heading = to_x, to_y, to_heading
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
    if not straight_clear(ground, ax, ay, bx, by, need):
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
def body_distance(cells, body, poses, reach):
    """Least distance between a convex polygon in poses and the squares of occupied cells, as far as `reach`.

    Pose by pose and square by square, edge by edge; shares no code with `body_clear`.

    Parameters
    ----------
    body : float64 (n, 2)
        Corners in order, of a robot that heads along x.
    poses : float64 (k, 3)
        x, y and heading, so close to each other that nothing is missed between them.
    """
    rows, cols = cells.shape
    n = body.shape[0]
    outer = np.sqrt((body**2).sum(axis=1).max())
    least, free = reach, 0.0  # free: of the pose before, at least
    for i in range(poses.shape[0]):
        x, y, heading = poses[i]
        if i > 0:
            moved = np.sqrt((x - poses[i - 1, 0]) ** 2 + (y - poses[i - 1, 1]) ** 2)
            free -= moved + outer * abs(np.sin((heading - poses[i - 1, 2]) / 2)) * 2
        if free > least:
            continue
        here = reach
        at_x = x + body[:, 0] * np.cos(heading) - body[:, 1] * np.sin(heading)
        at_y = y + body[:, 0] * np.sin(heading) + body[:, 1] * np.cos(heading)
        for row in range(max(int(y - outer - reach), 0), min(int(y + outer + reach) + 2, rows)):
            for col in range(max(int(x - outer - reach), 0), min(int(x + outer + reach) + 2, cols)):
                if cells[row, col] != 1 or max(abs(row - y), abs(col - x)) > outer + here + 0.5:
                    continue
                left = right = False
                for k in range(n):
                    ax, ay, bx, by = at_x[k], at_y[k], at_x[(k + 1) % n], at_y[(k + 1) % n]
                    here = min(here, _to_square(ax, ay, bx, by, float(col), float(row)))
                    side = (bx - ax) * (row - ay) - (by - ay) * (col - ax)
                    left, right = left or side > 0, right or side < 0
                if not (left and right):
                    here = 0.0  # the square's centre lies within
        least, free = min(least, here), here
    return least


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
