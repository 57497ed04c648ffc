"""What the planner server answers, without ROS: codes as of nav2's ComputePathToPose, cancel, tolerance, headings."""

import math
import threading
import time
from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np
import pytest

import antnav as an
from antnav.errors import MapError, ParameterError
from antnav.ros.planner import PathPlanner, Request

WALLS = np.zeros((20, 30), np.uint8)
WALLS[:15, 12] = 1
GRID = an.GridMap(WALLS, 0.1, (-1.0, -1.0, 0.0))
START, GOAL = (-0.5, 0.5, 0.0), (1.5, 0.5, 1.0)


@dataclass(frozen=True)
class Never(an.Planner):
    """Searches until it is told to end, and finds nothing."""

    name: str = "never"

    def plan(self, problem: an.Problem, call: an.Call) -> an.Plan:
        while (ending := call.ending(0, math.inf)) is None:
            time.sleep(1e-3)
        return an.Plan(cells=None, stopped_by=ending)


def on(grid: an.GridMap, **options: object) -> PathPlanner:
    planner = PathPlanner(**options)  # type: ignore[arg-type]
    planner.use(grid)
    return planner


def message(values: list[list[int]]) -> SimpleNamespace:
    """An OccupancyGrid, rows from the bottom up."""
    turn = SimpleNamespace(x=0.0, y=0.0, z=0.0, w=1.0)
    origin = SimpleNamespace(position=SimpleNamespace(x=0.0, y=0.0, z=0.0), orientation=turn)
    info = SimpleNamespace(resolution=1.0, width=len(values[0]), height=len(values), origin=origin)
    return SimpleNamespace(info=info, data=np.array(values, np.int8).ravel())


def test_a_path_that_keeps_the_radius_and_ends_in_the_goal() -> None:
    answer = on(GRID, radius=0.15).plan(Request(GOAL, START))
    assert (answer.error_code, answer.error_msg, answer.canceled) == (0, "", False)
    assert tuple(answer.poses[0, :2]) == START[:2]
    assert tuple(answer.poses[-1]) == GOAL
    assert np.hypot(*np.diff(answer.poses[:, :2], axis=0).T).max() <= 0.05 + 1e-9
    drive = an.Trajectory(answer.poses, np.zeros(len(answer.poses)), GRID)
    assert drive.wall_distance >= 0.15 - 1e-9
    assert answer.seconds > 0


def test_headings_of_both_ends_where_the_curvature_is_limited() -> None:
    free = an.GridMap(np.zeros((60, 60), np.uint8), 0.1)
    answer = on(free, max_curvature=2.0).plan(Request((4.0, 4.0, -2.0), (2.0, 2.0, 3.0)))
    assert answer.poses[0].tolist() == pytest.approx([2.0, 2.0, 3.0])
    assert answer.poses[-1].tolist() == pytest.approx([4.0, 4.0, -2.0])
    steps = np.diff(answer.poses[:, :2], axis=0)
    assert math.atan2(*steps[-1, ::-1]) == pytest.approx(-2.0, abs=0.1)


@pytest.mark.parametrize(
    "goal, start, code",
    [
        (GOAL, (-5.0, 0.5, 0.0), 203),
        ((9.0, 0.5, 0.0), START, 204),
        (GOAL, (0.25, 0.5, 0.0), 205),
        ((0.25, 0.5, 0.0), START, 206),
        (GOAL, None, 202),
        (None, START, 202),
        (GOAL, (math.nan, 0.5, 0.0), 200),
    ],
)
def test_error_codes(goal: tuple[float, float, float], start: tuple[float, float, float], code: int) -> None:
    answer = on(GRID, tolerance=0.0).plan(Request(goal, start))
    assert (answer.error_code, len(answer.poses)) == (code, 0)
    assert answer.error_msg


def test_no_way_and_out_of_time() -> None:
    closed = WALLS.copy()
    closed[:, 12] = 1
    assert on(an.GridMap(closed, 0.1, GRID.origin), tolerance=0.0).plan(Request(GOAL, START)).error_code == 208
    answer = on(GRID, planners={"Never": Never()}, max_seconds=0.01).plan(Request(GOAL, START))
    assert (answer.error_code, answer.error_msg) == (207, "never: no_path")


def test_before_a_map_has_come() -> None:
    assert PathPlanner().plan(Request(GOAL, START)).error_code == 207


def test_tolerance_moves_the_goal() -> None:
    answer = on(GRID, tolerance=0.3).plan(Request((0.25, 0.5, 0.5), START))
    assert answer.error_code == 0
    assert 0 < math.dist(answer.poses[-1, :2], (0.25, 0.5)) <= 0.3


def test_planners_by_their_names() -> None:
    several = on(GRID, planners={"GridBased": an.astar(), "Ants": an.npaco(ants=5, iterations=3)})
    for name, code in (("GridBased", 0), ("Ants", 0), ("", 201), ("Other", 201)):
        assert several.plan(Request(GOAL, START, name)).error_code == code
    assert on(GRID).plan(Request(GOAL, START, "")).error_code == 0


def test_a_goal_that_is_canceled() -> None:
    cancel = threading.Event()
    threading.Timer(0.05, cancel.set).start()
    answer = on(GRID, planners={"Never": Never()}, max_seconds=60.0).plan(Request(GOAL, START), cancel)
    assert answer.canceled
    cancel.set()
    answer = on(GRID).plan(Request(GOAL, START), cancel)
    assert answer.canceled
    assert not len(answer.poses)


def test_a_start_beside_a_wall_gets_the_path_of_cells() -> None:
    beside = (0.15, 0.5, 0.0)
    answer = on(GRID, radius=0.15, start_tolerance=0.3).plan(Request(GOAL, beside))
    assert answer.error_code == 0
    assert tuple(answer.poses[-1]) == GOAL


def test_maps_from_messages() -> None:
    planner = PathPlanner(allow_unknown=False, tolerance=0.0)
    planner.take_map(message([[0, 0, 0], [100, 100, -1]]), costmap=False)
    assert planner.plan(Request((2.5, 0.5, 0.0), (0.5, 0.5, 0.0))).error_code == 0
    assert planner.plan(Request((0.5, 1.5, 0.0), (0.5, 0.5, 0.0))).error_code == 206  # of the second row from below
    assert planner.plan(Request((2.5, 1.5, 0.0), (0.5, 0.5, 0.0))).error_code == 206
    with pytest.raises(MapError, match="6 cells"):
        wrong = message([[0, 0, 0], [100, 100, -1]])
        wrong.info.width = 5
        planner.take_map(wrong, costmap=False)
    assert planner.grid is not None


@pytest.mark.parametrize(
    "options",
    [
        {"radius": -1.0},
        {"max_seconds": 0},
        {"tolerance": math.nan},
        {"max_curvature": 0.0},
        {"planners": {"a": "astar"}},
    ],
)
def test_what_is_refused(options: dict[str, object]) -> None:
    with pytest.raises(ParameterError):
        PathPlanner(**options)  # type: ignore[arg-type]


def test_a_margin_leaves_the_inscribed_cells_of_a_costmap_closed() -> None:
    walls = np.zeros((40, 60), np.uint8)
    walls[10:30, 28:32] = 1
    costmap = an.GridMap(walls, 0.05).inflated(0.25, strict=True)
    answer = on(costmap, margin=0.05).plan(Request((2.8, 1.0, 0.0), (0.2, 1.0, 0.0)))
    assert answer.error_code == 0
    assert an.Trajectory(answer.poses, np.zeros(len(answer.poses)), costmap).wall_distance > 0.25


@pytest.mark.parametrize("yaw", [math.nan, math.inf])
def test_headings_that_are_no_numbers_are_an_error(yaw: float) -> None:
    for request in (Request((*GOAL[:2], yaw), START), Request(GOAL, (*START[:2], yaw))):
        assert on(GRID).plan(request).error_code == 200
