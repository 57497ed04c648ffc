"""LaTeX: tables that fit a page."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Sequence

from antnav.report.table import Table
from antnav.report.text import one_line

#: Points of a line of text in LaTeX's narrowest class, of a letter in its \\footnotesize, and between two columns.
TEX_WIDTH, TEX_LETTER, TEX_GAP = 345, 4.3, 6
TEX_PROSE = 40  #: Letters beyond which a text is broken into lines in LaTeX.
TEX_ROWS = 60  #: Rows of all parts beyond which a table does not fit a page in LaTeX.


def table(given: Table) -> str:
    """A floating table of the packages array and booktabs, in parts below each other where it is too wide.

    Where it is too long for a page, longtables, which break between pages.
    """
    slim = given.slim()
    parts = _parts(slim)
    caption = f"\\caption{{{_tex(' '.join((_unnumbered(slim.title) + '.', slim.note)).strip())}}}"
    label, small = f"\\label{{tab:{slim.name}}}", "\\footnotesize\\setlength{\\tabcolsep}{3pt}"
    if len(slim.rows) * len(parts) > TEX_ROWS:
        lines = ["% needs \\usepackage{array,booktabs,longtable}, and one column", f"{{{small}"]
        for number, part in enumerate(parts):
            lines += _longtable(slim, part, [f"{caption}{label}\\\\"] * (number == 0))
        return "\n".join([*lines, "}"]) + "\n"
    lines = ["% needs \\usepackage{array,booktabs}", "\\begin{table*}", f"\\centering{small}", caption, label]
    for number, part in enumerate(parts):
        lines += ["", "\\medskip"] * (number > 0) + _tabular(slim, part)
    return "\n".join([*lines, "\\end{table*}"]) + "\n"


def _widths(slim: Table) -> list[int]:
    """Letters of each column in LaTeX, whose heads are broken between words."""
    cells = zip(slim.columns, zip(*slim.texts, strict=True), strict=True) if slim.rows else ()
    return [max(map(len, [*column.head.split(), *texts])) for column, texts in cells]


def _parts(slim: Table) -> list[list[int]]:
    """Columns that fit side by side, those that name the row in each part: the texts before the first number."""
    points = [min(width, TEX_PROSE) * TEX_LETTER + TEX_GAP for width in _widths(slim)]
    names = list(range(next((index for index in range(len(points)) if slim.right(index)), 1) or 1))
    parts = [list(names)]
    for index in range(len(names), len(points)):
        taken = sum(points[place] for place in parts[-1])
        if len(parts[-1]) > len(names) and taken + points[index] > TEX_WIDTH:
            parts.append(list(names))
        parts[-1].append(index)
    return parts


def _tabular(slim: Table, part: list[int]) -> list[str]:
    shape, head, rows = _tex_body(slim, part)
    return [f"\\begin{{tabular}}{{{shape}}}", *head, *rows, "\\bottomrule", "\\end{tabular}"]


def _longtable(slim: Table, part: list[int], caption: list[str]) -> list[str]:
    shape, head, rows = _tex_body(slim, part)
    begin = [f"\\begin{{longtable}}{{{shape}}}", *caption, *head, "\\endhead"]
    return [*begin, *rows, "\\bottomrule", "\\end{longtable}"]


def _tex_body(slim: Table, part: list[int]) -> tuple[str, list[str], list[str]]:
    """The columns' shapes, the head between its rules, and the rows."""
    widths = _widths(slim)
    prose = f">{{\\raggedright\\arraybackslash}}p{{{TEX_PROSE * TEX_LETTER:.0f}pt}}"
    shape = "".join(prose if widths[i] > TEX_PROSE else "r" if slim.right(i) else "l" for i in part)
    head = ["\\toprule", _tex_line([_tex_head(slim, index, widths[index]) for index in part]), "\\midrule"]
    return shape, head, [_tex_row([row[index] for index in part]) for row in slim.texts]


def _tex_head(slim: Table, index: int, width: int) -> str:
    lines = textwrap.wrap(slim.columns[index].head, width) or [""]
    stack = "\\\\".join(map(_tex, lines))
    return stack if len(lines) == 1 else f"\\shortstack[{'r' if slim.right(index) else 'l'}]{{{stack}}}"


_TEX = {"\\": "\\textbackslash{}", "~": "\\textasciitilde{}", "^": "\\textasciicircum{}"} | {
    letter: f"\\{letter}" for letter in "&%$#_{}"
}


def _tex(text: str) -> str:
    return "".join(_TEX.get(letter, letter) for letter in one_line(text))


def _unnumbered(title: str) -> str:
    """A title whose number LaTeX does not repeat: it counts by itself."""
    return re.sub(r"^(Table \d+)\. (.+)", r"\2 (the paper's \1)", title)


def _tex_row(cells: Sequence[str]) -> str:
    return _tex_line([_tex(cell) for cell in cells])


def _tex_line(cells: Sequence[str]) -> str:
    """After a rule or a line's end, LaTeX would read a bracket or a star as an option of these."""
    row = " & ".join(cells) + " \\\\"
    return "{}" * row.startswith(("[", "*")) + row
