"""Compile or load the kernels once a process, and say how long it took."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from antnav.ants.second import SecondProcess
from antnav.colony import colony
from antnav.colony.parameters import Settings
from antnav.colony.parts import Death, Hybrid, Part, RewardAndPunish, Target
from antnav.kernels import grid_kernels
from antnav.planner.once import once
from antnav.plugins.source import Source
from antnav.search import exact, windows
from antnav.search.abstraction import prepare
from antnav.search.mending import mended
from antnav.world.grid import GridMap
from antnav.world.path_cost import FREE
from antnav.world.problem import Problem

#: Ants that have seen everything in a blink.
_TINY = Settings(
    name="warmup",
    heuristic=Target(),
    pheromone=RewardAndPunish(),
    deadlock=Hybrid(),
    ants=2,
    iterations=2,
)


def kernels(
    *,
    windows: bool,
    regions: bool,
    ants: bool = True,
    searches: bool = False,
    own: bool = False,
    walking: bool = False,
    rivals: bool = False,
    gaps: bool = False,
) -> float:
    """Compile kernels, those of what else is wanted among them; seconds that it took, 0 once done.

    own, walking: those that ask users' rules after the walk, and those that ask them in its course as well. Where
    nothing is kept on disk a second process compiles what is not the ants'.
    """
    wanted = {"exact": True, "windows": windows, "regions": regions, "rivals": rivals, "gaps": gaps}
    others = {name: work for name, work in _OTHERS.items() if wanted[name]}
    walks = {"ants": ants, "searches": searches, "own": own, "walking": walking}
    colonies = {name: work for name, work in _COLONIES.items() if walks[name]}
    with SecondProcess() as second:
        begin: dict[str, Callable[[], None]] = {"second process": partial(second.start, [*others])}
        return once(begin | colonies | {"second process joined": second.join} | others)


def compile_named(names: Sequence[str]) -> None:
    """Compile these kernels alone, in a second process."""
    once({name: _OTHERS[name] for name in names})


def turning() -> float:
    """Compile what a problem with a price of turns needs beside the rest."""
    return once({"turning": _turning})


def _problem(turning: float = 0.0) -> Problem:
    return Problem.from_cells(GridMap(np.zeros((2, 5), np.uint8)), (0, 0), (1, 4), turning=turning)


def _turning() -> None:
    exact.shortest_path(_problem(turning=1.0))


def _exact() -> None:
    problem = _problem()
    exact.shortest_path(problem, "astar")
    path = exact.shortest_path(problem).path
    assert path is not None
    _ = path.wall_distance
    windows.without_loops(problem.graph.flat)
    problem.cost_along(problem.graph.flat[:2].copy())
    problem.graph.part(np.ones(len(problem.graph), np.bool_), 0)


def _ants(searches: bool) -> None:
    colony.run(colony.whole_task(_problem(), replace(_TINY, graft=searches), seed=0))


def _own(kind: str, rule: Part) -> None:
    colony.run(colony.whole_task(_problem(), _TINY.changed(**{kind: rule}), seed=0))


class _Idle(RewardAndPunish):
    """An own rule that deposits nothing."""

    own, function, source = True, staticmethod(lambda ants: None), Source("idle", "", "", "")


class _Mortal(Death):
    """An own rule by which ants in dead ends die."""

    own, function, source = True, staticmethod(lambda stuck: True), Source("mortal", "", "", "")


def _windows() -> None:
    from antnav.kernels import jump_kernels

    problem = _problem()
    path = problem.graph.flat[:5].copy()
    grid_kernels.reoptimise(problem.flat_moves, problem.width, path, 3, 0, FREE)
    jump_kernels.reoptimise(problem.flat_moves, problem.width, problem.terrain.jumps, path, 3, 0)


def _regions() -> None:
    problem = _problem()
    short = prepare(problem.grid, block=4)
    graph = short.between(*problem.flat_ends)
    assert graph is not None
    graph.distances_to(graph.goal)
    stops = short.stops(np.array([graph.start, graph.goal], np.int32), graph, *problem.flat_ends)
    path = grid_kernels.thread_route(short.moves, problem.width, short.block, stops, FREE)
    grid_kernels.cost_along(path, problem.width, FREE)


def _gaps() -> None:
    problem = _problem()
    mended(problem.graph.flat[[0, -1]], problem)


def _rivals() -> None:
    from antnav.kernels import walk_kernels

    problem = _problem()
    moves, width = problem.flat_moves, problem.width
    start, goal = problem.flat_ends
    stops = walk_kernels.stops_of(np.zeros(2), np.full(problem.grid.shape, start), start, goal)
    walk_kernels.straight_walk(moves, width, stops)
    grid_kernels.joined(moves, width, stops, FREE)
    walk_kernels.descend(moves, width, np.zeros(moves.size), start, goal)
    walk_kernels.wander(moves, width, start, goal, np.zeros(1))


_COLONIES: dict[str, Callable[[], None]] = {
    "ants": partial(_ants, False),
    "searches": partial(_ants, True),
    "own": partial(_own, "pheromone", _Idle()),
    "walking": partial(_own, "deadlock", _Mortal()),
}
_OTHERS = {"exact": _exact, "windows": _windows, "regions": _regions, "rivals": _rivals, "gaps": _gaps}
