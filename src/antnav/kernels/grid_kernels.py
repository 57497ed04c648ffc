"""Searches on the padded map of legal moves (`moves.legal_moves`), compiled.

Cells are flat indices into that map. A length is kept as its number of straight and diagonal moves and turned into a
float by one formula, straight + sqrt(2) diagonal: equal lengths compare equal, however they were put together.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from antnav.kernels import heap
from antnav.kernels.graph import SQRT2
from antnav.kernels.jit import jit

DIAGONAL = np.array([1, 0, 1, 0, 0, 1, 0, 1], np.int32)
#: Half of each move's length, which the sum of two prices is multiplied by.
HALVES = np.where(DIAGONAL, 0.5 * SQRT2, 0.5)
ROWS = np.array([-1, -1, -1, 0, 0, 1, 1, 1], np.int32)
COLS = np.array([-1, 0, 1, -1, 1, -1, 0, 1], np.int32)
#: Of a cell's legal moves, as bits, those that connectivity needs: where a diagonal one lies beside a straight one, two
#: straight moves lead there too.
ESSENTIAL = np.array(
    [
        legal
        & ~sum(
            1 << diagonal
            for diagonal, beside in ((0, 0b01010), (2, 0b10010), (5, 0b1001000), (7, 0b1010000))
            if legal & beside
        )
        for legal in range(256)
    ],
    np.uint8,
)
#: Moves that leave a box by its first and last row, and by its first and last column.
_UP, _DOWN, _LEFT, _RIGHT = 0b00000111, 0b11100000, 0b00101001, 0b10010100


@jit
def offsets_of(width):
    """What each move adds to a flat cell, int64 (8,)."""
    return np.array([-width - 1, -width, -width + 1, -1, 1, width - 1, width, width + 1], np.int64)


@jit
def flood(moves, width, start):
    """Cells that can be reached from `start`: (seen, count), seen uint8 of the shape of `moves`, flat."""
    offsets = offsets_of(width)
    seen = np.zeros(moves.size, np.uint8)
    stack = np.empty(moves.size, np.int32)
    stack[0] = start
    seen[start] = 1
    size = 1
    count = 0
    while size > 0:
        size -= 1
        cell = stack[size]
        count += 1
        for k in range(8):
            if moves[cell] >> k & 1:
                other = cell + offsets[k]
                if not seen[other]:
                    seen[other] = 1
                    stack[size] = other
                    size += 1
    return seen, count


@jit
def components(moves, width):
    """Connected components of the cells: int32, flat; 1, 2, ... in map order, 0 where a cell has no move."""
    offsets = offsets_of(width)
    label = np.zeros(moves.size, np.int32)
    stack = np.empty(moves.size, np.int32)
    count = 0
    for first in range(moves.size):
        if moves[first] == 0 or label[first]:
            continue
        count += 1
        label[first] = count
        stack[0] = first
        size = 1
        while size > 0:
            size -= 1
            cell = stack[size]
            legal = ESSENTIAL[moves[cell]]
            for k in range(8):
                other = cell + offsets[k]
                if legal >> k & 1 and not label[other]:
                    label[other] = count
                    stack[size] = other
                    size += 1
    return label


@jit
def neighbour_table(moves, width, seen, count):
    """Number the cells of `seen` in map order and list their neighbours among them.

    Returns
    -------
    (cells, neighbours, lengths, reverse)
        cells int32 (n,): flat cell of node i; the rest as in `Graph`.
    """
    offsets = offsets_of(width)
    node = np.full(moves.size, -1, np.int32)
    cells = np.empty(count, np.int32)
    n = 0
    for cell in range(moves.size):
        if seen[cell]:
            node[cell] = n
            cells[n] = cell
            n += 1
    neighbours = np.empty((count, 8), np.int32)
    lengths = np.empty((count, 8), np.float64)
    reverse = np.empty((count, 8), np.uint8)
    for i in range(count):
        cell = cells[i]
        for k in range(8):
            other = node[cell + offsets[k]]
            neighbours[i, k] = other if moves[cell] >> k & 1 and other >= 0 else count
            lengths[i, k] = SQRT2 if DIAGONAL[k] else 1.0
            reverse[i, k] = 7 - k
    return cells, neighbours, lengths, reverse


_push, _pop = jit(heap.push), jit(heap.pop)


class Prices(NamedTuple):
    """What moves cost beside their lengths: each its length times the mean of its two cells' prices, and its climb.

    Both are alike either way: what more it costs to go up than to go down decides no path, see `PathCost`.
    """

    cells: np.ndarray  #: float64, price of each cell of the padded map, flat, >= 1; empty where cost is length
    cheapest: float  #: the least price
    heights: np.ndarray  #: float64, flat: a move costs the difference of its cells' heights; empty where all is level


class Scratch(NamedTuple):
    """Arrays of a search, one value a cell; they may be longer than the map."""

    straight: np.ndarray  #: int32, straight moves from the start, where moves have no prices
    diagonal: np.ndarray  #: int32, diagonal moves, likewise
    length: np.ndarray  #: float64
    parent: np.ndarray  #: uint8, move that led to the cell
    closed: np.ndarray  #: uint8


@jit
def new_scratch(size):
    """Scratch for maps of so many cells."""
    return Scratch(
        np.empty(size, np.int32),
        np.empty(size, np.int32),
        np.empty(size, np.float64),
        np.empty(size, np.uint8),
        np.empty(size, np.uint8),
    )


@jit
def _search(moves, width, start, goal, guided, bound, scratch, prices):
    """See `search`; paths that cost `bound` or more are not followed. Returns the number of cells expanded."""
    price, cheapest, height = prices
    dear, hilly = price.size > 0, height.size > 0
    offsets = offsets_of(width)
    straight, diagonal, length, parent, closed = scratch
    length[: moves.size] = np.inf
    closed[: moves.size] = 0
    capacity = 1024
    keys = np.empty(capacity, np.float64)
    items = np.empty(capacity, np.int32)
    goal_row, goal_col = goal // width, goal % width
    straight[start], diagonal[start], length[start] = 0, 0, 0.0
    keys[0], items[0] = 0.0, start
    size = 1
    expanded = 0
    while size > 0:
        cell = _pop(keys, items, size)
        size -= 1
        if closed[cell]:
            continue
        closed[cell] = 1
        expanded += 1
        if cell == goal:
            break
        legal, reached = moves[cell], length[cell]
        down = cell // width - goal_row
        right = cell - cell // width * width - goal_col
        for k in range(8):
            other = cell + offsets[k]
            if not legal >> k & 1 or closed[other]:
                continue
            if dear:
                s = d = 0
                g = reached + HALVES[k] * (price[cell] + price[other])
                if hilly:
                    g += abs(height[other] - height[cell])
            else:
                s = straight[cell] + 1 - DIAGONAL[k]
                d = diagonal[cell] + DIAGONAL[k]
                g = s + SQRT2 * d
            if g >= length[other]:
                continue
            key = g
            if guided:
                rows = abs(down + ROWS[k])
                cols = abs(right + COLS[k])
                least = min(rows, cols)
                beyond = max(rows, cols) - least
                if dear:
                    key = g + (1.0 + 1e-11) * cheapest * (beyond + SQRT2 * least)
                    if hilly:
                        key += abs(height[goal] - height[other])
                else:
                    key = (s + beyond) + SQRT2 * (d + least) + 1e-11 * (beyond + SQRT2 * least)
            if key >= bound:
                continue
            length[other] = g
            parent[other] = k
            if not dear:
                straight[other] = s
                diagonal[other] = d
            if size == capacity:
                capacity *= 2
                keys = np.append(keys, keys)
                items = np.append(items, items)
            _push(keys, items, size, key, other)
            size += 1
    return expanded


@jit
def search(moves, width, start, goal, guided, prices):
    """A* from `start` to `goal` with the octile heuristic, or Dijkstra's algorithm where `guided` is false.

    Parameters
    ----------
    prices : Prices

    With goal = -1 everything is searched. Among equal f, A* prefers the cell nearer to the goal: the heuristic is
    raised by 1e-11 of itself. Below 200,000 cells that cannot change the result, since two lengths a + sqrt(2) b that
    differ at all then differ by more; beyond, the result is within 1e-11 of the optimum.

    Returns
    -------
    (length, parent, expanded)
        length float64, flat: exact length from start, inf where not reached; final for expanded cells.
        parent uint8, flat: the move that led to each cell. expanded: number of cells taken from the queue.
    """
    scratch = new_scratch(moves.size)
    expanded = _search(moves, width, start, goal, guided, np.inf, scratch, prices)
    return scratch.length, scratch.parent, expanded


@jit
def search_turning(moves, width, start, goal, guided, prices, turns, entry, onward, bound):
    """`search` where turns cost, too: its states are cells with the move that led there.

    Parameters
    ----------
    turns : float64 (9, 8)
        Cost of a move by the last move + 1, 0 before the first.
    entry, onward : int
        Of a piece of a path, the move before it + 1, else 0, and the move after it, else -1: turns into both count.
    bound : float
        Paths that cost so much or more are not followed.

    Returns
    -------
    (cost, path, expanded)
        cost float64 of the cheapest path, inf where there is none; path int32 flat, empty then; expanded states.
    """
    offsets = offsets_of(width)
    price, cheapest, height = prices
    dear, hilly = price.size > 0, height.size > 0
    cost = np.full(8 * moves.size, np.inf)
    last = np.empty(8 * moves.size, np.uint8)  # of a state: the move before its own, + 1
    closed = np.zeros(8 * moves.size, np.uint8)
    capacity = 1024
    keys = np.empty(capacity, np.float64)
    items = np.empty(capacity, np.int32)
    goal_row, goal_col = goal // width, goal % width
    size, expanded = 0, 0
    state, cell, heading, reached = -1, start, entry, 0.0
    while True:
        if cell == goal:
            break
        down = cell // width - goal_row
        right = cell - cell // width * width - goal_col
        for k in range(8):
            other = cell + offsets[k]
            if not moves[cell] >> k & 1 or closed[8 * other + k]:
                continue
            step = 2.0 * HALVES[k]
            if dear:
                step = HALVES[k] * (price[cell] + price[other])
                if hilly:
                    step += abs(height[other] - height[cell])
            g = reached + step + turns[heading, k]
            if other == goal and onward >= 0:
                g += turns[k + 1, onward]
            if g >= cost[8 * other + k]:
                continue
            key = g
            if guided:
                key += (1.0 + 1e-11) * cheapest * octile(down + ROWS[k], right + COLS[k])
                if hilly:
                    key += abs(height[goal] - height[other])
            if key >= bound:
                continue
            cost[8 * other + k] = g
            last[8 * other + k] = heading
            if size == capacity:
                capacity *= 2
                keys = np.append(keys, keys)
                items = np.append(items, items)
            _push(keys, items, size, key, 8 * other + k)
            size += 1
        state = -1
        while size > 0 and state < 0:
            state = _pop(keys, items, size)
            size -= 1
            if closed[state]:
                state = -1
        if state < 0:
            return np.inf, np.empty(0, np.int32), expanded
        closed[state] = 1
        expanded += 1
        cell, heading, reached = state >> 3, (state & 7) + 1, cost[state]
    count = 1
    at, by = cell, heading
    while at != start or by != entry:
        before = last[8 * at + by - 1]
        at -= offsets[by - 1]
        by = before
        count += 1
    path = np.empty(count, np.int32)
    at, by = cell, heading
    for i in range(count - 1, -1, -1):
        path[i] = at
        if i > 0:
            before = last[8 * at + by - 1]
            at -= offsets[by - 1]
            by = before
    return reached, path, expanded


@jit
def trace(parent, width, start, goal):
    """Flat cells from `start` to `goal`, int32, along the moves that `search` noted."""
    offsets = offsets_of(width)
    count = 1
    cell = goal
    while cell != start:
        cell -= offsets[parent[cell]]
        count += 1
    path = np.empty(count, np.int32)
    cell = goal
    for i in range(count - 1, 0, -1):
        path[i] = cell
        cell -= offsets[parent[cell]]
    path[0] = start
    return path


@jit
def length_along(path, width):
    """Length in cells of a sequence of neighbouring flat cells."""
    straight = 0
    for i in range(path.size - 1):
        step = abs(path[i + 1] - path[i])
        straight += step in (1, width)
    return straight + SQRT2 * (path.size - 1 - straight)


@jit
def length_inside(path, width, rows):
    """`length_along` of int32 cells, 0 without a move; nan where one of them lies outside the map."""
    for cell in path:
        row, col = cell // width, cell % width
        if not (1 <= row <= rows and 1 <= col <= width - 2):
            return np.nan
    return length_along(path, width) if path.size > 0 else 0.0


@jit
def distinct(path):
    """How many different numbers there are among some of 0 and more, int32."""
    last = 2  # of a table with open addresses, of which half stay free
    while last < 2 * path.size:
        last *= 2
    last -= 1
    table = np.full(last + 1, -1, np.int32)
    count = 0
    for cell in path:
        at = np.int64(cell) * 0x5F356495 >> 12 & last
        while table[at] >= 0 and table[at] != cell:
            at = at + 1 & last
        count += table[at] < 0
        table[at] = cell
    return count


@jit
def cost_along(path, width, prices):
    """Cost of a sequence of neighbouring flat cells, as `search` adds it up; its length where prices are empty."""
    price, _, height = prices
    if price.size == 0:
        return length_along(path, width)
    cost = 0.0
    for i in range(path.size - 1):
        step = abs(path[i + 1] - path[i])
        cost += (1.0 if step in (1, width) else SQRT2) * (0.5 * (price[path[i]] + price[path[i + 1]]))
        if height.size > 0:
            cost += abs(height[path[i + 1]] - height[path[i]])
    return cost


@jit
def joined(moves, width, stops, prices):
    """Stops that can reach each other joined by shortest paths, each from an A* search: (cells int64, cost)."""
    cells, guided = stops[:1].copy(), width > 0  # for a literal True the search would be compiled once more
    for i in range(1, stops.size):
        _, parent, _ = search(moves, width, stops[i - 1], stops[i], guided, prices)
        cells = np.append(cells, trace(parent, width, stops[i - 1], stops[i])[1:].astype(np.int64))
    return cells, cost_along(cells, width, prices)


@jit
def octile(rows, cols):
    """Length of a shortest path that leads over so many rows and columns of a map without obstacles."""
    rows, cols = abs(rows), abs(cols)
    least = min(rows, cols)
    return max(rows, cols) - least + SQRT2 * least


@jit
def distance_to_walls(rows_to_wall, cells, squares):
    """Least distance in cells between the cells of a path and occupied ones; inf where there is none of either.

    Parameters
    ----------
    rows_to_wall : int32 (rows, cols)
        As `GridMap.rows_to_wall`.
    cells : int32 (k, 2)
        Row and column, neighbour after neighbour.
    squares : bool
        Measure from the line through the centres to the edges of occupied cells, instead of between centres. On a
        straight move the nearest point is one of its ends; on a diagonal one it may be the middle.
    """
    cols = rows_to_wall.shape[1]
    half = 0.5 if squares else 0.0
    least = np.inf  # squared
    for i in range(cells.shape[0]):
        row, col = cells[i]
        for middle in range(2 if squares and i > 0 else 1):
            other_row, other_col = cells[i - middle]
            if middle and (row == other_row or col == other_col):
                continue
            left, right = min(col, other_col), max(col, other_col)
            for aside in range(cols):
                across = max(aside + 0.5 * middle - half, 0.0) ** 2
                if across >= least or (left - aside < 0 and right + aside >= cols):
                    break
                for at in (left - aside, right + aside):
                    if 0 <= at < cols:
                        along = min(rows_to_wall[row, at], rows_to_wall[other_row, at]) + 0.5 * middle
                        least = min(least, across + max(along - half, 0.0) ** 2)
    return np.sqrt(least)


@jit
def room(prices, size):
    """Scratch for the prices of so many cells, empty where those are."""
    cells = np.empty(size if prices.cells.size > 0 else 0, np.float64)
    return Prices(cells, prices.cheapest, np.empty(size if prices.heights.size > 0 else 0, np.float64))


@jit
def search_box(moves, width, box, start, goal, bound, local, scratch, path, prices, local_prices):
    """A shortest path inside a box of the padded map, if it costs less than `bound`.

    Parameters
    ----------
    box : (top, bottom, left, right)
        First row and column of the box, and the ones after its last, counted on the padded map.
    local : uint8; local_prices : Prices
        Scratch, one value a cell of the box; see `room`.
    path : int32
        Gets the flat cells, if there is a path.

    Returns
    -------
    int
        Number of moves, -1 where there is no such path.
    """
    top, bottom, left, right = box
    wide = right - left
    size = (bottom - top) * wide
    for row in range(bottom - top):
        from_left = (row + top) * width + left
        local[row * wide : (row + 1) * wide] = moves[from_left : from_left + wide]
        local[row * wide] &= 255 - _LEFT
        local[(row + 1) * wide - 1] &= 255 - _RIGHT
        if prices.cells.size > 0:
            local_prices.cells[row * wide : (row + 1) * wide] = prices.cells[from_left : from_left + wide]
        if prices.heights.size > 0:
            local_prices.heights[row * wide : (row + 1) * wide] = prices.heights[from_left : from_left + wide]
    for col in range(wide):
        local[col] &= 255 - _UP
        local[size - 1 - col] &= 255 - _DOWN
    from_cell = (start // width - top) * wide + start % width - left
    cell = (goal // width - top) * wide + goal % width - left
    _search(local[:size], wide, from_cell, cell, True, bound, scratch, local_prices)
    if not scratch.closed[cell]:
        return -1
    offsets = offsets_of(wide)
    steps, at = 0, cell
    while at != from_cell:
        at -= offsets[scratch.parent[at]]
        steps += 1
    for i in range(steps, -1, -1):
        row = cell // wide
        path[i] = (row + top) * width + cell - row * wide + left
        if i > 0:
            cell -= offsets[scratch.parent[cell]]
    return steps


@jit
def box_around(path, width, height, margin):
    """First row and column of the box some cells around a path, and the ones after its last, on the padded map."""
    top, bottom, left, right = height, 0, width, 0
    for cell in path:
        row = cell // width
        col = cell - row * width
        top, bottom = min(top, row), max(bottom, row + 1)
        left, right = min(left, col), max(right, col + 1)
    return (
        max(1, top - margin),
        min(height - 1, bottom + margin),
        max(1, left - margin),
        min(width - 1, right + margin),
    )


@jit
def put(cells, at, others, first, last):
    """`cells[at:] = others[first:last]`; where a slice is assigned, Numba compiles an error message, for a second."""
    for i in range(first, last):
        cells[at + i - first] = others[i]


@jit
def reoptimise(moves, width, path, window, offset, prices):
    """Replace pieces of a path by shortest paths within boxes around them (windows, as POPMUSIC has them).

    The path is cut into pieces of `window` moves, the first of `offset` moves where that is above 0. The box of a piece
    is its bounding box and a quarter of the window around. A piece that is as short as can be without obstacles stays.

    Parameters
    ----------
    path : int32 (k,)
        Flat cells.

    Returns
    -------
    int32
        The new path, which costs as much as before or less.
    """
    height = moves.size // width
    margin = window // 4
    side = window + 2 * margin + 1
    local = np.empty(side * side, np.uint8)
    local_prices = room(prices, side * side)
    scratch = new_scratch(side * side)
    piece = np.empty(side * side, np.int32)
    # A shorter path may have more cells: straight moves in place of diagonal ones.
    better = np.empty(int(length_along(path, width)) + 2, np.int32)
    better[0] = path[0]
    kept = 0
    first = 0
    last = offset if offset > 0 else window
    while first < path.size - 1:
        last = min(last, path.size - 1)
        steps = -1
        bound = cost_along(path[first : last + 1], width, prices) - 1e-9
        rows = path[last] // width - path[first] // width
        least = prices.cheapest * octile(rows, path[last] % width - path[first] % width)
        if prices.heights.size > 0:
            least += abs(prices.heights[path[last]] - prices.heights[path[first]])
        if bound > least:
            box = box_around(path[first : last + 1], width, height, margin)
            start, goal = path[first], path[last]
            steps = search_box(moves, width, box, start, goal, bound, local, scratch, piece, prices, local_prices)
        if kept + max(steps, last - first) >= better.size:  # a cheap way may be long
            better = np.append(better, np.empty(max(steps, last - first) + better.size, np.int32))
        if steps >= 0:
            put(better, kept, piece, 0, steps + 1)
            kept += steps
        else:
            put(better, kept, path, first, last + 1)
            kept += last - first
        first, last = last, last + window
    return better[: kept + 1].copy()


@jit
def one_region(moves, width, box, first, number, region, rows, cols):
    """Give a number to the connected component of a cell inside a box.

    Parameters
    ----------
    box : (top, bottom, left, right)
        As in `search_box`.
    first, number : int
        The component's first cell in map order, and its number.
    region : int32, flat
        Gets the number; less than 0 where no component has been found yet.
    rows, cols : int32
        Scratch, one value a cell of the box; the first `size` are those of the component's cells.

    Returns
    -------
    (size, centre)
        Number of its cells, and the one nearest to their mean.
    """
    top, bottom, left, right = box
    rows[0], cols[0] = first // width, first % width
    region[first] = number
    size, done = 1, 0
    row_sum, col_sum = 0, 0
    while done < size:
        row, col = rows[done], cols[done]
        done += 1
        row_sum += row
        col_sum += col
        legal = ESSENTIAL[moves[row * width + col]]
        for k in range(8):
            if not legal >> k & 1:
                continue
            r, c = row + ROWS[k], col + COLS[k]
            if top <= r < bottom and left <= c < right and region[r * width + c] < 0:
                region[r * width + c] = number
                rows[size], cols[size] = r, c
                size += 1
    nearest, centre = np.inf, first
    for i in range(size):
        distance = (rows[i] - row_sum / size) ** 2 + (cols[i] - col_sum / size) ** 2
        if distance < nearest:
            nearest = distance
            centre = rows[i] * width + cols[i]
    return size, centre


@jit
def regions(moves, width, block):
    """Regions: connected components of the cells inside each block of `block` cells a side, block by block.

    Returns
    -------
    (region, centre)
        region int32, flat: region of each cell, -1 where a cell has no move.
        centre int32 (n,): flat cell of the region nearest to the mean of its cells.
    """
    height = moves.size // width
    region = np.full(moves.size, -1, np.int32)
    centre = np.empty(1024, np.int32)
    rows = np.empty(block * block, np.int32)
    cols = np.empty(block * block, np.int32)
    count = 0
    for top in range(1, height - 1, block):
        bottom = min(top + block, height - 1)
        for left in range(1, width - 1, block):
            right = min(left + block, width - 1)
            for first_row in range(top, bottom):
                for first_col in range(left, right):
                    first = first_row * width + first_col
                    if moves[first] == 0 or region[first] >= 0:
                        continue
                    if count == centre.size:
                        centre = np.append(centre, centre)
                    box = top, bottom, left, right
                    _, centre[count] = one_region(moves, width, box, first, count, region, rows, cols)
                    count += 1
    return region, centre[:count].copy()


@jit
def through(near, step, far, price_one, price_two):
    """Cost of a way through a crossing: its lengths before it, of the move, and behind it, by the regions' prices."""
    return near * price_one + step * (0.5 * (price_one + price_two)) + far * price_two


@jit
def climb(heights, here, leave, enter, there):
    """Sum of the differences in `Prices.heights` along a way through a crossing; 0 where all is level."""
    if heights.size == 0:
        return 0.0
    return (
        abs(heights[leave] - heights[here])
        + abs(heights[enter] - heights[leave])
        + abs(heights[there] - heights[enter])
    )


@jit
def crossings(moves, width, block, region, centre, price, heights):
    """Neighbouring regions, and for each pair the move from one to the other that joins their centres best.

    A diagonal move from the region with the smaller number counts only where no straight move leads there too.

    Lengths are octile, from centre to centre, see `through` and `climb`; `price` is float64 (n,), 1 without costs. They
    guide; the path itself is searched on cells.

    Returns
    -------
    (first, other, leave, enter, length)
        The crossings of region i are those from first[i] on, before first[i + 1]: other int32 is the region behind,
        leave and enter int32 the flat cells of the move, length float64 the length from centre to centre.
    """
    n = centre.size
    height = moves.size // width
    offsets = offsets_of(width)
    rows = centre // width
    cols = centre - rows * width
    head = np.full(n, -1, np.int32)  # crossings of a region into ones with a larger number, as a linked list
    capacity = 4 * n + 16
    after = np.empty(capacity, np.int32)
    pair = np.empty((capacity, 4), np.int32)
    least = np.empty(capacity, np.float64)
    count = 0
    for top in range(1, height - 1, block):
        bottom = min(top + block, height - 1)
        for left in range(1, width - 1, block):
            right = min(left + block, width - 1)
            for row in range(top, bottom):
                on_edge = row in (top, bottom - 1)
                for col in range(left, right, 1 if on_edge else max(1, right - 1 - left)):
                    cell = row * width + col
                    one = region[cell]
                    if one < 0:
                        continue
                    for k in range(8):
                        if not moves[cell] >> k & 1:
                            continue
                        two = region[cell + offsets[k]]
                        if two <= one:
                            continue
                        beside = region[cell + ROWS[k] * width] == two or region[cell + COLS[k]] == two
                        if DIAGONAL[k] and beside:
                            continue
                        near = octile(row - rows[one], col - cols[one])
                        far = octile(row + ROWS[k] - rows[two], col + COLS[k] - cols[two])
                        length = through(near, SQRT2 if DIAGONAL[k] else 1.0, far, price[one], price[two])
                        length += climb(heights, centre[one], cell, cell + offsets[k], centre[two])
                        e = head[one]
                        while e >= 0 and pair[e, 1] != two:
                            e = after[e]
                        if e < 0:
                            if count == capacity:
                                capacity *= 2
                                after = np.append(after, after)
                                pair = np.concatenate((pair, pair))
                                least = np.append(least, least)
                            e = count
                            count += 1
                            after[e] = head[one]
                            head[one] = e
                            least[e] = np.inf
                        if length < least[e] - 1e-9:
                            least[e] = length
                            pair[e, 0], pair[e, 1], pair[e, 2], pair[e, 3] = one, two, cell, cell + offsets[k]
    first = np.zeros(n + 1, np.int32)
    for e in range(count):
        first[pair[e, 0] + 1] += 1
        first[pair[e, 1] + 1] += 1
    for i in range(n):
        first[i + 1] += first[i]
    fill = first[:n].copy()
    other = np.empty(2 * count, np.int32)
    leave = np.empty(2 * count, np.int32)
    enter = np.empty(2 * count, np.int32)
    lengths = np.empty(2 * count, np.float64)
    for e in range(count):
        for way in range(2):
            here, there = pair[e, way], pair[e, 1 - way]
            place = fill[here]
            fill[here] += 1
            other[place] = there
            leave[place], enter[place] = pair[e, 2 + way], pair[e, 3 - way]
            lengths[place] = least[e]
    return first, other, leave, enter, lengths


@jit
def region_table(first, other, length):
    """The graph of regions in the form of `Graph`, at most 8 neighbours a node.

    A region with more neighbours becomes a chain of nodes, joined by edges of length 0: slot 0 leads back, slot 7 on.

    Returns
    -------
    (owner, node, slot, neighbours, lengths, reverse)
        owner int32 (nodes,): region of each node; node int32 and slot uint8 of each crossing; the rest as in `Graph`.
    """
    n = first.size - 1
    base = np.zeros(n + 1, np.int32)
    for i in range(n):
        degree = first[i + 1] - first[i]
        base[i + 1] = base[i] + (1 if degree <= 8 else (degree + 3) // 6)  # 7 at either end, 6 between
    count = base[n]
    owner = np.empty(count, np.int32)
    node = np.empty(other.size, np.int32)
    slot = np.empty(other.size, np.uint8)
    neighbours = np.full((count, 8), count, np.int32)
    lengths = np.zeros((count, 8), np.float64)
    reverse = np.zeros((count, 8), np.uint8)
    for i in range(n):
        degree = first[i + 1] - first[i]
        for c in range(base[i], base[i + 1]):
            owner[c] = i
            if c > base[i]:
                neighbours[c, 0], reverse[c, 0] = c - 1, 7
                neighbours[c - 1, 7], reverse[c - 1, 7] = c, 0
        at, k = base[i], 0
        for e in range(first[i], first[i + 1]):
            if degree > 8 and k == 7 and at + 1 < base[i + 1]:
                at, k = at + 1, 1
            node[e], slot[e] = at, k
            k += 1
    for i in range(n):
        for e in range(first[i], first[i + 1]):
            back = first[other[e]]
            while other[back] != i:
                back += 1
            neighbours[node[e], slot[e]] = node[back]
            reverse[node[e], slot[e]] = slot[back]
            lengths[node[e], slot[e]] = length[e]
    return owner, node, slot, neighbours, lengths, reverse


@jit
def distances(neighbours, lengths, source):
    """Length of a shortest path from each node of a `Graph` to one of them, by Dijkstra's algorithm; float64 (n,)."""
    n = neighbours.shape[0]
    length = np.full(n, np.inf)
    closed = np.zeros(n, np.uint8)
    keys = np.empty(8 * n + 1, np.float64)
    items = np.empty(8 * n + 1, np.int32)
    length[source] = 0.0
    keys[0], items[0] = 0.0, source
    size = 1
    while size > 0:
        i = _pop(keys, items, size)
        size -= 1
        if closed[i]:
            continue
        closed[i] = 1
        for k in range(8):
            j = neighbours[i, k]
            if j < n and length[i] + lengths[i, k] < length[j]:
                length[j] = length[i] + lengths[i, k]
                _push(keys, items, size, length[j], j)
                size += 1
    return length


@jit
def thread_route(moves, width, block, stops, prices):
    """A path through the cells `stops`: a shortest path within a block from stop 0 to 1, from 2 to 3, and so on.

    Stops 1 and 2, 3 and 4, ... are the two cells of a crossing.

    Returns
    -------
    int32
        Flat cells.
    """
    height = moves.size // width
    local = np.empty(block * block, np.uint8)
    local_prices = room(prices, block * block)
    scratch = new_scratch(block * block)
    piece = np.empty(block * block, np.int32)
    path = np.empty(1024, np.int32)
    size = 0
    for i in range(0, stops.size, 2):
        while path.size < size + block * block:
            path = np.append(path, path)
        start, goal = stops[i], stops[i + 1]
        top = (start // width - 1) // block * block + 1
        left = (start % width - 1) // block * block + 1
        box = (top, min(top + block, height - 1), left, min(left + block, width - 1))
        steps = search_box(moves, width, box, start, goal, np.inf, local, scratch, piece, prices, local_prices)
        put(path, size, piece, 0, steps + 1)
        size += steps + 1
    return path[:size].copy()


@jit
def two_sides(moves, width, source, remaining, limit, prices, below):
    """Cheapest paths from `source`, and the cheapest that pass on another side of some marks, by Dijkstra's algorithm.

    Each mark has a ray upward from the right edge of its cell. A move to the right across it adds the mark to the sum
    of a path, one to the left takes it away, modulo 2**64. Two paths with one end and equal sums enclose no mark.

    Parameters
    ----------
    remaining : float64, flat
        Least cost from each cell to the far end.
    limit : float
        Paths that cannot lead there for this cost are not followed.
    below : int64, flat
        For each cell the sum of the marks farther down in its column.

    Returns
    -------
    (cost, total, parent)
        Of states 2 * cell and 2 * cell + 1, in no order: cost float64, inf where there is no such path; sum int64; the
        state before int32, -1 at the source. That two suffice is no guess: of three sides before a move, the third
        cannot become one of the best two after it.
    """
    price, _, height = prices
    dear, hilly = price.size > 0, height.size > 0
    offsets = offsets_of(width)
    cost = np.full(2 * moves.size, np.inf)
    total = np.zeros(2 * moves.size, np.int64)
    parent = np.full(2 * moves.size, -1, np.int32)
    closed = np.zeros(2 * moves.size, np.uint8)
    capacity = 1024
    keys = np.empty(capacity, np.float64)
    items = np.empty(capacity, np.int32)
    cost[2 * source] = 0.0
    keys[0], items[0] = 0.0, 2 * source
    size = 1
    while size > 0:
        key = keys[0]
        state = _pop(keys, items, size)
        size -= 1
        if closed[state] or key != cost[state]:
            continue
        closed[state] = 1
        cell = state >> 1
        for k in range(8):
            if not moves[cell] >> k & 1:
                continue
            other = cell + offsets[k]
            step = SQRT2 if DIAGONAL[k] else 1.0
            if dear:
                step = HALVES[k] * (price[cell] + price[other])
                if hilly:
                    step += abs(height[other] - height[cell])
            reached = key + step
            if reached + remaining[other] > limit:
                continue
            side = total[state]
            if COLS[k] != 0:
                side += COLS[k] * below[min(cell // width, other // width) * width + min(cell % width, other % width)]
            one, two = 2 * other, 2 * other + 1
            if cost[one] < np.inf and total[one] == side:
                slot = one
            elif cost[two] < np.inf and total[two] == side:
                slot = two
            else:
                slot = one if cost[one] > cost[two] else two
            if closed[slot] or reached >= cost[slot]:
                continue
            cost[slot], total[slot], parent[slot] = reached, side, state
            if size == capacity:
                capacity *= 2
                keys = np.append(keys, keys)
                items = np.append(items, items)
            _push(keys, items, size, reached, slot)
            size += 1
    cost[closed == 0] = np.inf
    return cost, total, parent
