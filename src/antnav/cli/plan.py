"""`antnav plan`: a path on a map."""

from __future__ import annotations

import math
import threading
from collections.abc import Sequence
from dataclasses import replace
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import msgspec
import typer

from antnav.ants.presets import PRESETS
from antnav.cli.advice import why_no_path
from antnav.cli.alternatives import SEVERAL, several
from antnav.cli.driving import (
    Drive,
    GoalHeading,
    MaxAcceleration,
    MaxAngularSpeed,
    MaxCurvature,
    MaxLateralAcceleration,
    MaxSpeed,
    Spacing,
    StartHeading,
    outline_of,
)
from antnav.cli.inputs import (
    Invert,
    MapName,
    RulesOption,
    ValuesOption,
)
from antnav.cli.query import (
    AllowUnknown,
    Cells,
    Corners,
    Cost,
    Goal,
    GoalTolerance,
    Json,
    Keepout,
    Quiet,
    Resolution,
    RobotRadius,
    Seed,
    Set,
    Speed,
    Start,
    StartTolerance,
    StrictRadius,
    TimeLimit,
    Turning,
    Workers,
    check_radius,
    ends_of,
    map_of,
    planner_of,
)
from antnav.cli.running import Watch, compilation_announced, run_interruptibly
from antnav.cli.saving import PATH_ENDINGS, check_films, check_outputs, import_for_pictures, save_all
from antnav.cli.terminal import FOUND, INTERRUPTED, NO_PATH, say, say_rows
from antnav.colony.parts import Axis, Heuristic
from antnav.costs.named import collected
from antnav.errors import ParameterError
from antnav.plan.algorithms import EXACT
from antnav.plan.solve import solve
from antnav.plan.warmup import warmup
from antnav.planner import nav2
from antnav.planner.plan import Status
from antnav.planner.result import Result
from antnav.run.spmd import executor_for
from antnav.run.stop import Seconds
from antnav.search import exact
from antnav.trajectories.files import ENDINGS as TRAJECTORIES
from antnav.values import check_seed
from antnav.world.moves import CornerRule
from antnav.world.path import check_cost, check_path
from antnav.world.problem import Problem

if TYPE_CHECKING:
    from antnav.trajectories.model import Trajectory

DEFAULT = "paco"


class Picture(StrEnum):
    """What a picture shows.

    - both: the map with the path, and the convergence beside it.
    - map: the map with the path alone.
    """

    BOTH = "both"
    MAP = "map"


def plan(
    map_name: MapName,
    start: Start = None,
    goal: Goal = None,
    cells: Cells = False,
    algorithm: Annotated[
        str | None,
        typer.Option(
            metavar="NAME",
            show_default=DEFAULT,
            help=f"One of {', '.join((*PRESETS, *EXACT))}, or a rival: see `antnav algorithms`. "
            "Where only the path counts and cost is length, jps is the fastest.",
        ),
    ] = None,
    corner_rule: Corners = CornerRule.FORBID,
    robot_radius: RobotRadius = 0.0,
    strict_radius: StrictRadius = False,
    resolution: Resolution = None,
    allow_unknown: AllowUnknown = False,
    goal_tolerance: GoalTolerance = 0.0,
    start_tolerance: StartTolerance = 0.0,
    cost: Cost = None,
    keepout: Keepout = None,
    speed: Speed = None,
    turning: Turning = 0.0,
    seed: Seed = 0,
    ants: Annotated[int | None, typer.Option(help="Ants an iteration; default: the algorithm's, 50 of most.")] = None,
    iterations: Annotated[int | None, typer.Option(help="Iterations; default: the algorithm's, 50 of most.")] = None,
    heuristic: Annotated[
        str | None,
        typer.Option(
            metavar="|".join(Heuristic), help="What draws the ants, or one of your own; default: the algorithm's."
        ),
    ] = None,
    axis: Annotated[Axis | None, typer.Option(help="Line on which PACO divides the map; default: auto.")] = None,
    settings: Set = None,
    straighten: Annotated[
        bool, typer.Option(help="Turn as seldom as the path's moves allow, at the same length, or show the raw path.")
    ] = True,
    time_limit: TimeLimit = None,
    workers: Workers = None,
    alternatives: Annotated[
        int | None,
        typer.Option(
            metavar="K", help="K routes that truly differ: exact ones, or of the --algorithm, if it is given."
        ),
    ] = None,
    least_difference: Annotated[
        float,
        typer.Option(
            metavar="SHARE", help="With --alternatives: least share of a route that runs along no cheaper one."
        ),
    ] = 0.3,
    longest: Annotated[
        float, typer.Option(metavar="FACTOR", help="With --alternatives: cost of the dearest route, in optima.")
    ] = 1.5,
    trajectory: Annotated[
        str | None,
        typer.Option(
            metavar="FILE",
            help=f"Save a curve to drive as {', '.join(TRAJECTORIES)}; radius and margin are then kept strictly, and "
            "planned with.",
        ),
    ] = None,
    spacing: Spacing = None,
    margin: Annotated[
        float | None, typer.Option(metavar="METRES", help="With --trajectory: to keep beyond the robot's radius [0].")
    ] = None,
    max_curvature: MaxCurvature = None,
    start_heading: StartHeading = None,
    goal_heading: GoalHeading = None,
    footprint: Annotated[
        str | None,
        typer.Option(
            metavar="POINTS", help="With --trajectory: a robot that is no disc, as nav2's: [[x,y],...] in metres."
        ),
    ] = None,
    footprint_padding: Annotated[
        float | None, typer.Option(metavar="METRES", help="With --footprint: added to each corner, as nav2 does [0].")
    ] = None,
    max_speed: MaxSpeed = None,
    max_acceleration: MaxAcceleration = None,
    max_lateral_acceleration: MaxLateralAcceleration = None,
    max_angular_speed: MaxAngularSpeed = None,
    rules: RulesOption = "nav2",
    values: ValuesOption = "cells",
    invert: Invert = False,
    check: Annotated[
        bool, typer.Option("--check", help="Verify each move of the path by code that the planners do not use.")
    ] = False,
    output: Annotated[
        list[str] | None,
        typer.Option("-o", "--output", metavar="FILE", help=f"Save as {', '.join(PATH_ENDINGS)}. Repeatable."),
    ] = None,
    picture: Annotated[
        Picture, typer.Option(help="What pictures show: map and convergence, or the map alone.")
    ] = Picture.BOTH,
    json: Json = False,
    quiet: Quiet = False,
) -> int:
    """Plan a path with ants, and tell how much longer it is than the shortest on the grid's eight directions.

    antnav plan warehouse --robot-radius 0.25 -o plan.png -o plan.json

    antnav plan office.yaml --start -1.5,2 --goal 18.5,9 --robot-radius 0.2

    Ctrl-C ends the search with the best path so far; a second Ctrl-C leaves at once.
    """
    outputs = [Path(name) for name in output or []]
    check_outputs(outputs, map_name, PATH_ENDINGS if alternatives is None else SEVERAL)
    options = {"ants": ants, "iterations": iterations, "heuristic": heuristic, "axis": axis}
    options |= {"straighten": None if straighten else False}
    chosen = planner_of(algorithm or DEFAULT, settings, **options)
    composed = settings or any(value is not None for value in options.values())
    check_films(outputs, chosen)
    executor = executor_for(workers)
    stop = Seconds(time_limit) if time_limit is not None else None
    check_seed(seed)
    if alternatives is None and (least_difference, longest) != (0.3, 1.5):
        raise ParameterError("--least-difference or --longest", "they are of --alternatives", "give --alternatives K")
    check_radius(robot_radius, strict=strict_radius)
    limits = max_speed, max_acceleration, max_lateral_acceleration, max_angular_speed
    outline = outline_of(footprint, footprint_padding, robot_radius, driven=trajectory is not None)
    robot_radius = outline.inscribed if outline else robot_radius
    drive = Drive.of(
        trajectory, spacing, margin, max_curvature, start_heading, goal_heading, *limits, alone=alternatives is None
    )
    if drive:
        drive.check(map_name, outputs)
        strict_radius, margin_m = True, drive.margin
    else:
        margin_m = 0.0

    grid = map_of(map_name, rules, values, resolution, invert=invert)
    ends = ends_of(map_name, grid, start, goal, cells=cells)
    import_for_pictures(outputs)
    with compilation_announced(quiet):
        inflated = grid.inflated(robot_radius + margin_m, strict=strict_radius)
        field = collected(grid, cost or (), keepout or (), speed or ())
        problem = Problem(inflated, *ends, corner_rule, allow_unknown, goal_tolerance, start_tolerance, field, turning)
        seconds_compile = 0.0 if alternatives is not None else warmup(chosen, turns=turning > 0)
    if alternatives is not None:
        return several(
            problem,
            alternatives,
            chosen if algorithm or composed else None,
            grid,
            robot_radius,
            outputs,
            strict=strict_radius,
            check=check,
            json=json,
            quiet=quiet,
            least_difference=least_difference,
            longest=longest,
            seed=seed,
            stop=stop,
            executor=executor,
        )

    watch = Watch(chosen.name, time_limit, quiet)

    def search(cancel: threading.Event) -> Result:
        watch.optimum = exact.optimum(problem).cost
        return solve(problem, chosen, seed=seed, stop=stop, executor=executor, cancel=cancel, events=watch.hear)

    result, interrupted = run_interruptibly(search, watch)
    result = replace(result, seconds_compile=seconds_compile)
    if check and result.path:
        check_path(result.path, problem)
        check_cost(result.path, problem, result.cost)
    advice = (
        []
        if result.path
        else why_no_path(result, grid, robot_radius, margin=margin_m, outline=outline is not None, strict=strict_radius)
    )
    advised = replace(result, notes=(*result.notes, *(text for _, text in advice)))
    with compilation_announced(quiet or not drive):
        driven, failure = drive.along(result, robot_radius, outline) if drive else (None, None)
    saved, unsaved = save_all(advised, outputs, driven, picture.value)
    failure = failure or unsaved
    if json:
        say(_json(advised, robot_radius, driven, checked=check and result.path is not None))
    elif not quiet:
        rows = _rows(result, robot_radius, advice, saved, strict=strict_radius, checked=check)
        say_rows(rows + (drive.rows(driven) if drive and driven else []))
    if failure:
        raise failure
    if interrupted:
        return INTERRUPTED
    return FOUND if result.status is Status.FOUND else NO_PATH


def _margin(result: Result, radius: float) -> float | None:
    """Metres that the path leaves between the robot's body and the walls; None without a radius, path or wall."""
    known = result.path is not None and radius > 0 and math.isfinite(result.path.wall_distance)
    return result.path.wall_distance - radius if known and result.path else None


def _json(result: Result, radius: float, driven: Trajectory | None, *, checked: bool) -> str:
    document = result.to_dict(map_cells=False)
    del document["history"]
    document["nav2_code"] = nav2.code_of(result)
    margin = _margin(result, radius)
    document |= {"robot_radius": radius, "margin_m": margin, "checked": checked}
    if driven is not None:
        document["trajectory"] = driven.to_dict()
    return msgspec.json.encode(document).decode()


def _rows(
    result: Result,
    radius: float,
    advice: Sequence[tuple[str, str]],
    outputs: Sequence[Path],
    *,
    strict: bool,
    checked: bool,
) -> list[tuple[str, str]]:
    status, *others = result.table
    rows = [status, *advice, *others]
    margin = _margin(result, radius)
    if margin is not None:
        body = f"between walls and a robot of radius {radius:g} m"
        why = "an end lies off the centre of its cell, or a corner is passed" if strict else ""
        touching = f"; {why or '--strict-radius keeps the whole radius'}" if margin < 0 else ""
        rows.insert([name for name, _ in rows].index("clearance") + 1, ("margin", f"{margin:.3f} m {body}{touching}"))
    if checked and result.path:
        rows.append(("checked", "every move of the path is legal, and its length and cost are right"))
    return rows + [("saved", str(path)) for path in outputs]
