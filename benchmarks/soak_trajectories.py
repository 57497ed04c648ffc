"""Random trajectories on real maps, each checked by code of its own.

`python benchmarks/soak_trajectories.py [QUERIES] [DATA] [SEED]`: 10,000 queries by default, over the maps of
`bench_trajectories.py` and of MovingAI: random radius, margin, limit of the curvature and headings, start and goal at
centres of cells or anywhere in them, along A*'s path or the cells of the shortest line at any angle. Each curve is
sampled at a tenth of a cell; what lies near a sample is found in a k-d tree of walls, and the distance is that to their
squares. Every failure, and every curve longer than its path, is a line of JSON, which says how to repeat it; exit
code 1 if there is a failure.
"""

from __future__ import annotations

import json
import math
import sys
import time
import warnings
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
from bench_trajectories import MAPS
from numpy.typing import NDArray
from scipy.ndimage import binary_erosion
from scipy.spatial import KDTree

import antnav as an
from antnav import maps
from antnav.errors import ParameterError

FILES = [f"ros/{name}.yaml" for name in MAPS]
FILES += [
    f"movingai/{name}.map"
    for name in (
        "cities/Berlin_0_256",
        "dao/brc202d",
        "dao/den312d",
        "da2/ht_chantry",
        "bg512/AR0602SR",
        "rooms/32room_000",
        "sc1/Aftershock",
        "random/random512-10-0",
        "mapf/warehouse-10-20-10-2-1",
    )
]
BLOCK = 10  #: Queries with one radius, margin and limit.
CLOSE = 1e-6  #: Metres, radians, or a share.


class Walls:
    """Distances to the squares of a map's occupied cells."""

    def __init__(self, grid: an.GridMap) -> None:
        self.grid, occupied = grid, grid.cells == an.Cell.OCCUPIED
        edge = occupied & ~binary_erosion(occupied, np.ones((3, 3)), border_value=1)
        self.centres = np.argwhere(edge)[:, ::-1].astype(float)
        self.tree = KDTree(self.centres) if len(self.centres) else None

    def least(self, points: NDArray[np.float64], reach: float, closed: an.GridMap) -> tuple[float, bool]:
        """Metres from points to the nearest square, as far as `reach`, -1 in one or in what is unknown on a closed map.

        And whether a point lies in what was unknown before cells near walls were closed, which hides that.
        """
        grid = self.grid
        (dx, dy), yaw = ((points - grid.origin[:2]) / grid.resolution).T, grid.origin[2]
        x = dx * math.cos(yaw) + dy * math.sin(yaw) - 0.5
        y = grid.rows - 0.5 - (dy * math.cos(yaw) - dx * math.sin(yaw))
        row, col = np.rint(y).astype(int), np.rint(x).astype(int)
        if not ((row >= 0) & (row < grid.rows) & (col >= 0) & (col < grid.cols)).all():
            return -1.0, False
        inside = np.maximum(np.abs(y - row), np.abs(x - col)) < 0.5 - CLOSE
        if (inside & np.isin(closed.cells[row, col], (an.Cell.OCCUPIED, an.Cell.UNKNOWN))).any():
            return -1.0, True
        hidden = bool((inside & (grid.cells[row, col] == an.Cell.UNKNOWN)).any())
        if self.tree is None:
            return reach, hidden
        cells, least = reach / grid.resolution, reach / grid.resolution
        left, count = np.column_stack((x, y)), 12
        while len(left):
            found, near = self.tree.query(left, count, distance_upper_bound=cells + math.sqrt(0.5))
            there = np.isfinite(found)
            gaps = np.abs(left[:, None] - self.centres[np.where(there, near, 0)]) - 0.5
            away = np.where(there, np.hypot(*np.moveaxis(np.maximum(gaps, 0), -1, 0)), np.inf)
            least = min(least, float(away.min()))
            left, count = left[there.all(axis=1)], 4 * count
        return least * grid.resolution, hidden


def broken(
    drive: an.Trajectory, problem: an.Problem, walls: Walls, query: dict[str, Any]
) -> tuple[list[str], float, bool]:
    """What is wrong with a trajectory, its distance from walls beyond what it should keep, `least`'s other answer."""
    wrong = []
    poses, need, limit = drive.poses, query["radius"] + query["margin"], query["max_curvature"]
    if (tuple(poses[0, :2]), tuple(poses[-1, :2])) != (problem.start, problem.goal):
        wrong.append("ends")
    for name, pose in (("start_heading", poses[0]), ("goal_heading", poses[-1])):
        if query[name] is not None and abs(math.remainder(pose[2] - query[name], math.tau)) > CLOSE:
            wrong.append(name)
    steps = np.diff(poses[:, :2], axis=0)
    chords = np.hypot(*steps.T)
    counts = np.maximum(np.ceil(10 * chords / problem.grid.resolution), 1).astype(int)
    chord = np.repeat(np.arange(len(steps)), counts)
    share = (np.arange(len(chord)) - np.repeat(np.cumsum(counts) - counts, counts)) / counts[chord]
    points = np.concatenate((poses[:-1, :2][chord] + share[:, None] * steps[chord], poses[-1:, :2]))
    away, hidden = walls.least(points, need + 0.5 * problem.grid.resolution, problem.grid)
    spare = away - need
    if spare < -CLOSE:
        wrong.append("distance")
    if drive.smooth:
        turns = np.remainder(np.diff(poses[:, 2]) + math.pi, math.tau) - math.pi
        bent = 2 * np.abs(np.sin(turns / 2))
        if limit is not None and (bent > limit * chords * (1 + CLOSE) + CLOSE).any():
            wrong.append("curvature")
        if limit is not None and drive.max_curvature > limit * (1 + CLOSE):
            wrong.append("curvature that is told")
        towards = np.arctan2(steps[:, 1], steps[:, 0])
        off = np.remainder(poses[:-1, 2] + turns / 2 - towards + math.pi, math.tau) - math.pi
        if (np.abs(off) * chords > 1e-5 + 1e-3 * chords).any():
            wrong.append("headings")
    return wrong, spare, hidden


def main() -> int:
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 10_000
    data = Path(sys.argv[2]) if len(sys.argv) > 2 else Path(__file__).resolve().parents[2] / "shared" / "data"
    draw = np.random.default_rng(int(sys.argv[3]) if len(sys.argv) > 3 else 12)
    warnings.simplefilter("ignore", maps.MapWarning)
    known = [(file, an.load_map(data / file)) for file in FILES if (data / file).exists()]
    walls = {file: Walls(grid) for file, grid in known}
    told, asked, least, ms, begin = Counter[str](), Counter[str](), math.inf, list[float](), time.perf_counter()
    done = block = 0
    slowest: tuple[float, dict[str, Any]] = (0.0, {})
    first = an.Problem.from_cells(an.GridMap([[0, 0, 0], [0, 1, 0]]), (1, 0), (1, 2))
    an.trajectory(an.exact.any_angle(first).path, first, max_curvature=3.0, goal_heading=0.0)  # compiles
    while done < count:
        file, grid = known[block % len(known)]
        block += 1
        side = grid.resolution
        radius, margin = draw.uniform(0.3, 5.0) * side, draw.choice((0.0, draw.uniform(0.0, 1.5))) * side
        limit = None if draw.random() < 0.25 else 1 / (draw.uniform(1.0, 12.0) * side)
        closed = grid.inflated(radius + margin, strict=True)
        free = np.argwhere(closed.cells == an.Cell.FREE)
        for _ in range(BLOCK if len(free) else 0):
            cells = free[draw.integers(len(free), size=2)]
            within = draw.uniform(-0.499, 0.499, (2, 2)) * (draw.random() < 0.5)
            start, goal = map(tuple, grid.cell_to_world(cells + within).tolist())
            headings = [float(draw.uniform(-4, 4)) if draw.random() < 0.4 else None for _ in range(2)]
            along = ("A*", "any angle")[draw.integers(2)]
            query = {
                **{"map": file, "start": start, "goal": goal, "radius": radius, "margin": margin, "along": along},
                **{"max_curvature": limit, "start_heading": headings[0], "goal_heading": headings[1]},
            }
            problem = an.Problem(closed, start, goal)
            search = an.exact.shortest_path if along == "A*" else an.exact.any_angle
            path = search(problem).path if problem.connected else None
            if path is None:
                continue
            options = {name: query[name] for name in ("radius", "margin", "start_heading", "goal_heading")}
            now = time.perf_counter()
            done += 1
            kind = "headings" if any(heading is not None for heading in headings) else "no headings"
            asked[kind] += 1
            try:
                drive = an.trajectory(path, problem, max_curvature=limit, spacing=max(side, 0.05), **options)
            except ParameterError as error:
                told["refused"] += 1
                if not within.any() or "nearer to a wall" not in str(error):
                    told["failed"] += 1
                    print(json.dumps(query | {"wrong": repr(error)}), flush=True)
                continue
            except Exception as error:
                told["failed"] += 1
                print(json.dumps(query | {"wrong": repr(error)}), flush=True)
                continue
            ms.append(1e3 * (time.perf_counter() - now))
            slowest = max(slowest, (ms[-1], query), key=lambda pair: pair[0])
            wrong, spare, hidden = broken(drive, problem, walls[file], query)
            least = min(least, spare / side)
            told[f"smooth, {kind}"] += drive.smooth
            told["hidden"] += hidden
            if kind == "no headings" and drive.length > 1.01 * path.length_m + side:
                told["longer"] += 1
                print(json.dumps(query | {"longer": drive.length / path.length_m}), flush=True)
            if wrong:
                told["failed"] += 1
                print(json.dumps(query | {"wrong": wrong, "spare": spare, "note": drive.note}), flush=True)
        if block % 100 == 0:
            print(f"# {done} queries, {dict(told)}, {time.perf_counter() - begin:.0f} s", file=sys.stderr, flush=True)
    print(f"{done} queries on {len(known)} maps, {told['failed']} failed, {told['refused']} refused: an end too near")
    for kind, number in asked.items():
        print(f"{kind}: {told[f'smooth, {kind}']} of {number} smooth")
    print(f"through a corner of what was unknown before inflation: {told['hidden']}")
    print(f"longer than the path by more than 1 % and a cell, without headings: {told['longer']}")
    print(f"least distance beyond radius and margin: {least:.2e} cells")
    print(f"milliseconds a curve: median {np.median(ms):.1f}, 95 % {np.percentile(ms, 95):.1f}")
    print(f"the slowest took {max(ms):.0f}: {json.dumps(slowest[1])}")
    return 1 if told["failed"] else 0


if __name__ == "__main__":
    sys.exit(main())
