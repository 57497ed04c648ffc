"""Memory strategies: what is done to remembered pheromone where a run begins with it, on a changed map perhaps."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from antnav.colony.parts import names
from antnav.colony.parts.parameter import parameter
from antnav.colony.parts.part import Part
from antnav.kernels.graph import slots_along
from antnav.planner.facts import Basis, Knows
from antnav.planner.memory import Memory
from antnav.search.mending import mended, shortened
from antnav.search.windows import without_loops
from antnav.world.grid_graph import GridGraph
from antnav.world.problem import Problem

if TYPE_CHECKING:
    from scipy.sparse import csr_array

    from antnav.colony.parameters import Settings

#: An immigrant is a shortest path where each edge costs up to so many times its length, drawn evenly [ours].
DEAREST = 3.0


class KnownPath(NamedTuple):
    """A path that counts as found before the first ant walks."""

    nodes: NDArray[np.int32]
    cost: float


class Warm(NamedTuple):
    """What a colony on the whole map begins with."""

    tau: NDArray[np.float64] | None = None  #: shape (n, 8); None: as the algorithm says
    known: KnownPath | None = None


class MemoryPart(Part):
    """A memory strategy."""

    no_regions = "a graph of regions is another for each query, so that nothing is remembered"

    def warm(self, memory: Memory, problem: Problem, algorithm: Settings, seed: int) -> Warm:
        """What a run on that problem, whose ends are connected, begins with."""
        raise NotImplementedError

    def remembered(self, memory: Memory, graph: GridGraph, algorithm: Settings) -> NDArray[np.float64]:
        """Remembered pheromone of every edge, shape (n, 8)."""
        return memory.on(graph, algorithm.tau0, algorithm.tau_min * algorithm.tau0)


class Keep(MemoryPart):
    """All of it stays as it is; tau0 where no edge is known [ours]."""

    name, basis = names.MemoryStrategy.KEEP, Basis.OURS
    no_regions = ""

    def warm(self, memory: Memory, problem: Problem, algorithm: Settings, seed: int) -> Warm:
        """As it is."""
        return Warm(self.remembered(memory, problem.graph, algorithm))


class Restart(MemoryPart):
    """It is forgotten, or a share of it everywhere (Guntsch & Middendorf) [reconstruction].

    Parameters
    ----------
    lambda_r : float
        lambda_R, the share; at 1 the algorithm begins as ever.
    """

    name, basis = names.MemoryStrategy.RESTART, Basis.RECONSTRUCTION

    lambda_r: float = parameter(1.0, most=1, sane=(0.3, 1), symbol="lambda_R", certainty=Basis.SOURCE)

    def warm(self, memory: Memory, problem: Problem, algorithm: Settings, seed: int) -> Warm:
        """Nothing, or all equalised alike."""
        if self.lambda_r == 1:
            return Warm()
        tau = self.remembered(memory, problem.graph, algorithm)
        return Warm(equalised(tau, np.full(len(problem.graph), self.lambda_r), problem.graph))


class Eta(MemoryPart):
    """It is equalised around the change, by distance (Guntsch & Middendorf) [reconstruction].

    EvoWorkshops 2001, doi 10.1007/3-540-45365-2_22: tau <- (1 - gamma) tau + gamma mean, where
    gamma = max(0, 1 - d / (lambda_E D)) at a cell that is d away from the nearest change, straight, and D is the mean
    distance of two cells of the map.

    Parameters
    ----------
    lambda_e : float
        lambda_E; at 0 nothing is equalised.
    """

    name, basis = names.MemoryStrategy.ETA, Basis.RECONSTRUCTION

    lambda_e: float = parameter(0.5, most=100, sane=(0.2, 2), symbol="lambda_E", certainty=Basis.OURS)

    def warm(self, memory: Memory, problem: Problem, algorithm: Settings, seed: int) -> Warm:
        """Equalised by distance."""
        tau, graph = self.remembered(memory, problem.graph, algorithm), problem.graph
        away, reach = distance_to_changes(memory, problem), self.lambda_e * mean_distance(problem.grid.shape)
        if away is None or reach == 0:
            return Warm(tau)
        return Warm(equalised(tau, np.maximum(0.0, 1.0 - away / reach), graph))


class Tau(MemoryPart):
    """It is equalised where pheromone leads to the change (Guntsch & Middendorf) [reconstruction].

    As `eta`, with gamma = min(1, lambda_T p), p the largest product of tau / tau_max along a way from the cell to the
    change.

    Parameters
    ----------
    lambda_t : float
        lambda_T.
    """

    name, basis = names.MemoryStrategy.TAU, Basis.RECONSTRUCTION

    lambda_t: float = parameter(1.0, most=1e6, sane=(0.5, 5), symbol="lambda_T", certainty=Basis.OURS)

    def warm(self, memory: Memory, problem: Problem, algorithm: Settings, seed: int) -> Warm:
        """Equalised by pheromone."""
        from scipy.sparse.csgraph import dijkstra

        tau, graph = self.remembered(memory, problem.graph, algorithm), problem.graph
        away = distance_to_changes(memory, problem)
        if away is None:
            return Warm(tau)
        edges = graph.graph.neighbours < len(graph)
        far = between(graph, -np.log(tau / tau[edges].max()) + 1e-12)  # SciPy takes 0 for no edge
        product = np.exp(-dijkstra(far, indices=np.flatnonzero(away <= np.sqrt(2.0)), min_only=True))
        return Warm(equalised(tau, np.minimum(1.0, self.lambda_t * product), graph))


class Repair(Eta):
    """Flattened, then as `eta`; the best path, its gaps searched exactly, counts as found and deposits [ours].

    After the elitist ant that Guntsch, Middendorf & Schmeck (GECCO 2001) carry across a change.

    Parameters
    ----------
    lambda_e : float
        lambda_E; at 0 nothing is equalised.
    flatten : float
        Exponent f in (0, 1] that draws all pheromone towards its mean m before: m (tau / m)^f; at 1 it does nothing.
        Others than 1 and 0.5 use powers, which differ in the last digit between machines.
    elitists : float
        Deposits of Q / L that the path gets.
    """

    name, basis, knows = names.MemoryStrategy.REPAIR, Basis.OURS, Knows.GAPS

    flatten: float = parameter(0.5, most=1, above=True, sane=(0.3, 1), certainty=Basis.OURS)
    elitists: float = parameter(20.0, most=1e6, sane=(0, 50), certainty=Basis.OURS)

    def remembered(self, memory: Memory, graph: GridGraph, algorithm: Settings) -> NDArray[np.float64]:
        """Drawn towards the mean."""
        tau = super().remembered(memory, graph, algorithm)
        mean = tau[graph.graph.neighbours < len(graph)].mean()
        flat: NDArray[np.float64] = mean * (tau / mean) ** self.flatten  # NumPy takes roots for 0.5
        return flat if self.flatten < 1 else tau

    def warm(self, memory: Memory, problem: Problem, algorithm: Settings, seed: int) -> Warm:
        """Equalised, with the path laid out."""
        tau, _ = super().warm(memory, problem, algorithm, seed)
        paths = population(memory.paths[:1], problem)
        if not paths or tau is None:
            return Warm(tau)
        deposit(tau, problem.graph, paths[0].nodes, self.elitists * algorithm.q / paths[0].cost, algorithm)
        return Warm(tau, paths[0])


class Population(MemoryPart):
    """It is laid out anew from the latest paths, mended (P-ACO, Guntsch & Middendorf) [reconstruction].

    ANTS 2002, doi 10.1007/3-540-45724-0_10: to tau0, each of the k paths of the memory adds (tau_max - 1) tau0 / k on
    its edges. The cheapest counts as found.

    Parameters
    ----------
    tau_max : float
        Pheromone of an edge on all of them, in tau0.
    """

    name, basis, knows = names.MemoryStrategy.POPULATION, Basis.RECONSTRUCTION, Knows.GAPS

    tau_max: float = parameter(10.0, least=1, most=1e6, sane=(2, 50), certainty=Basis.OURS)

    def warm(self, memory: Memory, problem: Problem, algorithm: Settings, seed: int) -> Warm:
        """The pheromone of the population."""
        paths = population(memory.paths, problem)
        if not paths:
            return Warm()
        best = min(paths, key=lambda path: path.cost)
        graph, chance = problem.graph, np.random.default_rng(seed)
        walked = self.changed_paths([path.nodes for path in paths], best.nodes, memory, problem, chance)
        tau = algorithm.initial.tau(algorithm.tau0, graph, int(best.nodes[0]), int(best.nodes[-1]))
        for nodes in walked:
            deposit(tau, graph, nodes, (self.tau_max - 1.0) * algorithm.tau0 / len(walked), algorithm)
        return Warm(tau, best)

    def changed_paths(
        self,
        paths: Sequence[NDArray[np.int32]],
        best: NDArray[np.int32],
        memory: Memory,
        problem: Problem,
        chance: np.random.Generator,
    ) -> Sequence[NDArray[np.int32]]:
        """The paths that deposit, over nodes."""
        return paths


class Immigrants(Population):
    """A population of whose paths a share is replaced by immigrants.

    Mavrovouniotis & Yang (Applied Soft Computing 2013) do so at each iteration, here at the change. They are made of
    shortest paths at costs that are drawn [ours]: tours have simpler ones.
    """

    immigrants: float = parameter(0.4, most=1, sane=(0.2, 0.6), symbol="r", certainty=Basis.SOURCE)

    def changed_paths(
        self,
        paths: Sequence[NDArray[np.int32]],
        best: NDArray[np.int32],
        memory: Memory,
        problem: Problem,
        chance: np.random.Generator,
    ) -> Sequence[NDArray[np.int32]]:
        """The first paths, which are the latest and best, and immigrants instead of the others."""
        count = int(np.ceil(self.immigrants * len(paths)))
        made = [self.immigrant(best, memory, problem, chance) for _ in range(count)]
        return [*paths[: len(paths) - count], *made]

    def immigrant(
        self, best: NDArray[np.int32], memory: Memory, problem: Problem, chance: np.random.Generator
    ) -> NDArray[np.int32]:
        """One of them."""
        raise NotImplementedError


class RandomImmigrants(Immigrants):
    """As `population`, a share drawn at random (RIACO, Mavrovouniotis & Yang) [reconstruction].

    Parameters
    ----------
    tau_max : float
        Pheromone of an edge on all paths, in tau0.
    immigrants : float
        r, the share.
    """

    name, basis = names.MemoryStrategy.RANDOM_IMMIGRANTS, Basis.RECONSTRUCTION

    def immigrant(
        self, best: NDArray[np.int32], memory: Memory, problem: Problem, chance: np.random.Generator
    ) -> NDArray[np.int32]:
        """A path from start to goal."""
        return drawn(problem.graph, int(best[0]), int(best[-1]), chance)


class ElitismImmigrants(Immigrants):
    """As `population`, a share the best path mutated (EIACO, Mavrovouniotis & Yang) [reconstruction].

    Parameters
    ----------
    tau_max : float
        Pheromone of an edge on all paths, in tau0.
    immigrants : float
        r, the share.
    """

    name, basis = names.MemoryStrategy.ELITISM_IMMIGRANTS, Basis.RECONSTRUCTION

    def immigrant(
        self, best: NDArray[np.int32], memory: Memory, problem: Problem, chance: np.random.Generator
    ) -> NDArray[np.int32]:
        """The best path, mutated."""
        return mutated(best, problem.graph, chance)


class MemoryImmigrants(Immigrants):
    """As `population`, a share the best ever mutated (MIACO, Mavrovouniotis & Yang) [reconstruction].

    Parameters
    ----------
    tau_max : float
        Pheromone of an edge on all paths, in tau0.
    immigrants : float
        r, the share.
    """

    name, basis = names.MemoryStrategy.MEMORY_IMMIGRANTS, Basis.RECONSTRUCTION

    def immigrant(
        self, best: NDArray[np.int32], memory: Memory, problem: Problem, chance: np.random.Generator
    ) -> NDArray[np.int32]:
        """The best of the long-term memory on this map, mutated."""
        known = population([*memory.paths[:1], *memory.earlier], problem)
        return mutated(min(known, key=lambda path: path.cost).nodes if known else best, problem.graph, chance)


def equalised(tau: NDArray[np.float64], gamma: NDArray[np.float64], graph: GridGraph) -> NDArray[np.float64]:
    """(1 - gamma) tau + gamma mean, gamma of an edge the mean of its two nodes'."""
    neighbours = graph.graph.neighbours
    share = (gamma[:, None] + np.append(gamma, 0.0)[neighbours]) / 2.0
    result: NDArray[np.float64] = (1.0 - share) * tau + share * tau[neighbours < len(graph)].mean()
    return result


def mean_distance(shape: tuple[int, int]) -> float:
    """Mean straight distance in cells between two cells of a map of that shape, a cell and itself among them."""
    rows, cols = (np.arange(side, dtype=np.float64) for side in shape)
    pairs = [np.where(along > 0, 2.0, 1.0) * (len(along) - along) for along in (rows, cols)]
    away = np.sqrt(rows[:, None] ** 2 + cols**2)
    return float((pairs[0][:, None] * pairs[1] * away).sum() / (len(rows) * len(cols)) ** 2)


def distance_to_changes(memory: Memory, problem: Problem) -> NDArray[np.float64] | None:
    """Straight distance in cells from each node to the nearest cell that can be reached now or before; None: all are.

    Costs that changed are no change here: a memory knows cells.
    """
    from scipy.ndimage import distance_transform_edt

    changed = np.setxor1d(memory.flat, problem.graph.flat)
    if not len(changed):
        return None
    same = np.ones(problem.grid.shape, np.bool_)
    same[tuple(problem.from_flat(changed).T)] = False
    away: NDArray[np.float64] = distance_transform_edt(same)[tuple(problem.graph.cells.T)]
    return away


def deposit(
    tau: NDArray[np.float64], graph: GridGraph, nodes: NDArray[np.int32], amount: float, algorithm: Settings
) -> None:
    """Leave pheromone on the edges of a path, or of its cells, as the algorithm's ants do."""
    slots, reverse = slots_along(graph.graph, nodes), graph.graph.reverse
    if algorithm.deposit is names.Deposit.CELLS:
        for node in nodes[1:]:
            known = graph.graph.neighbours[node] < len(graph)
            tau[graph.graph.neighbours[node][known], reverse[node][known]] += amount
        return
    tau[nodes[:-1], slots] += amount
    if algorithm.deposit is names.Deposit.BOTH:
        tau[nodes[1:], reverse[nodes[:-1], slots]] += amount


def population(paths: Sequence[NDArray[np.int32]], problem: Problem) -> list[KnownPath]:
    """Remembered paths as paths of this problem, without those of which nothing is left."""
    found = []
    for path in paths:
        whole = mended(path, problem)
        if whole is not None:
            short = shortened(whole, problem)
            nodes = np.searchsorted(problem.graph.flat, short).astype(np.int32)
            found.append(KnownPath(nodes, problem.cost_along(short)))
    return found


def between(graph: GridGraph, values: NDArray[np.float64]) -> csr_array:
    """Values of edges, shape (n, 8), as a sparse matrix."""
    from scipy.sparse import coo_array

    tail, slot = np.nonzero(graph.graph.neighbours < len(graph))
    head = graph.graph.neighbours[tail, slot]
    return coo_array((values[tail, slot], (tail, head)), shape=(len(graph), len(graph))).tocsr()


def drawn(graph: GridGraph, start: int, goal: int, chance: np.random.Generator) -> NDArray[np.int32]:
    """A shortest path where each edge costs between once and `DEAREST` times what it does."""
    from scipy.sparse.csgraph import dijkstra

    costs = graph.graph.lengths * chance.uniform(1.0, DEAREST, graph.graph.lengths.shape)
    _, before = dijkstra(between(graph, costs), directed=True, indices=[start], return_predecessors=True)
    nodes = [goal]
    while nodes[-1] != start:
        nodes.append(int(before[0, nodes[-1]]))
    return np.array(nodes[::-1], np.int32)


def mutated(nodes: NDArray[np.int32], graph: GridGraph, chance: np.random.Generator) -> NDArray[np.int32]:
    """The path with a new piece between two of its nodes."""
    first, last = np.sort(chance.choice(len(nodes), 2, replace=False))
    piece = drawn(graph, int(nodes[first]), int(nodes[last]), chance)
    return without_loops(np.concatenate((nodes[:first], piece, nodes[last + 1 :])))
