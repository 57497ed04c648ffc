"""What queries have in common: the options that say which map, from where to where, for which robot."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Annotated, Any

import typer

from antnav.cli.inputs import cell_point, centre, point, read_map
from antnav.errors import ParameterError
from antnav.maps import builtin_names, builtin_query
from antnav.plan.algorithms import algorithm
from antnav.planner.planner import Planner
from antnav.world.grid import GridMap
from antnav.world.moves import CornerRule
from antnav.world.problem import Point

Start = Annotated[str | None, typer.Option(metavar="X,Y", help="Start in metres. A built-in map has a default.")]
Goal = Annotated[str | None, typer.Option(metavar="X,Y", help="Goal in metres. A built-in map has a default.")]
Cells = Annotated[
    bool, typer.Option("--cells", help="Start and goal are ROW,COL, from 0,0 at the top left, instead of metres.")
]
Corners = Annotated[
    CornerRule,
    typer.Option(help="Diagonal moves past obstacles: forbid, graze one, or allow between two (the paper's)."),
]
RobotRadius = Annotated[float, typer.Option(metavar="METRES", help="Keep farther than this from occupied cells.")]
StrictRadius = Annotated[
    bool,
    typer.Option(
        "--strict-radius/--nav2-radius",
        help="Measure the robot's radius to the walls' edges, or as nav2 does, from centre to centre of cells.",
    ),
]
Resolution = Annotated[
    float | None,
    typer.Option(metavar="METRES", help="Side of a cell, for maps that do not say it, such as bare images [1]."),
]
AllowUnknown = Annotated[bool, typer.Option("--allow-unknown", help="The robot may cross unknown cells.")]
GoalTolerance = Annotated[
    float,
    typer.Option(metavar="METRES", help="Where the goal cannot be reached, take the nearest cell within this."),
]
StartTolerance = Annotated[
    float,
    typer.Option(metavar="METRES", help="Where the start is not free, take the nearest free cell within this."),
]
Keepout = Annotated[
    list[str] | None, typer.Option(metavar="MASK", help="Close the cells of a keep-out mask (map_server YAML).")
]
Cost = Annotated[
    list[str] | None,
    typer.Option(
        metavar="KIND:NUMBERS",
        help="Keep off walls: clearance:METRES[:WEIGHT], or inflation:RADIUS:SCALING:INSCRIBED[:WEIGHT]. Climb "
        "little: slope:FILE:UP[:DOWN], heights in metres and the cost of one.",
    ),
]
Speed = Annotated[
    list[str] | None,
    typer.Option(metavar="MASK", help="Slow zones of a speed mask, as nav2 reads it: cost is time."),
]
Turning = Annotated[float, typer.Option(metavar="CELLS", help="What a turn by one radian costs.")]
Seed = Annotated[int, typer.Option(help="Same seed, same path, whatever the number of workers.")]
TimeLimit = Annotated[
    float | None, typer.Option(metavar="SECONDS", help="Stop then, with the best so far. Results then vary.")
]
Workers = Annotated[int | None, typer.Option(help="Threads; default: one for each core.")]
Json = Annotated[bool, typer.Option("--json", help="Print one JSON object on stdout and nothing else.")]
Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="No progress and no table; errors only.")]

Set = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="NAME=VALUE",
        help="Any parameter of the algorithm, such as pheromone=max_min or beta=5; `antnav algorithms NAME` lists "
        "them. Repeatable.",
    ),
]


def planner_of(name: str, settings: Sequence[str] | None, **options: Any) -> Planner:
    """The planner of that name, with what `--set` and options of their own say of it; those that are None say nothing.

    Raises
    ------
    ParameterError
        A setting is none, or stands twice; the planner does not have it, or it is out of range.
    """
    return algorithm(name, **choices_of(settings, **options))


def choices_of(settings: Sequence[str] | None, **options: Any) -> dict[str, Any]:
    """What `--set` and these options say; those that are None say nothing.

    Raises
    ------
    ParameterError
        A setting is none, or stands twice.
    """
    choices = {key: value for key, value in options.items() if value is not None}
    for text in settings or ():
        key, sign, value = text.partition("=")
        if not sign or not key:
            raise ParameterError(f"--set {text!r}", "it is NAME=VALUE", "write it like --set beta=5")
        if key in choices:
            raise ParameterError(f"--set {text!r}", f"{key} is given twice", "leave one of them out")
        choices[key] = _value(value)
    return choices


def _value(text: str) -> Any:
    """A truth, a number or a text, as TOML has them; none stands for None."""
    words = {"true": True, "false": False, "none": None}
    if text in words:
        return words[text]
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return text


def check_radius(radius: float, *, strict: bool) -> None:
    """Refuse a way to measure the robot's radius where there is none.

    Raises
    ------
    ParameterError
    """
    if strict and not radius:
        remedy = "give a --robot-radius above 0, or leave it out"
        raise ParameterError("--strict-radius", "it says how the robot's radius is measured", remedy)


def map_of(name: str, rules: str, values: str, resolution: float | None, *, invert: bool) -> GridMap:
    """The map of a query, see `inputs.read_map`, with another side of its cells where one is given."""
    grid = read_map(name, rules, values, invert)
    return grid if resolution is None else replace(grid, resolution=resolution)


def ends_of(map_name: str, grid: GridMap, start: str | None, goal: str | None, *, cells: bool) -> tuple[Point, Point]:
    """Start and goal in metres, as given or as they belong to a built-in map."""
    defaults = builtin_query(map_name) if map_name in builtin_names() else (None, None)
    points = []
    for name, text, default in (("start", start, defaults[0]), ("goal", goal, defaults[1])):
        if text is not None:
            points.append(cell_point(name, text, grid) if cells else point(name, text))
        elif default is not None:
            points.append(centre(grid, default))
        else:
            raise ParameterError(
                f"no --{name}",
                "a map from a file needs a start and a goal",
                f"give --{name} X,Y in metres, or --cells --{name} ROW,COL; `antnav maps show` tells the map's extent",
            )
    return points[0], points[1]
