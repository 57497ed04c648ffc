"""The report of a study: one HTML file that needs nothing else, Markdown, tables, figures, and the raw runs."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from dataclasses import fields
from pathlib import Path

from antnav.errors import ParameterError
from antnav.report import folder, to_csv
from antnav.report.environment import machine
from antnav.report.section import Section
from antnav.report.table import Value
from antnav.study import sections, setup
from antnav.study.drawings import gap_figure
from antnav.study.groups import grouped
from antnav.study.model import Study, Sweep
from antnav.study.paper_sections import paper_sections
from antnav.study.record import Kept, Record
from antnav.world.problem import Problem


def write_report(
    records: Sequence[Record],
    out_dir: str | os.PathLike[str],
    *,
    title: str,
    paper: bool,
    problems: Mapping[str, Problem],
    sweeps: Sequence[Sweep] = (),
    study: Study | None = None,
    notes: Sequence[str] = (),
    environment: Mapping[str, str] | None = None,
) -> Path:
    """Write a report of these runs, each file whole or not at all, and return the path of its HTML.

    The same records give the same bytes on the same machine: nothing in the files depends on when they were written.

    Parameters
    ----------
    records : sequence of Record
        At least one. Order decides the order of maps and algorithms.
    out_dir : path-like
        Made where it is missing. Gets report.html (self-contained), report.md, runs.csv, tables/ and figures/, and with
        a study parameters.json and as_run.toml, the file that it was read from. Loses those tables and figures of its
        last report, named in files.txt, that this one does not have.
    title : str
    paper : bool
        Whether the records repeat Si & Bao 2024: its tables and figures by number, its printed figures beside ours.
    problems : mapping of str to Problem
        By map label, for the pictures of maps; a map that is missing here gets none.
    sweeps : sequence of Sweep
        Those of the study, for heat maps.
    study : Study, optional
        What was run: its parameters and problems are shown and, with the file that it was read from, kept beside the
        results, so that they can be repeated.
    notes : sequence of str
        What a reader must know, shown first.
    environment : mapping, optional
        Versions and machine that the report is written with; default: those here and now. Those of the runs are in
        the records.

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
    facts = sections.facts(groups, {} if study else problems, machine() if environment is None else environment)
    baseline = study.baseline if study else None
    told = [
        Section("At a glance", items=(*sections.glance(groups), *sections.warnings(records, groups, study), *notes)),
        *sections.by_map(groups, problems, paper, sections.rivals(study)),
        *sections.sweeps(groups, sweeps),
        sections.tests(groups, baseline, drawings=[gap_figure(groups)]),
        *(paper_sections(groups, problems, study) if paper else []),
        *([Section("What was run", tables=tuple(setup.tables(study)))] if study else []),
        Section("Environment", tables=(sections.environment(facts),)),
    ]
    more = files(records, setup.document(study), study.text) if study else files(records)
    return folder.write(Path(out_dir), title, told, more)


def files(records: Sequence[Kept], parameters: str = "", as_run: str = "") -> dict[str, bytes]:
    """What a report has beside tables and figures: all runs; of a study, its choices and the file it was read from."""
    more = {"runs.csv": runs_csv(records), "parameters.json": parameters, "as_run.toml": as_run}
    return {name: text.encode() for name, text in more.items() if text}


def runs_csv(records: Sequence[Kept]) -> str:
    """All records, at least one, as one table, nothing left out: tuples and mappings as JSON, empty for None."""
    names = [field.name for field in fields(records[0])]
    rows = [[_plain(getattr(record, name)) for name in names] for record in records]
    return to_csv.lines(names, rows)


def _plain(value: object) -> Value:
    if isinstance(value, tuple | dict):
        return json.dumps(value, separators=(",", ":"))
    return value if value is None or isinstance(value, str | int | float) else str(value)
