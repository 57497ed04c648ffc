"""Walks on the padded map, at what random walks seldom meet; their twins are in `tests/rivals`."""

from __future__ import annotations

import numpy as np
import pytest

import antnav as an
from antnav.kernels import walk_kernels


@pytest.mark.parametrize(
    "ends", [((0, 5), (5, 5)), ((5, 5), (0, 5)), ((5, 0), (5, 5)), ((5, 5), (5, 0)), ((0, 0), (5, 5))]
)
def test_one_line_has_room_for_all_its_cells(ends: tuple[tuple[int, int], tuple[int, int]]) -> None:
    """Down, up, right and left along the edges, and from corner to corner."""
    problem = an.Problem.from_cells(an.GridMap(np.zeros((6, 6), np.uint8)), *ends)
    stops = np.array([problem.to_flat(cell) for cell in ends])
    cells, _, illegal = walk_kernels.straight_walk(problem.flat_moves, problem.width, stops)
    assert problem.from_flat(cells).tolist() == np.linspace(*ends, 6, dtype=int).tolist()
    assert illegal == 0
