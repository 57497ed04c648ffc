"""A run in a panel: an algorithm on the scene's problem, one iteration at a time, and what is seen of it."""

from __future__ import annotations

import time
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from antnav.ants.algorithm import Algorithm
from antnav.colony.colony import Colony
from antnav.errors import ParameterError
from antnav.kernels import ant_kernels
from antnav.kernels.view_kernels import shade
from antnav.plan.solve import solve
from antnav.plan.steps import Step, Steps
from antnav.planner.phases import Phase
from antnav.planner.planner import Planner
from antnav.planner.result import Result
from antnav.view.packet import Packet
from antnav.view.scene import outcome_words
from antnav.world.problem import Problem

#: Ants of an iteration whose walks are shown, of all colonies together.
SHOWN = 40
#: Moves of a walk that are shown.
LONGEST = 6000
#: Pheromone below this share of the most is not seen.
FAINTEST = 0.01
#: Bytes that the colonies of a run may take.
MOST_MEMORY = 400_000_000

_STAGES = {
    Phase.STAGE_ONE: "Stage one: two colonies, one from either end, look for the cell at which to divide the way.",
    Phase.STAGE_TWO: "Stage two: each half has a colony of its own; both walk at the same time.",
    Phase.WHOLE_MAP: "One map, one way: {} from the start to the goal.",
    Phase.REGIONS: "Two colonies walk over a coarse graph of regions.",
    Phase.ROUTES: "The best routes are laid out on cells.",
    Phase.WINDOWS: "Pieces of the path are searched anew, exactly.",
}


def check_memory(algorithm: Planner, cells: int) -> None:
    """Refuse a run whose arrays would be too large, before they are made.

    Raises
    ------
    ParameterError
    """
    if not isinstance(algorithm, Algorithm):
        return
    colonies = max(algorithm.colonies, algorithm.decomposition.pieces if algorithm.decomposition else 1, 2)
    needed = colonies * (cells * (5 * algorithm.ants + 200) + 64 * algorithm.iterations)
    if needed > MOST_MEMORY:
        given = f"{algorithm.ants} ants, {algorithm.iterations} iterations on {cells} cells"
        rule = f"they need {needed / 1e6:.0f} MB, and a panel has {MOST_MEMORY / 1e6:.0f}"
        raise ParameterError(given, rule, "choose fewer ants or colonies, or a smaller map")


class Run:
    """One panel.

    Parameters
    ----------
    problem : Problem
    algorithm : Planner
        Of ants it shows every iteration, of others the end.
    seed : int
    """

    def __init__(self, problem: Problem, algorithm: Planner, seed: int) -> None:
        check_memory(algorithm, problem.grid.cells.size)
        self.problem, self.algorithm, self.seed = problem, algorithm, seed
        self.result: Result | None = None
        self.step: Step | None = None
        self.iteration = 0  #: over all stages
        self.rows: list[list[float | None]] = []  #: an iteration each: best, mean, arrived, lost
        self._told = 0
        self._steps = Steps(problem, algorithm, seed) if isinstance(algorithm, Algorithm) else None
        self._iterator: Iterator[Step] = iter(self._steps or ())

    @property
    def done(self) -> bool:
        """Whether there is a result."""
        return self.result is not None

    def advance(self, count: int, seconds: float) -> None:
        """So many iterations more, or fewer where the time is up or all are done."""
        end = time.perf_counter() + seconds
        for _ in range(count):
            if self.done:
                return
            self._one()
            if time.perf_counter() > end:
                return

    def _one(self) -> None:
        if self._steps is None:
            self.result = solve(self.problem, self.algorithm, seed=self.seed)
            return
        step = next(self._iterator, None)
        if step is None:
            self.result = self._steps.result
            return
        self.step = step
        if not step.colonies:
            return
        self.iteration += 1
        last = [colony.last for colony in step.colonies]
        means = [one.mean for one in last if np.isfinite(one.mean)]
        arrived, lost = sum(one.arrived for one in last), sum(one.lost for one in last)
        mean = None if not means else float(np.sum(means) if step.stage == Phase.STAGE_TWO else np.mean(means))
        self.rows.append([step.best if np.isfinite(step.best) else None, mean, arrived, lost])

    def frame(self, panel: int, optimum: float) -> Packet:
        """What is seen of it now."""
        step, result = self.step, self.result
        walking = step is not None and bool(step.colonies) and step.stage != Phase.REGIONS
        colonies = step.colonies if step is not None and walking else ()
        best = None
        if result is not None:
            best = None if result.path is None else [result.path.cells]
        elif walking and step is not None:
            best = _bests(colonies, step.stage == Phase.STAGE_TWO)
        rows, self._told = self.rows[self._told :], len(self.rows)
        auxiliary = result.auxiliary_cell if result else step.auxiliary_cell if step else None
        ants, walks = _walks(colonies)
        packet = Packet(
            {
                "is": "frame",
                "panel": panel,
                "iteration": self.iteration,
                "stage": step.stage if step else "",
                "auxiliary": auxiliary,
                "done": self.done,
                "rows": rows,
                "first": self._told - len(rows),
                "words": self._words(optimum),
                "ants": ants,
                "bests": [len(cells) for cells in best or []],
                "cost": _finite(result.cost if result else step.best if step else np.inf),
            }
        )
        packet.add("walks", walks)
        packet.add("best", np.concatenate(best or [np.empty((0, 2), np.int32)]).astype(np.uint16))
        packet.add("dead", _dead_ends(colonies))
        for side in (0, 1):
            packet.add(f"heat{side}", _heat(colonies[side::2], self.problem))
        return packet

    def _words(self, optimum: float) -> list[str]:
        step, result = self.step, self.result
        words = []
        if step is None and result is None:
            words.append(f"{self.algorithm.name}: press play, or step through it.")
        elif step is not None:
            ants = self.algorithm.ants * len(step.colonies)
            words.append(_STAGES.get(Phase(step.stage), step.stage).format(_colonies(len(step.colonies))))
            if step.colonies and self.rows:
                _, _, arrived, lost = self.rows[-1]
                words.append(
                    f"Iteration {self.iteration} of {self._total}: {arrived:.0f} of {ants} ants arrived, "
                    f"{lost:.0f} ended in a dead end."
                )
        if result is not None:
            words.append(outcome_words(result))
        elif step is not None and np.isfinite(step.best) and 0 < optimum < np.inf:
            words.append(
                f"Best so far {step.best:.2f} cells, {100 * (step.best / optimum - 1):.2f} % above the optimum."
            )
        return words

    @property
    def _total(self) -> int:
        return max(self.algorithm.iterations if isinstance(self.algorithm, Algorithm) else 1, self.iteration)


def _finite(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None


def _colonies(count: int) -> str:
    return "one colony walks" if count == 1 else f"{count} colonies walk, by turns from either end,"


def _bests(colonies: tuple[Colony, ...], halves: bool) -> list[NDArray[np.int32]]:
    """Best paths so far: of each half, or of the better colony."""
    found = [colony for colony in colonies if colony.best_nodes is not None]
    if not halves:
        found = sorted(found, key=lambda colony: colony.best_length)[:1]
    return [colony.task.grid_graph.cells[colony.best_nodes].astype(np.int32) for colony in found]


def _walks(colonies: tuple[Colony, ...]) -> tuple[list[tuple[int, int, int]], NDArray[np.uint16]]:
    """Some ants of each colony: side, fate and cells of each walk; and all their cells, (row, col)."""
    ants, walks = list[tuple[int, int, int]](), list[NDArray[np.uint16]]()
    for number, colony in enumerate(colonies):
        view = colony.view()
        count = len(view.fates)
        for ant in np.unique(np.linspace(0, count - 1, min(count, SHOWN // len(colonies)), dtype=np.int64)):
            nodes = view.path(int(ant))[: LONGEST + 1]
            ants.append((number % 2, int(view.fates[ant]), len(nodes)))
            walks.append(view.cells[nodes].astype(np.uint16))
    return ants, np.concatenate(walks) if walks else np.empty((0, 2), np.uint16)


def _dead_ends(colonies: tuple[Colony, ...]) -> NDArray[np.uint16]:
    """Cells at which ants ended in this iteration, (row, col)."""
    found = [np.empty((0, 2), np.int64)]
    for colony in colonies:
        view = colony.view()
        dead = np.flatnonzero(view.fates == ant_kernels.DEAD)
        found.append(view.cells[view.paths[dead, view.steps[dead]]].reshape(-1, 2))
    return np.unique(np.concatenate(found), axis=0).astype(np.uint16)


def _heat(colonies: tuple[Colony, ...], problem: Problem) -> NDArray[np.uint8]:
    """Pheromone of colonies as shades of the map's cells, logarithmic, 255 at the most; nothing without a colony."""
    if not colonies:
        return np.empty(0, np.uint8)
    shades = np.zeros(problem.grid.shape, np.uint8)
    for colony in colonies:
        graph = colony.task.grid_graph
        shade(colony.tau, graph.graph.neighbours, graph.cells, FAINTEST, shades)
    return shades
