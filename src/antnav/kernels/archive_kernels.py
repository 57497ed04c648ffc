"""An archive of vectors that no other beats, compiled.

Vectors lie in blocks that know their bounds, so that most of them need not be looked at: one level of the ND-tree
(Jaszkiewicz & Lust 2018, doi:10.1109/TEVC.2018.2799684). A vector that is better than one in the archive by less than a
tolerance in every objective counts as beaten, which bounds the archive's size (Laumanns et al. 2002,
doi:10.1162/106365602760234108).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from antnav.kernels import splitmix
from antnav.kernels.jit import jit
from antnav.kernels.splitmix import GOLDEN

#: Places of a block.
BLOCK = 32
#: Places of `Archive.counts`.
BLOCKS, ENTRIES, USED, HIT = range(4)
#: No way home.
FAR = 2**62


class Network(NamedTuple):
    """What is searched; see `front_kernels`."""

    neighbours: np.ndarray  #: int32 (n, 8)
    costs: np.ndarray  #: int32 (n, 8, k)
    turns: np.ndarray  #: int32 (9, 8, k), or (0, 8, k)
    start: int
    goal: int


class Home(NamedTuple):
    """The best ways to the goal for a weighted sum, as `front_kernels.ways_home` finds them."""

    prices: np.ndarray  #: int64 (n, 8)
    corners: np.ndarray  #: int64 (9, 8)
    rest: np.ndarray  #: int64 (states,)
    values: np.ndarray  #: int64 (states, k)
    following: np.ndarray  #: uint8 (states,)


class Archive(NamedTuple):
    """Vectors in blocks of `BLOCK` places, and their paths."""

    values: np.ndarray  #: int64 (places, k)
    begin: np.ndarray  #: int64 (places,): where a vector's path begins in the pool
    length: np.ndarray  #: int32 (places,): nodes of the path; 0 where it lies elsewhere
    size: np.ndarray  #: int32 (blocks,)
    low: np.ndarray  #: int64 (blocks, k): no vector of the block is below
    high: np.ndarray  #: int64 (blocks, k): nor above
    tolerance: np.ndarray  #: int64 (k,)
    scale: np.ndarray  #: float64 (k,): one over the range of each objective
    pool: np.ndarray  #: int32: nodes of paths
    counts: np.ndarray  #: int64 (4,)


@jit
def beaten(archive, vector):
    """Whether a vector of the archive is nowhere worse, but for the tolerance."""
    k = vector.size
    values, low, tolerance, counts = archive.values, archive.low, archive.tolerance, archive.counts
    hit = counts[HIT]
    if archive.size[hit // BLOCK] > hit % BLOCK:
        j = 0
        while j < k and values[hit, j] - tolerance[j] <= vector[j]:
            j += 1
        if j == k:
            return True
    for block in range(counts[BLOCKS]):
        j = 0
        while j < k and low[block, j] - tolerance[j] <= vector[j]:
            j += 1
        if j < k:
            continue
        for place in range(block * BLOCK, block * BLOCK + archive.size[block]):
            j = 0
            while j < k and values[place, j] - tolerance[j] <= vector[j]:
                j += 1
            if j == k:
                counts[HIT] = place
                return True
    return False


@jit
def _bounds(archive, block):
    """Work out a block's bounds anew."""
    first = block * BLOCK
    for j in range(archive.low.shape[1]):
        low = high = archive.values[first, j]
        for place in range(first + 1, first + archive.size[block]):
            low = min(low, archive.values[place, j])
            high = max(high, archive.values[place, j])
        archive.low[block, j], archive.high[block, j] = low, high


@jit
def _move(archive, source, target):
    for j in range(archive.low.shape[1]):
        archive.values[target, j] = archive.values[source, j]
    archive.begin[target], archive.length[target] = archive.begin[source], archive.length[source]


@jit
def _split(archive, block):
    """Move half of a block into a new one: those above the median of the objective in which it is widest."""
    k = archive.low.shape[1]
    _bounds(archive, block)
    wide, most = 0, -1.0
    for j in range(k):
        width = (archive.high[block, j] - archive.low[block, j]) * archive.scale[j]
        if width > most:
            wide, most = j, width
    first = block * BLOCK
    order = np.argsort(archive.values[first : first + BLOCK, wide], kind="mergesort")
    upper = np.zeros(BLOCK, np.bool_)
    upper[order[BLOCK // 2 :]] = True
    new = archive.counts[BLOCKS]
    archive.counts[BLOCKS] += 1
    kept = moved = 0
    for i in range(BLOCK):
        if upper[i]:
            _move(archive, first + i, new * BLOCK + moved)
            moved += 1
        else:
            _move(archive, first + i, first + kept)
            kept += 1
    archive.size[block], archive.size[new] = kept, moved
    _bounds(archive, block)
    _bounds(archive, new)


@jit
def place(archive, vector, begin, length):
    """Take in a vector that is not beaten, and throw out those that it beats; False where there is no room."""
    k = vector.size
    values, low, high, size, counts = archive.values, archive.low, archive.high, archive.size, archive.counts
    if counts[BLOCKS] + 1 >= size.size:
        return False
    nearest, least = -1, np.inf
    for block in range(counts[BLOCKS]):
        far = 0.0
        worse = size[block] > 0
        for j in range(k):
            far += abs(0.5 * (low[block, j] + high[block, j]) - vector[j]) * archive.scale[j]
            worse = worse and vector[j] <= high[block, j]
        if worse:
            at = block * BLOCK
            while at < block * BLOCK + size[block]:
                j = 0
                while j < k and vector[j] <= values[at, j]:
                    j += 1
                if j == k:
                    size[block] -= 1
                    counts[ENTRIES] -= 1
                    _move(archive, block * BLOCK + size[block], at)
                else:
                    at += 1
        if far < least:
            nearest, least = block, far
    if nearest < 0:
        nearest = counts[BLOCKS]
        counts[BLOCKS] += 1
        size[nearest] = 0
    elif size[nearest] == BLOCK:
        new = counts[BLOCKS]
        _split(archive, nearest)
        here = there = 0.0
        for j in range(k):
            here += abs(0.5 * (low[nearest, j] + high[nearest, j]) - vector[j]) * archive.scale[j]
            there += abs(0.5 * (low[new, j] + high[new, j]) - vector[j]) * archive.scale[j]
        if there < here:
            nearest = new
    at = nearest * BLOCK + size[nearest]
    for j in range(k):
        values[at, j] = vector[j]
        if size[nearest] == 0:
            low[nearest, j] = high[nearest, j] = vector[j]
        else:
            low[nearest, j] = min(low[nearest, j], vector[j])
            high[nearest, j] = max(high[nearest, j], vector[j])
    archive.begin[at], archive.length[at] = begin, length
    size[nearest] += 1
    counts[ENTRIES] += 1
    return True


@jit
def add(archive, values, lengths, nodes):
    """Take in paths in turn, those that are not beaten; how many there was room for.

    Parameters
    ----------
    values : int64 (p, k)
    lengths : int32 (p,)
    nodes : int32
        Of all paths, one after the other.
    """
    at = 0
    for i in range(lengths.size):
        length = lengths[i]
        if not beaten(archive, values[i]):
            begin = archive.counts[USED]
            if begin + length > archive.pool.size or not place(archive, values[i], begin, length):
                return i
            archive.pool[begin : begin + length] = nodes[at : at + length]
            archive.counts[USED] += length
        at += length
    return lengths.size


@jit
def listed(archive):
    """Places of all vectors whose path lies here, in the order in which they came."""
    found = np.empty(archive.counts[ENTRIES], np.int64)
    count = 0
    for block in range(archive.counts[BLOCKS]):
        for at in range(block * BLOCK, block * BLOCK + archive.size[block]):
            if archive.length[at] > 0:
                found[count] = at
                count += 1
    found = found[:count]
    return found[np.argsort(archive.begin[found], kind="mergesort")]


@jit
def gathered(archive, places):
    """Nodes of the paths at these places, one after the other: int32."""
    total = np.int64(0)
    for i in range(places.size):
        total += archive.length[places[i]]
    nodes = np.empty(total, np.int32)
    at = 0
    for i in range(places.size):
        begin, length = archive.begin[places[i]], archive.length[places[i]]
        nodes[at : at + length] = archive.pool[begin : begin + length]
        at += length
    return nodes


_mix, _unit = jit(splitmix.mix), jit(splitmix.unit)


@jit
def uniform(key, draw):
    """The draw of that number from a stream: float64 in [0, 1)."""
    return _unit(_mix(key + np.uint64(draw) * GOLDEN))


@jit
def stream(seed, number, ant):
    """An ant's own stream."""
    return _mix(_mix(_mix(np.uint64(seed) + GOLDEN) + np.uint64(number)) + np.uint64(ant))


@jit
def _enter(archive, vector, path, before, network, home, state, marks, stamp):
    """Take in a path: nodes up to a state, and the way home from there. False where the archive has no room."""
    n = network.neighbours.shape[0]
    turning = network.turns.size > 0
    wide = 9 if turning else 1
    begin = archive.counts[USED]
    pool = archive.pool
    if begin + before + n > pool.size:
        return False
    for i in range(before):
        pool[begin + i] = path[i]
        marks[path[i]] = stamp
    at = begin + before
    node = state // wide
    while node != network.goal:
        s = home.following[state]
        node = network.neighbours[node, s]
        if marks[node] == stamp:  # no cell twice
            return True
        marks[node] = stamp
        pool[at] = node
        at += 1
        state = node * wide + (s + 1 if turning else 0)
    if not place(archive, vector, begin, at - begin):
        return False
    archive.counts[USED] = at
    return True


@jit
def walk(network, home, archive, tau, heats, decay, slack, ants, seed, number, work):
    """Let ants walk to the goal one after the other, and look home from every cell where they leave the best way.

    A move's regret r is what the weighted sum of the whole path grows by at least, whatever follows: its price, plus
    the least rest behind it, less the least rest here. An ant takes it with a probability in proportion to
    tau exp(-r / T), never to a cell where it has been, and never beyond `slack` in all; no move left ends its walk.

    Parameters
    ----------
    tau : float64 (n, 8), or (0, 8)
        Pheromone to the power alpha; of size 0: all alike.
    heats : int64 (h,)
        Temperatures T, which ants have in turn.
    decay : float64 (d,)
        exp(-i / 64), 0 from there on.
    work : int64 (4,)
        Counts walks, walks that arrived and looks home.

    Returns
    -------
    bool
        Whether there was room for all that was found.
    """
    neighbours, costs, turns = network.neighbours, network.costs, network.turns
    n, _, k = costs.shape
    turning = turns.size > 0
    wide = 9 if turning else 1
    seen = np.full(n, np.int64(-1), np.int64)
    marks = np.full(n, np.int64(-1), np.int64)
    stamp = np.int64(0)
    path = np.empty(n, np.int32)
    reached = np.zeros(k, np.int64)
    vector = np.zeros(k, np.int64)
    shares = np.zeros(8, np.float64)
    regrets = np.zeros(8, np.int64)
    for ant in range(ants):
        key = stream(seed, number, ant)
        heat = heats[ant % heats.size]
        node, last, count = network.start, 0, 1
        path[0] = node
        seen[node] = ant
        left = slack
        reached[:] = 0
        work[0] += 1
        while node != network.goal:
            state = node * wide + (last if turning else 0)
            total = 0.0
            for s in range(8):
                shares[s] = 0.0
                other = neighbours[node, s]
                if other == n or seen[other] == ant:
                    continue
                rest = home.rest[other * wide + (s + 1 if turning else 0)]
                if rest == FAR:
                    continue
                regret = home.prices[node, s] + home.corners[last, s] + rest - home.rest[state]
                if regret > left:
                    continue
                regrets[s] = regret
                cold = 64 * regret // heat
                if cold < decay.size:
                    shares[s] = decay[cold]
                    if tau.size > 0:
                        shares[s] *= tau[node, s]
                    total += shares[s]
            if total == 0.0:
                break
            drawn = uniform(key, count) * total
            s, chosen = 0, -1
            while s < 8:
                if shares[s] > 0.0:
                    chosen = s
                    drawn -= shares[s]
                    if drawn < 0.0:
                        break
                s += 1
            left -= regrets[chosen]
            for j in range(k):
                reached[j] += costs[node, chosen, j]
                if turning:
                    reached[j] += turns[last, chosen, j]
            strayed = count == 1 or chosen != home.following[state]
            node, last = neighbours[node, chosen], chosen + 1
            seen[node] = ant
            path[count] = node
            count += 1
            if strayed:
                work[2] += 1
                state = node * wide + (last if turning else 0)
                for j in range(k):
                    vector[j] = reached[j] + home.values[state, j]
                if not beaten(archive, vector):
                    stamp += 1
                    if not _enter(archive, vector, path, count, network, home, state, marks, stamp):
                        return False
        if node == network.goal:
            work[1] += 1
    return True


@jit
def _sums(network, nodes, first):
    """Prices of paths up to each node, int64 (nodes, k), and the move from there, int8 (nodes,), -1 from the last."""
    neighbours, costs, turns = network.neighbours, network.costs, network.turns
    k = costs.shape[2]
    sums = np.zeros((nodes.size, k), np.int64)
    slots = np.full(nodes.size, -1, np.int8)
    for p in range(first.size - 1):
        last = 0
        for i in range(first[p], first[p + 1] - 1):
            s = 0
            while neighbours[nodes[i], s] != nodes[i + 1]:
                s += 1
            slots[i] = s
            for j in range(k):
                sums[i + 1, j] = sums[i, j] + costs[nodes[i], s, j]
                if turns.size > 0:
                    sums[i + 1, j] += turns[last, s, j]
            last = s + 1
    return sums, slots


@jit
def pheromone(network, nodes, first, near, alpha):
    """tau^alpha, where tau is 1 plus the number of the first `near` paths that make a move; empty if alpha is 0."""
    if alpha == 0.0:
        return np.zeros((0, 8), np.float64)
    tau = np.ones((network.neighbours.shape[0], 8), np.float64)
    for i in range(first[near]):
        s = 0
        while s < 8 and (i + 1 == nodes.size or network.neighbours[nodes[i], s] != nodes[i + 1]):
            s += 1
        if s < 8 and nodes[i] != network.goal:
            tau[nodes[i], s] += 1.0
    if alpha != 1.0:
        for i in range(tau.shape[0]):
            for s in range(8):
                if tau[i, s] != 1.0:
                    tau[i, s] **= alpha
    return tau


@jit
def stray(network, home, archive, nodes, first, work):
    """From every cell of known paths, make every other move and go home; take in what is not beaten.

    Parameters
    ----------
    nodes : int32
        Of the known paths, one after the other.
    first : int64 (p + 1,)
        Where each begins.
    """
    neighbours, costs, turns = network.neighbours, network.costs, network.turns
    n, _, k = costs.shape
    turning = turns.size > 0
    wide = 9 if turning else 1
    sums, slots = _sums(network, nodes, first)
    marks = np.full(n, np.int64(-1), np.int64)
    stamp = np.int64(0)
    path = np.empty(n, np.int32)
    vector = np.zeros(k, np.int64)
    for p in range(first.size - 1):
        last = 0
        for i in range(first[p], first[p + 1] - 1):
            node = nodes[i]
            for s in range(8):
                other = neighbours[node, s]
                if other == n:
                    continue
                state = other * wide + (s + 1 if turning else 0)
                if home.rest[state] == FAR:
                    continue
                work[2] += 1
                for j in range(k):
                    vector[j] = sums[i, j] + costs[node, s, j] + home.values[state, j]
                    if turning:
                        vector[j] += turns[last, s, j]
                if beaten(archive, vector):
                    continue
                count = i - first[p] + 1
                stamp += 1
                fresh = True
                for c in range(count):
                    path[c] = nodes[first[p] + c]
                    fresh = fresh and path[c] != other
                if fresh:
                    path[count] = other
                    if not _enter(archive, vector, path, count + 1, network, home, state, marks, stamp):
                        return False
            last = slots[i] + 1
    return True


@jit
def splice(network, archive, nodes, first, pairs, seed, number, work):
    """Where two known paths part, go on along the other one; take in what is not beaten.

    Parameters
    ----------
    nodes, first
        As in `stray`.
    pairs : int
        How many pairs are drawn.
    """
    turns = network.turns
    n, _, k = network.costs.shape
    turning = turns.size > 0
    sums, slots = _sums(network, nodes, first)
    marks = np.full(n, np.int64(-1), np.int64)
    where = np.zeros(n, np.int64)
    seen = np.full(n, np.int64(-1), np.int64)
    stamp = np.int64(0)
    vector = np.zeros(k, np.int64)
    pool = archive.pool
    count = first.size - 1
    if count < 2:
        return True
    for pair in range(pairs):
        key = stream(seed, number, pair)
        a = int(uniform(key, 0) * count)
        b = int(uniform(key, 1) * (count - 1))
        if b >= a:
            b += 1
        for i in range(first[a], first[a + 1]):
            where[nodes[i]] = i
            seen[nodes[i]] = pair
        for i in range(first[b] + 1, first[b + 1] - 1):
            if seen[nodes[i]] != pair:
                continue
            other = where[nodes[i]]
            if slots[other] == slots[i]:
                continue
            for turn in range(2):  # along a, then b; along b, then a
                head, at, tail, end = (other, i, a, first[b + 1]) if turn == 0 else (i, other, b, first[a + 1])
                work[3] += 1
                for j in range(k):
                    vector[j] = sums[head, j] + sums[end - 1, j] - sums[at, j]
                    if turning:
                        vector[j] += np.int64(turns[slots[head - 1] + 1, slots[at], j])
                        vector[j] -= turns[slots[at - 1] + 1, slots[at], j]
                if beaten(archive, vector):
                    continue
                begin = archive.counts[USED]
                if begin + n > pool.size:
                    return False
                stamp += 1
                fresh = True
                length = 0
                for c in range(first[tail], head + 1):
                    pool[begin + length] = nodes[c]
                    marks[nodes[c]] = stamp
                    length += 1
                for c in range(at + 1, end):
                    if marks[nodes[c]] == stamp:
                        fresh = False
                        break
                    marks[nodes[c]] = stamp
                    pool[begin + length] = nodes[c]
                    length += 1
                if fresh:
                    if not place(archive, vector, begin, length):
                        return False
                    archive.counts[USED] += length
    return True
