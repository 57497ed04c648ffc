"""Sides: on which side of obstacles a path passes, exactly.

Two paths between the same ends pass on one side of a cell if the loop that they make does not wind around it. For all
cells of a mask at once that is one number: each has a random mark, and a path sums the marks above which it passes,
with a sign for its direction. Equal sums: no cell between. It is the signature of Bhattacharya, Likhachev & Kumar 2012
(doi 10.1007/s10514-012-9304-1) with rays and numbers modulo 2**64.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from antnav.search import windows
from antnav.world.moves import CornerRule
from antnav.world.terrain import Terrain


def marks_below(mask: NDArray[np.bool_], width: int) -> NDArray[np.int64]:
    """Random marks, the same in each run, of a mask's cells on the padded map, as `grid_kernels.two_sides` takes them.

    Parameters
    ----------
    mask : ndarray of bool, shape (n,)
        Flat.
    """
    drawn = np.random.default_rng(0).integers(-(2**63), 2**63, mask.size, np.int64)
    marks = np.where(mask, drawn, 0).reshape(-1, width)
    below = np.zeros_like(marks)
    np.cumsum(marks[:0:-1], axis=0, out=below[-2::-1])
    return below.ravel()


def side(path: NDArray[Any], below: NDArray[np.int64], width: int) -> int:
    """The sum of marks along a path of flat cells, modulo 2**64."""
    higher, left, step = _crossings(path, width)
    return int((step * below[higher * width + left]).sum())


def obstacles_between(one: NDArray[Any], other: NDArray[Any], terrain: Terrain) -> int:
    """How many obstacles two paths of flat cells between the same ends enclose: 0 if they pass on the same side of all.

    An obstacle is what cannot be entered and hangs together so that no legal move leads through it.
    """
    from scipy import ndimage

    width = terrain.width
    winding = np.zeros(terrain.moves.shape, np.int32)
    for path, sign in ((one, 1), (other, -1)):
        higher, left, step = _crossings(path, width)
        np.add.at(winding, (higher + 1, left), sign * step)
    inside = np.cumsum(winding, axis=0)[1:-1, 1:-1] != 0
    corners = 1 if terrain.corner_rule is CornerRule.ALLOW else 2
    return int(ndimage.label(inside & ~terrain.passable, ndimage.generate_binary_structure(2, corners))[1])


def polished(path: NDArray[Any], terrain: Terrain, reach: float) -> NDArray[Any]:
    """A path without needless bends and turns, no dearer and on the same side of all obstacles; `reach` in cells."""
    straight = windows.straightened(path, terrain)
    better = windows.straightened(
        windows.without_loops(windows.improved(path, terrain, max(12, round(4 * reach)))), terrain
    )
    best = path
    for way in (straight, better):
        if terrain.cost_along(way) <= terrain.cost_along(best) and not obstacles_between(path, way, terrain):
            best = way
    return best


def _crossings(path: NDArray[Any], width: int) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """Of each move that changes the column: its higher row, its left column, +1 to the right or -1 to the left."""
    rows, cols = np.divmod(np.asarray(path, np.int64), width)
    step = np.diff(cols)
    higher, left = np.minimum(rows[1:], rows[:-1]), np.minimum(cols[1:], cols[:-1])
    across = step != 0
    return higher[across], left[across], step[across]
