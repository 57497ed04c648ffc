"""named: scenarios by a text, as the command line gives them."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

from antnav.errors import ParameterError, check_type, shown
from antnav.scenarios.covers import Cover, events_of
from antnav.scenarios.discs import obstacles, people, traffic
from antnav.scenarios.doors import doors
from antnav.scenarios.ground import Ground
from antnav.scenarios.scenario import Scenario, least_sensor
from antnav.search.exact import optimum
from antnav.values import finite_number, whole_in
from antnav.world.cost import LARGEST
from antnav.world.problem import Problem, check_problem

#: Scenarios by name: the maker, and what stands behind the name; all but the first may be left out.
KINDS: dict[str, tuple[Callable[..., Iterator[Cover]], tuple[str, ...]]] = {
    "doors": (doors, ("count",)),
    "obstacles": (obstacles, ("count", "radius")),
    "people": (people, ("count", "radius")),
    "traffic": (traffic, ("count", "price")),
}
#: Cells that a robot sees in unknown terrain, where nobody says it.
SENSOR = 10
FORMS = (
    "doors:K, obstacles:K[:RADIUS], people:K[:RADIUS], traffic:K[:PRICE], unknown[:RADIUS], each RADIUS in cells, "
    "or several joined by +"
)
_MOST = 10_000
#: Ticks where there is no way at rest.
_TICKS = 200


def named(
    text: str,
    problem: Problem,
    *,
    seed: int = 0,
    ticks: int | None = None,
    seconds: float | None = None,
    speed: int = 1,
    radius: float = 0.0,
) -> Scenario:
    """Draw the scenario that a text stands for, such as "people:20" or "doors:4+people:20".

    Parameters
    ----------
    text : str
        ============================ =================================================================================
        doors:K                      K narrow passages open and close at random, half of them on the robot's way
        obstacles:K[:RADIUS]         K discs of `RADIUS` 2 cells fall once each and vanish later
        people:K[:RADIUS]            K discs of `RADIUS` 1 walk from place to place, 1.34 times as fast as the robot
        traffic:K[:PRICE]            K regions where a metre costs `PRICE` 4 more come and go
        unknown[:RADIUS]             the robot begins with an empty map and sees `RADIUS` 10 cells around itself
        ============================ =================================================================================

        Discs of radius 0 are one cell, of radius 1 nine. Every second disc lies near the cheapest path of the map at
        rest. What overlaps blocks a cell until the last one has gone; prices add up.
    problem : Problem
        The map at rest, start and goal.
    seed : int
        Same text, problem and seed: same bytes.
    ticks, seconds, speed, radius
        See `Scenario`; `ticks` default to 50 and twice what the robot takes for its way at rest, `seconds` of a tick to
        what a robot of 1 m/s takes for its moves.

    Raises
    ------
    ParameterError
        No such scenario, numbers out of range, fewer narrow passages than doors.
    """
    check_problem(problem)
    check_type("scenario", text, str, f"give one of {FORMS}")
    given = _TICKS if ticks is None else ticks
    frame = Scenario.of(problem, ticks=given, seconds=seconds, speed=speed, radius=radius, name=text, seed=seed)
    grid = problem.grid.inflated(frame.radius)
    inflated = problem if grid is problem.grid else replace(problem, grid=grid)
    path = optimum(inflated).path
    if ticks is None and path is not None:
        frame = replace(frame, ticks=50 + 2 * math.ceil((len(path) - 1) / frame.speed))
    ground = Ground(inflated, frame.ticks, frame.speed)
    covers: list[Cover] = []
    sensor = None
    for number, part in enumerate(text.split("+")):
        kind, *numbers = part.strip().split(":")
        if kind == "unknown" and len(numbers) <= 1 and sensor is None:
            least = least_sensor(frame.speed, frame.radius / problem.grid.resolution)
            sensor = _whole(text, numbers[0]) if numbers else max(SENSOR, least)
        elif kind in KINDS:
            make, _ = KINDS[kind]
            covers += make(ground, np.random.default_rng((frame.seed, number)), **_numbers(text, kind, numbers))
        else:
            raise _unknown(text)
    events = tuple(events_of(covers, grid.shape, frame.ticks))
    return replace(frame, events=events, sensor=sensor)


def _numbers(text: str, kind: str, given: list[str]) -> dict[str, int | float]:
    """What stands behind a kind's name, by what it means."""
    names = KINDS[kind][1]
    if not 1 <= len(given) <= len(names):
        raise _unknown(text)
    found: dict[str, int | float] = {}
    for name, word in zip(names, given, strict=False):
        if name == "price":
            found[name] = finite_number(_number(text, word, float))
            if not 0 < found[name] <= LARGEST:
                raise ParameterError(f"scenario {text}: price {word}", f"it is up to {LARGEST:g}, above 0", "give one")
        else:
            found[name] = _whole(text, word)
    return found


def _whole(text: str, word: str) -> int:
    return whole_in(f"scenario {text}: number", _number(text, word, int), 0, _MOST)


def _number(text: str, word: str, kind: type[int] | type[float]) -> int | float:
    try:
        return kind(word)
    except ValueError:
        raise _unknown(text) from None


def _unknown(text: object) -> ParameterError:
    return ParameterError(f"scenario {shown(text)}", f"it is {FORMS}", "give one, such as people:20")
