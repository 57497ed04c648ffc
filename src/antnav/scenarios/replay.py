"""replay: drive a robot through a scenario with any replanner."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise, product
from threading import Event as Flag

import numpy as np
from numpy.typing import NDArray

from antnav.errors import ParameterError, check_type, shown
from antnav.live.methods import METHODS, replanner
from antnav.live.mission import MOST_ROUNDS, Mission
from antnav.live.replanner import Replanner
from antnav.live.update import MissionStatus, Update
from antnav.planner.call import check_conduct
from antnav.planner.once import once
from antnav.scenarios.known import Known, Noticed
from antnav.scenarios.model import Replay, Tick
from antnav.scenarios.scenario import Scenario
from antnav.scenarios.verify import failure
from antnav.search.exact import optimum
from antnav.values import whole_in
from antnav.world.grid import GridMap
from antnav.world.moves import CornerRule
from antnav.world.path import length_of
from antnav.world.problem import CellIndex, Problem


def replay(
    given: GridMap | Problem | None,
    scenario: Scenario,
    algorithm: str | Replanner = "regions",
    *,
    improve: int = 1,
    verify: bool = False,
    cancel: Flag | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Replay:
    """Drive a robot through a scenario.

    At each tick the scenario's events come first; then the robot notices what it can, and where that is news the
    mission replans and improves the plan; then the robot makes `scenario.speed` moves along the plan, or waits where
    there is none. It ends when the robot arrives, or with the scenario.

    Parameters
    ----------
    given : GridMap, Problem or None
        The scenario's map or problem; None: the map that the scenario holds.
    scenario : Scenario
    algorithm : str or Replanner
        As `an.Mission` takes it. One that was handed in is used as it is: what it remembers of an earlier replay goes
        along.
    improve : int
        Rounds of improvement after each change, 0 to 1000.
    verify : bool
        Whether each plan and verdict is checked on a map made anew. That takes longer than planning, and pushes the
        replanner's data out of the processor's caches.
    cancel : threading.Event, optional
        Set it from elsewhere, and the replay ends with the ticks so far.
    progress : callable, optional
        Called with the number of ticks done and of all.

    Raises
    ------
    ParameterError
        Another map or problem than the scenario's, no such replanner, values out of range.
    EndpointError
        The start or the goal is closed at rest.
    """
    check_type("scenario", scenario, Scenario, "make one with antnav.scenarios.named")
    problem = scenario.problem(given)
    improve = whole_in("improve", improve, 0, MOST_ROUNDS)
    check_type("verify", verify, bool, "give True or False")
    check_conduct(None, None, cancel)
    if not (progress is None or callable(progress)):
        raise ParameterError(f"progress {shown(progress)}", "it is called with two numbers", "give a function")
    known = Known(problem, scenario.sensor)
    least = optimum(replace(problem, grid=problem.grid.inflated(scenario.radius), cost=None, turning=0.0)).length
    prepare(algorithm)
    begin = time.thread_time()
    mission = Mission(known.resting, algorithm, radius=scenario.radius)
    seconds_first = time.thread_time() - begin
    happens = {event.tick: event for event in scenario.events}
    robot, before = problem.start_cell, mission.plan.flat
    ticks, plans, news = list[Tick](), list[NDArray[np.int32] | None](), list[Noticed]()
    for number in range(scenario.ticks):
        if cancel is not None and cancel.is_set():
            break
        if number in happens:
            known.happen(happens[number])
        noticed = known.notice(robot)
        update, seconds, idle_seconds = _replanned(mission, problem, noticed, robot, improve)
        wrong = failure(update, known, robot, scenario.radius) if verify else ""
        way, collision = _driven(update, robot, known, problem.corner_rule, scenario.speed)
        ticks.append(
            Tick(
                tick=number,
                row=robot[0],
                col=robot[1],
                status=update.status,
                cost=update.cost,
                changed_share=_share(update.flat, before),
                noticed=noticed.cells,
                left_out=noticed.left_out,
                moves=len(way) - 1,
                length=length_of(np.array(way, np.int32)),
                paid=_paid(way, problem, known),
                failure=wrong or collision,
                seconds=seconds,
                idle_seconds=idle_seconds,
            )
        )
        plans.append(update.cells)
        news.append(noticed)
        if progress is not None:
            progress(number + 1, scenario.ticks)
        if update.status is MissionStatus.ARRIVED:
            break
        robot = way[-1]
        before = update.flat
    return Replay(
        scenario=scenario,
        problem=problem,
        algorithm=algorithm if isinstance(algorithm, str) else algorithm.name,
        improve=improve,
        verified=verify,
        ticks=tuple(ticks),
        plans=tuple(plans),
        news=tuple(news),
        optimum=least,
        seconds_first=seconds_first,
    )


def prepare(algorithm: str | Replanner) -> float:
    """Compile or load what a replanner needs, outside of the times that are measured; seconds that it took."""
    name = replanner(algorithm).name
    name = name if name in METHODS else "astar"  # what is one's own prepares itself

    def drive() -> None:
        problem = Problem.from_cells(GridMap(np.zeros((48, 48), np.uint8)), (24, 2), (24, 45))
        optimum(problem)
        wall = np.stack((np.arange(48), np.full(48, 24)), axis=-1)
        for radius, cost in product((0.0, 1.0), (None, (wall[:9], 2.0))):
            mission = Mission(problem, name, radius=radius)
            mission.moved_to((30, 2))
            for cells in (wall[24:25], wall[12:], wall):
                mission.change(blocked=cells, cost=cost)
                mission.improve(MOST_ROUNDS)
                mission.change(freed=cells)
                mission.improve(MOST_ROUNDS)

    return once({f"replay {name}": drive})


def _replanned(
    mission: Mission, problem: Problem, noticed: Noticed, robot: CellIndex, improve: int
) -> tuple[Update, float, float]:
    """The plan in force, and the CPU seconds that the thread took for it and for improving it."""
    at = problem.grid.cell_to_world(robot)
    cost = None
    if len(noticed.priced):
        base = 0.0 if problem.cost is None else problem.cost.values[tuple(noticed.priced.T)]
        cost = (noticed.priced, base + noticed.prices)
    begin = time.thread_time()
    if noticed.cells:
        mission.change(blocked=noticed.blocked, freed=noticed.freed, cost=cost, at=(float(at[0]), float(at[1])))
    elif robot != mission.position:
        mission.moved_to(robot)
    middle = time.thread_time()
    if noticed.cells and improve:
        mission.improve(improve)
    return mission.plan, middle - begin, time.thread_time() - middle


def _driven(
    update: Update, robot: CellIndex, known: Known, rule: CornerRule, speed: int
) -> tuple[list[CellIndex], str]:
    """Cells that the robot drives over, its own first, and what it would have hit: it stops before that."""
    way = [robot]
    if update.status is not MissionStatus.PLANNED or update.cells is None:
        return way, ""
    for row, col in update.cells[1 : speed + 1].tolist():
        sides = [(way[-1][0], col), (row, way[-1][1])] if row != way[-1][0] and col != way[-1][1] else []
        hit = sum(map(known.is_closed, sides))
        corners = {CornerRule.ALLOW: 2, CornerRule.GRAZE: 1, CornerRule.FORBID: 0}[rule]
        if known.is_closed((row, col)) or hit > corners:
            return way, f"collision on the way from {way[-1]} to {(row, col)}"
        way.append((row, col))
    return way, ""


def _share(plan: NDArray[np.int32] | None, before: NDArray[np.int32] | None) -> float:
    """Share of a plan's cells that are not of the one before."""
    if plan is None:
        return 0.0
    return 1.0 if before is None else float(np.isin(plan, before, invert=True).mean())


def _paid(way: list[CellIndex], problem: Problem, known: Known) -> float:
    """What a way costs at the prices of the moment, in cells."""
    if len(way) == 1:
        return 0.0
    extra = sum(math.dist(one, other) * (known.price(one) + known.price(other)) / 2 for one, other in pairwise(way))
    return problem.objective.of(np.array(way, np.int32), problem.grid) + extra
