"""WOA, MFO, SMA and HHO by their papers' formulas, on plain vectors; knows no path and needs no library.

What the four share, and the papers leave open or differ in [ours]:

- All individuals move at once, from the positions of the iteration before.
- A coordinate outside the box is set to the box's edge before its cost is worked out.
- t / T, by which every schedule runs, is the share of the evaluations that is spent.
- The origin is the middle of the box. The formulas of WOA, SMA and HHO draw towards it, and the papers' boxes have
  it there; at a corner of the map it would favour whoever starts in that corner.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]
Cost = Callable[[Vector], float]

SPIRAL = 1.0  #: b, the shape of the logarithmic spirals of WOA and MFO
FRESH = 0.03  #: z, the share of the slime mould that starts anew in each iteration
LEVY = 1.5  #: beta, the exponent of HHO's Levy flights
LEVY_SIGMA = (
    math.gamma(1 + LEVY) * math.sin(math.pi * LEVY / 2) / (math.gamma((1 + LEVY) / 2) * LEVY * 2 ** ((LEVY - 1) / 2))
) ** (1 / LEVY)


class Swarm:
    """Positions, their costs, the best so far, and the account of evaluations.

    Attributes
    ----------
    x, f : ndarray
        Positions from the middle of the box, shape (n, d), and their costs, shape (n,).
    best, least : ndarray, float
        The best position of all iterations and its cost.
    half : ndarray
        Half the sides of the box, shape (d,).
    rng : Generator
    """

    def __init__(
        self,
        cost: Cost,
        bounds: tuple[Vector, Vector],
        population: int,
        evaluations: int,
        rng: np.random.Generator,
    ) -> None:
        self._cost, self._budget, self._spent = cost, evaluations, 0
        self._low, self._high = bounds
        self._middle = (self._low + self._high) / 2
        self.half = (self._high - self._low) / 2
        self.rng = rng
        self.best, self.least = np.zeros_like(self.half), math.inf
        self.x = rng.uniform(-self.half, self.half, (population, len(self.half)))
        self.f = np.full(population, math.inf)
        self.move(np.arange(population), self.x)

    @property
    def t(self) -> float:
        """Share of the budget that is spent, for the papers' t / T; 1 ends the search."""
        return self._spent / self._budget

    def move(self, who: NDArray[np.intp], x: Vector) -> None:
        """Send these individuals to their rows of `x`."""
        self.x[who], self.f[who] = self._evaluate(x[who])

    def dive(self, who: NDArray[np.intp], x: Vector) -> NDArray[np.intp]:
        """Send those of these individuals to their rows of `x` that are better off there; returns the others."""
        there, f = self._evaluate(x[who])
        better = f < self.f[who]
        self.x[who[better]], self.f[who[better]] = there[better], f[better]
        return who[~better]

    def _evaluate(self, x: Vector) -> tuple[Vector, Vector]:
        """Positions within the box and their costs; inf for those that the budget does not reach."""
        points = np.clip(x + self._middle, self._low, self._high)
        x, f = points - self._middle, np.full(len(points), math.inf)
        for i in range(min(len(points), self._budget - self._spent)):
            f[i] = self._cost(points[i])
            self._spent += 1
            if f[i] < self.least:
                self.best, self.least = x[i].copy(), float(f[i])
        return x, f


def whales(s: Swarm) -> None:
    """WOA. Mirjalili & Lewis 2016, doi 10.1016/j.advengsoft.2016.01.008.

    ::

        p < 0.5    X' = P - A |C P - X|            P = X* where |A| < 1, else any whale
        else       X' = |X* - X| e^(b l) cos(2 pi l) + X*
        A = 2 a r - a, a from 2 to 0; C = 2 r; l in [-1, 1]

    r, so A and C, are vectors; |A| < 1 is asked of each coordinate [ours]. The author's code has one number a whale.
    """
    n = len(s.x)
    everyone = np.arange(n)
    while s.t < 1:
        a = 2 * (1 - s.t)
        pull = a * s.rng.uniform(-1, 1, s.x.shape)  # A
        sway = 2 * s.rng.random(s.x.shape)  # C
        turn = s.rng.uniform(-1, 1, (n, 1))  # l
        p = s.rng.random((n, 1))
        prey = np.where(abs(pull) < 1, s.best, s.x[s.rng.integers(n, size=n)])
        encircled = prey - pull * abs(sway * prey - s.x)
        s.move(everyone, np.where(p < 0.5, encircled, _spiral(s.x, s.best, turn)))


def moths(s: Swarm) -> None:
    """MFO. Mirjalili 2015, doi 10.1016/j.knosys.2015.07.006.

    ::

        M_i' = |F_j - M_i| e^(b t) cos(2 pi t) + F_j
        flames = round(n - (n - 1) t / T); t in [r, 1], r from -1 to -2, one a coordinate

    F are the n best positions of all iterations, best first; moth i flies round flame i, or the last one.
    """
    n = len(s.x)
    everyone = np.arange(n)
    flames, f = s.x[:0], s.f[:0]
    while s.t < 1:
        flames, f = np.concatenate([flames, s.x]), np.concatenate([f, s.f])
        best = np.argsort(f, kind="stable")[:n]
        flames, f = flames[best], f[best]
        last = round(n - (n - 1) * s.t) - 1
        turn = s.rng.uniform(-1 - s.t, 1, s.x.shape)
        s.move(everyone, _spiral(s.x, flames[np.minimum(everyone, last)], turn))


def slime_mould(s: Swarm) -> None:
    """SMA. Li et al. 2020, doi 10.1016/j.future.2020.03.055.

    ::

        rand < z   X' = anywhere in the box
        r < p      X' = X_b + vb (W X_A - X_B)      p = tanh |S - DF|
        else       X' = vc X
        W = 1 +- r log((bF - S) / (bF - wF) + 1)    + for the better half
        vb in [-a, a], a = arctanh(1 - t / T); vc in [-b, b], b = 1 - t / T

    S is the cost, DF the least of all iterations, bF and wF least and greatest of this one. vb, vc, W and r are one
    number a coordinate and the logarithm is to base 10, as in the authors' own code.
    """
    n = len(s.x)
    everyone = np.arange(n)
    while s.t < 1:
        sign = np.where(np.argsort(np.argsort(s.f, kind="stable")) < n // 2, 1.0, -1.0)
        smell = np.log10((s.f - s.f.min()) / (np.ptp(s.f) or 1.0) + 1)
        weight = 1 + (sign * smell)[:, None] * s.rng.random(s.x.shape)
        p = np.tanh(s.f - s.least)[:, None]
        a, b = math.atanh(1 - s.t), 1 - s.t
        first, second = s.x[s.rng.integers(n, size=(2, n))]
        approach = s.best + s.rng.uniform(-a, a, s.x.shape) * (weight * first - second)
        shrunk = s.rng.uniform(-b, b, s.x.shape) * s.x
        moved = np.where(s.rng.random(s.x.shape) < p, approach, shrunk)
        anywhere = s.rng.uniform(-s.half, s.half, s.x.shape)
        s.move(everyone, np.where(s.rng.random((n, 1)) < FRESH, anywhere, moved))


def hawks(s: Swarm) -> None:
    """HHO. Heidari et al. 2019, doi 10.1016/j.future.2019.02.028.

    ::

        E = 2 E0 (1 - t / T), E0 in [-1, 1]; J = 2 (1 - r5)
        1 <= |E|            q >= 0.5: X' = X_rand - r1 |X_rand - 2 r2 X|
                            else:     X' = X_rabbit - X_mean - r3 (LB + r4 (UB - LB))
        |E| < 1, r >= 0.5   X' = X_rabbit - X - E |J X_rabbit - X|  where 0.5 <= |E|
                            X' = X_rabbit - E |X_rabbit - X|        else
        |E| < 1, r < 0.5    Y = X_rabbit - E |J X_rabbit - X|       where 0.5 <= |E|
                            Y = X_rabbit - E |J X_rabbit - X_mean|  else
                            Z = Y + S LF;  X' = Y, else Z, else X: the first that is better than X
        LF = u sigma / |v|^(1 / beta)

    LF is that of the authors' own code. Their paper has 0.01 LF, less than any cell and lost on wide boxes, and u and
    v uniform in (0, 1) instead of normal, which makes no Levy flight. A dive takes one evaluation or two.
    """
    n = len(s.x)
    while s.t < 1:
        r, q, r1, r2, r3, r4, r5 = s.rng.random((7, n, 1))
        energy = 2 * s.rng.uniform(-1, 1, (n, 1)) * (1 - s.t)
        jump = 2 * (1 - r5)
        some, mean = s.x[s.rng.integers(n, size=n)], s.x.mean(axis=0)
        near, far = some - r1 * abs(some - 2 * r2 * s.x), s.best - mean - r3 * s.half * (2 * r4 - 1)
        soft = s.best - s.x - energy * abs(jump * s.best - s.x)
        hard = s.best - energy * abs(s.best - s.x)
        moved = np.where(
            abs(energy) >= 1,
            np.where(q >= 0.5, near, far),
            np.where(abs(energy) >= 0.5, soft, hard),
        )
        y = s.best - energy * abs(jump * s.best - np.where(abs(energy) >= 0.5, s.x, mean))
        u, v = s.rng.standard_normal((2, *s.x.shape))
        z = y + s.rng.random(s.x.shape) * u * LEVY_SIGMA / abs(v) ** (1 / LEVY)
        diving = ((abs(energy) < 1) & (r < 0.5))[:, 0]
        s.move(np.flatnonzero(~diving), moved)
        s.dive(s.dive(np.flatnonzero(diving), y), z)


def _spiral(x: Vector, target: Vector, turn: Vector) -> Vector:
    return abs(target - x) * np.exp(SPIRAL * turn) * np.cos(2 * math.pi * turn) + target


#: The algorithms, by the name of their method; each searches until the swarm's budget is spent.
ALGORITHMS: Mapping[str, Callable[[Swarm], None]] = MappingProxyType(
    {"woa": whales, "mfo": moths, "sma": slime_mould, "hho": hawks}
)


def minimise(
    method: str,
    cost: Cost,
    bounds: tuple[Vector, Vector],
    *,
    population: int,
    evaluations: int,
    seed: int,
) -> tuple[Vector, float]:
    """Best vector within the bounds that the method finds, and its cost, in exactly `evaluations` calls of `cost`.

    The same seed gives the same result, with one version of NumPy.
    """
    rng = np.random.Generator(np.random.PCG64(seed))
    swarm = Swarm(cost, bounds, population, evaluations, rng)
    ALGORITHMS[method](swarm)
    return swarm.best + (bounds[0] + bounds[1]) / 2, swarm.least
