"""tour: many stops in, one trip out."""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator
from concurrent.futures import Executor
from contextlib import contextmanager
from importlib.metadata import version
from itertools import islice, pairwise
from typing import Any, Literal

import numpy as np

from antnav.errors import EndpointError, ParameterError, check_type, shown
from antnav.plan.solve import solve
from antnav.plan.warmup import warmup
from antnav.planner.call import check_conduct
from antnav.planner.exact import astar
from antnav.planner.once import once
from antnav.planner.plan import Status
from antnav.planner.planner import Planner
from antnav.planner.result import Result, versions
from antnav.run.stop import Stop
from antnav.tours import order as orders
from antnav.tours.distances import between, lifted
from antnav.tours.model import Tour
from antnav.values import check_seed, finite_number
from antnav.world.cost import CostField
from antnav.world.grid import GridMap
from antnav.world.moves import CornerRule
from antnav.world.problem import Problem

#: Stops at most: the distances of so many on depot take two seconds, their order one.
MOST = 1000


def tour(
    grid: GridMap,
    start: Any,
    stops: Iterable[Any],
    order: Literal["best", "given"] = "best",
    return_to_start: bool = False,
    *,
    radius: float = 0.0,
    margin: float = 0.0,
    cells: bool = False,
    corner_rule: CornerRule | str = CornerRule.FORBID,
    allow_unknown: bool = False,
    goal_tolerance: float = 0.0,
    start_tolerance: float = 0.0,
    cost: CostField | None = None,
    turning: float = 0.0,
    method: Literal["auto", "exact", "ils", "ants", "library"] = "auto",
    algorithm: Planner | None = None,
    seed: int = 0,
    stop: Stop | None = None,
    executor: Executor | None = None,
) -> Tour:
    """Plan one trip from a start to many stops, in the best order.

    Parameters
    ----------
    grid : GridMap
    start : (x, y)
        Metres.
    stops : iterable of (x, y)
        1 to 1000 of them. Two may be one place, and one may be the start.
    order : {"best", "given"}
    return_to_start : bool
        Whether the trip ends at the start; else it ends at the last stop, whichever that is.
    radius, margin : float
        Of the robot, and to keep beyond it, in metres, measured to walls' edges: ``grid.inflated(radius + margin,
        strict=True)``.
    cells : bool
        Whether the start and the stops are (row, col) instead.
    corner_rule, allow_unknown, goal_tolerance, start_tolerance, cost, turning
        As `Problem` takes them; each stop is a goal. Each leg begins from a stand: a turn at a stop costs nothing.
    method : {"auto", "exact", "ils", "ants", "library"}
        How the order is searched: dynamic programming for up to 18 stops; iterated local search; Ant Colony System with
        local search; PyVRP, the extra ``antnav[tours]``. "auto": exact for up to 12 stops, then "ils".
    algorithm : Planner, optional
        Of the legs; default: `astar()`. The order is by exact distances in any case.
    seed : int
        Of the order, and of each leg. The same seed gives the same tour.
    stop, executor
        As `solve` takes them, for each leg.

    Returns
    -------
    Tour
        With status "unreachable" where a stop cannot be reached, and the notes say which: that is no error.

    Raises
    ------
    ParameterError
        A parameter is out of range; no stop, or too many.
    OutsideMapError, OccupiedError
        The start or a stop, whose number and place are told, is outside the map or not on a passable cell.

    Examples
    --------
    >>> import antnav as an
    >>> stops = [(19.5, 0.5), (9.5, 10.5), (0.5, 10.5)]
    >>> trip = an.tour(an.maps.builtin("equiv20"), (0.5, 19.5), stops)
    >>> trip.order, round(trip.length_m, 2), trip.proven
    ((3, 2, 1), 34.73, True)
    """
    check_type("map", grid, GridMap, "make one with GridMap(array), or load one with load_map")
    check_type("algorithm", algorithm, Planner | None, "call a preset, as in an.paco(), or leave it out")
    if not isinstance(order, str) or order not in ("best", "given"):
        raise ParameterError(f"order {shown(order)}", "it is best, or as given", 'give "best" or "given"')
    for name, flag in (("return_to_start", return_to_start), ("cells", cells)):
        check_type(name, flag, bool | np.bool_, "give True or False")
    check_seed(seed)
    check_conduct(stop, executor, None)
    given = _listed(stops)
    chosen = orders.check_method(method, len(given))
    robot = [_metres("radius", radius), _metres("margin", margin)]
    planner = astar() if algorithm is None else algorithm
    inflated = grid.inflated(sum(robot), strict=True)

    choices: dict[str, Any] = {"allow_unknown": allow_unknown, "cost": cost, "turning": turning}
    choices["corner_rule"] = CornerRule.of(corner_rule)

    def asked(one: Any, other: Any, tolerance: float) -> Problem:
        make = Problem.from_cells if cells else Problem
        return make(inflated, one, other, goal_tolerance=tolerance, start_tolerance=start_tolerance, **choices)

    at_start = asked(start, start, start_tolerance)
    begun = at_start.start_cell if cells else at_start.start
    queries = [at_start]
    for number, place in enumerate(given, 1):
        with _named(number):
            queries.append(asked(begun, place, goal_tolerance))
    terrain = at_start.terrain
    seconds_compile = warmup(planner, turns=at_start.turning > 0) + prepare()

    begin = time.perf_counter()
    flat = np.array([terrain.to_flat(query.goal_cell) for query in queries], np.int32)
    costs = between(terrain, flat, executor)
    distances = lifted(costs, terrain, flat)
    apart = [number for number, query in enumerate(queries) if not query.connected]
    ordered = time.perf_counter()
    found = orders.Order((), "given" if order == "given" else chosen, None, float("inf"))
    if not apart:
        heights = np.array([terrain.objective.lift(int(flat[0]), int(place)) for place in flat])
        if order == "given":
            found = orders.given(costs, heights, back=bool(return_to_start))
        else:
            found = orders.best(costs, heights, chosen, int(seed), back=bool(return_to_start))
    legs_begin = time.perf_counter()
    places = tuple(query.goal for query in queries)
    visited = (0, *found.stops, *([0] if return_to_start else [])) if found.stops else ()
    legs = tuple(
        solve(
            Problem(inflated, places[one], places[other], **choices), planner, seed=seed, stop=stop, executor=executor
        )
        for one, other in pairwise(visited)
    )
    failed = [number for number, leg in enumerate(legs) if leg.path is None]
    return Tour(
        status=Status.UNREACHABLE if apart else legs[failed[0]].status if failed else Status.FOUND,
        grid=at_start.grid,
        places=places,
        order=found.stops,
        legs=legs,
        return_to_start=bool(return_to_start),
        distances=distances,
        method=found.method,
        optimum=found.optimum,
        bound=found.bound,
        radius=robot[0],
        margin=robot[1],
        algorithm=planner,
        seed=int(seed),
        seconds_distances=ordered - begin,
        seconds_order=legs_begin - ordered,
        seconds_legs=time.perf_counter() - legs_begin,
        seconds_compile=seconds_compile,
        notes=(*_moved(queries), *_unreached(queries, apart), *_pathless(legs, visited, failed)),
        versions=versions() | ({"pyvrp": version("pyvrp")} if found.method == "library" else {}),
    )


def prepare() -> float:
    """Compile or load the kernels that orders of stops need; seconds that it took, 0 once done."""
    return once({"tours": _compile})


def _compile() -> None:
    open_map = GridMap(np.zeros((2, 5), np.uint8))
    terrain = Problem.from_cells(open_map, (0, 0), (1, 4)).terrain
    between(terrain, np.array([terrain.to_flat((0, 0)), terrain.to_flat((1, 4))], np.int32))
    orders.compile_kernels()


def _listed(stops: Any) -> list[Any]:
    try:
        given = list(islice(stops, MOST + 1)) if not isinstance(stops, str | bytes) else None
    except TypeError:  # an array of no dimension is an Iterable, too
        given = None
    if given is None:
        raise ParameterError(f"stops {shown(stops)}", "they are points", "give a list of (x, y)")
    if not 1 <= len(given) <= MOST:
        known = "none" if not given else f"more than {MOST}"
        raise ParameterError(f"stops: {known}", f"a tour has 1 to {MOST}", "give as many, or split the tour")
    return given


@contextmanager
def _named(number: int) -> Iterator[None]:
    """Errors of a goal name the stop."""
    try:
        yield
    except (EndpointError, ParameterError) as error:
        if not error.given.startswith("goal ") or error.given.startswith("goal tolerance"):
            raise
        told = f"stop {number}{error.given[4:]}", error.rule, error.remedy
        if isinstance(error, EndpointError):
            raise type(error)("goal", *told) from None
        raise ParameterError(*told) from None


def _metres(name: str, given: Any) -> float:
    number = finite_number(given)
    if not number >= 0:
        raise ParameterError(f"{name} {shown(given)}", "it is a finite number of metres, >= 0", "give one, such as 0.2")
    return number


def _moved(queries: list[Problem]) -> list[str]:
    """What the tolerances did, in words."""
    told = [text for text in queries[0].moved_ends if text.startswith("the start ")]
    for number, query in enumerate(queries[1:], 1):
        told += [text.replace("the goal", f"stop {number}", 1) for text in query.moved_ends]
    return told


def _unreached(queries: list[Problem], apart: list[int]) -> list[str]:
    told = [f"stop {number} at ({queries[number].goal[0]:g}, {queries[number].goal[1]:g}) m" for number in apart]
    return [f"no path leads from the start to {', '.join(told)}"] if told else []


def _pathless(legs: tuple[Result, ...], visited: tuple[int, ...], failed: list[int]) -> list[str]:
    return [
        f"from place {visited[number]} to place {visited[number + 1]}: {legs[number].status.replace('_', ' ')}"
        for number in failed
    ]
