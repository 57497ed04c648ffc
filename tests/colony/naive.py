"""Slow, obvious twins of the kernels in antnav.colony.kernels, to be checked by eye.

Ants walk one after the other, edges are pairs of nodes in dictionaries, integers are Python's own.
"""

from __future__ import annotations

import math
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


class NaiveColony:
    """The whole colony on an adjacency list: neighbours[i] = [(j, length), ...] in slot order."""

    def __init__(self, neighbours, eta, choices, tau0, seed, colony=0):
        self.neighbours = neighbours
        self.eta = eta  # {(i, j): eta ** beta}
        self.choices = choices
        self.tau = {(i, j): tau0 for i, row in enumerate(neighbours) for j, _ in row}
        self.length_of = {(i, j): d for i, row in enumerate(neighbours) for j, d in row}
        self.seed, self.colony = seed, colony
        self.best, self.best_path = math.inf, None
        self.visits = [0] * len(neighbours)
        self.records = []

    def weight(self, i, j):
        if self.choices.alpha == 1.0:
            return self.tau[i, j] * self.eta[i, j]
        if self.choices.alpha == int(self.choices.alpha):
            power = 1.0
            for _ in range(int(self.choices.alpha)):
                power *= self.tau[i, j]
            return power * self.eta[i, j]
        return self.tau[i, j] ** self.choices.alpha * self.eta[i, j]

    def choose(self, cell, tabu, u):
        """Roulette wheel of eq. (3.1); None in a dead end."""
        open_moves = [(j, self.weight(cell, j)) for j, _ in self.neighbours[cell] if j not in tabu]
        if not open_moves:
            return None
        total = sum(weight for _, weight in open_moves)
        running = 0.0
        for j, weight in open_moves:
            running += weight
            if u * total < running:
                return j
        return open_moves[-1][0]

    def walk(self, t, ant, dead_ends):
        """One ant: (path or None, moves, whether it met a dead end). Dead ends are noted as (cell, last edges)."""
        c = self.choices
        key, draw = stream(self.seed, self.colony, t, ant), 0
        path, tabu = [c.start], {c.start}
        moves, met, just_stepped_back = 0, False, False
        retracts = c.deadlock == 3 and t <= c.switch * c.iterations
        while True:
            draw += 1
            choice = self.choose(path[-1], tabu, uniform(key, draw))
            if choice is not None:
                path.append(choice)
                tabu.add(choice)
                moves += 1
                just_stepped_back = False
                if choice == c.goal:
                    return path, moves, met
                continue
            met = True
            if c.deadlock != 0 and len(path) > 1:
                dead_ends.append((path[-1], path[-3:]))
            dies = not retracts
            if c.deadlock == 1:
                dies, just_stepped_back = just_stepped_back, True
            if dies or len(path) == 1:
                return None, moves, met
            path.pop()
            moves += 1

    def length(self, path):
        total = 0.0
        for edge in pairwise(path):
            total += self.length_of[edge]
        return total

    def deposit(self, path, amount):
        for i, j in pairwise(path):
            self.tau[i, j] += amount
            if self.choices.deposit == 0:
                self.tau[j, i] += amount

    def iterate(self, t):
        c = self.choices
        dead_ends, arrived, steps, lost = [], [], 0, 0
        for ant in range(c.ants):
            path, moves, met = self.walk(t, ant, dead_ends)
            steps += moves
            if path:
                arrived.append((self.length(path), ant, path))
            elif met:
                lost += 1
        entropy = self.entropy(min(arrived)[2]) if arrived else math.nan
        ranked = sorted(arrived)
        for _, _, path in arrived:
            for cell in path:
                self.visits[cell] += 1
        if ranked and ranked[0][0] < self.best:
            self.best, _, self.best_path = ranked[0]

        for edge in self.tau:
            self.tau[edge] *= 1.0 - c.rho
        if c.pheromone == 0:
            for length, _, path in arrived:
                self.deposit(path, c.q / length)
        else:
            rate = math.ceil(10 * t / c.iterations)
            for length, _, path in ranked[: 11 - rate]:
                self.deposit(path, rate * c.q / length)
            sign = -1.0 if t <= c.iterations / 2 else -0.2
            for length, _, path in ranked[-rate:]:
                self.deposit(path, sign * c.q / length)

        for cell in sorted({cell for cell, _ in dead_ends}):
            factor = 1.0
            for _ in range(math.ceil(sum(dead == cell for dead, _ in dead_ends) / 3)):
                factor *= 1.0 - c.punish
            edges = set()
            for dead, last in dead_ends:
                if dead == cell:
                    pairs = list(pairwise(last))
                    edges.update(pairs[-1:] if c.deadlock == 1 else pairs)
            for edge in edges:
                self.tau[edge] *= factor

        for edge in self.tau:
            self.tau[edge] = max(self.tau[edge], c.tau_min)

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
                lost,
                steps,
                entropy,
            )
        )

    def entropy(self, path):
        """Mean entropy in bits of the choices along a path, before tabu."""
        total = 0.0
        for cell in path[:-1]:
            weights = [self.weight(cell, j) for j, _ in self.neighbours[cell]]
            total -= sum(w / sum(weights) * math.log2(w / sum(weights)) for w in weights if w > 0)
        return total / (len(path) - 1)
