"""A mission's plan after every change, against the map of its moment."""

from __future__ import annotations

import numpy as np
import pytest

import antnav as an
from antnav.live.methods import METHODS
from antnav.live.update import MissionStatus
from antnav.world.moves import legal_moves


def scattered(seed: int, shape=(40, 50), share: float = 0.15) -> an.GridMap:
    cells = (np.random.default_rng(seed).random(shape) < share).astype(np.uint8)
    cells[:4, :4] = cells[-4:, -4:] = 0
    return an.GridMap(cells)


@pytest.mark.parametrize("name", METHODS)
@pytest.mark.parametrize("rule", an.CornerRule)
def test_every_plan_is_a_path_of_its_moment(name: str, rule: an.CornerRule) -> None:
    rng = np.random.default_rng(1)
    grid = scattered(0)
    mission = an.Mission(an.Problem.from_cells(grid, (0, 0), (39, 49), corner_rule=rule), name)
    seen = set()
    for _ in range(150):
        blocked = rng.integers(0, grid.shape, (rng.integers(0, 12), 2))
        occupied = np.argwhere(mission.terrain.grid.cells == an.Cell.OCCUPIED)
        update = mission.change(blocked=blocked, freed=occupied[rng.integers(0, len(occupied), rng.integers(0, 9))])
        seen.add(update.status)
        if update:
            assert an.check_path(update.cells, mission.problem) == pytest.approx(update.cost)
        elif update.status is MissionStatus.UNREACHABLE:
            assert not mission.problem.connected
    assert MissionStatus.PLANNED in seen


@pytest.mark.parametrize(("radius", "strict"), [(0.0, False), (1.5, False), (2.3, True)])
@pytest.mark.parametrize("rule", an.CornerRule)
def test_moves_equal_those_of_a_map_made_anew(rule: an.CornerRule, radius: float, strict: bool) -> None:
    rng = np.random.default_rng(2)
    cells = scattered(3, share=0.02).cells.copy()
    cells[20:24, 20:24] = an.Cell.UNKNOWN
    problem = an.Problem.from_cells(an.GridMap(cells), (0, 0), (39, 49), corner_rule=rule)
    mission = an.Mission(problem, "astar", radius=radius, strict=strict)
    for _ in range(60):
        before = mission.terrain.moves.copy()
        blocked, freed = (rng.integers(0, cells.shape, (rng.integers(0, 8), 2)) for _ in range(2))
        occupied = np.argwhere(mission.terrain.grid.cells == an.Cell.OCCUPIED)
        update = mission.change(blocked=blocked, freed=np.concatenate((freed, occupied[:3])))
        expected = legal_moves(mission.terrain.grid.passable(), rule).ravel()
        np.testing.assert_array_equal(mission.terrain.moves, expected)
        assert update.altered == np.count_nonzero(before != expected)
