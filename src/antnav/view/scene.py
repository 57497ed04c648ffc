"""A scene: a map that is drawn on, a start, a goal, and the plan that is mended under the pen."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from antnav.errors import AntnavError, OccupiedError
from antnav.live.mission import Mission
from antnav.live.update import MissionStatus
from antnav.search.exact import optimum
from antnav.view.dropped import check_cells
from antnav.world.cost import CostField
from antnav.world.grid import Cell, GridMap
from antnav.world.moves import CornerRule
from antnav.world.problem import CellIndex, Problem
from antnav.world.terrain import Terrain

_WORDS = {
    MissionStatus.UNREACHABLE: "No way leads from the start to the goal: erase a wall.",
    MissionStatus.NO_PATH: "No way was found.",
    MissionStatus.START_BLOCKED: "The start is in a wall: erase it, or move the start.",
    MissionStatus.GOAL_BLOCKED: "The goal is in a wall: erase it, or move the goal.",
    MissionStatus.ARRIVED: "Start and goal are the same cell: move one of them.",
}


class Scene:
    """What all panels of a view show.

    Parameters
    ----------
    grid : GridMap
        As it is without the robot's radius.
    start, goal : (row, col)
    corner_rule : CornerRule
    radius : float
        Of the robot in metres, also for what is drawn.
    cost : CostField or None

    Raises
    ------
    AntnavError
        The map is too large, or an end lies where none can.
    """

    def __init__(
        self,
        grid: GridMap,
        start: CellIndex,
        goal: CellIndex,
        corner_rule: CornerRule | str = CornerRule.ALLOW,
        radius: float = 0.0,
        cost: CostField | None = None,
    ) -> None:
        check_cells(grid.rows, grid.cols, grid.name)
        self.grid, self.radius, self.corner_rule = grid, radius, CornerRule(corner_rule)
        problem = Problem.from_cells(grid, start, goal, corner_rule=self.corner_rule, cost=cost)
        self.mission = Mission(problem, radius=radius)
        self.edited = False
        self._optimum: float | None = None

    @classmethod
    def of(cls, grid: GridMap, start: CellIndex, goal: CellIndex, *others: Any) -> Scene:
        """The same, where an end may lie in a wall: somebody has dragged it there."""
        try:
            return cls(grid, start, goal, *others)
        except OccupiedError:
            free = np.argwhere(grid.cells == Cell.FREE)
            if not len(free):
                raise
            row, col = free[0].tolist()
            made = cls(grid, (row, col), (row, col), *others)
            made.move(start, goal)
            return made

    @property
    def cells(self) -> NDArray[np.uint8]:
        """What the map holds now, shape (rows, cols)."""
        return self.mission.terrain.grid.cells

    @property
    def bare(self) -> GridMap:
        """The map now, without the robot's radius."""
        kinds = self.cells
        cells = np.where((kinds == Cell.INFLATED) & (self.radius > 0), Cell.FREE, kinds).astype(np.uint8)
        return GridMap(cells, self.grid.resolution, self.grid.origin, name=self.grid.name)

    @property
    def prices(self) -> NDArray[np.float64] | None:
        """What cells cost now beside the way; None where none does."""
        cost = self.mission.terrain.cost
        return None if cost is None or not cost.values.any() else cost.values

    def draw(self, cells: list[tuple[int, int]], kind: str, cost: float) -> None:
        """Cells are walls now, or free, or cost something; those outside the map and under the ends' marks stay.

        Raises
        ------
        AntnavError
            A price is out of its range.
        """
        rows, cols = self.grid.shape
        places = np.array(cells, np.int64).reshape(-1, 2)
        inside = ((places >= 0) & (places < (rows, cols))).all(axis=1)
        ends = (places[:, None] == np.array([self.mission.position, self.mission.goal])).all(axis=2).any(axis=1)
        places = places[inside & ~(ends & (kind == "wall"))]
        if not len(places):
            return
        if kind == "cost":
            self.mission.change(cost=(places, np.full(len(places), cost)))
        else:
            self.mission.change(**{"blocked" if kind == "wall" else "freed": places})
        self._altered()

    def move(self, start: CellIndex | None, goal: CellIndex | None) -> None:
        """The ends lie elsewhere.

        Raises
        ------
        OutsideMapError
            Not there.
        """
        for end in (start, goal):
            if end is not None:
                self.grid.checked_cell(end)
        if start is not None:
            self.mission.moved_to(start)
        if goal is not None:
            self.mission.goal = goal
        self._altered()

    def with_rule(self, corner_rule: CornerRule | str) -> Scene:
        """The scene as it is now, under a corner rule."""
        mission = self.mission
        ends, cost = (mission.position, mission.goal), mission.terrain.cost
        new = Scene.of(self.bare, *ends, CornerRule(corner_rule), self.radius, cost)
        new.edited = self.edited
        return new

    def _altered(self) -> None:
        self.edited, self._optimum = True, None

    @property
    def problem(self) -> Problem | None:
        """For planners; None where there is nothing to plan: `words` say why."""
        if self.mission.plan.status is not MissionStatus.PLANNED:
            return None
        try:
            return self.mission.problem
        except OccupiedError:
            return None

    @property
    def words(self) -> str:
        """Why there is nothing to plan; "" where there is."""
        return _WORDS.get(self.mission.plan.status, "")

    @property
    def optimum(self) -> float:
        """Least cost of a path; inf where there is none."""
        if self._optimum is None:
            problem = self.problem
            self._optimum = np.inf if problem is None else float(optimum(problem).cost)
        return self._optimum

    def plan(self) -> dict[str, Any]:
        """The plan of the mission, as it was mended last."""
        update = self.mission.plan
        return {
            "status": update.status,
            "did": update.reason,
            "milliseconds": round(1e3 * update.seconds, 3),
            "cost": update.cost if update else None,
        }


def ends_of(grid: GridMap, corner_rule: CornerRule | str = CornerRule.ALLOW) -> tuple[CellIndex, CellIndex]:
    """Two cells far from each other in the largest part of a map that ways join: where it says nothing of ends.

    Raises
    ------
    AntnavError
        No two free cells are joined.
    """
    terrain = Terrain.of(grid, corner_rule, False)
    components = terrain.components.reshape(grid.rows + 2, -1)[1:-1, 1 : grid.cols + 1]
    sizes = np.bincount(components.ravel())
    sizes[0] = 0
    there = np.argwhere(components == int(sizes.argmax()))
    if not sizes.any():
        raise AntnavError(grid.name or "the map", "it has no two free cells side by side", "choose another map")
    sums = there.sum(axis=1)
    one, other = there[int(sums.argmin())], there[int(sums.argmax())]
    return (int(one[0]), int(one[1])), (int(other[0]), int(other[1]))
