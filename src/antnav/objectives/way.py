"""Objectives of moves: length, risk, time, energy."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from antnav.errors import ParameterError, check_type, shown
from antnav.objectives.objective import Objective, over_cells
from antnav.values import finite_number
from antnav.world.cost import CostField
from antnav.world.grid_graph import GridGraph
from antnav.world.path_cost import PathCost
from antnav.world.terrain import Terrain


@dataclass(frozen=True)
class Length(Objective):
    """Metres between the centres of cells."""

    name: str = "length"
    unit: str = "m"

    def edges(self, terrain: Terrain, graph: GridGraph) -> NDArray[np.float64]:
        """1 or sqrt(2) times the resolution."""
        return graph.graph.lengths * terrain.grid.resolution


@dataclass(frozen=True, eq=False)
class Risk(Objective):
    """A cost field along the path: metres times the mean of the fields of each move's two cells.

    ::

        risk(a -> b) = |a - b| (field(a) + field(b)) / 2

    Parameters
    ----------
    field : CostField
        Made by `antnav.costs`, such as `clearance`. Cells that it blocks are closed for `Problem(cost=...)` only.
    name : str, optional
        Default: "risk".
    """

    field: CostField
    name: str = "risk"
    unit: str = "m"

    def __post_init__(self) -> None:
        check_type("field", self.field, CostField, "make one with antnav.costs, such as costs.clearance(grid, 0.5)")
        if self.field.slope:
            raise ParameterError(f"field {self.field.name}", "slopes are no risk of a cell", "give them to Energy")

    def edges(self, terrain: Terrain, graph: GridGraph) -> NDArray[np.float64]:
        """See the class."""
        self.field.check_fits(terrain.grid)
        return over_cells(self.field.values, graph) * terrain.grid.resolution


@dataclass(frozen=True, eq=False)
class Time(Objective):
    """Seconds at a speed that slow zones lower.

    ::

        time(a -> b) = |a - b| (1 + (zones(a) + zones(b)) / 2) / speed

    Parameters
    ----------
    speed : float
        Metres per second where nothing slows down, > 0.
    zones : CostField, optional
        What `antnav.costs.speed` makes of a speed mask: full speed over limit, less 1.
    """

    speed: float = 1.0
    zones: CostField | None = None
    name: str = "time"
    unit: str = "s"

    def __post_init__(self) -> None:
        if not finite_number(self.speed) > 0:
            raise ParameterError(f"speed {shown(self.speed)}", "it is above 0 metres per second", "give one, such as 1")
        check_type("zones", self.zones, CostField | None, "make them with antnav.costs.speed, or leave them out")
        if self.zones is not None and self.zones.slope:
            raise ParameterError("zones with slopes", "time is of zones that slow down", "give slopes to Energy")

    def edges(self, terrain: Terrain, graph: GridGraph) -> NDArray[np.float64]:
        """See the class."""
        return _costs(self.zones, terrain, graph) / float(self.speed)


@dataclass(frozen=True, eq=False)
class Energy(Objective):
    """The work of a way over slopes, in metres of level way: its length, and what a field of slopes adds.

    Parameters
    ----------
    slopes : CostField
        Made by `antnav.costs.slope`: another price up than down.
    """

    slopes: CostField
    name: str = "energy"
    unit: str = "m"

    def __post_init__(self) -> None:
        check_type("slopes", self.slopes, CostField, "make them with antnav.costs.slope")

    def edges(self, terrain: Terrain, graph: GridGraph) -> NDArray[np.float64]:
        """See the class."""
        return _costs(self.slopes, terrain, graph)


def _costs(field: CostField | None, terrain: Terrain, graph: GridGraph) -> NDArray[np.float64]:
    """Metres, and what a field adds, by the one formula for what a move costs."""
    return PathCost(field).on(terrain.grid).edges(graph.graph, graph.flat) * terrain.grid.resolution
