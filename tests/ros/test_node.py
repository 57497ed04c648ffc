"""The node, on stand-ins for ROS: what it asks of the planner, and what becomes of goals."""

from __future__ import annotations

import importlib
import math
import sys
from typing import Any

import numpy as np
import pytest

from antnav.errors import ParameterError
from antnav.ros.settings import Goals
from tests.ros import fake
from tests.ros.fake import Goal, Record


def node_of(monkeypatch: pytest.MonkeyPatch, **given: object) -> Any:
    fake.install(monkeypatch, **given)
    return importlib.import_module("antnav.ros.node").PlannerNode()


def grid(values: np.ndarray, resolution: float = 0.1) -> Record:
    rows, cols = values.shape
    return Record(info=Record(resolution=resolution, width=cols, height=rows), data=values.astype(np.int8).ravel())


def stamped(x: float, y: float, yaw: float = 0.0, frame: str = "map") -> Record:
    turn = Record(z=math.sin(yaw / 2), w=math.cos(yaw / 2))
    return Record(header=Record(frame_id=frame), pose=Record(position=Record(x=x, y=y), orientation=turn))


@pytest.fixture
def node(monkeypatch: pytest.MonkeyPatch) -> Any:
    made = node_of(monkeypatch, radius=0.2)
    made.on_map(grid(np.zeros((40, 40))))
    return made


def test_a_goal_with_a_start(node: Any) -> None:
    goal = Goal(node, 1, goal=stamped(3.0, 3.0, 1.0), start=stamped(1.0, 1.0), use_start=True)
    node.on_accepted(goal)
    assert goal.state == "succeeded"
    path = goal.result.path
    assert (path.header.frame_id, path.header.stamp) == ("map", "now")
    assert (path.poses[0].pose.position.x, path.poses[-1].pose.position.x) == (1.0, 3.0)
    assert path.poses[-1].pose.orientation.z == pytest.approx(math.sin(0.5))
    assert all(one.header is path.header for one in path.poses)
    assert node.published == [path]
    assert goal.result.error_code == 0
    assert goal.result.planning_time.sec + goal.result.planning_time.nanosec > 0


def test_the_robot_is_the_start_and_goals_of_other_frames_are_moved(node: Any) -> None:
    quarter = Record(z=math.sin(math.pi / 4), w=math.cos(math.pi / 4))
    node.transforms.known["map", "base_link"] = Record(translation=Record(x=1.0, y=1.5), rotation=Record())
    node.transforms.known["map", "odom"] = Record(translation=Record(x=2.0, y=0.5), rotation=quarter)
    goal = Goal(node, 1, goal=stamped(1.0, -1.0, 0.25, "odom"), use_start=False)
    node.on_accepted(goal)
    first, last = (goal.result.path.poses[at].pose for at in (0, -1))
    assert (first.position.x, first.position.y) == (1.0, 1.5)
    assert (last.position.x, last.position.y) == pytest.approx((3.0, 1.5))
    assert 2 * math.atan2(last.orientation.z, last.orientation.w) == pytest.approx(0.25 + math.pi / 2)


def test_errors_abort_with_their_code(node: Any) -> None:
    lost = Goal(node, 1, goal=stamped(3.0, 3.0), use_start=False)
    node.on_accepted(lost)
    assert (lost.state, lost.result.error_code) == ("aborted", 202)
    outside = Goal(node, 2, goal=stamped(9.0, 3.0), start=stamped(1.0, 1.0), use_start=True)
    node.on_accepted(outside)
    assert (outside.state, outside.result.error_code) == ("aborted", 204)
    assert "9.0" in outside.result.error_msg
    assert not node.published
    assert len(node.said) == 2


def test_humble_has_no_error_code(node: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        sys.modules["antnav.ros.node"].ComputePathToPose,
        "Result",
        lambda: fake.SimpleNamespace(path=Record(), planning_time=Record()),
    )
    goal = Goal(node, 1, goal=stamped(9.0, 3.0), start=stamped(1.0, 1.0), use_start=True)
    node.on_accepted(goal)
    assert goal.state == "aborted"
    assert set(vars(goal.result)) == {"path", "planning_time"}


def test_a_goal_is_canceled(node: Any) -> None:
    goal = Goal(node, 1, goal=stamped(3.0, 3.0), start=stamped(1.0, 1.0), use_start=True)
    assert node.server.cancel_callback(goal) == "accept"
    goal.is_cancel_requested = True
    node.on_accepted(goal)
    assert goal.state == "canceled"


def test_a_newer_goal_ends_the_older_one(node: Any) -> None:
    older = Goal(node, 1, goal=stamped(3.0, 3.0), start=stamped(1.0, 1.0), use_start=True)
    newer = Goal(node, 2, goal=stamped(2.0, 3.0), start=stamped(1.0, 1.0), use_start=True)
    plan = node.planner.plan

    def interrupted(*args: object, **options: object) -> object:
        node.planner.plan = plan
        node.on_accepted(newer)
        return plan(*args, **options)

    node.planner.plan = interrupted
    node.on_accepted(older)
    assert (older.state, newer.state) == ("aborted", "succeeded")


def test_a_wrong_map_leaves_the_old_one(node: Any) -> None:
    before, wrong = node.planner.grid, grid(np.zeros((3, 3)))
    wrong.info.width = 4
    node.on_map(wrong)
    assert node.planner.grid is before
    assert "9 cells" in node.said[0]


def test_what_it_listens_to(monkeypatch: pytest.MonkeyPatch) -> None:
    plain = node_of(monkeypatch)
    assert (plain.maps.kind.__name__, plain.maps.topic) == ("OccupancyGrid", "/map")
    costs = node_of(monkeypatch, costmap_topic="/global_costmap/costmap_raw")
    assert (costs.maps.kind.__name__, costs.maps.topic) == ("Costmap", "/global_costmap/costmap_raw")
    meta = Record(size_x=2, size_y=1, resolution=0.5)
    costs.on_map(Record(metadata=meta, data=np.array([0, 254], np.uint8)))
    assert costs.planner.grid.cells.tolist() == [[0, 1]]


def test_parameters(monkeypatch: pytest.MonkeyPatch) -> None:
    made = node_of(
        monkeypatch, **{"planner_plugins": ["A", "B"], "B.algorithm": "npaco", "max_curvature": 2.0, "tolerance": 0.25}
    )
    assert [planner.name for planner in made.planner.planners.values()] == ["astar", "npaco"]
    assert (made.planner.max_curvature, made.planner.tolerance) == (2.0, 0.25)
    with pytest.raises(ParameterError, match="algorithm 'no'"):
        node_of(monkeypatch, **{"GridBased.algorithm": "no"})


def test_goals_forget_what_has_ended() -> None:
    goals = Goals()
    goals.begin(b"a")
    one = goals.event(b"a")
    goals.end(b"a")
    goals.begin(b"b")
    assert not one.is_set()
    goals.begin(b"c")
    assert goals.event(b"b").is_set()
    assert not goals.event(b"c").is_set()
