"""Cost fields: what they take, how they add, what stays closed."""

from __future__ import annotations

import copy
import pickle

import numpy as np
import pytest

from antnav.errors import ParameterError
from antnav.world.cost import CostField
from tests.conftest import grid_of

SMALL = CostField([[0, 1, 2], [3, 4, 5]], [[False, True, False], [False, False, False]], "small")


def test_values_are_copied_closed_and_in_rows() -> None:
    given, blocked = np.asfortranarray(np.ones((2, 3))), np.zeros((3, 2), bool).T
    field = CostField(given, blocked)
    given[0, 0], blocked[0, 0] = 7, True
    assert field.values.dtype == np.float64
    assert field.values.tolist() == [[1.0] * 3] * 2
    assert not field.blocked.any()
    for array in (field.values, field.blocked):
        assert array.flags.c_contiguous
        assert not array.flags.writeable


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ([[np.nan]], "cost nan"),
        ([[np.inf]], "cost inf"),
        ([[-1]], r"cost -1\.0"),
        ([[1.1e9]], "cost 1100000000"),
        ([1, 2], "rows and columns"),
        ([[[1]]], "rows and columns"),
        (np.zeros((0, 3)), "rows and columns"),
        ([["a"]], "a number for each cell"),
        ([[1], [1, 2]], "a number for each cell"),
        (None, "a number for each cell"),
        (np.ma.masked_equal([[1, 2]], 2), "masked"),
    ],
)
def test_what_is_no_cost_is_refused(values: object, said: str) -> None:
    with pytest.raises(ParameterError, match=said):
        CostField(values)  # type: ignore[arg-type]


@pytest.mark.parametrize("blocked", [[[True, False]], [[0, 1, 0]] * 2, [[True], [True, False]], "ab", [[True] * 3]])
def test_what_is_no_block_is_refused(blocked: object) -> None:
    with pytest.raises(ParameterError, match="blocked"):
        CostField(np.zeros((2, 3)), blocked)  # type: ignore[arg-type]


def test_fields_add_costs_and_blocks() -> None:
    both = SMALL + CostField(np.full((2, 3), 0.5), [[False] * 3, [True, False, False]], "other")
    assert both.values.tolist() == [[0.5, 1.5, 2.5], [3.5, 4.5, 5.5]]
    assert both.blocked.tolist() == [[False, True, False], [True, False, False]]
    assert both.name == "small + other"
    assert sum([SMALL, both]).values.tolist() == (SMALL + both).values.tolist()
    with pytest.raises(ParameterError, match="shapes"):
        _ = SMALL + CostField([[1]])
    with pytest.raises(TypeError):
        _ = SMALL + 1  # type: ignore[operator]
    with pytest.raises(TypeError):
        _ = 1 + SMALL  # type: ignore[operator]


def test_the_digest_is_of_shape_values_and_blocks() -> None:
    zeros = np.zeros((2, 3))
    fields = [
        CostField(zeros),
        CostField(zeros.T),
        CostField(zeros, SMALL.blocked),
        CostField(zeros + 1),
    ]
    assert len({field.digest for field in fields}) == 4
    assert CostField(-zeros, name="another").digest == CostField(zeros).digest


@pytest.mark.parametrize("again", [copy.deepcopy, lambda field: pickle.loads(pickle.dumps(field))])
def test_a_copy_is_as_closed_as_the_field(again: object) -> None:
    field = again(SMALL)  # type: ignore[operator]
    assert field.digest == SMALL.digest
    assert not field.values.flags.writeable
    assert not field.blocked.flags.writeable


def test_a_field_fits_maps_of_its_shape() -> None:
    SMALL.check_fits(grid_of("...", "..."))
    with pytest.raises(ParameterError, match="2 x 3 cells: the map has 1 x 3"):
        SMALL.check_fits(grid_of("..."))
