"""A front as a picture: paths on the map, values beside it, in the same colours."""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from antnav.fronts.front import Front
from antnav.markup import printable
from antnav.plot.map import cell_handles, draw_cells, mark, panel_size
from antnav.plot.style import FAINT, GREEN, INK, PURPLE, legend_below

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

#: Numbers that are written beside paths and values: those of a larger front would hide each other.
NUMBERED = 12
#: Points of a path that are looked at for its number.
SAMPLES = 60
#: Colours of the first and the last path lie here on the scale of viridis: its yellow end is too light on white.
DARKEST, LIGHTEST = 0.0, 0.88


def draw_front(figure: Figure, front: Front) -> Axes:
    """The whole picture: map left, values right, title above, fine print below. Returns the map's axes."""
    width, height = panel_size(front.problem.grid, whole=front.problem.allow_unknown)
    right = 4.9
    height = max(height, 5.2)
    figure.set_size_inches(width + right, height)
    figure.set_layout_engine("constrained", w_pad=0.08, h_pad=0.15)
    left_ax: Axes
    left_ax, right_ax = figure.subplots(1, 2, width_ratios=[width, right])
    colours, numbers = _colours(len(front)), _numbered(front)
    _draw_paths(left_ax, front, colours, numbers)
    draw = _draw_plane if len(front.objectives) == 2 else _draw_parallel
    if len(front):
        draw(right_ax, front, colours, numbers)
    style: dict[str, Any] = {"x": 0.012, "ha": "left", "color": INK}
    figure.suptitle(_title(front), fontsize=11, parse_math=False, **style)
    lines = [f"Certainty: {front.certainty}", *(f"Note: {note}" for note in front.notes)]
    print_ = "\n".join(textwrap.fill(printable(line, 300), int(17 * (width + right))) for line in lines)
    figure.supxlabel(print_, fontsize=6.5, parse_math=False, **style | {"color": FAINT})
    return left_ax


def _title(front: Front) -> str:
    grid = front.problem.grid
    place = printable(grid.name) or f"{grid.rows} x {grid.cols} cells"
    names = ", ".join(objective.name for objective in front.objectives)
    whole = "the whole front" if front.complete else "not known to be the whole front"
    outcome = f"{len(front)} paths that none beats, {whole}" if len(front) else f"{front.status}: no path"
    return printable(f"{names} on {place}, {front.method['name']}, seed {front.seed}", 200) + f"\n{outcome}"


def _colours(count: int) -> NDArray[np.float64]:
    import matplotlib as mpl

    shades: NDArray[np.float64] = mpl.colormaps["viridis"](np.linspace(DARKEST, LIGHTEST, max(count, 1)))
    return shades


def _numbered(front: Front) -> list[int]:
    """Which paths get their number written: all of a small front, else some spread evenly, and the knee."""
    count = len(front)
    if count <= NUMBERED:
        return list(range(count))
    return sorted({*np.linspace(0, count - 1, NUMBERED).astype(int).tolist(), front.knee()})


def _draw_paths(ax: Axes, front: Front, colours: NDArray[np.float64], numbers: list[int]) -> None:
    problem = front.problem
    grid = problem.grid
    draw_cells(ax, grid, whole=problem.allow_unknown)
    cell = 330 / max(grid.shape)  # side of a cell in points
    width = min(max(0.25 * cell, 0.9), 2.2)
    for path, colour in zip(front.paths, colours, strict=False):
        ax.plot(*path.points.T, color=colour, linewidth=width, solid_capstyle="round", zorder=3)
    for number, at in zip(numbers, _places([front.paths[number].points for number in numbers]), strict=True):
        _write_number(ax, number, at, colours[number])
    size = min(max(0.6 * cell, 6.5), 9.0)
    goal = mark(ax, problem.goal, "goal", marker="s", color=PURPLE, markersize=1.2 * size)
    start = mark(ax, problem.start, "start", marker="o", color=GREEN, markersize=0.9 * size)
    kept_out = problem.cost is not None and bool(problem.cost.blocked.any())
    legend_below(ax, [start, goal, *cell_handles(grid, kept_out=kept_out)])


def _places(lines: list[NDArray[np.float64]]) -> list[NDArray[np.float64]]:
    """A point of each line for its number: far from the other lines, from the ends, and from numbers so far."""
    samples = [line[np.linspace(0, len(line) - 1, SAMPLES).astype(int)] for line in lines]
    ends = [samples[0][0], samples[0][-1]] if samples else []
    taken: list[NDArray[np.float64]] = []
    for i, line in enumerate(samples):
        others = np.concatenate([other for j, other in enumerate(samples) if j != i] or [np.array(ends)])
        apart = np.hypot(*(line[:, None] - others).T).min(axis=0)
        free = np.hypot(*(line[:, None] - np.array([*ends, *taken])).T).min(axis=0)
        taken.append(line[np.argmax(apart + 0.3 * free)])
    return taken


def _write_number(ax: Axes, number: int, at: Any, colour: Any) -> None:
    from matplotlib import patheffects

    ax.annotate(
        str(number),
        at,
        xytext=(3, 3),
        textcoords="offset points",
        fontsize=8,
        color=colour,
        zorder=5,
        path_effects=[patheffects.withStroke(linewidth=2, foreground="white")],
    )


def _draw_plane(ax: Axes, front: Front, colours: NDArray[np.float64], numbers: list[int]) -> None:
    """Two objectives: one against the other."""
    first, second = front.values.T
    ax.plot(first, second, color=FAINT, linewidth=0.6, drawstyle="steps-post", zorder=1)
    ax.scatter(first, second, c=colours, s=22, zorder=2)
    knee = front.knee()
    ax.scatter(first[[knee]], second[[knee]], s=80, facecolors="none", edgecolors=INK, zorder=3, label="knee")
    for number in numbers:
        _write_number(ax, number, front.values[number], colours[number])
    ax.set_xlabel(front.objectives[0].label, parse_math=False)
    ax.set_ylabel(front.objectives[1].label, parse_math=False)
    ax.grid(color="#e3e6e9", linewidth=0.6)
    ax.set_axisbelow(True)
    ax.legend(frameon=False, fontsize=8)


def _draw_parallel(ax: Axes, front: Front, colours: NDArray[np.float64], numbers: list[int]) -> None:
    """Three and more: an axis each side by side, a line a path, between the least and the largest value."""
    places = list(range(len(front.objectives)))
    scaled = front.normalised
    for row, colour in zip(scaled, colours, strict=True):
        ax.plot(places, row, color=colour, linewidth=0.9, zorder=2)
    knee = front.knee()
    ax.plot(places, scaled[knee], color=INK, linewidth=1.8, linestyle="--", zorder=3, label=f"knee, path {knee}")
    for number in numbers:
        _write_number(ax, number, (places[-1], scaled[number, -1]), colours[number])
    labels = [
        f"{objective.label}\n{low:.4g} to {high:.4g}"
        for objective, low, high in zip(front.objectives, front.ideal, front.nadir, strict=True)
    ]
    ax.set_xticks(places, labels, fontsize=8, parse_math=False)
    ax.set_yticks([0, 1], ["least", "largest"], fontsize=8)
    for place in places:
        ax.axvline(place, color="#c8ccd1", linewidth=0.8, zorder=1)
    ax.set_xlim(-0.15, places[-1] + 0.25)
    ax.legend(frameon=False, fontsize=8, loc="lower right", bbox_to_anchor=(1, 1), borderaxespad=0)
