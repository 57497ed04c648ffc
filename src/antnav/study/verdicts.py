"""Reached: the paper's printed lengths beside ours."""

from __future__ import annotations

import math

from antnav.report import statistics
from antnav.report.table import Column, Table, Value
from antnav.study import published
from antnav.study.groups import Groups, lengths, optimum_of

BEST_TOLERANCE = 5e-4  #: Cells: the paper prints 29.2132 and 29.2133 for one length.
MEAN_TOLERANCE = 0.5  #: Per cent.


def reached(groups: Groups) -> Table | None:
    """Each printed length beside ours, and whether it is reached; None where nothing printed has a counterpart."""
    rows: list[tuple[Value, ...]] = []
    for label, group in groups.items():
        for algorithm, runs in group.items():
            key = (published.side_of(label) or 0, algorithm)
            if key not in published.PRINTED:
                continue
            found = statistics.summary(lengths(runs), optimum_of(runs))
            printed = published.PRINTED[key]
            for figure in ("best", "mean"):
                ours = getattr(found, figure) if found.arrived else math.inf
                theirs = getattr(printed, figure) if printed else math.inf
                off = 100 * (ours / theirs - 1) if math.isfinite(ours) and math.isfinite(theirs) else None
                row = (label, algorithm, figure, theirs, ours, off, verdict(figure, ours, theirs))
                rows.append((*row, f"{found.arrived} of {found.runs}"))
    if not rows:
        return None
    columns = (
        Column("map"),
        Column("algorithm"),
        Column("figure"),
        Column(published.LABEL, ".4f", published=True),
        Column("ours", ".4f"),
        Column("ours longer by (%)", "+z.2f"),
        Column("verdict"),
        Column("runs with a path"),
    )
    note = (
        f"Best: reached within {BEST_TOLERANCE} cells, which is the paper's own rounding. Mean: reached within "
        f"{MEAN_TOLERANCE} %; ours is of the runs with a path. Seconds are not compared: other machines, other code."
    )
    return Table("reached", "Printed lengths, and ours", columns, tuple(rows), note)


def verdict(figure: str, ours: float, theirs: float) -> str:
    """Whether a printed "best" or "mean" is reached; inf means "no path"."""
    if math.isinf(ours) or math.isinf(theirs):
        return "as printed: no path" if ours == theirs else "path, none printed" if math.isinf(theirs) else "no path"
    tolerance = BEST_TOLERANCE if figure == "best" else MEAN_TOLERANCE / 100 * theirs
    if abs(ours - theirs) <= tolerance:
        return "reached"
    return "shorter than printed" if ours < theirs else "not reached"
