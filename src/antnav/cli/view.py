"""`antnav view`: a map, ants and pheromone in the browser."""

from __future__ import annotations

from typing import Annotated

import typer

from antnav.cli.inputs import Invert, RulesOption, ValuesOption, read_map
from antnav.cli.query import Corners, RobotRadius
from antnav.cli.running import compilation_announced
from antnav.cli.terminal import FOUND, complain, flush, say
from antnav.plan.algorithms import short_name
from antnav.plan.warmup import warmup
from antnav.view.dropped import coarser
from antnav.view.guard import Guard
from antnav.view.menu import planners
from antnav.view.messages import Panel
from antnav.view.session import Start
from antnav.world.moves import CornerRule
from antnav.world.problem import CellIndex


def view(
    map_name: Annotated[
        str,
        typer.Argument(
            metavar="MAP",
            help="A map file or the name of a built-in map; above 512 x 512 cells, several are shown as one.",
        ),
    ] = "equiv40",
    start: Annotated[str | None, typer.Option(metavar="ROW,COL", help="Start cell; it can be moved.")] = None,
    goal: Annotated[str | None, typer.Option(metavar="ROW,COL", help="Goal cell; it can be moved.")] = None,
    algorithm: Annotated[
        str, typer.Option(metavar="NAME[,NAME]", help="One, or two side by side under the same seed: paco,npaco.")
    ] = "paco",
    seed: Annotated[int, typer.Option(help="Same seed, same ants.")] = 0,
    corner_rule: Corners = CornerRule.ALLOW,
    robot_radius: RobotRadius = 0.0,
    rules: RulesOption = "nav2",
    values: ValuesOption = "cells",
    invert: Invert = False,
    host: Annotated[
        str, typer.Option(help="Address to listen on; other machines reach the page only where this is not loopback.")
    ] = "127.0.0.1",
    port: Annotated[int, typer.Option(min=0, max=65535, help="0: any that is free.")] = 8642,
    browser: Annotated[bool, typer.Option("--browser/--no-browser", help="Open the page.")] = True,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Print the address only.")] = False,
) -> int:
    """Watch ants find a way in the browser: draw walls, move start and goal, compare algorithms.

    antnav view

    antnav view warehouse --algorithm paco,npaco

    Ctrl-C ends it.
    """
    from antnav.view.server import bound, serve

    panels = [Panel(short_name(name.strip())) for name in algorithm.split(",")]
    whole = read_map(map_name, rules, values, invert)
    grid = coarser(whole)
    if grid is not whole:
        size = f"{whole.name or map_name} of {whole.rows} x {whole.cols} cells"
        complain(f"{size} is shown with {grid.rows} x {grid.cols}, of {grid.resolution:g} m", kind="warning")
    ends = _cell("start", start), _cell("goal", goal)
    listening = bound(host, port)
    guard = Guard(host, listening.getsockname()[1])
    with compilation_announced(quiet):
        first = Start(grid, *ends, panels, seed, corner_rule, robot_radius)
        for planner in planners(panels):
            warmup(planner)
    if not guard.local:
        complain("the page can be reached from other machines by whoever knows its address", kind="warning")
    say(guard.url if quiet else f"antnav view: {guard.url}  (Ctrl-C ends it)")
    flush()
    if browser:
        import webbrowser

        webbrowser.open(guard.url)
    serve(first, listening, guard)
    return FOUND


def _cell(name: str, text: str | None) -> CellIndex | None:
    from antnav.errors import ParameterError

    if text is None:
        return None
    try:
        row, col = (int(part) for part in text.split(","))
    except ValueError:
        raise ParameterError(f"--{name} {text!r}", "it is ROW,COL, two whole numbers", "write it like 3,17") from None
    return row, col
