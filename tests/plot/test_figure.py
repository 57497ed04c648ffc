"""The whole picture, and its files: valid, reproducible, whole or not there."""

from __future__ import annotations

import subprocess
import sys
import xml.etree.ElementTree as ET
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from PIL import Image

import antnav as an
from antnav import plot
from antnav.errors import OutputError, ParameterError
from antnav.planner.result import Result
from tests.plot.samples import line, stairs

mpl = pytest.importorskip("matplotlib")
mpl.use("Agg")
from matplotlib import pyplot as plt  # noqa: E402


@pytest.fixture(params=["divided", "undivided", "unreachable", "same_cell", "nobody_arrived"])
def any_result(request: pytest.FixtureRequest) -> Result:
    return request.getfixturevalue(request.param)


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
        "import sys; from antnav.planner.result import Result; from antnav.plot import save_picture\n"
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
    def fail(*_, **__):
        raise RuntimeError("no ink")

    target = tmp_path / "picture.png"
    target.write_bytes(b"old")
    monkeypatch.setattr("antnav.plot.figure._draw_figure", fail)
    with pytest.raises(RuntimeError, match="no ink"):
        plot.save_picture(divided, target)
    assert target.read_bytes() == b"old"
    assert [path.name for path in tmp_path.iterdir()] == ["picture.png"]


def test_the_map_alone(divided, tmp_path):
    ax = plot.plot_result(divided, panels="map")
    assert ax.figure.axes == [ax]
    np.testing.assert_array_equal(line(ax, "path").get_xydata(), divided.path.points)
    both, alone = tmp_path / "both.png", tmp_path / "alone.png"
    plot.save_picture(divided, both)
    plot.save_picture(divided, alone, panels="map")
    assert Image.open(alone).width < Image.open(both).width
    with pytest.raises(ParameterError, match="there are both, map"):
        plot.save_picture(divided, alone, panels="left")
