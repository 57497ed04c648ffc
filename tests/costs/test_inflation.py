from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as npst

import antnav as an
from antnav import costs
from antnav.errors import ParameterError
from tests.conftest import grid_of


def nav2_cost(cells: float, resolution: float, scaling: float, inscribed: float) -> int:
    """What nav2 writes into its costmap at a distance in cells, as its documentation says it."""
    if cells == 0:
        return 254
    if cells * resolution <= inscribed:
        return 253
    return int(252 * math.exp(-scaling * (cells * resolution - inscribed)))


def test_the_curve_by_hand() -> None:
    field = costs.inflation(an.GridMap([[1, 0, 0, 0, 0]], resolution=0.5), 1.5, 2.0, 0.5, weight=6.0)
    np.testing.assert_allclose(field.values, [[6.0, 6.0, 6 * math.exp(-1), 6 * math.exp(-2), 0.0]])
    assert not field.blocked.any()


def test_the_radius_is_rounded_up_to_whole_cells() -> None:
    assert np.count_nonzero(costs.inflation(grid_of("#....."), 2.1, 1.0, 0.0).values) == 4


@given(
    npst.arrays(np.uint8, npst.array_shapes(min_dims=2, max_dims=2, max_side=7), elements=st.integers(0, 3)),
    st.sampled_from([0.05, 1.0]),
    st.sampled_from([1.0, 3.0, 10.0]),
    st.sampled_from([0.0, 0.1, 0.22, 2.0]),
)
def test_costs_are_those_of_nav2_before_they_are_cut(
    cells: np.ndarray, resolution: float, scaling: float, inscribed: float
) -> None:
    field = costs.inflation(an.GridMap(cells, resolution), 0.55, scaling, inscribed, weight=252.0)
    walls = np.argwhere(cells == an.Cell.OCCUPIED)
    for (row, col), value in np.ndenumerate(field.values):
        nearest = min((math.hypot(row - r, col - c) for r, c in walls), default=math.inf)
        wanted = 0 if nearest > math.ceil(0.55 / resolution) else nav2_cost(nearest, resolution, scaling, inscribed)
        assert min(wanted, 252) - 1e-9 <= value < min(wanted, 252) + 1


def test_no_walls_no_costs() -> None:
    assert not costs.inflation(grid_of("..?"), 1.0, 1.0, 0.5).values.any()


@pytest.mark.parametrize(
    "wrong",
    [
        *({"inflation_radius": radius} for radius in (0, math.nan)),
        *({"inscribed_radius": radius} for radius in (-1, math.nan)),
        {"cost_scaling_factor": -1},
        {"weight": 1e308},
        {"grid": None},
    ],
)
def test_other_numbers_are_refused(wrong: dict[str, object]) -> None:
    good = {"grid": grid_of("#."), "inflation_radius": 0.55, "cost_scaling_factor": 10.0, "inscribed_radius": 0.2}
    with pytest.raises(ParameterError, match=next(iter(wrong))):
        costs.inflation(**good | wrong)  # type: ignore[arg-type]


@pytest.mark.parametrize("radius", [5e-324, 1e308])
def test_radii_at_the_ends_of_the_range(radius: float) -> None:
    assert costs.inflation(an.GridMap([[1, 0]], 1e-10), radius, 0.0, 0.0).values.tolist() == [[1.0, 1.0]]
