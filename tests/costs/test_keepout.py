from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import antnav as an
from antnav import costs
from antnav.errors import ParameterError
from tests.conftest import grid_of


def test_an_array_blocks_where_it_is_true() -> None:
    field = costs.keepout([[True, False], [False, False]])
    assert field.blocked.tolist() == [[True, False], [False, False]]
    assert not field.values.any()


def test_a_map_blocks_where_it_is_occupied() -> None:
    assert costs.keepout(an.GridMap([[0, 1, 2, 3]])).blocked.tolist() == [[False, True, False, False]]


def test_a_mask_of_finer_cells_is_read_at_the_centres_of_the_map() -> None:
    mask = an.GridMap([[0, 0, 0, 0, 0, 1], [0, 1, 0, 0, 1, 0], [1, 0, 0, 0, 0, 0]], resolution=1.0)
    assert costs.keepout(mask, an.GridMap([[0, 0]], resolution=3.0)).blocked.tolist() == [[True, True]]


def test_a_mask_of_coarser_cells_blocks_all_that_they_cover() -> None:
    mask = an.GridMap([[0, 1], [0, 0]], resolution=2.0)
    blocked = costs.keepout(mask, an.GridMap(np.zeros((4, 4), np.uint8), resolution=1.0)).blocked
    assert np.argwhere(blocked).tolist() == [[0, 2], [0, 3], [1, 2], [1, 3]]


def test_outside_its_mask_a_map_is_free() -> None:
    mask = an.GridMap([[1]], resolution=1.0, origin=(2.0, 1.0, 0.0))
    blocked = costs.keepout(mask, an.GridMap(np.zeros((3, 4), np.uint8))).blocked
    assert np.argwhere(blocked).tolist() == [[1, 2]]


def test_a_mask_may_be_turned() -> None:
    # its columns run up from (2, 0), so that its row is the map's right column
    mask = an.GridMap([[0, 1]], origin=(2.0, 0.0, math.pi / 2))
    assert costs.keepout(mask, an.GridMap(np.zeros((2, 2), np.uint8))).blocked.tolist() == [
        [False, True],
        [False, False],
    ]


def test_a_mask_that_lies_elsewhere_is_refused() -> None:
    with pytest.raises(ParameterError, match="no cell of the map"):
        costs.keepout(an.GridMap([[1]], origin=(9.0, 9.0, 0.0)), grid_of(".."))


@pytest.mark.parametrize("mask", [[[0, 1]], [True, False], [[True], [True, False]], "ab", None, [[0.5]]])
def test_what_is_no_mask_is_refused(mask: object) -> None:
    with pytest.raises(ParameterError, match="mask"):
        costs.keepout(mask)  # type: ignore[arg-type]


def test_an_array_has_the_shape_of_the_map() -> None:
    assert costs.keepout([[True, False]], grid_of("..")).blocked.any()
    with pytest.raises(ParameterError, match="1 x 2 cells: the map has 1 x 3"):
        costs.keepout([[True, False]], grid_of("..."))
    with pytest.raises(ParameterError, match="grid"):
        costs.keepout([[True, False]], "map.yaml")  # type: ignore[arg-type]


@pytest.mark.filterwarnings("ignore::antnav.maps.MapWarning")  # of gray 205 in them
def test_nav2_keepout_mask_of_the_depot(data: Path) -> None:
    folder = data / "ros" / "nav2_bringup"
    depot, mask = (an.load_map(folder / f"{name}.yaml") for name in ("depot", "depot_keepout"))
    field = costs.keepout(mask, depot)
    assert field.blocked.sum() == 31213  # black pixels of depot_keepout.pgm
    assert (field.blocked == costs.keepout(mask).blocked).all()
