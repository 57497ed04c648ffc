"""Searches on the padded map of legal moves (`moves.legal_moves`), compiled.

Cells are flat indices into that map. A length is kept as its number of straight and diagonal moves and turned into a
float by one formula, straight + sqrt(2) diagonal: equal lengths compare equal, however they were put together.
"""

from __future__ import annotations

import numpy as np

from antnav._jit import jit

SQRT2 = 2.0**0.5
_DIAGONAL = np.array([1, 0, 1, 0, 0, 1, 0, 1], np.int32)


@jit
def _offsets(width):
    return np.array([-width - 1, -width, -width + 1, -1, 1, width - 1, width, width + 1], np.int64)


@jit
def flood(moves, width, start):
    """Cells that can be reached from `start`: (seen, count), seen uint8 of the shape of `moves`, flat."""
    offsets = _offsets(width)
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
def neighbour_table(moves, width, seen, count):
    """Number the cells of `seen` in map order and list their neighbours.

    Returns
    -------
    (cells, neighbours, lengths, reverse)
        cells int32 (n,): flat cell of node i; the rest as in `Graph`.
    """
    offsets = _offsets(width)
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
            legal = moves[cell] >> k & 1
            neighbours[i, k] = node[cell + offsets[k]] if legal else count
            lengths[i, k] = SQRT2 if _DIAGONAL[k] else 1.0
            reverse[i, k] = 7 - k
    return cells, neighbours, lengths, reverse


@jit
def _push(keys, items, size, key, item):
    """Put an item into a heap with four children a node; a hole moves up instead of swaps."""
    i = size
    while i > 0:
        parent = (i - 1) >> 2
        if keys[parent] <= key:
            break
        keys[i] = keys[parent]
        items[i] = items[parent]
        i = parent
    keys[i] = key
    items[i] = item


@jit
def _pop(keys, items, size):
    """Take the least item from a heap of `size` items."""
    item = items[0]
    size -= 1
    key, moved = keys[size], items[size]
    i = 0
    while True:
        first = 4 * i + 1
        if first >= size:
            break
        least = first
        for child in range(first + 1, min(first + 4, size)):
            if keys[child] < keys[least]:
                least = child
        if keys[least] >= key:
            break
        keys[i] = keys[least]
        items[i] = items[least]
        i = least
    keys[i] = key
    items[i] = moved
    return item


@jit
def search(moves, width, start, goal, guided):
    """A* from `start` to `goal` with the octile heuristic, or Dijkstra's algorithm where `guided` is false.

    With goal = -1 everything is searched. Among equal f, A* prefers the cell nearer to the goal: the heuristic is
    raised by 1e-11 of itself. Below 200,000 cells that cannot change the result, since two lengths a + sqrt(2) b that
    differ at all then differ by more; beyond, the result is within 1e-11 of the optimum.

    Returns
    -------
    (length, parent, expanded)
        length float64, flat: exact length from start, inf where not reached; final for expanded cells.
        parent uint8, flat: the move that led to each cell. expanded: number of cells taken from the queue.
    """
    offsets = _offsets(width)
    straight = np.zeros(moves.size, np.int32)
    diagonal = np.zeros(moves.size, np.int32)
    length = np.full(moves.size, np.inf)
    parent = np.zeros(moves.size, np.uint8)
    closed = np.zeros(moves.size, np.uint8)
    capacity = 1024
    keys = np.empty(capacity, np.float64)
    items = np.empty(capacity, np.int32)
    goal_row, goal_col = goal // width, goal % width
    length[start] = 0.0
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
        for k in range(8):
            other = cell + offsets[k]
            if not moves[cell] >> k & 1 or closed[other]:
                continue
            s = straight[cell] + 1 - _DIAGONAL[k]
            d = diagonal[cell] + _DIAGONAL[k]
            g = s + SQRT2 * d
            if g >= length[other]:
                continue
            length[other] = g
            straight[other] = s
            diagonal[other] = d
            parent[other] = k
            key = g
            if guided:
                row = other // width
                rows = abs(row - goal_row)
                cols = abs(other - row * width - goal_col)
                least = min(rows, cols)
                beyond = max(rows, cols) - least
                key = (s + beyond) + SQRT2 * (d + least) + 1e-11 * (beyond + SQRT2 * least)
            if size == capacity:
                capacity *= 2
                keys = np.append(keys, keys)
                items = np.append(items, items)
            _push(keys, items, size, key, other)
            size += 1
    return length, parent, expanded


@jit
def trace(parent, width, start, goal):
    """Flat cells from `start` to `goal`, int32, along the moves that `search` noted."""
    offsets = _offsets(width)
    count = 1
    cell = goal
    while cell != start:
        cell -= offsets[parent[cell]]
        count += 1
    path = np.empty(count, np.int32)
    cell = goal
    for i in range(count - 1, -1, -1):
        path[i] = cell
        cell -= offsets[parent[cell]]
    return path
