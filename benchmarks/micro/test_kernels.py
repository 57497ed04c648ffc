"""Every kernel by itself: `pytest -n 0 benchmarks/micro`. Needs pytest-benchmark; compiling is not timed."""

from __future__ import annotations

import numpy as np
import pytest

import antnav as an
from antnav import maps
from antnav.colony.colony import Colony
from antnav.kernels import ant_kernels, grid_kernels
from antnav.search import exact
from antnav.world.moves import CornerRule, legal_moves

SEED, ITERATION = np.uint64(7), 10


def stand_in() -> an.Problem:
    """The 40 x 40 stand-in for the paper's largest map."""
    return an.Problem.from_cells(maps.builtin("equiv40"), *maps.builtin_query("equiv40"), corner_rule="allow")


def caves() -> an.Problem:
    """A map of 250,000 cells."""
    grid = maps.generate("caves", 500, 500, seed=1)
    return an.Problem.from_cells(grid, *maps.ends(grid))


@pytest.fixture(scope="module", params=[stand_in, caves], ids=["40", "500"])
def problem(request: pytest.FixtureRequest) -> an.Problem:
    an.warmup()
    return request.param()


@pytest.fixture(params=["npaco", "mmas", "acs"])
def colony(request: pytest.FixtureRequest) -> Colony:
    """Ten iterations old, its last ants still in their arrays."""
    an.warmup()
    colony = Colony(stand_in(), an.preset(request.param), seed=7)
    colony.step(ITERATION)
    return colony


def test_walk(benchmark, colony: Colony) -> None:
    ant_kernels.begin(colony._choices, colony._state, ITERATION)
    moves = benchmark(
        ant_kernels.walk, colony._graph, colony._choices, colony._state, SEED, colony.task.colony, ITERATION, None
    )
    benchmark.extra_info["moves"] = int(moves)


def test_deposits(benchmark, colony: Colony) -> None:
    tau, arrived = colony.tau.copy(), colony.last.arrived

    def fresh() -> None:  # evaporated again and again, pheromone would become too small for fast arithmetic
        colony.tau[:] = tau

    def deposit() -> None:
        ant_kernels.update_pheromone(
            colony._graph, colony._choices, colony._state, arrived, colony.best_length, ITERATION
        )

    benchmark.pedantic(deposit, setup=fresh, rounds=2000, warmup_rounds=10)


def test_begin(benchmark, colony: Colony) -> None:
    benchmark(ant_kernels.begin, colony._choices, colony._state, ITERATION)


@pytest.mark.parametrize("method", ["astar", "dijkstra", "jps"])
def test_exact(benchmark, problem: an.Problem, method: str) -> None:
    benchmark(exact.shortest_path, problem, method)


def test_flood(benchmark, problem: an.Problem) -> None:
    benchmark(grid_kernels.flood, problem.flat_moves, problem.width, problem.to_flat(problem.start_cell))


def test_neighbour_table(benchmark, problem: an.Problem) -> None:
    moves = problem.flat_moves
    seen, count = grid_kernels.flood(moves, problem.width, problem.to_flat(problem.start_cell))
    benchmark(grid_kernels.neighbour_table, moves, problem.width, seen, count)


def test_legal_moves(benchmark, problem: an.Problem) -> None:
    """What a `Terrain` works out once."""
    benchmark(legal_moves, problem.passable, CornerRule.FORBID)
