"""Exact fronts of several costs: all paths that no other beats, by label setting."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from antnav.errors import ParameterError
from antnav.kernels import label_kernels as kernels

#: Labels that are looked at between two questions to `check`: a few milliseconds.
CHUNK = 4096
#: Labels that arrays have room for at first.
ROOM = 1 << 12


@dataclass(frozen=True)
class Labels:
    """What a search for a front found.

    Attributes
    ----------
    values : ndarray of int64, shape (p, k)
        Costs of the paths, none of which beats another; in lexicographic order.
    paths : list of ndarray of int32
        Nodes of each path, from the start to the goal.
    complete : bool
        Whether that is the whole front. Where it is not, its paths still belong to it.
    made, popped : int
        Labels made and labels looked at.
    ended : bool
        Whether the search was not cut: with a slack its answer is whole up to that.
    """

    values: NDArray[np.int64]
    paths: list[NDArray[np.int32]]
    complete: bool
    made: int
    popped: int
    ended: bool


def front(
    neighbours: NDArray[np.int32],
    costs: NDArray[np.int32],
    turns: NDArray[np.int32],
    start: int,
    goal: int,
    *,
    slack: NDArray[np.int32] | None = None,
    limit: int | None = None,
    check: Callable[[], bool] | None = None,
) -> Labels:
    """All Pareto-optimal paths from start to goal: one for each vector of costs.

    Parameters
    ----------
    neighbours : ndarray of int32, shape (n, 8)
        As in `Graph`: n where there is none.
    costs : ndarray of int32, shape (n, 8, k)
        Of the edge in each slot, k from 1 to 6; whole numbers >= 0.
    turns : ndarray of int32, shape (9, 8, k)
        On top of that, by the slot of the last move + 1 (0 before the first) and that of the next; of size 0 where
        turns cost nothing. Where a turn may be dearer than a detour that avoids it, paths may visit a node twice.
    start, goal : int
    slack : ndarray of int32, shape (k,), optional
        What a path that was found is worse than by no more than this in each cost is left out: each path of the front
        then has one here that is so little worse. With it the answer is never complete.
    limit : int, optional
        Labels that may be made.
    check : callable, optional
        Asked every few milliseconds; the search ends where it returns True.

    Raises
    ------
    ParameterError
        Costs of a path that do not fit into 31 bits.
    """
    n, k = len(neighbours), costs.shape[2]
    order = _order(costs, turns)
    costs = np.ascontiguousarray(costs[:, :, order])
    turning = turns.size > 0
    turns = np.ascontiguousarray(turns[:, :, order]) if turning else np.zeros((0, 8, k), np.int32)
    bounds = _bounds(neighbours, costs, turns, goal)
    spare = np.zeros(k, np.int32) if slack is None else np.ascontiguousarray(slack[order], np.int32)
    network = kernels.Network(neighbours, costs, turns, _gaps(turns, k), bounds, goal, spare)
    source = 9 * start if turning else start
    search = _begin(n, k)
    if bounds[source, 0] < kernels.FAR:
        search.labels[0] = [-1, source, *([0] * k)]
        search.keys[0] = search.items[0] = 0
        search.counts[[kernels.MADE, kernels.OPEN]] = 1
    most = np.iinfo(np.int64).max if limit is None else limit
    advance: Callable[..., int] = kernels.advance_two if k == 2 and not turning else kernels.advance
    while not (check and check()):
        state = advance(network, search, CHUNK, most)
        if state == kernels.OVERFLOW:
            raise _too_dear()
        if state == kernels.DONE or (state == kernels.FULL and search.counts[kernels.MADE] + 8 > most):
            break
        if state == kernels.FULL:
            search = _longer(search)
    made, _, popped, count = search.counts[:4].tolist()
    found = search.found[:count]
    values = search.labels[found, 2:][:, np.argsort(order)].astype(np.int64)
    ranking = np.lexsort(values.T[::-1])
    paths = [kernels.trace(search.labels, label, turning) for label in found[ranking]]
    ended = bool(search.counts[kernels.OPEN] == 0)
    return Labels(values[ranking], paths, ended and not spare.any(), made, popped, ended)


def _order(costs: NDArray[np.int32], turns: NDArray[np.int32]) -> list[int]:
    """Which cost labels are sorted by: one without turns, if any, of the widest range: few vectors are left then."""
    k = costs.shape[2]
    looks = [turns.size > 0 and bool(turns[:, :, j].any()) for j in range(k)]
    widest = costs.reshape(-1, k).max(axis=0, initial=0)
    first = min(range(k), key=lambda j: (looks[j], -int(widest[j])))
    return [first, *(j for j in range(k) if j != first)]


def _gaps(turns: NDArray[np.int32], k: int) -> NDArray[np.int64]:
    """By how much the next move can be dearer after one last move than after another, shape (9, 9, k).

    So much better must a label be to cover one of the same node with another last move. Where all costs look at turns,
    the order in which labels come no longer follows from their costs at the node: none covers another then.
    """
    if turns.size == 0:
        return np.zeros((9, 9, k), np.int64)
    if turns[:, :, 0].any():
        return np.repeat(np.where(np.eye(9), 0, np.int64(kernels.FAR))[:, :, None], k, axis=2)
    gaps: NDArray[np.int64] = np.maximum(turns[:, None].astype(np.int64) - turns[None], 0).max(axis=2)
    return gaps


def _bounds(
    neighbours: NDArray[np.int32], costs: NDArray[np.int32], turns: NDArray[np.int32], goal: int
) -> NDArray[np.int32]:
    begin, edges = kernels.arrivals(neighbours)
    states = 9 if turns.size else 1
    bounds = np.empty((len(neighbours) * states, costs.shape[2]), np.int32)
    for j in range(costs.shape[2]):
        if turns.size and turns[:, :, j].any():
            bounds[:, j] = kernels.bound_turning(begin, edges, costs, turns, j, goal)
        else:
            bounds[:, j] = np.repeat(kernels.bound(begin, edges, costs, j, goal), states)
    dearest = int(costs.max(initial=0)) + int(turns.max(initial=0))
    if dearest * states * len(neighbours) >= kernels.FAR:  # else no path costs that much
        reachable = kernels.bound(begin, edges, np.zeros_like(costs), 0, goal) < kernels.FAR
        if (bounds[np.repeat(reachable, states)] == kernels.FAR).any():
            raise _too_dear()
    return bounds


def _begin(n: int, k: int) -> kernels.Search:
    return kernels.Search(
        labels=np.empty((ROOM, 2 + k), np.int32),
        keys=np.empty(ROOM, np.int64),
        items=np.empty(ROOM, np.int32),
        least=np.full(n + 1, kernels.FAR),
        root=np.full(n + 1, kernels.NONE),
        forks=np.empty((ROOM, 2 + 2 * k), np.int32),
        leaves=np.empty((ROOM, (kernels.LEAF + 2) * k), np.int32),
        found=np.empty(ROOM, np.int32),
        counts=np.zeros(7, np.int64),
    )


def _longer(search: kernels.Search) -> kernels.Search:
    """The same with twice the room where it has become short."""
    short = search.counts[kernels.MADE] + 8 > len(search.labels)
    names = ["labels", "keys", "items", "found"] if short else ["forks", "leaves"]
    return search._replace(**{name: _twice(getattr(search, name)) for name in names})


def _twice(array: NDArray[np.int32]) -> NDArray[np.int32]:
    longer = np.empty((2 * len(array), *array.shape[1:]), array.dtype)
    longer[: len(array)] = array
    return longer


def _too_dear() -> ParameterError:
    return ParameterError("costs of a path", "they are whole numbers below 2^31", "choose coarser units")
