"""Exact searches that are taken up again where a map has changed, on the padded map of legal moves. Compiled.

`repair` is the optimised D* Lite (Koenig & Likhachev 2005, doi:10.1109/TRO.2004.838026), or LPA* (Koenig, Likhachev &
Furcy 2004, doi:10.1016/j.artint.2003.12.001) from the goal: they differ in what a robot that has moved does to the
queue. `adapt` is MPGAA* (Hernandez, Asin & Baier, AAAI 2015).

Costs are whole numbers of grains, `GRAIN` of them to a cell's length where nothing makes them coarser: sums are exact
in whatever order they are made, and no tie is decided by rounding. Moves cost the same either way.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from antnav.kernels import heap
from antnav.kernels.graph import SQRT2
from antnav.kernels.grid_kernels import COLS, DIAGONAL, HALVES, ROWS, offsets_of
from antnav.kernels.jit import jit

#: Grains in the length of a straight move. A diagonal one is off by less than 1e-10 of itself.
GRAIN = 2.0**32
#: More than any path costs.
FAR = np.int64(2**58)
#: Of a cell that stands in no queue.
_OUT = np.int64(-1)
#: No move.
_NONE = np.uint8(8)
_LENGTHS = np.where(DIAGONAL, round(SQRT2 * GRAIN), round(GRAIN)).astype(np.int64)
#: Columns of `Tree.node`, side by side in memory: cost to the goal when the cell was last expanded; the same by its
#: neighbours' g; key under which it stands in the queue, whose entries with other keys are stale; the move towards the
#: goal that rhs counts on.
G, RHS, KEY, MOVE = range(4)
#: Places of `Tree.numbers`: entries of the queue, k_m, where the robot was, the goal.
SIZE, SHIFT, ROBOT, GOAL = range(4)
#: Places of `Guide.numbers`: searches so far, whether the latest found no way, the goal.
SEARCHES, CUT, END = range(3)


class Scale(NamedTuple):
    """How costs become grains."""

    grain: float  #: grains to a cost of 1
    straight: int  #: no more than any straight move costs; for `repair` less
    diagonal: int  #: the same of diagonal moves
    spare: int  #: bits of a number that no path's cost needs


class Tree(NamedTuple):
    """What `repair` keeps of a search from the goal; one value a cell."""

    node: np.ndarray  #: int64 (n, 4), see `G`
    price: np.ndarray  #: float64, prices that rhs was worked out with; empty where there are none
    numbers: np.ndarray  #: int64 (4,)


class Guide(NamedTuple):
    """What `adapt` keeps of its searches from the robot; one value a cell."""

    g: np.ndarray  #: int64, cost from the robot, of the search that saw the cell last
    h: np.ndarray  #: int64, lower bound of the cost to the goal, -1 where it is the first one
    seen: np.ndarray  #: int32, twice the number of that search, one more where it expanded the cell
    parent: np.ndarray  #: uint8, move that led to the cell
    following: np.ndarray  #: uint8, move onwards on the latest path through the cell
    order: np.ndarray  #: int32, cells that the latest search has expanded
    numbers: np.ndarray  #: int64 (3,)


@jit
def _cost(cell, other, k, price, height, grain):
    """What move k from a cell to another costs."""
    if price.size == 0:
        return _LENGTHS[k]
    cost = np.int64(HALVES[k] * (price[cell] + price[other]) * grain + 0.5)
    if height.size > 0:
        cost += abs(np.int64(height[other] * grain) - np.int64(height[cell] * grain))
    return cost


@jit
def _bound(rows, cols, cell, other, height, scale):
    """No more than the cost of any path between two cells so many rows and columns apart.

    Where it lacks a grain a move, cost so far and bound of the rest together grow along every path: one number orders
    the queue of `repair` as the two of the published keys do.
    """
    rows, cols = abs(rows), abs(cols)
    least = min(rows, cols)
    bound = scale.straight * (max(rows, cols) - least) + scale.diagonal * least
    if height.size > 0:
        bound += abs(np.int64(height[other] * scale.grain) - np.int64(height[cell] * scale.grain))
    return bound


_push, _pop = jit(heap.push), jit(heap.pop)


@jit
def _look(cell, moves, offsets, price, height, grain, tree):
    """Work out rhs of a cell by its neighbours."""
    node = tree.node
    least, towards = FAR, _NONE
    legal = moves[cell]
    for k in range(8):
        if not legal >> k & 1:
            continue
        other = cell + offsets[k]
        if node[other, G] < least:
            cost = node[other, G] + _cost(cell, other, k, price, height, grain)
            if cost < least:
                least, towards = cost, np.uint8(k)
    node[cell, RHS], node[cell, MOVE] = least, towards


@jit
def _holds(cell, offsets, price, height, grain, node):
    """Whether rhs of a cell is still what the neighbour says that it counts on."""
    k = node[cell, MOVE]
    if k == _NONE:
        return True
    other = cell + offsets[k]
    return node[cell, RHS] == node[other, G] + _cost(cell, other, k, price, height, grain)


@jit
def _enqueue(cell, bound, tree, keys, items, size):
    """Put a cell into the queue, or take it out, as g and rhs say. Returns the size of the queue."""
    node, numbers = tree.node, tree.numbers
    key = _OUT
    if node[cell, G] != node[cell, RHS]:
        key = min(node[cell, G], node[cell, RHS]) + bound + numbers[SHIFT]
    if node[cell, KEY] != key:
        node[cell, KEY] = key
        if key != _OUT:
            _push(keys, items, size, key, cell)
            size += 1
    return size


@jit
def _put(cell, width, start, height, scale, tree, keys, items, size):
    """`_enqueue` where the robot is at `start`."""
    rows, cols = cell // width - start // width, cell % width - start % width
    return _enqueue(cell, _bound(rows, cols, cell, start, height, scale), tree, keys, items, size)


@jit
def _renew(cell, goal, moves, width, offsets, prices, scale, start, tree, keys, items, size):
    """Look at a cell, and queue it if need be. Returns the size of the queue."""
    if cell == goal:
        return size
    _look(cell, moves, offsets, prices.cells, prices.heights, scale.grain, tree)
    return _put(cell, width, start, prices.heights, scale, tree, keys, items, size)


@jit
def _room(keys, items, size, node):
    """Throw stale entries out of a queue; where that does not halve it, give it twice the room."""
    count = 0
    capacity = keys.size
    old_keys, old_items = keys[:size].copy(), items[:size].copy()
    fresh = 0
    for i in range(size):
        fresh += node[old_items[i], KEY] == old_keys[i]
    if 2 * fresh > capacity:
        keys, items = np.empty(2 * capacity, np.int64), np.empty(2 * capacity, np.int32)
    for i in range(size):
        if node[old_items[i], KEY] == old_keys[i]:
            _push(keys, items, count, old_keys[i], np.int64(old_items[i]))
            count += 1
    return keys, items, count


@jit
def root(tree, start, goal, width, prices, scale, keys, items):
    """Begin: nothing is known but that the goal is reached from itself."""
    node, known, numbers = tree
    known[:] = prices.cells
    node[:, G] = FAR
    node[:, RHS] = FAR
    node[:, KEY] = _OUT
    node[:, MOVE] = 8
    node[goal, RHS] = 0
    numbers[SIZE], numbers[SHIFT], numbers[ROBOT], numbers[GOAL] = 0, 0, start, goal
    numbers[SIZE] = _put(goal, width, start, prices.heights, scale, tree, keys, items, 0)


@jit
def repair(moves, width, prices, scale, tree, keys, items, cells, start, reorder):
    """Search on, from the goal towards a robot at `start`, after the moves or prices of `cells` have changed.

    Parameters
    ----------
    keys, items : int64 and int32
        The queue.
    cells : int32
        Cells whose moves or prices are others now.
    reorder : bool
        Where the robot has moved, work out all keys anew, as LPA* must; else raise k_m, as D* Lite does.

    Returns
    -------
    (path, keys, items)
        path int32: flat cells from start to goal, empty where there is no way; the queue, which may have grown.
    """
    price, _, height = prices
    grain = scale.grain
    node, known, numbers = tree
    offsets = offsets_of(width)
    size, goal, robot = numbers[SIZE], numbers[GOAL], numbers[ROBOT]
    top, left = start // width, start % width
    if start != robot:
        numbers[ROBOT] = start
        if not reorder:
            numbers[SHIFT] += _bound(top - robot // width, left - robot % width, robot, start, height, scale)
        else:
            count = 0
            for i in range(size):
                cell = np.int64(items[i])
                if node[cell, KEY] != keys[i]:
                    continue
                node[cell, KEY] = _OUT
                count = _put(cell, width, start, height, scale, tree, keys, items, count)
            size = count
    for i in range(cells.size):
        cell = np.int64(cells[i])
        if size + 9 > keys.size:
            keys, items, size = _room(keys, items, size, node)
        size = _renew(cell, goal, moves, width, offsets, prices, scale, start, tree, keys, items, size)
        if price.size > 0 and price[cell] != known[cell]:
            for k in range(8):
                other = cell + offsets[k]
                if moves[cell] >> k & 1 and price[other] == known[other]:
                    size = _renew(other, goal, moves, width, offsets, prices, scale, start, tree, keys, items, size)
    if price.size > 0:
        for i in range(cells.size):
            known[cells[i]] = price[cells[i]]
    shift = numbers[SHIFT]
    while size > 0:
        key = keys[0]
        cell = np.int64(items[0])
        if (
            node[cell, KEY] == key
            and key >= min(node[start, G], node[start, RHS]) + shift
            and node[start, RHS] <= node[start, G]
        ):
            if _holds(start, offsets, price, height, grain, node):
                break
            if size == keys.size:
                keys, items, size = _room(keys, items, size, node)
            size = _renew(start, goal, moves, width, offsets, prices, scale, start, tree, keys, items, size)
            continue
        _pop(keys, items, size)
        size -= 1
        if node[cell, KEY] != key:
            continue
        node[cell, KEY] = _OUT
        if size + 9 > keys.size:
            keys, items, size = _room(keys, items, size, node)
        if not _holds(cell, offsets, price, height, grain, node):
            _look(cell, moves, offsets, price, height, grain, tree)
        row = cell // width
        down, right = row - top, cell - row * width - left
        bound = _bound(down, right, cell, start, height, scale)
        if node[cell, G] == node[cell, RHS]:
            continue
        if key < min(node[cell, G], node[cell, RHS]) + bound + shift:
            size = _enqueue(cell, bound, tree, keys, items, size)
            continue
        legal = moves[cell]
        lowered = node[cell, G] > node[cell, RHS]
        node[cell, G] = node[cell, RHS] if lowered else FAR
        if not lowered:
            size = _enqueue(cell, bound, tree, keys, items, size)
        for k in range(8):
            if not legal >> k & 1:
                continue
            other = cell + offsets[k]
            if lowered:
                cost = node[cell, G] + _cost(cell, other, k, price, height, grain)
                if cost >= node[other, RHS]:
                    continue
                node[other, RHS], node[other, MOVE] = cost, np.uint8(7 - k)
            elif node[other, MOVE] == 7 - k and node[other, G] == node[other, RHS]:
                _look(other, moves, offsets, price, height, grain, tree)
            else:  # what stands in the queue is looked at when it leaves it
                continue
            bound = _bound(down + ROWS[k], right + COLS[k], other, start, height, scale)
            size = _enqueue(other, bound, tree, keys, items, size)
    numbers[SIZE] = size
    return _follow(node[:, MOVE], offsets, start, goal, node[start, RHS] < FAR), keys, items


@jit
def aim(guide, goal):
    """Begin: of the way to a goal nothing is known but the first lower bound."""
    guide.h[:] = -1
    guide.h[goal] = 0
    guide.seen[:] = 0
    guide.following[:] = _NONE
    guide.numbers[SEARCHES], guide.numbers[CUT], guide.numbers[END] = 0, 0, goal


@jit
def _lower(cell, bound, h, following, keys, items, size):
    """Lower the bound of a cell where it lies above another one. Returns the size of the queue."""
    if h[cell] > bound:
        h[cell], following[cell] = bound, _NONE
        _push(keys, items, size, bound, cell)
        size += 1
    return size


@jit
def _more(keys, items):
    """A queue with twice the room."""
    return np.append(keys, keys), np.append(items, items)


@jit
def _leads(cell, goal, moves, offsets, price, height, grain, h, following):
    """Whether an earlier path leads from a cell to the goal for what its bound says; where not, it is forgotten."""
    at = cell
    while at != goal:
        k = following[at]
        if k == _NONE or not moves[at] >> k & 1:
            break
        other = at + offsets[k]
        if h[at] != h[other] + _cost(at, other, k, price, height, grain):
            break
        at = other
    if at == goal:
        return True
    while True:
        k = following[cell]
        following[cell] = _NONE
        if cell == at:
            return False
        cell += offsets[k]


@jit
def adapt(moves, width, prices, scale, guide, keys, items, cells, start):
    """Search from a robot at `start`, with what is known of the way to the goal.

    Parameters
    ----------
    keys, items : int64 and int32
        Room for a queue.
    cells : int32
        Cells whose moves or prices are others since the last search.

    Returns
    -------
    (path, keys, items)
        path int32: flat cells from start to goal, empty where there is no way; the queue, which may have grown.
    """
    price, _, height = prices
    grain = scale.grain
    g, h, seen, parent, following, order, numbers = guide
    offsets = offsets_of(width)
    goal = numbers[END]
    goal_row, goal_col = goal // width, goal % width
    closed = 2 * numbers[SEARCHES] + 1
    cut = numbers[CUT] > 0
    dear = price.size > 0
    size = 0
    for i in range(cells.size):
        cell = np.int64(cells[i])
        legal = moves[cell]
        if legal == 0:
            continue
        row = cell // width
        down, right = row - goal_row, cell - row * width - goal_col
        if h[cell] < 0:
            h[cell] = _bound(down, right, cell, goal, height, scale)
        if size + 9 > keys.size:
            keys, items = _more(keys, items)
        least = FAR
        for k in range(8):
            if not legal >> k & 1:
                continue
            other = cell + offsets[k]
            if cut and (seen[cell] == closed) != (seen[other] == closed):
                cut = False
            if h[other] < 0:
                h[other] = _bound(down + ROWS[k], right + COLS[k], other, goal, height, scale)
            cost = _cost(cell, other, k, price, height, grain)
            least = min(least, h[other] + cost)
            if dear:  # else the other one is among the cells, too
                size = _lower(other, h[cell] + cost, h, following, keys, items, size)
        size = _lower(cell, least, h, following, keys, items, size)
    while size > 0:
        key = keys[0]
        cell = np.int64(_pop(keys, items, size))
        size -= 1
        if h[cell] != key:
            continue
        while size + 8 > keys.size:
            keys, items = _more(keys, items)
        for k in range(8):
            other = cell + offsets[k]
            if moves[cell] >> k & 1 and h[other] > key:
                bound = key + _cost(cell, other, k, price, height, grain)
                size = _lower(other, bound, h, following, keys, items, size)
    if cut and seen[start] == closed:
        return np.empty(0, np.int32), keys, items
    numbers[SEARCHES] += 1
    numbers[CUT] = 0
    opened = 2 * numbers[SEARCHES]
    closed = opened + 1
    cell = np.int64(start)
    if h[cell] < 0:
        h[cell] = _bound(cell // width - goal_row, cell % width - goal_col, cell, goal, height, scale)
    coarse = 0  # ties of a key's cost are broken by the bound's leading bits
    most = (np.int64(1) << scale.spare) - 1
    while h[cell] >> coarse > most:
        coarse += 1
    g[cell], seen[cell], parent[cell] = 0, opened, _NONE
    keys[0], items[0] = h[cell] << scale.spare, cell
    size = 1
    count = 0
    found = False
    while size > 0:
        cell = np.int64(_pop(keys, items, size))
        size -= 1
        if seen[cell] == closed:
            continue
        if _leads(cell, goal, moves, offsets, price, height, grain, h, following):
            found = True
            break
        seen[cell] = closed
        order[count] = cell
        count += 1
        while size + 8 > keys.size:
            keys, items = _more(keys, items)
        row = cell // width
        down, right = row - goal_row, cell - row * width - goal_col
        for k in range(8):
            other = cell + offsets[k]
            if not moves[cell] >> k & 1 or seen[other] == closed:
                continue
            cost = g[cell] + _cost(cell, other, k, price, height, grain)
            if seen[other] == opened and cost >= g[other]:
                continue
            if h[other] < 0:
                h[other] = _bound(down + ROWS[k], right + COLS[k], other, goal, height, scale)
            g[other], seen[other], parent[other] = cost, opened, k
            key = (cost + h[other]) << scale.spare | min(h[other] >> coarse, most)
            _push(keys, items, size, key, other)
            size += 1
    if not found:
        numbers[CUT] = 1
        return np.empty(0, np.int32), keys, items
    least = g[cell] + h[cell]
    for i in range(count):
        h[order[i]] = least - g[order[i]]
    while cell != start:
        k = parent[cell]
        cell -= offsets[k]
        following[cell] = k
    return _follow(following, offsets, start, goal, True), keys, items


@jit
def _follow(move, offsets, start, goal, reached):
    """Cells from `start` to `goal` along a move of each, int32; empty where it is not reached."""
    if not reached:
        return np.empty(0, np.int32)
    path = np.empty(2048, np.int32)
    path[0] = cell = start
    count = 1
    while cell != goal:
        cell += offsets[move[cell]]
        if count == path.size:
            longer = np.empty(2 * count, np.int32)
            longer[:count] = path
            path = longer
        path[count] = cell
        count += 1
    return path[:count].copy()
