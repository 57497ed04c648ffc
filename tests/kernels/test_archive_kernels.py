"""Archive, ways home, walks and splices against plain twins."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from antnav.fronts import archive as archives
from antnav.fronts.colonies import decay_table
from antnav.fronts.instance import Instance
from antnav.kernels import archive_kernels as kernels
from antnav.kernels import front_kernels
from tests.fronts.instances import drawn

FAR = kernels.FAR


def archive_of(k: int, limit: int = 500, tolerance: int = 0) -> kernels.Archive:
    return archives.empty(limit, 100_000, np.full(k, 100), np.full(k, tolerance))


@settings(max_examples=30)
@given(st.integers(0, 2**32 - 1), st.integers(2, 5), st.integers(0, 120))
def test_the_archive_holds_what_no_other_vector_beats(seed: int, k: int, count: int) -> None:
    """And of equal vectors the first, with its path."""
    values = np.random.default_rng(seed).integers(0, 12, (count, k))
    archive = archive_of(k)
    assert kernels.add(archive, values, np.ones(count, np.int32), np.arange(count, dtype=np.int32)) == count
    kept, lengths, nodes = archives.paths_of(archive)
    expected = [
        i
        for i, one in enumerate(values)
        if not (
            (values[:i] <= one).all(axis=1).any() or ((values <= one).all(axis=1) & (values != one).any(axis=1)).any()
        )
    ]
    assert nodes.tolist() == expected
    assert (kept == values[expected]).all()
    assert archive.counts[kernels.ENTRIES] == len(expected) == len(lengths)


@settings(max_examples=10)
@given(st.integers(0, 2**32 - 1), st.integers(2, 4))
def test_a_coarse_archive_misses_nothing_by_more_than_its_tolerance(seed: int, k: int) -> None:
    values = np.random.default_rng(seed).integers(0, 100, (600, k))
    paths = (values, np.ones(600, np.int32), np.zeros(600, np.int32))
    archive = archives.taken(archive_of(k, limit=20), paths, 20)
    kept = archives.paths_of(archive)[0]
    assert len(kept) <= 20
    assert all(((kept - archive.tolerance) <= one).all(axis=1).any() for one in values)
    assert ((kept[:, None] <= kept).all(axis=2) == np.eye(len(kept), dtype=bool)).all()


def network_of(k: int, seed: int = 3, side: int = 12) -> tuple[Instance, kernels.Network]:
    instance = Instance.of(*drawn(side, seed, k))
    return instance, kernels.Network(*instance.arrays, instance.start, instance.goal)


def home_of(instance: Instance, weights: NDArray[np.int64], slack: int) -> kernels.Home:
    prices, corners = front_kernels.weighed(instance.costs, instance.turns, weights)
    behind = front_kernels.ideal_from(instance.graph.graph.neighbours, instance.costs, instance.start)
    ways = front_kernels.ways_home(
        *instance.arrays, prices, corners, weights, behind, instance.start, instance.goal, slack
    )
    return kernels.Home(prices, corners, *ways)


def naive_rest(instance: Instance, weights: NDArray[np.int64]) -> dict[tuple[int, int], int]:
    """Least weighted sum to the goal from each node and last move + 1: relaxed until nothing changes."""
    neighbours, costs, turns = instance.arrays
    n = len(neighbours)
    rest = {(node, last): 0 if node == instance.goal else math.inf for node in range(n) for last in range(9)}
    changed = True
    while changed:
        changed = False
        for node in range(n):
            for last in range(9):
                for s in range(8):
                    if neighbours[node, s] < n and node != instance.goal:
                        price = costs[node, s] + (turns[last, s] if turns.size else 0)
                        found = int(weights @ price) + rest[int(neighbours[node, s]), s + 1]
                        if found < rest[node, last]:
                            rest[node, last], changed = found, True
    return rest


@pytest.mark.parametrize("k", [2, 4])
def test_ways_home_are_the_best_ones(k: int) -> None:
    instance, network = network_of(k, side=7)
    weights = np.array([3, 1, 500, 2], np.int64)[:k]
    rest = naive_rest(instance, weights)
    wide = 9 if instance.turns.size else 1
    best = rest[instance.start, 0]
    for slack in (0, int(best) // 10, 2**60):
        home = home_of(instance, weights, slack)
        near = np.flatnonzero(home.rest < FAR)
        assert home.rest[instance.start * wide] == best
        for state in near.tolist():
            node, last = state // wide, state % wide
            assert home.rest[state] == rest[node, last] == weights @ home.values[state]
    reachable = {node for node in range(len(network.neighbours)) if node != instance.start}
    assert {state // wide for state in near.tolist()} >= reachable  # with any slack


def naive_walk(
    instance: Instance, home: kernels.Home, heats: list[int], slack: int, ants: int, seed: int, number: int
) -> tuple[list[list[int]], list[list[int]]]:
    """Nodes of each ant, and the nodes from which it looked home, as the docstring of `walk` says."""
    neighbours = instance.graph.graph.neighbours
    wide = 9 if instance.turns.size else 1
    walks, strayed = [], []
    for ant in range(ants):
        key = np.uint64(kernels.stream(np.uint64(seed), number, ant))
        nodes, last, left, looks = [instance.start], 0, slack, []
        while nodes[-1] != instance.goal:
            node = nodes[-1]
            state = node * wide + (last if wide == 9 else 0)
            odds, regrets = {}, {}
            for s in range(8):
                other = int(neighbours[node, s])
                if other == len(neighbours) or other in nodes:
                    continue
                rest = int(home.rest[other * wide + (s + 1 if wide == 9 else 0)])
                regret = int(home.prices[node, s] + home.corners[last, s]) + rest - int(home.rest[state])
                if rest < FAR and regret <= left and regret * 64 // heats[ant % len(heats)] < 1024:
                    odds[s] = math.exp(-(regret * 64 // heats[ant % len(heats)]) / 64)
                    regrets[s] = regret
            if not odds:
                break
            drawn = kernels.uniform(key, len(nodes)) * sum(odds.values())
            for s, share in odds.items():
                chosen = s
                drawn -= share
                if drawn < 0:
                    break
            left -= regrets[chosen]
            if len(nodes) == 1 or chosen != home.following[state]:
                looks.append(len(nodes))
            nodes.append(int(neighbours[node, chosen]))
            last = chosen + 1
        walks.append(nodes)
        strayed.append(looks)
    return walks, strayed


@pytest.mark.parametrize("k", [2, 3])
def test_ants_walk_as_their_plain_twin(k: int) -> None:
    """The archive is that of all walks that arrived, and of the best ways on from where they strayed."""
    instance, network = network_of(k)
    weights = np.array([1000, 300, 300_000], np.int64)[:k]
    home = home_of(instance, weights, 10**8)
    slack, heats = 10**7, [10, 10**5, 10**6]
    archive, work = archive_of(k), np.zeros(4, np.int64)
    assert kernels.walk(
        network, home, archive, np.zeros((0, 8)), np.array(heats), decay_table(), slack, 60, np.uint64(5), 2, work
    )
    walks, strayed = naive_walk(instance, home, heats, slack, 60, 5, 2)
    assert work[:3].tolist() == [60, sum(w[-1] == instance.goal for w in walks), sum(map(len, strayed))]
    wide = 9 if instance.turns.size else 1
    paths = []
    for nodes, looks in zip(walks, strayed, strict=True):
        for count in looks:
            path = nodes[: count + 1]
            slot = int((network.neighbours[path[-2]] == path[-1]).argmax())
            while path[-1] != instance.goal:
                slot = int(home.following[path[-1] * wide + (slot + 1 if wide == 9 else 0)])
                path = [*path, int(network.neighbours[path[-1], slot])]
            if len(set(path)) == len(path):
                paths.append(np.array(path, np.int32))
    expected = archives.taken(archive_of(k), archives.joined(instance, paths), 500)
    for mine, theirs in zip(archives.paths_of(archive), archives.paths_of(expected), strict=True):
        assert mine.tolist() == theirs.tolist()
    assert len(archives.split(archive)) > 1


def test_pheromone_counts_the_near_paths_that_make_a_move() -> None:
    instance, network = network_of(2)
    path = front_kernels.weighted(*instance.arrays, np.array([1, 1]), instance.ideal, instance.start, instance.goal)
    nodes, first = np.concatenate((path, path, path)), np.arange(4) * len(path)
    tau = kernels.pheromone(network, nodes, first, 2, 2.0)
    slots = [int((network.neighbours[a] == b).argmax()) for a, b in pairwise(path)]
    assert [tau[i, s] for i, s in zip(path[:-1], slots, strict=True)] == [9.0] * len(slots)
    assert np.count_nonzero(tau != 1.0) == len(slots)
    assert kernels.pheromone(network, nodes, first, 2, 0.0).shape == (0, 8)


@pytest.mark.parametrize("k", [2, 3, 4])
@pytest.mark.parametrize("work_of", ["splice", "stray"])
def test_splices_and_strays_are_paths_with_their_values(k: int, work_of: str) -> None:
    instance, network = network_of(k)
    known = []
    for j in range(k):
        weights = np.ones(k, np.int64)
        weights[j] = 10**6
        known.append(front_kernels.weighted(*instance.arrays, weights, instance.ideal, instance.start, instance.goal))
    nodes, first = np.concatenate(known), np.append(0, np.cumsum([len(path) for path in known]))
    archive, work = archive_of(k), np.zeros(4, np.int64)
    if work_of == "splice":
        assert kernels.splice(network, archive, nodes, first, 200, np.uint64(1), 1, work)
        assert work[3] > 0
    else:
        home = home_of(instance, np.array([1000, 300, 300_000, 200])[:k], 10**8)
        assert kernels.stray(network, home, archive, nodes, first, work)
        assert work[2] > 0
    paths = archives.split(archive)
    values = archives.paths_of(archive)[0]
    assert (instance.steps(paths) == values).all()
    for path in paths:
        assert (path[0], path[-1]) == (instance.start, instance.goal)
        assert len(set(path.tolist())) == len(path)
        assert all(b in network.neighbours[a] for a, b in pairwise(path))
