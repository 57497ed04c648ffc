"""What a replanner is: it keeps a plan on a terrain that changes."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from antnav.live.terrain import LiveTerrain

#: Flat cells from the robot to the goal; None where there is no way.
Path = NDArray[np.int32] | None


class Replanner(ABC):
    """Keeps a path from the robot to the goal while the terrain changes under it.

    `begin` comes first; both ends are open cells whenever a method is called. What a replanner of your own returns is
    checked, move by move.

    Examples
    --------
    ::

        class Again(an.Replanner):
            name = "again"

            def begin(self, terrain, start, goal):
                self.terrain, self.goal = terrain, goal
                return self.moved(start)

            def changed(self, cells, start):
                return self.moved(start)

            def moved(self, start):
                best = an.exact.shortest_path(self.terrain.problem(start, self.goal)).path
                return None if best is None else self.terrain.flat_of("path", best.cells)


        an.Mission(problem, Again())
    """

    name: ClassVar[str] = "own"  #: for tables
    exact: ClassVar[bool] = False  #: whether every path is a cheapest one
    source: ClassVar[str] = ""  #: who described it
    certain: bool = True  #: whether there is no way where it finds none
    serves: LiveTerrain | None = None  #: of the one mission that it is for, the latest
    did: str = "replanned"  #: what the latest call has done to the path, in a word

    def prepare(self) -> None:  # noqa: B027
        """Compile or load what it needs, before anything is measured."""

    @abstractmethod
    def begin(self, terrain: LiveTerrain, start: int, goal: int) -> Path:
        """Plan anew, whatever was before."""

    @abstractmethod
    def changed(self, cells: NDArray[np.int32], start: int) -> Path:
        """Moves or prices of some cells of the terrain are others now; the robot may have moved, too."""

    @abstractmethod
    def moved(self, start: int) -> Path:
        """The robot is somewhere else on the same terrain."""

    def altered(self, cells: NDArray[np.int32]) -> None:  # noqa: B027
        """As `changed`, but an end is closed: there is nothing to plan until `begin`."""

    @property
    def improves(self) -> bool:
        """Whether it can use idle time."""
        return type(self).improve is not Replanner.improve

    def improve(self, rounds: int) -> Path:
        """Use idle time for a better path, counted in rounds of work. Who does not define it is never asked."""
        raise NotImplementedError
