"""Tables: columns, rows, and how to write them as Markdown, CSV, LaTeX and HTML."""

from __future__ import annotations

import csv
import html
import io
import math
import re
import textwrap
from collections.abc import Sequence
from dataclasses import dataclass, replace

from antnav.markup import escaped, printable

Value = str | float | int | None

PROSE = 30  #: Letters from which a text gets a wider column in HTML.
#: Points of a line of text in LaTeX's narrowest class, of a letter in its \\footnotesize, and between two columns.
TEX_WIDTH, TEX_LETTER, TEX_GAP = 345, 4.3, 6
TEX_PROSE = 40  #: Letters beyond which a text is broken into lines in LaTeX.
TEX_ROWS = 60  #: Rows of all parts beyond which a table does not fit a page in LaTeX.


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

    def markdown(self) -> str:
        """A pipe table."""
        lines = [[column.head for column in self.columns], *self.texts]
        rule = ["---:" if self.right(index) else "---" for index in range(len(self.columns))]
        cells = [[plain(cell).replace("|", "\\|") for cell in line] for line in lines]
        return "\n".join("| " + " | ".join(line) + " |" for line in [cells[0], rule, *cells[1:]]) + "\n"

    def csv(self) -> str:
        """Full precision; empty for what does not exist, inf for no path."""
        return as_csv([column.head for column in self.columns], self.rows)

    def latex(self) -> str:
        """A floating table of the packages array and booktabs, in parts below each other where it is too wide.

        Where it is too long for a page, longtables, which break between pages.
        """
        slim = self._slim()
        parts = slim._parts()
        caption = f"\\caption{{{_tex(' '.join((_unnumbered(slim.title) + '.', slim.note)).strip())}}}"
        label, small = f"\\label{{tab:{slim.name}}}", "\\footnotesize\\setlength{\\tabcolsep}{3pt}"
        if len(slim.rows) * len(parts) > TEX_ROWS:
            lines = ["% needs \\usepackage{array,booktabs,longtable}, and one column", f"{{{small}"]
            for number, part in enumerate(parts):
                lines += slim._longtable(part, [f"{caption}{label}\\\\"] * (number == 0))
            return "\n".join([*lines, "}"]) + "\n"
        lines = ["% needs \\usepackage{array,booktabs}", "\\begin{table*}", f"\\centering{small}", caption, label]
        for number, part in enumerate(parts):
            lines += ["", "\\medskip"] * (number > 0) + slim._tabular(part)
        return "\n".join([*lines, "\\end{table*}"]) + "\n"

    def _slim(self) -> Table:
        """As it is set in print: short heads, and columns that are footnotes as sentences of the note."""
        kept = [index for index, column in enumerate(self.columns) if not column.footnote]
        notes = [self.note] if self.note else []
        for index, column in enumerate(self.columns):
            if column.footnote:
                notes += _footnotes(column.name.capitalize(), [(texts[0], texts[index]) for texts in self.texts])
        columns = tuple(replace(self.columns[index], head=self.columns[index].name) for index in kept)
        rows = tuple(tuple(row[index] for index in kept) for row in self.rows)
        return Table(self.name, self.title, columns, rows, " ".join(notes))

    def _widths(self) -> list[int]:
        """Letters of each column in LaTeX, whose heads are broken between words."""
        cells = zip(self.columns, zip(*self.texts, strict=True), strict=True) if self.rows else ()
        return [max(map(len, [*column.head.split(), *texts])) for column, texts in cells]

    def _parts(self) -> list[list[int]]:
        """Columns that fit side by side, those that name the row in each part: the texts before the first number."""
        points = [min(width, TEX_PROSE) * TEX_LETTER + TEX_GAP for width in self._widths()]
        names = list(range(next((index for index in range(len(points)) if self.right(index)), 1) or 1))
        parts = [list(names)]
        for index in range(len(names), len(points)):
            taken = sum(points[place] for place in parts[-1])
            if len(parts[-1]) > len(names) and taken + points[index] > TEX_WIDTH:
                parts.append(list(names))
            parts[-1].append(index)
        return parts

    def _tabular(self, part: list[int]) -> list[str]:
        shape, head, rows = self._tex_body(part)
        return [f"\\begin{{tabular}}{{{shape}}}", *head, *rows, "\\bottomrule", "\\end{tabular}"]

    def _longtable(self, part: list[int], caption: list[str]) -> list[str]:
        shape, head, rows = self._tex_body(part)
        begin = [f"\\begin{{longtable}}{{{shape}}}", *caption, *head, "\\endhead"]
        return [*begin, *rows, "\\bottomrule", "\\end{longtable}"]

    def _tex_body(self, part: list[int]) -> tuple[str, list[str], list[str]]:
        """The columns' shapes, the head between its rules, and the rows."""
        widths = self._widths()
        prose = f">{{\\raggedright\\arraybackslash}}p{{{TEX_PROSE * TEX_LETTER:.0f}pt}}"
        shape = "".join(prose if widths[i] > TEX_PROSE else "r" if self.right(i) else "l" for i in part)
        head = ["\\toprule", _tex_line([self._tex_head(index, widths[index]) for index in part]), "\\midrule"]
        return shape, head, [_tex_row([row[index] for index in part]) for row in self.texts]

    def _tex_head(self, index: int, width: int) -> str:
        lines = textwrap.wrap(self.columns[index].head, width) or [""]
        stack = "\\\\".join(map(_tex, lines))
        return stack if len(lines) == 1 else f"\\shortstack[{'r' if self.right(index) else 'l'}]{{{stack}}}"

    def html(self) -> str:
        """A table in a box that scrolls sideways on a narrow screen."""
        return self._slim()._html()

    def _html(self) -> str:
        looks = self._looks()
        heads = "".join(
            f'<th scope="col"{look}>{escaped(column.head)}</th>'
            for column, look in zip(self.columns, looks, strict=True)
        )
        body = "\n".join(f"<tr>{_html_row(row, looks)}</tr>" for row in self.texts)
        return (
            f'<div class="scroll" tabindex="0"><table id="{self.name}">\n<caption>{escaped(self.title)}</caption>\n'
            f"<thead><tr>{heads}</tr></thead>\n<tbody>\n{body}\n</tbody></table></div>\n"
            + (f'<p class="note">{escaped(self.note)}</p>\n' if self.note else "")
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


def _footnotes(what: str, texts: Sequence[tuple[str, str]]) -> list[str]:
    """Texts of rows as sentences: what all have in common, divided at semicolons, and what else each has."""
    parts = {row: text.split("; ") for row, text in texts}
    common = [part for part in next(iter(parts.values()), []) if all(part in own for own in parts.values())]
    owners: dict[str, list[str]] = {}
    for row, own in parts.items():
        owners.setdefault("; ".join(part for part in own if part not in common), []).append(row)
    shared = [f"{what} of all: {'; '.join(common)}."] if common else []
    return shared + [f"{what} of {', '.join(who)}: {text}." for text, who in owners.items() if text]


def _html_row(row: list[str], looks: list[str]) -> str:
    cells = zip(row[1:], looks[1:], strict=True)
    return f'<th scope="row">{escaped(row[0])}</th>' + "".join(
        f"<td{look}>{escaped(cell)}</td>" for cell, look in cells
    )


_TEX = {"\\": "\\textbackslash{}", "~": "\\textasciitilde{}", "^": "\\textasciicircum{}"} | {
    letter: f"\\{letter}" for letter in "&%$#_{}"
}


def _tex(text: str) -> str:
    return "".join(_TEX.get(letter, letter) for letter in _one_line(text))


def _unnumbered(title: str) -> str:
    """A title whose number LaTeX does not repeat: it counts by itself."""
    return re.sub(r"^(Table \d+)\. (.+)", r"\2 (the paper's \1)", title)


def _tex_row(cells: Sequence[str]) -> str:
    return _tex_line([_tex(cell) for cell in cells])


def _tex_line(cells: Sequence[str]) -> str:
    """After a rule or a line's end, LaTeX would read a bracket or a star as an option of these."""
    row = " & ".join(cells) + " \\\\"
    return "{}" * row.startswith(("[", "*")) + row


def plain(text: str) -> str:
    """Text for Markdown: on one line, no HTML, no quotation. A sign between two values, as in t <= b T, stays."""
    return re.sub(r"<(?=[A-Za-z/!?])|^>", lambda found: html.escape(found[0]), _one_line(text))


def _one_line(text: str) -> str:
    """Labels come from files and users: no line ends, no control characters."""
    return printable(text, len(text))


def as_csv(head: Sequence[str], rows: Sequence[Sequence[Value]]) -> str:
    """Full precision; empty for None and nan; texts that a spreadsheet would take for a formula begin with '."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(map(_no_formula, head))
    writer.writerows([[_no_formula(value) for value in row] for row in rows])
    return text.getvalue()


def _no_formula(value: Value) -> Value:
    """An apostrophe before =, +, - or @, unless the text is a number or that sign alone."""
    if isinstance(value, float) and math.isnan(value):
        return ""
    if not isinstance(value, str) or len(value) < 2 or value.lstrip()[:1] not in tuple("=+-@"):
        return value
    try:
        float(value)
    except ValueError:
        return f"'{value}"
    return value
