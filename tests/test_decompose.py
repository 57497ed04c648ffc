"""The auxiliary cell, the halves, the joined path: by hand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import antnav as an
from antnav import decompose
from antnav.colony.colony import run, whole_task
from antnav.colony.parts import Axis
from tests.conftest import grid_of


@pytest.mark.parametrize(
    ("start", "goal", "axis", "line"),
    [
        ((0, 0), (19, 19), "auto", (0, 9)),  # printed: auxiliary cell (8.5, 10.5) of 20 rows = row 9
        ((21, 0), (1, 25), "row", (0, 11)),  # printed: (20.5, 18.5) of 30 rows = row 11
        ((21, 0), (1, 25), "auto", (1, 12)),  # the paper's own rule, which its 30x30 map breaks
        ((5, 5), (34, 28), "auto", (0, 19)),  # printed: (11.5, 20.5) of 40 rows = row 19
        ((3, 3), (3, 9), "auto", (1, 6)),
        ((3, 3), (9, 3), "column", (1, 3)),
    ],
)
def test_boundary(start: tuple, goal: tuple, axis: str, line: tuple) -> None:
    assert decompose.boundary(start, goal, Axis(axis)) == line


def test_auxiliary_cell_is_the_most_visited_of_the_line_but_no_end() -> None:
    problem = an.Problem.from_cells(grid_of("...", "...", "..."), (1, 0), (1, 2))
    visits = np.array([9, 9, 9, 7, 2, 5, 9, 9, 9])
    assert decompose.auxiliary_node(problem.graph, visits, (0, 1), (3, 5)) == 4
    assert decompose.auxiliary_node(problem.graph, visits, (0, 1), (4, 5)) == 3
    visits[4] = 0
    assert decompose.auxiliary_node(problem.graph, visits, (0, 1), (3, 5)) is None
    assert decompose.auxiliary_node(problem.graph, np.full(9, 4), (1, 1), (3, 5)) == 1  # ties: the first


def test_half_keeps_to_its_side_and_to_the_line() -> None:
    problem = an.Problem.from_cells(grid_of("...", "...", "..."), (0, 0), (2, 2))
    graph = problem.graph
    start, middle, goal = (graph.node(cell) for cell in ((0, 0), (1, 1), (2, 2)))
    assert decompose.half(graph, (0, 1), middle, start).tolist() == [True] * 6 + [False] * 3
    assert decompose.half(graph, (1, 1), middle, goal).tolist() == [False, True, True] * 3


def test_ants_that_keep_to_a_half_never_leave_it() -> None:
    problem = an.Problem.from_cells(grid_of("...", "...", "..."), (0, 0), (1, 2))
    task = whole_task(problem, an.npaco(beta=0, iterations=20), 1)
    allowed = decompose.half(problem.graph, (0, 1), task.goal, task.start)
    for side, everywhere in ((allowed, False), (None, True)):
        visits = run(replace(task, allowed=side)).visits
        assert (visits[6:] > 0).any() == everywhere


def test_half_is_refused_where_it_cuts_the_auxiliary_cell_off() -> None:
    # From the start, row 1's right end is only reached through row 2.
    problem = an.Problem.from_cells(grid_of("..###", "..#..", "....."), (0, 0), (2, 4))
    graph = problem.graph
    assert decompose.half(graph, (0, 1), graph.node((1, 4)), graph.node((0, 0))) is None
    assert decompose.half(graph, (0, 1), graph.node((1, 1)), graph.node((1, 0))) is None  # the end lies on the line


@pytest.mark.parametrize(
    ("nodes", "expected"),
    [
        ([1, 2, 3], [1, 2, 3]),
        ([1, 2, 3, 2, 4], [1, 2, 4]),
        ([1, 2, 1, 3, 4, 3, 5], [1, 3, 5]),
        ([7], [7]),
        ([1, 2, 1], [1]),
    ],
)
def test_loops_are_cut_out(nodes: list, expected: list) -> None:
    assert decompose.without_loops(np.array(nodes)).tolist() == expected
