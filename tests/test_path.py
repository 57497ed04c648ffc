"""Path: measures by hand, and a check that finds every kind of fault."""

from __future__ import annotations

import math

import numpy as np
import pytest

import antnav as an
from antnav.errors import PathError
from antnav.path import Path
from tests.conftest import grid_of

GRID = an.GridMap(grid_of("....", ".#..", "....").cells, resolution=0.5)
CELLS = [(0, 0), (1, 0), (2, 1), (2, 2), (1, 3)]


def test_measures_by_hand() -> None:
    path = Path(CELLS, GRID)
    assert path.length == 2 + 2 * math.sqrt(2)
    assert path.length_m == path.length / 2
    assert path.turns == 3
    assert path.turning_angle == pytest.approx(3 * math.pi / 4)
    assert path.clearance == pytest.approx(0.5)  # (1, 0) is one cell from the obstacle
    np.testing.assert_allclose(path.points[0], (0.25, 1.25))
    np.testing.assert_allclose(path.headings, [-math.pi / 2, -math.pi / 4, 0, math.pi / 4, math.pi / 4])


def test_ends_are_exactly_start_and_goal() -> None:
    path = Path(CELLS, GRID, start=(0.3, 1.3), goal=(1.6, 0.8))
    assert tuple(path.points[0]) == (0.3, 1.3)
    assert tuple(path.points[-1]) == (1.6, 0.8)


def test_a_path_of_one_cell() -> None:
    path = Path([(0, 0)], GRID)
    assert (path.length, path.turns, path.turning_angle, len(path.headings)) == (0, 0, 0, 1)


def test_clearance_without_obstacles_is_infinite() -> None:
    assert Path([(0, 0), (0, 1)], grid_of("..")).clearance == math.inf


def test_a_good_path_passes_and_its_length_is_added_up_anew() -> None:
    problem = an.Problem.from_cells(GRID, (0, 0), (1, 3), corner_rule="graze")
    assert an.check_path(CELLS, problem) == pytest.approx(2 + 2 * math.sqrt(2))


@pytest.mark.parametrize(
    ("cells", "rule", "message"),
    [
        ([], "allow", "must lead from"),
        (CELLS[1:], "allow", "must lead from"),
        (CELLS[:-1], "allow", "must lead from"),
        ([(0, 0), (1, 1), (1, 2), (1, 3)], "allow", "not free"),
        ([(0, 0), (-1, 1), (0, 2), (1, 3)], "allow", "outside"),
        ([(0, 0), (0, 2), (1, 3)], "allow", "not neighbours"),
        ([(0, 0), (0, 0), (0, 1), (0, 2), (1, 3)], "allow", "not neighbours"),
        (CELLS, "forbid", "cuts a corner"),
    ],
)
def test_every_fault_is_found(cells: list, rule: str, message: str) -> None:
    problem = an.Problem.from_cells(GRID, (0, 0), (1, 3), corner_rule=rule)
    with pytest.raises(PathError, match=message):
        an.check_path(cells, problem)


def test_squeezing_between_two_obstacles_needs_allow() -> None:
    grid = grid_of(".#", "#.")
    an.check_path([(0, 0), (1, 1)], an.Problem.from_cells(grid, (0, 0), (1, 1), corner_rule="allow"))
    with pytest.raises(PathError, match="corner"):
        an.check_path([(0, 0), (1, 1)], an.Problem.from_cells(grid, (0, 0), (1, 1), corner_rule="graze"))


def test_a_false_length_is_found() -> None:
    problem = an.Problem.from_cells(GRID, (0, 0), (1, 3), corner_rule="graze")
    path = Path(CELLS, GRID)
    path.__dict__["length"] = 3.0
    with pytest.raises(PathError, match="add up to"):
        an.check_path(path, problem)
