"""Trajectory: poses along a curve, and what can be measured on them."""

from __future__ import annotations

import math
import os
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from antnav.errors import check_type
from antnav.kernels import grid_kernels, trajectory_kernels
from antnav.trajectories import files
from antnav.trajectories.footprint import Footprint
from antnav.trajectories.ground import to_plane
from antnav.values import read_only
from antnav.world.grid import MAX_CELLS, GridMap

SCHEMA = "antnav/trajectory"


@dataclass(frozen=True, eq=False)
class Trajectory:
    """What a robot drives: poses no farther apart than the spacing, from the exact start to the exact goal.

    Attributes
    ----------
    poses : ndarray of float64, shape (k, 3)
        x and y in metres, heading in radians in [-pi, pi].
    curvature : ndarray of float64, shape (k,)
        In 1/m, positive to the left. Where a heading jumps, the place is there twice, with infinite curvature: the
        robot turns on the spot.
    grid : GridMap
    radius, margin : float
        Metres that the curve keeps from occupied cells, together; 0 where no radius was given.
    smooth : bool
        Whether the curve has no corners and keeps the limit of curvature. Else it is the shortened line with corners.
    note : str
        Why it is not smooth, or what else a reader must know; empty where there is nothing.
    footprint : Footprint or None
        Of a robot that is no disc: what keeps `margin` from occupied cells, turned as the poses are; `radius` is then
        its inscribed radius.
    speeds, times : ndarray of float64, shape (k,), or None
        m/s at each pose, and seconds until it is reached; None where no limits were given.
    """

    poses: NDArray[np.float64] = field(repr=False)
    curvature: NDArray[np.float64] = field(repr=False)
    grid: GridMap
    radius: float = 0.0
    margin: float = 0.0
    smooth: bool = True
    note: str = ""
    speeds: NDArray[np.float64] | None = field(default=None, repr=False)
    times: NDArray[np.float64] | None = field(default=None, repr=False)
    footprint: Footprint | None = field(default=None, repr=False)

    def __post_init__(self) -> None:
        for array in (self.poses, self.curvature, self.speeds, self.times):
            if array is not None:
                read_only(array)

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self.__post_init__()  # pickling drops the flags

    def __len__(self) -> int:
        return len(self.poses)

    def __repr__(self) -> str:
        kind = "smooth" if self.smooth else "with corners"
        return (
            f"Trajectory({len(self)} poses, {self.length:.3f} m, {kind}, curvature up to {self.max_curvature:.3g} / m, "
            f"{self.wall_distance:.3f} m from walls)"
        )

    @property
    def points(self) -> NDArray[np.float64]:
        """Places in metres, shape (k, 2)."""
        return self.poses[:, :2]

    @cached_property
    def arc_length(self) -> NDArray[np.float64]:
        """Metres driven up to each pose, along the arcs, shape (k,)."""
        chords = np.hypot(*np.diff(self.points, axis=0).T)
        half = np.abs(np.remainder(np.diff(self.poses[:, 2]) + math.pi, math.tau) - math.pi) / 2
        bent = np.where((chords > 0) & (half > 1e-6), half / np.sin(np.maximum(half, 1e-6)), 1.0)
        return read_only(np.concatenate(([0.0], np.cumsum(chords * bent))))

    @property
    def length(self) -> float:
        """Length in metres."""
        return float(self.arc_length[-1])

    @property
    def duration(self) -> float | None:
        """Seconds from start to goal; None without speeds."""
        return None if self.times is None else float(self.times[-1])

    @cached_property
    def max_curvature(self) -> float:
        """Largest absolute curvature in 1/m; inf where the robot turns on the spot."""
        return float(np.abs(self.curvature).max(initial=0.0))

    @cached_property
    def wall_distance(self) -> float:
        """Distance in metres of the line through the poses from the squares of occupied cells; inf without any.

        The line is that of the robot's centre, whatever its radius or footprint.
        """
        line = to_plane(self.grid, np.concatenate((self.points, self.points[-1:])))
        cells = np.clip(np.rint(line[:, ::-1]), 0, np.array(self.grid.shape) - 1).astype(np.int32)
        near = float(grid_kernels.distance_to_walls(self.grid.rows_to_wall, cells, False))
        if not near < MAX_CELLS:
            return math.inf
        return float(trajectory_kernels.least_distance(self.grid.cells, line, near + 2.0)) * self.grid.resolution

    def to_dict(self) -> dict[str, Any]:
        """All that a file says, as JSON types; infinities are None."""
        more: dict[str, Any] = {}
        if self.speeds is not None and self.times is not None:
            more |= {"duration_s": self.duration, "speeds": self.speeds.tolist(), "times": self.times.tolist()}
        if self.footprint is not None:
            more["footprint"] = self.footprint.points
        return {
            "schema": SCHEMA,
            "version": 1,
            "radius": self.radius,
            "margin": self.margin,
            "smooth": self.smooth,
            "note": self.note,
            "length_m": self.length,
            "max_curvature": _finite(self.max_curvature),
            "wall_distance_m": _finite(self.wall_distance),
            "poses": self.poses.tolist(),
            "arc_length": self.arc_length.tolist(),
            "curvature": [_finite(value) for value in self.curvature.tolist()],
        } | more

    def save(self, path: str | os.PathLike[str], *, frame: str = "map", stamp: float = 0.0) -> None:
        """Write the trajectory, whole or not at all, in the format that the name's ending says.

        ======================= ================================================================================
        .csv                    one line a pose: s, x and y in metres, heading in radians, curvature in 1/m, and
                                where there are speeds, these in m/s, and seconds
        .json, .yaml            that, and what is known of the whole
        .geojson                a LineString in metres of the map's frame, not in degrees on the Earth
        .ros2.yaml              nav_msgs/Path, as ``ros2 topic pub`` takes it
        .mcap, .rosbag2         a bag, one file or a folder, with nav_msgs/Path on /plan and the map on /map; needs
                                the extra ``antnav[ros]``
        ======================= ================================================================================

        Parameters
        ----------
        frame : str
            Of messages, as their `frame_id`.
        stamp : float
            Of messages, in seconds since 1970. With speeds, each pose has that of the time at which it is reached.

        Raises
        ------
        ParameterError
            Another ending; no such frame or stamp; rosbags is missing.
        OutputError
            The file cannot be written.
        """
        files.save(self, path, frame, stamp)

    @classmethod
    def load(cls, path: str | os.PathLike[str], grid: GridMap) -> Self:
        """Read what `save` wrote as .json or .csv; `check_trajectory` tells whether it is clear on a map.

        Parameters
        ----------
        path : path-like
            A CSV file says neither radius nor margin.
        grid : GridMap

        Raises
        ------
        ResultFormatError
            No such file, or no trajectory.
        ParameterError
            Another ending.
        """
        check_type("grid", grid, GridMap, "load one with load_map")
        return cls(grid=grid, **files.load(path, SCHEMA))


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None
