"""Terrain: one for each choice, what it works out, how long that lives, and in which copies it is not."""

from __future__ import annotations

import copy
import gc
import pickle
import weakref
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from threading import Barrier
from typing import Any

import numpy as np
import pytest

import antnav as an
from antnav import maps
from antnav.errors import ParameterError
from antnav.search import exact
from antnav.search.abstraction import Abstraction
from antnav.world.grid_graph import KEPT
from antnav.world.kept import Kept, KeptByKind
from antnav.world.moves import CornerRule, legal_moves
from tests.conftest import grid_of

TWO_PARTS = "..#.", "..#.", "####", "...#"


def test_a_map_has_one_terrain_for_each_choice() -> None:
    grid = grid_of(".?", "..")
    terrain = an.Terrain.of(grid, "allow")
    assert terrain is an.Terrain.of(grid, CornerRule.ALLOW, np.False_)
    assert (terrain.grid, terrain.corner_rule, terrain.allow_unknown) == (grid, CornerRule.ALLOW, False)
    others = [an.Terrain.of(grid), an.Terrain.of(grid, "allow", True), an.Terrain.of(grid_of(".?", ".."), "allow")]
    assert len({terrain, *others}) == 4
    problem = an.Problem.from_cells(grid, (0, 0), (1, 1), corner_rule="allow")
    assert problem.terrain is terrain is an.Problem.from_cells(grid, (1, 0), (1, 1), corner_rule="allow").terrain


@pytest.mark.parametrize(
    ("given", "rule"),
    [
        ({"grid": np.zeros((3, 3), np.uint8)}, "GridMap"),
        ({"corner_rule": "sometimes"}, "allow, graze, forbid"),
        ({"corner_rule": None}, "allow, graze, forbid"),
        ({"allow_unknown": "no"}, "true or false"),
        ({"allow_unknown": 1}, "true or false"),
    ],
)
def test_what_is_no_terrain(given: dict[str, Any], rule: str) -> None:
    for make in (an.Terrain, an.Terrain.of):
        with pytest.raises(ParameterError, match=rule):
            make(**({"grid": grid_of("..")} | given))


def test_what_it_works_out() -> None:
    grid = grid_of(*TWO_PARTS)
    terrain = an.Terrain.of(grid)
    assert np.array_equal(terrain.moves, legal_moves(grid.passable(), CornerRule.FORBID))
    assert terrain.width == terrain.moves.shape[1] == 6
    assert terrain.flat_moves.tolist() == terrain.moves.ravel().tolist()
    components = terrain.components.reshape(6, 6)[1:-1, 1:-1]
    assert components.tolist() == [[1, 1, 0, 2], [1, 1, 0, 2], [0, 0, 0, 0], [3, 3, 3, 0]]
    assert np.array_equal(terrain.reached((1, 3)), components == 2)
    assert np.argwhere(terrain.reached((2, 0))).tolist() == [[2, 0]]  # a wall: itself alone
    assert terrain.joins((0, 0), (1, 1))
    assert not terrain.joins((0, 0), (0, 3))
    assert an.Terrain.of(grid_of(".?", ".#"), allow_unknown=True).passable.tolist() == [[True, True], [True, False]]


def test_it_is_worked_out_once_and_closed_to_writing() -> None:
    grid = grid_of("..", ".?")
    one, other = an.Terrain.of(grid, "allow"), an.Terrain(grid, CornerRule.ALLOW)
    assert one.passable is other.passable is an.Terrain.of(grid).passable
    assert one.components is other.components
    assert np.shares_memory(one.moves, other.flat_moves)
    assert Abstraction.of(one, 8) is Abstraction.of(other, 8) is an.prepare(grid, "allow", block=8)
    assert not any(array.flags.writeable for array in (one.passable, one.moves, one.components))
    assert one.flat_moves.flags.writeable  # Numba would compile kernels a second time for others


def test_the_next_query_in_a_component_gets_the_same_graph() -> None:
    grid = grid_of(*TWO_PARTS)
    graph = an.Problem.from_cells(grid, (0, 0), (1, 1)).graph  # nobody holds the problem
    assert an.Problem.from_cells(grid, (1, 0), (0, 1)).graph is graph
    assert an.Terrain.of(grid).graph((1, 1)) is graph
    far = an.Terrain.of(grid).graph((0, 3))
    assert (len(graph), len(far)) == (4, 2)
    assert an.Terrain.of(grid).graph((0, 0)) is graph  # held here
    assert len(an.Terrain.of(grid_of(".#.")).graph((0, 2))) == 1
    assert len(an.Terrain.of(grid, "allow").graph((0, 0))) == 4
    with pytest.raises(ParameterError, match="may not stand there"):
        an.Terrain.of(grid).graph((0, 2))


def test_a_map_keeps_the_latest_graph_and_takes_it_along() -> None:
    """By counting references alone: nothing waits for the collector of cycles."""
    gc.disable()
    try:
        grid = grid_of(*TWO_PARTS)
        terrain = an.Terrain.of(grid)
        near = weakref.ref(terrain.graph((0, 0)))
        assert near() is not None
        far = weakref.ref(terrain.graph((0, 3)))
        assert near() is None
        kept = far, weakref.ref(terrain.flat_moves.base), weakref.ref(an.prepare(grid))
        del terrain
        assert [ref() is None for ref in kept] == [False] * 3
        del grid
        assert [ref() is None for ref in kept] == [True] * 3
    finally:
        gc.enable()


def test_a_problem_holds_its_graph() -> None:
    grid = grid_of(*TWO_PARTS)
    near = an.Problem.from_cells(grid, (0, 0), (1, 1))
    graph = weakref.ref(near.graph)
    _ = an.Problem.from_cells(grid, (0, 3), (1, 3)).graph
    assert near.graph is graph()


def test_pheromone_of_one_run_fits_the_next() -> None:
    grid = maps.generate("caves", 30, 30, seed=1)
    free = [
        tuple(map(int, cell)) for cell in np.argwhere(an.Terrain.of(grid).components.reshape(32, 32)[1:-1, 1:-1] == 1)
    ]
    one = an.Colony(an.Problem.from_cells(grid, free[0], free[-1]), an.npaco(ants=4, iterations=3), seed=1)
    other = an.Colony(an.Problem.from_cells(grid, free[1], free[-2]), an.npaco(ants=4, iterations=3), seed=1)
    one.step()
    assert one.task.grid_graph is other.task.grid_graph
    other.tau[:] = one.tau
    other.step()
    assert np.isfinite(other.tau).all()


@pytest.mark.parametrize("again", [copy.copy, copy.deepcopy, lambda it: pickle.loads(pickle.dumps(it))])
def test_no_copy_holds_what_is_kept(again: Callable[[Any], Any]) -> None:
    problem = an.Problem.from_cells(an.GridMap(np.zeros((50, 50), np.uint8)), (0, 0), (49, 49))
    bare = pickle.dumps(problem)
    result = an.solve(problem, an.npaco(ants=3, iterations=3), seed=1)
    an.prepare(problem.grid)
    assert exact.optimum(problem).path.clearance == np.inf  # rows to the walls, too
    assert len(pickle.dumps(problem)) <= len(bare) + 100
    assert len(pickle.dumps(problem.terrain)) < len(bare) + 100
    twin = again(problem)
    assert not {"graph", "kept"} & twin.__dict__.keys()
    assert an.solve(twin, an.npaco(ants=3, iterations=3), seed=1).length == result.length
    grid = again(problem.grid)
    assert not any(len(kept) for kept in vars(grid.kept).values())
    assert again(problem.grid) == grid == problem.grid
    assert an.Terrain.of(grid).grid is grid
    graph = again(problem.graph)
    assert np.array_equal(graph.distances_to(3), problem.graph.distances_to(3))


def test_an_unpickled_terrain_is_the_one_of_its_map() -> None:
    problem = an.Problem.from_cells(grid_of("..", ".?"), (0, 0), (0, 1), allow_unknown=True)
    other, terrain = pickle.loads(pickle.dumps((problem, problem.terrain)))
    assert other.terrain is terrain is an.Terrain.of(other.grid, allow_unknown=True)


def test_threads_on_a_fresh_map_share_all_and_get_the_same_bytes() -> None:
    cells = maps.generate("caves", 60, 60, seed=3).cells
    component = an.Terrain.of(an.GridMap(cells)).components.reshape(62, 62)[1:-1, 1:-1]
    free = np.argwhere(component == np.bincount(component[component > 0]).argmax())
    start, goal = (tuple(map(int, free[at])) for at in (0, -1))
    alone = an.solve(an.Problem.from_cells(an.GridMap(cells), start, goal), an.paco(iterations=20), seed=4)
    for _ in range(3):
        grid, barrier = an.GridMap(cells), Barrier(8)

        def run(_: int, grid: an.GridMap = grid, barrier: Barrier = barrier) -> tuple[an.Result, Any, Any]:
            barrier.wait()
            problem = an.Problem.from_cells(grid, start, goal)
            return an.solve(problem, an.paco(iterations=20), seed=4), problem.graph, an.prepare(grid)

        with ThreadPoolExecutor(8) as eight:
            results, graphs, abstractions = zip(*eight.map(run, range(8)), strict=True)
        assert len({id(graph) for graph in graphs}) == len({id(short) for short in abstractions}) == 1
        for result in results:
            assert result.path.cells.tobytes() == alone.path.cells.tobytes()
            assert [column.tobytes() for column in result.history] == [column.tobytes() for column in alone.history]


def test_nodes_and_cells_out_of_range_are_refused() -> None:
    problem = an.Problem.from_cells(grid_of("..#.", "..#."), (0, 0), (1, 1))
    graph, short = problem.graph, an.prepare(problem.grid, block=4)
    regions = short.between(problem.to_flat((0, 0)), problem.to_flat((1, 1)))
    for cell in ((0, 2), (0, 3), (2, 0), (0, -1), (1, -5), (-1, 5), (0.5, 0), (True, 0), None, "ab", (0, 1, 2)):
        with pytest.raises(ParameterError, match="cell"):
            graph.node(cell)
    for cell in ((2, 0), (0, 4), (-1, 0), (0, -1), (0.5, 0), (True, 0), None, "ab"):
        for ask in (problem.to_flat, problem.terrain.to_flat, problem.terrain.graph, problem.terrain.reached):
            with pytest.raises(ParameterError, match="cell"):
                ask(cell)
    assert [graph.node(tuple(cell)) for cell in graph.cells] == [0, 1, 2, 3]
    for node in (-1, 4, 1.0, True, None, "1", np.array([1]), 10**30):
        for placed in (graph, regions):
            with pytest.raises(ParameterError, match="nodes are 0"):
                placed.distances_to(node)
    assert graph.distances_to(np.int32(3)) is graph.distances_to(3)


def test_a_graph_keeps_the_latest_distances() -> None:
    graph = an.Terrain.of(an.GridMap(np.zeros((3, 3), np.uint8))).graph((0, 0))
    first = weakref.ref(graph.distances_to(0))
    for node in range(1, KEPT):
        graph.distances_to(node)
    assert graph.distances_to(0) is first()  # asked for again, it is the latest
    for node in range(1, KEPT + 1):
        graph.distances_to(node)
    assert first() is None


def test_kept_values_are_the_latest_and_those_in_use() -> None:
    kept: Kept[str, np.ndarray] = Kept(2)
    one = kept.of("one", lambda: np.zeros(1))
    for key in ("two", "three", "four"):
        kept.of(key, lambda: np.zeros(2))
    assert kept.of("one", lambda: np.zeros(3)) is one
    assert len(kept) == 2
    assert len(kept.of("three", lambda: np.zeros(3))) == 3  # gone before
    copied = copy.deepcopy(kept)
    assert len(copied) == 0
    assert len(copied.of("one", lambda: np.zeros(4))) == 4


def test_what_a_value_needs_may_be_kept_in_the_same_place() -> None:
    kept: Kept[int, np.ndarray] = Kept(9)

    def factorial(n: int) -> np.ndarray:
        return kept.of(n, lambda: n * factorial(n - 1) if n else np.ones(1))

    assert factorial(5) == [120]
    assert len(kept) == 6


def test_a_failure_is_not_kept() -> None:
    kept = KeptByKind()
    with pytest.raises(ZeroDivisionError):
        kept.of(float, "share", lambda: 1 / 0)
    array = kept.of(np.ndarray, "share", lambda: np.ones(2))
    assert kept.of(np.ndarray, "share", lambda: np.zeros(2)) is array
