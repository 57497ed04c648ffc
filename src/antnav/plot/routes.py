"""Several routes on one map, in colours and with numbers where they lie apart."""

from __future__ import annotations

import os
import textwrap
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from antnav.errors import check_type
from antnav.markup import printable
from antnav.plot.data import costs
from antnav.plot.figure import save_drawing
from antnav.plot.map import cell_handles, draw_cells, draw_ends, heat_handle, panel_size
from antnav.plot.style import BLUE, FAINT, GREEN, INK, ORANGE, PURPLE, SKY, VERMILLION, axes_for, legend_below
from antnav.routes.model import Alternatives

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

#: Of the routes; the seventh is dashed in the colour of the first.
COLOURS = (VERMILLION, BLUE, GREEN, PURPLE, ORANGE, SKY)
WIDEST, NARROWEST = 4.2, 1.6  #: Widths in points: what lies below is seen beside what lies above.


def plot_alternatives(alternatives: Alternatives, ax: Axes | None = None) -> Axes:
    """Draw all routes on their map, numbered where they lie apart, with lengths in the legend.

    Parameters
    ----------
    alternatives : Alternatives
    ax : Axes, optional
        Where to draw; default: a new pyplot figure.

    Raises
    ------
    ParameterError
        matplotlib is not installed.
    """
    check_type("alternatives", alternatives, Alternatives, "call an.alternatives(problem)")
    ax = axes_for(ax, panel_size(alternatives.problem.grid, whole=alternatives.problem.allow_unknown))
    _draw(ax, alternatives)
    return ax


def save_alternatives(alternatives: Alternatives, path: str | os.PathLike[str]) -> None:
    """Write the picture that `plot_alternatives` draws, as `save_picture` writes that of a result."""
    check_type("alternatives", alternatives, Alternatives, "call an.alternatives(problem)")

    def draw(figure: Figure) -> None:
        width, height = panel_size(alternatives.problem.grid, whole=alternatives.problem.allow_unknown)
        figure.set_size_inches(width + 1.0, height + 0.16 * len(alternatives))
        figure.set_layout_engine("constrained", w_pad=0.08, h_pad=0.1)
        _draw(figure.add_subplot(), alternatives)

    save_drawing(draw, path)


def _draw(ax: Axes, found: Alternatives) -> None:
    problem, shades = found.problem, costs(found.problem)
    draw_cells(ax, problem.grid, shades, whole=problem.allow_unknown)
    handles = [_draw_route(ax, found, number) for number in range(len(found))]
    for number, (x, y) in enumerate(places(found)):
        badge = {"boxstyle": "circle,pad=0.25", "facecolor": "white", "edgecolor": _colour(number), "linewidth": 1.4}
        ax.text(x, y, str(number + 1), fontsize=8, ha="center", va="center", color=INK, bbox=badge, zorder=5)
    handles += draw_ends(ax, problem)
    handles += cell_handles(problem.grid, kept_out=problem.cost is not None and bool(problem.cost.blocked.any()))
    handles += [] if shades is None else [heat_handle(shades)]
    legend = legend_below(ax, handles)
    lines = [f"Method: {printable(found.method, 300)}", *(f"Note: {printable(note, 300)}" for note in found.notes)]
    legend.set_title("\n".join(textwrap.fill(line, 90) for line in lines))
    legend.get_title().set(fontsize=6.5, color=FAINT, parse_math=False)
    name = printable(problem.grid.name) or f"{problem.grid.rows} x {problem.grid.cols} cells"
    title = f"{found.status.replace('_', ' ')}: {len(found)} of {found.k} routes on {name}"
    ax.set_title(title, fontsize=10, color=INK, parse_math=False)


def _draw_route(ax: Axes, found: Alternatives, number: int) -> Any:
    from matplotlib import patheffects

    route = found[number]
    width = WIDEST - (WIDEST - NARROWEST) * number / max(1, len(found) - 1)
    label = f"{number + 1}: {route.path.length_m:.2f} m"
    label += "" if found.problem.objective.plain else f", cost {route.cost:.2f}"
    label += f", +{100 * route.gap:.1f} %" if number else ""
    label += f", {100 * route.difference:.0f} % different" if number else ""
    (line,) = ax.plot(
        *route.path.points.T,
        color=_colour(number),
        linewidth=width,
        linestyle="-" if number < len(COLOURS) else (0, (3, 1)),
        label=label,
        zorder=3,
        path_effects=[patheffects.Stroke(linewidth=width + 1.2, foreground="white"), patheffects.Normal()],
    )
    return line


def _colour(number: int) -> str:
    return COLOURS[number % len(COLOURS)]


def places(found: Alternatives) -> list[NDArray[np.float64]]:
    """Of each route the point (x, y) in metres that lies farthest from all others, where its number stands."""
    from scipy.spatial import KDTree

    points = [route.path.points for route in found]
    if len(points) == 1:
        return [points[0][len(points[0]) // 2]]
    chosen = []
    for number, own in enumerate(points):
        others = KDTree(np.concatenate(points[:number] + points[number + 1 :]))
        chosen.append(own[int(np.argmax(others.query(own)[0]))])
    return chosen
