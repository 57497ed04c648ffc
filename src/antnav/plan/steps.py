"""Steps: a whole algorithm, all its stages, one iteration at a time."""

from __future__ import annotations

import time
from collections.abc import Generator, Iterator
from typing import NamedTuple

from antnav.ants.algorithm import Algorithm, told
from antnav.ants.strategies import Context, Found, Order, improved, strategy_of
from antnav.colony.colony import Colony
from antnav.errors import check_type
from antnav.plan.solve import checked, concluded, without_search
from antnav.planner.call import Call
from antnav.planner.result import Result
from antnav.world.problem import CellIndex, Problem


class Step(NamedTuple):
    """One iteration of the colonies that run side by side in a stage."""

    #: a `Phase`: "stage one", "stage two", "whole map", "regions"; at the end "routes" or "windows", or "abstraction"
    #: where no ant had to walk
    stage: str
    number: int  #: iteration in this stage, counted from 1
    colonies: tuple[Colony, ...]  #: as they stand: `history`, `tau` (may be written to), ...; () at the end
    auxiliary_cell: CellIndex | None  #: (row, col) at which PACO divided the map, from stage two on
    best: float  #: least cost, or length without costs, from start to goal in this stage so far; inf before the first


class Steps:
    """Run any algorithm one iteration at a time, PACO's two stages included.

    Parameters
    ----------
    problem : Problem
    algorithm : Algorithm, optional
        A preset such as `paco()` (default).
    seed : int
        0 <= seed < 2**64.

    Attributes
    ----------
    result : Result or None
        What `solve` returns for the same seed, to the last byte but for seconds; None until the last step is done.
        Pheromone that was written to on the way makes it another one.

    Raises
    ------
    ParameterError
        A parameter is out of range.

    Examples
    --------
    >>> import antnav as an
    >>> problem = an.Problem.from_cells(an.maps.builtin("equiv20"), start=(0, 0), goal=(19, 19))
    >>> steps = an.Steps(problem, an.paco(iterations=5), seed=7)
    >>> for step in steps:
    ...     print(step.stage, step.number, round(step.best, 2), [colony.last.lost for colony in step.colonies])
    stage one 1 46.87 [0, 0]
    stage one 2 38.38 [0, 0]
    stage one 3 38.38 [0, 0]
    stage two 1 34.63 [0, 0]
    stage two 2 33.56 [7, 31]
    >>> steps.result.auxiliary_cell
    (9, 9)
    """

    def __init__(self, problem: Problem, algorithm: Algorithm | None = None, seed: int = 0) -> None:
        planner = checked(problem, algorithm, seed)
        check_type("algorithm", planner, Algorithm, "call a preset, as in an.paco(): steps are those of ants")
        assert isinstance(planner, Algorithm)
        self.problem, self.algorithm, self.seed = problem, planner.suited(problem), int(seed)
        self.result: Result | None = None

    def __iter__(self) -> Iterator[Step]:
        call = Call(self.seed)
        run = Context(self.problem, self.algorithm, call)
        if plan := without_search(self.problem):
            self.result = concluded(self.problem, self.algorithm, call, plan, 0.0)
            return
        strategy, done = strategy_of(run), None
        while True:
            try:
                order = strategy.send(done)
            except StopIteration as end:
                found: Found = end.value
                break
            begin = time.perf_counter()
            colonies = tuple(Colony.of(task) for task in order.tasks)
            spent = yield from _side_by_side(order, colonies)
            seconds = time.perf_counter() - begin
            outcomes = [colony.outcome(seconds, cpu) for colony, cpu in zip(colonies, spent, strict=True)]
            done = run.keep(order, outcomes, seconds)
        plan = told(run, improved(run, found))
        self.result = concluded(self.problem, self.algorithm, call, plan, 0.0)
        if run.runs and not run.runs[-1].tasks:  # what comes after the ants: routes on cells, windows
            yield Step(run.runs[-1].name, 1, (), self.result.auxiliary_cell, self.result.cost)


def _side_by_side(order: Order, colonies: tuple[Colony, ...]) -> Generator[Step, None, list[float]]:
    """Colonies of a stage in lockstep; returns CPU seconds of each, added up by steps: each may be another thread's."""
    auxiliary, spent = None, [0.0] * len(colonies)
    if order.parts and len(order.tasks) == 2:
        row, col = order.tasks[1].grid_graph.cells[order.tasks[1].start]
        auxiliary = int(row), int(col)
    for number in range(1, max(task.iterations for task in order.tasks) + 1):
        for index, colony in enumerate(colonies):
            begin = time.thread_time()
            colony.step()
            spent[index] += time.thread_time() - begin
        best = order.best(colony.best_length for colony in colonies)
        yield Step(order.phase, number, colonies, auxiliary, best)
    return spent
