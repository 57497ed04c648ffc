"""Sections: what the report of a study says."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence

from antnav.report import statistics
from antnav.report.section import Drawing, Section
from antnav.report.table import Column, Table
from antnav.study import comparison, results, series
from antnav.study.budget import Budget
from antnav.study.drawings import (
    file_name,
    paper_figures,
    rank_figure,
    study_figures,
    sweep_figures,
)
from antnav.study.groups import LENGTH, Groups, GroupsOf, Measure, R, busy, lengths, loaded, optimum_of
from antnav.study.model import Study, Sweep
from antnav.study.record import Kept, Mark, Record
from antnav.world.problem import Problem


def glance(groups: Groups) -> list[str]:
    """One sentence a map; of many algorithms, on the best of them."""
    sentences = []
    for label, group in groups.items():
        parts = []
        for name in series.leaders(group):
            runs = group[name]
            found = statistics.summary(lengths(runs), optimum_of(runs))
            gaps = [100 * run.gap for run in runs if run.gap is not None]
            said = f"mean gap {sum(gaps) / len(gaps):.2f} %" if gaps else "no path"
            if 0 < found.arrived < found.runs:
                said += f", path in {found.arrived} of {found.runs} runs"
            parts.append(f"{name} {said}")
        choice = series.choice_of_leaders(group)
        sentences.append(f"{label}{f' ({choice})' if choice else ''}: {'; '.join(parts)}.")
    return sentences


def warnings(records: Sequence[Record], groups: Groups, study: Study | None) -> list[str]:
    """What a reader has to know before the figures."""
    told = comparison.too_few_seeds(groups, study.baseline if study else None)
    if study and study.seconds is not None:
        ended = sum(Mark.LIMITED in run.marks for run in records)
        told.append(
            f"Each run had {study.seconds:g} s at most; this ended {ended} of {len(records)} runs, whose lengths "
            "depend on the machine."
        )
    told += _budgets(groups, study)
    return told + company(records)


def company(records: Sequence[Kept]) -> list[str]:
    """Of which runs the seconds are no measure."""
    told = []
    if count := loaded(records):
        told.append(
            f"Wall seconds are left out where runs had company ({count} of {len(records)} runs): they would be no "
            "measure; those of one worker are."
        )
    if count := busy(records):
        told.append(
            f"The machine was busy: in {count} of {len(records)} runs its load average was above its number of cores, "
            "so that their wall seconds are too many."
        )
    return told


def _budgets(groups: Groups, study: Study | None) -> list[str]:
    """In what the algorithms were made equal, and where they are not."""
    budget = study.equal_budget if study else None
    unequal = comparison.unequal_budgets(groups, budget or Budget.WALKS)
    if study is None or budget is None:
        hint = "A study's key equal_budget gives all algorithms the same."
        return [*unequal, *([hint] if unequal else [])]
    how = (
        "by their iterations"
        if budget is Budget.WALKS
        else "each run ending with what that algorithm's of the same seed spent"
    )
    told = f"All algorithms got the {budget} of {study.reference.label}, {how}"
    return [f"{told}; where a schedule ended before that, less was spent." if unequal else f"{told}.", *unequal]


def rivals(study: Study | None) -> list[str]:
    """Labels of the planners without ants."""
    return [entry.label for entry in study.algorithms if not entry.algorithm.ants] if study else []


def by_map(groups: Groups, problems: Mapping[str, Problem], paper: bool, rivals: Sequence[str]) -> list[Section]:
    """The results of each map, and the figures."""
    found = []
    for number, (label, group) in enumerate(groups.items(), 2):
        title = f"Table {number}. Results on {label}" if paper else f"Results on {label}"
        name = f"table_{number}_{file_name(label)}" if paper else f"results_{number - 1}_{file_name(label)}"
        found.append(results.outcomes(label, group, paper=paper, name=name, title=title, rivals=rivals))
    extra = [results.saved_time(groups, paper=paper), results.auxiliary_cells(groups, paper=paper)]
    drawings = paper_figures(groups, problems) if paper else study_figures(groups, problems, rivals)
    return [
        Section("Results", tables=(*found, *(table for table in extra if table))),
        Section("Figures", drawings=tuple(drawings)),
    ]


def sweeps(groups: Groups, sweeps: Sequence[Sweep]) -> list[Section]:
    """Heat maps, where the study has sweeps."""
    drawings = sweep_figures(groups, [plane for sweep in sweeps for plane in series.planes(sweep)])
    return [Section("Sensitivity to parameters", drawings=tuple(drawings))] if drawings else []


def tests(
    groups: GroupsOf[R],
    baseline: str | None,
    measure: Measure = LENGTH,
    *,
    compared: str = "algorithms",
    drawn: str = "",
    said: Sequence[str] = (),
    drawings: Sequence[Drawing] = (),
) -> Section:
    """Statistics on a measure, with a word on each test that could not be done.

    Parameters
    ----------
    compared : str
        What the groups are, in the plural.
    drawn : str
        What else a pair needs to be compared, after a comma.
    said, drawings
        Stand first.
    """
    text, tables, shown = list(said), [], list(drawings)
    if pairs := comparison.comparisons(groups, baseline, measure):
        tables.append(pairs)
    else:
        text.append(f"Paired comparisons need two {compared} with a seed in common{drawn}.")
    found, block, blocks = comparison.ranks(groups, measure)
    if found is None:
        text.append(f"Friedman's test needs three {compared} and two blocks that all of them have.")
    else:
        tables.append(comparison.mean_ranks(found, block))
        shown.append(rank_figure(found, list(blocks)))
    return Section("Statistics", tuple(text), tables=tuple(tables), drawings=tuple(shown))


def facts(
    groups: GroupsOf[R], problems: Mapping[str, Problem], here: Mapping[str, str] | None = None
) -> dict[str, str]:
    """Runs, seeds, maps, environments, notes, and where the report is written (`here`), each in a few words."""
    runs = [run for group in groups.values() for runs in group.values() for run in runs]
    facts = {"runs": str(len(runs)), "seeds": _ranges(sorted({run.seed for run in runs}))}
    for label in groups:
        if label in problems:
            problem = problems[label]
            grid = problem.grid
            facts[f"map {label}"] = (
                f"{grid.rows} x {grid.cols} cells, {problem.start_cell} to {problem.goal_cell} (row, col), corner rule "
                f"{problem.corner_rule}, digest {grid.digest[:16]}"
            )
    places = Counter(", ".join(f"{name} {value}" for name, value in run.environment.items()) for run in runs)
    facts |= {f"runs of environment {number}": f"{places[place]}: {place}" for number, place in enumerate(places, 1)}
    said = Counter(note for run in runs for note in (*run.notes, *(mark.sentence for mark in run.marks)))
    facts |= {f"note: {note}": f"in {said[note]} of {len(runs)} runs" for note in sorted(said)}
    return facts | {f"report: {name}": value for name, value in (here or {}).items()}


def _ranges(seeds: Sequence[int]) -> str:
    """1, 2, 3, 7 as "1-3, 7"."""
    parts: list[list[int]] = []
    for seed in seeds:
        if parts and seed == parts[-1][-1] + 1:
            parts[-1][1:] = [seed]
        else:
            parts.append([seed])
    return ", ".join("-".join(map(str, part)) for part in parts)


def environment(facts: Mapping[str, str]) -> Table:
    """The facts as a table."""
    columns = (Column("what"), Column("value"))
    return Table("environment", "Runs, maps, versions and machine", columns, tuple(facts.items()))
