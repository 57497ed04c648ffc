"""The replanner of ours: a path mended in a box, rerouted over regions, improved when there is time."""

from __future__ import annotations

from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from antnav.kernels import grid_kernels, region_kernels
from antnav.live.replanner import Path, Replanner
from antnav.live.terrain import LiveTerrain
from antnav.planner.once import once
from antnav.world.grid import Cell, GridMap
from antnav.world.problem import Problem

#: Side of a block in cells, and of one on maps of more than so many cells.
BLOCK, LARGE_BLOCK, LARGE = 12, 24, 1_100_000
#: Moves on either side of a broken piece that are searched anew with it, and cells around.
REACH = 12
#: Longest broken piece in moves that is mended in a box.
LONGEST = 64
#: Moves of the windows that make a new route shorter at once.
WINDOW = 24
#: Moves of the window that is searched anew where cells near the path opened.
NEAR = 96
#: What improvement does, round by round: windows of so many moves, and where the first one ends. 0: a new route.
ROUNDS = ((0, 0), (48, 24), (48, 0), (96, 48), (96, 0), (192, 96), (192, 0), (384, 192), (384, 0))
#: The same on maps of at most so many cells: A* takes no longer than larger windows there, and leaves no gap.
SMALL, ROUNDS_SMALL = 2**19, (*ROUNDS[:5], (-1, 0))
#: Rounds that a first plan gets.
FIRST = 6
#: Longer by this share than before, a mended path is compared with a new route.
LONGER = 0.01
#: A route must be shorter by this share, as far as one can tell from regions: at once, and in idle time.
GAIN_AT_ONCE, GAIN_IDLE = 0.04, 0.003


class Regions(Replanner):
    """A path mended where a change broke it, without ants and without proof that it is the shortest [ours].

    1. Blocks that a change touched get their regions anew; the region graph equals one made from the whole map.
    2. Broken moves are searched anew in a box around them. Where that fails, or makes the path longer by more than 1 %,
       a route is searched over regions, laid out on cells and made shorter in windows; the cheaper path stays. A route
       that leads through the same regions as the path in force keeps its cells.
    3. Where cells of the path cost more, a window around them is searched anew, then a route. What could only shorten
       the path waits for `improve`, unless regions say that it is 4 % or more.
    4. `improve` looks for a better route, then searches windows of the path anew where something has changed; on maps
       of at most half a million cells a last round of A* leaves no gap.

    Lengths over regions are approximate: they choose, and paths are compared by what they cost on cells.
    """

    name: ClassVar[str] = "regions"
    exact: ClassVar[bool] = False
    source: ClassVar[str] = "antnav; regions after Botea et al. 2004, windows after Taillard & Voss 2002"

    _terrain: LiveTerrain
    _regions: region_kernels.Regions
    _routing: region_kernels.Routing

    def __init__(self) -> None:
        self._known: LiveTerrain | None = None  #: whose regions are worked out
        self._priced = False  #: with prices
        self._goal = 0
        self._path: Path = None
        self._cut_off = -1  #: where the robot was when no way led to the goal
        self._ratio = 1.0  #: of what paths cost to what regions say
        self._rounds: tuple[tuple[int, int], ...] = ROUNDS
        self._round, self._left = 0, 0  #: of improvement: the next one, and how many there are to do
        self._dirty: tuple[int, int] | None = None  #: where the path is new, in cells from the goal

    def prepare(self) -> None:
        """Compile or load kernels."""
        once({"replanning over regions": _compile})

    def begin(self, terrain: LiveTerrain, start: int, goal: int) -> Path:
        """Work out regions, unless they are known, and plan over them."""
        self.prepare()
        if self._known is not terrain or self._priced != terrain.priced:
            self._terrain, self._known, self._priced = terrain, terrain, terrain.priced
            self._make(_Room(terrain))
        self._goal = goal
        self._ratio, self._dirty, self._path = 1.0, None, None
        self._reroute(start)
        self._rounds = ROUNDS_SMALL if terrain.moves.size <= SMALL else ROUNDS
        self._round, self._left = 1, len(self._rounds) - 1  # the route is the best one
        return self.improve(FIRST)

    def _make(self, room: _Room) -> None:
        """Work out all regions, with as much room as they take."""
        terrain = self._terrain
        while True:
            self._room = room
            self._regions, self._routing = room.arrays()
            region_kernels.make_ready(self._regions, terrain.moves, terrain.width, terrain.prices)
            if not self._regions.full[0]:
                return
            room = room.larger(int(self._regions.full[0]))

    def altered(self, cells: NDArray[np.int32]) -> None:
        """Note which blocks are to be worked out anew before they are used."""
        if self._known is not None and self._priced == self._known.priced:
            region_kernels.touch(self._regions, cells, self._terrain.width)

    def changed(self, cells: NDArray[np.int32], start: int) -> Path:
        """Mend the path, or reroute."""
        self.altered(cells)
        path = self._mended(start, self._terrain.opened if len(cells) else cells)
        raised = self._terrain.raised
        if path is not None and len(cells) and len(raised) and np.isin(path, raised).any():
            self._avoid(start, path, raised)
        return self._path

    def _avoid(self, start: int, path: NDArray[np.int32], raised: NDArray[np.int32]) -> None:
        """Cells of the path cost more now: go round them near by, or take another route."""
        terrain = self._terrain
        self._path, _ = region_kernels.shorten_near(
            path, raised, terrain.moves, terrain.width, terrain.prices, NEAR // 2, self._routing.place
        )
        cost = float(grid_kernels.cost_along(self._path, terrain.width, terrain.prices))
        self._reroute(start, cost * (1 - LONGER))
        self._mark_near(raised)

    def moved(self, start: int) -> Path:
        """Go on from there: along the path, or back to it."""
        return self._mended(start, np.empty(0, np.int32))

    def _mended(self, start: int, opened: NDArray[np.int32]) -> Path:
        terrain, path = self._terrain, self._path
        if path is None:
            if len(opened) or self._cut_off != start:
                self._reroute(start)
            return self._path
        if path[0] != start:
            at = np.flatnonzero(path == start)
            path = path[int(at[0]) :] if len(at) else np.concatenate((np.array([start], np.int32), path))
        before = float(grid_kernels.cost_along(path, terrain.width, terrain.prices))
        state, mended = region_kernels.mend(
            path, terrain.moves, terrain.width, terrain.prices, REACH, LONGEST, self._routing.place
        )
        if state == region_kernels.BROKEN:
            self._path = path
            self._reroute(start)
            return self._path
        if state == region_kernels.MENDED:
            self._note(path, mended)
            path = mended
        self._path, self.did = path, "mended"
        cost = float(grid_kernels.cost_along(path, terrain.width, terrain.prices))
        if state == region_kernels.MENDED and cost > (1 + LONGER) * before:
            self._reroute(start, cost * (1 - LONGER))
        if len(opened):
            share = GAIN_AT_ONCE
            if region_kernels.least_gain(opened, start, self._goal, terrain.width) < cost * (1 - share):
                self._path, gained = region_kernels.shorten_near(
                    self._path, opened, terrain.moves, terrain.width, terrain.prices, NEAR // 2, self._routing.place
                )
                cost -= gained
                self._reroute(start, cost * (1 - share))
            self._mark_near(opened)
        return self._path

    def _reroute(self, start: int, below: float = np.inf) -> None:
        """Take a route over regions if there is one that seems to cost less, and costs less."""
        terrain, path = self._terrain, self._path
        while True:
            length, stops = region_kernels.route(
                self._regions,
                self._routing,
                terrain.moves,
                terrain.width,
                start,
                self._goal,
                below / self._ratio,
                below == np.inf,
                terrain.prices,
            )
            if not self._regions.full[0]:
                break
            self._make(self._room.larger(int(self._regions.full[0])))
        if not len(stops):
            if below == np.inf:
                self._path, self._cut_off = None, start
            return
        force = np.array([start], np.int32) if path is None else path
        good, from_goal = region_kernels.legal_ends(force, terrain.moves, terrain.width) if path is not None else (0, 0)
        found: NDArray[np.int32] = region_kernels.lay_out(
            self._regions,
            self._routing,
            stops,
            force,
            good,
            from_goal,
            terrain.moves,
            terrain.width,
            terrain.prices,
            WINDOW,
        )
        cost = float(grid_kernels.cost_along(found, terrain.width, terrain.prices))
        if below < np.inf and path is not None:
            kept = float(grid_kernels.cost_along(path, terrain.width, terrain.prices))
            if cost >= kept:
                self._ratio = max(self._ratio, kept / max(length, 1.0))  # the regions promised too much
                return
        self._ratio = max(cost, 1.0) / max(length, 1.0)
        self._note(force, found)
        self._path, self.did = found, "rerouted"

    def _note(self, before: NDArray[np.int32], path: NDArray[np.int32]) -> None:
        """Windows have to look at what is new."""
        first, last = region_kernels.in_common(path, before)
        low, high = first, len(path) - last
        if self._dirty is not None:  # cells from the goal, so that what has been driven does not count
            far, near = self._dirty
            low, high = min(low, max(0, len(path) - far)), max(high, len(path) - near)
        self._dirty, self._left = (len(path) - low, len(path) - high), len(self._rounds)

    def _mark_near(self, cells: NDArray[np.int32]) -> None:
        """Windows have to look at the path near some cells."""
        path, width = self._path, self._terrain.width
        if path is None:
            return
        rows, cols = path // width, path % width
        far = NEAR
        top, left = cells.min() // width - far, (cells % width).min() - far
        bottom, right = cells.max() // width + far, (cells % width).max() + far
        near = np.flatnonzero((rows >= top) & (rows <= bottom) & (cols >= left) & (cols <= right))
        self._left = len(self._rounds)
        if len(near):
            low, high = int(near[0]), int(near[-1]) + 1
            if self._dirty is not None:
                low, high = min(low, len(path) - self._dirty[0]), max(high, len(path) - self._dirty[1])
            self._dirty = len(path) - max(low, 0), len(path) - high

    def improve(self, rounds: int) -> Path:
        """Look for a better route, search windows anew where something has changed, then, on small maps, everything."""
        terrain = self._terrain
        for _ in range(rounds):
            path = self._path
            if path is None or not self._left:
                break
            window, offset = self._rounds[self._round]
            self._round, self._left = (self._round + 1) % len(self._rounds), self._left - 1
            if window <= 0:
                cost = float(grid_kernels.cost_along(path, terrain.width, terrain.prices))
                if not window:
                    self._reroute(int(path[0]), cost * (1 - GAIN_IDLE))  # what is new gets all rounds
                else:
                    self._search(int(path[0]), cost)
                    self._left = 0
                continue
            if self._dirty is None:
                continue
            low = max(0, len(path) - self._dirty[0] - window)
            high = min(len(path), len(path) - self._dirty[1] + window)
            if high - low < 3:
                continue
            piece = grid_kernels.reoptimise(
                terrain.moves, terrain.width, path[low:high].copy(), window, offset, terrain.prices
            )
            behind = len(path) - high
            whole: NDArray[np.int32] = np.concatenate((path[:low], piece, path[high:]))
            whole = region_kernels.without_loops(whole, self._routing.place)  # windows may cross each other
            self._path, self._dirty = whole, (max(len(whole) - low, behind), behind)
        if not self._left:
            self._dirty = None
        self.did = "improved"
        return self._path

    def _search(self, start: int, cost: float) -> None:
        """A* on cells; the path in force stays where it is as good."""
        terrain = self._terrain
        length, parent, _ = grid_kernels.search(terrain.moves, terrain.width, start, self._goal, True, terrain.prices)
        if length[self._goal] < cost * (1 - 1e-9):
            self._path = grid_kernels.trace(parent, terrain.width, start, self._goal)


def _compile() -> None:
    """Compile or load every kernel, or an update in the middle of a mission would have to."""
    cells = np.zeros((5, 40), np.uint8)
    cells[1:4, 20] = Cell.OCCUPIED
    problem = Problem.from_cells(GridMap(cells), (2, 0), (2, 39))
    terrain, regions = LiveTerrain(problem), Regions()
    start, goal = problem.flat_ends
    wall = terrain.flat_of("wall", [(row, 20) for row in range(5)])
    regions._terrain = regions._known = terrain
    regions._make(_Room(terrain))
    regions._goal, regions._rounds = goal, ROUNDS_SMALL
    regions._reroute(start)
    regions._reroute(start)  # with a path in force
    regions.changed(terrain.alter(wall[:1]), start)
    regions.changed(terrain.alter(freed=wall), start)
    regions.changed(terrain.alter(wall), start)
    regions.changed(terrain.alter(freed=wall), start)
    regions.improve(len(ROUNDS))


class _Room:
    """How large the arrays of regions are."""

    def __init__(self, terrain: LiveTerrain, most: int = 32, crossings: int = 16) -> None:
        self._terrain, self._most, self._crossings = terrain, most, crossings
        self._block = BLOCK if terrain.moves.size <= LARGE else LARGE_BLOCK

    def larger(self, full: int) -> _Room:
        """Twice as much of what there was too little of."""
        most, crossings = self._most * (2 if full == 1 else 1), self._crossings * (2 if full == 2 else 1)
        return _Room(self._terrain, most, crossings)

    def arrays(self) -> tuple[region_kernels.Regions, region_kernels.Routing]:
        """Arrays without a region."""
        rows, cols = self._terrain.shape
        cells = self._terrain.moves.size
        blocks = -(-rows // self._block) * -(-cols // self._block)
        regions, crossings = blocks * self._most, blocks * self._crossings + 64 * self._block
        made = region_kernels.Regions(
            block=self._block,
            most=self._most,
            region=np.full(cells, -1, np.int32),
            number=np.zeros(blocks, np.int32),
            centre=np.zeros(regions, np.int32),
            price=np.ones(regions),
            head=np.full(regions, -1, np.int32),
            after=np.append(np.arange(1, crossings, dtype=np.int32), np.int32(-1)),
            other=np.zeros(crossings, np.int32),
            leave=np.zeros(crossings, np.int32),
            enter=np.zeros(crossings, np.int32),
            length=np.zeros(crossings),
            spare=np.array([0, crossings]),
            stale=np.full(blocks, region_kernels.LABELS | region_kernels.LINKS, np.uint8),
            full=np.zeros(1, np.int64),
        )
        routing = region_kernels.Routing(
            cost=np.zeros(regions),
            by=np.zeros(regions, np.int32),
            before=np.zeros(regions, np.int32),
            stamp=np.zeros(regions, np.int32),
            flooded=np.zeros(regions, np.int32),
            stack=np.zeros(regions, np.int32),
            place=np.full(cells, -1, np.int32),  # zeros would cost page faults at the first change
            number=np.zeros(1, np.int32),
        )
        return made, routing
