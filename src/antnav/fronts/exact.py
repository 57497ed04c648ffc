"""Exact: the whole front, by label setting."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from antnav.errors import ParameterError, shown
from antnav.fronts.instance import Instance
from antnav.fronts.method import Found, Method
from antnav.fronts.weights import ends
from antnav.planner.call import Call
from antnav.planner.plan import StoppedBy
from antnav.search import labels
from antnav.values import finite_number, whole_in


@dataclass(frozen=True)
class Exact(Method):
    """Label setting with truncated vectors (NAMOA*dr, Pulido, Mandow & Perez-de-la-Cruz 2015); see `search.labels`.

    Parameters
    ----------
    limit : int
        Labels that may be made, 1 to 10**9: a label takes about 30 bytes.
    slack : float
        0 to 1: with more than 0 paths are left out that have one in the front which is worse by at most this share of
        each objective's range. A*pex (Zhang et al. 2022) merges labels to that end; this only drops them.
    """

    limit: int = 20_000_000
    slack: float = 0.0
    draws: ClassVar[bool] = False

    def __post_init__(self) -> None:
        whole_in("limit", self.limit, 1, 10**9)
        if not 0 <= finite_number(self.slack) <= 1:
            raise ParameterError(f"slack {shown(self.slack)}", "it is a share from 0 to 1", "give such as 0.002")

    @property
    def name(self) -> str:
        """As `antnav.pareto` takes it."""
        return "exact"

    @property
    def certainty(self) -> str:
        """Where it comes from."""
        return "exact, for values counted in whole steps (NAMOA*dr: Pulido, Mandow & Perez-de-la-Cruz 2015)"

    def find(self, instance: Instance, call: Call) -> Found:
        """Search until all is found, or the limit or the call ends it."""
        ending: list[StoppedBy] = []

        def ended() -> bool:
            why = call.ending(0, math.inf)
            if why:
                ending.append(why)
            return why is not None

        spare = None
        if self.slack:
            _, _, ranges = ends(instance)
            spare = (self.slack * ranges).astype(np.int32)
        found = labels.front(
            *instance.arrays, instance.start, instance.goal, slack=spare, limit=self.limit, check=ended
        )
        notes: tuple[str, ...] = ()
        paths = found.paths
        if found.ended and not found.complete:
            share = f"{100 * self.slack:g} %"
            notes = (f"each path of the front has one here that is worse by at most {share} of the ranges",)
        elif not found.complete:
            if not paths:
                paths, _, _ = ends(instance)  # better than nothing
            why = "its time" if ending else f"the limit of {self.limit} labels"
            notes = (f"front incomplete: {why} ended the search; these paths are part of it, others are missing",)
        return Found(
            paths=paths,
            complete=found.complete,
            stopped_by=ending[0] if ending else StoppedBy.SCHEDULE,
            work={"labels": found.made},
            notes=notes,
        )
