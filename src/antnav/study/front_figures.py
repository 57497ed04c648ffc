"""Figures of a study of fronts: each method's typical front beside the yardstick."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from antnav.markup import printable
from antnav.plot.style import FAINT, INK
from antnav.report.pictures import looks, new_figure
from antnav.report.section import Drawing
from antnav.study.drawings import file_name
from antnav.study.front_record import FrontRecord
from antnav.study.standing import FrontGroups, Standing

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

CAPTION = "Of each method the front of the run whose share of hypervolume is the median; grey: the yardstick."
LINES = 400  #: Of a front, as many paths as parallel axes show, spread evenly.


def drawings(groups: FrontGroups, known: Mapping[str, Standing]) -> list[Drawing]:
    """A figure for each map with paths: a plane of two objectives, or parallel axes."""
    return [
        _drawing(number, label, groups[label], standing) for number, (label, standing) in enumerate(known.items(), 1)
    ]


def _drawing(number: int, label: str, group: Mapping[str, Sequence[FrontRecord]], standing: Standing) -> Drawing:
    shown = {name: standing.typical(runs) for name, runs in group.items()}
    plane = standing.truth.shape[1] == 2
    caption = CAPTION if plane else f"{CAPTION} A line is a path; 0 and 1 are the ends of the yardstick."

    def figure() -> Figure:
        return draw_plane(shown, standing, label) if plane else draw_parallel(shown, standing, label)

    return Drawing(f"fronts_{number}_{file_name(label)}", f"Fronts on {label}", caption, figure)


def draw_plane(shown: Mapping[str, FrontRecord], standing: Standing, label: str) -> Figure:
    """One objective against the other."""
    sheet = new_figure(7.0, 5.0)
    ax, look = sheet.add_subplot(), looks(list(shown))
    first, second = standing.truth.T
    ax.plot(first, second, color=FAINT, linewidth=3.5, alpha=0.35, drawstyle="steps-post", label="yardstick", zorder=1)
    for place, (name, run) in enumerate(shown.items()):
        style = look[name] | {"linestyle": "none" if run.complete else look[name]["linestyle"]}
        many = max(1, len(run.values) // 60)
        size = 4.0 + 7.0 * (len(shown) - 1 - place) / len(shown)  # those that coincide lie inside each other
        ax.plot(
            *np.array(run.values).T,
            **style,
            linewidth=0.9,
            markersize=size,
            markerfacecolor="none",
            markevery=many,
            drawstyle="steps-post",
            label=_named(name, run),
        )
    objectives = next(iter(shown.values())).objectives
    ax.set_xlabel(objectives[0], parse_math=False)
    ax.set_ylabel(objectives[1], parse_math=False)
    _dress(ax, label)
    for text in ax.legend(frameon=False, fontsize=8).get_texts():
        text.set_parse_math(False)
    return sheet


def draw_parallel(shown: Mapping[str, FrontRecord], standing: Standing, label: str) -> Figure:
    """An axis for each objective, a panel for each method."""
    columns = min(3, len(shown))
    rows = math.ceil(len(shown) / columns)
    sheet = new_figure(4.2 * columns, 3.3 * rows + 0.4)
    axes, look = sheet.subplots(rows, columns, squeeze=False, sharey=True).ravel(), looks(list(shown))
    low, width = standing.scale
    objectives = next(iter(shown.values())).objectives
    places = range(len(objectives))
    for ax, (name, run) in zip(axes, shown.items(), strict=False):
        ax.plot(places, _some((standing.truth - low) / width).T, color=FAINT, linewidth=0.5, alpha=0.25, zorder=1)
        lines = _some((np.array(run.values) - low) / width)
        ax.plot(places, lines.T, color=look[name]["color"], linewidth=0.7, alpha=0.7, zorder=2)
        ax.set_xticks(places, [printable(each, 24) for each in objectives], fontsize=7.5, parse_math=False)
        for place in places:
            ax.axvline(place, color="#c8ccd1", linewidth=0.8, zorder=0)
        _dress(ax, _named(name, run))
    for ax in axes[len(shown) :]:
        ax.set_visible(False)
    sheet.suptitle(printable(label), fontsize=10, color=INK, parse_math=False)
    return sheet


def _named(name: str, run: FrontRecord) -> str:
    count = len(run.values)
    return f"{printable(name, 40)}: {count} path{'s' * (count != 1)}"


def _some(lines: np.ndarray) -> np.ndarray:
    return lines[:: max(1, math.ceil(len(lines) / LINES))]


def _dress(ax: Axes, title: str) -> None:
    ax.set_title(printable(title, 60), fontsize=10, color=INK, parse_math=False)
    ax.tick_params(labelsize=8, color=FAINT)
    for side in ("top", "right"):
        ax.spines[side].set_visible(False)
