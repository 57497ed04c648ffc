"""What a prompt and a notebook show of maps, paths and results: short, with sizes, escaped."""

from __future__ import annotations

import base64
import io
import re
from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pytest
from PIL import Image

import antnav as an
from antnav import rivals
from antnav.markup import MOST_PIXELS, map_html
from tests.conftest import grid_of

BAD = "<script>alert(1)</script>&\x00\x1b'"


@pytest.fixture(scope="module")
def result() -> an.Result:
    start, goal = an.maps.builtin_query("equiv20")
    problem = an.Problem.from_cells(replace(an.maps.builtin("equiv20"), name=BAD), start, goal)
    return an.solve(problem, an.npaco(ants=10, iterations=10), seed=3)


def picture_of(text: str) -> np.ndarray:
    found = re.search(r"data:image/png;base64,([^\"]+)", text)
    assert found
    return np.asarray(Image.open(io.BytesIO(base64.b64decode(found[1]))))


def test_reprs_are_short_and_tell_sizes(result: an.Result) -> None:
    assert result.path is not None
    large = an.maps.builtin("warehouse")
    problem = an.Problem.from_cells(large, *an.maps.builtin_query("warehouse"))
    far = an.solve(problem, an.paco_large(), seed=0)
    rival = an.solve(problem, rivals.PotentialField(escapes=0))
    for one in (result, result.path, result.problem.grid, far, far.path, rival, large):
        assert len(repr(one)) < 400
    assert repr(large) == ("GridMap('warehouse', 400 x 600 cells, resolution=0.05, origin=(-2.0, -3.0, 0.0))")
    assert f"{len(far.path)} cells, (" in repr(far.path)
    assert "seed=3, 10 iterations" in repr(result)
    assert repr(an.Path([], large)).startswith("Path(0 cells, length=")


def test_a_repr_searches_nothing() -> None:
    problem = an.Problem.from_cells(grid_of("...", "..."), (0, 0), (1, 2))
    found = an.solve(problem, an.npaco(ants=2, iterations=2))
    repr(found)
    assert "_exact" not in vars(found)


def test_notebooks_get_well_formed_and_escaped_html(result: an.Result) -> None:
    for one in (result, result.path, result.problem.grid):
        text = one._repr_html_()
        ElementTree.fromstring(f"<div>{text}</div>")
        assert "<script" not in text
        assert all(letter.isprintable() for letter in text)
    text = result._repr_html_()
    assert "<th>gap</th>" in text
    assert text.count("<polyline") == 1
    assert "<polyline" not in result.problem.grid._repr_html_()


def test_a_result_without_a_path_has_html_too() -> None:
    problem = an.Problem.from_cells(grid_of(".#.", ".#."), (0, 0), (0, 2))
    assert "unreachable" in an.solve(problem)._repr_html_()


def test_the_picture_is_the_map_and_thin_walls_stay_in_small_pictures_of_large_maps() -> None:
    shown = picture_of(map_html(grid_of(".#?", "...").cells, ""))
    assert shown.shape == (2, 3)
    assert shown[0, 1] < shown[0, 2] < shown[0, 0] == 255
    cells = np.zeros((50, 5 * MOST_PIXELS + 3), np.uint8)
    cells[:, 777] = 1
    shown = picture_of(map_html(cells, ""))
    assert max(shown.shape) <= MOST_PIXELS
    assert (shown[:, 777 // 6] < 255).all()
    assert (np.delete(shown, 777 // 6, axis=1) == 255).all()
    assert len(map_html(cells, "")) < 5000
