"""Dubins' curves: every word ends at the goal, and the shortest of known cases."""

from __future__ import annotations

import math

import numpy as np
import pytest

from antnav.trajectories.dubins import dubins
from antnav.trajectories.pieces import backwards, end_of, length_of, part


@pytest.mark.parametrize("seed", range(40))
def test_every_word_leads_from_pose_to_pose(seed: int) -> None:
    draw = np.random.default_rng(seed)
    start, goal = (tuple(draw.uniform(-4, 4, 3).tolist()) for _ in range(2))
    radius = float(draw.uniform(0.1, 3))
    words = dubins(start, goal, radius)
    assert len(words) >= 4
    assert [length_of(word) for word in words] == sorted(length_of(word) for word in words)
    for word in words:
        x, y, heading = end_of(word)
        assert (x, y) == pytest.approx(goal[:2], abs=1e-9)
        assert math.remainder(heading - goal[2], math.tau) == pytest.approx(0, abs=1e-9)
        assert set(np.abs(word[:, 4]).round(9)) <= {0.0, round(1 / radius, 9)}


def test_known_lengths() -> None:
    assert length_of(dubins((0, 0, 0), (5, 0, 0), 1)[0]) == pytest.approx(5)
    assert length_of(dubins((0, 0, 0), (0, 2, math.pi), 1)[0]) == pytest.approx(math.pi)  # half a circle
    assert length_of(dubins((0, 0, 0), (2, 2, 0), 1)[0]) == pytest.approx(math.pi)  # left, right


def test_parts_and_the_way_back() -> None:
    word = dubins((0, 0, 0.3), (3, 4, 2.0), 0.7)[0]
    total = length_of(word)
    piece = part(word, 0.4 * total, 0.9 * total)
    assert length_of(piece) == pytest.approx(total / 2)
    assert end_of(part(word, 0, 0.4 * total)) == pytest.approx(tuple(piece[0, :3]))
    x, y, heading = end_of(backwards(word))
    assert (x, y, math.remainder(heading - math.pi, math.tau)) == pytest.approx((0, 0, 0.3))
