"""What is told about a run once it is over: stages, history, pheromone. Kept out of the time that a run takes."""

from __future__ import annotations

import math
import zlib
from collections.abc import Sequence
from typing import Any, cast

import msgspec
import numpy as np
from numpy.typing import NDArray

from antnav.colony.colony import Outcome, Task
from antnav.kernels.ant_kernels import COUNTS, History, new_history
from antnav.planner.memory import EARLIER, PATHS, Memory, turned
from antnav.planner.plan import ColonyReport, Stage
from antnav.search.abstraction import Abstraction, RegionGraph
from antnav.values import read_only
from antnav.world.grid_graph import GridGraph
from antnav.world.problem import Problem


class Run(msgspec.Struct, frozen=True, eq=False):
    """Colonies that ran side by side.

    Attributes
    ----------
    name : str
    parts : bool
        Whether their paths are parts of one, so that lengths add up; else the better colony counts.
    seconds : float
        Wall time.
    tasks, outcomes
        In the same order.
    """

    name: str
    parts: bool
    seconds: float
    tasks: Sequence[Task]
    outcomes: Sequence[Outcome]

    @property
    def iterations(self) -> int:
        """Iterations one after the other: of the colony that did most."""
        return max((outcome.iterations for outcome in self.outcomes), default=0)

    def stage(self) -> Stage:
        """The account that goes into the result."""
        reports = []
        for task, outcome in zip(self.tasks, self.outcomes, strict=True):
            start, goal = ((int(row), int(col)) for row, col in task.grid_graph.cells[[task.start, task.goal]])
            length = outcome.length if math.isfinite(outcome.length) else None
            reports.append(
                ColonyReport(
                    start=start,
                    goal=goal,
                    iterations=outcome.iterations,
                    length=length,
                    steps=outcome.steps,
                    seconds=outcome.seconds,
                    cpu_seconds=outcome.cpu_seconds,
                    walks=task.algorithm.ants * outcome.iterations,
                )
            )
        return Stage(self.name, self.seconds, tuple(reports))

    def history(self) -> History:
        """The colonies' histories as one; where one colony stopped before the others, its last values are held."""
        if len(self.outcomes) < 2:
            return self.outcomes[0].history if self.outcomes else new_history(0)
        columns = zip(*(_held(outcome.history, self.iterations) for outcome in self.outcomes), strict=True)
        every = History(*(np.array(column) for column in columns))
        arrived = every.arrived.sum(axis=0)
        if self.parts:
            best, iteration_best, mean = (every[i].sum(axis=0) for i in range(3))
        else:
            best, iteration_best = every.best.min(axis=0), every.iteration_best.min(axis=0)
            total = (np.where(every.arrived > 0, every.mean, 0.0) * every.arrived).sum(axis=0)
            mean = np.where(arrived > 0, total / np.maximum(arrived, 1), np.nan)
        lost, steps, entropy = every.lost.sum(axis=0), every.steps.sum(axis=0), every.entropy.mean(axis=0)
        return History(best, iteration_best, mean, arrived, lost, steps, entropy)


def _held(history: History, length: int) -> History:
    """The history continued to a length: the last values stay, and nobody walks any more."""
    more = length - len(history.best)
    if not more:
        return history
    nothing_yet = {"best": math.inf, "iteration_best": math.inf}
    if not more:
        return history
    held = []
    for name, array in zip(History._fields, history, strict=True):
        last = array[-1] if len(array) else nothing_yet.get(name, math.nan)
        held.append(np.append(array, np.full(more, 0 if name in COUNTS else last, array.dtype)))
    return History(*held)


def joined_history(runs: Sequence[Run]) -> History:
    """The histories of runs that followed each other."""
    histories = [run.history() for run in runs] or [new_history(0)]
    return History(*(read_only(np.concatenate(columns)) for columns in zip(*histories, strict=True)))


#: Nodes of which nothing is compressed: it would take longer than all the rest of the account.
FEW = 200
_NONE = np.empty(0, np.int32)


class Heat(msgspec.Struct, frozen=True, eq=False):
    """Mean pheromone of each node's edges at the end of a run, packed: results are kept by the thousand.

    Nodes that nobody visited have one value, so little is left of them.
    """

    problem: Problem
    packed: bytes  #: which nodes have another value than most, a bit each, which they have, and which most have
    nodes: int
    block: int  #: of the abstraction whose nodes these are; 0: they are those of the problem's graph
    owner: NDArray[np.int32]  #: their regions

    @classmethod
    def of(cls, problem: Problem, values: NDArray[np.float32], block: int, owner: NDArray[np.int32]) -> Heat:
        """Keep one value a node. Only what is left once the usual value is out is compressed: that takes long."""
        bits = values.view(np.uint32)  # nan is like nan
        usual = _usual(bits)
        unlike = bits != usual
        packed = np.packbits(unlike).tobytes() + values[unlike].tobytes() + usual.tobytes()
        if len(values) > FEW:
            packed = zlib.compress(packed, 1)
        return cls(problem, packed, len(values), block, owner)

    def __call__(self) -> NDArray[np.float32]:
        """The values at their cells, shape (rows, cols), nan where nobody could walk."""
        if not self.nodes:
            return np.full(self.problem.grid.shape, np.nan, np.float32)
        unpacked = np.frombuffer(zlib.decompress(self.packed) if self.nodes > FEW else self.packed, np.uint8)
        ends = -(-self.nodes // 8)
        unlike = np.unpackbits(unpacked[:ends], count=self.nodes).astype(np.bool_)
        found = unpacked[ends:].copy().view(np.float32)  # aligned
        values = np.full(self.nodes, found[-1])
        values[unlike] = found[:-1]
        terrain = self.problem.terrain
        if self.block:
            return Abstraction.of(terrain, self.block).on_map(values, self.owner)
        return self.problem.graph.on_map(values)


def _last_colonies(runs: Sequence[Run]) -> list[tuple[Task, Outcome]]:
    """Colonies of the last run with ants: all whose paths are parts of one, of those with one aim the better."""
    walked = [run for run in runs if run.outcomes]
    if not walked:
        return []
    pairs = list(zip(walked[-1].tasks, walked[-1].outcomes, strict=True))
    return pairs if walked[-1].parts else [min(pairs, key=lambda pair: pair[1].length)]


def heat(problem: Problem, runs: Sequence[Run], block: int = 0) -> Heat:
    """The pheromone at the end of the last run with ants.

    The pheromone of parts is added up where they overlap; of colonies with one aim the better one's is taken.

    Parameters
    ----------
    block : int
        Side of the blocks where the ants walked on an abstraction; 0: on the problem's graph.
    """
    pairs = _last_colonies(runs)
    if not pairs:
        return Heat(problem, b"", 0, block, _NONE)
    if block:
        task, outcome = pairs[0]  # colonies on regions have one aim
        regions = cast(RegionGraph, task.grid_graph)
        return Heat.of(problem, _node_means(outcome.tau, regions.graph.neighbours), block, regions.owner)
    total = np.full(len(problem.graph), np.nan, np.float32)
    for task, outcome in pairs:
        graph = task.grid_graph
        mean = _node_means(outcome.tau, graph.graph.neighbours)
        if graph is problem.graph:
            total = np.nan_to_num(total) + mean
        else:
            nodes = np.searchsorted(problem.graph.flat, cast(GridGraph, graph).flat)
            total[nodes] = np.nan_to_num(total[nodes]) + mean
    return Heat.of(problem, total, block, _NONE)


def memory(
    problem: Problem,
    runs: Sequence[Run],
    tau0: float,
    best: NDArray[np.int32] | None = None,
    before: Memory | None = None,
) -> Memory | None:
    """The pheromone at the end of the last run with ants, and its paths, for runs to come; None where nobody walked.

    Of parts that both know an edge, the larger value is taken; of colonies with one aim, the better one's.

    Parameters
    ----------
    best : ndarray of int32 or None
        The path found, over flat cells.
    before : Memory or None
        What the run began with.
    """
    pairs = _last_colonies(runs)
    if not pairs:
        return None
    whole = problem.graph
    tau = np.full((len(whole), 8), np.nan)
    for task, outcome in pairs:
        graph = cast(GridGraph, task.grid_graph)
        from_goal = graph.flat[task.start] == problem.flat_ends[1]
        own = turned(outcome.tau, graph.graph) if from_goal else outcome.tau
        own = np.where(graph.graph.neighbours < len(graph), own, np.nan)
        nodes = np.searchsorted(whole.flat, graph.flat)
        tau[nodes] = np.fmax(tau[nodes], own)
    paths = [] if best is None else [best.astype(np.int32)]
    for task, outcome in pairs:
        flat = cast(GridGraph, task.grid_graph).flat
        backwards = flat[task.start] == problem.flat_ends[1]
        ants = [flat[nodes[::-1] if backwards else nodes] for nodes in outcome.paths[1:]]
        paths += sorted(ants, key=problem.cost_along)
    distinct = {path.tobytes(): path for path in paths}
    latest = tuple(list(distinct.values())[:PATHS])
    earlier = () if before is None else (*before.paths[:1], *before.earlier)[:EARLIER]
    return Memory(problem.grid.shape, whole.flat, tau, tau0, latest, earlier)


#: The ways in which a node can have edges.
_EDGES = np.unpackbits(np.arange(1, 256, dtype=np.uint8)[:, None], axis=1).astype(np.bool_)


def _node_means(tau: NDArray[np.float64], neighbours: NDArray[np.int32]) -> NDArray[np.float32]:
    """Mean pheromone of each node's edges; that of nodes whose edges are like most is worked out once."""
    most = _usual(tau[:, 0])
    unlike = (tau != most).view(np.uint64)[:, 0] != 0  # eight bools at once
    usual = _means(np.full(_EDGES.shape, most), _EDGES)
    others = np.flatnonzero(unlike | (usual != usual[0]).any())  # sums may be rounded
    means: NDArray[np.float32] = np.full(len(tau), usual[0])
    means[others] = _means(tau[others], neighbours[others] < len(neighbours))
    return means


def _means(tau: NDArray[np.float64], edges: NDArray[np.bool_]) -> NDArray[np.float32]:
    means = np.where(edges, tau, 0.0).sum(axis=1) / np.maximum(edges.sum(axis=1), 1)
    return cast(NDArray[np.float32], means.astype(np.float32))


def _usual(values: NDArray[Any]) -> Any:
    """A value that many have: the middle one of a thousand."""
    some = np.sort(values[:: max(1, len(values) // 1000)])
    return some[len(some) // 2]
