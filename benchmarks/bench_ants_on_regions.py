"""Do ants help a replanner over regions? `python benchmarks/bench_ants_on_regions.py [routes] [jams] [--data FOLDER]`.

`routes`: after each change of the map, idle time goes into more routes over regions, each laid out on cells and made
shorter; the cheapest stays. Who proposes them: nobody (`twin`, which is `antnav.live.regions`), longer windows
instead, lengths over regions with noise (no memory), the path's true costs written back to the crossings (no ants),
ants that follow pheromone on the crossings. `+ ready`: what was laid out and not taken is kept, and taken at once
where the path breaks and no box mends it.

`jams`: discs of cells in which cells cost more from time to time; a robot drives there and back and is told prices of
now, all of them or those near it. It plans with them, or with what memory says of the time when it will be there.
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path
from typing import Any, ClassVar

import numba
import numpy as np
from numpy.typing import NDArray

import antnav as an
from antnav import maps
from antnav.kernels import grid_kernels, heap, region_kernels
from antnav.live import regions as live_regions
from antnav.live.astar import AStar
from antnav.live.cost_memory import CostMemory
from antnav.live.regions import ROUNDS, Regions
from antnav.live.replanner import Path as Way
from antnav.live.replanner import Replanner
from antnav.live.terrain import LiveTerrain
from antnav.world.grid import GridMap

_push, _pop = numba.njit(heap.push), numba.njit(heap.pop)
_WINDOW = live_regions.WINDOW


NONE = np.empty(0, np.int32)
LASTING = 8


def query(grid: an.GridMap, rng: np.random.Generator) -> an.Problem:
    """A pair of cells that a way joins, at least half the map apart."""
    free = np.argwhere(grid.passable())
    while True:
        start, goal = (tuple(cell) for cell in rng.choice(free, 2).tolist())
        problem = an.Problem.from_cells(grid, start, goal)
        if problem.connected and np.abs(np.subtract(start, goal)).max() > max(grid.shape) / 2:
            return problem


class Events:
    """What happens to one map and one robot."""

    def __init__(self, terrain: LiveTerrain, radius: int, goal: int, seed: int) -> None:
        self.terrain, self.goal, self.margin = terrain, goal, radius + 2
        self.rng = np.random.default_rng(seed)
        away = np.indices((2 * radius + 1,) * 2) - radius
        self.disc = np.argwhere((away**2).sum(axis=0) <= radius * radius) - radius
        self.lying: list[NDArray[np.int32]] = []

    def next(self, path: NDArray[np.int32] | None, robot: int) -> NDArray[np.int32]:
        """Cells whose moves are others then."""
        if path is None:
            return self.terrain.alter(NONE, self.lying.pop(int(self.rng.integers(len(self.lying)))))
        terrain, rng = self.terrain, self.rng
        along, offset, oldest = rng.random(), rng.integers(-3, 4, 2), int(rng.integers(LASTING))
        centre = terrain.cells_of(path[int(along * (len(path) - 1))]) + offset
        away = np.abs(terrain.cells_of(np.array([robot, self.goal])) - centre).max(axis=1).min()
        cells = centre + self.disc
        cells = cells[((cells >= 0) & (cells < terrain.shape)).all(axis=1)]
        flat = terrain.flat_of("disc", cells) if away > self.margin else NONE
        flat = flat[terrain.passable[flat] > 0]
        freed = self.lying.pop(oldest) if len(self.lying) > LASTING else NONE
        if flat.size:
            self.lying.append(flat)
        return terrain.alter(flat, freed)


# --- routes ----------------------------------------------------------------------------------------------------------


@numba.njit
def _key(leave: int, enter: int, width: int) -> int:
    """Where a crossing's memory lies: it survives that its block gets its regions anew."""
    step = enter - leave
    row = 1 if step > 1 else (-1 if step < -1 else 0)
    return leave * 9 + 4 + 3 * row + step - row * width


@numba.njit
def _between(regions: Any, one: int, two: int) -> int:
    e = regions.head[one]
    while e >= 0 and regions.other[e] != two:
        e = regions.after[e]
    return e


@numba.njit
def _correct(regions: Any, base: Any, mark: Any, factor: Any, width: int) -> None:
    """Write octile lengths times what was learned into the crossings."""
    for region in range(regions.head.size):
        if region % regions.most >= regions.number[region // regions.most]:
            continue
        e = regions.head[region]
        while e >= 0:
            if regions.length[e] != mark[e]:  # made anew since
                base[e] = regions.length[e]
            regions.length[e] = base[e] * factor[_key(regions.leave[e], regions.enter[e], width)]
            mark[e] = regions.length[e]
            e = regions.after[e]


@numba.njit
def _teach(regions: Any, base: Any, factor: Any, typical: Any, path: Any, width: int, price: Any, rho: float) -> None:
    """What a path costs from the middle of its cells in one region to the middle of those in the next.

    As a share of the octile length, and of what that share typically is: or crossings that were tried would look
    shorter than those that were not.
    """
    region = regions.region
    costs = np.zeros(path.size)
    for i in range(1, path.size):
        step = path[i] - path[i - 1]
        straight = step in (1, -1, width, -width)
        length = 1.0 if straight else np.sqrt(2.0)
        if price.size > 0:
            length *= 0.5 * (price[path[i]] + price[path[i - 1]])
        costs[i] = costs[i - 1] + length
    begin, first, before, last = 0, 0, -1.0, -1
    for i in range(1, path.size + 1):
        if i < path.size and region[path[i]] == region[path[begin]]:
            continue
        middle = 0.5 * (costs[begin] + costs[i - 1])
        this = region[path[begin]]
        if last >= 0 and this >= 0 and first > 0 and i < path.size:  # whole pieces only
            for back in range(2):
                e = _between(regions, this, last) if back else _between(regions, last, this)
                if e >= 0 and base[e] > 0:
                    ratio = (middle - before) / base[e]
                    typical[0] += 0.01 * (ratio - typical[0])
                    ratio = min(3.0, max(0.3, ratio / typical[0]))
                    key = _key(regions.leave[e], regions.enter[e], width)
                    factor[key] += rho * (ratio - factor[key])
        last, before, first, begin = this, middle, begin, i


@numba.njit
def _fade(regions: Any, trail: Any, width: int, rho: float, least: float) -> None:
    for region in range(regions.head.size):
        if region % regions.most >= regions.number[region // regions.most]:
            continue
        e = regions.head[region]
        while e >= 0:
            key = _key(regions.leave[e], regions.enter[e], width)
            trail[key] = max(least, (1 - rho) * trail[key])
            e = regions.after[e]


@numba.njit
def _deposit(regions: Any, trail: Any, path: Any, width: int, amount: float) -> None:
    region = regions.region
    for i in range(1, path.size):
        one, two = region[path[i - 1]], region[path[i]]
        if one != two and one >= 0 and two >= 0:
            e = _between(regions, one, two)
            if e >= 0:
                key = _key(regions.leave[e], regions.enter[e], width)
                trail[key] = min(1.0, trail[key] + amount)


@numba.njit
def _from_goal(regions: Any, last: int, first: int, slack: float, far: Any) -> None:
    """Dijkstra's algorithm from the goal's region, as far as the start's and some more."""
    far[:] = np.inf
    keys, items = np.empty(1024), np.empty(1024, np.int32)
    far[last] = 0.0
    keys[0], items[0] = 0.0, last
    size, bound = 1, np.inf
    while size > 0:
        g = keys[0]
        this = _pop(keys, items, size)
        size -= 1
        if g > bound:
            break
        if g > far[this]:
            continue
        if this == first:
            bound = slack * g
        e = regions.head[this]
        while e >= 0:
            two = regions.other[e]
            if g + regions.length[e] < far[two]:
                far[two] = g + regions.length[e]
                if size == keys.size:
                    keys, items = np.append(keys, keys), np.append(items, items)
                _push(keys, items, size, far[two], two)
                size += 1
            e = regions.after[e]


@numba.njit
def _walk(regions: Any, trail: Any, far: Any, seen: Any, number: int, ends: Any, width: int, beta: float) -> Any:
    """An ant's route: crossings by pheromone and by the detour they mean; no region twice. Empty where it is lost."""
    start, goal = ends
    stops = np.empty(4096, np.int32)
    stops[0], count = start, 1
    this, last = regions.region[start], regions.region[goal]
    seen[this] = number
    while this != last:
        total, chosen = 0.0, -1
        e = regions.head[this]
        while e >= 0:
            two = regions.other[e]
            if seen[two] != number and far[two] < np.inf:
                detour = max(0.0, regions.length[e] + far[two] - far[this])
                weight = trail[_key(regions.leave[e], regions.enter[e], width)] * np.exp(-beta * detour)
                total += weight
                if np.random.random() * total < weight:  # noqa: NPY002
                    chosen = e
            e = regions.after[e]
        if chosen < 0 or count + 3 > stops.size:
            return stops[:0].copy()
        stops[count], stops[count + 1] = regions.leave[chosen], regions.enter[chosen]
        count += 2
        this = regions.other[chosen]
        seen[this] = number
    stops[count] = goal
    return stops[: count + 1].copy()


@numba.njit
def _sow(seed: int) -> None:
    np.random.seed(seed)  # noqa: NPY002


class Proposing(Regions):
    """Regions, and in idle time more routes: each laid out on cells, made shorter, and taken if it costs less."""

    name: ClassVar[str] = "proposing"
    routes = 1
    ready = False  #: take what is ready where the path breaks, instead of a search for a route
    deferred = False  #: no search for a route at once where the path could be mended

    def __init__(self, seed: int = 0) -> None:
        super().__init__()
        self._rng = np.random.default_rng(seed)
        _sow(seed)
        self._others: list[tuple[float, NDArray[np.int32]]] = []
        self._driven: NDArray[np.int32] = np.empty(0, np.int32)
        self.taken = 0
        self._at_once = False

    def begin(self, terrain: LiveTerrain, start: int, goal: int) -> Way:
        self._others = []
        self._memory: tuple[NDArray[Any], ...] = ()
        path = super().begin(terrain, start, goal)
        self._rounds, self._round = ROUNDS, 0  # without A* at the end, which would leave nothing to compare
        return path

    def learn(self, path: NDArray[np.int32], best: bool) -> None:
        """A path on cells is known now."""

    def propose(self, start: int) -> NDArray[np.int32]:
        """Stops of a route."""
        raise NotImplementedError

    def idle(self) -> Way:
        """Twin's improvement, then routes."""
        path = self.improve(len(ROUNDS))
        if path is None or len(path) < 3:
            return path
        terrain, start = self._terrain, int(path[0])
        if self.routes:
            region_kernels.make_ready(self._regions, terrain.moves, terrain.width, terrain.prices)
        cost = terrain.cost_along(path)
        known = {self._route_of(path)}
        self._others, rejected = [], []
        self.learn(path, True)
        for _ in range(self.routes):
            stops = self.propose(start)
            if not len(stops) or self._route_of(stops) in known:
                continue
            known.add(self._route_of(stops))
            found = self._laid_out(stops, start, cost)
            known.add(self._route_of(found))
            its = terrain.cost_along(found)
            if its < cost - 1e-9:
                rejected.append((cost, path))
                path, cost = found, its
            else:
                rejected.append((its, found))
            self.learn(found, its <= cost)
        self._path = path
        if self.ready:
            self._others = [(c, p) for c, p in rejected if np.isin(p, path, invert=True).mean() > 0.1]
            self._driven = path
        return path

    def _route_of(self, cells: NDArray[np.int32]) -> bytes:
        passed = self._regions.region[cells]
        return passed[np.append(True, passed[1:] != passed[:-1])].tobytes()

    def _laid_out(self, stops: NDArray[np.int32], start: int, cost: float) -> NDArray[np.int32]:
        terrain = self._terrain
        graph = terrain.moves, terrain.width
        alone = np.array([start], np.int32)
        found = region_kernels.lay_out(
            self._regions, self._routing, stops, alone, 0, 0, *graph, terrain.prices, _WINDOW
        )
        hopeful = terrain.cost_along(found) < 1.02 * cost
        for window, offset in ROUNDS[3:] if hopeful else ():
            found = grid_kernels.reoptimise(*graph, found, window, offset, terrain.prices)
        return found

    def _reroute(self, start: int, below: float = np.inf) -> None:
        if below == np.inf and self._others and self._path is not None:
            found = self._ready(start)
            if found is not None:
                self._note(self._path, found)
                self._path = found
                self.taken += 1
                return
        if (self._others or self.deferred) and self._is_longer(below):
            found = self._ready(start)
            if found is not None and self._terrain.cost_along(found) < below:
                self._note(self._path, found)
                self._path = found
                self.taken += 1
            return
        super()._reroute(start, below)

    def _is_longer(self, below: float) -> bool:
        """Whether this is what follows on a mended path that is longer."""
        if not self._at_once or self._path is None or below == np.inf:
            return False
        return abs(self._terrain.cost_along(self._path) * (1 - live_regions.LONGER) - below) < 1e-6

    def changed(self, cells: NDArray[np.int32], start: int) -> Way:
        self._at_once = True
        path = super().changed(cells, start)
        self._at_once = False
        return path

    def _ready(self, start: int) -> Way:
        terrain, back = self._terrain, self._driven
        at = np.flatnonzero(back == start)
        if not len(at):
            return None
        head = back[int(at[0]) : 0 : -1]
        for _, path in sorted(self._others, key=lambda pair: pair[0]):
            whole = region_kernels._without_loops(np.concatenate((head, path)), self._routing.place)
            good, _ = region_kernels.legal_ends(whole, terrain.moves, terrain.width)
            if good == len(whole) - 1:
                return whole
        return None


class Windows(Proposing):
    """The whole path in longer windows instead."""

    def idle(self) -> Way:
        path, terrain = self.improve(len(ROUNDS)), self._terrain
        if path is not None and len(path) > 2:
            for offset in (192, 0):
                path = grid_kernels.reoptimise(terrain.moves, terrain.width, path, 384, offset, terrain.prices)
            self._path = path
        return path


class Exact(Proposing):
    """A* on cells instead: what idle time could do without any of this."""

    def idle(self) -> Way:
        path, terrain = self._path, self._terrain
        if path is not None:
            length, parent, _ = grid_kernels.search(
                terrain.moves, terrain.width, int(path[0]), self._goal, True, terrain.prices
            )
            found = grid_kernels.trace(parent, terrain.width, int(path[0]), self._goal)
            if length[self._goal] < terrain.cost_along(path) - 1e-9:
                path = found
            self._path, self._left, self._dirty = path, 0, None
        return path


class Noise(Proposing):
    """Shortest routes over lengths with noise: nothing is remembered."""

    def propose(self, start: int) -> NDArray[np.int32]:
        regions = self._regions
        noisy = regions._replace(length=regions.length * self._rng.uniform(1, 1.3, regions.length.size))
        return _route(noisy, self._routing, self._terrain, start, self._goal)


def _route(regions: Any, routing: Any, terrain: LiveTerrain, start: int, goal: int) -> NDArray[np.int32]:
    stops: NDArray[np.int32]
    graph = terrain.moves, terrain.width
    _, stops = region_kernels.route(regions, routing, *graph, start, goal, np.inf, False, terrain.prices)
    return stops


class Learning(Proposing):
    """True costs of paths go back to the crossings they lead over; the shortest route by corrected lengths."""

    rho = 0.3

    def learn(self, path: NDArray[np.int32], best: bool) -> None:
        terrain, regions = self._terrain, self._regions
        region_kernels.make_ready(regions, terrain.moves, terrain.width, terrain.prices)
        if not self._memory:
            size = regions.length.size
            self._memory = np.zeros(size), np.full(size, np.nan), np.ones(9 * terrain.moves.size), np.ones(1)
        base, mark, factor, typical = self._memory
        if mark.size != regions.length.size:  # made anew with more room
            base, mark = np.zeros(regions.length.size), np.full(regions.length.size, np.nan)
            self._memory = base, mark, factor, typical
        _correct(regions, base, mark, factor, terrain.width)
        _teach(regions, base, factor, typical, path, terrain.width, terrain.prices.cells, self.rho)
        _correct(regions, base, mark, factor, terrain.width)

    def propose(self, start: int) -> NDArray[np.int32]:
        return _route(self._regions, self._routing, self._terrain, start, self._goal)


class Ants(Learning):
    """Ants that follow pheromone on the crossings; what their paths cost on cells is laid down.

    With `rho = 0` lengths over regions stay octile.
    """

    evaporation, least, beta = 0.1, 0.05, 0.3
    _number = 0

    def begin(self, terrain: LiveTerrain, start: int, goal: int) -> Way:
        self._trail = np.ones(9 * terrain.moves.size)
        return super().begin(terrain, start, goal)

    def idle(self) -> Way:
        self._far: Any = None
        path = super().idle()
        if path is not None:
            _fade(self._regions, self._trail, self._terrain.width, self.evaporation, self.least)
            _deposit(self._regions, self._trail, path, self._terrain.width, 0.2)
            for cost, other in self._others:  # bypasses stay alive
                share = max(0.0, 1 - 10 * (cost / self._terrain.cost_along(path) - 1))
                _deposit(self._regions, self._trail, other, self._terrain.width, 0.1 * share)
        return path

    def learn(self, path: NDArray[np.int32], best: bool) -> None:
        if self.rho:
            super().learn(path, best)

    def propose(self, start: int) -> NDArray[np.int32]:
        regions = self._regions
        if self._far is None or self._far.size != regions.head.size:
            self._far, self._seen, self._number = np.empty(regions.head.size), np.zeros(regions.head.size, np.int64), 0
            ends = int(regions.region[self._goal]), int(regions.region[start])
            _from_goal(regions, *ends, 1.3, self._far)
        self._number += 1
        ends = start, self._goal
        stops: NDArray[np.int32] = _walk(
            regions, self._trail, self._far, self._seen, self._number, ends, self._terrain.width, self.beta
        )
        return stops


class Twin(Proposing):
    """`antnav.live.regions` as it is."""

    routes = 0


def _kind(base: type[Proposing], **what: Any) -> type[Proposing]:
    return type(base.__name__, (base,), what)


ROUTERS: dict[str, type[Proposing]] = {
    "twin": Twin,
    "A* in idle time": Exact,
    "longer windows": Windows,
    "noise": Noise,
    "true costs": Learning,
    "own costs": _kind(Learning, routes=0),
    "ants, octile": _kind(Ants, rho=0.0),
    "ants": Ants,
    "deferred": _kind(Twin, deferred=True),
    "noise + ready": _kind(Noise, ready=True),
    "ants + ready": _kind(Ants, ready=True),
}

FILES = {
    "32room": "rooms/32room_000.map",
    "AR0602SR": "bg512/AR0602SR.map",
    "brc202d": "dao/brc202d.map",
    "random512-10": "random/random512-10-0.map",
    "NewYork": "cities/NewYork_0_1024.map",
    "Berlin": "cities/Berlin_0_256.map",
    "den312d": "dao/den312d.map",
}


def grid_of(name: str, data: Path) -> GridMap | None:
    if name == "maze":  # with loops: detours that octile lengths do not know
        return maps.generate("maze", 341, 341, seed=5, passage=5, wall=2, loops=0.25)
    if name == "rooms":
        return maps.generate("rooms", 240, 240, seed=3, room=18, door=4)
    if name == "caves":
        return maps.generate("caves", 240, 240, seed=4)
    file = data / "movingai" / FILES[name]
    return maps.load_map(file) if file.exists() else None


class Stopwatch:
    """Time in one function of a module."""

    def __init__(self, module: Any, name: str) -> None:
        self._module, self._name, self.seconds = module, name, 0.0

    def __getattr__(self, name: str) -> Any:
        found = getattr(self._module, name)
        if name != self._name:
            return found

        def timed(*given: Any) -> Any:
            begin = time.process_time()
            answer = found(*given)
            self.seconds += time.process_time() - begin
            return answer

        return timed


class Side:
    """One replanner on its own copy of a map; draws of events are the same for all."""

    def __init__(self, kind: type[Proposing], problem: an.Problem, radius: int, seed: int) -> None:
        self.terrain, (self.robot, goal) = LiveTerrain(problem), problem.flat_ends
        self.replanner, self.exact = kind(seed), AStar()
        self.replanner.begin(self.terrain, self.robot, goal)
        self.exact.begin(self.terrain, self.robot, goal)
        self.path = self.replanner.idle()
        self.course = Events(self.terrain, radius, goal, seed)
        #: seconds at once, of them in A* over regions, gap at once, idle seconds, gap then, A*'s seconds
        self.measured: list[tuple[float, ...]] = []

    def event(self) -> None:
        terrain, path = self.terrain, self.path
        cells = self.course.next(path, self.robot)
        if path is not None:
            self.robot = int(path[min(2, len(path) - 1)])
        if self.robot == self.course.goal:
            return
        watch = Stopwatch(region_kernels, "route")
        live_regions.region_kernels = watch  # type: ignore[assignment]
        begin = time.process_time()
        path = self.replanner.changed(cells, self.robot)
        own = time.process_time() - begin
        live_regions.region_kernels = region_kernels
        at_once = np.inf if path is None else terrain.cost_along(path)
        begin = time.process_time()
        self.path = path = self.replanner.idle()
        idle = time.process_time() - begin
        begin = time.process_time()
        best = self.exact.moved(self.robot)
        anew = time.process_time() - begin
        assert (best is None) == (path is None), "wrong verdict"
        if best is not None and path is not None:
            least = terrain.cost_along(best)
            assert region_kernels.legal_ends(path, terrain.moves, terrain.width)[0] == len(path) - 1
            gaps = 100 * (at_once / least - 1), 100 * (terrain.cost_along(path) / least - 1)
            self.measured.append((1e3 * own, 1e3 * watch.seconds, gaps[0], 1e3 * idle, gaps[1], 1e3 * anew))


def sides_of(names: list[str], problem: an.Problem, radius: int, events: int, seed: int) -> dict[str, Side]:
    """All of them, in turn."""
    sides = {name: Side(ROUTERS[name], problem, radius, seed) for name in names}
    for _ in range(events):
        for side in sides.values():
            side.event()
    return sides


def bench_routes(given: argparse.Namespace) -> None:
    warm = maps.generate("maze", 90, 90, seed=1, passage=3, loops=0.3)
    sides_of(given.idle, query(warm, np.random.default_rng(0)), 2, 8, 0)
    print(f"{'map':13}{'disc':>5} {'idle routes':15}{'median':>8}{'p99':>8}{'no A*':>8}{'max':>8}{'gap %':>7}", end="")
    print(f"{'largest':>9}{'idle ms':>9}{'gap %':>7}{'largest':>9}{'taken':>7}{'A* ms':>8}")
    everything: dict[str, list[Any]] = {name: [] for name in given.idle}
    for name in given.maps:
        grid = grid_of(name, given.data)
        if grid is None:
            continue
        rng = np.random.default_rng(given.seed)
        problems = [query(grid, rng) for _ in range(given.queries)]
        for radius in given.discs:
            rows: dict[str, list[Any]] = {method: [] for method in given.idle}
            taken = dict.fromkeys(given.idle, 0)
            for i, problem in enumerate(problems):
                for method, side in sides_of(given.idle, problem, radius, given.events, given.seed + i).items():
                    rows[method] += side.measured
                    taken[method] += side.replanner.taken
            for method, measured in rows.items():
                everything[method] += measured
                tell(f"{name:13}{radius:5} {method:15}", measured, taken[method])
    for method, measured in everything.items():
        tell(f"{'all':13}{'':5} {method:15}", measured, 0)


def tell(head: str, measured: list[Any], taken: int) -> None:
    own, route, first, idle, then, anew = np.array(measured).T
    print(head + "".join(f"{np.percentile(own, p):8.3f}" for p in (50, 99)), end="")
    print(f"{np.percentile(own - route, 99):8.3f}{own.max():8.3f}{first.mean():7.2f}{first.max():9.2f}", end="")
    print(f"{idle.mean():9.2f}{then.mean():7.2f}{then.max():9.2f}{taken:7}{anew.mean():8.2f}", flush=True)


# --- jams ------------------------------------------------------------------------------------------------------------

EXTRA = 6.0  # what a jam adds to the price 1 of a cell, that is to the time that a move takes
STEP = 12  # moves between two looks at the map


class Sites:
    """Discs that are jammed from time to time; when, nobody can influence."""

    def __init__(self, problem: an.Problem, lasting: float, drift: bool, seed: int, radius: int = 6) -> None:
        rng = np.random.default_rng(seed)
        terrain = LiveTerrain(problem)
        start, goal = problem.flat_ends
        centres: list[NDArray[np.int32]] = [
            terrain.cells_of(np.array([start]))[0],
            terrain.cells_of(np.array([goal]))[0],
        ]
        away = np.indices((2 * radius + 1,) * 2) - radius
        disc = np.argwhere((away**2).sum(axis=0) <= radius * radius) - radius
        terrain.begin_prices()
        everywhere = terrain._flat_map()
        self.cells: list[NDArray[np.int32]] = []
        for _ in range(8):  # where ways lead that are not much longer
            coarse = rng.uniform(0, 2, tuple(side // 16 + 1 for side in terrain.shape))
            noise = np.kron(coarse, np.ones((16, 16)))[: terrain.shape[0], : terrain.shape[1]]
            terrain.price(everywhere, noise.ravel())
            exact = AStar()
            path = exact.begin(terrain, start, goal)
            assert path is not None
            for along in rng.permutation(len(path))[:12]:
                centre = terrain.cells_of(path[along])
                if min(np.abs(centre - other).max() for other in centres) > 2 * radius + 2:
                    centres.append(centre)
                    inside = centre + disc
                    inside = inside[((inside >= 0) & (inside < terrain.shape)).all(axis=1)]
                    self.cells.append(terrain.flat_of("disc", inside))
        self.centres = np.array(centres[2:])
        self.of = np.full(terrain.moves.size, -1)
        for site, inside in enumerate(self.cells):
            self.of[inside] = site
        count = len(self.cells)
        #: share of the time that each is jammed, before and after half of the mission
        self.share = rng.beta(0.5, 0.5, (2 if drift else 1, count)).clip(0.05, 0.95)
        self.lasting, self.half = lasting, 2500.0 if drift else np.inf
        self.switches = [self._draw(site, rng) for site in range(count)]

    def _draw(self, site: int, rng: np.random.Generator) -> NDArray[np.float64]:
        """When it is jammed, free, jammed, ..."""
        now, switches, jammed = 0.0, [0.0], True
        if rng.random() > self.share[0, site]:
            switches, jammed = [0.0, 0.0], False
        while now < 20000:
            share = self.shares(now)[site]
            now += rng.exponential(2 * self.lasting * (share if jammed else 1 - share))
            switches.append(now)
            jammed = not jammed
        return np.array(switches)

    def shares(self, now: float) -> NDArray[np.float64]:
        return self.share[-1 if now > self.half else 0]

    def jammed(self, site: int, now: float) -> bool:
        return bool(np.searchsorted(self.switches[site], now, side="right") % 2)

    def correlation(self, now: float, ahead: NDArray[np.float64]) -> NDArray[np.float64]:
        share = self.shares(now)
        return np.exp(-ahead / (2 * self.lasting) * (1 / share + 1 / (1 - share)))


class Belief:
    """What jams add when the robot will be there: `trust` in what was seen last fades to what is remembered.

    `evaporation` is the time after which memory has lost all but 1/e, as pheromone does; inf: the mean of all that was
    seen. `trust` is the time in which what was seen loses as much of its worth; nan: learned from how often jams were
    seen to come or go; below 0: jams are ignored.
    """

    def __init__(self, sites: Sites, trust: float, evaporation: float, oracle: bool = False) -> None:
        self._sites, self._trust, self._evaporation, self._oracle = sites, trust, evaporation, oracle
        count = len(sites.cells)
        self._last, self._seen = np.zeros(count), np.zeros(count)  # jammed or not, and when that was so
        self._sum, self._weight, self._known = np.zeros(count), np.zeros(count), np.zeros(count, np.bool_)
        self._now = 0.0
        self._flips, self._watched = 1.0, 400.0

    def look(self, now: float, visible: NDArray[np.bool_]) -> None:
        before, self._now = self._now, now
        seconds = now - before
        kept = np.exp(-seconds / self._evaporation)
        state = np.array([self._sites.jammed(site, now) for site in range(len(visible))], np.float64)
        amount = min(seconds, 20.0) * visible
        watched = visible & self._known & (self._seen == before)  # then, too
        self._flips += float((state != self._last)[watched].sum())
        self._watched += seconds * float(watched.sum())
        kept = np.where(visible, kept, 1.0)  # what nobody looks at does not fade
        self._sum = kept * self._sum + amount * state
        self._weight = kept * self._weight + amount
        self._last = np.where(visible, state, self._last)
        self._seen = np.where(visible, now, self._seen)
        self._known |= visible

    def extra(self, away: NDArray[np.float64]) -> NDArray[np.float64]:
        """Of each site, if the robot has so far to go."""
        if self._trust < 0:
            return np.zeros(len(away))
        ahead = self._now - self._seen + away
        if self._oracle:
            mean, trust = self._sites.shares(self._now), self._sites.correlation(self._now, ahead)
        else:
            mean = (self._sum + 4.0) / (self._weight + 20.0)
            lasting = self._trust
            if np.isnan(lasting):
                lasting = 2 * float((mean * (1 - mean)).mean()) * self._watched / self._flips
            trust = np.exp(-ahead / lasting) if lasting else np.zeros(len(ahead))
            if self._trust == np.inf:
                mean = np.zeros(len(ahead))
        trust = np.where(self._known, trust, 0.0)
        expected: NDArray[np.float64] = EXTRA * (mean + trust * (self._last - mean))
        return expected


class Priced(Regions):
    """Regions that look for a better route after each change of prices, raised ones too."""

    def changed(self, cells: NDArray[np.int32], start: int) -> Way:
        super().changed(cells, start)
        if len(cells):
            self._mark_near(cells)
        return self.improve(len(ROUNDS))


class Together(CostMemory):
    """`CostMemory` with those regions."""

    def __init__(self) -> None:
        super().__init__(Priced())


#: Planner, time for which what was seen is trusted, time in which memory evaporates, whether it is told the truth.
DRIVERS: dict[str, tuple[type[Replanner], float, float, bool]] = {
    "present prices": (Priced, np.inf, np.inf, False),
    "none": (Priced, -1.0, np.inf, False),
    "memory alone": (Priced, 0.0, 1000.0, False),
    "pheromone": (Priced, np.nan, 1000.0, False),
    "  fast fading": (Priced, np.nan, 250.0, False),
    "  no fading": (Priced, np.nan, np.inf, False),
    "true shares": (Priced, 0.0, np.inf, True),
    "CostMemory": (Together, np.inf, np.inf, False),
    "A*: present": (AStar, np.inf, np.inf, False),
    "A*: pheromone": (AStar, np.nan, 1000.0, False),
    "A*: CostMemory": (CostMemory, np.inf, np.inf, False),
}


def drive(
    problem: an.Problem, sites: Sites, driver: str, sight: float, trips: int
) -> tuple[NDArray[np.float64], float]:
    """Time of each trip, and milliseconds of CPU a look."""
    kind, trust, evaporation, oracle = DRIVERS[driver]
    terrain, replanner = LiveTerrain(problem), kind()
    terrain.begin_prices()
    belief = Belief(sites, trust, evaporation, oracle)
    start, goal = problem.flat_ends
    width, robot, now = terrain.width, start, 0.0
    believed = np.zeros(len(sites.cells))
    times, seconds, looks = np.zeros(trips), 0.0, 0
    for trip in range(trips):
        goal = problem.flat_ends[1 - trip % 2]
        begun, path = False, None
        while robot != goal:
            rows, cols = (np.abs(terrain.cells_of(np.array([robot])) - sites.centres)).T
            away = np.maximum(rows, cols) + 0.414 * np.minimum(rows, cols)
            belief.look(now, away <= sight)
            extra = belief.extra(np.maximum(away - 6, 0))
            other = np.flatnonzero(np.abs(extra - believed) > 0.25)
            believed[other] = extra[other]
            changed = np.empty(0, np.int32)
            begin = time.process_time()
            if len(other):
                cells = np.concatenate([sites.cells[site] for site in other])
                values = np.concatenate([np.full(len(sites.cells[site]), believed[site]) for site in other])
                changed = terrain.price(cells, values)
            if not begun:
                replanner.altered(changed)
                path, begun = replanner.begin(terrain, robot, goal), True
            else:
                path = replanner.changed(changed, robot)
            seconds, looks = seconds + time.process_time() - begin, looks + 1
            assert path is not None and path[0] == robot
            for one, two in zip(path[:STEP].tolist(), path[1 : STEP + 1].tolist(), strict=False):
                price = 1.0
                for cell in (one, two):
                    site = int(sites.of[cell])
                    price += 0.5 * EXTRA * (site >= 0 and sites.jammed(site, now))
                passed = price * (1.0 if abs(two - one) in (1, width) else 2**0.5)
                now += passed
                times[trip] += passed
            robot = int(path[min(STEP, len(path) - 1)])
    return times, 1e3 * seconds / looks


def bench_jams(given: argparse.Namespace) -> None:
    print(f"{'sight':6}{'lasting':>8} {'planned with':17}" + "".join(f"{name:>11}" for name in given.jam_maps), end="")
    print(f"{'mean':>8}{'later':>8}{'ms':>7}   time over that with present prices, %; later: second half of the trips")
    cases = [(lasting, False) for lasting in given.lasting] + [(100.0, True)]
    for sight in given.sights:
        for lasting, drift in cases:
            times: dict[str, list[Any]] = {driver: [] for driver in given.drivers}
            took: dict[str, list[float]] = {driver: [] for driver in given.drivers}
            for name in given.jam_maps:
                grid = grid_of(name, given.data)
                assert grid is not None
                rng = np.random.default_rng(given.seed)
                for seed in range(given.seed, given.seed + given.queries):
                    problem = query(grid, rng)
                    sites = Sites(problem, lasting, drift, seed)
                    for driver in given.drivers:
                        trips, ms = drive(problem, sites, driver, sight, given.trips)
                        times[driver].append((name, trips.sum(), trips[given.trips // 2 :].sum()))
                        took[driver].append(ms)
            base = times["present prices"]
            for driver, all_times in times.items():
                over = np.array(
                    [
                        [100 * (a / b - 1) for a, b in zip(x[1:], y[1:], strict=True)]
                        for x, y in zip(all_times, base, strict=True)
                    ]
                )
                by_map = [over[[x[0] == name for x in all_times], 0].mean() for name in given.jam_maps]
                word = "all" if sight == np.inf else f"{sight:.0f}"
                print(f"{word:6}{lasting:8.0f}{'*' if drift else ' '}{driver:17}", end="")
                print("".join(f"{o:11.1f}" for o in by_map), end="")
                print(f"{over[:, 0].mean():8.1f}{over[:, 1].mean():8.1f}{np.mean(took[driver]):7.2f}", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("what", nargs="*", default=["routes", "jams"])
    parser.add_argument("--data", type=Path, default=Path(__file__).resolve().parents[2] / "shared" / "data")
    parser.add_argument("--maps", nargs="+", default=["32room", "AR0602SR", "brc202d", "maze", "NewYork"])
    parser.add_argument("--idle", nargs="+", choices=ROUTERS, default=list(ROUTERS))
    parser.add_argument("--queries", type=int, default=2)
    parser.add_argument("--events", type=int, default=60)
    parser.add_argument("--discs", type=int, nargs="+", default=[4, 12])
    parser.add_argument("--seed", type=int, default=71)
    parser.add_argument("--drivers", nargs="+", choices=DRIVERS, default=list(DRIVERS))
    parser.add_argument("--sights", type=float, nargs="+", default=[np.inf, 40, 10])
    parser.add_argument("--lasting", type=float, nargs="+", default=[20, 100, 500, 3000])
    parser.add_argument("--jam-maps", nargs="+", default=["Berlin", "maze", "rooms", "caves"])
    parser.add_argument("--trips", type=int, default=8)
    given = parser.parse_args()
    if "routes" in given.what:
        bench_routes(given)
    if "jams" in given.what:
        bench_jams(given)


if __name__ == "__main__":
    main()
