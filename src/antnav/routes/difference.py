"""Difference: how much of a route does not run along another one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from antnav.kernels import route_kernels
from antnav.kernels.graph import SQRT2
from antnav.world.path import Path
from antnav.world.terrain import Terrain

#: Default tolerance: so many cells, or this share of the best route's length, whichever is more.
CELLS, SHARE = 2.0, 0.02


@dataclass(frozen=True, eq=False)
class Zone:
    """Where a route counts as running along a path: the cells from which a short legal way leads to it.

    What lies behind a wall is not near, however thin the wall.
    """

    near: NDArray[np.uint8]
    width: int

    @classmethod
    def of(cls, path: NDArray[Any], terrain: Terrain, reach: float) -> Zone:
        """The zone of a path of flat cells, `reach` in cells."""
        near = route_kernels.near(terrain.flat_moves, terrain.width, path.astype(np.int32), reach * (1 + 1e-9))
        return cls(near, terrain.width)

    def share(self, path: NDArray[Any]) -> float:
        """Share of a path's length inside: of those moves of which both cells are."""
        steps = np.where(np.isin(np.abs(np.diff(path)), (1, self.width)), 1.0, SQRT2)
        inside = self.near[path] > 0
        return float(steps[inside[1:] & inside[:-1]].sum() / steps.sum()) if len(steps) else 1.0


def flat_cells(path: Path, terrain: Terrain) -> NDArray[np.int32]:
    """A path's cells on the padded map."""
    flat: NDArray[np.int32] = ((path.cells[:, 0] + 1) * terrain.width + path.cells[:, 1] + 1).astype(np.int32)
    return flat


def default_reach(length: float) -> float:
    """The tolerance in cells where the best route has this length."""
    return max(CELLS, SHARE * length)
