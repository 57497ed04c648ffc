"""The regions near a route over regions, and their graph: what ants on a large map are given. Compiled.

Regions and crossings are those of `grid_kernels`. What a query costs follows the route, but for a byte a region.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from antnav.kernels import heap
from antnav.kernels.grid_kernels import climb, octile, region_table, through
from antnav.kernels.jit import jit

_push, _pop = jit(heap.push), jit(heap.pop)


class Crossings(NamedTuple):
    """Regions of a map and the crossings between them, as `grid_kernels.crossings` gives them."""

    width: int  #: columns of the padded map
    region: np.ndarray  #: int32, flat
    centre: np.ndarray  #: int32 (regions,)
    price: np.ndarray  #: float64 (regions,)
    first: np.ndarray  #: int32 (regions + 1,)
    other: np.ndarray  #: int32, a crossing each, as the next ones
    leave: np.ndarray  #: int32
    enter: np.ndarray  #: int32
    length: np.ndarray  #: float64


@jit
def parts(first, other):
    """Connected component of each region, int32: 0, 1, ..."""
    part = np.full(first.size - 1, -1, np.int32)
    stack = np.empty(part.size, np.int32)
    count = 0
    for begin in range(part.size):
        if part[begin] >= 0:
            continue
        part[begin] = count
        stack[0] = begin
        size = 1
        while size > 0:
            size -= 1
            this = stack[size]
            for e in range(first[this], first[this + 1]):
                if part[other[e]] < 0:
                    part[other[e]] = count
                    stack[size] = other[e]
                    size += 1
        count += 1
    return part


@jit
def _apart(one, two, width):
    return octile(two // width - one // width, two % width - one % width)


@jit
def _length(short, heights, start, goal, this, e):
    """Length through a crossing of region `this` where that, or the one behind, is that of start or goal."""
    first, last = short.region[start], short.region[goal]
    two = short.other[e]
    here = goal if this == last else start if this == first else short.centre[this]
    there = goal if two == last else start if two == first else short.centre[two]
    leave, enter = short.leave[e], short.enter[e]
    near, far = _apart(here, leave, short.width), _apart(enter, there, short.width)
    step = _apart(leave, enter, short.width)
    one_price, two_price = short.price[this], short.price[two]
    if this < two:  # the way back is as long to the last digit
        return through(near, step, far, one_price, two_price) + climb(heights, here, leave, enter, there)
    return through(far, step, near, two_price, one_price) + climb(heights, there, enter, leave, here)


@jit
def _route(short, heights, start, goal):
    """The regions of a cheapest route from goal to start, by A*; both are connected."""
    width, centre = short.width, short.centre
    ends = short.region[start], short.region[goal]
    first, last = ends
    goal_row, goal_col = goal // width, goal % width
    cost = np.empty(centre.size, np.float64)
    ahead = np.empty(centre.size, np.float64)
    before = np.empty(centre.size, np.int32)
    state = np.zeros(centre.size, np.uint8)  # 1 where reached, 2 where done with
    keys = np.empty(1024, np.float64)
    items = np.empty(1024, np.int32)
    cost[first], state[first] = 0.0, 1
    keys[0], items[0] = 0.0, first
    size = 1
    while state[last] != 2:
        this = _pop(keys, items, size)
        size -= 1
        if state[this] == 2:
            continue
        state[this] = 2
        for e in range(short.first[this], short.first[this + 1]):
            two = short.other[e]
            if state[two] == 2:
                continue
            length = short.length[e]
            if this in ends or two in ends:  # calls are dear: each counts references to eight arrays
                length = _length(short, heights, start, goal, this, e)
            reached = cost[this] + length
            if state[two] == 1 and reached >= cost[two]:
                continue
            if state[two] == 0:
                there = goal if two == last else centre[two]
                ahead[two] = octile(there // width - goal_row, there % width - goal_col)
            cost[two], before[two], state[two] = reached, this, 1
            if size == keys.size:
                keys, items = np.append(keys, keys), np.append(items, items)
            _push(keys, items, size, reached + ahead[two], two)
            size += 1
    count, this = 1, last
    while this != first:
        this = before[this]
        count += 1
    route = np.empty(count, np.int32)
    this = last
    for i in range(count):
        route[i] = this
        if this != first:
            this = before[this]
    return route


@jit
def _around(short, route, reach):
    """The regions at most so many crossings from a route, in order, and for each region of the map its place there."""
    place = np.full(short.centre.size, -1, np.int32)
    near = np.empty(max(1024, 2 * route.size), np.int32)
    size = 0
    for region in route:
        near[size], place[region] = region, 0
        size += 1
    begin = 0
    for _ in range(reach):
        end = size
        for i in range(begin, end):
            this = near[i]
            for e in range(short.first[this], short.first[this + 1]):
                two = short.other[e]
                if place[two] < 0:
                    if size == near.size:
                        near = np.append(near, near)
                    near[size], place[two] = two, 0
                    size += 1
        begin = end
    near = np.sort(near[:size])
    for i in range(size):
        place[near[i]] = i
    return near, place


@jit
def corridor(short, heights, start, goal, reach):
    """The graph of the regions near a cheapest route between two cells that the map connects.

    Parameters
    ----------
    short : Crossings
    heights : float64
        `Prices.heights`.
    start, goal : int
        Flat cells; their regions lie where they are, not at their centres.
    reach : int
        Regions at most so many crossings from the route are near.

    Returns
    -------
    (owner, flat, crossing, start, goal, neighbours, lengths, reverse)
        Of each node: owner int32, its region; flat int64, the cell that stands for it; crossing int32 (nodes, 8), the
        crossing of each edge, -1 for none. Nodes of start and goal. The rest as in `Graph`, see
        `grid_kernels.region_table`.
    """
    near, place = _around(short, _route(short, heights, start, goal), reach)
    first = np.zeros(near.size + 1, np.int32)
    for i in range(near.size):
        degree = 0
        for e in range(short.first[near[i]], short.first[near[i] + 1]):
            degree += place[short.other[e]] >= 0
        first[i + 1] = first[i] + degree
    number = np.empty(first[-1], np.int32)
    other = np.empty(number.size, np.int32)
    length = np.empty(number.size, np.float64)
    ends = short.region[start], short.region[goal]
    at = 0
    for this in near:
        for e in range(short.first[this], short.first[this + 1]):
            if place[short.other[e]] >= 0:
                number[at], other[at] = e, place[short.other[e]]
                length[at] = short.length[e]
                if this in ends or short.other[e] in ends:
                    length[at] = _length(short, heights, start, goal, this, e)
                at += 1
    owner, node, slot, neighbours, lengths, reverse = region_table(first, other, length)
    crossing = np.full((owner.size, 8), -1, np.int32)
    for i in range(number.size):
        crossing[node[i], slot[i]] = number[i]
    nodes = np.array([-1, -1])
    flat = np.empty(owner.size, np.int64)
    for i in range(owner.size - 1, -1, -1):
        owner[i] = near[owner[i]]
        flat[i] = short.centre[owner[i]]
        for k, cell in enumerate((start, goal)):
            if owner[i] == short.region[cell]:
                flat[i], nodes[k] = cell, i  # of a chain, its first node
    return owner, flat, crossing, nodes[0], nodes[1], neighbours, lengths, reverse
