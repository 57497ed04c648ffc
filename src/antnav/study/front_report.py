"""The report of a study of fronts."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from importlib.metadata import version
from pathlib import Path

from antnav.errors import ParameterError
from antnav.report import folder
from antnav.report.environment import machine
from antnav.report.section import Section
from antnav.study import front_sections, sections, setup
from antnav.study.front_model import FrontStudy
from antnav.study.front_record import FrontRecord
from antnav.study.groups import grouped
from antnav.study.report import files
from antnav.study.standing import standings


def write_front_report(
    records: Sequence[FrontRecord],
    out_dir: str | os.PathLike[str],
    study: FrontStudy,
    *,
    environment: Mapping[str, str] | None = None,
) -> Path:
    """Write a report of these runs, files and all as `write_report` does, and return the path of its HTML.

    Raises
    ------
    ParameterError
        No records, or matplotlib or moocore is not installed.
    OutputError
        A file cannot be written.
    """
    if not records:
        raise ParameterError("a report", "there are no runs to report", "run the study first")
    groups = grouped(records)
    known = standings(groups)
    here = dict(machine() if environment is None else environment)
    facts = sections.facts(groups, {}, here | {"indicators": f"moocore {version('moocore')}"})
    glance = (*front_sections.glance(groups, known), *front_sections.warnings(records, groups, study))
    told = [
        Section("At a glance", items=glance),
        *front_sections.by_map(groups, known),
        front_sections.tests(groups, known, study.baseline),
        front_sections.what_was_run(groups, study),
        Section("Environment", tables=(sections.environment(facts),)),
    ]
    asked = {label: [each.label for each in objectives] for label, objectives in study.objectives.items()}
    parameters = setup.document(study, front_sections.usual, without_ants="method", objectives=asked)
    return folder.write(Path(out_dir), study.title, told, files(records, parameters, study.text))
