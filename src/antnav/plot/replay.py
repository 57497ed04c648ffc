"""Replays as a picture (ways driven, plans given up, times of replans beneath), and the files of films."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from antnav.errors import ParameterError
from antnav.files import as_path, write_whole
from antnav.markup import printable
from antnav.plot.data import BLUES, ORANGES, Heat
from antnav.plot.figure import FORMATS, save_drawing
from antnav.plot.film import Drive, Film, Shade, check_replays, corners, film_of
from antnav.plot.gif import gif
from antnav.plot.map import cell_handles, draw_cells, draw_ends, heat_handle, panel_size
from antnav.plot.page import page
from antnav.plot.style import BLUE, FAINT, GREEN, INK, VERMILLION, legend_below, require_matplotlib
from antnav.scenarios.model import Replay
from antnav.world.grid import Cell, GridMap

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

#: Endings of films.
FILMS = ("gif", "html")
#: Milliseconds at which lines are drawn.
LINES = (1, 10, 100)


def plot_replay(replays: Replay | Sequence[Replay]) -> Axes:
    """Draw a replay, or several of one scenario side by side: ways, plans given up, what was blocked, times of replans.

    Parameters
    ----------
    replays : Replay or list of Replay

    Returns
    -------
    Axes
        The first map's, of a new pyplot figure; its ``figure`` holds the rest.

    Raises
    ------
    ParameterError
        matplotlib is not installed; there is no tick; the scenarios differ.
    """
    given = check_replays(replays)
    require_matplotlib()
    from matplotlib import pyplot as plt

    return _draw(plt.figure(), given)


def save_film(replays: Replay | Sequence[Replay], path: str | os.PathLike[str]) -> None:
    """Write a replay, or several of one scenario side by side, as a film or a picture, whole or not at all.

    Parameters
    ----------
    replays : Replay or list of Replay
    path : path-like
        Ends in .html (one page that needs nothing else, to be played and stepped through), .gif, or .png, .svg, .pdf
        for the picture that `plot_replay` draws. Films need no matplotlib.

    Raises
    ------
    ParameterError
        Another ending; matplotlib is not installed; there is no tick; the scenarios differ.
    OutputError
        The file cannot be written; nothing of it is left behind.
    """
    given, name = check_replays(replays), as_path(path).name
    ending = as_path(path).suffix.lower().removeprefix(".")
    if ending not in (*FILMS, *FORMATS):
        rule = f"films end in .{', .'.join(FILMS)}, pictures in .{', .'.join(FORMATS)}"
        raise ParameterError(f"file name {name}", rule, "choose one of them")
    if ending in FORMATS:
        save_drawing(lambda figure: _draw(figure, given), path)
    else:
        write_whole(path, gif(given) if ending == "gif" else page(given).encode())


def _draw(figure: Figure, replays: list[Replay]) -> Axes:
    grid, scenario = replays[0].problem.grid, replays[0].scenario
    film = film_of(replays, max(grid.shape))
    width, height = panel_size(grid, whole=True)
    cols, beneath = min(len(replays), 2), 1.9
    rows = -(-len(replays) // cols)
    figure.set_size_inches(max(width, 4.8) * cols, (height + beneath) * rows)
    figure.set_layout_engine("constrained", w_pad=0.08, h_pad=0.1)
    ratios = [height, beneath] * rows
    panels: NDArray[Any] = figure.subplots(2 * rows, cols, height_ratios=ratios, squeeze=False)
    above: list[Axes] = panels[::2].ravel().tolist()
    below: list[Axes] = panels[1::2].ravel().tolist()
    for empty in (*above[len(replays) :], *below[len(replays) :]):
        empty.remove()
    most = max((tick.seconds for drive in film.drives for tick in drive.ticks if tick.noticed), default=0.0)
    for number, drive in enumerate(film.drives):
        _draw_map(above[number], film, drive)
        _draw_times(below[number], drive, max(300.0, 2e3 * most))
        done = replays[number]
        end = f"arrived after {len(done) - 1} ticks" if done.arrived else f"not arrived in {len(done)} ticks"
        title = f"{printable(drive.name)}: {end}, {done.travelled:.1f} cells driven"
        above[number].set_title(title, fontsize=10, color=INK, parse_math=False)
    place = printable(grid.name) or f"{grid.rows} x {grid.cols} cells"
    title = f"{printable(scenario.name)} on {place}, seed {scenario.seed}"
    figure.suptitle(title, fontsize=11, x=0.012, ha="left", color=INK, parse_math=False)
    return above[0]


def stays(film: Film, shade: Shade, ticks: int) -> Heat | None:
    """For how many of the first ticks each pixel had a shade; None where none had."""
    since, total = np.full(film.shades.shape, -1), np.zeros(film.shades.shape, np.int64)
    for tick, (pixels, shades) in enumerate(film.changes[:ticks]):
        began = since.flat[pixels]
        total.flat[pixels] += np.where(began >= 0, tick - began, 0)
        since.flat[pixels] = np.where(shades == shade, tick, -1)
    total[since >= 0] += ticks - since[since >= 0]
    most = int(total.max())
    if not most:
        return None
    label, palette = ("blocked", BLUES) if shade is Shade.BLOCKED else ("dearer", ORANGES)
    shares = np.where(total > 0, 0.2 + 0.8 * total / most, 0.0).astype(np.float32)
    return Heat(shares, f"{label} for up to {most} ticks", palette=palette)


def _draw_map(ax: Axes, film: Film, drive: Drive) -> None:
    """The map, on it how long what was blocked, or else dearer; free cells that the robot has never seen as unknown."""
    from matplotlib.collections import LineCollection
    from matplotlib.lines import Line2D

    grid, problem, ticks = film.problem.grid, film.problem, len(drive.ticks)
    shades = stays(film, Shade.BLOCKED, ticks) or stays(film, Shade.PRICED, ticks)
    seen = np.zeros(grid.shape, bool)
    for tick in drive.ticks:
        film.look(seen, (tick.row, tick.col))
        if film.scenario.sensor is None:
            break
    if not seen.all():
        unseen = ~seen & (grid.cells == Cell.FREE)
        cells = np.where(unseen, np.uint8(Cell.UNKNOWN), grid.cells)
        grid = GridMap(cells, grid.resolution, grid.origin, grid.name)
    draw_cells(ax, grid, shades, whole=True)
    given_up = [grid.cell_to_world(corners(plan)) for _, plan in drive.plans[:-1] if plan is not None]
    thin: dict[str, Any] = {"color": VERMILLION, "linewidth": 0.7}
    ax.add_collection(LineCollection(given_up, alpha=0.45, zorder=2, **thin))
    (way,) = ax.plot(*grid.cell_to_world(drive.way).T, color=GREEN, linewidth=2.0, label="way driven", zorder=3)
    handles: list[Any] = [way, *draw_ends(ax, problem)]
    handles += [Line2D([], [], label=f"plans given up ({len(given_up)})", **thin)] if given_up else []
    handles += cell_handles(grid, kept_out=problem.cost is not None and bool(problem.cost.blocked.any()))
    handles += [] if shades is None else [heat_handle(shades)]
    legend_below(ax, handles)


def _draw_times(ax: Axes, drive: Drive, most: float) -> None:
    """Milliseconds of each replan as a bar, logarithmic, with lines where a robot's rate would miss it."""
    ticks = [tick for tick in drive.ticks if tick.noticed]
    ax.set_yscale("log")
    ax.set(xlim=(-0.5, len(drive.ticks) - 0.5), ylim=(0.01, most))
    width = max(0.4, min(250 / len(drive.ticks), 4.0))
    numbers, heights = [tick.tick for tick in ticks], [1e3 * tick.seconds for tick in ticks]
    ax.vlines(numbers, 0.01, heights, color=BLUE, linewidth=width, zorder=2)
    for line in LINES:
        ax.axhline(line, color=FAINT, linewidth=0.7, linestyle="--", zorder=3)
    ax.set_yticks([0.1, *LINES], ["0.1", *map(str, LINES)])
    ax.minorticks_off()
    ax.set_ylabel("replan, CPU ms", color=INK)
    ax.set_xlabel("tick", color=INK)
    ax.tick_params(labelsize=8, color=FAINT)
