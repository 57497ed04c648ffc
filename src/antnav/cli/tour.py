"""`antnav tour`: one trip to many stops."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import msgspec
import typer

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
)
from antnav.cli.inputs import Invert, MapName, RulesOption, ValuesOption, cell_point, point
from antnav.cli.query import (
    AllowUnknown,
    Cells,
    Corners,
    Cost,
    GoalTolerance,
    Json,
    Keepout,
    Quiet,
    Resolution,
    RobotRadius,
    Seed,
    Speed,
    StartTolerance,
    TimeLimit,
    Turning,
    map_of,
)
from antnav.cli.running import compilation_announced
from antnav.cli.saving import ENDINGS, check_outputs, write_all
from antnav.cli.terminal import FOUND, NO_PATH, say, say_rows
from antnav.costs.named import collected
from antnav.errors import ParameterError
from antnav.plan.algorithms import algorithm as planner_named
from antnav.plan.warmup import warmup
from antnav.planner.plan import Status
from antnav.run.stop import Seconds
from antnav.tours.order import METHODS
from antnav.tours.stops import read_stops
from antnav.tours.tour import prepare
from antnav.tours.tour import tour as find_tour
from antnav.trajectories.files import ENDINGS as TRAJECTORIES
from antnav.world.grid import GridMap
from antnav.world.moves import CornerRule
from antnav.world.path import check_cost, check_path
from antnav.world.problem import Point

if TYPE_CHECKING:
    from antnav.tours.model import Tour
    from antnav.trajectories.model import Trajectory


def tour(
    map_name: MapName,
    start: Annotated[str | None, typer.Option(metavar="X,Y", help="Start in metres.")] = None,
    stop: Annotated[list[str] | None, typer.Option(metavar="X,Y", help="A stop in metres. Repeatable.")] = None,
    stops: Annotated[
        str | None,
        typer.Option(
            metavar="FILE", help="Stops of a .csv file with columns x and y, or row and col, after each --stop."
        ),
    ] = None,
    cells: Cells = False,
    order: Annotated[str, typer.Option(metavar="best|given", help="Of the stops.")] = "best",
    back: Annotated[bool, typer.Option("--return", help="End at the start; else at the last stop.")] = False,
    method: Annotated[
        str, typer.Option(metavar="NAME", help=f"How the order is found: auto, {', '.join(METHODS)}.")
    ] = "auto",
    algorithm: Annotated[
        str, typer.Option(metavar="NAME", help="Of each leg: see `antnav algorithms`. The order is by exact distances.")
    ] = "astar",
    corner_rule: Corners = CornerRule.FORBID,
    robot_radius: RobotRadius = 0.0,
    margin: Annotated[float, typer.Option(metavar="METRES", help="To keep beyond the robot's radius.")] = 0.0,
    resolution: Resolution = None,
    allow_unknown: AllowUnknown = False,
    goal_tolerance: GoalTolerance = 0.0,
    start_tolerance: StartTolerance = 0.0,
    cost: Cost = None,
    keepout: Keepout = None,
    speed: Speed = None,
    turning: Turning = 0.0,
    seed: Seed = 0,
    time_limit: TimeLimit = None,
    trajectory: Annotated[
        str | None,
        typer.Option(metavar="FILE", help=f"Save one curve to drive through all stops, as {', '.join(TRAJECTORIES)}."),
    ] = None,
    spacing: Spacing = None,
    max_curvature: MaxCurvature = None,
    start_heading: StartHeading = None,
    goal_heading: GoalHeading = None,
    max_speed: MaxSpeed = None,
    max_acceleration: MaxAcceleration = None,
    max_lateral_acceleration: MaxLateralAcceleration = None,
    max_angular_speed: MaxAngularSpeed = None,
    rules: RulesOption = "nav2",
    values: ValuesOption = "cells",
    invert: Invert = False,
    check: Annotated[
        bool, typer.Option("--check", help="Verify each move of each leg by code that the planners do not use.")
    ] = False,
    output: Annotated[
        list[str] | None,
        typer.Option("-o", "--output", metavar="FILE", help=f"Save as {', '.join(ENDINGS)}. Repeatable."),
    ] = None,
    json: Json = False,
    quiet: Quiet = False,
) -> int:
    """Plan one trip to many stops, in the best order; radius and margin are kept to walls' edges.

    antnav tour depot.yaml --start 2,2 --stop 28,13 --stop 12,5 --stop 4,12 --return --robot-radius 0.2 -o tour.png

    antnav tour warehouse --start 1,1 --stops stops.csv --robot-radius 0.25 --trajectory drive.csv
    """
    outputs = [Path(name) for name in output or []]
    check_outputs(outputs, map_name)
    planner = planner_named(algorithm)
    kept = margin if trajectory else None
    limits = max_speed, max_acceleration, max_lateral_acceleration, max_angular_speed
    drive = Drive.of(trajectory, spacing, kept, max_curvature, start_heading, goal_heading, *limits, alone=True)
    if drive:
        drive.check(map_name, outputs)
    grid = map_of(map_name, rules, values, resolution, invert=invert)
    places = _places(grid, start, stop or [], stops, cells=cells)
    with compilation_announced(quiet):
        field = collected(grid, cost or (), keepout or (), speed or ())
        seconds_compile = warmup(planner, turns=turning > 0) + prepare()
    found = find_tour(
        grid,
        places[0],
        places[1:],
        order,  # type: ignore[arg-type] # which it checks
        back,
        radius=robot_radius,
        margin=margin,
        corner_rule=corner_rule,
        allow_unknown=allow_unknown,
        goal_tolerance=goal_tolerance,
        start_tolerance=start_tolerance,
        cost=field,
        turning=turning,
        method=method,  # type: ignore[arg-type]
        algorithm=planner,
        seed=seed,
        stop=None if time_limit is None else Seconds(time_limit),
    )
    found = replace(found, seconds_compile=seconds_compile)
    for leg in found.legs if check else ():
        if leg.path:
            check_path(leg.path, leg.problem)
            check_cost(leg.path, leg.problem, leg.cost)
    driven, failure = drive.along(found, robot_radius) if drive else (None, None)
    saved, unsaved = write_all(outputs, found.save, partial(_draw, found, driven))
    failure = failure or unsaved
    checked = check and found.path is not None
    if json:
        told = found.to_dict() | {"checked": checked}
        told |= {} if driven is None else {"trajectory": driven.to_dict()}
        say(msgspec.json.encode(told).decode())
    elif not quiet:
        rows = found.table + [("checked", "every move of each leg is legal, and costs are right")] * checked
        rows += [("saved", str(path)) for path in saved]
        say_rows(rows + (drive.rows(driven) if drive and driven else []))
    if failure:
        raise failure
    return FOUND if found.status is Status.FOUND else NO_PATH


def _places(grid: GridMap, start: str | None, stop: Sequence[str], file: str | None, *, cells: bool) -> list[Point]:
    """The start and all stops in metres."""
    if start is None:
        raise ParameterError("no --start", "a tour begins somewhere", "give --start X,Y in metres")
    given = [("start", start), *(("stop", text) for text in stop)]
    places = [cell_point(name, text, grid) if cells else point(name, text) for name, text in given]
    if file is not None:
        read = read_stops(file)
        places += [cell_point("stops", f"{row},{col}", grid) for row, col in read.places] if read.cells else read.places
    return places


def _draw(found: Tour, trajectory: Trajectory | None, path: Path) -> None:
    from antnav.plot.tours import save_tour

    save_tour(found, path, trajectory=trajectory)
