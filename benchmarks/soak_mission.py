"""A mission of many changes: `python benchmarks/soak_mission.py [CHANGES]`, 100,000 by default.

Discs fall and vanish on a map of 512 x 512 cells with a robot's radius, the robot drives, goals change. Memory is told
on the way; every thousandth plan is verified on a map made anew. At the end the terrain and the regions equal those of
a mission begun afresh on the map of that moment.
"""

from __future__ import annotations

import resource
import sys
import time

import numpy as np

import antnav as an
from antnav import maps
from antnav.kernels import region_kernels

CHANGES = int(sys.argv[1]) if len(sys.argv) > 1 else 100_000
SIDE = 512


def main() -> None:
    rng = np.random.default_rng(1)
    grid = maps.generate("random", SIDE, SIDE, seed=4, density=0.25, block=8)
    problem = an.Problem.from_cells(grid, *maps.ends(grid), start_tolerance=40, goal_tolerance=40)
    mission = an.Mission(problem, radius=1.0)
    away = np.indices((9, 9)) - 4
    disc = np.argwhere((away**2).sum(axis=0) <= 16) - 4
    lying: list[np.ndarray] = []
    cut_off = checked = 0
    begin = time.perf_counter()
    for number in range(1, CHANGES + 1):
        plan = mission.plan.cells
        blocked = freed = None
        if len(lying) > 40 or plan is None:
            freed = lying.pop(int(rng.integers(len(lying)))) if lying else None
        else:
            centre = plan[rng.integers(len(plan))] if rng.random() < 0.3 else rng.integers(0, SIDE, 2)
            cells = centre + disc
            cells = cells[((cells >= 0) & (cells < SIDE)).all(axis=1)]
            cells = cells[grid.cells[tuple(cells.T)] == an.Cell.FREE]
            far = (np.abs(cells[:, None] - [mission.position, mission.goal]).max(axis=-1) > 4).all(axis=1)
            blocked = cells[far]
            lying.append(blocked)
        mission.change(blocked=blocked, freed=freed)
        if plan is not None and mission.plan:
            mission.moved_to(mission.plan.cells[min(2, len(mission.plan.cells) - 1)])
            mission.improve()
        if mission.plan.status == "arrived" or not (mission.plan or lying):
            mission.goal = mission.terrain.cells_of(rng.choice(np.flatnonzero(mission.terrain.moves), 1))[0].tolist()
        cut_off += not mission.plan
        if number % 1000 == 0 and mission.plan:
            an.check_path(mission.plan.cells, mission.problem)
            checked += 1
        if number % (CHANGES // 10) == 0:
            memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
            seconds = time.perf_counter() - begin
            print(f"{number} changes, {seconds:.0f} s, at most {memory:.0f} MB so far, {mission.plan}", flush=True)
    terrain, kept = mission.terrain, mission._replanner._regions
    fresh = an.Mission(mission.problem)
    np.testing.assert_array_equal(terrain.moves, fresh.terrain.moves)
    region_kernels.make_ready(kept, terrain.moves, terrain.width, terrain.prices)
    new = fresh._replanner._regions
    assert kept.most == new.most
    for name in ("region", "number"):
        np.testing.assert_array_equal(getattr(kept, name), getattr(new, name))
    count = 0
    for region in np.unique(new.region[new.region >= 0]).tolist():
        ways = []
        for regions in (kept, new):
            found, e = [], int(regions.head[region])
            while e >= 0:
                found.append([float(getattr(regions, name)[e]) for name in ("other", "leave", "enter", "length")])
                e = int(regions.after[e])
            ways.append(found)
        assert ways[0] == ways[1]
        count += len(ways[0])
    print(f"the terrain, {int(new.number.sum())} regions and {count} crossings equal those made anew;", end=" ")
    print(f"{checked} plans verified, {cut_off} changes without a way")


if __name__ == "__main__":
    main()
