"""`antnav pareto`: paths that no other beats, for goals that conflict."""

from __future__ import annotations

import threading
from dataclasses import replace
from pathlib import Path
from typing import Annotated

import msgspec
import typer

from antnav.cli.inputs import Invert, MapName, RulesOption, ValuesOption
from antnav.cli.query import (
    AllowUnknown,
    Cells,
    Corners,
    Goal,
    GoalTolerance,
    Json,
    Keepout,
    Quiet,
    Resolution,
    RobotRadius,
    Seed,
    Start,
    StartTolerance,
    StrictRadius,
    TimeLimit,
    Workers,
    check_radius,
    ends_of,
    map_of,
)
from antnav.cli.running import CountWatch, compilation_announced, run_interruptibly
from antnav.cli.saving import ENDINGS, check_outputs, save_all
from antnav.cli.terminal import FOUND, INTERRUPTED, NO_PATH, say, say_rows, say_table
from antnav.costs.named import collected as collected_costs
from antnav.fronts.front import Front
from antnav.fronts.pareto import METHODS, warmup
from antnav.fronts.pareto import pareto as find_front
from antnav.objectives.named import FORMS, collected
from antnav.planner.plan import Status
from antnav.run.spmd import executor_for
from antnav.run.stop import Seconds
from antnav.values import check_seed
from antnav.world.moves import CornerRule
from antnav.world.problem import Problem

#: Rows of the table that a person is shown; files have all.
SHOWN = 40


def pareto(
    map_name: MapName,
    objective: Annotated[
        list[str] | None,
        typer.Option(
            metavar="KIND",
            help=f"What is to be small: {FORMS}. Two to six times; default: length and risk:clearance:0.5.",
        ),
    ] = None,
    start: Start = None,
    goal: Goal = None,
    cells: Cells = False,
    method: Annotated[
        str, typer.Option(metavar="NAME", help=f"One of {', '.join(METHODS)}: see `antnav algorithms`.")
    ] = "auto",
    corner_rule: Corners = CornerRule.FORBID,
    robot_radius: RobotRadius = 0.0,
    strict_radius: StrictRadius = False,
    resolution: Resolution = None,
    allow_unknown: AllowUnknown = False,
    goal_tolerance: GoalTolerance = 0.0,
    start_tolerance: StartTolerance = 0.0,
    keepout: Keepout = None,
    seed: Seed = 0,
    time_limit: TimeLimit = None,
    workers: Workers = None,
    rules: RulesOption = "nav2",
    values: ValuesOption = "cells",
    invert: Invert = False,
    output: Annotated[
        list[str] | None,
        typer.Option("-o", "--output", metavar="FILE", help=f"Save as {', '.join(ENDINGS)}. Repeatable."),
    ] = None,
    json: Json = False,
    quiet: Quiet = False,
) -> int:
    """Find the paths that no other path beats in all of several objectives.

    antnav pareto warehouse --objective length --objective risk:clearance:1 -o front.png -o front.json

    Ctrl-C ends the search with the paths found so far; a second Ctrl-C leaves at once.
    """
    outputs = [Path(name) for name in output or []]
    check_outputs(outputs, map_name)
    executor = executor_for(workers)
    stop = Seconds(time_limit) if time_limit is not None else None
    check_seed(seed)
    check_radius(robot_radius, strict=strict_radius)
    grid = map_of(map_name, rules, values, resolution, invert=invert)
    ends = ends_of(map_name, grid, start, goal, cells=cells)
    with compilation_announced(quiet, "front_kernels.weighted"):
        inflated = grid.inflated(robot_radius, strict=strict_radius)
        field = collected_costs(grid, (), keepout or (), ())
        problem = Problem(inflated, *ends, corner_rule, allow_unknown, goal_tolerance, start_tolerance, field)
        objectives = collected(objective or ["length", "risk:clearance:0.5"], problem.grid)
        seconds_compile = warmup(method)

    def search(cancel: threading.Event) -> Front:
        return find_front(problem, objectives, algorithm=method, seed=seed, stop=stop, executor=executor, cancel=cancel)

    watch = CountWatch("paths", quiet)
    watch.on_interrupt = "taking the paths found so far"
    front, interrupted = run_interruptibly(search, watch)
    front = replace(front, seconds_compile=seconds_compile)
    saved, failure = save_all(front, outputs)
    if json:
        say(msgspec.json.encode(front.to_dict(map_cells=False)).decode())
    elif not quiet:
        say_rows([*front.account, *(("saved", str(path)) for path in saved)])
        header, *rows = front.table
        shown = [row for number, row in enumerate(rows) if number < SHOWN or row[-1]]  # the knee always
        say_table(header, shown, [True] * (len(header) - 1) + [False])
        if len(rows) > len(shown):
            say(f"... {len(rows) - len(shown)} more; -o front.csv has all")
    if failure:
        raise failure
    if interrupted:
        return INTERRUPTED
    return FOUND if front.status is Status.FOUND else NO_PATH
