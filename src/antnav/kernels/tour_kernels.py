"""Orders of stops: exact, by ants, by iterated local search, and bounds. Compiled.

An order is a path through all nodes of a symmetric matrix, from the first node to the last. The last stands for the
end: of a way back for the start once more, else for wherever the trip may end. So 2-opt and Or-opt need no exceptions.
"""

from __future__ import annotations

import numpy as np

from antnav.kernels import heap, splitmix
from antnav.kernels.graph import SQRT2
from antnav.kernels.grid_kernels import DIAGONAL, HALVES, offsets_of
from antnav.kernels.jit import jit
from antnav.kernels.splitmix import GOLDEN

_push, _pop = jit(heap.push), jit(heap.pop)
_mix, _unit = jit(splitmix.mix), jit(splitmix.unit)
#: By a move, as bits: those that may follow it in the open, the same move and of a diagonal one its two parts.
_ONWARD = np.array([0b1011, 0b10, 0b10110, 0b1000, 0b10000, 0b1101000, 0b1000000, 0b11010000], np.uint8)
#: Number of the lowest bit.
_LOWEST = np.array([0, *((bits & -bits).bit_length() - 1 for bits in range(1, 256))], np.int64)
_STRAIGHT = 2**32  #: A straight move in a count of both kinds.
_NO_WAY = 2**62  #: Longer than all.
_LONGEST = 3  #: Nodes of a segment that Or-opt moves.
_BRIDGE = 50  #: Nodes of a segment that a double bridge exchanges.


@jit
def _length(way):
    """Length of a way from its counts of moves."""
    return (way >> 32) + SQRT2 * (way & 0xFFFFFFFF)


@jit
def lengths(moves, width, source, targets, ways, arrived):
    """Exact lengths of shortest ways from a cell to others, inf where there is none.

    Dijkstra's algorithm with buckets of width 1 (Dial 1969; Denardo & Fox 1979): no move is shorter, so the cells of
    one bucket cannot shorten each other's ways, and none is sorted. Where a cell and the one before have all eight
    moves, only those follow that no other way makes as short with its diagonal moves first (Harabor & Grastien 2011).

    Parameters
    ----------
    targets : int32
        Flat cells; each may be there more than once.
    ways, arrived : int64 (n,), uint8 (n,)
        Scratch for the map's cells: straight moves * 2**32 + diagonal ones of the way there, and the moves by which
        it ends.
    """
    offsets = offsets_of(width)
    ways[:] = _NO_WAY
    buckets = np.empty((3, 1024), np.int32)
    sizes = np.zeros(3, np.int64)
    ways[source], arrived[source] = 0, 0
    buckets[0, 0], sizes[0] = source, 1
    level, empty, farthest = 0, 0, np.inf
    while empty < 3 and level <= farthest:
        now = level % 3
        empty = empty + 1 if sizes[now] == 0 else 0
        for i in range(sizes[now]):
            cell = buckets[now, i]
            way = ways[cell]
            length = _length(way)
            if length < level:  # a shorter way had been found since it came here
                continue
            legal, by = moves[cell], arrived[cell]
            if legal == 255 and by != 0:
                legal = 0
                while by != 0:
                    k = _LOWEST[by]
                    by &= by - 1
                    legal |= _ONWARD[k] if moves[cell - offsets[k]] == 255 else 255
            while legal != 0:
                k = _LOWEST[legal]
                legal &= legal - 1
                other = cell + offsets[k]
                longer = way + (1 if DIAGONAL[k] else _STRAIGHT)
                known = ways[other]
                if longer == known:
                    arrived[other] |= 1 << k
                    continue
                reached, before = _length(longer), _length(known)
                if reached > before:
                    continue
                ways[other] = longer
                arrived[other] = 1 << k
                if int(before) == int(reached):
                    continue  # it waits in that bucket already
                later = int(reached) % 3
                if sizes[later] == buckets.shape[1]:
                    wider = np.empty((3, 2 * buckets.shape[1]), np.int32)
                    wider[:, : buckets.shape[1]] = buckets
                    buckets = wider
                buckets[later, sizes[later]] = other
                sizes[later] += 1
        sizes[now] = 0
        level += 1
        if level % 64 == 0:
            farthest = 0.0
            for cell in targets:
                farthest = max(farthest, _length(ways[cell]))
    found = np.empty(targets.size, np.float64)
    for i in range(targets.size):
        way = ways[targets[i]]
        found[i] = np.inf if way == _NO_WAY else _length(way)
    return found


@jit
def turning_costs(moves, width, source, targets, prices, turns):
    """Exact costs of the cheapest ways from a cell to others where turns cost, too, inf where there is none.

    Dijkstra's algorithm on cells with the move that led there.

    Parameters
    ----------
    targets : int32
        Flat cells; each may be there more than once.
    prices : Prices
    turns : float64 (9, 8)
        Cost of a move by the last move + 1, 0 before the first.
    """
    offsets = offsets_of(width)
    price, _, height = prices
    dear, hilly = price.size > 0, height.size > 0
    cost = np.full(8 * moves.size, np.inf)
    closed = np.zeros(8 * moves.size, np.uint8)
    least = np.full(moves.size, np.inf)
    wanted = np.zeros(moves.size, np.uint8)
    remaining = 0
    for cell in targets:
        remaining += 1 - wanted[cell]
        wanted[cell] = 1
    capacity = 1024
    keys, items = np.empty(capacity, np.float64), np.empty(capacity, np.int32)
    size, cell, heading, reached = 0, source, 0, 0.0
    while True:
        if reached < least[cell]:
            least[cell] = reached
            remaining -= wanted[cell]
            if remaining == 0:
                break
        for k in range(8):
            if not moves[cell] >> k & 1:
                continue
            other = cell + offsets[k]
            step = HALVES[k] * (price[cell] + price[other]) if dear else 2.0 * HALVES[k]
            if hilly:
                step += abs(height[other] - height[cell])
            g = reached + step + turns[heading, k]
            if g >= cost[8 * other + k]:
                continue
            cost[8 * other + k] = g
            if size == capacity:
                capacity *= 2
                keys, items = np.append(keys, keys), np.append(items, items)
            _push(keys, items, size, g, 8 * other + k)
            size += 1
        state = -1
        while size > 0 and state < 0:
            state = _pop(keys, items, size)
            size -= 1
            if closed[state]:
                state = -1
        if state < 0:
            break
        closed[state] = 1
        cell, heading, reached = state >> 3, (state & 7) + 1, cost[state]
    return least[targets]


@jit
def held_karp(cost):
    """The cheapest order, by dynamic programming over sets (Held & Karp 1962, doi 10.1137/0110015): int32 (m,)."""
    stops = cost.shape[0] - 2
    end = stops + 1
    least = np.full((1 << stops, stops), np.inf)
    for j in range(stops):
        least[1 << j, j] = cost[0, j + 1]
    for mask in range(1, 1 << stops):
        for j in range(stops):
            here = least[mask, j]
            if not mask >> j & 1:
                continue
            for k in range(stops):
                if not mask >> k & 1:
                    there = here + cost[j + 1, k + 1]
                    least[mask | 1 << k, k] = min(least[mask | 1 << k, k], there)
    order = np.empty(stops + 2, np.int32)
    order[0], order[end] = 0, end
    mask, after = (1 << stops) - 1, end
    for i in range(stops, 0, -1):
        best, chosen = np.inf, 0
        for j in range(stops):
            if mask >> j & 1 and least[mask, j] + cost[j + 1, after] < best:
                best = least[mask, j] + cost[j + 1, after]
                chosen = j
        order[i] = after = chosen + 1
        mask ^= 1 << chosen
    return order


@jit
def cost_of(cost, order):
    """What an order costs."""
    total = 0.0
    for i in range(order.size - 1):
        total += cost[order[i], order[i + 1]]
    return total


@jit
def _reverse(order, place, i, j):
    """Turn a piece of an order round."""
    while i < j:
        one, other = order[i], order[j]
        order[i], order[j] = other, one
        place[other], place[one] = i, j
        i += 1
        j -= 1


@jit
def _exchange(order, place, i, j, k):
    """Exchange the neighbouring pieces i..j and j + 1..k."""
    _reverse(order, place, i, k)
    _reverse(order, place, i, i + k - j - 1)
    _reverse(order, place, i + k - j, k)


@jit
def _two_opt(cost, near, order, place, node, least):
    """Replace an edge of a node and one more where that gains more than `least`; the gain, and four nodes."""
    last = order.size - 1
    p = place[node]
    for side in range(2):
        step = 1 - 2 * side
        if not 0 <= p + step <= last:
            continue
        beside = order[p + step]
        for other in near[node]:
            gain = cost[node, beside] - cost[node, other]
            if gain <= least:
                break
            q = place[other]
            if not 0 <= q + step <= last:
                continue
            beyond = order[q + step]
            gain += cost[other, beyond] - cost[beside, beyond]
            if gain > least:
                low, high = min(p, q), max(p, q)
                _reverse(order, place, low + 1 - side, high - side)
                return gain, beside, other, beyond
    return 0.0, node, node, node


@jit
def _or_opt(cost, near, order, place, node, least):
    """Move up to three nodes, the first or last of which is this one, where that gains more than `least`."""
    last = order.size - 1
    p = place[node]
    for size in range(1, _LONGEST + 1):
        for side in range(2 if size > 1 else 1):
            i, j = (p - size + 1, p) if side else (p, p + size - 1)  # side: the node is the last of them
            if i < 1 or j >= last:
                continue
            before, after = order[i - 1], order[j + 1]
            end = order[i] if side else order[j]
            saved = cost[before, order[i]] + cost[order[j], after] - cost[before, after]
            for other in near[node]:
                if cost[node, other] >= saved - least:
                    break
                q = place[other]
                if i <= q <= j:
                    continue
                for way in range(2):  # 0: behind the other node, 1: before it
                    r = q - 1 if way else q + 1
                    if r < 0 or r > last or i <= r <= j:
                        continue
                    beyond = order[r]
                    gain = saved - cost[node, other] - cost[end, beyond] + cost[other, beyond]
                    if gain <= least:
                        continue
                    if max(q, r) < i:
                        low = max(q, r)
                        _exchange(order, place, low, i - 1, j)
                        first = low
                    else:
                        high = min(q, r)
                        _exchange(order, place, i, j, high)
                        first = i + high - j
                    if side != way:
                        _reverse(order, place, first, first + size - 1)
                    return gain, before, after, end, other, beyond
    return 0.0, node, node, node, node, node


@jit
def _improve(cost, near, order, place, stack, waits, count, least):
    """2-opt and Or-opt with lists of near nodes, until no node that waits, or comes to wait, has a better place.

    Parameters
    ----------
    stack, waits, count
        The nodes that wait, whether each does, how many do.
    """
    touched = np.empty(6, np.int32)
    while count > 0:
        count -= 1
        node = stack[count]
        waits[node] = 0
        gain, a, b, c = _two_opt(cost, near, order, place, node, least)
        number = 4
        touched[0], touched[1], touched[2], touched[3] = node, a, b, c
        if gain == 0.0:
            gain, a, b, c, d, e = _or_opt(cost, near, order, place, node, least)
            number = 6
            touched[1], touched[2], touched[3], touched[4], touched[5] = a, b, c, d, e
        if gain == 0.0:
            continue
        for i in range(number):
            if not waits[touched[i]]:
                waits[touched[i]] = 1
                stack[count] = touched[i]
                count += 1


@jit
def _from_nearest(cost, order, place):
    """Always the nearest node next."""
    m = order.size
    for i in range(m):
        order[i] = i
    for i in range(1, m - 1):
        best = i
        for j in range(i + 1, m - 1):
            if cost[order[i - 1], order[j]] < cost[order[i - 1], order[best]]:
                best = j
        order[i], order[best] = order[best], order[i]
    for i in range(m):
        place[order[i]] = i


@jit
def iterated(cost, near, rounds, key, least):
    """Iterated local search: 2-opt and Or-opt, a double bridge of short pieces, again, and back if that was worse.

    Martin, Otto & Felten (1991); Johnson & McGeoch (1997).

    Parameters
    ----------
    cost : float64 (m, m)
        Symmetric.
    near : int32 (m, k)
        Of each node the others that are near, nearest first.
    rounds : int
    key : uint64
        Of the stream of random numbers.
    least : float
        Gains up to this are none.

    Returns
    -------
    (order, cost)
    """
    m = cost.shape[0]
    order, place = np.empty(m, np.int32), np.empty(m, np.int32)
    _from_nearest(cost, order, place)
    stack, waits = np.empty(m, np.int32), np.ones(m, np.uint8)
    for i in range(m):
        stack[i] = m - 1 - i
    _improve(cost, near, order, place, stack, waits, m, least)
    best, total = order.copy(), cost_of(cost, order)
    if m < 5:
        return best, total
    draw = np.uint64(0)
    for _ in range(rounds):
        p = int(_unit(_mix(key + draw * GOLDEN)) * (m - 3))
        room = m - 2 - p
        one = 1 + int(_unit(_mix(key + (draw + np.uint64(1)) * GOLDEN)) * min(_BRIDGE, room - 1))
        two = 1 + int(_unit(_mix(key + (draw + np.uint64(2)) * GOLDEN)) * min(_BRIDGE, room - one))
        draw += np.uint64(3)
        _exchange(order, place, p + 1, p + one, p + one + two)
        count = 0
        for at in (p, p + 1, p + two, p + two + 1, p + one + two, p + one + two + 1):
            node = order[at]
            if not waits[node]:
                waits[node] = 1
                stack[count] = node
                count += 1
        _improve(cost, near, order, place, stack, waits, count, least)
        found = cost_of(cost, order)
        if found <= total + least:
            best[:] = order
            total = min(found, total)
        else:
            order[:] = best
            for i in range(m):
                place[order[i]] = i
    return best, cost_of(cost, best)


@jit
def _walk(cost, tau, near, beta, greed, xi, tau_zero, key, order, place, weights):
    """One ant's order, and the local update of its edges: Dorigo & Gambardella (1997), equations 3 and 5.

    It begins anywhere and goes round; the first node and the last lie side by side.
    """
    m = order.size
    last = m - 1
    place[:] = -1
    node = int(_unit(_mix(key)) * m)
    if node == last:
        node = 0
    first, draw = node, np.uint64(1)
    order[0], place[node] = node, 0
    for i in range(1, m):
        after = -1
        if node == 0 and place[last] < 0:
            after = last
        elif node == last and place[0] < 0:
            after = 0
        else:
            total, heaviest, count = 0.0, -1.0, 0
            for other in near[node]:
                weight = 0.0
                if place[other] < 0:
                    weight = tau[node, other] * (1.0 / cost[node, other]) ** beta
                    if weight > heaviest:
                        heaviest, after = weight, other
                weights[count] = weight
                total += weight
                count += 1
            if after < 0:  # all that are near have been visited: the nearest of the others
                nearest = np.inf
                for other in range(m):
                    if place[other] < 0 and cost[node, other] < nearest:
                        nearest, after = cost[node, other], other
            elif _unit(_mix(key + draw * GOLDEN)) >= greed:
                rest = _unit(_mix(key + (draw + np.uint64(1)) * GOLDEN)) * total
                for j in range(count):
                    if weights[j] > 0.0:
                        after = near[node, j]
                        rest -= weights[j]
                        if rest < 0.0:
                            break
            draw += np.uint64(2)
        order[i], place[after] = after, i
        tau[node, after] = tau[after, node] = (1.0 - xi) * tau[node, after] + xi * tau_zero
        node = after
    tau[node, first] = tau[first, node] = (1.0 - xi) * tau[node, first] + xi * tau_zero
    _unrolled(order, place)


@jit
def _unrolled(order, place):
    """A round as an order from the first node to the last."""
    m = order.size
    last, begin = m - 1, place[0]
    step = -1 if order[(begin + 1) % m] == last else 1
    copy = order.copy()
    for i in range(m):
        order[i] = copy[(begin + step * i) % m]
        place[order[i]] = i


@jit
def ants(cost, near, number, iterations, beta, greed, rho, xi, improved, key, least):
    """Ant Colony System (Dorigo & Gambardella 1997, doi 10.1109/4235.585892), with local search where wanted.

    Parameters
    ----------
    cost, near, key, least
        As `iterated` takes them.
    number, iterations : int
        Ants, and how often they set out.
    beta, greed, rho, xi : float
        Weight of nearness, share of greedy choices (q0), global and local evaporation rate.
    improved : bool
        Whether 2-opt and Or-opt work on what each ant found.

    Returns
    -------
    (order, cost)
    """
    m = cost.shape[0]
    order, place = np.empty(m, np.int32), np.empty(m, np.int32)
    stack, waits = np.empty(m, np.int32), np.zeros(m, np.uint8)
    weights = np.empty(near.shape[1], np.float64)
    _from_nearest(cost, order, place)
    best, total = order.copy(), cost_of(cost, order)
    tau_zero = 1.0 / (m * max(total, least))
    tau = np.full((m, m), tau_zero)
    visible = np.maximum(cost, max(1e-4 * total / m, least))  # also of places that lie in one cell
    for iteration in range(iterations):
        for ant in range(number):
            own = _mix(key + np.uint64(iteration * number + ant + 1) * GOLDEN)
            _walk(visible, tau, near, beta, greed, xi, tau_zero, own, order, place, weights)
            if improved:
                for i in range(m):
                    stack[i], waits[i] = i, 1
                _improve(cost, near, order, place, stack, waits, m, least)
            found = cost_of(cost, order)
            if found < total - least:
                best[:] = order
                total = found
        deposit = rho / max(total, least)
        for i in range(m - 1):
            one, other = best[i], best[i + 1]
            tau[one, other] = tau[other, one] = (1.0 - rho) * tau[one, other] + deposit
    return best, total


@jit
def bound(cost, target, rounds):
    """No order costs less: the largest of some spanning trees' costs (Held & Karp 1970, doi 10.1287/opre.18.6.1138).

    An order is a spanning tree of which the first and the last node have one edge and all others two. Where a tree has
    more, its nodes become dearer, where it has fewer, cheaper: subgradient steps towards `target`, what a good order
    costs.
    """
    m = cost.shape[0]
    price = np.zeros(m)
    degree = np.empty(m, np.int64)
    to_tree, joint, inside = np.empty(m), np.empty(m, np.int32), np.empty(m, np.uint8)
    before = np.zeros(m)
    best, scale, stale, patience = -np.inf, 2.0, 0, max(5, rounds // 40)
    for _ in range(rounds):
        degree[:] = 0
        inside[:] = 0
        to_tree[:] = np.inf
        tree, node = 0.0, 0
        inside[0] = 1
        for _ in range(m - 1):
            chosen, nearest = -1, np.inf
            for other in range(m):
                if inside[other]:
                    continue
                edge = cost[node, other] + price[node] + price[other]
                if edge < to_tree[other]:
                    to_tree[other], joint[other] = edge, node
                if to_tree[other] < nearest:
                    nearest, chosen = to_tree[other], other
            tree += nearest
            inside[chosen] = 1
            degree[chosen] += 1
            degree[joint[chosen]] += 1
            node = chosen
        off = 0.0
        for i in range(m):
            wanted = 1 if i in (0, m - 1) else 2
            tree -= wanted * price[i]
            degree[i] -= wanted
            off += degree[i] * degree[i]
        if tree > best:
            best, stale = tree, 0
        else:
            stale += 1
        if off == 0.0:
            return tree
        if stale == patience:
            scale, stale = scale / 2, 0
        step = scale * max(target - tree, 1e-9 * abs(target)) / off
        for i in range(m):
            price[i] += step * (0.7 * degree[i] + 0.3 * before[i])
            before[i] = degree[i]
    return best
