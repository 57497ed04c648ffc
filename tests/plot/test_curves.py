"""Curves show the history, each stage by itself; scales fit; an empty panel says why."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import antnav as an
from antnav import plot
from tests.plot.samples import line, plan, stairs, texts, two_rooms, with_history

pytest.importorskip("matplotlib").use("Agg")

INF, NAN = math.inf, math.nan


def test_plot_convergence_shows_the_history(undivided):
    ax = plot.plot_convergence(undivided)
    data = plot.convergence(undivided)
    (best,) = stairs(ax)
    np.testing.assert_array_equal(best.get_data().values, data.best)
    np.testing.assert_array_equal(best.get_data().edges, np.arange(13) + 0.5)
    np.testing.assert_array_equal(line(ax, "best of the iteration").get_ydata(), data.iteration_best)
    (mean,) = [line for line in ax.lines if line.get_label().startswith("mean of the arrived ants")]
    np.testing.assert_array_equal(mean.get_ydata(), data.mean)
    assert set(line(ax, f"exact optimum: {data.optimum:.4f}").get_ydata()) == {data.optimum}
    returned = line(ax, f"path returned: {data.length:.4f}")
    assert (returned.get_xdata()[0], returned.get_ydata()[0]) == (12.5, data.length)
    assert "stage" not in texts(ax.figure)


def test_plot_convergence_marks_the_stages_and_joins_none(divided):
    ax = plot.plot_convergence(divided)
    first, second = stairs(ax)
    np.testing.assert_array_equal(first.get_data().values, divided.history.best[:3])
    np.testing.assert_array_equal(second.get_data().values, divided.history.best[3:])
    assert second.get_data().edges[0] == 3.5
    shown = texts(ax.figure)
    assert "stage one: better of two colonies" in shown
    assert "stage two: sum over the parts" in shown


def test_all_best_lengths_fit_and_a_mean_that_does_not_is_stated(undivided):
    result = with_history(undivided, [30, 20, 20], [30, 20, 28], [500, 60, 22.5], [("whole map", 3)])
    ax = plot.plot_convergence(result)
    low, high = ax.get_ylim()
    assert low < undivided.optimum < 30 < high < 60
    assert "mean of the arrived ants (22.5 to 500.0)" in texts(ax.figure)


def test_the_right_scale_is_the_gap(undivided):
    ax = plot.plot_convergence(undivided)
    (gap,) = ax.child_axes
    ax.figure.canvas.draw()
    np.testing.assert_allclose(gap.get_ylim(), [100 * (end / undivided.optimum - 1) for end in ax.get_ylim()])


def test_without_an_optimum_there_is_no_gap(undivided):
    ax = plot.plot_convergence(replace(undivided, certificate=(INF, 0.0)))
    ax.figure.canvas.draw()
    assert not ax.child_axes
    assert "exact optimum" not in texts(ax.figure)


def test_values_between_gaps_are_seen(undivided):
    result = with_history(undivided, [20] * 4, [20] * 4, [NAN, 22, NAN, NAN], [("whole map", 4)])
    ax = plot.plot_convergence(result)
    (mean,) = [line for line in ax.lines if line.get_label().startswith("mean of the arrived ants")]
    assert (mean.get_marker(), mean.get_markevery()) == (".", [1])


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("unreachable", "no path exists"),
        ("same_cell", "start and goal are one cell"),
        ("nobody_arrived", "no ant arrived"),
    ],
)
def test_an_empty_convergence_says_why(name, words, request):
    result = request.getfixturevalue(name)
    ax = plot.plot_convergence(result)
    assert words in texts(ax.figure)
    assert not stairs(ax) or name == "nobody_arrived"
    assert ax.get_legend() is None or "best so far" not in texts(ax.get_legend())


def test_halves_that_were_never_joined(undivided):
    stages = [("stage one", 1, 1), ("stage two", 2, 2)]
    result = with_history(undivided, [25, INF, INF], [25, INF, INF], [30, NAN, NAN], stages)
    ax = plot.plot_convergence(result)
    assert "stage two: sum over the parts" in texts(ax.figure)
    assert "no ant arrived" not in texts(ax.figure)


def test_a_planner_without_iterations_says_so() -> None:
    ax = plot.plot_convergence(plan(two_rooms(), an.astar()))
    assert "astar has no iterations" in texts(ax.figure)
