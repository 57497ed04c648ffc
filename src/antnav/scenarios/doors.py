"""Doors: narrow passages of a map, which open and close."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from antnav.errors import ParameterError
from antnav.scenarios.covers import Cover
from antnav.scenarios.ground import Ground

#: Cells that a door may be wide: 1.2 m at 0.05 m a cell.
WIDEST = 24
#: Places that are looked at for each door that is wanted, and at least.
_LOOKED_AT = 200


class Passage(NamedTuple):
    """Passable cells in a row between two closed ones.

    Attributes
    ----------
    row, col : int
        Its first cell, at the top or the left.
    width : int
        Number of cells.
    down : bool
        Whether it goes down, not to the right.
    """

    row: int
    col: int
    width: int
    down: bool

    @property
    def cells(self) -> NDArray[np.int64]:
        """Row and column of each, shape (width, 2)."""
        cells = np.tile(np.array((self.row, self.col)), (self.width, 1))
        cells[:, 0 if self.down else 1] += np.arange(self.width)
        return cells


def doors(ground: Ground, rng: np.random.Generator, count: int) -> Iterator[Cover]:
    """Narrow passages that open and close at random, half of them on the robot's way as far as it has so many.

    Raises
    ------
    ParameterError
        The map has fewer.
    """
    cols = ground.problem.grid.cols
    for passage in narrow(ground, rng, count):
        cells = ground.apart_from_ends(passage.cells @ np.array((cols, 1)))
        tick, shut = 0, bool(rng.integers(2))
        while tick < ground.ticks:
            end = tick + 1 + int(rng.integers(max(ground.ticks // 4, 1)))
            if shut:
                yield Cover(tick, end, cells)
            tick, shut = end, not shut


def narrow(ground: Ground, rng: np.random.Generator, count: int) -> list[Passage]:
    """So many passages whose closing separates what lies around them, none touching another, in random order.

    They are at most half as wide as the widest place of the map, which the distance transform tells.

    Raises
    ------
    ParameterError
        There are fewer, or none was found among those that were looked at.
    """
    from scipy import ndimage

    passable = ground.problem.passable & ground.problem.reachable
    on_way = np.zeros(passable.shape, np.bool_)
    on_way[tuple(ground.way.T)] = True
    widest = min(WIDEST, int(ndimage.distance_transform_edt(np.pad(passable, 1)).max()))
    runs = np.concatenate([_runs(passable, on_way, widest, down=down) for down in (False, True)])
    runs = runs[rng.permutation(len(runs))]
    taken = np.zeros(passable.shape, np.bool_)
    found: list[Passage] = []
    for candidates, most in ((runs[runs[:, -1] == 1], (count + 1) // 2), (runs, count)):
        for row, col, width, down in candidates[: max(count, 10) * _LOOKED_AT, :-1].tolist():
            if len(found) == most:
                break
            passage = Passage(row, col, width, down == 1)
            (top, left), (bottom, right) = passage.cells[0], passage.cells[-1] + 1
            around = taken[max(top - 3, 0) : bottom + 3, max(left - 3, 0) : right + 3]
            if not around.any() and _separates(passage, passable):
                around[:] = True
                found.append(passage)
    if len(found) < count:
        rule = f"{len(found)} narrow passages of at most {widest} cells were found on this map"
        raise ParameterError(f"doors:{count}", rule, "ask for fewer, or for obstacles:K")
    return found


def _runs(passable: NDArray[np.bool_], on_way: NDArray[np.bool_], widest: int, *, down: bool) -> NDArray[np.int64]:
    """Rows of at most so many passable cells between closed ones, with passable cells on both sides.

    Returns
    -------
    ndarray of int64, shape (n, 5)
        Row, column, width, whether it goes down, whether the robot's way crosses it.
    """
    lines, crossed = (passable.T, on_way.T) if down else (passable, on_way)
    framed = np.pad(lines, 1)
    steps = np.diff(framed[1:-1].astype(np.int8), axis=1)
    begins, ends = np.argwhere(steps == 1), np.argwhere(steps == -1)
    widths = ends[:, 1] - begins[:, 1]

    def holds(marked: NDArray[np.bool_]) -> NDArray[np.bool_]:
        sums = np.pad(np.cumsum(marked, axis=1, dtype=np.int32), ((0, 0), (1, 0)))
        found: NDArray[np.bool_] = sums[tuple(ends.T)] > sums[tuple(begins.T)]
        return found

    leads = (widths <= widest) & holds(framed[:-2, 1:-1] & framed[2:, 1:-1])
    places = begins[:, ::-1] if down else begins
    columns = (places, widths[:, None], np.full((len(begins), 1), down), holds(crossed)[:, None])
    runs: NDArray[np.int64] = np.hstack(columns)[leads].astype(np.int64)
    return runs


def _separates(passage: Passage, passable: NDArray[np.bool_]) -> bool:
    """Whether, once it is closed, no way of a few widths leads from one side to the other."""
    from scipy import ndimage

    reach = 2 * passage.width + 4
    (top, left), (bottom, right) = passage.cells[0], passage.cells[-1] + 1
    top, left = max(top - reach, 0), max(left - reach, 0)
    window = passable[top : bottom + reach, left : right + reach].copy()
    rows, cols = (passage.cells - (top, left)).T
    window[rows, cols] = False
    labels, _ = ndimage.label(window, np.ones((3, 3)))
    aside, ahead = (0, 1) if passage.down else (1, 0)
    one, other = (np.setdiff1d(labels[rows + s * aside, cols + s * ahead], 0) for s in (-1, 1))
    return len(one) > 0 and len(other) > 0 and not np.isin(one, other).any()
