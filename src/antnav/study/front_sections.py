"""What the report of a study of fronts says."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from antnav.fronts.pareto import METHODS
from antnav.planner.planner import Planner, parameters
from antnav.report.section import Section
from antnav.report.table import Column, Table, Value
from antnav.study import comparison, sections, setup
from antnav.study.budget import Budget
from antnav.study.drawings import file_name
from antnav.study.front_figures import drawings
from antnav.study.front_model import FrontPlanner, FrontStudy, method_of
from antnav.study.front_record import FrontRecord
from antnav.study.groups import certainty, median, wall_seconds
from antnav.study.record import Mark
from antnav.study.standing import FrontGroups, Standing, missing_hypervolume, quartiles

_COLUMNS = (
    Column("method"),
    Column("certainty", footnote=True),
    Column("runs", "d"),
    Column("paths", ".0f"),
    Column("paths, lower quartile", ".0f", short="low"),
    Column("paths, upper quartile", ".0f", short="high"),
    Column("hypervolume (%)", ".2f", short="HV (%)"),
    Column("hypervolume, lower quartile (%)", ".2f", short="low"),
    Column("hypervolume, upper quartile (%)", ".2f", short="high"),
    Column("epsilon", ".4f"),
    Column("epsilon, lower quartile", ".4f", short="low"),
    Column("epsilon, upper quartile", ".4f", short="high"),
    Column("IGD+", ".4f"),
    Column("IGD+, lower quartile", ".4f", short="low"),
    Column("IGD+, upper quartile", ".4f", short="high"),
    Column("complete (%)", ".0f"),
    Column("wall s", ".4f"),
    Column("work"),
)

LATE = 0.1  #: Share by which a run may exceed the time limit without a warning.

NOTE = (
    "Medians over the runs, and quartiles. Hypervolume: share of the yardstick's (Zitzler & Thiele 1998), up to the "
    "reference point, which lies 1.1 ranges of the yardstick beyond its least values. Epsilon: what must be taken off "
    "every value so that nothing of the yardstick is missed (additive, Zitzler et al. 2003). IGD+: mean distance from "
    "the yardstick's points (Ishibuchi et al. 2015). Both in ranges of the yardstick, 0 the best. Complete: runs that "
    "proved that there are no other paths."
)


def glance(groups: FrontGroups, known: Mapping[str, Standing]) -> list[str]:
    """One sentence a map."""
    told = []
    for label, group in groups.items():
        if label not in known:
            told.append(f"{label}: no path leads from the start to the goal.")
            continue
        shares = {name: 100 * quartiles(known[label].measured(runs, "hypervolume"))[0] for name, runs in group.items()}
        parts = ", ".join(f"{name} {share:.2f} %" for name, share in shares.items())
        told.append(f"{label}: hypervolume (median) {parts}, of {known[label].yardstick}.")
    return told


def warnings(records: Sequence[FrontRecord], groups: FrontGroups, study: FrontStudy) -> list[str]:
    """What a reader has to know before the figures."""
    told = [] if len(study.seeds) == 1 else _single(study)
    if study.seconds is not None:
        ended = sum(Mark.LIMITED in run.marks for run in records)
        told.append(
            f"Each run had {study.seconds:g} s at most; this ended {ended} of {len(records)} runs, whose fronts depend "
            "on the machine."
        )
        told += _late(groups, study.seconds)
    if study.equal_budget is Budget.SECONDS:
        told.append(f"Each run had the seconds of {study.reference.label}'s of the same seed at most.")
    return told + sections.company(records)


def _late(groups: FrontGroups, limit: float) -> list[str]:
    """A sentence for each map on which methods took clearly longer than they had."""
    told = []
    for label, group in groups.items():
        took = {name: median([run.seconds for run in runs]) for name, runs in group.items()}
        late = [f"{name} {seconds:.3g} s" for name, seconds in took.items() if seconds > (1 + LATE) * limit]
        if late:
            told.append(f"{label}: longer than that took {', '.join(late)} (medians): methods end between their steps.")
    return told


def _single(study: FrontStudy) -> list[str]:
    names = [entry.label for entry in study.algorithms if not method_of(entry.algorithm).draws]
    if not names:
        return []
    return [f"{', '.join(names)}: nothing is drawn at random; unless a budget differs, one run stands for all seeds."]


def by_map(groups: FrontGroups, known: Mapping[str, Standing]) -> list[Section]:
    """The results of each map, and the figures."""
    tables = [
        _results(label, group, known.get(label), f"fronts_{number}_{file_name(label)}")
        for number, (label, group) in enumerate(groups.items(), 1)
    ]
    return [
        Section("Results", tables=tuple(tables)),
        Section("Figures", drawings=tuple(drawings(groups, known))),
    ]


def _results(label: str, group: Mapping[str, list[FrontRecord]], standing: Standing | None, name: str) -> Table:
    rows = tuple(_row(algorithm, runs, standing) for algorithm, runs in group.items())
    note = "No path leads from the start to the goal."
    if standing:
        labels = next(iter(group.values()))[0].objectives
        point = ", ".join(f"{each} {value:.6g}" for each, value in zip(labels, standing.reference, strict=True))
        note = f"The yardstick is {standing.yardstick}. Reference point: {point}. {NOTE}"
    return Table(name, f"Results on {label}", _COLUMNS, rows, note)


def _row(algorithm: str, runs: list[FrontRecord], standing: Standing | None) -> tuple[Value, ...]:
    measured: list[float] = []
    if standing:
        for what, scale in (("hypervolume", 100.0), ("epsilon", 1.0), ("igd_plus", 1.0)):
            measured += quartiles([scale * value for value in standing.measured(runs, what)])
    names = dict.fromkeys(name for run in runs for name in run.work)
    return (
        algorithm,
        certainty(runs),
        len({run.key for run in runs}),
        *quartiles([float(len(run.values)) for run in runs]),
        *(measured or [math.nan] * 9),
        100 * sum(run.complete for run in runs) / len(runs),
        wall_seconds(runs),
        ", ".join(f"{median([run.work.get(name, 0) for run in runs]):.0f} {name}" for name in names) or "-",
    )


def tests(groups: FrontGroups, known: Mapping[str, Standing], baseline: str | None) -> Section:
    """Statistics on the share of the hypervolume, with a word on each test that could not be done."""
    found = {label: group for label, group in groups.items() if label in known}
    measure = missing_hypervolume(known)
    few = comparison.too_few_seeds(found, baseline, measure)
    drawn = ", one of which draws at random"
    return sections.tests(found, baseline, measure, compared="methods", drawn=drawn, said=few)


def usual(chosen: Planner) -> dict[str, Any]:
    """Parameters of antnav's method of that name; empty where there is none."""
    method = method_of(chosen)
    kind = METHODS.get(method.name)
    return parameters(FrontPlanner(kind())) if kind is type(method) else {}


def what_was_run(groups: FrontGroups, study: FrontStudy) -> Section:
    """Methods, objectives and maps."""
    methods = setup.choices("parameters", "Parameters of the methods", "method", study.algorithms, usual)
    rows: list[tuple[Value, ...]] = []
    for label, group in groups.items():
        run = next(iter(group.values()))[0]
        rows += [(label, name, step) for name, step in zip(run.objectives, run.counted, strict=True)]
    columns = (Column("map"), Column("objective"), Column("counted in steps of", ".4g"))
    note = "Searches count in whole steps, so that a front is complete to within these; values are added up exactly."
    objectives = Table("objectives", "Objectives", columns, tuple(rows), note)
    return Section("What was run", tables=(methods, objectives, setup.problems(study.maps)))
