"""alternatives: several cheap routes that truly differ."""

from __future__ import annotations

import threading
import time
from concurrent.futures import Executor
from typing import Any

import numpy as np
from numpy.typing import NDArray

from antnav.errors import ParameterError, check_type, shown
from antnav.plan.solve import solve
from antnav.plan.warmup import warmup
from antnav.planner.call import check_conduct
from antnav.planner.exact import astar
from antnav.planner.once import once
from antnav.planner.planner import Planner
from antnav.planner.result import Result, versions
from antnav.routes import penalty, via
from antnav.routes.difference import default_reach, flat_cells
from antnav.routes.model import Alternatives, compared
from antnav.run.stop import Stop
from antnav.search import exact
from antnav.values import check_seed, finite_number, is_whole
from antnav.world.grid import GridMap
from antnav.world.path import Path
from antnav.world.problem import Problem, check_problem

#: Routes at most.
MOST = 100


def alternatives(
    problem: Problem,
    k: int = 3,
    *,
    least_difference: float = 0.3,
    longest: float = 1.5,
    tolerance: float | None = None,
    algorithm: Planner | None = None,
    seed: int = 0,
    stop: Stop | None = None,
    executor: Executor | None = None,
    cancel: threading.Event | None = None,
) -> Alternatives:
    """Plan several routes, cheapest first, that differ pairwise.

    A route runs along another one where a legal way of at most `tolerance` leads to it: what lies behind a wall is not
    near. Two routes on the same side of all obstacles are one route, unless between them lie cells so dear that no
    route over them is as cheap.

    Parameters
    ----------
    problem : Problem
    k : int
        How many routes are wanted, the best among them.
    least_difference : float
        0 to 1: least share of a route's length that runs along none of the cheaper routes (of each, not of all
        together).
    longest : float
        >= 1: the dearest route costs at most so many times the optimum.
    tolerance : float, optional
        Metres; default: two cells, or 2 % of the best route's length where that is more.
    algorithm : Planner, optional
        Default: exact. The first route is a cheapest path, and each other one the cheapest on its side of the obstacles
        that leads from the start to some cell and from there to the goal on cheapest paths, prices of turns left out of
        account. With a planner, ants or another one: it plans again and again, earlier ways made dearer.
    seed, stop, executor, cancel
        As `solve` takes them, for each run of the `algorithm`; without one nothing is left to chance, and nothing
        takes long.

    Returns
    -------
    Alternatives
        A sequence of `Route`. Fewer than `k` where no more are found, which the notes say; none without any path.

    Raises
    ------
    ParameterError
        A parameter is out of range.

    Examples
    --------
    >>> import antnav as an
    >>> problem = an.Problem.from_cells(an.maps.builtin("equiv20"), start=(0, 0), goal=(19, 19))
    >>> for route in an.alternatives(problem, 2):
    ...     print(round(route.cost, 2), f"{route.difference:.0%} of it along no cheaper one")
    30.97 100% of it along no cheaper one
    31.56 36% of it along no cheaper one
    """
    check_problem(problem)
    if not is_whole(k) or not 1 <= k <= MOST:
        raise ParameterError(f"k {shown(k)}", f"it is a whole number from 1 to {MOST}", "give one, such as 3")
    least = _number("least_difference", least_difference, 0.0, 1.0)
    most_cost = _number("longest", longest, 1.0, 1e6)
    given = None if tolerance is None else _number("tolerance", tolerance, 0.0, 1e9)
    check_type("algorithm", algorithm, Planner | None, "call a preset, as in an.paco(), or leave it out")
    check_seed(seed)
    check_conduct(stop, executor, cancel)
    seconds_compile = prepare(algorithm, turns=problem.turning > 0)
    begin = time.perf_counter()
    optimum = exact.shortest_path(problem, "astar")
    limit, most_shared = most_cost * optimum.cost, 1 - least
    flats: list[NDArray[Any]] = []
    reach = 0.0
    if optimum.path is not None:
        best = flat_cells(optimum.path, problem.terrain)
        reach = default_reach(optimum.length) if given is None else given / problem.grid.resolution
        if problem.start_cell == problem.goal_cell:
            flats = [best]
        elif algorithm is None:
            flats = via.routes(problem, best, int(k), most_shared, limit, reach)
        else:

            def plan(asked: Problem) -> Result:
                return solve(asked, algorithm, seed=seed, stop=stop, executor=executor, cancel=cancel)

            def ended() -> bool:
                return cancel is not None and cancel.is_set()

            flats = penalty.routes(problem, plan, int(k), most_shared, limit, reach, ended)
    paths = [
        Path(problem.from_flat(flat).astype(np.int32), problem.grid, problem.start, problem.goal) for flat in flats
    ]
    routes = compared(paths, problem, optimum.cost, most_shared, reach)
    return Alternatives(
        routes=routes,
        problem=problem,
        algorithm=algorithm,
        seed=int(seed),
        k=int(k),
        least_difference=least,
        longest=most_cost,
        tolerance=reach * problem.grid.resolution,
        optimum=optimum.cost,
        seconds_run=time.perf_counter() - begin,
        seconds_compile=seconds_compile,
        notes=(*_shortfall(len(routes), int(k), problem, algorithm, cancel), *problem.moved_ends),
        versions=versions(),
    )


def prepare(algorithm: Planner | None = None, *, turns: bool = False) -> float:
    """Compile or load the kernels that `alternatives` needs; seconds that it took, 0 once done."""
    return warmup(algorithm or astar(), turns=turns) + once({"routes": _compile})


def _compile() -> None:
    cells = np.zeros((5, 9), np.uint8)
    cells[1:4, 2:7] = 1
    problem = Problem.from_cells(GridMap(cells), (2, 0), (2, 8))
    best = exact.shortest_path(problem).path
    assert best is not None
    via.routes(problem, flat_cells(best, problem.terrain), 2, 0.7, 100.0, 2.0)


def _number(name: str, value: Any, least: float, most: float) -> float:
    number = finite_number(value)
    if not least <= number <= most:
        rule = f"it is a number from {least:g} to {most:g}"
        raise ParameterError(f"{name} {shown(value)}", rule, "give one, or leave it out")
    return number


def _shortfall(
    found: int, k: int, problem: Problem, algorithm: Planner | None, cancel: threading.Event | None
) -> tuple[str, ...]:
    """Why there are fewer routes than were wanted."""
    if found == k or not problem.connected:
        return ()
    if problem.start_cell == problem.goal_cell:
        return ("start and goal lie in one cell: there is one route",)
    if algorithm is not None and cancel is not None and cancel.is_set():
        return (f"cancelled after {found} routes",)
    if algorithm is not None:
        return (f"{algorithm.name} found no further route in {penalty.RUNS} runs: others may exist",)
    return (f"{found} of {k} routes: no other side has one that is cheap enough and different enough",)
