"""plan: every rival by one set of rules, whatever it does inside."""

from __future__ import annotations

import math
import subprocess
import sys
import threading
from dataclasses import replace
from importlib.util import find_spec
from typing import Any

import numpy as np
import pytest

import antnav as an
from antnav import rivals
from antnav.errors import ParameterError
from antnav.planner.plan import StoppedBy
from antnav.rivals import RIVALS, Metaheuristic, PotentialField, Rival
from antnav.run.stop import Iterations
from antnav.study.record import Record
from tests.conftest import grid_of
from tests.rivals.test_encoding import RULES, TRAP, TRAP_ENDS, random_problem

needs_pygmo = pytest.mark.skipif(find_spec("pygmo") is None, reason="pygmo is not installed (extra `rivals`)")


def marks(rival: Rival) -> list[pytest.MarkDecorator]:
    return [needs_pygmo] if isinstance(rival, Metaheuristic) and rival.method.from_pygmo else []


every_rival = pytest.mark.parametrize(
    "name", [pytest.param(name, marks=marks(rival)) for name, rival in RIVALS.items()]
)
every_method = pytest.mark.parametrize(
    "method", [pytest.param(method, marks=marks(Metaheuristic(method=method))) for method in rivals.Method]
)


def small(name: str) -> Rival:
    """The rival with a small budget."""
    rival = RIVALS[name]
    return replace(rival, points=3, population=20, evaluations=1000) if isinstance(rival, Metaheuristic) else rival


def outcome(result: an.Result) -> dict[str, object]:
    document = {name: value for name, value in result.to_dict().items() if "seconds" not in name}
    return document | {"stages": result.steps}


@every_rival
@pytest.mark.parametrize("rule", RULES)
def test_paths_are_valid_and_seeds_decide(name: str, rule: str) -> None:
    problem = random_problem(2, rule)
    results = [an.solve(problem, small(name), seed=seed) for seed in (0, 1, 2**64 - 1)]
    for result in results:
        best = result.history.best
        assert np.all(best[1:] <= best[:-1])
        assert result.status is (an.Status.FOUND if result.path else an.Status.NO_PATH)
        if result.path is None:
            assert result.notes
        else:
            assert an.check_path(result.path, problem) == pytest.approx(result.length) == best[-1]
            assert result.length >= result.optimum - 1e-9
    assert outcome(results[2]) == outcome(an.solve(problem, small(name), seed=2**64 - 1))
    assert any(result.path for result in results)


@every_method
def test_seeds_differ(method: rivals.Method) -> None:
    problem = random_problem(2, "allow")
    rival = small(f"{method}-straight")
    histories = {tuple(an.solve(problem, rival, seed=seed).history.best) for seed in range(5)}
    assert len(histories) > 1


@every_rival
def test_ends_that_need_no_search(name: str) -> None:
    apart = an.Problem.from_cells(grid_of(".#."), (0, 0), (0, 2))
    result = an.solve(apart, small(name))
    assert (result.status, result.path, result.steps) == (an.Status.UNREACHABLE, None, 0)
    same = an.Problem.from_cells(grid_of(".#."), (0, 0), (0, 0))
    result = an.solve(same, small(name))
    assert (result.status, result.length, result.gap) == (an.Status.FOUND, 0.0, 0.0)


def test_the_gap_is_a_share_of_the_optimum() -> None:
    """Three moves to and fro, where one would do."""
    problem = an.Problem.from_cells(grid_of(".."), (0, 0), (0, 1))
    to_and_fro = an.Path(np.array([(0, 0), (0, 1), (0, 0), (0, 1)], np.int32), problem.grid)
    result = replace(an.solve(problem, PotentialField()), path=to_and_fro)
    assert (result.length, result.optimum, result.gap) == (3.0, 1.0, 2.0)
    assert math.isnan(replace(result, path=None).gap)


@every_rival
def test_a_record_takes_a_rival(name: str) -> None:
    result = an.solve(random_problem(2, "allow"), small(name))
    record = Record.of(result, key="k", map_label="m", algorithm_label=name)
    assert (record.status, record.steps, record.iterations) == (result.status, result.steps, len(record.best))
    assert record.length == (result.length if result.path else None)
    assert str(record.certainty) == RIVALS[name].certainty


@every_rival
def test_stop_and_cancel(name: str) -> None:
    problem = an.Problem.from_cells(TRAP, *TRAP_ENDS)
    result = an.solve(problem, small(name), stop=Iterations(1))
    assert (result.stopped_by, result.iterations) == (StoppedBy.CRITERION, 1)
    assert (result.status is an.Status.FOUND) == (result.path is not None)
    cancel = threading.Event()
    cancel.set()
    assert an.solve(problem, small(name), cancel=cancel).stopped_by is StoppedBy.CANCELLED


@every_method
def test_straight_lines_fail_in_the_trap_and_exact_ones_succeed(method: rivals.Method) -> None:
    problem = an.Problem.from_cells(TRAP, *TRAP_ENDS)
    rival = Metaheuristic(method=method, points=1, population=20, evaluations=1000)
    result = an.solve(problem, rival)
    assert result.status is an.Status.NO_PATH
    assert "vectors was feasible" in result.notes[0]
    assert 800 <= result.steps <= rival.evaluations
    assert result.iterations == result.steps // rival.population
    result = an.solve(problem, replace(rival, segments="exact"))
    assert result.length == pytest.approx(result.optimum)


def test_without_pygmo_the_remedy_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pygmo", None)
    with pytest.raises(ParameterError, match=r"antnav\[rivals\]"):
        an.solve(random_problem(2, "allow"), RIVALS["ga-exact"])


@pytest.mark.parametrize("name", ["woa-exact", "sma-straight", "mfo-exact", "hho-straight"])
def test_own_swarms_need_no_pygmo(monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    monkeypatch.setitem(sys.modules, "pygmo", None)
    result = an.solve(random_problem(2, "allow"), small(name))
    assert result.steps == 1000
    assert "pygmo" not in result.versions


def test_the_import_brings_nothing_heavy() -> None:
    script = "import sys, antnav.rivals; print([m for m in ('pygmo', 'scipy.ndimage') if m in sys.modules])"
    assert subprocess.run([sys.executable, "-c", script], check=True, capture_output=True, text=True).stdout == "[]\n"


@pytest.mark.parametrize(
    "arguments",
    [
        {"method": "ants"},
        {"method": "ga", "segments": "curved"},
        {"method": "ga", "points": 0},
        {"method": "ga", "penalty": -1},
        {"method": "ga", "population": 5},
        {"method": "ga", "population": 50, "evaluations": 100},
        {"method": "ga", "points": 1.5},
        {"method": "ga", "points": True},
        {"method": "ga", "penalty": "3"},
        {"method": "ga", "penalty": float("inf")},
        {"method": "ga", "population": "x"},
        {"method": "ga", "population": 10**5000},
        {"method": "ga", "evaluations": 1000.5},
        {"method": "ga", "evaluations": None},
    ],
)
def test_metaheuristics_refuse_what_they_cannot_do(arguments: dict[str, Any]) -> None:
    with pytest.raises(ParameterError):
        Metaheuristic(**arguments)


@pytest.mark.parametrize(
    "arguments",
    [
        {"attraction": 0},
        {"attraction": "1"},
        {"repulsion": -1},
        {"repulsion": None},
        {"reach": 1},
        {"reach": float("nan")},
        {"escapes": -1},
        {"escapes": 2.5},
        {"walk": 0},
        {"walk": 2.5},
        {"walk": True},
    ],
)
def test_potential_fields_refuse_what_they_cannot_do(arguments: dict[str, Any]) -> None:
    with pytest.raises(ParameterError):
        PotentialField(**arguments)
