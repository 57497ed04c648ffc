"""The figure of a dynamic study: the gap over all iterations, with the changes as lines."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from antnav.markup import printable
from antnav.plot.style import FAINT, INK
from antnav.report.pictures import looks, new_figure
from antnav.report.section import Drawing
from antnav.study.drawings import file_name
from antnav.study.dynamic_record import DynamicRecord
from antnav.study.tracking import DynamicGroups, Tracking

if TYPE_CHECKING:
    from matplotlib.figure import Figure

CAPTION = (
    "Gap to the optimum of the moment, mean over the runs; lines stand where the map changes. Left out where a run has "
    "no path yet."
)


def drawings(groups: DynamicGroups) -> list[Drawing]:
    """A figure for each map."""
    return [_drawing(number, label, group) for number, (label, group) in enumerate(groups.items(), 1)]


def _drawing(number: int, label: str, group: Mapping[str, Sequence[DynamicRecord]]) -> Drawing:
    name = f"changes_{number}_{file_name(label)}"
    return Drawing(name, f"Gap over iterations on {label}", CAPTION, lambda: draw_gaps(group, label))


def draw_gaps(group: Mapping[str, Sequence[DynamicRecord]], label: str) -> Figure:
    """Mean gap of each algorithm by iteration."""
    sheet = new_figure(8.0, 4.6)
    ax, look = sheet.add_subplot(), looks(list(group))
    for name, runs in group.items():
        gaps = np.mean([100.0 * Tracking(run).every_gap for run in runs], axis=0)
        maps, every = gaps.shape
        shown = np.where(np.isfinite(gaps), gaps, np.nan).ravel()
        line = {"color": look[name]["color"], "linestyle": look[name]["linestyle"]}
        ax.plot(np.arange(1, shown.size + 1), shown, **line, linewidth=1.2, label=printable(name, 40))
    for change in range(1, maps):
        ax.axvline(change * every + 0.5, color=FAINT, linewidth=0.6, alpha=0.6, zorder=0)
    ax.set_ylim(bottom=0)
    ax.set_title(printable(label, 60), fontsize=10, color=INK, parse_math=False)
    ax.set_xlabel("iteration", color=INK)
    ax.set_ylabel("gap to the optimum (%)", color=INK)
    ax.tick_params(labelsize=8, color=FAINT)
    for side in ("top", "right"):
        ax.spines[side].set_visible(False)
    for text in ax.legend(frameon=False, fontsize=8).get_texts():
        text.set_parse_math(False)
    return sheet
