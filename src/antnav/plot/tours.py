"""A tour on its map: legs from light to dark as they come, arrows along them, stops with their numbers."""

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
from antnav.plot.map import cell_handles, draw_cells, heat_handle, mark, mark_size, panel_size
from antnav.plot.style import BLUE, FAINT, GREEN, INK, SKY, VERMILLION, axes_for, legend_below
from antnav.tours.model import Tour
from antnav.tours.order import said_of
from antnav.trajectories.model import Trajectory

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_NUMBERED = 60  #: Stops up to which each has its number; of more, numbers would hide the map.
_ARROWS = 0.06  #: Of the map's longer side, from one arrow to the next.


def plot_tour(tour: Tour, ax: Axes | None = None, *, trajectory: Trajectory | None = None) -> Axes:
    """Draw a tour: its legs, from light to dark as they come, and the stops with the numbers that they were given.

    Parameters
    ----------
    tour : Tour
    ax : Axes, optional
        Where to draw; default: a new pyplot figure.
    trajectory : Trajectory, optional
        Drawn over the legs.

    Raises
    ------
    ParameterError
        matplotlib is not installed.
    """
    check_type("tour", tour, Tour, "call an.tour(grid, start, stops)")
    check_type("trajectory", trajectory, Trajectory | None, "make one with tour.trajectory()")
    ax = axes_for(ax, panel_size(tour.grid))
    _draw(ax, tour, trajectory)
    return ax


def save_tour(tour: Tour, path: str | os.PathLike[str], *, trajectory: Trajectory | None = None) -> None:
    """Write the picture that `plot_tour` draws, as `save_picture` writes that of a result."""
    check_type("tour", tour, Tour, "call an.tour(grid, start, stops)")
    check_type("trajectory", trajectory, Trajectory | None, "make one with tour.trajectory()")

    def draw(figure: Figure) -> None:
        width, height = panel_size(tour.grid)
        figure.set_size_inches(width + 1.0, height + 0.3 + 0.1 * len(tour.notes))
        figure.set_layout_engine("constrained", w_pad=0.08, h_pad=0.1)
        _draw(figure.add_subplot(), tour, trajectory)

    save_drawing(draw, path)


def _draw(ax: Axes, tour: Tour, trajectory: Trajectory | None) -> None:
    shades = costs(tour.legs[0].problem) if tour.legs else None
    draw_cells(ax, tour.grid, shades)
    handles = _draw_way(ax, tour)
    if trajectory is not None:
        label = "trajectory" if trajectory.smooth else "trajectory, turning on the spot"
        handles += ax.plot(*trajectory.points.T, color=INK, linewidth=1.0, label=label, zorder=3.2)
    handles += _draw_stops(ax, tour)
    handles += cell_handles(tour.grid)
    handles += [] if shades is None else [heat_handle(shades)]
    legend = legend_below(ax, handles)
    lines = [
        f"Order: {printable(said_of(tour.method), 300)}",
        *(f"Note: {printable(note, 300)}" for note in tour.notes),
    ]
    legend.set_title("\n".join(textwrap.fill(line, 90) for line in lines))
    legend.get_title().set(fontsize=6.5, color=FAINT, parse_math=False)
    name = printable(tour.grid.name) or f"{tour.grid.rows} x {tour.grid.cols} cells"
    title = f"{tour.status.replace('_', ' ')}: {len(tour)} stops on {name}"
    if tour.path is not None:
        judged = "no order is better" if tour.proven else f"at most {100 * tour.gap:.1f} % above the best order"
        title += f", {tour.length_m:.2f} m\n{judged}"
    ax.set_title(title, fontsize=10, color=INK, parse_math=False)


def _draw_way(ax: Axes, tour: Tour) -> list[Any]:
    """The legs, and arrows along them."""
    from matplotlib import colormaps, patheffects
    from matplotlib.lines import Line2D

    shades = colormaps["viridis_r"](np.linspace(0.15, 0.9, len(tour.legs)))
    halo = [patheffects.Stroke(linewidth=3.6, foreground="white"), patheffects.Normal()]
    for leg, shade in zip(tour.legs, shades, strict=True):
        if leg.path is not None:
            ax.plot(*leg.path.points.T, color=shade, linewidth=2.0, zorder=3, path_effects=halo)
            for (x, y), (dx, dy) in arrows(leg.path.points, _ARROWS * max(tour.grid.shape) * tour.grid.resolution):
                look = {"arrowstyle": "-|>", "color": shade, "mutation_scale": 11, "linewidth": 0}
                ax.annotate(
                    "", xy=(x + dx, y + dy), xytext=(x, y), arrowprops=look | {"shrinkA": 0, "shrinkB": 0}, zorder=3.1
                )
    row = tuple(Line2D([], [], color=shade, linewidth=2.0) for shade in shades[:: max(1, len(shades) // 5)])
    for line in row[:1]:
        line.set_label("legs, first to last")
    return [row] if row else []


def arrows(points: NDArray[np.float64], apart: float) -> list[tuple[NDArray[np.float64], NDArray[np.float64]]]:
    """Where arrows stand along a line, in metres, evenly and `apart` or more, and whither they point."""
    along = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))))
    count = int(along[-1] / apart)
    found = []
    for s in along[-1] * (np.arange(count) + 0.5) / max(count, 1):
        low, high = np.searchsorted(along, [s - apart / 8, s + apart / 8]).clip(0, len(points) - 1)
        if (points[high] != points[low]).any():
            found.append((points[low], points[high] - points[low]))
    return found


def _draw_stops(ax: Axes, tour: Tour) -> list[Any]:
    """The start, and the stops with their numbers, or without where there are many."""
    size = mark_size(tour.grid)
    handles = [mark(ax, tour.places[0], "start", marker="o", color=GREEN, markersize=0.9 * size)]
    for number, place in enumerate(tour.places[1:], 1):
        reached = bool(np.isfinite(tour.distances[0, number]))
        last = bool(tour.order) and not tour.return_to_start and number == tour.order[-1]
        colour = VERMILLION if not reached or last else BLUE
        if len(tour) <= _NUMBERED:
            badge = {"boxstyle": "circle,pad=0.2", "facecolor": "white", "edgecolor": colour, "linewidth": 1.3}
            ax.text(*place, str(number), fontsize=6.5, ha="center", va="center", color=INK, bbox=badge, zorder=5)
        else:
            mark(ax, place, "", marker="o", color=VERMILLION if last else SKY, markersize=0.5 * size)
    return handles
