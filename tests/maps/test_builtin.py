import pytest
from scipy import ndimage

from antnav import maps
from antnav.errors import ParameterError
from antnav.world.grid import Cell


@pytest.mark.parametrize("name, side, occupied", [("equiv20", 20, 103), ("equiv30", 30, 337), ("equiv40", 40, 690)])
def test_equivalents_of_the_papers_maps(name, side, occupied):
    grid = maps.builtin(name)
    assert grid.shape == (side, side)
    assert grid.counts()["occupied"] == occupied
    assert (grid.name, grid.resolution, grid.origin) == (name, 1.0, (0.0, 0.0, 0.0))


def test_equivalents_are_the_shared_files(shared_data):
    for name in ("equiv20", "equiv30", "equiv40"):
        assert maps.load_map(shared_data / "paper_equivalent" / f"{name}.txt") == maps.builtin(name)


@pytest.mark.parametrize("name", maps.builtin_names())
def test_start_and_goal_are_free(name):
    grid = maps.builtin(name)
    for cell in maps.builtin_query(name):
        assert grid.cells[cell] == Cell.FREE


def test_the_warehouse_has_a_way_for_a_robot():
    grid = maps.builtin("warehouse")
    assert (grid.shape, grid.resolution, grid.origin) == ((400, 600), 0.05, (-2.0, -3.0, 0.0))
    start, goal = maps.builtin_query("warehouse")
    labels, _ = ndimage.label(grid.inflated(0.25).passable())  # four directions: no corner is cut
    assert labels[start] == labels[goal] > 0
    assert abs(start[0] - goal[0]) > 300 and abs(start[1] - goal[1]) > 500
    assert (grid.cells[[0, -1]] == Cell.UNKNOWN).all()
    assert min(grid.counts()[kind] for kind in ("free", "occupied", "unknown")) > 10_000


def test_the_warehouse_is_the_same_everywhere():
    assert maps.builtin("warehouse").digest == "ed6422f8dd63967b2419186373308941ab57916c8be56ce9ad87c454076853ef"


def test_unknown_names():
    for ask in (maps.builtin, maps.builtin_query):
        with pytest.raises(ParameterError, match="equiv20, equiv30, equiv40, warehouse"):
            ask("paper20")
