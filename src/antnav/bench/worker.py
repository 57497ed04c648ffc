# mypy: disable-error-code="import-not-found,import-untyped"
"""Planners that can be installed, each behind the same two calls, and their stopwatch.

`antnav bench peers` runs this file as a program, in whichever interpreter has the peer: it needs NumPy and nothing
else, not even antnav.

    worker.py list                             {peer: version} of those installed here
    worker.py PEER TASK.npz RUNS SEED SECONDS  one line a run: seconds and path; no new run after SECONDS
"""

from __future__ import annotations

import json
import math
import os
import random
import sys
import time
from importlib import metadata
from pathlib import Path
from typing import Any, NamedTuple, TextIO

import numpy as np
from numpy.typing import NDArray

Points = list[Any]  #: (row, col) of each point, start first
SQRT2 = math.sqrt(2.0)
STEPS = ((-1, -1), (-1, 0), (-1, 1), (0, -1), (0, 1), (1, -1), (1, 0), (1, 1))
#: The first planner of antnav in the list is exact; the others are these presets.
PRESETS = ("npaco", "paco", "paco_ls", "gao", "paco_large")


class Task(NamedTuple):
    """What to plan: a map, True where blocked, and two of its cells."""

    blocked: NDArray[np.bool_]
    start: tuple[int, int]
    goal: tuple[int, int]


class Peer:
    """A planner.

    Attributes
    ----------
    distribution : str
        Its name on PyPI.
    majors : range
        Major versions that this adapter fits.
    corner : str
        "forbid" or "allow": its corner rule; "any angle": its path does not follow the cells.
    largest : int
        Longest side of a map that it is tried on.
    """

    distribution = ""
    majors = range(1000)
    corner = "forbid"
    largest = 100_000

    def version(self) -> str | None:
        """The version installed here; None where none is, or one that does not fit."""
        try:
            version = metadata.version(self.distribution)
        except metadata.PackageNotFoundError:
            return None
        return version if int(version.split(".")[0]) in self.majors else None

    def build(self, task: Task) -> Any:
        """What further queries on the map can use again."""
        raise NotImplementedError

    def solve(self, state: Any, task: Task, seed: int) -> Points | None:
        """A path, or None."""
        raise NotImplementedError


# antnav


class Antnav(Peer):
    """antnav's A*, or a preset; the map and its legal moves can be used again."""

    distribution = "antnav"

    def __init__(self, preset: str | None = None) -> None:
        self.preset = preset

    def build(self, task: Task) -> Any:
        """The map, and what belongs to it."""
        import antnav as an

        grid = an.GridMap(task.blocked.view(np.uint8))
        _ = an.Problem.from_cells(grid, task.start, task.goal).moves
        if self.preset is not None and (block := an.preset(self.preset).coarse):
            an.prepare(grid, block=block)
        return grid

    def solve(self, state: Any, task: Task, seed: int) -> Points | None:
        """As a user would."""
        import antnav as an

        problem = an.Problem.from_cells(state, task.start, task.goal)
        if self.preset is None:
            path = an.exact.shortest_path(problem).path
        else:
            path = an.solve(problem, an.preset(self.preset), seed=seed).path
        return None if path is None else path.cells.tolist()


# Graph libraries: the user builds the graph, here without cut corners


class Graph(NamedTuple):
    """The edges of a map, each in both directions."""

    source: NDArray[np.int64]
    target: NDArray[np.int64]
    length: NDArray[np.float64]


def graph_of(blocked: NDArray[np.bool_], *, allow: bool = False) -> Graph:
    """Edges between neighbouring free cells; diagonals between two blocked ones only where `allow`."""
    rows, cols = blocked.shape
    free = np.pad(~blocked, 1)
    number = np.pad(np.arange(rows * cols).reshape(rows, cols), 1)
    parts: list[tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]] = []

    def shifted(array: NDArray[Any], row: int, col: int) -> NDArray[Any]:
        return array[1 + row : 1 + row + rows, 1 + col : 1 + col + cols]

    for row, col in STEPS:
        legal = shifted(free, 0, 0) & shifted(free, row, col)
        if row and col and not allow:
            legal &= shifted(free, row, 0) & shifted(free, 0, col)
        lengths = np.full(np.count_nonzero(legal), SQRT2 if row and col else 1.0)
        parts.append((shifted(number, 0, 0)[legal], shifted(number, row, col)[legal], lengths))
    return Graph(*(np.concatenate(part) for part in zip(*parts, strict=True)))


def nodes(task: Task) -> tuple[int, int]:
    """Start and goal as numbers of cells in map order."""
    cols = task.blocked.shape[1]
    return task.start[0] * cols + task.start[1], task.goal[0] * cols + task.goal[1]


def cells(path: Any, task: Task) -> Points:
    """Numbers of cells as rows and columns."""
    return [divmod(int(node), task.blocked.shape[1]) for node in path]


def octile(task: Task, node: int) -> float:
    """Distance to the goal on an empty map."""
    row, col = divmod(node, task.blocked.shape[1])
    rows, cols = abs(row - task.goal[0]), abs(col - task.goal[1])
    return float(max(rows, cols) + (SQRT2 - 1) * min(rows, cols))


class Scipy(Peer):
    """Dijkstra's algorithm of scipy.sparse.csgraph."""

    distribution = "scipy"

    def __init__(self, corner: str) -> None:
        self.corner = corner

    def build(self, task: Task) -> Any:
        """A sparse matrix."""
        from scipy.sparse import csr_array

        source, target, length = graph_of(task.blocked, allow=self.corner == "allow")
        return csr_array((length, (source, target)), shape=(task.blocked.size,) * 2)

    def solve(self, state: Any, task: Task, seed: int) -> Points | None:
        """From the start to everywhere: it has no goal."""
        from scipy.sparse.csgraph import dijkstra

        start, goal = nodes(task)
        found: Any = dijkstra(state, indices=[start], return_predecessors=True)
        distance, before = (array[0] for array in found)
        if not np.isfinite(distance[goal]):
            return None
        path = [goal]
        while path[-1] != start:
            path.append(before[path[-1]])
        return cells(reversed(path), task)


class Rustworkx(Peer):
    """A* of rustworkx."""

    distribution = "rustworkx"

    def build(self, task: Task) -> Any:
        """A directed graph."""
        import rustworkx

        graph = rustworkx.PyDiGraph()
        graph.add_nodes_from(range(task.blocked.size))
        graph.add_edges_from(list(zip(*(part.tolist() for part in graph_of(task.blocked)), strict=True)))
        return graph

    def solve(self, state: Any, task: Task, seed: int) -> Points | None:
        """Its nodes call back into Python."""
        import rustworkx

        start, goal = nodes(task)
        path = rustworkx.digraph_astar_shortest_path(
            state, start, lambda node: node == goal, float, lambda node: octile(task, node)
        )
        return cells(path, task)


class Igraph(Peer):
    """Dijkstra's algorithm of igraph."""

    distribution = "igraph"

    def build(self, task: Task) -> Any:
        """An undirected graph and its weights."""
        import igraph

        source, target, length = graph_of(task.blocked)
        once = source < target
        return igraph.Graph(n=task.blocked.size, edges=np.column_stack((source[once], target[once]))), length[once]

    def solve(self, state: Any, task: Task, seed: int) -> Points | None:
        """To one goal."""
        graph, weights = state
        start, goal = nodes(task)
        return cells(graph.get_shortest_paths(start, to=goal, weights=weights.tolist())[0], task)


class Networkx(Peer):
    """A* of NetworkX."""

    distribution = "networkx"

    def build(self, task: Task) -> Any:
        """An undirected graph."""
        import networkx

        source, target, length = graph_of(task.blocked)
        once = source < target
        graph = networkx.Graph()
        graph.add_weighted_edges_from(
            zip(source[once].tolist(), target[once].tolist(), length[once].tolist(), strict=True)
        )
        return graph

    def solve(self, state: Any, task: Task, seed: int) -> Points | None:
        """With the octile heuristic."""
        import networkx

        start, goal = nodes(task)
        return cells(networkx.astar_path(state, start, goal, heuristic=lambda node, _: octile(task, node)), task)


# Grid planners


class Tcod(Peer):
    """A* of tcod, which counts in whole numbers: 70 a straight move, 99 a diagonal one."""

    distribution = "tcod"
    corner = "allow"

    def build(self, task: Task) -> Any:
        """Costs."""
        return (~task.blocked).astype(np.int8)

    def solve(self, state: Any, task: Task, seed: int) -> Points | None:
        """The path ends where it begins if there is none."""
        import tcod.path

        finder = tcod.path.Pathfinder(tcod.path.SimpleGraph(cost=state, cardinal=70, diagonal=99))
        finder.add_root(task.start)
        path: Points = finder.path_to(task.goal).tolist()
        return path if len(path) > 1 else None


class Skimage(Peer):
    """Minimum-cost path of scikit-image."""

    distribution = "scikit-image"
    corner = "allow"

    def build(self, task: Task) -> Any:
        """Costs."""
        return np.where(task.blocked, -1.0, 1.0)

    def solve(self, state: Any, task: Task, seed: int) -> Points | None:
        """To one goal."""
        from skimage.graph import MCP_Geometric

        search = MCP_Geometric(state, fully_connected=True)
        search.find_costs([task.start], [task.goal])
        path: Points = search.traceback(task.goal)
        return path


class Pyastar2d(Peer):
    """A* of pyastar2d, to which a diagonal move costs no more than a straight one."""

    distribution = "pyastar2d"
    corner = "allow"

    def build(self, task: Task) -> Any:
        """Costs."""
        return np.where(task.blocked, np.inf, 1.0).astype(np.float32)

    def solve(self, state: Any, task: Task, seed: int) -> Points | None:
        """With diagonals."""
        import pyastar2d

        path = pyastar2d.astar_path(state, task.start, task.goal, allow_diagonal=True)
        return None if path is None else path.tolist()


class Dijkstra3d(Peer):
    """Dijkstra's algorithm of dijkstra3d, from both ends."""

    distribution = "dijkstra3d"
    corner = "allow"

    def build(self, task: Task) -> Any:
        """Costs in its own order of memory."""
        return np.asfortranarray(np.where(task.blocked, np.inf, 1.0).astype(np.float32))

    def solve(self, state: Any, task: Task, seed: int) -> Points | None:
        """With diagonals, at their length."""
        import dijkstra3d

        path: Points = dijkstra3d.dijkstra(
            state, task.start, task.goal, bidirectional=True, connectivity=8, anisotropy=(1.0, 1.0)
        ).tolist()
        return path


class Pathfinding(Peer):
    """A* of pathfinding, written in Python."""

    distribution = "pathfinding"

    def build(self, task: Task) -> Any:
        """Lists of free cells: its own grid serves one query only."""
        return (~task.blocked).astype(int).tolist()

    def solve(self, state: Any, task: Task, seed: int) -> Points | None:
        """Diagonals between two free cells only."""
        from pathfinding.core.diagonal_movement import DiagonalMovement
        from pathfinding.core.grid import Grid
        from pathfinding.core.heuristic import octile
        from pathfinding.finder.a_star import AStarFinder

        grid = Grid(matrix=state)
        finder = AStarFinder(heuristic=octile, diagonal_movement=DiagonalMovement.only_when_no_obstacle)
        path, _ = finder.find_path(grid.node(*task.start[::-1]), grid.node(*task.goal[::-1]), grid)
        return [(node.y, node.x) for node in path] or None


class Pmp2(Peer):
    """A planner of python-motion-planning 2."""

    distribution = "python-motion-planning"
    majors = range(2, 3)

    def __init__(self, planner: str, corner: str = "forbid") -> None:
        self.planner, self.corner = planner, corner

    def build(self, task: Task) -> Any:
        """Its grid."""
        from python_motion_planning.common import TYPES
        from python_motion_planning.common import Grid as PmpGrid

        grid = PmpGrid(bounds=[[0, side] for side in task.blocked.shape])
        grid.type_map[:, :] = np.where(task.blocked, TYPES.OBSTACLE, TYPES.FREE)
        return grid

    def solve(self, state: Any, task: Task, seed: int) -> Points | None:
        """By the planner of that name."""
        import python_motion_planning.path_planner as planners

        path, info = getattr(planners, self.planner)(map_=state, start=task.start, goal=task.goal).plan()
        return list(path) if info["success"] else None


class Pmp1(Peer):
    """A planner of python-motion-planning 1, the last with ants."""

    distribution = "python-motion-planning"
    majors = range(1, 2)
    largest = 256

    def __init__(self, planner: str, **options: float) -> None:
        self.planner, self.options = planner, options

    def build(self, task: Task) -> Any:
        """Its grid, with walls around: it looks beyond the edge."""
        import matplotlib

        matplotlib.use("Agg")
        from python_motion_planning import Grid as PmpGrid

        walled = np.pad(task.blocked, 1, constant_values=True)
        grid = PmpGrid(*walled.shape)
        grid.update({(int(row), int(col)) for row, col in np.argwhere(walled)})
        return grid

    def solve(self, state: Any, task: Task, seed: int) -> Points | None:
        """From either end; the path is turned the right way round."""
        import python_motion_planning

        start, goal = ((end[0] + 1, end[1] + 1) for end in (task.start, task.goal))
        path = getattr(python_motion_planning, self.planner)(start, goal, state, **self.options).plan()[1]
        shifted = [(row - 1, col - 1) for row, col in path or ()]
        return (shifted if shifted[0] == task.start else shifted[::-1]) if shifted else None


class Pathplan(Peer):
    """A planner of pathplan; its metaheuristics place points of a path at any angle."""

    distribution = "pathplan"
    largest = 256

    def __init__(self, planner: str, corner: str, **options: int) -> None:
        self.planner, self.corner, self.options = planner, corner, options

    def build(self, task: Task) -> Any:
        """Its grid."""
        from pathplan.core import GridMap

        return GridMap(task.blocked.astype(float))

    def solve(self, state: Any, task: Task, seed: int) -> Points | None:
        """By the planner of that name."""
        if self.options:
            from pathplan import metaheuristic as planners
        else:
            from pathplan import classic as planners
        path, _ = getattr(planners, self.planner)(state, **self.options).plan(task.start, task.goal)
        return None if path is None else list(path)


class Ompl(Peer):
    """RRTConnect of OMPL with its simplification, for a point at any angle."""

    distribution = "ompl"
    corner = "any angle"

    def build(self, task: Task) -> Any:
        """The map itself."""
        return task.blocked

    def solve(self, state: Any, task: Task, seed: int) -> Points | None:
        """At most 30 s."""
        from ompl import base, geometric, util

        util.setLogLevel(util.LogLevel.LOG_NONE)
        rows, cols = state.shape
        space, bounds = base.RealVectorStateSpace(2), base.RealVectorBounds(2)
        for axis, side in enumerate(state.shape):
            bounds.setLow(axis, -0.5)
            bounds.setHigh(axis, side - 0.5)
        space.setBounds(bounds)
        setup = geometric.SimpleSetup(space)
        information = setup.getSpaceInformation()
        information.setStateValidityCheckingResolution(0.25 / math.hypot(rows, cols))

        def is_free(point: Any) -> bool:
            row, col = int(point[0] + 0.5), int(point[1] + 0.5)
            return not state[min(rows - 1, max(0, row)), min(cols - 1, max(0, col))]

        setup.setStateValidityChecker(is_free)
        ends = [space.allocState(), space.allocState()]
        for end, cell in zip(ends, (task.start, task.goal), strict=True):
            end[0], end[1] = map(float, cell)
        setup.setStartAndGoalStates(*ends)
        setup.setPlanner(geometric.RRTConnect(information))
        if not setup.solve(30.0) or not setup.haveExactSolutionPath():
            return None
        setup.simplifySolution()
        return [(point[0], point[1]) for point in setup.getSolutionPath().getStates()]


# Other ants


class AcoRouting(Peer):
    """aco_routing on the user's graph, 50 ants and 50 iterations."""

    distribution = "aco-routing"
    largest = 256

    def build(self, task: Task) -> Any:
        """A directed graph of named nodes."""
        import networkx

        source, target, length = graph_of(task.blocked)
        graph = networkx.DiGraph()
        edges = zip(map(str, source.tolist()), map(str, target.tolist()), length.tolist(), strict=True)
        graph.add_weighted_edges_from(edges, weight="cost")
        return graph

    def solve(self, state: Any, task: Task, seed: int) -> Points | None:
        """With antnav's alpha and beta."""
        from aco_routing import ACO

        steps = task.blocked.size // 2
        colony = ACO(state, ant_max_steps=steps, num_iterations=50, ant_random_spawn=False, alpha=1.0, beta=7.0)
        start, goal = (str(node) for node in nodes(task))
        try:
            path, _ = colony.find_shortest_path(source=start, destination=goal, num_ants=50)
        except Exception:  # its way of saying that no ant arrived
            return None
        return cells(path, task)


class Mealpy(Peer):
    """Ants for continuous numbers (ACOR) of mealpy on six points of a path; this encoding is ours."""

    distribution = "mealpy"
    corner = "any angle"
    largest = 256

    def build(self, task: Task) -> Any:
        """The map itself."""
        return task.blocked

    def solve(self, state: Any, task: Task, seed: int) -> Points | None:
        """50 ants, 50 iterations; a blocked sample of the way costs 1000."""
        from mealpy import ACOR, FloatVar

        rows, cols = state.shape
        along = np.linspace(0, 1, 4 * max(rows, cols))[:, None]

        def points(numbers: NDArray[np.float64]) -> NDArray[np.float64]:
            return np.vstack((task.start, numbers.reshape(-1, 2), task.goal)).astype(float)

        def cost(numbers: NDArray[np.float64]) -> float:
            way = points(numbers)
            legs = np.diff(way, axis=0)
            samples = np.concatenate([first + along * leg for first, leg in zip(way, legs, strict=False)])
            near = np.clip(np.rint(samples).astype(int), 0, [rows - 1, cols - 1])
            return float(np.linalg.norm(legs, axis=1).sum() + 1000.0 * state[near[:, 0], near[:, 1]].sum())

        bounds = FloatVar(lb=[0.0] * 12, ub=[rows - 1.0, cols - 1.0] * 6)
        problem = {"obj_func": cost, "minmax": "min", "log_to": None, "bounds": bounds}
        best = ACOR.OriginalACOR(epoch=50, pop_size=50).solve(problem, seed=seed)
        found: Points = points(best.solution).tolist()
        return found if best.target.fitness < 1000 else None


#: By name; antnav's own first.
PEERS: dict[str, Peer] = {
    "antnav-astar": Antnav(),
    **{f"antnav-{preset}": Antnav(preset) for preset in PRESETS},
    "scipy": Scipy("forbid"),
    "scipy-allow": Scipy("allow"),
    "tcod": Tcod(),
    "scikit-image": Skimage(),
    "pyastar2d": Pyastar2d(),
    "dijkstra3d": Dijkstra3d(),
    "rustworkx": Rustworkx(),
    "igraph": Igraph(),
    "networkx": Networkx(),
    "pathfinding": Pathfinding(),
    "pmp2-astar": Pmp2("AStar"),
    "pmp2-theta": Pmp2("ThetaStar", "any angle"),
    "pmp1-astar": Pmp1("AStar"),
    "pmp1-aco": Pmp1("ACO", n_ants=50, max_iter=50, alpha=1.0, beta=7.0),
    "pmp1-aco-defaults": Pmp1("ACO"),
    "pathplan-astar": Pathplan("AStarPlanner", "allow"),
    "pathplan-pso": Pathplan("PSOPlanner", "any angle", pop_size=50, max_iter=50),
    "pathplan-ga": Pathplan("GAPlanner", "any angle", pop_size=50, max_iter=50),
    "pathplan-gwo": Pathplan("GWOPlanner", "any angle", pop_size=50, max_iter=50),
    "aco-routing": AcoRouting(),
    "mealpy-acor": Mealpy(),
    "ompl-rrtconnect": Ompl(),
}


def measure(peer: Peer, task: Task, runs: int, seed: int, seconds: float, out: TextIO) -> None:
    """Time the runs, after one on a small empty map that pays for imports and compilers."""
    small = Task(np.zeros((8, 8), np.bool_), (0, 0), (7, 7))
    _plan(peer, peer.build(small), small, seed)
    begin = time.perf_counter()
    for run in range(runs):
        cpu, first = time.process_time(), time.perf_counter()
        state = peer.build(task)
        built = time.perf_counter()
        path = _plan(peer, state, task, seed + run)
        end = time.perf_counter()
        line = {"total": end - first, "query": end - built, "cpu": time.process_time() - cpu, "path": _plain(path)}
        print(json.dumps(line), file=out, flush=True)
        if end - begin > seconds:
            break


def _plan(peer: Peer, state: Any, task: Task, seed: int) -> Points | None:
    random.seed(seed)
    np.random.seed(seed)  # noqa: NPY002 - what the peers draw from
    return peer.solve(state, task, seed)


def _plain(path: Points | None) -> list[list[float]] | None:
    return None if path is None else [[float(row), float(col)] for row, col, *_ in path]


def main(arguments: list[str]) -> None:
    """The program."""
    here = Path(__file__).resolve().parent  # its modules must not pass for a peer's
    sys.path[:] = [entry for entry in sys.path if Path(entry).resolve() != here]
    with os.fdopen(os.dup(1), "w") as out:
        os.dup2(2, 1)  # what peers print is not ours to read
        if arguments == ["list"]:
            json.dump({name: version for name, peer in PEERS.items() if (version := peer.version())}, out)
            return
        name, file, runs, seed, seconds = arguments
        with np.load(file) as data:
            task = Task(data["blocked"], *(tuple(data[end].tolist()) for end in ("start", "goal")))
        measure(PEERS[name], task, int(runs), int(seed), float(seconds), out)
    sys.stdout.flush()
    os._exit(0)  # not the noisy ends of some peers


if __name__ == "__main__":
    main(sys.argv[1:])
