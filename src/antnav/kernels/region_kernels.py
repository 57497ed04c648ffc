"""Regions of a map that changes, routes over them, and a path that is mended where it broke. Compiled.

A region is a connected component of the open cells of a square block, as in `grid_kernels.regions`. Those of block b
are numbered b * most, b * most + 1, ... in map order, so that regions kept up to date equal those made anew.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from antnav.kernels import heap
from antnav.kernels.graph import SQRT2
from antnav.kernels.grid_kernels import (
    COLS,
    DIAGONAL,
    ROWS,
    climb,
    cost_along,
    new_scratch,
    octile,
    offsets_of,
    one_region,
    put,
    reoptimise,
    room,
    search_box,
    thread_route,
    through,
)
from antnav.kernels.jit import jit

_push, _pop = jit(heap.push), jit(heap.pop)

#: What of a block is stale: its regions, and the crossings out of them.
LABELS, LINKS = 1, 2
#: What `mend` found: the path is whole, mended, or broken beyond a box.
WHOLE, MENDED, BROKEN = 0, 1, 2


class Regions(NamedTuple):
    """Regions and the crossings between them, kept up to date block by block, each when it is asked for.

    `region` holds one value a cell of the padded map, `number` one a block, `centre`, `price` and `head` `most` values
    a block. Crossings are linked lists, one a region: from `head` on along `after`; unused ones begin at `spare[0]`.
    """

    block: int  #: side of a block in cells
    most: int  #: regions that a block may have
    region: np.ndarray  #: int32, region of each cell, -1 where a cell has no move
    number: np.ndarray  #: int32, how many regions each block has
    centre: np.ndarray  #: int32, cell nearest to the mean of the region's cells
    price: np.ndarray  #: float64, mean price of the region's cheapest cells, as many as a block's side
    head: np.ndarray  #: int32, a region's first crossing, -1 for none
    after: np.ndarray  #: int32, the next crossing of the same region, or unused
    other: np.ndarray  #: int32, region behind the crossing
    leave: np.ndarray  #: int32, last cell before it
    enter: np.ndarray  #: int32, first cell behind it
    length: np.ndarray  #: float64, from centre to centre
    spare: np.ndarray  #: int64 (2,): first unused crossing, number of unused ones
    stale: np.ndarray  #: uint8, one a block: LABELS and LINKS where they are to be worked out before they are used
    full: np.ndarray  #: int64 (1,): not 0 where there was no room, for regions (1) or for crossings (2)


class Routing(NamedTuple):
    """Scratch of searches over regions: one value a region, told from older ones by `stamp`."""

    cost: np.ndarray  #: float64
    by: np.ndarray  #: int32, crossing that led there
    before: np.ndarray  #: int32, region before
    stamp: np.ndarray  #: int32, 2 * search where reached, + 1 where done with
    flooded: np.ndarray  #: int32, search in which the flood from the goal came there
    stack: np.ndarray  #: int32, of that flood
    place: np.ndarray  #: int32, one a cell: where a path has it last
    number: np.ndarray  #: int32 (1,), of the latest search


@jit
def _corner(regions, block, width):
    """First row and column of a block on the padded map."""
    across = (width - 3) // regions.block + 1
    return block // across * regions.block + 1, block % across * regions.block + 1


@jit
def _block_of(regions, cell, width):
    across = (width - 3) // regions.block + 1
    return (cell // width - 1) // regions.block * across + (cell % width - 1) // regions.block


@jit
def _unlink(regions, region):
    """Give back a region's crossings."""
    e = regions.head[region]
    while e >= 0:
        following = regions.after[e]
        regions.after[e] = regions.spare[0]
        regions.spare[0] = e
        regions.spare[1] += 1
        e = following
    regions.head[region] = -1


@jit
def _label(regions, block, moves, width, price):
    """Find a block's regions anew."""
    side, most = regions.block, regions.most
    top, left = _corner(regions, block, width)
    bottom, right = min(top + side, moves.size // width - 1), min(left + side, width - 1)
    box = top, bottom, left, right
    region = regions.region
    regions.stale[block] &= ~LABELS
    for i in range(regions.number[block]):
        _unlink(regions, block * most + i)
    for row in range(top, bottom):
        region[row * width + left : row * width + right] = -1
    rows = np.empty(side * side, np.int32)
    cols = np.empty(side * side, np.int32)
    cheap = np.empty(side * side if price.size > 0 else 0, np.float64)
    count = 0
    for first_row in range(top, bottom):
        for first_col in range(left, right):
            first = first_row * width + first_col
            if moves[first] == 0 or region[first] >= 0:
                continue
            if count == most:
                regions.full[0] = 1
                continue
            this = block * most + count
            size, regions.centre[this] = one_region(moves, width, box, first, this, region, rows, cols)
            regions.price[this] = 1.0
            if price.size > 0:
                for i in range(size):
                    cheap[i] = price[rows[i] * width + cols[i]]
                least = np.sort(cheap[:size])[: min(size, side)]
                regions.price[this] = least.sum() / least.size
            regions.head[this] = -1
            count += 1
    regions.number[block] = count


@jit
def _link(regions, block, moves, width, heights):
    """Find the crossings out of a block anew, for each pair of regions the one that joins their centres best."""
    side, most = regions.block, regions.most
    region, centre, price = regions.region, regions.centre, regions.price
    offsets = offsets_of(width)
    top, left = _corner(regions, block, width)
    bottom, right = min(top + side, moves.size // width - 1), min(left + side, width - 1)
    for i in range(regions.number[block]):
        _unlink(regions, block * most + i)
    if regions.spare[1] < 12 * side:  # a block's edge has fewer moves out of it
        regions.full[0] = 2
        return
    for row in range(top, bottom):
        on_edge = row in (top, bottom - 1)
        for col in range(left, right, 1 if on_edge else max(1, right - 1 - left)):
            cell = row * width + col
            one = region[cell]
            if one < 0:
                continue
            for k in range(8):
                r, c = row + ROWS[k], col + COLS[k]
                if not moves[cell] >> k & 1 or (top <= r < bottom and left <= c < right):
                    continue
                other_cell = cell + offsets[k]
                two = region[other_cell]
                if two < 0:
                    continue  # there was no room for it
                if DIAGONAL[k] and (region[cell + ROWS[k] * width] == two or region[cell + COLS[k]] == two):
                    continue
                near = octile(row - centre[one] // width, col - centre[one] % width)
                far = octile(r - centre[two] // width, c - centre[two] % width)
                length = through(near, SQRT2 if DIAGONAL[k] else 1.0, far, price[one], price[two])
                length += climb(heights, centre[one], cell, other_cell, centre[two])
                e = regions.head[one]
                while e >= 0 and regions.other[e] != two:
                    e = regions.after[e]
                if e < 0:
                    e = regions.spare[0]
                    regions.spare[0] = regions.after[e]
                    regions.spare[1] -= 1
                    regions.after[e] = regions.head[one]
                    regions.head[one] = e
                    regions.other[e] = two
                    regions.length[e] = np.inf
                if length < regions.length[e] - 1e-9:
                    regions.length[e] = length
                    regions.leave[e], regions.enter[e] = cell, other_cell


@jit
def touch(regions, cells, width):
    """Note that moves or prices of some cells are others: regions of their blocks, and crossings around, are stale."""
    across = (width - 3) // regions.block + 1
    stale = regions.stale
    for i in range(cells.size):
        block = _block_of(regions, cells[i], width)
        if stale[block] & LABELS:
            continue
        stale[block] |= LABELS
        row, col = block // across, block % across
        for r in range(max(0, row - 1), row + 2):
            for c in range(max(0, col - 1), min(across, col + 2)):
                if r * across + c < stale.size:
                    stale[r * across + c] |= LINKS


@jit
def _ready(regions, block, moves, width, prices):
    """Work out what is stale of a block's regions and crossings."""
    if not regions.stale[block]:
        return
    across = (width - 3) // regions.block + 1
    row, col = block // across, block % across
    for r in range(max(0, row - 1), row + 2):
        for c in range(max(0, col - 1), min(across, col + 2)):
            near = r * across + c
            if near < regions.stale.size and regions.stale[near] & LABELS:
                _label(regions, near, moves, width, prices.cells)
    _link(regions, block, moves, width, prices.heights)
    regions.stale[block] = 0


@jit
def make_ready(regions, moves, width, prices):
    """Work out whatever is stale."""
    for block in range(regions.stale.size):
        _ready(regions, block, moves, width, prices)


@jit
def _region_of(regions, cell, moves, width, prices):
    """The region of a cell, worked out where it is stale."""
    block = _block_of(regions, cell, width)
    if regions.stale[block] & LABELS:
        _label(regions, block, moves, width, prices.cells)
    return regions.region[cell]


@jit
def route(regions, routing, moves, width, start, goal, bound, wall, prices):
    """A route over regions by A*, and beside it a flood from the goal, which soon knows where a goal is walled in.

    The regions of start and goal lie where these cells are, not at their centres.

    Parameters
    ----------
    start, goal : int
        Flat cells.
    bound : float
        Routes that are as long or longer are not followed.
    wall : bool
        Whether the flood goes along.

    Returns
    -------
    (length, stops)
        inf where there is no such route; stops int32: start, the two cells of each crossing, goal.
    """
    most, centre, price, heights = regions.most, regions.centre, regions.price, prices.heights
    number = routing.number[0] + 1
    routing.number[0] = number
    cost, by, before, stamp = routing.cost, routing.by, routing.before, routing.stamp
    first = _region_of(regions, start, moves, width, prices)
    last = _region_of(regions, goal, moves, width, prices)
    if first < 0 or last < 0:
        return np.inf, np.empty(0, np.int32)
    goal_row, goal_col = goal // width, goal % width
    keys = np.empty(1024, np.float64)
    items = np.empty(1024, np.int32)
    cost[first], stamp[first], by[first] = 0.0, 2 * number, -1
    keys[0], items[0] = 0.0, first
    size = 1
    flooding = wall and first != last
    low, high = 0, 1
    routing.stack[0] = last
    routing.flooded[last] = number
    while size > 0:
        this = _pop(keys, items, size)
        size -= 1
        if stamp[this] == 2 * number + 1:
            continue
        stamp[this] = 2 * number + 1
        if this == last:
            break
        if flooding:
            if routing.flooded[this] == number:
                flooding = False
            elif low == high:
                return np.inf, np.empty(0, np.int32)
            else:
                two = routing.stack[low]
                _ready(regions, two // most, moves, width, prices)
                e = regions.head[two]
                low += 1
                while e >= 0:
                    two = regions.other[e]
                    if routing.flooded[two] != number:
                        routing.flooded[two] = number
                        routing.stack[high] = two
                        high += 1
                    e = regions.after[e]
        here = start if this == first else centre[this]
        _ready(regions, this // most, moves, width, prices)
        e = regions.head[this]
        while e >= 0:
            two = regions.other[e]
            if stamp[two] != 2 * number + 1:
                length = regions.length[e]
                there = goal if two == last else centre[two]
                if this == first or two == last:
                    leave, enter = regions.leave[e], regions.enter[e]
                    near = octile(leave // width - here // width, leave % width - here % width)
                    step = octile(enter // width - leave // width, enter % width - leave % width)
                    far = octile(there // width - enter // width, there % width - enter % width)
                    length = through(near, step, far, price[this], price[two])
                    length += climb(heights, here, leave, enter, there)
                g = cost[this] + length
                if stamp[two] != 2 * number or g < cost[two]:
                    key = g + octile(there // width - goal_row, there % width - goal_col)
                    if key < bound:
                        cost[two], stamp[two], by[two], before[two] = g, 2 * number, e, this
                        if size == keys.size:
                            keys = np.append(keys, keys)
                            items = np.append(items, items)
                        _push(keys, items, size, key, two)
                        size += 1
            e = regions.after[e]
    if stamp[last] != 2 * number + 1:
        return np.inf, np.empty(0, np.int32)
    count = 0
    this = last
    while this != first:
        this = before[this]
        count += 1
    stops = np.empty(2 * count + 2, np.int32)
    stops[0], stops[2 * count + 1] = start, goal
    this = last
    for i in range(count, 0, -1):
        stops[2 * i], stops[2 * i - 1] = regions.enter[by[this]], regions.leave[by[this]]
        this = before[this]
    return cost[last], stops


@jit
def _whole(path, at, moves, width, offsets):
    """Whether move `at` of a path is legal."""
    step = path[at + 1] - path[at]
    for k in range(8):
        if offsets[k] == step:
            return moves[path[at]] >> k & 1 != 0
    return False


@jit
def without_loops(path, place):
    """The path with every loop cut out: from each cell on, it goes on where it leaves that cell for the last time."""
    for i in range(path.size):
        place[path[i]] = i
    size, at = 0, 0
    while at < path.size:
        at = place[path[at]]
        path[size] = path[at]
        size += 1
        at += 1
    return path[:size].copy()


@jit
def mend(path, moves, width, prices, reach, most, place):
    """Search the broken pieces of a path anew, each within a box around it and some moves on either side.

    Parameters
    ----------
    path : int32 (k,)
        Flat cells; its first and last are open.
    reach : int
        Moves that a piece takes along on either side, and cells that its box has around it; twice as many where that
        fails.
    most : int
        Longest broken piece in moves, with what lies between two of them.
    place : int32
        Scratch, one value a cell.

    Returns
    -------
    (state, path)
        WHOLE and the path; MENDED and the new one; BROKEN where a piece has no way within its box.
    """
    offsets = offsets_of(width)
    height = moves.size // width
    k = path.size
    first = 0
    while first < k - 1 and _whole(path, first, moves, width, offsets):
        first += 1
    if first == k - 1:
        return WHOLE, path
    better = np.empty(2 * k + 1024, np.int32)
    size = 0  # of what is kept
    done = 0  # path[:done] is dealt with
    while first < k - 1:
        last = first + 1  # moves first..last - 1 are in the piece
        look = last
        while look < k - 1 and look - last < 2 * reach:
            if not _whole(path, look, moves, width, offsets):
                last = look + 1
            look += 1
        if last - first > most:
            return BROKEN, path
        steps = -1
        for wider in range(1, 3):
            begin, end = max(done, first - wider * reach), min(k - 1, last + wider * reach)
            while end < k - 1 and moves[path[end]] == 0:
                end += 1
            while begin > done and moves[path[begin]] == 0:
                begin -= 1
            top, bottom, left, right = height, 0, width, 0
            for i in range(begin, end + 1):
                row = path[i] // width
                col = path[i] - row * width
                top, bottom = min(top, row), max(bottom, row + 1)
                left, right = min(left, col), max(right, col + 1)
            margin = wider * reach
            box = (
                max(1, top - margin),
                min(height - 1, bottom + margin),
                max(1, left - margin),
                min(width - 1, right + margin),
            )
            area = (box[1] - box[0]) * (box[3] - box[2])
            if area > (most + 6 * reach) ** 2:
                return BROKEN, path
            piece = np.empty(area, np.int32)
            steps = search_box(
                moves,
                width,
                box,
                path[begin],
                path[end],
                np.inf,
                np.empty(area, np.uint8),
                new_scratch(area),
                piece,
                prices,
                room(prices, area),
            )
            if steps >= 0:
                break
        if steps < 0:
            return BROKEN, path
        while size + (begin - done) + steps + 1 + k > better.size:
            better = np.append(better, better)
        put(better, size, path, done, begin)
        size += begin - done
        put(better, size, piece, 0, steps)
        size += steps
        done = end
        first = end
        while first < k - 1 and _whole(path, first, moves, width, offsets):
            first += 1
    put(better, size, path, done, k)
    size += k - done
    return MENDED, without_loops(better[:size], place)


@jit
def lay_out(regions, routing, stops, path, good, from_goal, moves, width, prices, window):
    """The path along a route, which keeps the path in force at both ends as far as both lead through the same regions.

    Parameters
    ----------
    stops : int32
        Of a route from path[0] to path[-1]; see `route`.
    path : int32
        The path in force; of length 1 where there is none.
    good, from_goal : int
        Its first moves and its last ones that are legal, so many.
    window : int
        Moves of the windows in which what is new is made shorter, at two offsets; 0 for none.
    """
    region = regions.region
    k, m = path.size, stops.size // 2  # stops 2 i and 2 i + 1 lie in region i of the route
    for i in range(k):
        _region_of(regions, path[i], moves, width, prices)
    head, i = 0, 0
    if k > 1:
        while head < good and i < m:
            onward = region[path[head + 1]]
            if onward == region[stops[2 * i]]:
                head += 1
            elif i + 1 < m and onward == region[stops[2 * i + 2]]:
                head += 1
                i += 1
            else:
                break
    tail, j = k - 1, m - 1
    if k > 1:
        while k - 1 - tail < from_goal and j >= i and tail > head + 1:
            onward = region[path[tail - 1]]
            if onward == region[stops[2 * j]]:
                tail -= 1
            elif j > i and onward == region[stops[2 * j - 2]]:
                tail -= 1
                j -= 1
            else:
                break
    some = stops[2 * i : 2 * j + 2].copy()
    if k > 1:
        some[0], some[some.size - 1] = path[head], path[tail]
    middle = thread_route(moves, width, regions.block, some, prices)
    if k == 1:
        head, tail = 0, 0
        whole = middle
    else:
        whole = without_loops(np.concatenate((path[:head], middle, path[tail + 1 :])), routing.place)
    if window > 0 and whole.size > 2:
        begin, end = max(0, head - window), min(whole.size, head + middle.size + window)
        piece = whole[begin:end].copy()
        piece = reoptimise(moves, width, piece, window, window // 2, prices)
        piece = reoptimise(moves, width, piece, window, 0, prices)
        whole = without_loops(np.concatenate((whole[:begin], piece, whole[end:])), routing.place)
    return whole


@jit
def in_common(path, before):
    """Cells at the beginning and at the end that two paths have in common."""
    least = min(path.size, before.size)
    first = 0
    while first < least and path[first] == before[first]:
        first += 1
    last = 0
    while last < least - first and path[path.size - 1 - last] == before[before.size - 1 - last]:
        last += 1
    return first, last


@jit
def legal_ends(path, moves, width):
    """Number of legal moves before the first broken one of a path, and behind the last."""
    offsets = offsets_of(width)
    k = path.size
    good = 0
    while good < k - 1 and _whole(path, good, moves, width, offsets):
        good += 1
    from_goal = 0
    while from_goal < k - 1 and _whole(path, k - 2 - from_goal, moves, width, offsets):
        from_goal += 1
    return good, from_goal


@jit
def least_gain(cells, start, goal, width):
    """Length of the shortest way on an empty map that leads through one of some cells."""
    least = np.inf
    for i in range(cells.size):
        row, col = cells[i] // width, cells[i] % width
        least = min(
            least,
            octile(row - start // width, col - start % width) + octile(row - goal // width, col - goal % width),
        )
    return least


@jit
def shorten_near(path, cells, moves, width, prices, window, place):
    """Search the piece of a path that comes nearest to some cells anew, in one window of twice so many moves.

    Returns
    -------
    (path, gained)
        The path, and by how much less it costs.
    """
    row, col, nearest, at = 0, 0, np.inf, 0
    for i in range(cells.size):
        row += cells[i] // width
        col += cells[i] % width
    for i in range(path.size):
        away = octile(path[i] // width - row / cells.size, path[i] % width - col / cells.size)
        if away < nearest:
            nearest, at = away, i
    begin, end = max(0, at - window), min(path.size, at + window + 1)
    if end - begin < 3:
        return path, 0.0
    better = reoptimise(moves, width, path[begin:end].copy(), 2 * window, 0, prices)
    whole = without_loops(np.concatenate((path[:begin], better, path[end:])), place)
    gained = cost_along(path, width, prices) - cost_along(whole, width, prices)
    if gained <= 0:
        return path, 0.0
    return whole, gained
