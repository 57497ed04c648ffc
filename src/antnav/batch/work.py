"""What a worker is given and gives back: queries, each with all that it shares with others."""

from __future__ import annotations

import contextlib
import copyreg
import io
import pickle
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from functools import cache
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
from antnav.world.moves import CornerRule
from antnav.world.problem import CellIndex, Point, Problem

Ends = tuple[Point, Point] | tuple[CellIndex, CellIndex]
Query = Problem | Ends
Answer = Result | AntnavError

#: Settings of problems that are known when another one comes.
SETTINGS_KNOWN = 4
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


class Job(NamedTuple):
    """A query, of which the ends travel."""

    context: Context
    query: Query

    def __reduce__(self) -> tuple[type[Job], tuple[Context, Ends]]:
        return Job, (self.context, ends_of(self.query))


def work(jobs: Iterator[Job]) -> bytes:
    """Answer queries in a worker process."""
    _keep_memory()
    contexts, answers = [], []
    for context, query in jobs:
        context.planner.prepare()
        contexts.append(context)
        answers.append(context.answer(query, Serial()))
    return _packed(answers, contexts)


@cache
def _keep_memory() -> None:
    np.empty(FREED, np.uint8)


def _shared(contexts: Iterable[Context]) -> list[Any]:
    """What answers hold and both sides have."""
    shared: list[Any] = []
    for context in {id(context): context for context in contexts}.values():
        shared.append(context.planner)
        if (setting := context.setting) is not None:
            closed = setting.grid if setting.cost is None else setting.grid.closed(setting.cost.blocked)
            shared += [setting.grid, closed, setting.cost]
    return shared


def _packed(answers: Sequence[Answer | None], contexts: Sequence[Context]) -> bytes:
    """The answers without what both sides have.

    By a table of types: `persistent_id`, asked for every object, takes as long as all the rest.
    """
    shared = _shared(contexts)
    places = {id(each): place for place, each in enumerate(shared)}

    def reduced(given: Any) -> Any:
        place = places.get(id(given))
        return given.__reduce_ex__(pickle.HIGHEST_PROTOCOL) if place is None else (_place, (place,))

    stream = io.BytesIO()
    pickler = pickle.Pickler(stream, pickle.HIGHEST_PROTOCOL)
    kinds = dict.fromkeys({GridMap, CostField, *(type(context.planner) for context in contexts)}, reduced)
    pickler.dispatch_table = {**copyreg.dispatch_table, **kinds}
    pickler.dump(answers)
    return stream.getvalue()


def _place(place: int) -> Any:
    """What stands in the pickle for something that is shared."""
    raise NotImplementedError


def unpacked(packed: bytes, jobs: Sequence[Job]) -> list[Answer]:
    """The answers of a worker, on our own map and problems."""
    shared = _shared(context for context, _ in jobs)

    class Unpickler(pickle.Unpickler):
        def find_class(self, module: str, name: str) -> Any:
            return shared.__getitem__ if (module, name) == (__name__, "_place") else super().find_class(module, name)

    answers: list[Answer] = Unpickler(io.BytesIO(packed)).load()
    return [
        replace(answer, problem=query) if isinstance(answer, Result) and isinstance(query, Problem) else answer
        for answer, (_, query) in zip(answers, jobs, strict=True)
    ]


def ends_of(query: Query) -> Ends:
    """Start and goal as they were asked for."""
    if not isinstance(query, Problem):
        return query
    return query.requested_start or query.start, query.requested_goal or query.goal
