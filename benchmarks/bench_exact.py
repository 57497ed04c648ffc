"""A* against jump point search: `python benchmarks/bench_exact.py FOLDER` of MovingAI scenarios.

The longest quarter of every scenario file whose map has a side of --side cells or more, 20 queries each, rule forbid.
At every query the two take turns; CPU milliseconds of this thread, the least of some calls after one that does not
count, median over queries. "search" is the kernel, "path" all of `exact.shortest_path`: fewer turns and a `Path`
besides. "moves" and "jumps" are worked out once a map.
"""

from __future__ import annotations

import argparse
import math
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

import antnav as an
from antnav.bench.scenarios import TOLERANCE, read_queries
from antnav.kernels import grid_kernels, jump_kernels
from antnav.search import exact
from antnav.world.jumps import jump_ends
from antnav.world.moves import legal_moves
from antnav.world.path_cost import FREE


def milliseconds(call: Callable[[], object], calls: int) -> float:
    """The least CPU time of some calls, after one that does not count."""
    call()
    spent = []
    for _ in range(calls):
        begin = time.thread_time()
        call()
        spent.append(1e3 * (time.thread_time() - begin))
    return min(spent)


def measured(problem: an.Problem, published: float, calls: int) -> list[float]:
    """Searches and whole calls of both, and the cells that either took from its queue."""
    terrain = problem.terrain
    rows, cols = problem.grid.shape
    box, graph, ends = (1, rows + 1, 1, cols + 1), (terrain.flat_moves, terrain.width), problem.flat_ends
    search = [
        lambda: grid_kernels.search(*graph, *ends, True, FREE),
        lambda: jump_kernels.jump_search(*graph, terrain.jumps, box, *ends, math.inf),
    ]
    found = [exact.shortest_path(problem, method) for method in ("astar", "jps")]
    assert found[0].length == found[1].length
    assert abs(found[0].length - published) <= TOLERANCE
    row = [milliseconds(call, calls) for call in search]
    row += [
        milliseconds(lambda method=method: exact.shortest_path(problem, method), calls) for method in ("astar", "jps")
    ]
    return [*row, *(one.expanded for one in found)]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--queries", type=int, default=20)
    parser.add_argument("--side", type=int, default=141)
    parser.add_argument("--calls", type=int, default=5)
    options = parser.parse_args()
    an.warmup(an.astar())
    an.warmup(an.jps())
    by_map: dict[str, list] = {}
    for query in read_queries(options.folder, options.queries, 0.25):
        if max(query.grid.shape) >= options.side:
            by_map.setdefault(query.map_label, []).append(query)
    head = ("map", "moves", "jumps", "A* search", "JPS search", "ratio", "A* path", "JPS path", "A* cells", "JPS cells")
    print("| " + " | ".join(head) + " |\n|---|" + "---:|" * (len(head) - 1))
    for label, queries in by_map.items():
        passable, rule = queries[0].grid.passable(unknown=False), an.CornerRule.FORBID
        moves = legal_moves(passable, rule)
        prepared = [
            milliseconds(lambda: legal_moves(passable, rule), 3),  # noqa: B023
            milliseconds(lambda: jump_ends(moves, rule), 3),  # noqa: B023
        ]
        rows = np.array([measured(query.problem(), query.published, options.calls) for query in queries])
        star, jumps, star_path, jumps_path, star_cells, jump_cells = np.median(rows, axis=0)
        cells = [f"{value:.2f}" for value in prepared] + [f"{star:.2f}", f"{jumps:.3f}", f"{star / jumps:.1f}"]
        cells += [f"{star_path:.2f}", f"{jumps_path:.3f}", f"{star_cells:.0f}", f"{jump_cells:.0f}"]
        print(f"| {label} | " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()
