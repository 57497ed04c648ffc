"""What a mission answers: the plan in force, and what has become of the one before."""

from __future__ import annotations

from enum import StrEnum
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from antnav.world.grid import GridMap
from antnav.world.path import length_of


class MissionStatus(StrEnum):
    """How a mission stands.

    - planned: there is a path
    - arrived: the robot is at the goal
    - unreachable: no path leads to the goal
    - no_path: none was found, by ants that may have missed one
    - start_blocked: the robot's own cell is closed
    - goal_blocked: the goal's cell is closed
    """

    PLANNED = "planned"
    ARRIVED = "arrived"
    UNREACHABLE = "unreachable"
    NO_PATH = "no_path"
    START_BLOCKED = "start_blocked"
    GOAL_BLOCKED = "goal_blocked"


class Update:
    """The plan after a change, a move or some improvement.

    Attributes
    ----------
    status : MissionStatus
    flat : ndarray of int32 or None
        The path as flat cells of the padded map; None where there is none.
    cost : float
        Of the path, in cells; its length where the map has no costs; inf without a path.
    reason : str
        What was done: "planned anew", "kept" (the plan before, or what is left of it), "replanned", "no way".
    altered : int
        Cells whose moves or prices the change has altered.
    seconds : float
        Wall time of the call.
    """

    def __init__(
        self,
        status: MissionStatus,
        flat: NDArray[np.int32] | None,
        cost: float,
        reason: str,
        altered: int,
        seconds: float,
        before: NDArray[np.int32] | None,
        grid: GridMap,
    ) -> None:
        self.status, self.flat, self.cost, self.reason = status, flat, cost, reason
        self.altered, self.seconds = altered, seconds
        self._before, self._grid = before, grid

    def __bool__(self) -> bool:
        """Whether there is a path."""
        return self.flat is not None

    def __repr__(self) -> str:
        cost = f", cost={self.cost:.2f}" if self else ""
        return f"Update({self.status}, {self.reason}{cost}, {self.seconds * 1e3:.3g} ms)"

    @cached_property
    def cells(self) -> NDArray[np.int32] | None:
        """Rows and columns of the path, shape (k, 2), the robot's cell first; None without one."""
        if self.flat is None:
            return None
        width = self._grid.cols + 2
        return np.stack((self.flat // width - 1, self.flat % width - 1), axis=-1).astype(np.int32)

    @cached_property
    def points(self) -> NDArray[np.float64] | None:
        """Centres of the path's cells in metres, shape (k, 2); None without a path."""
        return None if self.cells is None else self._grid.cell_to_world(self.cells)

    @cached_property
    def length(self) -> float:
        """Length of the path in cells; inf without one."""
        return np.inf if self.cells is None else length_of(self.cells)

    @cached_property
    def changed_share(self) -> float:
        """Share of the path's cells, 0 to 1, that the plan before did not lead through; 0 without a path."""
        if self.flat is None or self.flat is self._before:
            return 0.0
        if self._before is None:
            return 1.0
        return float(np.isin(self.flat, self._before, invert=True).mean())
