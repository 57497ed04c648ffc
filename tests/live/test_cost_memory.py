"""Memory of prices: what is expected, against sums by hand; and what it is good for."""

from __future__ import annotations

import math

import numpy as np
import pytest

import antnav as an
from antnav.errors import ParameterError
from antnav.live.astar import AStar
from antnav.live.cost_memory import CostMemory
from antnav.live.dstar_lite import DStarLite
from antnav.live.regions import Regions
from antnav.live.replanner import Replanner
from antnav.live.terrain import LiveTerrain
from antnav.world.cost import CostField


def priced(cells: np.ndarray, start: tuple[int, int], goal: tuple[int, int]) -> an.Problem:
    return an.Problem.from_cells(an.GridMap(cells), start, goal, cost=CostField(np.zeros(cells.shape)))


def two_corridors() -> an.Problem:
    """The upper one is shorter, and its middle, column 20, is jammed at times."""
    cells = np.ones((9, 41), np.uint8)
    cells[:, :2] = cells[:, -2:] = 0
    cells[3] = cells[8] = 0
    return priced(cells, (3, 0), (3, 40))


JAM = [(3, col) for col in range(16, 25)]


def test_expectation_is_the_sum_by_hand() -> None:
    problem = priced(np.zeros((1, 60), np.uint8), (0, 0), (0, 59))
    terrain, memory = LiveTerrain(problem), CostMemory(evaporation=50.0)
    start, goal = problem.flat_ends
    memory.begin(terrain, start, goal)
    cell = terrain.flat_of("cell", [(0, 40)])
    memory.changed(terrain.price(cell, np.array([4.0])), start)
    memory.moved(start + 10)  # ten cells of price 1
    memory.changed(terrain.price(cell, np.array([0.0])), start + 15)
    # before it was watched: 20, a fifth of it at 5; then 15 at 5, while all of it evaporates
    total, mean, square = 20.0, 0.8 * 1 + 0.2 * 5, 0.8 * 1 + 0.2 * 25
    for drive in (10, 5):
        kept = math.exp(-drive / 50)
        weight = kept * total + 50 * (1 - kept)
        mean = (kept * total * mean + 50 * (1 - kept) * 5) / weight
        square = (kept * total * square + 50 * (1 - kept) * 25) / weight
        total = weight
    lasting = 2 * (square - mean**2) * (400 + 15) / (4**2 + 4**2)
    expected = mean + (1 - mean) * math.exp(-25 / lasting)
    assert memory._expected.prices.cells[cell] == pytest.approx(expected)
    assert terrain.prices.cells[cell] == 1.0
    assert terrain.prices.cells is not memory._expected.prices.cells


@pytest.mark.parametrize("remembers", [True, False])
def test_a_place_that_is_mostly_jammed_is_avoided_while_it_is_free(remembers: bool) -> None:
    problem = two_corridors()
    mission = an.Mission(problem, CostMemory() if remembers else AStar())
    assert (mission.plan.cells[:, 0] == 3).all()
    for _ in range(6):  # jammed for 39 of 40 moves there, free when the robot sets out
        mission.change(cost=(JAM, 9.0))
        mission.moved_to((3, 1))
        for goal in ((3, 40), (3, 0)):
            mission.goal = goal
            mission.moved_to(goal)
        mission.change(cost=(JAM, 0.0))
        mission.moved_to((3, 0))
    mission.goal = (3, 40)
    assert (mission.plan.cells[:, 0] == 8).any() == remembers


def test_near_by_the_price_of_now_counts() -> None:
    problem = two_corridors()
    mission = an.Mission(problem, CostMemory())
    mission.change(cost=(JAM, 50.0))
    mission.moved_to((3, 13))
    assert (mission.plan.cells[:, 0] == 8).any()  # back and round, as it is jammed now
    mission.change(cost=(JAM, 0.0))
    assert (mission.plan.cells[:, 0] == 3).all()


@pytest.mark.parametrize("planner", [AStar, DStarLite, Regions])
def test_every_plan_is_a_path_of_its_moment(planner: type[Replanner]) -> None:
    rng = np.random.default_rng(3)
    cells = (rng.random((40, 50)) < 0.15).astype(np.uint8)
    cells[:4, :4] = cells[-4:, -4:] = 0
    memory = CostMemory(planner())
    mission = an.Mission(priced(cells, (0, 0), (39, 49)), memory)
    plans = 0
    for _ in range(60):
        occupied = np.argwhere(mission.terrain.grid.cells == an.Cell.OCCUPIED)
        freed = occupied[rng.integers(0, len(occupied), 5)]
        update = mission.change(
            blocked=rng.integers(4, (36, 46), (5, 2)),
            freed=np.vstack((freed, mission.position)),
            cost=(rng.integers(0, (40, 50), (30, 2)), float(rng.integers(0, 5))),
        )
        if update:
            plans += 1
            an.check_path(update.cells, mission.problem)
            if planner is not Regions:
                best = AStar().begin(memory._expected, int(update.flat[0]), int(update.flat[-1]))
                least = memory._expected.cost_along(best)
                assert memory._expected.cost_along(update.flat) == pytest.approx(least)
            if len(update.cells) > 20:
                mission.moved_to(tuple(update.cells[2].tolist()))
            an.check_path(mission.improve(3).cells, mission.problem)
    assert plans > 50


def test_as_long_as_no_price_changes_it_is_the_planner() -> None:
    problem = an.Problem.from_cells(an.GridMap(np.zeros((20, 20), np.uint8)), (0, 0), (19, 19))
    with_memory, without = an.Mission(problem, CostMemory()), an.Mission(problem, AStar())
    for row in range(3, 15):
        for mission in (with_memory, without):
            mission.change(blocked=[(row, 19 - row)])
        assert with_memory.plan.cells.tolist() == without.plan.cells.tolist()


def test_another_terrain_is_not_remembered() -> None:
    problem = two_corridors()
    start, goal = problem.flat_ends
    memory, terrain = CostMemory(), LiveTerrain(problem)
    memory.begin(terrain, start, goal)
    memory.changed(terrain.price(terrain.flat_of("jam", JAM), np.full(len(JAM), 9.0)), start)
    assert len(memory._cells) == len(JAM)
    memory.begin(terrain, goal, start)
    assert len(memory._cells) == len(JAM)
    memory.begin(LiveTerrain(problem), start, goal)
    assert not len(memory._cells)


@pytest.mark.parametrize("evaporation", [0, -1.0, math.inf, math.nan, "slow"])
def test_evaporation_is_checked(evaporation: object) -> None:
    with pytest.raises(ParameterError):
        CostMemory(evaporation=evaporation)  # type: ignore[arg-type]


def test_a_planner_that_may_miss_a_way_stays_one() -> None:
    class Blind(AStar):
        certain = False

        def moved(self, start: int) -> None:
            return None

    mission = an.Mission(two_corridors(), CostMemory(Blind()))
    assert mission.plan.status == "no_path"
    with pytest.raises(ParameterError, match="planner 'astar'"):
        CostMemory("astar")


class Again(AStar):
    """One that does not improve, and does not say that it is exact."""

    name, exact = "again", False


def test_who_does_not_improve_is_not_asked() -> None:
    problem = an.Problem.from_cells(an.GridMap(np.zeros((9, 9), np.uint8)), (0, 0), (8, 8))
    mission = an.Mission(problem, CostMemory(Again()))
    assert mission.improve(3) is mission.plan
    assert an.Mission(problem, CostMemory(Regions())).improve(3).cost == mission.plan.cost
