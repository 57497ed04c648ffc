"""Tables: columns, rows, and how to write them as Markdown, CSV, LaTeX and HTML."""

from __future__ import annotations

import csv
import html
import io
import math
from collections.abc import Sequence
from dataclasses import dataclass

Value = str | float | int | None

PROSE = 30  #: Letters from which a text gets a wider column in HTML.


@dataclass(frozen=True)
class Column:
    """A column: its head, how its numbers are written (a format specification), whether others published them."""

    head: str
    spec: str = ""
    published: bool = False

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

    def markdown(self) -> str:
        """A pipe table."""
        lines = [[column.head for column in self.columns], *self.texts]
        rule = ["---:" if self.right(index) else "---" for index in range(len(self.columns))]
        escaped = [[plain(cell).replace("|", "\\|") for cell in line] for line in lines]
        return "\n".join("| " + " | ".join(line) + " |" for line in [escaped[0], rule, *escaped[1:]]) + "\n"

    def csv(self) -> str:
        """Full precision; empty for what does not exist, inf for no path."""
        return as_csv([column.head for column in self.columns], self.rows)

    def latex(self) -> str:
        """A floating table of the packages booktabs and graphicx."""
        shape = "".join("r" if self.right(index) else "l" for index in range(len(self.columns)))
        lines = [
            "% needs \\usepackage{booktabs,graphicx}",
            "\\begin{table*}",
            "\\centering",
            f"\\caption{{{_tex(' '.join((self.title + '.', self.note)).strip())}}}",
            f"\\label{{tab:{self.name}}}",
            "\\resizebox{\\textwidth}{!}{%",
            f"\\begin{{tabular}}{{{shape}}}",
            "\\toprule",
            _tex_row([column.head for column in self.columns]),
            "\\midrule",
            *(_tex_row(row) for row in self.texts),
            "\\bottomrule",
            "\\end{tabular}}",
            "\\end{table*}",
        ]
        return "\n".join(lines) + "\n"

    def html(self) -> str:
        """A table in a box that scrolls sideways on a narrow screen."""
        looks = self._looks()
        heads = "".join(
            f'<th scope="col"{look}>{html.escape(column.head)}</th>'
            for column, look in zip(self.columns, looks, strict=True)
        )
        body = "\n".join(f"<tr>{_html_row(row, looks)}</tr>" for row in self.texts)
        return (
            f'<div class="scroll" tabindex="0"><table id="{self.name}">\n<caption>{html.escape(self.title)}</caption>\n'
            f"<thead><tr>{heads}</tr></thead>\n<tbody>\n{body}\n</tbody></table></div>\n"
            + (f'<p class="note">{html.escape(self.note)}</p>\n' if self.note else "")
        )

    def _looks(self) -> list[str]:
        """The class attribute of each column's cells in HTML."""
        widths = [max(map(len, column), default=0) for column in zip(*self.texts, strict=True)]
        looks = []
        for index, (column, width) in enumerate(zip(self.columns, widths, strict=True)):
            number = self.right(index)
            classes = (
                ["number"] * number + ["published"] * column.published + ["prose"] * (not number and width > PROSE)
            )
            looks.append(f' class="{" ".join(classes)}"' if classes else "")
        return looks


def _html_row(row: list[str], looks: list[str]) -> str:
    cells = zip(row[1:], looks[1:], strict=True)
    return f'<th scope="row">{html.escape(row[0])}</th>' + "".join(
        f"<td{look}>{html.escape(cell)}</td>" for cell, look in cells
    )


_TEX = {"\\": "\\textbackslash{}", "~": "\\textasciitilde{}", "^": "\\textasciicircum{}"} | {
    letter: f"\\{letter}" for letter in "&%$#_{}"
}


def _tex(text: str) -> str:
    return "".join(_TEX.get(letter, letter) for letter in _one_line(text))


def _tex_row(cells: Sequence[str]) -> str:
    """After a rule or a line's end, LaTeX would read a bracket or a star as an option of these."""
    row = " & ".join(_tex(cell) for cell in cells) + " \\\\"
    return "{}" * row.startswith(("[", "*")) + row


def plain(text: str) -> str:
    """Text for Markdown: on one line, and no HTML."""
    return _one_line(text).replace("<", "&lt;").replace(">", "&gt;")


def _one_line(text: str) -> str:
    return " ".join(text.splitlines())


def as_csv(head: Sequence[str], rows: Sequence[Sequence[Value]]) -> str:
    """Full precision; empty for None and nan."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(head)
    writer.writerows(
        [["" if isinstance(value, float) and math.isnan(value) else value for value in row] for row in rows]
    )
    return text.getvalue()
