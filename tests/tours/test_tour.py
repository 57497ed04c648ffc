"""Tours: orders against brute force, what is said of them, odd stops, one trajectory."""

from __future__ import annotations

import csv
import json
import math
import pickle
from itertools import pairwise, permutations
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import antnav as an
from antnav import costs
from antnav.errors import OccupiedError, OutsideMapError, ParameterError
from antnav.planner.plan import Status
from antnav.tours.order import METHODS
from antnav.world.path import check_cost
from tests.conftest import grid_of

ROOMS = grid_of(
    "..............",
    ".####..#####..",
    ".#......#..#..",
    ".#..##..#..#..",
    "....##.....#..",
    ".#..##..####..",
    "..............",
)
CORNERS = [(0, 13), (6, 0), (3, 9), (0, 0), (6, 13), (3, 2)]


def drawn(seed: int, count: int, share: float = 0.2) -> tuple[an.GridMap, list[tuple[int, int]]]:
    """A map, and places on it that ways join."""
    rng = np.random.default_rng(seed)
    grid = an.GridMap((rng.random((12, 14)) < share).astype(np.uint8))
    reached = np.argwhere(an.Terrain.of(grid).reached(tuple(np.argwhere(grid.passable())[0].tolist())))
    return grid, [tuple(cell) for cell in reached[rng.integers(len(reached), size=count)].tolist()]


def brute_force(tour: an.Tour) -> float:
    """The least cost of any order, by the directed distances."""
    table, stops = tour.distances, range(1, len(tour) + 1)
    back = (0,) if tour.return_to_start else ()
    return min(sum(table[pair] for pair in pairwise((0, *order, *back))) for order in permutations(stops))


def assert_honest(tour: an.Tour) -> None:
    """What is said of a tour, added up anew."""
    assert sorted(tour.order) == list(range(1, len(tour) + 1))
    assert len(tour.legs) == len(tour) + tour.return_to_start
    total = 0.0
    for (one, other), leg in zip(pairwise(tour.visited), tour.legs, strict=True):
        an.check_path(leg.path, leg.problem)
        check_cost(leg.path, leg.problem, leg.cost)
        assert (leg.problem.start, leg.problem.goal) == (tour.places[one], tour.places[other])
        assert leg.cost == pytest.approx(tour.distances[one, other])
        total += leg.cost
    assert tour.cost == pytest.approx(total)
    assert tour.bound <= tour.cost * (1 + 1e-9)
    assert np.abs(np.diff(tour.path.cells, axis=0)).max(initial=0) <= 1
    assert np.hypot(*np.diff(tour.points, axis=0).T).sum() == pytest.approx(tour.length_m)


@settings(max_examples=40)
@given(
    seed=st.integers(0, 10**6),
    count=st.integers(2, 7),
    back=st.booleans(),
    method=st.sampled_from(["exact", "ils", "ants"]),
    kind=st.sampled_from(["plain", "dear", "slopes", "turns"]),
)
def test_small_tours_are_as_good_as_brute_force(seed: int, count: int, back: bool, method: str, kind: str) -> None:
    grid, cells = drawn(seed, count)
    values = np.random.default_rng(seed).gamma(1.0, 1.0, grid.shape)
    choices = {
        "plain": {},
        "dear": {"cost": costs.array(values)},
        "slopes": {"cost": costs.slope(3 * values, up=3.0, down=0.5)},
        "turns": {"turning": 0.7},
    }[kind]
    tour = an.tour(grid, cells[0], cells[1:], return_to_start=back, cells=True, method=method, seed=seed, **choices)
    assert_honest(tour)
    assert tour.cost == pytest.approx(brute_force(tour))
    assert tour.proven
    assert tour.optimum == pytest.approx(tour.cost)


def test_slopes_make_the_ways_there_and_back_differ() -> None:
    """Uphill is dear: the tour that may end anywhere ends below."""
    field = costs.slope(np.tile(np.arange(9.0), (3, 1)), up=5.0, down=0.0)
    tour = an.tour(an.GridMap(np.zeros((3, 9), np.uint8)), (1, 4), [(1, 0), (1, 8)], cells=True, cost=field)
    assert tour.distances[1, 2] == pytest.approx(8 + 5 * 8)
    assert tour.distances[2, 1] == pytest.approx(8)
    assert tour.order == (2, 1)
    assert tour.cost == pytest.approx(4 + 5 * 4 + 8) == brute_force(tour)


@settings(max_examples=30)
@given(seed=st.integers(0, 10**6), rule=st.sampled_from(list(an.CornerRule)), share=st.floats(0, 0.5))
def test_distances_are_those_of_single_searches(seed: int, rule: an.CornerRule, share: float) -> None:
    grid, cells = drawn(seed, 5, share)
    tour = an.tour(grid, cells[0], cells[1:], "given", cells=True, corner_rule=rule)
    for one, other in permutations(range(5), 2):
        problem = an.Problem.from_cells(grid, cells[one], cells[other], corner_rule=rule)
        assert tour.distances[one, other] == an.exact.shortest_path(problem, "dijkstra").cost


def test_the_given_order_is_kept_and_judged() -> None:
    tour = an.tour(ROOMS, (0, 6), CORNERS, "given", cells=True)
    assert_honest(tour)
    best = an.tour(ROOMS, (0, 6), CORNERS, cells=True)
    assert tour.order == (1, 2, 3, 4, 5, 6)
    assert tour.gap == pytest.approx(tour.cost / best.cost - 1)
    assert tour.gap > 0.3
    assert not tour.proven
    assert "% above the best order" in tour.summary()
    assert "as given" in tour.summary()


@pytest.mark.parametrize("method", ["ils", "ants"])
def test_larger_tours_have_an_honest_bound(method: str) -> None:
    rng = np.random.default_rng(1)
    places = [tuple(cell) for cell in rng.integers(0, 60, (31, 2)).tolist()]
    tour = an.tour(an.GridMap(np.zeros((60, 60), np.uint8)), places[0], places[1:], cells=True, method=method)
    assert_honest(tour)
    assert 0 <= tour.gap < 0.04
    again = an.tour(an.GridMap(np.zeros((60, 60), np.uint8)), places[0], places[1:], cells=True, method=method)
    assert again.order == tour.order
    assert again.path.cells.tobytes() == tour.path.cells.tobytes()


def test_a_stop_may_be_the_start_and_two_may_be_one() -> None:
    tour = an.tour(ROOMS, (0, 0), [(6, 13), (0, 0), (6, 13), (0, 13)], cells=True, return_to_start=True)
    assert_honest(tour)
    assert tour.cost == pytest.approx(brute_force(tour))
    assert tour.trajectory().length > 0


def test_one_stop_that_is_the_start() -> None:
    tour = an.tour(ROOMS, (0, 0), [(0, 0)], cells=True)
    assert (tour.order, tour.cost, tour.gap, tour.proven) == ((1,), 0.0, 0.0, True)
    assert tour.points.tolist() == [list(tour.places[0])]
    assert len(tour.trajectory(start_heading=1.0)) == 1


def test_stops_that_cannot_be_reached_are_named() -> None:
    grid = grid_of("...#.", "...#.", "...#.")
    tour = an.tour(grid, (0.5, 0.5), [(2.5, 2.5), (4.5, 1.5), (1.5, 1.5), (4.5, 0.5)])
    assert tour.status is Status.UNREACHABLE
    assert (tour.order, tour.legs, tour.path, tour.points) == ((), (), None, None)
    assert math.isinf(tour.cost)
    assert math.isnan(tour.gap)
    assert tour.notes == ("no path leads from the start to stop 2 at (4.5, 1.5) m, stop 4 at (4.5, 0.5) m",)
    assert tour.summary().startswith("status         unreachable, 4 stops\n")
    assert math.isinf(tour.distances[0, 2])
    assert json.loads(json.dumps(tour.to_dict()))["cost"] is None
    with pytest.raises(ParameterError, match="unreachable"):
        tour.trajectory()


def test_the_radius_is_strict() -> None:
    grid = an.GridMap(ROOMS.cells, 0.5)
    tour = an.tour(grid, (0.25, 0.25), [(6.75, 3.25)], radius=0.2, margin=0.05)
    assert tour.path.wall_distance >= 0.25
    with pytest.raises(
        OccupiedError, match=r"^stop 1 \(2.25, 1.75\) m = cell \(3, 4\): an obstacle is there; choose a"
    ):
        an.tour(grid, (0.25, 0.25), [(2.25, 1.75)])
    with pytest.raises(OccupiedError, match=r"^stop 2 .*: it is nearer to an obstacle than the robot's radius"):
        an.tour(grid, (0.25, 0.25), [(6.75, 3.25), (3.25, 1.75)], radius=0.3)


def test_tolerances_move_the_start_and_stops() -> None:
    tour = an.tour(
        ROOMS, (1, 1), [(6, 13), (4, 4)], cells=True, start_tolerance=2.0, goal_tolerance=1.5, return_to_start=True
    )
    assert_honest(tour)
    assert tour.path.cells[0].tolist() == [0, 1]
    assert len(tour.notes) == 2
    assert tour.notes[0].startswith("the start (1.5, 5.5) m was moved by 1 m to ")
    assert tour.notes[1].startswith("stop 2 (4.5, 2.5) m was moved by 1 m to ")


@pytest.mark.parametrize(
    ("stops", "told"),
    [
        ([], "stops: none: a tour has 1 to 1000"),
        ([(0.5, 0.5)] * 2000, "stops: more than 1000: a tour has 1 to 1000"),
        ([(0.5, 0.5), (math.nan, 1)], "stop 2 (nan, 1): a point is two finite numbers"),
        ([(0.5, 0.5), 3], "stop 2 3: a point is two finite numbers"),
        ("depot", "stops 'depot': they are points"),
        (None, "stops None: they are points"),
    ],
)
def test_bad_stops(stops: object, told: str) -> None:
    with pytest.raises(ParameterError) as raised:
        an.tour(ROOMS, (0.5, 0.5), stops)
    assert str(raised.value).startswith(told)


def test_a_stop_outside_the_map_is_named() -> None:
    with pytest.raises(OutsideMapError, match=r"^stop 2 \(99.0, 1.0\) m"):
        an.tour(ROOMS, (0.5, 0.5), [(0.5, 0.5), (99, 1)])
    with pytest.raises(OutsideMapError, match=r"^stop 1 cell \(7, 0\)"):
        an.tour(ROOMS, (0, 0), [(7, 0)], cells=True)
    with pytest.raises(OccupiedError, match=r"^start "):
        an.tour(ROOMS, (1, 1), [(0, 0)], cells=True)


@pytest.mark.parametrize(
    "wrong",
    [
        {"order": "worst"},
        {"method": "simplex"},
        {"method": "exact"},
        {"radius": -1},
        {"margin": math.nan},
        {"return_to_start": 1},
        {"cells": "no"},
        {"seed": -1},
        {"algorithm": "paco"},
        {"corner_rule": "jump"},
        {"turning": -1},
    ],
)
def test_what_is_out_of_range_is_named(wrong: dict) -> None:
    with pytest.raises(ParameterError, match=next(iter(wrong)).replace("_", "[ _]")):
        an.tour(ROOMS, (0.5, 0.5), [(0.5, 0.5)] * 19, **wrong)


def test_ants_may_plan_the_legs() -> None:
    tour = an.tour(ROOMS, (0, 6), CORNERS[:3], cells=True, algorithm=an.npaco(ants=8, iterations=8), seed=3)
    assert tour.status is Status.FOUND
    assert tour.cost >= tour.bound
    assert all(leg.algorithm.name == "npaco" for leg in tour.legs)


def test_a_planner_that_finds_no_path_says_so() -> None:
    class Idle(an.Planner):
        name = "idle"

        def plan(self, problem: an.Problem, call: an.Call) -> an.Plan:
            return an.Plan(cells=None)

    tour = an.tour(ROOMS, (0, 0), [(0, 13)], cells=True, algorithm=Idle())
    assert tour.status is Status.NO_PATH
    assert tour.path is None
    assert tour.notes == ("from place 0 to place 1: no path",)


def test_files(tmp_path: Path) -> None:
    tour = an.tour(ROOMS, (0, 6), CORNERS, cells=True, return_to_start=True)
    tour.save(tmp_path / "tour.json")
    told = json.loads((tmp_path / "tour.json").read_text())
    assert told == json.loads(json.dumps(tour.to_dict()))
    assert tuple(told["order"]) == tour.order
    assert [leg["stop"] for leg in told["legs"]] == [*tour.order, 0]
    assert told["legs"][-1]["total_m"] == pytest.approx(tour.length_m)
    tour.save(tmp_path / "tour.csv")
    with (tmp_path / "tour.csv").open() as stream:
        rows = list(csv.DictReader(stream))
    assert [int(row["stop"]) for row in rows] == list(tour.visited)
    assert float(rows[-1]["total_m"]) == pytest.approx(tour.length_m)
    with pytest.raises(ParameterError, match=r"tours end in \.json or \.csv"):
        tour.save(tmp_path / "tour.txt")


def test_it_travels_and_shows_itself() -> None:
    tour = an.tour(ROOMS, (0, 6), CORNERS, cells=True)
    copy = pickle.loads(pickle.dumps(tour))
    assert copy.order == tour.order
    assert not copy.distances.flags.writeable
    assert "<table>" in tour._repr_html_()
    assert repr(tour).startswith("Tour(found, 6 stops, ")


def test_one_trajectory_leads_through_all_stops() -> None:
    grid = an.GridMap(np.zeros((60, 80), np.uint8), 0.05)
    stops = [(2.0, 2.5), (3.5, 1.0), (1.0, 0.5)]
    tour = an.tour(grid, (0.5, 2.0), stops, radius=0.1, return_to_start=True)
    drive = tour.trajectory(max_curvature=4.0, start_heading=0.5, goal_heading=-1.0)
    assert drive.smooth
    assert drive.note == ""
    assert drive.max_curvature <= 4.0 * (1 + 1e-9)
    assert (drive.radius, drive.margin) == (0.1, 0.0)
    assert tuple(drive.poses[0]) == (0.5, 2.0, 0.5)
    assert tuple(drive.poses[-1]) == (0.5, 2.0, -1.0)
    assert {*stops} <= {tuple(pose[:2]) for pose in drive.poses.tolist()}
    assert len(drive.curvature) == len(drive)


def test_where_there_is_no_room_the_robot_turns_on_the_spot() -> None:
    grid = an.GridMap(grid_of("#########", "#.......#", "#########").cells, 0.5)
    tour = an.tour(grid, (0.75, 0.75), [(3.75, 0.75), (2.25, 0.75)], "given", radius=0.2)
    drive = tour.trajectory()
    assert not drive.smooth
    assert drive.note == "no smooth curve leads through stop 1: the robot turns on the spot there"
    assert math.isinf(drive.max_curvature)
    (at,) = np.flatnonzero((np.diff(drive.points, axis=0) == 0).all(axis=1))
    assert drive.points[at].tolist() == [3.75, 0.75]
    assert drive.length == pytest.approx(4.5)


def test_a_robot_with_speeds_rests_at_stops_and_takes_its_time_to_turn() -> None:
    grid = an.GridMap(grid_of("#########", "#.......#", "#########").cells, 0.5)
    tour = an.tour(grid, (0.75, 0.75), [(3.75, 0.75), (2.25, 0.75)], "given", radius=0.2)
    drive = tour.trajectory(max_speed=1.0, max_acceleration=1e3, max_angular_speed=0.5)
    (at,) = np.flatnonzero((np.diff(drive.points, axis=0) == 0).all(axis=1))
    assert drive.speeds[[0, at, at + 1, -1]].tolist() == [0.0] * 4
    assert drive.times[at + 1] - drive.times[at] == pytest.approx(math.pi / 0.5)
    assert drive.duration == pytest.approx(4.5 + math.pi / 0.5, rel=0.01)
    assert (np.diff(drive.times) >= 0).all()


def test_methods_are_those_that_are_documented() -> None:
    assert set(METHODS) <= set(an.tour.__doc__.replace('"', " ").replace(",", " ").replace("}", " ").split())


def test_a_footprint_counts_instead_of_the_radius() -> None:
    grid = an.GridMap(np.pad(np.zeros((38, 58), np.uint8), 1, constant_values=1), 0.05)
    tour = an.tour(grid, (0.5, 0.5), [(2.4, 1.5), (0.5, 1.5)], radius=0.1, margin=0.02)
    drive = tour.trajectory(footprint=[(0.15, 0.1), (0.15, -0.1), (-0.15, -0.1), (-0.15, 0.1)])
    assert drive.footprint is not None
    assert (drive.radius, drive.margin) == (pytest.approx(0.1), 0.02)


def test_poses_of_turns_at_stops_all_have_infinite_curvature() -> None:
    drive = an.tour(ROOMS, (0, 6), CORNERS, cells=True).trajectory(max_curvature=1e-3)
    spots = np.flatnonzero((np.diff(drive.points, axis=0) == 0).all(axis=1))
    assert len(spots) >= 1
    assert np.isinf(drive.curvature[spots]).all()
    assert np.isinf(drive.curvature[spots + 1]).all()
