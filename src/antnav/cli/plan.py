"""`antnav plan`: a path on a map."""

from __future__ import annotations

import math
import threading
from collections.abc import Sequence
from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path
from typing import Annotated

import msgspec
import typer

from antnav.ants.presets import PRESETS
from antnav.cli.advice import why_no_path
from antnav.cli.inputs import (
    Invert,
    MapName,
    RulesOption,
    ValuesOption,
    cell_point,
    centre,
    check_output,
    files_of_map,
    point,
    read_map,
)
from antnav.cli.running import Watch, compilation_announced, run_interruptibly
from antnav.cli.terminal import FOUND, INTERRUPTED, NO_PATH, say, say_rows
from antnav.colony.parts import Axis, Heuristic
from antnav.costs.named import collected
from antnav.errors import AntnavError, OutputError, ParameterError
from antnav.maps import builtin_names, builtin_query
from antnav.plan.algorithms import EXACT
from antnav.plan.algorithms import algorithm as planner_named
from antnav.plan.solve import solve
from antnav.plan.warmup import warmup
from antnav.planner import nav2
from antnav.planner.plan import Status
from antnav.planner.result import Result
from antnav.run.spmd import executor_for
from antnav.run.stop import Seconds
from antnav.search import exact
from antnav.values import check_seed
from antnav.world.grid import GridMap
from antnav.world.moves import CornerRule
from antnav.world.path import check_cost, check_path
from antnav.world.problem import Point, Problem

PICTURES = (".png", ".svg", ".pdf")
ENDINGS = (".json", ".csv", *PICTURES)


def plan(
    map_name: MapName,
    start: Annotated[
        str | None, typer.Option(metavar="X,Y", help="Start in metres. A built-in map has a default.")
    ] = None,
    goal: Annotated[
        str | None, typer.Option(metavar="X,Y", help="Goal in metres. A built-in map has a default.")
    ] = None,
    cells: Annotated[
        bool, typer.Option("--cells", help="Start and goal are ROW,COL, from 0,0 at the top left, instead of metres.")
    ] = False,
    algorithm: Annotated[
        str,
        typer.Option(
            metavar="NAME", help=f"One of {', '.join((*PRESETS, *EXACT))}, or a rival: see `antnav algorithms`."
        ),
    ] = "paco",
    corner_rule: Annotated[
        CornerRule,
        typer.Option(help="Diagonal moves past obstacles: forbid, graze one, or allow between two (the paper's)."),
    ] = CornerRule.FORBID,
    robot_radius: Annotated[
        float, typer.Option(metavar="METRES", help="Keep cell centres farther than this from occupied ones, as nav2.")
    ] = 0.0,
    strict_radius: Annotated[
        bool, typer.Option("--strict-radius", help="Measure the robot's radius to the walls' edges instead.")
    ] = False,
    resolution: Annotated[
        float | None,
        typer.Option(metavar="METRES", help="Side of a cell, for maps that do not say it, such as bare images [1]."),
    ] = None,
    allow_unknown: Annotated[bool, typer.Option("--allow-unknown", help="The robot may cross unknown cells.")] = False,
    goal_tolerance: Annotated[
        float,
        typer.Option(metavar="METRES", help="Where the goal cannot be reached, take the nearest cell within this."),
    ] = 0.0,
    start_tolerance: Annotated[
        float,
        typer.Option(metavar="METRES", help="Where the start is not free, take the nearest free cell within this."),
    ] = 0.0,
    cost: Annotated[
        list[str] | None,
        typer.Option(
            metavar="KIND:NUMBERS",
            help="Keep off walls: clearance:METRES[:WEIGHT], or inflation:RADIUS:SCALING:INSCRIBED[:WEIGHT].",
        ),
    ] = None,
    keepout: Annotated[
        list[str] | None, typer.Option(metavar="MASK", help="Close the cells of a keep-out mask (map_server YAML).")
    ] = None,
    speed: Annotated[
        list[str] | None,
        typer.Option(metavar="MASK", help="Slow zones of a speed mask, as nav2 reads it: cost is time."),
    ] = None,
    turning: Annotated[float, typer.Option(metavar="CELLS", help="What a turn by one radian costs.")] = 0.0,
    seed: Annotated[int, typer.Option(help="Same seed, same path, whatever the number of workers.")] = 0,
    ants: Annotated[int | None, typer.Option(help="Ants an iteration; default: the algorithm's, 50.")] = None,
    iterations: Annotated[int | None, typer.Option(help="Iterations; default: the algorithm's, 50.")] = None,
    heuristic: Annotated[Heuristic | None, typer.Option(help="What draws the ants; default: the algorithm's.")] = None,
    axis: Annotated[Axis | None, typer.Option(help="Line on which PACO divides the map; default: auto.")] = None,
    straighten: Annotated[
        bool, typer.Option(help="Turn as seldom as the path's moves allow, at the same length, or show the raw path.")
    ] = True,
    time_limit: Annotated[
        float | None, typer.Option(metavar="SECONDS", help="Stop then, with the best so far. Results then vary.")
    ] = None,
    workers: Annotated[int | None, typer.Option(help="Threads; default: one for each core.")] = None,
    rules: RulesOption = "nav2",
    values: ValuesOption = "cells",
    invert: Invert = False,
    check: Annotated[
        bool, typer.Option("--check", help="Verify each move of the path by code that the planners do not use.")
    ] = False,
    output: Annotated[
        list[str] | None,
        typer.Option("-o", "--output", metavar="FILE", help=f"Save as {', '.join(ENDINGS)}. Repeatable."),
    ] = None,
    json: Annotated[bool, typer.Option("--json", help="Print one JSON object on stdout and nothing else.")] = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="No progress and no table; errors only.")] = False,
) -> int:
    """Plan a path with ants, and tell how much longer it is than the shortest on the grid's eight directions.

    antnav plan warehouse --robot-radius 0.25 -o plan.png -o plan.json

    antnav plan office.yaml --start -1.5,2 --goal 18.5,9 --robot-radius 0.2

    Ctrl-C ends the search with the best path so far; a second Ctrl-C leaves at once.
    """
    outputs = [Path(name) for name in output or []]
    _check_outputs(outputs, map_name)
    choices = {"ants": ants, "iterations": iterations, "heuristic": heuristic, "axis": axis}
    choices |= {} if straighten else {"straighten": False}
    chosen = planner_named(algorithm, **{name: value for name, value in choices.items() if value is not None})
    executor = executor_for(workers)
    stop = Seconds(time_limit) if time_limit is not None else None
    check_seed(seed)
    if strict_radius and not robot_radius:
        remedy = "give a --robot-radius above 0, or leave it out"
        raise ParameterError("--strict-radius", "it says how the robot's radius is measured", remedy)

    grid = read_map(map_name, rules, values, invert)
    if resolution is not None:
        grid = replace(grid, resolution=resolution)
    ends = _ends(map_name, grid, start, goal, cells=cells)
    with compilation_announced(quiet):
        inflated = grid.inflated(robot_radius, strict=strict_radius)
        field = collected(grid, cost or (), keepout or (), speed or ())
        problem = Problem(inflated, *ends, corner_rule, allow_unknown, goal_tolerance, start_tolerance, field, turning)
        seconds_compile = warmup(chosen, turns=turning > 0)

    watch = Watch(chosen.name, time_limit, quiet)

    def search(cancel: threading.Event) -> Result:
        watch.optimum = exact.optimum(problem).cost
        return solve(problem, chosen, seed=seed, stop=stop, executor=executor, cancel=cancel, events=watch.hear)

    result, interrupted = run_interruptibly(search, watch)
    result = replace(result, seconds_compile=seconds_compile)
    if check and result.path:
        check_path(result.path, problem)
        check_cost(result.path, problem, result.cost)
    advice = [] if result.path else why_no_path(result, grid, robot_radius, strict=strict_radius)
    advised = replace(result, notes=(*result.notes, *(text for _, text in advice)))
    saved, failure = _save(advised, outputs)
    if json:
        say(_json(advised, robot_radius, checked=check and result.path is not None))
    elif not quiet:
        say_rows(_rows(result, robot_radius, advice, saved, strict=strict_radius, checked=check))
    if failure:
        raise failure
    if interrupted:
        return INTERRUPTED
    return FOUND if result.status is Status.FOUND else NO_PATH


def _check_outputs(outputs: Sequence[Path], map_name: str) -> None:
    sources = files_of_map(map_name) if outputs else []
    for path in outputs:
        check_output(path, ENDINGS, sources)
        if _is_picture(path) and find_spec("matplotlib") is None:
            raise ParameterError(f"output {path}", "a picture needs matplotlib", 'run: pip install "antnav[plot]"')


def _ends(map_name: str, grid: GridMap, start: str | None, goal: str | None, *, cells: bool) -> tuple[Point, Point]:
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


def _save(result: Result, outputs: Sequence[Path]) -> tuple[list[Path], BaseException | None]:
    """Write the files, pictures last. No failure must cost the user the answer: the first comes back with the rest."""
    saved: list[Path] = []
    failure: BaseException | None = None
    for path in sorted(outputs, key=_is_picture):
        try:
            if _is_picture(path):
                _draw(result, path)
            else:
                result.save(path)
            saved.append(path)
        except Exception as error:
            failure = failure or error
        except KeyboardInterrupt as interrupt:  # of a picture that takes long
            return saved, interrupt
    return saved, failure


def _is_picture(path: Path) -> bool:
    return path.suffix.lower() in PICTURES


def _draw(result: Result, path: Path) -> None:
    from antnav.plot import save_picture

    try:
        save_picture(result, path)
    except AntnavError:
        raise
    except Exception as error:  # matplotlib has many settings, fonts and versions
        remedy = "the path itself is found: save it as .json, and draw that"
        raise OutputError(f"picture {path}", f"{type(error).__name__}: {error}", remedy) from error


def _margin(result: Result, radius: float) -> float | None:
    """Metres that the path leaves between the robot's body and the walls; None without a radius, path or wall."""
    known = result.path is not None and radius > 0 and math.isfinite(result.path.wall_distance)
    return result.path.wall_distance - radius if known and result.path else None


def _json(result: Result, radius: float, *, checked: bool) -> str:
    document = result.to_dict(map_cells=False)
    del document["history"]
    document["nav2_code"] = nav2.code_of(result)
    margin = _margin(result, radius)
    return msgspec.json.encode({**document, "robot_radius": radius, "margin_m": margin, "checked": checked}).decode()


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
