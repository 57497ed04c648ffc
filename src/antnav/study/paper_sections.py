"""Sections on the paper: its claims, what differs from it, what it leaves undefined."""

from __future__ import annotations

from collections.abc import Mapping

from antnav.planner.facts import Basis
from antnav.report.section import Section
from antnav.report.table import Table, Value
from antnav.study import claims, published, results, verdicts
from antnav.study.groups import Groups, certainty, most_frequent, rests_on
from antnav.study.model import Study
from antnav.world.problem import Problem


def paper_sections(groups: Groups, problems: Mapping[str, Problem], study: Study | None) -> list[Section]:
    """What a report adds where the runs repeat the paper."""
    reached, examined = verdicts.reached(groups), claims.examined(groups, problems, study)
    one_by_one = Section("The paper's claims", (claims.tally(examined),), tables=(claims.table(examined),))
    return [
        *([one_by_one] if examined else []),
        Section(
            "What differs from the paper, and why",
            text=(
                f"Written by the program from the runs above. The paper's figures are of {published.RUNS} runs each "
                f"({published.PAPER}).",
            ),
            items=tuple(_differences(groups, reached)),
            tables=(reached,) if reached else (),
        ),
        Section(
            "What the paper leaves undefined, and what we chose",
            text=("Formulas, sources and measurements: docs/algorithms and docs/reproduction.md of antnav.",),
            items=published.CHOICES,
        ),
    ]


def _differences(groups: Groups, reached: Table | None) -> list[str]:
    """What is reached and what is not, in sentences, with the likely cause."""
    rows = reached.rows if reached else ()
    told = [f"{len(rows)} printed lengths have a counterpart here."] if rows else []
    for figure, meaning in (
        ("reached", "Reached"),
        ("as printed: no path", "No path, as printed"),
        ("shorter than printed", "Shorter than printed"),
        ("path, none printed", "A path where the paper prints none"),
        ("not reached", "Not reached (longer)"),
        ("no path", "No path where the paper prints one"),
    ):
        cases = [_case(row) for row in rows if row[6] == figure]
        if cases:
            told.append(f"{meaning} ({len(cases)}): {', '.join(cases)}.")
    missed = dict.fromkeys(str(row[1]) for row in rows if row[6] in ("not reached", "no path"))
    told += [_cause(name, groups) for name in missed]
    return told + _time_differences(groups) + _cell_differences(groups)


def _case(row: tuple[Value, ...]) -> str:
    label, algorithm, figure, _, _, off, verdict, *_ = row
    by = f" ({off:+.2f} %)" if isinstance(off, float) and verdict != "reached" else ""
    return f"{label} {algorithm} {figure}{by}"


def _cause(algorithm: str, groups: Groups) -> str:
    """Why an algorithm may miss printed lengths: what its certainty says it rests on."""
    runs = [run for group in groups.values() for run in group.get(algorithm, [])]
    causes = ["the built-in maps are stand-ins with the same optimum but other walls"]
    if rests_on(Basis.RECONSTRUCTION, runs):
        causes.insert(0, "the algorithm is a reconstruction, not its authors' code")
    elif rests_on(Basis.CALIBRATED, runs):
        causes.insert(0, "the paper does not print all parameters")
    return f"Why {algorithm} may miss them: {', and '.join(causes)} (certainty: {certainty(runs)})."


def _time_differences(groups: Groups) -> list[str]:
    """Time saved by PACO, ours beside the printed."""
    table = results.saved_time(groups, paper=True)
    told = [
        f"{row[0]}: against NPACO, PACO needs {claims.saved_words(row, groups[str(row[0])])}; the paper prints "
        f"{row[-1]:.2f} % less time."
        for row in (table.rows if table else ())
        if isinstance(row[-1], float)
    ]
    if told:
        told.append(
            "Why the savings differ: stage two takes as long as its longer half, and early iterations wander over the "
            "whole map in both halves; runs here last milliseconds, of which starting two threads is a part, and "
            "need two free cores."
        )
    return told


def _cell_differences(groups: Groups) -> list[str]:
    """Auxiliary cells, ours beside the printed."""
    told = []
    for label, group in groups.items():
        side, favourite = published.side_of(label), most_frequent(group.get("paco", []))
        if side is None or favourite is None:
            continue
        printed, runs = published.AUXILIARY[side][0], group["paco"]
        share = sum(run.auxiliary_cell == printed for run in runs)
        which = "is the printed one" if favourite[0] == printed else f"is not the printed {printed}"
        told.append(
            f"{label}: PACO's most frequent auxiliary cell {favourite[0]} {which}; {share} of {len(runs)} runs "
            "choose the printed one."
        )
    return told
