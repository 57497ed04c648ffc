"""Artificial potential field (Khatib 1986) with random walks out of local minima (Barraquand & Latombe 1991)."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar, Self

import numpy as np
from numpy.typing import NDArray

from antnav.errors import ParameterError, shown
from antnav.kernels import walk_kernels
from antnav.rivals.rival import Rival
from antnav.rivals.watch import Watch
from antnav.search.windows import without_loops
from antnav.values import finite_number, is_whole
from antnav.world.problem import Problem


@dataclass(frozen=True, kw_only=True)
class PotentialField(Rival):
    """Goes down U = U_att + U_rep, and wanders at random where it is stuck.

    ::

        U_att = attraction / 2 * rho^2                        rho: straight distance to the goal
        U_rep = repulsion / 2 * (1 / d - 1 / reach)^2         where d <= reach, else 0
                                                              d: distance to the nearest blocked cell

    All distances in cells, between centres; what lies outside the map is blocked.
    Khatib 1986, doi 10.1177/027836498600500106; loops of the way are cut out of the path.

    Parameters
    ----------
    attraction, repulsion : float
        Gains, > 0 and >= 0. Only their ratio matters. Sane: repulsion 1 to 1000 times attraction; more on larger maps.
    reach : float
        How far obstacles repel, in cells, > 1. Sane: 1.5 to 5.
    escapes : int
        Random walks at most, >= 0. With 0 it is Khatib's planner: the first local minimum ends it.
    walk : int
        Moves of the first random walk, >= 1; the n-th has n times as many. Sane: about a side of the map.
    """

    attraction: float = 1.0
    repulsion: float = 20.0
    reach: float = 2.0
    escapes: int = 100
    walk: int = 40

    kind: ClassVar[str] = "potential-field"
    certainty: ClassVar[str] = "[reconstruction]: the potential of Khatib 1986 on a grid; gains and random walks [ours]"
    name: ClassVar[str] = "potential-field"

    def __post_init__(self) -> None:
        rules = [
            ("attraction", self.attraction, finite_number(self.attraction) > 0, "number > 0"),
            ("repulsion", self.repulsion, finite_number(self.repulsion) >= 0, "number >= 0"),
            ("reach", self.reach, finite_number(self.reach) > 1, "number > 1 cell"),
            ("escapes", self.escapes, is_whole(self.escapes) and self.escapes >= 0, "whole number >= 0"),
            ("walk", self.walk, is_whole(self.walk) and self.walk >= 1, "whole number >= 1"),
        ]
        for name, value, valid, rule in rules:
            if not valid:
                raise ParameterError(f"{name} {shown(value)}", f"it is a {rule}", "give one within the range")

    @property
    def walks(self) -> int:
        """Descents at most."""
        return self.escapes + 1

    def with_walks(self, wanted: int) -> Self:
        """With so many descents at most."""
        return replace(self, escapes=wanted - 1)

    def potential(self, problem: Problem) -> NDArray[np.float64]:
        """U of every cell of the padded map, shape (rows + 2, cols + 2); inf where blocked."""
        from scipy import ndimage

        free = np.pad(problem.passable, 1)
        d = ndimage.distance_transform_edt(free)
        rows, cols = np.indices(free.shape)
        rho2 = (rows - 1 - problem.goal_cell[0]) ** 2 + (cols - 1 - problem.goal_cell[1]) ** 2
        with np.errstate(divide="ignore"):
            push = np.maximum(0.0, 1 / d - 1 / self.reach)
        field: NDArray[np.float64] = np.where(free, self.attraction / 2 * rho2 + self.repulsion / 2 * push**2, np.inf)
        return field

    def search(self, problem: Problem, seed: int, watch: Watch) -> str:
        """Descend and wander; returns why there is no path, "" where there is one."""
        moves, width = problem.flat_moves, problem.width
        potential = self.potential(problem).ravel()
        start, goal = problem.flat_ends
        rng = np.random.default_rng(seed)
        trail = np.array([start])
        for escape in range(self.escapes + 1):
            if escape:
                draws = rng.random(escape * self.walk)
                trail = np.append(trail, walk_kernels.wander(moves, width, int(trail[-1]), goal, draws)[1:])
            trail = np.append(trail, walk_kernels.descend(moves, width, potential, int(trail[-1]), goal)[1:])
            watch.steps, watch.walks = len(trail) - 1, escape + 1
            if trail[-1] == goal:
                path = without_loops(trail.astype(np.int32)).astype(np.int64)
                watch.found(problem.cost_along(path), path)
            watch.iteration()
            if trail[-1] == goal:
                return ""
        row, col = problem.from_flat(trail[-1])
        return f"stuck in a local minimum at cell ({row}, {col}) after {self.escapes} random walks"
