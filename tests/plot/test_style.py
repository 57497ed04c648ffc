"""Titles and fine print tell the truth, whatever the names; nothing is covered; axes are made or taken."""

from __future__ import annotations

import sys
import xml.etree.ElementTree as ET
from dataclasses import replace

import numpy as np
import pytest

import antnav as an
from antnav import plot
from antnav.errors import ParameterError
from antnav.planner.plan import StoppedBy
from antnav.planner.result import Result
from tests.plot.samples import texts, two_rooms

pytest.importorskip("matplotlib").use("Agg")
from matplotlib import pyplot as plt  # noqa: E402


def test_the_title_says_what_came_out(divided, undivided, unreachable, nobody_arrived):
    def title(result: Result) -> str:
        return plot.plot_path(result).get_title()

    metres = f"{divided.length:.4f} cells, {divided.length_m:.3f} m, gap {100 * divided.gap:.2f} %, found"
    assert title(divided) == f"paco on two rooms, seed 1\n{metres}"
    assert " m," not in title(undivided)  # resolution 1: metres are cells
    assert title(unreachable).endswith("\nunreachable: no path leads from start to goal")
    assert title(nobody_arrived).endswith("\nno ant arrived in 3 iterations")
    assert title(replace(divided, stopped_by=StoppedBy.CANCELLED)).endswith("found (stopped: cancelled)")


def test_certainty_and_notes_travel_with_the_picture(divided):
    noted = replace(divided, notes=("the sub-paths cross; the joined path has a loop",))
    for ax in (plot.plot_result(noted), plot.plot_path(noted)):
        shown = " ".join(texts(ax.figure).split())
        assert f"Certainty: {divided.algorithm.certainty}" in shown
        assert "Note: the sub-paths cross; the joined path has a loop" in shown


@pytest.mark.parametrize("name", ["$a_{b", "line\nbreak", "bell\x07 -- \x00", "x" * 500, "lone \udcff surrogate"])
def test_any_name_can_be_printed(divided, tmp_path, name):
    grid = two_rooms(name=name)
    problem = an.Problem.from_cells(grid, (1, 1), (8, 12))
    result = replace(divided, problem=problem, algorithm=replace(divided.algorithm, name=name, certainty=name))
    plot.save_picture(result, tmp_path / "picture.svg")
    ET.parse(tmp_path / "picture.svg")
    plot.plot_map(grid).figure.canvas.draw()


def test_functions_draw_on_the_axes_that_they_are_given(divided):
    for draw in (plot.plot_path, plot.plot_convergence, plot.plot_result):
        figure, ax = plt.subplots()
        assert draw(divided, ax) is ax
        assert draw(divided, ax=ax).figure is figure
    ax = plt.figure().add_subplot()
    assert plot.plot_map(divided.problem.grid, ax) is ax


@pytest.mark.parametrize("shape", [(4, 60), (60, 4), (30, 30), (1, 1), (200, 300)])
@pytest.mark.parametrize("draw", ["plot_result", "plot_path", "plot_convergence"])
def test_nothing_is_cut_off_or_covered(shape, draw):
    grid = an.GridMap(np.zeros(shape, np.uint8), resolution=0.05, name="hall")
    goal = (shape[0] - 1, shape[1] - 1)
    result = an.solve(an.Problem.from_cells(grid, (0, 0), goal), an.paco(ants=3, iterations=5), seed=0)
    ax = getattr(plot, draw)(result)
    figure = ax.figure
    figure.canvas.draw()
    box, size = figure.get_tightbbox(), figure.get_size_inches()
    assert box.x0 >= 0
    assert box.y0 >= 0
    assert box.x1 <= size[0]
    assert box.y1 <= size[1]
    for panel in figure.axes:
        if panel.get_legend():
            assert panel.get_legend().get_window_extent().y1 < panel.get_window_extent().y0


@pytest.mark.parametrize("draw", ["plot_map", "plot_path", "plot_convergence", "plot_result", "save_picture"])
def test_without_matplotlib_the_error_names_the_extra(divided, tmp_path, monkeypatch, draw):
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    arguments = {"plot_map": [divided.problem.grid], "save_picture": [divided, tmp_path / "picture.png"]}
    with pytest.raises(ParameterError, match=r'pip install "antnav\[plot\]"'):
        getattr(plot, draw)(*arguments.get(draw, [divided]))
    assert not list(tmp_path.iterdir())
