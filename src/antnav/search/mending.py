"""Mending: an earlier path made a path of another problem, its gaps searched exactly."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from antnav.kernels import grid_kernels
from antnav.search.windows import without_loops
from antnav.world.problem import Problem


def mended(path: NDArray[np.int32], problem: Problem) -> NDArray[np.int32] | None:
    """What is left of a path on the map of a problem whose ends are connected, as a path from its start to its goal.

    It begins with the cell nearest to the start and ends with that nearest to the goal. Where two of its cells are no
    legal move apart any more, a shortest path joins them.

    Parameters
    ----------
    path : ndarray of int32, shape (k,)
        Flat cells of the padded map.

    Returns
    -------
    ndarray of int32 or None
        Flat cells; None where nothing is left on the way.
    """
    graph, (start, goal) = problem.graph, problem.flat_ends
    node = np.minimum(np.searchsorted(graph.flat, path), len(graph) - 1)
    left = node[graph.flat[node] == path]
    if not len(left):
        return None
    away = [((graph.cells[left] - problem.from_flat(end)) ** 2).sum(axis=1) for end in (start, goal)]
    left = left[away[0].argmin() : away[1].argmin() + 1]
    if not len(left):
        return None
    nodes = np.concatenate(([graph.node(problem.start_cell)], left, [graph.node(problem.goal_cell)]))
    nodes = nodes[np.append(True, nodes[1:] != nodes[:-1])]
    legal = (graph.graph.neighbours[nodes[:-1]] == nodes[1:, None]).any(axis=1)
    pieces: list[NDArray[Any]] = []
    for ends, moves in zip(pairwise(graph.flat[nodes].astype(np.int64)), legal, strict=True):
        stops = np.array(ends)
        joined = stops if moves else grid_kernels.joined(graph.moves, graph.width, stops, problem.objective.prices)[0]
        pieces.append(joined[:-1])
    return without_loops(np.concatenate([*pieces, [goal]]).astype(np.int32))


def shortened(path: NDArray[np.int32], problem: Problem) -> NDArray[np.int32]:
    """The path with jumps: from each cell to the farthest later one that is a legal move away, if that costs less."""
    graph, nodes = problem.graph, np.searchsorted(problem.graph.flat, path)
    kept, place = [path[0]], 0
    while place < len(path) - 1:
        near = np.isin(nodes[place + 1 :], graph.graph.neighbours[nodes[place]])
        place += 1 + int(np.flatnonzero(near)[-1])
        kept.append(path[place])
    short = np.array(kept, np.int32)
    return short if problem.cost_along(short) < problem.cost_along(path) else path
