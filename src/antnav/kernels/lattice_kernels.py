"""A search over poses, compiled: arcs and lines that a robot drives forwards, from cell to cell and heading to heading.

Hybrid A*: D. Dolgov, S. Thrun, M. Montemerlo & J. Diebel, Path planning for autonomous vehicles in unknown
semi-structured environments, International Journal of Robotics Research 29(5) (2010) 485-501, doi
10.1177/0278364909359210 [source].
Dubins' words: A. M. Shkel & V. Lumelsky, Classification of the Dubins set, Robotics and Autonomous Systems 34 (2001)
179-202, doi 10.1016/S0921-8890(00)00127-5 [source]. Lines lie in cells, as in `trajectory_kernels`.
"""

from __future__ import annotations

import numpy as np

from antnav.kernels import heap
from antnav.kernels.graph import SQRT2
from antnav.kernels.jit import jit
from antnav.kernels.trajectory_kernels import clear, pieces_clear, swept_clear

_push, _pop = jit(heap.push), jit(heap.pop)
_HEADINGS = 72
_BINS = 2  #: Of positions, in a cell.
_STEP = 1.5  #: Length in cells of what is driven from node to node, at least.
_SWEEP = 0.1  #: Turn in radians of an arc from node to node, at least.
_GREED = 1.3  #: Factor of the estimate of the rest.
_TURNING = 0.05  #: What an arc costs on top of its length, for each cell.
#: Lengths of turns, 1 for left, -1 for right, 0 for straight, of the words that `words` fills.
WORDS = np.array([(1, 0, 1), (-1, 0, -1), (1, 0, -1), (-1, 0, 1), (-1, 1, -1), (1, -1, 1)], np.int64)


@jit
def words(d, alpha, beta):
    """Lengths in radii of the parts of Dubins' six words, shape (6, 3), nan where there is none (section 3)."""
    found = np.full((6, 3), np.nan)
    tau = 2 * np.pi
    sa, sb, ca, cb, cab = np.sin(alpha), np.sin(beta), np.cos(alpha), np.cos(beta), np.cos(alpha - beta)
    p2 = 2 + d * d - 2 * cab + 2 * d * (sa - sb)
    if p2 >= 0:
        turn = np.arctan2(cb - ca, d + sa - sb)
        found[0] = (turn - alpha) % tau, np.sqrt(p2), (beta - turn) % tau
    p2 = 2 + d * d - 2 * cab + 2 * d * (sb - sa)
    if p2 >= 0:
        turn = np.arctan2(ca - cb, d - sa + sb)
        found[1] = (alpha - turn) % tau, np.sqrt(p2), (turn - beta) % tau
    p2 = -2 + d * d + 2 * cab + 2 * d * (sa + sb)
    if p2 >= 0:
        p = np.sqrt(p2)
        turn = np.arctan2(-ca - cb, d + sa + sb) - np.arctan2(-2, p)
        found[2] = (turn - alpha) % tau, p, (turn - beta) % tau
    p2 = -2 + d * d + 2 * cab - 2 * d * (sa + sb)
    if p2 >= 0:
        p = np.sqrt(p2)
        turn = np.arctan2(ca + cb, d - sa - sb) - np.arctan2(2, p)
        found[3] = (alpha - turn) % tau, p, (beta - turn) % tau
    middle = (6 - d * d + 2 * cab + 2 * d * (sa - sb)) / 8
    if abs(middle) <= 1:
        p = tau - np.arccos(middle)
        t = (alpha - np.arctan2(ca - cb, d - sa + sb) + p / 2) % tau
        found[4] = t, p, (alpha - beta - t + p) % tau
    middle = (6 - d * d + 2 * cab + 2 * d * (sb - sa)) / 8
    if abs(middle) <= 1:
        p = tau - np.arccos(middle)
        t = (np.arctan2(cb - ca, d + sa - sb) - alpha + p / 2) % tau
        found[5] = t, p, (beta - alpha - t + p) % tau
    return found


@jit
def _along(x, y, heading, length, curvature):
    """The pose at the end of a piece."""
    if curvature == 0:
        return x + length * np.cos(heading), y + length * np.sin(heading), heading
    now = heading + curvature * length
    return (
        x + (np.sin(now) - np.sin(heading)) / curvature,
        y + (np.cos(heading) - np.cos(now)) / curvature,
        now,
    )


@jit
def onto(ground, start, goal, radius, need):
    """The shortest clear turn between two poses (x, y, heading), as pieces; none where there is none.

    One of Dubins' words; where the goal's heading is nan an arc and a line.
    """
    none = np.empty((0, 5))
    dx, dy = goal[0] - start[0], goal[1] - start[1]
    away, towards = np.sqrt(dx * dx + dy * dy), np.arctan2(dy, dx)
    parts, sides = np.full((6, 3), np.nan), WORDS
    if np.isnan(goal[2]):
        for k in range(2):
            side = float(WORDS[k, 0])
            ahead = np.cos(start[2]) * dx + np.sin(start[2]) * dy
            aside = side * (np.cos(start[2]) * dy - np.sin(start[2]) * dx) - radius  # from the centre of the arc
            rest = ahead * ahead + aside * aside - radius * radius
            if rest >= 0:
                line = np.sqrt(rest)
                turn = (np.arctan2(aside, ahead) + np.arctan2(radius, line)) % (2 * np.pi)
                parts[k] = turn, line / radius, 0.0
    else:
        parts = words(away / radius, (start[2] - towards) % (2 * np.pi), (goal[2] - towards) % (2 * np.pi))
    for k in range(6):
        for part in (0, 2):
            if 2 * np.pi - parts[k, part] < 1e-9:
                parts[k, part] = 0.0
    lengths = parts[:, 0] + parts[:, 1] + parts[:, 2]
    for _ in range(6):
        best = -1
        for k in range(6):
            if not np.isnan(lengths[k]) and (best < 0 or lengths[k] < lengths[best]):
                best = k
        if best < 0:
            return none
        lengths[best] = np.nan
        pieces = np.empty((3, 5))
        x, y, heading = start[0], start[1], start[2]
        count = 0
        for part in range(3):
            length, curvature = parts[best, part] * radius, sides[best, part] / radius
            if length > 1e-9:
                pieces[count] = x, y, heading, length, curvature
                x, y, heading = _along(x, y, heading, length, curvature)
                count += 1
        if pieces_clear(ground, pieces[:count], need):
            return pieces[:count].copy()
    return none


@jit
def _field(ground, start, goal, need, beyond):
    """Distance in cells to the goal over cells whose centres are clear, as far as the start and some way beyond."""
    rows, cols = ground.closed.shape
    field = np.full((rows, cols), np.inf)
    keys, items = np.empty(2 * rows * cols + 64), np.empty(2 * rows * cols + 64, np.int64)
    row, col = int(np.floor(goal[1] + 0.5)), int(np.floor(goal[0] + 0.5))
    to_row, to_col = int(np.floor(start[1] + 0.5)), int(np.floor(start[0] + 0.5))
    field[row, col] = 0.0
    size, limit = 1, np.inf
    keys[0], items[0] = 0.0, row * cols + col
    while size > 0:
        key = keys[0]
        item = _pop(keys, items, size)
        size -= 1
        row, col = item // cols, item % cols
        if key > limit:
            break
        if key > field[row, col]:
            continue
        if row == to_row and col == to_col:
            limit = min(limit, 1.3 * key + beyond)
        for down in range(-1, 2):
            for right in range(-1, 2):
                r, c = row + down, col + right
                if (down == 0 and right == 0) or not (0 <= r < rows and 0 <= c < cols):
                    continue
                g = key + (SQRT2 if down != 0 and right != 0 else 1.0)
                if g < field[r, c] and size < keys.size and clear(ground, float(c), float(r), float(c), float(r), need):
                    field[r, c] = g
                    _push(keys, items, size, g, r * cols + c)
                    size += 1
    return field


@jit
def _estimate(field, x, y):
    """The least of the field near a point: it may lie in a cell whose centre is not clear."""
    row, col = int(np.floor(y)), int(np.floor(x))
    least = np.inf
    for r in range(max(row, 0), min(row + 2, field.shape[0])):
        for c in range(max(col, 0), min(col + 2, field.shape[1])):
            least = min(least, field[r, c] + np.sqrt((r - y) ** 2 + (c - x) ** 2))
    return least


@jit
def _slot(table, key):
    """Where a key stands in a hash table, or may."""
    mask = table.size - 1
    at = (key * 0x9E3779B97F4A7C1 >> 17) & mask
    while table[at] >= 0 and table[at] != key:
        at = (at + 1) & mask
    return at


@jit
def _key(x, y, heading, width):
    turn = int(np.floor(heading / (2 * np.pi) * _HEADINGS + 0.5)) % _HEADINGS
    return (int(np.floor((y + 1) * _BINS)) * width + int(np.floor((x + 1) * _BINS))) * _HEADINGS + turn


@jit
def search(ground, start, goal, radius, need, limit):
    """A way between two poses, as pieces, none where none was found; and how many poses were looked at.

    Parameters
    ----------
    start, goal : float64 (3,)
        x, y and heading, nan for any.
    radius : float
        Of arcs, in cells.
    limit : int
        Poses that are looked at, at most.
    """
    none = np.empty((0, 5))
    cols = ground.closed.shape[1]
    field = _field(ground, start, goal, max(need - 0.75, 0.0), 12 * radius + 10)
    if np.isinf(_estimate(field, start[0], start[1])):
        return none, 0
    step = max(_STEP, _SWEEP * radius)
    size, count, width = 0, 0, (cols + 2) * _BINS
    most = 3 * limit + _HEADINGS
    keys, items = np.empty(most), np.empty(most, np.int64)
    pose, spent = np.empty((most, 3)), np.empty(most)
    parent, bend = np.full(most, -1, np.int64), np.zeros(most)
    bits = 64
    while bits < 2 * most:
        bits *= 2
    table, at_node, done = np.full(bits, -1, np.int64), np.empty(bits, np.int64), np.zeros(most, np.bool_)
    begins = _HEADINGS if np.isnan(start[2]) else 1
    for k in range(begins):
        heading = 2 * np.pi * k / begins if begins > 1 else start[2]
        pose[count] = start[0], start[1], heading
        spent[count] = 0.0
        slot = _slot(table, _key(start[0], start[1], heading, width))
        table[slot], at_node[slot] = _key(start[0], start[1], heading, width), count
        _push(keys, items, size, 0.0, count)
        count, size = count + 1, size + 1
    looked = 0
    wait, tries = 0.0, 0
    while size > 0 and looked < limit:
        node = _pop(keys, items, size)
        size -= 1
        if done[node]:
            continue
        done[node] = True
        looked += 1
        x, y, heading = pose[node]
        rest = _estimate(field, x, y)
        wait -= 1
        if wait <= 0:  # the farther away, and the more of it was in vain, the more seldom
            tail = onto(ground, pose[node], goal, radius, need)
            if tail.shape[0] > 0:
                return _way(pose, bend, parent, node, step, tail), looked
            tries += 1
            wait = rest / (2 * radius) + tries / 8
        for side in range(-1, 2):
            curvature = side / radius
            to_x, to_y, to_heading = _along(x, y, heading, step, curvature)
            to_heading %= 2 * np.pi
            beyond = _estimate(field, to_x, to_y)
            if np.isinf(beyond):
                continue
            key = _key(to_x, to_y, to_heading, width)
            g = spent[node] + step * (1 + _TURNING * abs(side))
            slot = _slot(table, key)
            if table[slot] >= 0 and spent[at_node[slot]] <= g:
                continue
            if not swept_clear(ground, x, y, heading, to_x, to_y, heading + curvature * step, curvature, need):
                continue
            if table[slot] >= 0:
                done[at_node[slot]] = True
            table[slot], at_node[slot] = key, count
            pose[count] = to_x, to_y, to_heading
            spent[count], parent[count], bend[count] = g, node, curvature
            _push(keys, items, size, g + _GREED * beyond, count)
            count, size = count + 1, size + 1
    return none, looked


@jit
def _way(pose, bend, parent, node, step, tail):
    """The pieces from the first pose to a node, and the tail."""
    count, at = 0, node
    while parent[at] >= 0:
        count, at = count + 1, parent[at]
    pieces = np.empty((count + tail.shape[0], 5))
    pieces[count:] = tail
    at = node
    while parent[at] >= 0:
        count -= 1
        before = parent[at]
        pieces[count] = pose[before, 0], pose[before, 1], pose[before, 2], step, bend[at]
        at = before
    return pieces


@jit
def shortened(ground, pieces, goal, radius, need):
    """Pieces with turns instead of many of them, where these are shorter and clear: from each the farthest found."""
    n = pieces.shape[0]
    ahead = np.zeros(n + 1)
    ahead[1:] = np.cumsum(pieces[:, 3])
    found = np.empty((3 * n + 3, 5))
    count, at = 0, 0
    begin = pieces[0, :3].copy()
    while at < n:
        best, turn = at + 1, pieces[at : at + 1]
        step = 2
        low, high = at + 1, n + 1
        while low < n and high - low > 1:
            to = min(low + step, n) if high > n else (low + high) // 2
            end = goal if to == n else pieces[to, :3]
            short = onto(ground, begin, end, radius, need)
            if short.shape[0] > 0 and short[:, 3].sum() <= ahead[to] - ahead[at] + 1e-9:
                low, best, turn = to, to, short
                step *= 2
            else:
                high = to
        found[count : count + turn.shape[0]] = turn
        count += turn.shape[0]
        at = best
        x, y, heading = _along(turn[-1, 0], turn[-1, 1], turn[-1, 2], turn[-1, 3], turn[-1, 4])
        begin[0], begin[1], begin[2] = x, y, heading
    return found[:count].copy()
