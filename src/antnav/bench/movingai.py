"""The MovingAI benchmark: every query by every algorithm in turn, and what came out of it."""

from __future__ import annotations

import math
import threading
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

from antnav.bench.output import Mark, Picture
from antnav.bench.scenarios import TOLERANCE, Query, check_published
from antnav.errors import ParameterError
from antnav.plan.algorithms import algorithm
from antnav.plan.algorithms import names as known_names
from antnav.plan.solve import solve
from antnav.planner.plan import StoppedBy
from antnav.report.statistics import quantiles
from antnav.report.table import Column, Table
from antnav.run.spmd import Serial
from antnav.run.stop import Seconds, Stop
from antnav.values import check_seed
from antnav.world.path import check_path

ALL_MAPS = "all maps"

#: Called with searches done and searches in all, from any thread.
Progress = Callable[[int, int], None]


@dataclass(frozen=True)
class Answer:
    """What one algorithm made of one query.

    Attributes
    ----------
    query : Query
    algorithm : str
    seed : int
    length : float
        In cells; inf without a path.
    seconds : float
        Wall time of the search.
    stopped_by : StoppedBy
    """

    query: Query
    algorithm: str
    seed: int
    length: float
    seconds: float
    stopped_by: StoppedBy = StoppedBy.SCHEDULE

    @property
    def gap(self) -> float:
        """Length / published length - 1; 0 within the digits that are printed, inf without a path."""
        return gap_of(self.length, self.query.published, TOLERANCE)


def gap_of(length: float, optimum: float, tolerance: float) -> float:
    """How much longer than necessary, as a share: 0 up to the tolerance in cells, inf without a path."""
    if length <= optimum + tolerance:
        return 0.0
    return length / optimum - 1.0 if optimum > 0 else math.inf


def default_algorithms() -> tuple[str, str]:
    """The preset for large maps, and A* as the measure."""
    return "paco_large", "astar"


def check_algorithms(names: Sequence[str]) -> None:
    """Refuse names of no planner, and repeated ones.

    Raises
    ------
    ParameterError
    """
    for name in names:
        algorithm(name)
        if names.count(name) > 1:
            raise ParameterError(f"algorithm {name!r}", "it is named twice", "name it once")
    if not names:
        raise ParameterError("no algorithm", f"the algorithms are {', '.join(known_names())}", "choose among them")


def run(
    queries: Sequence[Query],
    names: Sequence[str],
    *,
    seed: int = 0,
    time_limit: float | None = None,
    workers: int = 1,
    cancel: threading.Event | None = None,
    progress: Progress | None = None,
) -> list[Answer]:
    """Ask every algorithm every query, in turn, and check every path.

    Parameters
    ----------
    queries : sequence of Query
    names : sequence of str
        Of planners: see `antnav.algorithm`.
    seed : int
        Of the ants, the same for all queries.
    time_limit : float, optional
        Seconds for ants to spend on a query.
    workers : int
        Queries side by side. Times are measured with one: a divided problem then has a thread for each half. With more,
        every search has one thread and shares the machine with others.
    cancel : threading.Event, optional
        Set it from elsewhere to end early: answers to the query under way are dropped. Set here where the run fails.
    progress : callable, optional

    Returns
    -------
    list of Answer
        Query by query, in each the algorithms in the order of their names.

    Raises
    ------
    ParameterError
        A parameter is out of range.
    MapFormatError
        A published length is not that of a shortest path.
    PathError
        A planner broke the rules of the map: a bug.

    Notes
    -----
    Each search gets a new `Problem`, so none profits from what another worked out; legal moves belong to the map and
    are worked out before. Before the times count, every algorithm solves the shortest query once, untimed.
    """
    check_algorithms(names)
    stop = None if time_limit is None else Seconds(time_limit)
    if workers < 1:
        raise ParameterError(f"workers {workers}", "at least 1 worker is needed", "give 1 or more")
    race = _Race(names, check_seed(seed), stop, Serial() if workers > 1 else None, cancel or threading.Event())
    race.warm_up(queries)
    return [answer for answers in race.answers(queries, workers, progress) for answer in answers]


@dataclass(frozen=True, eq=False)
class _Race:
    names: Sequence[str]
    seed: int
    stop: Stop | None
    executor: Serial | None
    cancel: threading.Event

    def warm_up(self, queries: Sequence[Query]) -> None:
        """Compile, prepare every map, and verify the published lengths."""
        for query in {query.grid.digest: query for query in queries}.values():
            for name in self.names:
                algorithm(name).prepare(query.problem())
        for query in queries:
            if self.cancel.is_set():
                return
            check_published(query)
        self.ask(min(queries, key=lambda query: query.published))

    def answers(self, queries: Sequence[Query], workers: int, progress: Progress | None) -> Iterator[list[Answer]]:
        """Answers to each query in order; none to those that were cancelled."""
        counter = _Counter(len(queries) * len(self.names), progress)

        def ask(query: Query) -> list[Answer]:
            return self.ask(query, counter)

        if workers == 1:
            yield from map(ask, queries)
            return
        with ThreadPoolExecutor(workers, thread_name_prefix="antnav-bench") as pool:
            try:
                yield from pool.map(ask, queries)
            except BaseException:
                self.cancel.set()
                raise

    def ask(self, query: Query, counter: _Counter | None = None) -> list[Answer]:
        found = []
        for name in self.names:
            answer = None if self.cancel.is_set() else self.answer(query, name)
            if answer is None:
                return []
            found.append(answer)
            if counter:
                counter.add()
        return found

    def answer(self, query: Query, name: str) -> Answer | None:
        """None where it was cancelled."""
        problem = query.problem()
        result = solve(
            problem, algorithm(name), seed=self.seed, stop=self.stop, executor=self.executor, cancel=self.cancel
        )
        if result.stopped_by is StoppedBy.CANCELLED:
            return None
        length = check_path(result.path, problem) if result.path else math.inf
        return Answer(query, name, self.seed, length, result.seconds_run, result.stopped_by)


class _Counter:
    """Counts searches of several threads."""

    def __init__(self, total: int, progress: Progress | None) -> None:
        self._lock, self._done, self._total, self._progress = threading.Lock(), 0, total, progress

    def add(self) -> None:
        with self._lock:
            self._done += 1
            if self._progress:
                self._progress(self._done, self._total)


# Tables


def raw_table(answers: Sequence[Answer]) -> Table:
    """One row an answer."""
    heads = (
        *("map", "scenarios", "number", "start row", "start col", "goal row", "goal col", "published length"),
        *("algorithm", "seed", "length", "gap %", "seconds", "stopped by"),
    )
    rows = tuple(
        (
            *(query.map_label, query.scenarios, query.number, *query.start, *query.goal, query.published),
            *(answer.algorithm, answer.seed, answer.length, 100 * answer.gap, answer.seconds, answer.stopped_by.value),
        )
        for answer in answers
        for query in [answer.query]
    )
    return Table("queries", "Every query by every algorithm", tuple(Column(head) for head in heads), rows)


@dataclass(frozen=True)
class Score:
    """An algorithm on the queries of a map: shares and gaps in per cent, times in milliseconds.

    Quantiles are linear and over all queries; a query without a path has gap inf. `ratio` is that of the median time to
    A*'s, nan where A* did not run.
    """

    map_label: str
    algorithm: str
    queries: int
    solved: float
    optimal: float
    gap_median: float
    gap_95: float
    gap_max: float
    ms_median: float
    ms_95: float
    ratio: float


def scores(answers: Sequence[Answer]) -> list[Score]:
    """A score for each map and algorithm, in the order of the answers; of several maps, then one for all of them."""
    labels = list(dict.fromkeys(answer.query.map_label for answer in answers))
    groups = {label: [answer for answer in answers if answer.query.map_label == label] for label in labels}
    if len(labels) > 1:
        groups[ALL_MAPS] = list(answers)
    return [score for label, group in groups.items() for score in _scores(label, group)]


def _scores(label: str, answers: Sequence[Answer]) -> list[Score]:
    found = []
    reference = [answer.seconds for answer in answers if answer.algorithm == "astar"]
    for name in dict.fromkeys(answer.algorithm for answer in answers):
        group = [answer for answer in answers if answer.algorithm == name]
        gaps = np.array([answer.gap for answer in group])
        seconds = [answer.seconds for answer in group]
        median_gap, high_gap, most = (float(100 * gap) for gap in quantiles(gaps, (0.5, 0.95, 1.0)))
        middle, high = (float(1000 * value) for value in quantiles(seconds, (0.5, 0.95)))
        found.append(
            Score(
                *(label, name, len(group), float(100 * np.isfinite(gaps).mean()), float(100 * (gaps == 0).mean())),
                *(median_gap, high_gap, most, middle, high),
                ratio=middle / (1000 * float(np.median(reference))) if reference else math.nan,
            )
        )
    return found


_COLUMNS = (
    Column("map"),
    Column("algorithm"),
    Column("queries", "d"),
    Column("solved %", ".1f"),
    Column("optimal %", ".1f"),
    Column("gap %, median", ".2f"),
    Column("gap %, 95th", ".2f"),
    Column("gap %, max", ".2f"),
    Column("ms, median", ".2f"),
    Column("ms, 95th", ".2f"),
    Column("x astar", ".1f"),
)


def summary(found: Sequence[Score], note: str = "") -> Table:
    """The scores as a table."""
    rows = tuple(tuple(getattr(score, name) for name in Score.__dataclass_fields__) for score in found)
    return Table("summary", "Gap to the published optimum, and time, by map", _COLUMNS, rows, note)


def picture(found: Sequence[Score]) -> Picture:
    """Gap and time of every algorithm by map."""
    marks: dict[str, dict[str, Mark]] = {}
    for score in found:
        mark = Mark(score.gap_median, score.gap_95, score.ms_median)
        marks.setdefault(score.algorithm, {})[score.map_label] = mark
    return Picture(marks, "gap (%): median, line to the 95th percentile; x: no path", "median time (ms)")
