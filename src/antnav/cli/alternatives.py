"""`antnav plan --alternatives`: several routes on a map."""

from __future__ import annotations

import threading
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import msgspec

from antnav.cli.advice import why_no_path
from antnav.cli.running import Watch, compilation_announced, run_interruptibly
from antnav.cli.saving import PICTURES, write_all
from antnav.cli.terminal import FOUND, INTERRUPTED, NO_PATH, say, say_rows
from antnav.plan.solve import solve
from antnav.planner.exact import astar
from antnav.planner.planner import Planner
from antnav.routes.alternatives import alternatives, prepare
from antnav.routes.model import Alternatives
from antnav.world.grid import GridMap
from antnav.world.path import check_cost, check_path
from antnav.world.problem import Problem

#: Endings of files.
SEVERAL = (".json", *PICTURES)


def several(
    problem: Problem,
    k: int,
    planner: Planner | None,
    grid: GridMap,
    robot_radius: float,
    outputs: Sequence[Path],
    *,
    strict: bool,
    check: bool,
    json: bool,
    quiet: bool,
    **choices: Any,
) -> int:
    """Plan, print and save; the exit code. `choices` are those of `alternatives`, `grid` the map before inflation."""
    with compilation_announced(quiet):
        seconds_compile = prepare(planner, turns=problem.turning > 0)
    watch = Watch(planner.name if planner else "alternatives", None, quiet)

    def search(cancel: threading.Event) -> Alternatives:
        return alternatives(problem, k, algorithm=planner, cancel=cancel, **choices)

    found, interrupted = run_interruptibly(search, watch)
    found = replace(found, seconds_compile=seconds_compile)
    if check:
        for route in found:
            check_path(route.path, problem)
            check_cost(route.path, problem, route.cost)
    advice: list[tuple[str, str]] = []
    if not problem.connected:
        advice = why_no_path(solve(problem, astar()), grid, robot_radius, strict=strict)
    saved, failure = write_all(outputs, found.save, partial(_draw, found))
    if json:
        told = found.to_dict(map_cells=False) | {"robot_radius": robot_radius, "checked": check and len(found) > 0}
        say(msgspec.json.encode({**told, "notes": [*found.notes, *(text for _, text in advice)]}).decode())
    elif not quiet:
        status, *others = found.table
        rows = [status, *advice, *others]
        rows += [("checked", "every move is legal, and lengths and costs are right")] if check and len(found) else []
        say_rows([*rows, *(("saved", str(path)) for path in saved)])
    if failure:
        raise failure
    if interrupted:
        return INTERRUPTED
    return FOUND if len(found) else NO_PATH


def _draw(found: Alternatives, path: Path) -> None:
    from antnav.plot.routes import save_alternatives

    save_alternatives(found, path)
