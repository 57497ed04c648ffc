"""What any algorithm must do, run over every preset and over a pairwise covering of the parts.

A new preset or part is tested here by being registered.
"""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest

import antnav as an
from antnav import maps
from antnav.ants.presets import PRESETS
from antnav.colony.colony import Colony
from antnav.colony.parts import Deadlock, Deposit, Heuristic, InitialPheromone, LocalSearch, PheromoneRule, Transition
from antnav.errors import ParameterError
from tests.kernels.test_ant_kernels import assert_equal, one_colony, random_problem, twin_of

CHOICES: dict[str, list[Any]] = {
    "heuristic": list(Heuristic),
    "transition": list(Transition),
    "deadlock": list(Deadlock),
    "pheromone": list(PheromoneRule),
    "deposit": list(Deposit),
    "initial": list(InitialPheromone),
    "local_search": list(LocalSearch),
    "graft": [False, True],
    "local_rate": [0.0, 0.1],
    "spread": [0.0, 0.2],
    "openness": [0.0, 1.0],
    "rho_last": [None, 0.3],
    "beta_last": [None, 7.0, 0.0],
    "windows": [0, 9],
    "preset": ["npaco", "paco", "paco_extended"],
}


def pairwise_covering(choices: dict[str, list[Any]]) -> list[dict[str, Any]]:
    """Rows such that every two values of different parts stand together in one of them; greedy, the same each time."""
    names = list(choices)
    missing = {((a, x), (b, y)) for a, b in itertools.combinations(names, 2) for x in choices[a] for y in choices[b]}
    rows = []
    while missing:
        row = dict(min(missing, key=str))
        for name in names:
            if name not in row:
                gains = {
                    value: sum(
                        tuple(sorted([(name, value), other], key=lambda part: names.index(part[0]))) in missing
                        for other in row.items()
                    )
                    for value in choices[name]
                }
                row[name] = max(gains, key=gains.__getitem__)
        row = {name: row[name] for name in names}
        rows.append(row)
        missing -= set(itertools.combinations(row.items(), 2))
    return rows


COVERING = pairwise_covering(CHOICES)


def algorithm_of(row: dict[str, Any], **more: Any) -> an.Algorithm:
    return PRESETS[row["preset"]](**{name: value for name, value in row.items() if name != "preset"}, **more)


ALGORITHMS = {name: make(ants=15, iterations=15) for name, make in PRESETS.items()} | {
    "-".join(str(value) for value in row.values()): algorithm_of(row, ants=15, iterations=15) for row in COVERING
}
ALGORITHMS["paco_large"] = PRESETS["paco_large"](coarse=4, windows=9)  # on a map of a few blocks


def everything(result: an.Result) -> tuple:
    path = None if result.path is None else result.path.cells.tolist()
    return path, [column.tobytes() for column in result.history], result.auxiliary_cell, result.notes


@pytest.fixture(scope="module")
def problem() -> an.Problem:
    grid = maps.generate("random", 14, 16, seed=5, density=0.25)
    cells = np.argwhere(grid.passable())
    return an.Problem.from_cells(grid, tuple(cells[0]), tuple(cells[-1]), corner_rule="allow")


@pytest.mark.parametrize("name", ALGORITHMS)
def test_conformance(name: str, problem: an.Problem) -> None:
    algorithm = ALGORITHMS[name]
    result = an.solve(problem, algorithm, seed=3)
    assert everything(result) == everything(an.solve(problem, algorithm, seed=3, executor=an.spmd.Serial()))
    if result.path is not None:
        an.check_path(result.path, problem)
        assert result.gap >= 0
    history = result.history
    assert np.all(history.arrived >= 0)
    assert np.all(history.lost >= 0)
    assert np.all(history.steps > 0)
    for stage in result.stages:
        for colony in stage.colonies:
            assert colony.iterations <= algorithm.iterations
    if algorithm.decomposition is None and not algorithm.coarse:
        assert np.all(history.arrived + history.lost <= algorithm.ants * algorithm.colonies)
        best = history.best
        assert np.all(best[1:] <= best[:-1])
        of_ants = np.minimum.accumulate(history.iteration_best)
        assert np.all(best <= of_ants) if algorithm.graft else np.array_equal(best, of_ants)
        finite = np.isfinite(history.mean)
        assert np.all(history.mean[finite] >= history.iteration_best[finite] - 1e-9)
        assert result.length == pytest.approx(best[-1]) or (algorithm.windows and result.length < best[-1])


@pytest.mark.parametrize("name", ALGORITHMS)
def test_pheromone_keeps_its_bounds(name: str, problem: an.Problem) -> None:
    colony = Colony(problem, one_colony(ALGORITHMS[name]), seed=1)
    for _ in colony:
        low, high = colony._state.bounds
        edges = colony.task.grid_graph.graph.neighbours < len(colony.task.grid_graph)
        assert colony.tau[edges].min() >= low > 0
        assert colony.tau[edges].max() <= high
        assert np.isfinite(colony.tau[edges]).all()


@pytest.mark.parametrize("row", COVERING, ids=lambda row: "-".join(str(value) for value in row.values()))
def test_every_composition_equals_its_twin(row: dict[str, Any]) -> None:
    colony = Colony(random_problem(31, side=7), one_colony(algorithm_of(row, ants=8, iterations=8)), seed=9)
    twin = twin_of(colony)
    for t in range(1, 9):
        colony.step()
        twin.iterate(t)
        assert_equal(colony, twin)


@pytest.mark.parametrize("name", sorted(set(PRESETS) - {"traditional"}))
def test_better_than_a_blind_walk(name: str) -> None:
    """A walk with neither pheromone nor heuristic, as many ants and iterations, on the 20x20 stand-in."""
    problem = an.Problem.from_cells(maps.builtin("equiv20"), *maps.builtin_query("equiv20"), corner_rule="allow")
    blind = an.npaco(alpha=0, beta=0, heuristic="edge")
    ours, theirs = (
        [an.solve(problem, algorithm, seed=seed).length for seed in range(5)] for algorithm in (PRESETS[name](), blind)
    )
    assert max(ours) < min(theirs)


@pytest.mark.parametrize(
    ("choices", "reason"),
    [
        ({"pheromone": "max_min", "rho": 0}, "rho above 0"),
        ({"pheromone": "best_so_far", "rho": 0}, "rho above 0"),
        ({"pheromone": "best_and_turns", "rho": 1}, "rho below 1"),
        ({"transition": "pseudo_random", "q0_min": 1, "q0_max": 1}, "same way"),
        ({"pheromone": "rank_based", "elite": 0}, "whole number"),
        ({"transition": "pseudo_random", "q0_relief": 0}, "above 0"),
    ],
)
def test_parts_that_do_not_fit_are_refused_with_the_reason(choices: dict[str, Any], reason: str) -> None:
    with pytest.raises(ParameterError, match=reason):
        an.npaco(**choices)


def test_what_is_kept_cannot_be_written_to() -> None:
    """A built-in map, and what is worked out from it, serves all problems of a process."""
    problem = an.Problem.from_cells(an.maps.builtin("equiv20"), (0, 0), (19, 19))
    result = an.solve(problem, an.npaco(ants=5, iterations=5))
    path, graph = result.path, problem.graph
    kept = {
        "map": [problem.grid.cells],
        "problem": [problem.moves, problem.passable],
        "graph": [graph.flat, graph.cells, graph.distances_to(0)],
        "path": [path.cells, path.points, path.headings],
        "result": [*result.history, result.pheromone],
    }
    open_to_writing = [name for name, arrays in kept.items() if any(array.flags.writeable for array in arrays)]
    assert open_to_writing == []


def test_arrays_for_kernels_are_writeable() -> None:
    """Numba would compile kernels a second time for others."""
    problem = an.Problem.from_cells(an.maps.builtin("equiv20"), (0, 0), (19, 19))
    assert problem.flat_moves.flags.writeable
    assert np.shares_memory(problem.flat_moves, problem.moves)
    assert all(array.flags.writeable for array in problem.graph.graph)
