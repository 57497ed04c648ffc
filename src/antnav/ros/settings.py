"""Parameters of the planner server, and which of its goals run."""

from __future__ import annotations

import threading
from collections.abc import Mapping
from typing import Any

from antnav.plan.algorithms import algorithm
from antnav.ros.planner import PathPlanner

#: Parameters of the node and their defaults; of each planner there is one more, `<name>.algorithm`.
PARAMETERS: Mapping[str, Any] = {
    "planner_plugins": ["GridBased"],
    "map_topic": "/map",
    "costmap_topic": "",  # of a raw costmap, such as /global_costmap/costmap_raw: instead of the map
    "global_frame": "map",
    "robot_base_frame": "base_link",
    "radius": 0.0,
    "margin": 0.0,
    "tolerance": 0.5,
    "start_tolerance": 0.0,
    "allow_unknown": True,
    "max_seconds": 5.0,
    "spacing": 0.05,
    "max_curvature": 0.0,  # no limit
}
_OWN = ("radius", "margin", "tolerance", "start_tolerance", "allow_unknown", "max_seconds", "spacing")


def planner_of(values: Mapping[str, Any], algorithms: Mapping[str, str]) -> PathPlanner:
    """The planner that parameters ask for.

    Parameters
    ----------
    values : mapping
        As `PARAMETERS`.
    algorithms : mapping
        Names of antnav's planners by the names that nav2 calls them by.

    Raises
    ------
    ParameterError
        No such planner, or a number out of its range.
    """
    planners = {name: algorithm(chosen) for name, chosen in algorithms.items()}
    own = {name: values[name] for name in _OWN}
    return PathPlanner(planners, max_curvature=values["max_curvature"] or None, **own)


class Ended:
    """Whether a goal should end: by its client, or by a newer goal."""

    def __init__(self, goal: Any, newer: threading.Event) -> None:
        self._goal, self._newer = goal, newer

    def is_set(self) -> bool:
        """Asked while it is planned, since rclpy cancels a goal only after its callback has agreed."""
        return self._newer.is_set() or bool(self._goal.is_cancel_requested)


class Goals:
    """Which goals run: the newest only, as in nav2's servers."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._running: dict[bytes, threading.Event] = {}

    def begin(self, goal: bytes) -> None:
        """Let a goal run, and tell those before it to end."""
        with self._lock:
            for event in self._running.values():
                event.set()
            self._running[goal] = threading.Event()

    def event(self, goal: bytes) -> threading.Event:
        """What tells a goal to end."""
        with self._lock:
            return self._running.setdefault(goal, threading.Event())

    def end(self, goal: bytes) -> None:
        """Forget a goal, which has ended."""
        with self._lock:
            self._running.pop(goal, None)
