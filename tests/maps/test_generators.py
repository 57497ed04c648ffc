import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import ndimage

from antnav import maps
from antnav.errors import MapError, MapSizeError, ParameterError
from antnav.maps.drawing import join_corners
from antnav.world.grid import Cell, GridMap

KINDS = maps.generator_names()
DIGESTS = {
    "random": "8bbc4bd739299763",
    "rooms": "1af61698e9b7b051",
    "maze": "18fd6476aa36d173",
    "caves": "fff147b03a09b0bc",
    "u_traps": "0e624f7524726406",
    "warehouse": "336aef181017a271",
}


def first_and_last(kind, grid):
    """The two cells that `generate` promises to join."""
    if kind in ("random", "u_traps"):
        return (0, 0), (grid.rows - 1, grid.cols - 1)
    free = np.argwhere(grid.cells == Cell.FREE)
    return tuple(free.min(axis=0)), tuple(free.max(axis=0))


@settings(max_examples=300, deadline=None, derandomize=True)
@given(st.sampled_from(KINDS), st.integers(1, 90), st.integers(1, 90), st.integers(0, 2**64))
def test_corners_are_joined(kind, rows, cols, seed):
    try:
        grid = maps.generate(kind, rows, cols, seed)
    except ParameterError as error:
        assert error.remedy.startswith("enlarge the map")
        return
    assert grid.shape == (rows, cols)
    labels, _ = ndimage.label(grid.passable())
    start, goal = first_and_last(kind, grid)
    assert labels[start] == labels[goal] > 0
    start, goal = maps.ends(grid)
    assert labels[start] == labels[goal] > 0


@pytest.mark.parametrize(
    "kind, options",
    [
        ("random", {"density": 0.0}),
        ("random", {"density": 0.9, "block": 3}),
        ("random", {"density": 1}),
        ("rooms", {"room": 5, "door": 20, "closed": 0.0}),
        ("rooms", {"room": 1, "closed": 1.0}),
        ("maze", {"passage": 3, "wall": 2, "loops": 0.2}),
        ("maze", {"loops": 1}),
        ("caves", {"density": 0.6, "steps": 0}),
        ("caves", {"density": 1.0}),
        ("u_traps", {"traps": 150, "size": 3}),
        ("u_traps", {"size": 40}),
        ("warehouse", {"aisle": 3, "clutter": 1}),
        ("warehouse", {"clutter": 0.0}),
    ],
)
@pytest.mark.parametrize("seed", range(3))
def test_options_keep_the_promise(kind, options, seed):
    grid = maps.generate(kind, 40, 61, seed=seed, **options)
    labels, _ = ndimage.label(grid.passable())
    start, goal = first_and_last(kind, grid)
    assert labels[start] == labels[goal] > 0


@pytest.mark.parametrize("kind", KINDS)
def test_the_same_seed_gives_the_same_map_everywhere(kind):
    assert maps.generate(kind, 50, 70, seed=5).digest[:16] == DIGESTS[kind]
    assert maps.generate(kind, 50, 70, seed=6).digest[:16] != DIGESTS[kind]


def test_shares_are_kept():
    counts = maps.generate("random", 300, 300, density=0.25).counts()
    assert abs(counts["occupied"] / 90_000 - 0.25) < 0.01
    blocks = maps.generate("random", 12, 16, density=0.5, block=4, seed=1).cells[4:8].reshape(4, 4, 4)
    assert all(len(np.unique(blocks[:, at])) == 1 for at in range(4))


def test_a_maze_has_one_way_between_any_two_cells():
    grid = maps.generate("maze", 41, 61, seed=2)
    free = grid.passable()
    assert ndimage.label(free)[1] == 1
    joints = np.count_nonzero(free[1:] & free[:-1]) + np.count_nonzero(free[:, 1:] & free[:, :-1])
    assert joints == np.count_nonzero(free) - 1  # a tree


def test_rooms_have_walls_and_doors():
    cells = maps.generate("rooms", 21, 31, room=9, door=2, closed=0.0).cells
    assert (cells[[0, 10, 20]][:, [0, 10, 20, 30]] == Cell.OCCUPIED).all()  # corners of the rooms
    for left in (1, 11, 21):
        assert np.count_nonzero(cells[10, left : left + 9] == Cell.FREE) == 2
    for top in (1, 11):
        assert np.count_nonzero(cells[top : top + 9, 10] == Cell.FREE) == 2
        assert (cells[top : top + 9, 1:10] == Cell.FREE).all()


def test_traps_are_open_to_the_top_or_the_left():
    seen = set()
    for seed in range(8):
        cells = maps.generate("u_traps", 9, 9, traps=1, size=5, seed=seed).cells
        rows, cols = np.nonzero(cells)
        sides = cells[rows.min() : rows.max() + 1, cols.min() : cols.max() + 1]
        if sides[-1].all() and sides[:, -1].all():  # not opened to join the corners
            assert sides[0].all() != sides[:, 0].all()
            seen.add("left" if sides[0].all() else "top")
    assert seen == {"left", "top"}


@pytest.mark.parametrize(
    "kind, options, match",
    [
        ("hills", {}, "random, rooms, maze, caves, u_traps, warehouse"),
        ("random", {"densty": 0.1}, "density=0.3, block=1"),
        ("random", {"density": -0.1}, "from 0 to 1"),
        ("random", {"density": float("nan")}, "from 0 to 1"),
        ("random", {"density": "0.1"}, "from 0 to 1"),
        ("random", {"block": 0}, "from 1 to"),
        ("random", {"block": 2.0}, "whole number"),
        ("random", {"block": True}, "whole number"),
        ("random", {"block": 51}, "from 1 to 50"),
        ("random", {"block": 99999999999999999999}, "from 1 to 50"),
        ("random", {"block": 10**5000}, "enormous"),
        ("rooms", {"door": 99999999999999999999}, "whole number"),
        ("u_traps", {"traps": 1_000_000_000}, "from 1 to 144"),
        ("warehouse", {"aisle": 10**5000}, "whole number"),
        ("rooms", {"room": 0}, "from 1 to"),
        ("rooms", {"door": 0}, "from 1 to"),
        ("rooms", {"room": 60}, "enlarge"),
        ("maze", {"wall": 0}, "from 1 to"),
        ("maze", {"passage": 60}, "enlarge"),
        ("caves", {"steps": -1}, "from 0 to 100"),
        ("caves", {"steps": 101}, "from 0 to 100"),
        ("u_traps", {"size": 2}, "from 3 to 50"),
        ("u_traps", {"size": 51}, "from 3 to 50"),
        ("u_traps", {"traps": -1}, "from 1 to"),
        ("warehouse", {"aisle": 2}, "from 3 to"),
        ("warehouse", {"aisle": 20}, "one rack"),
        ("warehouse", {"clutter": 2}, "from 0 to 1"),
    ],
)
def test_wrong_options(kind, options, match):
    with pytest.raises(ParameterError, match=match):
        maps.generate(kind, 50, 50, **options)


@pytest.mark.parametrize(
    "wrong",
    [
        {"rows": 0},
        {"cols": -1},
        {"rows": 3.5},
        {"seed": -1},
        {"seed": None},
        {"cols": True},
        {"seed": 10**5000},
        {"rows": 10**400},
    ],
)
def test_wrong_sizes_and_seeds(wrong):
    with pytest.raises(ParameterError):
        maps.generate("random", **{"rows": 5, "cols": 5, "seed": 0} | wrong)


def test_a_large_map_is_refused_before_it_is_drawn():
    with pytest.raises(MapSizeError):
        maps.generate("maze", 40_000, 40_000)


def test_ends_of_maps_drawn_by_hand():
    assert maps.ends(GridMap([[0, 0, 0], [0, 1, 0], [0, 0, 0]])) == ((0, 0), (2, 2))
    assert maps.ends(GridMap([[1, 0, 0], [0, 0, 1], [0, 1, 1]])) == ((2, 0), (0, 2))  # along the other diagonal
    assert maps.ends(GridMap([[0, 1, 0, 0]])) == ((0, 2), (0, 3))  # the larger region
    assert maps.ends(GridMap([[1, 0, 2]])) == ((0, 1), (0, 1))
    with pytest.raises(MapError):
        maps.ends(GridMap([[1, 2, 3]]))


def test_join_corners_opens_the_fewest_cells():
    cells = np.array([[0, 1, 0, 0], [0, 1, 1, 0], [0, 1, 1, 0], [0, 0, 1, 0]], dtype=np.uint8)
    join_corners(cells)
    assert cells.sum() == 5  # one of the two cells that separate the halves
    full = np.ones((5, 7), dtype=np.uint8)
    join_corners(full)
    assert np.count_nonzero(full == 0) == 11
    single = np.ones((1, 1), dtype=np.uint8)
    join_corners(single)
    assert single[0, 0] == 0


@settings(max_examples=100, deadline=None, derandomize=True)
@given(st.integers(1, 12), st.integers(1, 12), st.integers(0, 10**6))
def test_join_corners_is_optimal(rows, cols, seed):
    cells = (np.random.default_rng(seed).random((rows, cols)) < 0.6).astype(np.uint8)
    cells[0, 0] = cells[-1, -1] = 0
    before = cells.astype(int)
    fewest = np.full(cells.shape, 10**6)
    fewest[0, 0] = 0
    for _ in range(cells.size):  # Bellman and Ford
        padded = np.pad(fewest, 1, constant_values=10**6)
        around = np.minimum.reduce([padded[:-2, 1:-1], padded[2:, 1:-1], padded[1:-1, :-2], padded[1:-1, 2:]])
        fewest = np.minimum(fewest, around + before)
    join_corners(cells)
    assert before.sum() - cells.sum() == fewest[-1, -1]
