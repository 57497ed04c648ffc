"""A rule and its slow twin: the same function, written so plainly that a reader can check it by eye."""

from __future__ import annotations

from collections.abc import Callable
from inspect import signature
from typing import Any

import numpy as np
from numpy.typing import NDArray

from antnav.colony.colony import Colony
from antnav.colony.parts import Part
from antnav.conformance.goals import prices_of
from antnav.conformance.grounds import maps, problem_on
from antnav.conformance.sameness import bytes_of
from antnav.conformance.subject import Subject, is_one_colony, subjects_of
from antnav.errors import ParameterError, shown
from antnav.objectives.objective import Objective
from antnav.plan.solve import solve
from antnav.planner.planner import Planner
from antnav.register.parts import KINDS
from antnav.world.problem import Problem

#: Seeds of each map.
SEEDS = 2


def assert_twin(rule: Any, twin: Any) -> None:
    """Compare a rule with its slow twin, bit for bit, on maps of all sorts.

    Parameters
    ----------
    rule : what a decorator of `antnav.register` returned, or made of it, or a file that registers one thing
    twin : callable
        Of a rule, a function with the same arguments; of an algorithm or a planner, a function that returns a planner;
        of an objective, a class that derives from `antnav.objectives.Objective`.

    Raises
    ------
    AssertionError
        They differ: on which map, from which iteration on, by how much.
    ParameterError
        It is no rule, or the twin cannot be called, or not with the rule's parameters.
    """
    subject, *others = subjects_of(rule)
    if others:
        given = f"rules {subject.name} and {others[0].name}"
        raise ParameterError(given, "one rule is compared with its twin", 'name it, as in "mine.py:share"')
    if not callable(twin):
        raise ParameterError(f"twin {shown(twin)}", "it is a function, or a class of objectives", "give one")
    for grid in maps():
        problem = problem_on(grid)
        where = f"on map {grid.name}"
        if isinstance(subject.made, Objective):
            one, other = prices_of(subject.made, problem), prices_of(twin(), problem)
            _assert_same(f"{where}, prices of moves", one.edges, other.edges)
            _assert_same(f"{where}, prices of turns", one.turns, other.turns)
            continue
        for seed in range(SEEDS):
            _compare(f"{where}, seed {seed}", problem, seed, _planners(subject, twin))


def _planners(subject: Subject, twin: Callable[..., Any]) -> tuple[Planner, Planner]:
    if not isinstance(subject.made, Part):
        return subject.planner(), twin()
    part = subject.made
    skipped = len(KINDS[subject.kind][1])
    takes, wanted = (list(signature(one).parameters)[skipped:] for one in (twin, part.function))
    if sorted(takes) != sorted(wanted):
        rule = f"the twin takes {', '.join(takes) or 'no parameters'}, the rule {', '.join(wanted) or 'none'}"
        raise ParameterError(f"twin of {subject.name}", rule, "give it the arguments of the rule")
    kind = type(type(part).__name__, (type(part),), {"function": staticmethod(twin), "jit": False})
    return subject.planner(), subject.planner(**{subject.kind: kind(**part.values())})


def _compare(where: str, problem: Problem, seed: int, planners: tuple[Planner, Planner]) -> None:
    if not all(map(is_one_colony, planners)):
        results = [solve(problem, planner, seed=seed) for planner in planners]
        if bytes_of(results[0]) != bytes_of(results[1]):
            cost, its_cost = (result.cost for result in results)
            raise AssertionError(f"{where}: outcomes differ, a path of cost {cost:.6g}, and {its_cost:.6g} of its twin")
        return
    given: Any = planners
    mine, its = (Colony(problem, planner, seed) for planner in given)
    for iteration in mine:
        its.step()
        told = f"{where}, iteration {iteration.number}"
        _assert_same(f"{told}, pheromone", mine.tau, its.tau)
        for name, one, other in zip(mine.history._fields, mine.history, its.history, strict=True):
            _assert_same(f"{told}, {name} of the iterations", one, other)


def _assert_same(where: str, one: NDArray[Any], other: NDArray[Any]) -> None:
    bits = (array.ravel().view(np.uint64) for array in (one, other))
    differ = np.flatnonzero(np.not_equal(*bits))
    if len(differ):
        place = tuple(map(int, np.unravel_index(differ[0], one.shape)))
        raise AssertionError(f"{where}, place {place}: {one[place]!r}, its twin has {other[place]!r}")
