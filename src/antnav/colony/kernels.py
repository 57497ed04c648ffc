"""The ants, compiled: walk, pheromone update, k iterations in one call.

Kernels know a `graph.Graph`, not a grid; "cell" below is a node of that graph.
Everything that one kernel calls lives in this file, because Numba's disk cache watches only the file of the caller.
`tests/colony/naive.py` holds a slow twin of each kernel and the tests compare them draw for draw.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from antnav._jit import jit
from antnav.colony.parts import Deadlock, Deposit, PheromoneRule

ANT_SYSTEM = PheromoneRule.ANT_SYSTEM.code
REWARD_AND_PUNISH = PheromoneRule.REWARD_AND_PUNISH.code
DEATH = Deadlock.DEATH.code
BACKTRACK = Deadlock.BACKTRACK.code
HYBRID = Deadlock.HYBRID.code
BOTH = Deposit.BOTH.code

#: Ants that walk in turn in one batch: one bit each in the word that says who has visited a cell.
BATCH = 64

WALKING, ARRIVED, DEAD = 0, 1, 2

_GOLDEN = np.uint64(0x9E3779B97F4A7C15)
_MIX_1 = np.uint64(0xBF58476D1CE4E5B9)
_MIX_2 = np.uint64(0x94D049BB133111EB)
_S27, _S30, _S31, _S11 = np.uint64(27), np.uint64(30), np.uint64(31), np.uint64(11)
_ONE, _ZERO, _EIGHT = np.uint64(1), np.uint64(0), np.uint64(8)
_TO_UNIT = 2.0**-53


class Choices(NamedTuple):
    """The scalars of one colony run."""

    start: int
    goal: int
    ants: int
    iterations: int  #: T of the schedule, eq. (4.1)
    alpha: float
    rho: float
    q: float
    tau_min: float
    punish: float  #: lambda of eq. (4.2)
    switch: float  #: b: the hybrid strategy kills dead ants once t > b T
    pheromone: int  #: code of PheromoneRule
    deadlock: int  #: code of Deadlock
    deposit: int  #: code of Deposit


class State(NamedTuple):
    """Everything that changes, allocated once a colony."""

    tau: np.ndarray  #: (n, 8) float64, pheromone of an edge, the same value in both directions
    eta: np.ndarray  #: (n, 8) float64, heuristic to the power beta, 0 where there is no neighbour
    weight: np.ndarray  #: (n, 8) float64, tau^alpha eta^beta, the numerator of eq. (3.1)
    visited: (
        np.ndarray
    )  #: (n + 1,) uint64, bit a: ant a of the batch has been here; all ones in the last, which is no cell
    path: np.ndarray  #: (m, n) int32, row a: cells of ant a
    slots: np.ndarray  #: (m, n) uint8, slot taken from each cell of the path
    steps_on_path: np.ndarray  #: (m,) int64
    status: np.ndarray  #: (m,) uint8
    met_dead_end: np.ndarray  #: (m,) uint8
    length: np.ndarray  #: (m,) float64
    order: np.ndarray  #: (m,) int64, arrived ants by length
    dead_count: np.ndarray  #: (n,) int32, M_lost of eq. (4.2)
    dead_last: np.ndarray  #: (n,) uint64, bit k: the edge of slot k led here
    dead_pairs: np.ndarray  #: (n,) uint64, bit 8 k + l: the edges of slot k and, one before, of slot l led here
    visits: np.ndarray  #: (n,) int64, arrived paths through each cell, over all iterations
    best_path: np.ndarray  #: (n,) int32
    best_steps: np.ndarray  #: (1,) int64, edges of the best path; -1 before the first arrival


class History(NamedTuple):
    """One value an iteration."""

    best: np.ndarray  #: float64, best length so far, inf before the first arrival
    iteration_best: np.ndarray  #: float64, inf where no ant arrived
    mean: np.ndarray  #: float64, mean length of the arrived ants, nan where none arrived
    arrived: np.ndarray  #: int64
    lost: np.ndarray  #: int64, ants that met a dead end and did not arrive
    steps: np.ndarray  #: int64, moves of all ants, steps back included
    entropy: np.ndarray  #: float64, mean entropy (bits) of the choices along the iteration's best path, nan without one


#: Fields of `History` that count ants or moves.
COUNTS = frozenset({"arrived", "lost", "steps"})


def new_history(length: int) -> History:
    """A history of unwritten values."""
    return History(*(np.empty(length, np.int64 if name in COUNTS else np.float64) for name in History._fields))


@jit
def mix(z):
    """Finalizer of SplitMix64 (Steele, Lea & Flood 2014, doi 10.1145/2714064.2660195)."""
    z = (z ^ (z >> _S30)) * _MIX_1
    z = (z ^ (z >> _S27)) * _MIX_2
    return z ^ (z >> _S31)


@jit
def stream(seed, colony, iteration, ant):
    """Key of one ant's own random stream."""
    key = mix(np.uint64(seed) + _GOLDEN)
    key = mix(key + np.uint64(colony))
    key = mix(key + np.uint64(iteration))
    return mix(key + np.uint64(ant))


@jit
def uniform(key, draw):
    """Draw number `draw` (1, 2, ...) of a stream: uniform in [0, 1), 53 bits."""
    return np.float64(mix(key + np.uint64(draw) * _GOLDEN) >> _S11) * _TO_UNIT


@jit
def set_weights(choices, state):
    """Clamp tau from below, then the numerator of eq. (3.1) for every edge.

    One flat loop each: the compiler vectorizes that, which makes it four times faster.
    """
    tau, eta, weight = state.tau.ravel(), state.eta.ravel(), state.weight.ravel()
    tau_min = choices.tau_min
    for e in range(tau.size):
        tau[e] = max(tau[e], tau_min)
    if choices.alpha == 1.0:
        for e in range(tau.size):
            weight[e] = tau[e] * eta[e]
        return
    whole = int(choices.alpha)
    for e in range(tau.size):
        power = 1.0
        if whole == choices.alpha:  # multiplications agree on every machine, powers do not
            for _ in range(whole):
                power *= tau[e]
        else:
            power = tau[e] ** choices.alpha
        weight[e] = power * eta[e]


@jit
def walk(graph, choices, state, seed, colony, t):
    """Let all ants of iteration t walk (section 3 and 4.2); returns the number of moves.

    The ants of a batch move in turn, one move a round: their loads overlap, where one ant alone would wait for each.
    Every ant draws from its own stream and sees only its own tabu list, so the turns change nothing in the result.
    """
    neighbours, weight, visited = graph.neighbours, state.weight, state.visited
    path, slots_taken, reverse = state.path, state.slots, graph.reverse
    dead_count, dead_last, dead_pairs = state.dead_count, state.dead_last, state.dead_pairs
    retract = choices.deadlock == HYBRID and t <= choices.switch * choices.iterations
    alive = np.empty(BATCH, np.int64)
    cells = np.empty(BATCH, np.int64)
    depths = np.empty(BATCH, np.int64)
    draws = np.empty(BATCH, np.int64)
    running = np.empty(8, np.float64)
    stepped_back = np.empty(BATCH, np.bool_)
    keys = np.empty(BATCH, np.uint64)
    moves = 0
    for first in range(0, choices.ants, BATCH):
        count = min(BATCH, choices.ants - first)
        visited[:] = _ZERO
        visited[visited.size - 1] = ~_ZERO
        for a in range(count):
            alive[a] = a
            cells[a] = choices.start
            depths[a] = 0
            draws[a] = 0
            stepped_back[a] = False
            keys[a] = stream(seed, colony, t, first + a)
            path[first + a, 0] = choices.start
            state.status[first + a] = WALKING
            state.met_dead_end[first + a] = 0
        visited[choices.start] = ~_ZERO
        walking = count
        while walking > 0:
            kept = 0
            for turn in range(walking):
                a = alive[turn]
                ant = first + a
                cell = cells[a]
                depth = depths[a]
                shift = np.uint64(a)
                bit = _ONE << shift
                draws[a] += 1
                total = 0.0
                for k in range(8):  # no branch: a wrong guess by the processor costs more than the sums
                    free = _ONE - ((visited[neighbours[cell, k]] >> shift) & _ONE)
                    total += weight[cell, k] * np.float64(free)
                    running[k] = total
                if total > 0.0:
                    target = uniform(keys[a], draws[a]) * total
                    slot = 0
                    for k in range(7):
                        slot += target >= running[k] and running[k] < total
                    cell = neighbours[cell, slot]
                    slots_taken[ant, depth] = slot
                    depth += 1
                    path[ant, depth] = cell
                    visited[cell] |= bit
                    stepped_back[a] = False
                    cells[a] = cell
                    depths[a] = depth
                    moves += 1
                    if cell == choices.goal:
                        state.status[ant] = ARRIVED
                        state.steps_on_path[ant] = depth
                        continue
                else:
                    state.met_dead_end[ant] = 1
                    dies = not retract
                    if choices.deadlock == BACKTRACK:
                        dies = stepped_back[a]
                        stepped_back[a] = True
                    if choices.deadlock != DEATH and depth > 0:
                        dead_count[cell] += 1
                        last = np.uint64(reverse[path[ant, depth - 1], slots_taken[ant, depth - 1]])
                        if depth > 1:
                            before = np.uint64(reverse[path[ant, depth - 2], slots_taken[ant, depth - 2]])
                            dead_pairs[cell] |= _ONE << (last * _EIGHT + before)
                        else:
                            dead_last[cell] |= _ONE << last
                    if dies or depth == 0:
                        state.status[ant] = DEAD
                        continue
                    depths[a] = depth - 1
                    cells[a] = path[ant, depth - 1]
                    moves += 1
                alive[kept] = a
                kept += 1
            walking = kept
    return moves


@jit
def _rank_arrived(graph, choices, state):
    """Length of each arrived ant, their order (shortest first, equal lengths in ant order), and the visits."""
    path, visits = state.path, state.visits
    arrived = 0
    for ant in range(choices.ants):
        if state.status[ant] != ARRIVED:
            continue
        total = 0.0
        for s in range(state.steps_on_path[ant]):
            total += graph.lengths[path[ant, s], state.slots[ant, s]]
            visits[path[ant, s]] += 1
        visits[choices.goal] += 1
        state.length[ant] = total
        place = arrived
        while place > 0 and state.length[state.order[place - 1]] > total:
            state.order[place] = state.order[place - 1]
            place -= 1
        state.order[place] = ant
        arrived += 1
    return arrived


@jit
def _deposit(graph, choices, state, ant, amount):
    """Add pheromone to the edges of one ant's path."""
    for s in range(state.steps_on_path[ant]):
        i = state.path[ant, s]
        k = state.slots[ant, s]
        j = graph.neighbours[i, k]
        state.tau[i, k] += amount
        if choices.deposit == BOTH:
            state.tau[j, graph.reverse[i, k]] += amount


@jit
def update_pheromone(graph, choices, state, arrived, t):
    """Evaporation, eq. (3.3), then the deposits of the chosen rule."""
    tau = state.tau.ravel()
    keep = 1.0 - choices.rho
    for e in range(tau.size):
        tau[e] *= keep
    if choices.pheromone == ANT_SYSTEM:
        for ant in range(choices.ants):
            if state.status[ant] == ARRIVED:
                _deposit(graph, choices, state, ant, choices.q / state.length[ant])
    elif choices.pheromone == REWARD_AND_PUNISH:
        c = (10 * t + choices.iterations - 1) // choices.iterations
        for rank in range(min(11 - c, arrived)):
            ant = state.order[rank]
            _deposit(graph, choices, state, ant, c * choices.q / state.length[ant])
        punish = -1.0 if 2 * t <= choices.iterations else -0.2
        for rank in range(max(0, arrived - c), arrived):
            ant = state.order[rank]
            _deposit(graph, choices, state, ant, punish * choices.q / state.length[ant])


@jit
def punish_dead_ends(graph, choices, state):
    """Eq. (4.2) at every dead cell, in cell order, once an edge and dead cell; forgets the dead ends.

    Only the direction that led there fades: fading both ways also closes the way out of a trap, and halves the share
    of runs that reach the optimum on the 40x40 map (docs/algorithms/paco.md).
    """
    tau, neighbours, reverse = state.tau, graph.neighbours, graph.reverse
    for cell in range(state.dead_count.size):
        count = state.dead_count[cell]
        if count == 0:
            continue
        factor = 1.0
        for _ in range((count + 2) // 3):
            factor *= 1.0 - choices.punish
        for k in range(8):
            before = (state.dead_pairs[cell] >> np.uint64(8 * k)) & np.uint64(255)
            if not before and not (state.dead_last[cell] >> np.uint64(k)) & _ONE:
                continue
            previous = neighbours[cell, k]
            tau[previous, reverse[cell, k]] *= factor
            if choices.deadlock == BACKTRACK:
                continue
            for other in range(8):
                if (before >> np.uint64(other)) & _ONE:
                    tau[neighbours[previous, other], reverse[previous, other]] *= factor
        state.dead_count[cell] = 0
        state.dead_last[cell] = _ZERO
        state.dead_pairs[cell] = _ZERO


@jit
def _path_entropy(state, ant):
    """Mean over a path's cells of the entropy, in bits, of the choice that eq. (3.1) offers there before tabu."""
    steps = state.steps_on_path[ant]
    entropy = 0.0
    for s in range(steps):
        i = state.path[ant, s]
        total = 0.0
        for k in range(8):
            total += state.weight[i, k]
        for k in range(8):
            p = state.weight[i, k] / total
            if p > 0.0:
                entropy -= p * np.log2(p)
    return entropy / steps


@jit
def advance(graph, choices, state, history, seed, colony, first, k):
    """Run iterations first, ..., first + k - 1, counted from 1. State and history say everything that comes of it."""
    set_weights(choices, state)  # somebody may have written to tau since the last call
    for t in range(first, first + k):
        moves = walk(graph, choices, state, seed, colony, t)
        arrived = _rank_arrived(graph, choices, state)
        best = history.best[t - 2] if t > 1 else np.inf
        mean = np.nan
        shortest = np.inf
        entropy = np.nan
        if arrived > 0:
            winner = state.order[0]
            shortest = state.length[winner]
            entropy = _path_entropy(state, winner)
            mean = 0.0
            for rank in range(arrived):
                mean += state.length[state.order[rank]]
            mean /= arrived
            if shortest < best:
                best = shortest
                steps = state.steps_on_path[winner]
                state.best_steps[0] = steps
                for s in range(steps + 1):
                    state.best_path[s] = state.path[winner, s]
        lost = 0
        for ant in range(choices.ants):
            lost += state.met_dead_end[ant] and state.status[ant] != ARRIVED
        history.best[t - 1] = best
        history.iteration_best[t - 1] = shortest
        history.mean[t - 1] = mean
        history.arrived[t - 1] = arrived
        history.lost[t - 1] = lost
        history.steps[t - 1] = moves
        history.entropy[t - 1] = entropy
        update_pheromone(graph, choices, state, arrived, t)
        punish_dead_ends(graph, choices, state)
        set_weights(choices, state)
