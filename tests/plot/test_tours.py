"""A tour is drawn with its legs in order, its stops by their numbers, and arrows along it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import antnav as an
from antnav.errors import ParameterError
from antnav.plot.tours import arrows, save_tour
from tests.conftest import grid_of
from tests.plot.samples import texts

pytest.importorskip("matplotlib").use("Agg")

GRID = grid_of("..........", "....##....", "....##....", "..........", "..........")
TOUR = an.tour(GRID, (2, 0), [(0, 9), (4, 9), (4, 0)], cells=True, return_to_start=True)


def test_legs_and_stops_are_drawn_where_they_lie() -> None:
    ax = an.plot_tour(TOUR)
    drawn = [line.get_xydata() for line in ax.lines]
    for leg in TOUR.legs:
        assert any(np.array_equal(leg.path.points, points) for points in drawn)
    numbers = {text.get_text(): text.get_position() for text in ax.texts if text.get_text()}
    assert numbers == {str(number): TOUR.places[number] for number in (1, 2, 3)}
    assert ax.get_title() == f"found: 3 stops on 5 x 10 cells, {TOUR.length_m:.2f} m\nno order is better"
    assert "dynamic programming" in texts(ax.figure)


def test_the_legs_grow_darker() -> None:
    ax = an.plot_tour(TOUR)
    shades = [sum(line.get_color()[:3]) for line in ax.lines if len(line.get_xydata()) > 1]
    assert len(shades) == 4
    assert shades == sorted(shades, reverse=True)


def test_arrows_point_along_the_way() -> None:
    points = np.array([(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (3.0, 0.0), (3.0, 1.0), (3.0, 2.0), (3.0, 3.0)])
    found = arrows(points, 2.0)
    assert len(found) == 3
    for place, way in found:
        (at,) = np.flatnonzero((points == place).all(axis=1))
        assert way.tolist() == (points[at + 1] - points[at]).tolist()
    assert arrows(points[:1], 1.0) == []
    assert arrows(points[:2], 9.0) == []


def test_many_stops_have_no_numbers_and_a_tour_that_ends_elsewhere_says_where() -> None:
    cells = [(int(row), int(col)) for row, col in np.argwhere(GRID.passable())] * 2
    many = an.plot_tour(an.tour(GRID, (2, 0), cells[:61], cells=True))
    assert not [text for text in many.texts if text.get_text()]


def test_what_was_not_found_is_said() -> None:
    none = an.tour(grid_of("..#..", "..#.."), (0, 0), [(0, 4), (1, 1)], cells=True)
    ax = an.plot_tour(none)
    assert ax.get_title() == "unreachable: 2 stops on 2 x 5 cells"
    assert none.notes[0] in texts(ax.figure).replace("\n", " ")


def test_it_is_saved_with_its_trajectory_the_same_each_time(tmp_path: Path) -> None:
    for name in ("one.svg", "other.svg"):
        save_tour(TOUR, tmp_path / name, trajectory=TOUR.trajectory())
    assert (tmp_path / "one.svg").read_bytes() == (tmp_path / "other.svg").read_bytes()
    with pytest.raises(ParameterError, match="pictures end in"):
        save_tour(TOUR, tmp_path / "tour.gif")
    with pytest.raises(ParameterError, match=r"call an\.tour"):
        an.plot_tour("tour")
