"""Discs that lie, walk or cost: obstacles, people, traffic jams."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from antnav.scenarios.covers import Cover
from antnav.scenarios.ground import Ground
from antnav.search.exact import shortest_path
from antnav.world.problem import CellIndex, Problem

#: Walking speed of people in metres a second (Weidmann 1993), to a robot's 1 m/s.
WALKING = 1.34


def obstacles(ground: Ground, rng: np.random.Generator, count: int, radius: int = 2) -> Iterator[Cover]:
    """Discs that fall once and vanish later, every second one near the robot's way; never onto start or goal."""
    for number in range(count):
        centre = ground.spot(rng, near_way=number % 2 == 0, reach=2 * radius + 1)
        yield Cover(*ground.stay(rng), ground.apart_from_ends(ground.disc(centre, radius)))


def traffic(ground: Ground, rng: np.random.Generator, count: int, price: float = 4.0) -> Iterator[Cover]:
    """Jams that come and go, every second one near the robot's way: discs where a metre costs `price` more."""
    radius = max(min(ground.problem.grid.shape) // 16, 2)
    for number in range(count):
        centre = ground.spot(rng, near_way=number % 2 == 0, reach=radius)
        yield Cover(*ground.stay(rng), ground.disc(centre, radius), price)


def people(ground: Ground, rng: np.random.Generator, count: int, radius: int = 1) -> Iterator[Cover]:
    """Discs that walk from spot to spot on shortest paths, every second spot near the robot's way.

    They walk 1.34 times as fast as the robot, and mind walls, but not the robot, each other, or what else happens.
    """
    for number in range(count):
        here = ground.spot(rng, near_way=number % 2 == 0, reach=8)
        stands, begin = here, 0
        for tick, there in enumerate(_walk(ground, rng, here), 1):
            if there != stands or tick == ground.ticks:
                yield Cover(begin, tick, ground.disc(stands, radius))
                stands, begin = there, tick


def _walk(ground: Ground, rng: np.random.Generator, here: CellIndex) -> Iterator[CellIndex]:
    """Where somebody stands at ticks 1, 2, ..., up to the last tick."""
    problem = ground.problem
    way, place, walked = [here], 0, 0.0
    aim = 0
    for _ in range(ground.ticks):
        walked += WALKING * ground.speed
        while walked >= 1.0:
            walked -= 1.0
            if place + 1 == len(way):
                aim += 1
                to = ground.spot(rng, near_way=aim % 2 == 0, reach=8)
                rule, unknown = problem.corner_rule, problem.allow_unknown
                walk = Problem.from_cells(problem.grid, way[-1], to, corner_rule=rule, allow_unknown=unknown)
                found = shortest_path(walk, "astar").path
                way, place = [(row, col) for row, col in found.cells.tolist()] if found else [way[-1]], 0
            place = min(place + 1, len(way) - 1)
        yield way[place]
