"""Text and small pictures for HTML: what notebooks show of maps, paths and results."""

from __future__ import annotations

import base64
import html
import io
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

#: Gray levels by kind of cell: free, occupied, unknown, inflated.
GRAYS = np.array([255, 30, 190, 225], np.uint8)
ROUTE = "#D55E00"  #: Okabe & Ito's vermillion.
MOST_PIXELS = 400  #: Of the longer side; of larger maps, a pixel shows the darkest of a block of cells.
WIDTH = 320  #: Of the longer side on the screen.


def printable(text: str, most: int = 60) -> str:
    """Names come from files: one line, of bounded length, without control characters, which SVG forbids."""
    words = " ".join("".join(c if c.isprintable() else " " for c in text).split())
    return words if len(words) <= most else f"{words[: most - 3]}..."


def escaped(text: str) -> str:
    """Text for HTML: on one line, no tags, no control characters."""
    return html.escape(printable(text, len(text)))


def map_html(cells: NDArray[np.uint8], caption: str, path: ArrayLike | None = None) -> str:
    """A map as an inline figure, with a path over it.

    Parameters
    ----------
    cells : ndarray of uint8, shape (rows, cols)
        Values of `grid.Cell`.
    caption : str
        Is escaped here.
    path : array_like of int, shape (k, 2), optional
        Rows and columns.
    """
    rows, cols = cells.shape
    line = ""
    if path is not None:
        points = " ".join(f"{col + 0.5:g},{row + 0.5:g}" for row, col in np.asarray(path).tolist())
        line = f'<polyline points="{points}" fill="none" stroke="{ROUTE}" stroke-width="{max(rows, cols) / 130:g}"/>'
    scale = WIDTH / max(rows, cols)
    return (
        f'<figure style="margin:0"><svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {cols} {rows}" '
        f'width="{max(1.0, cols * scale):.0f}" height="{max(1.0, rows * scale):.0f}">'
        f'<image width="{cols}" height="{rows}" preserveAspectRatio="none" style="image-rendering:pixelated" '
        f'href="data:image/png;base64,{base64.b64encode(_png(cells)).decode()}"/>{line}</svg>'
        f"<figcaption>{escaped(caption)}</figcaption></figure>"
    )


def table_html(caption: str, head: Sequence[str], rows: Sequence[Sequence[str]], total: int) -> str:
    """A table with a caption; all texts are escaped here. Says how many rows there are beyond those shown."""
    heads = "".join(f"<th>{escaped(text)}</th>" for text in head)
    body = "".join("<tr>" + "".join(f"<td>{escaped(text)}</td>" for text in row) + "</tr>" for row in rows)
    more = f"<p>{total - len(rows)} more</p>" if total > len(rows) else ""
    head_and_body = f"<thead><tr>{heads}</tr></thead><tbody>{body}</tbody>"
    return f"<table><caption>{escaped(caption)}</caption>{head_and_body}</table>{more}"


def _png(cells: NDArray[np.uint8]) -> bytes:
    from PIL import Image

    side = -(-max(cells.shape) // MOST_PIXELS)
    gray = GRAYS[cells]
    for axis in (0, 1):
        gray = np.minimum.reduceat(gray, np.arange(0, cells.shape[axis], side), axis=axis)
    content = io.BytesIO()
    Image.fromarray(gray).save(content, "PNG")
    return content.getvalue()
