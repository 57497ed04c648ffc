"""The whole picture: path left, convergence right; on the screen or in a file."""

from __future__ import annotations

import io
import os
import threading
from collections.abc import Callable
from functools import partial
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any, Literal, get_args

from antnav.errors import ParameterError, check_type, shown
from antnav.files import as_path, write_whole
from antnav.fronts.front import Front
from antnav.planner.result import Result
from antnav.plot.curves import plot_convergence
from antnav.plot.front import draw_front
from antnav.plot.map import draw_path, panel_size, plot_path
from antnav.plot.style import FAINT, INK, fine_print, legend_below, require_matplotlib, title_of
from antnav.trajectories.model import Trajectory

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SALT = "antnav"  #: Makes the ids in an SVG file depend on its content only.
DPI = 200
FORMATS = ("png", "svg", "pdf")
Panels = Literal["both", "map"]

DRAWING = threading.Lock()  # matplotlib's settings belong to the process


def plot_result(
    result: Result, ax: Axes | None = None, *, trajectory: Trajectory | None = None, panels: Panels = "both"
) -> Axes:
    """Draw a result: the path on its map, and the convergence beside it.

    Parameters
    ----------
    result : Result
    ax : Axes, optional
        Given: only the path picture is drawn, there. Default: a new pyplot figure.
    trajectory : Trajectory, optional
        Of the result, drawn over its path, with the robot at some poses.
    panels : {"both", "map"}
        "map" leaves the convergence out.

    Returns
    -------
    Axes
        The map's; its ``figure`` holds the rest.

    Raises
    ------
    ParameterError
        matplotlib is not installed, or there are no such panels.
    """
    check_type("result", result, Result, "solve a problem first")
    check_type("trajectory", trajectory, Trajectory | None, "make one with result.trajectory")
    check_panels(panels)
    if ax is not None:
        return plot_path(result, ax, trajectory=trajectory)
    require_matplotlib()
    from matplotlib import pyplot as plt

    return _draw_figure(plt.figure(), result, trajectory, panels)


def plot_front(front: Front) -> Axes:
    """Draw a front: its paths on the map, and their values beside it, in the same colours and with the same numbers.

    Parameters
    ----------
    front : Front

    Returns
    -------
    Axes
        The map's, of a new pyplot figure; its ``figure`` holds the rest.

    Raises
    ------
    ParameterError
        matplotlib is not installed.
    """
    check_type("front", front, Front, "make one with antnav.pareto")
    require_matplotlib()
    from matplotlib import pyplot as plt

    return draw_front(plt.figure(), front)


def check_panels(panels: str) -> None:
    """Refuse panels that there are not."""
    if not isinstance(panels, str) or panels not in get_args(Panels):
        raise ParameterError(
            f"panels {shown(panels)}", f"there are {', '.join(get_args(Panels))}", "choose one of them"
        )


def save_picture(
    result: Result | Front,
    path: str | os.PathLike[str],
    *,
    trajectory: Trajectory | None = None,
    panels: Panels = "both",
) -> None:
    """Write the picture that `plot_result` or `plot_front` draws, whole or not at all.

    Uses neither pyplot nor the user's style: the same result gives the same bytes of SVG or PDF with the same
    matplotlib. For a style of your own take ``plot_result(result).figure.savefig``.

    Parameters
    ----------
    result : Result or Front
    path : path-like
        Ends in .png, .svg or .pdf.
    trajectory : Trajectory, optional
        Of the result, drawn over its path, with the robot at some poses.
    panels : {"both", "map"}
        Of a result: "map" leaves the convergence out.

    Raises
    ------
    ParameterError
        Another ending, no such panels, or matplotlib is not installed.
    OutputError
        The file cannot be written; nothing of it is left behind.
    """
    check_type("result", result, Result | Front, "solve a problem first")
    check_type("trajectory", trajectory, Trajectory | None, "make one with result.trajectory")
    check_panels(panels)
    if isinstance(result, Front):
        draw = partial(draw_front, front=result)
    else:
        draw = partial(_draw_figure, result=result, trajectory=trajectory, panels=panels)
    save_drawing(draw, path, tight=panels == "map")


def save_drawing(draw: Callable[[Figure], object], path: str | os.PathLike[str], *, tight: bool = False) -> None:
    """Write what a function draws on a figure, on request without blank edges; see `save_picture`."""
    ending = as_path(path).suffix.lower().removeprefix(".")
    if ending not in FORMATS:
        raise ParameterError(
            f"file name {FilePath(path).name}", f"pictures end in .{', .'.join(FORMATS)}", "choose one of them"
        )
    write_whole(path, _render(draw, ending, tight=tight))


def _render(draw: Callable[[Figure], object], ending: str, *, tight: bool) -> bytes:
    require_matplotlib()
    import matplotlib.style
    from matplotlib.figure import Figure

    undated = {"svg": {"Date": None}, "pdf": {"CreationDate": None}}
    own = {"svg.hashsalt": SALT, "pdf.fonttype": 42}  # journals refuse type 3 fonts
    content = io.BytesIO()
    with DRAWING, matplotlib.style.context(["default", own]):
        figure = Figure()
        draw(figure)
        edges: Any = "tight" if tight else None
        figure.savefig(
            content, format=ending, dpi=DPI, metadata=undated.get(ending), facecolor="white", bbox_inches=edges
        )
    return content.getvalue()


def _draw_figure(figure: Figure, result: Result, trajectory: Trajectory | None = None, panels: Panels = "both") -> Axes:
    """The whole picture: path left, convergence right, title above, fine print below."""
    width, height = panel_size(result.problem.grid, whole=result.problem.allow_unknown)
    if panels == "map":
        figure.set_size_inches(width, height + 0.9)
        figure.set_layout_engine("constrained")
        return plot_path(result, figure.subplots(), trajectory=trajectory)
    right = 4.9
    height = max(height, 5.2)
    figure.set_size_inches(width + right, height)
    figure.set_layout_engine("constrained", w_pad=0.08, h_pad=0.15)
    left_ax: Axes
    left_ax, right_ax = figure.subplots(1, 2, width_ratios=[width, right])
    legend_below(left_ax, draw_path(left_ax, result, trajectory))
    plot_convergence(result, right_ax)
    style: dict[str, Any] = {"x": 0.012, "ha": "left", "color": INK}
    figure.suptitle(title_of(result), fontsize=11, parse_math=False, **style)
    letters = int(17 * (width + right))
    figure.supxlabel(fine_print(result, letters), fontsize=6.5, parse_math=False, **style | {"color": FAINT})
    return left_ax
