"""Messages of rclpy to plain values and back, without importing it."""

from __future__ import annotations

import math
from typing import Any

from antnav.exchange.messages import quaternions, yaw_of
from antnav.ros.planner import Answer, Pose


def pose_of(message: Any) -> Pose:
    """What a geometry_msgs/Pose says of the plane."""
    return message.position.x, message.position.y, yaw_of(message.orientation)


def moved(pose: Pose, transform: Any) -> Pose:
    """A pose in another frame.

    Parameters
    ----------
    transform : geometry_msgs/Transform
        From the frame of the pose.
    """
    yaw, shift = yaw_of(transform.rotation), transform.translation
    cos, sin = math.cos(yaw), math.sin(yaw)
    x, y, heading = pose
    return shift.x + cos * x - sin * y, shift.y + sin * x + cos * y, heading + yaw


def fill_path(path: Any, answer: Answer, pose_stamped: Any) -> None:
    """Put an answer's poses into a nav_msgs/Path whose header is set.

    Parameters
    ----------
    pose_stamped : type
        geometry_msgs/PoseStamped.
    """
    for (x, y, _), turn in zip(answer.poses.tolist(), quaternions(answer.poses[:, 2]).tolist(), strict=True):
        one = pose_stamped()
        one.header = path.header
        one.pose.position.x, one.pose.position.y = x, y
        for axis, part in zip("xyzw", turn, strict=True):
            setattr(one.pose.orientation, axis, part)
        path.poses.append(one)


def fill_result(result: Any, answer: Answer) -> None:
    """Put all but the path into a result of ComputePathToPose; humble's has no error code, jazzy's has both."""
    whole = int(answer.seconds)
    result.planning_time.sec, result.planning_time.nanosec = whole, int((answer.seconds - whole) * 1e9)
    for name in ("error_code", "error_msg"):
        if hasattr(result, name):
            setattr(result, name, getattr(answer, name))
