"""Regions, crossings and the graph of regions, against slow and obvious twins."""

from __future__ import annotations

import math
import pickle

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components, dijkstra

import antnav as an
from antnav.errors import ParameterError
from antnav.kernels import grid_kernels
from antnav.maps.generators import ends, generate
from antnav.search.abstraction import Abstraction, prepare
from antnav.world.moves import STEPS, CornerRule
from tests.conftest import grid_of


def random_grid(rows: int, cols: int, density: float, seed: int) -> an.GridMap:
    return an.GridMap((np.random.default_rng(seed).random((rows, cols)) < density).astype(np.uint8))


def legal_pairs(moves: np.ndarray) -> list[tuple[int, int]]:
    """Every legal move as a pair of flat cells."""
    width = moves.shape[1]
    flat = moves.ravel()
    return [
        (int(cell), int(cell) + row * width + col)
        for cell in np.flatnonzero(flat)
        for k, (row, col) in enumerate(STEPS)
        if flat[cell] >> k & 1
    ]


def block_of(cell: int, width: int, block: int) -> tuple[int, int]:
    return (cell // width - 1) // block, (cell % width - 1) // block


def octile(one: int, other: int, width: int) -> float:
    rows, cols = abs(one // width - other // width), abs(one % width - other % width)
    return max(rows, cols) + (math.sqrt(2) - 1) * min(rows, cols)


maps = {
    "rows": st.integers(1, 23),
    "cols": st.integers(1, 23),
    "density": st.floats(0, 0.6),
    "seed": st.integers(0, 2**32 - 1),
    "rule": st.sampled_from(list(CornerRule)),
}


@settings(max_examples=80, deadline=None, derandomize=True)
@given(**maps)
def test_components_equal_scipy(rows: int, cols: int, density: float, seed: int, rule: CornerRule) -> None:
    grid = random_grid(rows, cols, density, seed)
    terrain = an.Terrain.of(grid, rule)
    moves, found = terrain.moves, terrain.components
    pairs = legal_pairs(moves)
    one, other = zip(*pairs, strict=True) if pairs else ((), ())
    matrix = coo_array((np.ones(len(pairs)), (one, other)), shape=(moves.size, moves.size))
    _, label = connected_components(matrix, directed=False)
    can_move = moves.ravel() > 0
    assert np.array_equal(found > 0, can_move)
    both = set(zip(found[can_move].tolist(), label[can_move].tolist(), strict=True))
    assert len(both) == len({a for a, _ in both}) == len({b for _, b in both})


@settings(max_examples=80, deadline=None, derandomize=True)
@given(block=st.sampled_from([4, 5, 16]), **maps)
def test_regions_and_crossings_equal_their_twins(
    block: int, rows: int, cols: int, density: float, seed: int, rule: CornerRule
) -> None:
    terrain = an.Terrain.of(random_grid(rows, cols, density, seed), rule)
    moves, short = terrain.moves, Abstraction.of(terrain, block)
    width, pairs = moves.shape[1], legal_pairs(moves)
    inside = [(a, b) for a, b in pairs if block_of(a, width, block) == block_of(b, width, block)]
    one, other = zip(*inside, strict=True) if inside else ((), ())
    matrix = coo_array((np.ones(len(inside)), (one, other)), shape=(moves.size, moves.size))
    _, label = connected_components(matrix, directed=False)
    can_move = moves.ravel() > 0
    _, region, centre, _, first, other, leave, enter, length = short.crossings
    assert np.array_equal(region >= 0, can_move)
    both = set(zip(region[can_move].tolist(), label[can_move].tolist(), strict=True))
    assert len(both) == len(short) == len({b for _, b in both})
    for number, middle in enumerate(centre):
        cells = np.argwhere((region == number).reshape(moves.shape))
        to_mean = ((cells - cells.mean(axis=0)) ** 2).sum(axis=1)
        here = np.array([middle // width, middle % width])
        assert region[middle] == number
        assert ((here - cells.mean(axis=0)) ** 2).sum() == pytest.approx(to_mean.min())

    best: dict[tuple[int, int], float] = {}
    for a, b in pairs:
        ends = region[a], region[b]
        rows, cols = b // width - a // width, b % width - a % width
        beside = {region[a + rows * width], region[a + cols]} if rows and cols else set()
        if ends[0] < ends[1] and ends[1] not in beside:
            centres = centre[ends[0]], centre[ends[1]]
            way = octile(centres[0], a, width) + octile(a, b, width) + octile(b, centres[1], width)
            best[ends] = best[ends[::-1]] = min(best.get(ends, math.inf), way)
    owners = np.repeat(np.arange(len(short)), np.diff(first))
    assert dict(zip(zip(owners, other, strict=True), length, strict=True)) == pytest.approx(best)
    legal = set(pairs)
    for i, j, a, b in zip(owners, other, leave, enter, strict=True):
        assert (a, b) in legal
        assert (region[a], region[b]) == (i, j)


def lengths_between(short: Abstraction, start: int, goal: int) -> dict[tuple[int, int], float]:
    """Length of each way through a crossing, by the regions it joins; those of start and goal lie where these are."""
    width, region, centre, _, first, other, leave, enter, _ = short.crossings
    place = dict(enumerate(centre.tolist())) | {int(region[start]): start} | {int(region[goal]): goal}
    owners = np.repeat(np.arange(len(short)), np.diff(first))
    return {
        (int(one), int(two)): octile(place[one], a, width) + octile(a, b, width) + octile(b, place[two], width)
        for one, two, a, b in zip(owners, other.tolist(), leave.tolist(), enter.tolist(), strict=True)
    }


@settings(max_examples=100, deadline=None, derandomize=True)
@given(block=st.sampled_from([4, 16]), reach=st.integers(0, 4), data=st.data(), **maps)
def test_the_graph_of_a_query_equals_its_twin(
    block: int, reach: int, data: st.DataObject, rows: int, cols: int, density: float, seed: int, rule: CornerRule
) -> None:
    """The regions so many crossings from a cheapest route, and all that is between them."""
    terrain = an.Terrain.of(random_grid(rows, cols, density, seed), rule)
    short, component = Abstraction.of(terrain, block), terrain.components
    can_move = np.flatnonzero(component).tolist()
    if not can_move:
        return
    start = data.draw(st.sampled_from(can_move))
    goal = data.draw(st.sampled_from(can_move))
    graph, region = short.between(start, goal, reach), short.crossings.region
    assert (graph is not None) == (component[start] == component[goal])
    if graph is None:
        return
    wanted = lengths_between(short, start, goal)
    neighbours, lengths, reverse = graph.graph
    joined = {}
    for i, k in zip(*np.nonzero(neighbours < len(graph)), strict=True):
        j = neighbours[i, k]
        back = neighbours[j, reverse[i, k]], reverse[j, reverse[i, k]], lengths[j, reverse[i, k]]
        assert back == (i, k, lengths[i, k])
        if graph.owner[i] == graph.owner[j]:
            assert (lengths[i, k], abs(int(i) - int(j)), graph.crossing[i, k]) == (0, 1, -1)
        else:
            e = graph.crossing[i, k]
            assert region[[short.crossings.leave[e], short.crossings.enter[e]]].tolist() == graph.owner[[i, j]].tolist()
            joined[int(graph.owner[i]), int(graph.owner[j])] = lengths[i, k]
    near = set(graph.owner.tolist())
    assert joined == pytest.approx({pair: length for pair, length in wanted.items() if near.issuperset(pair)})
    assert sorted(graph.owner) == graph.owner.tolist()
    assert graph.owner[[graph.start, graph.goal]].tolist() == region[[start, goal]].tolist()

    count = len(short)
    matrix = coo_array(([*wanted.values()], ([i for i, _ in wanted], [j for _, j in wanted])), shape=(count, count))
    least = dijkstra(matrix.tocsr() if wanted else np.zeros((count, count)), indices=region[start])[region[goal]]
    assert graph.distances_to(graph.goal)[graph.start] == pytest.approx(least)
    ball = set(short.between(start, goal, 0).owner.tolist())
    for _ in range(reach):
        ball |= {two for one, two in wanted if one in ball}
    assert near == ball


def test_a_region_with_many_neighbours_becomes_a_chain() -> None:
    degree = 20
    first = np.array([0, degree, *range(degree + 1, 2 * degree + 1)], np.int32)
    other = np.array([*range(1, degree + 1), *[0] * degree], np.int32)
    owner, *_, neighbours, _lengths, _reverse = grid_kernels.region_table(first, other, np.ones(2 * degree))
    assert (owner == 0).sum() == 3  # 7 + 6 + 7 slots
    assert sorted(owner[neighbours[:3][neighbours[:3] < len(owner)]].tolist()) == [0] * 4 + list(range(1, 21))


@settings(max_examples=60, deadline=None, derandomize=True)
@given(**maps)
def test_distances_equal_scipy(rows: int, cols: int, density: float, seed: int, rule: CornerRule) -> None:
    short = Abstraction.of(an.Terrain.of(random_grid(rows, cols, density, seed), rule), 4).crossings
    _, _, _, neighbours, lengths, _ = grid_kernels.region_table(short.first, short.other, short.length)
    count = len(neighbours)
    if count == 0:
        return
    i, k = np.nonzero(neighbours < count)
    matrix = coo_array((lengths[i, k] + 1e-12, (i, neighbours[i, k])), shape=(count, count)).tocsr()
    np.testing.assert_allclose(grid_kernels.distances(neighbours, lengths, 0), dijkstra(matrix, indices=0), atol=1e-9)


def test_ends_lie_where_they_are() -> None:
    """Three blocks in a row: with the ends' own cells, the length along the corridor is exact."""
    short = prepare(an.GridMap(np.zeros((1, 12), np.uint8)), block=4)
    start, goal = 14 + 1, 14 + 12
    graph = short.between(start, goal)
    assert graph.cells[[graph.start, graph.goal]].tolist() == [[0, 0], [0, 11]]
    assert graph.distances_to(graph.goal)[graph.start] == 11
    path = np.array([0, 1, 2], np.int32)
    assert graph.lengths_of([path, path[1:]]).tolist() == [11, graph.distances_to(graph.goal)[1]]
    assert short.stops(path, graph, start, goal).tolist() == [15, 18, 19, 22, 23, 26]
    assert short.crossings.length.tolist() == [4, 4, 4, 4]  # centre to centre, untouched


def test_stops_over_a_chain() -> None:
    """Edges inside a region are no crossings: a comb with ten teeth in the next block is a chain of two nodes."""
    short = prepare(grid_of("." * 20, *[".#" * 10] * 25), "allow", block=20)
    start, goal = 1 * 22 + 1, 26 * 22 + 19
    graph, region = short.between(start, goal), short.crossings.region
    assert (graph.owner == region[start]).sum() == 2
    path, distance = [graph.start], graph.distances_to(graph.goal)
    while path[-1] != graph.goal:
        around = [j for j in graph.graph.neighbours[path[-1]] if j < len(graph) and j not in path]
        path.append(min(around, key=lambda j: distance[j]))
    assert len(path) == 3  # the last tooth hangs on the chain's second node
    stops = short.stops(np.array(path, np.int32), graph, start, goal)
    assert stops[0] == start
    assert stops[-1] == goal
    assert len(stops) % 2 == 0
    for one, other in zip(stops[::2], stops[1::2], strict=True):
        assert region[one] == region[other]


@pytest.mark.parametrize("block", [4, 16, 64, 128])
def test_routes_on_cells_in_blocks_of_any_size(block: int) -> None:
    grid = generate("maze", 260, 140, seed=5)
    problem = an.Problem.from_cells(grid, *ends(grid))
    result = an.solve(problem, an.paco_large(coarse=block, windows=0), seed=1)
    an.check_path(result.path, problem)


def test_values_at_the_cells_of_their_regions() -> None:
    short = prepare(grid_of("....#...", "....#..."), block=4)
    field = short.on_map(np.array([3, 7], np.float32), np.array([0, 1]))
    np.testing.assert_array_equal(field, [[3] * 4 + [np.nan] + [7] * 3] * 2)
    chain = np.array([0, 0, 1])  # of a chain, the first node's
    np.testing.assert_array_equal(short.on_map(np.array([3, 4, 7], np.float32), chain), field)


def test_prepared_once_a_map() -> None:
    grid = an.GridMap(np.zeros((5, 5), np.uint8))
    assert prepare(grid) is not prepare(an.GridMap(np.zeros((5, 5), np.uint8)))
    assert len(pickle.dumps(grid)) < 1000
    assert prepare(pickle.loads(pickle.dumps(grid))) is not prepare(grid)
    assert prepare(grid) is prepare(grid, "forbid", block=16) is Abstraction.of(an.Terrain.of(grid), 16)
    assert prepare(grid) is not prepare(grid, allow_unknown=True)
    assert prepare(grid) is not prepare(grid, "allow")
    assert prepare(grid) is not prepare(grid, block=8)


@pytest.mark.parametrize("block", [4, 128])
def test_the_smallest_and_the_largest_block(block: int) -> None:
    assert prepare(an.GridMap(np.zeros((5, 5), np.uint8)), block=block).block == block


@pytest.mark.parametrize("block", [3, 129, True, 8.0])
def test_a_block_out_of_range(block: int) -> None:
    with pytest.raises(ParameterError, match="4 to 128"):
        prepare(an.GridMap(np.zeros((5, 5), np.uint8)), block=block)


def test_what_is_prepared() -> None:
    with pytest.raises(ParameterError, match="GridMap"):
        prepare("warehouse")
    assert repr(prepare(grid_of("....", "...."), block=4)) == "Abstraction(1 regions, 0 crossings, blocks of 4 cells)"


def test_map_without_a_move() -> None:
    assert len(prepare(grid_of("#.#"))) == 0
    assert prepare(grid_of("#.#")).crossings.other.tolist() == []


def test_cells_that_the_map_does_not_connect() -> None:
    grid = grid_of("..#.", "..#.", "####", "...#")
    short = prepare(grid, block=4)
    here, there, alone = (1 * 6 + 1, 1 * 6 + 4, 4 * 6 + 1)
    assert short.between(here, there) is None
    assert short.between(here, alone) is None
    assert short.between(here, 3 * 6 + 1) is None  # an obstacle
    assert short.between(here, 2 * 6 + 2) is not None


def test_a_region_costs_what_its_cheap_corridor_does() -> None:
    """Blocks of 16: a row that costs nothing leads through regions that cost 9 a metre elsewhere."""
    values = np.full((32, 64), 9.0)
    values[8] = 0.0
    grid = an.GridMap(np.zeros(values.shape, np.uint8))
    abstraction = prepare(grid, cost=an.costs.array(values))
    upper, lower = (abstraction.crossings.region.reshape(34, 66)[row, 1] for row in (8, 24))
    assert abstraction.crossings.price[[upper, lower]].tolist() == [1.0, 10.0]
    problem = an.Problem.from_cells(grid, (8, 0), (24, 63), cost=an.costs.array(values))
    graph = abstraction.between(*problem.flat_ends)
    assert graph is not None
    route = graph.distances_to(graph.goal)[graph.start]
    assert route == pytest.approx(an.exact.shortest_path(problem).cost, rel=0.25)
