"""Remaining costs as a search on a map of lower resolution estimates them."""

from __future__ import annotations

from itertools import product

import numpy as np
from numpy.typing import NDArray

from antnav.kernels.graph import PlacedGraph


def estimated_costs(grid_graph: PlacedGraph, goal: int, side: int) -> NDArray[np.float64]:
    """Cost from every node to the goal, estimated on blocks of `side` x `side` cells, shape (n,).

    A block stands for its nodes: it lies at their mean place, and crossing it costs the harmonic mean of what its moves
    cost per cell. Blocks are neighbours where a move leads from one to the other; that costs their distance times the
    mean of both. Between places of blocks costs are interpolated (bilinear, over the blocks around a node that have
    any).
    """
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import dijkstra

    cells, n = grid_graph.cells, len(grid_graph)
    row, col = (cells // side).T
    wide = int(col.max()) + 3  # a ring of blocks without nodes spares bounds tests
    numbers, block = np.unique((row + 1) * wide + col + 1, return_inverse=True)
    count = len(numbers)
    place = np.stack([np.bincount(block, weights=along) for along in cells.T], axis=-1) / np.bincount(block)[:, None]

    tail, slot = np.nonzero(grid_graph.graph.neighbours < n)
    head = grid_graph.graph.neighbours[tail, slot]
    steps = np.sqrt(((cells[tail] - cells[head]) ** 2).sum(axis=1).astype(np.float64))
    per_cell = grid_graph.graph.lengths[tail, slot] / steps
    price = np.bincount(block[tail], minlength=count) / np.maximum(
        np.bincount(block[tail], 1.0 / per_cell, minlength=count), 1e-300
    )

    one, other = np.divmod(np.unique(block[head].astype(np.int64) * count + block[tail]), count)
    away = np.sqrt(((place[one] - place[other]) ** 2).sum(axis=1)) * 0.5 * (price[one] + price[other])
    between = coo_array((away, (one, other)), shape=(count, count)).tocsr()  # from head to tail: against the moves
    cost = dijkstra(between, indices=block[goal])

    at = np.full(int(numbers[-1]) + wide + 2, -1)
    at[numbers] = np.arange(count)
    total, weight = np.zeros(n), np.zeros(n)
    for down, right in product((-1, 0, 1), repeat=2):
        near = at[(row + 1 + down) * wide + col + 1 + right]
        share = np.where(near < 0, 0.0, np.prod(np.maximum(1 - np.abs(cells - place[near]) / side, 0.0), axis=1))
        share[~np.isfinite(cost[near])] = 0.0
        total += share * np.where(share > 0, cost[near], 0.0)
        weight += share
    estimate: NDArray[np.float64] = np.where(weight > 0, total / np.maximum(weight, 1e-300), cost[block])
    estimate[goal] = 0.0
    return estimate
