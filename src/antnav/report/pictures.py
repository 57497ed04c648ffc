"""Pictures: a look for each series, figures without pyplot, and their bytes.

Every algorithm keeps one look (colour, line style, marker) in all figures; the looks differ in grey print too.
"""

from __future__ import annotations

import io
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from antnav.plot.figure import DPI, DRAWING, SALT
from antnav.plot.style import BLUE, FAINT, GREEN, INK, ORANGE, PURPLE, VERMILLION, require_matplotlib

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Looks = dict[str, dict[str, Any]]

_LOOKS: tuple[dict[str, Any], ...] = (
    {"color": VERMILLION, "linestyle": "-", "marker": "o"},
    {"color": BLUE, "linestyle": (0, (5, 1.6)), "marker": "s"},
    {"color": GREEN, "linestyle": (0, (6, 1.5, 1, 1.5)), "marker": "^"},
    {"color": INK, "linestyle": (0, (1.2, 1.2)), "marker": "D"},
    {"color": PURPLE, "linestyle": (0, (3, 1.2)), "marker": "v"},
    {"color": ORANGE, "linestyle": (0, (4, 1.2, 1, 1.2, 1, 1.2)), "marker": "P"},
    {"color": FAINT, "linestyle": (0, (8, 2)), "marker": "X"},
)
#: The paper's algorithms look alike in every report.
PAPER = ("paco", "npaco", "dai", "traditional", "luo")


def looks(names: Sequence[str], also: Sequence[str] = ()) -> Looks:
    """A look for each algorithm; the first seven differ. `also` names others that look alike in every report."""
    fixed = dict(zip((*PAPER, *also), _LOOKS, strict=False))
    free = [look for look in _LOOKS if look not in [fixed[name] for name in names if name in fixed]] or list(_LOOKS)
    others = [name for name in names if name not in fixed]
    return {name: fixed.get(name) or free[others.index(name) % len(free)] for name in names}


def new_figure(width: float, height: float) -> Figure:
    """A figure of this size in inches, without pyplot."""
    require_matplotlib()
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), layout="constrained")


def render(draw: Callable[[], Figure], ending: str) -> bytes:
    """The bytes of a figure that `draw()` makes, in matplotlib's default style, as "svg" or "png"."""
    require_matplotlib()
    import matplotlib.style

    content = io.BytesIO()
    own = {"svg.hashsalt": SALT, "svg.fonttype": "path"}
    with DRAWING, matplotlib.style.context(["default", own]):
        figure = draw()
        undated = {"Date": None} if ending == "svg" else None
        figure.savefig(content, format=ending, dpi=DPI, metadata=undated, facecolor="white")
    return content.getvalue()
