"""Routes made of two halves, from `grid_kernels.two_sides`, and cells near a path. Compiled.

A state is 2 * cell or 2 * cell + 1; cells are flat indices into the padded map of legal moves.
"""

from __future__ import annotations

import numpy as np

from antnav.kernels.graph import SQRT2
from antnav.kernels.jit import jit

_DIAGONAL = np.array([1, 0, 1, 0, 0, 1, 0, 1], np.int32)


@jit
def cheapest_by_side(out_cost, out_total, home_cost, home_total, above, limit):
    """The cheapest pairs of a state from the start and one from the goal at one cell, one for each side.

    Parameters
    ----------
    out_cost, out_total : float64 and int64 (2 n,)
        Cost and sum of the halves from the start; `home_...` of those from the goal.
    above, limit : float
        Pairs that cost more than one and no more than the other are returned.

    Returns
    -------
    (side, cost, out, home)
        side int64: sum of the whole route; cost float64; states int32. In no order.
    """
    capacity = 1024  # of a table with open addresses; the sums are random numbers
    mask = np.int64(capacity - 1)
    sides = np.empty(capacity, np.int64)
    costs = np.full(capacity, np.inf)
    pairs = np.empty((capacity, 2), np.int32)
    count = 0
    for cell in range(out_cost.size // 2):
        for pair in range(4):
            out, home = 2 * cell + (pair & 1), 2 * cell + (pair >> 1)
            cost = out_cost[out] + home_cost[home]
            if not cost <= limit:
                continue
            side = out_total[out] - home_total[home]
            at = side & mask
            while costs[at] < np.inf and sides[at] != side:
                at = (at + 1) & mask
            if cost >= costs[at]:
                continue
            count += costs[at] == np.inf
            sides[at], costs[at], pairs[at, 0], pairs[at, 1] = side, cost, out, home
            if 2 * count > capacity:
                used = np.flatnonzero(costs < np.inf)
                old_sides, old_costs, old_pairs = sides[used], costs[used], pairs[used]
                capacity *= 2
                mask = np.int64(capacity - 1)
                sides = np.empty(capacity, np.int64)
                costs = np.full(capacity, np.inf)
                pairs = np.empty((capacity, 2), np.int32)
                for i in range(used.size):
                    at = old_sides[i] & mask
                    while costs[at] < np.inf:
                        at = (at + 1) & mask
                    sides[at], costs[at], pairs[at] = old_sides[i], old_costs[i], old_pairs[i]
    used = np.flatnonzero((costs < np.inf) & (costs > above))
    return sides[used], costs[used], pairs[used, 0].copy(), pairs[used, 1].copy()


@jit
def half(parent, state):
    """Flat cells, int32, from the end at which the halves begin to the cell of a state."""
    count, at = 0, state
    while at >= 0:
        count += 1
        at = parent[at]
    path = np.empty(count, np.int32)
    for i in range(count - 1, -1, -1):
        path[i] = state >> 1
        state = parent[state]
    return path


@jit
def shared(parent, width, states, near):
    """Length of the half to each of some states, and how much of it lies inside `near`: float64 (n,) each.

    A move is inside where both of its cells are; near is uint8, flat.
    """
    length = np.full(parent.size, -1.0)
    inside = np.zeros(parent.size, np.float64)
    stack = np.empty(parent.size, np.int32)
    for state in states:
        size, at = 0, state
        while length[at] < 0.0:
            if parent[at] < 0:
                length[at] = 0.0
                break
            stack[size] = at
            size += 1
            at = parent[at]
        for i in range(size - 1, -1, -1):
            after = stack[i]
            apart = abs((after >> 1) - (at >> 1))
            step = 1.0 if apart in (1, width) else SQRT2
            length[after] = length[at] + step
            inside[after] = inside[at] + (step if near[at >> 1] and near[after >> 1] else 0.0)
            at = after
    return length[states], inside[states]


@jit
def near(moves, width, path, reach):
    """Cells from which a way of at most `reach` cells leads to a path: uint8, flat."""
    offsets = np.array([-width - 1, -width, -width + 1, -1, 1, width - 1, width, width + 1], np.int64)
    length = np.full(moves.size, np.inf)
    found = np.zeros(moves.size, np.uint8)
    front = path.copy()
    for cell in front:
        length[cell] = 0.0
        found[cell] = 1
    while front.size > 0:
        after = np.empty(8 * front.size, np.int32)
        size = 0
        for cell in front:
            for k in range(8):
                other = cell + offsets[k]
                reached = length[cell] + (SQRT2 if _DIAGONAL[k] else 1.0)
                if moves[cell] >> k & 1 and reached <= reach and reached < length[other]:
                    length[other] = reached
                    found[other] = 1
                    after[size] = other
                    size += 1
        front = after[:size].copy()
    return found
