"""Claims: what Si & Bao 2024 say, one by one, and what the runs of a reproduction show of each.

A verdict is worked out from the runs. Who is smaller is a question for a paired test (`statistics.paired`, corrected
after Holm within the claim), so that ten lucky runs decide nothing: what the test cannot show cannot be told.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import NamedTuple

from antnav.ants.decompose import boundary
from antnav.colony.parts import Axis
from antnav.planner.facts import Basis
from antnav.planner.planner import parameters
from antnav.report import statistics
from antnav.report.table import Column, Table, Value
from antnav.study import published, results, verdicts
from antnav.study.groups import (
    Groups,
    busy,
    clauses,
    in_common,
    lengths,
    loaded,
    median,
    most_frequent,
    rests_on,
)
from antnav.study.model import Study
from antnav.study.paper import SWAPPED
from antnav.study.record import Record
from antnav.world.problem import Problem

HOLDS, FAILS, OPEN = "holds", "does not hold", "cannot be told"
NEAR = 0.05  #: A run has converged once its best length stays within this share above the optimum.
SAVED_TOLERANCE = 5.0  #: Percentage points of time saved.

Group = dict[str, list[Record]]
Measure = Callable[[Sequence[Record]], list[float]]


class Claim(NamedTuple):
    """A claim of the paper on a map, what ours shows, the verdict, and what of ours that rests on."""

    where: str
    map: str
    claim: str
    ours: str
    verdict: str
    rests_on: str = "-"


def table(claims: Sequence[Claim]) -> Table:
    """The claims as a table of the report."""
    heads = ("in the paper", "map", "claim", "ours", "verdict", "ours rests on")
    columns = (Column("no.", "d"), *map(Column, heads))
    note = (
        "Claims are in our words; those of figures say what their curves show. Verdicts are worked out from the runs. "
        "Printed lengths: as in “Printed lengths, and ours”, within its tolerance, or shorter. Where a claim fails on "
        "a reconstruction, nothing can be told. Parameters hold because the runs were made with them. "
        f"“Smaller” and “fewer”: shown by Wilcoxon's paired test at {100 * statistics.ALPHA:.0f} %, corrected after "
        f"Holm within the claim. Convergence: the iteration from which on the best length stays within "
        f"{100 * NEAR:.0f} % of the optimum. Time saved: within {SAVED_TOLERANCE:g} points or more, by the steps on "
        "the critical path, which do not depend on the machine. All verdicts are of the maps that were run; the "
        "built-in ones are stand-ins with other walls."
    )
    rows = [(number, *claim) for number, claim in enumerate(claims, 1)]
    return Table("claims", "The paper's claims, one by one", columns, tuple(rows), note)


def tally(claims: Sequence[Claim]) -> str:
    """How many claims hold, in a sentence."""
    count = Counter(claim.verdict for claim in claims)
    parts = ", ".join(f"{verdict} {count[verdict]}" for verdict in (HOLDS, FAILS, OPEN))
    return f"Of {len(claims)} claims: {parts}."


def examined(groups: Groups, problems: Mapping[str, Problem], study: Study | None) -> list[Claim]:
    """Every claim that the maps of these runs have something to say on."""
    places = {label: side for label in groups if (side := published.side_of(label)) is not None}
    if not places:
        return []
    found = list(_parameters(study))
    for label, side in places.items():
        found += _on_map(label, groups[label], side, problems.get(label), study)
    return sorted(found, key=lambda claim: (_PLACES.index(claim.where.split()[0]), claim.where))


_PLACES = ("Table", "Section", "Figure", "Abstract")  #: Order of the claims; on each place map by map.


def _on_map(label: str, group: Group, side: int, problem: Problem | None, study: Study | None) -> Iterator[Claim]:
    number = 2 + published.SIDES.index(side)
    yield from _lengths(label, group, side, f"Table {number}")
    yield from _ranking(label, group, side, f"Table {number}")
    if problem is not None:
        yield _line(label, problem, side)
        yield _switch(label, problem, side, study)
    yield _auxiliary(label, group, side, f"Figure {number + 5}")
    yield from _two_rules(label, group)
    yield _convergence(label, group, f"Figure {number + 5}")
    yield from _abstract(label, group, side)


# Verdicts


def smaller(pairs: Sequence[tuple[Sequence[float], Sequence[float]]]) -> str:
    """Whether the first of each pair is smaller, seed by seed: shown of all, its reverse shown of one, or open."""
    if not pairs or not all(len(first) for first, _ in pairs):
        return OPEN
    found = [statistics.paired(first, second) for first, second in pairs]
    shown = [p < statistics.ALPHA for p in statistics.holm([outcome.p for outcome in found])]
    if any(sure and not outcome.favours_first for sure, outcome in zip(shown, found, strict=True)):
        return FAILS
    return HOLDS if all(shown) else OPEN


def compared(group: Group, pairs: Sequence[tuple[str, str]], measure: Measure) -> str:
    """`smaller` of algorithms by what is measured of their runs.

    Open where one of them is missing, and where a claim fails that rests on a reconstruction.
    """
    if any(name not in group for pair in pairs for name in pair):
        return OPEN
    verdict = smaller([in_common(group[one], group[other], measure) for one, other in pairs])
    rebuilt = any(rests_on(Basis.RECONSTRUCTION, group[name]) for pair in pairs for name in pair)
    return OPEN if verdict == FAILS and rebuilt else verdict


def settled(runs: Sequence[Record]) -> list[float]:
    """The iteration from which on each run's best length stays near the optimum; inf where it never does."""
    found = []
    for run in runs:
        far = [n for n, best in enumerate(run.best, 1) if best is None or best > (1 + NEAR) * (run.optimum or 0.0)]
        last = far[-1] if far else 0
        found.append(last + 1.0 if last < len(run.best) else math.inf)
    return found


def _lost(runs: Sequence[Record]) -> list[float]:
    return [float(sum(run.lost)) for run in runs]


def _seconds(runs: Sequence[Record]) -> list[float]:
    return [run.seconds for run in runs]


# What is said where


def _parameters(study: Study | None) -> Iterator[Claim]:
    """Table 1, and what it leaves out."""
    runs = [entry for entry in study.algorithms if entry.label in ("paco", "npaco")] if study else []
    chosen = {entry.label: parameters(entry.algorithm) for entry in runs}
    printed = ", ".join(f"{symbol} {value:g}" for symbol, value in published.TABLE_1.values())
    other = [
        f"{label} {symbol} {values[name]:g}"
        for label, values in chosen.items()
        for name, (symbol, value) in published.TABLE_1.items()
        if values.get(name, value) != value
    ]
    verdict = OPEN if not chosen else FAILS if other else HOLDS
    used = f"run with {', '.join(other)}" if other else f"run with these by {' and '.join(chosen)}" if chosen else "-"
    yield Claim("Table 1", "all", f"parameters: {printed}", used, verdict)
    first = next(iter(chosen.values()), None)
    ours = f"{first['rho']:g}, {first['tau0']:g}, {first['tau_min']:g} tau0" if first else "-"
    yield Claim("Table 1", "all", "rho, tau0 and a least tau: not printed", ours, OPEN, "calibrated values")


def _switch(label: str, problem: Problem, side: int, study: Study | None) -> Claim:
    """B of section 5."""
    ants = [entry for entry in study.algorithms if entry.label in ("paco", "npaco")] if study else []
    used = {entry.label: parameters(entry.algorithm.suited(problem)).get("switch") for entry in ants}
    printed = published.SWITCH[side]
    verdict = OPEN if not used else HOLDS if set(used.values()) == {printed} else FAILS
    return Claim(
        "Section 5",
        label,
        f"ants in a dead end are killed once t > b T, b = {printed:g}",
        f"run with b: {', '.join(f'{name} {value}' for name, value in used.items()) or '-'}",
        verdict,
        "PACO's stage two applies b to its own T - T0 iterations (calibrated)",
    )


def _line(label: str, problem: Problem, side: int) -> Claim:
    """Whether the paper's auxiliary cell lies where its rule says."""
    axis, index = boundary(problem.start_cell, problem.goal_cell, Axis.AUTO)
    cell = published.AUXILIARY[side][0]
    ours = f"the rule gives {('row', 'column')[axis]} {index}, the printed cell is {cell} (row, col)"
    claim = "the auxiliary cell lies on the middle row, or where columns differ more, on the middle column"
    return Claim("Section 4.3", label, claim, ours, HOLDS if cell[axis] == index else FAILS)


def _auxiliary(label: str, group: Group, side: int, where: str) -> Claim:
    cell, (x, y) = published.AUXILIARY[side]
    runs = group.get("paco", [])
    favourite = most_frequent(runs)
    claim = f"PACO's auxiliary cell is ({x}, {y}), that is {cell} (row, col)"
    if favourite is None:
        return Claim(where, label, claim, "-", OPEN)
    share = sum(run.auxiliary_cell == cell for run in runs)
    ours = f"{favourite[0]} most often; the printed one in {share} of {len(runs)} runs"
    return Claim(where, label, claim, ours, HOLDS if favourite[0] == cell else FAILS, _basis(group, "paco"))


def _two_rules(label: str, group: Group) -> Iterator[Claim]:
    """Figures 5 and 6: the paper's pheromone rule and deadlock strategy against Luo's, all else equal."""
    pair = ("npaco", SWAPPED)
    for where, claim, measure, words in (
        ("Figure 5", "the paper's two rules end in shorter paths than Luo's", lengths, "length"),
        ("Figure 5", "the paper's two rules converge in fewer iterations than Luo's", settled, "iteration"),
        ("Figure 6", "the paper's two rules lose fewer ants than Luo's", _lost, "ants lost in all iterations"),
    ):
        verdict = compared(group, [pair], measure)
        yield Claim(where, label, claim, _medians(group, pair, measure, words), verdict, _basis(group, *pair))


def _convergence(label: str, group: Group, where: str) -> Claim:
    """Figures 7-9."""
    names = ("paco", "dai", "traditional")
    claim = "PACO converges in fewer iterations than Dai's and the traditional algorithm"
    verdict = compared(group, [(names[0], other) for other in names[1:]], settled)
    return Claim(where, label, claim, _medians(group, names, settled, "iteration"), verdict, _basis(group, *names))


def _lengths(label: str, group: Group, side: int, where: str) -> Iterator[Claim]:
    """Printed best and mean, algorithm by algorithm."""
    compared_with = verdicts.reached({label: group})
    rows = compared_with.rows if compared_with else ()
    for (of, name), printed in published.PRINTED.items():
        if of != side:
            continue
        claim = (
            f"{name} reaches {printed.best:.4f}, and {printed.mean:.4f} on average" if printed else f"{name}: no path"
        )
        ours = {str(row[2]): row for row in rows if row[1] == name}
        if not ours:
            yield Claim(where, label, claim, "-", OPEN)
            continue
        holds = {row[6] for row in ours.values()} <= {"reached", "shorter than printed", "as printed: no path"}
        verdict = HOLDS if holds else OPEN if rests_on(Basis.RECONSTRUCTION, group[name]) else FAILS
        said = ", ".join(f"{figure} {_length(row[4])} ({row[6]})" for figure, row in ours.items())
        yield Claim(where, label, claim, said, verdict, _basis(group, name))


def _ranking(label: str, group: Group, side: int, where: str) -> Iterator[Claim]:
    """Whom PACO beats, or does not, by the printed means and seconds."""
    rows = {name: printed for (of, name), printed in published.PRINTED.items() if of == side}
    means = {name: printed.mean if printed else math.inf for name, printed in rows.items()}
    seconds = {name: printed.seconds for name, printed in rows.items() if printed}
    unfit = unfit_for_time(group)
    for printed, measure, what, ours, others in (
        (means, lengths, "shorter paths on average", _means, ("dai", "traditional")),
        (seconds, _seconds, "less time", _median_seconds, ("npaco", "dai", "traditional")),
    ):
        for other in others:
            if other not in printed:  # no path was printed, and so no time
                continue
            first, second = sorted(("paco", other), key=lambda name: printed[name])
            claim = f"{first} has {what} than {second}"
            basis = _basis(group, first, second)
            if unfit and measure is _seconds:
                yield Claim(where, label, claim, f"no measure: {unfit}", OPEN, basis)
                continue
            verdict = compared(group, [(first, second)], measure)
            yield Claim(where, label, claim, ours(group, (first, second)), verdict, basis)


def _abstract(label: str, group: Group, side: int) -> Iterator[Claim]:
    """Time saved, and at what price."""
    names = ("paco", "npaco")
    paco, npaco = (published.PRINTED[side, name] for name in names)
    assert paco is not None
    assert npaco is not None
    basis = _basis(group, *names)
    loss = 100 * (paco.mean / npaco.mean - 1)
    claim = f"PACO loses little accuracy: its mean is {loss:.2f} % above NPACO's"
    means = [statistics.summary(lengths(group[name]), math.inf).mean for name in names if name in group]
    if len(means) == len(names) and all(map(math.isfinite, means)):
        ours = 100 * (means[0] / means[1] - 1)
        verdict = HOLDS if ours <= loss + verdicts.MEAN_TOLERANCE else FAILS
        yield Claim("Abstract", label, claim, f"{ours:+.2f} %", verdict, basis)
    else:
        yield Claim("Abstract", label, claim, "-", OPEN, basis)
    claim = f"PACO needs {published.TIME_SAVED[side]:.2f} % less time than NPACO"
    saved = results.saved_time({label: group}, paper=True)
    if saved is None:
        yield Claim("Abstract", label, claim, "-", OPEN, basis)
        return
    (row,) = saved.rows
    enough = float(row[4] or 0) >= published.TIME_SAVED[side] - SAVED_TOLERANCE
    yield Claim("Abstract", label, claim, saved_words(row, group), HOLDS if enough else FAILS, basis)


def unfit_for_time(group: Group) -> str:
    """Why the seconds of these runs are no measure; "" where they are one."""
    every = [run for runs in group.values() for run in runs]
    return "runs had company" if loaded(every) else "the machine was busy" if 2 * busy(every) > len(every) else ""


def saved_words(row: Sequence[Value], group: Group) -> str:
    """What a row of `results.saved_time` says, as far as it is known and a measure; what verdicts rest on first."""
    unfit = unfit_for_time(group)
    shares = {"work on the critical path (steps)": row[4], "CPU time": row[5]}
    shares |= {} if unfit else {"wall time": row[3]}
    told = ", ".join(
        f"{abs(share):.1f} % {'less' if share >= 0 else 'more'} {what}"
        for what, share in shares.items()
        if isinstance(share, float) and math.isfinite(share)
    )
    return told + (f" (wall seconds are no measure: {unfit})" if unfit else "")


# Words


def _medians(group: Group, names: Sequence[str], measure: Measure, what: str) -> str:
    found = []
    for name in names:
        if name in group:
            value = float(statistics.quantiles(measure(group[name]), (0.5,))[0])
            found.append(f"{name} {f'{value:.6g}' if math.isfinite(value) else 'never'}")
    return f"{what} (median): {', '.join(found)}" if found else "-"


def _length(value: Value) -> str:
    return Column("", ".4f").text(value)


def _means(group: Group, names: Sequence[str]) -> str:
    found = {name: statistics.summary(lengths(group[name]), math.inf) for name in names if name in group}
    return ", ".join(f"{name} {one.mean:.4f}" if one.arrived else f"{name} no path" for name, one in found.items())


def _median_seconds(group: Group, names: Sequence[str]) -> str:
    return ", ".join(f"{name} {median(_seconds(group[name])):.4f} s" for name in names if name in group)


def _basis(group: Group, *names: str) -> str:
    """What of these algorithms is not the paper's word, as their certainty says."""
    found = clauses(run for name in names for run in group.get(name, []))
    return "; ".join(str(clause) for clause in found if clause.basis is not Basis.PAPER) or "-"
