"""Exact replanners cost what A* costs after every event, over many drawn ones on small maps."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from antnav.kernels import grid_kernels, replan_kernels
from antnav.kernels.graph import SQRT2
from antnav.kernels.grid_kernels import Prices
from antnav.world.moves import CornerRule, legal_moves

NOTHING = np.empty(0, np.int32)
Replan = Callable[[NDArray[np.int32], int], NDArray[np.int32]]


class Map:
    """A map that can be altered."""

    def __init__(self, passable: NDArray[np.bool_], rule: CornerRule, prices: Prices) -> None:
        self.passable, self.rule, self.prices = passable, rule, prices
        self.shape, self.width = passable.shape, passable.shape[1] + 2
        self.moves = legal_moves(passable, rule).ravel()

    def flat(self, cells: NDArray[np.int64]) -> NDArray[np.int32]:
        return ((cells[:, 0] + 1) * self.width + cells[:, 1] + 1).astype(np.int32)

    def set(self, cells: NDArray[np.int64], passable: bool) -> NDArray[np.int32]:
        self.passable[tuple(cells.T)] = passable
        moves = legal_moves(self.passable, self.rule).ravel()
        changed = np.flatnonzero(moves != self.moves).astype(np.int32)
        self.moves[:] = moves
        return changed

    def price(self, cells: NDArray[np.int64], prices: NDArray[np.float64]) -> NDArray[np.int32]:
        flat = self.flat(cells)
        self.prices.cells[flat] = prices
        return flat

    def cost(self, path: NDArray[np.int32]) -> float:
        price, _, height = self.prices
        total = 0.0
        for one, other in zip(path[:-1].tolist(), path[1:].tolist(), strict=True):
            k = [
                -self.width - 1,
                -self.width,
                -self.width + 1,
                -1,
                1,
                self.width - 1,
                self.width,
                self.width + 1,
            ].index(other - one)
            assert self.moves[one] >> k & 1
            length = SQRT2 if k in (0, 2, 5, 7) else 1.0
            total += length * (price[one] + price[other]) / 2 if price.size else length
            total += abs(height[one] - height[other]) if height.size else 0.0
        return total


def scale(prices: Prices) -> replan_kernels.Scale:
    least = prices.cheapest * replan_kernels.GRAIN
    return replan_kernels.Scale(replan_kernels.GRAIN, int(least) - 1, int(SQRT2 * least) - 1)


def tree(terrain: Map, start: int, goal: int, reorder: bool) -> Replan:
    n = terrain.moves.size
    tree = replan_kernels.Tree(
        *(np.empty(n, np.int64) for _ in range(3)),
        np.empty(n, np.uint8),
        terrain.prices.cells.copy(),
        np.zeros(4, np.int64),
    )
    queue = [np.empty(16, np.int64), np.empty(16, np.int32)]
    graph = terrain.moves, terrain.width, terrain.prices, scale(terrain.prices)
    replan_kernels.root(tree, start, goal, *graph[1:], *queue)

    def replan(cells: NDArray[np.int32], start: int) -> NDArray[np.int32]:
        path, *queue[:] = replan_kernels.repair(*graph, tree, *queue, cells, start, reorder)
        return path

    return replan


def d_star_lite(terrain: Map, start: int, goal: int) -> Replan:
    return tree(terrain, start, goal, False)


def lpa_star(terrain: Map, start: int, goal: int) -> Replan:
    return tree(terrain, start, goal, True)


def mpgaa_star(terrain: Map, start: int, goal: int) -> Replan:
    n = terrain.moves.size
    guide = replan_kernels.Guide(
        *(np.empty(n, kind) for kind in (np.int64, np.int64, np.int32, np.uint8, np.uint8, np.int32)),
        np.zeros(3, np.int64),
    )
    queue = [np.empty(16, np.int64), np.empty(16, np.int32)]
    graph = terrain.moves, terrain.width, terrain.prices, scale(terrain.prices)
    replan_kernels.aim(guide, goal)

    def replan(cells: NDArray[np.int32], start: int) -> NDArray[np.int32]:
        path, *queue[:] = replan_kernels.adapt(*graph, guide, *queue, cells, start)
        return path

    return replan


def optimum(terrain: Map, start: int, goal: int) -> NDArray[np.int32]:
    graph = terrain.moves, terrain.width
    length, parent, _ = grid_kernels.search(*graph, start, goal, True, terrain.prices)
    return grid_kernels.trace(parent, terrain.width, start, goal) if np.isfinite(length[goal]) else NOTHING


def draw(rng: np.random.Generator) -> Map:
    shape = tuple(rng.integers(2, 41, 2).tolist())
    kind = rng.choice(["length", "steps", "prices", "hills"])
    price, height = np.empty(0), np.empty(0)
    if kind != "length":
        drawn = rng.integers(1, 4, shape).astype(float) if kind == "steps" else 1 + rng.gamma(1, 2, shape)
        price = np.pad(drawn, 1, constant_values=1.0).ravel()
    if kind == "hills":
        height = np.pad(rng.uniform(0, rng.choice([0.5, 5]), shape), 1).ravel()
    passable = rng.random(shape) >= rng.choice([0, 0.1, 0.3, 0.45])
    passable[0, 0] = True
    return Map(passable, rng.choice(list(CornerRule)), Prices(price, 1.0, height))


def near(terrain: Map, path: NDArray[np.int32], rng: np.random.Generator) -> NDArray[np.int64]:
    """A disc, on the path more often than not."""
    centre = rng.integers(terrain.shape)
    if path.size and rng.random() < 0.6:
        centre = np.array(divmod(int(rng.choice(path)), terrain.width)) - 1
    away = np.indices(terrain.shape) - centre[:, None, None]
    return np.argwhere((away**2).sum(axis=0) <= rng.choice([0, 1, 2, 4]) ** 2)


@pytest.mark.parametrize("seed", range(5))
def test_every_replan_costs_what_a_star_costs(seed: int) -> None:
    rng = np.random.default_rng(seed)
    events, cut = 0, 0
    while events < 2000:
        terrain = draw(rng)
        start, goal = (int(cell) for cell in rng.choice(terrain.flat(np.argwhere(terrain.passable)), 2))
        replanners = [begin(terrain, start, goal) for begin in (d_star_lite, lpa_star, mpgaa_star)]
        discs, cells, first = [], NOTHING, terrain.prices.cells.copy()
        for _ in range(rng.integers(5, 60)):
            events += 1
            path = optimum(terrain, start, goal)
            for replan in replanners:
                found = replan(cells, start)
                assert (found.size > 0) == (path.size > 0)
                if path.size:
                    assert (found[0], found[-1]) == (start, goal)
                    assert math.isclose(terrain.cost(found), terrain.cost(path), rel_tol=1e-9)
            cut += not path.size
            cells, event = NOTHING, rng.random()
            if event < 0.4:
                discs.append(near(terrain, path, rng))
                cells = terrain.set(discs[-1], False)
            elif event < 0.65 and discs:
                cells = terrain.set(discs.pop(rng.integers(len(discs))), True)
            elif event < 0.72:
                cells = terrain.set(np.argwhere(rng.random(terrain.shape) < 0.05), True)
            elif event < 0.87 and first.size:
                disc = near(terrain, path, rng)
                flat = terrain.flat(disc)
                prices = terrain.prices.cells[flat] * rng.choice([0.5, 1.0001, 3, 10])
                cells = terrain.price(disc, first[flat] if rng.random() < 0.5 else np.maximum(1.0, prices))
            if path.size and rng.random() < 0.6:
                start = int(path[min(len(path) - 1, rng.integers(4))])
            elif rng.random() < 0.2:
                start = int(terrain.flat(rng.integers(terrain.shape)[None])[0])
    assert 0.05 < cut / events < 0.6
