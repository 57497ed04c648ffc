"""Routes via a cell: from the start to it and on to the goal, each half a cheap path, the cheapest on each side.

Routes via one node are Abraham, Delling, Goldberg & Werneck's (2013, doi 10.1145/2444016.2444019), who ask that they be
cheapest paths around that node. On a grid this is no sign of another way: an empty hall is full of detours that are
cheapest paths for most of their length. So of all routes on one side of all obstacles only the cheapest counts, and
each half may be the cheapest path or the cheapest on another side [ours].
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from antnav.kernels import grid_kernels, route_kernels
from antnav.routes.difference import Zone
from antnav.routes.sides import marks_below, polished, side
from antnav.world.moves import octile
from antnav.world.problem import Problem

#: Routes are searched up to these multiples of the best cost, one after the other, until there are enough: the search
#: stays near the best route, and where cells have costs, cheap routes are told apart by what is dearer.
LEVELS = (1.01, 1.04, 1.12, 1.3, 1.6)


@dataclass(frozen=True, eq=False)
class Halves:
    """Cheap paths from one end to all cells: of each cell two states, for two sides."""

    cost: NDArray[np.float64]
    total: NDArray[np.int64]
    parent: NDArray[np.int32]


@dataclass(frozen=True, eq=False)
class Candidates:
    """Routes via a cell, by cost: a state of either half for each."""

    out: Halves
    home: Halves
    width: int
    costs: NDArray[np.float64]
    states: NDArray[np.int32]  #: shape (n, 2)
    shares: NDArray[np.float64]  #: the most that a route shares with one of those taken

    def next(self, most_shared: float) -> int | None:
        """The cheapest that may be taken, of several the most different; None where there is none. It is then gone."""
        cheap = np.flatnonzero(self.shares <= most_shared)
        if not len(cheap):
            return None
        as_cheap = cheap[self.costs[cheap] <= self.costs[cheap[0]] * (1 + 1e-9)]
        number = int(as_cheap[np.argmin(self.shares[as_cheap])])
        self.shares[number] = np.inf
        return number

    def path(self, number: int) -> NDArray[np.int32]:
        """Flat cells."""
        out, home = self.states[number]
        there = route_kernels.half(self.out.parent, out)
        return np.concatenate((there, route_kernels.half(self.home.parent, home)[-2::-1]))

    def see(self, zone: Zone) -> None:
        """Take note of a route that was taken."""
        out, out_inside = route_kernels.shared(self.out.parent, self.width, self.states[:, 0], zone.near)
        home, home_inside = route_kernels.shared(self.home.parent, self.width, self.states[:, 1], zone.near)
        np.maximum(self.shares, (out_inside + home_inside) / (out + home), out=self.shares)


def _candidates(problem: Problem, level: float, above: float, best: NDArray[Any]) -> Candidates:
    """Routes that cost more than `above` and at most `level`: the cheapest on each side but that of the best.

    What no route up to the level leads over is an obstacle. Turns cost nothing here.
    """
    (start, goal), width, prices = problem.flat_ends, problem.width, problem.objective.prices
    least_to_goal = _least(problem, goal)
    to_start = _costs(problem, start, _least(problem, start) + least_to_goal <= level)
    to_goal = _costs(problem, goal, to_start + least_to_goal <= level)
    below = marks_below(to_start + to_goal > level, width)

    def halves(end: int, remaining: NDArray[np.float64]) -> Halves:
        return Halves(*grid_kernels.two_sides(problem.flat_moves, width, end, remaining, level, prices, below))

    out, home = halves(start, to_goal), halves(goal, to_start)
    sides, costs, *states = route_kernels.cheapest_by_side(out.cost, out.total, home.cost, home.total, above, level)
    others = np.flatnonzero(sides != side(best, below, width))
    order = others[np.lexsort((states[0][others], costs[others]))]
    return Candidates(out, home, width, costs[order], np.stack(states, axis=-1)[order], np.zeros(len(order)))


def _least(problem: Problem, end: int) -> NDArray[np.float64]:
    """Of each cell, flat: the cost to an end if there were no obstacles."""
    (rows, cols), (row, col) = problem.moves.shape, divmod(end, problem.width)
    cheapest = problem.objective.prices.cheapest / (1 + 1e-9)
    return cheapest * octile(np.arange(rows)[:, None] - row, np.arange(cols) - col).ravel()


def _costs(problem: Problem, end: int, inside: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Of each cell, flat: the exact cost to an end over cells of a mask."""
    moves = np.where(inside, problem.flat_moves, np.uint8(0))
    cost: NDArray[np.float64]
    cost, _, _ = grid_kernels.search(moves, problem.width, end, -1, False, problem.objective.prices)
    return cost


def routes(
    problem: Problem, best: NDArray[Any], count: int, most_shared: float, limit: float, reach: float
) -> list[NDArray[Any]]:
    """The best path and others, of flat cells, cheapest first but for the cost of turns.

    Parameters
    ----------
    problem : Problem
    best : ndarray of int
        A cheapest path.
    count : int
        How many are wanted, the best among them.
    most_shared : float
        Share of a route's length that may run along a cheaper one.
    limit : float
        The dearest cost.
    reach : float
        How far from a path another one still runs along it, in cells.
    """
    found, zones = [best], [Zone.of(best, problem.terrain, reach)]
    limit *= 1 + 1e-9
    cost, above = problem.cost_along(best), 0.0
    start, goal = problem.flat_ends
    climb = float(problem.objective.towards(goal, np.zeros(problem.moves.size))[start])  # the same for all routes
    for level in [one * cost - climb for one in LEVELS if one * cost < limit] + [limit - climb]:
        if len(found) == count:
            break
        candidates = _candidates(problem, level, above, best)
        for zone in zones:
            candidates.see(zone)
        above = level
        while len(found) < count and (number := candidates.next(most_shared)) is not None:
            path = candidates.path(number)
            if len(np.unique(path)) < len(path):
                continue  # round an obstacle and back
            better = polished(path, problem.terrain, reach)
            if max(zone.share(better) for zone in zones) <= most_shared:
                path = better
            if problem.cost_along(path) > limit:  # by its turns
                continue
            found.append(path)
            zones.append(Zone.of(path, problem.terrain, reach))
            candidates.see(zones[-1])
    return found
