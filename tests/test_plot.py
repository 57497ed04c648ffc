"""Pictures: what they show is checked by value, that they can be opened, and that they hide nothing."""

from __future__ import annotations

import io
import math
import subprocess
import sys
import xml.etree.ElementTree as ET
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

import antnav as an
from antnav import plot
from antnav.colony.kernels import History
from antnav.errors import OutputError, ParameterError
from antnav.result import ColonyReport, Result, Stage, Status, StoppedBy

mpl = pytest.importorskip("matplotlib")
mpl.use("Agg")
from matplotlib import pyplot as plt  # noqa: E402
from matplotlib.colors import to_rgba  # noqa: E402
from matplotlib.image import AxesImage  # noqa: E402

INF, NAN = math.inf, math.nan


@pytest.fixture(autouse=True)
def close_figures():
    yield
    plt.close("all")


def two_rooms(door: bool = True, **place) -> an.GridMap:
    """10 x 14 cells, a wall with or without a door in the middle; one unknown cell, one inflated."""
    cells = np.zeros((10, 14), np.uint8)
    cells[:, 6] = an.Cell.OCCUPIED
    if door:
        cells[4:6, 6] = an.Cell.FREE
    cells[0, 13], cells[9, 0] = an.Cell.UNKNOWN, an.Cell.INFLATED
    return an.GridMap(cells, **{"name": "two rooms"} | place)


def plan(grid: an.GridMap, algorithm: an.Algorithm | None = None, goal=(8, 12)) -> Result:
    problem = an.Problem.from_cells(grid, (1, 1), goal)
    return an.solve(problem, algorithm or an.paco(ants=10, iterations=12), seed=1)


@pytest.fixture(scope="module")
def divided() -> Result:
    return plan(two_rooms(resolution=0.5, origin=(-2.0, 3.0, 0.0)))


@pytest.fixture(scope="module")
def undivided() -> Result:
    return plan(two_rooms(), an.npaco(ants=10, iterations=12))


@pytest.fixture(scope="module")
def unreachable() -> Result:
    return plan(two_rooms(door=False))


@pytest.fixture(scope="module")
def same_cell() -> Result:
    return plan(two_rooms(), goal=(1, 1))


@pytest.fixture(scope="module")
def nobody_arrived(undivided: Result) -> Result:
    none = np.full(3, INF)
    zero = np.zeros(3, np.int64)
    history = History(none, none, none * NAN, zero, zero + 10, zero + 50, none * NAN)
    return replace(undivided, status=Status.NO_ANT_ARRIVED, path=None, history=history)


@pytest.fixture(params=["divided", "undivided", "unreachable", "same_cell", "nobody_arrived"])
def any_result(request: pytest.FixtureRequest) -> Result:
    return request.getfixturevalue(request.param)


def line(ax, label: str):
    (found,) = [line for line in ax.lines if line.get_label() == label]
    return found


def texts(figure) -> str:
    return "\n".join(text.get_text() for text in figure.findobj(mpl.text.Text))


def with_history(result: Result, best, iteration_best, mean, stages) -> Result:
    count = np.zeros(len(best), np.int64)
    history = History(
        *(np.array(values, float) for values in (best, iteration_best, mean)), count, count, count, count * NAN
    )
    accounts = tuple(
        Stage(name, 0.1, tuple(ColonyReport((1, 1), (8, 12), n, None, 5, 0.1, 0.1) for n in iterations))
        for name, *iterations in stages
    )
    return replace(result, history=history, stages=accounts)


# ----------------------------------------------------------------------------------------------------------- data


def test_convergence_is_the_history(undivided):
    data = plot.convergence(undivided)
    assert data.iteration.tolist() == list(range(1, 13))
    for name in ("best", "iteration_best", "mean"):
        np.testing.assert_array_equal(getattr(data, name), getattr(undivided.history, name))
    assert (data.stage_one, data.divided, data.stages) == (0, False, [slice(0, 12)])
    assert (data.optimum, data.length) == (undivided.optimum, undivided.length)


def test_convergence_has_nan_before_the_first_arrival(undivided):
    result = with_history(undivided, [INF, INF, 20, 19], [INF, INF, 20, 19], [NAN, NAN, 25, 24], [("whole map", 4)])
    data = plot.convergence(result)
    np.testing.assert_array_equal(data.best, [NAN, NAN, 20, 19])
    np.testing.assert_array_equal(data.iteration_best, [NAN, NAN, 20, 19])
    np.testing.assert_array_equal(data.mean, [NAN, NAN, 25, 24])


def test_convergence_knows_the_stages(divided):
    data = plot.convergence(divided)
    assert (data.stage_one, data.divided) == (3, True)
    assert data.stages == [slice(0, 3), slice(3, 12)]


@pytest.mark.parametrize(
    ("stages", "stage_one", "divided_"),
    [
        ([("stage one", 3, 3), ("stage one", 4, 5), ("stage two", 1, 2)], 5, True),  # the first attempt left no history
        ([("stage one", 7, 7)], 7, False),  # ended after stage one
        ([("stage one", 3, 3), ("whole map", 7)], 0, False),  # fell back to one colony
        ([("whole map", 7)], 0, False),
    ],
)
def test_convergence_of_unusual_runs(undivided, stages, stage_one, divided_):
    data = plot.convergence(with_history(undivided, [20.0] * 7, [21.0] * 7, [22.0] * 7, stages))
    assert (data.stage_one, data.divided) == (stage_one, divided_)
    assert sum(part.stop - part.start for part in data.stages) == 7


def test_convergence_without_iterations(unreachable, same_cell):
    assert plot.convergence(unreachable).optimum == INF
    for result in (unreachable, same_cell):
        data = plot.convergence(result)
        assert data.stages == []
        assert data.best.size == 0


def test_heat_is_logarithmic_between_a_hundredth_and_the_most(undivided):
    field = np.full(undivided.problem.grid.shape, 0.001, np.float32)
    field[0, :4] = (10.0, 1.0, 0.1, 0.05)
    field[:, 6] = NAN
    heat = plot.heat(replace(undivided, pheromone=field))
    np.testing.assert_allclose(heat.shade[0, :4], (1, 0.5, 0, 0), atol=1e-6)
    assert heat.shade[1:].max() == 0
    assert heat.label == "pheromone, 0.1 to 10 (log)"


def test_heat_begins_at_the_median_where_that_is_more(undivided):
    field = np.full(undivided.problem.grid.shape, 1.0, np.float32)
    field[0, :3] = (4.0, 2.0, 0.5)
    np.testing.assert_allclose(plot.heat(replace(undivided, pheromone=field)).shade[0, :3], (1, 0.5, 0), atol=1e-6)


@pytest.mark.parametrize("value", [None, NAN, 1.0, 0.0])
def test_no_heat_where_pheromone_says_nothing(undivided, value):
    field = None if value is None else np.full(undivided.problem.grid.shape, value, np.float32)
    assert plot.heat(replace(undivided, pheromone=field)) is None


def test_heat_of_an_unreachable_goal_is_what_can_be_reached(unreachable):
    heat = plot.heat(unreachable)
    np.testing.assert_array_equal(heat.shade > 0, unreachable.problem.reachable)
    assert heat.even


def test_map_colours_tell_the_kinds_apart():
    grid = an.GridMap([[0, 1, 2, 3]])
    colours = plot.map_colours(grid)
    assert colours.shape == (1, 4, 3)
    np.testing.assert_array_equal(colours[0], plot.CELL_COLOURS)
    free, wall, unknown, inflated = colours[0] @ (0.299, 0.587, 0.114)
    assert free > unknown + 15 > inflated + 30 > wall + 100  # in grey print too


def test_map_colours_are_shaded_towards_blue():
    grid = an.GridMap([[0, 0, 0, 1]])
    shade = np.array([[0, 0.5, 1, 0]], np.float32)
    colours = plot.map_colours(grid, plot.Heat(shade, "")) / 255
    for cell, colour in zip(colours[0], ("white", plot.SKY, plot.BLUE), strict=False):
        np.testing.assert_allclose(cell, to_rgba(colour)[:3], atol=1e-6)


# -------------------------------------------------------------------------------------------------------- drawing


def test_plot_map_lies_where_the_map_lies():
    grid = two_rooms(resolution=0.5, origin=(-2.0, 3.0, 0.0))
    ax = plot.plot_map(grid)
    (image,) = ax.get_images()
    assert image.get_extent() == [-2.0, 5.0, 3.0, 8.0]
    assert (ax.get_xlim(), ax.get_ylim()) == ((-2.0, 5.0), (3.0, 8.0))
    np.testing.assert_array_equal(image.get_array(), plot.map_colours(grid))
    assert (ax.get_xlabel(), ax.get_ylabel(), ax.get_title()) == ("x (m)", "y (m)", "two rooms")
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["obstacle", "inflated", "unknown"]


def test_functions_draw_on_the_axes_that_they_are_given(divided):
    for draw in (plot.plot_path, plot.plot_convergence, plot.plot_result):
        figure, ax = plt.subplots()
        assert draw(divided, ax) is ax
        assert draw(divided, ax=ax).figure is figure
    ax = plt.figure().add_subplot()
    assert plot.plot_map(divided.problem.grid, ax) is ax


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


def test_a_turned_map_is_drawn_in_its_own_frame():
    grid = two_rooms(resolution=0.5, origin=(7.0, -3.0, 0.6))
    result = plan(grid)
    ax = plot.plot_path(result)
    cells = result.path.cells
    expected = np.stack(((cells[:, 1] + 0.5) * 0.5, (grid.rows - cells[:, 0] - 0.5) * 0.5), axis=-1)
    np.testing.assert_allclose(line(ax, "path").get_xydata(), expected, atol=1e-9)
    assert ax.get_images()[0].get_extent() == [0, 7, 0, 5]
    assert ax.get_xlabel() == "x (m) in the map's frame, turned by 34.38°"


def test_plot_path_of_an_exact_start_and_goal():
    result = an.solve(an.Problem(two_rooms(), (1.2, 8.9), (12.7, 1.1)), an.npaco(iterations=3), seed=0)
    drawn = line(plot.plot_path(result), "path").get_xydata()
    assert (tuple(drawn[0]), tuple(drawn[-1])) == ((1.2, 8.9), (12.7, 1.1))


def test_a_loaded_result_is_drawn_without_pheromone(divided, tmp_path):
    divided.save(tmp_path / "plan.json")
    ax = plot.plot_path(Result.load(tmp_path / "plan.json"))
    assert "pheromone" not in texts(ax.figure)
    np.testing.assert_array_equal(line(ax, "path").get_xydata(), divided.path.points)


def test_the_title_says_what_came_out(divided, undivided, unreachable, nobody_arrived):
    def title(result: Result) -> str:
        return plot.plot_path(result).get_title()

    metres = f"{divided.length:.4f} cells = {divided.length_m:.3f} m, gap {100 * divided.gap:.2f} %, found"
    assert title(divided) == f"paco on two rooms, seed 1\n{metres}"
    assert " m," not in title(undivided)  # resolution 1: metres are cells
    assert title(unreachable).endswith("\nunreachable: no path leads from start to goal")
    assert title(nobody_arrived).endswith("\nno ant arrived in 3 iterations")
    assert title(replace(divided, stopped_by=StoppedBy.CANCELLED)).endswith("found (stopped: cancelled)")


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


def test_certainty_and_notes_travel_with_the_picture(divided):
    noted = replace(divided, notes=("the sub-paths cross; the joined path has a loop",))
    for ax in (plot.plot_result(noted), plot.plot_path(noted)):
        shown = " ".join(texts(ax.figure).split())
        assert f"Certainty: {divided.algorithm.certainty}" in shown
        assert "Note: the sub-paths cross; the joined path has a loop" in shown


def stairs(ax):
    return [patch for patch in ax.patches if isinstance(patch, mpl.patches.StepPatch)]


def test_plot_convergence_shows_the_history(undivided):
    ax = plot.plot_convergence(undivided)
    data = plot.convergence(undivided)
    (best,) = stairs(ax)
    np.testing.assert_array_equal(best.get_data().values, data.best)
    np.testing.assert_array_equal(best.get_data().edges, np.arange(13) + 0.5)
    np.testing.assert_array_equal(line(ax, "best of the iteration").get_ydata(), data.iteration_best)
    (mean,) = [line for line in ax.lines if line.get_label().startswith("mean of the arrived ants")]
    np.testing.assert_array_equal(mean.get_ydata(), data.mean)
    assert set(line(ax, f"exact optimum: {data.optimum:.4f}").get_ydata()) == {data.optimum}
    returned = line(ax, f"path returned: {data.length:.4f}")
    assert (returned.get_xdata()[0], returned.get_ydata()[0]) == (12.5, data.length)
    assert "stage" not in texts(ax.figure)


def test_plot_convergence_marks_the_stages_and_joins_none(divided):
    ax = plot.plot_convergence(divided)
    first, second = stairs(ax)
    np.testing.assert_array_equal(first.get_data().values, divided.history.best[:3])
    np.testing.assert_array_equal(second.get_data().values, divided.history.best[3:])
    assert second.get_data().edges[0] == 3.5
    shown = texts(ax.figure)
    assert "stage one: better of two colonies" in shown
    assert "stage two: sum of the two halves" in shown


def test_all_best_lengths_fit_and_a_mean_that_does_not_is_stated(undivided):
    result = with_history(undivided, [30, 20, 20], [30, 20, 28], [500, 60, 22.5], [("whole map", 3)])
    ax = plot.plot_convergence(result)
    low, high = ax.get_ylim()
    assert low < undivided.optimum < 30 < high < 60
    assert "mean of the arrived ants (22.5 to 500.0)" in texts(ax.figure)


def test_the_right_scale_is_the_gap(undivided):
    ax = plot.plot_convergence(undivided)
    (gap,) = ax.child_axes
    ax.figure.canvas.draw()
    np.testing.assert_allclose(gap.get_ylim(), [100 * (end / undivided.optimum - 1) for end in ax.get_ylim()])


def test_without_an_optimum_there_is_no_gap(undivided):
    ax = plot.plot_convergence(replace(undivided, optimum=INF))
    ax.figure.canvas.draw()
    assert not ax.child_axes
    assert "exact optimum" not in texts(ax.figure)


def test_values_between_gaps_are_seen(undivided):
    result = with_history(undivided, [20] * 4, [20] * 4, [NAN, 22, NAN, NAN], [("whole map", 4)])
    ax = plot.plot_convergence(result)
    (mean,) = [line for line in ax.lines if line.get_label().startswith("mean of the arrived ants")]
    assert (mean.get_marker(), mean.get_markevery()) == (".", [1])


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("unreachable", "no path exists"),
        ("same_cell", "start and goal are one cell"),
        ("nobody_arrived", "no ant arrived"),
    ],
)
def test_an_empty_convergence_says_why(name, words, request):
    result = request.getfixturevalue(name)
    ax = plot.plot_convergence(result)
    assert words in texts(ax.figure)
    assert not stairs(ax) or name == "nobody_arrived"
    assert ax.get_legend() is None or "best so far" not in texts(ax.get_legend())


def test_halves_that_were_never_joined(undivided):
    stages = [("stage one", 1, 1), ("stage two", 2, 2)]
    result = with_history(undivided, [25, INF, INF], [25, INF, INF], [30, NAN, NAN], stages)
    ax = plot.plot_convergence(result)
    assert "stage two: sum of the two halves" in texts(ax.figure)
    assert "no ant arrived" not in texts(ax.figure)


def test_plot_result_has_both_panels(divided):
    ax = plot.plot_result(divided)
    assert len(ax.figure.axes) == 2
    assert ax is ax.figure.axes[0]
    np.testing.assert_array_equal(line(ax, "path").get_xydata(), divided.path.points)
    assert len(stairs(ax.figure.axes[1])) == 2
    assert ax.figure.get_suptitle().startswith("paco on two rooms, seed 1\n")


def test_plot_result_on_given_axes_leaves_the_figure_alone(divided):
    figure, (left, right) = plt.subplots(1, 2)
    assert an.plot_result(divided, ax=left) is left
    assert figure.axes == [left, right]
    assert not right.has_data()
    assert figure.get_suptitle() == figure.get_supxlabel() == ""


@pytest.mark.parametrize("shape", [(4, 60), (60, 4), (30, 30), (1, 1), (200, 300)])
@pytest.mark.parametrize("draw", ["plot_result", "plot_path", "plot_convergence"])
def test_nothing_is_cut_off_or_covered(shape, draw):
    grid = an.GridMap(np.zeros(shape, np.uint8), resolution=0.05, name="hall")
    goal = (shape[0] - 1, shape[1] - 1)
    result = an.solve(an.Problem.from_cells(grid, (0, 0), goal), an.paco(ants=3, iterations=5), seed=0)
    ax = getattr(plot, draw)(result)
    figure = ax.figure
    figure.canvas.draw()
    box, size = figure.get_tightbbox(), figure.get_size_inches()
    assert box.x0 >= 0
    assert box.y0 >= 0
    assert box.x1 <= size[0]
    assert box.y1 <= size[1]
    for panel in figure.axes:
        if panel.get_legend():
            assert panel.get_legend().get_window_extent().y1 < panel.get_window_extent().y0


def test_lines_between_cells_only_on_small_maps():
    assert len(plot.plot_map(an.GridMap(np.zeros((60, 50), bool))).collections) == 2
    assert not plot.plot_map(an.GridMap(np.zeros((60, 61), bool))).collections


def test_a_very_large_map_is_drawn_as_means_of_blocks(monkeypatch):
    monkeypatch.setattr(plot, "DRAWN_SIDE", 4)
    cells = np.zeros((3, 7), np.uint8)
    cells[0, 0] = cells[:, 6] = 1
    ax = plot.plot_map(an.GridMap(cells, resolution=0.5))
    (image,) = ax.get_images()
    assert image.get_array().shape == (2, 4, 3)
    assert image.get_extent() == [0, 4, -0.5, 1.5]  # the last blocks reach beyond the map
    assert (ax.get_xlim(), ax.get_ylim()) == ((0, 3.5), (0, 1.5))
    free, wall = plot.CELL_COLOURS[:2].astype(float)
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


# --------------------------------------------------------------------------------------------------------- files


def test_pictures_are_written_and_valid(any_result, tmp_path):
    for ending in ("png", "svg", "pdf", "PNG"):
        plot.save_picture(any_result, tmp_path / f"picture.{ending}")
    with Image.open(tmp_path / "picture.png") as image:
        image.load()
        assert image.format == "PNG"
        assert min(image.size) > 500
    root = ET.parse(tmp_path / "picture.svg").getroot()
    assert root.tag == "{http://www.w3.org/2000/svg}svg"
    pdf = (tmp_path / "picture.pdf").read_bytes()
    assert pdf.startswith(b"%PDF-")
    assert pdf.rstrip().endswith(b"%%EOF")
    assert {path.suffix for path in tmp_path.iterdir()} <= {".png", ".svg", ".pdf", ".PNG"}


@pytest.mark.parametrize("ending", ["svg", "pdf"])
def test_the_same_result_gives_the_same_bytes(divided, tmp_path, ending):
    plot.save_picture(divided, tmp_path / f"one.{ending}")
    with mpl.rc_context({"font.size": 20, "axes.facecolor": "black", "svg.hashsalt": "other"}):
        plot.save_picture(divided, tmp_path / f"two.{ending}")
        assert mpl.rcParams["font.size"] == 20  # the user's style is back
    one, two = ((tmp_path / f"{name}.{ending}").read_bytes() for name in ("one", "two"))
    assert one == two
    assert b"<dc:date>" not in one
    assert b"CreationDate" not in one


def test_pictures_can_be_written_by_many_threads(divided, undivided, tmp_path):
    before = dict(mpl.rcParams)
    results = [divided, undivided] * 3
    paths = [tmp_path / f"{number}.svg" for number in range(len(results))]
    with ThreadPoolExecutor(6) as pool:
        list(pool.map(plot.save_picture, results, paths))
    assert len({path.read_bytes() for path in paths}) == 2
    assert dict(mpl.rcParams) == before
    assert plt.get_fignums() == []


def test_save_picture_does_without_pyplot(divided, tmp_path):
    divided.save(tmp_path / "plan.json")
    code = (
        "import sys; from antnav.result import Result; from antnav.plot import save_picture\n"
        "assert 'matplotlib' not in sys.modules\n"
        f"save_picture(Result.load({str(tmp_path / 'plan.json')!r}), {str(tmp_path / 'plan.png')!r})\n"
        "assert 'matplotlib.pyplot' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
    assert (tmp_path / "plan.png").exists()


@pytest.mark.parametrize("name", ["picture.gif", "picture", "picture.svg.txt", ".png"])
def test_other_endings_are_refused(divided, tmp_path, name):
    with pytest.raises(ParameterError, match=r"pictures end in \.png, \.svg, \.pdf"):
        plot.save_picture(divided, tmp_path / name)
    assert not list(tmp_path.iterdir())


def test_an_unwritable_path_leaves_nothing(divided, tmp_path):
    with pytest.raises(OutputError):
        plot.save_picture(divided, tmp_path / "missing" / "picture.png")
    (tmp_path / "folder.png").mkdir()
    with pytest.raises(OutputError):
        plot.save_picture(divided, tmp_path / "folder.png")
    assert [path.name for path in tmp_path.rglob("*")] == ["folder.png"]


def test_a_failed_drawing_keeps_the_old_picture(divided, tmp_path, monkeypatch):
    def fail(*_):
        raise RuntimeError("no ink")

    target = tmp_path / "picture.png"
    target.write_bytes(b"old")
    monkeypatch.setattr(plot, "_draw_figure", fail)
    with pytest.raises(RuntimeError, match="no ink"):
        plot.save_picture(divided, target)
    assert target.read_bytes() == b"old"
    assert [path.name for path in tmp_path.iterdir()] == ["picture.png"]


@pytest.mark.parametrize("name", ["$a_{b", "line\nbreak", "bell\x07 -- \x00", "x" * 500, "lone \udcff surrogate"])
def test_any_name_can_be_printed(divided, tmp_path, name):
    grid = two_rooms(name=name)
    problem = an.Problem.from_cells(grid, (1, 1), (8, 12))
    result = replace(divided, problem=problem, algorithm=replace(divided.algorithm, name=name, certainty=name))
    plot.save_picture(result, tmp_path / "picture.svg")
    ET.parse(tmp_path / "picture.svg")
    plot.plot_map(grid).figure.canvas.draw()


@pytest.mark.parametrize("draw", ["plot_map", "plot_path", "plot_convergence", "plot_result", "save_picture"])
def test_without_matplotlib_the_error_names_the_extra(divided, tmp_path, monkeypatch, draw):
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    arguments = {"plot_map": [divided.problem.grid], "save_picture": [divided, tmp_path / "picture.png"]}
    with pytest.raises(ParameterError, match=r'pip install "antnav\[plot\]"'):
        getattr(plot, draw)(*arguments.get(draw, [divided]))
    assert not list(tmp_path.iterdir())


def test_the_map_is_one_image(divided):
    assert [type(image) for image in plot.plot_path(divided).get_images()] == [AxesImage]
