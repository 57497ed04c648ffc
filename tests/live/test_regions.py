"""Regions kept up to date equal those made anew; plans are paths, verdicts right, improvement never makes worse."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
import pytest

import antnav as an
from antnav.kernels import region_kernels
from antnav.live import regions
from antnav.live.cost_memory import CostMemory
from antnav.live.regions import ROUNDS, Regions
from antnav.live.replanner import Replanner
from antnav.live.terrain import LiveTerrain
from antnav.search.exact import shortest_path
from antnav.world.cost import CostField, Slope


def crossings(regions: region_kernels.Regions, region: int) -> list[tuple[int, int, int, float]]:
    found, e = [], int(regions.head[region])
    while e >= 0:
        found.append((int(regions.other[e]), int(regions.leave[e]), int(regions.enter[e]), float(regions.length[e])))
        e = int(regions.after[e])
    return found


def drive(seed: int, rule: str, dear: bool, events: int = 60) -> Iterator[tuple[an.Mission, np.random.Generator]]:
    """A mission after each of many changes of all kinds."""
    rng = np.random.default_rng(seed)
    shape = tuple(rng.integers(12, 70, 2).tolist())
    cells = (rng.random(shape) < rng.choice([0.05, 0.2, 0.35])).astype(np.uint8)
    cells[0, 0] = cells[-1, -1] = 0
    slope = Slope(rng.random(shape) * 2, 1.0, 0.5) if seed % 2 else None
    cost = CostField(rng.random(shape) * 3, slope=slope) if dear else None
    goal = (shape[0] - 1, shape[1] - 1)
    problem = an.Problem.from_cells(an.GridMap(cells), (0, 0), goal, corner_rule=rule, cost=cost)
    mission = an.Mission(problem, "regions", radius=1.0 if seed % 3 == 2 else 0.0)
    for _ in range(events):
        kind, (row, col), side = rng.integers(4), rng.integers(0, shape), int(rng.integers(1, 8))
        square = [(r, c) for r in range(row - side, row + side) for c in range(col - side, col + side)]
        square = [(r, c) for r, c in square if 0 <= r < shape[0] and 0 <= c < shape[1]]
        if kind == 0:
            mission.change(blocked=square)
        elif kind == 1:
            mission.change(freed=square, cost=(square, rng.random() * 4) if dear else None)
        elif kind == 2 and mission.plan:
            mission.moved_to(mission.plan.cells[min(3, len(mission.plan.cells) - 1)])
        else:
            on_plan = mission.plan.cells[rng.integers(0, len(mission.plan.cells), 1)] if mission.plan else None
            mission.change(blocked=on_plan, freed=rng.integers(0, shape, (5, 2)))
        if mission.plan.status.endswith("blocked"):
            mission.change(freed=[mission.position, mission.goal])
        if not mission.plan.status.endswith("blocked"):
            yield mission, rng


@pytest.mark.parametrize("dear", [False, True])
@pytest.mark.parametrize("rule", an.CornerRule)
@pytest.mark.parametrize("seed", range(4))
def test_plans_are_paths_and_verdicts_right(seed: int, rule: an.CornerRule, dear: bool) -> None:
    gaps = []
    for mission, rng in drive(seed, rule, dear):
        problem = mission.problem
        best = shortest_path(problem)
        assert bool(mission.plan) == (best.path is not None)
        if not mission.plan:
            continue
        an.check_path(mission.plan.cells, problem)
        assert len(np.unique(mission.plan.flat)) == len(mission.plan.flat), "a loop"
        assert mission.plan.cost >= best.cost * (1 - 1e-9)
        if rng.random() < 0.3:
            before = mission.plan
            after = mission.improve(len(ROUNDS))
            an.check_path(after.cells, problem)
            assert after.cost <= before.cost * (1 + 1e-9)
            gaps.append(after.cost / max(best.cost, 1.0) - 1)
    assert np.mean(gaps or [0]) < 0.01


@pytest.mark.parametrize("seed", range(6))
def test_regions_kept_up_to_date_equal_those_made_anew(seed: int) -> None:
    mission = [mission for mission, _ in drive(seed, "forbid", seed % 2 == 1, events=80)][-1]
    terrain, kept = mission.terrain, mission._replanner._regions
    region_kernels.make_ready(kept, terrain.moves, terrain.width, terrain.prices)
    fresh = Regions()
    fresh.begin(terrain, *(terrain.to_flat(cell) for cell in (mission.position, mission.goal)))
    new = fresh._regions
    assert kept.full[0] == new.full[0] == 0
    assert kept.most == new.most
    np.testing.assert_array_equal(kept.region, new.region)
    np.testing.assert_array_equal(kept.number, new.number)
    for region in np.unique(new.region[new.region >= 0]).tolist():
        assert crossings(kept, region) == crossings(new, region)
        assert kept.centre[region] == new.centre[region]
        assert kept.price[region] == new.price[region]
    used = sum(len(crossings(kept, region)) for region in np.unique(new.region[new.region >= 0]).tolist())
    assert kept.spare[1] == len(kept.other) - used, "crossings are lost"


def test_blocks_with_more_regions_than_expected_get_room() -> None:
    """Pairs of cells side by side: a block of 12 x 12 has 36 regions, more than the 32 there is room for at first."""
    cells = np.ones((60, 60), np.uint8)
    cells[:, ::3] = cells[:, 1::3] = 0
    cells[2::3] = 1  # pairs of two rows
    cells[1::3] = 1
    cells[0], cells[:, 0], cells[-1], cells[:, -1] = 0, 0, 0, 0
    problem = an.Problem.from_cells(an.GridMap(cells), (0, 0), (59, 59))
    mission = an.Mission(problem, "regions")
    comb = np.zeros((60, 60), np.bool_)
    comb[1:-1:2, 1:-1] = True
    for _ in range(3):
        mission.change(freed=np.ones((60, 60), np.bool_))
        mission.change(blocked=comb)
        assert an.check_path(mission.plan.cells, mission.problem) == pytest.approx(mission.plan.cost)
    assert mission._replanner._regions.full[0] == 0


def test_the_graph_of_regions_joins_what_the_map_joins() -> None:
    rng = np.random.default_rng(8)
    grid = an.GridMap((rng.random((50, 50)) < 0.45).astype(np.uint8))
    free = np.argwhere(grid.passable())
    verdicts = set()
    for start, goal in rng.choice(free, (60, 2)).tolist():
        problem = an.Problem.from_cells(grid, tuple(start), tuple(goal))
        replanner = Regions()
        found = replanner.begin(LiveTerrain(problem), *problem.flat_ends)
        assert (found is not None) == problem.connected
        verdicts.add(problem.connected)
    assert verdicts == {False, True}


def test_the_same_changes_give_the_same_plans() -> None:
    one, other = ([m.plan.flat for m, _ in drive(5, "graze", False)] for _ in range(2))
    assert len(one) == len(other)
    for a, b in zip(one, other, strict=True):
        assert (a is None) == (b is None)
        assert a is None or (a == b).all()


@pytest.mark.parametrize("algorithm", [Regions, lambda: CostMemory(Regions())])
def test_prices_that_rise_on_the_path_are_driven_round(algorithm: Callable[[], Replanner]) -> None:
    cost = CostField(np.zeros((60, 60)))
    problem = an.Problem.from_cells(an.GridMap(np.zeros((60, 60), np.uint8)), (30, 1), (30, 58), cost=cost)
    mission = an.Mission(problem, algorithm())
    mission.improve(2 * len(ROUNDS))  # until nothing is left to do
    jam = np.argwhere(np.hypot(*np.mgrid[-30:30, -30:30]) < 8) - (0, 20)  # near the robot
    before = mission.plan
    mission.change(cost=(jam, 20.0))
    mission.improve(len(ROUNDS))
    assert mission.plan.cost < 0.9 * mission.terrain.cost_along(before.flat)


def test_windows_leave_no_loops() -> None:
    rng = np.random.default_rng(0)
    for _ in range(20):
        cells = (rng.random((80, 80)) < 0.3).astype(np.uint8)
        cells[:2, :2] = cells[-2:, -2:] = 0
        cost = CostField(rng.random((80, 80)) * 100)
        mission = an.Mission(an.Problem.from_cells(an.GridMap(cells), (0, 0), (79, 79), corner_rule="allow", cost=cost))
        for _ in range(10):
            there = rng.integers(0, 80, (800, 2))
            mission.change(cost=(there, rng.random(800) * 1000))
            for update in (mission.plan, mission.improve(1)):
                if update:
                    assert len(np.unique(update.cells, axis=0)) == len(update.cells)


def test_everything_is_compiled_before_the_first_plan(monkeypatch: pytest.MonkeyPatch) -> None:
    used = set()
    kernels = {name for name in vars(region_kernels) if callable(getattr(region_kernels, name)) and name.islower()}
    for name in kernels:
        kernel = getattr(region_kernels, name)
        monkeypatch.setattr(region_kernels, name, lambda *given, n=name, k=kernel: (used.add(n), k(*given))[1])
    regions._compile()
    before = set(used)
    for mission, _ in drive(1, "allow", dear=True):
        mission.improve(1)
    assert used <= before
