"""Rules of every kind that a kernel calls, and cuts: registered by their decorators, chosen by name."""

from __future__ import annotations

import pickle
from typing import Any

import numba
import numpy as np
import pytest

import antnav as an
from antnav.colony.parameters import RULES
from antnav.errors import ParameterError, RuleError
from antnav.planner.facts import Knows

PROBLEM = an.Problem.from_cells(an.maps.builtin("equiv20"), (0, 0), (19, 19))


def deposits(ants, top=3):  # type: ignore[no-untyped-def]
    """The best few."""
    for rank in range(min(top, ants.arrived)):
        ants.amounts[rank] = ants.q / ants.costs[ants.order[rank]]


def likeliest(choice):  # type: ignore[no-untyped-def]
    return np.argmax(choice.weights * (0.5 + choice.draws[0]))


FUNCTIONS: dict[str, Any] = {
    "pheromone": deposits,
    "transition": likeliest,
    "deadlock": lambda stuck: stuck.backs > 2,
    "local_search": lambda ants: None,
}


@pytest.mark.parametrize("kind", FUNCTIONS)
def test_every_kind_works_by_name_and_is_the_same_after_a_journey(kind: str) -> None:
    part = getattr(an.register, kind)(FUNCTIONS[kind], name="mine", version="7")
    algorithm = an.npaco(ants=9, iterations=4, **{kind: "mine"})
    assert algorithm == an.npaco(ants=9, iterations=4, **{kind: part})
    assert algorithm.document()[kind] == "mine"
    assert algorithm.document()["own"][kind]["version"] == "7"
    assert "own rule mine (test_kinds.py, 7)" in str(algorithm.certainty)
    assert an.Algorithm.of(algorithm.document()) == algorithm
    length = an.solve(PROBLEM, algorithm, seed=2).length
    RULES[kind].registered.clear()  # as in another process
    assert an.solve(PROBLEM, pickle.loads(pickle.dumps(algorithm)), seed=2).length == length


def test_a_function_that_numba_has_compiled_is_compiled() -> None:
    assert an.register.pheromone(numba.njit(deposits)).jit
    assert not an.register.pheromone(deposits).jit
    assert an.register.pheromone(jit=True)(deposits).jit


def test_ranges_of_parameters_hold() -> None:
    share = an.register.pheromone(lambda ants, top=an.parameter(3, least=1, most=50): None, name="share")
    with pytest.raises(ParameterError, match="top 51: top is a whole number from 1 to 50"):
        an.npaco(pheromone="share", top=51)
    with pytest.raises(ParameterError, match="top 5 with pheromone reward_and_punish: top belongs to pheromone share"):
        an.npaco(top=5)
    with pytest.raises(ParameterError, match=r"top of own rule other .*belongs to pheromone share"):
        an.register.deadlock(lambda stuck, top=3: True, name="other")
    assert share(top=5).top == 5


def halves(ground, paths, pieces, shift=0):  # type: ignore[no-untyped-def]
    """Nodes at equal steps of the best path of stage one."""
    best = paths[0]
    return best[[len(best) * k // pieces + shift for k in range(1, pieces)]]


def test_own_cuts_divide_the_way() -> None:
    seen: list[Any] = []

    @an.register.cuts
    def spied(ground, paths, pieces):  # type: ignore[no-untyped-def]
        seen.append((ground, paths))
        return halves(ground, paths, pieces)

    algorithm = an.paco(cuts="spied", pieces=3, iterations=20)
    result = an.solve(PROBLEM, algorithm, seed=1)
    assert result.path is not None
    assert len(result.stages[1].colonies) == 3
    ((ground, paths),) = seen
    assert all((path[0], path[-1]) == (ground.start, ground.goal) for path in paths)
    assert not any(path.flags.writeable for path in paths)
    steps = an.Steps(PROBLEM, algorithm, seed=1)
    assert [step.stage for step in steps].count("stage two") == 17
    assert steps.result.length == result.length


def test_parameters_of_cuts_stand_with_the_decomposition() -> None:
    an.register.cuts(halves)
    algorithm = an.paco(cuts="halves", shift=1)
    assert algorithm.decomposition.cuts.shift == 1
    document = algorithm.document()
    assert document["decomposition"]["cuts"] == "halves"
    assert document["decomposition"]["shift"] == 1
    assert "shift" not in document
    assert an.Algorithm.of(document) == algorithm
    assert algorithm.changed(shift=2).decomposition.cuts.shift == 2
    assert algorithm.changed(cuts="line").decomposition == an.paco().decomposition
    assert str(algorithm.certainty).endswith("modified: cuts halves, shift 1; own rule halves (test_kinds.py)")
    with pytest.raises(ParameterError, match="shift belongs to cuts halves"):
        an.npaco(shift=1)
    with pytest.raises(ParameterError, match="give search whole"):
        an.paco_extended(cuts="halves")
    with pytest.raises(ParameterError, match="it is one of line, levels, halves"):
        an.paco(cuts="thirds")
    assert pickle.loads(pickle.dumps(algorithm)) == algorithm


def test_cuts_that_ask_for_distances_know_them() -> None:
    an.register.cuts(lambda ground, paths, pieces: [np.argmax(ground.distances_to(0))], name="far")
    assert an.paco(cuts="far").knows == Knows.FROM_START


@pytest.mark.parametrize(
    "returned",
    [
        lambda ground, paths, pieces: [ground.start],
        lambda ground, paths, pieces: [5, 5],
        lambda ground, paths, pieces: [len(ground)],
        lambda ground, paths, pieces: [2.5],
        lambda ground, paths, pieces: np.arange(1, 65),
        lambda ground, paths, pieces: None,
    ],
)
def test_what_cuts_return_is_checked(returned: object) -> None:
    an.register.cuts(returned, name="bad")
    with pytest.raises(RuleError, match=r"own rule bad .* it returns up to 63 different nodes"):
        an.solve(PROBLEM, an.paco(cuts="bad"))


def test_cuts_may_leave_the_way_whole() -> None:
    an.register.cuts(lambda ground, paths, pieces: [], name="none-at-all")
    result = an.solve(PROBLEM, an.paco(cuts="none-at-all"), seed=1)
    assert result.auxiliary_cell is None
    assert result.path is not None
    an.check_path(result.path, PROBLEM)
