"""Against others: whether a rule is better than none at all, and what it takes beside the built-in one of its kind."""

from __future__ import annotations

import statistics
import time

from antnav.ants.presets import npaco, paco
from antnav.conformance.grounds import maps, problem_on
from antnav.conformance.subject import ASKED, Subject
from antnav.conformance.verdict import Broken, Measured, Told
from antnav.maps.builtin import builtin, builtin_query
from antnav.plan.solve import solve
from antnav.planner.planner import Planner
from antnav.report.statistics import paired
from antnav.world.problem import Problem

#: Seeds of each problem.
SEEDS = 10
#: Maps on which there is only one path, so that nothing can be better.
ONE_PATH = {"corridor", "zigzag"}
#: Above this p value "better" may be luck.
LUCK = 0.001
#: More than so many times the built-in rule's time.
SLOW = 20
ROUNDS = 5


def duel_of(subject: Subject) -> tuple[Planner, Planner, str]:
    """The planner that is judged, its blind rival, and what that is in words."""
    few = {"ants": 10, "iterations": 10}
    if subject.kind == "pheromone":
        alone = {"heuristic": "edge", "beta": 0, "ants": 10, "iterations": 30}
        return subject.planner(**alone), subject.planner(alpha=0, **alone), "the same ants, blind to pheromone"
    blind = npaco(heuristic="edge", alpha=0, beta=0, ants=10, iterations=10)
    own = {"alpha": 0} if subject.kind == "heuristic" else {}
    return subject.planner(**few, **own), blind, "ants that walk at random"


def lengths(planner: Planner) -> list[float]:
    """Costs of paths, on each map with each seed."""
    grounds = [problem_on(grid) for grid in maps() if grid.name not in ONE_PATH]
    return [solve(problem, planner, seed=seed).cost for problem in grounds for seed in range(SEEDS)]


def better(subject: Subject) -> Told:
    """Its paths are shorter than those of blind ants, by more than luck."""
    planner, blind, words = duel_of(subject)
    ours, theirs = lengths(planner), lengths(blind)
    duel = paired(ours, theirs)
    figures = {"shorter": duel.shorter, "equal": duel.equal, "longer": duel.longer, "p": duel.p}
    told = f"against {words}: shorter in {duel.shorter} of {duel.pairs} runs, longer in {duel.longer}, p {duel.p:.1g}"
    if not duel.favours_first or duel.p > LUCK:
        raise Broken(told)
    return Measured(told, figures)


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
