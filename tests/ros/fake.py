"""Stand-ins for the modules of ROS that the node imports: what it calls of them, and what these give back."""

from __future__ import annotations

import sys
from types import ModuleType, SimpleNamespace
from typing import Any

import pytest


class Record(SimpleNamespace):
    """A message whose parts come to be when they are first named; numbers begin with 0."""

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        numbers = {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0, "sec": 0, "nanosec": 0}
        made = numbers.get(name, [] if name == "poses" else Record())
        setattr(self, name, made)
        return made


class TransformException(Exception):  # noqa: N818  its name in tf2_ros
    pass


class Buffer:
    def __init__(self) -> None:
        self.known: dict[tuple[str, str], Record] = {}

    def lookup_transform(self, target: str, source: str, _when: object) -> Record:
        if (target, source) not in self.known:
            raise TransformException(f"{source} to {target}")
        return Record(transform=self.known[target, source])


class Node:
    given: dict[str, object] = {}  # noqa: RUF012  parameters of the test

    def __init__(self, name: str) -> None:
        self.name, self.said, self.published = name, [], []

    def declare_parameter(self, name: str, default: object) -> SimpleNamespace:
        return SimpleNamespace(value=self.given.get(name, default))

    def create_subscription(self, kind: type, topic: str, hear: Any, profile: object) -> SimpleNamespace:
        return SimpleNamespace(kind=kind, topic=topic, hear=hear, profile=profile)

    def create_publisher(self, *_: object) -> SimpleNamespace:
        return SimpleNamespace(publish=self.published.append)

    def get_logger(self) -> SimpleNamespace:
        return SimpleNamespace(warning=self.said.append, error=self.said.append)

    def get_clock(self) -> Any:
        return SimpleNamespace(now=lambda: SimpleNamespace(to_msg=lambda: "now"))


class Goal:
    """A goal handle of rclpy's action server."""

    def __init__(self, server: Any, number: int, **request: object) -> None:
        self.server, self.goal_id = server, SimpleNamespace(uuid=[number] * 16)
        self.request, self.state, self.is_cancel_requested = Record(planner_id="", **request), "", False

    def execute(self) -> None:
        self.result = self.server.execute(self)

    def succeed(self) -> None:
        self.state = "succeeded"

    def abort(self) -> None:
        self.state = "aborted"

    def canceled(self) -> None:
        self.state = "canceled"


class Result(SimpleNamespace):
    """Of ComputePathToPose as in jazzy."""

    def __init__(self) -> None:
        super().__init__(path=Record(), planning_time=Record(), error_code=0, error_msg="")


def install(monkeypatch: pytest.MonkeyPatch, **given: object) -> None:
    """Let `import rclpy` and the others find the stand-ins; the node's parameters have other values where given."""
    monkeypatch.setattr(Node, "given", given)
    action = SimpleNamespace(Result=Result)
    parts: dict[str, dict[str, object]] = {
        "rclpy": {},
        "rclpy.time": {"Time": lambda: 0},
        "rclpy.action": {
            "ActionServer": lambda *args, **options: SimpleNamespace(args=args, **options),
            "CancelResponse": SimpleNamespace(ACCEPT="accept"),
        },
        "rclpy.callback_groups": {"ReentrantCallbackGroup": object},
        "rclpy.node": {"Node": Node},
        "rclpy.qos": {
            "DurabilityPolicy": SimpleNamespace(TRANSIENT_LOCAL=1),
            "QoSProfile": dict,
            "ReliabilityPolicy": SimpleNamespace(RELIABLE=1),
        },
        "geometry_msgs.msg": {"PoseStamped": Record},
        "nav_msgs.msg": {"OccupancyGrid": type("OccupancyGrid", (), {}), "Path": Record},
        "nav2_msgs.action": {"ComputePathToPose": action},
        "nav2_msgs.msg": {"Costmap": type("Costmap", (), {})},
        "tf2_ros": {
            "Buffer": Buffer,
            "TransformException": TransformException,
            "TransformListener": lambda *_: None,
        },
    }
    for name, things in parts.items():
        module = ModuleType(name)
        vars(module).update(things)
        monkeypatch.setitem(sys.modules, name, module)
    sys.modules["rclpy"].time = sys.modules["rclpy.time"]  # type: ignore[attr-defined]
    monkeypatch.delitem(sys.modules, "antnav.ros.node", raising=False)
