"""Scenarios drawn by a text: what each kind does, and the same bytes for the same seed."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

import antnav as an
from antnav.errors import EndpointError, ParameterError
from antnav.scenarios.discs import WALKING, people
from antnav.scenarios.doors import WIDEST, narrow
from antnav.scenarios.ground import Ground

FLOOR = an.GridMap(np.zeros((30, 40), np.uint8), 0.5, name="floor")
ROOMS = an.maps.generate("rooms", 60, 60, 4)
PROBLEM = an.Problem.from_cells(FLOOR, (0, 0), (29, 39))
IN_ROOMS = an.Problem.from_cells(ROOMS, *an.maps.ends(ROOMS))
KINDS = ("doors:3", "obstacles:8", "obstacles:8:1", "people:5", "people:5:0", "traffic:4", "traffic:4:2.5", "unknown:6")


def states(scenario: an.Scenario, shape: tuple[int, int]) -> tuple[list[np.ndarray], list[np.ndarray]]:
    """Which cells are blocked and what they cost, tick by tick, by a plain loop."""
    blocked, prices = np.zeros(shape, bool), np.zeros(shape)
    happens = {event.tick: event for event in scenario.events}
    all_blocked, all_prices = [], []
    for tick in range(scenario.ticks):
        if tick in happens:
            event = happens[tick]
            assert not blocked[tuple(event.blocked.T)].any(), "blocked twice"
            assert blocked[tuple(event.freed.T)].all(), "freed, but was not blocked"
            assert (prices[tuple(event.priced.T)] != event.prices).all(), "a price that is none"
            blocked[tuple(event.blocked.T)] = True
            blocked[tuple(event.freed.T)] = False
            prices[tuple(event.priced.T)] = event.prices
        all_blocked.append(blocked.copy())
        all_prices.append(prices.copy())
    return all_blocked, all_prices


@pytest.mark.parametrize("text", [*KINDS, "doors:2+people:4+traffic:2+obstacles:3"])
def test_same_seed_same_events_which_are_changes_of_free_cells(text: str) -> None:
    one = an.scenarios.named(text, IN_ROOMS, seed=7, ticks=60)
    assert one.to_dict() == an.scenarios.named(text, IN_ROOMS, seed=7, ticks=60).to_dict()
    assert text.startswith("unknown") or one.to_dict() != an.scenarios.named(text, IN_ROOMS, seed=8, ticks=60).to_dict()
    blocked, _ = states(one, ROOMS.shape)
    assert not (np.array(blocked) & ~ROOMS.passable()).any()


def test_people_walk_from_cell_to_cell_round_walls() -> None:
    ground = Ground(IN_ROOMS, 50, 1)
    (cover, *rest) = covers = list(people(ground, np.random.default_rng(5), 1, 0))
    assert (cover.begin, rest[-1].end) == (0, 50)
    cells = [divmod(int(cover.cells[0]), ROOMS.cols) for cover in covers]
    assert all(one.end == other.begin for one, other in itertools.pairwise(covers))
    most = 1 + int(WALKING)
    steps = np.abs(np.diff(cells, axis=0)).max(axis=1)
    assert steps.max() <= most
    assert 45 * WALKING <= steps.sum() <= 50 * WALKING
    assert all(ROOMS.passable()[cell] for cell in cells)


def test_a_disc_of_radius_0_is_a_cell_of_1_nine_of_2_without_corners() -> None:
    ground = Ground(PROBLEM, 9, 1)
    assert [len(ground.disc((10, 10), radius)) for radius in (0, 1, 2)] == [1, 9, 21]
    assert ground.disc((0, 0), 1).tolist() == [0, 1, 40, 41]


def test_every_second_disc_lies_near_the_way() -> None:
    wall = np.zeros((60, 60), np.uint8)
    problem = an.Problem.from_cells(an.GridMap(wall), (0, 0), (0, 59))
    ground, rng = Ground(problem, 9, 1), np.random.default_rng(1)
    near = [ground.spot(rng, near_way=True, reach=3) for _ in range(50)]
    far = [ground.spot(rng, near_way=False, reach=3) for _ in range(50)]
    assert max(row for row, _ in near) <= 3
    assert max(row for row, _ in far) > 40


def test_obstacles_and_doors_leave_start_and_goal_alone() -> None:
    small = an.Problem.from_cells(an.GridMap(np.zeros((4, 4), np.uint8)), (0, 0), (3, 3))
    blocked, _ = states(an.scenarios.named("obstacles:30:3", small, ticks=40), (4, 4))
    assert np.array(blocked)[:, [0, 3], [0, 3]].sum() == 0
    assert np.array(blocked).any()


def test_doors_are_the_gaps_between_rooms() -> None:
    cells = np.zeros((11, 30), np.uint8)
    cells[:, 9] = cells[:, 19] = 1
    cells[4:6, 9] = cells[8, 19] = 0
    problem = an.Problem.from_cells(an.GridMap(cells), (5, 0), (5, 29))
    scenario = an.scenarios.named("doors:2", problem, ticks=200)
    blocked, _ = states(scenario, cells.shape)
    assert {*map(tuple, np.argwhere(np.any(blocked, axis=0)).tolist())} == {(4, 9), (5, 9), (8, 19)}
    shut = np.array([[state[4, 9], state[8, 19]] for state in blocked])
    assert not shut.all(axis=0).any()
    assert (np.array([state[4, 9] == state[5, 9] for state in blocked])).all()
    with pytest.raises(ParameterError, match="2 narrow passages"):
        an.scenarios.named("doors:3", problem)


def test_a_passage_separates_what_lies_around_it() -> None:
    found = narrow(Ground(IN_ROOMS, 9, 1), np.random.default_rng(0), 4)
    assert len({passage.cells.tobytes() for passage in found}) == 4
    for passage in found:
        assert passage.width <= WIDEST
        assert ROOMS.passable()[tuple(passage.cells.T)].all()
        before, after = passage.cells[0] - (passage.cells[-1] - passage.cells[0] > 0), passage.cells[-1]
        assert len(before) == len(after) == 2
    with pytest.raises(ParameterError, match="0 narrow passages"):
        narrow(Ground(PROBLEM, 9, 1), np.random.default_rng(0), 1)


def test_prices_add_up_and_go_back_to_nothing() -> None:
    scenario = an.scenarios.named("traffic:40:0.1+traffic:40:0.7", PROBLEM, seed=2, ticks=100)
    _, prices = states(scenario, FLOOR.shape)
    values = np.unique(prices)
    assert values[0] == 0.0
    assert {0.1, 0.7, 0.1 + 0.7} <= {*values.tolist()}
    assert not np.array(states(scenario, FLOOR.shape)[0]).any()


def test_unknown_terrain_is_a_sensor() -> None:
    assert an.scenarios.named("unknown", PROBLEM).sensor == 10
    both = an.scenarios.named("unknown:3+people:2", PROBLEM, ticks=9)
    assert (both.sensor, bool(both.events)) == (3, True)
    assert an.scenarios.named("people:2", PROBLEM, ticks=9).sensor is None
    with pytest.raises(ParameterError, match="4 cells or more"):
        an.scenarios.named("unknown:3", PROBLEM, speed=3)


def test_a_tick_lasts_as_long_as_the_moves_of_a_robot_of_a_metre_a_second() -> None:
    assert an.scenarios.named("people:1", PROBLEM, ticks=9, speed=2).seconds == 1.0
    assert an.scenarios.named("people:1", PROBLEM, ticks=9, seconds=0.1).seconds == 0.1


def test_a_robot_with_a_radius_stands_away_from_walls() -> None:
    with pytest.raises(EndpointError, match="radius"):
        an.scenarios.named("people:1", IN_ROOMS, radius=1.0)


@pytest.mark.parametrize(
    "text",
    [
        "",
        "people",
        "people:",
        "people:x",
        "people:1:2:3",
        "doors:2:3",
        "crowd:3",
        "unknown:1:2",
        "unknown+unknown",
        "+",
    ],
)
def test_what_is_no_scenario(text: str) -> None:
    with pytest.raises(ParameterError, match="it is doors:K"):
        an.scenarios.named(text, PROBLEM)


@pytest.mark.parametrize("text", ["people:-1", "people:99999", "traffic:3:0", "traffic:3:nan", "traffic:1:1e99"])
def test_numbers_out_of_range(text: str) -> None:
    with pytest.raises(ParameterError, match=f"scenario {text}"):
        an.scenarios.named(text, PROBLEM)
