"""Memory: a run that begins with the pheromone of another, on other ends, rules, maps and machines."""

from __future__ import annotations

import copy
import pickle
import threading
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import antnav as an
from antnav import maps
from antnav.ants.strategies import Context, strategy_of
from antnav.colony import colony
from antnav.errors import OutputError, ParameterError, ResultFormatError
from antnav.planner.memory import PATHS, Memory, turned
from antnav.run import spmd, stop
from tests.conftest import grid_of
from tests.plan.test_solve import fingerprint

ENDS = maps.builtin_query("equiv20")
PROBLEM = an.Problem.from_cells(maps.builtin("equiv20"), *ENDS, corner_rule="allow")
COLD = an.solve(PROBLEM, an.npaco(), remember=True)
QUICK = an.npaco(ants=10, iterations=5)


def known(result: an.Result) -> Memory:
    assert result.memory is not None
    return result.memory


def changed(cell: tuple[int, int], kind: an.Cell) -> an.GridMap:
    cells = PROBLEM.grid.cells.copy()
    assert cells[cell] != kind
    cells[cell] = kind
    return an.GridMap(cells)


def free_cell_beside_the_path() -> tuple[int, int]:
    """A cell of the path whose loss leaves a way."""
    for row, col in COLD.path.cells[1:-1].tolist():
        if an.Problem.from_cells(changed((row, col), an.Cell.OCCUPIED), *ENDS, corner_rule="allow").connected:
            return row, col
    raise AssertionError("every cell of the path is a bottleneck")


OPEN, WALL = free_cell_beside_the_path(), tuple(np.argwhere(PROBLEM.grid.cells == an.Cell.OCCUPIED)[40].tolist())
OTHERS = {
    "the same": PROBLEM,
    "another start and goal": an.Problem.from_cells(PROBLEM.grid, (0, 0), (19, 10), corner_rule="allow"),
    "the way back": an.Problem.from_cells(PROBLEM.grid, *ENDS[::-1], corner_rule="allow"),
    "another corner rule": an.Problem.from_cells(PROBLEM.grid, *ENDS, corner_rule="graze"),
    "a wall more": an.Problem.from_cells(changed(OPEN, an.Cell.OCCUPIED), *ENDS, corner_rule="allow"),
    "a wall less": an.Problem.from_cells(changed(WALL, an.Cell.FREE), *ENDS, corner_rule="allow"),
}


def begun_with(memory: Memory, problem: an.Problem, algorithm: an.Algorithm) -> NDArray[np.float64]:
    """The initial pheromone edge by edge, nan where the graph has no edge."""
    columns, graph = problem.grid.cols + 2, problem.graph
    rows = {
        (int(flat) // columns - 1, int(flat) % columns - 1): tau
        for flat, tau in zip(memory.flat, memory.tau, strict=True)
    }
    tau = np.full((len(graph), 8), np.nan)
    for node, slot in np.argwhere(graph.graph.neighbours < len(graph)):
        before = rows.get(tuple(graph.cells[node].tolist()), np.full(8, np.nan))[slot]
        scaled = max(before * (algorithm.tau0 / memory.tau0), algorithm.tau_min * algorithm.tau0)
        tau[node, slot] = algorithm.tau0 if np.isnan(before) else scaled
    return tau


@pytest.mark.parametrize("name", ["npaco", "paco", "paco_levels", "acs", "luo"])
def test_a_warm_run_begins_where_a_cold_one_ended(name: str) -> None:
    algorithm = an.preset(name)
    cold, warm = (an.solve(PROBLEM, algorithm, seed=1, warm=memory) for memory in (None, COLD.memory))
    assert warm.history.mean[0] < 0.7 * cold.history.mean[0]
    assert fingerprint(warm) == fingerprint(an.solve(PROBLEM, algorithm, seed=1, warm=COLD))


@pytest.mark.parametrize("other", OTHERS)
@pytest.mark.parametrize("tau0", [1.0, 0.01])
def test_edges_are_matched_by_cell_and_move(other: str, tau0: float) -> None:
    problem, algorithm = OTHERS[other], replace(QUICK, tau0=tau0, tau_min=0.5)
    expected, edges = begun_with(known(COLD), problem, algorithm), problem.graph.graph.neighbours < len(problem.graph)
    (task,) = strategy_of(Context(problem, algorithm, an.Call(warm=COLD.memory))).send(None).tasks
    np.testing.assert_array_equal(task.tau[edges], expected[edges])
    assert task.tau[edges].min() == 0.5 * tau0 < task.tau[edges].max()
    assert np.isfinite(task.tau).all()
    cold, warm = (an.solve(problem, QUICK, seed=2, warm=memory, remember=True) for memory in (None, COLD.memory))
    assert an.check_path(warm.path, problem) == pytest.approx(warm.length)
    assert warm.history.mean[0] < cold.history.mean[0]
    np.testing.assert_array_equal(np.isnan(known(warm).tau), ~edges)


def test_what_a_memory_does_not_know_begins_at_tau0() -> None:
    memory = known(an.solve(an.Problem.from_cells(grid_of("..#..", "..#.."), (0, 0), (1, 1)), QUICK, remember=True))
    assert memory.flat.tolist() == [8, 9, 15, 16]
    opened = an.Problem.from_cells(grid_of(".....", "..#.."), (0, 3), (1, 4))
    tau = memory.on(opened.graph, 3.0, 0.1)
    east, between = opened.graph.cells[:, 1] > 1, opened.graph.node((0, 1))
    assert (tau[east] == 3.0).all()
    assert tau[between, 4] == 3.0  # right, into what was a wall
    assert tau[between, 3] == max(3.0 * memory.tau[1, 3], 0.1) != 3.0


def test_scouts_begin_with_it_either_way_and_pieces_do_not() -> None:
    run = Context(PROBLEM, an.paco().on(PROBLEM.grid), an.Call(warm=COLD.memory))
    strategy = strategy_of(run)
    order = strategy.send(None)
    forward, backward = (task.tau for task in order.tasks)
    graph = PROBLEM.graph.graph
    for node, slot in np.argwhere(graph.neighbours < len(PROBLEM.graph)):
        assert backward[node, slot] == forward[graph.neighbours[node, slot], 7 - slot]
    outcomes = [colony.run(task) for task in order.tasks]
    assert all(task.tau is None for task in strategy.send(run.keep(order, outcomes, 0.0)).tasks)


def test_turned_twice_is_as_before() -> None:
    graph = PROBLEM.graph.graph
    tau = np.random.default_rng(0).random(graph.neighbours.shape)
    edges = graph.neighbours < len(PROBLEM.graph)
    assert (turned(tau, graph) != tau)[edges].any()
    np.testing.assert_array_equal(turned(turned(tau, graph), graph)[edges], tau[edges])


@pytest.mark.parametrize("name", ["npaco", "paco", "paco_levels", "paco_ls"])
def test_same_bytes_on_every_executor(name: str) -> None:
    def solved(executor: Any) -> tuple[bytes, bytes]:
        result = an.solve(PROBLEM, an.preset(name), seed=5, warm=COLD, remember=True, executor=executor)
        return fingerprint(result), known(result).tau.tobytes()

    expected = solved(None)
    with spmd.Processes(2) as processes:
        for executor in (spmd.Serial(), spmd.executor_for(2), processes):
            assert solved(executor) == expected


def test_remembering_changes_nothing_else() -> None:
    for algorithm in (an.npaco(), an.paco()):
        plain, remembered = (an.solve(PROBLEM, algorithm, seed=3, remember=remember) for remember in (False, True))
        assert plain.memory is None
        assert fingerprint(plain) == fingerprint(remembered)
        assert plain.to_dict().keys() == remembered.to_dict().keys()


def test_a_run_that_was_ended_early_remembers_the_better_scout() -> None:
    """Its ants deposit on their way only, so along its path most pheromone lies from the start to the goal."""
    algorithm, graph, sides = an.paco(deposit="forward", straighten=False), PROBLEM.graph, set()
    for seed in range(6):
        result = an.solve(PROBLEM, algorithm, seed=seed, stop=stop.Iterations(3), remember=True)
        (stage,) = result.stages
        sides.add(stage.colonies[0].length > stage.colonies[1].length)
        nodes = np.array([graph.node(tuple(cell)) for cell in result.path.cells.tolist()])
        slots = np.argmax(graph.graph.neighbours[nodes[:-1]] == nodes[1:, None], axis=1)
        tau = known(result).tau
        assert tau[nodes[:-1], slots].sum() > tau[nodes[1:], 7 - slots].sum()
    assert sides == {True, False}, "either scout was the better one once"


def test_a_cancelled_run_remembers_what_it_began_with() -> None:
    cancel = threading.Event()
    cancel.set()
    for algorithm in (QUICK, an.paco()):
        result = an.solve(PROBLEM, algorithm, warm=COLD, remember=True, cancel=cancel)
        assert (result.stopped_by, result.steps) == ("cancelled", 0)
        np.testing.assert_array_equal(known(result).tau, begun_with(known(COLD), PROBLEM, algorithm))


def test_where_nobody_walks_what_was_known_stays_known() -> None:
    there = an.Problem.from_cells(PROBLEM.grid, (0, 0), (0, 0))
    walled = grid_of(*(["." * 9 + "#" + "." * 10] * 20))
    apart = an.Problem.from_cells(walled, *ENDS)
    for problem in (there, apart):
        assert an.solve(problem, QUICK, remember=True).memory is None
        assert an.solve(problem, QUICK, warm=COLD).memory is None
        assert an.solve(problem, QUICK, warm=COLD, remember=True).memory is COLD.memory


def test_memories_are_plain_data_that_nobody_writes_to() -> None:
    memory = known(COLD)
    assert repr(memory) == f"Memory({len(PROBLEM.graph)} of 20 x 20 cells, tau0 1, {len(memory.paths)} paths)"
    for other in (
        memory,
        pickle.loads(pickle.dumps(memory)),
        copy.deepcopy(memory),
        pickle.loads(pickle.dumps(COLD)).memory,
    ):
        assert (other.shape, other.tau0) == ((20, 20), 1.0)
        np.testing.assert_array_equal(other.flat, memory.flat)
        np.testing.assert_array_equal(other.tau, memory.tau)
        for mine, theirs in zip((*other.paths, *other.earlier), (*memory.paths, *memory.earlier), strict=True):
            np.testing.assert_array_equal(mine, theirs)
        assert not any(array.flags.writeable for array in (other.flat, other.tau, *other.paths))
        assert fingerprint(an.solve(PROBLEM, QUICK, warm=other)) == fingerprint(an.solve(PROBLEM, QUICK, warm=memory))


@pytest.mark.parametrize("name", ["npaco", "paco", "paco_levels"])
def test_a_memory_keeps_paths_the_latest_and_cheapest_first(name: str) -> None:
    memory, bests = None, []
    for seed, (label, problem) in enumerate(OTHERS.items()):
        result = an.solve(problem, an.preset(name, ants=10, iterations=6), seed=seed, warm=memory, remember=True)
        memory = known(result)
        ends = {(int(path[0]), int(path[-1])) for path in memory.paths}
        assert ends == {problem.flat_ends}, label
        costs = [problem.cost_along(path) for path in memory.paths[1:]]
        assert costs == sorted(costs)
        assert len({path.tobytes() for path in memory.paths}) == len(memory.paths) <= PATHS
        np.testing.assert_array_equal(problem.from_flat(memory.paths[0]), result.path.cells)
        for path in memory.paths:
            an.check_path(an.Path(problem.from_flat(path).astype(np.int32), problem.grid), problem)
        assert [path.tolist() for path in memory.earlier] == bests[::-1]
        bests.append(memory.paths[0].tolist())


def test_pheromone_of_a_memory_is_that_of_its_result() -> None:
    np.testing.assert_allclose(known(COLD).pheromone, COLD.pheromone, rtol=1e-6)
    empty = known(COLD).cleared()
    assert (empty.paths, empty.earlier) == ((), ())
    assert np.isnan(empty.pheromone).all()
    assert fingerprint(an.solve(PROBLEM, QUICK, warm=empty)) == fingerprint(an.solve(PROBLEM, QUICK))


def test_a_memory_is_saved_and_loaded(tmp_path: Path) -> None:
    second = known(an.solve(OTHERS["a wall more"], QUICK, warm=COLD, remember=True))
    for memory in (known(COLD), second, second.cleared()):
        memory.save(tmp_path / "memory.npz")
        loaded = Memory.load(str(tmp_path / "memory.npz"))
        assert (loaded.shape, loaded.tau0) == (memory.shape, memory.tau0)
        for name in ("flat", "tau"):
            np.testing.assert_array_equal(getattr(loaded, name), getattr(memory, name))
        for name in ("paths", "earlier"):
            assert [path.tolist() for path in getattr(loaded, name)] == [
                path.tolist() for path in getattr(memory, name)
            ]
    with pytest.raises(OutputError):
        second.save(tmp_path / "nowhere" / "memory.npz")


def test_files_that_hold_no_memory_are_refused(tmp_path: Path) -> None:
    file = tmp_path / "memory.npz"
    known(COLD).save(file)
    whole = file.read_bytes()
    with np.load(file) as archive:
        arrays = dict(archive)
    broken: list[dict[str, Any] | bytes] = [
        b"",
        b"PK",
        whole[:-30],
        whole[: len(whole) // 2],
        whole.replace(b"tau", b"tan"),
    ]
    broken += [arrays | {"antnav_memory": 2}, arrays | {"tau0": -1.0}, arrays | {"flat": arrays["flat"][:-1]}]
    broken += [{name: array for name, array in arrays.items() if name != left_out} for left_out in arrays]
    broken += [arrays | {"paths_lengths": lengths} for lengths in (np.array([1]), arrays["paths_lengths"] * -1)]
    broken += [arrays | {"tau": np.array([None])}, arrays | {"shape": np.array(3)}]
    for content in broken:
        if isinstance(content, bytes):
            file.write_bytes(content)
        else:
            np.savez(file, **content)
        with pytest.raises(ResultFormatError, match=r"memory .*npz"):
            Memory.load(file)
    with pytest.raises(ResultFormatError, match="No such file"):
        Memory.load(tmp_path / "none.npz")
    with pytest.raises(ParameterError):
        Memory.load(3)  # type: ignore[arg-type]
    for place in np.random.default_rng(0).integers(
        0, len(whole), 60
    ):  # a flipped byte: refused, or nothing that matters
        file.write_bytes(whole[:place] + bytes([whole[place] ^ 0x55]) + whole[place + 1 :])
        try:
            loaded = Memory.load(file)
        except ResultFormatError:
            continue
        np.testing.assert_array_equal(loaded.tau, known(COLD).tau)


@pytest.mark.parametrize("name", ["paco_large", "astar", "dijkstra", "woa-exact", "potential-field"])
def test_planners_without_such_pheromone_refuse(name: str) -> None:
    planner = an.algorithm(name)
    assert not planner.remembers
    with pytest.raises(ParameterError, match=f"warm with {planner.name}: it has no pheromone"):
        an.solve(PROBLEM, planner, warm=COLD)
    with pytest.raises(ParameterError, match=f"remember with {planner.name}: it has no pheromone"):
        an.solve(PROBLEM, planner, remember=True)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"warm": COLD.memory.tau}, "its type is Memory"),
        ({"warm": True}, "its type is Memory"),
        ({"warm": an.solve(PROBLEM, QUICK)}, "the result has no memory; run it with remember=True"),
        ({"remember": 1}, "its type is bool"),
        ({"remember": None}, "its type is bool"),
    ],
)
def test_what_is_no_memory_is_refused(given: dict[str, Any], words: str) -> None:
    with pytest.raises(ParameterError, match=words):
        an.solve(PROBLEM, QUICK, **given)


def test_a_memory_of_another_shape_is_refused() -> None:
    problem = an.Problem.from_cells(an.GridMap(np.zeros((20, 21), np.uint8)), (0, 0), (19, 19))
    with pytest.raises(ParameterError, match="warm of 20 x 20 cells: the map has 20 x 21 cells; give the memory of"):
        an.solve(problem, QUICK, warm=COLD)


@dataclass(frozen=True)
class Echo(an.Planner):
    """Has nothing of its own but what it is given."""

    name: str = "echo"
    remembers = True

    def plan(self, problem: an.Problem, call: an.Call) -> an.Plan:
        assert call.remember
        return an.Plan(cells=None, memory=call.warm)


def test_ones_own_planner_may_remember() -> None:
    assert an.solve(PROBLEM, Echo(), warm=COLD, remember=True).memory is COLD.memory


@pytest.mark.parametrize(
    ("wrong", "given"),
    [
        ({"tau0": 0.0}, "tau0 0.0"),
        ({"tau0": np.inf}, "tau0 inf"),
        ({"tau0": "1"}, "tau0 '1'"),
        ({"shape": (3,)}, r"shape \(3,\)"),
        ({"shape": (3, 2.5)}, r"shape \(3, 2.5\)"),
        ({"flat": np.array([6, 7, 25], np.int32)}, "flat from 6 to 25"),
        ({"flat": [6, 7, 8]}, r"flat \[6, 7, 8\]"),
        ({"flat": np.array([6, 8, 7], np.int32)}, "flat array"),
        ({"flat": np.array([6, 7, 8.0])}, "flat array"),
        ({"flat": np.array([-1, 7, 8], np.int32)}, "flat from -1 to 8"),
        ({"flat": np.empty(0, np.int32), "tau": np.empty((0, 8))}, "flat array"),
        ({"tau": np.ones((2, 8))}, r"tau of shape \(2, 8\)"),
        ({"tau": np.empty((0, 8))}, r"tau of shape \(0, 8\)"),
        ({"tau": np.ones((3, 8), np.float32)}, "tau of shape .* float32"),
        ({"tau": np.full((3, 8), np.inf)}, "tau: each value is finite"),
        ({"tau": np.full((3, 8), -1.0)}, "tau: each value is finite"),
        ({"paths": [np.array([6], np.int32)]}, "paths"),
        ({"paths": (np.array([6]),)}, "paths array"),
        ({"paths": (np.empty(0, np.int32),)}, "paths array"),
        ({"earlier": ([6],)}, "earlier"),
        ({"earlier": (np.array([25], np.int32),)}, "earlier array"),
    ],
)
def test_a_memory_that_cannot_be_is_refused(wrong: dict[str, Any], given: str) -> None:
    good = {"shape": (3, 3), "flat": np.array([6, 7, 8], np.int32), "tau": np.full((3, 8), np.nan), "tau0": 1.0}
    assert repr(Memory(**good)) == "Memory(3 of 3 x 3 cells, tau0 1)"
    with pytest.raises(ParameterError, match=given):
        Memory(**(good | wrong))
