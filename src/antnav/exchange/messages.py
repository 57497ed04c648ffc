"""Messages of ROS from poses and maps, and maps from messages."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from antnav.exchange.bag import Recorded, typestore
from antnav.world.grid import GridMap

PATH = "nav_msgs/msg/Path"
GRID = "nav_msgs/msg/OccupancyGrid"
COSTMAP = "nav2_msgs/msg/Costmap"
#: Occupancy of the cells, in the order of `Cell`. Inflated ones have 99, as nav2 publishes its costmaps: robots whose
#: centre is there touch, but nothing stands there.
OCCUPANCY = np.array([0, 100, -1, 99], np.int8)


def quaternions(headings: ArrayLike) -> NDArray[np.float64]:
    """Turns about the z axis as (x, y, z, w), shape (..., 4)."""
    half = np.asarray(headings, np.float64) / 2
    return np.stack((np.zeros_like(half), np.zeros_like(half), np.sin(half), np.cos(half)), axis=-1)


def yaw_of(orientation: Any) -> float:
    """Heading in radians of an orientation; that of the x axis seen from above."""
    x, y, z, w = orientation.x, orientation.y, orientation.z, orientation.w
    return math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)) + 0.0


def clock(stamp: float, after: float = 0.0) -> tuple[int, int]:
    """Seconds and nanoseconds of a time so many seconds after a stamp."""
    part, whole = math.modf(stamp)  # apart: seconds since 1970 leave a float64 no room for nanoseconds
    seconds, nanoseconds = divmod(round(part * 1e9) + round(after * 1e9), 10**9)
    return int(whole) + seconds, nanoseconds


def path_message(poses: NDArray[np.float64], times: NDArray[np.float64] | None, frame: str, stamp: float) -> Recorded:
    """nav_msgs/Path on /plan; with times each pose is stamped with when it is reached.

    Parameters
    ----------
    poses : ndarray of float64, shape (k, 3)
        x and y in metres, heading in radians.
    times : ndarray of float64, shape (k,), optional
        Seconds after the stamp.
    """
    kinds = typestore().types
    header, time = kinds["std_msgs/msg/Header"], kinds["builtin_interfaces/msg/Time"]
    point, turn = kinds["geometry_msgs/msg/Point"], kinds["geometry_msgs/msg/Quaternion"]
    pose, stamped = kinds["geometry_msgs/msg/Pose"], kinds["geometry_msgs/msg/PoseStamped"]
    heads = [
        header(time(*clock(stamp, after)), frame) for after in (times if times is not None else [0.0] * len(poses))
    ]
    places = (
        pose(point(x, y, 0.0), turn(*q))
        for (x, y), q in zip(poses[:, :2].tolist(), quaternions(poses[:, 2]).tolist(), strict=True)
    )
    all_poses = [stamped(head, place) for head, place in zip(heads, places, strict=True)]
    return Recorded("/plan", PATH, kinds[PATH](header(time(*clock(stamp)), frame), all_poses))


def grid_message(grid: GridMap, frame: str, stamp: float) -> Recorded:
    """nav_msgs/OccupancyGrid on /map, rows from the bottom up."""
    kinds = typestore().types
    time = kinds["builtin_interfaces/msg/Time"](*clock(stamp))
    x, y, yaw = grid.origin
    turn = kinds["geometry_msgs/msg/Quaternion"](*quaternions(yaw).tolist())
    origin = kinds["geometry_msgs/msg/Pose"](kinds["geometry_msgs/msg/Point"](x, y, 0.0), turn)
    info = kinds["nav_msgs/msg/MapMetaData"](time, grid.resolution, grid.cols, grid.rows, origin)
    data = np.ascontiguousarray(OCCUPANCY[grid.cells[::-1]]).ravel()
    return Recorded("/map", GRID, kinds[GRID](kinds["std_msgs/msg/Header"](time, frame), info, data), latched=True)
