"""Task: what to plan; Peer: the two calls of a planner."""

from __future__ import annotations

from importlib import metadata
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Points = list[Any]  #: (row, col) of each point, start first


class Task(NamedTuple):
    """What to plan: a map, True where blocked, and two of its cells."""

    blocked: NDArray[np.bool_]
    start: tuple[int, int]
    goal: tuple[int, int]


class Peer:
    """A planner.

    Attributes
    ----------
    distribution : str
        Its name on PyPI.
    majors : range
        Major versions that this adapter fits.
    corner : str
        "forbid" or "allow": its corner rule; "any angle": its path does not follow the cells.
    largest : int
        Longest side of a map that it is tried on.
    """

    distribution = ""
    majors = range(1000)
    corner = "forbid"
    largest = 100_000

    def version(self) -> str | None:
        """The version installed here; None where none is, or one that does not fit."""
        try:
            version = metadata.version(self.distribution)
        except metadata.PackageNotFoundError:
            return None
        return version if int(version.split(".")[0]) in self.majors else None

    def build(self, task: Task) -> Any:
        """What further queries on the map can use again."""
        raise NotImplementedError

    def solve(self, state: Any, task: Task, seed: int) -> Points | None:
        """A path, or None."""
        raise NotImplementedError
