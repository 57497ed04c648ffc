"""What is seen of ants at work, gathered one iteration at a time: walks, dead ends, pheromone, paths, words."""

from __future__ import annotations

import time
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from antnav.ants.algorithm import Algorithm
from antnav.colony.colony import Colony
from antnav.kernels import ant_kernels
from antnav.kernels.view_kernels import shade
from antnav.plan.solve import solve
from antnav.plan.steps import Step, Steps
from antnav.planner.phases import Phase
from antnav.planner.planner import Planner
from antnav.planner.result import Result
from antnav.world.problem import CellIndex, Problem

#: Ants of an iteration whose walks are shown, of all colonies together.
SHOWN = 40
#: Moves of a walk that are shown.
LONGEST = 6000
#: Pheromone below this share of the most is not seen.
FAINTEST = 0.01

_STAGES = {
    Phase.STAGE_ONE: "Stage one: two colonies, one from either end, look for the cell at which to divide the way.",
    Phase.STAGE_TWO: "Stage two: each half has a colony of its own; both walk at the same time.",
    Phase.WHOLE_MAP: "One map, one way: {} from the start to the goal.",
    Phase.REGIONS: "Two colonies walk over a coarse graph of regions.",
    Phase.ROUTES: "The best routes are laid out on cells.",
    Phase.WINDOWS: "Pieces of the path are searched anew, exactly.",
}


class Seen(NamedTuple):
    """What is seen of an algorithm at work at one moment.

    Attributes
    ----------
    iteration : int
        Done so far, over all stages.
    stage : str
        A `Phase`; "" before the first iteration.
    auxiliary : (row, col) or None
        Where PACO divided the way.
    done : bool
    cost : float
        Of the best path from start to goal in this stage so far; inf without one.
    words : list of str
        How things stand.
    ants : list of (int, int, int)
        Of some ants of the iteration: side (0: of the colony from the start, or of the first half), `Fate`, cells of
        its walk.
    walks : ndarray of int32, shape (k, 2)
        (row, col) of the cells of their walks, one after the other.
    bests : list of ndarray of int32, shape (k, 2)
        Best path so far, or that of each half.
    dead : ndarray of int32, shape (k, 2)
        Cells at which ants ended.
    heat : tuple of ndarray of uint8, shape (rows, cols)
        Pheromone of either side; shape (0,) where it has no colony.
    """

    iteration: int
    stage: str
    auxiliary: CellIndex | None
    done: bool
    cost: float
    words: list[str]
    ants: list[tuple[int, int, int]]
    walks: NDArray[np.int32]
    bests: list[NDArray[np.int32]]
    dead: NDArray[np.int32]
    heat: tuple[NDArray[np.uint8], NDArray[np.uint8]]


class Watched:
    """An algorithm at work, watched one iteration at a time.

    Parameters
    ----------
    problem : Problem
    algorithm : Planner
        Of ants it shows every iteration, of others the end.
    seed : int

    Attributes
    ----------
    result : Result or None
        What `solve` returns, once all is done.
    rows : list
        Of each iteration: cost of the best path so far and mean cost, None without one; ants that arrived, and that
        were lost.
    """

    def __init__(self, problem: Problem, algorithm: Planner, seed: int) -> None:
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

    def seen(self, optimum: float) -> Seen:
        """What is seen of it now."""
        step, result = self.step, self.result
        walking = step is not None and bool(step.colonies) and step.stage != Phase.REGIONS
        colonies = step.colonies if step is not None and walking else ()
        bests = list[NDArray[np.int32]]()
        if result is not None:
            bests = [] if result.path is None else [result.path.cells]
        elif walking and step is not None:
            bests = _bests(colonies, step.stage == Phase.STAGE_TWO)
        ants, walks = _walks(colonies)
        return Seen(
            iteration=self.iteration,
            stage=step.stage if step else "",
            auxiliary=result.auxiliary_cell if result else step.auxiliary_cell if step else None,
            done=self.done,
            cost=result.cost if result else step.best if step else np.inf,
            words=self._words(optimum),
            ants=ants,
            walks=walks,
            bests=bests,
            dead=_dead_ends(colonies),
            heat=(_heat(colonies[0::2], self.problem), _heat(colonies[1::2], self.problem)),
        )

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
            words.append(_outcome(result))
        elif step is not None and np.isfinite(step.best) and 0 < optimum < np.inf:
            best = f"{step.best:.2f} cells" if self.problem.objective.plain else f"costs {step.best:.2f}"
            words.append(f"Best so far {best}, {100 * (step.best / optimum - 1):.2f} % above the optimum.")
        return words

    @property
    def _total(self) -> int:
        return max(self.algorithm.iterations if isinstance(self.algorithm, Algorithm) else 1, self.iteration)


def _colonies(count: int) -> str:
    return "one colony walks" if count == 1 else f"{count} colonies walk, by turns from either end,"


def _bests(colonies: tuple[Colony, ...], halves: bool) -> list[NDArray[np.int32]]:
    """Best paths so far: of each half, or of the better colony."""
    found = [colony for colony in colonies if colony.best_nodes is not None]
    if not halves:
        found = sorted(found, key=lambda colony: colony.best_length)[:1]
    return [colony.task.grid_graph.cells[colony.best_nodes].astype(np.int32) for colony in found]


def _walks(colonies: tuple[Colony, ...]) -> tuple[list[tuple[int, int, int]], NDArray[np.int32]]:
    """Some ants of each colony: side, fate and cells of each walk; and all their cells, (row, col)."""
    ants, walks = list[tuple[int, int, int]](), list[NDArray[np.int32]]()
    for number, colony in enumerate(colonies):
        view = colony.view()
        count = len(view.fates)
        for ant in np.unique(np.linspace(0, count - 1, min(count, SHOWN // len(colonies)), dtype=np.int64)):
            nodes = view.path(int(ant))[: LONGEST + 1]
            ants.append((number % 2, int(view.fates[ant]), len(nodes)))
            walks.append(view.cells[nodes].astype(np.int32))
    return ants, np.concatenate(walks) if walks else np.empty((0, 2), np.int32)


def _dead_ends(colonies: tuple[Colony, ...]) -> NDArray[np.int32]:
    """Cells at which ants ended in this iteration, (row, col)."""
    found = [np.empty((0, 2), np.int64)]
    for colony in colonies:
        view = colony.view()
        dead = np.flatnonzero(view.fates == ant_kernels.DEAD)
        found.append(view.cells[view.paths[dead, view.steps[dead]]].reshape(-1, 2))
    return np.unique(np.concatenate(found), axis=0).astype(np.int32)


def _heat(colonies: tuple[Colony, ...], problem: Problem) -> NDArray[np.uint8]:
    """Pheromone of colonies as shades of the map's cells, logarithmic, 255 at the most; nothing without a colony."""
    if not colonies:
        return np.empty(0, np.uint8)
    shades = np.zeros(problem.grid.shape, np.uint8)
    for colony in colonies:
        graph = colony.task.grid_graph
        shade(colony.tau, graph.graph.neighbours, graph.cells, FAINTEST, shades)
    return shades


def _outcome(result: Result) -> str:
    """How a run ended, in a sentence."""
    if result.path is None:
        return "No ant arrived: the run ended without a path."
    gap = 100 * result.gap
    plain = result.problem.objective.plain
    best = "the shortest there is" if plain else "the cheapest there is"
    beyond = best if gap < 1e-9 else f"{gap:.2f} % above the optimum"
    price = "" if plain else f" that costs {result.cost:.2f}"
    ironed = getattr(result.algorithm, "straighten", False)
    order = " Its moves are in another order, for fewer turns at the same length." if ironed else ""
    return f"Done: a path of {result.length:.2f} cells{price}, {beyond}.{order}"
