"""A mission's plan after every change, against the map of its moment."""

from __future__ import annotations

import numpy as np
import pytest

import antnav as an
from antnav.live.methods import METHODS
from antnav.live.update import MissionStatus
from antnav.world.cost import CostField
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
            assert len(np.unique(update.cells, axis=0)) == len(update.cells), "no loops"
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


def corridor() -> an.Problem:
    """Two ways round a wall, the upper one shorter."""
    cells = np.zeros((9, 30), np.uint8)
    cells[3:8, 15] = 1
    return an.Problem.from_cells(an.GridMap(cells, resolution=0.5), (4, 0), (4, 29))


@pytest.mark.parametrize("name", METHODS)
def test_a_goal_that_is_walled_in_is_told_and_found_again(name: str) -> None:
    mission = an.Mission(corridor(), name)
    ring = [(r, c) for r in (3, 4, 5) for c in (28, 29) if (r, c) != (4, 29)]
    assert mission.change(blocked=ring).status is MissionStatus.UNREACHABLE
    assert mission.plan.cells is mission.plan.points is None
    assert mission.plan.length == mission.plan.cost == np.inf
    assert np.isnan(mission.gap)
    assert mission.improve(3).status is MissionStatus.UNREACHABLE
    assert mission.change(freed=ring).status is MissionStatus.PLANNED
    assert mission.gap == pytest.approx(0)


@pytest.mark.parametrize("name", METHODS)
def test_a_robot_inside_a_new_wall_and_a_closed_goal(name: str) -> None:
    mission = an.Mission(corridor(), name)
    assert mission.change(blocked=[mission.position]).status is MissionStatus.START_BLOCKED
    with pytest.raises(an.errors.OccupiedError):
        _ = mission.problem
    assert mission.change(blocked=[mission.goal], freed=[mission.position]).status is MissionStatus.GOAL_BLOCKED
    update = mission.change(freed=[mission.goal])
    assert update.status is MissionStatus.PLANNED
    assert an.check_path(update.cells, mission.problem) == pytest.approx(update.cost)
    mission.moved_to(mission.goal)
    assert mission.plan.status is MissionStatus.ARRIVED
    assert mission.plan.cells.tolist() == [list(mission.goal)]


@pytest.mark.parametrize("name", METHODS)
def test_another_goal_and_another_place(name: str) -> None:
    mission = an.Mission(corridor(), name)
    mission.goal = (8, 3)
    assert (mission.goal, mission.plan.cells[-1].tolist()) == ((8, 3), [8, 3])
    x, y = mission.plan.points[2]
    mission.moved((x, y))
    np.testing.assert_allclose(mission.plan.points[0], (x, y))
    mission.moved_to((0, 29))
    assert an.check_path(mission.plan.cells, mission.problem) == pytest.approx(mission.plan.cost)
    assert mission.gap == pytest.approx(0)


@pytest.mark.parametrize("name", METHODS)
def test_costs_come_and_go(name: str) -> None:
    mission = an.Mission(corridor(), name)
    short = mission.plan.cost
    above = [(r, c) for r in range(3) for c in range(13, 18)]
    dear = mission.change(cost=(above, 50.0))
    assert dear.cost > short + 1
    assert 8 in dear.cells[:, 0], "below the wall"
    an.check_path(dear.cells, mission.problem)
    assert mission.gap == pytest.approx(0, abs=0.01)
    again = mission.change(cost=CostField(np.zeros((9, 30))))
    mission.improve(9)
    assert mission.plan.cost == pytest.approx(short)
    assert again.altered == len(above)


WRONG = [
    ({"blocked": [(9, 0)]}, "cell"),
    ({"blocked": [(-1, 0)]}, "cell"),
    ({"freed": [(0, 30)]}, "cell"),
    ({"blocked": np.zeros((9, 29), np.bool_)}, "blocked"),
    ({"blocked": [(1.5, 2)]}, "blocked"),
    ({"blocked": "all"}, "blocked"),
    ({"freed": [(1, 2, 3)]}, "freed"),
    ({"cost": [(1, 2)]}, "cost"),
    ({"cost": ([(1, 2)], -1.0)}, "cost -1"),
    ({"cost": ([(1, 2)], np.nan)}, "cost nan"),
    ({"cost": ([(1, 2)], [1.0, 2.0])}, "cost"),
    ({"cost": 3}, "cost"),
    ({"at": (1e9, 0.0)}, "cell"),
    ({"at": (np.nan, 0.0)}, "position"),
    ({"at": 3}, "position"),
]


@pytest.mark.parametrize(("given", "told"), WRONG, ids=[str(given)[:40] for given, _ in WRONG])
def test_what_is_wrong_is_refused_and_nothing_altered(given: dict, told: str) -> None:
    mission = an.Mission(corridor())
    before, moves = mission.plan, mission.terrain.moves.copy()
    with pytest.raises(an.errors.ParameterError) as error:
        mission.change(**{"blocked": [(0, 15)], **given})
    assert told in str(error.value)
    assert mission.plan is before
    np.testing.assert_array_equal(mission.terrain.moves, moves)


def test_other_arguments_are_checked() -> None:
    problem = corridor()
    for given in (
        {"algorithm": "magic"},
        {"algorithm": 3},
        {"radius": -1},
        {"radius": "x"},
        {"strict": 2},
        {"seed": -1},
    ):
        with pytest.raises(an.errors.ParameterError):
            an.Mission(problem, **given)
    turning = an.Problem(problem.grid, problem.start, problem.goal, turning=1.0)
    with pytest.raises(an.errors.ParameterError, match="turns"):
        an.Mission(turning)
    mission = an.Mission(problem)
    for rounds in (0, -1, 1.5, 10**9):
        with pytest.raises(an.errors.ParameterError):
            mission.improve(rounds)
    with pytest.raises(an.errors.ParameterError):
        mission.goal = (9, 9, 9)


def test_threads_wait_for_each_other() -> None:
    from concurrent.futures import ThreadPoolExecutor

    grid = scattered(4)
    mission = an.Mission(an.Problem.from_cells(grid, (0, 0), (39, 49), corner_rule="allow"))

    def work(seed: int) -> None:
        rng = np.random.default_rng(seed)
        for _ in range(40):
            cells = rng.integers(4, 36, (4, 2))
            mission.change(blocked=cells)
            mission.improve(2)
            mission.change(freed=cells)

    with ThreadPoolExecutor(4) as pool:
        list(pool.map(work, range(4)))
    assert an.check_path(mission.plan.cells, mission.problem) == pytest.approx(mission.plan.cost)
    expected = legal_moves(mission.terrain.grid.passable(), mission.problem.corner_rule).ravel()
    np.testing.assert_array_equal(mission.terrain.moves, expected)


def test_the_map_that_was_given_stays_as_it_is() -> None:
    problem = corridor()
    before = problem.grid.cells.copy(), problem.moves.copy()
    mission = an.Mission(problem)
    mission.change(blocked=np.ones((9, 30), np.bool_))
    np.testing.assert_array_equal(problem.grid.cells, before[0])
    np.testing.assert_array_equal(problem.moves, before[1])


def test_ants_plan_anew_with_what_they_remember() -> None:
    grid = an.maps.builtin("equiv20")
    problem = an.Problem.from_cells(grid, *an.maps.builtin_query("equiv20"), corner_rule="allow")
    plans = []
    for _ in range(2):
        mission = an.Mission(problem, an.npaco(memory="eta", iterations=8), seed=3)
        assert mission.memory is not None
        mission.change(blocked=mission.plan.cells[10:11])
        mission.moved_to(mission.plan.cells[2])
        before = mission.plan.cost
        assert mission.improve(2).cost <= before
        an.check_path(mission.plan.cells, mission.problem)
        plans.append(mission.plan.cells)
        del mission.memory
        assert mission.memory is None
    np.testing.assert_array_equal(*plans)
    assert an.Mission(problem).memory is None


def test_within_the_tolerances_a_closed_end_is_replaced_by_the_nearest_open_cell() -> None:
    grid = an.GridMap(np.zeros((9, 30), np.uint8), resolution=0.5)
    ends = {"start_tolerance": 1.0, "goal_tolerance": 0.5}
    mission = an.Mission(an.Problem.from_cells(grid, (4, 5), (4, 29), **ends))
    update = mission.change(blocked=[(r, c) for r in (3, 4, 5) for c in (4, 5, 6)] + [(4, 29)])
    assert update.status is MissionStatus.PLANNED
    assert abs(update.cells[0] - (4, 5)).sum() == 2, "two cells away, 1 m"
    assert abs(update.cells[-1] - (4, 29)).sum() == 1
    assert (mission.position, mission.goal) == ((4, 5), (4, 29))
    an.check_path(update.cells, mission.problem)
    beside = [(4, 28), (3, 29), (5, 29)]
    assert mission.change(blocked=beside).status is MissionStatus.GOAL_BLOCKED
    assert mission.change(freed=[*beside, (4, 29)]).cells[-1].tolist() == [4, 29]
    wall = [(r, c) for r in range(9) for c in range(2, 9)]
    assert mission.change(blocked=wall).status is MissionStatus.START_BLOCKED


@pytest.mark.parametrize("name", METHODS)
def test_a_jam_on_the_path_is_avoided(name: str) -> None:
    grid = an.GridMap(np.zeros((40, 60), np.uint8))
    cost = CostField(np.zeros(grid.shape))
    mission = an.Mission(an.Problem.from_cells(grid, (20, 0), (20, 59), cost=cost), name)
    mission.change(cost=([(r, c) for r in range(16, 25) for c in range(28, 33)], 30.0))
    assert mission.gap < 0.03, "at once"
    if name == "regions":
        mission.improve(9)
        assert mission.gap == pytest.approx(0)


def test_an_update_tells_what_was_done() -> None:
    mission = an.Mission(corridor())
    assert mission.plan.reason == "planned anew"
    assert mission.change(blocked=[(8, 20)]).reason == "kept"
    assert mission.plan.changed_share == 0
    assert mission.moved_to(mission.plan.cells[2]).reason == "went on"
    mended = mission.change(blocked=mission.plan.cells[4:5])
    assert mended.reason == "mended"
    assert 0 < mended.changed_share < 0.9
    across = [(row, 14) for row in range(3)]
    assert mission.change(blocked=across).reason in ("rerouted", "mended")
    assert mission.change(freed=[*across, (8, 20)]).reason in ("rerouted", "mended", "kept")
    assert mission.improve(9).reason in ("improved", "kept")
    assert mission.change(blocked=[(row, 14) for row in range(9)]).reason == "no way"
    assert "no way" in repr(mission.plan)
    assert not mission.plan


def test_far_from_the_break_the_plan_stays_and_a_long_way_round_is_a_route() -> None:
    cells = np.zeros((60, 200), np.uint8)
    cells[5:60, 100] = 1
    cells[55, 100] = 0  # two ways through the wall: above it, and a door below
    mission = an.Mission(an.Problem.from_cells(an.GridMap(cells), (55, 2), (55, 197)))
    assert mission.plan.cost == 195
    update = mission.change(blocked=[(55, 100)])
    assert update.reason == "rerouted"
    assert mission.gap < 0.1
    assert mission.change(freed=[(55, 100)]).cost < 1.05 * 195, "what is worth it is not left to idle time"
    assert mission.improve(9).cost == pytest.approx(195)


def test_a_notebook_shows_the_map_of_the_moment_and_the_plan() -> None:
    mission = an.Mission(corridor())
    before = mission._repr_html_()
    assert "<polyline" in before
    mission.change(blocked=[(row, 7) for row in range(9)])
    after = mission._repr_html_()
    assert "<polyline" not in after
    assert "unreachable" in after
    assert before.split("base64,")[1][:200] != after.split("base64,")[1][:200]


def test_a_disc_that_moves_on_stays_whole() -> None:
    mission = an.Mission(an.Problem.from_cells(an.GridMap(np.zeros((20, 20), np.uint8)), (0, 0), (19, 19)))
    before, now = ({(r + step, c) for r in range(5, 10) for c in range(5, 10)} for step in (0, 1))
    mission.change(blocked=list(before))
    mission.change(blocked=list(now), freed=list(before))
    occupied = np.argwhere(mission.terrain.grid.cells == an.Cell.OCCUPIED)
    assert {tuple(cell) for cell in occupied.tolist()} == now


def test_a_map_that_is_inflated_already_is_told() -> None:
    grid = scattered(0, share=0.02)
    ends = {"start_tolerance": 5.0, "goal_tolerance": 5.0}
    with pytest.warns(UserWarning, match="radius="):
        an.Mission(an.Problem.from_cells(grid.inflated(1.0), (0, 0), (39, 49), **ends))


class Again(an.Replanner):
    name = "again"
    wrong = ""

    def begin(self, terrain, start, goal):
        self.terrain, self.goal = terrain, goal
        return self.moved(start)

    def changed(self, cells, start):
        return self.moved(start)

    def moved(self, start):
        best = an.exact.shortest_path(self.terrain.problem(start, self.goal)).path
        path = None if best is None else self.terrain.flat_of("path", best.cells)
        wrongs = {
            "": path,
            "cells": best.cells,
            "empty": path[:0],
            "list": path.tolist(),
            "reversed": path[::-1].copy(),
            "jump": path[[0, *range(3, len(path))]],
            "int64": path.astype(np.int64),
        }
        return wrongs[self.wrong]


def test_a_replanner_of_ones_own_needs_three_methods() -> None:
    mission = an.Mission(corridor(), Again())
    assert mission.gap == pytest.approx(0)
    update = mission.change(blocked=mission.plan.cells[5:6])
    an.check_path(update.cells, mission.problem)
    assert mission.improve(3) is mission.plan
    assert "again" in repr(mission)


@pytest.mark.parametrize("wrong", ["cells", "empty", "list", "reversed", "jump", "int64"])
def test_what_it_should_not_have_given_is_refused(wrong: str) -> None:
    mission = an.Mission(corridor(), Again())
    Again.wrong = wrong
    try:
        with pytest.raises(an.errors.ParameterError, match="Again"):
            mission.change(blocked=mission.plan.cells[5:6])
    finally:
        Again.wrong = ""


@pytest.mark.parametrize("name", METHODS)
def test_a_replanner_serves_its_latest_mission(name: str) -> None:
    own = METHODS[name]()
    first = an.Mission(corridor(), own)
    second = an.Mission(an.Problem.from_cells(an.GridMap(np.zeros((3, 3), np.uint8)), (0, 0), (2, 2)), own)
    before, moves = first.plan, first.terrain.moves.copy()
    for call in (
        lambda: first.change(blocked=[(8, 29)]),
        lambda: first.moved_to((4, 1)),
        lambda: setattr(first, "goal", (0, 0)),
        first.improve,
    ):
        with pytest.raises(an.errors.ParameterError, match="another mission"):
            call()
    assert first.plan is before
    np.testing.assert_array_equal(first.terrain.moves, moves)
    assert second.change(blocked=[(1, 1)])


def test_reasons() -> None:
    mission = an.Mission(corridor(), "astar")
    assert mission.plan.reason == "planned anew"
    assert mission.moved_to(mission.plan.cells[1]).reason == "went on"
    assert mission.change(blocked=[(8, 0)]).reason == "kept"
    assert mission.change(blocked=mission.plan.cells[3:4]).reason == "replanned"
    assert mission.change(blocked=[(row, 20) for row in range(9)]).reason == "no way"


def test_a_change_leaves_the_robot_where_another_thread_has_moved_it() -> None:
    from threading import Thread

    mission = an.Mission(corridor())
    with mission._lock:
        thread = Thread(target=lambda: mission.change(blocked=[(8, 0)]))
        thread.start()
        thread.join(0.1)  # it waits for the lock
        mission.moved_to((4, 3))
    thread.join()
    assert mission.position == (4, 3)


def test_a_radius_beyond_the_map() -> None:
    mission = an.Mission(an.Problem.from_cells(an.GridMap(np.zeros((9, 30), np.uint8)), (0, 0), (8, 29)), radius=1e9)
    assert mission.change(blocked=[(0, 29)]).status is MissionStatus.START_BLOCKED
    assert mission.change(freed=[(0, 29)])


def test_a_mission_is_not_copied() -> None:
    import copy

    mission = an.Mission(corridor())
    with pytest.raises(TypeError, match="begin another"):
        copy.deepcopy(mission)
    assert an.Mission(mission.problem).plan.cost == mission.plan.cost
