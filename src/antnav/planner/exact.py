"""Exact planners: A*, Dijkstra's algorithm and jump point search, to be run, studied and compared like any other."""

from __future__ import annotations

import time
from dataclasses import dataclass
from functools import partial
from typing import ClassVar

import numpy as np

from antnav.errors import ParameterError, shown
from antnav.planner.call import Call
from antnav.planner.once import once
from antnav.planner.phases import Phase
from antnav.planner.plan import ColonyReport, Plan, Stage
from antnav.planner.planner import KINDS, Planner
from antnav.search import exact
from antnav.world.grid import GridMap
from antnav.world.problem import Problem

#: The searches, and who described them.
METHODS = {
    "astar": "Hart, Nilsson & Raphael 1968, doi 10.1109/TSSC.1968.300136, with the octile heuristic",
    "dijkstra": "Dijkstra 1959, doi 10.1007/BF01386390",
    "jps": "Harabor & Grastien 2011, doi 10.1609/aaai.v25i1.7994, and 2014, doi 10.1609/icaps.v24i1.13633",
}


@dataclass(frozen=True, kw_only=True)
class Exact(Planner):
    """A cheapest path on the grid's eight directions, with few turns.

    It looks at neither the clock nor `cancel`: a search ends in milliseconds, and half of one is worth nothing.

    Parameters
    ----------
    method : {"astar", "dijkstra", "jps"}
        "jps" needs moves that cost their length.
    """

    method: str = "astar"
    kind: ClassVar[str] = "exact"

    def __post_init__(self) -> None:
        if not isinstance(self.method, str) or self.method not in METHODS:
            rule = f"the exact methods are {', '.join(METHODS)}"
            raise ParameterError(f"method {shown(self.method)}", rule, "choose one of them")

    @property
    def name(self) -> str:
        """That of the method."""
        return self.method

    @property
    def certainty(self) -> str:
        """Exact, and by whom."""
        return f"[source]: {METHODS[self.method]}; exact, it knows the whole map"

    def prepare(self, problem: Problem | None = None) -> float:
        """Compile the search; work out the legal moves of the map."""
        if problem is not None:
            _ = problem.terrain.jumps if self.method == "jps" else problem.flat_moves
        return once({self.method: partial(_compile, self.method)})

    def plan(self, problem: Problem, call: Call) -> Plan:
        """Search; the steps are the cells that were taken from the queue."""
        cpu = time.thread_time()
        found = exact.shortest_path(problem, self.method)
        report = ColonyReport(
            start=problem.start_cell,
            goal=problem.goal_cell,
            iterations=0,
            length=found.cost if found.path else None,
            steps=found.expanded,
            seconds=found.seconds,
            cpu_seconds=time.thread_time() - cpu,
        )
        stages = (Stage(Phase.SEARCH, found.seconds, (report,)),)
        return Plan(cells=found.path.cells if found.path else None, stages=stages, seconds=found.seconds)


def _compile(method: str) -> None:
    exact.shortest_path(Problem.from_cells(GridMap(np.zeros((2, 5), np.uint8)), (0, 0), (1, 4)), method)


def jps() -> Exact:
    """Jump point search, as a planner."""
    return Exact(method="jps")


def astar() -> Exact:
    """A* with the octile heuristic, as a planner."""
    return Exact(method="astar")


def dijkstra() -> Exact:
    """Dijkstra's algorithm, as a planner."""
    return Exact(method="dijkstra")


KINDS["exact"] = lambda document: Exact(method=document.get("method", ""))
