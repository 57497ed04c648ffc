"""Markdown: a report with its figures beside it."""

from __future__ import annotations

from collections.abc import Sequence

from antnav.report.section import Section
from antnav.report.table import Table
from antnav.report.text import plain


def table(given: Table) -> str:
    """A pipe table."""
    numbers = [given.right(index) for index in range(len(given.columns))]
    lines = [[column.head for column in given.columns], *given.texts]
    rule = ["---:" if number else "---" for number in numbers]
    cells = [[plain(cell).replace("|", "\\|") for cell in line] for line in lines]
    return "\n".join("| " + " | ".join(line) + " |" for line in [cells[0], rule, *cells[1:]]) + "\n"


def document(title: str, sections: Sequence[Section]) -> str:
    """Headings, text, tables, and figures by the names of their files."""
    parts = [f"# {plain(title)}\n"]
    for section in sections:
        parts.append(f"## {plain(section.title)}\n")
        parts += [f"{plain(text)}\n" for text in section.text]
        if section.items:
            parts.append("".join(f"- {plain(item)}\n" for item in section.items))
        for each in section.tables:
            note = [f"{plain(each.note)}\n"] if each.note else []
            parts += [f"### {plain(each.title)}\n", table(each), *note]
        for drawing in section.drawings:
            name = plain(drawing.title)
            parts += [f"### {name}\n", f"![{name}](figures/{drawing.name}.svg)\n", f"{plain(drawing.caption)}\n"]
    return "\n".join(parts)
