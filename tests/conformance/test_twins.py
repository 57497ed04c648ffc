"""A rule against its slow twin: equal to the last bit, or told where they differ."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import antnav as an
from antnav.errors import ParameterError
from antnav.testing import assert_twin


def share(ants, top=an.parameter(3, least=1, most=50)):
    """The best few deposit."""
    best = ants.order[: min(top, ants.arrived)]
    ants.amounts[: best.size] = ants.q / ants.costs[best]


SAME = "@an.register.initial\ndef {}(ground):\n    return 2.0\n"


def one_by_one(ants, top):
    for rank in range(min(top, ants.arrived)):
        ants.amounts[rank] = ants.q / ants.costs[ants.order[rank]]


def one_more(ants, top):
    one_by_one(ants, top + (ants.t > 2))


@pytest.mark.parametrize("jit", [False, True])
def test_a_pheromone_rule(jit: bool) -> None:
    rule = an.register.pheromone(share, jit=jit)
    assert_twin(rule, one_by_one)
    assert_twin(rule(top=7), one_by_one)
    with pytest.raises(AssertionError, match=r"on map open, seed 0, iteration 3, pheromone, place \(\d+, \d\): "):
        assert_twin(rule, one_more)


def test_a_heuristic_of_another_last_bit() -> None:
    def cells(ground):
        """By column."""
        return 1 / (1 + ground.cells[:, 1])

    def almost(ground):
        return np.nextafter(cells(ground), 2)

    rule = an.register.heuristic(cells)
    assert_twin(rule, cells)
    with pytest.raises(AssertionError, match="on map open"):
        assert_twin(rule, almost)


def test_algorithms_and_cuts_by_their_outcomes() -> None:
    def few(**choices):
        """Few ants in two stages."""
        return an.paco(ants=5, **choices)

    made = an.register.algorithm(few)
    assert_twin(made, lambda: an.paco(ants=5))
    with pytest.raises(AssertionError, match="outcomes differ, a path of cost"):
        assert_twin(made, lambda: an.paco(ants=6))


def test_objectives_by_their_prices() -> None:
    class Diagonals(an.objectives.Objective):
        """Diagonal moves."""

        name = "diagonals"

        def edges(self, terrain: Any, graph: Any) -> Any:
            return graph.graph.lengths > 1

    class Twice(Diagonals):
        def edges(self, terrain: Any, graph: Any) -> Any:
            return 2.0 * (graph.graph.lengths > 1)

    kind = an.register.objective(Diagonals)
    assert_twin(kind, Diagonals)
    with pytest.raises(AssertionError, match="on map open, prices of moves, place"):
        assert_twin(kind, Twice)


def test_one_of_a_file(tmp_path: Path) -> None:
    file = tmp_path / "mine.py"
    file.write_text("import antnav as an\n\n" + "".join(SAME.format(name) for name in ("one", "other")))
    assert_twin(f"{file}:one", lambda ground: 2.0)
    with pytest.raises(ParameterError, match="rules one and other"):
        assert_twin(file, lambda ground: 2.0)


def test_what_is_no_twin() -> None:
    with pytest.raises(ParameterError, match="twin 3"):
        assert_twin(an.register.pheromone(share), 3)


def test_a_twin_of_other_parameters() -> None:
    def waiting(ants, patience=an.parameter(5, least=1), half=an.parameter(2.0, least=0)):
        """Nothing."""

    with pytest.raises(ParameterError, match="the twin takes top, the rule patience, half; give it the arguments"):
        assert_twin(an.register.pheromone(waiting), one_by_one)
    with pytest.raises(ParameterError, match="the twin takes no parameters, the rule top"):
        assert_twin(an.register.pheromone(share), lambda ants: None)
