"""Record: what is kept of a run, and what is not."""

from __future__ import annotations

import antnav as an
from antnav import maps
from antnav.study.record import Record
from antnav.study.runner import without_times
from tests.conftest import grid_of


def record_of(result: an.Result) -> Record:
    return Record.of(result, key="key", map_label="map", algorithm_label="label")


def test_lengths_of_an_undivided_run_are_kept_by_iteration() -> None:
    problem = an.Problem.from_cells(grid_of("....", ".##.", "...."), (0, 0), (2, 3))
    result = an.solve(problem, an.npaco(ants=5, iterations=4), seed=1)
    record = record_of(result)
    assert record.best == tuple(result.history.best.tolist())
    assert (record.length, record.gap, record.walks) == (result.length, result.gap, 20)
    assert (record.key, record.map, record.algorithm, record.seed) == ("key", "map", "label", 1)


def test_estimates_on_a_graph_of_regions_are_not_kept() -> None:
    grid = maps.generate("caves", 40, 40, seed=2)
    problem = an.Problem.from_cells(grid, *maps.ends(grid))
    result = an.solve(problem, an.paco_large(coarse=8, ants=5, iterations=3), seed=5)
    record = record_of(result)
    assert result.length < float("inf")
    assert [stage.name for stage in result.stages].count("regions") == 1
    assert record.best == (None,) * result.iterations == (None,) * 3
    assert record.length == result.length
    assert without_times(record) == without_times(record_of(an.solve(problem, result.algorithm, seed=5)))
