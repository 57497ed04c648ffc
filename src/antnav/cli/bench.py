"""`antnav bench`: against published optima, and against what else can be installed."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from antnav.bench import movingai as movingai_bench
from antnav.bench import output as bench_output
from antnav.bench import peers as peers_bench
from antnav.bench.courses import COURSES, Course, course
from antnav.bench.output import Picture
from antnav.bench.scenarios import read_queries
from antnav.cli.inputs import check_folder, read_map
from antnav.cli.running import CountWatch, compilation_announced, run_interruptibly
from antnav.cli.terminal import FOUND, INTERRUPTED, complain, say, say_table
from antnav.errors import ParameterError
from antnav.maps import builtin_names, builtin_query
from antnav.plan.warmup import warmup
from antnav.plot.style import require_matplotlib
from antnav.report.table import Table
from antnav.values import check_seed

Out = Annotated[
    Path | None, typer.Option("--output", "-o", metavar="FOLDER", help="Write tables and a figure there too.")
]
Seed = Annotated[int, typer.Option(help="Same seed, same paths.")]
Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="No progress.")]

app = typer.Typer(help="Measure gaps and times, against published optima or other planners.", rich_markup_mode=None)


@app.callback(invoke_without_command=True)
def _bench(context: typer.Context) -> None:
    if context.invoked_subcommand is None:
        typer.echo(context.get_help())


@app.command(short_help="Gap to the published optima of MovingAI scenarios, and time.")
def movingai(
    folder: Annotated[
        Path, typer.Argument(metavar="DIR", help="Folder with MovingAI .map and .scen files, at any depth.")
    ],
    algorithms: Annotated[
        str | None,
        typer.Option(metavar="NAME,...", help="Presets, astar, dijkstra; default: the preset for large maps, astar."),
    ] = None,
    queries: Annotated[int, typer.Option(help="Queries of each .scen file.")] = 20,
    hardest: Annotated[float, typer.Option(metavar="SHARE", help="Share of the file that they are of.")] = 0.25,
    seed: Seed = 0,
    time_limit: Annotated[
        float | None, typer.Option(metavar="SECONDS", help="For ants, a query. Results then vary.")
    ] = None,
    workers: Annotated[int, typer.Option(min=1, help="Queries side by side; above 1, times are no measure.")] = 1,
    output: Out = None,
    quiet: Quiet = False,
) -> int:
    """Solve the hardest queries of MovingAI scenarios, and compare with their published optima.

    Every algorithm solves every query in turn, corner rule forbid; every path is checked move by move.
    """
    names = list(movingai_bench.default_algorithms()) if algorithms is None else _names("--algorithms", algorithms)
    movingai_bench.check_algorithms(names)
    check_seed(seed)
    _check_output(output)
    asked = read_queries(folder, queries, hardest)
    with compilation_announced(quiet):
        warmup()
    watch = CountWatch("searches", quiet)
    answers, interrupted = run_interruptibly(
        lambda cancel: movingai_bench.run(
            asked,
            names,
            seed=seed,
            time_limit=time_limit,
            workers=workers,
            cancel=cancel,
            progress=watch.count,
        ),
        watch,
    )
    scores = movingai_bench.scores(answers)
    note = f"Corner rule forbid, seed {seed}" + ("" if time_limit is None else f", ants for at most {time_limit:g} s")
    if workers > 1:
        note += f"; {workers} queries at a time, so times are no measure"
    summary = movingai_bench.summary(scores, f"{note}.")
    done = f"{len(answers)} of {len(asked) * len(names)} searches"
    return _finish(
        output, movingai_bench.raw_table(answers), summary, movingai_bench.picture(scores), done, interrupted
    )


@app.command(short_help="antnav beside other planners from PyPI.")
def peers(
    only: Annotated[
        str | None,
        typer.Option("--peers", metavar="NAME,...", help="Adapters of benchmarks/peers; a wrong name lists them."),
    ] = None,
    maps: Annotated[
        str, typer.Option(metavar="NAME,...", help=f"Among {', '.join(COURSES)}, built-in maps, and map files.")
    ] = ",".join(COURSES),
    runs: Annotated[int, typer.Option(min=1, help="Runs of each peer on each map.")] = 5,
    python: Annotated[
        list[str] | None,
        typer.Option(metavar="INTERPRETER", help="Another Python, for peers that this one does not have. Repeatable."),
    ] = None,
    timeout: Annotated[float, typer.Option(metavar="SECONDS", help="For a peer on a map.")] = 120.0,
    seed: Seed = 0,
    output: Out = None,
    quiet: Quiet = False,
) -> int:
    """Run antnav and the peers that are installed on the same maps, each in a process of its own.

    Total: from array to path; query: what a second query on the same map would pay again; medians. The gap is to the
    optimum under the peer's own corner rule. Needs the source tree: adapters are in benchmarks/peers, and
    benchmarks/requirements-peers.txt lists what to install.
    """
    names = list(peers_bench.peers()) if only is None else _names("--peers", only)
    peers_bench.check_peers(names)
    check_seed(seed)
    _check_output(output)
    courses = [_course(name) for name in _names("--maps", maps)]
    if not quiet:
        on = f"{len(courses)} map{'s' * (len(courses) != 1)}"
        complain(
            f"looking for {len(names)} peers, then timing each that is installed, {runs} times on {on}...", kind=""
        )
    known = peers_bench.installed(peers_bench.interpreters(python or []))
    absent = [name for name in names if name not in known]
    if absent == names:
        raise ParameterError(f"peers {', '.join(names)}", "none is installed", "install some, or name their --python")
    with compilation_announced(quiet):
        warmup()
    watch = CountWatch("trials", quiet)
    trials, interrupted = run_interruptibly(
        lambda cancel: peers_bench.run(
            names, courses, known, runs=runs, seed=seed, timeout=timeout, cancel=cancel, progress=watch.count
        ),
        watch,
    )
    rows = peers_bench.rows(trials)
    done = f"{len(trials)} of {len(courses) * (len(names) - len(absent))} trials"
    table = peers_bench.summary(rows, absent)
    return _finish(output, peers_bench.runs_table(trials), table, peers_bench.picture(rows), done, interrupted)


def _names(option: str, text: str) -> list[str]:
    names = list(dict.fromkeys(name.strip() for name in text.split(",") if name.strip()))
    if not names:
        raise ParameterError(f"{option} {text!r}", "it is one name or several, with commas between", "name one")
    return names


def _check_output(folder: Path | None) -> None:
    """What would fail after hours must fail at once."""
    if folder is not None:
        check_folder(folder)
        require_matplotlib()


def _course(name: str) -> Course:
    if name in COURSES:
        return course(name)
    grid = read_map(name)
    if name in builtin_names():
        return Course(name, grid, *builtin_query(name))
    return Course.on(grid.name or name, grid)


def _finish(folder: Path | None, raw: Table, summary: Table, picture: Picture, done: str, interrupted: bool) -> int:
    """Print the summary and write the files; of an interrupted run, what there is is printed and nothing written."""
    if summary.rows:
        right = [summary.right(index) for index in range(len(summary.columns))]
        say_table([column.head for column in summary.columns], summary.texts, right)
    if summary.note:
        say(summary.note)
    if interrupted:
        complain(f"interrupted after {done}{'; no file was written' if folder else ''}", kind="")
        return INTERRUPTED
    if folder is not None:
        bench_output.write(folder, raw, summary, picture)
        say(f"{done}, files: {folder}")
    return FOUND
