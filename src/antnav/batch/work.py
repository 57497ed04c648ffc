"""What a worker is given and gives back: chunks of queries, with the map once a worker and not once a query."""

from __future__ import annotations

import contextlib
import copyreg
import hashlib
import io
import pickle
import time
from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from typing import Any, NamedTuple, Self

import numpy as np

from antnav.errors import AntnavError, EndpointError, ParameterError, check_type, shown
from antnav.plan.solve import solve
from antnav.planner.plan import StoppedBy
from antnav.planner.planner import Planner
from antnav.planner.result import Result
from antnav.run.channel import Asked
from antnav.run.spmd import Serial
from antnav.run.stop import Stop
from antnav.search import exact
from antnav.world.cost import CostField
from antnav.world.grid import Cell, GridMap
from antnav.world.kept import Kept
from antnav.world.moves import CornerRule
from antnav.world.problem import CellIndex, Point, Problem

Ends = tuple[Point, Point] | tuple[CellIndex, CellIndex]
Query = Problem | Ends
Answer = Result | AntnavError

#: Maps, each with all that was worked out from it, that a worker keeps.
MAPS_KEPT = 4
#: Bytes that a worker takes and frees before it begins, just under the most from which glibc learns: it then keeps the
#: memory of searches. Given back after each one, it took as long as the search itself on depot (307 x 604).
FREED = 31 << 20


@dataclass(frozen=True, eq=False)
class Setting:
    """All of a problem but its ends.

    Parameters
    ----------
    grid, corner_rule, allow_unknown, goal_tolerance, start_tolerance, cost, turning
        As of `Problem`.
    cells : bool
        Whether ends are (row, col).
    """

    grid: GridMap
    corner_rule: CornerRule | str = CornerRule.FORBID
    allow_unknown: bool = False
    goal_tolerance: float = 0.0
    start_tolerance: float = 0.0
    cost: CostField | None = None
    turning: float = 0.0
    cells: bool = False

    @classmethod
    def of(cls, problem: Problem) -> Self:
        """That of a problem."""
        return cls(**{name: getattr(problem, name) for name in cls.__dataclass_fields__ if name != "cells"})

    def check(self) -> None:
        """Refuse choices that fit no pair of ends, by a problem on the first free cell."""
        check_type("grid", self.grid, GridMap, "make one with GridMap(array), or load one with load_map")
        free = np.argwhere(self.grid.cells == Cell.FREE)
        if len(free):
            cell = tuple(free[0].tolist())
            with contextlib.suppress(EndpointError):  # it is kept out
                replace(self, cells=True).problem((cell, cell))

    def fits(self, problem: Problem) -> bool:
        """Whether a problem is on the same map, with the same choices."""
        return not self.cells and all(
            given is own or (not isinstance(own, GridMap | CostField) and given == own)
            for name, own in vars(self).items()
            if name != "cells"
            for given in [getattr(problem, name)]
        )

    def problem(self, ends: Ends) -> Problem:
        """The problem with these ends."""
        choices = {name: value for name, value in vars(self).items() if name not in ("grid", "cells")}
        try:
            start, goal = ends
        except (TypeError, ValueError):
            raise ParameterError(f"query {shown(ends)}", "it is a pair, start and goal", "give both") from None
        if self.cells:
            return Problem.from_cells(self.grid, start, goal, **choices)  # type: ignore[arg-type]
        return Problem(self.grid, start, goal, **choices)


@dataclass(frozen=True, eq=False)
class Context:
    """What all queries of a chunk share: where, by which planner, how."""

    setting: Setting | None  #: None: there are no pairs
    planner: Planner
    seed: int
    stop: Stop | None
    optimum: bool

    def problem(self, query: Query) -> Problem:
        """The query as a problem."""
        if isinstance(query, Problem):
            return query
        if self.setting is None:
            raise ParameterError(f"query {shown(query)}", "a pair has no map of its own", "give grid=, or a Problem")
        return self.setting.problem(query)

    def answer(self, query: Query, executor: Executor | None, cancel: Asked | None = None) -> Answer | None:
        """The result without its pheromone, or the error of a query that cannot be asked; None once cancelled."""
        try:
            problem = self.problem(query)
            result = solve(problem, self.planner, seed=self.seed, stop=self.stop, executor=executor, cancel=cancel)
        except AntnavError as error:
            return error
        if result.stopped_by is StoppedBy.CANCELLED:
            return None
        certificate = None
        if self.optimum and problem.connected:
            found = exact.optimum(problem)
            certificate = found.cost, found.seconds
        return replace(result, heat=None, certificate=certificate)

    def sent(self) -> Sent:
        """Packed for other processes.

        Raises
        ------
        ParameterError
            Something in it cannot be sent.
        """
        try:
            content = pickle.dumps(self, pickle.HIGHEST_PROTOCOL)
        except (pickle.PicklingError, AttributeError, TypeError) as error:
            remedy = "define its class in a module that workers can import, or use threads"
            raise ParameterError(f"batch by {self.planner.name}", f"it cannot be sent: {error}", remedy) from error
        return Sent(hashlib.sha256(content).hexdigest(), content)


class Sent(NamedTuple):
    """A context on its way."""

    key: str
    content: bytes | None  #: None: the worker should have it


class Chunk(NamedTuple):
    """Queries that follow each other."""

    context: Sent
    queries: tuple[Ends, ...]


class Packed(NamedTuple):
    """What came of a chunk; answers are None where the worker lacked the context."""

    answers: bytes | None
    seconds: float


#: Of this worker.
_KEPT: Kept[str, Context] = Kept(MAPS_KEPT)


def work(chunk: Chunk) -> Packed:
    """Answer the queries of a chunk in a worker process."""
    begin = time.perf_counter()
    key, content = chunk.context
    try:
        context = _KEPT.of(key, lambda: _context(content))
    except LookupError:
        return Packed(None, 0.0)
    answers = [context.answer(query, Serial()) for query in chunk.queries]
    return Packed(_packed(answers, context), time.perf_counter() - begin)


def _context(content: bytes | None) -> Context:
    if content is None:
        raise LookupError
    context: Context = pickle.loads(content)
    context.planner.prepare()
    np.empty(FREED, np.uint8)
    return context


def _shared(context: Context) -> list[Any]:
    """What answers hold and both sides have."""
    setting = context.setting
    if setting is None:
        return [context.planner]
    closed = setting.grid if setting.cost is None else setting.grid.closed(setting.cost.blocked)
    return [context.planner, setting.grid, closed, setting.cost]


def _packed(answers: Sequence[Answer | None], context: Context) -> bytes:
    """The answers without what both sides have.

    By a table of types: `persistent_id`, asked for every object, takes as long as all the rest.
    """
    places = {id(each): place for place, each in enumerate(_shared(context))}

    def reduced(given: Any) -> Any:
        place = places.get(id(given))
        return given.__reduce_ex__(pickle.HIGHEST_PROTOCOL) if place is None else (_place, (place,))

    stream = io.BytesIO()
    pickler = pickle.Pickler(stream, pickle.HIGHEST_PROTOCOL)
    kinds = dict.fromkeys({GridMap, CostField, type(context.planner)}, reduced)
    pickler.dispatch_table = {**copyreg.dispatch_table, **kinds}
    pickler.dump(answers)
    return stream.getvalue()


def _place(place: int) -> Any:
    """What stands in the pickle for something that is shared."""
    raise NotImplementedError


def unpacked(packed: bytes, context: Context, queries: Sequence[Query]) -> list[Answer]:
    """The answers of a worker, on our own map and problems."""
    shared = _shared(context)

    class Unpickler(pickle.Unpickler):
        def find_class(self, module: str, name: str) -> Any:
            return shared.__getitem__ if (module, name) == (__name__, "_place") else super().find_class(module, name)

    answers: list[Answer] = Unpickler(io.BytesIO(packed)).load()
    return [
        replace(answer, problem=query) if isinstance(answer, Result) and isinstance(query, Problem) else answer
        for answer, query in zip(answers, queries, strict=True)
    ]


def ends_of(query: Query) -> Ends:
    """Start and goal as they were asked for."""
    if not isinstance(query, Problem):
        return query
    return query.requested_start or query.start, query.requested_goal or query.goal
