"""Figures, read back from their axes."""

from __future__ import annotations

import math

import numpy as np
import pytest

import antnav as an
from antnav.report import pictures
from antnav.study import comparison, drawings, figures, series
from antnav.study.groups import grouped
from tests.study.made_up import OPTIMUM, made_up, paper_like, problems

pytest.importorskip("matplotlib")


def test_looks_of_seven_algorithms_differ_also_without_colour() -> None:
    look = pictures.looks(["x", "paco", "y", "luo", "z", "dai", "npaco"])
    assert len({str(style["linestyle"]) for style in look.values()}) == 7
    assert len({style["marker"] for style in look.values()}) == 7
    assert look["paco"] == pictures.looks(["paco"])["paco"]
    assert len(pictures.looks([str(i) for i in range(30)])) == 30


def test_convergence_shows_the_optimum_and_says_who_found_nothing() -> None:
    group = grouped(paper_like())["equiv30"]
    ax = figures.draw_convergence(None, group, drawings.FOUR, "equiv30")
    labels = [str(line.get_label()) for line in ax.get_lines()]
    assert labels == ["paco", "npaco", "dai", "traditional: no path in any run", f"optimum: {OPTIMUM:.4f}"]
    assert list(ax.get_lines()[-1].get_ydata()) == [OPTIMUM] * 2
    assert ax.get_lines()[0].get_ydata()[-1] == pytest.approx(OPTIMUM)


def test_lost_ants() -> None:
    ax = figures.draw_lost(None, grouped(paper_like())["equiv20"], list(drawings.RULES), "equiv20", drawings.RULES)
    labels = ["npaco, the paper's two rules", "npaco, Luo's two rules", "luo, the whole preset"]
    assert [str(line.get_label()) for line in ax.get_lines()] == labels
    assert ax.get_lines()[0].get_ydata().tolist() == [9, 5, 3, 1, 0]


def test_paths_ends_and_star() -> None:
    group = grouped(paper_like())["equiv30"]
    problem = problems()["equiv30"]
    ax = figures.draw_paths(None, problem, group, drawings.FOUR, "t")
    lines = {str(line.get_label()).split(":")[0]: line for line in ax.get_lines()}
    assert set(lines) >= {*drawings.FOUR, "start", "goal", "auxiliary cell"}
    assert len(lines["traditional"].get_xdata()) == 0
    star = problem.grid.cell_to_world((9, 9))  # of PACO's best run, seed 0
    assert (lines["auxiliary cell"].get_xdata()[0], lines["auxiliary cell"].get_ydata()[0]) == tuple(star)
    assert lines["auxiliary cell"].get_marker() == "*"


def test_gaps_name_the_runs_without_a_path() -> None:
    group = {"a": [made_up("a", 0, 30.0), made_up("a", 1, None)], "b": [made_up("b", 0, 31.0)]}
    ax = figures.draw_gaps(None, group, "t")
    assert [label.get_text() for label in ax.get_yticklabels()] == ["a\n(1 of 2: no path)", "b"]
    dots = [line for line in ax.get_lines() if line.get_marker() not in ("None", "", None)]
    assert [len(line.get_xdata()) for line in dots] == [1, 1]
    assert dots[0].get_xdata()[0] == pytest.approx(100 * (30 / OPTIMUM - 1))  # per cent
    medians = [line for line in ax.get_lines() if line.get_linewidth() == 1.6]
    assert [line.get_xdata()[0] for line in medians] == [line.get_xdata()[0] for line in dots]


def test_the_critical_difference_diagram_gives_everybody_a_line_and_joins_ties() -> None:
    lengths = {"a": 30.0, "b": 30.0, "c": 40.0, "d": 40.0, "e": 35.0}
    records = [made_up(name, seed, length) for name, length in lengths.items() for seed in range(30)]
    found, _, _ = comparison.ranks(grouped(records))
    assert found is not None
    ax = figures.draw_ranks(None, found, "abcde")
    assert [label.get_text() for label in ax.get_yticklabels()] == [
        "a (1.50)",
        "b (1.50)",
        "e (3.00)",
        "c (4.50)",
        "d (4.50)",
    ]
    bars = [list(line.get_ydata()) for line in ax.get_lines() if line.get_linewidth() == 3]
    assert bars == [[-0.25, 1.25], [2.75, 4.25]]


def test_logarithmic_axes_say_so_and_a_sweep_of_zeros_has_no_scale() -> None:
    group = {"a": [made_up("a", seed, OPTIMUM, best=(9 * OPTIMUM, OPTIMUM)) for seed in range(2)]}
    assert figures.draw_convergence(None, group, ["a"], "t").get_ylabel().endswith(", logarithmic")
    assert figures.draw_gaps(None, group, "t").get_xlabel() == "gap to the optimum (%)"
    far = {"a": [made_up("a", 0, 1.3 * OPTIMUM)]}
    assert figures.draw_gaps(None, far, "t").get_xlabel().endswith(", logarithmic above 1")
    assert not figures.draw_convergence(None, far, ["a"], "t").get_ylabel().endswith(", logarithmic")
    for gap, panels in ((0.0, 1), (2.0, 2)):
        ax = figures.draw_sweep(None, series.SweepGrid([1.0], [0.0], np.array([[gap]]), np.array([[0.0]])), "rho", None)
        assert len(ax.figure.axes) == panels


def test_paths_on_a_turned_map_lie_on_it_and_unknown_surroundings_are_cut_away() -> None:
    cells = np.full((100, 100), 2)
    cells[40:60, 40:60] = 0
    grid = an.GridMap(cells, 0.5, (3.0, 4.0, 1.0))
    problem = an.Problem.from_cells(grid, (40, 40), (59, 59))
    group = {"a": [made_up("a", 0, 27.0, path=tuple((40 + i, 40 + i) for i in range(20)))]}
    ax = figures.draw_paths(None, problem, group, ["a"], "t")
    (line,) = (line for line in ax.get_lines() if str(line.get_label()).startswith("a:"))
    assert line.get_xydata()[0] == pytest.approx(tuple(grid.cell_to_world((40, 40))))
    centre, half = grid.cell_to_world((49.5, 49.5)), 5.5 * (math.cos(1) + math.sin(1))
    assert ax.get_xlim() == pytest.approx((centre[0] - half, centre[0] + half))
    assert ax.get_ylim() == pytest.approx((centre[1] - half, centre[1] + half))
