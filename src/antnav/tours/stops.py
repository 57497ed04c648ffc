"""Stops from a CSV file."""

from __future__ import annotations

import csv
import io
import os
from typing import Any, NamedTuple

from antnav.errors import ParameterError, shown
from antnav.files import as_path, open_regular

#: Columns by whether stops are cells.
COLUMNS = {False: ("x", "y"), True: ("row", "col")}


class Stops(NamedTuple):
    """The stops of a file.

    Attributes
    ----------
    cells : bool
        Whether they are (row, col) instead of (x, y) in metres.
    places : list of pairs of numbers
    """

    cells: bool
    places: list[Any]


def read_stops(path: str | os.PathLike[str]) -> Stops:
    """The stops of a .csv file: a line of heads, x and y in metres or row and col among them, then one a line.

    Raises
    ------
    ParameterError
        No such file, no such columns, or a line that is no stop, which is named.
    """
    file = as_path(path)
    try:
        with open_regular(file) as stream:
            text = stream.read().decode("utf-8-sig", "replace")
    except OSError as error:
        raise ParameterError(f"stops {file}", error.strerror or str(error), "name a file that can be read") from error
    heads, _, _ = text.partition("\n")
    delimiter = next((mark for mark in ",;\t" if mark in heads), ",")
    reader = csv.reader(io.StringIO(text, newline=""), delimiter=delimiter)
    try:
        names = [name.strip().lower() for name in next(reader, [])]
        cells = next((cells for cells, columns in COLUMNS.items() if {*columns} <= {*names}), None)
        if cells is None:
            rule = "its columns are x and y in metres, or row and col"
            raise ParameterError(f"stops {file}", rule, "give it these heads")
        at = [names.index(name) for name in COLUMNS[cells]]
        return Stops(cells, [_place(file, reader.line_num, line, at, cells) for line in reader if line])
    except csv.Error as error:
        raise ParameterError(f"stops {file}, line {reader.line_num}", str(error), "mend the line") from error


def _place(file: object, number: int, line: list[str], at: list[int], cells: bool) -> Any:
    kind, rule = (int, "two whole numbers") if cells else (float, "two numbers")
    try:
        return tuple(kind(line[column]) for column in at)
    except (ValueError, IndexError, OverflowError):
        given = f"stops {file}, line {number} {shown(','.join(line))}"
        raise ParameterError(given, f"a stop is {rule}", "mend the line") from None
