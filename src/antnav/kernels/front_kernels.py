"""Searches with several objectives on a graph, compiled; all prices are whole numbers.

Arrays, here and in all kernels of fronts: `neighbours` int32 (n, 8), n where there is none; move k and move 7 - k undo
each other. `costs` int32 (n, 8, k): price of move s from node i in each objective. `turns` int32 (9, 8, k): what a move
costs more by the last move + 1, 0 before the first; of size 0 where no objective looks at turns.
"""

from __future__ import annotations

import numpy as np

from antnav.kernels import heap
from antnav.kernels.jit import jit

_FAR = 2**62


_push, _pop = jit(heap.push), jit(heap.pop)


@jit
def ideal(neighbours, costs, goal):
    """Least price to the goal from each node in each objective by itself, without turns: int64 (n, k), 2**62 if none.

    Dijkstra's algorithm from the goal, against the moves.
    """
    n, _, objectives = costs.shape
    least = np.full((n, objectives), _FAR, np.int64)
    closed = np.empty(n, np.uint8)
    keys, items = np.empty(1024, np.int64), np.empty(1024, np.int32)
    for j in range(objectives):
        closed[:] = 0
        least[goal, j] = 0
        keys[0], items[0], size = 0, goal, 1
        while size > 0:
            node = _pop(keys, items, size)
            size -= 1
            if closed[node]:
                continue
            closed[node] = 1
            for s in range(8):
                other = neighbours[node, s]
                if other == n or closed[other]:
                    continue
                price = least[node, j] + costs[other, 7 - s, j]
                if price < least[other, j]:
                    least[other, j] = price
                    if size == keys.size:
                        keys, items = np.append(keys, keys), np.append(items, items)
                    _push(keys, items, size, price, other)
                    size += 1
    return least


@jit
def weighted(neighbours, costs, turns, weights, ideal, start, goal):
    """A path of least weighted sum, by A*: nodes int32 (p,), empty where there is none.

    Parameters
    ----------
    weights : int64 (k,)
        Whole numbers >= 0.
    ideal : int64 (n, k)
        As the function of that name gives it: the weighted sum of these is what guides the search.
    """
    n, _, objectives = costs.shape
    turning = turns.size > 0
    wide = 8 if turning else 1  # states of a node: the moves that led there
    reached = np.full(n * wide, _FAR, np.int64)
    before = np.full(n * wide, -1, np.int32)
    slots = np.empty(n * wide, np.uint8)
    closed = np.zeros(n * wide, np.uint8)
    keys, items = np.empty(1024, np.int64), np.empty(1024, np.int32)
    size, state, node, last, price = 0, -1, start, 0, np.int64(0)
    while node != goal:
        for s in range(8):
            other = neighbours[node, s]
            if other == n:
                continue
            to = other * wide + (s if turning else 0)
            if closed[to] or other == start:
                continue
            found = price
            rest = np.int64(0)
            for j in range(objectives):
                step = np.int64(costs[node, s, j])
                if turning:
                    step += turns[last, s, j]
                found += weights[j] * step
                rest += weights[j] * ideal[other, j]
            if found < reached[to]:
                reached[to] = found
                before[to] = state
                slots[to] = s
                if size == keys.size:
                    keys, items = np.append(keys, keys), np.append(items, items)
                _push(keys, items, size, found + rest, to)
                size += 1
        state = -1
        while size > 0 and state < 0:
            state = _pop(keys, items, size)
            size -= 1
            if closed[state]:
                state = -1
        if state < 0:
            return np.empty(0, np.int32)
        closed[state] = 1
        node, last, price = state // wide, slots[state] + 1, reached[state]
    count, at = 1, state
    while at >= 0:
        count += 1
        at = before[at]
    path = np.empty(count, np.int32)
    at = state
    for i in range(count - 1, 0, -1):
        path[i] = at // wide
        at = before[at]
    path[0] = start
    return path


@jit
def totals(neighbours, edges, turns, lengths, nodes, sums):
    """Add up prices of paths, move by move.

    Parameters
    ----------
    edges, turns : (n, 8, k), (9, 8, k)
        Alike in type.
    lengths, nodes : int32
        How many nodes each path has, and those of all paths.
    sums : (p, k)
        Zeros; gets the prices.
    """
    k = edges.shape[2]
    at = 0
    for p in range(lengths.size):
        last = 0
        for i in range(at, at + lengths[p] - 1):
            s = 0
            while neighbours[nodes[i], s] != nodes[i + 1]:
                s += 1
            for j in range(k):
                sums[p, j] += edges[nodes[i], s, j] + turns[last, s, j]
            last = s + 1
        at += lengths[p]


@jit
def undominated(values):
    """Which vectors no other beats, of equal ones the first: bool (p,).

    Parameters
    ----------
    values : int64 (p, k)
        Sorted lexicographically: a vector can only be beaten by one before it.
    """
    count, objectives = values.shape
    kept = np.zeros(count, np.bool_)
    front = np.empty(count, np.int64)
    size = 0
    for i in range(count):
        beaten = False
        for f in range(size - 1, -1, -1):
            other = front[f]
            worse = False
            for j in range(objectives):
                if values[other, j] > values[i, j]:
                    worse = True
                    break
            if not worse:
                beaten = True
                break
        if not beaten:
            kept[i] = True
            front[size] = i
            size += 1
    return kept


@jit
def ideal_from(neighbours, costs, start):
    """Least price from the start to each node in each objective by itself, without turns; as `ideal`."""
    n, _, objectives = costs.shape
    back = np.zeros((n, 8, objectives), costs.dtype)
    for i in range(n):
        for s in range(8):
            other = neighbours[i, s]
            if other < n:
                back[other, 7 - s] = costs[i, s]
    return ideal(neighbours, back, start)


@jit
def weighed(costs, turns, weights):
    """Weighted sums of prices: int64 (n, 8) of moves, (9, 8) of turns."""
    n, _, objectives = costs.shape
    prices, corners = np.zeros((n, 8), np.int64), np.zeros((9, 8), np.int64)
    for i in range(n):
        for s in range(8):
            for j in range(objectives):
                prices[i, s] += weights[j] * costs[i, s, j]
    if turns.size > 0:
        for last in range(9):
            for s in range(8):
                for j in range(objectives):
                    corners[last, s] += weights[j] * turns[last, s, j]
    return prices, corners


@jit
def ways_home(neighbours, costs, turns, prices, corners, weights, behind, start, goal, slack):
    """Best ways to the goal for a weighted sum, from every state near the best path.

    A* from the goal against the moves, over nodes, or with turns over nodes and last moves + 1 (state 9 * node + last).
    Near: some path through the state may cost up to `slack` more than the best one.

    Parameters
    ----------
    prices, corners : int64
        As `weighed` gives them.
    behind : int64 (n, k)
        As `ideal_from` gives it: what guides the search.

    Returns
    -------
    rest : int64 (states,)
        Least weighted sum to the goal, 2**62 for states that are not near.
    values : int64 (states, k)
        Prices of that way in each objective.
    following : uint8 (states,)
        Its first move.
    """
    n, _, objectives = costs.shape
    turning = turns.size > 0
    wide = 9 if turning else 1
    rest = np.full(n * wide, _FAR, np.int64)
    values = np.empty((n * wide, objectives), np.int64)
    following = np.empty(n * wide, np.uint8)
    closed = np.zeros(n * wide, np.uint8)
    guide = np.full(n, np.int64(-1), np.int64)
    keys, items = np.empty(1 << 12, np.int64), np.empty(1 << 12, np.int32)
    size = 0
    for last in range(1 if turning else 0, wide):
        rest[goal * wide + last] = 0
        _push(keys, items, size, np.int64(0), np.int32(goal * wide + last))
        size += 1
    limit = np.int64(_FAR)
    while size > 0:
        key = keys[0]
        if key > limit:
            break
        state = _pop(keys, items, size)
        size -= 1
        if closed[state]:
            continue
        closed[state] = 1
        node, last = state // wide, state % wide
        if node == goal:
            for j in range(objectives):
                values[state, j] = 0
        else:
            s = following[state]
            to = neighbours[node, s] * wide + (s + 1 if turning else 0)
            for j in range(objectives):
                values[state, j] = values[to, j] + costs[node, s, j]
                if turning:
                    values[state, j] += turns[last, s, j]
        if node == start:
            limit = key + slack
            continue
        for back in range(8):
            s = 7 - back
            if turning and s != last - 1:
                continue
            other = neighbours[node, back]
            if other in (n, goal):
                continue
            if guide[other] < 0:
                guide[other] = 0
                for j in range(objectives):
                    guide[other] += weights[j] * behind[other, j]
            if size + 9 > keys.size:
                keys, items = np.append(keys, keys), np.append(items, items)
            price = rest[state] + prices[other, s]
            if not turning:
                if price < rest[other] and price + guide[other] <= limit:
                    rest[other] = price
                    following[other] = s
                    _push(keys, items, size, price + guide[other], other)
                    size += 1
                continue
            for before in range(0 if other == start else 1, 1 if other == start else 9):
                whole = price + corners[before, s]
                to = other * 9 + before
                if whole < rest[to] and whole + guide[other] <= limit:
                    rest[to] = whole
                    following[to] = s
                    _push(keys, items, size, whole + guide[other], np.int32(to))
                    size += 1
    for state in range(n * wide):
        if not closed[state]:
            rest[state] = _FAR
    return rest, values, following
