"""Exact replanners cost what A* costs after every event, over many drawn ones on small maps and some on large ones."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

import antnav as an
from antnav import costs, maps
from antnav.kernels.graph import SQRT2
from antnav.kernels.replan_kernels import FAR, SHIFT
from antnav.live.astar import AStar
from antnav.live.dstar_lite import DStarLite
from antnav.live.methods import METHODS
from antnav.live.replanner import Replanner
from antnav.live.terrain import LiveTerrain

NOTHING = np.empty(0, np.int32)
EXACT = [kind for kind in METHODS.values() if kind.exact and kind is not AStar]


def cost_along(path: NDArray[np.int32], terrain: LiveTerrain) -> float:
    """Cost of a path of legal moves, added up by itself."""
    price, _, height = terrain.prices
    width, total = terrain.width, 0.0
    ways = [-width - 1, -width, -width + 1, -1, 1, width - 1, width, width + 1]
    for one, other in zip(path[:-1].tolist(), path[1:].tolist(), strict=True):
        k = ways.index(other - one)
        assert terrain.moves[one] >> k & 1
        length = SQRT2 if k in (0, 2, 5, 7) else 1.0
        total += length * (price[one] + price[other]) / 2 if price.size else length
        total += abs(height[one] - height[other]) if height.size else 0.0
    return total


class Course:
    """Events on one map, and what each replanner makes of them."""

    def __init__(self, problem: an.Problem, rng: np.random.Generator) -> None:
        self.terrain, self.rng = LiveTerrain(problem), rng
        self.robot, self.goal = problem.flat_ends
        self.replanners: list[Replanner] = [kind() for kind in EXACT]
        self.exact = AStar()
        self.lying: list[NDArray[np.int32]] = []
        self.compare([r.begin(self.terrain, self.robot, self.goal) for r in (self.exact, *self.replanners)])
        self.first = self.terrain.prices.cells.copy()

    def compare(self, paths: list[NDArray[np.int32] | None]) -> None:
        self.path = paths[0]
        for found in paths[1:]:
            assert (found is None) == (self.path is None)
            if found is not None:
                assert (found[0], found[-1]) == (self.robot, self.goal)
                least = cost_along(self.path, self.terrain)
                assert math.isclose(cost_along(found, self.terrain), least, rel_tol=1e-9)

    def disc(self, *radii: int) -> NDArray[np.int32]:
        """Cells of the map, on the path more often than not."""
        shape, rng = self.terrain.shape, self.rng
        centre = rng.integers(shape)
        if self.path is not None and rng.random() < 0.6:
            centre = self.terrain.cells_of(rng.choice(self.path))
        away = np.indices(shape) - centre[:, None, None]
        return self.terrain.flat_of("disc", (away**2).sum(axis=0) <= rng.choice(radii) ** 2)

    def event(self, *radii: int) -> None:
        """A disc falls or goes, cells open, prices rise and fall; the robot goes along its path or jumps."""
        terrain, rng, cells = self.terrain, self.rng, NOTHING
        event = rng.random()
        if event < 0.4:
            self.lying.append(self.disc(*radii))
            cells = terrain.alter(self.lying[-1])
        elif event < 0.65 and self.lying:
            cells = terrain.alter(freed=self.lying.pop(rng.integers(len(self.lying))))
        elif event < 0.72:
            cells = terrain.alter(freed=terrain.flat_of("freed", rng.random(terrain.shape) < 0.05))
        elif event < 0.87 and terrain.priced:
            disc = self.disc(*radii)
            prices = np.maximum(1.0, terrain.prices.cells[disc] * rng.choice([0.5, 1.0001, 3, 10]))
            cells = terrain.price(disc, (self.first[disc] if rng.random() < 0.5 else prices) - 1)
        if self.path is not None and rng.random() < 0.6:
            self.robot = int(self.path[min(len(self.path) - 1, rng.integers(4))])
        elif rng.random() < 0.2 and terrain.passable.any():
            self.robot = int(rng.choice(np.flatnonzero(terrain.passable)))
        known = cells.size > 0 or event < 0.5
        replanned = [r.changed(cells, self.robot) if known else r.moved(self.robot) for r in self.replanners]
        self.compare([self.exact.moved(self.robot), *replanned])


def draw(rng: np.random.Generator) -> an.Problem:
    shape = tuple(rng.integers(2, 41, 2).tolist())
    cells = (rng.random(shape) < rng.choice([0, 0.1, 0.3, 0.45])).astype(np.uint8)
    cells[0, 0] = cells[-1, -1] = 0
    kind = rng.choice(["length", "steps", "prices", "hills"])
    grid = an.GridMap(cells)
    cost = None
    if kind == "steps":
        cost = costs.array(rng.integers(0, 3, shape).astype(float))
    elif kind == "prices":
        cost = costs.array(rng.gamma(1, 2, shape))
    elif kind == "hills":
        cost = costs.array(rng.gamma(1, 2, shape)) + costs.slope(
            rng.random(shape), up=rng.choice([1.0, 10.0]), down=0.5
        )
    start, goal = rng.choice(np.argwhere(cells == 0), 2)
    return an.Problem.from_cells(grid, start, goal, corner_rule=rng.choice(list(an.CornerRule)), cost=cost)


@pytest.mark.parametrize("seed", range(5))
def test_every_replan_costs_what_a_star_costs(seed: int) -> None:
    rng = np.random.default_rng(seed)
    events, cut = 0, 0
    while events < 2000:
        course = Course(draw(rng), rng)
        for _ in range(rng.integers(5, 60)):
            course.event(0, 1, 2, 4)
            events += 1
            cut += course.path is None
    assert 0.05 < cut / events < 0.6


@pytest.mark.parametrize("rule", [an.CornerRule.FORBID, an.CornerRule.ALLOW])
@pytest.mark.parametrize("name", ["bg512/AR0602SR", "rooms/32room_000", "random/random512-10-0"])
def test_on_large_maps(data: Path, name: str, rule: an.CornerRule) -> None:
    grid = maps.load_map(data / "movingai" / f"{name}.map")
    rng = np.random.default_rng(1)
    free = np.argwhere(grid.passable())
    problem = next(
        p for p in (an.Problem.from_cells(grid, *rng.choice(free, 2), corner_rule=rule) for _ in free) if p.connected
    )
    course = Course(problem, rng)
    for _ in range(40):
        course.event(2, 6, 12)
    assert len(course.lying) > 2


@pytest.mark.parametrize("kind", EXACT)
def test_a_price_beyond_all_counting_is_paid_only_where_nothing_else_leads(kind: type[Replanner]) -> None:
    grid = an.GridMap(np.zeros((5, 30), np.uint8))
    terrain = LiveTerrain(an.Problem.from_cells(grid, (2, 0), (2, 29), cost=costs.array(np.zeros(grid.shape))))
    start, goal = terrain.to_flat((2, 0)), terrain.to_flat((2, 29))
    replanner = kind()
    replanner.begin(terrain, start, goal)
    gate = terrain.flat_of("gate", [(row, 15) for row in range(5)])
    path = replanner.changed(terrain.price(gate[1:], np.full(4, 1e9)), start)
    assert path is not None
    assert gate[0] in path
    path = replanner.changed(terrain.price(gate[:1], np.full(1, 1e9)), start)
    assert path is not None
    assert len(path) == 30


def test_k_m_begins_anew_before_it_overflows() -> None:
    terrain = LiveTerrain(an.Problem.from_cells(an.GridMap(np.zeros((9, 9), np.uint8)), (0, 0), (8, 8)))
    replanner = DStarLite()
    replanner.begin(terrain, terrain.to_flat((0, 0)), terrain.to_flat((8, 8)))
    replanner._tree.numbers[SHIFT] = FAR + 1
    path = replanner.moved(terrain.to_flat((0, 8)))
    assert path is not None
    assert len(path) == 9
    assert replanner._tree.numbers[SHIFT] < FAR


@pytest.mark.parametrize("kind", EXACT)
def test_begun_again_it_goes_on_with_what_it_has_been_told_of(kind: type[Replanner]) -> None:
    grid = an.GridMap(np.zeros((9, 30), np.uint8))
    terrain = LiveTerrain(an.Problem.from_cells(grid, (4, 0), (4, 29)))
    start, goal = terrain.to_flat((4, 0)), terrain.to_flat((4, 29))
    replanner = kind()
    replanner.altered(NOTHING)  # a robot that stands on a closed cell from the beginning
    replanner.begin(terrain, start, goal)
    wall = terrain.flat_of("wall", [(row, 15) for row in range(9)])
    replanner.altered(terrain.alter(wall))
    assert replanner.begin(terrain, start, goal) is None
    terrain.alter(freed=wall[:1])  # nobody tells
    path = replanner.begin(terrain, start, goal)
    assert path is not None
    assert wall[0] in path
