"""Every check is seen to pass good rules of each kind, and to fail a rule that breaks what it looks for."""

from __future__ import annotations

import os
import random
import re
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
import pytest

import antnav as an
from antnav.colony.parameters import FAMILIES
from antnav.conformance import comparing
from antnav.conformance.checks import CHECKS, OF_OBJECTIVES, carried_out
from antnav.conformance.grounds import maps, problem_on, problems
from antnav.conformance.model import Finding, Verdict
from antnav.conformance.subject import Subject, subjects_of
from antnav.conformance.verdict import Measured
from antnav.errors import ParameterError


def found(check: str, made: Any) -> Finding:
    (subject,) = subjects_of(made)
    return carried_out(check, subject)


def fails(check: str, made: Any, words: str) -> None:
    finding = found(check, made)
    assert finding.verdict is Verdict.FAILED, finding
    assert re.search(words, finding.told), finding.told


# Pheromone rules.


def good(ants, top=an.parameter(3, least=1, most=50)):
    """The best few deposit."""
    for rank in range(min(top, ants.arrived)):
        ants.amounts[rank] = ants.q / ants.costs[ants.order[rank]]


def drawing(ants):
    ants.amounts[0] = random.random()


def reading_the_clock(ants):
    ants.amounts[0] = time.perf_counter_ns() % 1000 / 1000


CALLS: list[int] = []


def counting(ants):
    CALLS.append(1)
    ants.amounts[0] = 1 / len(CALLS)


def exploding(ants):
    ants.amounts[: ants.arrived] = 1e308


def not_a_number(ants):
    ants.tau[:] = np.nan


def losing_edges(ants):
    ants.bounds[0] = 0.0


def saying_nan(ants):
    ants.amounts[0] = np.nan


def raising_late(ants):
    if ants.t == 7:
        raise ZeroDivisionError("in iteration 7")
    good(ants, 3)


def writing_costs(ants):
    ants.costs[:] = 1


def forcing(ants):
    ants.costs.flags.writeable = True
    ants.costs[0] = 1


def idle(ants):
    """Nobody deposits."""


def worst_first(ants):
    """The worst deposit."""
    for rank in range(max(0, ants.arrived - 3), ants.arrived):
        ants.amounts[rank] = ants.q / ants.costs[ants.order[rank]]


def in_this_process_only(ants):
    ants.amounts[0] = os.getpid() / 1e7


def in_this_thread_only(ants):
    ants.amounts[0] = 1.0 + (threading.current_thread() is threading.main_thread())


def small_maps_only(ants):
    assert len(ants.tau) > 20, "too small"


def dividing(ants):
    if 1 / (ants.t - ants.t) > 5:
        ants.amounts[0] = 0.5


def summing(ants):
    ants.amounts[0] = 1 / (1 + np.sum(ants.tau))


def beyond(ants):
    ants.amounts[len(ants.amounts) + 1 - ants.arrived * 0] = 0.0


@pytest.mark.parametrize(
    ("check", "function", "words"),
    [
        ("runs", raising_late, "in iteration 7"),
        ("runs", saying_nan, "no finite number"),
        ("runs", writing_costs, "read-only"),
        ("deterministic", drawing, "two runs with one seed differ"),
        ("deterministic", reading_the_clock, "two runs with one seed differ"),
        ("deterministic", counting, "two runs with one seed differ"),
        ("steps", counting, r"is not step\(12\)"),
        ("legal paths", small_maps_only, "on corridor, allow: .*too small"),
        ("bounds", exploding, "iteration 1: pheromone of inf"),
        ("runs", not_a_number, "no finite number"),
        ("bounds", losing_edges, "a lower bound of 0"),
        ("writes", writing_costs, "read-only"),
        ("writes", forcing, "writes to costs, which it is only shown"),
        ("workers", in_this_process_only, "another process"),
        ("workers", in_this_thread_only, "threads"),
        ("better than blind", idle, "shorter in 0 of 100 runs, longer in 0, p 1"),
        ("better than blind", worst_first, "shorter in 4. of 100 runs"),
        ("documented", drawing, "no docstring"),
    ],
)
def test_a_pheromone_rule_that_fails(check: str, function: Callable[..., None], words: str) -> None:
    fails(check, an.register.pheromone(function), words)


@pytest.mark.parametrize(
    ("check", "function", "words"),
    [
        ("writes", writing_costs, "only shown: .*readonly"),
        ("compiled", dividing, "in Python it raised ZeroDivisionError"),
        ("compiled", beyond, "an index beyond an array's end"),
        ("compiled", summing, "from iteration 2 on pheromone differs"),
    ],
)
def test_a_compiled_rule_that_fails(check: str, function: Callable[..., None], words: str) -> None:
    fails(check, an.register.pheromone(function, jit=True), words)


def test_what_may_be_compiled_and_is_not_is_no_failure() -> None:
    assert found("compiled", an.register.pheromone(good)).verdict is Verdict.SKIPPED


def test_a_parameter_without_a_range() -> None:
    def vague(ants, top=3):
        """The best few."""

    fails("documented", an.register.pheromone(vague), r"top has no range: write top=an.parameter\(")


def test_a_slow_rule_in_python(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(comparing, "SLOW", 0.0)
    fails("speed", an.register.pheromone(good), "times npaco, .* ms a run on equiv40: compile it, with jit=True")
    compiled = found("speed", an.register.pheromone(good, name="compiled", jit=True))
    assert compiled.verdict is Verdict.PASSED
    assert compiled.figures["ratio"] > 0


# Other kinds.


def heaviest(choice):
    """The heaviest edge, whatever is drawn."""
    return int(np.argmax(choice.weights))


def any_edge(choice):
    """Any edge, whatever it weighs."""
    edges = np.flatnonzero(choice.weights)
    return int(edges[int(choice.draws[0] * len(edges))])


def flat(ground):
    """The same everywhere."""
    return np.ones(len(ground))


def scribbling(ground):
    """Writes lengths."""
    ground.placed.graph.lengths[0] = 3.0
    return np.ones(len(ground))


def nowhere(ground):
    """No number."""
    return np.full(len(ground), np.nan)


def test_a_transition_that_ignores_its_draws() -> None:
    fails("deterministic", an.register.transition(heaviest), "another seed gives the same ants")


def test_a_transition_that_ignores_weights_is_blind() -> None:
    fails("better than blind", an.register.transition(any_edge), "against ants that walk at random")


def test_a_heuristic_that_says_nothing_is_blind() -> None:
    fails("better than blind", an.register.heuristic(flat), "shorter in 0 of 100 runs")


def test_a_heuristic_that_writes_to_the_graph() -> None:
    fails("writes", an.register.heuristic(scribbling), "written to lengths of the problem")


def test_a_heuristic_of_no_numbers() -> None:
    fails("runs", an.register.heuristic(nowhere), "nan at node")


def test_a_local_search_that_does_nothing() -> None:
    fails("better than blind", an.register.local_search(idle), "the same ants without it: shorter in 0 of 100")


def test_a_local_search_that_breaks_paths() -> None:
    def breaking(ants):
        """One node less."""
        ants.steps[:] -= 1

    fails("runs", an.register.local_search(breaking), "does not lead from the start to the goal")


def test_cuts_that_are_no_nodes() -> None:
    def at_the_goal(ground, paths, pieces):
        """The goal."""
        return [ground.goal]

    fails("runs", an.register.cuts(at_the_goal), "neither the start nor the goal")


def test_a_deadlock_rule_that_draws() -> None:
    def moody(stuck):
        """Dies now and then."""
        return random.random() < 0.5

    fails("deterministic", an.register.deadlock(moody), "two runs with one seed differ")


# Planners and algorithms.


@dataclass(frozen=True)
class Jumping(an.Planner):
    """From the start to the goal at once."""

    name: str = "jumping"

    def plan(self, problem: an.Problem, call: an.Call) -> an.Plan:
        return an.Plan(cells=np.array([problem.start_cell, problem.goal_cell]))


@dataclass(frozen=True)
class Forgetful(an.Planner):
    """Its document leaves out how it searches."""

    name: str = "forgetful"
    dear: bool = True

    def plan(self, problem: an.Problem, call: an.Call) -> an.Plan:
        found = an.solve(problem, an.astar() if not self.dear else an.npaco(ants=2, iterations=1), seed=call.seed)
        return an.Plan(cells=None if found.path is None else found.path.cells)

    def document(self) -> dict[str, Any]:
        return super().document() | {"dear": True}


@dataclass(frozen=True)
class Lazy(an.Planner):
    """Finds nothing."""

    name: str = "lazy"

    def plan(self, problem: an.Problem, call: an.Call) -> an.Plan:
        return an.Plan(cells=None)


@dataclass(frozen=True)
class Undescribed(an.Planner):
    name: str = "undescribed"

    def plan(self, problem: an.Problem, call: an.Call) -> an.Plan:
        return an.Plan(cells=None)


def test_a_planner_whose_path_is_none() -> None:
    fails("legal paths", an.register.planner(Jumping), "on open, allow: .*neighbours")


def test_a_planner_that_files_do_not_hold() -> None:
    kind = an.register.planner(Forgetful)
    assert found("saved", kind()).verdict is Verdict.PASSED
    fails("saved", kind(dear=False), "another outcome")


def test_a_planner_that_finds_nothing() -> None:
    made = an.register.planner(Lazy)
    fails("better than blind", made, "shorter in 0 of 100 .*; without a path in 100, which counts as longest")
    assert found("deterministic", made).told == "one seed, one outcome; another seed, the same one"
    assert found("steps", made).verdict is Verdict.SKIPPED


def test_a_dataclass_without_words_of_its_own() -> None:
    fails("documented", an.register.planner(Undescribed), "no docstring")


def test_an_algorithm_whose_rule_fails() -> None:
    rule = an.register.pheromone(exploding)

    def mine(**choices):
        """With a rule that explodes."""
        return an.npaco(pheromone=rule, **choices)

    fails("bounds", an.register.algorithm(mine), "pheromone of inf")


# Objectives.


class Priced(an.objectives.Objective):
    """A move costs what the function says."""

    name = "priced"
    of: ClassVar[Callable[[Any, Any], Any]]

    def edges(self, terrain: Any, graph: Any) -> Any:
        return type(self).of(terrain, graph)


ASKED: list[int] = []


def growing(terrain: Any, graph: Any) -> Any:
    ASKED.append(1)
    return graph.graph.lengths * len(ASKED)


def stretching(terrain: Any, graph: Any) -> Any:
    graph.graph.lengths[0] *= 2
    return graph.graph.lengths


def alternating(terrain: Any, graph: Any) -> Any:
    ASKED.append(1)
    return graph.graph.lengths * (1 + len(ASKED) % 2)


@pytest.mark.parametrize(
    ("check", "function", "words"),
    [
        ("runs", lambda terrain, graph: -graph.graph.lengths, "costs 0 to"),
        ("runs", lambda terrain, graph: graph.graph.lengths * 0, "tells no path from another"),
        ("deterministic", growing, "the same map gets other prices"),
        ("writes", stretching, "written to lengths"),
        ("fronts", alternating, "whose prices add up to"),
        ("workers", lambda terrain, graph: graph.graph.lengths * os.getpid(), "in another process"),
    ],
)
def test_an_objective_that_fails(check: str, function: Callable[..., Any], words: str) -> None:
    kind = an.register.objective(type("Own", (Priced,), {"of": staticmethod(function), "__doc__": "Own."}))
    fails(check, kind, words)


def test_a_good_objective_passes_all() -> None:
    kind = an.register.objective(
        type("Own", (Priced,), {"of": lambda terrain, graph: graph.graph.lengths > 1, "__doc__": "Diagonal moves."})
    )
    assert {check: found(check, kind).verdict for check in OF_OBJECTIVES} == dict.fromkeys(OF_OBJECTIVES, "passed")


# The suite itself.


@pytest.mark.parametrize("jit", [False, True], ids=["in Python", "compiled"])
def test_a_good_rule_passes_all(jit: bool) -> None:
    rule = an.register.pheromone(good, jit=jit)
    verdicts = {check: found(check, rule) for check in CHECKS}
    assert [one for one in verdicts.values() if one.verdict is Verdict.FAILED] == []
    assert {check for check, one in verdicts.items() if one.verdict is Verdict.SKIPPED} == (
        set() if jit else {"compiled"}
    )


BUILT_IN = [
    pytest.param(kind, name, id=f"{kind}-{name}")
    for kind, family in FAMILIES.items()
    if kind != "memory"
    for name in map(str, family.family)
    if name != "none"
]


@pytest.mark.parametrize(("kind", "name"), BUILT_IN)
def test_built_in_rules_are_better_than_blind(kind: str, name: str) -> None:
    told = comparing.better(Subject(kind, FAMILIES[kind].of(name)))
    assert isinstance(told, Measured)
    assert told.figures["p"] < (1e-3 if name == "edge" else 1e-8)


def test_problems_hold_what_rules_stumble_over() -> None:
    named = dict(problems())
    assert len(named) > 36
    assert {problem.corner_rule for problem in named.values()} == set(an.CornerRule)
    assert not named["no path"].connected
    assert named["start is goal"].start_cell == named["start is goal"].goal_cell
    sizes = {grid.name: len(problem_on(grid).graph) for grid in maps()}
    assert min(sizes.values()) < 20 < 100 < max(sizes.values())


def test_what_is_no_rule_is_refused(tmp_path: Any) -> None:
    for given in (3, None, an.npaco(), an.colony, "no.py", good):
        with pytest.raises(ParameterError):
            subjects_of(given)
    (tmp_path / "empty.py").write_text("x = 1\n")
    with pytest.raises(ParameterError, match="registers nothing"):
        subjects_of(tmp_path / "empty.py")
