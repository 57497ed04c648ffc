"""verify: whether what a mission says is so, on a map made anew, by code that shares nothing with replanners."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from antnav.errors import PathError
from antnav.live.update import MissionStatus, Update
from antnav.scenarios.known import Known
from antnav.world.moves import CornerRule
from antnav.world.path import Path, check_cost, check_path
from antnav.world.problem import CellIndex, Problem


def failure(update: Update, known: Known, robot: CellIndex, radius: float) -> str:
    """What is wrong with a plan or a verdict, in words; nothing where it is right."""
    problem = known.resting
    grid, goal = known.grid(radius), problem.goal_cell
    passable = grid.passable(unknown=problem.allow_unknown)
    found = _status(passable, robot, goal, problem.corner_rule)
    if update.status is MissionStatus.NO_PATH and found is MissionStatus.PLANNED:
        return ""  # ants may miss a way, and say so
    if update.status is not found:
        return f"it says {update.status}, and it is {found}"
    if update.status is not MissionStatus.PLANNED:
        return ""
    rule, unknown = problem.corner_rule, problem.allow_unknown
    now = Problem.from_cells(grid, robot, goal, corner_rule=rule, allow_unknown=unknown, cost=known.cost())
    path = Path(np.empty((0, 2), np.int32) if update.cells is None else update.cells, grid)
    try:
        check_path(path, now)
        check_cost(path, now, update.cost)
    except PathError as error:
        return f"{error.given}: {error.rule}"
    return ""


def _status(passable: NDArray[np.bool_], robot: CellIndex, goal: CellIndex, rule: CornerRule) -> MissionStatus:
    """How things stand; the parts of a map are those of its straight moves, unless diagonal ones may cross corners."""
    from scipy import ndimage

    if not passable[robot]:
        return MissionStatus.START_BLOCKED
    if not passable[goal]:
        return MissionStatus.GOAL_BLOCKED
    if robot == goal:
        return MissionStatus.ARRIVED
    parts, _ = ndimage.label(passable, np.ones((3, 3)) if rule is CornerRule.ALLOW else None)
    return MissionStatus.PLANNED if parts[robot] == parts[goal] else MissionStatus.UNREACHABLE
