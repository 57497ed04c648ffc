"""Files of trajectories: what is written comes back, or is what others read."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import yaml

import antnav as an
from antnav.errors import ParameterError, ResultFormatError

GRID = an.GridMap(np.zeros((40, 60), bool), 0.1, (3.0, -2.0, 0.3))
PROBLEM = an.Problem.from_cells(GRID, (20, 5), (8, 50))
RESULT = an.solve(PROBLEM, an.astar())
FAST = RESULT.trajectory(radius=0.2, margin=0.05, max_speed=0.5, max_acceleration=0.4, start_heading=1.0)
CORNERS = RESULT.trajectory(radius=0.2, start_heading=3.0, max_curvature=1e-3)


@pytest.mark.parametrize("drive", [FAST, CORNERS], ids=["with speeds", "with corners"])
@pytest.mark.parametrize("name", ["drive.json", "drive.csv"])
def test_it_is_read_again(drive: an.Trajectory, tmp_path: Path, name: str) -> None:
    drive.save(tmp_path / name)
    found = an.Trajectory.load(tmp_path / name, GRID)
    for field in ("poses", "curvature", "speeds", "times"):
        one, other = getattr(drive, field), getattr(found, field)
        assert (one is None) == (other is None)
        if one is not None:
            np.testing.assert_array_equal(one, other)
    assert found.smooth == drive.smooth
    if name == "drive.json":
        assert (found.radius, found.margin, found.note) == (drive.radius, drive.margin, drive.note)
    assert an.check_trajectory(found, PROBLEM, 0.2) == pytest.approx(drive.length, rel=1e-3)


@pytest.mark.parametrize(
    ("name", "content", "wrong"),
    [
        ("a.json", b"", "must be a trajectory"),
        ("a.json", b'{"schema": "antnav/result", "poses": [], "curvature": []}', "schema is 'antnav/result'"),
        ("a.json", b'{"schema": "antnav/trajectory", "poses": [], "curvature": []}', "no poses"),
        ("a.json", b'{"schema": "antnav/trajectory", "poses": [[0,0,0]], "curvature": []}', "1 poses and 0 curvature"),
        ("a.json", b'{"schema": "antnav/trajectory", "version": 2, "poses": [], "curvature": []}', "version 2"),
        (
            "a.json",
            b'{"schema": "antnav/trajectory", "radius": -5, "poses": [[0,0,0]], "curvature": [0]}',
            "radius is -5",
        ),
        ("a.csv", b"x,y,heading,curvature,speed\n1,2,3,0,1\n", "speeds without times"),
        ("a.csv", b"x,y,heading,curvature,speed,t\n1,2,3,0,1,2\n1,3,3,0,1,1\n", "times fall"),
        ("a.csv", b"x,y\n1,2\n", "no column heading"),
        ("a.csv", b"x,y,heading,curvature\n1,2,three,0\n", "three"),
        ("a.csv", b"x,y,heading,curvature\n1,2,nan,0\n", "no numbers"),
        ("a.csv", b"\xff\xfe", "must be a trajectory"),
        ("a.csv", b"x,y,heading,curvature\n1,2,3,0,5\n", "more values than the first"),
        ("a.csv", b"x,y,heading,curvature\n1,2,3," + b"0" * 200_000, "field limit"),
        ("a.csv", b"x,y,heading,curvature\n1,2,3,nan\n", "curvature that is no number"),
        ("a.csv", b"x,y,heading,curvature,speed,t\n1,2,3,0,inf,0\n", "speeds or times that are no numbers"),
    ],
)
def test_other_files_are_refused(tmp_path: Path, name: str, content: bytes, wrong: str) -> None:
    (tmp_path / name).write_bytes(content)
    with pytest.raises(ResultFormatError, match=wrong):
        an.Trajectory.load(tmp_path / name, GRID)


def test_missing_files_and_other_endings_are_refused(tmp_path: Path) -> None:
    with pytest.raises(ResultFormatError, match="cannot read"):
        an.Trajectory.load(tmp_path / "missing.csv", GRID)
    for name in ("drive.yaml", "drive.mcap"):
        with pytest.raises(ParameterError, match="are read from"):
            an.Trajectory.load(tmp_path / name, GRID)
    for name in ("drive", "drive.exe"):
        with pytest.raises(ParameterError, match="trajectories end in"):
            FAST.save(tmp_path / name)


def test_geojson_is_a_line_in_metres(tmp_path: Path) -> None:
    FAST.save(tmp_path / "drive.geojson")
    (feature,) = json.loads((tmp_path / "drive.geojson").read_text())["features"]
    assert feature["geometry"]["type"] == "LineString"
    assert feature["geometry"]["coordinates"] == FAST.points.tolist()
    properties = feature["properties"]
    assert (properties["unit"], properties["frame"], properties["radius"]) == ("m", "map", 0.2)
    np.testing.assert_allclose(np.radians(properties["headings_degrees"]), FAST.poses[:, 2], atol=1e-9)


def test_yaml_has_a_row_a_pose(tmp_path: Path) -> None:
    FAST.save(tmp_path / "drive.yaml")
    found = yaml.safe_load((tmp_path / "drive.yaml").read_text())
    assert found["length_m"] == FAST.length
    assert [row["t"] for row in found["poses"]] == FAST.times.tolist()
    assert list(found["poses"][0]) == ["s", "x", "y", "heading", "curvature", "speed", "t"]


@pytest.mark.parametrize(("frame", "stamp"), [(3, 0.0), ("map", -1.0), ("map", float("nan")), ("map", 2.0**31)])
def test_frames_and_stamps_that_cannot_be(tmp_path: Path, frame: str, stamp: float) -> None:
    with pytest.raises(ParameterError, match=r"frame|stamp"):
        FAST.save(tmp_path / "drive.ros2.yaml", frame=frame, stamp=stamp)
    assert not list(tmp_path.iterdir())


def test_paths_of_cells_for_other_programs(tmp_path: Path) -> None:
    RESULT.save(tmp_path / "plan.geojson", frame="hall")
    (feature,) = json.loads((tmp_path / "plan.geojson").read_text())["features"]
    assert feature["geometry"]["coordinates"] == RESULT.path.points.tolist()
    properties = feature["properties"]
    assert (properties["algorithm"], properties["gap"], properties["frame"]) == ("astar", 0.0, "hall")
    RESULT.save(tmp_path / "plan.ros2.yaml", stamp=2)
    found = yaml.safe_load((tmp_path / "plan.ros2.yaml").read_text())
    assert len(found["poses"]) == len(RESULT.path.points)
    assert {each["header"]["stamp"]["sec"] for each in found["poses"]} == {2}
    turns = [each["pose"]["orientation"] for each in found["poses"]]
    headings = [2 * np.arctan2(turn["z"], turn["w"]) for turn in turns]
    np.testing.assert_allclose(np.exp(1j * np.array(headings)), np.exp(1j * RESULT.path.headings), atol=1e-12)
    with pytest.raises(ParameterError, match="stamp"):
        RESULT.save(tmp_path / "late.geojson", stamp=-1)


def test_a_result_without_a_path_has_no_line(tmp_path: Path) -> None:
    walled = an.Problem.from_cells(an.GridMap(np.array([[0, 1, 0]], np.uint8)), (0, 0), (0, 2))
    none = an.solve(walled, an.astar())
    none.save(tmp_path / "none.geojson")
    (feature,) = json.loads((tmp_path / "none.geojson").read_text())["features"]
    assert feature["geometry"] is None
    assert (feature["properties"]["status"], feature["properties"]["length_m"]) == ("unreachable", None)
    none.save(tmp_path / "none.ros2.yaml")
    assert yaml.safe_load((tmp_path / "none.ros2.yaml").read_text())["poses"] == []


@pytest.mark.parametrize("name", ["drive.yaml", "drive.ros2.yaml", "drive.geojson", "drive.mcap"])
def test_frames_and_stamps_are_refused_that_messages_cannot_hold(tmp_path: Path, name: str) -> None:
    for odd in ("\ud800", "a\0b", "a\nb"):
        with pytest.raises(ParameterError, match="name of a frame"):
            FAST.save(tmp_path / name, frame=odd)
    assert FAST.duration is not None
    with pytest.raises(ParameterError, match=r"all ends below 2\*\*31"):
        FAST.save(tmp_path / name, stamp=2.0**31 - FAST.duration / 2)
    assert not list(tmp_path.iterdir())


def test_a_byte_order_mark_is_passed_over(tmp_path: Path) -> None:
    FAST.save(tmp_path / "drive.csv")
    (tmp_path / "drive.csv").write_bytes(b"\xef\xbb\xbf" + (tmp_path / "drive.csv").read_bytes())
    assert len(an.Trajectory.load(tmp_path / "drive.csv", GRID)) == len(FAST)
