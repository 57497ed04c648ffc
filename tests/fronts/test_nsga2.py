"""NSGA-II on control points: its paths, its account, what it refuses."""

from __future__ import annotations

import sys
import threading
from typing import Any

import numpy as np
import pytest

import antnav as an
from antnav import costs, objectives
from antnav.errors import ParameterError
from antnav.fronts import Nsga2
from antnav.fronts.pareto import warmup
from antnav.run.stop import Iterations
from tests.conftest import grid_of

HALL = grid_of("..........", "....##....", "..#.##....", "..........", "....#.....", "..........")
PROBLEM = an.Problem.from_cells(HALL, (0, 0), (0, 9))
ASKED = [objectives.Length(), objectives.Risk(costs.clearance(HALL, 2.0, 3.0))]
QUICK = Nsga2(points=3, population=40, generations=20)


@pytest.fixture
def pygmo() -> Any:
    return pytest.importorskip("pygmo")


@pytest.mark.usefixtures("pygmo")
def test_no_path_of_it_beats_the_exact_front_and_most_of_that_is_found() -> None:
    exact = an.pareto(PROBLEM, ASKED, algorithm="exact")
    front = an.pareto(PROBLEM, ASKED, algorithm=QUICK)
    for path, values in zip(front.paths, front.values, strict=True):
        an.check_path(path, PROBLEM)
        assert any((other <= values + 1e-9).all() for other in exact.values)
    np.testing.assert_allclose(front.values[0], exact.values[0])  # the shortest
    assert len(front) > 1
    assert not front.complete


def test_the_same_seed_gives_the_same_and_the_library_is_named(pygmo: Any) -> None:
    first, second, other = (an.pareto(PROBLEM, ASKED, algorithm=QUICK, seed=seed) for seed in (3, 3, 4))
    assert first.values.tobytes() == second.values.tobytes()
    assert [path.cells.tolist() for path in first.paths] == [path.cells.tolist() for path in second.paths]
    assert [path.cells.tolist() for path in first.paths] != [path.cells.tolist() for path in other.paths]
    assert first.work == {"evaluations": 1 + 40 * 21}
    assert first.versions["pygmo"] == pygmo.__version__
    assert "Deb, Pratap, Agarwal & Meyarivan 2002" in first.certainty


@pytest.mark.usefixtures("pygmo")
def test_more_generations_lose_nothing() -> None:
    few, many = (an.pareto(PROBLEM, ASKED, algorithm=QUICK, stop=Iterations(count)) for count in (3, 10))
    assert few.stopped_by == "criterion"
    assert few.work["evaluations"] == 1 + 40 * 3
    for values in few.values:
        assert any((other <= values).all() for other in many.values)


@pytest.mark.usefixtures("pygmo")
def test_ended_before_it_began_it_has_the_shortest_path() -> None:
    cancel = threading.Event()
    cancel.set()
    front = an.pareto(PROBLEM, ASKED, algorithm=QUICK, cancel=cancel)
    assert (front.stopped_by, front.work, len(front)) == ("cancelled", {"evaluations": 1}, 1)
    assert front.paths[0].length == pytest.approx(an.exact.optimum(PROBLEM).length)
    there = an.pareto(an.Problem.from_cells(HALL, (0, 0), (0, 0)), ASKED, algorithm=QUICK)
    assert there.values.tolist() == [[0.0, 0.0]]


@pytest.mark.parametrize(
    "given",
    [
        {"points": 0},
        {"points": 1.5},
        {"population": 4},
        {"population": 42},
        {"population": True},
        {"generations": -1},
        {"generations": 10**7},
    ],
)
def test_parameters_out_of_range_are_refused(given: dict[str, Any]) -> None:
    with pytest.raises(ParameterError, match=next(iter(given))):
        Nsga2(**given)


def test_without_pygmo_the_remedy_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pygmo", None)
    with pytest.raises(ParameterError, match=r"antnav\[rivals\]"):
        an.pareto(PROBLEM, ASKED, algorithm="nsga2")
    warmup()  # of the others
