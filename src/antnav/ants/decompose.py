"""PACO's decomposition: the auxiliary cell, the two halves, and the path that is joined from them (section 4.3)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from antnav.colony.parts import Axis
from antnav.kernels.graph import SQRT2
from antnav.search.abstraction import RegionGraph
from antnav.world.grid_graph import GridGraph
from antnav.world.problem import CellIndex


def boundary(start: CellIndex, goal: CellIndex, axis: Axis) -> tuple[int, int]:
    """The dividing line: (0, row) or (1, column).

    The middle row, floor((row_start + row_goal) / 2), where rows differ at least as much as columns, else the middle
    column [paper]; `axis` can fix either one.
    """
    rows, cols = abs(start[0] - goal[0]), abs(start[1] - goal[1])
    across = 0 if axis is Axis.ROW or (axis is Axis.AUTO and rows >= cols) else 1
    return across, (start[across] + goal[across]) // 2


def auxiliary_node(
    grid_graph: GridGraph, visits: NDArray[np.int64], line: tuple[int, int], ends: tuple[int, int]
) -> int | None:
    """The node on the line that most arrived paths pass through; ties go to the first in map order.

    Parameters
    ----------
    grid_graph : GridGraph
    visits : ndarray of int64, shape (n,)
        Arrived paths of both colonies through each node.
    line : (axis, index)
        As `boundary` gives it.
    ends : (int, int)
        Start and goal, which cannot be auxiliary cells.

    Returns
    -------
    int or None
        None where no arrived path touches the line elsewhere than at the ends.
    """
    axis, index = line
    candidates = np.where(grid_graph.cells[:, axis] == index, visits, 0)
    candidates[list(ends)] = 0
    best = int(np.argmax(candidates))
    return best if candidates[best] > 0 else None


def half(grid_graph: GridGraph, line: tuple[int, int], auxiliary: int, end: int) -> GridGraph | None:
    """The graph of the side of `end`, the dividing line included.

    Returns
    -------
    GridGraph or None
        None where the auxiliary cell cannot be reached from `end` without leaving that side.
    """
    axis, index = line
    side = np.sign(grid_graph.cells[end, axis] - index)
    if side == 0:
        return None
    return _joining(grid_graph, (grid_graph.cells[:, axis] - index) * side >= 0, end, auxiliary)


def level_crossings(
    grid_graph: GridGraph, visits: NDArray[np.int64], distance: NDArray[np.float64], goal: int, pieces: int
) -> list[int]:
    """One node on each level of the distance from the start, the one that most arrived paths pass through.

    Level k of K is crossed at nodes at least k/K of the way from the start, next to a node that is less far. Every path
    to the goal passes such a node, and the pieces between have shortest paths of one length [ours].

    Parameters
    ----------
    visits : ndarray of int64, shape (n,)
        Arrived paths through each node.
    distance : ndarray of float64, shape (n,)
        Length of a shortest path from the start.
    pieces : int
        K.
    """
    padded = np.append(distance, np.inf)
    crossings: list[int] = []
    for k in range(1, pieces):
        level = distance[goal] * k / pieces
        near = np.flatnonzero((distance >= level) & (distance < level + SQRT2 + 1e-9))  # farther ones are behind them
        near = near[(near != goal) & ~np.isin(near, crossings)]
        on_level = near[padded[grid_graph.graph.neighbours[near]].min(axis=1) < level]
        if len(on_level):
            crossings.append(int(on_level[np.argmax(visits[on_level])]))
    return crossings


def band(ends: tuple[int, int], grid_graph: GridGraph, distance: NDArray[np.float64]) -> GridGraph | None:
    """The graph of the nodes whose distance from the start lies between those of two crossings, a move more or less.

    Parameters
    ----------
    ends : (int, int)
        Nodes of the two crossings.
    grid_graph : GridGraph
    distance : ndarray of float64, shape (n,)
        Length of a shortest path from the start.

    Returns
    -------
    GridGraph or None
        None where these nodes alone do not join the two.
    """
    low, high = distance[ends[0]] - SQRT2, distance[ends[1]] + SQRT2
    return _joining(grid_graph, (distance >= low) & (distance <= high), *ends)


def _joining(grid_graph: GridGraph, inside: NDArray[np.bool_], one: int, other: int) -> GridGraph | None:
    part = grid_graph.part(inside, one)
    return part if int(grid_graph.flat[other]) in part else None


def different_routes(
    paths: Sequence[NDArray[np.int32]], graph: RegionGraph, count: int, new: float = 0.2
) -> list[NDArray[np.int32]]:
    """The shortest paths through a graph of which each has much that the ones before it lack.

    Parameters
    ----------
    paths : sequence of ndarray of int32
        Nodes of each path.
    count : int
        Paths wanted at most.
    new : float
        Share of a path's nodes that no path before it has, at least.
    """
    paths = list({path.tobytes(): path for path in paths}.values())  # many ants went the same way
    lengths = graph.lengths_of(paths)
    used = np.zeros(len(graph), np.bool_)
    routes: list[NDArray[np.int32]] = []
    for index in np.argsort(lengths, kind="stable"):
        path = paths[index]
        if not routes or np.mean(~used[path]) >= new:
            routes.append(path)
            used[path] = True
        if len(routes) == count:
            break
    return routes
