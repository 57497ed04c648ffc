"""Outcomes: tables of lengths, times and auxiliary cells, filled from records."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import astuple

from antnav.planner.facts import Knows
from antnav.report import statistics
from antnav.report.table import Column, Table, Value
from antnav.study import published
from antnav.study.groups import (
    Groups,
    certainty,
    know,
    lengths,
    loaded,
    median,
    most_frequent,
    optimum_of,
    percent_saved,
    wall_seconds,
)
from antnav.study.record import Record

_OUTCOMES = (
    Column("algorithm"),
    Column("certainty", footnote=True),
    Column("runs", "d"),
    Column("time (median wall s)", ".4f", short="wall s"),
    Column("best", ".4f"),
    Column("mean", ".4f"),
)


_PUBLISHED = tuple(
    Column(f"{figure}: {published.LABEL}", spec, published=True, short=f"paper: {figure}")
    for figure, spec in (("time s", "g"), ("best", ".4f"), ("mean", ".4f"))
)


_BEYOND = (
    Column("optimum", ".4f"),
    Column("gap of mean (%)", ".2f", short="gap (%)"),
    Column("gap, 95 % from (%)", ".2f", short="95 % from"),
    Column("gap, 95 % to (%)", ".2f", short="95 % to"),
    Column("success (%)", ".0f", short="path (%)"),
    Column("optimal (%)", ".0f", short="opt. (%)"),
    Column("median", ".4f"),
    Column("spread (IQR)", ".4f", short="IQR"),
    Column("std", ".4f"),
    Column("ant walks or path evaluations", ".0f", short="walks"),
    Column("steps", ".0f"),
    Column("steps on the critical path", ".0f", short="critical steps"),
    Column("CPU s", ".4f"),
)


OUTCOMES_NOTE = (
    "Lengths in cells. Best, mean, std and gap are of the runs with a path; median and spread (interquartile range) of "
    "all runs, a missing path counting as infinitely long. Seconds, walks and steps are medians of what a run spends: "
    "walks are the paths that were tried, arrived or not, steps the moves of all ants. The 95 % interval is a BCa "
    "bootstrap of the mean gap with a fixed seed. Path and opt. are the shares of runs with a path and with one of the "
    "optimum's length; critical steps, those on the critical path."
)


RIVALS_NOTE = (
    " Of a planner without ants, walks and steps are cost evaluations; of a potential field, walks are descents, steps "
    "its robot's moves."
)


def outcomes(
    label: str, group: dict[str, list[Record]], *, paper: bool, name: str, title: str, rivals: Collection[str] = ()
) -> Table:
    """One map's table: a row for each algorithm; with `paper`, the printed figures in columns of their own.

    `rivals` are the labels of planners without ants.
    """
    columns = (*_OUTCOMES, *(_PUBLISHED if paper else ()), *_BEYOND)
    rows = tuple(_outcome(label, algorithm, runs, paper) for algorithm, runs in group.items())
    note = OUTCOMES_NOTE + RIVALS_NOTE * any(algorithm in rivals for algorithm in group)
    note += _guided(group) + _company(run for runs in group.values() for run in runs)
    if paper:
        note += f" Columns “paper”: {published.LABEL}, from {published.PAPER}; never to be mixed with ours."
    return Table(name, title, columns, rows, note)


def _guided(group: dict[str, list[Record]]) -> str:
    """Who was told the way, as the records say."""
    told = ""
    for what, where in ((Knows.TO_GOAL, "cell"), (Knows.REGIONS, "region")):
        names = [name for name, runs in group.items() if know(what, runs)]
        if names:
            who = "All" if len(names) == len(group) else ", ".join(names)
            told += f" {who}: ants guided by a heuristic that knows the exact distance to the goal from every {where}."
    return told + " Their lengths say little about how ants find a way by themselves." * bool(told)


def _company(runs: Iterable[Record]) -> str:
    return " Wall seconds are missing where other runs ran beside them: they would be no measure." * (loaded(runs) > 0)


def _outcome(label: str, algorithm: str, runs: list[Record], paper: bool) -> tuple[Value, ...]:
    found, optimum = statistics.summary(lengths(runs), optimum_of(runs)), optimum_of(runs)
    gaps = [100 * run.gap for run in runs if run.gap is not None]
    low, high = statistics.interval(gaps)
    row: tuple[Value, ...] = (
        algorithm,
        certainty(runs),
        found.runs,
        wall_seconds(runs),
        found.best if found.arrived else math.inf,
        found.mean if found.arrived else math.inf,
    )
    beyond: tuple[Value, ...] = (
        optimum,
        sum(gaps) / len(gaps) if gaps else None,
        low,
        high,
        100 * found.success_rate,
        100 * found.optimal_rate,
        found.median,
        found.iqr,
        found.std,
        median([run.walks for run in runs]),
        median([run.steps for run in runs]),
        median([run.critical_steps for run in runs]),
        median([run.cpu_seconds for run in runs]),
    )
    return (*row, *(_printed(label, algorithm) if paper else ()), *beyond)


def _printed(label: str, algorithm: str) -> tuple[Value, ...]:
    key = (published.side_of(label) or 0, algorithm)
    if key not in published.PRINTED:
        return (None, None, None)
    printed = published.PRINTED[key]
    return astuple(printed) if printed else (math.inf, math.inf, math.inf)


def saved_time(groups: Groups, *, paper: bool) -> Table | None:
    """Per cent that PACO saves over NPACO; None where no map has both."""
    measures: dict[str, Callable[[Sequence[Record]], float]] = {
        "wall s": wall_seconds,
        "steps on the critical path": lambda runs: median([run.critical_steps for run in runs]),
        "CPU s": lambda runs: median([run.cpu_seconds for run in runs]),
    }
    rows: list[tuple[Value, ...]] = []
    compared: list[Record] = []
    for label, group in groups.items():
        if "paco" not in group or "npaco" not in group or math.isinf(optimum_of(group["paco"])):
            continue  # where no path exists, no ant has walked
        compared += [*group["paco"], *group["npaco"]]
        paco, npaco = ([measure(group[name]) for measure in measures.values()] for name in ("paco", "npaco"))
        saved = [percent_saved(ours, theirs) for ours, theirs in zip(paco, npaco, strict=True)]
        printed = (published.TIME_SAVED.get(published.side_of(label) or 0),) if paper else ()
        rows.append((label, paco[0], npaco[0], *saved, *printed))
    if not rows:
        return None
    columns = [Column("map"), Column("PACO wall s", ".4f"), Column("NPACO wall s", ".4f")]
    columns += [Column(f"saved, {measure} (%)", ".2f") for measure in measures]
    if paper:
        columns.append(Column(f"saved (%): {published.LABEL}", ".2f", published=True))
    note = (
        "Medians over single runs, not the fastest of several repeats. Wall time depends on what else the machine "
        "does, on free cores and on the cost of starting two threads; the steps on the critical path (the longer "
        "colony of each stage) are what does not depend on the machine."
    ) + _company(compared)
    return Table("saved_time", "Time that PACO saves over NPACO", tuple(columns), tuple(rows), note)


def auxiliary_cells(groups: Groups, *, paper: bool) -> Table | None:
    """Auxiliary cells of the algorithms that have one; None where none has."""
    rows: list[tuple[Value, ...]] = []
    for label, group in groups.items():
        for algorithm, runs in group.items():
            favourite = most_frequent(runs)
            if favourite is None:
                continue
            cell, count = favourite
            row: tuple[Value, ...] = (label, algorithm, str(cell), 100 * count / len(runs))
            row += (len({run.auxiliary_cell for run in runs if run.auxiliary_cell}),)
            if paper:
                row += _printed_cell(label, runs)
            rows.append(row)
    if not rows:
        return None
    columns = [Column("map"), Column("algorithm"), Column("most frequent (row, col)"), Column("share (%)", ".0f")]
    columns.append(Column("different cells", "d"))
    if paper:
        columns += [
            Column("printed (row, col)", published=True),
            Column("printed (x, y)", published=True),
            Column("runs with the printed one (%)", ".0f"),
        ]
    note = "Rows and columns from 0 at the top left. Shares are of all runs."
    return Table("auxiliary_cells", "Auxiliary cells", tuple(columns), tuple(rows), note)


def _printed_cell(label: str, runs: Sequence[Record]) -> tuple[Value, ...]:
    side = published.side_of(label)
    if side is None:
        return (None, None, None)
    cell, point = published.AUXILIARY[side]
    return str(cell), f"({point[0]}, {point[1]})", 100 * sum(run.auxiliary_cell == cell for run in runs) / len(runs)
