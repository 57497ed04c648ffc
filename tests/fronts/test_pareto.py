"""Fronts: against brute force, what a user may ask, files."""

from __future__ import annotations

import json
import pickle
import threading
from dataclasses import dataclass
from importlib.util import find_spec
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import antnav as an
from antnav import costs, fronts, objectives
from antnav.errors import ParameterError, ResultFormatError
from antnav.fronts.instance import Instance
from tests.conftest import grid_of
from tests.fronts.instances import drawn

STEPS = [(-1, -1), (-1, 0), (-1, 1), (0, -1), (0, 1), (1, -1), (1, 0), (1, 1)]
HALL = grid_of("........", "...##...", "...##...", "........", "........")
FIELD = costs.clearance(HALL, 2.0, 3.0)
PROBLEM = an.Problem.from_cells(HALL, (0, 0), (0, 7))
LENGTH_AND_RISK = [objectives.Length(), objectives.Risk(FIELD)]


def all_paths(problem: an.Problem) -> list[list[tuple[int, int]]]:
    """Every path without a cell twice, by brute force."""
    found = []

    def walk(path: list[tuple[int, int]]) -> None:
        row, col = path[-1]
        if path[-1] == problem.goal_cell:
            found.append(list(path))
            return
        for k, (down, right) in enumerate(STEPS):
            cell = (row + down, col + right)
            if problem.moves[row + 1, col + 1] >> k & 1 and cell not in path:
                walk([*path, cell])

    walk([problem.start_cell])
    return found


def by_hand(cells: list[tuple[int, int]], values: np.ndarray) -> tuple[int, ...]:
    """Length and risk of a path in the steps that searches count in, and its turns."""
    worth = {}
    for here in ("length", "risk"):
        worth[here] = []
    moves = list(pairwise(cells))
    dearest = max(
        np.hypot(*np.subtract(b, a)) * (values[a] + values[b]) / 2
        for a in np.ndindex(values.shape)
        for b in [(a[0] + i, a[1] + j) for i, j in STEPS]
        if 0 <= b[0] < values.shape[0] and 0 <= b[1] < values.shape[1]
    )
    length = sum(round(np.hypot(*np.subtract(b, a)) / (np.sqrt(2) / 1000)) for a, b in moves)
    risk = sum(round(np.hypot(*np.subtract(b, a)) * (values[a] + values[b]) / 2 / (dearest / 1000)) for a, b in moves)
    headings = [tuple(np.subtract(b, a)) for a, b in moves]
    return length, risk, sum(a != b for a, b in pairwise(headings))


def undominated(vectors: set[tuple[int, ...]]) -> set[tuple[int, ...]]:
    return {
        one
        for one in vectors
        if not any(other != one and all(a <= b for a, b in zip(other, one, strict=True)) for other in vectors)
    }


@settings(max_examples=40)
@given(st.integers(0, 2**32 - 1), st.booleans())
def test_the_exact_front_is_that_of_all_paths(seed: int, turns: bool) -> None:
    values = np.random.default_rng(seed).integers(0, 9, (3, 4)).astype(float) + 1.0
    grid = an.GridMap(np.zeros((3, 4), np.uint8))
    problem = an.Problem.from_cells(grid, (0, 0), (2, 3))
    asked: list[objectives.Objective] = [objectives.Length(), objectives.Risk(costs.array(values))]
    asked += [objectives.Turns()] if turns else []
    front = an.pareto(problem, asked, algorithm="exact")
    instance = Instance.of(problem, asked)
    k = len(asked)
    paths = all_paths(problem)
    vectors = {by_hand(path, values)[:k] for path in paths}
    got = set()
    for path in front.paths:
        cells = [tuple(cell) for cell in path.cells.tolist()]
        got.add(by_hand(cells, values)[:k])
        nodes = np.array([instance.graph.node(cell) for cell in cells], np.int32)
        assert tuple(instance.steps([nodes])[0]) == by_hand(cells, values)[:k]
    assert front.complete
    assert got <= undominated(vectors)
    assert len(front) == len(got)
    left_out = undominated(vectors) - got  # of equal steps, or beaten by a hair that steps round away
    for path in paths if left_out else ():
        if by_hand(path, values)[:k] in left_out:
            nodes = np.array([instance.graph.node(cell) for cell in path], np.int32)
            assert (front.values <= instance.values([nodes])[0] + 1e-12).all(axis=1).any()


def needs(method: str) -> None:
    """Skip where the library of a method's extra is not installed."""
    if fronts.METHODS[method].extra == "rivals":
        pytest.importorskip("pygmo")


@pytest.mark.parametrize("method", fronts.METHODS)
@pytest.mark.parametrize("extra", [[], [objectives.Turns()]])
def test_paths_are_legal_undominated_and_sorted(method: str, extra: list[objectives.Objective]) -> None:
    needs(method)
    front = an.pareto(PROBLEM, [*LENGTH_AND_RISK, *extra], algorithm=method)
    assert len(front) > 1
    for path in front.paths:
        an.check_path(path, PROBLEM)
    np.testing.assert_allclose(front.values[:, 0], [path.length_m for path in front.paths])
    for i, one in enumerate(front.values):
        for j, other in enumerate(front.values):
            assert i == j or (one < other).any()
    assert front.values.tolist() == sorted(front.values.tolist())


def test_auto_says_what_it_took() -> None:
    front = an.pareto(PROBLEM, LENGTH_AND_RISK)
    assert front.complete
    assert "auto took exact search" in front.notes
    assert front.method["name"] == "auto"
    exact = an.pareto(PROBLEM, LENGTH_AND_RISK, algorithm="exact")
    np.testing.assert_array_equal(front.values, exact.values)
    short = an.pareto(PROBLEM, LENGTH_AND_RISK, algorithm=fronts.Auto(limit=30))
    assert not short.complete
    assert any("labels were not enough" in note for note in short.notes)
    assert {"labels", "walks"} <= short.work.keys()
    assert {*map(tuple, short.values.round(9).tolist())} <= {*map(tuple, exact.values.round(9).tolist())}
    assert len(short) >= len(exact) - 1


def test_the_first_path_is_the_shortest_and_weights_choose() -> None:
    front = an.pareto(PROBLEM, LENGTH_AND_RISK)
    assert front.paths[0].length == pytest.approx(an.exact.optimum(PROBLEM).cost)
    assert front.best([1, 0]) == 0
    assert front.best([0, 1]) == len(front) - 1
    sums = front.values @ [1.0, 0.5]
    assert sums[front.best([1.0, 0.5])] == sums.min()
    assert front.best([2.0, 1.0]) == front.best([1.0, 0.5])
    scaled = (front.values - front.ideal) / (front.nadir - front.ideal)
    assert scaled[front.knee()].sum() == scaled.sum(axis=1).min()


def test_the_weighted_optimum_is_that_of_a_problem_with_that_cost() -> None:
    front = an.pareto(PROBLEM, LENGTH_AND_RISK)
    priced = an.Problem.from_cells(HALL, (0, 0), (0, 7), cost=FIELD)
    assert front.values[front.best([1, 1])].sum() == pytest.approx(an.exact.optimum(priced).cost, rel=1e-3)


def test_hypervolume_is_the_area_below_two_objectives() -> None:
    pytest.importorskip("moocore")
    front = an.pareto(PROBLEM, LENGTH_AND_RISK)
    reference = front.nadir + 1.0
    ends = np.append(front.values[1:, 0], reference[0])
    area = ((ends - front.values[:, 0]) * (reference[1] - front.values[:, 1])).sum()
    assert front.hypervolume(reference) == pytest.approx(area)
    with pytest.raises(ParameterError, match="reference"):
        front.hypervolume([1.0])


def test_a_robot_at_its_goal_and_one_without_a_way() -> None:
    there = an.pareto(an.Problem.from_cells(HALL, (0, 0), (0, 0)), LENGTH_AND_RISK)
    assert there.values.tolist() == [[0.0, 0.0]]
    walled = an.Problem.from_cells(grid_of(".#.", ".#.", ".#."), (0, 0), (0, 2))
    none = an.pareto(walled, [objectives.Length(), objectives.Turns()])
    assert (none.status, len(none), none.complete) == ("unreachable", 0, True)
    assert "unreachable" in none.summary()
    with pytest.raises(ParameterError, match="without paths"):
        none.knee()
    with pytest.raises(ParameterError, match="without paths"):
        none.best([1, 1])


def test_a_limit_and_a_cancel_are_told() -> None:
    short = an.pareto(PROBLEM, LENGTH_AND_RISK, algorithm=fronts.Exact(limit=20))
    assert not short.complete
    assert any("front incomplete: the limit of 20 labels" in note for note in short.notes)
    cancel = threading.Event()
    cancel.set()
    for method, kind in fronts.METHODS.items():
        if kind.extra and find_spec("pygmo") is None:
            continue
        ended = an.pareto(PROBLEM, LENGTH_AND_RISK, algorithm=method, cancel=cancel)
        assert (ended.stopped_by, ended.complete) == ("cancelled", False)


@pytest.mark.parametrize("method", ["exact", "auto"])
def test_a_search_that_is_ended_at_once_has_paths(method: str) -> None:
    front = an.pareto(PROBLEM, LENGTH_AND_RISK, algorithm=method, stop=an.stop.Seconds(1e-9))
    assert (front.status, front.complete) == ("found", False)
    assert len(front) >= 2
    assert front.knee() < len(front)


@pytest.mark.parametrize("k", [2, 3])
def test_a_slack_leaves_out_what_is_covered(k: int) -> None:
    problem, asked = drawn(20, 3, k)
    whole = an.pareto(problem, asked, algorithm="exact")
    some = an.pareto(problem, asked, algorithm=fronts.Exact(slack=0.05))
    assert not some.complete
    assert len(some) < len(whole)
    assert any("worse by at most 5 % of the ranges" in note for note in some.notes)
    roundings = 0.5 * 60 * np.array([each.step for each in whole.objectives])  # half a step for each move
    spare = 0.05 * (whole.nadir - whole.ideal) + roundings
    for row in whole.values:
        assert (some.values <= row + spare).all(axis=1).any()
    with pytest.raises(ParameterError, match="slack"):
        fronts.Exact(slack=2)


def test_no_path_of_a_front_is_beaten_by_a_hair() -> None:
    grid = an.GridMap(np.zeros((12, 12), np.uint8))
    field = costs.array(np.random.default_rng(1).gamma(0.3, 3.0, grid.shape))
    problem = an.Problem.from_cells(grid, (0, 0), (11, 11))
    front = an.pareto(problem, [objectives.Length(), objectives.Risk(field)], algorithm="exact")
    for one in front.values:
        assert ((front.values <= one).all(axis=1)).sum() == 1


def test_sums_that_would_overflow_are_refused() -> None:
    @dataclass(frozen=True)
    class Dear(objectives.Objective):
        name: str = "dear"
        step: float | None = 1.0

        def edges(self, terrain: an.Terrain, graph: Any) -> Any:
            return np.full(graph.graph.neighbours.shape, 1e6)

    rows = np.ones((161, 161), np.uint8)  # a snake of 13,000 cells
    rows[::2] = 0
    rows[1::4, -1], rows[3::4, 0] = 0, 0
    problem = an.Problem.from_cells(an.GridMap(rows), (0, 0), (160, 160))
    with pytest.raises(ParameterError, match="coarser"):
        an.pareto(problem, [objectives.Length(), Dear()], algorithm="sweep")


def test_costs_of_the_problem_are_refused_but_closed_cells_taken() -> None:
    for problem in (
        an.Problem.from_cells(HALL, (0, 0), (0, 7), cost=FIELD),
        an.Problem.from_cells(HALL, (0, 0), (0, 7), turning=1.0),
    ):
        with pytest.raises(ParameterError, match="a problem with costs"):
            an.pareto(problem, LENGTH_AND_RISK)
    closed = np.zeros(HALL.shape, np.bool_)
    closed[0, 3] = True
    kept = an.Problem.from_cells(HALL, (0, 0), (0, 7), cost=costs.keepout(closed))
    for path in an.pareto(kept, LENGTH_AND_RISK).paths:
        assert (0, 3) not in map(tuple, path.cells.tolist())


@pytest.mark.parametrize(
    "asked",
    [
        [],
        [objectives.Length()],
        [objectives.Length()] * 2,
        [objectives.Length(str(i)) for i in range(7)],
        "length",
        objectives.Length(),
        [objectives.Length(), "risk"],
        [objectives.Length(), objectives.Length(name=3)],  # type: ignore[arg-type]
        None,
    ],
)
def test_other_objectives_are_refused(asked: Any) -> None:
    with pytest.raises(ParameterError):
        an.pareto(PROBLEM, asked)


@pytest.mark.parametrize("weights", [[1], [1, -1], [0, 0], [np.nan, 1], "ab", [np.inf, 1]])
def test_other_weights_are_refused(weights: Any) -> None:
    with pytest.raises(ParameterError, match="weights"):
        an.pareto(PROBLEM, LENGTH_AND_RISK).best(weights)


def test_a_front_is_kept_in_a_file(tmp_path: Path) -> None:
    front = an.pareto(PROBLEM, LENGTH_AND_RISK)
    front.save(tmp_path / "front.json")
    again = an.Front.load(tmp_path / "front.json")
    np.testing.assert_array_equal(again.values, front.values)
    assert again.to_dict() == front.to_dict()
    copied = pickle.loads(pickle.dumps(front))
    assert copied.to_dict() == front.to_dict()
    assert not copied.values.flags.writeable
    front.save(tmp_path / "front.csv")
    lines = (tmp_path / "front.csv").read_text().splitlines()
    assert lines[0] == "path,length [m],risk [m]"
    assert len(lines) == len(front) + 1
    with pytest.raises(ParameterError, match="json or"):
        front.save(tmp_path / "front.txt")


@pytest.mark.parametrize(
    "spoil",
    [
        lambda document: document["values"].pop(),
        lambda document: document["values"][0].pop(),
        lambda document: document["paths"][0].pop(),
        lambda document: document.update(schema="antnav/result"),
        lambda document: document.update(status="unreachable"),
        lambda document: document.update(version=9),
        lambda document: document["values"][0].__setitem__(0, "x"),
    ],
)
def test_a_file_that_cannot_be_true_is_refused(tmp_path: Path, spoil: Any) -> None:
    file = tmp_path / "front.json"
    an.pareto(PROBLEM, LENGTH_AND_RISK).save(file)
    document = json.loads(file.read_text())
    spoil(document)
    file.write_text(json.dumps(document))
    with pytest.raises(ResultFormatError):
        an.Front.load(file)
    with pytest.raises(ResultFormatError):
        an.Front.load(tmp_path / "absent.json")
