"""Jump point search on the padded map of legal moves, compiled; see `search.exact` and docs/algorithms/exact.md.

Cells are flat indices, moves and lengths as in `grid_kernels`. A jump goes on in one direction to the next cell where a
shortest path may have to turn. Those cells, and the first one that is closed, are bits, 64 cells of a row or a column a
word, so that a jump looks at words.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from antnav.kernels import heap
from antnav.kernels.bits import lowest_bit
from antnav.kernels.graph import SQRT2
from antnav.kernels.grid_kernels import COLS, ROWS, box_around, length_along, octile, put
from antnav.kernels.jit import jit

_push, _pop = jit(heap.push), jit(heap.pop)
_ROOM = 128  #: nodes at first, a power of two
_SCATTER = 0x5F356495  #: < 2**31 and odd
#: Columns of a node: cell, straight and diagonal moves from the start, the node before, moves to go on by, and those
#: that have been gone.
_CELL, _STRAIGHT, _DIAGONAL, _BEFORE, _ONWARD, _GONE = range(6)


class Jumps(NamedTuple):
    """Where jumps end on a map."""

    words: np.ndarray  #: int64; of each row to the right, then to the left, of each column down, then up
    row_words: int  #: words of a row
    column_words: int
    onward: np.ndarray  #: uint8 (8, 256): moves that may follow a move, by it and the legal ones of the cell it led to


@jit
def _jump(moves, words, line, place, cell, step, most, to_goal):
    """Cells from one on to the end of its jump along a line of words, or to the goal before; 0 where all is closed."""
    at = line + (place + 1 >> 6)
    word = words[at] >> (place + 1 & 63)  # of a word below 0, what comes in lies above what was its highest bit
    if word != 0:
        far = 1 + lowest_bit(word)
    else:
        at += 1
        while words[at] == 0:
            at += 1
        far = ((at - line) << 6) + lowest_bit(words[at]) - place
    if 0 < to_goal <= far:
        return to_goal
    return 0 if far > most or moves[cell + far * step] == 0 else far


@jit
def _note(found, n, cell, straight, diagonal, onward):
    found[n, 0], found[n, 1], found[n, 2], found[n, 3] = cell, straight, diagonal, onward


@jit
def _successors(moves, width, jumps, box, goal, cell, onward, found):
    """The jump points that a cell leads to: cell, straight and diagonal moves, moves to go on by; returns their number.

    A diagonal jump goes on past cells from which straight jumps lead somewhere, to where it is closed or forced to
    turn: those cells are never queued, only where the straight jumps end.
    """
    words, row_words, column_words, following = jumps
    top, bottom, left, right = box
    height = moves.size // width
    row, col = cell // width, cell % width
    n = 0
    for k in range(8):
        if not onward >> k & 1:
            continue
        down, aside = ROWS[k], COLS[k]
        if aside > 0:
            along, step, most, to_goal = 4, 1, right - 1 - col, goal % width - col
            line, place = row * row_words, col
        else:
            along, step, most, to_goal = 3, -1, col - left, col - goal % width
            line, place = (height + row) * row_words, 64 * row_words - 1 - col
        if down > 0:
            across, leap, deepest, below = 6, width, bottom - 1 - row, goal // width - row
            column, depth = 2 * height * row_words + col * column_words, row
        else:
            across, leap, deepest, below = 1, -width, row - top, row - goal // width
            column, depth = 2 * height * row_words + (width + col) * column_words, 64 * column_words - 1 - row
        if down == 0 or aside == 0:
            if down == 0:
                far = _jump(moves, words, line, place, cell, step, most, to_goal if below == 0 else 0)
            else:
                far = _jump(moves, words, column, depth, cell, leap, deepest, below if to_goal == 0 else 0)
                step = leap
            if far > 0:
                other = cell + far * step
                _note(found, n, other, far, 0, following[k, moves[other]])
                n += 1
            continue
        natural = 1 << k | 1 << along | 1 << across
        at, legal = cell, moves[cell]
        for i in range(1, min(most, deepest) + 1):
            if not legal >> k & 1:
                break
            at += leap + step
            legal = moves[at]
            place += 1
            depth += 1
            line += down * row_words
            column += aside * column_words
            if at == goal or following[k, legal] | natural != natural:
                _note(found, n, at, 0, i, following[k, legal])
                n += 1
                break
            far = _jump(moves, words, line, place, at, step, most - i, to_goal - i if i == below else 0)
            if far > 0:
                other = at + far * step
                _note(found, n, other, far, i, following[along, moves[other]])
                n += 1
            far = _jump(moves, words, column, depth, at, leap, deepest - i, below - i if i == to_goal else 0)
            if far > 0:
                other = at + far * leap
                _note(found, n, other, far, i, following[across, moves[other]])
                n += 1
    return n


@jit
def _slot(table, cell):
    """Where a cell stands in a hash table, or could."""
    last = table.size - 1  # of a power of two
    at = cell * _SCATTER >> 12 & last
    while table[at] != 0 and table[at] >> 32 != cell:
        at = at + 1 & last
    return at


@jit
def _grown(nodes, count):
    """Room for as many nodes again, and a hash table of theirs."""
    nodes = np.concatenate((nodes, nodes))
    table = np.zeros(2 * nodes.shape[0], np.int64)
    for node in range(count):
        cell = np.int64(nodes[node, _CELL])
        table[_slot(table, cell)] = cell << 32 | node
    return nodes, table


@jit
def jump_search(moves, width, jumps, box, start, goal, bound):
    """A shortest path within a box: A* over the ends of jumps.

    Parameters
    ----------
    jumps : Jumps
    box : (top, bottom, left, right)
        First row and column of the box, and the ones after its last, counted on the padded map.
    bound : float
        Paths of this length and more are not followed.

    Returns
    -------
    (path, expanded)
        path int32: flat cells, none where there is no such path. expanded: number of cells taken from the queue.

    Notes
    -----
    Ties are broken as in `grid_kernels.search`. Where ways of one length come to a cell by different moves, whatever
    may follow one of them goes on.
    """
    top, bottom, left, right = box
    goal_row, goal_col = goal // width, goal % width
    nodes = np.empty((_ROOM, 6), np.int32)
    table = np.zeros(2 * _ROOM, np.int64)  # of cell << 32 | node
    keys = np.empty(_ROOM, np.float64)
    queue = np.empty(_ROOM, np.int32)
    found = np.empty((8 * min(bottom - top, right - left) + 8, 4), np.int32)
    nodes[0, _CELL], nodes[0, _STRAIGHT], nodes[0, _DIAGONAL], nodes[0, _BEFORE] = start, 0, 0, -1
    nodes[0, _ONWARD], nodes[0, _GONE] = 255, 0
    table[_slot(table, start)] = start << 32
    keys[0], queue[0] = 0.0, 0
    count, size = 1, 1
    expanded = 0
    node, cell = 0, start
    while size > 0:
        node = np.int64(_pop(keys, queue, size))
        size -= 1
        onward = nodes[node, _ONWARD] & ~nodes[node, _GONE]
        if onward == 0:
            continue
        expanded += 1
        cell = np.int64(nodes[node, _CELL])
        if cell == goal:
            break
        nodes[node, _GONE] |= onward
        for i in range(_successors(moves, width, jumps, box, goal, cell, onward, found)):
            other = np.int64(found[i, 0])
            straight = nodes[node, _STRAIGHT] + found[i, 1]
            diagonal = nodes[node, _DIAGONAL] + found[i, 2]
            onward = 255 if other == goal else found[i, 3]
            place = _slot(table, other)
            new, known = table[place] == 0, table[place] & 0xFFFFFFFF
            if not new:
                length = straight + SQRT2 * diagonal
                before = nodes[known, _STRAIGHT] + SQRT2 * nodes[known, _DIAGONAL]
                if length > before:
                    continue
                if length == before:
                    waits = nodes[known, _ONWARD] & ~nodes[known, _GONE]
                    nodes[known, _ONWARD] |= onward
                    if waits or not nodes[known, _ONWARD] & ~nodes[known, _GONE]:
                        continue
            rows, cols = abs(other // width - goal_row), abs(other % width - goal_col)
            least = min(rows, cols)
            beyond = max(rows, cols) - least
            key = (straight + beyond) + SQRT2 * (diagonal + least) + 1e-11 * (beyond + SQRT2 * least)
            if key >= bound:
                continue
            if new:
                known = np.int64(count)
                table[place] = other << 32 | known
                count += 1
            if new or length < before:
                nodes[known, _CELL], nodes[known, _BEFORE] = other, node
                nodes[known, _STRAIGHT], nodes[known, _DIAGONAL] = straight, diagonal
                nodes[known, _ONWARD], nodes[known, _GONE] = onward, 0
            if count == nodes.shape[0]:
                nodes, table = _grown(nodes, count)
            if size == keys.size:
                keys = np.append(keys, keys)
                queue = np.append(queue, queue)
            _push(keys, queue, size, key, known)
            size += 1
    if cell != goal:
        return np.empty(0, np.int32), expanded
    return _walked(nodes, node, width), expanded


@jit
def _walked(nodes, node, width):
    """The flat cells of the way to a node: each jump's diagonal moves first."""
    last = nodes[node, _STRAIGHT] + nodes[node, _DIAGONAL]
    path = np.empty(last + 1, np.int32)
    path[last] = nodes[node, _CELL]
    while last > 0:
        before = nodes[node, _BEFORE]
        cell, origin = np.int64(nodes[node, _CELL]), np.int64(nodes[before, _CELL])
        down, aside = cell // width - origin // width, cell % width - origin % width
        diagonal = min(abs(down), abs(aside))
        across = np.sign(down) * width + np.sign(aside)
        along = np.sign(down) * width if abs(down) > abs(aside) else np.sign(aside)
        for i in range(max(abs(down), abs(aside)) - 1, -1, -1):
            path[last - 1] = path[last] - (across if i < diagonal else along)
            last -= 1
        node = before
    return path


@jit
def reoptimise(moves, width, jumps, path, window, offset):
    """`grid_kernels.reoptimise` by jump point search, where moves cost their lengths."""
    better = np.empty(int(length_along(path, width)) + 2, np.int32)  # straight moves in place of diagonal ones are more
    better[0] = path[0]
    kept = 0
    first = 0
    last = offset if offset > 0 else window
    while first < path.size - 1:
        last = min(last, path.size - 1)
        piece = path[first : last + 1]
        bound = length_along(piece, width) - 1e-9
        if bound > octile(piece[-1] // width - piece[0] // width, piece[-1] % width - piece[0] % width):
            box = box_around(piece, width, moves.size // width, window // 4)
            found, _ = jump_search(moves, width, jumps, box, np.int64(piece[0]), np.int64(piece[-1]), bound)
            if found.size > 0:
                piece = found
        put(better, kept, piece, 0, piece.size)
        kept += piece.size - 1
        first, last = last, last + window
    return better[: kept + 1].copy()
