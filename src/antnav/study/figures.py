"""Figures of a study: what they show is gathered first, then drawn.

Every algorithm keeps one look (colour, line style, marker) in all figures; the looks differ in grey print too.
"""

from __future__ import annotations

import io
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations, product
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from antnav.plot.figure import DPI, DRAWING, SALT
from antnav.plot.map import plot_map
from antnav.plot.style import (
    BLUE,
    FAINT,
    GREEN,
    INK,
    ORANGE,
    PURPLE,
    VERMILLION,
    YELLOW,
    legend_below,
    printable,
    require_matplotlib,
)
from antnav.problem import CellIndex, Problem
from antnav.study import statistics, tables
from antnav.study.config import Sweep
from antnav.study.record import Record

if TYPE_CHECKING:
    from matplotlib.axes import Axes
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
_FIXED = {name: _LOOKS[i] for i, name in enumerate(("paco", "npaco", "dai", "traditional", "luo"))}
FOUR = ("paco", "npaco", "dai", "traditional")  #: Of the paper's Figures 7-9.
TWO = ("npaco", "luo")  #: Of its Figures 5 and 6: its own two rules, and Luo's.
LONGEST_NAME = 60  #: Letters of a label in a file name.
MOST_CURVES = 7  #: More in one panel cannot be told apart: the best of them are shown.


def looks(names: Sequence[str]) -> Looks:
    """A look for each algorithm; the first seven differ."""
    free = [look for look in _LOOKS if look not in [_FIXED[name] for name in names if name in _FIXED]] or list(_LOOKS)
    others = [name for name in names if name not in _FIXED]
    return {name: _FIXED.get(name) or free[others.index(name) % len(free)] for name in names}


def _shown_looks(group: Mapping[str, Sequence[Record]], names: Sequence[str]) -> Looks:
    """The group's looks, so that an algorithm keeps its own in all figures; in a crowd, those of the ones shown."""
    return looks(list(group) if len(group) <= MOST_CURVES else names)


# Data


@dataclass(frozen=True, eq=False)
class Band:
    """One quantity of an algorithm by iteration, over its runs: the mean, and the quartiles.

    The mean is of the finite values, nan where less than half of the runs have one. Quartiles are of all runs and may
    be infinite. `arrived` counts the runs that end with a finite value.
    """

    iteration: NDArray[np.int64]
    mean: NDArray[np.float64]
    low: NDArray[np.float64]
    high: NDArray[np.float64]
    arrived: int


def band(series: Sequence[Sequence[float | None]]) -> Band:
    """Gather runs, one series each, None standing for inf; a run that ended earlier keeps its last value."""
    longest = max((len(values) for values in series), default=0)
    if longest == 0:
        empty = np.empty(0)
        return Band(np.empty(0, np.int64), empty, empty, empty, 0)
    rows = [[math.inf if value is None else float(value) for value in values] for values in series if len(values)]
    table = np.array([values + values[-1:] * (longest - len(values)) for values in rows])
    known = np.isfinite(table)
    count = known.sum(axis=0)
    mean = np.where(known, table, 0.0).sum(axis=0) / np.maximum(count, 1)
    low, high = statistics.quantiles(table, (0.25, 0.75))
    number = np.arange(1, longest + 1, dtype=np.int64)
    return Band(number, np.where(2 * count >= len(table), mean, np.nan), low, high, int(count[-1]))


def best_bands(group: Mapping[str, Sequence[Record]], names: Sequence[str]) -> dict[str, Band]:
    """Best length so far by iteration."""
    return {name: band([run.best for run in group[name]]) for name in names if name in group}


def lost_bands(group: Mapping[str, Sequence[Record]], names: Sequence[str]) -> dict[str, Band]:
    """Lost ants by iteration."""
    return {name: band([run.lost for run in group[name]]) for name in names if name in group}


def best_run(runs: Sequence[Record]) -> Record | None:
    """The run with the shortest path, of these the first seed; None where no run has a path."""
    arrived = [run for run in runs if run.path is not None and run.length is not None]
    return min(arrived, key=lambda run: (round(run.length or 0.0, 9), run.seed), default=None)


def beside(points: NDArray[np.float64], shift: float) -> NDArray[np.float64]:
    """A line moved sideways, so that paths through the same cells are seen side by side."""
    if len(points) < 2:
        return points
    along = np.gradient(points, axis=0)
    length = np.linalg.norm(along, axis=1, keepdims=True)
    across = np.stack((-along[:, 1], along[:, 0]), axis=1) / np.where(length > 0, length, 1)
    return points + shift * across


@dataclass(frozen=True)
class Plane:
    """A sweep's algorithms over one parameter, x, or two; with y None, over x alone.

    `points` holds their parameters by label, as far as these are numbers; those in `averaged` vary besides x and y.
    """

    name: str
    points: Mapping[str, Mapping[str, float]]
    x: str
    y: str | None
    averaged: tuple[str, ...] = ()


def planes(sweep: Sweep) -> list[Plane]:
    """Each pair of a sweep's parameters by itself; those that are no numbers are part of the name."""
    families: dict[str, dict[str, dict[str, float]]] = {}
    for label, values in sweep.points.items():
        numbers = {key: float(value) for key, value in values.items() if _is_number(value)}
        name = " ".join([sweep.name, *(f"{key}={value}" for key, value in values.items() if key not in numbers)])
        families.setdefault(name, {})[label] = numbers
    found = []
    for name, points in families.items():
        keys = next(iter(points.values()))
        varied = [key for key in keys if len({point[key] for point in points.values()}) > 1]
        pairs: list[tuple[str, str | None]] = list(combinations(varied, 2)) or [(key, None) for key in varied]
        found += [Plane(name, points, x, y, tuple(key for key in varied if key not in (x, y))) for x, y in pairs]
    return found


def _is_number(value: float | str) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


@dataclass(frozen=True, eq=False)
class SweepGrid:
    """Mean gap in per cent, and share of runs without a path, over two parameters; rows are y; nan: no runs."""

    xs: list[float]
    ys: list[float]
    gap: NDArray[np.float64]
    missing: NDArray[np.float64]


def sweep_grid(records: Sequence[Record], plane: Plane) -> SweepGrid:
    """Gather what `draw_sweep` shows; the gap is of the runs with a path."""
    places = {label: (point[plane.x], point[plane.y] if plane.y else 0.0) for label, point in plane.points.items()}
    xs, ys = (sorted({place[axis] for place in places.values()}) for axis in (0, 1))
    gaps: dict[tuple[int, int], list[float | None]] = {}
    for record in records:
        if record.algorithm in places:
            x, y = places[record.algorithm]
            gaps.setdefault((ys.index(y), xs.index(x)), []).append(record.gap)
    gap, missing = np.full((len(ys), len(xs)), np.nan), np.full((len(ys), len(xs)), np.nan)
    for cell, values in gaps.items():
        arrived = [100 * value for value in values if value is not None]
        gap[cell] = sum(arrived) / len(arrived) if arrived else np.nan
        missing[cell] = 1 - len(arrived) / len(values)
    return SweepGrid(xs, ys, gap, missing)


# Drawing


def new_figure(width: float, height: float) -> Figure:
    """A figure of this size in inches, without pyplot."""
    require_matplotlib()
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), layout="constrained")


def _panel(ax: Axes | None, width: float = 6.0, height: float = 4.4) -> Axes:
    return new_figure(width, height).add_subplot() if ax is None else ax


def _dress(ax: Axes, title: str, x: str, y: str) -> None:
    ax.set_title(printable(title), fontsize=10, color=INK, parse_math=False)
    ax.set_xlabel(x, color=INK)
    ax.set_ylabel(y, color=INK)
    ax.tick_params(labelsize=8, color=FAINT)
    for side in ("top", "right"):
        ax.spines[side].set_visible(False)


def draw_bands(ax: Axes | None, bands: Mapping[str, Band], look: Looks, *, markers: bool = True) -> Axes:
    """Mean lines with their bands; a band whose upper quartile is infinite is open at the top."""
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
        ax.plot(data.iteration, data.mean, label=printable(name) + _absence(data), **style)
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


def _absence(data: Band) -> str:
    if np.isfinite(data.mean).any():
        return ""
    return ": path in less than half of the runs" if data.arrived else ": no path in any run"


def draw_convergence(ax: Axes | None, group: Mapping[str, Sequence[Record]], names: Sequence[str], title: str) -> Axes:
    """Best length by iteration of some algorithms on one map; the optimum as a line."""
    ax = _panel(ax)
    bands = best_bands(group, names)
    draw_bands(ax, bands, _shown_looks(group, names))
    _dress(ax, title, "iteration", "best length so far (cells)")
    handles = list(ax.get_lines())
    optimum = min((tables.optimum_of(group[name]) for name in bands), default=math.inf)
    if math.isfinite(optimum):
        line = ax.axhline(optimum, color=INK, linewidth=1.0, linestyle=(0, (1, 1.6)), zorder=1)
        line.set_label(f"optimum: {optimum:.4f}")
        handles.append(line)
    _fit(ax, bands, optimum)
    if handles:
        _legend(ax, handles)
    return ax


def _fit(ax: Axes, bands: Mapping[str, Band], optimum: float) -> None:
    """Logarithmic where one algorithm would press the others flat."""
    from matplotlib.ticker import LogLocator, MaxNLocator, NullFormatter, ScalarFormatter

    ax.xaxis.set_major_locator(MaxNLocator(integer=True, steps=[1, 2, 5, 10]))
    last = [data.mean[-1] for data in bands.values() if len(data.mean) and np.isfinite(data.mean[-1])]
    tops = [float(data.mean[np.isfinite(data.mean)].max()) for data in bands.values() if np.isfinite(data.mean).any()]
    if not tops or not math.isfinite(optimum) or not optimum > 0:
        return
    if max(tops) > 2 * min([optimum, *last]):
        ax.set_yscale("log")
        ax.yaxis.set_major_locator(LogLocator(subs=(1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0)))
        ax.yaxis.set_major_formatter(ScalarFormatter())
        ax.yaxis.set_minor_formatter(NullFormatter())
    ax.set_ylim(bottom=0.97 * optimum)


def draw_lost(ax: Axes | None, group: Mapping[str, Sequence[Record]], names: Sequence[str], title: str) -> Axes:
    """Lost ants by iteration of some algorithms on one map."""
    from matplotlib.ticker import MaxNLocator

    ax = _panel(ax)
    draw_bands(ax, lost_bands(group, names), _shown_looks(group, names))
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

    ax = plot_map(problem.grid, _panel(ax, 6.0, 6.6))
    old = ax.get_legend()
    kinds = list(old.legend_handles) if old else []
    look, handles = _shown_looks(group, names), []
    shown = [name for name in names if name in group]
    for place, name in enumerate(shown):
        run = best_run(group[name])
        if run is None or run.path is None:
            handles += ax.plot([], [], linestyle="none", label=f"{printable(name)}: no path")
            continue
        shift = (place - (len(shown) - 1) / 2) * 0.8 / max(len(shown), 3) * problem.grid.resolution
        points = beside(problem.grid.cell_to_world(np.array(run.path)), shift)
        handles += ax.plot(
            *points.T,
            **look[name],
            linewidth=1.5,
            markersize=3.4,
            markevery=(2 + place, max(4, len(points) // 7)),
            zorder=3 + 0.1 * place,
            label=f"{printable(name)}: {run.length:.4f}",
            path_effects=[patheffects.Stroke(linewidth=2.6, foreground="white"), patheffects.Normal()],
        )
    handles += _draw_ends(ax, problem, [cell for name in shown for cell in _stars(group[name])])
    _legend(ax, [*handles, *kinds])
    ax.set_title(printable(title), fontsize=10, color=INK, parse_math=False)
    return ax


def _stars(runs: Sequence[Record]) -> list[CellIndex]:
    run = best_run(runs)
    return [run.auxiliary_cell] if run and run.auxiliary_cell else []


def _draw_ends(ax: Axes, problem: Problem, stars: Sequence[CellIndex]) -> list[Any]:
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
        ax.plot(*problem.grid.cell_to_world(np.array(places)).T, label=label, **style | mark)[0]
        for label, places, mark in cells
        if places
    ]


def draw_gaps(ax: Axes | None, group: Mapping[str, Sequence[Record]], title: str) -> Axes:
    """Gaps of all runs on one map: a box (quartiles, whiskers to 1.5 of their range) and every run as a dot."""
    ax = _panel(ax, 6.0, 0.5 * len(group) + 1.8)
    look = looks(list(group))
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


def has_posthocs() -> bool:
    """Whether scikit-posthocs, which draws critical-difference diagrams, is installed."""
    try:
        import scikit_posthocs  # type: ignore[import-untyped,import-not-found,unused-ignore]  # noqa: F401
    except ImportError:
        return False
    return True


def draw_ranks(ax: Axes | None, found: statistics.Ranks, table: Mapping[str, Sequence[float]]) -> Axes:
    """Critical-difference diagram: mean ranks, a bar over algorithms that Nemenyi's test cannot tell apart.

    Raises
    ------
    ImportError
        scikit-posthocs is not installed; see `has_posthocs`.
    """
    import scikit_posthocs  # type: ignore[import-untyped,import-not-found,unused-ignore]

    ax = _panel(ax, 7.0, 0.28 * len(found.mean_ranks) + 1.3)
    names = list(table)
    look = looks(names)
    # The library walks through sets of labels: of numbers, since the order of a set of texts differs from run to run.
    drawn = scikit_posthocs.critical_difference_diagram(
        {number: found.mean_ranks[name] for number, name in enumerate(names)},
        scikit_posthocs.posthoc_nemenyi_friedman(statistics.rank_rows(table)),
        alpha=statistics.ALPHA,
        ax=ax,
        label_fmt_left="{label}",
        label_fmt_right="{label}",
        color_palette={number: look[name]["color"] for number, name in enumerate(names)},
        label_props={"fontsize": 9, "parse_math": False},
        crossbar_props={"color": INK, "linewidth": 3},
    )
    for text in drawn["labels"]:
        name = names[int(text.get_text())]
        words = [printable(name, 40), f"({found.mean_ranks[name]:.2f})"]
        left = text.get_horizontalalignment() == "right"
        text.set_text(" ".join(words) + "  " if left else "  " + " ".join(reversed(words)))
    ax.set_title(
        f"Mean ranks over {found.blocks} blocks; critical difference {found.critical_difference:.2f}",
        fontsize=10,
        color=INK,
        pad=16,
    )
    return ax


def draw_sweep(ax: Axes | None, data: SweepGrid, x: str, y: str | None, title: str = "") -> Axes:
    """Heat map of the mean gap over two parameters, each cell with its figure; see `sweep_grid`."""
    ax = _panel(ax, *_sweep_size(data))
    highest = float(np.nanmax(data.gap)) if np.isfinite(data.gap).any() else 0.0
    image = ax.imshow(
        np.ma.masked_invalid(data.gap), cmap="cividis_r", origin="lower", aspect="auto", vmin=0, vmax=max(highest, 0.01)
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
    ax.figure.colorbar(image, ax=ax, label="mean gap (%)")
    return ax


def _sweep_size(data: SweepGrid) -> tuple[float, float]:
    return 0.75 * len(data.xs) + 2.6, 0.5 * len(data.ys) + 1.6


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


# Whole figures


@dataclass(frozen=True)
class Drawing:
    """A figure of a report: name of its files, title, caption, and the function that makes it."""

    name: str
    title: str
    caption: str
    draw: Callable[[], Figure]


LINES_NOTE = (
    "Lines are means over the runs that have a path by then, drawn where at least half have one; they may rise when a "
    "further run finds its first. Bands are the quartiles of all runs, open at the top while more than a quarter have "
    "no path."
)
STAGES_NOTE = "PACO's second stage starts anew with the sum of its two halves, so its line may rise there."


def paper_figures(groups: tables.Groups, problems: Mapping[str, Problem]) -> list[Drawing]:
    """Figures 5-9 of the paper, as far as the records hold what they show."""
    found: list[Drawing] = []
    both = {label: group for label, group in groups.items() if all(name in group for name in TWO)}
    if both:
        caption = (
            "The paper's two rules (npaco: pheromone of eq. (4.1), hybrid deadlock strategy) against Luo's "
            "(reconstruction). "
        )
        for number, name, draw, what in (
            (5, "best_length", draw_convergence, "Best length by iteration"),
            (6, "lost_ants", draw_lost, "Lost ants by iteration"),
        ):
            title = f"Figure {number}. {what}: the two rules against Luo's"
            note = LINES_NOTE if number == 5 else "Lines are means over runs, bands the quartiles."
            found.append(Drawing(f"figure_{number}_{name}", title, caption + note, _row(draw, both, TWO)))
    for number, (label, group) in enumerate(groups.items(), 7):
        title = f"Figure {number}. Convergence and best paths on {label}"
        caption = (
            "Left: best length by iteration. Right: the best path of each algorithm, side by side where they share "
            f"cells; the star is the auxiliary cell of PACO's best run. {LINES_NOTE} {STAGES_NOTE}"
        )
        found.append(
            Drawing(
                f"figure_{number}_{file_name(label)}", title, caption, _pair(label, group, FOUR, problems.get(label))
            )
        )
    return found


def study_figures(groups: tables.Groups, problems: Mapping[str, Problem]) -> list[Drawing]:
    """Convergence and best paths of any study, a figure for each map."""
    found = []
    for number, (label, group) in enumerate(groups.items(), 1):
        names = leaders(group)
        caption = "Left: best length by iteration. Right: the best path of each algorithm. " + LINES_NOTE
        if len(names) < len(group):
            caption += f" Of {len(group)} algorithms the {len(names)} with the shortest median are shown."
        title = f"Convergence and best paths on {label}"
        found.append(
            Drawing(
                f"convergence_{number}_{file_name(label)}",
                title,
                caption,
                _pair(label, group, names, problems.get(label)),
            )
        )
    return found


def gap_figure(groups: tables.Groups) -> Drawing:
    """Gaps of all runs, a panel for each map."""
    caption = (
        "Each mark is a run; boxes are quartiles with the median, whiskers reach to 1.5 times the interquartile range."
    )
    return Drawing("gaps", "Gaps to the optimum", caption, lambda: _gap_panels(groups))


def leaders(group: Mapping[str, Sequence[Record]]) -> list[str]:
    """The algorithms of a group, or where they are many those with the shortest median, in the group's order."""
    if len(group) <= MOST_CURVES:
        return list(group)
    middle = {name: float(statistics.quantiles(tables.lengths(runs), (0.5,))[0]) for name, runs in group.items()}
    best = sorted(group, key=lambda name: middle[name])[:MOST_CURVES]
    return [name for name in group if name in best]


def rank_figure(found: statistics.Ranks, table: Mapping[str, Sequence[float]]) -> Drawing:
    """The critical-difference diagram of the ranks."""

    def figure() -> Figure:
        sheet = new_figure(7.0, 0.28 * len(table) + 1.3)
        draw_ranks(sheet.add_subplot(), found, table)
        return sheet

    caption = (
        f"Mean ranks over {found.blocks} blocks, 1 the best. Algorithms joined by a bar do not differ at "
        f"{100 * statistics.ALPHA:.0f} % by Nemenyi's test."
    )
    return Drawing("critical_difference", "Critical-difference diagram", caption, figure)


def sweep_figures(groups: tables.Groups, shown: Sequence[Plane]) -> list[Drawing]:
    """Heat maps of the mean gap, one for each plane and map."""
    return [
        _sweep_figure(number, label, [run for runs in group.values() for run in runs], plane)
        for number, (plane, (label, group)) in enumerate(product(shown, groups.items()), 1)
    ]


def _sweep_figure(number: int, label: str, runs: Sequence[Record], plane: Plane) -> Drawing:
    axes = [plane.x, *([plane.y] if plane.y else [])]
    caption = "Mean gap to the optimum in per cent, of the runs with a path; below it the share of runs without one."
    if plane.averaged:
        caption += f" Averaged over {', '.join(plane.averaged)}."
    data = sweep_grid(runs, plane)

    def figure() -> Figure:
        sheet = new_figure(*_sweep_size(data))
        draw_sweep(sheet.add_subplot(), data, plane.x, plane.y, f"{plane.name} on {label}")
        return sheet

    return Drawing(
        f"sweep_{number}_{file_name(' '.join((label, plane.name, *axes)))}",
        f"Mean gap of {plane.name} on {label} over {' and '.join(axes)}",
        caption,
        figure,
    )


def file_name(label: str) -> str:
    """A label as part of a file name, not of all of it: two labels may give the same."""
    return "".join(letter if letter.isascii() and letter.isalnum() else "_" for letter in label)[:LONGEST_NAME]


def _row(draw: Any, groups: tables.Groups, names: Sequence[str]) -> Callable[[], Figure]:
    def figure() -> Figure:
        sheet = new_figure(3.9 * len(groups), 3.9)
        axes = sheet.subplots(1, len(groups), squeeze=False)[0]
        for ax, (label, group) in zip(axes, groups.items(), strict=True):
            draw(ax, group, names, label)
        return sheet

    return figure


def _pair(
    label: str, group: Mapping[str, Sequence[Record]], names: Sequence[str], problem: Problem | None
) -> Callable[[], Figure]:
    def figure() -> Figure:
        if problem is None:
            sheet = new_figure(6.0, 4.6)
            draw_convergence(sheet.add_subplot(), group, names, label)
            return sheet
        sheet = new_figure(11.0, 6.0)
        left, right = sheet.subplots(1, 2)
        draw_convergence(left, group, names, f"{label}: convergence")
        draw_paths(right, problem, group, names, f"{label}: best paths")
        return sheet

    return figure


def _gap_panels(groups: tables.Groups) -> Figure:
    most = max(len(group) for group in groups.values())
    sheet = new_figure(7.0, (0.36 * most + 1.1) * len(groups))
    axes = sheet.subplots(len(groups), 1, squeeze=False)[:, 0]
    for ax, (label, group) in zip(axes, groups.items(), strict=True):
        draw_gaps(ax, group, label)
    return sheet
