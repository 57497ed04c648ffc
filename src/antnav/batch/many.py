"""solve_many: many queries in, their results out, in order."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator, Sized
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from functools import partial
from typing import Literal

from antnav.ants.presets import paco
from antnav.batch.work import SETTINGS_KNOWN, Answer, Context, Job, Query, Setting, unpacked, work
from antnav.errors import AntnavError, ParameterError, check_type, shown
from antnav.planner.call import check_conduct
from antnav.planner.planner import Planner
from antnav.run.channel import Asked
from antnav.run.chunks import AHEAD, stream_chunks
from antnav.run.spmd import CORES, Processes, Serial, checked_workers, shares_memory, stream_jobs
from antnav.run.stop import Stop
from antnav.values import check_seed
from antnav.world.cost import CostField
from antnav.world.grid import GridMap
from antnav.world.moves import CornerRule
from antnav.world.problem import Problem


def solve_many(
    queries: Iterable[Query],
    algorithm: Planner | None = None,
    *,
    grid: GridMap | None = None,
    cells: bool = False,
    corner_rule: CornerRule | str = CornerRule.FORBID,
    allow_unknown: bool = False,
    goal_tolerance: float = 0.0,
    start_tolerance: float = 0.0,
    cost: CostField | None = None,
    turning: float = 0.0,
    seed: int = 0,
    stop: Stop | None = None,
    executor: Executor | None = None,
    workers: int | None = None,
    optimum: bool = False,
    errors: Literal["raise", "return"] = "raise",
    cancel: Asked | None = None,
) -> Iterator[Answer]:
    """Plan many paths, a stream of results in the order of the queries; ``list(solve_many(...))`` for all at once.

    Parameters
    ----------
    queries : iterable of Problem, or of (start, goal)
        Read as they are needed, so it may be endless. Pairs are on `grid`.
    algorithm : Planner, optional
        Default: `paco()`.
    grid : GridMap, optional
        The map of pairs.
    cells : bool
        Whether pairs are of (row, col) instead of (x, y) in metres.
    corner_rule, allow_unknown, goal_tolerance, start_tolerance, cost, turning
        Of the problems that pairs make: see `Problem`.
    seed : int
        The same for every query, so that each can be repeated by itself with `solve`.
    stop : Stop, optional
        Of each query.
    executor : concurrent.futures.Executor, optional
        Where queries run side by side; Dask's `client.get_executor()` too. It is left open. A map travels once to
        each worker, whatever the number of queries, and a lost worker costs a retry.
    workers : int, optional
        Without an executor: processes, started for this call; 1, the default: none, queries run in this thread. With
        one: how many jobs it does at a time; default: the number of cores.
    optimum : bool
        Whether workers also search the optimum of every result, for its `gap`; otherwise it is searched when asked for.
    errors : {"raise", "return"}
        What becomes of a query that cannot be asked, such as one that starts in a wall: its error is raised when it is
        its turn, or stands in the place of its result.
    cancel : object with is_set(), optional
        Ends the stream: a query under way is given up.

    Returns
    -------
    iterator of Result
        The same, but for seconds, as from `solve(problem, algorithm, seed=seed)` one by one, whatever the executor and
        the number of workers; without pheromone.

    Raises
    ------
    ParameterError
        A parameter is out of range, or pairs have no map.
    AntnavError
        A query cannot be asked; a note of it says which.
    WorkerLostError
        A worker of the executor died again and again.

    Examples
    --------
    >>> import antnav as an
    >>> pairs = [((0.5, 19.5), (19.5, 0.5)), ((0.5, 19.5), (9.5, 10.5))]
    >>> for result in an.solve_many(pairs, an.astar(), grid=an.maps.builtin("equiv20")):
    ...     print(result.status, round(result.length_m, 2))
    found 30.97
    found 15.07
    """
    planner = paco() if algorithm is None else algorithm
    check_type("algorithm", planner, Planner, "call a preset, as in an.paco(), or derive from an.Planner")
    check_seed(seed)
    check_conduct(stop, executor, cancel)
    if not isinstance(errors, str) or errors not in ("raise", "return"):
        raise ParameterError(f"errors {shown(errors)}", "they are raised or returned", 'give "raise" or "return"')
    if not isinstance(queries, Iterable):
        raise ParameterError(
            f"queries {shown(queries)}", "there are several", "give a list of them, or another iterable"
        )
    setting = None
    if grid is not None:
        choices = (CornerRule.of(corner_rule), allow_unknown, goal_tolerance, start_tolerance, cost, turning)
        setting = Setting(grid, *choices, cells=cells)
        setting.check()
    if workers is not None:
        checked_workers(workers)
    batch = _Batch(Context(setting, planner, int(seed), stop, optimum), cancel)
    if executor is None and workers in (None, 1):
        answers = batch.in_turn(queries, Serial() if workers else None)
    elif executor is None:
        answers = batch.in_own_processes(queries, workers or CORES)
    elif isinstance(executor, Serial):
        answers = batch.in_turn(queries, executor)
    elif shares_memory(executor):
        answers = batch.in_threads(queries, executor, workers or CORES)
    else:
        answers = batch.elsewhere(queries, executor, workers or CORES)
    return answers if errors == "return" else _raising(answers)


def _raising(answers: Iterator[Answer]) -> Iterator[Answer]:
    for place, answer in enumerate(answers):
        if isinstance(answer, AntnavError):
            answer.add_note(f"query {place}, counted from 0")
            raise answer
        yield answer


@dataclass(frozen=True, eq=False)
class _Batch:
    """How queries are answered, by where that is done; None ends a stream of answers, once it is cancelled."""

    context: Context
    cancel: Asked | None

    def in_turn(self, queries: Iterable[Query], executor: Executor | None) -> Iterator[Answer]:
        """Here, one after the other."""
        for query in queries:
            if self.cancel is not None and self.cancel.is_set():
                return  # an exact search ends before it would look
            answer = self.context.answer(query, executor, self.cancel)
            if answer is None:
                return
            yield answer

    def in_threads(self, queries: Iterable[Query], executor: Executor, workers: int) -> Iterator[Answer]:
        """Here, in threads."""
        answer = partial(self.context.answer, executor=Serial(), cancel=self.cancel)
        for found in stream_jobs(answer, queries, executor, AHEAD * workers, cancel=self.cancel):
            if found is None:
                return
            yield found

    def in_own_processes(self, queries: Iterable[Query], workers: int) -> Iterator[Answer]:
        """In processes that live no longer."""
        pool = Processes(workers)
        try:
            yield from self.elsewhere(queries, pool, workers)
        finally:
            pool.kill()  # nobody waits for what they still do

    def elsewhere(self, queries: Iterable[Query], executor: Executor, workers: int) -> Iterator[Answer]:
        """In other processes, or on other machines."""
        contexts = _Contexts(self.context)
        for jobs, packed in stream_chunks(
            work,
            (Job(contexts.of(query), query) for query in queries),
            executor,
            workers,
            shared=lambda job: (job.context,),
            count=len(queries) if isinstance(queries, Sized) else None,
            cancel=self.cancel,
        ):
            yield from unpacked(packed, jobs)


class _Contexts:
    """The context of each query; of problems that of an earlier one where it fits."""

    def __init__(self, of_pairs: Context) -> None:
        self._of_pairs = of_pairs
        self._known: deque[Context] = deque(maxlen=SETTINGS_KNOWN)

    def of(self, query: Query) -> Context:
        """That of a query."""
        if not isinstance(query, Problem):
            return self._of_pairs
        for known in self._known:
            if known.setting is not None and known.setting.fits(query):
                return known
        self._known.append(replace(self._of_pairs, setting=Setting.of(query)))
        return self._known[-1]
