"""A map drawn with characters."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from antnav.world.grid import Cell, GridMap
from antnav.world.problem import CellIndex

#: By kind of cell: free, occupied, unknown, inflated.
BLOCKS, LETTERS = " █░▒", ".#?+"
#: A character whose upper half differs from its lower half, where one of them is occupied.
UPPER, LOWER = "▀", "▄"


def sketch(
    grid: GridMap, width: int, height: int, marks: Mapping[CellIndex, str] | None = None, *, unicode: bool = True
) -> list[str]:
    """Lines of a drawing of at most `width` x `height` characters, each about twice as high as wide.

    A small map gets two characters a cell. Of a larger one, a character shows a block of cells, in Unicode one in its
    upper and one in its lower half. A block is occupied where half the length of a wall of one cell crosses it: thin
    walls stay visible, specks do not.

    Parameters
    ----------
    grid : GridMap
    width, height : int
        Room in characters, >= 1.
    marks : mapping from (row, col) to a character, optional
        Drawn over the cells, such as S and G.
    unicode : bool
        Whether block characters can be shown; else occupied is ``#``, unknown ``?``, free ``.``.
    """
    marks = marks or {}
    letters = np.array(list(BLOCKS if unicode else LETTERS))
    if 2 * grid.cols <= width and grid.rows <= height:
        lines = np.repeat(letters[grid.cells], 2, axis=1)
        places = {(row, 2 * col): mark for (row, col), mark in marks.items()}
    else:
        side = max(-(-grid.cols // width), -(-grid.rows // (2 * height)))
        places = {(row // (2 * side), col // side): mark for (row, col), mark in marks.items()}
        if unicode:
            lines = _in_halves(_blocks(grid.cells, side, side), letters)
        else:
            lines = letters[_blocks(grid.cells, 2 * side, side)]
    for place, mark in places.items():
        lines[place] = mark
    return ["".join(line) for line in lines]


def framed(lines: list[str], *, unicode: bool = True) -> list[str]:
    """The drawing with a thin line around it, two characters wider and two lines higher."""
    corners, across, along = ("┌┐└┘", "─", "│") if unicode else ("++++", "-", "|")
    edge = across * len(lines[0])
    sides = [f"{along}{line}{along}" for line in lines]
    return [corners[0] + edge + corners[1], *sides, corners[2] + edge + corners[3]]


def _blocks(cells: NDArray[np.uint8], height: int, width: int) -> NDArray[np.uint8]:
    """What each block of cells mainly holds; blocks at the lower and right edge may be smaller."""
    tops, lefts = np.arange(0, cells.shape[0], height), np.arange(0, cells.shape[1], width)

    def count(kind: Cell) -> NDArray[np.int64]:
        return np.add.reduceat(np.add.reduceat((cells == kind).astype(np.int64), tops, axis=0), lefts, axis=1)

    number = {kind: count(kind) for kind in Cell}
    half = sum(number.values()) / 2
    blocks = np.where(number[Cell.UNKNOWN] > half, Cell.UNKNOWN, Cell.FREE).astype(np.uint8)
    blocks[number[Cell.INFLATED] > half] = Cell.INFLATED
    blocks[(number[Cell.OCCUPIED] > 0) & (number[Cell.OCCUPIED] >= width / 2)] = Cell.OCCUPIED
    return blocks


def _in_halves(blocks: NDArray[np.uint8], letters: NDArray[np.str_]) -> NDArray[np.str_]:
    """A character for each pair of blocks, one above the other."""
    blocks = np.pad(blocks, ((0, len(blocks) % 2), (0, 0)), mode="edge")
    upper, lower = blocks[::2], blocks[1::2]
    lines: NDArray[np.str_] = letters[np.minimum(upper, lower)]
    same = upper == lower
    lines[same] = letters[upper[same]]
    lines[~same & (upper == Cell.OCCUPIED)] = UPPER
    lines[~same & (lower == Cell.OCCUPIED)] = LOWER
    return lines
