"""What benchmarks leave behind: tables as CSV and Markdown, and a figure; each file whole or not at all."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from antnav.errors import OutputError
from antnav.files import write_whole
from antnav.markup import printable
from antnav.plot.style import FAINT, INK, legend_below
from antnav.report import to_csv, to_markdown
from antnav.report.environment import machine
from antnav.report.pictures import looks, new_figure, render
from antnav.report.table import Table
from antnav.report.text import plain

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class Mark:
    """A point of the figure: gap in per cent with its upper end, and time in milliseconds; nan for what is unknown."""

    gap: float
    gap_high: float
    ms: float


@dataclass(frozen=True)
class Picture:
    """What the figure shows: marks by series (a colour each) and row, and what its axes say."""

    marks: Mapping[str, Mapping[str, Mark]]
    gap_label: str
    time_label: str


def write(out: Path, raw: Table, summary: Table, picture: Picture) -> None:
    """Write raw rows, summary and figure into a folder, which is made where it is missing.

    Raises
    ------
    ParameterError
        matplotlib is not installed.
    OutputError
        A file cannot be written.
    """
    contents = {
        f"{raw.name}.csv": to_csv.table(raw).encode(),
        f"{summary.name}.csv": to_csv.table(summary).encode(),
        **{f"figure.{ending}": render(lambda: draw_picture(picture), ending) for ending in ("svg", "png")},
        f"{summary.name}.md": _markdown(summary).encode(),
    }
    try:
        out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(f"folder {out}", error.strerror or str(error), "name one that can be made") from error
    for name, content in contents.items():
        write_whole(out / name, content)


def _markdown(table: Table) -> str:
    facts = [f"- {name}: {plain(value)}\n" for name, value in machine().items()]
    note = [f"{plain(table.note)}\n"] if table.note else []
    return "\n".join(
        [f"# {plain(table.title)}\n", "".join(facts), to_markdown.table(table), *note, "![gap and time](figure.svg)\n"]
    )


def draw_picture(picture: Picture) -> Figure:
    """Two panels with the same rows: gap (a line to its upper end) and time (logarithmic)."""
    marks = picture.marks
    rows = list(dict.fromkeys(row for series in marks.values() for row in series))
    sheet = new_figure(10.0, (0.16 * len(marks) + 0.22) * len(rows) + 1.8)
    left, right = sheet.subplots(1, 2, sharey=True)
    look = looks(list(marks))
    for place, (name, series) in enumerate(marks.items()):
        shift = 0.7 * ((place + 0.5) / len(marks) - 0.5)
        style: dict[str, Any] = {"color": look[name]["color"], "marker": look[name]["marker"], "linestyle": "none"}
        places = {row: rows.index(row) + shift for row in series}
        _draw_gaps(left, series, places, style)
        right.plot(
            [mark.ms for mark in series.values()],
            list(places.values()),
            **style,
            markersize=4.5,
            label=printable(name),
        )
    _scale_gaps(
        left, [gap for series in marks.values() for mark in series.values() for gap in (mark.gap, mark.gap_high)]
    )
    right.set_xscale("log")
    for ax, label in ((left, picture.gap_label), (right, picture.time_label)):
        ax.set_xlabel(label, color=INK, fontsize=9)
        ax.tick_params(labelsize=8, color=FAINT)
        ax.grid(axis="x", color=FAINT, alpha=0.25, linewidth=0.6)
        for side in ("top", "right"):
            ax.spines[side].set_visible(False)
    left.set_yticks(range(len(rows)), [printable(row, 40) for row in rows], parse_math=False)
    left.set_ylim(len(rows) - 0.5, -0.5)
    for text in legend_below(right, right.get_lines()).get_texts():
        text.set_parse_math(False)
    return sheet


def _draw_gaps(ax: Axes, series: Mapping[str, Mark], places: Mapping[str, float], style: Mapping[str, Any]) -> None:
    """Gaps of a series; a cross at the right edge where there is no path."""
    for row, mark in series.items():
        if math.isinf(mark.gap):
            edge = ax.get_yaxis_transform()
            ax.plot([1.0], [places[row]], color=style["color"], marker="x", transform=edge, clip_on=False)
            continue
        ax.plot([mark.gap], [places[row]], **style, markersize=4.5, clip_on=False)
        if math.isfinite(mark.gap_high):
            ax.plot([mark.gap, mark.gap_high], [places[row]] * 2, color=style["color"], linewidth=1.2)


def _scale_gaps(ax: Axes, gaps: Sequence[float]) -> None:
    """Linear up to 1 %, logarithmic beyond: one poor algorithm must not press the others flat."""
    highest = max((gap for gap in gaps if math.isfinite(gap)), default=0.0)
    if highest > 2:
        from matplotlib.ticker import ScalarFormatter

        ax.set_xscale("symlog", linthresh=1, linscale=0.5)
        ax.set_xticks([tick for tick in (0, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000) if tick <= 1.5 * highest])
        ax.xaxis.set_major_formatter(ScalarFormatter())
        ax.minorticks_off()
    ax.set_xlim(left=0, right=1.15 * highest or 1.0)
