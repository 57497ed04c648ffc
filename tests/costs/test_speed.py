from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import antnav as an
from antnav import costs, maps
from antnav.errors import ParameterError
from tests.conftest import grid_of


def test_a_metre_costs_the_time_that_it_takes_more_than_at_full_speed() -> None:
    field = costs.speed([[0, 50, 75, 99, 1]])
    np.testing.assert_allclose(field.values, [[0.0, 1.0, 3.0, 99.0, 100 / 99 - 1]])
    assert not field.blocked.any()


def test_unknown_cells_and_limits_of_0_or_less_do_not_limit() -> None:
    assert costs.speed([[-1, 100, 0]]).values.tolist() == [[0.0, 0.0, 0.0]]
    assert costs.speed([[30, 60]], base=50.0).values.tolist() == [[4.0, 0.0]]  # 20 per cent, and -10


def test_a_limit_above_the_full_speed_does_not_limit() -> None:
    assert costs.speed([[1, 100]], base=100.0, multiplier=1.0).values.tolist() == [[0.0, 0.0]]


def test_limits_in_metres_per_second() -> None:
    field = costs.speed([[0, 10, 20, 60]], base=0.0, multiplier=0.01, full_speed=0.4)
    np.testing.assert_allclose(field.values, [[0.0, 3.0, 1.0, 0.0]])


@given(st.integers(-1, 100), st.floats(-200, 200), st.floats(-5, 5))
def test_every_value_as_in_the_documentation_of_nav2(value: int, base: float, multiplier: float) -> None:
    limit = base + multiplier * value
    free = value <= 0 or not 0 < limit <= 100
    if not free and 100 / limit > 1e9:
        return
    wanted = 0.0 if free else 100 / limit - 1
    assert costs.speed([[value]], base=base, multiplier=multiplier).values[0, 0] == pytest.approx(wanted)


def test_grades_are_laid_on_the_map() -> None:
    frame = an.GridMap([[0, 0]], resolution=2.0, origin=(0.0, 2.0, 0.0))
    mask = maps.Grades(np.array([[0, 50]], np.int8), frame)
    assert costs.speed(mask).values.tolist() == [[0.0, 1.0]]
    field = costs.speed(mask, an.GridMap(np.zeros((4, 4), np.uint8)))
    assert np.argwhere(field.values == 1.0).tolist() == [[0, 2], [0, 3], [1, 2], [1, 3]]
    assert field.values.sum() == 4.0


@pytest.mark.parametrize("mask", [[[101]], [[-2]], [[0.5]], [[True]], [50], "ab", None, grid_of("..")])
def test_what_is_no_mask_is_refused(mask: object) -> None:
    with pytest.raises(ParameterError, match="mask"):
        costs.speed(mask)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "wrong",
    [{"base": math.nan}, {"multiplier": math.inf}, {"full_speed": 0}, {"full_speed": "fast"}, {"grid": [[0]]}],
)
def test_other_numbers_are_refused(wrong: dict[str, object]) -> None:
    with pytest.raises(ParameterError, match=next(iter(wrong))):
        costs.speed([[50]], **wrong)  # type: ignore[arg-type]


def test_numbers_at_the_ends_of_the_range() -> None:
    assert costs.speed([[50]], base=1e308, multiplier=1e308).values[0, 0] == 0.0
    with pytest.raises(ParameterError, match="cost"):
        costs.speed([[50]], base=5e-324, multiplier=0.0)


def test_an_array_has_the_shape_of_the_map() -> None:
    assert costs.speed([[50, 0]], grid_of("..")).values.any()
    with pytest.raises(ParameterError, match="the map has 1 x 3"):
        costs.speed([[50, 0]], grid_of("..."))


@pytest.mark.filterwarnings("ignore::antnav.maps.MapWarning")  # of gray 205 in them
def test_nav2_speed_mask_of_the_depot(data: Path) -> None:
    folder = data / "ros" / "nav2_bringup"
    field = costs.speed(maps.load_grades(folder / "depot_speed.yaml"), an.load_map(folder / "depot.yaml"))
    found, counts = np.unique(field.values, return_counts=True)
    np.testing.assert_allclose(found, [0.0, 0.25, 1 / 3, 1.0])  # values 20, 25 and 50 of the mask
    assert counts.tolist() == [123746 + 3735, 4228, 25017, 28702]  # 0 and 100 do not limit
