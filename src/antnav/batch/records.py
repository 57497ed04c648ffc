"""What came of queries, for files: CSV, JSON lines, Parquet, a row a query; without times, so the same on each run."""

from __future__ import annotations

import csv
import io
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from types import TracebackType
from typing import Any, BinaryIO, Protocol, Self

import msgspec

from antnav.batch.rows import Row
from antnav.batch.work import Answer, Query
from antnav.errors import AntnavError
from antnav.planner.document import finite

#: Rows of Parquet that are written at a time.
GROUP = 1000


class Record(msgspec.Struct, kw_only=True):
    """A row of output: points in metres, lengths and costs in cells but for `length_m`; None where there is none."""

    line: int
    id: str | None = None
    status: str  #: of the result, or "error"
    start: tuple[float, float] | None = None
    goal: tuple[float, float] | None = None
    length: float | None = None
    length_m: float | None = None
    cost: float | None = None
    optimum: float | None = None
    gap: float | None = None
    turns: int | None = None
    path: list[tuple[float, float]] | None = None
    cells: list[tuple[int, int]] | None = None
    error: str | None = None

    @classmethod
    def of(cls, row: Row, answer: Answer) -> Self:
        """What came of a row."""
        if isinstance(answer, AntnavError):
            return cls(line=row.line, id=row.id, status="error", error=str(answer))
        problem, path = answer.problem, answer.path
        known = answer.certificate is not None
        return cls(
            line=row.line,
            id=row.id,
            status=answer.status.value,
            start=problem.start,
            goal=problem.goal,
            length=finite(answer.length),
            length_m=finite(answer.length_m),
            cost=finite(answer.cost),
            optimum=finite(answer.optimum) if known else None,
            gap=finite(answer.gap) if known else None,
            turns=path.turns if path else None,
            path=path.points.tolist() if path else None,
            cells=path.cells.tolist() if path else None,
        )


def answered(rows: Iterable[Row], ask: Callable[[Iterable[Query]], Iterator[Answer]]) -> Iterator[tuple[Row, Answer]]:
    """Each row with what came of it, in the order of the rows; `ask` is not asked those that are no queries."""
    waiting = deque[Row]()

    def queries() -> Iterator[Query]:
        for row in rows:
            waiting.append(row)
            if not isinstance(row.ends, AntnavError):
                yield row.ends

    def bad() -> Iterator[tuple[Row, Answer]]:
        while waiting and isinstance(waiting[0].ends, AntnavError):
            row = waiting.popleft()
            assert isinstance(row.ends, AntnavError)
            yield row, row.ends

    for answer in ask(queries()):
        yield from bad()
        yield waiting.popleft(), answer
    yield from bad()


class Writer(Protocol):
    """Writes records; a context manager."""

    def write(self, record: Record) -> None:
        """Write one."""

    def __enter__(self) -> Self: ...

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None: ...


def writer_for(file: Path, stream: BinaryIO) -> Writer:
    """The writer for a file's ending, which `check_ending` has let pass."""
    return {".csv": _Csv, ".parquet": _Parquet}.get(file.suffix.lower(), JsonLines)(stream)


class JsonLines:
    """An object a line."""

    def __init__(self, stream: BinaryIO) -> None:
        self._stream = stream

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Nothing is kept back."""

    def write(self, record: Record) -> None:
        """Write one."""
        self._stream.write(msgspec.json.encode(record) + b"\n")


class _Csv(JsonLines):
    """Points as x and y, the path as WKT, which geographic tools read."""

    _ENDS = ("start_x", "start_y", "goal_x", "goal_y")

    def __enter__(self) -> Self:
        heads = [name for name in Record.__struct_fields__ if name not in ("start", "goal", "cells")]
        heads[3:3] = self._ENDS
        self._line(heads)
        return self

    def write(self, record: Record) -> None:
        values = msgspec.structs.asdict(record)
        ends = [*(values.pop("start") or (None, None)), *(values.pop("goal") or (None, None))]
        del values["cells"]
        if record.path is not None:
            points = record.path if len(record.path) > 1 else 2 * record.path  # a line has two
            values["path"] = f"LINESTRING ({', '.join(f'{x!r} {y!r}' for x, y in points)})"
        fields = list(values.values())
        fields[3:3] = ends
        self._line(fields)

    def _line(self, fields: Iterable[Any]) -> None:
        text = io.StringIO()
        csv.writer(text, lineterminator="\n").writerow(fields)
        self._stream.write(text.getvalue().encode())


class _Parquet(JsonLines):
    """Columns as of JSON, paths as lists."""

    def __enter__(self) -> Self:
        import pyarrow
        from pyarrow import parquet

        number, point = pyarrow.float64(), pyarrow.list_(pyarrow.float64(), 2)
        kinds = dict.fromkeys(Record.__struct_fields__, number)
        kinds |= dict.fromkeys(("id", "status", "error"), pyarrow.string())
        kinds |= {"line": pyarrow.int64(), "turns": pyarrow.int64(), "start": point, "goal": point}
        kinds |= {"path": pyarrow.list_(point), "cells": pyarrow.list_(pyarrow.list_(pyarrow.int32(), 2))}
        self._schema = pyarrow.schema(list(kinds.items()))
        self._table, self._rows = parquet.ParquetWriter(self._stream, self._schema), list[dict[str, Any]]()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if error is None:
            self._flush()
        self._table.close()

    def write(self, record: Record) -> None:
        self._rows.append(msgspec.structs.asdict(record))
        if len(self._rows) == GROUP:
            self._flush()

    def _flush(self) -> None:
        import pyarrow

        self._table.write_table(pyarrow.Table.from_pylist(self._rows, self._schema))
        self._rows = []
