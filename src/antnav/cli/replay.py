"""`antnav replay`: a robot in a scenario, with any replanner."""

from __future__ import annotations

import math
import threading
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Annotated

import msgspec
import typer

from antnav.cli.inputs import Invert, MapName, RulesOption, ValuesOption, check_output
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
    Start,
    StartTolerance,
    ends_of,
    map_of,
)
from antnav.cli.running import CountWatch, compilation_announced, run_interruptibly
from antnav.cli.saving import PICTURES, check_outputs, write_all
from antnav.cli.terminal import FOUND, INTERRUPTED, NO_PATH, complain, say, say_table
from antnav.costs.named import collected
from antnav.errors import ParameterError
from antnav.live.methods import METHODS, replanner
from antnav.live.update import MissionStatus
from antnav.plan.algorithms import short_name
from antnav.scenarios.comparison import HEADS, rows
from antnav.scenarios.model import Replay, save_ticks
from antnav.scenarios.named import FORMS, named
from antnav.scenarios.replay import prepare
from antnav.scenarios.scenario import Scenario
from antnav.scenarios.side_by_side import replays
from antnav.world.grid import GridMap
from antnav.world.moves import CornerRule
from antnav.world.problem import Problem

#: Endings of outputs: ticks, the scenario itself, films, pictures.
FILMS = (".html", ".gif")
ENDINGS = (".csv", ".json", *FILMS, *PICTURES)


def replay(
    map_name: MapName,
    scenario: Annotated[
        str,
        typer.Option(metavar="TEXT|FILE", help=f"What happens: {FORMS}. Or a saved scenario, FILE.json."),
    ] = "people:20",
    start: Start = None,
    goal: Goal = None,
    cells: Cells = False,
    algorithm: Annotated[
        str, typer.Option(metavar="NAME,...", help=f"Replanners, of {', '.join(METHODS)}, or algorithms of your own.")
    ] = "regions",
    ticks: Annotated[
        int | None,
        typer.Option(show_default="twice what the way takes", help="When it ends, if the robot has not arrived."),
    ] = None,
    speed: Annotated[int, typer.Option(help="Moves from cell to cell that the robot makes in a tick.")] = 1,
    improve: Annotated[
        int, typer.Option(help="Rounds of improvement after each change, for replanners that do so.")
    ] = 1,
    seed: Annotated[int, typer.Option(help="Same seed, same scenario.")] = 0,
    corner_rule: Corners = CornerRule.FORBID,
    robot_radius: RobotRadius = 0.0,
    resolution: Resolution = None,
    allow_unknown: AllowUnknown = False,
    goal_tolerance: GoalTolerance = 0.0,
    start_tolerance: StartTolerance = 0.0,
    cost: Annotated[
        list[str] | None, typer.Option(metavar="KIND:NUMBERS", help="Costs at rest, as `antnav plan` takes them.")
    ] = None,
    keepout: Keepout = None,
    workers: Annotated[
        int, typer.Option(min=1, help="Replanners side by side, each in a process; the same replays.")
    ] = 1,
    check: Annotated[
        bool, typer.Option("--check", help="Check every plan and verdict on a map made anew: slow, and times grow.")
    ] = False,
    save_scenario: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Save the scenario as .json, for anybody to replay.")
    ] = None,
    rules: RulesOption = "nav2",
    values: ValuesOption = "cells",
    invert: Invert = False,
    output: Annotated[
        list[str] | None,
        typer.Option(
            "-o",
            "--output",
            metavar="FILE",
            help="Save a film as .html or .gif, a picture as .png, .svg or .pdf, the ticks as .csv, "
            "the scenario as .json. Repeatable.",
        ),
    ] = None,
    json: Json = False,
    quiet: Quiet = False,
) -> int:
    """Drive a robot through a map that changes, and tell how long replanning took and how far it drove.

    antnav replay warehouse --scenario people:20 --seed 3 --robot-radius 0.25 -o film.html -o ticks.csv

    Times are CPU milliseconds of a replan. The optimum is that of the map at rest. Ctrl-C ends with the ticks so far.
    """
    outputs = [Path(name) for name in output or []]
    check_outputs(outputs, map_name, ENDINGS)
    if save_scenario is not None:
        check_output(save_scenario, (".json",))
        outputs.append(save_scenario)
    names = list(dict.fromkeys(name.strip() for name in algorithm.split(",")))
    for name in names:
        replanner(name)
    names = [short_name(name) for name in names]
    grid = map_of(map_name, rules, values, resolution, invert=invert)
    with compilation_announced(quiet, "grid_kernels.search"):
        if scenario.lower().endswith(".json"):
            drawn = Scenario.load(scenario)
            own: dict[str, object] = {"start": start, "goal": goal, "ticks": ticks, "cost": cost, "keepout": keepout}
            own |= {"seed": seed or None, "robot-radius": robot_radius or None}
            own |= {"speed": None if speed == 1 else speed, "allow-unknown": allow_unknown or None}
            own |= {"corner-rule": None if corner_rule is CornerRule.FORBID else corner_rule}
            own |= {"goal-tolerance": goal_tolerance or None, "start-tolerance": start_tolerance or None}
            given = ", ".join(f"--{name}" for name, value in own.items() if value is not None)
            if given:
                rule = "a saved scenario has its own"
                raise ParameterError(given, rule, "leave that out, or draw a scenario by its text")
            problem = _saved(drawn, grid)
        else:
            ends = ends_of(map_name, grid, start, goal, cells=cells)
            field = collected(grid, cost or (), keepout or (), ())
            inflated = grid.inflated(robot_radius)
            problem = Problem(inflated, *ends, corner_rule, allow_unknown, goal_tolerance, start_tolerance, field)
            problem = replace(problem, grid=grid, goal_tolerance=0.0, start_tolerance=0.0)
            drawn = named(scenario, problem, seed=seed, ticks=ticks, speed=speed, radius=robot_radius)
        for name in names:
            prepare(name)
    side_by_side = workers > 1 and len(names) > 1
    watch = CountWatch("replays" if side_by_side else "ticks", quiet)

    def drive(cancel: threading.Event) -> list[Replay]:
        return replays(
            problem,
            drawn,
            names,
            improve=improve,
            verify=check,
            workers=workers if side_by_side else 1,
            cancel=cancel,
            progress=watch.count,
        )

    found, interrupted = run_interruptibly(drive, watch)
    saved, failure = write_all(outputs, lambda path: _save(path, drawn, found), partial(_film, found))
    if json:
        say(msgspec.json.encode([one.to_dict() for one in found]).decode())
    elif not quiet:
        say_table(HEADS, rows(found), [False, *[True] * (len(HEADS) - 1)])
        for path in saved:
            say(f"saved {path}")
    for one in found:
        for text in one.failures[:3]:
            complain(f"{one.algorithm}, {text}")
        if not (one.arrived or interrupted) and one.ticks:
            complain(f"{one.algorithm} did not arrive: {_why(one)}")
    if failure:
        raise failure
    if interrupted:
        return INTERRUPTED
    return FOUND if all(one.arrived for one in found) else NO_PATH


def _why(one: Replay) -> str:
    """Why a robot is not at the goal."""
    if one.optimum == math.inf:
        return "at rest, no way leads to the goal; choose another, or give a --goal-tolerance or a smaller radius"
    told = {
        MissionStatus.START_BLOCKED: "its own cell is closed",
        MissionStatus.GOAL_BLOCKED: "the goal is closed; choose another, or give a --goal-tolerance",
        MissionStatus.UNREACHABLE: "no way leads to the goal when the scenario ends",
    }
    return told.get(one.ticks[-1].status, "the scenario ended before; give more --ticks")


def _saved(drawn: Scenario, grid: GridMap) -> Problem:
    """The problem of a scenario that was saved on this map."""
    if drawn.query.cost is not None and (drawn.query.map.rows, drawn.query.map.cols) == grid.shape:
        problem = drawn.problem()
        if problem.cost is None or problem.grid == grid.closed(problem.cost.blocked):
            return problem
    return drawn.problem(grid)


def _save(path: Path, drawn: Scenario, found: list[Replay]) -> None:
    if path.suffix.lower() == ".json":
        drawn.save(path)
    elif path.suffix.lower() in FILMS:
        _film(found, path)
    else:
        save_ticks(found, path)


def _film(found: list[Replay], path: Path) -> None:
    from antnav.plot.replay import save_film

    save_film([one for one in found if len(one)], path)
