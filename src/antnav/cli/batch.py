"""`antnav batch`: many queries on one map, from a file and into a file."""

from __future__ import annotations

import contextlib
import io
import sys
import threading
import time
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import Executor
from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from antnav.ants.presets import PRESETS
from antnav.batch.many import solve_many
from antnav.batch.records import JsonLines, Record, Writer, answered, writer_for
from antnav.batch.rows import ENDINGS, check_ending, read_rows
from antnav.cli.engines import FORMS, engine
from antnav.cli.inputs import Invert, MapName, RulesOption, ValuesOption, check_output, files_of_map
from antnav.cli.query import (
    AllowUnknown,
    Corners,
    Cost,
    GoalTolerance,
    Keepout,
    Quiet,
    Resolution,
    RobotRadius,
    Seed,
    Set,
    Speed,
    StartTolerance,
    StrictRadius,
    TimeLimit,
    Turning,
    map_of,
    planner_of,
)
from antnav.cli.running import CountWatch, compilation_announced, run_interruptibly
from antnav.cli.terminal import BAD_ROWS, FOUND, INTERRUPTED, NO_PATH, complain, say_rows
from antnav.costs.named import collected
from antnav.errors import AntnavError
from antnav.files import writing_whole
from antnav.plan.algorithms import EXACT
from antnav.plan.warmup import warmup
from antnav.planner.plan import Status
from antnav.run.spmd import Serial, checked_workers, executor_for
from antnav.run.stop import Seconds
from antnav.values import check_seed
from antnav.world.moves import CornerRule

DEFAULT = "paco"
#: Bad rows that are told one by one.
MOST_TOLD = 20
STDOUT = "-"

Pairs = Annotated[
    Path,
    typer.Argument(
        metavar="PAIRS",
        help=f"Queries, one a row: {', '.join(ENDINGS)}. Columns start_x, start_y, goal_x, goal_y in metres, or "
        'start_row, start_col, goal_row, goal_col; JSON lines have "start" and "goal", or "start_cell" and '
        '"goal_cell", of two numbers. A column id is carried along.',
        show_default=False,
    ),
]


def batch(
    map_name: MapName,
    pairs: Pairs,
    output: Annotated[
        str,
        typer.Option(
            "-o",
            "--output",
            metavar="FILE",
            help=f"Where the paths go: {', '.join(ENDINGS)}, or {STDOUT} for JSON lines on stdout as they are found.",
        ),
    ] = STDOUT,
    algorithm: Annotated[
        str,
        typer.Option(
            metavar="NAME", help=f"One of {', '.join((*PRESETS, *EXACT))}, or a rival: see `antnav algorithms`."
        ),
    ] = DEFAULT,
    corner_rule: Corners = CornerRule.FORBID,
    robot_radius: RobotRadius = 0.0,
    strict_radius: StrictRadius = True,
    resolution: Resolution = None,
    allow_unknown: AllowUnknown = False,
    goal_tolerance: GoalTolerance = 0.0,
    start_tolerance: StartTolerance = 0.0,
    cost: Cost = None,
    keepout: Keepout = None,
    speed: Speed = None,
    turning: Turning = 0.0,
    seed: Seed = 0,
    settings: Set = None,
    ants: Annotated[int | None, typer.Option(help="Ants an iteration; default: the algorithm's, 50.")] = None,
    iterations: Annotated[int | None, typer.Option(help="Iterations; default: the algorithm's, 50.")] = None,
    time_limit: TimeLimit = None,
    executor: Annotated[
        str | None,
        typer.Option(metavar="NAME", help=f"Where rows are planned side by side: {FORMS}. Default: processes."),
    ] = None,
    workers: Annotated[
        int | None, typer.Option(show_default="1; with --executor all there are", help="Rows planned side by side.")
    ] = None,
    optimum: Annotated[
        bool, typer.Option("--optimum", help="Search the optimum of each too, and tell the gap.")
    ] = False,
    rules: RulesOption = "nav2",
    values: ValuesOption = "cells",
    invert: Invert = False,
    quiet: Quiet = False,
) -> int:
    """Plan a path for each row of a file, in its order; the same paths whatever the number of workers.

    antnav batch office.yaml pairs.csv -o paths.jsonl --workers 2 --algorithm astar

    A row that is no query is told on stderr with its line, and has its error in the output; the others are planned,
    and the exit code is 3. Ctrl-C keeps the rows that are done: whole lines.
    """
    check_ending(pairs)
    target = None if output == STDOUT else Path(output)
    if target is not None:
        check_output(target, ENDINGS, [pairs, *files_of_map(map_name)])
        check_ending(target, "output")
    chosen = planner_of(algorithm, settings, ants=ants, iterations=iterations)
    stop = Seconds(time_limit) if time_limit is not None else None
    check_seed(seed)
    if workers is not None:
        checked_workers(workers)
    cells, rows = read_rows(pairs)
    total = sum(1 for _ in rows)

    grid = map_of(map_name, rules, values, resolution, invert=invert)
    with compilation_announced(quiet):
        inflated = grid.inflated(robot_radius, strict=strict_radius)
        field = collected(grid, cost or (), keepout or (), speed or ())
        warmup(chosen, turns=turning > 0)
    watch = CountWatch("queries", quiet)
    begin = time.perf_counter()

    def work(cancel: threading.Event, pool: Executor | None, count: int) -> Counter[str]:
        ask = partial(
            solve_many,
            algorithm=chosen,
            grid=inflated,
            cells=cells,
            corner_rule=corner_rule,
            allow_unknown=allow_unknown,
            goal_tolerance=goal_tolerance,
            start_tolerance=start_tolerance,
            cost=field,
            turning=turning,
            seed=seed,
            stop=stop,
            executor=pool,
            workers=count,
            optimum=optimum,
            errors="return",
            cancel=cancel,
        )
        done: Counter[str] = Counter()
        with _writer(target) as writer:
            for row, answer in answered(read_rows(pairs).rows, ask):
                record = Record.of(row, answer)
                writer.write(record)
                done[record.status] += 1
                if isinstance(answer, AntnavError) and done["error"] <= MOST_TOLD:
                    complain(f"{pairs}, line {row.line}: {answer}")
                watch.count(done.total(), total)
        return done

    with _engine(executor, workers) as (pool, count):
        done, interrupted = run_interruptibly(lambda cancel: work(cancel, pool, count), watch)
    seconds = time.perf_counter() - begin
    bad, found = done["error"], done[Status.FOUND.value]
    if bad > MOST_TOLD:
        complain(f"{pairs}: {bad - MOST_TOLD} more rows are no queries: see the error of each in the output")
    if interrupted:
        complain(f"interrupted after {done.total()} of {total} rows{f'; {target} has them' if target else ''}", kind="")
        return INTERRUPTED
    if target is not None and not quiet:
        names = {name: "bad row" + "s" * (bad > 1) if name == "error" else name.replace("_", " ") for name in done}
        lost = ", ".join(f"{count} {names[name]}" for name, count in sorted(done.items()) if name != Status.FOUND)
        rate = f"{seconds:.3f}, {done.total() / seconds:.0f} a second, workers: {count}"
        table = [("rows", f"{done.total()}, {found} with a path{lost and f'; {lost}'}"), ("seconds", rate)]
        say_rows([*table, ("algorithm", f"{chosen.outline}, seed {seed}"), ("saved", str(target))])
    return BAD_ROWS if bad else FOUND if found == total else NO_PATH


@contextlib.contextmanager
def _engine(executor: str | None, workers: int | None) -> Iterator[tuple[Executor | None, int]]:
    """Who plans the rows; None: as many processes, or for one this one."""
    if executor is None:
        yield None, workers or 1
        return
    with engine(executor, workers) as (pool, count), executor_for(count) or Serial() as threads:
        yield pool or threads, count


@contextlib.contextmanager
def _writer(target: Path | None) -> Iterator[Writer]:
    if target is None:
        yield _Printed(sys.stdout.buffer if sys.stdout else io.BytesIO())
        return
    with writing_whole(target) as stream, writer_for(target, stream) as writer:
        yield writer


class _Printed(JsonLines):
    """Each line at once, for whoever reads along."""

    def write(self, record: Record) -> None:
        super().write(record)
        self._stream.flush()
