"""Scenario: what happens on a map, tick by tick, fixed before anybody plans."""

from __future__ import annotations

import math
import os
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any, Self

import msgspec
import numpy as np
from numpy.typing import ArrayLike, NDArray

from antnav.errors import ParameterError, ResultFormatError, check_type, shown
from antnav.files import as_path, write_whole
from antnav.planner.document import CostPart, MapPart, ProblemPart, content_of, only_json, unreadable
from antnav.scenarios import document
from antnav.values import check_seed, finite_number, read_only, whole_in
from antnav.world.cost import LARGEST
from antnav.world.grid import GridMap
from antnav.world.problem import Problem, check_problem

#: Ticks that a scenario may have.
MOST_TICKS = 10**6
#: A robot's pace in metres a second, from which the length of a tick follows where nobody gives it.
PACE = 1.0

_NO_CELLS = read_only(np.empty((0, 2), np.int32))
_NO_PRICES = read_only(np.empty(0))


@dataclass(frozen=True, eq=False)
class Event:
    """What changes at the beginning of a tick.

    Parameters
    ----------
    tick : int
        From 0.
    blocked, freed : array_like of int, shape (k, 2)
        Row and column of cells that are closed from now on, and of those that are free.
    priced : array_like of int, shape (k, 2)
        Cells whose price is another from now on.
    prices : array_like of float, shape (k,)
        What crossing each of them costs per metre, on top of the problem's own cost; 0 takes a price back.

    Raises
    ------
    ParameterError
        Cells that are no pairs of whole numbers or stand in both lists, prices out of range or of another number.
    """

    tick: int
    blocked: NDArray[np.int32] = field(default_factory=lambda: _NO_CELLS)
    freed: NDArray[np.int32] = field(default_factory=lambda: _NO_CELLS)
    priced: NDArray[np.int32] = field(default_factory=lambda: _NO_CELLS)
    prices: NDArray[np.float64] = field(default_factory=lambda: _NO_PRICES)

    def __post_init__(self) -> None:
        object.__setattr__(self, "tick", whole_in("tick", self.tick, 0, MOST_TICKS - 1))
        for name in ("blocked", "freed", "priced"):
            object.__setattr__(self, name, _cells(name, getattr(self, name)))
        object.__setattr__(self, "prices", _prices(self.prices, len(self.priced)))
        both = np.intersect1d(*(cells @ np.array((2**32, 1)) for cells in (self.blocked, self.freed)))
        if len(both):
            cell = divmod(int(both[0]), 2**32)
            rule = "a cell is blocked or freed at a tick, not both"
            raise ParameterError(f"cell {cell} at tick {self.tick}", rule, "leave one out")

    def __repr__(self) -> str:
        counts = f"{len(self.blocked)} blocked, {len(self.freed)} freed, {len(self.priced)} priced"
        return f"Event(tick {self.tick}: {counts})"


@dataclass(frozen=True, eq=False)
class Scenario:
    """What happens on a map while a robot drives from start to goal.

    Made by `antnav.scenarios.named`, or by `Scenario.of` from events of one's own. It knows nothing of planners: a
    person may walk onto the robot's cell. A replay then keeps that cell free until the robot has left, and counts it.

    Parameters
    ----------
    query : ProblemPart
        Map, start, goal, corner rule and costs, as in result files. With or without the cells of the map.
    events : tuple of Event
        Ticks ascending.
    ticks : int
        When it ends, 1 to 1,000,000.
    seconds : float
        Length of a tick.
    speed : int
        Moves from cell to cell that the robot makes in a tick, 1 to 1000.
    radius : float
        Of the robot in metres, on top of the map's own inflation.
    sensor : int or None
        How far the robot sees, in cells: those within sensor + 1/2 of its own. It begins with an empty map and takes as
        free what it has not seen. None: it knows everything at once.
    name : str
        What it was drawn from, such as "people:20".
    seed : int

    Raises
    ------
    ParameterError
        A value out of range, cells outside of the map, ticks that do not ascend, a sensor that sees less far than the
        robot goes in a tick.
    """

    query: ProblemPart
    events: tuple[Event, ...]
    ticks: int
    seconds: float
    speed: int = 1
    radius: float = 0.0
    sensor: int | None = None
    name: str = "own"
    seed: int = 0

    def __post_init__(self) -> None:
        check_type("query", self.query, ProblemPart, "use Scenario.of(problem, events, ...)")
        object.__setattr__(self, "ticks", whole_in("ticks", self.ticks, 1, MOST_TICKS))
        object.__setattr__(self, "speed", whole_in("speed", self.speed, 1, 1000))
        object.__setattr__(self, "seconds", _above("seconds of a tick", self.seconds, least=1e-9))
        object.__setattr__(self, "radius", _above("radius", self.radius, least=0.0))
        object.__setattr__(self, "seed", check_seed(self.seed))
        check_type("name", self.name, str, "give a text")
        if self.sensor is not None:
            object.__setattr__(self, "sensor", whole_in("sensor", self.sensor, 0, 10**5))
            if self.sensor < (least := least_sensor(self.speed, self.radius / self.query.map.resolution)):
                rule = f"it sees what the robot could hit in a tick of {self.speed} moves: {least} cells or more"
                raise ParameterError(f"sensor {self.sensor}", rule, "give a farther one, or a slower robot")
        try:
            object.__setattr__(self, "events", tuple(self.events))
        except TypeError as error:
            raise ParameterError(f"events {shown(self.events)}", "they are a row of Event", "give a list") from error
        last = -1
        for event in self.events:
            check_type("event", event, Event, "make one with antnav.scenarios.Event(tick, blocked=...)")
            self._check_event(event, last)
            last = event.tick

    def _check_event(self, event: Event, last: int) -> None:
        if not last < event.tick < self.ticks:
            rule = f"ticks ascend, up to {self.ticks - 1}"
            if event.tick >= self.ticks:
                raise ParameterError(f"event at tick {event.tick}", f"ticks are 0..{self.ticks - 1}", "give more ticks")
            raise ParameterError(f"tick {event.tick} after {last}", rule, "sort the events, one for each tick")
        for cells in (event.blocked, event.freed, event.priced):
            outside = ~((cells >= 0) & (cells < (self.query.map.rows, self.query.map.cols))).all(axis=1)
            if outside.any():
                rule = f"the map has {self.query.map.rows} rows and {self.query.map.cols} columns"
                given = f"cell {tuple(cells[outside][0].tolist())} at tick {event.tick}"
                raise ParameterError(given, rule, "give cells of the map")

    @classmethod
    def of(
        cls,
        problem: Problem,
        events: Iterable[Event] = (),
        *,
        ticks: int = 200,
        seconds: float | None = None,
        speed: int = 1,
        radius: float = 0.0,
        sensor: int | None = None,
        name: str = "own",
        seed: int = 0,
    ) -> Self:
        """A scenario of events; a tick lasts as long as a robot of 1 m/s takes for its moves, if nothing is said."""
        check_problem(problem)
        speed = whole_in("speed", speed, 1, 1000)
        seconds = speed * problem.grid.resolution / PACE if seconds is None else seconds
        query = ProblemPart.of(problem, map_cells=True)
        return cls(query, events, ticks, seconds, speed, radius, sensor, name, seed)  # type: ignore[arg-type]

    def __repr__(self) -> str:
        changed = sum(len(event.blocked) + len(event.freed) + len(event.priced) for event in self.events)
        counts = f"{len(self.events)} events, {changed} changes of cells, {self.ticks} ticks"
        return f"Scenario({self.name!r}, seed {self.seed}, {self.query.map.name!r}: {counts})"

    def problem(self, given: GridMap | Problem | None = None) -> Problem:
        """The problem at rest: map, start, goal, corner rule, costs.

        Parameters
        ----------
        given : GridMap, Problem or None
            The map, or the whole problem, where the scenario was read from a file without map cells.

        Raises
        ------
        ParameterError
            Another map or problem than the scenario is of.
        """
        if isinstance(given, Problem):
            self._check_same(ProblemPart.of(given, map_cells=False))
            return given
        check_type("map", given, GridMap | None, "give the scenario's map, or its problem")
        query, cost = self.query, self.query.cost
        if given is not None:
            self._check_same(msgspec.structs.replace(query, map=MapPart.of(given, cells=False)))
            query = msgspec.structs.replace(query, map=MapPart.of(given, cells=True))
        elif query.map.cells is msgspec.UNSET:
            raise ParameterError("no map", "the scenario's file does not hold its map", "give the map or the problem")
        if cost is not None and cost.values is msgspec.UNSET:
            raise ParameterError("a map", "the scenario's file does not hold its costs", "give the problem")
        return query.problem()

    def _check_same(self, other: ProblemPart) -> None:
        if _told(self.query) != _told(other):
            wanted = (
                f"map {self.query.map.name!r} {self.query.map.digest[:12]}, {self.query.start} -> {self.query.goal}"
            )
            given = f"{other.map.name!r} {other.map.digest[:12]}, {other.start} -> {other.goal}"
            raise ParameterError(f"a problem on {given}", f"the scenario is of {wanted}", "give that one")

    def to_dict(self, *, map_cells: bool = True) -> dict[str, Any]:
        """Everything as JSON types; without `map_cells`, the map has to be given again."""
        found: dict[str, Any] = msgspec.to_builtins(document.of(self, map_cells=map_cells))
        return found

    def save(self, path: str | os.PathLike[str], *, map_cells: bool = True) -> None:
        """Write .json, whole or not at all; see `to_dict`."""
        name = as_path(path).name
        write_whole(path, only_json(name, "scenarios", lambda: document.of(self, map_cells=map_cells), indent=None))

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Self:
        """Read what `save` wrote.

        Raises
        ------
        ResultFormatError
            No such file, none of a scenario, of a newer version, or one that cannot be true.
        """
        try:
            read = document.Document.read(content_of(path))
        except ResultFormatError as error:
            given = error.given if error.given.startswith("file ") else f"file {os.fspath(path)}, {error.given}"
            raise ResultFormatError(given, error.rule, error.remedy) from error
        try:
            return cls(**read.fields(Event))
        except ParameterError as error:
            raise unreadable("the file", str(error)) from error


def least_sensor(speed: int, radius: float) -> int:
    """How far a robot of a radius in cells must see, so that it cannot hit what it has not seen: cells."""
    return math.ceil(math.sqrt(2) * speed + radius - 0.5)


def _told(query: ProblemPart) -> dict[str, Any]:
    """What tells problems apart: neither names nor the way that cells are packed."""
    cost = None if query.cost is None else CostPart(digest=query.cost.digest, name="")
    bare = MapPart(**{**msgspec.structs.asdict(query.map), "name": "", "cells": msgspec.UNSET})
    told: dict[str, Any] = msgspec.to_builtins(msgspec.structs.replace(query, map=bare, cost=cost))
    return told


def _cells(name: str, given: ArrayLike) -> NDArray[np.int32]:
    """Cells as an array of one's own, shape (k, 2), or a `ParameterError`."""
    rule = "cells are rows and columns, whole numbers, shape (k, 2)"
    try:
        array = np.asarray(given)
    except (TypeError, ValueError, OverflowError):
        array = np.empty((0, 0), object)
    if array.size == 0 and array.dtype != object:
        return _NO_CELLS
    if array.ndim != 2 or array.shape[1] != 2 or array.dtype.kind not in "iu" or (np.abs(array) >= 2**31).any():
        raise ParameterError(f"{name} {shown(given)}", rule, "give such an array")
    return read_only(array.astype(np.int32))


def _prices(given: ArrayLike, count: int) -> NDArray[np.float64]:
    try:
        prices = np.array(given, np.float64)
    except (TypeError, ValueError, OverflowError):
        prices = np.full(1, math.nan)
    if prices.shape != (count,) or not ((prices >= 0) & (prices <= LARGEST)).all():
        rule = f"there is a number from 0 to {LARGEST:g} for each of {count} priced cells"
        raise ParameterError(f"prices {shown(given)}", rule, "give such numbers")
    return read_only(prices)


def _above(name: str, given: Any, least: float) -> float:
    number = finite_number(given)
    if not number >= least:
        raise ParameterError(f"{name} {shown(given)}", f"it is a finite number, at least {least:g}", "give one")
    return number
