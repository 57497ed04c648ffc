"""What a planner server of nav2 answers, without ROS: maps in, goals in, poses and error codes out."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from antnav.errors import AntnavError, EndpointError, ParameterError, check_type, shown
from antnav.maps.bag import grid_of
from antnav.plan.solve import solve
from antnav.planner import nav2
from antnav.planner.exact import astar
from antnav.planner.planner import Planner
from antnav.planner.result import Result
from antnav.run.channel import Asked
from antnav.run.stop import Seconds
from antnav.values import finite_number
from antnav.world.grid import GridMap
from antnav.world.problem import Problem

#: Error codes of ComputePathToPose that no `Result` and no `EndpointError` has.
NONE, UNKNOWN, INVALID_PLANNER, TF_ERROR, TIMEOUT = 0, 200, 201, 202, 207

Pose = tuple[float, float, float]  #: x and y in metres, yaw in radians, in the frame of the map


@dataclass(frozen=True)
class Request:
    """A goal of nav2_msgs/ComputePathToPose.

    Attributes
    ----------
    goal : Pose or None
        None where it could not be transformed into the frame of the map.
    start : Pose or None
        With `use_start` what the goal says, else where the robot is; None where nobody knows.
    planner_id : str
        Empty: the only planner.
    """

    goal: Pose | None
    start: Pose | None
    planner_id: str = ""


@dataclass(frozen=True)
class Answer:
    """A result of nav2_msgs/ComputePathToPose.

    Attributes
    ----------
    poses : ndarray of float64, shape (k, 3)
        x and y in metres, yaw in radians; none where there is an error.
    error_code : int
        0 none, 200 unknown, 201 no such planner, 202 no transform, 203 and 204 start and goal outside the map, 205 and
        206 occupied, 207 out of time, 208 no path.
    error_msg : str
    seconds : float
        Planning took so long.
    canceled : bool
        Whether it ended because it was told to.
    """

    poses: NDArray[np.float64] = field(default_factory=lambda: np.zeros((0, 3)))
    error_code: int = NONE
    error_msg: str = ""
    seconds: float = 0.0
    canceled: bool = False


@dataclass
class PathPlanner:
    """Plans on the map that it was given last.

    Parameters
    ----------
    planners : mapping of str to Planner
        By the names that `planner_id` may have.
    radius, margin : float
        Metres to keep from the edges of occupied cells; 0 on a costmap, whose inscribed cells are closed.
    tolerance, start_tolerance : float
        Metres, see `Problem`.
    allow_unknown : bool
        Whether paths may cross unknown cells, as nav2's planners do by default.
    max_seconds : float
        Limit of each search.
    spacing : float
        Metres from pose to pose, at most.
    max_curvature : float or None
        In 1/m: the curve then begins and ends in the poses' headings, too. None: only the last pose has the goal's.

    Attributes
    ----------
    grid : GridMap or None
        The map with the robot's radius; None before one has come.
    """

    planners: Mapping[str, Planner] = field(default_factory=lambda: {"GridBased": astar()})
    radius: float = 0.0
    margin: float = 0.0
    tolerance: float = 0.5
    start_tolerance: float = 0.0
    allow_unknown: bool = True
    max_seconds: float = 5.0
    spacing: float = 0.05
    max_curvature: float | None = None
    grid: GridMap | None = field(init=False, default=None)

    def __post_init__(self) -> None:
        for name, planner in self.planners.items():
            check_type(f"planner {name}", planner, Planner, "make one with antnav.algorithm")
        least = {"radius": 0.0, "margin": 0.0, "tolerance": 0.0, "start_tolerance": 0.0, "max_seconds": 1e-3}
        for name, bound in (least | {"spacing": 1e-4}).items():
            if not finite_number(getattr(self, name)) >= bound:
                rule = f"it is a finite number, >= {bound:g}"
                raise ParameterError(f"{name} {shown(getattr(self, name))}", rule, "give one")
        if self.max_curvature is not None and not finite_number(self.max_curvature) > 0:
            rule = "it is a finite number, > 0"
            raise ParameterError(f"max_curvature {shown(self.max_curvature)}", rule, "give one, or None")

    def take_map(self, message: Any, *, costmap: bool) -> None:
        """Plan on the map of a message from now on.

        Parameters
        ----------
        message : nav_msgs/OccupancyGrid or nav2_msgs/Costmap

        Raises
        ------
        MapError
            It is none; the old map is kept.
        """
        self.use(grid_of(message, "the map's message", "map", costmap=costmap))

    def use(self, grid: GridMap) -> None:
        """Plan on a map from now on."""
        self.grid = grid.inflated(self.radius + self.margin, strict=True)

    def plan(self, request: Request, cancel: Asked | None = None) -> Answer:
        """The answer to a request; no error of antnav's leaves it.

        Parameters
        ----------
        request : Request
        cancel : threading.Event, optional
            Set it from elsewhere, and the answer comes at once.
        """
        begin = time.perf_counter()
        try:
            answer = self._answer(request, cancel)
        except AntnavError as error:
            code = error.nav2_code if isinstance(error, EndpointError) else UNKNOWN
            answer = Answer(error_code=code, error_msg=str(error))
        canceled = cancel is not None and cancel.is_set()
        poses = answer.poses if not canceled else answer.poses[:0]
        return Answer(poses, answer.error_code, answer.error_msg, time.perf_counter() - begin, canceled)

    def _answer(self, request: Request, cancel: Asked | None) -> Answer:
        planner, grid = self._planner(request.planner_id), self.grid
        if planner is None:
            text = f"planner_id {shown(request.planner_id)}: the planners are {', '.join(self.planners)}"
            return Answer(error_code=INVALID_PLANNER, error_msg=text)
        if grid is None:
            return Answer(error_code=TIMEOUT, error_msg="no map has come yet")
        if request.start is None or request.goal is None:
            end = "start" if request.start is None else "goal"
            return Answer(error_code=TF_ERROR, error_msg=f"the {end} is not known in the frame of the map")
        if not all(map(math.isfinite, (*request.start, *request.goal))):
            return Answer(error_code=UNKNOWN, error_msg="the poses of start and goal are finite numbers")
        problem = Problem(
            grid,
            request.start[:2],
            request.goal[:2],
            allow_unknown=self.allow_unknown,
            goal_tolerance=self.tolerance,
            start_tolerance=self.start_tolerance,
        )
        result = solve(problem, planner, stop=Seconds(self.max_seconds), cancel=cancel)
        if result.path is None:
            return Answer(error_code=nav2.code_of(result), error_msg=f"{planner.name}: {result.status}")
        return Answer(self._poses(result, request.start[2], request.goal[2]))

    def _planner(self, name: str) -> Planner | None:
        if not name and len(self.planners) == 1:
            return next(iter(self.planners.values()))
        return self.planners.get(name)

    def _poses(self, result: Result, start: float, goal: float) -> NDArray[np.float64]:
        """A curve along the path, or the path itself where its ends are too near to walls for one."""
        assert result.path is not None
        bent = self.max_curvature is not None
        try:
            poses = result.trajectory(
                spacing=self.spacing,
                radius=self.radius or None,
                margin=self.margin,
                max_curvature=self.max_curvature,
                start_heading=start if bent else None,
                goal_heading=goal if bent else None,
            ).poses.copy()
        except ParameterError:
            poses = np.column_stack((result.path.points, result.path.headings))
        poses[-1, 2] = math.remainder(goal, math.tau)
        return poses
