"""Exact planners: the optimum that every result is measured against."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from antnav.errors import ParameterError, shown
from antnav.kernels import grid_kernels, straight_kernels
from antnav.search import windows
from antnav.values import read_only
from antnav.world.moves import CornerRule
from antnav.world.path import Path
from antnav.world.problem import CellIndex, Problem, check_problem

#: What `shortest_path` takes.
METHODS = ("auto", "astar", "dijkstra", "jps")


@dataclass(frozen=True)
class Optimum:
    """What an exact search found.

    Attributes
    ----------
    path : Path or None
        A shortest path, with few turns; None where none exists.
    cost : float
        Its cost in cells, which is its length where the problem has no costs; inf where none exists.
    expanded : int
        Cells taken from the queue.
    seconds : float
        Wall time of the search.
    """

    path: Path | None
    cost: float
    expanded: int
    seconds: float

    @property
    def length(self) -> float:
        """Length of the path in cells; inf where none exists."""
        return self.path.length if self.path else math.inf


def shortest_path(problem: Problem, method: str = "auto") -> Optimum:
    """A shortest path, by jump point search (Harabor & Grastien), A* (Hart, Nilsson & Raphael) or Dijkstra's algorithm.

    Parameters
    ----------
    problem : Problem
    method : {"auto", "astar", "dijkstra", "jps"}
        All are exact, and may find different ones of several shortest paths. "jps" looks at far fewer cells than
        "astar", and that at fewer than "dijkstra". "auto" is "jps" where cost is length, "astar" elsewhere.

    Raises
    ------
    ParameterError
        No such method, or "jps" on a problem with costs or a price of turns.

    Examples
    --------
    >>> import antnav as an
    >>> problem = an.Problem.from_cells(an.maps.builtin("equiv20"), start=(0, 0), goal=(19, 19))
    >>> an.exact.shortest_path(problem).path
    Path(27 cells, (0, 0) -> (19, 19), length=30.9706 cells = 30.971 m)
    """
    check_problem(problem)
    if not isinstance(method, str) or method not in METHODS:
        rule = f"the exact methods are {', '.join(METHODS)}"
        raise ParameterError(f"method {shown(method)}", rule, "choose one of them")
    blocks_only = problem.turning == 0 and problem.cost is not None and not problem.cost.prices
    if method == "jps" and not (problem.objective.plain or blocks_only):
        rule = "jump point search needs moves that cost their length, and turns that cost nothing"
        raise ParameterError("method 'jps'", rule, "choose astar, or leave the costs out")
    begin = time.perf_counter()
    if method == "jps" or (method == "auto" and problem.objective.plain):
        return _jumped(problem, begin)
    start, goal = problem.flat_ends
    moves, objective, guided = problem.flat_moves, problem.objective, method != "dijkstra"
    turns, prices = objective.turns(), objective.prices
    if turns is not None:
        _, flat, expanded = grid_kernels.search_turning(
            moves, problem.width, start, goal, guided, prices, turns, 0, -1, math.inf
        )
        return _optimum(problem, flat if len(flat) else None, int(expanded), time.perf_counter() - begin)
    length, parent, expanded = grid_kernels.search(moves, problem.width, start, goal, guided, prices)
    if math.isinf(length[goal]):
        return _optimum(problem, None, int(expanded), time.perf_counter() - begin)
    flat = grid_kernels.trace(parent, problem.width, start, goal)
    seconds = time.perf_counter() - begin
    if objective.plain:
        flat = straight_kernels.fewest_turns(flat, moves, problem.width)
    else:
        flat = windows.straightened(flat, problem.terrain)
    return _optimum(problem, flat, int(expanded), seconds)


def _jumped(problem: Problem, begin: float) -> Optimum:
    from antnav.kernels import jump_kernels  # milliseconds that an import need not take

    terrain, moves = problem.terrain, problem.flat_moves
    rows, cols = problem.grid.shape
    box = 1, rows + 1, 1, cols + 1
    flat, expanded = jump_kernels.jump_search(moves, terrain.width, terrain.jumps, box, *problem.flat_ends, math.inf)
    if len(flat):
        flat = straight_kernels.fewest_turns(flat, moves, terrain.width)
    return _optimum(problem, flat if len(flat) else None, int(expanded), time.perf_counter() - begin)


def _optimum(problem: Problem, flat: NDArray[np.int32] | None, expanded: int, seconds: float) -> Optimum:
    if flat is None:
        return Optimum(None, math.inf, expanded, seconds)
    cells = problem.from_flat(flat).astype(np.int32)
    path = Path(cells, problem.grid, problem.start, problem.goal)
    return Optimum(path, problem.objective.of(cells, problem.grid), expanded, seconds)


def distance_field(problem: Problem, cell: CellIndex | None = None) -> NDArray[np.float64]:
    """Exact distance, or cost, from every cell to `cell` (default: the goal), by Dijkstra's algorithm.

    Returns
    -------
    ndarray of float64, shape (rows, cols)
        In cells; inf where there is no way.

    Notes
    -----
    Moves cost the same in both directions, but for slopes: then this is the cost of the way to the cell.
    """
    check_problem(problem)
    source = problem.to_flat(problem.goal_cell if cell is None else cell)
    length, _, _ = grid_kernels.search(problem.flat_moves, problem.width, source, -1, False, problem.objective.prices)
    costs = problem.objective.towards(source, length)
    field: NDArray[np.float64] = costs.reshape(problem.moves.shape)[1:-1, 1:-1]
    return field


@dataclass(frozen=True, eq=False)
class ShortestLine:
    """The shortest line at any angle.

    Attributes
    ----------
    points : ndarray of float64, shape (k, 2)
        x and y in metres of its ends and corners; empty where none exists.
    path : Path or None
        Legal moves along it, for whoever wants cells, such as `antnav.trajectory`; None where none exists.
    length : float
        In cells; inf where none exists.
    expanded : int
        Intervals and corners taken from the queue.
    seconds : float
        Wall time of the search.
    """

    points: NDArray[np.float64]
    path: Path | None
    length: float
    expanded: int
    seconds: float


def any_angle(problem: Problem) -> ShortestLine:
    """The shortest line at any angle from the exact start to the exact goal: no path of the problem is shorter.

    Exact, by intervals of rows as Anya searches them (Harabor, Grastien, Oz & Aksakalli 2016, doi 10.1613/jair.5007).

    Notes
    -----
    The line is that of a point: it may run along walls and touch their corners, which are the squares of cells that
    the robot may not enter. It passes between two of them that touch at a corner under corner rule "allow" only. Where
    an end lies off its cell's centre, a first or last diagonal move past an obstacle, which "graze" and "allow" let
    pass, may cut that obstacle's corner and be shorter. It looks at lengths; what cells and turns cost is another
    matter.
    """
    check_problem(problem)
    return _any_angle(problem, np.array([problem.start, problem.goal]))


def any_angle_bound(problem: Problem) -> float | None:
    """Length in cells of the shortest line at any angle between the centres of the ends' cells, once for each problem.

    Returns
    -------
    float or None
        inf where no path exists; None where the problem has costs, of which a length says nothing.
    """
    check_problem(problem)
    if not problem.objective.plain:
        return None
    ends = problem.grid.cell_to_world([problem.start_cell, problem.goal_cell])
    return problem.kept.of(ShortestLine, None, lambda: _any_angle(problem, ends)).length


def _any_angle(problem: Problem, ends: NDArray[np.float64]) -> ShortestLine:
    from antnav.kernels import any_angle_kernels

    if not problem.connected:
        return ShortestLine(np.empty((0, 2)), None, math.inf, 0, 0.0)
    begin = time.perf_counter()
    closed = np.pad(~problem.passable, 1, constant_values=True).view(np.uint8)
    plane = problem.grid.world_to_plane(ends) + 1.5  # the kernel counts from the corner of the cells all round
    halves = np.rint(2 * plane) / 2
    plane = np.where(np.abs(plane - halves) < 1e-9, halves, plane)
    line, expanded = any_angle_kernels.shortest_line(closed, problem.corner_rule is CornerRule.ALLOW, plane)
    seconds = time.perf_counter() - begin
    points = problem.grid.cell_to_world(line[:, ::-1] - 1.5)
    points[0], points[-1] = ends
    length = float(np.hypot(*np.diff(line, axis=0).T).sum())
    cells = any_angle_kernels.cells_along(closed, line, np.array([problem.start_cell, problem.goal_cell]) + 1)
    path = Path(cells - 1, problem.grid, *map(tuple, ends.tolist()))
    return ShortestLine(read_only(points), path, length, int(expanded), seconds)


def optimum(problem: Problem) -> Optimum:
    """`shortest_path`, searched once for each problem: a thousand runs share one yardstick."""
    check_problem(problem)
    return problem.kept.of(Optimum, None, lambda: shortest_path(problem))
