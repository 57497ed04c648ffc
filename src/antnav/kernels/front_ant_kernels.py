"""P-ACO's ants, compiled: a pheromone matrix for each objective, and each ant with weights of its own.

Arrays of the instance as in `front_kernels`.
"""

from __future__ import annotations

import numpy as np

from antnav.kernels import splitmix
from antnav.kernels.jit import jit
from antnav.kernels.splitmix import GOLDEN

_mix, _unit = jit(splitmix.mix), jit(splitmix.unit)


@jit
def _uniform(key, draw):
    return _unit(_mix(key + np.uint64(draw) * GOLDEN))


@jit
def attraction(costs, turns, ideal, weights, unit, node, last, slot, other):
    """eta, 1 / (1 + detour / unit): the detour is what the weighted sum of price and least rest grows by."""
    detour = 0.0
    for j in range(weights.size):
        rise = np.float64(costs[node, slot, j]) + ideal[other, j] - ideal[node, j]
        if turns.size > 0:
            rise += turns[last, slot, j]
        detour += weights[j] * rise
    return 1.0 / (1.0 + detour / unit)


@jit
def iterate(neighbours, costs, turns, ideal, ranges, unit, tau, weights, ends, q0, rho, tau0, beta, seed, iteration):
    """Let each ant walk to the goal, a local update behind each move.

    An ant goes, with probability q0, where (sum_k w_k tau_k) eta^beta is largest, or else draws in proportion to it;
    never to a cell where it has been; no cell left ends its walk.

    Parameters
    ----------
    ranges : float64 (k,)
        Of the objectives, by which they are divided.
    unit : float
        A detour that halves eta.
    tau : float64 (k, n, 8)
    weights : float64 (ants, k)
        Of each ant, with the sum 1.
    ends : tuple of 2 ints
        Start and goal.
    beta : int

    Returns
    -------
    values : int64 (p, k)
    lengths : int32 (p,)
    nodes : int32
        Of the ants that arrived.
    """
    n, _, k = costs.shape
    start, goal = ends
    ants = weights.shape[0]
    values, lengths = np.zeros((ants, k), np.int64), np.empty(ants, np.int32)
    nodes = np.empty(4096, np.int32)
    seen = np.full(n, -1, np.int64)
    path = np.empty(n, np.int32)
    shares = np.zeros(8, np.float64)
    arrived, used = 0, 0
    for ant in range(ants):
        key = _mix(_mix(_mix(np.uint64(seed) + GOLDEN) + np.uint64(iteration)) + np.uint64(ant))
        node, last, count = start, 0, 1
        path[0] = node
        seen[node] = ant
        while node != goal:
            total, best = 0.0, -1
            for s in range(8):
                shares[s] = 0.0
                other = neighbours[node, s]
                if other == n or seen[other] == ant:
                    continue
                eta = attraction(costs, turns, ideal, weights[ant] / ranges, unit, node, last, s, other)
                trail = 0.0
                for j in range(k):
                    trail += weights[ant, j] * tau[j, node, s]
                for _ in range(beta):
                    trail *= eta
                shares[s] = trail
                total += trail
                if best < 0 or trail > shares[best]:
                    best = s
            if best < 0:
                break
            chosen = best
            if _uniform(key, 2 * count) >= q0:
                drawn = _uniform(key, 2 * count + 1) * total
                for s in range(8):
                    if shares[s] > 0.0:
                        chosen = s
                        drawn -= shares[s]
                        if drawn < 0.0:
                            break
            for j in range(k):
                values[arrived, j] += costs[node, chosen, j]
                if turns.size > 0:
                    values[arrived, j] += turns[last, chosen, j]
                tau[j, node, chosen] = (1.0 - rho) * tau[j, node, chosen] + rho * tau0
            node, last = neighbours[node, chosen], chosen + 1
            seen[node] = ant
            path[count] = node
            count += 1
        if node != goal:
            values[arrived] = 0
            continue
        while used + count > nodes.size:
            nodes = np.append(nodes, nodes)
        nodes[used : used + count] = path[:count]
        used += count
        lengths[arrived] = count
        arrived += 1
    return values[:arrived], lengths[:arrived], nodes[:used]


@jit
def evaporate(tau, rho):
    """(1 - rho) tau everywhere."""
    for j in range(tau.shape[0]):
        for i in range(tau.shape[1]):
            for s in range(8):
                tau[j, i, s] *= 1.0 - rho


@jit
def deposit(neighbours, matrix, nodes, amount):
    """Lay an amount on each move of a path."""
    for i in range(nodes.size - 1):
        s = 0
        while neighbours[nodes[i], s] != nodes[i + 1]:
            s += 1
        matrix[nodes[i], s] += amount
