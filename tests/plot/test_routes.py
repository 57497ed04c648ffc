"""All routes are drawn where they lie, and numbers stand where they lie apart."""

from __future__ import annotations

import numpy as np
import pytest
from PIL import Image

import antnav as an
from antnav import costs
from antnav.errors import ParameterError
from antnav.plot.routes import COLOURS, places, save_alternatives
from tests.conftest import grid_of
from tests.plot.samples import line, texts

pytest.importorskip("matplotlib").use("Agg")

GRID = grid_of("..........", "....##....", "....##....", "..........", "..........")
PROBLEM = an.Problem.from_cells(GRID, (2, 0), (2, 9))


def test_every_route_has_its_line_number_and_length() -> None:
    found = an.alternatives(PROBLEM, 2)
    ax = an.plot_alternatives(found)
    first, second = found
    labels = [f"1: {first.path.length_m:.2f} m"]
    labels += [f"2: {second.path.length_m:.2f} m, +{100 * second.gap:.1f} %, {100 * second.difference:.0f} % different"]
    for number, (label, route) in enumerate(zip(labels, found, strict=True)):
        drawn = line(ax, label)
        np.testing.assert_array_equal(drawn.get_xydata(), route.path.points)
        assert drawn.get_color() == COLOURS[number]
    assert [text.get_text() for text in ax.texts] == ["1", "2"]
    assert ax.get_title() == "found: 2 of 2 routes on 5 x 10 cells"
    assert found.method.split(";")[0] in texts(ax.figure).replace("\n", " ")


def test_numbers_stand_where_routes_lie_apart() -> None:
    found = an.alternatives(PROBLEM, 2)
    for route, place in zip(found, places(found), strict=True):
        assert place in route.path.points
        assert 3 <= place[0] <= 7
    assert [place[1] > 2.5 for place in places(found)] in ([True, False], [False, True])


def test_what_was_not_found_is_said() -> None:
    few = an.alternatives(PROBLEM, 5)
    assert few.notes[0] in texts(an.plot_alternatives(few).figure).replace("\n", " ")
    none = an.alternatives(an.Problem.from_cells(grid_of("..#..", "..#.."), (0, 0), (0, 4)))
    assert an.plot_alternatives(none).get_title() == "unreachable: 0 of 3 routes on 2 x 5 cells"
    one = an.alternatives(an.Problem.from_cells(GRID, (0, 0), (0, 0)))
    assert len(an.plot_alternatives(one).texts) == 1


def test_costs_are_shown() -> None:
    field = costs.array(np.full(GRID.shape, 0.5))
    found = an.alternatives(an.Problem.from_cells(GRID, (2, 0), (2, 9), cost=field), 2)
    said = texts(an.plot_alternatives(found).figure)
    assert f"1: {found[0].path.length_m:.2f} m, cost {found[0].cost:.2f}" in said
    assert "per metre" in said


def test_files(tmp_path) -> None:
    found = an.alternatives(PROBLEM, 2)
    for ending in ("png", "svg", "pdf"):
        save_alternatives(found, tmp_path / f"one.{ending}")
        save_alternatives(found, tmp_path / f"two.{ending}")
    with Image.open(tmp_path / "one.png") as image:
        assert min(image.size) > 300
    for ending in ("svg", "pdf"):
        assert (tmp_path / f"one.{ending}").read_bytes() == (tmp_path / f"two.{ending}").read_bytes()
    with pytest.raises(ParameterError, match="pictures end in"):
        save_alternatives(found, tmp_path / "one.jpg")
    with pytest.raises(ParameterError, match="alternatives"):
        save_alternatives("routes", tmp_path / "one.png")
