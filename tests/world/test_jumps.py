"""Where jumps end, against the definition of forced neighbours and cell by cell."""

from __future__ import annotations

import math
from itertools import product

import numpy as np
import pytest

import antnav as an
from antnav.world.jumps import onward
from antnav.world.moves import STEPS, CornerRule, legal_moves


def neighbours(passable: np.ndarray, rule: CornerRule) -> dict[tuple[int, int], list[tuple[int, int]]]:
    moves = legal_moves(passable, rule)[1:-1, 1:-1]
    return {
        (row, col): [(row + down, col + right) for k, (down, right) in enumerate(STEPS) if moves[row, col] >> k & 1]
        for row, col in np.ndindex(passable.shape)
    }


@pytest.mark.parametrize("rule", CornerRule)
def test_what_may_follow_a_move_is_what_no_other_path_reaches_as_soon(rule: CornerRule) -> None:
    """Harabor and Grastien's definition, on all squares of nine cells with a free one in the middle.

    From p over x to n; after a straight move n is pruned where another way from p to n is as short, after a diagonal
    one where another is shorter.
    """
    seen = 0
    x = (1, 1)
    for around in product((False, True), repeat=8):
        passable = np.insert(np.array(around), 4, True).reshape(3, 3)
        near = neighbours(passable, rule)
        legal = sum(1 << STEPS.index((n[0] - 1, n[1] - 1)) for n in near[x])
        for p in near[x]:
            expected = 0
            for n in near[x]:
                others = [math.dist(p, n)] if n in near[p] else []
                others += [math.dist(p, y) + math.dist(y, n) for y in near[p] if y != x and n in near[y]]
                over = math.dist(p, x) + math.dist(x, n)
                diagonal = p[0] != 1 and p[1] != 1
                pruned = n == p or any(
                    other < over - 1e-9 or (other < over + 1e-9 and not diagonal) for other in others
                )
                expected |= 0 if pruned else 1 << STEPS.index((n[0] - 1, n[1] - 1))
            assert onward(rule)[STEPS.index((1 - p[0], 1 - p[1])), legal] == expected, (passable, p)
            seen += 1
    assert seen > 500


@pytest.mark.parametrize("rule", CornerRule)
@pytest.mark.parametrize("shape", [(1, 1), (5, 62), (62, 5), (63, 140), (130, 64)])
def test_a_bit_tells_where_a_jump_ends(shape: tuple[int, int], rule: CornerRule) -> None:
    cells = (np.random.default_rng(5).random(shape) < 0.3).astype(np.uint8)
    terrain = an.Terrain.of(an.GridMap(cells), rule)
    jumps, moves = terrain.jumps, terrain.moves
    rows, cols = moves.shape
    words = jumps.words.view(np.uint64)
    bits = np.unpackbits(words.view(np.uint8), bitorder="little").astype(bool)
    half = 2 * rows * jumps.row_words * 64
    right, left = bits[:half].reshape(2, rows, -1)
    down, up = bits[half:].reshape(2, cols, -1)
    found = {(0, 1): right[:, :cols], (0, -1): left[:, ::-1][:, :cols]}
    found |= {(1, 0): down[:, :rows].T, (-1, 0): up[:, ::-1][:, :rows].T}
    for step, ends in found.items():
        k = STEPS.index(step)
        expected = (moves == 0) | (onward(rule)[k][moves] & ~np.uint8(1 << k) > 0)
        np.testing.assert_array_equal(ends, expected)
    assert terrain.jumps.words is jumps.words
