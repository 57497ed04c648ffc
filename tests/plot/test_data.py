"""What figures show is checked by value, without drawing."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import antnav as an
from antnav import plot
from antnav.plot.data import CELL_COLOURS
from tests.plot.samples import with_history

INF, NAN = math.inf, math.nan


def test_convergence_is_the_history(undivided):
    data = plot.convergence(undivided)
    assert data.iteration.tolist() == list(range(1, 13))
    for name in ("best", "iteration_best", "mean"):
        np.testing.assert_array_equal(getattr(data, name), getattr(undivided.history, name))
    assert (data.stage_one, data.divided, data.stages) == (0, False, [slice(0, 12)])
    assert (data.optimum, data.length) == (undivided.optimum, undivided.length)


def test_convergence_has_nan_before_the_first_arrival(undivided):
    result = with_history(undivided, [INF, INF, 20, 19], [INF, INF, 20, 19], [NAN, NAN, 25, 24], [("whole map", 4)])
    data = plot.convergence(result)
    np.testing.assert_array_equal(data.best, [NAN, NAN, 20, 19])
    np.testing.assert_array_equal(data.iteration_best, [NAN, NAN, 20, 19])
    np.testing.assert_array_equal(data.mean, [NAN, NAN, 25, 24])


def test_convergence_knows_the_stages(divided):
    data = plot.convergence(divided)
    assert (data.stage_one, data.divided) == (3, True)
    assert data.stages == [slice(0, 3), slice(3, 12)]


@pytest.mark.parametrize(
    ("stages", "stage_one", "divided_"),
    [
        ([("stage one", 3, 3), ("stage one", 4, 5), ("stage two", 1, 2)], 5, True),  # the first attempt left no history
        ([("stage one", 7, 7)], 7, False),  # ended after stage one
        ([("stage one", 3, 3), ("whole map", 7)], 0, False),  # fell back to one colony
        ([("whole map", 7)], 0, False),
    ],
)
def test_convergence_of_unusual_runs(undivided, stages, stage_one, divided_):
    data = plot.convergence(with_history(undivided, [20.0] * 7, [21.0] * 7, [22.0] * 7, stages))
    assert (data.stage_one, data.divided) == (stage_one, divided_)
    assert sum(part.stop - part.start for part in data.stages) == 7


def test_convergence_without_iterations(unreachable, same_cell):
    assert plot.convergence(unreachable).optimum == INF
    for result in (unreachable, same_cell):
        data = plot.convergence(result)
        assert data.stages == []
        assert data.best.size == 0


def test_heat_is_logarithmic_between_a_hundredth_and_the_most(undivided):
    field = np.full(undivided.problem.grid.shape, 0.001, np.float32)
    field[0, :4] = (10.0, 1.0, 0.1, 0.05)
    field[:, 6] = NAN
    heat = plot.heat(replace(undivided, heat=lambda: field))
    np.testing.assert_allclose(heat.shade[0, :4], (1, 0.5, 0, 0), atol=1e-6)
    assert heat.shade[1:].max() == 0
    assert heat.label == "pheromone, 0.1 to 10 (log)"


def test_heat_begins_at_the_median_where_that_is_more(undivided):
    field = np.full(undivided.problem.grid.shape, 1.0, np.float32)
    field[0, :3] = (4.0, 2.0, 0.5)
    np.testing.assert_allclose(plot.heat(replace(undivided, heat=lambda: field)).shade[0, :3], (1, 0.5, 0), atol=1e-6)


@pytest.mark.parametrize("value", [None, NAN, 1.0, 0.0])
def test_no_heat_where_pheromone_says_nothing(undivided, value):
    field = np.full(undivided.problem.grid.shape, value or 0.0, np.float32)
    assert plot.heat(replace(undivided, heat=None if value is None else lambda: field)) is None


def test_heat_of_an_unreachable_goal_is_what_can_be_reached(unreachable):
    heat = plot.heat(unreachable)
    np.testing.assert_array_equal(heat.shade > 0, unreachable.problem.reachable)
    assert heat.even


def test_map_colours_tell_the_kinds_apart():
    grid = an.GridMap([[0, 1, 2, 3]])
    colours = plot.map_colours(grid)
    assert colours.shape == (1, 4, 3)
    np.testing.assert_array_equal(colours[0], CELL_COLOURS)
    free, wall, unknown, inflated = colours[0] @ (0.299, 0.587, 0.114)
    assert free > unknown + 15 > inflated + 30 > wall + 100  # in grey print too


def test_map_colours_are_shaded_towards_blue():
    grid = an.GridMap([[0, 0, 0, 1]])
    shade = np.array([[0, 0.5, 1, 0]], np.float32)
    colours = plot.map_colours(grid, plot.Heat(shade, ""))
    sky_blue, blue, wall = (86, 180, 233), (0, 114, 178), CELL_COLOURS[an.Cell.OCCUPIED]
    np.testing.assert_array_equal(colours[0], [(255, 255, 255), sky_blue, blue, wall])
