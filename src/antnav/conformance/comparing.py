"""Against others: whether a rule is better than none at all, and what it takes beside the built-in one of its kind."""

from __future__ import annotations

import math
import statistics
import time
from typing import Any

import numpy as np

from antnav.ants.presets import npaco, paco
from antnav.colony.colony import Colony
from antnav.conformance.grounds import maps, problem_on
from antnav.conformance.subject import ASKED, Subject
from antnav.conformance.verdict import Broken, Measured, Told
from antnav.maps.builtin import builtin, builtin_query
from antnav.plan.solve import solve
from antnav.planner.planner import Planner
from antnav.plugins.source import Source
from antnav.register.parts import Spec, made
from antnav.report.statistics import paired
from antnav.world.problem import Problem

#: Seeds of each problem.
SEEDS = 10
#: Maps on which there is only one path, so that nothing can be better.
ONE_PATH = {"corridor", "zigzag"}
#: Ants that are guided a little, and feel each deposit.
LEARNING = {"heuristic": "target", "beta": 2, "tau0": 0.02, "ants": 20, "iterations": 100}
#: Above this p value "better" may be luck.
LUCK = 0.001
#: More than so many times the built-in rule's time.
SLOW = 20
ROUNDS = 5


def better(subject: Subject) -> Told:
    """It does better than what is blind, by more than luck."""
    words, ours, theirs = (_learning if subject.kind == "pheromone" else _planning)(subject)
    duel = paired(ours, theirs)
    figures = {"shorter": duel.shorter, "equal": duel.equal, "longer": duel.longer, "p": duel.p}
    told = f"{words}: shorter in {duel.shorter} of {duel.pairs} runs, longer in {duel.longer}, p {duel.p:.1g}"
    if lost := sum(map(math.isinf, ours)):
        told += f"; without a path in {lost}, which counts as longest"
    if not duel.favours_first or duel.p > LUCK:
        raise Broken(told)
    return Measured(told, figures)


def _planning(subject: Subject) -> tuple[str, list[float], list[float]]:
    """Costs of the paths found, and of those of ants that walk at random, or without the local search.

    A heuristic is judged without pheromone.
    """
    words, blind = "against ants that walk at random", npaco(heuristic="edge", alpha=0, beta=0, ants=10, iterations=10)
    if subject.kind == "local_search":
        words, blind = "against the same ants without it", npaco(ants=10, iterations=10)
    alone = {"alpha": 0} if subject.kind == "heuristic" else {}
    planners = subject.planner(ants=10, iterations=10, **alone), blind
    ours, theirs = (
        [solve(problem, planner, seed=seed).cost for problem in grounds() for seed in range(SEEDS)]
        for planner in planners
    )
    return words, ours, theirs


def _learning(subject: Subject) -> tuple[str, list[float], list[float]]:
    """Mean costs of the ants' paths in the last third of a run, with the rule and where nobody deposits anything.

    The best path would not do: on small maps ants that learn nothing come upon it, since they go everywhere.
    """

    def silent(ants: Any) -> None:
        pass

    nobody = made(Spec("pheromone", silent, Source("silent", "", "", ""), jit=False))()
    ours, theirs = (
        [_at_last(planner, problem, seed) for problem in grounds() for seed in range(SEEDS)]
        for planner in (subject.planner(**LEARNING, pheromone=rule) for rule in (subject.made, nobody))
    )
    return "the ants' last paths, against ants that deposit nothing", ours, theirs


def grounds() -> list[Problem]:
    """Those on which a path can be better than another."""
    return [problem_on(grid) for grid in maps() if grid.name not in ONE_PATH]


def _at_last(planner: Any, problem: Problem, seed: int) -> float:
    colony = Colony(problem, planner, seed)
    colony.step(planner.iterations)
    means = colony.history.mean[-planner.iterations // 3 :]
    return float(np.mean(means[np.isfinite(means)])) if np.isfinite(means).any() else math.inf


def speed(subject: Subject) -> Told:
    """How long it takes beside the built-in rule of its kind."""
    problem = Problem.from_cells(builtin("equiv40"), *builtin_query("equiv40"))
    usual = paco() if subject.kind == "cuts" else npaco()
    ratio, seconds = ratio_of(subject.planner(ants=usual.ants, iterations=usual.iterations), usual, problem)
    told = f"{ratio:.2f} times {usual.name}"
    told += f", {1000 * seconds:.1f} ms a run on equiv40"
    if ratio > SLOW and subject.kind in ASKED and not type(subject.made).jit:
        raise Broken(f"{told}: compile it, with jit=True")
    return Measured(told, {"ratio": ratio, "seconds": seconds})


def ratio_of(own: Planner, usual: Planner, problem: Problem) -> tuple[float, float]:
    """Median ratio of run times, taken by turns, and the median time of the first."""
    pairs = []
    for planner in (own, usual):
        planner.prepare(problem)
        solve(problem, planner)
    for seed in range(ROUNDS):
        times = []
        for planner in (own, usual):
            begin = time.perf_counter()
            solve(problem, planner, seed=seed)
            times.append(time.perf_counter() - begin)
        pairs.append(times)
    return statistics.median(one / other for one, other in pairs), statistics.median(one for one, _ in pairs)
