"""Comparisons: who is shorter than whom, and whether runs can show it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import combinations

from antnav.report import statistics
from antnav.report.table import Column, Table, Value
from antnav.study.budget import Budget
from antnav.study.groups import LENGTH, Groups, GroupsOf, Measure, R, in_common, median
from antnav.study.record import Kept

ALL_PAIRS = 6  #: Up to so many algorithms, each is compared with each; beyond, the first with each other.
BUDGET_TOLERANCE = 0.1  #: Share by which budgets may differ without a warning.
MANY_MAPS = 10  #: From so many maps on, Friedman's blocks are maps; below, runs of one seed on one map.


def comparisons(
    groups: GroupsOf[R],
    baseline: str | None = None,
    measure: Measure = LENGTH,
) -> Table | None:
    """Paired comparisons of algorithms on each map, or of a baseline with the others; None with nothing to pair."""
    rows: list[tuple[Value, ...]] = []
    for label, group in groups.items():
        found = {pair: statistics.paired(*sides) for pair, sides in _sides(group, baseline, measure).items()}
        corrected = statistics.holm([outcome.p for outcome in found.values()])
        for ((one, other), outcome), p in zip(found.items(), corrected, strict=True):
            shorter = one if outcome.favours_first else other
            verdict = f"{shorter} {measure.better}" if p < statistics.ALPHA else "no difference shown"
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
        Column(f"first {measure.better}", "d"),
        Column("equal", "d"),
        Column(f"first {measure.worse}", "d"),
        Column("A12", ".3f"),
        Column("effect"),
        Column("p", ".2g"),
        Column("p (Holm)", ".2g"),
        Column(f"at {100 * statistics.ALPHA:.0f} %"),
    )
    note = (
        f"{measure.what.capitalize()}s of runs of the same seed; Wilcoxon's signed-rank test, two-sided; p is exact up "
        "to 13 pairs, and up to 50 whose differences have different sizes, else the normal approximation. Corrected "
        "after Holm over the rows of a map. A run without a path ranks last, equal to other such runs. A12 (Vargha & "
        f"Delaney): the probability that a run of the first is {measure.better} than one of the second, ties half."
    )
    if baseline is not None:
        note += f" {baseline} is the study's baseline: only it is compared, with each other one."
    elif any(len(group) > ALL_PAIRS for group in groups.values()):
        note += (
            f" Of more than {ALL_PAIRS} algorithms on a map, only the first is compared, with each other one: the "
            "first of the study's file, unless its key baseline names another."
        )
    return Table("comparisons", "Paired comparisons", columns, tuple(rows), note)


def too_few_seeds(
    groups: GroupsOf[R],
    baseline: str | None = None,
    measure: Measure = LENGTH,
) -> list[str]:
    """A sentence for each map on which no comparison could have shown a difference, whatever the runs had been.

    Least p of n pairs: all differ in one direction, 2 / 2^n; Holm multiplies it by the number of comparisons.
    """
    told = []
    for label, group in groups.items():
        sides = _sides(group, baseline, measure).values()
        count, pairs = len(sides), max((len(left) for left, _ in sides), default=0)
        least = count * 2.0 ** (1 - pairs)
        if sides and least >= statistics.ALPHA:
            enough = math.floor(1 + math.log2(count / statistics.ALPHA)) + 1
            told.append(
                f"{label}: no comparison could reach {100 * statistics.ALPHA:.0f} %, whatever the {measure.what}s: "
                f"with {_counted(pairs, 'seed')} and {_counted(count, 'comparison')} the least p (Holm) is "
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


def _sides(group: dict[str, list[R]], baseline: str | None, measure: Measure) -> dict[tuple[str, str], _Sides]:
    """What is measured in common seeds of each two algorithms that are compared and have such.

    Two of which one run stands for all seeds are left out: there is nothing to be tested.
    """
    chosen = [pair for pair in _pairs(list(group), baseline) if any(_drawn(group[name]) for name in pair)]
    sides = {(one, other): in_common(group[one], group[other], measure.of) for one, other in chosen}
    return {pair: found for pair, found in sides.items() if found[0]}


def _drawn(runs: Sequence[Kept]) -> bool:
    """Whether each seed has a run of its own."""
    return len({run.key for run in runs}) == len(runs)


def _pairs(names: list[str], baseline: str | None) -> list[tuple[str, str]]:
    if baseline is None and len(names) <= ALL_PAIRS:
        return list(combinations(names, 2))
    first = names[0] if baseline is None else baseline
    return [(first, other) for other in names if other != first and first in names]


def ranks(
    groups: GroupsOf[R],
    measure: Measure = LENGTH,
) -> tuple[statistics.Ranks | None, str, dict[str, list[float]]]:
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
                table[name].append(float(statistics.quantiles(measure.of(group[name]), (0.5,))[0]))
            continue
        runs = {name: {run.seed: run for run in group[name]} for name in names}
        for seed in sorted(set.intersection(*(set(by_seed) for by_seed in runs.values()))):
            for name in names:
                table[name] += measure.of([runs[name][seed]])
    block = (
        f"a block is a map, its value the median {measure.what}"
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
