"""Fronts by label setting against all simple paths of small maps, and against label correcting on larger ones."""

from __future__ import annotations

import itertools
from collections.abc import Iterator

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from antnav.errors import ParameterError
from antnav.kernels import grid_kernels
from antnav.search import labels
from antnav.search.labels import front
from antnav.world.moves import STEPS, CornerRule, legal_moves

#: Turns in units of 45 degrees.
EIGHTHS = np.array(
    [[min((a - b) % 8, (b - a) % 8) for b in (0, 1, 2, 7, 3, 6, 5, 4)] for a in (0, 1, 2, 7, 3, 6, 5, 4)]
)
NONE = np.zeros((0, 8, 1), np.int32)


def neighbours_of(free: np.ndarray) -> np.ndarray:
    """The neighbour table of a map's free cells, in map order; cells that cannot be reached are nodes, too."""
    moves = legal_moves(free, CornerRule.GRAZE)
    seen = np.pad(free, 1).astype(np.uint8).ravel()
    return grid_kernels.neighbour_table(moves.ravel(), moves.shape[1], seen, int(free.sum()))[1]


def drawn(rng: np.random.Generator, shape: tuple[int, int], k: int, turning: str, most: int) -> tuple[np.ndarray, ...]:
    """A map with costs: neighbours, costs of directed edges, turns."""
    free = rng.random(shape) < rng.choice([0.6, 0.8, 1.0])
    free[0, 0] = free[-1, -1] = True
    neighbours = neighbours_of(free)
    costs = rng.integers(0, most + 1, (len(neighbours), 8, k)).astype(np.int32)
    turns = np.zeros((9, 8, k), np.int32)
    if turning == "count":
        turns[1:, :, -1] = 1 - np.eye(8)
    elif turning == "angles":
        turns[1:, :, rng.integers(k)] = EIGHTHS
    elif turning == "all":
        turns[1:] = EIGHTHS[:, :, None] * rng.integers(1, 4, k)
    elif turning == "any":
        turns[:] = rng.integers(0, most + 1, turns.shape)
    return neighbours, costs, turns if turning else np.zeros((0, 8, k), np.int32)


def price(nodes: list[int], neighbours: np.ndarray, costs: np.ndarray, turns: np.ndarray) -> tuple[int, ...]:
    """Costs of a path, edge by edge."""
    total, last = np.zeros(costs.shape[2], int), 0
    for a, b in itertools.pairwise(nodes):
        (slot,) = np.flatnonzero(neighbours[a] == b)
        total += costs[a, slot]
        if turns.size:
            total += turns[last, slot]
        last = slot + 1
    return tuple(total.tolist())


def beats(a: tuple[int, ...], b: tuple[int, ...]) -> bool:
    """Whether a is nowhere worse than b."""
    return all(x <= y for x, y in zip(a, b, strict=True))


def best(values: set[tuple[int, ...]]) -> list[tuple[int, ...]]:
    return sorted(v for v in values if not any(beats(w, v) and w != v for w in values))


def simple_paths(neighbours: np.ndarray, start: int, goal: int) -> Iterator[list[int]]:
    n = len(neighbours)
    path, used = [start], {start}

    def further() -> Iterator[list[int]]:
        if path[-1] == goal:
            yield list(path)
            return
        for other in neighbours[path[-1]].tolist():
            if other < n and other not in used:
                path.append(other)
                used.add(other)
                yield from further()
                used.remove(path.pop())

    yield from further()


def corrected(
    neighbours: np.ndarray, costs: np.ndarray, turns: np.ndarray, start: int, goal: int
) -> list[tuple[int, ...]]:
    """The front by label correcting: sets of vectors by node and last move, until nothing changes (Martins 1984)."""
    n, _, k = costs.shape
    zero = (0,) * k
    sets: dict[tuple[int, int], set[tuple[int, ...]]] = {(start, 0): {zero}}
    waiting = [((start, 0), zero)]
    while waiting:
        (node, last), value = waiting.pop(0)
        if node == goal or value not in sets[node, last]:
            continue
        for slot, other in enumerate(neighbours[node].tolist()):
            if other == n:
                continue
            extra = turns[last, slot] if turns.size else 0
            new = tuple((np.array(value) + costs[node, slot] + extra).tolist())
            state = (other, slot + 1 if turns.size else 0)
            kept = sets.setdefault(state, set())
            if not any(beats(old, new) for old in kept):
                sets[state] = {old for old in kept if not beats(new, old)} | {new}
                waiting.append((state, new))
    return best({value for (node, _), values in sets.items() if node == goal for value in values})


def check_paths(found: labels.Labels, *given: np.ndarray, start: int, goal: int) -> None:
    """Every path is one, and costs what is told."""
    for nodes, value in zip(found.paths, found.values, strict=True):
        assert (nodes[0], nodes[-1]) == (start, goal)
        assert price(nodes.tolist(), *given) == tuple(value.tolist())


@settings(max_examples=120, derandomize=True)
@given(
    rows=st.integers(1, 3),
    cols=st.integers(2, 4),
    k=st.integers(1, 4),
    turning=st.sampled_from(["", "", "count", "angles", "all"]),
    most=st.sampled_from([1, 3, 9, 1000]),
    seed=st.integers(0, 2**32 - 1),
)
def test_front_equals_the_best_of_all_simple_paths(
    rows: int, cols: int, k: int, turning: str, most: int, seed: int
) -> None:
    given = drawn(np.random.default_rng(seed), (rows, cols), k, turning, most)
    start, goal = 0, len(given[0]) - 1
    found = front(*given, start, goal)
    assert [tuple(v) for v in found.values.tolist()] == best(
        {price(p, *given) for p in simple_paths(given[0], start, goal)}
    )
    assert found.complete
    check_paths(found, *given, start=start, goal=goal)
    assert all(len(set(path.tolist())) == len(path) for path in found.paths) or turning == "all"


@settings(max_examples=60, derandomize=True)
@given(
    side=st.integers(8, 10),
    k=st.integers(2, 3),
    turning=st.sampled_from(["", "count", "angles", "all", "any"]),
    seed=st.integers(0, 2**32 - 1),
)
def test_front_equals_label_correcting(side: int, k: int, turning: str, seed: int) -> None:
    given = drawn(np.random.default_rng(seed), (side, side), k, turning, 4)
    start, goal = 0, len(given[0]) - 1
    found = front(*given, start, goal)
    assert [tuple(v) for v in found.values.tolist()] == corrected(*given, start, goal)
    check_paths(found, *given, start=start, goal=goal)


def open_map(side: int, k: int, most: int = 50, seed: int = 0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    neighbours = neighbours_of(np.ones((side, side), bool))
    costs = np.random.default_rng(seed).integers(0, most, (side * side, 8, k)).astype(np.int32)
    return neighbours, costs, NONE


def test_two_ways_round_by_hand() -> None:
    """Three cells in a row over three others: 2 by the first cost straight on, 2 by the second the other way round."""
    neighbours = neighbours_of(np.ones((2, 3), bool))
    costs = np.ones((6, 8, 2), np.int32)
    costs[1, :, 1] = 5  # leaving the middle of the first row
    found = front(neighbours, costs, NONE, 0, 2)
    assert found.values.tolist() == [[2, 2]]  # diagonally by the second row
    assert [path.tolist() for path in found.paths] == [[0, 4, 2]]
    costs[4, :, 0] = 3
    found = front(neighbours, costs, NONE, 0, 2)
    assert found.values.tolist() == [[2, 6], [4, 2]]
    assert [path.tolist() for path in found.paths] == [[0, 1, 2], [0, 4, 2]]


def test_the_first_move_turns_from_nothing() -> None:
    neighbours = neighbours_of(np.ones((1, 3), bool))
    costs = np.ones((3, 8, 2), np.int32)
    turns = np.zeros((9, 8, 2), np.int32)
    turns[0, :, 1], turns[5, 4, 1] = 7, 100
    assert front(neighbours, costs, turns, 0, 2).values.tolist() == [[2, 109]]


def test_a_dear_last_move_does_not_hide_another() -> None:
    """Two ways into one node: the cheaper one has to turn there, and the other is cheaper in all."""
    neighbours = neighbours_of(np.array([[1, 1, 1], [0, 1, 0]], bool))
    costs = np.ones((4, 8, 2), np.int32)
    turns = np.zeros((9, 8, 2), np.int32)
    turns[1:, :, 1] = 10 * (1 - np.eye(8))
    found = front(neighbours, costs, turns, 0, 2)
    assert found.values.tolist() == [[2, 2]]
    assert found.paths[0].tolist() == [0, 1, 2]


def test_start_is_goal() -> None:
    found = front(*open_map(3, 2), 4, 4)
    assert found.values.tolist() == [[0, 0]]
    assert [path.tolist() for path in found.paths] == [[4]]
    assert found.complete


@pytest.mark.parametrize("turning", ["", "count"])
def test_unreachable(turning: str) -> None:
    free = np.ones((3, 3), bool)
    free[:, 1] = False
    neighbours = neighbours_of(free)
    turns = np.ones((9, 8, 2), np.int32) if turning else NONE
    found = front(neighbours, np.ones((6, 8, 2), np.int32), turns, 0, 1)
    assert found.values.shape == (0, 2)
    assert (found.paths, found.complete) == ([], True)


@pytest.mark.parametrize("k", [1, 2, 3, 4])
def test_free_edges_give_one_path(k: int) -> None:
    neighbours, costs, _ = open_map(6, k)
    found = front(neighbours, np.zeros_like(costs), NONE, 0, 35)
    assert found.values.tolist() == [[0] * k]
    check_paths(found, neighbours, np.zeros_like(costs), NONE, start=0, goal=35)
    assert len(set(found.paths[0].tolist())) == len(found.paths[0])


@pytest.mark.parametrize("k", [2, 3])
def test_limit_leaves_a_part_of_the_front(k: int) -> None:
    given = open_map(20, k, seed=3)
    whole = front(*given, 0, 399)
    assert whole.complete
    part = front(*given, 0, 399, limit=whole.made * 9 // 10)
    assert not part.complete
    assert whole.made * 8 // 10 < part.made <= whole.made * 9 // 10
    assert 0 < len(part.paths) < len(whole.paths)
    assert {tuple(v) for v in part.values.tolist()} < {tuple(v) for v in whole.values.tolist()}
    check_paths(part, *given, start=0, goal=399)


def test_limit_below_one_label_a_move_makes_nothing() -> None:
    found = front(*open_map(20, 2), 0, 399, limit=0)
    assert (len(found.paths), found.complete) == (0, False)


def test_check_ends_the_search() -> None:
    given = open_map(20, 3, seed=3)
    asked = []

    def check() -> bool:
        asked.append(1)
        return len(asked) == 3

    found = front(*given, 0, 399, check=check)
    assert (len(asked), found.complete) == (3, False)
    assert 0 < found.popped <= 2 * labels.CHUNK


def test_same_bytes_however_often_it_is_asked(monkeypatch: pytest.MonkeyPatch) -> None:
    given = open_map(14, 3, most=6, seed=5)
    whole = front(*given, 0, 195)
    for chunk, room in ((7, 8), (1000, 1 << 16)):
        monkeypatch.setattr(labels, "CHUNK", chunk)
        monkeypatch.setattr(labels, "ROOM", room)
        other = front(*given, 0, 195)
        assert whole.values.tobytes() == other.values.tobytes()
        assert [path.tobytes() for path in whole.paths] == [path.tobytes() for path in other.paths]
        assert (whole.made, whole.popped) == (other.made, other.popped)


def test_the_order_of_costs_changes_no_front() -> None:
    neighbours, costs, _ = open_map(12, 3, most=5)
    expected = sorted(front(neighbours, costs, NONE, 0, 143).values[:, [2, 0, 1]].tolist())
    assert front(neighbours, costs[:, :, [2, 0, 1]], NONE, 0, 143).values.tolist() == expected


@pytest.mark.parametrize("turning", ["", "count"])
def test_costs_that_do_not_fit_are_refused(turning: str) -> None:
    neighbours = neighbours_of(np.ones((1, 4), bool))
    costs = np.full((4, 8, 2), 2**30, np.int32)
    turns = np.zeros((9, 8, 2), np.int32) if turning else NONE
    with pytest.raises(ParameterError, match="coarser"):
        front(neighbours, costs, turns, 0, 3)


@pytest.mark.parametrize("k", [2, 3])
def test_a_sum_that_does_not_fit_is_refused(k: int) -> None:
    """Every node is near enough to the goal, but not by way of the node below the start."""
    neighbours = neighbours_of(np.array([[1, 1, 1], [1, 0, 1], [1, 1, 1]], bool))
    costs = np.ones((8, 8, k), np.int32)
    costs[3, :, 0] = costs[0, 6, 0] = 2**30
    with pytest.raises(ParameterError, match="coarser"):
        front(neighbours, costs, NONE, 0, 2)
    costs[0, 6, 0] //= 2
    assert front(neighbours, costs, NONE, 0, 2).values.tolist() == [[2] * k]


def test_moves_have_the_angles_of_their_steps() -> None:
    for a in STEPS:
        for b in STEPS:
            angle = np.arctan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1])
            assert EIGHTHS[STEPS.index(a), STEPS.index(b)] == round(abs(angle) / (np.pi / 4))
