"""Better paths: pieces searched anew, exactly, within boxes around them; fewer turns at the same length."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Executor
from itertools import pairwise, product
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from antnav.kernels import grid_kernels, straight_kernels
from antnav.run import spmd
from antnav.search.abstraction import Abstraction
from antnav.world.moves import STEPS
from antnav.world.path_cost import PathCost
from antnav.world.terrain import Terrain

if TYPE_CHECKING:
    from antnav.kernels.jump_kernels import Jumps

#: A first round has windows of this share of the last one's length.
FIRST_ROUND = 3
#: Moves that one job takes at least, in whole windows: fewer do not pay for a thread.
CHUNK_MOVES = 256
#: From so many moves on, jump point search takes windows where cost is length; A* keeps the others:
#: tenths of a millisecond by either, and which of several shortest paths they find is part of recorded results.
JUMPS_FROM = 64
#: Moves of a window from which on a first round of shorter ones brings no shorter path, but takes a third of the time.
ONCE_FROM = 500
#: Moves of a window at most where cells or turns cost: by A*, longer ones would take as long as the whole map.
MOST_WITH_COSTS = 192


def improved(
    path: NDArray[np.int32],
    terrain: Terrain,
    window: int,
    executor: Executor | None = None,
    ended: Callable[[NDArray[np.int32]], bool] = lambda path: False,
) -> NDArray[np.int32]:
    """A path after two rounds of windows, first short ones, then long ones, each at two alternating offsets.

    Where cost is length, windows of `ONCE_FROM` moves and more have no first round, and a path that fits in one window
    is searched once.

    POPMUSIC (Taillard & Voss 2002) with exact search for its parts: what a window holds is a shortest path within its
    box afterwards. Windows of one round and offset do not touch, so they are searched side by side, and the result does
    not depend on how many are. Where turns cost, each depends on the one before.

    Parameters
    ----------
    path : ndarray of int32, shape (k,)
        Flat cells of the padded map.
    terrain : Terrain
    window : int
        Moves of a window in the last round, >= 3; at most `MOST_WITH_COSTS` where cells or turns cost.
    executor : concurrent.futures.Executor, optional
        Default: threads.
    ended : callable, optional
        Gets the path so far before each pass; that path comes back once it says so.
    """
    plain = terrain.objective.plain
    if not plain:
        window = min(window, MOST_WITH_COSTS)
    for length in (window,) if plain and window >= ONCE_FROM else (window // FIRST_ROUND, window):
        for offset in (0, length // 2):
            if len(path) < 3 or ended(path):
                return path
            whole = plain and len(path) <= window + 1  # in one window: others bring no more
            if whole and window >= JUMPS_FROM:
                return _one_pass(path, terrain, window, 0, executor)
            path = _one_pass(path, terrain, length, offset, executor)
            if whole and length == window:
                return path
    return path


def laid_out(stops: NDArray[np.int32], abstraction: Abstraction) -> NDArray[np.int32]:
    """The path on cells along a route, shortest within each of its regions.

    Parameters
    ----------
    stops : ndarray of int32
        As `Abstraction.stops` gives them.
    """
    moves, width, block = abstraction.moves, abstraction.crossings.width, abstraction.block
    path: NDArray[np.int32] = grid_kernels.thread_route(moves, width, block, stops, abstraction.objective.prices)
    return path


def straightened(path: NDArray[np.int32], terrain: Terrain) -> NDArray[np.int32]:
    """A path with fewer turns, or as many: the same moves in another order between cells that it keeps [ours].

    Its length is the same to the last digit, it costs no more, and it has no loop that the path had not. See
    `straight_kernels.fewest_turns`. What would cross another part of the path, or cost more, is tried in halves.

    Parameters
    ----------
    path : ndarray of int32, shape (k,)
        Flat cells of the padded map.
    terrain : Terrain
    """
    objective = terrain.objective
    whole: NDArray[np.int32] = straight_kernels.fewest_turns(path, terrain.flat_moves, terrain.width)
    cells = _distinct(path)
    if _distinct(whole) >= cells and (
        objective.plain or terrain.cost_along(whole) <= terrain.cost_along(path) * (1 + 1e-12)
    ):
        return whole
    if len(path) <= 3:
        return path
    middle = len(path) // 2
    halves = [(part, straightened(part, terrain)) for part in (path[: middle + 1], path[middle:])]
    ways = [np.concatenate((one, other[1:])) for one, other in product(*halves)]
    loopless = [way for way in ways if _distinct(way) >= cells]
    if objective.plain:
        return min(loopless, key=_turns)
    return min(loopless, key=lambda way: (round(terrain.cost_along(way), 9), _turns(way)))


def _distinct(path: NDArray[Any]) -> int:
    count: int = grid_kernels.distinct(path.astype(np.int32))  # writeable, or it is compiled anew
    return count


def _turns(path: NDArray[np.int32]) -> int:
    return int(np.count_nonzero(np.diff(path, 2)))


def _one_pass(
    path: NDArray[np.int32], terrain: Terrain, window: int, offset: int, executor: Executor | None
) -> NDArray[np.int32]:
    if terrain.objective.turning:
        return _pass_with_turns(path, terrain, window, offset)
    chunk = window * max(1, CHUNK_MOVES // window)
    cuts = range(offset + chunk, len(path) - 1, chunk)
    ends = [0, *cuts, len(path) - 1]
    jobs = [(path[a : b + 1], offset if a == 0 else 0) for a, b in pairwise(ends)]
    if terrain.objective.plain and window >= JUMPS_FROM:
        graph = terrain.flat_moves, terrain.width, terrain.jumps
        pieces = spmd.run_jobs(_jumped, jobs, executor, *graph, window)
    else:
        pieces = spmd.run_jobs(_piece, jobs, executor, terrain.flat_moves, terrain.width, window, terrain.objective)
    return np.concatenate([pieces[0], *(piece[1:] for piece in pieces[1:])])


def _piece(
    job: tuple[NDArray[np.int32], int], moves: NDArray[np.uint8], width: int, window: int, objective: PathCost
) -> NDArray[np.int32]:
    path, offset = job
    better: NDArray[np.int32] = grid_kernels.reoptimise(moves, width, path, window, offset, objective.prices)
    return better


def _jumped(
    job: tuple[NDArray[np.int32], int], moves: NDArray[np.uint8], width: int, jumps: Jumps, window: int
) -> NDArray[np.int32]:
    from antnav.kernels import jump_kernels

    path, offset = job
    better: NDArray[np.int32] = jump_kernels.reoptimise(moves, width, jumps, path, window, offset)
    return better


def _pass_with_turns(path: NDArray[np.int32], terrain: Terrain, window: int, offset: int) -> NDArray[np.int32]:
    """Windows one after the other: the turn from one into the next counts, and depends on both."""
    slots = _slots(path, terrain.width)
    kept, entry = [path[:1]], 0
    for first, last in pairwise([0, *range(offset or window, len(path) - 1, window), len(path) - 1]):
        onward = int(slots[last]) if last < len(slots) else -1
        piece = _piece_with_turns(path[first : last + 1], terrain, window // 4, entry, onward)
        kept.append(piece[1:])
        if len(piece) > 1:
            entry = int(_slots(piece[-2:], terrain.width)[0]) + 1
    return np.concatenate(kept)


def _piece_with_turns(
    path: NDArray[np.int32], terrain: Terrain, margin: int, entry: int, onward: int
) -> NDArray[np.int32]:
    """The cheapest way in a box around a piece of a path, or the piece; see `grid_kernels.search_turning`."""
    width, prices, turns = terrain.width, terrain.objective.prices, terrain.objective.turns()
    assert turns is not None
    slots = _slots(path, width)
    headings = np.concatenate(([entry], slots + 1))
    following = slots if onward < 0 else np.append(slots, onward)
    bound = grid_kernels.cost_along(path, width, prices) + turns[headings[: len(following)], following].sum() - 1e-9

    rows, cols = np.divmod(path, width)
    top, left = max(0, int(rows.min()) - margin - 1), max(0, int(cols.min()) - margin - 1)
    box = slice(top, int(rows.max()) + margin + 2), slice(left, int(cols.max()) + margin + 2)
    moves = terrain.flat_moves.reshape(-1, width)[box].copy()
    moves[[0, -1]] = moves[:, [0, -1]] = 0  # where a move out of the box ends
    wide = moves.shape[1]
    local = prices._replace(
        cells=prices.cells.reshape(-1, width)[box].ravel(), heights=prices.heights.reshape(-1, width)[box].ravel()
    )
    start, goal = (int(cell) for cell in (rows[[0, -1]] - top) * wide + cols[[0, -1]] - left)
    _, found, _ = grid_kernels.search_turning(
        moves.ravel(), wide, start, goal, True, local, turns, entry, onward, float(bound)
    )
    if not len(found):
        return path
    cells: NDArray[np.int32] = ((found // wide + top) * width + found % wide + left).astype(np.int32)
    return cells


def _slots(path: NDArray[np.int32], width: int) -> NDArray[np.intp]:
    """Number of each move of a path; see `moves.STEPS`."""
    number = {row * width + col: slot for slot, (row, col) in enumerate(STEPS)}
    return np.array([number[step] for step in np.diff(path).tolist()], np.intp)


def without_loops(nodes: NDArray[Any]) -> NDArray[Any]:
    """The path with every loop cut out: from each cell on, continue after its last occurrence."""
    if _distinct(nodes) == len(nodes):
        return nodes
    last = {int(node): place for place, node in enumerate(nodes)}
    kept, place = [], 0
    while place < len(nodes):
        place = last[int(nodes[place])]
        kept.append(nodes[place])
        place += 1
    return np.array(kept, np.int32)
