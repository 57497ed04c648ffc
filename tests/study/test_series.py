"""What figures show, as it is gathered from records."""

from __future__ import annotations

import math

import numpy as np
import pytest

import antnav as an
from antnav.study import figures, series
from tests.study.made_up import OPTIMUM, made_up, sweep_of

pytest.importorskip("matplotlib")


def test_band_by_hand() -> None:
    band = series.band([(None, 4.0, 2.0), (8.0, 6.0), (None, None, None), (4.0, 2.0, 2.0)])
    assert band.iteration.tolist() == [1, 2, 3]
    assert band.mean.tolist() == [6.0, 4.0, pytest.approx(10 / 3)]  # the second run keeps its 6
    assert band.low.tolist() == [7.0, 3.5, 2.0]
    assert band.high.tolist() == [math.inf] * 3
    assert band.arrived == 3


def test_band_hides_the_mean_of_a_minority() -> None:
    band = series.band([(None, 5.0), (None, None), (None, None)])
    assert np.isnan(band.mean).all()
    assert band.arrived == 1
    assert len(series.band([]).mean) == len(series.band([(), ()]).mean) == 0


def test_best_run_is_the_shortest_of_the_lowest_seed() -> None:
    runs = [made_up("a", 3, 30.0), made_up("a", 1, 30.0 + 1e-13), made_up("a", 0, 31.0), made_up("a", 2, None)]
    best = series.best_run(runs)
    assert best is not None
    assert best.seed == 1
    assert series.best_run(runs[3:]) is None


def test_a_line_moved_sideways_keeps_its_distance() -> None:
    moved = series.beside(np.array([[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]]), 0.5)
    assert moved - np.array([[0, 0], [1, 1], [2, 2]]) == pytest.approx(np.array([[-1, 1]] * 3) * 0.5 / math.sqrt(2))
    assert series.beside(np.zeros((1, 2)), 0.5).tolist() == [[0, 0]]


def test_a_plane_of_two_parameters() -> None:
    sweep = sweep_of("paco", rho=(0.1, 0.2), beta=(5, 7), switch=(0.6,))
    labels = list(sweep.points)
    (plane,) = series.planes(sweep)
    assert (plane.name, plane.x, plane.y, plane.averaged) == ("paco", "rho", "beta", ())
    records = [made_up(label, seed, OPTIMUM * (1 + 0.01 * seed)) for label in labels[:3] for seed in (0, 1)]
    records += [made_up(labels[3], 0, None), made_up(labels[3], 1, OPTIMUM), made_up("luo", 0, 99.0)]
    grid = series.sweep_grid(records, plane)
    assert (grid.xs, grid.ys) == ([0.1, 0.2], [5.0, 7.0])
    assert grid.gap == pytest.approx(np.array([[0.5, 0.5], [0.5, 0.0]]))
    assert grid.missing == pytest.approx(np.array([[0, 0], [0, 0.5]]))
    ax = figures.draw_sweep(None, grid, plane.x, plane.y)
    assert [text.get_text() for text in ax.texts] == ["0.50", "0.50", "0.50", "0.00\n50 % fail"]


def test_a_plane_of_one_parameter_and_none() -> None:
    (plane,) = series.planes(sweep_of("paco", rho=(0.1, 0.2)))
    assert (plane.x, plane.y) == ("rho", None)
    grid = series.sweep_grid([made_up("paco rho=0.1", 0, OPTIMUM)], plane)
    assert (grid.ys, grid.gap.shape) == ([0.0], (1, 2))
    figures.draw_sweep(None, grid, plane.x, plane.y)
    assert series.planes(sweep_of("paco", rho=(0.1,))) == []
    assert series.planes(sweep_of("paco", axis=("row", "column"))) == []


def test_parameters_that_are_words_are_not_averaged_over() -> None:
    sweep = sweep_of("paco", heuristic=("edge", "target"), rho=(0.1, 0.2), bend_with_start=(True,))
    edge, target = series.planes(sweep)
    assert edge.name == "paco heuristic=edge bend_with_start=True"
    assert (edge.x, edge.y) == ("rho", None)
    records = [made_up(label, 0, OPTIMUM * (2 if "edge" in label else 1)) for label in sweep.points]
    assert series.sweep_grid(records, edge).gap.tolist() == [[100, 100]]
    assert series.sweep_grid(records, target).gap.tolist() == [[0, 0]]


def test_a_crowd_shows_its_leaders() -> None:
    group = {f"a{i}": [made_up(f"a{i}", 0, 40.0 - i)] for i in range(12)}
    assert series.leaders(group) == [f"a{i}" for i in range(5, 12)]


def test_leaders_of_a_crowd_and_the_equals_that_are_left_out() -> None:
    medians = {"a": (30.0, 30.0, 33.0), "b": (31.0,) * 3, **dict.fromkeys("cdefghij", (30.0, 30.0, 30.0))}
    group = {name: [made_up(name, s, length) for s, length in enumerate(runs)] for name, runs in medians.items()}
    assert series.leaders(group) == list("cdefghi")
    assert "7 of 10 algorithms" in series.choice_of_leaders(group)
    assert "later in the study: 1 more" in series.choice_of_leaders(group)
    few = {name: group[name] for name in "abc"}
    assert (series.leaders(few), series.choice_of_leaders(few)) == (["a", "b", "c"], "")


def test_what_is_shown_of_a_map_in_a_field_of_unknown_cells() -> None:
    cells = np.full((100, 80), 2)
    cells[40:61, 20:41] = 0
    problem = an.Problem.from_cells(an.GridMap(cells), (45, 25), (55, 35))
    assert series.shown_part(problem, [[(45, 25), (55, 35)]]) == ((61, 19), (39, 41))
    through = an.Problem.from_cells(an.GridMap(cells), (45, 25), (99, 79), allow_unknown=True)
    assert series.shown_part(through, []) == ((99, 18), (38, 79))
    assert series.shown_part(an.Problem.from_cells(an.GridMap(np.zeros((9, 9), int)), (0, 0), (1, 1)), []) is None
