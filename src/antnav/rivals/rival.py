"""Rival: a planner that tells a `Watch` of every path it finds."""

from __future__ import annotations

import time

import numpy as np

from antnav.planner.call import Call
from antnav.planner.once import once
from antnav.planner.phases import Phase
from antnav.planner.plan import ColonyReport, Plan, Stage, history_of
from antnav.planner.planner import Planner
from antnav.rivals.watch import Halted, Watch
from antnav.run.stop import Iterations
from antnav.search.windows import straightened
from antnav.world.grid import GridMap
from antnav.world.problem import Problem


class Rival(Planner):
    """A planner without ants that searches in iterations; `Metaheuristic` and `PotentialField` are two."""

    def search(self, problem: Problem, seed: int, watch: Watch) -> str:
        """Search a connected problem, tell `watch` of every path; return why there is none, "" where there is one."""
        raise NotImplementedError

    def prepare(self, problem: Problem | None = None) -> float:
        """Import what it needs and compile its kernels, by two iterations on a tiny map."""
        return once({self.name: self._try})

    def _try(self) -> None:
        grid = GridMap(np.array([[0, 0, 0], [0, 1, 0], [0, 0, 0]], np.uint8))
        self._search(Problem.from_cells(grid, (2, 1), (0, 1)), 0, Watch(Call(stop=Iterations(2))))

    def _search(self, problem: Problem, seed: int, watch: Watch) -> str:
        try:
            return self.search(problem, seed, watch)
        except Halted:
            return "" if watch.cells is not None else "ended before any path was found"

    def plan(self, problem: Problem, call: Call) -> Plan:
        """Search, and straighten what was found as the paths of ants are."""
        if not problem.connected:
            return Plan(cells=None)
        begin, cpu, watch = time.perf_counter(), time.thread_time(), Watch(call)
        failure = self._search(problem, call.seed, watch)
        seconds, cpu_seconds = time.perf_counter() - begin, time.thread_time() - cpu
        cells = None
        if watch.cells is not None:
            flat = straightened(watch.cells.astype(np.int32), problem.terrain)
            cells = problem.from_flat(flat).astype(np.int32)
        report = ColonyReport(
            start=problem.start_cell,
            goal=problem.goal_cell,
            iterations=len(watch.history),
            length=None if cells is None else watch.best,
            steps=watch.steps,
            seconds=seconds,
            cpu_seconds=cpu_seconds,
            walks=watch.steps if watch.walks is None else watch.walks,
        )
        return Plan(
            cells=cells,
            stopped_by=watch.stopped_by,
            stages=(Stage(Phase.SEARCH, seconds, (report,)),),
            history=history_of(watch.history, watch.steps_by_iteration),
            notes=(failure,) if failure else (),
            seconds=seconds,
            cpu_seconds=cpu_seconds,
        )
