"""How many truly different routes there are, and what they take: `python benchmarks/bench_routes.py [DATA]`.

DATA is a folder with maps of nav2 and MovingAI, ../shared/data by default; of scenario files the hardest query is
asked. Columns: routes out of 5 that are 30 % different, by the default tolerance and by 1 m (a cell of MovingAI's is a
metre); by penalties around A* instead; the gaps of the first 3 in per cent; medians of interleaved calls in
milliseconds of CPU time, for 3 routes and for one A*. Last, ten seeds of paco_ls on depot: how many of their paths are
30 % different beyond 1 m.
"""

from __future__ import annotations

import statistics
import sys
import time
import warnings
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import antnav as an
from antnav import maps
from antnav.routes.model import compared

ROUNDS = 5
ROS = {
    "depot": ((2, 2, 28, 13), (2, 13, 28, 2), (1, 8, 29, 8)),
    "warehouse": ((1, 1, 6, 6),),
    "tb3_sandbox": ((-2.0, -0.5, 1.8, 0.6),),
}
SCENARIOS = (
    *("cities/Berlin_0_256", "dao/arena", "dao/den312d", "dao/brc202d", "da2/ht_chantry", "rooms/32room_000"),
    "random/random512-10-0",
)


def problems(data: Path) -> Iterator[tuple[str, an.Problem]]:
    for name in ("equiv20", "equiv30", "equiv40"):
        ends = maps.builtin_query(name)
        yield name, an.Problem.from_cells(maps.builtin(name), *ends, corner_rule="allow")
    grid = maps.builtin("warehouse").inflated(0.25)
    yield "warehouse (built in)", an.Problem.from_cells(grid, *maps.builtin_query("warehouse"))
    for name, queries in ROS.items():
        grid = an.load_map(data / "ros/nav2_bringup" / f"{name}.yaml").inflated(0.2)
        for number, (x, y, to_x, to_y) in enumerate(queries, 1):
            yield f"{name} {number}", an.Problem(grid, (x, y), (to_x, to_y), start_tolerance=2, goal_tolerance=2)
    for name in SCENARIOS:
        path = data / "movingai" / f"{name}.map"
        grid, query = an.load_map(path), maps.load_scenarios(path.with_suffix(".map.scen"))[-1]
        yield path.stem, an.Problem.from_cells(grid, query.start, query.goal)


def milliseconds(work: Callable[[], object]) -> float:
    begin = time.thread_time()
    work()
    return 1000 * (time.thread_time() - begin)


def main() -> None:
    warnings.simplefilter("ignore", maps.MapWarning)
    data = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parents[2] / "shared" / "data")
    print(f"{'map':<21} routes  1 m  penalty  gaps of 3 (%)            ms    A* ms")
    for name, problem in problems(data):
        found, metre = an.alternatives(problem, 5), an.alternatives(problem, 5, tolerance=1.0)
        penalised = an.alternatives(problem, 5, algorithm=an.astar())
        calls = (partial(an.alternatives, problem, 3), partial(an.exact.shortest_path, problem))
        times = [[milliseconds(call) for call in calls] for _ in range(ROUNDS)]
        ours, astar = (statistics.median(column) for column in zip(*times, strict=True))
        gaps = " ".join(f"{100 * route.gap:6.2f}" for route in found.routes[:3])
        counts = f"{len(found):6} {len(metre):4} {len(penalised):8}"
        print(f"{name:<21} {counts}  {gaps:<20} {ours:6.1f} {astar:8.2f}", flush=True)
    grid = an.load_map(data / "ros/nav2_bringup/depot.yaml").inflated(0.2)
    problem = an.Problem(grid, (2, 2), (28, 13))
    paths = [an.solve(problem, an.paco_ls(), seed=seed).path for seed in range(10)]
    optimum = an.exact.optimum(problem).cost
    apart = compared([path for path in paths if path], problem, optimum, 0.7, 1 / grid.resolution)
    print(f"ten seeds of paco_ls on depot: {len(apart)} different paths")


if __name__ == "__main__":
    main()
