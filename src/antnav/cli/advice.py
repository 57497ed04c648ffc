"""Plain words for searches that ended without a path, and options that would open a way."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from antnav.errors import AntnavError
from antnav.planner.facts import Knows
from antnav.planner.plan import Status, StoppedBy
from antnav.planner.result import Result
from antnav.world.grid import Cell, GridMap
from antnav.world.moves import CornerRule
from antnav.world.problem import Problem


def why_no_path(
    result: Result, grid: GridMap, radius: float, *, margin: float = 0.0, outline: bool = False, strict: bool = False
) -> list[tuple[str, str]]:
    """Why there is no path, and what helps, as rows for the table.

    Parameters
    ----------
    result : Result
        One without a path.
    grid : GridMap
        The map before it was inflated.
    radius : float
        Radius of the robot in metres.
    margin : float
        Metres that were kept besides.
    outline : bool
        Whether the radius is that of a footprint.
    strict : bool
        Whether it is measured to the walls' edges.
    """
    problem = result.problem
    if result.status is Status.UNREACHABLE:
        body = f" for a robot of {'inscribed ' if outline else ''}radius {radius:g} m" if radius else ""
        body += f" with a margin of {margin:g} m" if margin else ""
        why = f"no path exists from start to goal under corner rule {problem.corner_rule}{body}"
        if not problem.allow_unknown and (grid.cells == Cell.UNKNOWN).any():
            why += ", with unknown cells closed"
        if _kept_out(problem):
            why += ", with kept-out cells closed"
        back = Problem.from_cells(
            problem.grid,
            problem.goal_cell,
            problem.goal_cell,
            corner_rule=problem.corner_rule,
            allow_unknown=problem.allow_unknown,
        )
        why += f"; {_cells(problem)} can be reached from the start, {_cells(back)} from the goal"
        ways = list(_ways(problem, grid, radius, margin, outline=outline, strict=strict))
        remedy = f"a way opens with {', or '.join(ways)}" if ways else "move the start or the goal, or mend the map"
    elif result.status is Status.NO_PATH:
        why = f"{result.algorithm.name} found none, though a path of {result.optimum:.4f} cells exists"
        remedy = "take ants, such as --algorithm paco, or astar"
    else:
        early = {
            StoppedBy.CANCELLED: " before the interruption",
            StoppedBy.CRITERION: " within the time limit",
        }.get(
            result.stopped_by,
            f" in {_counted(result.iterations, 'iteration')} of {_counted(result.algorithm.ants, 'ant')}",
        )
        why = f"no ant arrived{early}, though a path of {result.optimum:.4f} cells exists"
        more = "more --ants or --iterations" if result.stopped_by is StoppedBy.SCHEDULE else "more time"
        guided = result.algorithm.knows & (Knows.TO_GOAL | Knows.REGIONS)
        remedy = f"give {more}" + ("" if guided else ", or try --heuristic detour, which knows the true distances")
    return [("why", why), ("remedy", remedy)]


def _counted(number: int, thing: str) -> str:
    return f"{number} {thing}" if number == 1 else f"{number} {thing}s"


def _cells(problem: Problem) -> str:
    return _counted(int(problem.reachable.sum()), "cell")


def _ways(
    problem: Problem, grid: GridMap, radius: float, margin: float, *, outline: bool, strict: bool
) -> Iterator[str]:
    """Options that, each by itself, make the goal reachable; the least change of each kind."""
    rule = problem.corner_rule
    for looser in {CornerRule.FORBID: (CornerRule.GRAZE, CornerRule.ALLOW), CornerRule.GRAZE: (CornerRule.ALLOW,)}.get(
        rule, ()
    ):
        if _connected(problem, problem.grid, looser, unknown=problem.allow_unknown):
            yield f"--corner-rule {looser} (for a point without a body: it passes corners of obstacles)"
            break
    if not problem.allow_unknown and _connected(problem, problem.grid, rule, unknown=True):
        yield "--allow-unknown"
    for option, most, least in (("--margin", margin, radius), ("--robot-radius", 0.0 if outline else radius, margin)):
        for share in (0.75, 0.5, 0.25, 0.0) if most else ():
            smaller = grid.inflated(least + share * most, strict=strict)
            if _connected(problem, smaller, rule, unknown=problem.allow_unknown):
                yield f"{option} {share * most:g}"
                break
    if _kept_out(problem):
        free = Problem.from_cells(
            grid.inflated(radius + margin, strict=strict),
            problem.start_cell,
            problem.goal_cell,
            corner_rule=rule,
            allow_unknown=problem.allow_unknown,
        )
        if free.connected:
            yield "another --keepout mask"
    nearest = _distance_to_reachable(problem)
    if nearest < 0.5 * math.dist(problem.start, problem.goal):  # or the path would end where it begins
        yield f"--goal-tolerance {nearest:g}"


def _kept_out(problem: Problem) -> bool:
    return problem.cost is not None and bool(problem.cost.blocked.any())


def _connected(problem: Problem, grid: GridMap, rule: CornerRule, *, unknown: bool) -> bool:
    try:
        return Problem.from_cells(
            grid, problem.start_cell, problem.goal_cell, corner_rule=rule, allow_unknown=unknown, cost=problem.cost
        ).connected
    except AntnavError:
        return False


def _distance_to_reachable(problem: Problem) -> float:
    """Metres from the goal to the nearest reachable cell centre, rounded up to three digits."""
    centres = problem.grid.cell_to_world(np.argwhere(problem.reachable))
    distance = float(np.hypot(*(centres - np.array(problem.goal)).T).min())
    step = 10.0 ** (math.floor(math.log10(distance)) - 2) if distance > 0 else 1.0
    return math.ceil(distance / step * (1 + 1e-9)) * step
