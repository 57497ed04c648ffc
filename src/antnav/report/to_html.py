"""HTML: a report as one file that needs nothing else."""

from __future__ import annotations

import base64
from collections.abc import Mapping, Sequence

from antnav.markup import escaped
from antnav.report.section import Drawing, Section
from antnav.report.table import Table

PROSE = 30  #: Letters from which a text gets a wider column in HTML.


def table(given: Table) -> str:
    """A table in a box that scrolls sideways on a narrow screen."""
    slim = given.slim()
    looks = _looks(slim)
    heads = "".join(
        f'<th scope="col"{look}>{escaped(column.head)}</th>' for column, look in zip(slim.columns, looks, strict=True)
    )
    body = "\n".join(f"<tr>{_row(row, looks)}</tr>" for row in slim.texts)
    return (
        f'<div class="scroll" tabindex="0"><table id="{slim.name}">\n<caption>{escaped(slim.title)}</caption>\n'
        f"<thead><tr>{heads}</tr></thead>\n<tbody>\n{body}\n</tbody></table></div>\n"
        + (f'<p class="note">{escaped(slim.note)}</p>\n' if slim.note else "")
    )


def _looks(slim: Table) -> list[str]:
    """The class attribute of each column's cells."""
    widths = [max(map(len, column), default=0) for column in zip(*slim.texts, strict=True)]
    looks = []
    for index, (column, width) in enumerate(zip(slim.columns, widths, strict=True)):
        number = slim.right(index)
        classes = ["number"] * number + ["published"] * column.published + ["prose"] * (not number and width > PROSE)
        looks.append(f' class="{" ".join(classes)}"' if classes else "")
    return looks


def _row(row: list[str], looks: list[str]) -> str:
    cells = zip(row[1:], looks[1:], strict=True)
    return f'<th scope="row">{escaped(row[0])}</th>' + "".join(
        f"<td{look}>{escaped(cell)}</td>" for cell, look in cells
    )


_CSS = """
:root { color-scheme: light dark; --ink: #26292e; --faint: #5b6169; --paper: #fff; --line: #d5d8dc; --band: #f3f4f6; }
@media (prefers-color-scheme: dark) {
  :root { --ink: #e4e6e9; --faint: #a3a9b1; --paper: #16181b; --line: #3a3e44; --band: #202327; }
}
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 86rem; padding: 1rem; background: var(--paper); color: var(--ink);
  font: 16px/1.5 system-ui, sans-serif; overflow-wrap: break-word; }
p, ul, figure { max-width: 72rem; }
h1 { font-size: 1.6rem; line-height: 1.25; } h2 { margin-top: 2.5rem; border-bottom: 1px solid var(--line); }
nav ul { padding: 0; display: flex; flex-wrap: wrap; gap: .25rem 1.2rem; list-style: none; }
a { color: inherit; }
.scroll { overflow-x: auto; margin: 1.5rem 0 .5rem; }
table { border-collapse: collapse; font-size: .78rem; line-height: 1.3; overflow-wrap: normal; }
caption { text-align: left; font-weight: 600; font-size: 1rem; padding-bottom: .4rem; white-space: nowrap; }
th, td { padding: .3rem .4rem; text-align: left; vertical-align: top; }
thead th { border-bottom: 2px solid var(--line); vertical-align: bottom; font-weight: 600; }
tbody tr:nth-child(odd) { background: var(--band); }
tbody th { position: sticky; left: 0; background: inherit; background-color: var(--paper); }
tbody tr:nth-child(odd) th { background-color: var(--band); }
thead th:first-child { position: sticky; left: 0; background: var(--paper); }
.scroll::-webkit-scrollbar { height: .6rem; }
.scroll::-webkit-scrollbar-thumb { background: var(--faint); border-radius: .3rem; }
.number { text-align: right; font-variant-numeric: tabular-nums; }
td.number { white-space: nowrap; }
.published { color: var(--faint); font-style: italic; }
td.prose { min-width: 9rem; }
.note, figcaption { color: var(--faint); font-size: .85rem; }
figure { margin: 2rem 0; } figcaption b { color: var(--ink); }
figure img { display: block; background: #fff; border-radius: 4px; max-width: 100%; height: auto; margin: .5rem 0; }
@media (max-width: 40rem) { figure .scroll img.wide { max-width: none; width: 52rem; } }
"""

_WIDE = 600  #: Points from which a figure scrolls sideways on a phone instead of shrinking beyond reading.


def document(title: str, sections: Sequence[Section], pictures: Mapping[str, bytes]) -> str:
    """The page; pictures are SVG by name of the drawing."""
    links = "".join(f'<li><a href="#s{i}">{escaped(section.title)}</a></li>' for i, section in enumerate(sections))
    body = "\n".join(_section(f"s{i}", section, pictures) for i, section in enumerate(sections))
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>{escaped(title)}</title>\n<style>{_CSS}</style>\n</head>\n<body>\n"
        f'<h1>{escaped(title)}</h1>\n<nav aria-label="Sections"><ul>{links}</ul></nav>\n'
        f"<main>\n{body}\n</main>\n</body>\n</html>\n"
    )


def _section(anchor: str, section: Section, pictures: Mapping[str, bytes]) -> str:
    parts = [f'<section id="{anchor}">\n<h2>{escaped(section.title)}</h2>']
    parts += [f"<p>{_text(text)}</p>" for text in section.text]
    if section.items:
        parts.append("<ul>\n" + "\n".join(f"<li>{_text(item)}</li>" for item in section.items) + "\n</ul>")
    parts += [table(each) for each in section.tables]
    parts += [_figure(drawing, pictures[drawing.name]) for drawing in section.drawings]
    return "\n".join([*parts, "</section>"])


def _text(text: str) -> str:
    """Escaped; no line ends between a number and its per cent."""
    return escaped(text).replace(" %", "&nbsp;%")


def _figure(drawing: Drawing, svg: bytes) -> str:
    """The picture as data: its ids cannot clash with those of another."""
    width = float(svg.split(b'width="', 1)[1].split(b"pt", 1)[0])
    look = ' class="wide"' if width > _WIDE else ""
    source = "data:image/svg+xml;base64," + base64.b64encode(svg).decode()
    return (
        f'<figure id="{drawing.name}">\n<div class="scroll" tabindex="0">'
        f'<img{look} src="{source}" alt="{escaped(drawing.title)}"></div>\n'
        f"<figcaption><b>{escaped(drawing.title)}.</b> {escaped(drawing.caption)}</figcaption>\n</figure>"
    )
