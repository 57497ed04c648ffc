"""MovingAI benchmark files: octile maps (.map) and scenarios (.scen)."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from antnav.errors import MapFormatError, MapSizeError
from antnav.files import write_whole
from antnav.maps.source import MapWarning, read_bytes, split_lines
from antnav.world.grid import Cell, GridMap, check_size

#: Length of a .scen file that is read: some million scenarios.
MAX_SCENARIO_BYTES = 2**27
_RESTORE = "restore the file from movingai.com"
_BAD = 255
_KINDS = np.full(256, _BAD, dtype=np.uint8)
_KINDS[list(b".G")] = Cell.FREE
# Swamp and water count as blocked: the published lengths hold for ground units that enter `.` and `G` only.
_KINDS[list(b"@OTSW")] = Cell.OCCUPIED
_LETTERS = np.frombuffer(b".@@@", dtype=np.uint8)


@dataclass(frozen=True)
class Scenario:
    """One query of a .scen file.

    Attributes
    ----------
    bucket : int
        Group of about equal lengths.
    map_name : str
        As printed; the folder in it rarely exists.
    cols, rows : int
        Size of the map that the cells refer to.
    start, goal : tuple of 2 ints
        (row, col) from the top left.
    optimal : float
        Published length in cells where a diagonal needs both side cells free. Between 2 and 8 decimals are printed:
        compare with an absolute tolerance of 5.1e-3.
    """

    bucket: int
    map_name: str
    cols: int
    rows: int
    start: tuple[int, int]
    goal: tuple[int, int]
    optimal: float


def read(path: Path) -> GridMap:
    """Read a .map file: `.` and `G` free; `@`, `O`, `T`, `S` and `W` occupied; resolution 1.

    Raises
    ------
    MapFileError, MapFormatError, MapSizeError
        Missing; a wrong header, row or letter (with its line and column); too large.
    """
    lines = split_lines(read_bytes(path), str(path))
    rows, cols, first = _read_header(lines, path)
    check_size(rows, cols, str(path))
    while not lines[-1]:
        lines.pop()
    body = lines[first:]
    if len(body) != rows:
        raise MapFormatError(
            f"{path} with {len(body)} rows of cells", f"its header says height {rows}", "restore the file"
        )
    for number, line in enumerate(body, first + 1):
        if len(line) != cols:
            raise MapFormatError(
                f"{path}, line {number} of {len(line)} cells", f"its header says width {cols}", "restore the file"
            )
    letters = np.frombuffer(b"".join(body), dtype=np.uint8).reshape(rows, cols)
    cells = _KINDS[letters]
    if (cells == _BAD).any():
        row, col = np.argwhere(cells == _BAD)[0]
        raise MapFormatError(
            f"{path}, line {first + row + 1}, column {col + 1}: {chr(letters[row, col])!r}",
            "cells are . G (free) or @ O T S W (blocked)",
            "replace the letter",
        )
    return GridMap(cells, name=path.stem)


def _read_header(lines: list[bytes], path: Path) -> tuple[int, int, int]:
    """Rows, columns and the index of the first line of cells."""
    sizes: dict[bytes, int] = {}
    if lines[0].split() != [b"type", b"octile"]:
        remedy = "put `type octile`, height, width and `map` before the cells, or rename it to .txt"
        rule = "a MovingAI map begins with `type octile`"
        raise _bad_line(path, 1, lines[0], rule, _RESTORE if lines[0][:4].lower() == b"type" else remedy)
    for number, line in enumerate(lines[1:4], 2):
        words = line.split()
        if words == [b"map"] and len(sizes) == 2:
            return sizes[b"height"], sizes[b"width"], number
        if len(words) != 2 or words[0] not in (b"height", b"width") or words[0] in sizes or not _is_count(words[1]):
            raise _bad_line(path, number, line, "a MovingAI header is type, height, width and map, a line each")
        sizes[words[0]] = int(words[1])
    raise _bad_line(path, len(lines), lines[-1], "a MovingAI header ends with the line `map`")


def _is_count(word: bytes) -> bool:
    return word.isdigit() and len(word) < 16  # int() takes seconds over a million digits, and refuses in the end


def _bad_line(path: Path, number: int, line: bytes, rule: str, remedy: str = _RESTORE) -> MapFormatError:
    shown = line[:40].decode("ascii", errors="replace")
    return MapFormatError(f"{path}, line {number}: {shown!r}", rule, remedy)


def read_scenarios(path: Path) -> list[Scenario]:
    """Read a .scen file, version 1: nine fields a line, apart by tabs or blanks.

    Raises
    ------
    MapFileError, MapFormatError, MapSizeError
        Missing; a wrong line (with its number) or a cell outside the map; too large.
    """
    lines = split_lines(read_bytes(path, MAX_SCENARIO_BYTES), str(path))
    if lines[0].split() not in ([b"version", b"1"], [b"version", b"1.0"]):
        raise _bad_line(path, 1, lines[0], "a scenario file begins with `version 1`")
    return [_scenario(line, number, path) for number, line in enumerate(lines[1:], 2) if line]


def _scenario(line: bytes, number: int, path: Path) -> Scenario:
    fields = line.split(b"\t") if b"\t" in line else line.split()
    if len(fields) != 9 or not all(_is_count(field) for field in (fields[0], *fields[2:8])):
        raise _bad_line(path, number, line, "it holds bucket, map, width, height, x, y, x, y and length")
    bucket, cols, rows, x0, y0, x1, y1 = (int(field) for field in (fields[0], *fields[2:8]))
    try:
        optimal = float(fields[8])
    except ValueError:
        optimal = math.nan
    if not 0 <= optimal < math.inf:
        raise _bad_line(path, number, line, "the length is a number from 0 on")
    try:
        check_size(rows, cols, "its map")
    except MapSizeError as error:
        raise _bad_line(path, number, line, f"{error.given}, but {error.rule}") from error
    if max(x0, x1) >= cols or max(y0, y1) >= rows:
        raise _bad_line(path, number, line, f"x is below {cols} and y below {rows}, the size of its map")
    name = fields[1].decode("utf-8", errors="replace")
    return Scenario(bucket, name, cols, rows, (y0, x0), (y1, x1), optimal)


def write(grid: GridMap, path: Path) -> None:
    """Write a .map file: free is `.`, all else `@`. Resolution and origin are not kept.

    Warns
    -----
    MapWarning
        The map has unknown cells: they become blocked.
    """
    warn_of_unknown(grid, path)
    rows = np.full((grid.rows, grid.cols + 1), ord("\n"), dtype=np.uint8)
    rows[:, :-1] = _LETTERS[grid.cells]
    header = f"type octile\nheight {grid.rows}\nwidth {grid.cols}\nmap\n"
    write_whole(path, header.encode() + rows.tobytes())


def warn_of_unknown(grid: GridMap, path: Path) -> None:
    """Say that a format of two letters cannot keep unknown cells."""
    unknown = grid.counts()["unknown"]
    if unknown:
        warnings.warn(
            f"{path}: {unknown} unknown cells are written as blocked; .yaml and .npy keep them",
            MapWarning,
            stacklevel=4,  # the caller of save_map
        )
