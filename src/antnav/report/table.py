"""Table: columns and rows; `to_csv`, `to_markdown`, `to_html` and `to_latex` write it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

Value = str | float | int | None


@dataclass(frozen=True)
class Column:
    """A column: its head, how its numbers are written (a format specification), whether others published them.

    In HTML and LaTeX, `short` stands for the head, and a `footnote` stands below the table.
    """

    head: str
    spec: str = ""
    published: bool = False
    short: str = ""
    footnote: bool = False

    @property
    def name(self) -> str:
        """The short head, where there is one."""
        return self.short or self.head

    def text(self, value: Value) -> str:
        """A value for readers: a dash for what does not exist, "no path" for an infinite length."""
        if value is None or (isinstance(value, float) and math.isnan(value)):
            return "-"
        if isinstance(value, float) and math.isinf(value):
            return "no path"
        return value if isinstance(value, str) else format(value, self.spec)


@dataclass(frozen=True)
class Table:
    """A table with its name (of its files), its title, and a note on how to read it."""

    name: str
    title: str
    columns: tuple[Column, ...]
    rows: tuple[tuple[Value, ...], ...]
    note: str = ""

    @property
    def texts(self) -> list[list[str]]:
        """All cells as readers see them."""
        return [[column.text(value) for column, value in zip(self.columns, row, strict=True)] for row in self.rows]

    def right(self, index: int) -> bool:
        """Whether a column holds numbers, which are set flush right."""
        return bool(self.columns[index].spec)

    def slim(self) -> Table:
        """As it is set in print: short heads, and columns that are footnotes as sentences of the note."""
        kept = [index for index, column in enumerate(self.columns) if not column.footnote]
        notes = [self.note] if self.note else []
        for index, column in enumerate(self.columns):
            if column.footnote:
                notes += _footnotes(column.name.capitalize(), [(texts[0], texts[index]) for texts in self.texts])
        columns = tuple(replace(self.columns[index], head=self.columns[index].name) for index in kept)
        rows = tuple(tuple(row[index] for index in kept) for row in self.rows)
        return Table(self.name, self.title, columns, rows, " ".join(notes))


def _footnotes(what: str, texts: Sequence[tuple[str, str]]) -> list[str]:
    """Texts of rows as sentences: what all have in common, divided at semicolons, and what else each has."""
    parts = {row: text.split("; ") for row, text in texts}
    common = [part for part in next(iter(parts.values()), []) if all(part in own for own in parts.values())]
    owners: dict[str, list[str]] = {}
    for row, own in parts.items():
        owners.setdefault("; ".join(part for part in own if part not in common), []).append(row)
    shared = [f"{what} of all: {'; '.join(common)}."] if common else []
    return shared + [f"{what} of {', '.join(who)}: {text}." for text, who in owners.items() if text]
