"""Where the kernel asks rules of the user's own, compiled or in Python: see `plugs`."""

from __future__ import annotations

import numpy as np

from antnav.kernels import plugs
from antnav.kernels.jit import jit
from antnav.kernels.plugs import Ants, Step

_ONE = np.uint64(1)


@jit
def _ants(graph, choices, state, own, kind, arrived, best, rho, t):
    """What rules of the user's see of an iteration; what one in Python is told of it."""
    own.numbers[0], own.numbers[1], own.numbers[2], own.numbers[3] = t, arrived, state.best_steps[0], state.stagnant[0]
    own.measures[0], own.measures[1] = best, rho
    return Ants(
        t,
        choices.iterations,
        choices.start,
        choices.goal,
        arrived,
        best,
        state.stagnant[0],
        rho,
        choices.q,
        choices.tau0,
        state.order,
        state.length,
        state.status,
        state.steps_on_path,
        state.path,
        state.slots,
        state.best_steps[0],
        state.best_path,
        state.best_slots,
        state.visits,
        graph.neighbours,
        graph.lengths,
        graph.reverse,
        state.tau,
        state.bounds,
        own.amounts,
        own.notes[kind],
        own.own[kind],
    )


@jit
def _said(compiled, address, seen, kind, error):
    """What the user's rule of a kind says."""
    answer = plugs.ask(address, seen) if compiled else plugs.call(address, kind)
    if answer == plugs.FAILED:
        error[plugs.WRONG], error[plugs.ANT] = plugs.RAISED, kind
    return answer


@jit
def deposits(graph, choices, state, own, arrived, best, rho, t):
    """Let the user's pheromone rule write amounts, and whatever else it may."""
    own.amounts[:] = 0.0
    seen = _ants(graph, choices, state, own, plugs.PHEROMONE, arrived, best, rho, t)
    compiled = own.ways[plugs.PHEROMONE] == plugs.COMPILED
    address = own.addresses[plugs.PHEROMONE] if compiled else own.callback
    _said(compiled, address, seen, plugs.PHEROMONE, own.error)
    if own.error[plugs.WRONG] == 0:
        own.error[plugs.WRONG] = _written(graph.neighbours, state.tau, state.bounds)


@jit
def _written(neighbours, tau, bounds):
    """What is wrong with the pheromone and the bounds that a rule has left; 0: nothing.

    Bounds of at least 0 keep weights so, without which the roulette could choose a wall. Where there is no edge tau
    counts for nothing, but must be finite: 0 times inf is not 0.
    """
    n = neighbours.shape[0]
    if not 0.0 <= bounds[0] <= bounds[1] or bounds[0] == np.inf:
        return plugs.NO_BOUNDS
    flat, odd = tau.ravel(), 0
    for e in range(flat.size):  # vectorized: 1 us where a test of each took 6
        odd += flat[e] - flat[e] != 0.0
    if odd == 0:
        return 0
    flat, wrong = tau.ravel(), 0
    for e in range(flat.size):  # without a branch, so that the compiler vectorizes it
        wrong += not abs(flat[e]) < np.inf
    for i in range(n if wrong else 0):
        for k in range(8):
            if not np.isfinite(tau[i, k]):
                if neighbours[i, k] < n:
                    return plugs.NO_TAU
                tau[i, k] = 0.0
    return 0


@jit
def search(graph, choices, state, own, arrived, best, rho, t):
    """Let the user's local search change paths, and check them."""
    seen = _ants(graph, choices, state, own, plugs.LOCAL_SEARCH, arrived, best, rho, t)
    compiled = own.ways[plugs.LOCAL_SEARCH] == plugs.COMPILED
    address = own.addresses[plugs.LOCAL_SEARCH] if compiled else own.callback
    _said(compiled, address, seen, plugs.LOCAL_SEARCH, own.error)
    for rank in range(arrived):
        ant = state.order[rank]
        steps = state.steps_on_path[ant]
        if own.error[plugs.WRONG] == 0 and not _slots_found(
            graph.neighbours, choices.start, choices.goal, state.path[ant], state.slots[ant], steps, state.place
        ):
            own.error[plugs.WRONG], own.error[plugs.ANT] = plugs.BROKEN, ant
    for ant in range(choices.ants):
        if own.error[plugs.WRONG] == 0 and not _on_map(state.path[ant], state.steps_on_path[ant], graph.neighbours):
            own.error[plugs.WRONG], own.error[plugs.ANT] = plugs.ASTRAY, ant


@jit
def _on_map(path, steps, neighbours):
    n = neighbours.shape[0]
    if not 0 <= steps < n:
        return False
    good = True
    for s in range(steps + 1):
        good = good and 0 <= path[s] < n
    return good


@jit
def _slots_found(neighbours, start, goal, path, slots, steps, place):
    """Whether a path leads from the start to the goal, edge by edge and nowhere twice; writes its slots."""
    n = neighbours.shape[0]
    if not 0 < steps < n or path[0] != start or path[steps] != goal:
        return False
    for s in range(steps + 1):
        if not 0 <= path[s] < n:
            return False
    good = True
    for s in range(steps):
        slot = -1
        for k in range(8):
            if neighbours[path[s], k] == path[s + 1]:
                slot = k
        good = good and slot >= 0 and place[path[s]] == 0 and path[s] != goal
        place[path[s]] = 1
        slots[s] = np.uint8(max(slot, 0))
    for s in range(steps):
        place[path[s]] = 0
    return good


@jit
def step(graph, state, own, kind):
    """What rules of a kind are given in each step, but for its numbers."""
    return Step(
        own.numbers,
        own.weights,
        own.draws,
        graph.neighbours,
        graph.lengths,
        state.tau,
        own.notes[kind],
        own.own[kind],
    )


@jit
def slot(way, address, given, error, weight, neighbours, visited, shift):
    """The slot that the user's transition rule chooses; the first open one where that is none.

    weight, neighbours: of the ant's cell. `given.numbers` and `given.draws` are written already.
    """
    weights = given.weights
    first = -1
    for k in range(8):
        weights[k] = weight[k] * np.float64(_ONE - ((visited[neighbours[k]] >> shift) & _ONE))
    for k in range(8):
        if first < 0 and weights[k] > 0.0:
            first = k
    chosen = first
    if error[plugs.WRONG] == 0:
        chosen = _said(way == plugs.COMPILED, address, given, plugs.TRANSITION, error)
        if error[plugs.WRONG] != 0:
            return first
        if not 0 <= chosen < 8 or weights[chosen] <= 0.0:
            error[plugs.WRONG] = plugs.CLOSED
            return first
    return chosen


@jit
def dies(way, address, given, error):
    """Whether an ant in a dead end dies by the user's deadlock rule. `given.numbers` are written already."""
    if error[plugs.WRONG] != 0:
        return True
    return _said(way == plugs.COMPILED, address, given, plugs.DEADLOCK, error) != 0
