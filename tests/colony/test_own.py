"""Rules of the user's own, asked by the kernel: like the built-in ones where they say the same, refused where wrong."""

from __future__ import annotations

import gc
import math
import weakref
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import antnav as an
from antnav.colony.parts import (
    DeadlockPart,
    LocalSearchPart,
    Part,
    PheromonePart,
    TransitionPart,
    parameter,
)
from antnav.colony.parts.names import OwnName
from antnav.errors import RuleError
from antnav.kernels import plugs
from antnav.planner.facts import Basis
from antnav.plugins.source import Source

BOTH = pytest.mark.parametrize("jit", [True, False], ids=["compiled", "in Python"])


def own(base: type[Part], function: Any, *, jit: bool = False, **more: Any) -> Any:
    """A part of that kind whose rule is the function."""
    name = function.__name__
    members = {"name": OwnName(name), "basis": Basis.OWN, "own": True, "jit": jit}
    members["source"] = Source(name, "", "test_own.py", "")
    kind = type(name, (base,), members | {"function": staticmethod(function)} | more)
    return kind()


def problem(name: str = "equiv20") -> an.Problem:
    return an.Problem.from_cells(an.maps.builtin(name), *an.maps.builtin_query(name))


def outcome(algorithm: an.Algorithm, *, seed: int = 3, where: an.Problem | None = None) -> tuple[bytes, list[float]]:
    colony = an.Colony(where or problem(), algorithm, seed=seed)
    colony.step(algorithm.iterations)
    return colony.tau.tobytes(), colony.history.best.tolist()


def ranked(ants, elite):  # type: ignore[no-untyped-def]
    for rank in range(min(elite - 1, ants.arrived)):
        ants.amounts[rank] = (elite - 1 - rank) * ants.q / ants.costs[ants.order[rank]]
    if ants.best_steps > 0:
        ants.amounts[-1] = elite * ants.q / ants.best


def ranked_arrays(ants, elite):  # type: ignore[no-untyped-def]
    first = ants.order[: min(elite - 1, ants.arrived)]
    ants.amounts[: len(first)] = np.arange(elite - 1, elite - 1 - len(first), -1) * ants.q / ants.costs[first]
    if ants.best_steps > 0:
        ants.amounts[-1] = elite * ants.q / ants.best


def punishing(ants):  # type: ignore[no-untyped-def]
    c = (10 * ants.t + ants.iterations - 1) // ants.iterations
    for rank in range(min(11 - c, ants.arrived)):
        ants.amounts[rank] += c * ants.q / ants.costs[ants.order[rank]]
    share = -1.0 if 2 * ants.t <= ants.iterations else -0.2
    for rank in range(max(0, ants.arrived - c), ants.arrived):
        ants.amounts[rank] += share * ants.q / ants.costs[ants.order[rank]]


ELITE = {"elite": parameter(6, least=1)}


@BOTH
@pytest.mark.parametrize("deposit", ["both", "forward", "cells"])
@pytest.mark.parametrize("function", [ranked, ranked_arrays])
def test_a_rank_based_rule_of_ones_own_gives_the_bytes_of_the_built_in_one(
    function: Any, deposit: str, jit: bool
) -> None:
    if jit and function is ranked_arrays and deposit != "both":
        pytest.skip("compiled once is enough")
    common = {"deposit": deposit, "spread": 0.1} if deposit == "both" else {"deposit": deposit}
    usual = an.npaco(pheromone="rank_based", ants=30, iterations=20, **common)  # type: ignore[arg-type]
    mine = replace(usual, pheromone=own(PheromonePart, function, jit=jit, **ELITE))
    assert outcome(mine) == outcome(usual)


def test_pacos_own_rule_written_anew() -> None:
    usual = an.npaco(ants=50, iterations=20)
    mine = replace(usual, pheromone=own(PheromonePart, punishing))
    assert outcome(mine)[1] == outcome(usual)[1]


def test_local_searches_of_the_algorithm_go_on_beside_an_own_rule() -> None:
    usual = an.npaco(pheromone="rank_based", local_search="taut", graft=True, ants=20, iterations=10)
    assert outcome(replace(usual, pheromone=own(PheromonePart, ranked, **ELITE))) == outcome(usual)


def test_steps_one_at_a_time_and_many_at_once_are_the_same() -> None:
    def remembers(ants):  # type: ignore[no-untyped-def]
        ants.notes[0] += 1
        ants.amounts[0] = 1.0 / (ants.costs[ants.order[0]] + ants.notes[0])

    mine = an.npaco(ants=20, iterations=12)
    mine = replace(mine, pheromone=own(PheromonePart, remembers))
    one, many = an.Colony(problem(), mine, seed=1), an.Colony(problem(), mine, seed=1)
    many.step(12)
    for _ in one:
        pass
    assert np.array_equal(one.tau, many.tau)


@BOTH
def test_a_rule_may_write_tau_and_its_bounds(jit: bool) -> None:
    def levelled(ants):  # type: ignore[no-untyped-def]
        ants.tau[:] = 0.5
        ants.tau[:5] = 0.8
        ants.bounds[0] = 0.7
        ants.bounds[1] = 0.9

    colony = an.Colony(problem(), replace(an.npaco(), pheromone=own(PheromonePart, levelled, jit=jit)), seed=1)
    colony.step(2)
    assert set(np.unique(colony.tau)) == {0.7, 0.8}
    assert colony._state.bounds.tolist() == [0.7, 0.9]


WALLED = np.array([[0, 0, 0, 0, 0], [0, 1, 1, 1, 0], [0, 1, 0, 1, 0], [0, 1, 0, 1, 0], [0, 0, 0, 0, 0]], np.uint8)


def spin(choice):  # type: ignore[no-untyped-def]
    total = 0.0
    for k in range(8):
        total += choice.weights[k]
    target = choice.draws[0] * total
    running = 0.0
    last = 0
    for k in range(8):
        if choice.weights[k] > 0.0:
            running += choice.weights[k]
            last = k
            if target < running:
                return k
    return last


def seen_choice(choice):  # type: ignore[no-untyped-def]
    assert 1 <= choice.t <= choice.iterations == 4
    assert (choice.steps == 0) == (choice.came == -1)
    assert choice.neighbours.shape == choice.lengths.shape == choice.tau.shape
    assert all(choice.neighbours[choice.node, k] < len(choice.tau) for k in np.flatnonzero(choice.weights))
    assert ((choice.draws >= 0) & (choice.draws < 1)).all()
    assert len(set(choice.draws.tolist())) == plugs.DRAWS
    return int(np.argmax(choice.weights))


def test_what_a_transition_rule_sees() -> None:
    algorithm = an.npaco(ants=5, iterations=4)
    mine = replace(algorithm, transition=own(TransitionPart, seen_choice))
    best = an.solve(problem(), mine, seed=2)
    assert best.length < math.inf
    usual = an.npaco(ants=5, iterations=4, transition="pseudo_random", q0_min=1, q0_max=1, local_rate=1e-9)
    first = an.Colony(problem(), mine, seed=2), an.Colony(problem(), usual, seed=2)
    for colony in first:
        colony.step(1)
    assert [ant.cells.tolist() for ant in first[0].ants()] == [ant.cells.tolist() for ant in first[1].ants()]


@BOTH
def test_a_roulette_of_ones_own_draws_like_the_built_in_one_in_the_first_step(jit: bool) -> None:
    usual = an.npaco(ants=40, iterations=1)
    mine = replace(usual, transition=own(TransitionPart, spin, jit=jit))
    walks = [an.Colony(problem(), one, seed=5) for one in (usual, mine)]
    for colony in walks:
        colony.step()
    first = [[tuple(ant.cells[1]) for ant in colony.ants()] for colony in walks]
    assert first[0] == first[1]


@BOTH
def test_hybrid_deadlock_written_anew_gives_the_same_bytes(jit: bool) -> None:
    def late(stuck, b):  # type: ignore[no-untyped-def]
        return stuck.t > math.floor(b * stuck.iterations + 1e-9)

    usual = an.npaco(ants=20, iterations=20, switch=0.6)

    def share(self: DeadlockPart, schedule: int) -> dict[str, Any]:
        return DeadlockPart.share(self, schedule) | {"punish": self.punish}  # type: ignore[attr-defined]

    rule = own(
        DeadlockPart, late, jit=jit, b=parameter(0.6, most=1), punish=parameter(usual.deadlock.punish), share=share
    )
    assert outcome(replace(usual, deadlock=rule)) == outcome(usual)


def test_a_dead_end_says_how_often_the_ant_has_stepped_back() -> None:
    seen: list[int] = []

    def patient(stuck):  # type: ignore[no-untyped-def]
        seen.append(stuck.backs)
        return stuck.backs >= 3

    rule = own(DeadlockPart, patient)
    an.solve(problem(), replace(an.npaco(iterations=10), deadlock=rule), seed=1)
    assert set(seen) == {0, 1, 2, 3}


def wrong(kind: type[Part], function: Any, *, jit: bool = False) -> RuleError:
    field = {PheromonePart: "pheromone", TransitionPart: "transition", DeadlockPart: "deadlock"}[kind]
    algorithm = replace(an.npaco(), **{field: own(kind, function, jit=jit)})
    with pytest.raises(RuleError) as caught:
        an.solve(problem(), algorithm, seed=1)
    return caught.value


def test_a_rule_that_raises_is_named_with_its_line() -> None:
    def raises(ants):  # type: ignore[no-untyped-def]
        raise ZeroDivisionError("by nothing")

    error = wrong(PheromonePart, raises)
    assert "pheromone rule raises (test_own.py): it raised ZeroDivisionError: by nothing (line" in str(error)
    assert isinstance(error.__cause__, ZeroDivisionError)


def test_ctrl_c_in_a_rule_is_ctrl_c() -> None:
    def interrupted(ants):  # type: ignore[no-untyped-def]
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        an.solve(problem(), replace(an.npaco(), pheromone=own(PheromonePart, interrupted)), seed=1)


def test_a_colony_goes_without_waiting_for_the_garbage_collector() -> None:
    def nothing(ants):  # type: ignore[no-untyped-def]
        pass

    colony = an.Colony(problem(), an.npaco(pheromone=own(PheromonePart, nothing)), seed=3)
    colony.step()
    gc.disable()
    try:
        gone = weakref.ref(colony.tau)
        del colony
        assert gone() is None
    finally:
        gc.enable()


def test_a_rule_cannot_write_to_what_it_is_only_shown() -> None:
    def greedy(ants):  # type: ignore[no-untyped-def]
        ants.costs[:] = 0

    assert "read-only" in str(wrong(PheromonePart, greedy))


def test_a_rule_that_returns_what_it_should_have_written() -> None:
    def returns(ants):  # type: ignore[no-untyped-def]
        return ants.amounts

    assert "returns None" in str(wrong(PheromonePart, returns))


@BOTH
def test_amounts_that_are_no_numbers_are_refused(jit: bool) -> None:
    def nowhere(ants):  # type: ignore[no-untyped-def]
        ants.amounts[0] = np.nan

    assert "for ant " in str(wrong(PheromonePart, nowhere, jit=jit))

    def best(ants):  # type: ignore[no-untyped-def]
        ants.amounts[-1] = np.inf

    assert "the best path so far is no finite number" in str(wrong(PheromonePart, best, jit=jit))


@BOTH
@pytest.mark.parametrize("bounds", [(-10.0, 10.0), (math.nan, math.nan), (2.0, 1.0), (math.inf, math.inf)])
def test_bounds_below_zero_by_which_ants_could_leave_the_map_are_refused(
    bounds: tuple[float, float], jit: bool
) -> None:
    low, high = bounds

    def unbounded(ants):  # type: ignore[no-untyped-def]
        ants.bounds[0] = low
        ants.bounds[1] = high
        for i in range(ants.tau.shape[0]):
            for k in range(8):
                ants.tau[i, k] = (i + 3 * k) % 5 - 2.0

    colony = an.Colony(problem(), an.npaco(pheromone=own(PheromonePart, unbounded, jit=jit)), seed=3)
    for _ in range(2):  # once more: it does not walk on
        with pytest.raises(RuleError, match="bounds"):
            colony.step(50)


@BOTH
def test_pheromone_that_is_no_number_is_refused_at_edges_and_does_no_harm_elsewhere(jit: bool) -> None:
    def at_edges(ants):  # type: ignore[no-untyped-def]
        ants.tau[ants.start, :] = np.nan

    assert "tau" in str(wrong(PheromonePart, at_edges, jit=jit))

    def elsewhere(ants):  # type: ignore[no-untyped-def]
        for i in range(ants.tau.shape[0]):
            for k in range(8):
                if ants.neighbours[i, k] == ants.tau.shape[0]:
                    ants.tau[i, k] = np.inf

    def nowhere(ants):  # type: ignore[no-untyped-def]
        pass

    bests = [outcome(an.npaco(pheromone=own(PheromonePart, one, jit=jit)))[1] for one in (elsewhere, nowhere)]
    assert bests[0] == bests[1]


@BOTH
def test_a_transition_to_where_no_ant_may_go_is_refused(jit: bool) -> None:
    def blind(choice):  # type: ignore[no-untyped-def]
        return 0

    assert "weight is 0" in str(wrong(TransitionPart, blind, jit=jit))


def test_what_cannot_be_compiled_says_why() -> None:
    def dreams(ants):  # type: ignore[no-untyped-def]
        ants.dreams[0] = 1

    error = wrong(PheromonePart, dreams, jit=True)
    assert "cannot be compiled" in str(error)
    assert "jit=True" in str(error)


def test_an_own_rule_in_both_halves_of_paco_and_in_other_processes() -> None:
    usual = an.paco(pheromone="rank_based", iterations=20)
    mine = replace(usual, pheromone=own(PheromonePart, ranked, **ELITE))
    one, other = an.solve(problem(), usual, seed=4), an.solve(problem(), mine, seed=4)
    assert one.history.best.tolist() == other.history.best.tolist()
    assert one.path is not None
    assert other.path is not None
    assert np.array_equal(one.path.cells, other.path.cells)


def test_large_maps_too() -> None:
    """Above so many cells built-in rules work on rows that ants come to; an own one sees all of tau."""
    where = an.Problem.from_cells(an.maps.generate("random", 80, 80, density=0.2, seed=1), (0, 0), (79, 79))
    usual = an.npaco(pheromone="rank_based", heuristic="detour", ants=10, iterations=8)
    mine = replace(usual, pheromone=own(PheromonePart, ranked, **ELITE))
    assert len(where.graph) > 4_000
    assert outcome(mine, where=where) == outcome(usual, where=where)


def imitating(ants):  # type: ignore[no-untyped-def]
    best = ants.order[0]
    for rank in range(1, ants.arrived):
        ant = ants.order[rank]
        ants.steps[ant] = ants.steps[best]
        for s in range(ants.steps[best] + 1):
            ants.paths[ant, s] = ants.paths[best, s]


@BOTH
def test_a_local_search_changes_paths_which_are_then_measured_and_ranked_anew(jit: bool) -> None:
    mine = replace(an.npaco(ants=20, iterations=3), local_search=own(LocalSearchPart, imitating, jit=jit))
    colony = an.Colony(problem(), mine, seed=3)
    colony.step()
    view, arrived = colony.view(), [ant for ant in colony.ants() if ant.length < math.inf]
    assert len(arrived) > 5
    assert len({ant.length for ant in arrived}) == 1
    assert len({ant.cells.tobytes() for ant in arrived}) == 1
    assert view.order.tolist() == sorted(view.order.tolist())  # equal lengths stay in ant order
    best = colony.best_path(problem())
    assert best is not None
    an.check_path(best, problem())
    assert best.length == arrived[0].length


@BOTH
def test_a_local_search_that_does_nothing_changes_nothing(jit: bool) -> None:
    def idle(ants):  # type: ignore[no-untyped-def]
        ants.notes[0] += 1.0

    usual = an.npaco(ants=20, iterations=10)
    assert outcome(replace(usual, local_search=own(LocalSearchPart, idle, jit=jit))) == outcome(usual)


def _jumps(ants):  # type: ignore[no-untyped-def]
    ants.steps[ants.order[0]] = 1
    ants.paths[ants.order[0], 1] = ants.goal


def _turns_back(ants):  # type: ignore[no-untyped-def]
    ant = ants.order[0]
    for s in range(ants.steps[ant], -1, -1):
        ants.paths[ant, s + 2] = ants.paths[ant, s]
    ants.paths[ant, 1] = ants.paths[ant, 3]
    ants.steps[ant] += 2


def _leaves(ants):  # type: ignore[no-untyped-def]
    ants.paths[ants.order[0], 1] = 10**6


def _has_no_end(ants):  # type: ignore[no-untyped-def]
    ants.steps[ants.order[0]] = 10**6


@BOTH
@pytest.mark.parametrize("function", [_jumps, _turns_back, _leaves, _has_no_end])
def test_a_local_search_that_breaks_a_path_is_refused(function: Any, jit: bool) -> None:
    algorithm = replace(an.npaco(ants=20), local_search=own(LocalSearchPart, function, jit=jit))
    with pytest.raises(RuleError, match=f"local search rule {function.__name__}.*edge by edge and nowhere twice"):
        an.solve(problem(), algorithm, seed=1)


@BOTH
def test_a_local_search_may_not_send_ants_off_the_map_that_did_not_arrive(jit: bool) -> None:
    def sends(ants):  # type: ignore[no-untyped-def]
        for ant in range(ants.fates.size):
            if ants.fates[ant] != 1:
                ants.paths[ant, 0] = 10**6

    algorithm = replace(an.npaco(ants=20), local_search=own(LocalSearchPart, sends, jit=jit))
    with pytest.raises(RuleError, match="did not arrive, has left the map"):
        an.solve(problem(), algorithm, seed=1)


def _too_far(ants):  # type: ignore[no-untyped-def]
    for rank in range(1000):
        ants.amounts[rank] = 1.0


def _too_far_ahead(choice):  # type: ignore[no-untyped-def]
    return int(choice.weights[choice.steps + 100])


def _too_far_back(stuck):  # type: ignore[no-untyped-def]
    return stuck.notes[1000] > 0


def _by_hand(ants):  # type: ignore[no-untyped-def]
    raise ValueError("no")


@pytest.mark.parametrize(
    ("kind", "function"),
    [
        (PheromonePart, _too_far),
        (PheromonePart, _by_hand),
        (TransitionPart, _too_far_ahead),
        (DeadlockPart, _too_far_back),
    ],
)
def test_a_compiled_rule_that_raises_or_leaves_its_arrays_ends_the_run_and_not_the_process(
    kind: type[Part], function: Any, capfd: pytest.CaptureFixture[str]
) -> None:
    error = wrong(kind, function, jit=True)
    assert f"rule {function.__name__} (test_own.py): it raised an error" in str(error)
    assert "without jit=True" in str(error)
    assert capfd.readouterr().err == ""


def test_a_compiled_rule_that_writes_to_the_best_path_is_found_out() -> None:
    def forger(ants):  # type: ignore[no-untyped-def]
        if ants.t == ants.iterations:
            ants.best_path[1] = ants.goal

    assert "the best path, to which no rule may write" in str(wrong(PheromonePart, forger, jit=True))
