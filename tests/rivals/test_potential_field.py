"""The potential field: its formula, its descent, the trap that it is known for."""

from __future__ import annotations

import numpy as np
import pytest

import antnav as an
from antnav.kernels import walk_kernels
from antnav.rivals import PotentialField
from tests.conftest import grid_of
from tests.rivals import naive
from tests.rivals.test_encoding import RULES, TRAP, TRAP_ENDS, random_problem


@pytest.mark.parametrize("rule", RULES)
def test_potential_equals_the_formula(rule: str) -> None:
    problem = random_problem(4, rule)
    field = PotentialField(attraction=2.0, repulsion=30.0, reach=2.5)
    got = field.potential(problem)
    padded = np.pad(problem.passable, 1)
    blocked = np.argwhere(~padded)
    for cell in np.ndindex(padded.shape):
        if not padded[cell]:
            assert got[cell] == np.inf
            continue
        d = np.hypot(*(blocked - cell).T).min()
        rho = np.hypot(cell[0] - 1 - problem.goal_cell[0], cell[1] - 1 - problem.goal_cell[1])
        push = 30.0 / 2 * (1 / d - 1 / 2.5) ** 2 if d <= 2.5 else 0.0
        assert got[cell] == pytest.approx(rho**2 + push)


@pytest.mark.parametrize("rule", RULES)
def test_descent_takes_the_lowest_legal_neighbour(rule: str) -> None:
    problem = random_problem(5, rule)
    potential = PotentialField().potential(problem)
    ends = problem.to_flat(problem.start_cell), problem.to_flat(problem.goal_cell)
    cells = walk_kernels.descend(problem.flat_moves, problem.width, potential.ravel(), *ends)
    trail = [tuple(int(x) for x in cell) for cell in problem.from_flat(cells)]
    for place, a in enumerate(trail):
        if a == problem.goal_cell:
            break
        around = [(a[0] + i, a[1] + j) for i in (-1, 0, 1) for j in (-1, 0, 1) if i or j]
        around = [b for b in around if naive.legal(problem, a, b)]
        lowest = min((potential[b[0] + 1, b[1] + 1] for b in around), default=np.inf)
        if place + 1 < len(trail):
            b = trail[place + 1]
            assert b in around
            assert b == problem.goal_cell or potential[b[0] + 1, b[1] + 1] == lowest < potential[a[0] + 1, a[1] + 1]
        else:
            assert lowest >= potential[a[0] + 1, a[1] + 1]


def test_wandering_follows_the_draws() -> None:
    problem = an.Problem.from_cells(grid_of("....", "####"), (0, 1), (0, 3))
    ends = problem.to_flat((0, 1)), problem.to_flat((0, 3))
    draws = np.array([0.49, 0.99, 0.5, 0.99, 0.0])  # of two ways, the left one below 0.5; the goal ends the walk
    walk = walk_kernels.wander(problem.flat_moves, problem.width, *ends, draws)
    assert problem.from_flat(walk)[:, 1].tolist() == [
        1,
        0,
        1,
        2,
        3,
    ]  # of two ways the left one below 0.5; the goal ends it


DRAWS = np.array([0.49, 0.99, 0.5, 0.99, 0.0])


def test_open_ground_needs_no_escape() -> None:
    problem = an.Problem.from_cells(grid_of(*["........"] * 8), (1, 1), (6, 6))
    result = an.solve(problem, PotentialField(escapes=0))
    assert result.length == pytest.approx(result.optimum)
    assert result.steps == 5


def test_the_trap_holds_it_and_says_so() -> None:
    result = an.solve(an.Problem.from_cells(TRAP, *TRAP_ENDS), PotentialField(escapes=0))
    assert (result.status, result.path) == (an.Status.NO_PATH, None)
    assert "stuck in a local minimum at cell (3, 5)" in result.notes[0]


@pytest.mark.parametrize("seed", range(5))
def test_random_walks_lead_out_of_the_trap(seed: int) -> None:
    problem = an.Problem.from_cells(TRAP, *TRAP_ENDS)
    result = an.solve(problem, PotentialField(), seed=seed)
    assert result.path is not None
    assert an.check_path(result.path, problem) == pytest.approx(result.length)
    assert len({tuple(cell) for cell in result.path.cells.tolist()}) == len(result.path)  # loops are cut out
    assert result.iterations > 1
