"""Tracking: how well a run follows the optimum of a map that changes, by the measures of the literature.

The map as it is first counts for nothing but the level before the first change. Fitness is 1 / cost, so that a run
without a path has 0. Branke, Evolutionary Optimization in Dynamic Environments, 2002, doi 10.1007/978-1-4615-0911-0;
Weicker, Performance measures for dynamic environments, PPSN 2002.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from antnav.study.dynamic_record import DynamicRecord
from antnav.study.groups import GroupsOf, Measure

DynamicGroups = GroupsOf[DynamicRecord]

#: Iterations after a change at which the gap is told.
AT = (2, 5, 10, 20, 50)
#: Gap up to which a run has recovered, beside the level before the change.
NEAR = 0.01
#: Differences of gaps that count as none.
TIE = 1e-9


@dataclass(frozen=True, eq=False)
class Tracking:
    """One run's measures; gaps are shares, inf without a path."""

    run: DynamicRecord

    @cached_property
    def every_gap(self) -> NDArray[np.float64]:
        """Gap to the optimum, a row for the map as it is first and after each change, a column for each iteration."""
        best = np.array([[math.inf if cost is None else cost for cost in row] for row in self.run.best])
        gap: NDArray[np.float64] = np.maximum(best / np.array(self.run.optima)[:, None] - 1.0, 0.0)
        return gap

    @property
    def gaps(self) -> NDArray[np.float64]:
        """The same after changes only."""
        return self.every_gap[1:]

    @property
    def offline(self) -> float:
        """Modified offline performance (Branke) as a gap: mean over iterations of that of the best since the change."""
        return float(self.gaps.mean())

    @property
    def accuracy(self) -> float:
        """Mean accuracy (Weicker): fitness over the optimum's."""
        return float((1.0 / (1.0 + self.gaps)).mean())

    @property
    def stability(self) -> float:
        """Mean loss of accuracy from the iteration before a change to the one after (Weicker); 0 where none is lost."""
        accuracy = 1.0 / (1.0 + self.every_gap)
        return float(np.maximum(accuracy[:-1, -1] - accuracy[1:, 0], 0.0).mean())

    @cached_property
    def recovery(self) -> NDArray[np.float64]:
        """Iterations after each change until the gap is that before it, or `NEAR`; inf where it never was."""
        wanted = np.maximum(self.every_gap[:-1, -1], NEAR) + TIE
        there = self.gaps <= wanted[:, None]
        return np.where(there.any(axis=1), there.argmax(axis=1) + 1.0, math.inf)

    def at(self, iteration: int) -> float:
        """Mean gap so many iterations after a change."""
        return float(self.gaps[:, iteration - 1].mean())


def offline_gaps(runs: Sequence[DynamicRecord]) -> list[float]:
    """What runs are compared by."""
    return [Tracking(run).offline for run in runs]


#: What runs that follow changes are compared by.
OFFLINE = Measure(offline_gaps, "offline gap", "smaller", "larger")
