"""Slow twins of the rivals' kernels, to be checked by eye."""

from __future__ import annotations

import math
from fractions import Fraction
from itertools import pairwise

import antnav as an
from antnav.rivals import Encoding

Cell = tuple[int, int]


def legal(problem: an.Problem, a: Cell, b: Cell) -> bool:
    rows, cols = problem.grid.shape

    def free(row: int, col: int) -> bool:
        return 0 <= row < rows and 0 <= col < cols and bool(problem.passable[row, col])

    if not free(*a) or not free(*b):
        return False
    if a[0] == b[0] or a[1] == b[1]:
        return True
    corners = [free(a[0], b[1]), free(b[0], a[1])]
    return {"allow": True, "graze": any(corners), "forbid": all(corners)}[problem.corner_rule]


def half_up(value: Fraction) -> int:
    return math.floor(value + Fraction(1, 2))


def line(a: Cell, b: Cell) -> list[Cell]:
    """Cells after a on the digital straight line to b."""
    n = max(abs(b[0] - a[0]), abs(b[1] - a[1]))
    return [tuple(p + half_up(Fraction(i * (q - p), n)) for p, q in zip(a, b, strict=True)) for i in range(1, n + 1)]


def stops(encoding: Encoding, vector: list[float]) -> list[Cell]:
    """Start, the control cells, goal."""
    problem = encoding.problem
    found = [problem.start_cell]
    for point in zip(vector[::2], vector[1::2], strict=True):
        inside = (min(max(math.floor(x + 0.5), 0), n - 1) for x, n in zip(point, problem.grid.shape, strict=True))
        flat = encoding.nearest[tuple(inside)]
        found.append((flat // problem.width - 1, flat % problem.width - 1))
    return [*found, problem.goal_cell]


def straight_walk(encoding: Encoding, vector: list[float]) -> tuple[list[Cell], float]:
    """Cells and cost of a vector with straight segments."""
    problem = encoding.problem
    places = stops(encoding, vector)
    walk, illegal = places[:1], 0
    for end in places[1:]:
        for b in line(walk[-1], end) if walk[-1] != end else []:
            a = walk[-1]
            if not legal(problem, a, b):
                corners = [(b[0], a[1]), (a[0], b[1])]
                ways = [c for c in corners if c not in (a, b) and legal(problem, a, c) and legal(problem, c, b)]
                walk += ways
                illegal += not ways
            walk.append(b)
    return walk, sum(math.dist(a, b) for a, b in pairwise(walk)) + encoding.penalty * illegal
