"""Contents: the tables of a report, filled from a study's records."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import astuple, fields
from itertools import combinations

from antnav.study import published, statistics
from antnav.study.budget import Budget
from antnav.study.groups import (
    Groups,
    certainty,
    in_common,
    lengths,
    loaded,
    median,
    most_frequent,
    optimum_of,
    percent_saved,
    wall_seconds,
)
from antnav.study.record import Record
from antnav.study.tables import Column, Table, Value, as_csv

ALL_PAIRS = 6  #: Up to so many algorithms, each is compared with each; beyond, the first with each other.
MANY_MAPS = 10  #: From so many maps on, Friedman's blocks are maps; below, runs of one seed on one map.

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
    """Who was told the way, as the certainty of the records says."""
    names = [name for name, runs in group.items() if "heuristic detour" in certainty(runs)]
    if not names:
        return ""
    who = "All" if len(names) == len(group) else ", ".join(names)
    return (
        f" {who}: ants guided by the heuristic detour, which knows the exact distance to the goal from every cell. "
        "Their lengths say little about how ants find a way by themselves."
    )


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


def comparisons(groups: Groups, baseline: str | None = None) -> Table | None:
    """Paired comparisons of algorithms on each map, or of a baseline with the others; None with nothing to pair."""
    rows: list[tuple[Value, ...]] = []
    for label, group in groups.items():
        found = {pair: statistics.paired(*sides) for pair, sides in _sides(group, baseline).items()}
        corrected = statistics.holm([outcome.p for outcome in found.values()])
        for ((one, other), outcome), p in zip(found.items(), corrected, strict=True):
            shorter = one if outcome.favours_first else other
            verdict = f"{shorter} shorter" if p < statistics.ALPHA else "no difference shown"
            size = statistics.magnitude(outcome.a12)
            tally = (outcome.shorter, outcome.equal, outcome.longer)
            rows.append((label, one, other, outcome.pairs, *tally, outcome.a12, size, outcome.p, p, verdict))
    if not rows:
        return None
    columns = (
        Column("map"),
        Column("first"),
        Column("second"),
        Column("seeds", "d"),
        Column("first shorter", "d"),
        Column("equal", "d"),
        Column("first longer", "d"),
        Column("A12", ".3f"),
        Column("effect"),
        Column("p", ".2g"),
        Column("p (Holm)", ".2g"),
        Column(f"at {100 * statistics.ALPHA:.0f} %"),
    )
    note = (
        "Lengths of runs of the same seed; Wilcoxon's signed-rank test, two-sided; p is exact up to 13 pairs, and up "
        "to 50 whose differences have different sizes, else the normal approximation. Corrected after Holm over the "
        "rows of a map. A run without a path ranks last, equal to other such runs. A12 (Vargha & Delaney): the "
        "probability that a run of the first is shorter than one of the second, ties half."
    )
    if baseline is not None:
        note += f" {baseline} is the study's baseline: only it is compared, with each other one."
    elif any(len(group) > ALL_PAIRS for group in groups.values()):
        note += (
            f" Of more than {ALL_PAIRS} algorithms on a map, only the first is compared, with each other one: the "
            "first of the study's file, unless its key baseline names another."
        )
    return Table("comparisons", "Paired comparisons", columns, tuple(rows), note)


def too_few_seeds(groups: Groups, baseline: str | None = None) -> list[str]:
    """A sentence for each map on which no comparison could have shown a difference, whatever the runs had been.

    Least p of n pairs: all differ in one direction, 2 / 2^n; Holm multiplies it by the number of comparisons.
    """
    told = []
    for label, group in groups.items():
        sides = _sides(group, baseline).values()
        count, pairs = len(sides), max((len(left) for left, _ in sides), default=0)
        least = count * 2.0 ** (1 - pairs)
        if sides and least >= statistics.ALPHA:
            enough = math.floor(1 + math.log2(count / statistics.ALPHA)) + 1
            told.append(
                f"{label}: no comparison could reach {100 * statistics.ALPHA:.0f} %, whatever the lengths: with "
                f"{_counted(pairs, 'seed')} and {_counted(count, 'comparison')} the least p (Holm) is "
                f"{min(1, least):.2g}. {enough} seeds or more can show a difference."
            )
    return told


def unequal_budgets(groups: Groups, budget: Budget) -> list[str]:
    """A sentence for each map on which the runs of one algorithm spent more than those of another."""
    told = []
    for label, group in groups.items():
        spent = {name: median([getattr(run, str(budget)) for run in runs]) for name, runs in group.items()}
        least, most = min(spent, key=lambda name: spent[name]), max(spent, key=lambda name: spent[name])
        if spent[most] > (1 + BUDGET_TOLERANCE) * spent[least]:
            told.append(
                f"{label}: budgets differ, from {spent[least]:.6g} {budget} of {least} to {spent[most]:.6g} of {most} "
                "(medians), so that lengths compare unlike efforts."
            )
    return told


def _counted(number: int, what: str) -> str:
    return f"{number} {what}{'s' * (number != 1)}"


_Sides = tuple[list[float], list[float]]


def _sides(group: dict[str, list[Record]], baseline: str | None) -> dict[tuple[str, str], _Sides]:
    """Lengths in common seeds of each two algorithms that are compared and have such."""
    sides = {(one, other): in_common(group[one], group[other]) for one, other in _pairs(list(group), baseline)}
    return {pair: found for pair, found in sides.items() if found[0]}


def _pairs(names: list[str], baseline: str | None) -> list[tuple[str, str]]:
    if baseline is None and len(names) <= ALL_PAIRS:
        return list(combinations(names, 2))
    first = names[0] if baseline is None else baseline
    return [(first, other) for other in names if other != first and first in names]


def ranks(groups: Groups) -> tuple[statistics.Ranks | None, str, dict[str, list[float]]]:
    """Friedman's test over the blocks that all algorithms have, what a block is, and the blocks themselves.

    With ten maps or more a block is a map, its value the median length; with fewer, the runs of one seed on one
    map, and the answer concerns these maps only.
    """
    names = list(dict.fromkeys(name for group in groups.values() for name in group))
    table: dict[str, list[float]] = {name: [] for name in names}
    maps = [group for group in groups.values() if len(group) == len(names)]
    by_map = len(maps) >= MANY_MAPS
    for group in maps:
        if by_map:
            for name in names:
                table[name].append(float(statistics.quantiles(lengths(group[name]), (0.5,))[0]))
            continue
        runs = {name: {run.seed: run for run in group[name]} for name in names}
        for seed in sorted(set.intersection(*(set(by_seed) for by_seed in runs.values()))):
            for name in names:
                table[name] += lengths([runs[name][seed]])
    block = (
        "a block is a map, its value the median length"
        if by_map
        else "a block is one seed on one map, so that the answer concerns these maps and not maps at large"
    )
    return statistics.friedman(table), block, table


def mean_ranks(found: statistics.Ranks, block: str) -> Table:
    """The mean ranks of Friedman's test."""
    note = (
        f"Friedman's test over {found.blocks} blocks ({block}): chi-squared {found.statistic:.2f}, p {found.p:.2g}. "
        f"Mean ranks further apart than {found.critical_difference:.3f} differ at "
        f"{100 * statistics.ALPHA:.0f} % (Nemenyi). A run without a path ranks last."
    )
    columns = (Column("algorithm"), Column("mean rank", ".3f"))
    return Table("mean_ranks", "Mean ranks", columns, tuple(found.mean_ranks.items()), note)


BUDGET_TOLERANCE = 0.1  #: Share by which budgets may differ without a warning.
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


def runs_csv(records: Sequence[Record]) -> str:
    """All records as one table, nothing left out: tuples and mappings as JSON, empty for None."""
    names = [field.name for field in fields(Record)]
    rows = [[_plain(getattr(record, name)) for name in names] for record in records]
    return as_csv(names, rows)


def _plain(value: object) -> Value:
    if isinstance(value, tuple | dict):
        return json.dumps(value, separators=(",", ":"))
    return value if value is None or isinstance(value, str | int | float) else str(value)
