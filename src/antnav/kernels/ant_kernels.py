"""The ants, compiled: walk, pheromone update, k iterations in one call.

Kernels know a `graph.Graph`, not a grid; "cell" below is a node of that graph.
What one kernel calls lives in its own file: `tests/kernels/test_sources.py` keeps it so.
`tests/kernels/naive.py` holds a slow twin of each kernel and the tests compare them draw for draw.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from antnav.kernels import own_kernels, plugs, splitmix
from antnav.kernels.codes import Deadlock, Deposit, LocalSearch, PheromoneRule, Transition
from antnav.kernels.graph import SQRT2
from antnav.kernels.jit import jit
from antnav.kernels.splitmix import GOLDEN

ANT_SYSTEM = int(PheromoneRule.ANT_SYSTEM)
REWARD_AND_PUNISH = int(PheromoneRule.REWARD_AND_PUNISH)
RANK_BASED = int(PheromoneRule.RANK_BASED)
MAX_MIN = int(PheromoneRule.MAX_MIN)
BEST_SO_FAR = int(PheromoneRule.BEST_SO_FAR)
BEST_AND_WORST = int(PheromoneRule.BEST_AND_WORST)
BEST_AND_TURNS = int(PheromoneRule.BEST_AND_TURNS)
DEATH = int(Deadlock.DEATH)
BACKTRACK = int(Deadlock.BACKTRACK)
RETRACT = int(Deadlock.RETRACT)
HYBRID = int(Deadlock.HYBRID)
BOTH = int(Deposit.BOTH)
CELLS = int(Deposit.CELLS)
NO_SEARCH = int(LocalSearch.NONE)
MERGE = int(LocalSearch.MERGE)
TAUT = int(LocalSearch.TAUT)
WEAVE = int(LocalSearch.WEAVE)
PSEUDO_RANDOM = int(Transition.PSEUDO_RANDOM)

#: Iterations without improvement after which the pseudo-random rule is relieved once more [reconstruction].
PATIENCE = 5
#: Ants whose pieces are merged into one path: the shortest of the iteration.
MERGED = 10
#: Costs whose difference is less are the same: sums of floats differ by rounding.
SAME_COST = 1e-9
#: Ants that walk in turn in one batch: one bit each in the word that says who has visited a cell.
BATCH = 64
#: Cells that share a flag which says whether one of them is a dead end.
BLOCK = 64
#: Columns of `State.past`: bounds of tau at the beginning of an iteration, by what factor it evaporates, and tau at its
#: end on an edge on which nothing but that has ever happened.
LOW, HIGH, KEEP, BARE = 0, 1, 2, 3

WALKING, ARRIVED, DEAD = 0, 1, 2

_ONE, _ZERO, _EIGHT = np.uint64(1), np.uint64(0), np.uint64(8)


class Choices(NamedTuple):
    """The scalars of one colony run."""

    start: int
    goal: int
    known: float  #: cost of the best path before the first iteration, inf without one
    ants: int
    iterations: int  #: T of the schedule, eq. (4.1)
    alpha: float
    rho: float  #: at t = 0 ...
    rho_last: float  #: ... and at t = T
    beta_share: float  #: beta at t = T over beta at t = 0
    spread: float  #: share of a deposit that all edges into the cells of the path get
    q: float
    tau0: float
    punish: float  #: lambda of eq. (4.2)
    retract_until: int  #: b T: the hybrid strategy kills dead ants in later iterations
    pheromone: int  #: of codes.PheromoneRule
    deadlock: int  #: of codes.Deadlock
    deposit: int  #: of codes.Deposit
    local_search: int  #: of codes.LocalSearch
    graft: bool  #: whether arrived ants give their shorter pieces to the best path so far
    transition: int  #: of codes.Transition
    headings: int  #: 9 where the heuristic depends on the last move (0: none yet, 1 + slot), else 1
    q0_min: float  #: q0 of the pseudo-random rule at t = 0 ...
    q0_max: float  #: ... and at t = T
    q0_relief: float  #: factor on q0 for every `PATIENCE` iterations without improvement
    local_rate: float  #: xi of the local update of the Ant Colony System; 0 for none
    elite: int  #: w of the rank-based rule
    q3: float  #: weight of smoothness in `BEST_AND_TURNS`
    mean_choices: float  #: mean number of neighbours, for the bounds of `MAX_MIN`
    best_every: int  #: `MAX_MIN`: the best so far deposits every so many iterations
    dear: bool  #: whether moves have prices, so that fewer moves need not cost less
    turning: float  #: cost in cells of a turn by one radian
    passes: bool  #: whether each iteration passes over all edges, which is faster where these are few
    restart: int  #: `MAX_MIN`: iterations without improvement after which all pheromone is tau_max again


class State(NamedTuple):
    """Everything that changes, allocated once a colony."""

    tau: np.ndarray  #: (n, 8) float64, pheromone of each edge in the direction that leaves the row's cell; see `latest`
    latest: (
        np.ndarray
    )  #: (n,) int32, how far a row of tau is: 2 t - 1 where iteration t begins, 2 t after evaporation in t
    past: np.ndarray  #: (T + 2, 4) float64, what happened in each iteration to every edge; see `LOW`
    eta: np.ndarray  #: (n headings, 8) float64, heuristic to the power beta, 0 where there is no neighbour
    weight: (
        np.ndarray
    )  #: (n headings, 8) float64, tau^alpha eta^beta, the numerator of eq. (3.1), where an ant is or was
    exponent: np.ndarray  #: (1,) float64, exponent on eta in this iteration
    place: np.ndarray  #: (n,) int32, place + 1 of a cell in the path under local search, else 0
    merged_path: np.ndarray  #: (n,) int32, scratch of the local search
    merged_slots: np.ndarray  #: (n,) uint8
    bounds: np.ndarray  #: (2,) float64, tau_min and tau_max
    stagnant: np.ndarray  #: (2,) int64, iterations since the best improved, and since it did or pheromone was reset
    angles: np.ndarray  #: (8, 8) float64, angle in radians between the directions of two slots
    visited: (
        np.ndarray
    )  #: (n + 1,) uint64, bit a: ant a of the batch has been here; all ones in the last, which is no cell
    seen: np.ndarray  #: (n batches,) int32, cells that the ants of each batch have visited in this iteration ...
    count_seen: np.ndarray  #: (1,) int64, ... and how many these are
    path: np.ndarray  #: (m, n) int32, row a: cells of ant a
    slots: np.ndarray  #: (m, n) uint8, slot taken from each cell of the path
    steps_on_path: np.ndarray  #: (m,) int64
    status: np.ndarray  #: (m,) uint8
    met_dead_end: np.ndarray  #: (m,) uint8
    length: np.ndarray  #: (m,) float64
    order: np.ndarray  #: (m,) int64, arrived ants by length
    depositor: np.ndarray  #: (2 m + 1,) int64, ants that deposit in this iteration, -1 for the best path so far
    amount: np.ndarray  #: (2 m + 1,) float64, how much each of them
    dead_count: np.ndarray  #: (n,) int32, M_lost of eq. (4.2)
    dead_last: np.ndarray  #: (n,) uint64, bit k: the edge of slot k led here
    dead_pairs: np.ndarray  #: (n,) uint64, bit 8 k + l: the edges of slot k and, one before, of slot l led here
    dead_blocks: np.ndarray  #: (n / 64, rounded up) uint8, 1: there is a dead end among these 64 cells
    visits: np.ndarray  #: (n,) int64, arrived paths through each cell, over all iterations
    best_path: np.ndarray  #: (n,) int32
    best_slots: np.ndarray  #: (n,) uint8
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


mix, _unit = jit(splitmix.mix), jit(splitmix.unit)


@jit
def stream(seed, colony, iteration, ant):
    """Key of one ant's own random stream."""
    key = mix(np.uint64(seed) + GOLDEN)
    key = mix(key + np.uint64(colony))
    key = mix(key + np.uint64(iteration))
    return mix(key + np.uint64(ant))


@jit
def uniform(key, draw):
    """Draw number `draw` (1, 2, ...) of a stream: uniform in [0, 1), 53 bits."""
    return _unit(mix(key + np.uint64(draw) * GOLDEN))


@jit
def _power(base, exponent):
    """Base ** exponent, 0 for base 0; by multiplications where the exponent is whole: they agree on every machine."""
    if base == 0.0:
        return 0.0
    whole = int(exponent)
    if whole != exponent:
        return base**exponent
    power = 1.0
    for _ in range(whole):
        power *= base
    return power


@jit
def _rho(choices, t):
    """Evaporation rate in iteration t."""
    return choices.rho + (choices.rho_last - choices.rho) * t / choices.iterations


@jit
def _catch_up(tau, latest, past, cells, t):
    """Bring rows of tau to the beginning of iteration t: within its bounds, after all evaporation before.

    Bytes are those of a pass over all edges in each iteration, but the work is that of the rows that ants come to.
    """
    bare_now = min(max(past[t - 1, BARE], past[t, LOW]), past[t, HIGH])
    for i in cells:
        if latest[i] >= 2 * t - 1:
            continue
        s = (latest[i] >> 1) + 1
        low, high = past[s, LOW], past[s, HIGH]
        if latest[i] & 1 == 0:
            for k in range(8):
                tau[i, k] = min(max(tau[i, k], low), high)
        if s < t:
            bare, like = min(max(past[s - 1, BARE], low), high), 0
            for k in range(8):
                like += tau[i, k] == bare
            if like == 8:
                for k in range(8):
                    tau[i, k] = bare_now
            else:
                for r in range(s, t):
                    keep, low, high = past[r, KEEP], past[r + 1, LOW], past[r + 1, HIGH]
                    for k in range(8):
                        tau[i, k] = min(max(keep * tau[i, k], low), high)
        latest[i] = 2 * t - 1


@jit
def _evaporate(tau, latest, past, cells, t):
    """Tau <- (1 - rho) tau, eq. (3.3), in rows of iteration t where that is not done yet."""
    _catch_up(tau, latest, past, cells, t)
    keep = past[t, KEEP]
    for i in cells:
        if latest[i] < 2 * t:
            for k in range(8):
                tau[i, k] *= keep
            latest[i] = 2 * t


@jit
def _evaporate_all(tau, keep):
    """The same for all of tau, flat."""
    for e in range(tau.size):
        tau[e] *= keep


@jit
def settle(tau, latest, past, bounds, t):
    """Bring all rows of tau to the end of iteration t, for somebody who looks at them or writes to them."""
    past[t + 1, LOW], past[t + 1, HIGH] = bounds
    _catch_up(tau, latest, past, np.arange(latest.size, dtype=np.int32), t + 1)
    latest[:] = 2 * t  # what is written there need not be within the bounds


@jit
def _multiply_row(tau, eta, weight, alpha, exponent, headings, i):
    """The numerator of eq. (3.1) for the edges of one cell."""
    for k in range(8):
        power = _power(tau[i, k], alpha)
        for row in range(i * headings, (i + 1) * headings):
            weight[row, k] = power * _power(eta[row, k], exponent)


@jit
def _weigh(tau, latest, past, eta, weight, alpha, exponent, headings, cells, t):
    """The numerator of eq. (3.1) for the edges of some cells in iteration t."""
    _catch_up(tau, latest, past, cells, t)
    if headings == 1 and alpha == 1.0 and exponent == 1.0:
        for i in cells:
            for k in range(8):
                weight[i, k] = tau[i, k] * eta[i, k]
        return
    for i in cells:
        _multiply_row(tau, eta, weight, alpha, exponent, headings, i)


@jit
def _keep_bounds(tau, low, high):
    """Keep all of tau, flat, between its bounds: a flat loop, which the compiler vectorizes, is four times faster."""
    for e in range(tau.size):
        tau[e] = min(max(tau[e], low), high)


@jit
def _multiply(tau, eta, weight, alpha, exponent, headings):
    """The numerator of eq. (3.1) for all edges."""
    if headings == 1 and alpha == 1.0 and exponent == 1.0:
        flat_tau, flat_eta, flat_weight = tau.ravel(), eta.ravel(), weight.ravel()
        for e in range(flat_tau.size):
            flat_weight[e] = flat_tau[e] * flat_eta[e]
        return
    for i in range(tau.shape[0]):
        _multiply_row(tau, eta, weight, alpha, exponent, headings, i)


@jit
def begin(choices, state, t):
    """Note what iteration t does to every edge; rows of tau follow when somebody needs them, on small maps at once."""
    past = state.past
    past[0, BARE] = choices.tau0
    past[t, LOW], past[t, HIGH] = state.bounds
    past[t, KEEP] = 1.0 if choices.pheromone == BEST_SO_FAR else 1.0 - _rho(choices, t)
    past[t, BARE] = past[t, KEEP] * min(max(past[t - 1, BARE], past[t, LOW]), past[t, HIGH])
    exponent = 1.0 + (choices.beta_share - 1.0) * t / choices.iterations
    state.exponent[0] = exponent
    if choices.passes:
        tau, eta, weight = state.tau, state.eta, state.weight
        _keep_bounds(tau.ravel(), past[t, LOW], past[t, HIGH])
        state.latest[:] = 2 * t - 1
        _multiply(tau, eta, weight, choices.alpha, exponent, choices.headings)


@jit
def _wear(choices, tau, eta, weight, exponent, i, k):
    """Local update of the Ant Colony System on one edge: tau <- (1 - xi) tau + xi tau0."""
    worn = (1.0 - choices.local_rate) * tau[i, k] + choices.local_rate * choices.tau0
    tau[i, k] = worn
    power = _power(worn, choices.alpha)
    for row in range(i * choices.headings, (i + 1) * choices.headings):
        weight[row, k] = power * _power(eta[row, k], exponent)


@jit
def _q0(choices, stagnant, t):
    """q0 of the pseudo-random rule in iteration t."""
    q0 = choices.q0_min + (choices.q0_max - choices.q0_min) * t / choices.iterations
    for _ in range(stagnant // PATIENCE):
        q0 *= choices.q0_relief
    return q0


@jit
def _best_slot(weights, neighbours, visited, shift):
    """Slot of the largest weight among the unvisited neighbours; ties go to the first."""
    best, most = -1, 0.0
    for k in range(8):
        if weights[k] > most and not (visited[neighbours[k]] >> shift) & _ONE:
            best, most = k, weights[k]
    return best


@jit
def _draw(draws, key, draw):
    """Draw the numbers of a step, the first of which is the roulette's own; returns the latest draw."""
    for k in range(plugs.DRAWS):
        draws[k] = uniform(key, draw + k)
    return draw + plugs.DRAWS - 1


@jit
def walk(graph, choices, state, seed, colony, t, own):
    """Let all ants of iteration t walk (section 3 and 4.2); returns the number of moves.

    The ants of a batch move in turn, one move a round: their loads overlap, where one ant alone would wait for each.
    Every ant draws from its own stream and sees only its own tabu list, so the turns change nothing in the result, but
    for the local update: there each ant sees what the others have worn.

    own: None, or `plugs.Plugs`: then a walk of its own is compiled, which asks the user's rules.
    """
    neighbours, weight, visited, seen = graph.neighbours, state.weight, state.visited, state.seen
    path, slots_taken, reverse = state.path, state.slots, graph.reverse
    dead_count, dead_last, dead_pairs = state.dead_count, state.dead_last, state.dead_pairs
    dead_blocks = state.dead_blocks
    headings, goal = choices.headings, choices.goal
    retract = choices.deadlock == RETRACT or (choices.deadlock == HYBRID and t <= choices.retract_until)
    punishes = choices.deadlock not in (DEATH, RETRACT)
    greedy = choices.transition == PSEUDO_RANDOM
    q0 = _q0(choices, state.stagnant[0], t)
    tau, latest, past, eta = state.tau, state.latest, state.past, state.eta
    alpha, exponent, passes = choices.alpha, state.exponent[0], choices.passes
    alive = np.empty(BATCH, np.int64)
    cells = np.empty(BATCH, np.int64)
    depths = np.empty(BATCH, np.int64)
    draws = np.empty(BATCH, np.int64)
    rows = np.empty(BATCH, np.int64)
    running = np.empty(8, np.float64)
    stepped_back = np.empty(BATCH, np.bool_)
    backs = np.zeros(BATCH, np.int64)
    keys = np.empty(BATCH, np.uint64)
    moves, count_seen = 0, 0
    if own is not None:
        step = own_kernels.step(graph, state, own, plugs.TRANSITION)
        dead_end = own_kernels.step(graph, state, own, plugs.DEADLOCK)
        numbers, error = own.numbers, own.error
        numbers[0], numbers[1], numbers[2], numbers[6] = t, choices.iterations, goal, state.stagnant[0]
        chooses, kills = own.ways[plugs.TRANSITION], own.ways[plugs.DEADLOCK]
        choosing = own.addresses[plugs.TRANSITION] if chooses == plugs.COMPILED else own.callback
        killing = own.addresses[plugs.DEADLOCK] if kills == plugs.COMPILED else own.callback
    for first in range(0, choices.ants, BATCH):
        count = min(BATCH, choices.ants - first)
        for a in range(count):
            alive[a] = a
            cells[a] = choices.start
            depths[a] = 0
            draws[a] = 0
            rows[a] = choices.start * headings
            stepped_back[a] = False
            backs[a] = 0
            keys[a] = stream(seed, colony, t, first + a)
            path[first + a, 0] = choices.start
            state.status[first + a] = WALKING
            state.met_dead_end[first + a] = 0
        visited[choices.start] = ~_ZERO
        seen[count_seen] = choices.start
        new, count_seen, begun = count_seen, count_seen + 1, count_seen
        walking = count
        while walking > 0:
            if count_seen > new and not passes:
                _weigh(tau, latest, past, eta, weight, alpha, exponent, headings, seen[new:count_seen], t)
                new = count_seen
            kept = 0
            for turn in range(walking):
                a = alive[turn]
                ant = first + a
                cell = cells[a]
                depth = depths[a]
                row = rows[a]
                shift = np.uint64(a)
                bit = _ONE << shift
                draws[a] += 1
                total = 0.0
                for k in range(8):  # no branch: a wrong guess by the processor costs more than the sums
                    free = _ONE - ((visited[neighbours[cell, k]] >> shift) & _ONE)
                    total += weight[row, k] * np.float64(free)
                    running[k] = total
                if total > 0.0:
                    target = uniform(keys[a], draws[a]) * total
                    slot = 0
                    for k in range(7):
                        slot += target >= running[k] and running[k] < total
                    if greedy:
                        draws[a] += 1
                        if uniform(keys[a], draws[a]) < q0:
                            slot = _best_slot(weight[row], neighbours[cell], visited, shift)
                    if own is not None:
                        backs[a] = 0
                        if chooses != plugs.BUILT_IN:
                            draws[a] = _draw(step.draws, keys[a], draws[a])
                            numbers[3], numbers[4] = cell, depth
                            numbers[5] = np.int64(slots_taken[ant, depth - 1]) if depth > 0 else -1
                            slot = own_kernels.slot(
                                chooses, choosing, step, error, weight[row], neighbours[cell], visited, shift
                            )
                    before = cell
                    cell = neighbours[cell, slot]
                    rows[a] = cell * headings + (slot + 1 if headings > 1 else 0)
                    slots_taken[ant, depth] = slot
                    depth += 1
                    path[ant, depth] = cell
                    seen[count_seen] = cell
                    count_seen += visited[cell] == _ZERO  # the first of the batch
                    visited[cell] |= bit
                    stepped_back[a] = False
                    cells[a] = cell
                    depths[a] = depth
                    moves += 1
                    if choices.local_rate > 0.0:
                        if count_seen > new and not passes:
                            _weigh(tau, latest, past, eta, weight, alpha, exponent, headings, seen[new:count_seen], t)
                            new = count_seen
                        _wear(choices, tau, eta, weight, exponent, before, slot)
                        _wear(choices, tau, eta, weight, exponent, cell, np.int64(reverse[before, slot]))
                    if cell == goal:
                        state.status[ant] = ARRIVED
                        state.steps_on_path[ant] = depth
                        continue
                else:
                    state.met_dead_end[ant] = 1
                    dies = not retract
                    if choices.deadlock == BACKTRACK:
                        dies = stepped_back[a]
                        stepped_back[a] = True
                    if own is not None:
                        if kills != plugs.BUILT_IN:
                            numbers[3], numbers[4], numbers[5] = cell, depth, backs[a]
                            dies = own_kernels.dies(kills, killing, dead_end, error)
                        backs[a] += 1
                    if punishes and depth > 0:
                        dead_count[cell] += 1
                        dead_blocks[cell // BLOCK] = 1
                        last = np.uint64(reverse[path[ant, depth - 1], slots_taken[ant, depth - 1]])
                        if depth > 1:
                            before = np.uint64(reverse[path[ant, depth - 2], slots_taken[ant, depth - 2]])
                            dead_pairs[cell] |= _ONE << (last * _EIGHT + before)
                        else:
                            dead_last[cell] |= _ONE << last
                    if dies or depth == 0:
                        state.status[ant] = DEAD
                        state.steps_on_path[ant] = depth
                        continue
                    depths[a] = depth - 1
                    cells[a] = path[ant, depth - 1]
                    last_slot = slots_taken[ant, depth - 2] if headings > 1 and depth > 1 else -1
                    rows[a] = cells[a] * headings + last_slot + 1
                    moves += 1
                alive[kept] = a
                kept += 1
            walking = kept
        for place in range(begun, count_seen):
            visited[seen[place]] = _ZERO
    state.count_seen[0] = count_seen
    return moves


@jit
def _length(lengths, path, slots, first, last):
    """Length of a path from its cell `first` to its cell `last`.

    Moves of length 1 and sqrt(2) are counted, so that paths of equal counts have equal lengths to the last bit: sums
    of floats would break ties by rounding.
    """
    straight, diagonal, rest = 0, 0, 0.0
    for s in range(first, last):  # no branch: the processor could only guess
        length = lengths[path[s], slots[s]]
        straight += length == 1.0
        diagonal += length == SQRT2
    if straight + diagonal < last - first:
        for s in range(first, last):
            length = lengths[path[s], slots[s]]
            if length not in (1.0, SQRT2):
                rest += length
    return straight + SQRT2 * diagonal + rest


@jit
def _rank_arrived(graph, choices, state, searches):
    """Length of each arrived ant, their order (shortest first, equal lengths in ant order), and the visits."""
    path, visits = state.path, state.visits
    arrived = 0
    for ant in range(choices.ants):
        if state.status[ant] != ARRIVED:
            continue
        if searches is not None and choices.local_search != NO_SEARCH:
            state.steps_on_path[ant] = _shorten(
                graph, path[ant], state.slots[ant], state.steps_on_path[ant], state.place, choices.dear
            )
        steps = state.steps_on_path[ant]
        straight, diagonal = 0, 0
        for s in range(steps):
            cell = path[ant, s]
            length = graph.lengths[cell, state.slots[ant, s]]
            straight += length == 1.0
            diagonal += length == SQRT2
            visits[cell] += 1
        visits[choices.goal] += 1
        total = straight + SQRT2 * diagonal  # as `_length` has it; one loop with the visits saves 2 us of 190
        if straight + diagonal < steps:
            total = _length(graph.lengths, path[ant], state.slots[ant], 0, steps)
        if choices.turning > 0.0:
            total += choices.turning * _angle(state.slots[ant, :steps], state.angles)
        state.length[ant] = total
        _place(state.order, state.length, arrived, ant)
        arrived += 1
    return arrived


@jit
def _rank_again(graph, choices, state):
    """Costs and order of the arrived ants, whose paths have changed."""
    arrived = 0
    for ant in range(choices.ants):
        if state.status[ant] != ARRIVED:
            continue
        path, slots, steps = state.path[ant], state.slots[ant], state.steps_on_path[ant]
        total = _cost(graph.lengths, path, slots, steps, choices.turning, state.angles)
        state.length[ant] = total
        _place(state.order, state.length, arrived, ant)
        arrived += 1


@jit
def _place(order, length, arrived, ant):
    """Put an ant behind those that are not longer; equal lengths stay in ant order."""
    place = arrived
    while place > 0 and length[order[place - 1]] > length[ant]:
        order[place] = order[place - 1]
        place -= 1
    order[place] = ant


@jit
def _shorten(graph, path, slots, steps, place, dear):
    """The shortcut of `LocalSearch` on one path, in 8 looks a cell; returns its new number of steps.

    Where moves have prices, a jump that costs more than the way around is left out.
    """
    neighbours, lengths = graph.neighbours, graph.lengths
    for s in range(steps + 1):
        place[path[s]] = s + 1
    kept = 0
    s = 0
    while s < steps:
        i = path[s]
        farthest, slot = s + 1, slots[s]
        for k in range(8):
            j = neighbours[i, k]
            if j < place.size and place[j] - 1 > farthest:
                if dear and lengths[i, k] > _length(lengths, path, slots, s, place[j] - 1):
                    continue
                farthest, slot = place[j] - 1, np.uint8(k)
        for passed in range(s, farthest):
            place[path[passed]] = 0
        path[kept] = i
        slots[kept] = slot
        kept += 1
        s = farthest
    place[path[s]] = 0
    path[kept] = path[s]
    return kept


@jit
def _spliced(lengths, place, path, slots, steps, other, other_slots, other_steps, new_path, new_slots):
    """Put the other path's shorter pieces into a path; returns the moves of the new path, 0 where no piece is shorter.

    A piece lies between two cells that both paths have and no other such cell, so that the path keeps clear of itself.
    """
    for s in range(steps + 1):
        place[path[s]] = s + 1
    kept, copied = 0, 0  # cells of the new path, and of the old one that it has or has replaced
    first = 0  # the latest cell of the other path that both have
    for j in range(1, other_steps + 1):
        if place[other[j]] == 0:
            continue
        start, end = place[other[first]] - 1, place[other[j]] - 1
        if copied <= start and end > start and j - first + end - start > 2:
            length = _length(lengths, path, slots, start, end)
            if _length(lengths, other, other_slots, first, j) < length:
                for s in range(copied, start):
                    new_path[kept], new_slots[kept] = path[s], slots[s]
                    kept += 1
                for s in range(first, j):
                    new_path[kept], new_slots[kept] = other[s], other_slots[s]
                    kept += 1
                copied = end
        first = j
    for s in range(steps + 1):
        place[path[s]] = 0
    if copied == 0:
        return 0
    for s in range(copied, steps):
        new_path[kept], new_slots[kept] = path[s], slots[s]
        kept += 1
    new_path[kept] = path[steps]
    return kept


@jit
def _copy(path, slots, steps, to_path, to_slots):
    """Copy a path; not by slices, for each of which Numba compiles what to say where shapes differ."""
    for s in range(steps):
        to_path[s], to_slots[s] = path[s], slots[s]
    to_path[steps] = path[steps]


@jit
def _merge(graph, state, arrived, turning):
    """Local search `MERGE`: each arrived ant, shortest first, gives its shorter pieces to the iteration's best path."""
    path, slots = state.path[state.order[0]], state.slots[state.order[0]]
    steps = state.steps_on_path[state.order[0]]
    new_path, new_slots = state.merged_path, state.merged_slots
    for rank in range(1, arrived):
        ant = state.order[rank]
        other, other_slots, other_steps = state.path[ant], state.slots[ant], state.steps_on_path[ant]
        kept = _spliced(
            graph.lengths, state.place, path, slots, steps, other, other_slots, other_steps, new_path, new_slots
        )
        if kept > 0:
            steps = kept
            _copy(new_path, new_slots, kept, path, slots)
    state.steps_on_path[state.order[0]] = steps
    state.length[state.order[0]] = _cost(graph.lengths, path, slots, steps, turning, state.angles)


@jit
def _cost(lengths, path, slots, steps, turning, angles):
    """Length of a whole path, and what its turns cost."""
    length = _length(lengths, path, slots, 0, steps)
    return length + turning * _angle(slots[:steps], angles) if turning > 0.0 else length


@jit
def _graft(graph, state, arrived, turning, best):
    """Each arrived ant, shortest first, gives its shorter pieces to the best path so far; returns its cost.

    Where turns cost, pieces that make the whole dearer are left out.
    """
    path, slots, steps = state.best_path, state.best_slots, state.best_steps[0]
    new_path, new_slots = state.merged_path, state.merged_slots
    for rank in range(arrived):
        ant = state.order[rank]
        other, other_slots, other_steps = state.path[ant], state.slots[ant], state.steps_on_path[ant]
        kept = _spliced(
            graph.lengths, state.place, path, slots, steps, other, other_slots, other_steps, new_path, new_slots
        )
        if kept == 0:
            continue
        cost = _cost(graph.lengths, new_path, new_slots, kept, turning, state.angles)
        if cost < best:
            best, steps = cost, kept
            _copy(new_path, new_slots, kept, path, slots)
    state.best_steps[0] = steps
    return best


@jit
def _taut(graph, path, slots, steps, place, new_path, new_slots):
    """Find the cheapest way over straight runs between cells of a path, see `LocalSearch`; returns its moves.

    Runs lead from each cell to later ones only. Where two of them cross, the loop between is cut out.
    """
    neighbours, lengths, nowhere = graph.neighbours, graph.lengths, place.size
    most = _length(lengths, path, slots, 0, steps) + SAME_COST
    cost = np.full(steps + 1, np.inf)
    origin, direction = np.zeros(steps + 1, np.int64), np.zeros(steps + 1, np.int64)
    cost[0] = 0.0
    for s in range(steps + 1):
        place[path[s]] = s + 1
    for s in range(steps):
        for k in range(8):
            cell, here = path[s], cost[s]
            while neighbours[cell, k] < nowhere and here <= most:
                here += lengths[cell, k]
                cell = neighbours[cell, k]
                later = place[cell] - 1
                if later > s and here < cost[later] - SAME_COST:
                    cost[later], origin[later], direction[later] = here, s, k
    for s in range(steps + 1):
        place[path[s]] = 0
    ends = np.empty(steps, np.int64)
    runs, s = 0, steps
    while s > 0:
        ends[runs] = s
        runs += 1
        s = origin[s]
    kept, cell = 0, path[0]
    new_path[0] = cell
    place[cell] = 1
    for run in range(runs - 1, -1, -1):
        slot = direction[ends[run]]
        while cell != path[ends[run]]:
            new_slots[kept] = slot
            cell = neighbours[cell, slot]
            kept += 1
            if place[cell] > 0:  # been here: without the loop
                for passed in range(place[cell], kept):
                    place[new_path[passed]] = 0
                kept = place[cell] - 1
            new_path[kept] = cell
            place[cell] = kept + 1
    for s in range(kept + 1):
        place[new_path[s]] = 0
    return kept


@jit
def _pull_taut(graph, state, turning):
    """Pull the iteration's best path taut, where that makes it cheaper."""
    ant = state.order[0]
    kept = _taut(
        graph,
        state.path[ant],
        state.slots[ant],
        state.steps_on_path[ant],
        state.place,
        state.merged_path,
        state.merged_slots,
    )
    _take(graph, state, kept, turning)


@jit
def _take(graph, state, kept, turning):
    """Make the new path of so many moves the iteration's best, where that makes it cheaper."""
    ant, new_path, new_slots = state.order[0], state.merged_path, state.merged_slots
    cost = _cost(graph.lengths, new_path, new_slots, kept, turning, state.angles)
    if cost < state.length[ant]:
        _copy(new_path, new_slots, kept, state.path[ant], state.slots[ant])
        state.steps_on_path[ant] = kept
        state.length[ant] = cost


@jit
def _weave(graph, state, arrived, turning):
    """Make the cheapest way over the cells of all arrived ants the iteration's best path, see `LocalSearch`.

    An exact search, but on these cells only. First in, first out: a cell that became cheaper waits once more.
    """
    neighbours, lengths = graph.neighbours, graph.lengths
    n = neighbours.shape[0]
    cost = np.full(n + 1, -np.inf)  # where no ant was: nothing is cheaper
    for rank in range(arrived):
        ant = state.order[rank]
        for s in range(state.steps_on_path[ant] + 1):
            cost[state.path[ant, s]] = np.inf
    start, goal = state.path[ant, 0], state.path[ant, state.steps_on_path[ant]]
    cost[start] = 0.0
    origin, direction = np.empty(n, np.int32), np.empty(n, np.uint8)
    queue, waits = np.empty(n, np.int32), np.zeros(n, np.bool_)
    queue[0], first, waiting = start, 0, 1
    while waiting > 0:
        cell = queue[first]
        first = (first + 1) % n
        waiting -= 1
        waits[cell] = False
        if cost[cell] >= cost[goal]:
            continue
        for k in range(8):
            j = neighbours[cell, k]
            here = cost[cell] + lengths[cell, k]
            if here < cost[j] - SAME_COST:
                cost[j], origin[j], direction[j] = here, cell, k
                if not waits[j]:
                    waits[j] = True
                    queue[(first + waiting) % n] = j
                    waiting += 1
    kept, cell = 0, goal
    while cell != start:
        kept, cell = kept + 1, origin[cell]
    s, cell = kept, goal
    state.merged_path[kept] = goal
    while s > 0:
        s -= 1
        state.merged_slots[s] = direction[cell]
        cell = origin[cell]
        state.merged_path[s] = cell
    _take(graph, state, kept, turning)


@jit
def _deposit_along(tau, neighbours, reverse, path, slots, amount, keep, both):
    """Tau <- keep tau + amount on the edges of a path, forward or in both directions."""
    for s in range(slots.size):
        i, k = path[s], np.int64(slots[s])
        tau[i, k] = keep * tau[i, k] + amount
        if both:
            j, back = neighbours[i, k], np.int64(reverse[i, k])
            tau[j, back] = keep * tau[j, back] + amount


@jit
def _deposit_around(tau, latest, past, neighbours, reverse, path, slots, amount, keep, t):
    """Tau <- keep tau + amount on all edges into the cells of a path."""
    for s in range(slots.size):
        j = neighbours[path[s], np.int64(slots[s])]
        for slot in range(8):
            other = neighbours[j, slot]
            if other < tau.shape[0]:
                back = np.int64(reverse[j, slot])
                if latest[other] < 2 * t:
                    _evaporate(tau, latest, past, neighbours[j, slot : slot + 1], t)
                tau[other, back] = keep * tau[other, back] + amount


@jit
def _note(depositor, amounts, count, ant, amount):
    """Put a deposit on the list of this iteration; ant -1 stands for the best path so far."""
    depositor[count] = ant
    amounts[count] = amount
    return count + 1


@jit
def _deposit_all(graph, choices, state, count, keep, t):
    """Carry out the noted deposits in their order, as `Deposit` and `spread` say."""
    tau, latest, past, neighbours, reverse = state.tau, state.latest, state.past, graph.neighbours, graph.reverse
    for d in range(count):
        ant, amount = state.depositor[d], state.amount[d]
        path, slots = state.best_path, state.best_slots[: max(0, state.best_steps[0])]
        if ant >= 0:
            path, slots = state.path[ant], state.slots[ant, : state.steps_on_path[ant]]
        _evaporate(tau, latest, past, path[: slots.size + 1], t)  # the best path may lead where no ant was
        if choices.deposit == CELLS:
            _deposit_around(tau, latest, past, neighbours, reverse, path, slots, amount, keep, t)
            continue
        _deposit_along(tau, neighbours, reverse, path, slots, amount, keep, choices.deposit == BOTH)
        if choices.spread > 0.0:
            share = choices.spread * amount
            _deposit_around(tau, latest, past, neighbours, reverse, path, slots, share, 1.0, t)


@jit
def _angle(slots, angles):
    """Sum of the turning angles in radians of one ant's path."""
    total = 0.0
    for s in range(1, slots.size):
        total += angles[slots[s - 1], slots[s]]
    return total


@jit
def _turning(slots, angles):
    """C of `BEST_AND_TURNS`: sum of the turning angles in radians plus number of turns of one ant's path."""
    total = 0.0
    for s in range(1, slots.size):
        if slots[s - 1] != slots[s]:
            total += 1.0 + angles[slots[s - 1], slots[s]]
    return total


@jit
def update_pheromone(graph, choices, state, arrived, best, t, own):
    """Deposits of the chosen rule after evaporation, eq. (3.3). best: length of the best path so far."""
    rho = _rho(choices, t)
    if choices.passes:
        _evaporate_all(state.tau.ravel(), state.past[t, KEEP])
        state.latest[:] = 2 * t
    else:
        _evaporate(state.tau, state.latest, state.past, state.seen[: state.count_seen[0]], t)
    if own is not None:  # alone, so that the compiler leaves out what follows
        if own.ways[plugs.PHEROMONE] != plugs.BUILT_IN:
            own_kernels.deposits(graph, choices, state, own, arrived, best, rho, t)
            _deposit_all(graph, choices, state, _noted(choices, state, own, arrived), 1.0, t)
            return
    if choices.pheromone == BEST_SO_FAR:
        if state.best_steps[0] > 0:
            _note(state.depositor, state.amount, 0, -1, rho * choices.q / best)
            _deposit_all(graph, choices, state, 1, 1.0 - rho, t)
        return
    unbounded = state.bounds[1] == np.inf
    _deposit_all(graph, choices, state, _deposits(choices, state, arrived, best, rho, t), 1.0, t)
    again = unbounded or state.stagnant[1] >= choices.restart
    if choices.pheromone == MAX_MIN and again and state.bounds[1] < np.inf:
        state.tau[:] = state.bounds[1]
        state.latest[:] = 2 * t
        state.past[t, BARE] = state.bounds[1]
        state.stagnant[1] = 0


@jit
def _noted(choices, state, own, arrived):
    """Note what a rule of the user's has written: by rank, then the best so far; returns the number of deposits."""
    amounts, count = own.amounts, 0
    for rank in range(arrived):
        if not np.isfinite(amounts[rank]):
            own.error[plugs.WRONG], own.error[plugs.ANT] = plugs.NO_NUMBER, state.order[rank]
        elif amounts[rank] != 0.0:
            count = _note(state.depositor, state.amount, count, state.order[rank], amounts[rank])
    if not np.isfinite(amounts[choices.ants]):
        own.error[plugs.WRONG], own.error[plugs.ANT] = plugs.NO_NUMBER, -1
    elif amounts[choices.ants] != 0.0 and state.best_steps[0] > 0:
        count = _note(state.depositor, state.amount, count, -1, amounts[choices.ants])
    return count


@jit
def _deposits(choices, state, arrived, best, rho, t):
    """Note who deposits how much by the chosen rule, and move the bounds; returns the number of deposits."""
    rule, order, length, q = choices.pheromone, state.order, state.length, choices.q
    who, much = state.depositor, state.amount
    count = 0
    if rule == ANT_SYSTEM:
        for ant in range(choices.ants):
            if state.status[ant] == ARRIVED:
                count = _note(who, much, count, ant, q / length[ant])
    elif rule == REWARD_AND_PUNISH:
        c = (10 * t + choices.iterations - 1) // choices.iterations
        for rank in range(min(11 - c, arrived)):
            count = _note(who, much, count, order[rank], c * q / length[order[rank]])
        punish = -1.0 if 2 * t <= choices.iterations else -0.2
        for rank in range(max(0, arrived - c), arrived):
            count = _note(who, much, count, order[rank], punish * q / length[order[rank]])
    elif rule == RANK_BASED:
        for rank in range(min(choices.elite - 1, arrived)):
            count = _note(who, much, count, order[rank], (choices.elite - 1 - rank) * q / length[order[rank]])
        if state.best_steps[0] > 0:
            count = _note(who, much, count, -1, choices.elite * q / best)
    elif rule == MAX_MIN and state.best_steps[0] > 0:
        if arrived == 0 or t % choices.best_every == 0:
            count = _note(who, much, count, -1, q / best)
        else:
            count = _note(who, much, count, order[0], q / length[order[0]])
        root = 0.05 ** (1.0 / state.best_steps[0])
        most = q / (rho * best)
        state.bounds[1] = most
        state.bounds[0] = min(most, most * (1.0 - root) / (root * max(choices.mean_choices - 1.0, 1e-9)))
    elif rule == BEST_AND_WORST and arrived > 0:
        count = _note(who, much, count, order[0], q / length[order[0]])
        if length[order[arrived - 1]] > length[order[0]]:
            count = _note(who, much, count, order[arrived - 1], -q / length[order[arrived - 1]])
    elif rule == BEST_AND_TURNS and arrived > 0:
        turning = _turning(state.slots[order[0], : state.steps_on_path[order[0]]], state.angles)
        smooth = choices.q3 / turning if turning > 0.0 else 0.0
        count = _note(who, much, count, order[0], q / length[order[0]] + smooth)
        state.bounds[1] = 1.0 / ((1.0 - rho) * best)
        state.bounds[0] = state.bounds[1] / 100.0
    return count


@jit
def punish_dead_ends(graph, choices, state):
    """Eq. (4.2) at every dead cell, in cell order, once an edge and dead cell; forgets the dead ends.

    Only the direction that led there fades: fading both ways also closes the way out of a trap, and halves the share
    of runs that reach the optimum on the 40x40 map (docs/algorithms/paco.md).
    """
    tau, neighbours, reverse, n = state.tau, graph.neighbours, graph.reverse, state.dead_count.size
    for block in range(state.dead_blocks.size):
        if not state.dead_blocks[block]:
            continue
        state.dead_blocks[block] = 0
        for cell in range(block * BLOCK, min(n, (block + 1) * BLOCK)):
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
def _path_entropy(weight, path, slots, headings):
    """Mean over a path's cells of the entropy, in bits, of the choice that eq. (3.1) offers there before tabu."""
    entropy = 0.0
    for s in range(slots.size):
        row = path[s] * headings + (slots[s - 1] + 1 if headings > 1 and s > 0 else 0)
        total = 0.0
        for k in range(8):
            total += weight[row, k]
        for k in range(8):
            p = weight[row, k] / total
            if p > 0.0:
                entropy -= p * np.log2(p)
    return entropy / slots.size


@jit
def advance(graph, choices, state, history, seed, colony, first, k, searches, own, walking):
    """Run iterations first, ..., first + k - 1, counted from 1. State and history say everything that comes of it.

    searches: None where paths stay as the ants walked them, without local search and grafting: machine code of its own,
    which compiles in two thirds of the time. Rows of tau where nobody was are left behind: see `settle`.
    own: None, or `plugs.Plugs` with `searches`, another machine code. Where a rule goes wrong it ends early.
    walking: the same where a rule is asked at each step or in dead ends, else None: to look for one costs 2 %.
    """
    for t in range(first, first + k):
        begin(choices, state, t)
        moves = walk(graph, choices, state, seed, colony, t, walking)
        arrived = _rank_arrived(graph, choices, state, searches)
        best = history.best[t - 2] if t > 1 else choices.known
        if own is not None:
            if own.ways[plugs.LOCAL_SEARCH] != plugs.BUILT_IN and arrived > 0 and own.error[plugs.WRONG] == 0:
                own_kernels.search(graph, choices, state, own, arrived, best, _rho(choices, t), t)
                if own.error[plugs.WRONG] == 0:
                    _rank_again(graph, choices, state)
            if own.error[plugs.WRONG] != 0:
                return
        if searches is not None:
            if choices.local_search == WEAVE and arrived > 0:
                _weave(graph, state, arrived, choices.turning)
            elif choices.local_search >= MERGE and arrived > 1:
                _merge(graph, state, min(arrived, MERGED), choices.turning)
            if choices.local_search >= TAUT and arrived > 0:
                _pull_taut(graph, state, choices.turning)
        mean = np.nan
        shortest = np.inf
        entropy = np.nan
        state.stagnant[0] += 1
        state.stagnant[1] += 1
        if arrived > 0:
            winner = state.order[0]
            shortest = state.length[winner]
            steps = state.steps_on_path[winner]
            if choices.local_search >= TAUT:  # it may lead where no ant was
                _weigh(
                    state.tau,
                    state.latest,
                    state.past,
                    state.eta,
                    state.weight,
                    choices.alpha,
                    state.exponent[0],
                    choices.headings,
                    state.path[winner, :steps],
                    t,
                )
            entropy = _path_entropy(state.weight, state.path[winner], state.slots[winner, :steps], choices.headings)
            mean = 0.0
            for rank in range(arrived):
                mean += state.length[state.order[rank]]
            mean /= arrived
            if shortest < best:
                best = shortest
                state.best_steps[0] = steps
                state.stagnant[:] = 0
                _copy(state.path[winner], state.slots[winner], steps, state.best_path, state.best_slots)
        if searches is not None and choices.graft and arrived > 0:
            grafted = _graft(graph, state, arrived, choices.turning, best)
            if grafted < best:
                best = grafted
                state.stagnant[:] = 0
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
        update_pheromone(graph, choices, state, arrived, best, t, own)
        if own is not None:
            if own.error[plugs.WRONG] != 0:
                return
        punish_dead_ends(graph, choices, state)
