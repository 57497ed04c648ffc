"""Which moves a robot may make: the eight directions and the corner rules."""

from __future__ import annotations

import math
from enum import StrEnum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from antnav.errors import ParameterError, shown
from antnav.kernels.graph import SQRT2

#: (row, column) steps of the eight moves; move k and move 7 - k undo each other.
STEPS = ((-1, -1), (-1, 0), (-1, 1), (0, -1), (0, 1), (1, -1), (1, 0), (1, 1))
#: Angle in radians between the directions of two slots, shape (8, 8).
SLOT_ANGLES = np.array(
    [[abs(math.atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1])) for b in STEPS] for a in STEPS]
)


class CornerRule(StrEnum):
    """When a diagonal move from a to b is legal, given the two cells x that it passes between.

    ::

        . b     x b     x b
        a .     a .     a x
        all     allow   allow only
                graze

    - allow: always: the paper's rule (its figure 2)
    - graze: at least one x is free: may touch a corner, not squeeze between two
    - forbid: both x are free: MovingAI's rule, the only safe one for a robot with a body
    """

    ALLOW = "allow"
    GRAZE = "graze"
    FORBID = "forbid"

    @classmethod
    def of(cls, value: str | CornerRule) -> CornerRule:
        """Corner rule by name.

        Raises
        ------
        ParameterError
            No such rule.
        """
        try:
            return cls(value)
        except (ValueError, TypeError):
            rules = ", ".join(cls)
            raise ParameterError(
                f"corner rule {shown(value)}", f"the rules are {rules}", "choose one of them"
            ) from None


def octile(rows: NDArray[Any], cols: NDArray[Any]) -> NDArray[np.float64]:
    """Length in cells of a shortest path over so many rows and columns where there are no obstacles."""
    rows, cols = np.abs(rows), np.abs(cols)
    least = np.minimum(rows, cols)
    length: NDArray[np.float64] = np.maximum(rows, cols) - least + SQRT2 * least
    return length


def legal_moves(passable: NDArray[np.bool_], rule: CornerRule) -> NDArray[np.uint8]:
    """Legal moves of every cell as bits, on a map padded by one closed cell all round.

    Parameters
    ----------
    passable : ndarray of bool, shape (rows, cols)
    rule : CornerRule

    Returns
    -------
    ndarray of uint8, shape (rows + 2, cols + 2)
        Bit k is set where move k of `STEPS` is legal. The padding spares kernels every bounds test.
    """
    rows, cols = passable.shape
    free = np.pad(passable, 1)

    def shifted(row: int, col: int) -> NDArray[np.bool_]:
        return free[1 + row : 1 + row + rows, 1 + col : 1 + col + cols]

    moves = np.zeros((rows + 2, cols + 2), np.uint8)
    inner = moves[1:-1, 1:-1]
    for k, (row, col) in enumerate(STEPS):
        legal = passable & shifted(row, col)
        if row and col and rule is CornerRule.GRAZE:
            legal &= shifted(row, 0) | shifted(0, col)
        elif row and col and rule is CornerRule.FORBID:
            legal &= shifted(row, 0) & shifted(0, col)
        inner |= legal.astype(np.uint8) << np.uint8(k)
    return moves
