"""The gallery: scripts that run while the site is built, each with its pictures and its code below."""

from __future__ import annotations

import ast
import hashlib
import os
from pathlib import Path

import matplotlib as mpl
from docutils import nodes
from matplotlib import pyplot as plt
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

#: Pixels of an inch: a picture of 7 inches fills the text's column on a screen of double density.
DPI = 150


def explanation_and_code(text: str) -> tuple[str, str]:
    """The docstring of a script, and the rest of it."""
    tree = ast.parse(text)
    words = ast.get_docstring(tree)
    if words is None:
        raise ValueError("a script of the gallery begins with what it shows, as a docstring")
    return words, "\n".join(text.splitlines()[tree.body[0].end_lineno :]).strip()


def run(script: Path, into: Path) -> list[Path]:
    """Run a script, and save every figure that it leaves open."""
    into.mkdir(parents=True, exist_ok=True)
    mpl.use("Agg")
    plt.close("all")
    here = Path.cwd()
    os.chdir(into)
    try:
        exec(compile(script.read_text(encoding="utf-8"), script, "exec"), {"__name__": "__main__"})
    finally:
        os.chdir(here)
    saved = []
    for number in plt.get_fignums():
        saved.append(into / f"{script.stem}-{number}.png")
        plt.figure(number).savefig(saved[-1], dpi=DPI, bbox_inches="tight", facecolor="white")
    plt.close("all")
    return saved


class Picture(SphinxDirective):
    """`picture SCRIPT`: heading and text from its docstring, its figures, its code."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        """A section."""
        relative, absolute = self.env.relfn2path(self.arguments[0])
        self.env.note_dependency(relative)
        script = Path(absolute)
        text = script.read_text(encoding="utf-8")
        words, code = explanation_and_code(text)
        title, _, words = words.partition("\n")
        mark = hashlib.sha256(f"{self.config.release} {text}".encode()).hexdigest()[:12]
        folder = Path(self.env.srcdir) / "_build" / "gallery" / mark
        pictures = sorted(folder.glob("*.png")) or run(script, folder)
        if not pictures:
            raise self.error(f"{script.name} leaves no figure open")
        section = nodes.section(ids=[nodes.make_id(script.stem)], names=[script.stem])
        section += nodes.title(title, title.rstrip("."))
        section += self.parse_text_to_nodes(words.strip())
        for picture in pictures:
            uri = os.path.relpath(picture, Path(self.env.doc2path(self.env.docname)).parent)
            section += nodes.image(uri=Path(uri).as_posix(), alt=title.rstrip("."))
        section += nodes.literal_block(code, code, language="python")
        return [section]


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the directive `picture`."""
    app.add_directive("picture", Picture)
    return {"parallel_read_safe": False, "parallel_write_safe": True}
