"""The map as a picture, and the path on it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from antnav.errors import check_type
from antnav.markup import printable
from antnav.planner.result import Result
from antnav.plot.data import CELL_COLOURS, Heat, costs, heat, known_corners, map_colours, shaded
from antnav.plot.style import (
    FAINT,
    GREEN,
    INK,
    PURPLE,
    SKY,
    VERMILLION,
    YELLOW,
    axes_for,
    fine_print,
    legend_below,
    title_of,
)
from antnav.trajectories.model import Trajectory
from antnav.world.grid import Cell, GridMap
from antnav.world.problem import Problem

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

GRID_SIDE = 60  #: Longer side in cells up to which lines between the cells are drawn.
OUTSIDE = "#e4e7ea"  #: Around a turned map.
MOST_ROBOTS = 60  #: Outlines of a robot on its trajectory.
DRAWN_SIDE = 4096  #: Longer side in cells up to which each cell is drawn; of larger maps, means of blocks.


def plot_map(grid: GridMap, ax: Axes | None = None) -> Axes:
    """Draw a map in metres: free cells white, walls dark, inflated cells grey, unknown ones sand-coloured.

    Parameters
    ----------
    grid : GridMap
        A map with a turned origin is drawn turned, so that the axes are the world's.
    ax : Axes, optional
        Where to draw; default: a new pyplot figure.

    Raises
    ------
    ParameterError
        matplotlib is not installed.
    """
    check_type("grid", grid, GridMap, "load one with load_map")
    ax = axes_for(ax, panel_size(grid))
    draw_cells(ax, grid, None)
    legend_below(ax, cell_handles(grid))
    if grid.name:
        _set_title(ax, printable(grid.name))
    return ax


def plot_path(result: Result, ax: Axes | None = None, *, trajectory: Trajectory | None = None) -> Axes:
    """Draw the map, the pheromone, the path, start, goal and auxiliary cell, with title, legend and fine print.

    Parameters
    ----------
    result : Result
        Without a path: map, start and goal, and the title says why. Where the goal cannot be reached, the cells that
        can be are shaded.
    ax : Axes, optional
        Where to draw; default: a new pyplot figure.
    trajectory : Trajectory, optional
        Drawn over the path.

    Raises
    ------
    ParameterError
        matplotlib is not installed.
    """
    check_type("result", result, Result, "solve a problem first")
    check_type("trajectory", trajectory, Trajectory | None, "make one with result.trajectory")
    ax = axes_for(ax, panel_size(result.problem.grid, whole=result.problem.allow_unknown))
    legend = legend_below(ax, draw_path(ax, result, trajectory))
    legend.set_title(fine_print(result, 70))
    legend.get_title().set(fontsize=6.5, color=FAINT, parse_math=False)
    _set_title(ax, title_of(result))
    return ax


def _set_title(ax: Axes, title: str) -> None:
    ax.set_title(title, fontsize=10, color=INK, parse_math=False)


def panel_size(grid: GridMap, *, whole: bool = False) -> tuple[float, float]:
    """Width and height in inches of a map's panel, legend and title included; see `draw_cells`."""
    side = 4.7
    across, up = np.ptp(grid.corners() if whole else known_corners(grid), axis=0)
    aspect = across / up
    width, height = (side * aspect, side) if aspect < 1.6 else (1.6 * side, 1.6 * side / aspect)
    return max(width, 3.4) + 0.8, height + 2.3


def draw_cells(ax: Axes, grid: GridMap, shades: Heat | None = None, *, whole: bool = False) -> None:
    """The map as one image, the axes in metres of the world; thin lines between the cells of a small map.

    Wide borders of unknown cells are cropped, unless the whole map is asked for.
    """
    from matplotlib.patches import Rectangle
    from matplotlib.ticker import MaxNLocator
    from matplotlib.transforms import Affine2D

    x, y, yaw = grid.origin
    left, bottom, frame = x, y, ax.transData
    if yaw:
        left, bottom, frame = 0.0, 0.0, Affine2D().rotate(yaw).translate(x, y) + ax.transData
    right, top = left + grid.cols * grid.resolution, bottom + grid.rows * grid.resolution
    colours, factor = _reduced(map_colours(grid, shades))
    side = factor * grid.resolution
    # "antialiased" works on colours, not on kinds of cells: sharp where a cell covers pixels, smooth where it does not.
    covered = (left, left + colours.shape[1] * side, top - colours.shape[0] * side, top)
    image = ax.imshow(colours, extent=covered, interpolation="antialiased", zorder=0, transform=frame)
    if yaw:
        rim = Rectangle((0, 0), right, top, fill=False, edgecolor=INK, linewidth=0.8, transform=frame, zorder=1)
        image.set_clip_path(ax.add_patch(rim))
        ax.set_facecolor(OUTSIDE)
    if max(grid.shape) <= GRID_SIDE:
        style: dict[str, Any] = {"colors": "#9aa0a6", "linewidths": 0.35, "alpha": 0.55, "zorder": 1}
        style["transform"] = frame
        ax.vlines(np.linspace(left, right, grid.cols + 1), bottom, top, **style)
        ax.hlines(np.linspace(bottom, top, grid.rows + 1), left, right, **style)
    corners = grid.corners() if whole else known_corners(grid)
    low, high = corners.min(axis=0), corners.max(axis=0)
    ax.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal")
    ax.set_xlabel("x (m)", color=INK)
    ax.set_ylabel("y (m)", color=INK)
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


def draw_path(ax: Axes, result: Result, trajectory: Trajectory | None = None) -> list[Any]:
    """Everything on the map; returns the handles of the legend."""
    from matplotlib import patheffects

    problem = result.problem
    shades = costs(problem) or heat(result)  # two layers would hide each other
    grid = problem.grid
    draw_cells(ax, grid, shades, whole=problem.allow_unknown)
    cell = 330 / max(grid.shape)  # side of a cell in points
    handles: list[Any] = []
    if result.path is not None:
        width = min(max(0.3 * cell, 1.3), 2.8)
        (line,) = ax.plot(
            *result.path.points.T,
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
    if trajectory is not None:
        label = "trajectory" if trajectory.smooth else "trajectory with corners"
        handles += ax.plot(*trajectory.points.T, color=INK, linewidth=1.0, label=label, zorder=3.5)
        handles += _draw_robot(ax, trajectory)
    size = mark_size(grid)
    handles += draw_ends(ax, problem)
    cells = result.crossing_cells
    label = "auxiliary cell" if len(cells) == 1 else "crossing cells"
    marks = [
        mark(ax, grid.cell_to_world(cell), label, marker="*", color=YELLOW, markersize=1.8 * size) for cell in cells
    ]
    handles += marks[:1]
    handles += cell_handles(grid, kept_out=problem.cost is not None and bool(problem.cost.blocked.any()))
    if shades is not None:
        handles.append(heat_handle(shades))
    return handles


def _draw_robot(ax: Axes, trajectory: Trajectory) -> list[Any]:
    """The robot's outline, with a line to where it heads, at some poses: two diameters apart, or more."""
    from matplotlib.collections import LineCollection, PatchCollection
    from matplotlib.colors import to_rgba
    from matplotlib.patches import Circle, Patch, Polygon

    outline = trajectory.footprint
    reach = outline.circumscribed if outline else trajectory.radius
    if not reach:
        return []
    gap = max(4 * reach, trajectory.length / MOST_ROBOTS)
    places = np.linspace(0, trajectory.length, max(int(trajectory.length / gap), 1) + 1)
    poses = trajectory.poses[np.minimum(np.searchsorted(trajectory.arc_length, places), len(trajectory) - 1)]
    ahead = np.column_stack((np.cos(poses[:, 2]), np.sin(poses[:, 2])))
    bodies: list[Patch] = [Circle((x, y), reach) for x, y in poses[:, :2].tolist()]
    if outline:
        aside = ahead[:, ::-1] * (-1, 1)
        turned = np.einsum("ci,kij->kcj", outline.corners, np.stack((ahead, aside), axis=1))
        bodies = [Polygon(corners) for corners in turned + poses[:, None, :2]]
    look: dict[str, Any] = {"facecolor": to_rgba(SKY, 0.25), "edgecolor": SKY, "linewidth": 0.7}
    ax.add_collection(PatchCollection(bodies, zorder=3.4, **look))
    noses = np.stack((poses[:, :2], poses[:, :2] + reach * ahead), axis=1)
    ax.add_collection(LineCollection([*noses], colors=SKY, linewidths=0.7, zorder=3.4))
    return [Patch(label="robot", **look)]


def mark_size(grid: GridMap) -> float:
    """Size in points of a mark on a map."""
    return min(max(0.6 * 330 / max(grid.shape), 6.5), 9.0)


def draw_ends(ax: Axes, problem: Problem) -> list[Artist]:
    """Marks of start and goal: this one lies below and is larger, so that both are seen where they share a cell."""
    size = mark_size(problem.grid)
    goal = mark(ax, problem.goal, "goal", marker="s", color=PURPLE, markersize=1.2 * size)
    start = mark(ax, problem.start, "start", marker="o", color=GREEN, markersize=0.9 * size)
    return [start, goal]


def mark(ax: Axes, point: ArrayLike, label: str, **look: Any) -> Artist:
    """A marker at a point in metres; returns its handle for the legend."""
    x, y = np.asarray(point)
    look |= {"markeredgecolor": INK, "markeredgewidth": 0.8, "linestyle": "none", "clip_on": False, "zorder": 4}
    return ax.plot([x], [y], label=label, **look)[0]


def cell_handles(grid: GridMap, *, kept_out: bool = False) -> list[Any]:
    """Legend of the kinds of cells that the map has; free ones need none."""
    from matplotlib.patches import Patch

    closed = "inflated or kept out" if kept_out else "inflated"
    labels = {Cell.OCCUPIED: "obstacle", Cell.INFLATED: closed, Cell.UNKNOWN: "unknown"}
    counts = grid.counts()
    return [
        Patch(facecolor=_hex(CELL_COLOURS[kind]), edgecolor=INK, linewidth=0.5, label=label)
        for kind, label in labels.items()
        if counts[kind.name.lower()]
    ]


def heat_handle(shades: Heat) -> Any:
    """A row of patches from light to dark, or one where there is one shade."""
    from matplotlib.patches import Patch

    steps = np.array([shades.shade.max()] if shades.even else np.linspace(0.1, 1, 6), np.float32)
    colours = shaded(np.full((len(steps), 3), 255, np.uint8), steps, shades.palette)
    row = tuple(Patch(facecolor=_hex(colour), linewidth=0) for colour in colours)
    row[0].set_label(shades.label)
    return row


def _hex(colour: NDArray[np.uint8]) -> str:
    """The colour as '#rrggbb'."""
    return f"#{colour.tobytes().hex()}"
