"""`antnav maps`: list, show, generate, convert."""

from __future__ import annotations

import math
import shlex
import shutil
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated

import typer

from antnav.cli.inputs import (
    MAP_ENDINGS,
    Invert,
    MapName,
    RulesOption,
    ValuesOption,
    check_output,
    files_of_map,
    read_map,
)
from antnav.cli.sketch import framed, sketch
from antnav.cli.terminal import FOUND, PIPE_WIDTH, complain, draws_unicode, is_terminal, say, say_rich, say_rows
from antnav.errors import ParameterError
from antnav.exchange import bag
from antnav.maps import builtin, builtin_names, builtin_query, generate, generator_names, save_map
from antnav.maps.generators import check_options, ends
from antnav.maps.map_server import image_beside
from antnav.world.grid import GridMap

#: Lines that `show` leaves for the table above its drawing, and the height of a drawing that goes to a pipe.
TABLE_LINES, PIPE_HEIGHT = 12, 60
#: Longer side in cells beyond which the hint names the algorithm for large maps: others need seconds there.
LARGE = 500

app = typer.Typer(help="List, show, generate and convert maps.", rich_markup_mode=None)


@app.callback(invoke_without_command=True)
def _maps(context: typer.Context) -> None:
    if context.invoked_subcommand is None:
        typer.echo(context.get_help())


@app.command("list", short_help="List the built-in maps and the generators.")
def list_maps() -> int:
    """List the built-in maps and the kinds that `antnav maps generate` draws."""
    from rich import box
    from rich.table import Table

    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    for title in ("built-in map", "cells", "metres", "free", "start", "goal"):
        table.add_column(title, justify="left" if title == "built-in map" else "right", no_wrap=True)
    for name in builtin_names():
        grid = builtin(name)
        start, goal = (f"{row},{col}" for row, col in builtin_query(name))
        table.add_row(name, f"{grid.rows} x {grid.cols}", _metres(grid), f"{_share(grid):.0f} %", start, goal)
    say_rich(table)
    say("Start and goal are ROW,COL, as with `antnav plan NAME --cells`.")
    say("The equivN stand in for the paper's maps; plan them with its --corner-rule allow to compare.")
    say(f"Kinds to generate: {', '.join(generator_names())}.")
    return FOUND


@app.command(short_help="Show what a map holds, with a drawing.")
def show(map_name: MapName, rules: RulesOption = "nav2", values: ValuesOption = "cells", invert: Invert = False) -> int:
    """Show what a map holds, with a drawing that fits the terminal."""
    grid = read_map(map_name, rules, values, invert)
    x, y, yaw = grid.origin
    corners = grid.corners()
    (left, bottom), (right, top) = corners.min(axis=0), corners.max(axis=0)
    size = grid.rows * grid.cols
    rows = [
        ("map", grid.name or map_name),
        ("cells", f"{grid.rows} rows x {grid.cols} columns = {size}"),
        ("metres", f"{_metres(grid)}, resolution {grid.resolution:g} m a cell"),
        ("origin", f"({x:g}, {y:g}) m, yaw {yaw:g} rad = {math.degrees(yaw):g} degrees"),
        ("extent", f"x {left:g}..{right:g} m, y {bottom:g}..{top:g} m"),
    ]
    if yaw:
        places = ", ".join(f"({x:g}, {y:g})" for x, y in corners.tolist())
        rows.append(("corners", f"{places} m, clockwise from the bottom left of the drawing"))
    rows += [
        (kind, f"{count} cells, {100 * count / size:.1f} %")
        for kind, count in grid.counts().items()
        if count or kind in {"free", "occupied"}
    ]
    marks: Mapping[tuple[int, int], str] = {}
    if map_name in builtin_names():
        start, goal = builtin_query(map_name)
        (start_x, start_y), (goal_x, goal_y) = grid.cell_to_world([start, goal]).tolist()
        rows.append(("start", f"cell {start[0]},{start[1]} = ({start_x:g}, {start_y:g}) m, S in the drawing"))
        rows.append(("goal", f"cell {goal[0]},{goal[1]} = ({goal_x:g}, {goal_y:g}) m, G in the drawing"))
        marks = {start: "S", goal: "G"}
    say_rows(rows)
    say()
    width, height = PIPE_WIDTH, PIPE_HEIGHT
    if is_terminal(sys.stdout):
        width, lines = shutil.get_terminal_size()
        height = max(lines - TABLE_LINES, 16)
    unicode = draws_unicode(sys.stdout)
    drawing = sketch(grid, max(width - 2, 1), height, marks, unicode=unicode)
    say("\n".join(framed(drawing, unicode=unicode)))
    return FOUND


@app.command("generate", short_help="Draw a map from a seed.")
def generate_map(
    kind: Annotated[str, typer.Argument(metavar="KIND", help=f"One of {', '.join(generator_names())}.")],
    output: Annotated[str, typer.Option("-o", "--output", metavar="FILE", help=f"One of {', '.join(MAP_ENDINGS)}.")],
    rows: Annotated[int, typer.Option(help="Height in cells.")] = 100,
    cols: Annotated[int, typer.Option(help="Width in cells.")] = 100,
    seed: Annotated[int, typer.Option(help="Same seed, same map, on every machine.")] = 0,
    option: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME=VALUE", help="Of the kind, such as density=0.2; a wrong one lists them. Repeatable."
        ),
    ] = None,
) -> int:
    """Draw a map from a seed, and say a start and a goal that a path joins."""
    path = Path(output)
    _check_map_output(path)
    options = dict(_option(text) for text in option or [])
    check_options(kind, options)  # before they could stand beside arguments of the same name
    grid = generate(kind, rows, cols, seed, **options)
    _write(grid, path)
    start, goal = ends(grid)
    query = f"--cells --start {start[0]},{start[1]} --goal {goal[0]},{goal[1]}"
    large = " --algorithm paco_large" if max(grid.shape) > LARGE else ""
    say(f"try: antnav plan {shlex.quote(output)} {query}{large}")
    return FOUND


@app.command(short_help="Write a map in another format.")
def convert(
    map_name: MapName,
    output: Annotated[str, typer.Argument(metavar="OUT", help=f"File to write: {', '.join(MAP_ENDINGS)}.")],
    rules: RulesOption = "nav2",
    values: ValuesOption = "cells",
    invert: Invert = False,
) -> int:
    """Write a map in another format, that of the ending of OUT."""
    path = Path(output)
    _check_map_output(path, files_of_map(map_name))
    _write(read_map(map_name, rules, values, invert), path)
    return FOUND


def _check_map_output(output: Path, inputs: list[Path] | None = None) -> None:
    check_output(output, MAP_ENDINGS, inputs or [], folder=output.suffix.lower() in bag.ENDINGS)
    if output.suffix.lower() in bag.ENDINGS:
        bag.require_rosbags()
    if output.suffix.lower() in {".yaml", ".yml"}:
        check_output(output.with_suffix(".pgm"), (".pgm",), inputs or [])
        image_beside(output)


def _write(grid: GridMap, output: Path) -> None:
    save_map(grid, output)
    keeps_place = output.suffix.lower() in {".yaml", ".yml", *bag.ENDINGS}
    if not keeps_place and (grid.resolution, grid.origin) != (1.0, (0.0, 0.0, 0.0)):
        complain(f"{output.suffix} files keep neither resolution nor origin; .yaml does", kind="warning")
    image = f" and {output.with_suffix('.pgm').name}" if output.suffix.lower() in {".yaml", ".yml"} else ""
    say(f"wrote {output}{image}: {grid.rows} x {grid.cols} cells, {_share(grid):.0f} % free")


def _option(text: str) -> tuple[str, float]:
    name, _, value = text.partition("=")
    try:
        number = float(value)
        return name, int(value) if value.strip().lstrip("+-").isdigit() else number
    except ValueError:
        raise ParameterError(
            f"--option {text!r}", "an option is a name and a number", "write it like density=0.2"
        ) from None


def _metres(grid: GridMap) -> str:
    return f"{grid.rows * grid.resolution:g} x {grid.cols * grid.resolution:g}"


def _share(grid: GridMap) -> float:
    return 100 * grid.counts()["free"] / (grid.rows * grid.cols)
