"""The exact planners against scipy, published lengths and queries on real maps."""

from __future__ import annotations

import csv
import json
import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra

import antnav as an
from antnav import maps
from antnav.errors import ParameterError
from antnav.search import exact
from antnav.world.cost import CostField
from antnav.world.moves import CornerRule
from tests.conftest import grid_of


def scipy_distances(cells: np.ndarray, rule: str, source: tuple[int, int]) -> np.ndarray:
    """Distances from one cell by scipy's Dijkstra, on edges listed one by one."""
    rows, cols = cells.shape

    def free(row: int, col: int) -> bool:
        return 0 <= row < rows and 0 <= col < cols and not cells[row, col]

    edges = []
    for row, col in np.argwhere(cells == 0):
        for down in (-1, 0, 1):
            for right in (-1, 0, 1):
                if (down, right) == (0, 0) or not free(row + down, col + right):
                    continue
                sides = free(row + down, col) + free(row, col + right)
                if down and right and sides < {"allow": 0, "graze": 1, "forbid": 2}[rule]:
                    continue
                edges.append((row * cols + col, (row + down) * cols + col + right, math.hypot(down, right)))
    size = rows * cols
    start, end, length = zip(*edges, strict=True) if edges else ((), (), ())
    graph = coo_array((length, (start, end)), shape=(size, size)).tocsr()
    return dijkstra(graph, indices=source[0] * cols + source[1]).reshape(rows, cols)


@settings(max_examples=150, deadline=None, derandomize=True)
@given(
    rows=st.integers(1, 14),
    cols=st.integers(2, 14),
    density=st.floats(0, 0.6),
    seed=st.integers(0, 2**32 - 1),
    rule=st.sampled_from(list(CornerRule)),
)
def test_optimum_equals_scipy_on_random_maps(rows: int, cols: int, density: float, seed: int, rule: CornerRule) -> None:
    cells = (np.random.default_rng(seed).random((rows, cols)) < density).astype(np.uint8)
    cells[0, 0] = cells[-1, -1] = 0
    problem = an.Problem.from_cells(an.GridMap(cells), (0, 0), (rows - 1, cols - 1), corner_rule=rule)
    expected = scipy_distances(cells, rule, (0, 0))
    np.testing.assert_allclose(exact.distance_field(problem, (0, 0)), np.where(cells, np.inf, expected), rtol=1e-12)
    for method in exact.METHODS:
        found = exact.shortest_path(problem, method)
        assert found.length == pytest.approx(expected[-1, -1], rel=1e-12)
        assert problem.connected == math.isfinite(expected[-1, -1]) == (found.path is not None)
        if found.path:
            assert an.check_path(found.path, problem) == pytest.approx(found.length)


def test_a_star_looks_at_fewer_cells_than_dijkstra_and_jumps_at_fewer_still() -> None:
    problem = an.Problem.from_cells(an.GridMap(np.zeros((40, 40), bool)), (0, 0), (0, 39))
    assert exact.shortest_path(problem).expanded == exact.shortest_path(problem, "jps").expanded == 2  # both ends
    assert exact.shortest_path(problem, "astar").expanded == 40
    assert exact.shortest_path(problem, "dijkstra").expanded > 400


@pytest.mark.parametrize("method", ["astar", "jps"])
def test_ties_towards_the_goal_change_no_length(method: str) -> None:
    """Two ways that differ by 0.017 cells: 41 diagonal moves in place of 58 straight ones.

    The shorter one zigzags first and has 42 cells to go then, the other one first comes near and then turns away. What
    breaks ties must not weigh those 42 cells so much that the longer way arrives before.
    """
    zigzag = [(10 + col % 2, col) for col in range(46)] + [(11, col) for col in range(46, 88)]
    around = [(9, 0), *((8, col) for col in range(1, 86)), *((row, 85) for row in range(8)), (0, 86)]
    around += [(row, 87) for row in range(11)]
    cells = np.ones((12, 88), np.uint8)
    cells[tuple(np.array(zigzag + around).T)] = 0
    problem = an.Problem.from_cells(an.GridMap(cells), zigzag[0], zigzag[-1], corner_rule="allow")
    assert exact.shortest_path(problem, method).length == pytest.approx(45 * math.sqrt(2) + 42, abs=1e-9)
    cells[tuple(np.array(zigzag[1:-1]).T)] = 1
    problem = an.Problem.from_cells(an.GridMap(cells), zigzag[0], zigzag[-1], corner_rule="allow")
    assert 0.01 < exact.shortest_path(problem, method).length - 45 * math.sqrt(2) - 42 < 0.02


def test_start_equals_goal() -> None:
    for method in exact.METHODS:
        found = exact.shortest_path(an.Problem.from_cells(grid_of(".."), (0, 1), (0, 1)), method)
        assert (found.length, len(found.path), found.expanded) == (0.0, 1, 1)


def test_unknown_method() -> None:
    with pytest.raises(ParameterError, match="astar, dijkstra, jps"):
        exact.shortest_path(an.Problem.from_cells(grid_of(".."), (0, 0), (0, 1)), "magic")


@pytest.mark.parametrize("choice", [{"turning": 0.5}, {"cost": CostField(np.ones((2, 3)))}], ids=["turns", "cost"])
def test_jumps_know_no_costs(choice: dict) -> None:
    problem = an.Problem.from_cells(grid_of("..#", "..."), (0, 0), (1, 2), **choice)
    with pytest.raises(ParameterError, match="choose astar"):
        exact.shortest_path(problem, "jps")
    assert exact.shortest_path(problem).cost == exact.shortest_path(problem, "astar").cost


def test_the_optimum_of_a_problem_is_searched_once() -> None:
    problem = an.Problem.from_cells(grid_of(".."), (0, 0), (0, 1))
    assert exact.optimum(problem) is exact.optimum(problem)


def moving_ai_rows(data: Path) -> Iterator[tuple[Path, tuple, tuple, dict[str, float]]]:
    folder = data / "movingai"
    with (data / "queries" / "movingai_sample_lengths.tsv").open(encoding="utf-8") as lines:
        for line in csv.DictReader(lines, delimiter="\t"):
            scen = folder / line["#scen_file"]
            bare = scen.with_suffix("")
            path = bare if bare.suffix == ".map" else bare.with_name(bare.name.rsplit("-", 2)[0] + ".map")
            start = int(line["start_y"]), int(line["start_x"])
            goal = int(line["goal_y"]), int(line["goal_x"])
            lengths = {
                "forbid": float(line["official_length"]),
                "graze": float(line["own_diag_if_one_side_free"]),
                "allow": float(line["own_diag_always"]),
            }
            yield path, start, goal, lengths


@pytest.mark.slow
def test_published_lengths_of_movingai_under_all_corner_rules(data: Path) -> None:
    loaded: dict[Path, an.GridMap] = {}
    count = 0
    for path, start, goal, lengths in moving_ai_rows(data):
        if path not in loaded:
            loaded[path] = maps.load_map(path)
        for rule, length in lengths.items():
            problem = an.Problem.from_cells(loaded[path], start, goal, corner_rule=rule)
            found = exact.shortest_path(problem, "jps")
            assert found.length == pytest.approx(length, abs=5.1e-3), (path, start, goal, rule)
            assert found.length == exact.shortest_path(problem, "astar").length
            back = an.Problem.from_cells(loaded[path], goal, start, corner_rule=rule)
            assert found.length == exact.shortest_path(back, "jps").length
            if count % 10 == 0:
                an.check_path(found.path, problem)
        count += 1
    assert count == 3146


@pytest.mark.slow
def test_queries_on_ros_maps(data: Path) -> None:
    """20 pairs on each of 20 real maps; the expected lengths were computed under ROS 1's thresholds."""
    queries = json.loads((data / "queries" / "ros_map_queries.json").read_text(encoding="utf-8"))
    count = 0
    for name, entry in queries["maps"].items():
        if not entry.get("queries"):
            continue
        path = data / "ros" / (name if name.endswith(".yaml") and "ctcv" not in name else entry["image"])
        grid = maps.load_map(path, rules="ros1")
        for query in entry["queries"]:
            for rule, key in (("forbid", "len_no_corner_cut"), ("allow", "len_corner_cut_allowed")):
                ends = tuple(query["start_row_col"]), tuple(query["goal_row_col"])
                problem = an.Problem.from_cells(grid, *ends, corner_rule=rule)
                assert exact.shortest_path(problem).length == pytest.approx(query[key], abs=1e-6), (name, query)
            count += 1
    assert count == 400


def test_jump_point_search_keeps_out_of_blocked_cells() -> None:
    """A field that only blocks cells leaves cost the length."""
    blocked = np.zeros((7, 9), np.bool_)
    blocked[1:, 4] = True
    problem = an.Problem.from_cells(
        an.GridMap(np.zeros((7, 9), np.uint8)), (6, 0), (6, 8), cost=an.costs.keepout(blocked)
    )
    found = [exact.shortest_path(problem, method) for method in ("jps", "astar", "auto")]
    assert [one.cost for one in found] == pytest.approx([found[0].length] * 3)
    assert not blocked[tuple(found[0].path.cells.T)].any()
    closed = an.Problem.from_cells(an.GridMap(blocked.astype(np.uint8)), (6, 0), (6, 8))
    assert exact.shortest_path(closed, "jps").length == found[0].length
