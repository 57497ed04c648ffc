"""`antnav plan --trajectory`: the table, JSON, files, what is refused."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from tests.cli.conftest import Run

MAP = "\n".join(["0" * 20] * 8 + ["0" * 10 + "1" * 10] * 8) + "\n"
QUERY = ("--cells", "--start", "12,2", "--goal", "3,17", "--resolution", "0.1", "--algorithm", "astar")


@pytest.fixture
def corner(tmp_path: Path) -> str:
    path = tmp_path / "corner.txt"
    path.write_text(MAP)
    return str(path)


def test_it_is_saved_and_told(cli: Run, corner: str, tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    drive, picture = tmp_path / "drive.csv", tmp_path / "plan.svg"
    options = ("--robot-radius", "0.2", "--margin", "0.05", "--max-curvature", "3", "--spacing", "0.02")
    headings = ("--start-heading", "1.57", "--goal-heading", "0")
    code, out, err = cli("plan", corner, *QUERY, *options, *headings, "--trajectory", str(drive), "-o", str(picture))
    assert (code, err) == (0, "")
    told = next(line for line in out.splitlines() if line.startswith("trajectory"))
    assert "curvature up to 3 / m, 0.25" in told
    table = np.genfromtxt(drive, delimiter=",", names=True)
    assert table["heading"][0] == 1.57
    assert np.diff(table["s"]).max() <= 0.02 + 1e-9
    assert picture.read_text().count("trajectory") > 0


def test_json(cli: Run, corner: str, tmp_path: Path) -> None:
    drive = tmp_path / "drive.json"
    code, out, _ = cli("plan", corner, *QUERY, "--robot-radius", "0.2", "--trajectory", str(drive), "--json")
    assert code == 0
    assert json.loads(out)["trajectory"] == json.loads(drive.read_bytes())


def test_speeds(cli: Run, corner: str, tmp_path: Path) -> None:
    drive = tmp_path / "drive.csv"
    limits = ("--max-speed", "0.5", "--max-acceleration", "0.5", "--max-angular-speed", "1")
    code, out, err = cli(
        "plan", corner, *QUERY, "--robot-radius", "0.2", "--max-curvature", "3", *limits, "--trajectory", str(drive)
    )
    assert (code, err) == (0, "")
    table = np.genfromtxt(drive, delimiter=",", names=True)
    assert f" in {table['t'][-1]:.1f} s, curvature" in out
    assert table["speed"].max() <= 0.5


def test_a_footprint(cli: Run, corner: str, tmp_path: Path) -> None:
    drive = tmp_path / "drive.json"
    given = ("--footprint", "[[0.25, 0.1], [0.25, -0.1], [-0.15, -0.1], [-0.15, 0.1]]", "--footprint-padding", "0.01")
    code, out, err = cli("plan", corner, *QUERY, *given, "--max-curvature", "3", "--trajectory", str(drive), "--json")
    assert (code, err) == (0, "")
    told = json.loads(out)
    assert told["robot_radius"] == pytest.approx(0.11)
    assert told["trajectory"]["smooth"]
    assert sorted(told["trajectory"]["footprint"])[-1] == pytest.approx([0.26, 0.11])


def test_it_is_no_output_as_well(cli: Run, corner: str, tmp_path: Path) -> None:
    drive = str(tmp_path / "drive.csv")
    code, out, err = cli("plan", corner, *QUERY, "--trajectory", drive, "-o", drive)
    assert (code, out) == (2, "")
    assert "it is an --output, too" in err
    assert not (tmp_path / "drive.csv").exists()


def test_no_path_no_trajectory(cli: Run, corner: str, tmp_path: Path) -> None:
    drive = tmp_path / "drive.json"
    Path(corner).write_text("010\n010\n010\n")
    code, _, _ = cli("plan", corner, "--cells", "--start", "0,0", "--goal", "0,2", "--trajectory", str(drive))
    assert code == 1
    assert not drive.exists()


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--margin", "0.1"), "they are of --trajectory"),
        (("--trajectory", "drive.csv", "--max-acceleration", "1"), "they need --max-speed"),
        (("--trajectory", "drive.csv", "--max-speed", "0"), "--max-speed 0.0: it is a finite number, >= 1e-06"),
        (("--footprint", "[[1,1],[-1,1],[0,-1]]"), "it is of --trajectory"),
        (("--footprint-padding", "0.1", "--trajectory", "drive.csv"), "it is of --footprint"),
        (("--footprint", "[[1,1],[1", "--trajectory", "drive.csv"), "it is a list of corners in metres"),
        (("--footprint", "[[1,1],[2,1],[1,2]]", "--trajectory", "drive.csv"), "lies inside of its footprint"),
        (("--footprint", "[]", "--robot-radius", "1", "--trajectory", "drive.csv"), "a disc or a polygon"),
        (("--trajectory", "drive.txt"), "trajectories end in .csv, .json, .geojson"),
        (("--trajectory", "drive.csv", "--alternatives", "2"), "a trajectory follows one path"),
        (("--trajectory", "drive.csv", "--spacing", "0"), "--spacing 0.0: it is a finite number, >= 0.0001"),
        (("--trajectory", "drive.csv", "--goal-heading", "nan"), "--goal-heading nan: it is a finite number"),
        (("--trajectory", "drive.csv", "--margin", "0.4"), "nearer to an obstacle than the robot's radius"),
    ],
)
def test_what_is_refused(cli: Run, corner: str, options: tuple[str, ...], said: str) -> None:
    code, out, err = cli("plan", corner, *QUERY[:2], "8,7", *QUERY[3:], *options)
    assert (code, out) == (2, "")
    assert said in err


def test_a_picture_of_the_map_alone(cli: Run, corner: str, tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    picture = tmp_path / "plan.svg"
    code, _, err = cli("plan", corner, *QUERY, "-o", str(picture), "--picture", "map")
    assert (code, err) == (0, "")
    assert "iteration" not in picture.read_text()


def test_what_helps_where_margin_or_footprint_close_the_way(cli: Run, tmp_path: Path) -> None:
    rows = [["0"] * 30 for _ in range(15)]
    for row in (*range(5), *range(10, 15)):
        rows[row][15] = "1"  # a door, half a metre wide
    tmp_path.joinpath("door.txt").write_text("\n".join("".join(row) for row in rows) + "\n")
    asked = ("plan", "door.txt", "--cells", "--start", "7,3", "--goal", "7,26", "--resolution", "0.1", *QUERY[-2:])
    code, out, _ = cli(*asked, "--robot-radius", "0.15", "--margin", "0.2", "--trajectory", "drive.csv")
    assert code == 1
    assert "for a robot of radius 0.15 m with a margin of 0.2 m" in out
    assert "a way opens with --margin 0.1" in out
    assert "--robot-radius 0" in out
    square = "[[0.3, 0.3], [0.3, -0.3], [-0.3, -0.3], [-0.3, 0.3]]"
    code, out, _ = cli(*asked, "--footprint", square, "--trajectory", "drive.csv")
    assert code == 1
    assert "of inscribed radius 0.3 m" in out
    assert "--robot-radius" not in out
