"""Pictures of maps and results: data first, drawing second. Needs matplotlib, the extra ``antnav[plot]``.

Every drawing function takes ``ax=None`` and returns the Axes; without one it opens a pyplot figure. `save_picture` does
without pyplot, so it works on servers and in threads.
"""

from __future__ import annotations

import io
import math
import os
import textwrap
import threading
from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from antnav.errors import ParameterError
from antnav.files import write_whole
from antnav.grid import Cell, GridMap
from antnav.result import Result, Status, StoppedBy

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.legend import Legend

__all__ = [
    "Convergence",
    "Heat",
    "convergence",
    "heat",
    "map_colours",
    "plot_convergence",
    "plot_map",
    "plot_path",
    "plot_result",
    "save_picture",
]

#: Colours of the cells, in the order of `Cell`. In grey print they keep four steps: 100, 16, 91 and 74 %.
CELL_COLOURS = np.array([(255, 255, 255), (38, 41, 46), (240, 231, 205), (186, 189, 194)], np.uint8)
#: Okabe & Ito 2008: told apart by all kinds of colour vision.
BLUE, SKY, ORANGE, VERMILLION, GREEN, PURPLE, YELLOW = (
    "#0072B2",
    "#56B4E9",
    "#E69F00",
    "#D55E00",
    "#009E73",
    "#CC79A7",
    "#F0E442",
)
INK, FAINT = "#26292e", "#6b7077"

GRID_SIDE = 60  #: Longer side in cells up to which lines between the cells are drawn.
DRAWN_SIDE = 4096  #: Longer side in cells up to which each cell is drawn; of larger maps, means of blocks.
SALT = "antnav"  #: Makes the ids in an SVG file depend on its content only.
DPI = 200
FORMATS = ("png", "svg", "pdf")

_drawing = threading.Lock()  # matplotlib's settings belong to the process


# ---------------------------------------------------------------------------------------------------------- data


@dataclass(frozen=True, eq=False)
class Convergence:
    """What a convergence figure shows: one value an iteration, lengths in cells, nan before any ant arrived.

    Attributes
    ----------
    iteration : ndarray of int64
        1, 2, ...
    best, iteration_best, mean : ndarray of float64
        Best so far, best of the iteration, mean of the ants that arrived in it. Of a divided problem: in stage one the
        better colony (the mean: of both), in stage two the sum of the two halves, so `best` may jump between them.
    stage_one : int
        How many of the iterations belong to stage one; 0 where the problem was not divided.
    divided : bool
        Whether stage two took place.
    optimum : float
        Length of a shortest path; inf where none exists.
    length : float
        Length of the path that was returned; inf without one. A repaired join may be shorter than `best`.
    """

    iteration: NDArray[np.int64]
    best: NDArray[np.float64]
    iteration_best: NDArray[np.float64]
    mean: NDArray[np.float64]
    stage_one: int
    divided: bool
    optimum: float
    length: float

    @property
    def stages(self) -> list[slice]:
        """The iterations of each stage; values of different stages are not joined by a line."""
        parts = [slice(0, self.stage_one), slice(self.stage_one, len(self.iteration))]
        return [part for part in parts if part.stop > part.start]


def convergence(result: Result) -> Convergence:
    """Gather what `plot_convergence` draws."""
    history = result.history
    best, iteration_best, mean = (
        np.where(np.isfinite(values), values, np.nan) for values in (history.best, history.iteration_best, history.mean)
    )
    names = [stage.name for stage in result.stages]
    divided = names[-1:] == ["stage two"]
    stage_one = 0
    if divided:  # earlier attempts at stage one, in which no ant arrived, have left no history
        stage_one = max(colony.iterations for colony in result.stages[-2].colonies)
    elif names[-1:] == ["stage one"]:
        stage_one = len(best)
    number = np.arange(1, len(best) + 1, dtype=np.int64)
    return Convergence(number, best, iteration_best, mean, stage_one, divided, result.optimum, result.length)


@dataclass(frozen=True, eq=False)
class Heat:
    """Shades for the cells of a map.

    Attributes
    ----------
    shade : ndarray of float32, shape (rows, cols)
        0 keeps the cell's own colour, 1 is the darkest.
    label : str
        What the legend says.
    even : bool
        Whether there is one shade only.
    """

    shade: NDArray[np.float32]
    label: str
    even: bool = False


def heat(result: Result) -> Heat | None:
    """Gather the pheromone, as shades: 1 at the most, 0 at a hundredth of it or at the median, logarithmic between.

    Few cells are on the ants' way, so the median is near what evaporation leaves; ants hardly feel less than a
    hundredth. Of a divided problem the pheromone is the sum of both halves'. Where no path exists, the shaded cells
    are those that can be reached from the start. None where there is nothing to show.
    """
    if result.status is Status.UNREACHABLE:
        return Heat(np.float32(0.2) * result.problem.reachable.astype(np.float32), "reachable from the start", True)
    field = result.pheromone
    if field is None or not np.isfinite(field).any():
        return None
    high = float(np.nanmax(field))
    low = max(float(np.nanmedian(field)), high / 100)
    if not 0 < low < high:
        return None
    with np.errstate(invalid="ignore"):
        shade = np.log(np.clip(np.nan_to_num(field, nan=low), low, high) / low) / math.log(high / low)
    return Heat(shade.astype(np.float32), f"pheromone, {low:.2g} to {high:.2g} (log)")


def map_colours(grid: GridMap, heat: Heat | None = None) -> NDArray[np.uint8]:
    """Colour of each cell, shape (rows, cols, 3): free white, wall dark, inflated grey, unknown sand; shades blue."""
    colours: NDArray[np.uint8] = CELL_COLOURS[grid.cells]
    if heat is None:
        return colours
    shaded = heat.shade > 0
    colours[shaded] = _shaded(colours[shaded], heat.shade[shaded])
    return colours


def _shaded(colours: NDArray[np.uint8], shade: NDArray[np.float32]) -> NDArray[np.uint8]:
    """Colours on the way from the cell's own (0) over sky blue (1/2) to blue (1); shapes (n, 3) and (n,)."""
    sky, blue = (np.array([int(text[k : k + 2], 16) for k in (1, 3, 5)], np.float32) for text in (SKY, BLUE))
    lower, upper = np.minimum(2 * shade, 1)[:, None], np.maximum(2 * shade - 1, 0)[:, None]
    mixed = colours + (sky - colours) * lower
    return np.rint(mixed + (blue - mixed) * upper).astype(np.uint8)


def _in_picture(grid: GridMap, points: ArrayLike) -> NDArray[np.float64]:
    """World points in the picture's coordinates: the world's own, or the map's frame where the map is turned."""
    points = np.asarray(points, np.float64)
    x0, y0, yaw = grid.origin
    if yaw == 0:
        return points
    dx, dy = points[..., 0] - x0, points[..., 1] - y0
    return np.stack((math.cos(yaw) * dx + math.sin(yaw) * dy, math.cos(yaw) * dy - math.sin(yaw) * dx), axis=-1)


def _extent(grid: GridMap) -> tuple[float, float, float, float]:
    """Left, right, bottom and top of the picture in metres."""
    left, bottom = grid.origin[:2] if grid.origin[2] == 0 else (0.0, 0.0)
    return left, left + grid.cols * grid.resolution, bottom, bottom + grid.rows * grid.resolution


def _title(result: Result) -> str:
    """Two lines: what was solved by what, and with which outcome."""
    grid = result.problem.grid
    place = _printable(grid.name) or f"{grid.rows} x {grid.cols} cells"
    ending = "" if result.stopped_by is StoppedBy.SCHEDULE else f" (stopped: {result.stopped_by})"
    if result.status is Status.UNREACHABLE:
        outcome = "unreachable: no path leads from start to goal"
    elif result.path is None:
        outcome = f"no ant arrived in {result.iterations} iterations{ending}"
    else:
        metres = f" = {result.length_m:.3f} m" if grid.resolution != 1 else ""
        outcome = f"{result.length:.4f} cells{metres}, gap {100 * result.gap:.2f} %, {result.status}{ending}"
    return f"{_printable(result.algorithm.name)} on {place}, seed {result.seed}\n{outcome}"


def _fine_print(result: Result, width: int) -> str:
    """What must travel with the picture: the certainty of the algorithm, and the result's notes."""
    lines = [f"Certainty: {_printable(result.algorithm.certainty, 300)}"]
    lines += [f"Note: {_printable(note, 300)}" for note in result.notes]
    return "\n".join(textwrap.fill(line, width) for line in lines)


def _printable(text: str, most: int = 60) -> str:
    """Names come from files: one line, of bounded length, without control characters, which SVG forbids."""
    words = " ".join("".join(c if c.isprintable() else " " for c in text).split())
    return words if len(words) <= most else f"{words[: most - 3]}..."


# ------------------------------------------------------------------------------------------------------- drawing


def plot_map(grid: GridMap, ax: Axes | None = None) -> Axes:
    """Draw a map in metres: free cells white, walls dark, inflated cells grey, unknown ones sand-coloured.

    Parameters
    ----------
    grid : GridMap
        A map with a turned origin is drawn upright in its own frame; the axes' labels say so.
    ax : Axes, optional
        Where to draw; default: a new pyplot figure.

    Raises
    ------
    ParameterError
        matplotlib is not installed.
    """
    ax = _axes(ax, _panel(grid))
    _draw_cells(ax, grid, None)
    _legend(ax, _cell_handles(grid))
    if grid.name:
        _set_title(ax, _printable(grid.name))
    return ax


def plot_path(result: Result, ax: Axes | None = None) -> Axes:
    """Draw the map, the pheromone, the path, start, goal and auxiliary cell, with title, legend and fine print.

    Parameters
    ----------
    result : Result
        Without a path: map, start and goal, and the title says why. Where the goal cannot be reached, the cells that
        can be are shaded.
    ax : Axes, optional
        Where to draw; default: a new pyplot figure.

    Raises
    ------
    ParameterError
        matplotlib is not installed.
    """
    ax = _axes(ax, _panel(result.problem.grid))
    handles = _draw_path(ax, result)
    legend = _legend(ax, handles)
    legend.set_title(_fine_print(result, 70))
    legend.get_title().set(fontsize=6.5, color=FAINT, parse_math=False)
    _set_title(ax, _title(result))
    return ax


def plot_convergence(result: Result, ax: Axes | None = None) -> Axes:
    """Draw the lengths by iteration: best so far, best and mean of each iteration, the exact optimum, the gap.

    The scale fits the best lengths; where the mean leaves the picture, the legend states its range. The stages of a
    divided problem are marked, and no line joins them: in stage two the lengths are sums of the two halves.

    Parameters
    ----------
    result : Result
    ax : Axes, optional
        Where to draw; default: a new pyplot figure.

    Raises
    ------
    ParameterError
        matplotlib is not installed.
    """
    ax = _axes(ax, (6.0, 4.6))
    data = convergence(result)
    ax.set_title("Convergence", loc="left", fontsize=9, color=INK)
    ax.set_xlabel("iteration", color=INK)
    ax.set_ylabel("length (cells)", color=INK)
    ax.tick_params(labelsize=8, color=FAINT)
    for side in ("top", "right"):
        ax.spines[side].set_visible(False)
    if not len(data.iteration):
        reason = "no path exists" if result.path is None else "start and goal are one cell"
        _say(ax, f"no ant walked:\n{reason}")
        ax.set(xticks=[], yticks=[])
        return ax
    handles = [*_draw_lengths(ax, data), *_draw_ends(ax, data), *_draw_stages(ax, data)]
    _scale(ax, data)
    if not np.isfinite(data.best).any():
        _say(ax, "no ant arrived" if not np.isfinite(data.iteration_best).any() else "no path was completed")
    _legend(ax, handles)
    return ax


def plot_result(result: Result, ax: Axes | None = None) -> Axes:
    """Draw a result: the path on its map, and the convergence beside it.

    Parameters
    ----------
    result : Result
    ax : Axes, optional
        Given: only the path picture is drawn, there. Default: a new pyplot figure with both panels.

    Returns
    -------
    Axes
        The map's; its ``figure`` holds the rest.

    Raises
    ------
    ParameterError
        matplotlib is not installed.
    """
    if ax is not None:
        return plot_path(result, ax)
    _require_matplotlib()
    from matplotlib import pyplot as plt

    return _draw_figure(plt.figure(), result)


def save_picture(result: Result, path: str | os.PathLike[str]) -> None:
    """Write the picture that `plot_result` draws, whole or not at all.

    Uses neither pyplot nor the user's style: the same result gives the same bytes of SVG or PDF with the same
    matplotlib. For a style of your own take ``plot_result(result).figure.savefig``.

    Parameters
    ----------
    result : Result
    path : path-like
        Ends in .png, .svg or .pdf.

    Raises
    ------
    ParameterError
        Another ending, or matplotlib is not installed.
    OutputError
        The file cannot be written; nothing of it is left behind.
    """
    ending = FilePath(path).suffix.lower().removeprefix(".")
    if ending not in FORMATS:
        raise ParameterError(
            f"file name {FilePath(path).name}", f"pictures end in .{', .'.join(FORMATS)}", "choose one of them"
        )
    write_whole(path, _render(result, ending))


def _render(result: Result, ending: str) -> bytes:
    _require_matplotlib()
    import matplotlib as mpl
    from matplotlib.figure import Figure

    undated = {"svg": {"Date": None}, "pdf": {"CreationDate": None}}
    content = io.BytesIO()
    with _drawing, mpl.rc_context():
        import matplotlib.style

        matplotlib.style.use("default")
        mpl.rcParams.update({"svg.hashsalt": SALT, "pdf.fonttype": 42})  # journals refuse type 3 fonts
        figure = Figure()
        _draw_figure(figure, result)
        figure.savefig(content, format=ending, dpi=DPI, metadata=undated.get(ending), facecolor="white")
    return content.getvalue()


def _require_matplotlib() -> None:
    try:
        import matplotlib  # noqa: F401
    except ImportError as error:
        raise ParameterError("a picture", "matplotlib is not installed", 'pip install "antnav[plot]"') from error


def _axes(ax: Axes | None, size: tuple[float, float]) -> Axes:
    _require_matplotlib()
    if ax is not None:
        return ax
    from matplotlib import pyplot as plt

    return plt.figure(figsize=size, layout="constrained").add_subplot()


def _panel(grid: GridMap) -> tuple[float, float]:
    """Width and height in inches of a map's panel, legend and title included."""
    side = 4.7
    aspect = grid.cols / grid.rows
    width, height = (side * aspect, side) if aspect < 1.6 else (1.6 * side, 1.6 * side / aspect)
    return max(width, 3.4) + 0.8, height + 2.3


def _draw_figure(figure: Figure, result: Result) -> Axes:
    """The whole picture: path left, convergence right, title above, fine print below."""
    width, height = _panel(result.problem.grid)
    right = 4.9
    height = max(height, 5.2)
    figure.set_size_inches(width + right, height)
    figure.set_layout_engine("constrained", w_pad=0.08, h_pad=0.15)
    left_ax: Axes
    left_ax, right_ax = figure.subplots(1, 2, width_ratios=[width, right])
    _legend(left_ax, _draw_path(left_ax, result))
    plot_convergence(result, right_ax)
    style: dict[str, Any] = {"x": 0.012, "ha": "left", "color": INK}
    figure.suptitle(_title(result), fontsize=11, parse_math=False, **style)
    letters = int(17 * (width + right))
    figure.supxlabel(_fine_print(result, letters), fontsize=6.5, parse_math=False, **style | {"color": FAINT})
    return left_ax


def _draw_cells(ax: Axes, grid: GridMap, shades: Heat | None) -> None:
    """The map as one image, the axes in metres; thin lines between the cells of a small map."""
    from matplotlib.ticker import MaxNLocator

    left, right, bottom, top = _extent(grid)
    colours, factor = _reduced(map_colours(grid, shades))
    side = factor * grid.resolution
    # "antialiased" works on colours, not on kinds of cells: sharp where a cell covers pixels, smooth where it does not.
    covered = (left, left + colours.shape[1] * side, top - colours.shape[0] * side, top)
    ax.imshow(colours, extent=covered, interpolation="antialiased", zorder=0)
    if max(grid.shape) <= GRID_SIDE:
        style: dict[str, Any] = {"colors": "#9aa0a6", "linewidths": 0.35, "alpha": 0.55, "zorder": 1}
        ax.vlines(np.linspace(left, right, grid.cols + 1), bottom, top, **style)
        ax.hlines(np.linspace(bottom, top, grid.rows + 1), left, right, **style)
    ax.set(xlim=(left, right), ylim=(bottom, top), aspect="equal")
    frame = "" if grid.origin[2] == 0 else f" in the map's frame, turned by {math.degrees(grid.origin[2]):.4g}°"
    ax.set_xlabel(f"x (m){frame}", color=INK)
    ax.set_ylabel(f"y (m){' in the map frame' if frame else ''}", color=INK)
    for axis in (ax.xaxis, ax.yaxis):
        axis.set_major_locator(MaxNLocator("auto", steps=[1, 2, 5, 10]))
    ax.ticklabel_format(useOffset=False)
    ax.tick_params(labelsize=8, color=FAINT)
    for spine in ax.spines.values():
        spine.set(color=INK, linewidth=0.8)


def _reduced(colours: NDArray[np.uint8]) -> tuple[NDArray[np.uint8], int]:
    """An image, and of a very large one the means of square blocks; with the side of a block in cells."""
    factor = -(-max(colours.shape[:2]) // DRAWN_SIDE)
    if factor == 1:
        return colours, 1
    padding = [(0, -side % factor) for side in colours.shape[:2]]
    padded = np.pad(colours, [*padding, (0, 0)], mode="edge")
    rows, cols = padded.shape[0] // factor, padded.shape[1] // factor
    blocks = padded.reshape(rows, factor, cols, factor, 3)
    return blocks.mean(axis=(1, 3), dtype=np.float32).astype(np.uint8), factor


def _draw_path(ax: Axes, result: Result) -> list[Any]:
    """Everything on the map; returns the handles of the legend."""
    from matplotlib import patheffects

    problem, shades = result.problem, heat(result)
    grid = problem.grid
    _draw_cells(ax, grid, shades)
    cell = 330 / max(grid.shape)  # side of a cell in points
    handles: list[Any] = []
    if result.path is not None:
        width = min(max(0.3 * cell, 1.3), 2.8)
        (line,) = ax.plot(
            *_in_picture(grid, result.path.points).T,
            color=VERMILLION,
            linewidth=width,
            solid_capstyle="round",
            solid_joinstyle="round",
            label="path",
            zorder=3,
            path_effects=[patheffects.Stroke(linewidth=width + 1.6, foreground="white"), patheffects.Normal()],
        )
        if len(result.path) > 1:
            handles.append(line)
    size = min(max(0.6 * cell, 6.5), 9.0)
    # The goal lies below the start and is larger, so that both are seen where they share a cell.
    goal = _mark(ax, grid, problem.goal, "goal", marker="s", color=PURPLE, markersize=1.2 * size)
    start = _mark(ax, grid, problem.start, "start", marker="o", color=GREEN, markersize=0.9 * size)
    handles += [start, goal]
    if result.auxiliary_cell:
        place = grid.cell_to_world(result.auxiliary_cell)
        handles.append(_mark(ax, grid, place, "auxiliary cell", marker="*", color=YELLOW, markersize=1.8 * size))
    return [*handles, *_cell_handles(grid), *([_heat_handle(shades)] if shades else [])]


def _mark(ax: Axes, grid: GridMap, point: ArrayLike, label: str, **look: Any) -> Artist:
    x, y = _in_picture(grid, point)
    look |= {"markeredgecolor": INK, "markeredgewidth": 0.8, "linestyle": "none", "clip_on": False, "zorder": 4}
    return ax.plot([x], [y], label=label, **look)[0]


def _cell_handles(grid: GridMap) -> list[Any]:
    """Legend of the kinds of cells that the map has; free ones need none."""
    from matplotlib.patches import Patch

    labels = {Cell.OCCUPIED: "obstacle", Cell.INFLATED: "inflated", Cell.UNKNOWN: "unknown"}
    counts = grid.counts()
    return [
        Patch(facecolor=_fraction(CELL_COLOURS[kind]), edgecolor=INK, linewidth=0.5, label=label)
        for kind, label in labels.items()
        if counts[kind.name.lower()]
    ]


def _heat_handle(shades: Heat) -> Any:
    """A row of patches from light to dark, or one where there is one shade."""
    from matplotlib.patches import Patch

    steps = np.array([shades.shade.max()] if shades.even else np.linspace(0.1, 1, 6), np.float32)
    colours = _shaded(np.full((len(steps), 3), 255, np.uint8), steps)
    row = tuple(Patch(facecolor=_fraction(colour), linewidth=0) for colour in colours)
    row[0].set_label(shades.label)
    return row


def _fraction(colour: NDArray[np.uint8]) -> tuple[float, float, float]:
    """The same colour with parts in [0, 1]."""
    red, green, blue = (int(part) / 255 for part in colour)
    return red, green, blue


def _draw_lengths(ax: Axes, data: Convergence) -> list[Any]:
    """The three curves, each stage by itself."""
    dots: dict[str, Any] = {"linewidth": 0.6}
    dashes: dict[str, Any] = {"linewidth": 0.6}
    if len(data.iteration) <= 200:  # beyond that marks and dashes run together
        dots = {"marker": ".", "markersize": 4.5, "linestyle": "none"}
        dashes = {"linewidth": 1.2, "linestyle": (0, (4, 1.5))}
    handles: list[Any] = []
    for part in data.stages:
        at = data.iteration[part]
        curves = [
            ax.plot(at, data.mean[part], color=ORANGE, zorder=2, **dashes, **_lonely(data.mean[part]))[0],
            ax.plot(at, data.iteration_best[part], color=BLUE, zorder=3, **dots)[0],
            ax.stairs(
                data.best[part], np.append(at - 0.5, at[-1] + 0.5), baseline=None, color=VERMILLION, lw=2, zorder=4
            ),
        ]
        handles = curves[::-1]
    labels = ["best so far", "best of the iteration", "mean of the arrived ants"]
    if np.isfinite(data.mean).any() and np.nanmax(data.mean) > _top(data):
        labels[2] += f" ({np.nanmin(data.mean):.1f} to {np.nanmax(data.mean):.1f})"
    for handle, label in zip(handles, labels, strict=True):
        handle.set_label(label)
    shown = [np.isfinite(values).any() for values in (data.best, data.iteration_best, data.mean)]
    return [handle for handle, show in zip(handles, shown, strict=True) if show]


def _lonely(values: NDArray[np.float64]) -> dict[str, Any]:
    """Marks for values between two gaps, which a line does not show."""
    gaps = np.isnan(np.pad(values, 1, constant_values=np.nan))
    lonely = np.flatnonzero(gaps[:-2] & ~gaps[1:-1] & gaps[2:])
    return {"marker": ".", "markersize": 3, "markevery": lonely.tolist()} if lonely.size else {}


def _draw_ends(ax: Axes, data: Convergence) -> list[Any]:
    """The optimum as a line, the length of the returned path as a mark on the right."""
    handles: list[Any] = []
    if math.isfinite(data.optimum):
        handles.append(
            ax.axhline(data.optimum, color=INK, lw=1.1, ls=(0, (1, 1.2)), label=f"exact optimum: {data.optimum:.4f}")
        )
    if math.isfinite(data.length):
        handles += ax.plot(
            [data.iteration[-1] + 0.5],
            [data.length],
            marker="D",
            markersize=6.5,
            color=VERMILLION,
            markeredgecolor=INK,
            markeredgewidth=0.8,
            linestyle="none",
            clip_on=False,
            zorder=5,
            label=f"path returned: {data.length:.4f}",
        )
    return handles


def _draw_stages(ax: Axes, data: Convergence) -> list[Any]:
    """The band of stage one, and what the lengths of either stage mean."""
    from matplotlib.patches import Patch

    if not data.stage_one:
        return []
    ax.axvspan(0.5, data.stage_one + 0.5, color="#e3e6ea", linewidth=0, zorder=0)
    bands = [Patch(facecolor="#e3e6ea", edgecolor=INK, linewidth=0.5, label="stage one: better of two colonies")]
    if data.divided:
        ax.axvline(data.stage_one + 0.5, color=FAINT, linewidth=0.8, zorder=1)
        bands.append(Patch(facecolor="white", edgecolor=INK, linewidth=0.5, label="stage two: sum of the two halves"))
    return bands


def _top(data: Convergence) -> float:
    """Upper end of the lengths' scale: all best lengths fit."""
    known = [values[np.isfinite(values)] for values in (data.best, data.iteration_best, np.array([data.length]))]
    low = data.optimum if math.isfinite(data.optimum) else 0.0
    highest = max((float(values.max()) for values in known if values.size), default=1.3 * low)
    return max(highest + 0.08 * (highest - low), 1.02 * low, low + 1e-9)


def _scale(ax: Axes, data: Convergence) -> None:
    """Limits of both axes, and the gap to the optimum on the right."""
    from matplotlib.ticker import MaxNLocator

    ax.set_xlim(0.5, data.iteration[-1] + 0.5)
    ax.xaxis.set_major_locator(MaxNLocator(integer=True))
    low, high = data.optimum, _top(data)
    if not 0 < low < math.inf:
        return  # a file may lack the optimum
    ax.set_ylim(low - 0.06 * (high - low), high)

    def to_percent(length: Any) -> Any:
        return 100 * (length / low - 1)

    def to_length(percent: Any) -> Any:
        return low * (1 + percent / 100)

    gap = ax.secondary_yaxis("right", functions=(to_percent, to_length))
    gap.set_ylabel("gap to the optimum (%)", color=INK)
    gap.tick_params(labelsize=8, color=FAINT)


def _say(ax: Axes, text: str) -> None:
    ax.text(0.5, 0.5, text, transform=ax.transAxes, ha="center", va="center", color=FAINT)


def _legend(ax: Axes, handles: list[Any]) -> Legend:
    """A legend below the axes, where it hides nothing."""
    from matplotlib.legend_handler import HandlerTuple
    from matplotlib.transforms import ScaledTranslation

    labels = [str((handle[0] if isinstance(handle, tuple) else handle).get_label()) for handle in handles]
    below_labels = ax.transAxes + ScaledTranslation(0, -36 / 72, ax.figure.dpi_scale_trans)
    return ax.legend(
        handles,
        labels,
        handler_map={tuple: HandlerTuple(ndivide=None, pad=0)},
        loc="upper center",
        bbox_to_anchor=(0.5, 0),
        bbox_transform=below_labels,
        borderaxespad=0,
        ncols=2 if len(max(labels, key=len, default="")) > 25 else 3,
        frameon=False,
        fontsize=8,
        alignment="left",
        columnspacing=1.4,
    )


def _set_title(ax: Axes, title: str) -> None:
    ax.set_title(title, fontsize=10, color=INK, parse_math=False)
