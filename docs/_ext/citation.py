"""CITATION.cff as BibTeX."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import yaml
from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

FILE = Path(__file__).parents[2] / "CITATION.cff"


def bibtex(entry: dict[str, Any]) -> str:
    """One entry, of the software or of an article."""
    authors = " and ".join(one.get("name") or one["family-names"] for one in entry["authors"])
    year = entry.get("year") or str(entry["date-released"])[:4]
    fields = {
        "author": f"{{{authors}}}" if "name" in entry["authors"][0] else authors,
        "title": f"{{{entry['title']}}}",
        "year": year,
        **{name: entry[name] for name in ("journal", "volume", "doi", "version", "license") if name in entry},
        **({"number": entry["issue"]} if "issue" in entry else {}),
    }
    kind, key = ("software", entry["title"]) if entry["type"] == "software" else ("article", authors.split()[0].lower())
    lines = [f"  {name} = {{{value}}}," for name, value in fields.items()]
    return "\n".join([f"@{kind}{{{key}{year},", *lines, "}"])


class Citation(SphinxDirective):
    """`citation`: the software and the papers that it asks to cite."""

    def run(self) -> list[nodes.Node]:
        """A block of BibTeX."""
        self.env.note_dependency(str(FILE))
        said = yaml.safe_load(FILE.read_text(encoding="utf-8"))
        text = "\n\n".join(bibtex(entry) for entry in (said, *said["references"]))
        return [nodes.literal_block(text, text, language="bibtex")]


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the directive `citation`."""
    app.add_directive("citation", Citation)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
