"""Text maps of 0 (free) and 1 (occupied), as the ant-colony literature prints them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from antnav.errors import MapFormatError, MapSizeError
from antnav.files import write_whole
from antnav.grid import Cell, GridMap, check_size
from antnav.maps.movingai import warn_of_unknown
from antnav.maps.source import read_bytes, split_lines

_SEPARATORS = b" \t,"


def read(path: Path) -> GridMap:
    """Read a text map; resolution 1.

    Raises
    ------
    MapFileError, MapFormatError, MapSizeError
        Missing; see `parse`; too large.
    """
    return GridMap(parse(read_bytes(path), str(path)), name=path.stem)


def parse(data: bytes, source: str) -> NDArray[np.uint8]:
    """Read lines of 0 and 1, the top row first, with or without blanks, tabs and commas between them.

    Empty lines do not count.

    Parameters
    ----------
    data : bytes
        The text.
    source : str
        Name for errors.

    Returns
    -------
    ndarray of uint8, shape (rows, cols)
        `Cell.FREE` and `Cell.OCCUPIED`.

    Raises
    ------
    MapFormatError, MapSizeError
        Another character or a row of another length (with its line); too many cells or lines.
    """
    lines = split_lines(data, source)
    rows: list[bytes] = []
    for number, line in enumerate(lines, 1):
        row = line.translate(None, _SEPARATORS)
        if row.strip(b"01"):
            column = next(at for at, letter in enumerate(line, 1) if letter not in b"01" + _SEPARATORS)
            raise MapFormatError(
                f"{source}, line {number}, column {column}: {chr(line[column - 1])!r}",
                "a text map has only 0 (free) and 1 (occupied), apart by blanks, tabs, commas or nothing",
                "replace the character",
            )
        if row and rows and len(row) != len(rows[0]):
            raise MapFormatError(
                f"{source}, line {number} of {len(row)} cells",
                f"the rows above have {len(rows[0])}",
                "make the rows equally long",
            )
        if row:
            rows.append(row)
    if not rows:
        raise MapSizeError(f"{source} without cells", "a map has at least one cell", "check the file")
    check_size(len(rows), len(rows[0]), source)
    return np.frombuffer(b"".join(rows), dtype=np.uint8).reshape(len(rows), -1) - np.uint8(ord("0"))


def write(grid: GridMap, path: Path) -> None:
    """Write 0 for free and 1 for all else, without blanks. Resolution and origin are not kept.

    Warns
    -----
    MapWarning
        The map has unknown cells: they become blocked.
    """
    warn_of_unknown(grid, path)
    rows = np.full((grid.rows, grid.cols + 1), ord("\n"), dtype=np.uint8)
    rows[:, :-1] = ord("0") + (grid.cells != Cell.FREE)
    write_whole(path, rows.tobytes())
