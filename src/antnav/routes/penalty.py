"""Routes by any planner: the ways found so far become dearer, and it plans again.

The penalty method (Chen, Bell & Bogenberger 2007, IEEE Trans. Intell. Transp. Syst. 8(1), 14-20; Bader, Dees,
Geisberger & Sanders 2011). A zone around each path is dearer here, or the next one would run a cell aside. Where that
only pushes it aside in the open, no obstacle lies between, and it does not count [ours].
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from antnav.planner.result import Result
from antnav.routes.difference import Zone, flat_cells
from antnav.routes.sides import obstacles_between, polished
from antnav.world.cost import LARGEST, CostField
from antnav.world.problem import Problem

#: What a path adds to the cost of a metre in its zone.
PENALTY = 0.5
#: Runs without a further route after which there is none.
RUNS = 8


def routes(
    problem: Problem,
    solve: Callable[[Problem], Result],
    count: int,
    most_shared: float,
    limit: float,
    reach: float,
    ended: Callable[[], bool],
) -> list[NDArray[Any]]:
    """Paths of flat cells that differ pairwise, in the order in which they were found.

    Parameters
    ----------
    problem : Problem
    solve : callable
        Plans on the same problem with other costs.
    count, most_shared, limit, reach
        See `via.routes`.
    ended : callable
        Whether to stop before the next run.
    """
    terrain, rows, width = problem.terrain, problem.grid.rows, problem.width
    found: list[NDArray[Any]] = []
    zones: list[Zone] = []
    penalty = np.zeros(problem.grid.shape)
    asked = problem
    fruitless = 0
    while len(found) < count and fruitless < RUNS and not (found and ended()):
        result = solve(asked)
        if result.path is None:
            break
        path = flat_cells(result.path, terrain)
        zone = Zone.of(path, terrain, reach)
        penalty += PENALTY * zone.near.reshape(rows + 2, width)[1:-1, 1:-1]
        room = LARGEST if problem.cost is None else LARGEST - problem.cost.values
        field = CostField(np.minimum(penalty, room), name="penalty")
        asked = replace(problem, cost=field if problem.cost is None else problem.cost + field)
        path = polished(path, terrain, reach) if found else path
        fruitless += 1
        if (
            problem.cost_along(path) <= limit * (1 + 1e-9)
            and all(other.share(path) <= most_shared for other in zones)
            and all(obstacles_between(path, other, terrain) for other in found)
        ):
            fruitless = 0
            found.append(path)
            zones.append(Zone.of(path, terrain, reach))
    return found
