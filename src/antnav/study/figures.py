"""Figures of a study, drawn on given axes: `series` gathers what they show, `drawings` puts them into reports.

Every algorithm keeps one look (colour, line style, marker) in all figures; the looks differ in grey print too.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from antnav.markup import printable
from antnav.plot.map import plot_map
from antnav.plot.style import (
    FAINT,
    INK,
    YELLOW,
    legend_below,
)
from antnav.report import statistics
from antnav.report.pictures import Looks, looks, new_figure
from antnav.study import series
from antnav.study.groups import optimum_of
from antnav.study.paper import SWAPPED
from antnav.study.record import Record
from antnav.world.grid import GridMap
from antnav.world.problem import CellIndex, Problem

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def _shown_looks(group: Mapping[str, Sequence[Record]], names: Sequence[str]) -> Looks:
    """The group's looks, so that an algorithm keeps its own in all figures; in a crowd, those of the ones shown."""
    return looks(list(group) if len(group) <= series.MOST_CURVES else names, (SWAPPED,))


def _panel(ax: Axes | None, width: float = 6.0, height: float = 4.4) -> Axes:
    return new_figure(width, height).add_subplot() if ax is None else ax


def _dress(ax: Axes, title: str, x: str, y: str) -> None:
    ax.set_title(printable(title), fontsize=10, color=INK, parse_math=False)
    ax.set_xlabel(x, color=INK)
    ax.set_ylabel(y, color=INK)
    ax.tick_params(labelsize=8, color=FAINT)
    for side in ("top", "right"):
        ax.spines[side].set_visible(False)


def draw_bands(
    ax: Axes | None,
    bands: Mapping[str, series.Band],
    look: Looks,
    words: Mapping[str, str] = MappingProxyType({}),
    *,
    markers: bool = True,
) -> Axes:
    """Mean lines with their bands; a band whose upper quartile is infinite is open at the top.

    `words` names algorithms otherwise than their labels do.
    """
    ax = _panel(ax)
    values = np.concatenate(
        [np.empty(0), *(part for data in bands.values() for part in (data.mean, data.low, data.high))]
    )
    top = 1.05 * float(values[np.isfinite(values)].max(initial=1.0))
    for place, (name, data) in enumerate(bands.items()):
        style = dict(look[name]) | {"markersize": 4.5, "linewidth": 1.7, "zorder": 3}
        every = max(1, len(data.iteration) // 9)
        start = (place * every) // max(1, len(bands))  # markers of lines that coincide stand side by side
        style |= {"markevery": (start, every)} if markers else {"marker": ""}
        ax.plot(data.iteration, data.mean, label=printable(words.get(name, name)) + _absence(data), **style)
        high = np.minimum(data.high, top)
        ax.fill_between(
            data.iteration,
            data.low,
            high,
            where=np.isfinite(data.low),
            color=style["color"],
            alpha=0.16,
            linewidth=0,
            zorder=2,
        )
    if any(np.isinf(data.high).any() and np.isfinite(data.low).any() for data in bands.values()):
        ax.set_ylim(top=top)
    return ax


def _legend(ax: Axes, handles: list[Any]) -> None:
    """A legend below; labels come from users, and a dollar sign in one is no formula."""
    for text in legend_below(ax, handles).get_texts():
        text.set_parse_math(False)


def _absence(data: series.Band) -> str:
    if np.isfinite(data.mean).any():
        return ""
    return ": path in less than half of the runs" if data.arrived else ": no path in any run"


def draw_convergence(
    ax: Axes | None,
    group: Mapping[str, Sequence[Record]],
    names: Sequence[str],
    title: str,
    words: Mapping[str, str] = MappingProxyType({}),
) -> Axes:
    """Best length by iteration of some algorithms on one map; the optimum as a line."""
    ax = _panel(ax)
    bands = series.best_bands(group, names)
    draw_bands(ax, bands, _shown_looks(group, names), words)
    _dress(ax, title, "iteration", "best length so far (cells)")
    handles = list(ax.get_lines())
    optimum = min((optimum_of(group[name]) for name in bands), default=math.inf)
    if math.isfinite(optimum):
        line = ax.axhline(optimum, color=INK, linewidth=1.0, linestyle=(0, (1, 1.6)), zorder=1)
        line.set_label(f"optimum: {optimum:.4f}")
        handles.append(line)
    _fit(ax, bands, optimum)
    if handles:
        _legend(ax, handles)
    return ax


def _fit(ax: Axes, bands: Mapping[str, series.Band], optimum: float) -> None:
    """Logarithmic where one algorithm would press the others flat."""
    from matplotlib.ticker import LogLocator, MaxNLocator, NullFormatter, ScalarFormatter

    ax.xaxis.set_major_locator(MaxNLocator(integer=True, steps=[1, 2, 5, 10]))
    last = [data.mean[-1] for data in bands.values() if len(data.mean) and np.isfinite(data.mean[-1])]
    tops = [float(data.mean[np.isfinite(data.mean)].max()) for data in bands.values() if np.isfinite(data.mean).any()]
    if not tops or not math.isfinite(optimum) or not optimum > 0:
        return
    if max(tops) > 2 * min([optimum, *last]):
        ax.set_yscale("log")
        ax.set_ylabel(f"{ax.get_ylabel()}, logarithmic")
        ax.yaxis.set_major_locator(LogLocator(subs=(1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0)))
        ax.yaxis.set_major_formatter(ScalarFormatter())
        ax.yaxis.set_minor_formatter(NullFormatter())
    ax.set_ylim(bottom=0.97 * optimum)


def draw_lost(
    ax: Axes | None,
    group: Mapping[str, Sequence[Record]],
    names: Sequence[str],
    title: str,
    words: Mapping[str, str] = MappingProxyType({}),
) -> Axes:
    """Lost ants by iteration of some algorithms on one map."""
    from matplotlib.ticker import MaxNLocator

    ax = _panel(ax)
    draw_bands(ax, series.lost_bands(group, names), _shown_looks(group, names), words)
    _dress(ax, title, "iteration", "lost ants")
    ax.xaxis.set_major_locator(MaxNLocator(integer=True, steps=[1, 2, 5, 10]))
    ax.set_ylim(bottom=0)
    if ax.get_lines():
        _legend(ax, list(ax.get_lines()))
    return ax


def draw_paths(
    ax: Axes | None, problem: Problem, group: Mapping[str, Sequence[Record]], names: Sequence[str], title: str
) -> Axes:
    """Best paths of some algorithms on one map, side by side where they share cells; auxiliary cells as stars."""
    from matplotlib import patheffects

    grid = problem.grid
    ax = plot_map(grid, _panel(ax, 6.0, 6.6))
    old = ax.get_legend()
    kinds = list(old.legend_handles) if old else []
    look, handles = _shown_looks(group, names), []
    shown = [name for name in names if name in group]
    for place, name in enumerate(shown):
        run = series.best_run(group[name])
        if run is None or run.path is None:
            handles += ax.plot([], [], linestyle="none", label=f"{printable(name)}: no path")
            continue
        shift = (place - (len(shown) - 1) / 2) * 0.8 / max(len(shown), 3) * grid.resolution
        points = series.beside(grid.cell_to_world(np.array(run.path)), shift)
        handles += ax.plot(
            *points.T,
            **look[name],
            linewidth=1.5,
            markersize=3.4,
            markevery=(2 + place, max(4, len(points) // 7)),
            zorder=3 + 0.1 * place,
            label=f"{printable(name)}: {run.cost:.4f}",
            path_effects=[patheffects.Stroke(linewidth=2.6, foreground="white"), patheffects.Normal()],
        )
    handles += _draw_ends(ax, grid, problem, [cell for name in shown for cell in _stars(group[name])])
    bounds = series.shown_part(problem, [run.path for name in shown for run in group[name] if run.path])
    if bounds:
        (bottom, left), (top, right) = bounds
        rows, cols = (bottom + 0.5, top - 0.5), (left - 0.5, right + 0.5)
        corners = grid.cell_to_world([(row, col) for row in rows for col in cols])
        ax.set(xlim=(corners[:, 0].min(), corners[:, 0].max()), ylim=(corners[:, 1].min(), corners[:, 1].max()))
    _legend(ax, [*handles, *kinds])
    ax.set_title(printable(title), fontsize=10, color=INK, parse_math=False)
    return ax


def _stars(runs: Sequence[Record]) -> list[CellIndex]:
    run = series.best_run(runs)
    return [run.auxiliary_cell] if run and run.auxiliary_cell else []


def _draw_ends(ax: Axes, grid: GridMap, problem: Problem, stars: Sequence[CellIndex]) -> list[Any]:
    """Start, goal and auxiliary cells as marks."""
    from matplotlib import patheffects

    rim = [patheffects.Stroke(linewidth=3.5, foreground="white"), patheffects.Normal()]
    style: dict[str, Any] = {"linestyle": "none", "markeredgecolor": INK, "markeredgewidth": 1.2, "zorder": 6}
    style |= {"path_effects": rim, "clip_on": False}
    cells: list[tuple[str, list[CellIndex], dict[str, Any]]] = [
        ("start", [problem.start_cell], {"marker": "o", "color": "white", "markersize": 8}),
        ("goal", [problem.goal_cell], {"marker": "s", "color": "white", "markersize": 8}),
        ("auxiliary cell", list(dict.fromkeys(stars)), {"marker": "*", "color": YELLOW, "markersize": 14}),
    ]
    return [
        ax.plot(*grid.cell_to_world(np.array(places)).T, label=label, **style | mark)[0]
        for label, places, mark in cells
        if places
    ]


def draw_gaps(ax: Axes | None, group: Mapping[str, Sequence[Record]], title: str) -> Axes:
    """Gaps of all runs on one map: a box (quartiles, whiskers to 1.5 of their range) and every run as a dot."""
    ax = _panel(ax, 6.0, 0.5 * len(group) + 1.8)
    look = looks(list(group), (SWAPPED,))
    for place, (name, runs) in enumerate(group.items()):
        gaps = np.array([100 * run.gap for run in runs if run.gap is not None])
        if len(gaps):
            ax.boxplot(
                gaps,
                positions=[place],
                orientation="horizontal",
                widths=0.62,
                showfliers=False,
                medianprops={"color": INK, "linewidth": 1.6},
                boxprops={"color": FAINT},
                whiskerprops={"color": FAINT},
                capprops={"color": FAINT},
            )
            rise = np.linspace(-0.22, 0.22, len(gaps)) if len(gaps) > 1 else np.zeros(1)
            ax.plot(
                gaps,
                place + rise,
                color=look[name]["color"],
                marker=look[name]["marker"],
                linestyle="none",
                markersize=4,
                alpha=0.75,
                clip_on=False,
            )
    _dress(ax, title, "gap to the optimum (%)", "")
    # Linear up to 1 %, logarithmic beyond: one poor algorithm does not press the others flat.
    highest = max((run.gap for runs in group.values() for run in runs if run.gap is not None), default=0.0)
    if highest > 0.2:
        from matplotlib.ticker import ScalarFormatter

        ax.set_xscale("symlog", linthresh=1, linscale=0.5)
        ax.set_xlabel(f"{ax.get_xlabel()}, logarithmic above 1")
        ax.set_xticks([tick for tick in (0, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000) if tick <= 150 * highest])
        ax.xaxis.set_major_formatter(ScalarFormatter())
        ax.minorticks_off()
    ax.set_xlim(left=0, right=None if highest else 1)
    ax.set_yticks(range(len(group)), [_named(name, runs) for name, runs in group.items()], parse_math=False)
    ax.set_ylim(len(group) - 0.5, -0.5)
    return ax


def _named(name: str, runs: Sequence[Record]) -> str:
    missing = sum(run.gap is None for run in runs)
    return printable(name, 40) + (f"\n({missing} of {len(runs)}: no path)" if missing else "")


def draw_ranks(ax: Axes | None, found: statistics.Ranks, order: Sequence[str]) -> Axes:
    """Critical-difference diagram (Demsar 2006), a line for each algorithm, so that equal ranks hide nobody.

    Bars at the right join the algorithms that Nemenyi's test cannot tell apart. `order` is that of the algorithms in
    the other figures, for their looks.
    """
    names = list(found.mean_ranks)
    ax = _panel(ax, *ranks_size(found))
    look = looks(order, (SWAPPED,))
    for row, (name, rank) in enumerate(found.mean_ranks.items()):
        ax.plot([1, rank], [row, row], color=FAINT, linewidth=0.6, zorder=1)
        ax.plot(rank, row, color=look[name]["color"], marker=look[name]["marker"], markersize=6, zorder=3)
    bars, step = statistics.alike(found), BAR_STEP * (len(names) - 1)
    for place, (first, last) in enumerate(bars):
        column = len(names) + step * (place + 1)
        ax.plot([column, column], [first - 0.25, last + 0.25], color=INK, linewidth=3, solid_capstyle="butt")
    _dress(ax, "", "mean rank, 1 the best", "")
    ax.set_title(
        f"Mean ranks over {found.blocks} blocks; critical difference {found.critical_difference:.2f}",
        fontsize=10,
        color=INK,
    )
    words = [f"{printable(name, 40)} ({rank:.2f})" for name, rank in found.mean_ranks.items()]
    ax.set_yticks(range(len(names)), words, parse_math=False)
    ax.set_ylim(len(names) - 0.4, -0.6)
    ax.set_xlim(1, len(names) + step * (len(bars) + 1))
    ax.set_xticks(range(1, len(names) + 1, max(1, len(names) // 12)))
    return ax


BAR_STEP = 0.03  #: Between two bars of a critical-difference diagram, in parts of the axis of ranks.


def ranks_size(found: statistics.Ranks) -> tuple[float, float]:
    """Inches of a critical-difference diagram."""
    return 7.0, 0.27 * len(found.mean_ranks) + 1.2


def draw_sweep(ax: Axes | None, data: series.SweepGrid, x: str, y: str | None, title: str = "") -> Axes:
    """Heat map of the mean gap over two parameters, each cell with its figure; see `sweep_grid`."""
    ax = _panel(ax, *sweep_size(data))
    highest = float(np.nanmax(data.gap)) if np.isfinite(data.gap).any() else 0.0
    image = ax.imshow(
        np.ma.masked_invalid(data.gap), cmap="cividis_r", origin="lower", aspect="auto", vmin=0, vmax=highest or 1
    )
    for (row, col), gap in np.ndenumerate(data.gap):
        lines = [f"{gap:.2f}"] if math.isfinite(gap) else []
        if data.missing[row, col] > 0:
            lines.append(f"{100 * data.missing[row, col]:.0f} % fail")
        dark = math.isfinite(gap) and gap > 0.55 * highest > 0
        ax.text(col, row, "\n".join(lines), ha="center", va="center", fontsize=8, color="white" if dark else INK)
    _dress(ax, title, x, y or "")
    ax.set_xticks(range(len(data.xs)), [f"{value:g}" for value in data.xs])
    ax.set_yticks(range(len(data.ys)), [f"{value:g}" for value in data.ys] if y else [""])
    if highest:  # else one shade needs no scale
        ax.figure.colorbar(image, ax=ax, label="mean gap (%)")
    return ax


def sweep_size(data: series.SweepGrid) -> tuple[float, float]:
    """Inches of a heat map."""
    return 0.75 * len(data.xs) + 2.6, 0.5 * len(data.ys) + 1.6
