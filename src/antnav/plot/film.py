"""What films of replays show, gathered once: the map as it changes, the ways driven, the plans where they change."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import IntEnum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from antnav.errors import ParameterError, check_type, shown
from antnav.live.update import MissionStatus
from antnav.plot.data import CELL_COLOURS, ORANGES
from antnav.scenarios.model import Replay, Tick
from antnav.scenarios.scenario import Event, Scenario
from antnav.world.problem import CellIndex, Problem


class Shade(IntEnum):
    """What is seen of a cell; of a block of cells, the last of these that there is.

    - FREE: free, nothing else
    - PRICED: costs more for now
    - UNKNOWN: unknown at rest
    - INFLATED: inflated or kept out at rest
    - OCCUPIED: a wall at rest
    - BLOCKED: free at rest, closed for now
    """

    FREE = 0
    PRICED = 1
    UNKNOWN = 2
    INFLATED = 3
    OCCUPIED = 4
    BLOCKED = 5


#: The shade of each kind of cell at rest, in the order of `Cell`.
AT_REST = np.array([Shade.FREE, Shade.OCCUPIED, Shade.UNKNOWN, Shade.INFLATED], np.uint8)
#: Colours in the order of `Shade`: those of the pictures, prices in their light orange, what comes and goes in blue.
COLOURS = np.array([(255, 255, 255), ORANGES[0], *CELL_COLOURS[[2, 3, 1]], (0, 114, 178)], np.uint8)
#: How much of the colour of unknown cells lies over what the robot has not seen yet.
VEIL = 0.65
VEILED = np.rint(COLOURS * (1 - VEIL) + COLOURS[Shade.UNKNOWN] * VEIL).astype(np.uint8)


class Change(NamedTuple):
    """What looks another way from a tick on: numbers of pixels, ascending, and their shades."""

    pixels: NDArray[np.int64]
    shades: NDArray[np.uint8]


class Drive(NamedTuple):
    """One robot.

    Attributes
    ----------
    name : str
        Of its replanner.
    ticks : tuple of Tick
    way : ndarray of int32, shape (k, 2)
        Every cell that it drove over, in order, the start first.
    passed : ndarray of int64, shape (len(ticks),)
        Where in `way` it stands when a tick begins.
    plans : tuple of (int, ndarray of int32 or None)
        The ticks whose plan is not the rest of the one before, with the plan's cells.
    """

    name: str
    ticks: tuple[Tick, ...]
    way: NDArray[np.int32]
    passed: NDArray[np.int64]
    plans: tuple[tuple[int, NDArray[np.int32] | None], ...]


@dataclass(frozen=True, eq=False)
class Film:
    """One scenario, and one robot or several that drove through it.

    Attributes
    ----------
    scenario : Scenario
    problem : Problem
        At rest.
    block : int
        A pixel shows so many rows and columns of cells.
    shades : ndarray of uint8, shape (rows, cols)
        The map at rest: a `Shade` for each pixel.
    changes : tuple of Change
        One for each tick of the longest drive.
    drives : tuple of Drive
    """

    scenario: Scenario
    problem: Problem
    block: int
    shades: NDArray[np.uint8]
    changes: tuple[Change, ...]
    drives: tuple[Drive, ...]

    def __len__(self) -> int:
        return len(self.changes)

    def pictures(self) -> Iterator[NDArray[np.uint8]]:
        """The map at each tick; the same array each time, altered in place."""
        shades = self.shades.copy()
        for pixels, values in self.changes:
            shades.flat[pixels] = values
            yield shades

    def look(self, seen: NDArray[np.bool_], cell: CellIndex) -> None:
        """Note what a robot on this cell sees of the map, in place; everything where it has no sensor."""
        if self.scenario.sensor is None:
            seen[:] = True
            return
        radius, block = self.scenario.sensor, self.block
        top, left = (max(place - radius, 0) // block for place in cell)
        window = seen[top : (cell[0] + radius) // block + 1, left : (cell[1] + radius) // block + 1]
        down, aside = np.ogrid[: window.shape[0], : window.shape[1]]
        middle = (block - 1) / 2
        row, col = (top + down) * block + middle - cell[0], (left + aside) * block + middle - cell[1]
        window |= row**2 + col**2 <= radius * (radius + 1)


def film_of(replays: Replay | Sequence[Replay], most: int) -> Film:
    """Gather a film whose picture of the map has at most so many rows and columns.

    Raises
    ------
    ParameterError
        No replay with a tick, or replays of different scenarios.
    """
    given = check_replays(replays)
    first = given[0]
    ticks = max(map(len, given))
    block = -(-max(first.problem.grid.shape) // most)
    ground = _Ground(first.problem, block)
    shades = ground.pixels.copy()
    happens = {event.tick: event for event in first.scenario.events}
    none = Change(np.empty(0, np.int64), np.empty(0, np.uint8))
    changes = tuple(ground.happen(happens[tick]) if tick in happens else none for tick in range(ticks))
    return Film(first.scenario, first.problem, block, shades, changes, tuple(map(_drive, given)))


def check_replays(replays: Replay | Sequence[Replay]) -> list[Replay]:
    """The replays as a list: at least one, all of one scenario, with a tick each."""
    given = [replays] if isinstance(replays, Replay) else list(replays) if isinstance(replays, list | tuple) else []
    for replay in given:
        check_type("replay", replay, Replay, "make one with antnav.replay")
    if not given or not all(map(len, given)):
        raise ParameterError(f"replays {shown(replays)}", "there is one or several, of a tick or more", "replay first")
    scenario = given[0].scenario
    for replay in given[1:]:
        if replay.scenario is not scenario and replay.scenario.to_dict() != scenario.to_dict():
            names = f"replays of {scenario.name!r} and {replay.scenario.name!r}"
            raise ParameterError(names, "they are of one scenario, seed and map", "save them one by one")
    return given


def _drive(replay: Replay) -> Drive:
    way, passed, plans, rest = list[NDArray[np.int32]](), [0], list[tuple[int, NDArray[np.int32] | None]](), None
    for number, (tick, plan) in enumerate(zip(replay.ticks, replay.plans, strict=True)):
        if not number or not _same(plan, rest):
            plans.append((number, plan))
        # the robot goes along its plan; where it cannot move, there may be none
        driven = np.array([(tick.row, tick.col)], np.int32) if plan is None else plan[: tick.moves + 1]
        way.append(driven[:1] if not number else driven[:0])
        way.append(driven[1:])
        passed.append(passed[-1] + len(driven) - 1)
        rest = None if plan is None else plan[tick.moves :]
    return Drive(replay.algorithm, replay.ticks, np.concatenate(way), np.array(passed[:-1]), tuple(plans))


def _same(one: NDArray[np.int32] | None, other: NDArray[np.int32] | None) -> bool:
    return one is other if one is None or other is None else np.array_equal(one, other)


class _Ground:
    """The map of a scenario as pixels of blocks of cells, altered event by event."""

    def __init__(self, problem: Problem, block: int) -> None:
        grid, self.block = problem.grid, block
        self.rest = AT_REST[grid.cells]
        if problem.cost is not None:
            self.rest[problem.cost.blocked & (self.rest == Shade.FREE)] = Shade.INFLATED
        self.closed_at_rest = ~problem.passable
        self.closed = self.closed_at_rest.copy()
        self.prices = np.zeros(grid.shape)
        rows, cols = (-(-side // block) for side in grid.shape)
        padding = [(0, count * block - side) for count, side in zip((rows, cols), grid.shape, strict=True)]
        self.blocks = np.pad(self.rest, padding).reshape(rows, block, cols, block)
        self.pixels: NDArray[np.uint8] = self.blocks.max(axis=(1, 3))

    def happen(self, event: Event) -> Change:
        blocked, freed, priced = (tuple(cells.T) for cells in (event.blocked, event.freed, event.priced))
        self.closed[blocked], self.closed[freed], self.prices[priced] = True, False, event.prices
        cells = np.concatenate((event.blocked, event.freed, event.priced)).astype(np.int64)
        rows, cols = cells.T
        self.blocks[rows // self.block, rows % self.block, cols // self.block, cols % self.block] = self._shades(cells)
        pixels = np.unique(rows // self.block * self.pixels.shape[1] + cols // self.block)
        high, low = np.divmod(pixels, self.pixels.shape[1])
        shades = self.blocks[high, :, low, :].max(axis=(1, 2))
        new = shades != self.pixels[high, low]
        self.pixels[high, low] = shades
        return Change(pixels[new], shades[new])

    def _shades(self, cells: NDArray[np.int64]) -> NDArray[np.uint8]:
        at = tuple(cells.T)
        wall = self.closed_at_rest[at]
        closed = np.where(wall, self.rest[at], Shade.BLOCKED)
        free = np.where(self.prices[at] > 0, Shade.PRICED, np.where(wall, Shade.FREE, self.rest[at]))
        return np.where(self.closed[at], closed, free).astype(np.uint8)


def corners(cells: NDArray[np.int32]) -> NDArray[np.int32]:
    """The cells of a way at which it turns, with its ends."""
    if len(cells) < 3:
        return cells
    steps = np.diff(cells, axis=0)
    turns = (steps[1:] != steps[:-1]).any(axis=1)
    return cells[np.concatenate(([True], turns, [True]))]


def status_text(tick: Tick) -> str:
    """How things stand for the robot, in words."""
    words = {
        MissionStatus.PLANNED: "on its way" if tick.moves else "waits",
        MissionStatus.ARRIVED: "arrived",
        MissionStatus.UNREACHABLE: "no way: it waits",
        MissionStatus.NO_PATH: "no way found: it waits",
        MissionStatus.START_BLOCKED: "its own cell is closed",
        MissionStatus.GOAL_BLOCKED: "the goal is closed: it waits",
    }
    return words[tick.status]
