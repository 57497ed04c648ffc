"""Where the jumps of jump point search end, for `kernels.jump_kernels`."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

from antnav.world.moves import STEPS, CornerRule

#: The straight moves in the order of `Jumps.words`: right, left, down, up.
_STRAIGHT = (4, 3, 6, 1)


def jump_ends(moves: NDArray[np.uint8], rule: CornerRule) -> NDArray[np.int64]:
    """Where jumps end on a map, as `Jumps.words`: 4 bits a cell.

    Parameters
    ----------
    moves : ndarray of uint8, shape (rows + 2, cols + 2)
        As `legal_moves` gives them.
    rule : CornerRule
    """
    follow = onward(rule)
    ends = np.zeros(256, np.uint8)
    ends[0] = 0b1111  # closed cells
    for i, k in enumerate(_STRAIGHT):
        ends |= (follow[k] & ~np.uint8(1 << k) > 0).astype(np.uint8) << np.uint8(i)
    rows = ends[moves]
    columns = np.ascontiguousarray(rows.T)
    lines = (rows, rows, columns, columns)
    return np.concatenate([_packed(lines[i] & np.uint8(1 << i), backwards=i % 2 > 0) for i in range(4)])


def _packed(ends: NDArray[np.uint8], backwards: bool) -> NDArray[np.int64]:
    """Lines of bits, 64 a word, the lowest first."""
    whole = np.pad(ends, ((0, 0), (0, -ends.shape[1] % 64)))
    octets = np.packbits(whole, axis=1, bitorder="big" if backwards else "little")
    return (octets[:, ::-1] if backwards else octets).ravel().view("<i8").astype(np.int64)


@cache
def onward(rule: CornerRule) -> NDArray[np.uint8]:
    """Moves that may follow a move on a shortest path, uint8 (8, 256): by it and the legal moves of the cell it led to.

    Of paths of one length only that counts whose diagonal moves come first. So a move's own parts may follow it, and
    those that an obstacle beside the cell before lets no other path make as soon: the forced ones.
    """
    legal = np.arange(256)

    def can(row: int, col: int) -> NDArray[np.int64]:
        return legal >> STEPS.index((row, col)) & 1

    follow = np.zeros((8, 256), np.uint8)
    for k, (row, col) in enumerate(STEPS):
        ahead = [(step, np.ones(256, np.int64)) for step in STEPS if step in ((row, col), (row, 0), (0, col))]
        if not (row and col):
            for aside in ((col, row), (-col, -row)):
                before = (aside[0] - row, aside[1] - col) if rule is CornerRule.FORBID else aside
                ahead += [(step, 1 - can(*before)) for step in (aside, (aside[0] + row, aside[1] + col))]
        elif rule is not CornerRule.FORBID:
            ahead += [((-row, col), 1 - can(-row, 0)), ((row, -col), 1 - can(0, -col))]
        for step, where in ahead:
            follow[k] |= ((can(*step) & where) << STEPS.index(step)).astype(np.uint8)
    return follow
