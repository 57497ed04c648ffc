"""`antnav reproduce`, `antnav study`, `antnav merge`: repeated runs, kept as they finish, and a report."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Annotated, Any

import typer

from antnav.cli.engines import Engine, Workers, engine
from antnav.cli.running import CountWatch, compilation_announced, run_interruptibly
from antnav.cli.terminal import FOUND, INTERRUPTED, complain, say
from antnav.errors import OutputError, ParameterError
from antnav.plot.style import require_matplotlib
from antnav.study.dynamic_record import DynamicRecord
from antnav.study.dynamic_report import write_dynamic_report
from antnav.study.front_record import FrontRecord
from antnav.study.front_report import write_front_report
from antnav.study.merge import merged
from antnav.study.model import AnyStudy, Study
from antnav.study.paper import PAPER_RUNS, paper_study
from antnav.study.record import Record
from antnav.study.report import write_report
from antnav.study.runner import run_study
from antnav.study.shard import Shard, absent
from antnav.study.store import Store
from antnav.study.toml import load_study

#: Of `reproduce`, seeds unless the user says otherwise.
DEFAULT_RUNS = 30

Out = Annotated[Path, typer.Option("--output", "-o", help="Folder for report, tables, figures and runs.")]
ShardOption = Annotated[
    str | None,
    typer.Option(
        "--shard",
        metavar="I/N",
        help="Only the I-th of N parts of the runs, kept in OUTPUT/runs-I-of-N.sqlite; `antnav merge` joins them.",
    ),
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
    executor: Engine = "threads",
    workers: Workers = None,
    shard: ShardOption = None,
    quiet: Quiet = False,
) -> int:
    """Rebuild Tables 2-4 and Figures 5-9 of Si & Bao 2024 as a report.

    Interrupted and started again, it goes on where it stopped: every run is kept in OUTPUT/runs.sqlite as it finishes.
    """
    if paper and runs is not None:
        raise ParameterError(f"--runs {runs} with --paper", f"--paper is --runs {PAPER_RUNS}", "leave one of them out")
    seeds = PAPER_RUNS if paper else runs or DEFAULT_RUNS
    where = Where(output, executor, workers, None if shard is None else Shard.of(shard), quiet)
    return _done(paper_study(seeds, maps), where, partial(_write, paper=True))


def study(
    config: Annotated[
        Path,
        typer.Argument(
            help="TOML file: maps, algorithms or a sweep, seeds; with objectives fronts, with changes maps that change."
        ),
    ],
    output: Out = Path("study"),
    executor: Engine = "threads",
    workers: Workers = None,
    shard: ShardOption = None,
    quiet: Quiet = False,
) -> int:
    """Compare algorithms x parameters x maps x seeds of your own, with the same report."""
    plan: AnyStudy[Any] = load_study(config)
    where = Where(output, executor, workers, None if shard is None else Shard.of(shard), quiet)
    return _done(plan, where, WRITERS[plan.keeps])


@dataclass(frozen=True)
class Where:
    """Where runs are done and kept."""

    folder: Path
    executor: str
    workers: int | None
    shard: Shard | None
    quiet: bool

    @property
    def store(self) -> Path:
        """The file of the runs."""
        return self.folder / ("runs.sqlite" if self.shard is None else self.shard.file_name)


def _write(records: Sequence[Record], output: Path, plan: Study, *, paper: bool = False) -> None:
    problems = {entry.label: entry.problem for entry in plan.maps}
    write_report(records, output, title=plan.title, paper=paper, problems=problems, sweeps=plan.sweeps, study=plan)


#: Write the report of a study, by what it keeps of a run.
WRITERS: Mapping[type, Callable[[Any, Path, Any], object]] = {
    Record: _write,
    FrontRecord: write_front_report,
    DynamicRecord: write_dynamic_report,
}


def _done(plan: AnyStudy[Any], where: Where, write: Callable[[Any, Path, Any], object]) -> int:
    """Do the runs and write the report; of a shard only the runs."""
    if where.shard is None:
        require_matplotlib()  # before the runs, not after them
    with compilation_announced(where.quiet):
        plan.warmup()
    with engine(where.executor, where.workers) as (executor, workers):
        try:
            where.folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            rule = error.strerror or str(error)
            raise OutputError(f"folder {where.folder}", rule, "name a folder that can be made or written to") from error
        watch = CountWatch("runs", where.quiet)
        with Store(where.store, plan.keeps) as store:
            do = partial(run_study, plan, store, executor=executor, workers=workers, shard=where.shard)
            records, interrupted = run_interruptibly(lambda cancel: do(cancel=cancel, progress=watch.count), watch)
        watch.close()
    if interrupted:
        total = len(plan.jobs() if where.shard is None else where.shard.jobs(plan))
        complain(f"interrupted after {len(records)} of {total} runs; the same command goes on from there", "")
        return INTERRUPTED
    if where.shard is not None:
        pattern = where.folder / f"runs-*-of-{where.shard.count}.sqlite"
        say(f"{len(records)} runs in {where.store}; with all shards: antnav merge {pattern} -o {where.folder}")
        return FOUND
    write(records, where.folder, plan)
    say(f"{len(records)} runs, report: {where.folder / 'report.html'}")
    return FOUND


def merge(
    stores: Annotated[list[Path], typer.Argument(metavar="FILE...", help="Stores of runs, such as of shards.")],
    output: Out = Path("study"),
) -> int:
    """Join stores of runs in OUTPUT/runs.sqlite, for `antnav study` or `antnav reproduce` to write the report from.

    antnav merge out/runs-*-of-10.sqlite -o out && antnav study x.toml -o out

    Of a run that several stores have the first is kept, and all must tell the same, apart from times.
    """
    try:
        output.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        rule = error.strerror or str(error)
        raise OutputError(f"folder {output}", rule, "name a folder that can be made or written to") from error
    target = output / "runs.sqlite"
    added, known = merged(stores, target)
    if lacking := absent([path.name for path in stores]):
        complain(lacking, "")
    say(f"{added} runs added to {target}{f', {known} were known' if known else ''}")
    return FOUND
