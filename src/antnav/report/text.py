"""Text: labels of files and users, for Markdown, HTML and LaTeX."""

from __future__ import annotations

import html
import re

from antnav.markup import printable


def plain(text: str) -> str:
    """Text for Markdown: on one line, no HTML, no quotation. A sign between two values, as in t <= b T, stays."""
    return re.sub(r"<(?=[A-Za-z/!?])|^>", lambda found: html.escape(found[0]), one_line(text))


def one_line(text: str) -> str:
    """Labels come from files and users: no line ends, no control characters."""
    return printable(text, len(text))
