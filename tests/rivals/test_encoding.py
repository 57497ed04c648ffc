"""The path encoding: kernels against their twins, finite costs, exact segments."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

import antnav as an
from antnav.errors import ParameterError
from antnav.rivals import Encoding, Segments
from antnav.search import exact
from tests.conftest import grid_of
from tests.rivals import naive

RULES = ["allow", "graze", "forbid"]

#: Start inside, goal behind: out at the left, round an arm, and back takes at least four straight lines.
TRAP = grid_of(
    ".........",
    ".######..",
    "......#..",
    "......#..",
    "......#..",
    ".######..",
    ".........",
)
TRAP_ENDS = ((3, 5), (3, 8))


def random_problem(seed: int, rule: str) -> an.Problem:
    rng = np.random.default_rng(seed)
    while True:
        cells = (rng.random((9, 12)) < 0.3).astype(np.uint8)
        cells[0, 0] = cells[8, 11] = 0
        problem = an.Problem.from_cells(an.GridMap(cells), (0, 0), (8, 11), corner_rule=rule)
        if problem.connected:
            return problem


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("seed", range(5))
def test_straight_walks_equal_their_twin(rule: str, seed: int) -> None:
    encoding = Encoding(random_problem(seed, rule), points=3, penalty=7.0)
    rng = np.random.default_rng(seed)
    for vector in rng.uniform(-3, 14, (60, encoding.dimension)):  # some points lie outside the map
        walk = encoding.walk(vector)
        cells, cost = naive.straight_walk(encoding, vector.tolist())
        assert encoding.decode(vector).tolist() == [list(cell) for cell in cells]
        assert encoding.cost_of(walk) == pytest.approx(cost, abs=1e-9)
        if walk.illegal == 0:
            assert an.check_path(encoding.decode(vector), encoding.problem) == pytest.approx(walk.length)


@pytest.mark.parametrize("rule", RULES)
def test_exact_walks_are_paths_over_the_control_cells(rule: str) -> None:
    problem = random_problem(3, rule)
    encoding = Encoding(problem, points=2, segments=Segments.EXACT)
    for vector in np.random.default_rng(0).uniform(-0.5, 11.5, (40, 4)):
        walk = encoding.walk(vector)
        assert walk.illegal == 0
        assert an.check_path(encoding.decode(vector), problem) == pytest.approx(walk.length)
        places = naive.stops(encoding, vector.tolist())
        parts = [exact.distance_field(problem, a)[b] for a, b in pairwise(places)]
        assert walk.length == pytest.approx(sum(parts))


def test_control_points_become_the_nearest_reachable_cells() -> None:
    problem = random_problem(1, "forbid")
    encoding = Encoding(problem)
    reachable = np.argwhere(problem.reachable)
    for cell in np.ndindex(problem.grid.shape):
        nearest = problem.from_flat(encoding.nearest[cell])
        assert problem.reachable[tuple(nearest)]
        assert np.hypot(*(nearest - cell)) == pytest.approx(np.hypot(*(reachable - cell).T).min())


def test_a_corner_is_walked_round_where_it_must_not_be_cut() -> None:
    grid = grid_of("..", "#.")
    for rule, length in [("allow", 2**0.5), ("graze", 2**0.5), ("forbid", 2.0)]:
        problem = an.Problem.from_cells(grid_of("..", ".#", ".."), (0, 0), (2, 1), corner_rule=rule)
        walk = Encoding(problem, points=1).walk([1.0, 0.0])
        assert (walk.illegal, walk.length) == (0, pytest.approx(1 + length)), grid


def test_the_trap_cannot_be_said_in_one_straight_control_point() -> None:
    problem = an.Problem.from_cells(TRAP, *TRAP_ENDS)
    encoding = Encoding(problem, points=1)
    assert min(encoding.walk(cell).illegal for cell in np.ndindex(TRAP.shape)) > 0
    assert Encoding(problem, points=1, segments=Segments.EXACT).walk([3, 5]).length == exact.optimum(problem).length


@pytest.mark.parametrize("arguments", [{"points": 0}, {"penalty": 0.0}, {"penalty": float("nan")}])
def test_parameters_out_of_range_are_refused(arguments: dict[str, float]) -> None:
    with pytest.raises(ParameterError):
        Encoding(random_problem(0, "allow"), **arguments)  # type: ignore[arg-type]
