"""Slow, obvious twins of the kernels in antnav.kernels.ant_kernels, to be checked by eye.

Ants are objects that move in turn, edges are pairs of nodes in dictionaries, integers are Python's own.
"""

from __future__ import annotations

import math
from collections import Counter
from itertools import pairwise

MASK = 2**64 - 1
GOLDEN = 0x9E3779B97F4A7C15


def mix(z):
    z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & MASK
    z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & MASK
    return z ^ (z >> 31)


def stream(seed, colony, iteration, ant):
    key = mix((seed + GOLDEN) & MASK)
    for part in (colony, iteration, ant):
        key = mix((key + part) & MASK)
    return key


def uniform(key, draw):
    return (mix((key + draw * GOLDEN) & MASK) >> 11) * 2.0**-53


class Ant:
    """A walker: where it has been, what it may not enter, its own random numbers."""

    def __init__(self, start, key):
        self.path, self.tabu = [start], {start}
        self.key, self.draws = key, 0
        self.moves, self.met, self.just_stepped_back = 0, False, False
        self.alive, self.arrived = True, False

    def draw(self):
        self.draws += 1
        return uniform(self.key, self.draws)


class NaiveColony:
    """The whole colony on an adjacency list: neighbours[i] = [(j, length, direction), ...] in slot order.

    Parts go by their names, so that a kernel that runs another one under its code is found out.
    """

    def __init__(self, neighbours, eta, parts, choices, tau, seed, colony=0, tau_min=1e-3, angles=None):
        self.neighbours = neighbours
        self.eta = eta  # {(i, j, direction of the last move or None): eta ** beta}
        self.pheromone, self.deadlock, self.deposits, self.local_search, self.transition = parts
        self.choices = choices
        self.tau = dict(tau)  # {(i, j): tau}
        self.length_of = {(i, j): d for i, row in enumerate(neighbours) for j, d, _ in row}
        self.direction_of = {(i, j): k for i, row in enumerate(neighbours) for j, _, k in row}
        self.angles = angles
        self.low, self.high = tau_min, math.inf
        self.seed, self.colony = seed, colony
        self.best, self.best_path = math.inf, None
        self.stagnant = self.since_reset = 0
        self.visits = [0] * len(neighbours)
        self.records = []

    def heading(self, path):
        """Direction of the last move, where the heuristic asks for it."""
        if self.choices.headings == 1 or len(path) < 2:
            return None
        return self.direction_of[path[-2], path[-1]]

    def weight(self, path, j):
        alpha, tau = self.choices.alpha, self.tau[path[-1], j]
        power = tau**alpha
        if alpha == int(alpha):
            power = 1.0
            for _ in range(int(alpha)):
                power *= tau
        eta = self.eta[path[-1], j, self.heading(path)]
        if self.choices.beta_share != 1:
            eta = eta ** (1 + (self.choices.beta_share - 1) * self.t / self.choices.iterations)
        return power * eta

    def choose(self, ant, q0):
        """Roulette wheel of eq. (3.1), or the best with probability q0; None in a dead end."""
        u = ant.draw()
        open_moves = [(j, self.weight(ant.path, j)) for j, _, _ in self.neighbours[ant.path[-1]] if j not in ant.tabu]
        if not open_moves:
            return None
        if self.transition == "pseudo_random" and ant.draw() < q0:
            return max(open_moves, key=lambda move: move[1])[0]
        total = sum(weight for _, weight in open_moves)
        running = 0.0
        for j, weight in open_moves:
            running += weight
            if u * total < running:
                return j
        return open_moves[-1][0]

    def move(self, ant, t, q0, dead_ends):
        """One move of one ant: a step, a step back, or death. Dead ends are noted as (cell, last cells)."""
        c = self.choices
        choice = self.choose(ant, q0)
        if choice is not None:
            before = ant.path[-1]
            ant.path.append(choice)
            ant.tabu.add(choice)
            ant.moves += 1
            ant.just_stepped_back = False
            if c.local_rate > 0:
                for edge in ((before, choice), (choice, before)):
                    self.tau[edge] = (1.0 - c.local_rate) * self.tau[edge] + c.local_rate * c.tau0
            ant.arrived = choice == c.goal
            ant.alive = not ant.arrived
            return
        ant.met = True
        if self.deadlock not in ("death", "retract") and len(ant.path) > 1:
            dead_ends.append((ant.path[-1], ant.path[-3:]))
        dies = not (self.deadlock == "retract" or (self.deadlock == "hybrid" and t <= c.retract_until))
        if self.deadlock == "backtrack":
            dies, ant.just_stepped_back = ant.just_stepped_back, True
        if dies or len(ant.path) == 1:
            ant.alive = False
            return
        ant.path.pop()
        ant.moves += 1

    def length(self, path):
        """By how many moves of a grid of each length: equal counts are equal, whatever their order; then the rest."""
        lengths = [self.length_of[edge] for edge in pairwise(path)]
        counts, rest = Counter(lengths), 0.0
        for length in lengths:
            rest += 0.0 if length in (1.0, math.sqrt(2)) else length
        return counts[1.0] + math.sqrt(2) * counts[math.sqrt(2)] + rest

    def deposit(self, path, amount, keep=1.0):
        both, cells = self.deposits == "both", self.deposits == "cells"
        for i, j in pairwise(path):
            if not cells:
                self.tau[i, j] = keep * self.tau[i, j] + amount
            if both:
                self.tau[j, i] = keep * self.tau[j, i] + amount
        for j in path[1:]:
            for other, _, _ in self.neighbours[j]:
                if cells:
                    self.tau[other, j] = keep * self.tau[other, j] + amount
                else:
                    self.tau[other, j] += self.choices.spread * amount

    def shorten(self, path):
        """From each cell on, jump to the farthest later cell of the path that is a neighbour."""
        short, place = [path[0]], 0
        while place < len(path) - 1:
            near = {j for j, _, _ in self.neighbours[path[place]]}
            place = max(later for later in range(place + 1, len(path)) if path[later] in near)
            short.append(path[place])
        return short

    def merge(self, path, other):
        """The path with the other's shorter pieces: each between two common cells with no common cell between."""
        place = {cell: s for s, cell in enumerate(path)}
        common = [j for j, cell in enumerate(other) if cell in place]
        merged, copied = [], 0
        for first, last in pairwise(common):
            start, end = place[other[first]], place[other[last]]
            piece = other[first : last + 1]
            if copied <= start < end and self.length(piece) < self.length(path[start : end + 1]):
                merged += path[copied:start] + piece[:-1]
                copied = end
        return merged + path[copied:]

    def tauten(self, path):
        """The cheapest way over straight runs from cells of the path to later ones, without its loops."""
        place = {cell: s for s, cell in enumerate(path)}
        ahead = {(i, k): (j, d) for i, row in enumerate(self.neighbours) for j, d, k in row}
        cost, run_to = {0: 0.0}, {0: [path[0]]}
        for s, first in enumerate(path):
            for k in range(8):
                run, here = [first], cost[s]
                while (run[-1], k) in ahead and here <= self.length(path) + 1e-9:
                    cell, d = ahead[run[-1], k]
                    run, here = [*run, cell], here + d
                    later = place.get(cell, 0)
                    if later > s and here < cost.get(later, math.inf) - 1e-9:
                        cost[later], run_to[later] = here, run
        runs, s = [], len(path) - 1
        while s > 0:
            runs.insert(0, run_to[s])
            s = place[run_to[s][0]]
        taut = [path[0]]
        for cell in (cell for run in runs for cell in run[1:]):
            taut = taut[: taut.index(cell)] if cell in taut else taut
            taut.append(cell)
        return taut if self.length(taut) < self.length(path) else path

    def weave(self, paths):
        """The cheapest way over the cells of all paths: a cell that became cheaper is looked at once more."""
        goal, cells = paths[0][-1], set().union(*paths)
        cost, way, queue = {paths[0][0]: 0.0}, {paths[0][0]: [paths[0][0]]}, [paths[0][0]]
        while queue:
            cell = queue.pop(0)
            for j, d, _ in self.neighbours[cell] if cost[cell] < cost.get(goal, math.inf) else ():
                if j in cells and cost[cell] + d < cost.get(j, math.inf) - 1e-9:
                    cost[j], way[j] = cost[cell] + d, [*way[cell], j]
                    queue += [] if j in queue else [j]
        return way[goal] if self.length(way[goal]) < self.length(paths[0]) else paths[0]

    def q0(self, t):
        c = self.choices
        q0 = c.q0_min + (c.q0_max - c.q0_min) * t / c.iterations
        for _ in range(self.stagnant // 5):
            q0 *= c.q0_relief
        return q0

    def iterate(self, t):
        c = self.choices
        self.t = t
        dead_ends = []
        ants = [Ant(c.start, stream(self.seed, self.colony, t, number)) for number in range(c.ants)]
        q0 = self.q0(t)
        for first in range(0, c.ants, 64):
            batch = ants[first : first + 64]
            while any(ant.alive for ant in batch):
                for ant in batch:
                    if ant.alive:
                        self.move(ant, t, q0, dead_ends)
        if self.local_search != "none":
            for ant in ants:
                ant.path = self.shorten(ant.path) if ant.arrived else ant.path
        arrived = [(self.length(ant.path), number, ant.path) for number, ant in enumerate(ants) if ant.arrived]
        ranked = sorted(arrived)
        for _, _, path in arrived:
            for cell in path:
                self.visits[cell] += 1
        if self.local_search in ("merge", "taut", "weave") and ranked:
            path = ranked[0][2]
            for _, _, other in ranked[1:10] if self.local_search != "weave" else ():
                path = self.merge(path, other)
            path = self.weave([other for _, _, other in ranked]) if self.local_search == "weave" else path
            path = self.tauten(path) if self.local_search != "merge" else path
            ranked[0] = self.length(path), ranked[0][1], path
            arrived = [ranked[0] if number == ranked[0][1] else (length, number, p) for length, number, p in arrived]
        entropy = self.entropy(ranked[0][2]) if ranked else math.nan
        self.stagnant += 1
        self.since_reset += 1
        if ranked and ranked[0][0] < self.best:
            self.best, _, self.best_path = ranked[0]
            self.stagnant = self.since_reset = 0
        if c.graft and ranked:
            for _, _, other in ranked:
                path = self.merge(self.best_path, other)
                if self.length(path) < self.best:
                    self.best, self.best_path = self.length(path), path
                    self.stagnant = self.since_reset = 0

        self.update(t, arrived, ranked)
        self.punish(dead_ends)
        for edge in self.tau:
            self.tau[edge] = min(max(self.tau[edge], self.low), self.high)

        lengths = [length for length, _, _ in ranked]
        mean = 0.0
        for length in lengths:
            mean += length
        self.records.append(
            (
                self.best,
                lengths[0] if lengths else math.inf,
                mean / len(lengths) if lengths else math.nan,
                len(lengths),
                sum(ant.met and not ant.arrived for ant in ants),
                sum(ant.moves for ant in ants),
                entropy,
            )
        )

    def update(self, t, arrived, ranked):
        c = self.choices
        rho = c.rho + (c.rho_last - c.rho) * t / c.iterations
        if self.pheromone == "best_so_far":
            if self.best_path:
                self.deposit(self.best_path, rho * c.q / self.best, keep=1.0 - rho)
            return
        for edge in self.tau:
            self.tau[edge] *= 1.0 - rho
        if self.pheromone == "ant_system":
            for length, _, path in arrived:
                self.deposit(path, c.q / length)
        elif self.pheromone == "reward_and_punish":
            rate = math.ceil(10 * t / c.iterations)
            for length, _, path in ranked[: 11 - rate]:
                self.deposit(path, rate * c.q / length)
            sign = -1.0 if t <= c.iterations / 2 else -0.2
            for length, _, path in ranked[-rate:]:
                self.deposit(path, sign * c.q / length)
        elif self.pheromone == "rank_based":
            for rank, (length, _, path) in enumerate(ranked[: c.elite - 1], start=1):
                self.deposit(path, (c.elite - rank) * c.q / length)
            if self.best_path:
                self.deposit(self.best_path, c.elite * c.q / self.best)
        elif self.pheromone == "max_min" and self.best_path:
            if not ranked or t % c.best_every == 0:
                self.deposit(self.best_path, c.q / self.best)
            else:
                self.deposit(ranked[0][2], c.q / ranked[0][0])
            unbounded = math.isinf(self.high)
            p = 0.05 ** (1.0 / (len(self.best_path) - 1))
            self.high = c.q / (rho * self.best)
            self.low = min(self.high, self.high * (1.0 - p) / (p * max(c.mean_choices - 1.0, 1e-9)))
            if unbounded or self.since_reset >= c.restart:
                self.tau = dict.fromkeys(self.tau, self.high)
                self.since_reset = 0
        elif self.pheromone == "best_and_worst" and ranked:
            self.deposit(ranked[0][2], c.q / ranked[0][0])
            if ranked[-1][0] > ranked[0][0]:
                self.deposit(ranked[-1][2], -c.q / ranked[-1][0])
        elif self.pheromone == "best_and_turns" and ranked:
            length, _, path = ranked[0]
            directions = [self.direction_of[edge] for edge in pairwise(path)]
            turning = 0.0
            for before, after in pairwise(directions):
                if before != after:
                    turning += 1.0 + self.angles[before][after]
            self.deposit(path, c.q / length + (c.q3 / turning if turning else 0.0))
            self.high = 1.0 / ((1.0 - rho) * self.best)
            self.low = self.high / 100.0

    def punish(self, dead_ends):
        """Eq. (4.2), once an edge and dead cell, in the direction that led there."""
        c = self.choices
        for cell in sorted({cell for cell, _ in dead_ends}):
            factor = 1.0
            for _ in range(math.ceil(sum(dead == cell for dead, _ in dead_ends) / 3)):
                factor *= 1.0 - c.punish
            edges = set()
            for dead, last in dead_ends:
                if dead == cell:
                    pairs = list(pairwise(last))
                    edges.update(pairs[-1:] if self.deadlock == "backtrack" else pairs)
            for edge in edges:
                self.tau[edge] *= factor

    def entropy(self, path):
        """Mean entropy in bits of the choices along a path, before tabu."""
        total = 0.0
        for place, cell in enumerate(path[:-1], start=1):
            weights = [self.weight(path[:place], j) for j, _, _ in self.neighbours[cell]]
            total -= sum(w / sum(weights) * math.log2(w / sum(weights)) for w in weights if w > 0)
        return total / (len(path) - 1)


AT_GOAL = 0.1
STEPS = ((-1, -1), (-1, 0), (-1, 1), (0, -1), (0, 1), (1, -1), (1, 0), (1, 1))


def remaining_lengths(neighbours, goal):
    """True remaining length of every cell, relaxed until nothing changes."""
    remaining = [math.inf] * len(neighbours)
    remaining[goal] = 0.0
    changed = True
    while changed:
        changed = False
        for i, row in enumerate(neighbours):
            shortest = min((d + remaining[j] for j, d, _ in row), default=math.inf)
            if i != goal and shortest < remaining[i] - 1e-12:
                remaining[i], changed = shortest, True
    return remaining


def lengths_by_blocks(neighbours, cells, goal, side=2):
    """Remaining lengths as the docstring of `colony.parts.blocks` estimates them."""
    blocks = {}
    for node, (row, col) in enumerate(cells):
        blocks.setdefault((row // side, col // side), []).append(node)
    place = {b: [sum(cells[i][k] for i in nodes) / len(nodes) for k in (0, 1)] for b, nodes in blocks.items()}
    block = {node: b for b, nodes in blocks.items() for node in nodes}
    price = {}
    for b, nodes in blocks.items():
        paces = [math.dist(cells[i], cells[j]) / d for i in nodes for j, d, _ in neighbours[i]]
        price[b] = len(paces) / sum(paces) if paces else 0.0
    order = sorted(blocks)
    rows = [
        [
            (order.index(c), math.dist(place[b], place[c]) * 0.5 * (price[b] + price[c]), None)
            for c in sorted({block[j] for i in blocks[b] for j, _, _ in neighbours[i]} - {b})
        ]
        for b in order
    ]
    cost = dict(zip(order, remaining_lengths(rows, order.index(block[goal])), strict=True))
    found = []
    for node, (row, col) in enumerate(cells):
        total = weight = 0.0
        for b in [(row // side + i, col // side + j) for i in (-1, 0, 1) for j in (-1, 0, 1)]:
            if b in cost and cost[b] < math.inf:
                share = math.prod(max(1 - abs(x - y) / side, 0.0) for x, y in zip((row, col), place[b], strict=True))
                total, weight = total + share * cost[b], weight + share
        found.append(total / weight if weight else cost[block[node]])
    found[goal] = 0.0
    return found


def octile(cell, goal):
    """Length of a way without walls."""
    rows, cols = abs(cell[0] - goal[0]), abs(cell[1] - goal[1])
    return math.sqrt(2) * min(rows, cols) + abs(rows - cols)


def eta(heuristic, neighbours, cells, start, goal, *, q2=1.5, turn=2.0, angle=10 / math.pi, with_start=False):
    """eta_ij as the docstrings of the parts say it: {(i, j, direction of the last move or None): eta}."""
    remaining = remaining_lengths(neighbours, goal)
    if heuristic == "blocks":
        remaining = lengths_by_blocks(neighbours, cells, goal)
    straight = [math.dist(cell, cells[goal]) for cell in cells]
    values = {}
    for i, row in enumerate(neighbours):
        for j, d, direction in row:
            if heuristic == "astar":
                near = straight[j] + (math.dist(cells[j], cells[start]) if with_start else 0.0)
                for last in (None, *range(8)):
                    bend = 0.0
                    if last is not None and last != direction:
                        between = abs(math.atan2(*STEPS[last]) - math.atan2(*STEPS[direction]))
                        bend = turn + angle * min(between, 2 * math.pi - between)
                    values[i, j, last] = q2 / max(near + bend, AT_GOAL)
                continue
            detour = max(d + remaining[j] - remaining[i], 0.0)
            if heuristic == "octile":
                ahead, here = (octile(cells[node], cells[goal]) for node in (j, i))
                detour = max(d + ahead - here, 0.0)
            costs = {"edge": d, "target": straight[j], "sum": d + straight[j], "geodesic": remaining[j]}
            values[i, j, None] = (
                1 / (1 + detour) if heuristic in {"detour", "blocks", "octile"} else 1 / max(costs[heuristic], AT_GOAL)
            )
    return values
