"""The kernels against their slow twins, draw for draw, and against laws worked out by hand."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace

import msgspec
import numpy as np
import pytest

import antnav as an
from antnav.ants.presets import PRESETS
from antnav.colony.colony import Colony, Task, whole_task
from antnav.colony.parts import Deadlock, PheromoneRule
from antnav.colony.parts.memory import KnownPath
from antnav.kernels import ant_kernels
from antnav.kernels.graph import Graph, slots_along
from antnav.search import exact
from antnav.world.moves import SLOT_ANGLES
from tests.conftest import grid_of
from tests.kernels import naive


def random_problem(
    seed: int, side: int = 9, density: float = 0.3, rule: str = "allow", *, back: bool = False
) -> an.Problem:
    """The first solvable random map of a seed, corner to corner, or back: then the start is not node 0."""
    rng = np.random.default_rng(seed)
    while True:
        cells = (rng.random((side, side + 2)) < density).astype(np.uint8)
        cells[0, 0] = cells[-1, -1] = 0
        ends = [(0, 0), (side - 1, side + 1)]
        problem = an.Problem.from_cells(an.GridMap(cells), *(ends[::-1] if back else ends), corner_rule=rule)
        if problem.connected:
            return problem


def one_colony(algorithm: an.Algorithm) -> an.Algorithm:
    """The algorithm's ants on the whole map, without its stages and windows."""
    return replace(algorithm, decomposition=None, coarse=0, windows=0, colonies=1)


def without_passes(colony: Colony) -> Colony:
    """The colony as on a large map, where rows of pheromone wait until an ant comes."""
    colony._choices = colony._choices._replace(passes=False)
    return colony


def twin_of(colony: Colony) -> naive.NaiveColony:
    """A naive colony with the same graph, heuristic, pheromone and choices."""
    graph, state, choices = colony.task.grid_graph.graph, colony._state, colony._choices
    n = len(graph.neighbours)
    neighbours, eta, tau = [], {}, {}
    for i in range(n):
        slots = [k for k in range(8) if graph.neighbours[i, k] < n]
        neighbours.append([(int(graph.neighbours[i, k]), float(graph.lengths[i, k]), k) for k in slots])
        for k in slots:
            j = int(graph.neighbours[i, k])
            tau[i, j] = float(state.tau[i, k])
            for heading in range(choices.headings):
                eta[i, j, heading - 1 if heading else None] = float(state.eta[i * choices.headings + heading, k])
    task = colony.task
    names = ("pheromone", "deadlock", "deposit", "local_search", "transition")
    parts = [str(getattr(task.algorithm, name)) for name in names]
    return naive.NaiveColony(
        neighbours, eta, parts, choices, tau, task.seed, task.colony, float(state.bounds[0]), SLOT_ANGLES.tolist()
    )


def assert_equal(colony: Colony, twin: naive.NaiveColony) -> None:
    """Pheromone, best path, visits and history are the same to the last bit (entropy: a logarithm, to 1e-12)."""
    graph = colony.task.grid_graph.graph
    n = len(graph.neighbours)
    for i in range(n):
        for k, j in enumerate(graph.neighbours[i]):
            if j < n:
                assert colony.tau[i, k] == twin.tau[i, int(j)], (i, int(j))
    best = colony.best_nodes
    assert (None if best is None else best.tolist()) == twin.best_path
    assert colony._state.visits.tolist() == twin.visits
    expected = ant_kernels.History(*(np.array(column) for column in zip(*twin.records, strict=True)))
    for name, mine, theirs in zip(ant_kernels.History._fields, colony.history, expected, strict=True):
        np.testing.assert_allclose(mine, theirs, rtol=1e-12 if name == "entropy" else 0, err_msg=name)


@pytest.mark.parametrize(
    ("pheromone", "deadlock", "seed"),
    [(p, d, s) for (p, d), s in zip(itertools.product(PheromoneRule, Deadlock), range(100, 200), strict=False)],
)
def test_colony_equals_its_naive_twin(pheromone: PheromoneRule, deadlock: Deadlock, seed: int) -> None:
    problem = random_problem(seed)
    choices = {"ants": 13, "iterations": 12, "beta": 2, "rho": 0.2} | (
        {"switch": 0.5} if deadlock is Deadlock.HYBRID else {}
    )
    algorithm = an.npaco(pheromone=pheromone, deadlock=deadlock, heuristic="sum", **choices)
    colony = Colony(problem, algorithm, seed)
    colony = without_passes(colony) if seed % 2 else colony
    twin = twin_of(colony)
    for t in range(1, 13):
        colony.step()
        twin.iterate(t)
        assert_equal(colony, twin)
    retracts = deadlock in {Deadlock.HYBRID, Deadlock.RETRACT}
    assert retracts or any(record[4] for record in twin.records), "the case should meet dead ends"


@pytest.mark.parametrize("pheromone", PheromoneRule)
@pytest.mark.parametrize("longer", [0.0, 1.5])
def test_a_path_that_is_known_before_equals_the_twins(pheromone: PheromoneRule, longer: float) -> None:
    """The optimum, which stays the best to the end, and one that ants beat."""
    problem = random_problem(7)
    algorithm = an.npaco(pheromone=pheromone, heuristic="sum", ants=5, iterations=6, beta=2, rho=0.2)
    path = exact.shortest_path(problem).path
    assert path is not None
    nodes = np.array([problem.graph.node(tuple(cell)) for cell in path.cells.tolist()], np.int32)
    cost = path.length + longer
    colony = Colony.of(msgspec.structs.replace(whole_task(problem, algorithm, 3), known=KnownPath(nodes, cost)))
    assert (colony.best_length, colony.best_nodes.tolist()) == (cost, nodes.tolist())
    twin = twin_of(colony)
    twin.best, twin.best_path = cost, nodes.tolist()
    for t in range(1, 7):
        colony.step()
        twin.iterate(t)
        assert_equal(colony, twin)
    assert colony.history.best[0] <= cost
    assert longer or (colony.history.best == cost).all()


def test_equal_counts_of_moves_are_equal_lengths() -> None:
    """Sums of floats would rank ants by rounding, and call it progress when the best is 1e-15 shorter."""
    ties = 0
    for seed in range(10):
        colony = Colony(random_problem(seed, side=20, density=0.1), an.npaco(ants=30, iterations=30), seed)
        colony.step(30)
        lengths = colony._state.length[colony._state.order[: colony.last.arrived]]
        counts = [np.array(np.diff(colony.task.grid_graph.cells[path], axis=0)) for path in colony.ant_paths()]
        exact = {((abs(move).sum(axis=1) == 1).sum(), (abs(move).sum(axis=1) == 2).sum()) for move in counts}
        assert len(set(lengths.tolist())) == len(exact)
        ties += len(lengths) - len(exact)
        gains = -np.diff(colony.history.best)
        assert np.all((gains == 0) | (gains > 1e-6) | np.isnan(gains))
    assert ties > 20, "the case should have ties"


@pytest.mark.parametrize("deadlock", list(Deadlock))
def test_a_graph_that_is_no_grid_equals_the_twin(deadlock: Deadlock) -> None:
    """Edges between regions have any length, and the slots of their two ends say nothing of each other."""
    short = an.prepare(random_problem(3, side=24, density=0.4).grid, "allow", block=4)
    regions = short.between(1 * 28 + 1, 24 * 28 + 26)
    algorithm = an.npaco(heuristic="detour", deadlock=deadlock, beta=0, ants=40, iterations=4, local_search="merge")
    colony = Colony.of(Task(regions, regions.start, regions.goal, algorithm, 4, seed=2))
    twin = twin_of(colony)
    for t in range(1, 5):
        colony.step()
        twin.iterate(t)
        assert_equal(colony, twin)
    lengths = colony._state.length[colony._state.status == ant_kernels.ARRIVED]
    assert len(lengths) > 2
    assert any(record[4] for record in twin.records) or deadlock in {Deadlock.RETRACT, Deadlock.HYBRID}


def test_deposits_in_the_direction_of_travel_equal_the_twin() -> None:
    colony = Colony(random_problem(4), an.npaco(deposit="forward", ants=9, iterations=8), 3)
    twin = twin_of(colony)
    colony.step(8)
    for t in range(1, 9):
        twin.iterate(t)
    assert_equal(colony, twin)


@pytest.mark.parametrize("name", sorted(PRESETS))
@pytest.mark.parametrize("seed", [21, 22])
def test_every_preset_equals_its_twin(name: str, seed: int) -> None:
    often = {"best_every": 4, "restart": 7} if name == "mmas" else {}
    algorithm = one_colony(PRESETS[name](ants=12, iterations=30, **often))
    colony = Colony(random_problem(seed, back=seed == 22), algorithm, seed)
    colony = without_passes(colony) if seed == 22 else colony
    twin = twin_of(colony)
    for t in range(1, 31):
        colony.step()
        twin.iterate(t)
        assert_equal(colony, twin)


@pytest.mark.parametrize("name", sorted(PRESETS))
@pytest.mark.parametrize("ants", [5, ant_kernels.BATCH + 5])
@pytest.mark.parametrize("steps", [1, 7, 90])
def test_rows_that_wait_catch_up_to_the_last_bit(name: str, ants: int, steps: int) -> None:
    """With 90 iterations most rows meet their bounds; pheromone that somebody writes in between may be outside them."""
    often = {"best_every": 4, "restart": 7} if name == "mmas" else {}
    algorithm = one_colony(PRESETS[name](ants=ants, iterations=90, **often))
    problem = random_problem(31, side=20, density=0.2)
    passing, waiting = Colony(problem, algorithm, 3), without_passes(Colony(problem, algorithm, 3))
    while passing.iteration < 90:
        for colony in (passing, waiting):
            colony.step(steps)
        if passing.iteration == 14:
            for colony in (passing, waiting):
                colony.tau[::3] = 1e-9
                colony.tau[1::5, 2] *= 1.5
    assert passing.tau.tobytes() == waiting.tau.tobytes()
    assert [column.tobytes() for column in passing.history] == [column.tobytes() for column in waiting.history]
    assert [path.tolist() for path in passing.ant_paths()] == [path.tolist() for path in waiting.ant_paths()]


def test_pheromone_in_hand_stays_up_to_date() -> None:
    """Whoever has it sees what later steps do, also where no ant comes by."""
    problem = random_problem(5, side=20, density=0.2)
    colony, other = (without_passes(Colony(problem, an.npaco(ants=2, iterations=9), 3)) for _ in range(2))
    tau = colony.tau
    colony.step(4), colony.step(5), other.step(9)
    assert tau.tobytes() == other.tau.tobytes()
    assert np.count_nonzero(tau == np.median(tau)) > tau.size / 4, "ants should not have been everywhere"


def test_after_a_step_back_to_the_start_there_is_no_last_move() -> None:
    """The pocket in the corner is next to the start, from which ants then see three other cells."""
    problem = an.Problem.from_cells(grid_of(".####", "#....", "#....", "#...."), (1, 1), (3, 4), corner_rule="allow")
    for deadlock in ("retract", "backtrack"):
        colony = Colony(problem, an.npaco(heuristic="astar", deadlock=deadlock, beta=1, ants=30, iterations=4), 5)
        twin = twin_of(colony)
        for t in range(1, 5):
            colony.step()
            twin.iterate(t)
        assert_equal(colony, twin)


def test_local_update_and_headings_with_other_powers_equal_the_twin() -> None:
    algorithm = an.acs(heuristic="astar", alpha=2, ants=70, iterations=6, deadlock="luo", pheromone="rank_based")
    colony = Colony(random_problem(23), algorithm, 1)
    twin = twin_of(colony)
    colony.step(6)
    for t in range(1, 7):
        twin.iterate(t)
    assert_equal(colony, twin)


@pytest.mark.parametrize("alpha", [0.0, 2.0, 3.0])
def test_other_powers_of_the_pheromone_equal_the_twin(alpha: float) -> None:
    colony = Colony(random_problem(5), an.npaco(alpha=alpha, ants=9, iterations=8), 3)
    twin = twin_of(colony)
    colony.step(8)
    for t in range(1, 9):
        twin.iterate(t)
    assert_equal(colony, twin)


def test_fractional_alpha_runs_close_to_the_twin() -> None:
    colony = Colony(random_problem(6), an.npaco(alpha=1.5, ants=9, iterations=3), 3)
    twin = twin_of(colony)
    colony.step(3)
    for t in range(1, 4):
        twin.iterate(t)
    assert colony.best_length == pytest.approx(twin.best)


def test_more_ants_than_fit_in_one_batch_equal_the_twin() -> None:
    colony = Colony(random_problem(7), an.npaco(ants=2 * ant_kernels.BATCH + 5, iterations=4), 11)
    twin = twin_of(colony)
    colony.step(4)
    for t in range(1, 5):
        twin.iterate(t)
    assert_equal(colony, twin)


def test_another_colony_number_draws_other_numbers() -> None:
    task = whole_task(random_problem(8), an.npaco(iterations=3), 1)
    tasks = [task, Task(task.grid_graph, task.start, task.goal, task.algorithm, 3, 1, colony=1)]
    paths = [Colony.of(each) for each in tasks]
    for colony in paths:
        colony.step(1)
    assert [p.tolist() for p in paths[0].ant_paths()] != [p.tolist() for p in paths[1].ant_paths()]


def test_random_numbers_are_those_of_splitmix64() -> None:
    # First outputs for seed 1234567 of the public reference implementation (Vigna, splitmix64.c).
    expected = [6457827717110365317, 3203168211198807973, 9817491932198370423, 4593380528125082431]
    key = np.uint64(1234567)
    drawn = [ant_kernels.uniform(key, draw) for draw in (1, 2, 3, 4)]
    assert drawn == [(number >> 11) * 2.0**-53 for number in expected]


def test_keys_agree_with_the_twin() -> None:
    for numbers in itertools.product((0, 7, 2**64 - 1), (0, 3), (1, 50), (0, 63)):
        assert int(ant_kernels.stream(np.uint64(numbers[0]), *numbers[1:])) == naive.stream(*numbers)


def test_first_step_follows_eq_3_1() -> None:
    # From the middle cell of the top row, ants see 5 neighbours; 20000 ants must split as tau eta^beta says.
    grid = grid_of("...", "...", "...")
    problem = an.Problem.from_cells(grid, (0, 1), (2, 1), corner_rule="allow")
    ants = 20_000
    colony = Colony(problem, an.traditional(ants=ants, iterations=1, beta=1), seed=1)
    colony.step()
    first = np.bincount(colony._state.path[:, 1], minlength=9) / ants
    straight, diagonal = 1.0, 1.0 / math.sqrt(2)
    total = 3 * straight + 2 * diagonal
    expected = np.array([straight, 0, straight, diagonal, straight, diagonal, 0, 0, 0]) / total
    standard_error = np.sqrt(expected * (1 - expected) / ants)
    assert np.all(np.abs(first - expected) <= 4.5 * standard_error)


def test_tabu_shares_out_what_the_visited_cell_would_have_got() -> None:
    # a b       From a to d: b, c and d are equally near. At c, coming from a, only b and d are left: half and half.
    # c d       (edge heuristic, beta 0: all weights are equal.)
    problem = an.Problem.from_cells(grid_of("..", ".."), (0, 0), (1, 1), corner_rule="allow")
    ants = 30_000
    colony = Colony(problem, an.traditional(ants=ants, iterations=1, beta=0), seed=2)
    colony.step()
    paths = colony.ant_paths()
    share = {steps: sum(len(path) - 1 == steps for path in paths) / ants for steps in (1, 2, 3)}
    for steps, probability in {1: 1 / 3, 2: 1 / 3, 3: 1 / 3}.items():
        assert abs(share[steps] - probability) < 4.5 * math.sqrt(probability * (1 - probability) / ants)


def test_pheromone_never_falls_below_its_bound() -> None:
    algorithm = an.npaco(iterations=30)
    colony = Colony(random_problem(9), algorithm, 0)
    lowest = algorithm.tau_min * algorithm.tau0
    for _ in colony:
        assert colony.tau.min() >= lowest
    assert colony.tau.min() == lowest, "eq. (4.1) takes so much away that the bound is met"


def test_eq_4_1_by_hand() -> None:
    # A corridor of 4 cells: every ant walks the same 3 edges, L = 3. T = 10, t = 1, so c = 1: the best 10 ants add
    # 1/3 each and the worst one takes 1/3 away: tau = 0.9 * 1 + 10/3 - 1/3 = 3.9. Both directions.
    problem = an.Problem.from_cells(grid_of("...."), (0, 0), (0, 3))
    colony = Colony(problem, an.npaco(ants=20, iterations=10), seed=0)
    colony.step()
    neighbours = colony.task.grid_graph.graph.neighbours
    np.testing.assert_allclose(colony.tau[neighbours < 4], 3.9, rtol=1e-12)


def test_eq_4_2_by_hand() -> None:
    # A corridor with the start in the middle: ants that go west die in cell 0, after one or two steps.
    problem = an.Problem.from_cells(grid_of("....."), (0, 2), (0, 4))
    algorithm = an.npaco(ants=40, iterations=2, beta=0, deadlock="luo", rho=0, punish=0.5, pheromone="ant_system")
    colony = Colony(problem, algorithm, seed=0)
    colony.step()
    lost = int(colony.history.lost[0])
    assert 0 < lost < 40
    west = {(1, 0): 0.5 ** math.ceil(lost / 3), (2, 1): 0.5 ** math.ceil(lost / 3), (0, 1): 1.0, (1, 2): 1.0}
    for (i, j), expected in west.items():
        slot = colony.task.grid_graph.graph.neighbours[i].tolist().index(j)
        assert colony.tau[i, slot] == pytest.approx(expected, rel=1e-12)


def test_lost_ants_are_those_that_met_a_dead_end_and_did_not_arrive() -> None:
    # With full retraction nobody is lost early on; with death everybody in the pocket is.
    problem = an.Problem.from_cells(grid_of("....."), (0, 2), (0, 4))
    retracting = Colony(problem, an.npaco(ants=40, iterations=10, beta=0, switch=1.0), seed=0)
    dying = Colony(problem, an.npaco(ants=40, iterations=10, beta=0, deadlock="death"), seed=0)
    retracting.step()
    dying.step()
    assert retracting.last.lost == 0
    assert retracting.last.arrived == 40
    assert dying.last.lost == 40 - dying.last.arrived > 0


@pytest.mark.parametrize("swapped", [False, True])
def test_merged_paths_by_hand(swapped: bool) -> None:
    """Two ants on a 3x7 map: one is better on the left, the other on the right; the merged path has both."""
    problem = an.Problem.from_cells(an.GridMap(np.zeros((3, 7), np.uint8)), (1, 0), (1, 6), corner_rule="allow")
    colony = Colony(problem, an.npaco(ants=2, iterations=1, local_search="merge"), seed=0)
    graph, state = colony.task.grid_graph, colony._state
    one = [(1, 0), (1, 1), (1, 2), (1, 3), (0, 3), (0, 4), (0, 5), (0, 6), (1, 6)]
    other = [(1, 0), (2, 0), (2, 1), (2, 2), (2, 3), (1, 3), (1, 4), (1, 5), (1, 6)]
    if swapped:
        one, other = other, one
    for ant, cells in enumerate((one, other)):
        nodes = [graph.node(cell) for cell in cells]
        state.path[ant, : len(nodes)] = nodes
        pairs = itertools.pairwise(nodes)
        state.slots[ant, : len(nodes) - 1] = [graph.graph.neighbours[i].tolist().index(j) for i, j in pairs]
        state.steps_on_path[ant] = len(nodes) - 1
        state.length[ant] = 8
    state.order[:2] = 0, 1
    ant_kernels._merge(graph.graph, state, 2, 0.0)
    assert state.steps_on_path.tolist() == [6, 8]
    assert graph.cells[state.path[0, :7]].tolist() == [[1, col] for col in range(7)]
    assert (state.length[0], state.place.max()) == (6, 0)
    slots = [graph.graph.neighbours[state.path[0, s]].tolist().index(state.path[0, s + 1]) for s in range(6)]
    assert state.slots[0, :6].tolist() == slots
    twin = twin_of(colony)
    paths = [[graph.node(cell) for cell in cells] for cells in (one, other)]
    assert twin.merge(*paths) == state.path[0, :7].tolist()


def test_grafted_pieces_by_hand() -> None:
    """Both ants are longer than the best path so far, and each is better on one side."""
    problem = an.Problem.from_cells(an.GridMap(np.zeros((3, 7), np.uint8)), (1, 0), (1, 6), corner_rule="allow")
    colony = Colony(problem, an.npaco(ants=2, iterations=1, graft=True), seed=0)
    graph, state = colony.task.grid_graph, colony._state
    best = [(1, 0), (2, 0), (2, 1), (2, 2), (1, 3), (0, 3), (0, 4), (0, 5), (1, 6)]
    left = [(1, 0), (1, 1), (1, 2), (1, 3), (1, 4), (2, 4), (2, 5), (2, 6), (1, 6)]
    right = [(1, 0), (0, 0), (0, 1), (0, 2), (1, 3), (1, 4), (1, 5), (1, 6)]

    def told(path: np.ndarray, slots: np.ndarray, cells: list[tuple[int, int]]) -> int:
        nodes = [graph.node(cell) for cell in cells]
        path[: len(nodes)] = nodes
        slots[: len(nodes) - 1] = [graph.graph.neighbours[i].tolist().index(j) for i, j in itertools.pairwise(nodes)]
        return len(nodes) - 1

    for ant, cells in enumerate((left, right)):
        state.steps_on_path[ant] = told(state.path[ant], state.slots[ant], cells)
    state.best_steps[0] = told(state.best_path, state.best_slots, best)
    state.order[:2] = 0, 1
    assert ant_kernels._graft(graph.graph, state, 2, 0.0, 99.0) == 6
    assert graph.cells[colony.best_nodes].tolist() == [[1, col] for col in range(7)]
    assert state.place.max() == 0


def test_taut_paths_by_hand() -> None:
    """Around a wall and in a zigzag: straight to the wall's end, and straight on; runs that cross make no loop."""
    problem = an.Problem.from_cells(grid_of("......", "..#...", "......"), (2, 0), (2, 5), corner_rule="allow")
    colony = Colony(problem, an.npaco(ants=1, iterations=1, local_search="taut"), seed=0)
    graph, state = colony.task.grid_graph, colony._state
    cells = [(2, 0), (1, 0), (0, 0), (0, 1), (0, 2), (0, 3), (0, 4), (1, 5), (2, 5)]
    nodes = np.array([graph.node(cell) for cell in cells], np.int32)
    state.path[0, :9], state.slots[0, :8] = nodes, slots_along(graph.graph, nodes)
    state.order[0], state.steps_on_path[0], state.length[0] = 0, 8, 7 + math.sqrt(2)
    ant_kernels._pull_taut(graph.graph, state, 0.0)
    assert state.steps_on_path[0] == 5
    assert graph.cells[state.path[0, :6]].tolist() == [[2, col] for col in range(6)]
    assert state.length[0] == 5
    assert twin_of(colony).tauten(nodes.tolist()) == state.path[0, :6].tolist()
    assert state.place.max() == 0


def test_taut_paths_equal_the_twins() -> None:
    """Of wanderers, whose paths are long."""
    shortened = 0
    for seed in range(12):
        problem = random_problem(seed, side=14, density=0.15, rule="forbid" if seed % 2 else "allow")
        colony = Colony(problem, an.npaco(ants=8, iterations=10, beta=0), seed)
        colony.step()
        twin, graph, state = twin_of(colony), colony.task.grid_graph.graph, colony._state
        for path in colony.ant_paths():
            slots = slots_along(graph, path).astype(np.uint8)
            count = ant_kernels._taut(
                graph, path, slots, len(path) - 1, state.place, state.merged_path, state.merged_slots
            )
            found = state.merged_path[: count + 1].tolist()
            assert len(set(found)) == len(found)
            assert slots_along(graph, np.array(found)).tolist() == state.merged_slots[:count].tolist()
            expected = twin.tauten(path.tolist())
            assert found == expected or twin.length(found) == twin.length(expected) == twin.length(path.tolist())
            assert state.place.max() == 0
            shortened += len(found) < len(path)
    assert shortened > 50


def test_runs_that_cross_make_no_loop() -> None:
    """Runs 0 -> 6 -> 2 by slot 0 and 3 -> 6 -> 5 by slot 1 are the shorter ways from 0 to 2 and from 3 to 5."""
    neighbours, lengths = np.full((7, 8), 7, np.int32), np.ones((7, 8))
    for start, slot, end in [(0, 0, 6), (6, 0, 2), (3, 1, 6), (6, 1, 5)]:
        neighbours[start, slot] = end
    for start, length in enumerate([10, 10, 1, 10, 10]):  # the path itself, in turning directions
        neighbours[start, 2 + start % 2], lengths[start, 2 + start % 2] = start + 1, length
    graph = Graph(neighbours, lengths, np.zeros((7, 8), np.uint8))
    path, slots = np.arange(6, dtype=np.int32), np.array([2, 3, 2, 3, 2], np.uint8)
    place, new_path, new_slots = np.zeros(7, np.int32), np.empty(7, np.int32), np.empty(7, np.uint8)
    assert ant_kernels._taut(graph, path, slots, 5, place, new_path, new_slots) == 2
    assert (new_path[:3].tolist(), new_slots[:2].tolist()) == ([0, 6, 5], [0, 1])
    assert place.max() == 0


@pytest.mark.parametrize(("turning", "steps"), [(0.0, 6), (9.0, 8)])
def test_woven_paths_by_hand(turning: float, steps: int) -> None:
    """Ants that share no cell but the ends, side by side: over to the other's and straight on, unless turns cost."""
    problem = an.Problem.from_cells(an.GridMap(np.zeros((4, 7), np.uint8)), (2, 0), (2, 6), corner_rule="allow")
    colony = Colony(problem, an.npaco(ants=3, iterations=1, local_search="weave"), seed=0)
    graph, state = colony.task.grid_graph, colony._state
    above = [(2, 0), (2, 1), (1, 2), (0, 3), (0, 4), (1, 5), (2, 6)]
    below = [(2, 0), (3, 0), (3, 1), (2, 2), (2, 3), (2, 4), (3, 5), (3, 6), (2, 6)]
    unseen = [(2, 0), (2, 1), (2, 2), (2, 3), (2, 4), (2, 5), (2, 6)]  # of an ant that did not arrive
    for ant, cells in enumerate((below, above, unseen)):
        nodes = np.array([graph.node(cell) for cell in cells], np.int32)
        state.path[ant, : len(nodes)], state.slots[ant, : len(nodes) - 1] = nodes, slots_along(graph.graph, nodes)
        state.steps_on_path[ant], state.length[ant] = len(nodes) - 1, 12.0
    state.order[:2] = 0, 1
    ant_kernels._weave(graph.graph, state, 2, turning)
    assert state.steps_on_path[0] == steps
    if turning == 0.0:
        woven = [(2, 0), (2, 1), (2, 2), (2, 3), (2, 4), (1, 5), (2, 6)]
        assert graph.cells[state.path[0, :7]].tolist() == [list(cell) for cell in woven]
        assert state.length[0] == pytest.approx(4 + 2 * math.sqrt(2))


def test_woven_is_no_longer_than_merged() -> None:
    """Of the same ants, in the first iteration: where one has the other's cells, it has its pieces."""
    shorter = 0
    for seed in range(10):
        problem = random_problem(seed, side=20)
        merged, woven = (
            Colony(problem, an.npaco(ants=8, heuristic="edge", beta=0, local_search=name), seed)
            for name in ("merge", "weave")
        )
        merged.step()
        woven.step()
        assert woven.last.arrived == merged.last.arrived > 0
        assert woven.last.iteration_best <= merged.last.iteration_best
        shorter += woven.last.iteration_best < merged.last.iteration_best - 1e-6
    assert shorter > 0


@pytest.mark.parametrize("turning", [0.0, 0.7])
def test_a_graft_never_makes_the_best_path_dearer(turning: float) -> None:
    problem = random_problem(12, side=15)
    ends = problem.start_cell, problem.goal_cell
    problem = an.Problem.from_cells(problem.grid, *ends, corner_rule="allow", turning=turning)
    colony = Colony(problem, an.npaco(ants=10, graft=True, deposit="forward", local_search="merge"), seed=1)
    grafted = 0
    for one in colony:
        path = colony.best_path(problem)
        assert path is not None
        assert problem.objective.of(path.cells, problem.grid) == pytest.approx(one.best)
        grafted += one.best < one.iteration_best
    assert np.all(np.diff(colony.history.best) <= 0)
    assert grafted > 0


def test_max_min_begins_at_tau_max() -> None:
    colony = Colony(random_problem(9), an.mmas(ants=9, iterations=3, rho=0.02), seed=0)
    colony.step()
    assert colony.tau.min() == colony.tau.max() == pytest.approx(1 / (0.02 * colony.best_length))


def test_equal_paths_are_not_punished() -> None:
    """In a corridor the worst path is the best: it gets its reward."""
    colony = Colony(an.Problem.from_cells(grid_of("...."), (0, 0), (0, 3)), an.luo(ants=5, iterations=1, rho=0.1), 0)
    before = colony.tau.copy()
    colony.step()
    edges = colony.task.grid_graph.graph.neighbours < 4
    np.testing.assert_allclose(colony.tau[edges], 0.9 * before[edges] + 1 / 3, rtol=1e-12)


def test_a_choice_without_a_decomposition_is_refused() -> None:
    with pytest.raises(an.AntnavError, match="belongs to a Decomposition"):
        an.paco(decomposition=None, stage_one=5)
    assert an.preset("paco", name="mine").name == "mine"
