"""Queries from files: CSV, JSON lines, Parquet; a row that is no query says so and ends nothing."""

from __future__ import annotations

import csv
import io
import os
from collections.abc import Iterable, Iterator
from importlib.util import find_spec
from pathlib import Path
from typing import Any, NamedTuple

import msgspec

from antnav.batch.work import Ends
from antnav.errors import ParameterError, shown
from antnav.files import as_path, open_regular

ENDINGS = (".csv", ".jsonl", ".parquet")
#: Columns by whether ends are cells.
COLUMNS = {
    False: ("start_x", "start_y", "goal_x", "goal_y"),
    True: ("start_row", "start_col", "goal_row", "goal_col"),
}
_RULE = f"its columns are {', '.join(COLUMNS[False])} in metres, or {', '.join(COLUMNS[True])}, and id if wanted"


class Row(NamedTuple):
    """A query of a file.

    Attributes
    ----------
    line : int
        Where it stands, from 1; of Parquet the number of the row.
    id : str or None
        Of the column of that name.
    ends : (start, goal), or ParameterError
        What is wrong with it.
    """

    line: int
    id: str | None
    ends: Ends | ParameterError


class Rows(NamedTuple):
    """The queries of a file.

    Attributes
    ----------
    cells : bool
        Whether ends are (row, col).
    rows : iterator of Row
        Read as they are needed.
    """

    cells: bool
    rows: Iterator[Row]


def read_rows(path: str | os.PathLike[str]) -> Rows:
    """The queries of a .csv, .jsonl or .parquet file.

    CSV has a line of heads, parted by commas, semicolons or tabs. A line of JSON is an object with ``"start": [x, y]``
    and ``"goal"`` in metres, or with ``"start_cell": [row, col]`` and ``"goal_cell"``; the first one decides.

    Raises
    ------
    ParameterError
        Another ending, no such columns, no such file, or Parquet without pyarrow.
    """
    file = as_path(path)
    check_ending(file)
    try:
        match file.suffix.lower():
            case ".csv":
                return _of_csv(file)
            case ".jsonl":
                return _of_json(file)
        return _of_parquet(file)
    except OSError as error:
        raise ParameterError(f"pairs {file}", error.strerror or str(error), "name a file that can be read") from error


def check_ending(file: Path, what: str = "pairs") -> None:
    """Refuse a file of no known kind, and Parquet without pyarrow.

    Raises
    ------
    ParameterError
    """
    if file.suffix.lower() not in ENDINGS:
        rule = f"its ending is one of {', '.join(ENDINGS)}"
        raise ParameterError(f"{what} {file}", rule, "choose one, and with it the format")
    if file.suffix.lower() == ".parquet" and find_spec("pyarrow") is None:
        raise ParameterError(f"{what} {file}", "Parquet needs pyarrow", 'run: pip install "antnav[parquet]"')


def _of_csv(file: Path) -> Rows:
    stream = io.TextIOWrapper(open_regular(file), "utf-8-sig", "replace", newline="")
    heads = stream.readline()
    delimiter = next((mark for mark in ",;\t" if mark in heads), ",")
    names = [name.strip().lower() for name in next(csv.reader([heads], delimiter=delimiter), [])]
    cells = _cells_by(names, file)

    def rows() -> Iterator[Row]:
        reader = csv.reader(stream, delimiter=delimiter)
        while True:
            try:
                fields = next(reader)
            except StopIteration:
                stream.close()
                return
            except csv.Error as error:
                yield Row(reader.line_num + 1, None, _bad("the line", str(error)))
                continue
            if not fields:
                continue
            if len(fields) == len(names):
                yield _row(reader.line_num + 1, dict(zip(names, fields, strict=True)), cells)
            else:
                error_ = _bad(f"a line of {len(fields)} fields", f"the heads are {len(names)}")
                yield Row(reader.line_num + 1, None, error_)

    return Rows(cells, rows())


class _Line(msgspec.Struct):
    """A query as JSON."""

    start: tuple[float, float] | None = None
    goal: tuple[float, float] | None = None
    start_cell: tuple[int, int] | None = None
    goal_cell: tuple[int, int] | None = None
    id: str | int | None = None


def _of_json(file: Path) -> Rows:
    def parsed() -> Iterator[tuple[int, _Line | ParameterError]]:
        with open_regular(file) as stream:
            for number, line in enumerate(stream, 1):
                if not line.strip():
                    continue
                try:
                    yield number, msgspec.json.decode(line, type=_Line)
                except (msgspec.MsgspecError, UnicodeDecodeError, RecursionError) as error:
                    yield number, _bad("the line", str(error))

    with open_regular(file):  # an error now, not later
        pass
    first = next((line for _, line in parsed() if isinstance(line, _Line)), _Line())
    cells = first.start_cell is not None

    def rows() -> Iterator[Row]:
        names = ("start_cell", "goal_cell") if cells else ("start", "goal")
        for number, line in parsed():
            if isinstance(line, ParameterError):
                yield Row(number, None, line)
                continue
            start, goal = (getattr(line, name) for name in names)
            missing = [name for name, end in zip(names, (start, goal), strict=True) if end is None]
            ends = _bad("the line", f"it has no {missing[0]}") if missing else (start, goal)
            yield Row(number, None if line.id is None else str(line.id), ends)

    return Rows(cells, rows())


def _of_parquet(file: Path) -> Rows:
    import pyarrow
    from pyarrow import parquet

    open_regular(file).close()
    try:
        table = parquet.ParquetFile(file)
    except pyarrow.ArrowException as error:
        raise ParameterError(f"pairs {file}", str(error), "name a Parquet file") from error
    cells = _cells_by(table.schema_arrow.names, file)
    wanted = [*COLUMNS[cells], *(["id"] if "id" in table.schema_arrow.names else [])]

    def rows() -> Iterator[Row]:
        number = 0
        for batch in table.iter_batches(columns=wanted):
            for values in batch.to_pylist():
                number += 1
                yield _row(number, values, cells)

    return Rows(cells, rows())


def _cells_by(names: Iterable[str], file: Path) -> bool:
    given = set(names)
    for cells, columns in COLUMNS.items():
        if given.issuperset(columns):
            return cells
    raise ParameterError(f"pairs {file}", _RULE, "give it these heads")


def _row(line: int, values: dict[str, Any], cells: bool) -> Row:
    kind = int if cells else float
    numbers: list[Any] = []
    name = None if values.get("id") in (None, "") else str(values["id"])
    for column in COLUMNS[cells]:
        try:
            numbers.append(kind(values[column]))
        except (TypeError, ValueError, OverflowError):
            rule = "it is a whole number" if cells else "it is a number"
            return Row(line, name, _bad(f"{column} {shown(values[column])}", rule))
    return Row(line, name, ((numbers[0], numbers[1]), (numbers[2], numbers[3])))


def _bad(given: str, rule: str) -> ParameterError:
    return ParameterError(given, rule, "mend the row")
