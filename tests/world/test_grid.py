"""GridMap: immutability, the three coordinate systems, inflation."""

from __future__ import annotations

import math
import pickle

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

import antnav as an
from antnav.errors import MapError, MapSizeError, ParameterError
from antnav.world.grid import MAX_CELLS, check_size
from antnav.world.moves import STEPS
from tests.conftest import grid_of


def test_cells_are_copied_and_cannot_be_written() -> None:
    source = np.zeros((2, 3), np.uint8)
    grid = an.GridMap(source)
    source[:] = 1
    assert grid.counts() == {"free": 6, "occupied": 0, "unknown": 0, "inflated": 0}
    with pytest.raises(ValueError, match="read-only"):
        grid.cells[0, 0] = 1
    with pytest.raises(ValueError, match="read-only"):
        pickle.loads(pickle.dumps(grid)).cells[0, 0] = 1


def test_equality_and_digest_follow_cells_and_place() -> None:
    grid = grid_of(".#", "..")
    assert grid == grid_of(".#", "..")
    assert hash(grid) == hash(grid_of(".#", ".."))
    others = [grid_of("..", ".."), an.GridMap(grid.cells, 0.5), an.GridMap(grid.cells, origin=(1, 0, 0))]
    assert all(other != grid and other.digest != grid.digest for other in others)
    assert grid != "a map"
    assert pickle.loads(pickle.dumps(grid)) == grid


@pytest.mark.parametrize(
    ("arguments", "error"),
    [
        ((np.zeros(3),), MapError),
        ((np.zeros((0, 3), np.uint8),), MapSizeError),
        ((np.full((2, 2), 7),), MapError),
        ((np.full((2, 2), -1),), MapError),
        ((np.zeros((2, 2)),), MapError),
        ((np.zeros((2, 2), bool), 0.0), MapError),
        ((np.zeros((2, 2), bool), math.nan), MapError),
        ((np.zeros((2, 2), bool), "wide"), MapError),
        ((np.zeros((2, 2), bool), 1.0, (0, 0)), MapError),
        ((np.zeros((2, 2), bool), 1.0, (0, 0, math.inf)), MapError),
        (([[0, 1], [0]],), MapError),
        (([["0", "1"]],), MapError),
        (([[0, None]],), MapError),
        (([[0, 10**400]],), MapError),
        ((None,), MapError),
        (("a map",), MapError),
        ((object(),), MapError),
        (({},), MapError),
        ((np.zeros((2, 2), bool), 10**400), MapError),
        ((np.zeros((2, 2), bool), 10**5000), MapError),
        ((np.zeros((2, 2), bool), None), MapError),
        ((np.zeros((2, 2), bool), []), MapError),
        ((np.zeros((2, 2), bool), 1.0, None), MapError),
        ((np.zeros((2, 2), bool), 1.0, 5), MapError),
        ((np.zeros((2, 2), bool), 1.0, (0, 0, None)), MapError),
        ((np.zeros((2, 2), bool), 1.0, (0, 0, 10**400)), MapError),
        ((np.zeros((2, 2), bool), 1.0, (0, 0, 0), 5), MapError),
        ((np.zeros((2, 2), bool), 1.0, (0, 0, 0), None), MapError),
        ((np.zeros((2, 2), bool), 0.05, (1e15, 0, 0)), MapError),
        ((np.zeros((2, 2), bool), 0.05, (0, -1e15, 0)), MapError),
        ((np.zeros((2, 2), bool), 1e308), MapError),
    ],
)
def test_bad_maps_are_refused_with_a_remedy(arguments: tuple, error: type[MapError]) -> None:
    with pytest.raises(error) as caught:
        an.GridMap(*arguments)
    assert caught.value.given
    assert caught.value.rule
    assert caught.value.remedy


def test_numpy_scalars_are_numbers() -> None:
    grid = an.GridMap([[0, 1]], np.float32(0.5), (np.int64(1), np.float16(2), np.array(0.0)), np.str_("name"))
    assert grid == an.GridMap([[0, 1]], 0.5, (1.0, 2.0, 0.0))
    assert grid.number_to_cell(np.int64(2)) == (0, 1)
    assert grid.contains((np.int8(0), np.uint16(1)))


@pytest.mark.parametrize("dtype", [bool, np.uint8, np.int64])
def test_what_is_masked_is_unknown(dtype: type) -> None:
    cells = np.ma.masked_array(np.array([[0, 1, 1]], dtype), mask=[[False, False, True]])
    assert an.GridMap(cells).cells.tolist() == [[0, 1, 2]]
    hidden = np.ma.masked_equal([[0, 1, -9999]], -9999)
    assert an.GridMap(hidden).cells.tolist() == [[0, 1, 2]]
    with pytest.raises(MapError):
        an.GridMap(np.ma.masked_equal([[0.5, 1.0]], 1.0))


def test_places_that_double_precision_cannot_tell_apart_are_refused_with_the_reason() -> None:
    with pytest.raises(MapError, match=r"0\.125 m apart in double precision.*nearer point"):
        an.GridMap(np.zeros((3, 3), bool), 0.05, (1e15, 0.0, 0.0))
    utm = an.GridMap(np.zeros((3, 3), bool), 0.05, (5e5, 9e6, 0.3))  # metres of a map projection are no trouble
    assert tuple(utm.world_to_cell(utm.cell_to_world((2, 1)))) == (2, 1)


@given(power=st.floats(5, 16), resolution=st.floats(0.001, 10), yaw=st.floats(-4, 4), row=st.integers(0, 29))
def test_every_cell_of_an_accepted_place_is_told_apart(power: float, resolution: float, yaw: float, row: int) -> None:
    try:
        grid = an.GridMap(np.zeros((30, 30), bool), resolution, (10**power, -(10**power), yaw))
    except MapError:
        return
    cells = [(row, col) for col in range(30)]
    np.testing.assert_array_equal(grid.world_to_cell(grid.cell_to_world(cells)), cells)


@pytest.mark.parametrize(
    "wrong",
    [None, "a", 5, [], [1], [1, 2, 3], [None, 1], {}, object(), [[0, 0], [1]]],
    ids=lambda each: str(each).split(" at ")[0],
)
@pytest.mark.parametrize(
    "method", ["cell_to_world", "world_to_cell", "cell_to_number", "number_to_cell", "number_to_paper", "contains"]
)
def test_wrong_arguments_of_methods(method: str, wrong: object) -> None:
    grid = an.GridMap(np.zeros((2, 2), bool))
    if wrong != 5 or "number_to" not in method:
        with pytest.raises(ParameterError):
            getattr(grid, method)(wrong)


def test_sizes_are_refused_before_memory_is_asked_for() -> None:
    with pytest.raises(MapSizeError, match="1000000000"):
        check_size(10**4, 10**5)
    check_size(1, MAX_CELLS)


def test_paper_numbering_eq_2_1() -> None:
    # Printed in the paper: the 20x20 map runs from (0.5, 19.5), cell 1, to (19.5, 0.5), cell 400.
    grid = an.GridMap(np.zeros((20, 20), bool))
    assert grid.number_to_paper(1) == (0.5, 19.5)
    assert grid.number_to_paper(20) == (19.5, 19.5)  # mod(n, N) = 0
    assert grid.number_to_paper(400) == (19.5, 0.5)
    assert grid.number_to_cell(189) == (9, 8)
    assert grid.number_to_paper(189) == (8.5, 10.5)
    for number in (0, 401, True, 1.0):
        with pytest.raises(ParameterError):
            grid.number_to_cell(number)
    with pytest.raises(ParameterError):
        grid.cell_to_number((20, 0))
    for cell in ((0.5, 0.7), (0, True), (1, "2")):
        with pytest.raises(ParameterError, match="two whole numbers"):
            grid.cell_to_number(cell)
    assert grid.cell_to_number((np.int32(1), np.uint8(1))) == 22


@given(rows=st.integers(1, 40), cols=st.integers(1, 40), data=st.data())
def test_paper_numbers_agree_with_the_formula(rows: int, cols: int, data: st.DataObject) -> None:
    grid = an.GridMap(np.zeros((rows, cols), bool))
    n = data.draw(st.integers(1, rows * cols))
    x = n % cols - 0.5 if n % cols else cols - 0.5
    y = rows + 0.5 - math.ceil(n / cols)
    assert grid.number_to_paper(n) == (x, y)
    assert tuple(grid.cell_to_world(grid.number_to_cell(n))) == (x, y)  # the default world frame is the paper's
    assert grid.cell_to_number(grid.number_to_cell(n)) == n


@given(
    resolution=st.floats(0.01, 10),
    origin=st.tuples(st.floats(-100, 100), st.floats(-100, 100), st.floats(-7, 7)),
    row=st.integers(-5, 30),
    col=st.integers(-5, 30),
)
def test_world_and_cells_are_inverse_for_any_pose(resolution: float, origin: tuple, row: int, col: int) -> None:
    grid = an.GridMap(np.zeros((20, 25), bool), resolution, origin)
    point = grid.cell_to_world((row, col))
    assert tuple(grid.world_to_cell(point)) == (row, col)


def test_world_frame_by_hand() -> None:
    # 0.5 m cells, origin (10, 20), turned by 90 degrees: the map's x axis points along the world's y.
    grid = an.GridMap(np.zeros((2, 3), bool), 0.5, (10.0, 20.0, math.pi / 2))
    np.testing.assert_allclose(grid.cell_to_world((1, 0)), (9.75, 20.25))  # bottom left cell
    np.testing.assert_allclose(grid.cell_to_world((0, 2)), (9.25, 21.25))
    np.testing.assert_array_equal(grid.world_to_cell([(9.75, 20.25), (9.25, 21.25)]), [(1, 0), (0, 2)])


@pytest.mark.parametrize("point", [(1e300, 0), (0, -1e300), (1.7e308, 1.7e308), (2.0**53, 0)])
@pytest.mark.parametrize("yaw", [0.0, 0.7])
def test_a_point_too_far_away_for_a_cell_is_refused(point: tuple, yaw: float, recwarn: pytest.WarningsRecorder) -> None:
    grid = an.GridMap(np.zeros((2, 3), bool), 0.5, (10.0, 20.0, yaw))
    for points in (point, [(10.1, 20.1), point]):
        with pytest.raises(ParameterError, match="so far away"):
            grid.world_to_cell(points)
    assert tuple(an.GridMap(np.zeros((2, 3), bool)).world_to_cell((2.0**50, 0.5))) == (1, 2**50)
    assert not recwarn.list


def test_corners_by_hand() -> None:
    grid = an.GridMap(np.zeros((2, 3), bool), 0.5, (10.0, 20.0, 0.0))
    np.testing.assert_allclose(grid.corners(), [(10, 20), (10, 21), (11.5, 21), (11.5, 20)])
    turned = an.GridMap(np.zeros((2, 3), bool), 0.5, (10.0, 20.0, math.pi / 2))
    np.testing.assert_allclose(turned.corners(), [(10, 20), (9, 20), (9, 21.5), (10, 21.5)])


@given(
    cells=arrays(
        np.uint8, st.tuples(st.integers(1, 12), st.integers(1, 12)), elements=st.sampled_from([0, 0, 0, 1, 2])
    ),
    radius=st.sampled_from([0.0, 0.05, 0.1, 0.15, 0.2, 0.3]),
)
def test_inflation_equals_brute_force(cells: np.ndarray, radius: float) -> None:
    grid = an.GridMap(cells, resolution=0.1)
    walls = np.argwhere(cells == an.Cell.OCCUPIED)
    inflated = grid.inflated(radius)
    for cell in np.ndindex(cells.shape):
        nearest = min((math.dist(cell, wall) * 0.1 for wall in walls), default=math.inf)
        near = nearest <= radius + 1e-9
        expected = cells[cell] if cells[cell] == an.Cell.OCCUPIED or not near or radius == 0 else an.Cell.INFLATED
        assert inflated.cells[cell] == expected


@given(
    cells=arrays(np.uint8, st.tuples(st.integers(1, 9), st.integers(1, 9)), elements=st.sampled_from([0, 0, 0, 0, 1])),
    radius=st.floats(0.001, 0.6) | st.sampled_from([0.05, 0.15, 0.2, 0.25, 0.3, math.hypot(0.05, 0.15)]),
)
def test_strict_inflation_measures_to_the_edges(cells: np.ndarray, radius: float) -> None:
    grid = an.GridMap(cells, resolution=0.1)
    strict = grid.inflated(radius, strict=True)
    walls = np.argwhere(cells)
    for cell in np.argwhere(cells == 0):
        gaps = np.maximum(np.abs(walls - cell) - 0.5, 0) * 0.1
        nearest = np.hypot(*gaps.T).min(initial=math.inf)
        if abs(nearest - radius) > 1e-9:
            assert (strict.cells[tuple(cell)] == an.Cell.FREE) == (nearest > radius)
        else:  # exactly the radius is kept
            assert strict.cells[tuple(cell)] == an.Cell.FREE
    assert (strict.cells[cells == 1] == an.Cell.OCCUPIED).all()
    assert (strict.passable() <= grid.inflated(radius).passable()).all()


@given(
    cells=arrays(np.uint8, (8, 8), elements=st.sampled_from([0] * 9 + [1])),
    radius=st.floats(0.05, 0.3),
)
def test_moves_between_strictly_open_cells_keep_the_radius(cells: np.ndarray, radius: float) -> None:
    grid = an.GridMap(cells, resolution=0.1)
    moves = an.Terrain.of(grid.inflated(radius, strict=True)).moves[1:-1, 1:-1]
    for cell in np.argwhere(moves).tolist():
        for k, (row, col) in enumerate(STEPS):
            if moves[tuple(cell)] >> k & 1:
                path = an.Path([cell, [cell[0] + row, cell[1] + col]], grid)
                assert path.wall_distance >= radius * (1 - 1e-9)


def test_inflation_starts_from_the_walls_again() -> None:
    grid = grid_of("#....")
    assert grid.inflated(1.0).inflated(1.0) == grid.inflated(1.0)
    assert grid.inflated(1.0).inflated(2.0).counts()["inflated"] == 2
    assert grid.inflated(2.0).passable().sum() == 2


@pytest.mark.parametrize("radius", [-0.1, math.nan, math.inf, "wide", "1", None, True, 10**400, [1.0, 2.0]])
@pytest.mark.parametrize("strict", [False, True])
def test_bad_radius(radius: float, strict: bool) -> None:
    with pytest.raises(ParameterError, match="radius"):
        grid_of("..").inflated(radius, strict=strict)


@pytest.mark.parametrize("radius", [np.float32(1.0), np.int64(1), np.array(1.0)])
def test_numpy_numbers_are_radii(radius: float) -> None:
    assert grid_of("#..").inflated(radius) == grid_of("#..").inflated(1.0)


def test_unknown_is_closed_unless_asked_for() -> None:
    grid = grid_of(".?#")
    assert grid.passable().tolist() == [[True, False, False]]
    assert grid.passable(unknown=True).tolist() == [[True, True, False]]


@pytest.mark.parametrize("place", [{"resolution": "1"}, {"resolution": True}, {"origin": (True, 0, 0)}])
def test_texts_and_truths_are_no_numbers(place: dict) -> None:
    with pytest.raises(MapError, match="finite numbers"):
        an.GridMap([[0, 0]], **place)
