from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as npst

import antnav as an
from antnav import costs
from antnav.costs.walls import distance_to_edges
from antnav.errors import ParameterError
from tests.conftest import grid_of


def naive_distance(grid: an.GridMap, row: int, col: int) -> float:
    """Metres from the centre of a cell to the nearest point of an occupied square."""
    return min(
        (
            math.hypot(max(abs(row - r) - 0.5, 0.0), max(abs(col - c) - 0.5, 0.0)) * grid.resolution
            for r, c in np.argwhere(grid.cells == an.Cell.OCCUPIED)
        ),
        default=math.inf,
    )


def test_cells_cost_the_more_the_nearer_the_wall_is() -> None:
    field = costs.clearance(grid_of("#....", "....."), 2.0, weight=4.0)
    aside = math.hypot(0.5, 0.5)
    np.testing.assert_allclose(
        field.values,
        [
            [4.0, 3.0, 1.0, 0.0, 0.0],  # 4 (1 - 0.5 / 2), 4 (1 - 1.5 / 2), and nothing from 2 m on
            [3.0, 4 - 2 * aside, 4 - 2 * math.hypot(1.5, 0.5), 0.0, 0.0],
        ],
    )
    assert not field.blocked.any()


def test_with_a_decay_they_fall_exponentially_up_to_the_radius() -> None:
    field = costs.clearance(an.GridMap([[1, 0, 0, 0]], resolution=0.5), 1.0, 3.0, decay=2.0)
    np.testing.assert_allclose(field.values, [[3.0, 3 * math.exp(-0.5), 3 * math.exp(-1.5), 0.0]])


def test_only_occupied_cells_are_walls() -> None:
    for grid in (grid_of("...", "..."), an.GridMap([[2, 0, 3]])):
        assert not costs.clearance(grid, 5.0).values.any()
        assert not costs.clearance(grid, 1e308, decay=0.0).values.any()


GRIDS = npst.arrays(np.uint8, npst.array_shapes(min_dims=2, max_dims=2, max_side=7), elements=st.integers(0, 2))


@given(GRIDS, st.sampled_from([1.0, 0.05, 3.0]), st.floats(0.1, 12.0))
def test_distances_are_to_the_edges_of_squares(cells: np.ndarray, resolution: float, reach: float) -> None:
    grid = an.GridMap(cells, resolution)
    found = distance_to_edges(grid, reach * resolution)
    for (row, col), distance in np.ndenumerate(found):
        true = naive_distance(grid, row, col)
        if true < reach * resolution:
            assert distance == pytest.approx(true)
        else:
            assert distance >= reach * resolution * (1 - 1e-12)


@given(GRIDS, st.floats(0.1, 12.0), st.floats(0.0, 9.0), st.none() | st.floats(0.0, 9.0))
def test_costs_are_from_0_to_the_weight(cells: np.ndarray, radius: float, weight: float, decay: float | None) -> None:
    grid = an.GridMap(cells)
    values = costs.clearance(grid, radius, weight, decay).values
    assert values.min() >= 0
    assert values.max() <= weight
    assert (values[grid.cells == an.Cell.OCCUPIED] == weight).all()


def test_clearance_of_a_path_and_of_a_field_agree() -> None:
    grid = an.maps.builtin("warehouse")
    distance = distance_to_edges(grid, 50.0)
    for cell in ((375, 45), (20, 575), (200, 300)):
        assert distance[cell] == pytest.approx(an.Path([cell], grid).wall_distance)


@pytest.mark.parametrize(
    "wrong",
    [
        *({"radius": radius} for radius in (0, -1.0, math.nan, math.inf, "1")),
        *({"weight": weight} for weight in (1e308, -1, math.nan)),
        *({"decay": decay} for decay in (-0.1, math.inf)),
        {"grid": 7},
    ],
)
def test_other_numbers_are_refused(wrong: dict[str, object]) -> None:
    with pytest.raises(ParameterError, match=next(iter(wrong))):
        costs.clearance(**{"grid": grid_of("#.."), "radius": 1.0} | wrong)  # type: ignore[arg-type]


@pytest.mark.parametrize("radius", [5e-324, 1e308])
def test_radii_at_the_ends_of_the_range(radius: float) -> None:
    grid = an.GridMap([[1, 0]], resolution=1e-10)
    assert costs.clearance(grid, radius).values.tolist() == [[1.0, 0.0 if radius < 1 else 1.0]]
