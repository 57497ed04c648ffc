"""What came of queries, in files."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Iterable, Iterator
from itertools import islice
from pathlib import Path

import numpy as np
import pytest

import antnav as an
from antnav.batch.records import GROUP, Record, answered, writer_for
from antnav.batch.rows import Row
from antnav.batch.work import Answer, Query
from antnav.errors import ParameterError

GRID = an.GridMap(np.array([[0, 0, 0], [0, 1, 0], [1, 1, 1], [0, 0, 0]]), resolution=0.5)
FOUND = an.solve(an.Problem.from_cells(GRID, (1, 0), (1, 2)), an.astar())
NOWHERE = an.solve(an.Problem.from_cells(GRID, (0, 0), (3, 0)), an.astar())
STAYS = an.solve(an.Problem.from_cells(GRID, (0, 0), (0, 0)), an.astar())
ERROR = ParameterError("the line", 'it says "no", and\nno more', "mend the row")
ENDS = ((1.0, 1.0), (2.0, 2.0))


def records() -> list[Record]:
    return [
        Record.of(Row(2, "a", ENDS), FOUND),
        Record.of(Row(3, None, ENDS), NOWHERE),
        Record.of(Row(5, "ö,", ENDS), ERROR),
        Record.of(Row(6, None, ENDS), STAYS),
    ]


def written(name: str, given: Iterable[Record]) -> bytes:
    stream = io.BytesIO()
    stream.close, content = lambda: None, stream  # type: ignore[method-assign]
    with writer_for(Path(name), stream) as writer:
        for record in given:
            writer.write(record)
    return content.getvalue()


def test_json_lines() -> None:
    first, second, third, last = map(json.loads, written("a.jsonl", records()).splitlines())
    assert (first["status"], first["length"], first["length_m"], first["turns"]) == ("found", 4.0, 2.0, 2)
    assert first["cells"] == [[1, 0], [0, 0], [0, 1], [0, 2], [1, 2]]
    assert first["path"][0] == first["start"] == [0.25, 1.25]
    assert (second["status"], second["length"], second["path"]) == ("unreachable", None, None)
    assert (third["id"], third["status"], third["error"]) == ("ö,", "error", str(ERROR))
    assert last["path"] == [[0.25, 1.75]]


def test_csv_has_wkt() -> None:
    rows = list(csv.DictReader(io.StringIO(written("a.csv", records()).decode(), newline="")))
    assert rows[0]["path"] == "LINESTRING (0.25 1.25, 0.25 1.75, 0.75 1.75, 1.25 1.75, 1.25 1.25)"
    assert (rows[0]["line"], rows[0]["start_y"], rows[0]["goal_x"], rows[0]["cost"]) == ("2", "1.25", "1.25", "4.0")
    assert (rows[1]["status"], rows[1]["path"], rows[1]["length"]) == ("unreachable", "", "")
    assert (rows[2]["error"], rows[2]["start_x"]) == (str(ERROR), "")
    assert rows[3]["path"] == "LINESTRING (0.25 1.75, 0.25 1.75)"


def test_parquet() -> None:
    pytest.importorskip("pyarrow", reason="the extra antnav[parquet] is not installed")
    from pyarrow import BufferReader, parquet

    many = records() * (GROUP // 2)
    rows = parquet.read_table(BufferReader(written("a.parquet", many))).to_pylist()
    lines = map(json.loads, written("a.jsonl", many).splitlines())
    assert rows == list(lines)


def test_gap_and_optimum_where_they_are_known() -> None:
    (result,) = an.solve_many([FOUND.problem], an.astar(), optimum=True)
    record = Record.of(Row(1, None, ENDS), result)
    assert (record.optimum, record.gap) == (4.0, 0.0)
    assert records()[0].optimum is None


@pytest.mark.parametrize("pattern", ["", "b", "g", "bbg", "gbb", "gbgb", "bgbggbb"])
@pytest.mark.parametrize("ahead", [1, 3])
def test_rows_that_are_no_queries_keep_their_place(pattern: str, ahead: int) -> None:
    rows = [Row(line, None, ENDS if letter == "g" else ERROR) for line, letter in enumerate(pattern)]

    def ask(queries: Iterable[Query]) -> Iterator[Answer]:
        """Reads some queries before it answers."""
        source = iter(queries)
        while batch := list(islice(source, ahead)):
            yield from [FOUND] * len(batch)

    found = list(answered(rows, ask))
    assert [row.line for row, _ in found] == list(range(len(rows)))
    assert ["g" if answer is FOUND else "b" for _, answer in found] == list(pattern)


def test_an_end_before_its_time_leaves_rows_out() -> None:
    rows = [Row(0, None, ERROR), Row(1, None, ENDS), Row(2, None, ERROR), Row(3, None, ENDS), Row(4, None, ERROR)]

    def ask(queries: Iterable[Query]) -> Iterator[Answer]:
        list(queries)
        yield FOUND

    assert [row.line for row, _ in answered(rows, ask)] == [0, 1, 2]
