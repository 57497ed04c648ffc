"""What an objective must do."""

from __future__ import annotations

import hashlib
import pickle
from itertools import pairwise

import numpy as np

from antnav.conformance.grounds import maps, problem_on
from antnav.conformance.sameness import first_problem, unshared
from antnav.conformance.subject import Subject
from antnav.conformance.verdict import Broken, Measured, Told
from antnav.fronts.pareto import pareto
from antnav.objectives.objective import Objective, Prices
from antnav.objectives.way import Length
from antnav.run.spmd import Processes, run_jobs
from antnav.world.path import Path, check_path
from antnav.world.problem import Problem


def prices_of(objective: Objective, problem: Problem) -> Prices:
    """Its prices on the problem's graph, checked."""
    return Prices.of(objective, problem.terrain, problem.graph)


def digest(objective: Objective, problem: Problem) -> bytes:
    """Of its prices, with all that decides a front."""
    prices = prices_of(objective, problem)
    return hashlib.sha256(prices.edges.tobytes() + prices.turns.tobytes() + repr(prices.step).encode()).digest()


def _digest_elsewhere(job: tuple[Objective, Problem]) -> bytes:
    return digest(*job)


def priced(subject: Subject) -> Told:
    """It gives prices: numbers of at least 0, of the right shapes, on every map."""
    least, most = np.inf, 0.0
    for grid in maps():
        prices = prices_of(subject.made, problem_on(grid))
        both = np.append(prices.edges, prices.turns)
        least, most = min(least, float(both.min())), max(most, float(both.max()))
    if most == 0:
        raise Broken("every move and turn costs 0: it tells no path from another")
    return Measured(f"prices of {least:g} to {most:g}", {"least": least, "most": most})


def same_prices(subject: Subject) -> Told:
    """The same map has the same prices, whatever was asked before."""
    first = digest(subject.made, first_problem())
    for grid in maps():
        digest(subject.made, problem_on(grid))
    if any(digest(subject.made, first_problem()) != first for _ in range(2)):
        raise Broken("the same map gets other prices: does it draw numbers, read a clock, or keep something?")
    return "one map, one set of prices"


def nothing_written(subject: Subject) -> Told:
    """It writes to nothing of the problem."""
    problem = first_problem()
    with unshared(problem):
        prices_of(subject.made, problem)
    return "nothing of the problem"


def fronts(subject: Subject) -> Told:
    """Fronts of it and length: legal paths, whose values are the sums of its prices."""
    objective, paths = subject.made, 0
    for grid in maps():
        problem = problem_on(grid)
        front = pareto(problem, [Length(), objective])
        for path, value in zip(front.paths, front.values[:, 1].tolist(), strict=True):
            paths += 1
            check_path(path, problem)
            total = _along(path, prices_of(objective, problem), problem)
            if not np.isclose(total, value, rtol=1e-9, atol=1e-12):
                raise Broken(f"on {grid.name}: a path of {value:g}, whose prices add up to {total:g}")
    return Measured(f"{paths} paths, all legal", {"paths": paths})


def _along(path: Path, prices: Prices, problem: Problem) -> float:
    nodes = [problem.graph.node(tuple(cell)) for cell in path.cells.tolist()]
    neighbours, total, came = problem.graph.graph.neighbours, 0.0, 0
    for node, following in pairwise(nodes):
        slot = int(np.flatnonzero(neighbours[node] == following)[0])
        total += float(prices.edges[node, slot] + prices.turns[came, slot])
        came = slot + 1
    return total


def sent(subject: Subject) -> Told:
    """In another process it has the same prices."""
    problem, wanted = first_problem(), digest(subject.made, first_problem())
    if digest(pickle.loads(pickle.dumps(subject.made)), problem) != wanted:
        raise Broken("its copy has other prices")
    processes = Processes(1)
    try:
        elsewhere = run_jobs(_digest_elsewhere, [(subject.made, problem)], processes)
    finally:
        processes.kill()
    if elsewhere != [wanted]:
        raise Broken("in another process it has other prices: does it depend on what is only in this one?")
    return "the same prices in another process"
