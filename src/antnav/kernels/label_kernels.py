"""Labels of paths with several costs, compiled: exact multi-objective search.

Label setting with A*'s bounds (Mandow & Perez-de-la-Cruz 2010, doi:10.1145/1754399.1754400). Labels leave the heap by
their first cost, so that dominance is a matter of the others, the *truncated* vector (NAMOA*dr: Pulido, Mandow &
Perez-de-la-Cruz 2015, doi:10.1016/j.cor.2015.05.007). Each node and the goal keep the truncated vectors that no other
of theirs covers, and a label is looked at when it leaves the heap (LTMOA*: Hernandez et al. 2023,
doi:10.24963/ijcai.2023/803; EMOA*: Ren et al. 2022). With two costs the set of a node is one number
(BOA*: Hernandez et al. 2023, doi:10.1016/j.artint.2022.103807).

A state is a node, or where turns have costs node * 9 + last move + 1 (0: none yet). Costs are whole numbers.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from antnav.kernels.jit import jit

#: Larger than any cost of a path: what lies beyond counts as unreachable.
FAR = np.int32(2**31 - 1)
#: Places of `Search.counts`.
MADE, OPEN, POPPED, FOUND, USED, ROOM = range(6)
#: Why `advance` came back: the front is complete; it should go on; arrays are too short; a cost grew too large.
DONE, MORE, FULL, OVERFLOW = range(4)
#: Sizes of a set in the pool are powers of two from this one on.
_LEAST = 2


class Network(NamedTuple):
    """What is searched."""

    neighbours: np.ndarray  #: int32 (n, 8), n where there is none
    costs: np.ndarray  #: int32 (n, 8, k)
    turns: np.ndarray  #: int32 (9, 8, k), by last move + 1 and next move; size 0 where they cost nothing
    gaps: np.ndarray  #: int64 (9, 9, k): the most by which one last move's turns cost more than another's
    bounds: np.ndarray  #: int32 (states, k): least cost from each state to the goal
    goal: int


class Search(NamedTuple):
    """A search that can be taken up again."""

    labels: np.ndarray  #: int32 (capacity, 2 + k): parent, state, costs from the start
    keys: np.ndarray  #: int64 (capacity,): the heap
    items: np.ndarray  #: int32 (capacity,): labels of the heap
    pool: np.ndarray  #: int32: the sets' entries, k numbers each: truncated vector and last move + 1
    first: np.ndarray  #: int64 (n + 1,): where a node's set begins; of the goal's reached labels last
    size: np.ndarray  #: int32 (n + 1,)
    room: np.ndarray  #: int32 (n + 1,)
    spare: np.ndarray  #: int64 (32,): outgrown pieces of the pool by size, linked; -1 where there is none
    found: np.ndarray  #: int32 (capacity,): labels that make the front
    counts: np.ndarray  #: int64 (6,)


@jit
def _push(keys, items, size, key, item):
    """Put an item into a heap with four children a node."""
    i = size
    while i > 0:
        parent = (i - 1) >> 2
        if keys[parent] <= key:
            break
        keys[i] = keys[parent]
        items[i] = items[parent]
        i = parent
    keys[i] = key
    items[i] = item


@jit
def _pop(keys, items, size):
    """Take the least item from a heap of `size` items."""
    item = items[0]
    size -= 1
    key, moved = keys[size], items[size]
    i = 0
    while True:
        first = 4 * i + 1
        if first >= size:
            break
        least = first
        for child in range(first + 1, min(first + 4, size)):
            if keys[child] < keys[least]:
                least = child
        if keys[least] >= key:
            break
        keys[i] = keys[least]
        items[i] = items[least]
        i = least
    keys[i] = key
    items[i] = moved
    return item


@jit
def arrivals(neighbours):
    """Edges by the node that they lead to: (begin int64 (n + 1,), edges int32), an edge is node * 8 + slot."""
    n = neighbours.shape[0]
    begin = np.zeros(n + 2, np.int64)
    for i in range(n):
        for slot in range(8):
            begin[neighbours[i, slot] + 1] += 1
    for i in range(n):
        begin[i + 1] += begin[i]
    fill = begin[:n].copy()
    edges = np.empty(begin[n], np.int32)
    for i in range(n):
        for slot in range(8):
            other = neighbours[i, slot]
            if other < n:
                edges[fill[other]] = 8 * i + slot
                fill[other] += 1
    return begin[: n + 1], edges


@jit
def bound(begin, edges, costs, j, goal):
    """Least cost j from each node to the goal, by Dijkstra's algorithm over reversed edges; int32 (n,)."""
    n = begin.size - 1
    least = np.full(n, FAR, np.int32)
    keys = np.empty(8 * n + 8, np.int64)
    items = np.empty(8 * n + 8, np.int32)
    least[goal] = 0
    keys[0], items[0] = 0, goal
    size = 1
    while size > 0:
        key = keys[0]
        node = _pop(keys, items, size)
        size -= 1
        if key > least[node]:
            continue
        for at in range(begin[node], begin[node + 1]):
            edge = edges[at]
            cost = key + costs[edge >> 3, edge & 7, j]
            if cost < least[edge >> 3]:
                least[edge >> 3] = cost
                _push(keys, items, size, cost, edge >> 3)
                size += 1
    return least


@jit
def bound_turning(begin, edges, costs, turns, j, goal):
    """The same from each state, over nodes and last moves; int32 (9 n,)."""
    n = begin.size - 1
    least = np.full(9 * n, FAR, np.int32)
    keys = np.empty(1 << 10, np.int64)
    items = np.empty(1 << 10, np.int32)
    size = 0
    for last in range(9):
        least[9 * goal + last] = 0
        _push(keys, items, size, 0, 9 * goal + last)
        size += 1
    while size > 0:
        key = keys[0]
        state = _pop(keys, items, size)
        size -= 1
        if key > least[state]:
            continue
        node, move = state // 9, state % 9 - 1
        for at in range(begin[node], begin[node + 1]):
            edge = edges[at]
            if edge & 7 != move:
                continue
            before = edge >> 3
            if size + 9 > keys.size:
                keys = np.concatenate((keys, np.empty_like(keys)))
                items = np.concatenate((items, np.empty_like(items)))
            for last in range(9):
                cost = key + costs[before, move, j] + turns[last, move, j]
                if cost < least[9 * before + last]:
                    least[9 * before + last] = cost
                    _push(keys, items, size, cost, 9 * before + last)
                    size += 1
    return least


@jit
def _covered(pool, first, size, vector, last, gaps, k):
    """Whether a set holds a vector that is nowhere worse than this one, whatever the next move."""
    for i in range(size):
        at = first + i * k
        before = pool[at + k - 1]
        j = 1
        while j < k and pool[at + j - 1] + gaps[before, last, j] <= vector[j]:
            j += 1
        if j == k:
            if i > 0:  # who covered one is likely to cover the next: one place forward
                for c in range(at, at + k):
                    pool[c], pool[c - k] = pool[c - k], pool[c]
            return True
    return False


@jit
def _insert(search, place, vector, last, gaps, k):
    """Put a vector into a set and take out those that it covers. The pool must have room."""
    pool, begin = search.pool, search.first[place]
    kept = 0
    for i in range(search.size[place]):
        at = begin + i * k
        after = pool[at + k - 1]
        j = 1
        while j < k and vector[j] + gaps[last, after, j] <= pool[at + j - 1]:
            j += 1
        if j < k:
            if kept < i:
                for c in range(k):
                    pool[begin + kept * k + c] = pool[at + c]
            kept += 1
    room = search.room[place]
    if kept == room:
        larger = max(_LEAST, 2 * room)
        level = 0
        while 1 << level < larger:
            level += 1
        new = search.spare[level]
        if new >= 0:
            search.spare[level] = pool[new]
        else:
            new = search.counts[USED]
            search.counts[USED] += larger * k
        for c in range(kept * k):
            pool[new + c] = pool[begin + c]
        if room > 0:
            pool[begin] = search.spare[level - 1]
            search.spare[level - 1] = begin
        search.counts[ROOM] = max(search.counts[ROOM], larger)
        search.first[place], search.room[place] = new, larger
        begin = new
    for j in range(1, k):
        pool[begin + kept * k + j - 1] = vector[j]
    pool[begin + kept * k + k - 1] = last
    search.size[place] = kept + 1


@jit
def advance(network, search, pops, limit):
    """Take up to `pops` labels from the heap, making up to `limit` in all; DONE, MORE, FULL or OVERFLOW."""
    neighbours, costs, turns, gaps, bounds, goal = network
    labels, keys, items, counts = search.labels, search.keys, search.items, search.counts
    n, k = neighbours.shape[0], costs.shape[2]
    turning = turns.size > 0
    reached = np.empty(k, np.int32)  # costs from the start
    whole = np.empty(k, np.int32)  # least costs of paths on from there
    for _ in range(pops):
        if counts[OPEN] == 0:
            return DONE
        if (
            counts[MADE] + 8 > min(limit, labels.shape[0])
            or counts[USED] + k * max(_LEAST, 2 * counts[ROOM]) > search.pool.size
        ):
            return FULL
        label = _pop(keys, items, counts[OPEN])
        counts[OPEN] -= 1
        counts[POPPED] += 1
        state = labels[label, 1]
        node, last = (state // 9, state % 9) if turning else (state, 0)
        for j in range(k):
            reached[j] = labels[label, 2 + j]
            whole[j] = reached[j] + bounds[state, j]
        if _covered(search.pool, search.first[n], search.size[n], whole, 0, gaps, k):
            continue
        if node == goal:
            _insert(search, n, whole, 0, gaps, k)
            search.found[counts[FOUND]] = label
            counts[FOUND] += 1
            continue
        if _covered(search.pool, search.first[node], search.size[node], reached, last, gaps, k):
            continue
        _insert(search, node, reached, last, gaps, k)
        for slot in range(8):
            other = neighbours[node, slot]
            if other == n:
                continue
            after = 9 * other + slot + 1 if turning else other
            if bounds[after, 0] == FAR:
                continue
            made = counts[MADE]
            key, rest = np.int64(0), np.int64(0)
            for j in range(k):
                cost = np.int64(reached[j]) + costs[node, slot, j]
                if turning:
                    cost += turns[last, slot, j]
                labels[made, 2 + j] = cost
                cost += bounds[after, j]
                whole[j] = cost
                if cost >= FAR:
                    return OVERFLOW
                if j == 0:
                    key = cost << 32
                else:
                    rest += cost
            if rest >= 1 << 32:
                return OVERFLOW
            if _covered(search.pool, search.first[n], search.size[n], whole, 0, gaps, k):
                continue
            if _covered(
                search.pool,
                search.first[other],
                search.size[other],
                labels[made, 2:],
                slot + 1 if turning else 0,
                gaps,
                k,
            ):
                continue
            labels[made, 0] = label
            labels[made, 1] = after
            _push(keys, items, counts[OPEN], key | rest, made)
            counts[OPEN] += 1
            counts[MADE] += 1
    return MORE


@jit
def trace(labels, label, turning):
    """Nodes of the path that a label stands for, from the start."""
    count = 0
    at = label
    while at >= 0:
        count += 1
        at = labels[at, 0]
    nodes = np.empty(count, np.int32)
    at = label
    while at >= 0:
        count -= 1
        nodes[count] = labels[at, 1] // 9 if turning else labels[at, 1]
        at = labels[at, 0]
    return nodes
