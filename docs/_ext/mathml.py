"""Formulas as MathML, by docutils' own converter: browsers draw it without scripts, fonts or LaTeX."""

from __future__ import annotations

from typing import Any, NoReturn

from docutils import nodes
from docutils.utils.math import MathError
from docutils.utils.math.latex2mathml import tex2mathml
from sphinx.application import Sphinx
from sphinx.util import logging

LOG = logging.getLogger(__name__)


def _draw(writer: Any, node: nodes.Element, *, as_block: bool) -> NoReturn:
    try:
        writer.body.append(tex2mathml(node.astext(), as_block=as_block))
    except MathError as error:
        LOG.warning("formula %r: %s", node.astext(), error, location=node)
    raise nodes.SkipNode


def _inline(writer: Any, node: nodes.Element) -> NoReturn:
    _draw(writer, node, as_block=False)


def _block(writer: Any, node: nodes.Element) -> NoReturn:
    _draw(writer, node, as_block=True)


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the renderer `mathml`."""
    app.add_html_math_renderer("mathml", (_inline, None), (_block, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
