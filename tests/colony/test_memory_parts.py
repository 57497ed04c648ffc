"""Memory strategies: what a run begins with where it remembers another, by hand and on drawn changes."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import antnav as an
from antnav import maps
from antnav.colony.parts import MemoryPart, MemoryStrategy
from antnav.colony.parts.memory import Warm, distance_to_changes, mean_distance
from antnav.errors import ParameterError
from antnav.planner.memory import Memory
from antnav.search import exact
from antnav.search.mending import mended, shortened
from tests.conftest import grid_of
from tests.plan.test_solve import fingerprint

ENDS = maps.builtin_query("equiv20")
PROBLEM = an.Problem.from_cells(maps.builtin("equiv20"), *ENDS, corner_rule="allow")
RESULT = an.solve(PROBLEM, an.npaco(local_search="shortcut"), remember=True)


def memory_of(result: an.Result) -> Memory:
    assert result.memory is not None
    return result.memory


def drawn_change(seed: int) -> an.Problem:
    """Obstacles elsewhere, but a way left."""
    chance, cells = np.random.default_rng(seed), PROBLEM.grid.cells
    while True:
        changed = cells.copy()
        for kind, other in ((an.Cell.OCCUPIED, an.Cell.FREE), (an.Cell.FREE, an.Cell.OCCUPIED)):
            there = np.argwhere(cells == kind)
            changed[tuple(there[chance.choice(len(there), 6, replace=False)].T)] = other
        changed[ENDS[0]] = changed[ENDS[1]] = an.Cell.FREE
        problem = an.Problem.from_cells(an.GridMap(changed), *ENDS, corner_rule="allow")
        if problem.connected:
            return problem


CHANGED = [drawn_change(seed) for seed in range(8)]


def begun(problem: an.Problem, /, *, seed: int = 0, with_: Memory | None = None, **choices: Any) -> Warm:
    algorithm = an.npaco(**choices)
    return algorithm.memory.warm(with_ or memory_of(RESULT), problem, algorithm, seed)


def pheromone(problem: an.Problem, **choices: Any) -> NDArray[np.float64]:
    """Of the edges, in map order."""
    tau = begun(problem, **choices).tau
    assert tau is not None
    assert (tau[edges(problem)] > 0).all()
    return tau[edges(problem)]


def edges(problem: an.Problem) -> NDArray[np.bool_]:
    return problem.graph.graph.neighbours < len(problem.graph)


def legal(nodes: NDArray[np.int32], problem: an.Problem) -> float:
    """Length of a path over nodes, which leads from the start to the goal by legal moves and visits no cell twice."""
    path = an.Path(problem.graph.cells[nodes].astype(np.int32), problem.grid)
    assert len(np.unique(nodes)) == len(nodes)
    return an.check_path(path, problem)


def test_a_run_that_forgets_is_cold() -> None:
    cold, warm = (an.solve(CHANGED[0], an.npaco(memory="restart"), warm=memory) for memory in (None, RESULT))
    assert fingerprint(cold) == fingerprint(warm)
    assert begun(CHANGED[0], memory="restart") == (None, None)


@pytest.mark.parametrize("name", MemoryStrategy)
def test_without_a_memory_every_strategy_does_the_same(name: MemoryStrategy) -> None:
    expected = fingerprint(an.solve(PROBLEM, an.npaco(iterations=3), seed=1))
    assert fingerprint(an.solve(PROBLEM, an.npaco(iterations=3, memory=name), seed=1)) == expected


@pytest.mark.parametrize("name", MemoryStrategy)
@pytest.mark.parametrize("preset", ["npaco", "paco", "mmas", "deng"])
def test_every_strategy_walks_on_a_changed_map_and_repeats(name: MemoryStrategy, preset: str) -> None:
    algorithm = an.preset(preset, iterations=6, memory=name)
    for problem in CHANGED[:2]:
        one, other = (an.solve(problem, algorithm, seed=3, warm=RESULT, remember=True) for _ in range(2))
        assert fingerprint(one) == fingerprint(other)
        assert an.check_path(one.path, problem) == pytest.approx(one.length)


@pytest.mark.parametrize("share", [0.3, 0.999])
def test_a_share_is_forgotten_everywhere(share: float) -> None:
    kept = pheromone(PROBLEM)
    expected = (1 - share) * kept + share * kept.mean()
    np.testing.assert_allclose(pheromone(PROBLEM, memory="restart", lambda_r=share), expected)


def test_eta_equalises_by_the_straight_distance_to_the_change() -> None:
    problem = CHANGED[1]
    kept, away = begun(problem).tau, distance_to_changes(memory_of(RESULT), problem)
    changed = np.argwhere(problem.reachable != PROBLEM.reachable)
    cells = problem.graph.cells
    by_hand = np.sqrt(((cells[:, None] - changed) ** 2).sum(axis=2)).min(axis=1)
    assert kept is not None
    assert away is not None
    np.testing.assert_allclose(away, by_hand)
    reach = 0.5 * mean_distance((20, 20))
    found, mean = begun(problem, memory="eta", lambda_e=0.5).tau, kept[edges(problem)].mean()
    assert found is not None
    for node, slot in np.argwhere(edges(problem))[::7]:
        ends = (node, problem.graph.graph.neighbours[node, slot])
        gamma = sum(max(0.0, 1 - by_hand[end] / reach) for end in ends) / 2
        assert found[node, slot] == pytest.approx((1 - gamma) * kept[node, slot] + gamma * mean)


@pytest.mark.parametrize("exponent", [0.5, 0.25])
def test_flattening_draws_pheromone_towards_its_mean(exponent: float) -> None:
    kept = pheromone(PROBLEM)
    found = pheromone(PROBLEM, memory="repair", flatten=exponent, elitists=0)
    np.testing.assert_allclose(found, kept.mean() * (kept / kept.mean()) ** exponent)


def test_mean_distance_by_hand() -> None:
    assert mean_distance((1, 1)) == 0
    assert mean_distance((1, 3)) == pytest.approx((0 + 1 + 2 + 1 + 0 + 1 + 2 + 1 + 0) / 9)
    assert mean_distance((2, 2)) == pytest.approx((2 + math.sqrt(2)) / 4)


def test_tau_equalises_where_pheromone_leads_to_the_change() -> None:
    """On a corridor: the product along the only way."""
    before = an.Problem.from_cells(grid_of("......"), (0, 0), (0, 4))
    after = an.Problem.from_cells(grid_of(".....#"), (0, 0), (0, 4))
    tau = np.full((6, 8), np.nan)
    along = [1.0, 2.0, 4.0, 4.0, 2.0]
    tau[:5, 4], tau[1:, 3] = along, along
    memory = Memory((1, 6), before.graph.flat, tau, 1.0)
    found = begun(after, with_=memory, memory="tau").tau
    assert found is not None
    gamma = [0.25 * 0.5, 0.5, 1.0, 1.0, 1.0]  # the change is beside cell 4; edges 1-2, 2-3, 3-4 have 2, 4, 4 of 4
    mean = np.mean(along[:4])
    for cell in range(4):
        share = (gamma[cell] + gamma[cell + 1]) / 2
        assert found[cell, 4] == pytest.approx((1 - share) * along[cell] + share * mean)


@pytest.mark.parametrize("name", ["eta", "tau", "repair"])
def test_where_nothing_changed_pheromone_stays(name: str) -> None:
    choices = {"elitists": 0, "flatten": 1} if name == "repair" else {}
    np.testing.assert_array_equal(pheromone(PROBLEM, memory=name, **choices), pheromone(PROBLEM))


@pytest.mark.parametrize("problem", CHANGED)
def test_a_mended_path_is_legal_and_keeps_what_it_can(problem: an.Problem) -> None:
    path = memory_of(RESULT).paths[0]
    whole = mended(path, problem)
    assert whole is not None
    short = shortened(whole, problem)
    lengths = [legal(np.searchsorted(problem.graph.flat, flat), problem) for flat in (whole, short)]
    assert exact.optimum(problem).cost <= lengths[1] + 1e-9
    assert lengths[1] <= lengths[0]
    if set(path.tolist()) <= set(problem.graph.flat.tolist()):
        np.testing.assert_array_equal(whole, path)


def test_mending_by_hand() -> None:
    open_map, walled = grid_of(".....", ".....", "....."), grid_of("..#..", ".....", ".....")
    before = an.Problem.from_cells(open_map, (0, 0), (0, 4), corner_rule="allow")
    path = np.array([before.to_flat((0, col)) for col in range(5)], np.int32)
    after = replace(before, grid=walled)
    assert after.from_flat(mended(path, after)).tolist() == [[0, 0], [0, 1], [1, 2], [0, 3], [0, 4]]
    along = replace(an.Problem.from_cells(open_map, (0, 2), (2, 4), corner_rule="allow"))
    assert along.from_flat(mended(path, along)).tolist()[:2] == [[0, 2], [0, 3]]  # from the robot's cell on
    detour = np.array(
        [before.to_flat(cell) for cell in [(0, 0), (1, 0), (1, 1), (0, 1), (0, 2), (0, 3), (0, 4)]], np.int32
    )
    assert before.from_flat(shortened(detour, before)).tolist() == [[0, 0], [0, 1], [0, 2], [0, 3], [0, 4]]


def test_nothing_is_mended_where_nothing_is_left() -> None:
    problem = an.Problem.from_cells(grid_of("...", "###"), (0, 0), (0, 2))
    gone = np.array([problem.to_flat((1, col)) for col in range(3)], np.int32)
    assert mended(gone, problem) is None
    memory = Memory((2, 3), problem.graph.flat, np.full((3, 8), np.nan), 1.0, (gone,))
    for name in ("repair", "population", "memory_immigrants"):
        assert begun(problem, with_=memory, memory=name).known is None
        assert an.solve(problem, an.npaco(memory=name), warm=memory).length == 2


@pytest.mark.parametrize("preset", ["npaco", "mmas", "acs", "rank_as"])
def test_a_repaired_path_counts_as_found(preset: str) -> None:
    """From the first iteration on, also where no ant arrives."""
    problem = next(
        problem for problem in CHANGED if legal(known(problem), problem) < 1.01 * exact.optimum(problem).cost
    )
    algorithm = an.preset(preset, ants=1, iterations=2, memory="repair")
    result = an.solve(problem, algorithm, warm=RESULT)
    assert result.history.best[0] <= legal(known(problem), problem)
    assert result.length <= result.history.best[0]


def known(problem: an.Problem) -> NDArray[np.int32]:
    found = begun(problem, memory="repair").known
    assert found is not None
    assert found.cost == pytest.approx(legal(found.nodes, problem))
    return found.nodes


def test_scouts_from_the_goal_know_it_the_other_way() -> None:
    result = an.solve(CHANGED[2], an.paco(ants=1, iterations=4, memory="repair"), warm=RESULT)
    lengths = [colony.length for colony in result.stages[0].colonies]
    assert max(lengths) <= legal(known(CHANGED[2]), CHANGED[2]) + 1e-9


@pytest.mark.parametrize("deposit", ["both", "forward", "cells"])
def test_a_repaired_path_deposits_as_ants_do(deposit: str) -> None:
    problem = CHANGED[3]
    plain, laid = (begun(problem, memory="repair", deposit=deposit, elitists=count) for count in (0, 5))
    assert plain.tau is not None
    assert laid.tau is not None
    assert laid.known is not None
    nodes, amount = laid.known.nodes, 5 / laid.known.cost
    expected = plain.tau.copy()
    neighbours = problem.graph.graph.neighbours
    for one, other in pairwise(nodes):
        if deposit == "cells":
            expected[neighbours == other] += amount
        else:
            expected[one, neighbours[one] == other] += amount
        if deposit == "both":
            expected[other, neighbours[other] == one] += amount
    np.testing.assert_allclose(laid.tau[edges(problem)], expected[edges(problem)])


def test_a_population_lays_its_pheromone_out_anew() -> None:
    problem, memory = CHANGED[4], memory_of(RESULT)
    tau = begun(problem, memory="population", tau_max=5).tau
    assert tau is not None
    expected = np.ones_like(tau)
    for path in memory.paths:
        nodes = np.searchsorted(problem.graph.flat, shortened(mended(path, problem), problem))
        for one, other in pairwise(nodes):
            expected[one, problem.graph.graph.neighbours[one] == other] += 4 / len(memory.paths)
            expected[other, problem.graph.graph.neighbours[other] == one] += 4 / len(memory.paths)
    np.testing.assert_allclose(tau[edges(problem)], expected[edges(problem)])
    assert expected[edges(problem)].max() <= 5 + 1e-9


@pytest.mark.parametrize("name", ["random_immigrants", "elitism_immigrants", "memory_immigrants"])
def test_immigrants_are_paths_that_the_seed_draws(name: str) -> None:
    problem, memory = CHANGED[5], memory_of(RESULT)
    algorithm = an.npaco(memory=name)
    part: Any = algorithm.memory
    best = known(problem)
    made = [part.immigrant(best, memory, problem, np.random.default_rng(seed)) for seed in range(12)]
    assert len({nodes.tobytes() for nodes in made}) > 4
    for nodes in made:
        legal(nodes, problem)
    first, again, other = (pheromone(problem, memory=name, seed=seed) for seed in (0, 0, 1))
    assert (first == again).all()
    assert (first != other).any()
    assert (pheromone(problem, memory=name, immigrants=0) == pheromone(problem, memory="population")).all()


def test_repair_says_that_it_knows_gaps() -> None:
    result = an.solve(CHANGED[6], an.npaco(memory="repair"), warm=RESULT)
    assert "gaps" in result.algorithm.knows.names
    assert "gaps of remembered paths are searched exactly" in str(result.algorithm.certainty)
    assert "memory repair" in str(result.algorithm.certainty)


@pytest.mark.parametrize("name", [name for name in MemoryStrategy if name != "keep"])
def test_regions_remember_nothing(name: MemoryStrategy) -> None:
    with pytest.raises(ParameterError, match=f"memory {name}: a graph of regions is another"):
        an.paco_large(memory=name)


def test_a_strategy_without_a_rule_is_refused() -> None:
    with pytest.raises(NotImplementedError):
        MemoryPart.warm(an.npaco().memory, memory_of(RESULT), PROBLEM, an.npaco(), 0)
