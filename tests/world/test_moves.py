"""Corner rules, cell by cell."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

from antnav.errors import ParameterError
from antnav.world.moves import STEPS, CornerRule, legal_moves, octile
from tests.conftest import grid_of


@pytest.mark.parametrize(("rule", "needed"), [("allow", 0), ("graze", 1), ("forbid", 2)])
def test_a_diagonal_needs_as_many_free_sides_as_the_rule_says(rule: str, needed: int) -> None:
    for a, b in itertools.product(".#", repeat=2):
        grid = grid_of("." + a, b + ".")
        moves = legal_moves(grid.passable(), CornerRule(rule))
        down_right = bool(moves[1, 1] >> STEPS.index((1, 1)) & 1)
        assert down_right == ((a == ".") + (b == ".") >= needed)


def test_moves_stay_inside_and_go_both_ways() -> None:
    cells = np.random.default_rng(3).random((15, 11)) < 0.7
    for rule in CornerRule:
        moves = legal_moves(cells, rule)
        assert not moves[[0, -1]].any()
        assert not moves[:, [0, -1]].any()
        for row, col in np.argwhere(moves):
            for k, (down, right) in enumerate(STEPS):
                if moves[row, col] >> k & 1:
                    assert cells[row + down - 1, col + right - 1]
                    assert moves[row + down, col + right] >> (7 - k) & 1


def test_octile_is_the_length_without_obstacles() -> None:
    lengths = octile(np.array([0, -3, 2, 4]), np.array([5, 3, -1, 4]))
    np.testing.assert_allclose(lengths, [5, 3 * math.sqrt(2), 1 + math.sqrt(2), 4 * math.sqrt(2)])


def test_unknown_rule() -> None:
    with pytest.raises(ParameterError, match="allow, graze, forbid"):
        CornerRule.of("sometimes")
