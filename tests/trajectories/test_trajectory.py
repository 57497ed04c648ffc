"""Trajectories on real maps and drawn ones: ends, walls, curvature; what is refused."""

from __future__ import annotations

import itertools
import json
import math
import pickle
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import antnav as an
from antnav.errors import ParameterError, PathError
from tests.conftest import grid_of


def least_distance(points: np.ndarray, grid: an.GridMap) -> float:
    """Metres from a line to the squares of occupied cells, by brute force at a tenth of a cell."""
    fine = np.concatenate([np.linspace(a, b, 11) for a, b in itertools.pairwise(points)])
    squares = grid.cell_to_world(np.argwhere(grid.cells == an.Cell.OCCUPIED))
    least = math.inf
    for part in np.array_split(fine, max(len(fine) // 100, 1)):
        gaps = np.maximum(np.abs(part[:, None] - squares) - grid.resolution / 2, 0)
        least = min(least, float(np.hypot(gaps[..., 0], gaps[..., 1]).min()))
    return least


def test_around_a_corner() -> None:
    grid = an.GridMap(np.pad(np.ones((10, 10), np.uint8), ((10, 0), (10, 0))), 0.1)
    problem = an.Problem.from_cells(grid.inflated(0.2, strict=True), (18, 3), (3, 18))
    path = an.exact.optimum(problem).path
    assert path is not None
    made = an.trajectory(path, problem, radius=0.2, max_curvature=2.5)
    assert made.smooth
    assert made.max_curvature <= 2.5
    assert 0.2 <= made.wall_distance == pytest.approx(least_distance(made.points, grid), abs=0.01)
    assert math.dist(problem.start, problem.goal) < made.length < path.length_m
    assert np.hypot(*np.diff(made.points, axis=0).T).max() <= 0.05 + 1e-9
    assert an.check_trajectory(made, problem, 0.2, 2.5) == pytest.approx(made.length, rel=1e-3)
    assert (tuple(made.points[0]), tuple(made.points[-1])) == (problem.start, problem.goal)


def drawn(grid: an.GridMap, need: float, count: int, seed: int) -> list[an.Problem]:
    closed, draw = grid.inflated(need, strict=True), np.random.default_rng(seed)
    cells = np.argwhere(closed.cells == an.Cell.FREE)
    problems = []
    while len(problems) < count:
        one, other = cells[draw.integers(len(cells), size=2)].tolist()
        problem = an.Problem.from_cells(closed, tuple(one), tuple(other))
        if problem.connected and one != other:
            problems.append(problem)
    return problems


@pytest.mark.filterwarnings("ignore::antnav.maps.MapWarning")
@pytest.mark.parametrize(("name", "radius", "limit"), [("depot", 0.2, 2.0), ("warehouse", 0.25, None)])
@pytest.mark.slow
def test_nothing_is_touched_on_real_maps(data: Path, name: str, radius: float, limit: float | None) -> None:
    grid = an.load_map(data / "ros" / "nav2_bringup" / f"{name}.yaml")
    smooth = 0
    for problem in drawn(grid, radius + 0.05, 100, 4):
        path = an.exact.shortest_path(problem).path
        assert path is not None
        made = an.trajectory(path, problem, radius=radius, margin=0.05, max_curvature=limit)
        an.check_trajectory(made, problem, radius + 0.05)
        assert made.wall_distance >= radius + 0.05 - 1e-9
        smooth += made.smooth
        if made.smooth and limit:
            assert made.max_curvature <= limit * (1 + 1e-9)
    assert smooth >= 95


def test_what_is_refused() -> None:
    problem = an.Problem.from_cells(grid_of("....", "....", "..#."), (0, 0), (0, 3))
    path = an.exact.optimum(problem).path
    assert path is not None
    for odd in (
        {"spacing": 0},
        {"spacing": math.nan},
        {"radius": -1},
        {"margin": "wide"},
        {"max_curvature": 0},
        {"start_heading": math.nan},
        {"goal_heading": math.inf},
        {"radius": 3.0},
        {"margin": 1e9},
    ):
        with pytest.raises(ParameterError):
            an.trajectory(path, problem, **odd)  # type: ignore[arg-type]


def hall(*, width: int = 30) -> an.GridMap:
    """A hall in which a wall leaves a door of seven cells."""
    cells = np.zeros((21, width), np.uint8)
    cells[:, width // 2] = 1
    cells[7:14, width // 2] = 0
    return an.GridMap(cells, 0.1, (3.0, -1.0, 0.7))


def path_of(problem: an.Problem) -> an.Path:
    path = an.exact.optimum(problem).path
    assert path is not None
    return path


@pytest.mark.parametrize(
    ("name", "start", "goal"), [("iqaco_20", (3, 3), (10, 2)), ("winsleo_walls_20", (19, 6), (17, 14))]
)
def test_arcs_are_no_detour_where_smaller_ones_fit(
    data: Path, name: str, start: tuple[int, int], goal: tuple[int, int]
) -> None:
    problem = an.Problem.from_cells(an.load_map(data / "aco_grids" / f"{name}.txt"), start, goal)
    made = an.trajectory(path_of(problem), problem)
    assert made.smooth
    assert made.length <= 1.03 * an.exact.any_angle(problem).length  # with arcs of two cells 1.2


def test_headings_are_exact_and_joined_without_a_corner() -> None:
    problem = an.Problem.from_cells(hall().inflated(0.25, strict=True), (5, 5), (16, 24))
    for start, goal in ((1.0, -2.0), (3.0, None), (None, 0.0), (-3.1, 7.0)):
        made = an.trajectory(
            path_of(problem), problem, radius=0.25, max_curvature=4, start_heading=start, goal_heading=goal
        )
        assert made.smooth
        for given, pose in ((start, made.poses[0]), (goal, made.poses[-1])):
            if given is not None:
                assert math.remainder(pose[2] - given, math.tau) == pytest.approx(0, abs=1e-9)
        an.check_trajectory(made, problem, 0.25, 4)


def test_where_no_curve_fits_corners_stay_and_it_says_so() -> None:
    problem = an.Problem.from_cells(grid_of(".#...", ".#.#.", "...#."), (0, 0), (2, 4))
    made = an.trajectory(path_of(problem), problem, max_curvature=0.5)
    assert not made.smooth
    assert "no curve of curvature <= 0.5 / m was found" in made.note
    assert made.max_curvature == math.inf
    assert math.inf in made.curvature
    turning = np.flatnonzero(np.hypot(*np.diff(made.points, axis=0).T) == 0)
    assert len(turning) > 1  # where it turns on the spot, there are two poses
    assert an.check_trajectory(made, problem) == pytest.approx(made.length)
    assert an.trajectory(path_of(problem), problem).smooth  # without a limit


def test_a_path_that_is_too_near_is_planned_anew() -> None:
    grid = hall()
    problem = an.Problem.from_cells(grid, (6, 5), (6, 24))
    near = path_of(problem)
    assert near.wall_distance < 0.2
    made = an.trajectory(near, problem, radius=0.2, margin=0.05)
    assert "planned" in made.note
    assert made.wall_distance >= 0.25 - 1e-9
    with pytest.raises(ParameterError, match=r"radius and margin: no path keeps 0\.4 m from walls"):
        an.trajectory(near, problem, radius=0.4)
    with pytest.raises(ParameterError, match=r"start .* it is nearer to a wall than radius and margin, 2 m"):
        an.trajectory(near, problem, radius=1.5, margin=0.5)


def test_unknown_and_kept_out_cells_stay_out() -> None:
    grid = grid_of("......", "..??..", "..??..", "......")
    problem = an.Problem.from_cells(grid, (1, 0), (2, 5))
    made = an.trajectory(path_of(problem), problem, radius=0.1, max_curvature=2)
    assert not (problem.grid.cells[tuple(grid.world_to_cell(made.points).T)] == an.Cell.UNKNOWN).any()
    known = an.Problem.from_cells(grid, (1, 0), (2, 5), allow_unknown=True)
    assert an.trajectory(path_of(known), known, radius=0.1).length == pytest.approx(math.hypot(5, 1))
    free = an.GridMap(np.zeros((4, 6), np.uint8))
    kept = an.Problem.from_cells(free, (1, 0), (2, 5), cost=an.costs.keepout(grid.cells == an.Cell.UNKNOWN))
    assert an.trajectory(path_of(kept), kept, radius=0.1).length > 5.2


def test_costs_keep_the_line_where_the_path_is() -> None:
    grid = an.GridMap(np.zeros((15, 21), np.uint8))
    dear = np.zeros(grid.shape)
    dear[3:12, 8:13] = 5.0
    problem = an.Problem.from_cells(grid, (7, 0), (7, 20), cost=an.costs.array(dear))
    made = an.trajectory(path_of(problem), problem, max_curvature=1)
    assert dear[tuple(grid.world_to_cell(made.points).T)].mean() < 0.5
    assert 20.5 < made.length < path_of(problem).length
    assert made.smooth


def test_start_and_goal_in_one_place() -> None:
    problem = an.Problem.from_cells(hall(), (5, 5), (5, 5))
    made = an.trajectory(path_of(problem), problem, radius=0.1)
    assert (len(made), made.length, made.smooth) == (1, 0.0, True)
    turned = an.trajectory(path_of(problem), problem, start_heading=0.0, goal_heading=1.0)
    assert turned.poses[[0, -1], 2] == pytest.approx([0.0, 1.0])
    an.check_trajectory(turned, problem)


def test_files(tmp_path: Path) -> None:
    problem = an.Problem.from_cells(hall(), (5, 5), (16, 24))
    made = an.trajectory(path_of(problem), problem, radius=0.2)
    made.save(tmp_path / "drive.csv")
    table = np.genfromtxt(tmp_path / "drive.csv", delimiter=",", names=True)
    assert table.dtype.names == ("s", "x", "y", "heading", "curvature")
    assert (np.column_stack([table["x"], table["y"], table["heading"]]) == made.poses).all()
    assert table["s"][-1] == made.length
    made.save(tmp_path / "drive.json")
    told = json.loads((tmp_path / "drive.json").read_bytes())
    assert (told["schema"], told["smooth"], told["radius"]) == ("antnav/trajectory", True, 0.2)
    assert told["poses"] == made.poses.tolist()
    assert told["wall_distance_m"] == made.wall_distance
    with pytest.raises(ParameterError, match=r"trajectories end in \.csv, \.json"):
        made.save(tmp_path / "drive.txt")


def test_a_trajectory_that_is_wrong_is_found() -> None:
    problem = an.Problem.from_cells(hall(), (2, 10), (2, 19))
    made = an.trajectory(path_of(problem), problem, radius=0.2, max_curvature=2)
    length = made.poses[:, :2] - made.poses[0, :2]
    for change, rule in (
        ({"poses": made.poses[1:]}, "start"),
        ({"poses": made.poses[[0, -1]]}, "open|radius"),
        ({"poses": made.poses + np.array([0, 0, 0.1])}, "heading"),
        ({"radius": 0.5}, "a distance of"),
        ({"poses": np.column_stack((made.poses[0, :2] + 99 * length, made.poses[:, 2]))}, "goal"),
        ({"curvature": made.curvature * 0.1}, "a curvature of"),
    ):
        with pytest.raises(PathError, match=rule):
            an.check_trajectory(replace(made, **change), problem)  # type: ignore[arg-type]
    with pytest.raises(PathError, match="a curvature of"):
        an.check_trajectory(made, problem, max_curvature=0.5)


def test_a_result_has_one() -> None:
    problem = an.Problem.from_cells(hall().inflated(0.2, strict=True), (5, 5), (16, 24))
    result = an.solve(problem, an.npaco(ants=9, iterations=9))
    made = result.trajectory(radius=0.2, max_curvature=2, spacing=0.02)
    assert made.length < result.length_m
    assert pickle.loads(pickle.dumps(made)).poses.tolist() == made.poses.tolist()
    walled = an.solve(an.Problem.from_cells(grid_of(".#."), (0, 0), (0, 2)), an.npaco(ants=2, iterations=2))
    with pytest.raises(ParameterError, match="status unreachable: a trajectory follows a path"):
        walled.trajectory()


def test_unknown_cells_stay_closed_beneath_inflated_ones(tmp_path: Path) -> None:
    cells = np.zeros((12, 30), np.uint8)
    cells[4:8, 10:20] = an.Cell.UNKNOWN
    cells[6, 10:20] = an.Cell.OCCUPIED  # the unknown band around it is narrower than the robot
    grid = an.GridMap(cells, 0.1)
    inflated = grid.inflated(0.24, strict=True)
    assert inflated.covered is not None
    assert (inflated.covered == (cells == an.Cell.UNKNOWN) & (inflated.cells == an.Cell.INFLATED)).all()
    assert grid.covered is None
    problem = an.Problem.from_cells(inflated, (3, 2), (3, 27))
    result = an.solve(problem, an.astar())
    result.save(tmp_path / "plan.json")
    for each in (result, an.Result.load(tmp_path / "plan.json"), pickle.loads(pickle.dumps(result))):
        drive = each.trajectory(radius=0.15)
        row, col = np.floor([12 - drive.points[:, 1] / 0.1, drive.points[:, 0] / 0.1]).astype(int)
        assert not np.isin(cells[row, col], (an.Cell.UNKNOWN, an.Cell.OCCUPIED)).any()
    dip = 0.25 * (np.abs(np.arange(len(drive)) - len(drive) // 2) < 3)
    fake = replace(drive, poses=drive.poses - dip[:, None] * (0.0, 1.0, 0.0))
    with pytest.raises(PathError, match="not open"):
        an.check_trajectory(fake, problem, 0.0, np.inf)
    crossing = an.Problem.from_cells(inflated, (3, 2), (3, 27), allow_unknown=True)
    assert an.solve(crossing, an.astar()).trajectory(radius=0.15).length <= drive.length + 1e-9


def test_a_margin_alone_opens_no_cells_that_inflation_closed() -> None:
    walls = np.zeros((40, 60), np.uint8)
    walls[10:30, 28:32] = 1
    problem = an.Problem(an.GridMap(walls, 0.05).inflated(0.25, strict=True), (0.2, 1.0), (2.8, 1.0))
    drive = an.solve(problem, an.astar()).trajectory(margin=0.05)
    assert drive.smooth
    assert drive.wall_distance > 0.25
