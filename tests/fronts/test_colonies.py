"""Colonies: legal paths with the values that the instance says, exact fronts of small maps, the same whoever works."""

from __future__ import annotations

import threading
from concurrent.futures import Executor, ThreadPoolExecutor

import numpy as np
import pytest

import antnav as an
from antnav import fronts
from antnav.errors import ParameterError
from antnav.fronts import archive as archives
from antnav.run.spmd import Processes, Serial
from antnav.run.stop import Iterations
from tests.fronts.instances import BLIND_FRONT, BLIND_OBJECTIVES, BLIND_PROBLEM, drawn

BRIEF = fronts.Colonies(rounds=2, colonies=3, ants=20, known=20, pairs=20)


@pytest.mark.parametrize("k", [2, 3, 4, 5])
def test_many_walks_find_the_exact_front_of_a_small_map(k: int) -> None:
    problem, asked = drawn(12, k, k)
    exact = an.pareto(problem, asked, algorithm="exact")
    found = an.pareto(problem, asked, algorithm=fronts.Colonies(rounds=60), seed=k)
    assert exact.complete
    np.testing.assert_allclose(found.values, exact.values)
    for path in found.paths:
        an.check_path(path, problem)
        assert len(np.unique(path.cells, axis=0)) == len(path.cells)


def test_ants_see_what_no_weighted_sum_sees() -> None:
    """See the map: the sweep misses the second way."""
    for method, missing in (("exact", []), ("ants", []), (fronts.Sweep(1000), [1])):
        front = an.pareto(BLIND_PROBLEM, BLIND_OBJECTIVES, algorithm=method)
        expected = [values for number, values in enumerate(BLIND_FRONT) if number not in missing]
        np.testing.assert_allclose(front.values, expected)


def same(one: fronts.Front, other: fronts.Front) -> bool:
    return (
        one.work == other.work
        and one.values.tobytes() == other.values.tobytes()
        and all(np.array_equal(a.cells, b.cells) for a, b in zip(one.paths, other.paths, strict=True))
    )


def test_a_seed_is_the_same_front_whoever_works() -> None:
    problem, asked = drawn(24, 3, 4)
    fronts_found = [an.pareto(problem, asked, algorithm=BRIEF, seed=5)]
    workers: list[Executor] = [Serial(), ThreadPoolExecutor(3), Processes(2)]
    for executor in workers:
        with executor:
            fronts_found.append(an.pareto(problem, asked, algorithm=BRIEF, seed=5, executor=executor))
    assert all(same(fronts_found[0], other) for other in fronts_found[1:])
    assert not same(fronts_found[0], an.pareto(problem, asked, algorithm=BRIEF, seed=6))


def test_it_ends_when_it_is_told_to() -> None:
    problem, asked = drawn(16, 1, 3)
    front = an.pareto(problem, asked, algorithm="ants", stop=Iterations(2))
    assert front.stopped_by == "criterion"
    assert front.work["searches"] == 2 * fronts.Colonies().colonies + 3
    cancel = threading.Event()
    cancel.set()
    front = an.pareto(problem, asked, algorithm="ants", cancel=cancel)
    assert (front.stopped_by, front.work["walks"]) == ("cancelled", 0)
    assert len(front) >= 1  # the best path of each objective


def test_a_full_archive_gets_coarser() -> None:
    problem, asked = drawn(24, 3, 4)
    fine = an.pareto(problem, asked, algorithm=fronts.Colonies(rounds=4))
    coarse = an.pareto(problem, asked, algorithm=fronts.Colonies(rounds=4, size=50))
    assert 10 <= len(coarse) <= 50 < len(fine)
    assert any("too many paths to keep" in note for note in coarse.notes)
    assert not fine.notes


@pytest.mark.parametrize("name", ["rounds", "colonies", "ants", "known", "pairs", "alpha", "size"])
def test_parameters_out_of_range_are_refused(name: str) -> None:
    with pytest.raises(ParameterError, match=name):
        fronts.Colonies(**{name: -1})


def test_an_archive_that_paths_fill_gets_coarser_and_does_not_hang() -> None:
    ranges = np.array([10, 10])
    kept = archives.empty(100, 50, ranges, np.zeros(2, np.int64))
    values = np.array([[1, 3], [2, 2], [3, 1]])
    kept = archives.taken(kept, (values, np.full(3, 20, np.int32), np.zeros(60, np.int32)), 100)
    assert kept.tolerance.any()
    assert 1 <= len(archives.split(kept)) <= 2
    none = archives.empty(100, 10, ranges, np.zeros(2, np.int64))
    with pytest.raises(ParameterError, match="no room"):
        archives.taken(none, (values, np.full(3, 20, np.int32), np.zeros(60, np.int32)), 100)
