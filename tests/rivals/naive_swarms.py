"""Slow twins of the swarms, one number at a time. Each returns the points whose cost it asks for, in order.

Random numbers are drawn in the same blocks as in `antnav.rivals.swarms`; what becomes of them is written out anew.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

Point = list[float]
Cost = Callable[[Point], float]


def clip(x: Point, half: Point) -> Point:
    return [min(max(value, -side), side) for value, side in zip(x, half, strict=True)]


class Start:
    """The first population, and the books."""

    def __init__(self, cost: Cost, half: Point, n: int, budget: int, seed: int) -> None:
        self.cost, self.half, self.n, self.budget = cost, half, n, budget
        self.rng = np.random.Generator(np.random.PCG64(seed))
        self.asked: list[Point] = []
        self.best: Point = []
        self.least = math.inf
        low = [-side for side in half]
        self.x = [clip(row, half) for row in self.rng.uniform(low, half, (n, len(half))).tolist()]
        self.f = [self.ask(x) for x in self.x]

    def ask(self, x: Point) -> float:
        if len(self.asked) == self.budget:
            return math.inf
        self.asked.append(x)
        value = self.cost(x)
        if value < self.least:
            self.best, self.least = x, value
        return value

    def done(self) -> float:
        return len(self.asked) / self.budget

    def go(self, x: list[Point]) -> None:
        self.x = [clip(row, self.half) for row in x]
        self.f = [self.ask(row) for row in self.x]


def spiral(x: float, target: float, turn: float) -> float:
    return abs(target - x) * math.exp(turn) * math.cos(2 * math.pi * turn) + target


def woa(*arguments: object) -> list[Point]:
    s = Start(*arguments)  # type: ignore[arg-type]
    n, d = s.n, len(s.half)
    while s.done() < 1:
        a = 2 - 2 * s.done()
        r1, r2 = (s.rng.uniform(-1, 1, (n, d)) + 1) / 2, s.rng.random((n, d))
        turns, ps, others = s.rng.uniform(-1, 1, n), s.rng.random(n), s.rng.integers(n, size=n)
        new = []
        for i in range(n):
            row = []
            for j in range(d):
                if ps[i] >= 0.5:
                    row.append(spiral(s.x[i][j], s.best[j], turns[i]))
                    continue
                big_a, c = 2 * a * r1[i, j] - a, 2 * r2[i, j]
                prey = s.best[j] if abs(big_a) < 1 else s.x[others[i]][j]
                row.append(prey - big_a * abs(c * prey - s.x[i][j]))
            new.append(row)
        s.go(new)
    return s.asked


def mfo(*arguments: object) -> list[Point]:
    s = Start(*arguments)  # type: ignore[arg-type]
    n, d = s.n, len(s.half)
    seen: list[tuple[float, Point]] = []
    while s.done() < 1:
        seen += zip(s.f, s.x, strict=True)
        flames = [x for _, x in sorted(seen, key=lambda pair: pair[0])]
        number = round(n - (n - 1) * s.done())
        turns = s.rng.uniform(-1 - s.done(), 1, (n, d))
        s.go([[spiral(s.x[i][j], flames[min(i, number - 1)][j], turns[i, j]) for j in range(d)] for i in range(n)])
    return s.asked


def sma(*arguments: object) -> list[Point]:
    s = Start(*arguments)  # type: ignore[arg-type]
    n, d = s.n, len(s.half)
    while s.done() < 1:
        order = sorted(range(n), key=lambda i: s.f[i])
        a, b = math.atanh(1 - s.done()), 1 - s.done()
        r, (first, second) = s.rng.random((n, d)), s.rng.integers(n, size=(2, n))
        vb, vc = s.rng.uniform(-a, a, (n, d)), s.rng.uniform(-b, b, (n, d))
        draws = s.rng.random((n, d))
        anywhere = s.rng.uniform([-side for side in s.half], s.half, (n, d))
        fresh = s.rng.random(n)
        new = []
        for i in range(n):
            smell = math.log10((min(s.f) - s.f[i]) / (min(s.f) - max(s.f)) + 1)
            p = math.tanh(abs(s.f[i] - s.least))
            row = []
            for j in range(d):
                w = 1 + r[i, j] * smell if order.index(i) < n // 2 else 1 - r[i, j] * smell
                if fresh[i] < 0.03:
                    row.append(anywhere[i, j])
                elif draws[i, j] < p:
                    row.append(s.best[j] + vb[i, j] * (w * s.x[first[i]][j] - s.x[second[i]][j]))
                else:
                    row.append(vc[i, j] * s.x[i][j])
            new.append(row)
        s.go(new)
    return s.asked


def hho(*arguments: object) -> list[Point]:
    s = Start(*arguments)  # type: ignore[arg-type]
    n, d = s.n, len(s.half)
    sigma = 0.6965745025576968  # Mantegna 1994: beta = 1.5
    while s.done() < 1:
        r, q, r1, r2, r3, r4, r5 = s.rng.random((7, n))
        e0, others = s.rng.uniform(-1, 1, n), s.rng.integers(n, size=n)
        (u, v), sizes = s.rng.standard_normal((2, n, d)), s.rng.random((n, d))
        rabbit, old, done = s.best, s.x, s.done()
        mean = [sum(x[j] for x in old) / n for j in range(d)]
        new, dives = list(old), []
        for i, x in enumerate(old):
            e, jump = 2 * e0[i] * (1 - done), 2 * (1 - r5[i])
            some = old[others[i]]
            if abs(e) >= 1 and q[i] >= 0.5:
                new[i] = [some[j] - r1[i] * abs(some[j] - 2 * r2[i] * x[j]) for j in range(d)]
            elif abs(e) >= 1:
                tree = [-side + r4[i] * (side + side) for side in s.half]
                new[i] = [rabbit[j] - mean[j] - r3[i] * tree[j] for j in range(d)]
            elif r[i] >= 0.5 and abs(e) >= 0.5:
                new[i] = [rabbit[j] - x[j] - e * abs(jump * rabbit[j] - x[j]) for j in range(d)]
            elif r[i] >= 0.5:
                new[i] = [rabbit[j] - e * abs(rabbit[j] - x[j]) for j in range(d)]
            else:
                centre = x if abs(e) >= 0.5 else mean
                y = [rabbit[j] - e * abs(jump * rabbit[j] - centre[j]) for j in range(d)]
                levy = [u[i, j] * sigma / abs(v[i, j]) ** (1 / 1.5) for j in range(d)]
                dives.append((i, clip(y, s.half), clip([y[j] + sizes[i, j] * levy[j] for j in range(d)], s.half)))
        for i in sorted(set(range(n)) - {i for i, _, _ in dives}):
            new[i] = clip(new[i], s.half)
            s.f[i] = s.ask(new[i])
        for which in (1, 2):  # y of all, then z of those that y did not help
            for dive in list(dives):
                i, f = dive[0], s.ask(dive[which])
                if f < s.f[i]:
                    new[i], s.f[i] = dive[which], f
                    dives.remove(dive)
        s.x = new
    return s.asked
