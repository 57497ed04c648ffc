"""A session: what one page looks at and does, without any network."""

from __future__ import annotations

import math
import tempfile
import time
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from antnav.errors import AntnavError, ParameterError
from antnav.maps import builtin, builtin_names, builtin_query, generate, save_map
from antnav.view import messages as say
from antnav.view.dropped import check_cells, map_of
from antnav.view.link import State, link_of, packed, state_of, unpacked
from antnav.view.menu import menu, planners
from antnav.view.messages import MOST_PANELS, MOST_SEED, Panel
from antnav.view.packet import Packet
from antnav.view.running import Run
from antnav.view.scene import Scene, ends_of
from antnav.world.cost import CostField
from antnav.world.grid import Cell, GridMap
from antnav.world.moves import CornerRule
from antnav.world.problem import CellIndex

#: Frames a second at most, and seconds that the iterations of one may take where speed has no bound.
RATE, BUSY = 60.0, 0.008
#: Frames that may be on their way to the page: as many as keep it busy while it waits for its screen.
AHEAD = 4
#: Seconds without a stroke until the ants begin anew on a map that was drawn on.
CALM = 0.12


class Start:
    """What a session begins with.

    Parameters
    ----------
    grid : GridMap
    start, goal : (row, col), optional
        Default: two cells far from each other.
    panels : list of Panel
    seed : int
    corner_rule : CornerRule
    radius : float
        Of the robot in metres.
    cost : CostField or None
    """

    def __init__(
        self,
        grid: GridMap,
        start: CellIndex | None = None,
        goal: CellIndex | None = None,
        panels: list[Panel] | None = None,
        seed: int = 0,
        corner_rule: CornerRule | str = CornerRule.ALLOW,
        radius: float = 0.0,
        cost: CostField | None = None,
    ) -> None:
        if start is None or goal is None:
            first, last = _ends(grid, corner_rule, radius)
            start, goal = start or first, goal or last
        self.panels, self.seed, self.radius = panels or [Panel("paco")], seed, radius
        self.grid, self.ends, self.corner_rule, self.cost = grid, (start, goal), corner_rule, cost
        self.scene()  # raises what is wrong with it
        self._check()

    def _check(self) -> None:
        if not 0 <= self.seed < MOST_SEED:
            raise ParameterError(f"seed {self.seed}", "in the view it is at least 0 and below 2**53", "choose another")
        if len(self.panels) > MOST_PANELS:
            rule = f"the view shows {MOST_PANELS} at most"
            raise ParameterError(f"{len(self.panels)} algorithms", rule, "leave some out")
        planners(self.panels)

    def scene(self) -> Scene:
        """A scene of its own for a page."""
        return Scene(self.grid, *self.ends, self.corner_rule, self.radius, self.cost)


class Session:
    """One page. Calls are made one at a time.

    Parameters
    ----------
    start : Start

    Attributes
    ----------
    playing : bool
    outbox : list of Packet or dict
        What is to be sent before the next frame.
    """

    def __init__(self, start: Start) -> None:
        self._start = start
        self.scene = start.scene()
        self.panels, self.seed = start.panels, start.seed
        self.speed, self.playing = 2.0, False
        self.outbox: list[Packet | dict[str, Any]] = []
        self.runs: list[Run] = []
        self._credit = AHEAD
        self._pending = False  #: something is to be seen though nothing runs
        self._calm = math.inf  #: when the runs begin anew
        self._go_on = False  #: whether they play then
        self._next = 0.0  #: when the next iteration is due

    @property
    def weight(self) -> int:
        """Cells that it keeps, for a bound over all sessions."""
        return self.scene.grid.cells.size * len(self.panels)

    def do(self, message: say.Said, content: bytes = b"") -> None:
        """Carry out a message; what is wrong with it is told in the outbox."""
        try:
            self._do(message, content)
        except AntnavError as error:
            self._note(error)

    def _note(self, error: AntnavError) -> None:
        self.outbox.append({"is": "note", "given": error.given, "rule": error.rule, "remedy": error.remedy})

    def _do(self, message: say.Said, content: bytes) -> None:
        match message:
            case say.Ack():
                self._credit = min(self._credit + 1, AHEAD)
            case say.Open(link=link):
                self.outbox.append(menu())
                try:
                    if link:
                        self._restore(state_of(link))
                finally:
                    self._show_scene()
            case say.Play():
                if self._all_done:
                    self._begin()
                self.playing, self._next = True, 0.0
                self.outbox.append(self._state())
            case say.Pause():
                self.playing = self._go_on = False
                self.outbox.append(self._state())
            case say.Step():
                self.playing = self._go_on = False
                self._settle()
                self._advance(1, math.inf)
            case say.Restart():
                self._begin()
            case say.Speed(speed=speed):
                self.speed, self._next = speed, 0.0
                self.outbox.append(self._state())
            case say.Choose(panels=panels, seed=seed, corner_rule=rule):
                self._choose(panels, seed, rule)
            case say.Draw(cells=cells, kind=kind, cost=cost):
                self.scene.draw(cells, kind, cost)
                self._stir()
            case say.Ends(start=start, goal=goal):
                self.scene.move(start, goal)
                self._stir()
            case say.Load():
                self._load(_named(message))
            case say.Drop(files=files):
                self._load(map_of(_split(files, content)))
            case say.Save(what=what, panel=panel):
                self._save(what, panel)

    def _choose(self, panels: list[Panel], seed: int, corner_rule: str) -> None:
        planners(panels)
        if corner_rule not in list(CornerRule):
            raise ParameterError(f"corner rule {corner_rule!r}", f"there are {', '.join(CornerRule)}", "choose one")
        changed = corner_rule != self.scene.corner_rule
        if changed:
            self.scene = self.scene.with_rule(corner_rule)
        self.panels, self.seed = panels, seed
        self._begin()
        if changed:
            self._show_scene()

    def _load(self, grid: GridMap) -> None:
        rule, radius = self.scene.corner_rule, self.scene.radius
        self.scene = Scene(grid, *_ends(grid, rule, radius), rule, radius)
        self._show_scene()

    def _restore(self, state: State) -> None:
        if state.cells:
            check_cells(state.rows, state.cols, state.name)
            cells = unpacked(state.cells, state.rows, state.cols)
            grid = GridMap(cells, state.resolution, state.origin, name=state.name)
        else:
            grid = builtin(state.name)
        cost = None
        numbers, prices = state.prices
        if numbers:
            values = np.zeros(grid.cells.size)
            if len(numbers) != len(prices) or not all(0 <= number < values.size for number in numbers):
                raise ParameterError("link", "its prices fit no cells", "copy it whole")
            values[numbers] = prices
            cost = CostField(values.reshape(grid.shape), name="painted")
        planners(state.panels)
        scene = Scene.of(grid, state.start, state.goal, state.corner_rule, state.radius, cost)
        scene.edited = bool(state.cells)
        self.scene, self.panels, self.seed = scene, state.panels, state.seed
        self.speed = min(max(state.speed, 0.0), say.FASTEST)

    def state(self) -> State:
        """The whole of it."""
        scene, prices = self.scene, self.scene.prices
        numbers = [] if prices is None else np.flatnonzero(prices).tolist()
        name = scene.grid.name
        as_is = not scene.edited and name in builtin_names() and scene.grid == builtin(name)
        return State(
            name=name[:100],
            rows=scene.grid.rows,
            cols=scene.grid.cols,
            start=scene.mission.position,
            goal=scene.mission.goal,
            panels=self.panels,
            cells="" if as_is else packed(scene.bare.cells),
            resolution=scene.grid.resolution,
            origin=scene.grid.origin,
            radius=scene.radius,
            prices=(numbers, [] if prices is None else prices.ravel()[numbers].tolist()),
            seed=self.seed,
            corner_rule=scene.corner_rule.value,
            speed=self.speed,
        )

    def _save(self, what: str, panel: int) -> None:
        if what == "link":
            self.outbox.append({"is": "link", "link": link_of(self.state())})
            return
        name = f"{self.scene.grid.name or 'map'}".replace(" ", "_").replace("/", "_")
        name, writes = f"{name}.map", partial[None](save_map, self.scene.mission.terrain.grid)
        if what == "result":
            result = self.runs[panel].result if panel < len(self.runs) else None
            if result is None:
                raise ParameterError("the result", "the run is not done", "play it to its end")
            name, writes = f"{result.algorithm.name}.json", partial[None](result.save)
        with tempfile.TemporaryDirectory(prefix="antnav-view-") as folder:
            path = Path(folder, "file" + Path(name).suffix)
            writes(path)
            content = np.frombuffer(path.read_bytes(), np.uint8)
        packet = Packet({"is": "file", "name": name})
        packet.add("content", content)
        self.outbox.append(packet)

    def _stir(self) -> None:
        """The map is another: show it at once, and let the ants begin anew once the pen rests."""
        self._calm = time.monotonic() + CALM
        self._go_on = self._go_on or self._all_done
        self.outbox.append(self._scene_packet())

    def _settle(self) -> None:
        if self._calm < math.inf or not self.runs:
            self._begin()

    def _begin(self) -> None:
        """Runs from their first iteration."""
        self._calm, self._next, problem = math.inf, 0.0, self.scene.problem
        self.playing, self._go_on = self.playing or self._go_on, False
        self.runs = []
        if problem is not None:
            try:
                self.runs = [Run(problem, planner, self.seed) for planner in planners(self.panels)]
            except ParameterError as error:  # too large for this map
                self._note(error)
        self._pending = True
        self.outbox.append({"is": "began", "panels": [panel.algorithm for panel in self.panels]})

    def _show_scene(self) -> None:
        self._begin()
        self.outbox.append(self._scene_packet())

    def _scene_packet(self) -> Packet:
        scene = self.scene
        update = scene.mission.plan
        packet = Packet(
            {
                "is": "scene",
                "name": scene.grid.name,
                "rows": scene.grid.rows,
                "cols": scene.grid.cols,
                "resolution": scene.grid.resolution,
                "start": scene.mission.position,
                "goal": scene.mission.goal,
                "corner_rule": scene.corner_rule.value,
                "optimum": scene.optimum if math.isfinite(scene.optimum) else None,
                "mended": scene.plan(),
                "words": scene.words,
                "panels": [{"algorithm": one.algorithm, "parameters": one.parameters} for one in self.panels],
                "seed": self.seed,
                "speed": self.speed,
                "playing": self.playing,
            }
        )
        packet.add("cells", scene.cells)
        cells = update.cells
        packet.add("plan", np.empty((0, 2), np.uint16) if cells is None else cells.astype(np.uint16))
        prices = scene.prices
        shades = np.empty(0, np.uint8)
        if prices is not None:  # a page tells four steps of them, of which the first is none
            shades = np.where(prices > 0, 64 + prices * (191 / prices.max()), 0).astype(np.uint8)
        packet.add("prices", shades)
        return packet

    @property
    def _all_done(self) -> bool:
        return bool(self.runs) and all(run.done for run in self.runs)

    def due(self) -> float:
        """Seconds until `frames` has something; inf while nothing can happen but by a message."""
        if self.outbox:
            return 0.0
        now = time.monotonic()
        if self._calm < math.inf:
            return max(self._calm - now, 0.0)
        if not self._credit:
            return math.inf
        if self._pending:
            return 0.0
        return max(self._next - now, 0.0) if self.playing and self.runs and not self._all_done else math.inf

    def frames(self) -> list[Packet | dict[str, Any]]:
        """What is to be sent now, in order; advances what plays."""
        now = time.monotonic()
        if self._calm <= now:
            self._begin()
        if self.playing and self._credit and self._calm == math.inf and now >= self._next and not self._all_done:
            interval = max(1 / self.speed if self.speed else 0.0, 1 / RATE)
            count = max(1, round(interval * self.speed)) if self.speed else 10**9
            self._advance(count, BUSY)
            self._next = max(self._next + interval, now) if self._next else now + interval
        sent, self.outbox = self.outbox, []
        if self._pending and self._credit:
            self._pending, self._credit = False, self._credit - 1
            sent += [run.frame(panel, self.scene.optimum) for panel, run in enumerate(self.runs)]
            sent.append(self._state())
        return sent

    def _state(self) -> dict[str, Any]:
        return {"is": "state", "playing": self.playing, "done": self._all_done}

    def _advance(self, count: int, seconds: float) -> None:
        for run in self.runs:
            run.advance(count, seconds / len(self.runs))
        self._pending = True
        if self._all_done:
            self.playing = False


def _ends(grid: GridMap, corner_rule: CornerRule | str, radius: float) -> tuple[CellIndex, CellIndex]:
    if radius:
        return ends_of(grid.inflated(radius), corner_rule)
    if grid.name in builtin_names() and grid == builtin(grid.name):
        return builtin_query(grid.name)
    return ends_of(grid, corner_rule)


def _named(wanted: say.Load) -> GridMap:
    """A built-in map, an empty one, or one of a generator."""
    name, rows, cols = wanted.name, wanted.rows, wanted.cols
    if name in builtin_names() and not wanted.drawn:
        return builtin(name)
    check_cells(rows, cols, name)
    if name == "empty":
        return GridMap(np.full((rows, cols), Cell.FREE, np.uint8), name="empty")
    return generate(name, rows, cols, wanted.seed)


def _split(files: list[tuple[str, int]], content: bytes) -> Mapping[str, bytes]:
    if sum(size for _, size in files) != len(content):
        raise ParameterError("dropped files", "they arrived in part", "drop them again")
    found, at = {}, 0
    for name, size in files:
        found[name] = content[at : at + size]
        at += size
    return found
