"""Maps and paths lie where they should, and what matters is seen."""

from __future__ import annotations

import io
import math

import numpy as np
import pytest
from PIL import Image

import antnav as an
from antnav import plot
from antnav.planner.result import Result
from antnav.plot.data import CELL_COLOURS
from tests.plot.samples import line, plan, texts, two_rooms

pytest.importorskip("matplotlib").use("Agg")
from matplotlib.image import AxesImage  # noqa: E402


def test_plot_map_lies_where_the_map_lies():
    grid = two_rooms(resolution=0.5, origin=(-2.0, 3.0, 0.0))
    ax = plot.plot_map(grid)
    (image,) = ax.get_images()
    assert image.get_extent() == [-2.0, 5.0, 3.0, 8.0]
    assert (ax.get_xlim(), ax.get_ylim()) == ((-2.0, 5.0), (3.0, 8.0))
    np.testing.assert_array_equal(image.get_array(), plot.map_colours(grid))
    assert (ax.get_xlabel(), ax.get_ylabel(), ax.get_title()) == ("x (m)", "y (m)", "two rooms")
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["obstacle", "inflated", "unknown"]


def test_the_map_is_one_image(divided):
    assert [type(image) for image in plot.plot_path(divided).get_images()] == [AxesImage]


def test_lines_between_cells_only_on_small_maps():
    assert len(plot.plot_map(an.GridMap(np.zeros((60, 50), bool))).collections) == 2
    assert not plot.plot_map(an.GridMap(np.zeros((60, 61), bool))).collections


def test_a_very_large_map_is_drawn_as_means_of_blocks(monkeypatch):
    monkeypatch.setattr("antnav.plot.map.DRAWN_SIDE", 4)
    cells = np.zeros((3, 7), np.uint8)
    cells[0, 0] = cells[:, 6] = 1
    ax = plot.plot_map(an.GridMap(cells, resolution=0.5))
    (image,) = ax.get_images()
    assert image.get_array().shape == (2, 4, 3)
    assert image.get_extent() == [0, 4, -0.5, 1.5]  # the last blocks reach beyond the map
    assert (ax.get_xlim(), ax.get_ylim()) == ((0, 3.5), (0, 1.5))
    free, wall = CELL_COLOURS[:2].astype(float)
    np.testing.assert_array_equal(image.get_array()[0, 0], ((3 * free + wall) / 4).astype(np.uint8))
    np.testing.assert_array_equal(image.get_array()[1, 3], wall.astype(np.uint8))


def test_thin_walls_of_a_large_map_stay_visible():
    cells = np.zeros((1000, 1600), np.uint8)
    cells[501] = 1  # one row, narrower than a pixel
    ax = plot.plot_map(an.GridMap(cells))
    buffer = io.BytesIO()
    ax.figure.savefig(buffer, dpi=100)
    picture = np.asarray(Image.open(buffer).convert("L"))
    assert (np.median(picture, axis=1) < 225).any()


def test_plot_path_shows_path_ends_and_auxiliary_cell(divided):
    ax = plot.plot_path(divided)
    np.testing.assert_array_equal(line(ax, "path").get_xydata(), divided.path.points)
    np.testing.assert_array_equal(line(ax, "start").get_xydata(), [divided.problem.start])
    np.testing.assert_array_equal(line(ax, "goal").get_xydata(), [divided.problem.goal])
    star = line(ax, "auxiliary cell")
    assert star.get_marker() == "*"
    np.testing.assert_array_equal(star.get_xydata()[0], divided.problem.grid.cell_to_world(divided.auxiliary_cell))
    names = [text.get_text() for text in ax.get_legend().get_texts()]
    assert names[:4] == ["path", "start", "goal", "auxiliary cell"]
    assert names[-1].startswith("pheromone")


def test_a_turned_map_is_drawn_in_the_world():
    grid = two_rooms(resolution=0.5, origin=(7.0, -3.0, 0.6))
    result = plan(grid)
    ax = plot.plot_path(result)
    np.testing.assert_array_equal(line(ax, "path").get_xydata(), result.path.points)
    np.testing.assert_array_equal(line(ax, "start").get_xydata(), [result.problem.start])
    np.testing.assert_allclose(ax.get_xlim(), (grid.corners()[:, 0].min(), grid.corners()[:, 0].max()))
    np.testing.assert_allclose(ax.get_ylim(), (grid.corners()[:, 1].min(), grid.corners()[:, 1].max()))
    assert ax.get_xlabel() == "x (m)"


@pytest.mark.parametrize("yaw", [0.0, 0.6, -2.5, math.pi / 2])
def test_a_point_read_off_the_picture_lies_in_the_cell_that_is_drawn_there(yaw):
    cells = np.array([[1, 0, 2], [0, 3, 1]])
    grid = an.GridMap(cells, resolution=0.5, origin=(7.0, -3.0, yaw))
    ax = plot.plot_map(grid)
    ax.get_legend().remove()
    buffer = io.BytesIO()
    ax.figure.savefig(buffer, dpi=100)
    picture = np.asarray(Image.open(buffer).convert("RGB"))
    for cell in np.ndindex(cells.shape):
        col, row = ax.transData.transform(grid.cell_to_world(cell))
        assert tuple(picture[round(len(picture) - row), round(col)]) == tuple(CELL_COLOURS[cells[cell]])


def test_plot_path_of_an_exact_start_and_goal():
    result = an.solve(an.Problem(two_rooms(), (1.2, 8.9), (12.7, 1.1)), an.npaco(iterations=3), seed=0)
    drawn = line(plot.plot_path(result), "path").get_xydata()
    assert (tuple(drawn[0]), tuple(drawn[-1])) == ((1.2, 8.9), (12.7, 1.1))


def test_a_loaded_result_is_drawn_without_pheromone(divided, tmp_path):
    divided.save(tmp_path / "plan.json")
    ax = plot.plot_path(Result.load(tmp_path / "plan.json"))
    assert "pheromone" not in texts(ax.figure)
    np.testing.assert_array_equal(line(ax, "path").get_xydata(), divided.path.points)


def test_without_a_path_start_and_goal_are_still_drawn(unreachable, nobody_arrived):
    for result in (unreachable, nobody_arrived):
        ax = plot.plot_path(result)
        assert {"start", "goal"} <= {line.get_label() for line in ax.lines}
        assert "path" not in {line.get_label() for line in ax.lines}
    assert "reachable from the start" in texts(plot.plot_path(unreachable).figure)


def test_start_and_goal_in_one_cell_are_both_seen(same_cell):
    ax = plot.plot_path(same_cell)
    start, goal = line(ax, "start"), line(ax, "goal")
    assert goal.get_markersize() > start.get_markersize()
    assert ax.lines.index(goal) < ax.lines.index(start)
    assert "path" not in [text.get_text() for text in ax.get_legend().get_texts()]


def test_wide_borders_of_unknown_cells_are_cropped():
    cells = np.full((200, 300), an.Cell.UNKNOWN, np.uint8)
    cells[50:90, 100:140] = an.Cell.FREE
    cells[50, 100:140] = an.Cell.OCCUPIED
    grid = an.GridMap(cells, resolution=0.1, origin=(-1.0, 2.0, 0.0))
    ax = plot.plot_map(grid)
    corners = grid.cell_to_world([(89 + 3 + 0.5, 100 - 3 - 0.5), (50 - 3 - 0.5, 139 + 3 + 0.5)])
    np.testing.assert_allclose((*ax.get_xlim(), *ax.get_ylim()), corners.T.ravel())
    whole = an.Problem.from_cells(grid, (60, 110), (190, 5), allow_unknown=True)
    ax = plot.plot_path(an.solve(whole, an.astar()))
    np.testing.assert_allclose((*ax.get_xlim(), *ax.get_ylim()), (-1.0, 29.0, 2.0, 22.0))
    blank = plot.plot_map(an.GridMap(np.full((9, 9), an.Cell.UNKNOWN, np.uint8)))
    assert (blank.get_xlim(), blank.get_ylim()) == ((0, 9), (0, 9))


def test_the_robot_is_drawn_at_some_poses_of_its_trajectory():
    from matplotlib.collections import PatchCollection

    problem = an.Problem.from_cells(an.GridMap(np.zeros((30, 60), bool), 0.1), (15, 5), (15, 55))
    result = an.solve(problem, an.astar())
    ax = plot.plot_path(result, trajectory=result.trajectory(radius=0.25))
    (robots,) = (each for each in ax.collections if isinstance(each, PatchCollection))
    boxes = np.array([path.get_extents().extents for path in robots.get_paths()])
    np.testing.assert_allclose(boxes[:, 2] - boxes[:, 0], 0.5, atol=1e-6)
    assert len(boxes) == 6
    np.testing.assert_allclose(boxes[[0, -1], :2] + 0.25, [problem.start, problem.goal], atol=1e-6)
    assert "robot" in [text.get_text() for text in ax.get_legend().get_texts()]


def test_a_footprint_is_drawn_turned():
    from matplotlib.collections import PatchCollection

    problem = an.Problem.from_cells(an.GridMap(np.zeros((60, 60), bool), 0.1), (50, 30), (10, 30))
    result = an.solve(problem, an.astar())
    drive = result.trajectory(footprint=[(0.4, 0.1), (0.4, -0.1), (-0.2, -0.1), (-0.2, 0.1)])
    ax = plot.plot_path(result, trajectory=drive)
    (robots,) = (each for each in ax.collections if isinstance(each, PatchCollection))
    first = robots.get_paths()[0].get_extents().extents  # it heads up
    x, y = problem.start
    np.testing.assert_allclose(first, (x - 0.1, y - 0.2, x + 0.1, y + 0.4), atol=1e-9)
