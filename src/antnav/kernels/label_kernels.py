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

from antnav.kernels import heap
from antnav.kernels.jit import jit

#: Larger than any cost of a path: what lies beyond counts as unreachable.
FAR = np.int32(2**31 - 1)
#: Places of `Search.counts`.
MADE, OPEN, POPPED, FOUND, LEAVES, FORKS, DEEPEST = range(7)
#: Why `advance` came back: the front is complete; it should go on; arrays are too short; a cost grew too large.
DONE, MORE, FULL, OVERFLOW = range(4)
#: Vectors that a leaf holds; more than there are last moves, or it might not be divisible.
LEAF = 16
#: Root of an empty set.
NONE = np.int32(2**31 - 1)


class Network(NamedTuple):
    """What is searched."""

    neighbours: np.ndarray  #: int32 (n, 8), n where there is none
    costs: np.ndarray  #: int32 (n, 8, k)
    turns: np.ndarray  #: int32 (9, 8, k), by last move + 1 and next move; size 0 where they cost nothing
    gaps: np.ndarray  #: int64 (9, 9, k): the most by which one last move's turns cost more than another's
    bounds: np.ndarray  #: int32 (states, k): least cost from each state to the goal
    goal: int
    slack: np.ndarray  #: int32 (k,): what lies so little below a vector at the goal, or above it, is left out


class Search(NamedTuple):
    """A search that can be taken up again."""

    labels: np.ndarray  #: int32 (capacity, 2 + k): parent, state, costs from the start
    keys: np.ndarray  #: int64 (capacity,): the heap
    items: np.ndarray  #: int32 (capacity,): labels of the heap
    least: np.ndarray  #: int32 (n + 1,): where two costs look at no turns, all that sets hold; at the goal last
    root: np.ndarray  #: int32 (n + 1,): the sets, the last of vectors at the goal: a leaf, -1 - fork or NONE
    forks: np.ndarray  #: int32 (., 2 + 2 k): axis, least value on the right, left, right; least and largest numbers
    leaves: (
        np.ndarray
    )  #: int32 (., 18 k): number of vectors, least and largest numbers; last move + 1 and numbers of each
    found: np.ndarray  #: int32 (capacity,): labels that make the front
    counts: np.ndarray  #: int64 (7,)


_push, _pop = jit(heap.push), jit(heap.pop)


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
def _covered(forks, leaves, root, vector, last, gaps, k, stack):
    """Whether a set holds a vector that is nowhere worse than this one, whatever the next move."""
    if root == NONE:
        return False
    stack[0] = root
    top = 1
    while top > 0:
        top -= 1
        at = stack[top]
        if at < 0:
            at = -1 - at
            j = 1
            while j < k and forks[at, 3 + j] <= vector[j]:
                j += 1
            if j == k:
                if vector[forks[at, 0]] >= forks[at, 1]:
                    stack[top] = forks[at, 3]
                    top += 1
                stack[top] = forks[at, 2]
                top += 1
            continue
        j = 1
        while j < k and leaves[at, j] <= vector[j]:
            j += 1
        if j < k:
            continue
        c = 2 * k
        for _ in range(leaves[at, 0]):
            before = leaves[at, c]
            j = 1
            while j < k and leaves[at, c + j] <= vector[j]:
                j += 1
            if j == k:
                if before == last:
                    return True
                j = 1
                while j < k and leaves[at, c + j] + gaps[before, last, j] <= vector[j]:
                    j += 1
                if j == k:
                    return True
            c += k
    return False


@jit
def _thin(search, place, vector, last, gaps, k, stack):
    """Take the vectors out of a set that this one covers."""
    forks, leaves = search.forks, search.leaves
    if search.root[place] == NONE:
        return
    stack[0] = search.root[place]
    top = 1
    while top > 0:
        top -= 1
        at = stack[top]
        if at < 0:
            at = -1 - at
            j = 1
            while j < k and forks[at, 2 + k + j] >= vector[j]:
                j += 1
            if j == k:
                if vector[forks[at, 0]] < forks[at, 1]:
                    stack[top] = forks[at, 2]
                    top += 1
                stack[top] = forks[at, 3]
                top += 1
            continue
        j = 1
        while j < k and leaves[at, k - 1 + j] >= vector[j]:
            j += 1
        if j < k:
            continue
        count = leaves[at, 0]
        i = 0
        while i < count:
            c = (i + 2) * k
            after = leaves[at, c]
            j = 1
            while j < k and vector[j] + gaps[last, after, j] <= leaves[at, c + j]:
                j += 1
            if j < k:
                i += 1
                continue
            count -= 1
            for j in range(k):
                leaves[at, c + j] = leaves[at, (count + 2) * k + j]
        if count < leaves[at, 0]:
            leaves[at, 0] = count
            _measure(leaves, at, k)


@jit
def _measure(leaves, at, k):
    """Note the least and the largest numbers of a leaf's vectors."""
    for j in range(1, k):
        least, most = FAR, np.int32(-1)
        for i in range(leaves[at, 0]):
            value = leaves[at, (i + 2) * k + j]
            least, most = min(least, value), max(most, value)
        leaves[at, j], leaves[at, k - 1 + j] = least, most


@jit
def _split(search, at, depth, k):
    """Make two leaves of a full one, at the median of one number: the fork between them."""
    leaves, forks, counts = search.leaves, search.forks, search.counts
    values = np.empty(LEAF, np.int32)
    axis, middle = 1, np.int32(0)
    for turn in range(k - 1):
        axis = 1 + (depth + turn) % (k - 1)
        for i in range(LEAF):
            values[i] = leaves[at, (i + 2) * k + axis]
        values.sort()
        i = LEAF // 2
        while i < LEAF - 1 and values[i] == values[0]:
            i += 1
        middle = values[i]
        if middle > values[0]:
            break
    right, fork = counts[LEAVES], counts[FORKS]
    counts[LEAVES] += 1
    counts[FORKS] += 1
    forks[fork, 0], forks[fork, 1], forks[fork, 2], forks[fork, 3] = axis, middle, at, right
    for j in range(1, 2 * k - 1):
        forks[fork, 3 + j] = leaves[at, j]
    kept, moved = 0, 0
    for i in range(LEAF):
        c = (i + 2) * k
        if leaves[at, c + axis] < middle:
            for j in range(k):
                leaves[at, (kept + 2) * k + j] = leaves[at, c + j]
            kept += 1
        else:
            for j in range(k):
                leaves[right, (moved + 2) * k + j] = leaves[at, c + j]
            moved += 1
    leaves[at, 0], leaves[right, 0] = kept, moved
    _measure(leaves, at, k)
    _measure(leaves, right, k)
    return fork


@jit
def _insert(search, place, vector, last, k):
    """Put a vector into a set."""
    leaves, forks, counts, root = search.leaves, search.forks, search.counts, search.root
    if root[place] == NONE:
        root[place] = counts[LEAVES]
        leaves[counts[LEAVES], 0] = 0
        _measure(leaves, counts[LEAVES], k)
        counts[LEAVES] += 1
    at, parent, side, depth = np.int64(root[place]), np.int64(-1), 0, 0
    while at < 0 or leaves[at, 0] == LEAF:
        if at >= 0:
            at = -1 - _split(search, at, depth, k)
            if parent < 0:
                root[place] = at
            else:
                forks[parent, side] = at
        parent = -1 - at
        for j in range(1, k):
            forks[parent, 3 + j] = min(forks[parent, 3 + j], vector[j])
            forks[parent, 2 + k + j] = max(forks[parent, 2 + k + j], vector[j])
        side = 3 if vector[forks[parent, 0]] >= forks[parent, 1] else 2
        at = np.int64(forks[parent, side])
        depth += 1
    counts[DEEPEST] = max(counts[DEEPEST], depth)
    c = (leaves[at, 0] + 2) * k
    leaves[at, c] = last
    for j in range(1, k):
        leaves[at, c + j] = vector[j]
        leaves[at, j] = min(leaves[at, j], vector[j])
        leaves[at, k - 1 + j] = max(leaves[at, k - 1 + j], vector[j])
    leaves[at, 0] += 1


@jit
def advance(network, search, pops, limit):
    """Take up to `pops` labels from the heap, making up to `limit` in all; DONE, MORE, FULL or OVERFLOW."""
    neighbours, costs, turns, gaps, bounds, goal, slack = network
    labels, keys, items, counts = search.labels, search.keys, search.items, search.counts
    forks, leaves, root = search.forks, search.leaves, search.root
    n, k = neighbours.shape[0], costs.shape[2]
    turning = turns.size > 0
    fresh = np.empty(k, np.int32)
    reached = np.empty(k, np.int32)  # costs from the start
    whole = np.empty(k, np.int32)  # least costs of paths on from there
    near = np.empty(k, np.int32)  # the same, and the slack
    stack = np.empty(counts[DEEPEST] + pops + 2, np.int64)  # a pop makes a set deeper by one at most
    for _ in range(pops):
        if counts[OPEN] == 0:
            return DONE
        if counts[MADE] + 8 > min(limit, labels.shape[0]):
            return FULL
        if counts[LEAVES] + 2 > search.leaves.shape[0] or counts[FORKS] + 2 > search.forks.shape[0]:
            return FULL
        label = _pop(keys, items, counts[OPEN])
        counts[OPEN] -= 1
        counts[POPPED] += 1
        state = labels[label, 1]
        node, last = (state // 9, state % 9) if turning else (state, 0)
        for j in range(k):
            reached[j] = labels[label, 2 + j]
            whole[j] = reached[j] + bounds[state, j]
            near[j] = min(np.int64(whole[j]) + slack[j], FAR)
        if _covered(forks, leaves, root[n], near, 0, gaps, k, stack):
            continue
        if node == goal:
            _thin(search, n, whole, 0, gaps, k, stack)
            _insert(search, n, whole, 0, k)
            search.found[counts[FOUND]] = label
            counts[FOUND] += 1
            continue
        if _covered(forks, leaves, root[node], reached, last, gaps, k, stack):
            continue
        _thin(search, node, reached, last, gaps, k, stack)
        _insert(search, node, reached, last, k)
        for slot in range(8):
            other = neighbours[node, slot]
            if other == n:
                continue
            after = 9 * other + slot + 1 if turning else other
            if bounds[after, 0] == FAR:
                continue
            made = counts[MADE]
            rest, dearest = np.int64(0), np.int64(0)
            for j in range(k):
                cost = np.int64(reached[j]) + costs[node, slot, j]
                if turning:
                    cost += turns[last, slot, j]
                fresh[j] = min(cost, FAR)
                cost += bounds[after, j]
                whole[j] = min(cost, FAR)
                near[j] = min(cost + slack[j], FAR)
                dearest = max(dearest, cost)
                if j > 0:
                    rest += cost
            into = slot + 1 if turning else 0
            if _covered(forks, leaves, root[other], fresh, into, gaps, k, stack):
                continue
            if _covered(forks, leaves, root[n], near, 0, gaps, k, stack):
                continue
            if dearest >= FAR or rest >= 1 << 32:
                return OVERFLOW
            labels[made, 0] = label
            labels[made, 1] = after
            for j in range(k):
                labels[made, 2 + j] = fresh[j]
            _push(keys, items, counts[OPEN], np.int64(whole[0]) << 32 | rest, made)
            counts[OPEN] += 1
            counts[MADE] += 1
    return MORE


@jit
def advance_two(network, search, pops, limit):
    """The same where two costs look at no turns: the set of a node is the least second cost so far."""
    neighbours, costs, _, _, bounds, goal, slack = network
    labels, keys, items, least, counts = search.labels, search.keys, search.items, search.least, search.counts
    n = neighbours.shape[0]
    room = min(limit, labels.shape[0]) - 8
    size, made = counts[OPEN], counts[MADE]
    answer = MORE
    for _ in range(pops):
        if size == 0 or made > room:
            answer = DONE if size == 0 else FULL
            break
        second = keys[0] & 0xFFFFFFFF
        label = _pop(keys, items, size)
        size -= 1
        counts[POPPED] += 1
        if second + slack[1] >= least[n]:
            continue
        node = labels[label, 1]
        a, b = np.int64(labels[label, 2]), np.int64(labels[label, 3])
        if b >= least[node]:
            continue
        least[node] = b
        if node == goal:
            least[n] = b
            search.found[counts[FOUND]] = label
            counts[FOUND] += 1
            continue
        for slot in range(8):
            other = neighbours[node, slot]
            if other == n:
                continue
            new = b + costs[node, slot, 1]
            whole = new + bounds[other, 1]
            if new >= least[other] or whole + slack[1] >= least[n]:
                continue
            first = a + costs[node, slot, 0]
            key = first + bounds[other, 0]
            if max(key, whole) >= FAR:
                if bounds[other, 0] < FAR:
                    answer = OVERFLOW
                continue
            labels[made, 0], labels[made, 1], labels[made, 2], labels[made, 3] = label, other, first, new
            _push(keys, items, size, key << 32 | whole, made)
            size += 1
            made += 1
        if answer == OVERFLOW:
            break
    counts[OPEN], counts[MADE] = size, made
    return answer


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
