"""The report of a study of maps that change."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path

import numpy as np

from antnav.errors import ParameterError
from antnav.report import folder
from antnav.report.environment import machine
from antnav.report.section import Section
from antnav.report.table import Column, Table, Value
from antnav.study import comparison, sections, setup
from antnav.study.drawings import file_name
from antnav.study.dynamic_figures import drawings
from antnav.study.dynamic_model import DynamicStudy
from antnav.study.dynamic_record import DynamicRecord
from antnav.study.groups import certainty, grouped, wall_seconds
from antnav.study.report import files
from antnav.study.tracking import AT, NEAR, OFFLINE, DynamicGroups, Tracking

#: Iterations within which a run should recover.
SOON = 5

NOTE = (
    "Means over the runs, of each over its changes; the map as it is first does not count. Gaps are to the exact "
    "optimum of the map of the moment. Offline gap: mean over all iterations of that of the best path since the "
    "change (modified offline performance, Branke). Accuracy: optimum over cost, mean over all iterations; "
    "stability: what accuracy loses from the iteration before a change to the one after, 0 is best (Weicker). "
    f"Recovered: share of the changes after which the gap was at most that before, or {100 * NEAR:g} %, within "
    f"{SOON} iterations; recovery: median of the iterations that this took, “no path” where most changes never saw "
    "it."
)


def write_dynamic_report(
    records: Sequence[DynamicRecord],
    out_dir: str | os.PathLike[str],
    study: DynamicStudy,
    *,
    environment: Mapping[str, str] | None = None,
) -> Path:
    """Write a report of these runs, files and all as `write_report` does, and return the path of its HTML.

    Raises
    ------
    ParameterError
        No records, or matplotlib is not installed.
    OutputError
        A file cannot be written.
    """
    if not records:
        raise ParameterError("a report", "there are no runs to report", "run the study first")
    groups = grouped(records)
    facts = sections.facts(groups, {}, machine() if environment is None else environment)
    warnings = [*comparison.too_few_seeds(groups, study.baseline, OFFLINE), *sections.company(records)]
    tables = [_results(number, label, group) for number, (label, group) in enumerate(groups.items(), 1)]
    told = [
        Section("At a glance", items=(*_glance(groups), *warnings)),
        Section("Results", tables=tuple(tables)),
        Section("Figures", drawings=tuple(drawings(groups))),
        sections.tests(groups, study.baseline, OFFLINE),
        _what_was_run(study),
        Section("Environment", tables=(sections.environment(facts),)),
    ]
    parameters = setup.document(study, changes=asdict(study.changes))
    return folder.write(Path(out_dir), study.title, told, files(records, parameters, study.text))


def _glance(groups: DynamicGroups) -> list[str]:
    """One sentence a map."""
    told = []
    for label, group in groups.items():
        gaps = {name: np.mean([Tracking(run).offline for run in runs]) for name, runs in group.items()}
        parts = (f"{name} {100 * gaps[name]:.2f} %" for name in sorted(gaps, key=gaps.__getitem__))
        told.append(f"{label}: offline gap {', '.join(parts)}.")
    return told


def _results(number: int, label: str, group: Mapping[str, Sequence[DynamicRecord]]) -> Table:
    every = len(next(iter(group.values()))[0].best[0])
    at = [iteration for iteration in AT if iteration <= every]
    columns = (
        Column("algorithm"),
        Column("certainty", footnote=True),
        Column("runs", "d"),
        Column("offline gap (%)", ".2f"),
        Column("accuracy", ".4f"),
        Column("stability", ".4f"),
        Column(f"recovered within {SOON} (%)", ".0f", short=f"rec. in {SOON} (%)"),
        Column("recovery (iterations)", ".0f", short="recovery"),
        *(Column(f"gap after {iteration} (%)", ".2f") for iteration in at),
        Column("largest gap at the end (%)", ".2f", short="largest"),
        Column("steps", ".0f"),
        Column("wall s", ".4f"),
    )
    rows = tuple(_row(name, runs, at) for name, runs in group.items())
    return Table(f"changes_{number}_{file_name(label)}", f"Results on {label}", columns, rows, NOTE)


def _row(name: str, runs: Sequence[DynamicRecord], at: Sequence[int]) -> tuple[Value, ...]:
    found = [Tracking(run) for run in runs]
    recovery = np.concatenate([one.recovery for one in found])
    return (
        name,
        certainty(runs),
        len(runs),
        100 * float(np.mean([one.offline for one in found])),
        float(np.mean([one.accuracy for one in found])),
        float(np.mean([one.stability for one in found])),
        100 * float((recovery <= SOON).mean()),
        float(np.sort(recovery)[len(recovery) // 2]),
        *(100 * float(np.mean([one.at(iteration) for one in found])) for iteration in at),
        100 * float(max(one.gaps[:, -1].max() for one in found)),
        float(np.mean([run.steps for run in runs])),
        wall_seconds(runs),
    )


def _what_was_run(study: DynamicStudy) -> Section:
    changes = study.changes
    text = (
        f"Each run meets {changes.count} changes, one every {changes.every} iterations; each moves "
        f"{100 * changes.share:g} % of the occupied cells, at least one, to free cells drawn evenly, and leaves a way. "
        f"They are drawn by the seed of the changes, {changes.seed}, and the run's."
    )
    tables = (
        setup.choices("parameters", "Parameters of the algorithms", "preset", study.algorithms),
        setup.problems(study.maps),
    )
    return Section("What was run", (text,), tables=tables)
