"""The auxiliary cell, the halves, the joined path: by hand."""

from __future__ import annotations

import numpy as np
import pytest

import antnav as an
from antnav import maps
from antnav.ants import decompose
from antnav.colony.parts import Axis
from antnav.kernels.graph import Graph
from antnav.planner.plan import ColonyReport, Stage
from antnav.search.abstraction import RegionGraph
from antnav.search.windows import without_loops
from tests.conftest import grid_of


@pytest.mark.parametrize(
    ("start", "goal", "axis", "line"),
    [
        ((0, 0), (19, 19), "auto", (0, 9)),  # printed: auxiliary cell (8.5, 10.5) of 20 rows = row 9
        ((21, 0), (1, 25), "row", (0, 11)),  # printed: (20.5, 18.5) of 30 rows = row 11
        ((21, 0), (1, 25), "auto", (1, 12)),  # the paper's own rule, which its 30x30 map breaks
        ((5, 5), (34, 28), "auto", (0, 19)),  # printed: (11.5, 20.5) of 40 rows = row 19
        ((3, 3), (3, 9), "auto", (1, 6)),
        ((3, 3), (9, 3), "column", (1, 3)),
    ],
)
def test_boundary(start: tuple, goal: tuple, axis: str, line: tuple) -> None:
    assert decompose.boundary(start, goal, Axis(axis)) == line


def test_auxiliary_cell_is_the_most_visited_of_the_line_but_no_end() -> None:
    problem = an.Problem.from_cells(grid_of("...", "...", "..."), (1, 0), (1, 2))
    visits = np.array([9, 9, 9, 7, 2, 5, 9, 9, 9])
    assert decompose.auxiliary_node(problem.graph, visits, (0, 1), (3, 5)) == 4
    assert decompose.auxiliary_node(problem.graph, visits, (0, 1), (4, 5)) == 3
    visits[4] = 0
    assert decompose.auxiliary_node(problem.graph, visits, (0, 1), (3, 5)) is None
    assert decompose.auxiliary_node(problem.graph, np.full(9, 4), (1, 1), (3, 5)) == 1  # ties: the first


def test_half_keeps_to_its_side_and_to_the_line() -> None:
    problem = an.Problem.from_cells(grid_of("...", "...", "..."), (0, 0), (2, 2))
    graph = problem.graph
    start, middle, goal = (graph.node(cell) for cell in ((0, 0), (1, 1), (2, 2)))
    upper = decompose.half(graph, (0, 1), middle, start)
    assert upper.cells.tolist() == [[row, col] for row in (0, 1) for col in range(3)]
    assert decompose.half(graph, (1, 1), middle, goal).cells.tolist() == [[r, c] for r in range(3) for c in (1, 2)]
    for node in range(6):  # the same neighbours, but for those outside
        everywhere = graph.graph.neighbours[node]
        assert upper.graph.neighbours[node].tolist() == [i if i < 6 else 6 for i in everywhere]
    assert upper.distances_to(0).tolist() == graph.distances_to(0)[:6].tolist()


def test_a_part_is_what_can_be_reached_inside() -> None:
    graph = an.Problem.from_cells(grid_of("..#..", "....."), (0, 0), (1, 4)).graph
    inside = np.array([row == 0 or col in (0, 1) for row, col in graph.cells])
    part = graph.part(inside, graph.node((0, 1)))
    assert part.cells.tolist() == [[0, 0], [0, 1], [1, 0], [1, 1]]
    assert [int(flat) in part for flat in graph.flat] == [True, True, False, False, True, True, False, False, False]
    assert part.graph.neighbours.max() == len(part)


def test_levels_are_crossed_where_most_paths_pass() -> None:
    """A corridor of 9 cells and a way round its middle: 3 pieces, each of a third of the length."""
    problem = an.Problem.from_cells(grid_of(".........", "###...###"), (0, 0), (0, 8), corner_rule="allow")
    graph = problem.graph
    distance = graph.distances_to(graph.node((0, 0)))
    goal = graph.node((0, 8))
    visits = np.ones(len(graph), np.int64)
    cells = [graph.cells[node].tolist() for node in decompose.level_crossings(graph, visits, distance, goal, 3)]
    assert cells == [[0, 3], [0, 6]]  # 8/3 and 16/3 of the way; (1, 3) is as far as (0, 3) and a half
    visits[graph.node((1, 3))] = 5
    cells = [graph.cells[node].tolist() for node in decompose.level_crossings(graph, visits, distance, goal, 3)]
    assert cells == [[1, 3], [0, 6]]
    assert decompose.level_crossings(graph, visits, distance, graph.node((0, 1)), 3) == []
    visits[graph.node((0, 5))] = 9  # one cell beyond the level at 4, which (0, 4) is on
    assert graph.cells[decompose.level_crossings(graph, visits, distance, goal, 2)].tolist() == [[0, 4]]


def test_every_level_separates_start_and_goal() -> None:
    """Without the cells on a level the goal cannot be reached."""
    grid = maps.generate("random", 30, 30, seed=3, density=0.3)
    problem = an.Problem.from_cells(grid, *maps.ends(grid), corner_rule="allow")
    graph = problem.graph
    start, goal = graph.node(problem.start_cell), graph.node(problem.goal_cell)
    distance = graph.distances_to(start)
    before = np.append(distance, np.inf)[graph.graph.neighbours].min(axis=1)
    crossings = decompose.level_crossings(graph, np.zeros(len(graph), np.int64), distance, goal, 5)
    assert len(crossings) == 4
    for k, crossing in enumerate(crossings, 1):
        level = distance[goal] * k / 5
        on_level = (distance >= level) & (before < level)
        assert on_level[crossing]
        assert int(graph.flat[goal]) not in graph.part(~on_level, start)


def test_a_band_lies_between_two_crossings() -> None:
    graph = an.Problem.from_cells(grid_of("........."), (0, 0), (0, 8)).graph
    distance = graph.distances_to(0)
    assert decompose.band((3, 5), graph, distance).cells[:, 1].tolist() == [2, 3, 4, 5, 6]
    graph = an.Problem.from_cells(grid_of(".........", ".#######.", "........."), (0, 0), (0, 8)).graph
    distance = graph.distances_to(0)
    there, here = graph.node((0, 3)), graph.node((2, 4))
    assert decompose.band((there, here), graph, distance) is None


def test_different_routes() -> None:
    """Four ways from 0 to 5; the second shortest is nearly the first, the third one has a cell of its own in four."""
    lengths = {(0, 1): 1.0, (1, 2): 1.0, (2, 5): 1.0, (2, 3): 1.0, (3, 5): 1.5, (0, 4): 3.0, (4, 5): 3.0}
    neighbours, table = np.full((6, 8), 6, np.int32), np.zeros((6, 8))
    for (i, j), length in lengths.items():
        for a, b in ((i, j), (j, i)):
            slot = int((neighbours[a] < 6).sum())
            neighbours[a, slot], table[a, slot] = b, length
    owner, crossing = np.arange(6, dtype=np.int32), np.zeros((6, 8), np.int32)
    places = np.zeros((6, 2), np.int64)
    graph = RegionGraph(Graph(neighbours, table, np.zeros((6, 8), np.uint8)), places, 0, 5, owner, crossing)
    paths = [np.array(path, np.int32) for path in ([0, 4, 5], [0, 1, 2, 3, 5], [0, 1, 2, 5], [0, 1, 2, 5])]
    assert graph.lengths_of(paths).tolist() == [6, 4.5, 3, 3]

    def routes(count: int, new: float) -> list:
        return [path.tolist() for path in decompose.different_routes(paths, graph, count, new)]

    assert routes(9, 0.2) == [[0, 1, 2, 5], [0, 1, 2, 3, 5], [0, 4, 5]]
    assert routes(9, 0.3) == [[0, 1, 2, 5], [0, 4, 5]]
    assert routes(2, 0.2) == [[0, 1, 2, 5], [0, 1, 2, 3, 5]]
    assert routes(1, 0.0) == [[0, 1, 2, 5]]
    assert decompose.different_routes([], graph, 3) == []


def test_balance_is_the_busiest_over_the_mean() -> None:
    reports = tuple(ColonyReport((0, 0), (1, 1), 5, 3.0, steps, 0.1, 0.1) for steps in (10, 20, 60))
    assert Stage("stage two", 0.1, reports).balance == 2.0
    assert np.isnan(Stage("windows", 0.1, ()).balance)


def test_pieces_keep_to_their_bands_and_are_joined() -> None:
    grid = maps.generate("caves", 60, 60, seed=1)
    problem = an.Problem.from_cells(grid, *maps.ends(grid))
    for pieces in (2, 3, 7):
        result = an.solve(problem, an.paco_levels(pieces=pieces), seed=2)
        an.check_path(result.path, problem)
        colonies = result.stages[1].colonies
        assert len(colonies) == pieces
        assert [colony.goal for colony in colonies[:-1]] == [colony.start for colony in colonies[1:]]
        assert result.crossing_cells == tuple(colony.start for colony in colonies[1:])
        assert result.gap < 0.02
        assert result.stages[1].balance < 1.5
        assert result.history.best[-1] >= result.length - 1e-9


def test_half_is_refused_where_it_cuts_the_auxiliary_cell_off() -> None:
    # From the start, row 1's right end is only reached through row 2.
    problem = an.Problem.from_cells(grid_of("..###", "..#..", "....."), (0, 0), (2, 4))
    graph = problem.graph
    assert decompose.half(graph, (0, 1), graph.node((1, 4)), graph.node((0, 0))) is None
    assert decompose.half(graph, (0, 1), graph.node((1, 1)), graph.node((1, 0))) is None  # the end lies on the line


@pytest.mark.parametrize(
    ("nodes", "expected"),
    [
        ([1, 2, 3], [1, 2, 3]),
        ([1, 2, 3, 2, 4], [1, 2, 4]),
        ([1, 2, 1, 3, 4, 3, 5], [1, 3, 5]),
        ([7], [7]),
        ([1, 2, 1], [1]),
    ],
)
def test_loops_are_cut_out(nodes: list, expected: list) -> None:
    assert without_loops(np.array(nodes)).tolist() == expected
