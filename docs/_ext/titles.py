"""Links whose words are a file's name, as on a code host, say the page's title here."""

from __future__ import annotations

import posixpath

from docutils import nodes
from sphinx.application import Sphinx


def say_titles(app: Sphinx, doctree: nodes.document, docname: str) -> None:
    """Put titles in."""
    for link in doctree.findall(nodes.reference):
        if not link.get("internal") or not link.astext().endswith(".md"):
            continue
        page = link["refuri"].partition("#")[0]
        target = posixpath.normpath(posixpath.join(posixpath.dirname(docname), page)).removesuffix(".html")
        if target in app.env.titles:
            link.children = [nodes.inline("", app.env.titles[target].astext())]


def setup(app: Sphinx) -> dict[str, bool]:
    """Do so when links are resolved."""
    app.connect("doctree-resolved", say_titles)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
