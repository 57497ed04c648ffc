"""What a colony offers to own rules: where its pheromone lies."""

from __future__ import annotations

from typing import cast

import msgspec
import pytest

import antnav as an
from antnav.colony.colony import Colony, run, whole_task
from antnav.errors import ParameterError
from antnav.world.grid_graph import GridGraph
from tests.conftest import grid_of

MOVES = ((-1, -1), (-1, 0), (-1, 1), (0, -1), (0, 1), (1, -1), (1, 0), (1, 1))  # as the docstring of tau says


def test_pheromone_lies_where_its_docstring_says() -> None:
    problem = an.Problem.from_cells(grid_of("..#.", "....", ".#.."), (0, 0), (2, 3), corner_rule="graze")
    colony = an.Colony(problem, an.npaco(ants=4, iterations=3), seed=1)
    colony.step()
    graph = cast(GridGraph, colony.task.grid_graph)
    neighbours, n = graph.graph.neighbours, len(graph)
    assert colony.tau.shape == neighbours.shape == (n, 8)
    assert graph.cells.tolist() == sorted(graph.cells.tolist()), "map order"
    legal = 0
    for node, cell in enumerate(graph.cells.tolist()):
        assert graph.node(cell) == node
        for k, (down, right) in enumerate(MOVES):
            end = int(neighbours[node, k])
            if end < n:
                legal += 1
                assert graph.cells[end].tolist() == [cell[0] + down, cell[1] + right]
                assert neighbours[end, 7 - k] == node
            else:
                assert end == n
    assert 0 < legal < 8 * n


@pytest.mark.parametrize("count", [-3, True, 1.5, "2", None])
def test_steps_are_counted_in_whole_numbers(count: object) -> None:
    colony = an.Colony(an.Problem.from_cells(grid_of("...."), (0, 0), (0, 3)), an.npaco(ants=2, iterations=3))
    with pytest.raises(ParameterError, match="count"):
        colony.step(count)
    colony.step(0)
    assert colony.iteration == 0


def test_paths_of_all_ants_are_kept_where_the_task_asks_for_them() -> None:
    problem = an.Problem.from_cells(grid_of("....", "....", "...."), (0, 0), (2, 3))
    quiet = whole_task(problem, an.npaco(ants=3, iterations=2), seed=1)
    told = run(msgspec.structs.replace(quiet, all_paths=True))
    colony = Colony.of(quiet)
    colony.step(2)
    assert run(quiet).paths == []
    assert [path.tolist() for path in told.paths] == [
        path.tolist() for path in (colony.best_nodes, *colony.ant_paths()) if path is not None
    ]
    assert len(told.paths) == 4
