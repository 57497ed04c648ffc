"""Text maps: 0 and 1 as the ant-colony literature prints them, `.` and `#`, or OccupancyGrid values; CSV too."""

from __future__ import annotations

import re
import struct
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from antnav.errors import MapFormatError, MapSizeError
from antnav.files import write_whole
from antnav.maps.movingai import warn_of_unknown
from antnav.maps.numbers import Values, to_grid
from antnav.maps.source import read_bytes, split_lines
from antnav.world.grid import Cell, GridMap, check_size

Fields = list[bytes] | tuple[bytes, ...]

#: What a field may be, and the byte that stands for it; -1 is 255, as in ROS.
_DIGITS = {b"0": 0, b"1": 1}
_LETTERS = {b".": 0, b"#": 1, b"@": 1}
_OCCUPANCY = {str(value).encode(): value % 256 for value in range(-1, 101)}


def read(path: Path, values: Values = "cells", invert: bool = False, occupied_from: int = 100) -> GridMap:
    """Read a text map; resolution 1.

    Parameters
    ----------
    path : Path
        The file.
    values, invert, occupied_from
        See `to_grid`.

    Raises
    ------
    MapFileError, MapFormatError, MapSizeError
        Missing; see `parse`; too large.
    """
    return to_grid(parse(read_bytes(path), str(path), values), path, values, invert, occupied_from)


def parse(data: bytes, source: str, values: Values = "cells") -> NDArray[np.uint8]:
    """Read lines of cells, the top row first.

    A line is split at its commas, or else its semicolons, tabs or blanks, and each field is a cell; a line without any
    of them has a cell a letter. One separator at the end of a line does not count, nor do empty lines. There are no
    comments: `#` is an occupied cell. There is no header: a first line 0, 1, 2 and so on, of three fields or more with
    commas, semicolons or tabs, could be numbered columns or occupancy, and is refused; with blanks it is occupancy.

    Parameters
    ----------
    data : bytes
        The text.
    source : str
        Name for errors.
    values : {"cells", "occupancy"}
        Cells are 0 (free) and 1 (occupied), or `.` (free) and `#` or `@` (occupied) if the first of them is one of
        these; occupancy is -1 and 0 to 100, a line without separators being one value.

    Returns
    -------
    ndarray of uint8, shape (rows, cols)
        `Cell.FREE` and `Cell.OCCUPIED`, or occupancy with 255 for -1.

    Raises
    ------
    MapFormatError, MapSizeError
        A field that is not a cell, a header or a row of another length (with its line); too many cells or lines.
    """
    words = _OCCUPANCY if values == "occupancy" else {}
    rows: list[bytes] = []
    for number, raw in enumerate(split_lines(data, source), 1):
        line = raw.lstrip(b" ")
        if not line:
            continue
        words = words or (_LETTERS if line[:1] in _LETTERS else _DIGITS)
        fields = _split(line, words)
        if not rows and _separator(line) != b" ":
            _refuse_header(f"{source}, line {number}: {line[:40].decode('latin-1')!a}", fields, words)
        try:
            row = bytes(map(words.__getitem__, fields))
        except KeyError:
            index = next(at for at, field in enumerate(fields) if field not in words)
            column = len(raw) - len(line) + _column(line, index)
            comment = line[:1] == b"#"
            raise _wrong(f"{source}, line {number}, column {column}", fields[index], words, comment) from None
        if rows and len(row) != len(rows[0]):
            raise MapFormatError(
                f"{source}, line {number} of {len(row)} cells",
                f"the rows above have {len(rows[0])}",
                "make the rows equally long",
            )
        rows.append(row)
    if not rows:
        raise MapSizeError(f"{source} without cells", "a map has at least one cell", "check the file")
    check_size(len(rows), len(rows[0]), source)
    return np.frombuffer(b"".join(rows), dtype=np.uint8).reshape(len(rows), -1)


def _separator(line: bytes) -> bytes:
    return next((mark for mark in (b",", b";", b"\t", b" ") if mark in line), b"")


def _split(line: bytes, words: dict[bytes, int]) -> Fields:
    mark = _separator(line)
    if mark == b" ":
        return line.split()
    if mark:
        return [field.strip() for field in line.removesuffix(mark).split(mark)]
    if words is _OCCUPANCY:
        return [line]
    letters: tuple[bytes, ...] = struct.unpack(f"{len(line)}c", line)
    return letters


def _column(line: bytes, index: int) -> int:
    """Where the field begins, counted from 1."""
    mark = _separator(line)
    if not mark:
        return index + 1
    rest = line.split(None if mark == b" " else mark, index)[-1]
    return len(line) - len(rest.lstrip(b" ")) + 1


def _refuse_header(line: str, fields: Fields, words: dict[bytes, int]) -> None:
    numbered = len(fields) > 2 and all(field == b"%d" % at for at, field in enumerate(fields))
    if fields[0] and not numbered:
        return
    rule = "it is a header, numbered columns or a column without a name, not cells"
    remedy = "leave out header and index, with pandas to_csv(..., header=False, index=False)"
    if fields[0] and words is _OCCUPANCY:
        rule = "it could be a header, numbered columns, or occupancy"
        remedy += "; if these are cells, put blanks between those of this line"
    raise MapFormatError(line, rule, remedy)


def _wrong(place: str, field: bytes, words: dict[bytes, int], comment: bool) -> MapFormatError:
    if words is _OCCUPANCY:
        rule = "OccupancyGrid values are -1 (unknown) and 0 (free) to 100 (occupied)"
    elif words is _LETTERS:
        rule = "cells are . (free) and # or @ (occupied) if the first of them is one of these"
    else:
        rule = "a text map has only 0 (free) and 1 (occupied), apart by commas, semicolons, tabs, blanks or nothing"
    if comment:
        remedy = "if the line is a comment, take it out: a text map has none, # is an occupied cell"
    elif not field:
        remedy = "fill the empty field"
    elif words is _LETTERS and field in _DIGITS:
        remedy = "write all cells as letters or all as digits; if the first line is a comment, take it out"
    elif field in _OCCUPANCY:
        remedy = "OccupancyGrid values are read with values='occupancy' (--values occupancy); else correct the cell"
    elif not field.strip(b"01"):
        remedy = "put a separator between all cells of a line, or none"
    elif re.fullmatch(rb"[01]\.0*(?:e[+-]?00)?", field):
        remedy = "save whole numbers, with numpy.savetxt(..., fmt='%d')"
    else:
        remedy = "take out what is not a cell"
    return MapFormatError(f"{place}: {field[:40].decode('latin-1')!a}", rule, remedy)


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
