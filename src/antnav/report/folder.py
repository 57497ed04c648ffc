"""Folder: the files of a report, each whole or not at all, without those of the last one."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path

from antnav.errors import OutputError
from antnav.files import write_whole
from antnav.report import to_csv, to_html, to_latex, to_markdown
from antnav.report.pictures import render
from antnav.report.section import Section

_MANIFEST = "files.txt"  #: Names of the files of a report, so that the next one in that folder can remove them.


def write(out: Path, title: str, sections: Sequence[Section], more: Mapping[str, bytes]) -> Path:
    """Write a report and the files that go with it, and return the path of its HTML.

    Raises
    ------
    ParameterError
        matplotlib is not installed.
    OutputError
        A file cannot be written.
    """
    files, pictures = dict(more), {}
    for section in sections:
        for table in section.tables:
            files[f"tables/{table.name}.csv"] = to_csv.table(table).encode()
            files[f"tables/{table.name}.tex"] = to_latex.table(table).encode()
        for drawing in section.drawings:
            pictures[drawing.name] = render(drawing.draw, "svg")
            files[f"figures/{drawing.name}.svg"] = pictures[drawing.name]
            files[f"figures/{drawing.name}.png"] = render(drawing.draw, "png")
    files["report.md"] = to_markdown.document(title, sections).encode()
    files["report.html"] = to_html.document(title, sections, pictures).encode()
    return _written(files, out)


def _written(files: Mapping[str, bytes], out: Path) -> Path:
    """The report itself last: where it is, the rest is too."""
    try:
        for folder in (out, out / "tables", out / "figures"):
            folder.mkdir(parents=True, exist_ok=True)
        for name in _written_before(out) - files.keys():
            (out / name).unlink(missing_ok=True)
    except OSError as error:
        raise OutputError(
            f"cannot make or clear {error.filename}", error.strerror or str(error), "name a folder that can be made"
        ) from error
    write_whole(out / _MANIFEST, "".join(f"{name}\n" for name in sorted(files)).encode())
    for name, content in files.items():
        write_whole(out / name, content)
    return out / "report.html"


def _written_before(out: Path) -> set[str]:
    """Tables and figures that the folder's last report wrote, whatever else its list may say."""
    try:
        lines = (out / _MANIFEST).read_text(encoding="ascii").splitlines()
    except (OSError, UnicodeError):
        return set()
    return {line for line in lines if re.fullmatch(r"(tables|figures)/\w+\.(csv|tex|svg|png)", line, re.ASCII)}
