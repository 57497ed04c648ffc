"""`antnav reproduce` and `antnav study`: repeated runs, kept as they finish, and a report."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Annotated, Any

import typer

from antnav.cli.running import CountWatch, compilation_announced, run_interruptibly
from antnav.cli.terminal import FOUND, INTERRUPTED, complain, say
from antnav.errors import OutputError, ParameterError
from antnav.plot.style import require_matplotlib
from antnav.study.dynamic_record import DynamicRecord
from antnav.study.dynamic_report import write_dynamic_report
from antnav.study.front_record import FrontRecord
from antnav.study.front_report import write_front_report
from antnav.study.model import AnyStudy, Study
from antnav.study.paper import PAPER_RUNS, paper_study
from antnav.study.record import Record
from antnav.study.report import write_report
from antnav.study.runner import run_study
from antnav.study.store import Store
from antnav.study.toml import load_study

#: Of `reproduce`, seeds unless the user says otherwise.
DEFAULT_RUNS = 30

Out = Annotated[Path, typer.Option("--output", "-o", help="Folder for report, tables, figures and runs.")]
Workers = Annotated[
    int, typer.Option(min=1, help="Runs side by side; above 1, wall seconds are no measure and are marked so.")
]
Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="No progress.")]


def reproduce(
    output: Out = Path("reproduction"),
    runs: Annotated[
        int | None, typer.Option(min=1, help=f"Seeds of each algorithm on each map; default {DEFAULT_RUNS}.")
    ] = None,
    paper: Annotated[bool, typer.Option("--paper", help=f"As many runs as in the paper: {PAPER_RUNS}.")] = False,
    maps: Annotated[
        Path | None, typer.Option(help="Folder with equiv20, equiv30, equiv40 in any map format; default: built in.")
    ] = None,
    workers: Workers = 1,
    quiet: Quiet = False,
) -> int:
    """Rebuild Tables 2-4 and Figures 5-9 of Si & Bao 2024 as a report.

    Interrupted and started again, it goes on where it stopped: every run is kept in OUTPUT/runs.sqlite as it finishes.
    """
    if paper and runs is not None:
        raise ParameterError(f"--runs {runs} with --paper", f"--paper is --runs {PAPER_RUNS}", "leave one of them out")
    seeds = PAPER_RUNS if paper else runs or DEFAULT_RUNS
    return _report(paper_study(seeds, maps), output, workers, quiet, partial(_write, paper=True))


def study(
    config: Annotated[
        Path,
        typer.Argument(
            help="TOML file: maps, algorithms or a sweep, seeds; with objectives fronts, with changes maps that change."
        ),
    ],
    output: Out = Path("study"),
    workers: Workers = 1,
    quiet: Quiet = False,
) -> int:
    """Compare algorithms x parameters x maps x seeds of your own, with the same report."""
    plan: AnyStudy[Any] = load_study(config)
    return _report(plan, output, workers, quiet, WRITERS[plan.keeps])


def _write(records: Sequence[Record], output: Path, plan: Study, *, paper: bool = False) -> None:
    problems = {entry.label: entry.problem for entry in plan.maps}
    write_report(records, output, title=plan.title, paper=paper, problems=problems, sweeps=plan.sweeps, study=plan)


#: Write the report of a study, by what it keeps of a run.
WRITERS: Mapping[type, Callable[[Any, Path, Any], object]] = {
    Record: _write,
    FrontRecord: write_front_report,
    DynamicRecord: write_dynamic_report,
}


def _report(
    plan: AnyStudy[Any], output: Path, workers: int, quiet: bool, write: Callable[[Any, Path, Any], object]
) -> int:
    require_matplotlib()  # before the runs, not after them
    with compilation_announced(quiet):
        plan.warmup()
    try:
        output.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        rule = error.strerror or str(error)
        raise OutputError(f"folder {output}", rule, "name a folder that can be made or written to") from error
    watch = CountWatch("runs", quiet)
    with Store(output / "runs.sqlite", plan.keeps) as store:
        records, interrupted = run_interruptibly(
            lambda cancel: run_study(plan, store, workers=workers, cancel=cancel, progress=watch.count), watch
        )
    watch.close()
    total = len(plan.jobs())
    if interrupted:
        complain(f"interrupted after {len(records)} of {total} runs; the same command goes on from there", "")
        return INTERRUPTED
    write(records, output, plan)
    say(f"{len(records)} runs, report: {output / 'report.html'}")
    return FOUND
