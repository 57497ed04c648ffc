"""A map of legal moves that changes: cells close and open, and moves follow. Compiled.

Cells are flat indices into the padded map, as in `grid_kernels`.
"""

from __future__ import annotations

import numpy as np

from antnav.kernels.grid_kernels import COLS, DIAGONAL, ROWS, offsets_of
from antnav.kernels.jit import jit

#: Values of `Cell`.
_FREE, _OCCUPIED, _UNKNOWN = 0, 1, 2


@jit
def _legal_moves(passable, cell, width, offsets, sides):
    """Legal moves of a cell as bits; see `moves.legal_moves`."""
    legal = 0
    if passable[cell]:
        for k in range(8):
            if passable[cell + offsets[k]]:
                beside = passable[cell + ROWS[k] * width] + passable[cell + COLS[k]] if DIAGONAL[k] else 2
                if beside >= sides:
                    legal |= 1 << k
    return legal


@jit
def _is_near(kind, width, disc, cell):
    """Whether an occupied cell lies within the robot's disc around a cell."""
    row, col = cell // width, cell % width
    for i in range(disc.shape[0]):
        r, c = row + disc[i, 0], col + disc[i, 1]
        if 0 < r < kind.size // width - 1 and 0 < c < width - 1 and kind[r * width + c] == _OCCUPIED:
            return True
    return False


@jit
def alter(kind, passable, moves, width, sides, unknown, disc, blocked, freed):
    """Occupy some cells, then free others; openness and legal moves follow, within the robot's radius of them.

    Parameters
    ----------
    kind : uint8, flat
        What each cell of the padded map holds, without the robot's radius; the padding is occupied.
    passable, moves : uint8, flat
        Altered with it.
    sides : int
        Free cells that a diagonal move needs beside it, 0 to 2: the corner rule.
    unknown : bool
        Whether unknown cells are open.
    disc : int32 (m, 2)
        Rows and columns to the cells within the robot's radius, (0, 0) among them.
    blocked, freed : int32
        Flat cells of the map.

    Returns
    -------
    (changed, opened)
        int32, cells whose moves are others now, each once, and those of them that have a move which they had not.
    """
    height = moves.size // width
    offsets = offsets_of(width)
    flipped = np.empty(256, np.int32)
    count = 0
    for i in range(blocked.size):
        cell = blocked[i]
        if kind[cell] == _OCCUPIED:
            continue
        kind[cell] = _OCCUPIED
        row, col = cell // width, cell % width
        for j in range(disc.shape[0]):
            r, c = row + disc[j, 0], col + disc[j, 1]
            if 0 < r < height - 1 and 0 < c < width - 1 and passable[r * width + c]:
                passable[r * width + c] = 0
                if count == flipped.size:
                    flipped = np.append(flipped, flipped)
                flipped[count] = r * width + c
                count += 1
    was_occupied = np.zeros(freed.size, np.uint8)
    for i in range(freed.size):
        was_occupied[i] = kind[freed[i]] == _OCCUPIED
        kind[freed[i]] = _FREE
    for i in range(freed.size):
        row, col = freed[i] // width, freed[i] % width
        for j in range(disc.shape[0]):
            if not was_occupied[i] and (disc[j, 0] != 0 or disc[j, 1] != 0):
                continue
            r, c = row + disc[j, 0], col + disc[j, 1]
            cell = r * width + c
            if not (0 < r < height - 1 and 0 < c < width - 1) or passable[cell]:
                continue
            open_kind = kind[cell] == _FREE or (unknown and kind[cell] == _UNKNOWN)
            if open_kind and not _is_near(kind, width, disc, cell):
                passable[cell] = 1
                if count == flipped.size:
                    flipped = np.append(flipped, flipped)
                flipped[count] = cell
                count += 1
    changed = np.empty(9 * count, np.int32)
    opened = np.empty(9 * count, np.int32)
    found, gained = 0, 0
    for i in range(count):
        for k in range(9):
            cell = flipped[i] + (offsets[k] if k < 8 else 0)
            legal = _legal_moves(passable, cell, width, offsets, sides)
            if legal != moves[cell]:
                if legal & ~moves[cell]:
                    opened[gained] = cell
                    gained += 1
                moves[cell] = legal
                changed[found] = cell
                found += 1
    return changed[:found].copy(), opened[:gained].copy()
