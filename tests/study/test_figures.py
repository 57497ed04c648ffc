"""Figures: what they gather, and what can be read back from their axes."""

from __future__ import annotations

import math
import os
import subprocess
import sys
from collections.abc import Sequence
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING
from xml.etree import ElementTree

import numpy as np
import pytest

from antnav.study import figures, tables
from antnav.study.config import Sweep
from tests.study.made_up import OPTIMUM, made_up, paper_like, problems

if TYPE_CHECKING:
    from matplotlib.figure import Figure

pytest.importorskip("matplotlib")
ROOT = Path(__file__).parents[2]


def sweep_of(name: str, **values: Sequence[float | str]) -> Sweep:
    """The sweep over all combinations of these values, with the labels of `load_study`."""
    points = [dict(zip(values, chosen, strict=True)) for chosen in product(*values.values())]
    return Sweep(name, {" ".join([name, *(f"{key}={value}" for key, value in p.items())]): p for p in points})


def test_looks_of_seven_algorithms_differ_also_without_colour() -> None:
    look = figures.looks(["x", "paco", "y", "luo", "z", "dai", "npaco"])
    assert len({str(style["linestyle"]) for style in look.values()}) == 7
    assert len({style["marker"] for style in look.values()}) == 7
    assert look["paco"] == figures.looks(["paco"])["paco"]
    assert len(figures.looks([str(i) for i in range(30)])) == 30


def test_band_by_hand() -> None:
    band = figures.band([(None, 4.0, 2.0), (8.0, 6.0), (None, None, None), (4.0, 2.0, 2.0)])
    assert band.iteration.tolist() == [1, 2, 3]
    assert band.mean.tolist() == [6.0, 4.0, pytest.approx(10 / 3)]  # the second run keeps its 6
    assert band.low.tolist() == [7.0, 3.5, 2.0]
    assert band.high.tolist() == [math.inf] * 3
    assert band.arrived == 3


def test_band_hides_the_mean_of_a_minority() -> None:
    band = figures.band([(None, 5.0), (None, None), (None, None)])
    assert np.isnan(band.mean).all()
    assert band.arrived == 1
    assert len(figures.band([]).mean) == len(figures.band([(), ()]).mean) == 0


def test_best_run_is_the_shortest_of_the_lowest_seed() -> None:
    runs = [made_up("a", 3, 30.0), made_up("a", 1, 30.0 + 1e-13), made_up("a", 0, 31.0), made_up("a", 2, None)]
    best = figures.best_run(runs)
    assert best is not None
    assert best.seed == 1
    assert figures.best_run(runs[3:]) is None


def test_a_line_moved_sideways_keeps_its_distance() -> None:
    moved = figures.beside(np.array([[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]]), 0.5)
    assert moved - np.array([[0, 0], [1, 1], [2, 2]]) == pytest.approx(np.array([[-1, 1]] * 3) * 0.5 / math.sqrt(2))
    assert figures.beside(np.zeros((1, 2)), 0.5).tolist() == [[0, 0]]


def test_convergence_shows_the_optimum_and_says_who_found_nothing() -> None:
    group = tables.grouped(paper_like())["equiv30"]
    ax = figures.draw_convergence(None, group, figures.FOUR, "equiv30")
    labels = [str(line.get_label()) for line in ax.get_lines()]
    assert labels == ["paco", "npaco", "dai", "traditional: no path in any run", f"optimum: {OPTIMUM:.4f}"]
    assert list(ax.get_lines()[-1].get_ydata()) == [OPTIMUM] * 2
    assert ax.get_lines()[0].get_ydata()[-1] == pytest.approx(OPTIMUM)


def test_lost_ants() -> None:
    ax = figures.draw_lost(None, tables.grouped(paper_like())["equiv20"], figures.TWO, "equiv20")
    assert [str(line.get_label()) for line in ax.get_lines()] == list(figures.TWO)
    assert ax.get_lines()[0].get_ydata().tolist() == [9, 5, 3, 1, 0]


def test_paths_ends_and_star() -> None:
    group = tables.grouped(paper_like())["equiv30"]
    problem = problems()["equiv30"]
    ax = figures.draw_paths(None, problem, group, figures.FOUR, "t")
    lines = {str(line.get_label()).split(":")[0]: line for line in ax.get_lines()}
    assert set(lines) >= {*figures.FOUR, "start", "goal", "auxiliary cell"}
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


def test_critical_difference_diagram_names_everybody() -> None:
    pytest.importorskip("scikit_posthocs")
    found, _, table = tables.ranks(tables.grouped(paper_like()))
    assert found is not None
    ax = figures.draw_ranks(None, found, table)
    said = " ".join(text.get_text() for text in ax.texts)
    assert all(f"({rank:.2f})" in said and name in said for name, rank in found.mean_ranks.items())


def test_the_diagram_does_not_depend_on_the_order_of_sets() -> None:
    pytest.importorskip("scikit_posthocs")
    script = (
        "import hashlib\n"
        "from antnav.study import figures, tables\n"
        "from tests.study.made_up import made_up\n"
        "records = [made_up(name, seed, 30 + seed * i % 3) for i, name in enumerate('abcdefg') for seed in range(6)]\n"
        "found, _, table = tables.ranks(tables.grouped(records))\n"
        "print(hashlib.sha256(figures.render(figures.rank_figure(found, table).draw, 'svg')).hexdigest())"
    )
    runs = [
        subprocess.Popen(
            [sys.executable, "-c", script], env=os.environ | {"PYTHONHASHSEED": seed}, stdout=subprocess.PIPE, cwd=ROOT
        )
        for seed in ("1", "2")
    ]
    digests = [run.communicate()[0] for run in runs]
    assert digests[0] == digests[1] != b""


def test_a_dollar_in_a_label_is_no_formula() -> None:
    groups = tables.grouped([made_up(name, seed, 30.0) for name in ("$\\no{$", "b", "c") for seed in (0, 1)])
    found, _, table = tables.ranks(groups)
    assert found is not None
    drawings = [*figures.study_figures(groups, problems(("equiv20",))), figures.gap_figure(groups)]
    if figures.has_posthocs():
        drawings.append(figures.rank_figure(found, table))
    for drawing in drawings:
        assert "$\\no{$" in written_on(drawing.draw())


def written_on(figure: Figure) -> str:
    """All texts of a figure that are drawn as they stand."""
    from matplotlib.text import Text

    figure.draw_without_rendering()  # raises where a formula cannot be read
    return " ".join(text.get_text() for text in figure.findobj(Text) if not text.get_parse_math())


def test_a_plane_of_two_parameters() -> None:
    sweep = sweep_of("paco", rho=(0.1, 0.2), beta=(5, 7), switch=(0.6,))
    labels = list(sweep.points)
    (plane,) = figures.planes(sweep)
    assert (plane.name, plane.x, plane.y, plane.averaged) == ("paco", "rho", "beta", ())
    records = [made_up(label, seed, OPTIMUM * (1 + 0.01 * seed)) for label in labels[:3] for seed in (0, 1)]
    records += [made_up(labels[3], 0, None), made_up(labels[3], 1, OPTIMUM), made_up("luo", 0, 99.0)]
    grid = figures.sweep_grid(records, plane)
    assert (grid.xs, grid.ys) == ([0.1, 0.2], [5.0, 7.0])
    assert grid.gap == pytest.approx(np.array([[0.5, 0.5], [0.5, 0.0]]))
    assert grid.missing == pytest.approx(np.array([[0, 0], [0, 0.5]]))
    ax = figures.draw_sweep(None, grid, plane.x, plane.y)
    assert [text.get_text() for text in ax.texts] == ["0.50", "0.50", "0.50", "0.00\n50 % fail"]


def test_a_plane_of_one_parameter_and_none() -> None:
    (plane,) = figures.planes(sweep_of("paco", rho=(0.1, 0.2)))
    assert (plane.x, plane.y) == ("rho", None)
    grid = figures.sweep_grid([made_up("paco rho=0.1", 0, OPTIMUM)], plane)
    assert (grid.ys, grid.gap.shape) == ([0.0], (1, 2))
    figures.draw_sweep(None, grid, plane.x, plane.y)
    assert figures.planes(sweep_of("paco", rho=(0.1,))) == []
    assert figures.planes(sweep_of("paco", axis=("row", "column"))) == []


def test_parameters_that_are_words_are_not_averaged_over() -> None:
    sweep = sweep_of("paco", heuristic=("edge", "target"), rho=(0.1, 0.2), bend_with_start=(True,))
    edge, target = figures.planes(sweep)
    assert edge.name == "paco heuristic=edge bend_with_start=True"
    assert (edge.x, edge.y) == ("rho", None)
    records = [made_up(label, 0, OPTIMUM * (2 if "edge" in label else 1)) for label in sweep.points]
    assert figures.sweep_grid(records, edge).gap.tolist() == [[100, 100]]
    assert figures.sweep_grid(records, target).gap.tolist() == [[0, 0]]


def test_what_is_averaged_over_is_said() -> None:
    sweep = sweep_of("paco", rho=(0.1, 0.2), beta=(5, 7), ants=(8, 9))
    drawings = figures.sweep_figures({"m": {}}, figures.planes(sweep))
    assert [drawing.caption.split(".")[-2].strip() for drawing in drawings] == [
        "Averaged over ants",
        "Averaged over beta",
        "Averaged over rho",
    ]


def test_names_of_sweeps_are_short_and_differ() -> None:
    planes = [plane for name in ("paco+", "paco-", "x" * 300) for plane in figures.planes(sweep_of(name, rho=(1, 2)))]
    names = [drawing.name for drawing in figures.sweep_figures({"m" * 260: {}, "n": {}}, planes)]
    assert len(set(names)) == 6
    assert max(map(len, names)) < 80


def test_paper_figures_5_to_9_and_their_bytes() -> None:
    groups = tables.grouped(paper_like(labels=("equiv20", "equiv30", "equiv40")))
    found = figures.paper_figures(groups, problems(("equiv20", "equiv30", "equiv40")))
    assert [drawing.title.split(".")[0] for drawing in found] == [f"Figure {number}" for number in range(5, 10)]
    once, again = (figures.render(found[2].draw, "svg") for _ in range(2))
    assert once == again
    ElementTree.fromstring(once)
    assert figures.render(found[0].draw, "png")[:4] == b"\x89PNG"


def test_a_crowd_shows_its_leaders() -> None:
    group = {f"a{i}": [made_up(f"a{i}", 0, 40.0 - i)] for i in range(12)}
    assert figures.leaders(group) == [f"a{i}" for i in range(5, 12)]


def test_drawing_leaves_the_users_pyplot_alone() -> None:
    from matplotlib import pyplot as plt

    before = plt.get_fignums()
    figures.render(figures.gap_figure(tables.grouped(paper_like())).draw, "svg")
    assert plt.get_fignums() == before
