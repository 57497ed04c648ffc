"""Heuristics by hand: on a row of cells, an L-shaped way, and a bend."""

from __future__ import annotations

import math

import numpy as np
import pytest

import antnav as an
from antnav.colony.heuristic import heuristic_weights, initial_pheromone
from antnav.colony.parts import Blocks, Detour, Heuristic, Part, Target
from antnav.colony.parts.heuristic import AT_GOAL
from antnav.errors import ParameterError
from antnav.planner.planner import identity
from antnav.world.moves import STEPS
from tests.conftest import grid_of
from tests.kernels import naive
from tests.kernels.test_ant_kernels import random_problem, twin_of

# S . #      From S to G the corner must be walked around: 4 moves, though G is 2 * sqrt(2) away.
# . # #
# . . G
PROBLEM = an.Problem.from_cells(grid_of("..#", ".##", "..."), (0, 0), (2, 2))
GRAPH = PROBLEM.graph
START, GOAL = GRAPH.node((0, 0)), GRAPH.node((2, 2))

#: Blocks of two by two cells lie at (1/3, 1/3), (2, 1/2) and (2, 2), 1.675 and 1.5 cells apart. At (1, 0) the shares
#: of the first two are (2/3)(5/6) and (1/2)(3/4), below it (1/6)(5/6) and 3/4; of the third none.
UPPER, LOWER = math.dist((1 / 3, 1 / 3), (2, 0.5)) + 1.5, 1.5
SHARES = ((1 - (2 / 3) / 2) * (1 - (1 / 3) / 2), (1 - 1 / 2) * (1 - 0.5 / 2))
HERE = (SHARES[0] * UPPER + SHARES[1] * LOWER) / sum(SHARES)
NEXT = ((1 - (5 / 3) / 2) * (1 - (1 / 3) / 2), 1 - 0.5 / 2)
THERE = (NEXT[0] * UPPER + NEXT[1] * LOWER) / sum(NEXT)
BLOCKS = 1 / (1 + max(1 + THERE - HERE, 0))


def eta(heuristic: str, here: tuple, there: tuple, heading: int = 0, **choices: object) -> float:
    algorithm = an.npaco(heuristic=heuristic, **({"beta": 1} | choices))
    weights = heuristic_weights(algorithm, GRAPH, START, GOAL)
    slot = STEPS.index((there[0] - here[0], there[1] - here[1]))
    headings = len(weights) // len(GRAPH)
    return float(weights[GRAPH.node(here) * headings + heading, slot])


@pytest.mark.parametrize(
    ("heuristic", "here", "there", "expected"),
    [
        ("edge", (0, 0), (1, 0), 1.0),
        ("target", (0, 0), (1, 0), 1 / math.sqrt(5)),
        ("target", (2, 1), (2, 2), 1 / AT_GOAL),
        ("sum", (0, 0), (1, 0), 1 / (1 + math.sqrt(5))),
        ("geodesic", (0, 0), (1, 0), 1 / 3),
        ("geodesic", (0, 0), (0, 1), 1 / 5),
        ("detour", (0, 0), (1, 0), 1.0),
        ("detour", (0, 0), (0, 1), 1 / 3),  # one step away and one back: two cells wasted
        ("detour", (2, 0), (1, 0), 1 / 3),
        ("blocks", (1, 0), (2, 0), BLOCKS),
        ("octile", (0, 0), (1, 0), 1 / (3 - math.sqrt(2))),  # 1 + sqrt(2) remain of 2 sqrt(2): 2 - sqrt(2) are wasted
        ("octile", (2, 1), (2, 2), 1.0),
    ],
)
def test_eta_by_hand(heuristic: str, here: tuple, there: tuple, expected: float) -> None:
    assert eta(heuristic, here, there) == pytest.approx(expected)
    assert eta(heuristic, here, there, beta=3) == pytest.approx(expected**3)


@pytest.mark.parametrize("heuristic", [name for name in Heuristic if name is not Heuristic.AUTO])
@pytest.mark.parametrize("beta", [1, 3])
def test_every_heuristic_equals_its_twin(heuristic: Heuristic, beta: int) -> None:
    colony = an.Colony(random_problem(5), an.npaco(heuristic=heuristic, beta=beta, ants=1, iterations=1))
    twin, task = twin_of(colony), colony.task
    expected = naive.eta(heuristic, twin.neighbours, task.grid_graph.cells.tolist(), task.start, task.goal)
    assert twin.eta.keys() == expected.keys()
    for edge, value in expected.items():
        assert twin.eta[edge] == pytest.approx(value**beta, rel=1e-12), edge


def test_a_heuristic_without_a_formula_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delattr(Detour, "eta")
    with pytest.raises(ParameterError, match="formula"):
        an.Colony(PROBLEM, an.npaco(heuristic="detour"))


def test_the_automatic_heuristic_must_have_been_chosen() -> None:
    with pytest.raises(ParameterError, match="auto"):
        heuristic_weights(an.npaco(heuristic="auto"), GRAPH, START, GOAL)


def test_astar_counts_the_bend() -> None:
    south, east = STEPS.index((1, 0)), STEPS.index((0, 1))
    straight = 1.5 / 1.0  # q2 over the distance from (2, 1) to the goal
    turned = 1.5 / (1.0 + 2.0 + 10 / math.pi * math.pi / 2)
    assert eta("astar", (2, 0), (2, 1), heading=0) == pytest.approx(straight)
    assert eta("astar", (2, 0), (2, 1), heading=1 + east) == pytest.approx(straight)
    assert eta("astar", (2, 0), (2, 1), heading=1 + south) == pytest.approx(turned)
    with_start = 1.5 / (1.0 + math.sqrt(5))
    assert eta("astar", (2, 0), (2, 1), bend_with_start=True) == pytest.approx(with_start)


def test_openness_multiplies_by_the_share_of_free_neighbours() -> None:
    assert eta("edge", (0, 0), (1, 0), openness=2) == pytest.approx((2 / 8) ** 2)


def test_weights_are_zero_where_there_is_no_neighbour() -> None:
    closed = GRAPH.graph.neighbours == len(GRAPH)
    for heuristic in ("edge", "target", "sum", "geodesic", "detour"):
        weights = heuristic_weights(an.npaco(heuristic=heuristic), GRAPH, START, GOAL)
        assert (weights[closed] == 0).all()
        assert (weights[~closed] > 0).all()


def test_unequal_initial_pheromone_by_hand() -> None:
    tau = initial_pheromone(an.luo(tau0=2.0), GRAPH, START, GOAL)
    direct = math.sqrt(8)
    at = {cell: 1 + direct / (math.dist(cell, (0, 0)) + math.dist(cell, (2, 2))) for cell in ((0, 0), (1, 0))}
    slot = STEPS.index((1, 0))
    assert tau[START, slot] == pytest.approx(2.0 * (at[0, 0] + at[1, 0]) / 2)
    assert tau[GRAPH.node((1, 0)), 7 - slot] == tau[START, slot]


def test_the_default_heuristic_follows_the_map() -> None:
    assert an.paco().on(an.GridMap([[0] * 40])).heuristic == Target()
    large = an.paco().on(an.GridMap([[0] * 41]))
    assert large.heuristic == Detour()
    assert "detour ours" in str(large.certainty)
    switches = [an.paco().on(an.GridMap([[0] * side])).deadlock.switch for side in (20, 21, 30, 31, 40)]
    assert switches == [0.6, 0.7, 0.7, 0.8, 0.8]


@pytest.mark.parametrize(("side", "plain", "dear"), [(40, Target(), Blocks()), (41, Detour(), Detour())])
def test_the_default_heuristic_follows_costs(side: int, plain: Part, dear: Part) -> None:
    grid = an.GridMap(np.zeros((2, side), np.uint8))
    ends = (0, 0), (1, side - 1)
    problem = an.Problem.from_cells(grid, *ends, cost=an.costs.array(np.ones(grid.shape)))
    for algorithm in (an.paco(), an.paco_ls(), an.npaco()):
        assert algorithm.suited(problem).heuristic == dear
        assert algorithm.suited(an.Problem.from_cells(grid, *ends, turning=1.0)).heuristic == plain
        assert identity(algorithm, problem) == identity(algorithm.changed(heuristic=dear), problem)
    assert an.paco_large().suited(problem).heuristic == Detour()
    result = an.solve(problem, an.npaco(iterations=2))
    assert result.algorithm.heuristic == dear
    assert f"{dear.name} ours" in str(result.algorithm.certainty)


def test_certainty_says_what_was_changed() -> None:
    assert "modified" not in str(an.paco(ants=9, iterations=9, axis="row").certainty)
    changed = str(an.paco(deadlock="backtrack", search="half", beta=3).certainty)
    assert changed.endswith("modified: deadlock backtrack, beta 3, search half")
