"""What must give the same bytes: a seed twice, steps one by one and at once, workers, files, compiled and not."""

from __future__ import annotations

import contextlib
import hashlib
import tempfile
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np

from antnav.colony.colony import Colony
from antnav.colony.parameters import FAMILIES
from antnav.colony.parts import Part
from antnav.conformance.grounds import problem_on
from antnav.conformance.subject import ASKED, Subject, is_one_colony
from antnav.conformance.verdict import Broken, LeftOut, Told
from antnav.errors import RuleError
from antnav.maps.generators import generate
from antnav.plan.solve import solve
from antnav.planner.planner import Planner, Recorded
from antnav.planner.result import Result
from antnav.register.parts import Spec, made
from antnav.run.spmd import Processes, Serial, run_jobs
from antnav.world.problem import Problem

#: Seeds of runs that are compared.
SEED, OTHER_SEED = 11, 12
#: Iterations that are made one by one and all at once.
STEPS = 12


def first_problem() -> Problem:
    """With walls, dead ends, and more ways than one."""
    return problem_on(generate("random", 14, 14, seed=7, density=0.25))


def other_problem() -> Problem:
    """Of another size."""
    return problem_on(generate("random", 9, 17, seed=2, density=0.15))


@contextlib.contextmanager
def unshared(problem: Problem) -> Iterator[None]:
    """Refuse what writes to arrays that all runs on a problem share."""
    before = _digests(problem)
    yield
    if changed := [name for name, one in _digests(problem).items() if one != before[name]]:
        raise Broken(f"it has written to {', '.join(changed)} of the problem, which other runs share")


def _digests(problem: Problem) -> dict[str, bytes]:
    graph = problem.graph
    arrays = {"the map": problem.grid.cells, "moves": problem.flat_moves, "cells": graph.cells}
    arrays |= {name: array for name, array in graph.graph._asdict().items() if isinstance(array, np.ndarray)}
    return {name: hashlib.sha256(np.ascontiguousarray(array).data).digest() for name, array in arrays.items()}


def bytes_of(result: Result) -> bytes:
    """A digest of all that a run brought but the times."""
    cells = None if result.path is None else result.path.cells.tolist()
    heat = None if result.pheromone is None else result.pheromone.tobytes()
    told = cells, result.status, result.auxiliary_cell, heat, *(column.tobytes() for column in result.history)
    return hashlib.sha256(repr(told).encode()).digest()


def run_of(planner: Planner, problem: Problem, seed: int = SEED, **how: Any) -> bytes:
    """The digest of a run."""
    return bytes_of(solve(problem, planner, seed=seed, **how))


def _run_elsewhere(job: tuple[Planner, Problem, int]) -> bytes:
    planner, problem, seed = job
    return run_of(planner, problem, seed)


def deterministic(subject: Subject) -> Told:
    """The same seed gives the same bytes, whatever ran before; another seed gives other ants."""
    planner, problem = subject.planner(), first_problem()
    first = run_of(planner, problem)
    run_of(planner, other_problem(), OTHER_SEED)
    for _ in range(2):
        if run_of(planner, problem) != first:
            raise Broken(
                "two runs with one seed differ: does it draw numbers of its own, read a clock, or keep "
                "something between runs?"
            )
    if run_of(planner, problem, OTHER_SEED) != first:
        return "one seed, one outcome; another seed, another"
    if isinstance(subject.made, Part):
        raise Broken("another seed gives the same ants: does it use the draws that it is given?")
    return "one seed, one outcome; another seed, the same one"


def steps(subject: Subject) -> Told:
    """A colony's steps one by one give the bytes of as many at once."""
    planner, problem = colony_of(subject), first_problem()
    one, many = Colony(problem, planner, SEED), Colony(problem, planner, SEED)
    for _ in range(min(STEPS, planner.iterations)):
        one.step(1)
    many.step(min(STEPS, planner.iterations))
    if not same_colonies(one, many):
        raise Broken("step(1) twelve times is not step(12): does it count its calls, or keep arrays that it is shown?")
    return f"step(1) {one.iteration} times is step({one.iteration})"


def colony_of(subject: Subject) -> Any:
    """The algorithm, where a `Colony` can step through it."""
    planner = subject.planner()
    if not is_one_colony(planner):
        raise LeftOut("it is not one colony on the whole map")
    return planner


def same_colonies(one: Colony, other: Colony) -> bool:
    """Whether pheromone and history are the same, bit for bit."""
    arrays = zip((one.tau, *one.history), (other.tau, *other.history), strict=True)
    return all(left.tobytes() == right.tobytes() for left, right in arrays)


def workers(subject: Subject) -> Told:
    """In turn, in threads, in other processes and sent there: the same bytes."""
    planner, problem = subject.planner(), first_problem()
    wanted = run_of(planner, problem, executor=Serial())
    with ThreadPoolExecutor(2) as threads:
        if run_of(planner, problem, executor=threads) != wanted:
            raise Broken("runs in threads and in turn differ")
        beside = threads.map(lambda seed: run_of(planner, problem, seed), (SEED, OTHER_SEED, SEED, OTHER_SEED))
        if len(set(beside)) > 2 or run_of(planner, problem) != wanted:
            raise Broken("runs side by side disturb one another: does it keep something between calls?")
    processes = Processes(1)
    try:
        elsewhere = run_jobs(_run_elsewhere, [(planner, problem, SEED)], processes)
        through = run_of(planner, problem, executor=processes)
    finally:
        processes.kill()
    if elsewhere != [wanted] or through != wanted:
        raise Broken("a run in another process differs: does it depend on what is only in this one?")
    return "in turn, in threads, in another process"


def saved(subject: Subject) -> Told:
    """A saved result is read again, and what made it gives the same bytes."""
    planner, problem = subject.planner(), first_problem()
    result = solve(problem, planner, seed=SEED)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "result.json"
        result.save(file)
        again = Result.load(file)
    if isinstance(again.algorithm, Recorded):
        raise Broken("the file names it, but it cannot be made of what the file says")
    if again.algorithm.document() not in (planner.document(), planner.suited(problem).document()):
        raise Broken("the file's algorithm has other parameters")
    if (again.path is None) != (result.path is None) or bytes_of(
        solve(again.problem, again.algorithm, seed=again.seed)
    ) != bytes_of(result):
        raise Broken("the algorithm that was read from the file gives another outcome")
    return "read from its file, it gives the same bytes"


def with_jit(part: Part, jit: bool) -> Part:
    """The same rule, compiled or in Python."""
    kind = next(kind for kind in ASKED if isinstance(part, FAMILIES[kind]))
    spec = Spec(kind, type(part).function, part.source, jit)
    return made(spec)(**part.values())


def compiled(subject: Subject) -> Told:
    """Compiled and in Python it gives the same bytes."""
    part = compiled_part(subject)
    planners: list[Any] = [subject.planner(**{subject.kind: one}) for one in (part, with_jit(part, jit=False))]
    one, other = (Colony(first_problem(), planner, SEED) for planner in planners)
    for iteration in range(1, one.task.iterations + 1):
        one.step()
        try:
            other.step()
        except RuleError as error:
            raise Broken(f"compiled it runs, but in Python {error.rule}") from error
        if not same_colonies(one, other):
            worst = float(np.nanmax(np.abs(one.tau - other.tau)))
            rule = f"from iteration {iteration} on pheromone differs by up to {worst:.2g}"
            raise Broken(
                f"compiled and in Python it differs, {rule}: sums in another order, or whole numbers for reals?"
            )
    return "compiled and in Python alike"


def compiled_part(subject: Subject) -> Any:
    """The rule, where it is one that is compiled."""
    part = subject.made
    if not (isinstance(part, Part) and type(part).jit):
        raise LeftOut("it is not compiled")
    return part
