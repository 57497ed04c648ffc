"""Standing: how good the fronts of a study are, beside the best that is known of each map."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from antnav.fronts import indicators
from antnav.report import statistics
from antnav.study.front_record import FrontRecord
from antnav.study.groups import GroupsOf, Measure

FrontGroups = GroupsOf[FrontRecord]


@dataclass(frozen=True)
class Quality:
    """A front beside the yardstick: share of its hypervolume, additive epsilon, IGD+; see `indicators.compare`."""

    hypervolume: float
    epsilon: float
    igd_plus: float


@dataclass(frozen=True, eq=False)
class Standing:
    """One map's fronts.

    Attributes
    ----------
    truth : ndarray of float64, shape (q, k)
        Values of the yardstick.
    proved : str
        Label of the method that proved it the whole front; "": the union of all methods' fronts.
    reference : tuple of float
        Up to where hypervolumes count, in the objectives' units.
    qualities : dict of str to Quality
        By the run's key.
    """

    truth: NDArray[np.float64]
    proved: str
    reference: tuple[float, ...]
    qualities: dict[str, Quality]

    @classmethod
    def of(cls, group: Mapping[str, Sequence[FrontRecord]]) -> Standing | None:
        """The standing of a map's runs; None where no path exists."""
        every = [run for runs in group.values() for run in runs]
        runs = {run.key: run for run in every if run.values}
        if not runs:
            return None
        whole = next((run for run in runs.values() if run.complete), None)
        found = {key: np.array(run.values) for key, run in runs.items()}
        truth = found[whole.key] if whole else indicators.undominated(np.concatenate(list(found.values())))
        compared = {key: indicators.compare(values, truth) for key, values in found.items()}
        qualities = {key: Quality(one["hypervolume"], one["epsilon"], one["igd_plus"]) for key, one in compared.items()}
        qualities |= {run.key: Quality(0.0, math.inf, math.inf) for run in every if not run.values}
        reference = next(iter(compared.values()))["reference"]
        return cls(truth, whole.algorithm if whole else "", tuple(reference), qualities)

    @property
    def yardstick(self) -> str:
        """What fronts are compared with, in words."""
        if self.proved:
            return f"the whole front, which {self.proved} proved: {len(self.truth)} paths"
        return f"the union of all methods' fronts ({len(self.truth)} paths), since none proved its own complete"

    def measured(self, runs: Sequence[FrontRecord], name: str) -> list[float]:
        """One field of `Quality` of each run."""
        return [getattr(self.qualities[run.key], name) for run in runs]

    def typical(self, runs: Sequence[FrontRecord]) -> FrontRecord:
        """The run whose share of hypervolume is the median, of two the lower."""
        ordered = sorted(runs, key=lambda run: (self.qualities[run.key].hypervolume, run.seed))
        return ordered[(len(ordered) - 1) // 2]

    @property
    def scale(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Least value of each objective on the yardstick, and its range; 1 where that is 0."""
        low, high = self.truth.min(axis=0), self.truth.max(axis=0)
        return low, np.where(high > low, high - low, 1.0)


def standings(groups: FrontGroups) -> dict[str, Standing]:
    """By map label, of the maps on which paths exist."""
    found = {label: Standing.of(group) for label, group in groups.items()}
    return {label: standing for label, standing in found.items() if standing}


def missing_hypervolume(known: Mapping[str, Standing]) -> Measure:
    """What methods are compared by: the share of the hypervolume that a front lacks."""

    def lacks(runs: Sequence[FrontRecord]) -> list[float]:
        return [1.0 - known[run.map].qualities[run.key].hypervolume for run in runs]

    return Measure(lacks, "missing hypervolume", "better", "worse")


def quartiles(values: Sequence[float]) -> tuple[float, float, float]:
    """Median, lower and upper quartile."""
    low, median, high = (float(value) for value in statistics.quantiles(values, (0.25, 0.5, 0.75)))
    return median, low, high
