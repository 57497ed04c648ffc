"""Maps from bags, trajectories into bags, on the command line."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import antnav as an
from tests.cli.conftest import Run

pytest.importorskip("rosbags", reason='needs pip install "antnav[ros]"')
from rosbags.highlevel import AnyReader


def topics_of(path: Path) -> set[str]:
    with AnyReader([path]) as reader:
        return set(reader.topics)


def test_the_command_line_reads_and_writes_bags(cli: Run, tmp_path: Path) -> None:
    an.save_map(an.GridMap(np.eye(20, dtype=bool)[::-1] & (np.arange(20) < 15)), tmp_path / "hall.mcap")
    ends = ("--cells", "--start", "1,1", "--goal", "18,18", "--algorithm", "astar", "--corner-rule", "allow")
    code, _, err = cli("plan", "hall.mcap:/map", *ends, "--trajectory", "drive.rosbag2")
    assert (code, err) == (0, "")
    assert topics_of(tmp_path / "drive.rosbag2") == {"/map", "/plan"}
    code, _, err = cli("maps", "convert", "drive.rosbag2", "back.mcap")
    assert (code, err) == (0, "")
    assert an.load_map(tmp_path / "back.mcap").shape == (20, 20)
    code, _, err = cli("plan", "back.mcap", *ends, "-o", "plan.mcap", "-o", "plan.geojson", "-o", "plan.ros2.yaml")
    assert (code, err) == (0, "")
    assert topics_of(tmp_path / "plan.mcap") == {"/map", "/plan"}
    assert {"plan.geojson", "plan.ros2.yaml"} <= {file.name for file in tmp_path.iterdir()}
    code, _, err = cli("plan", "back.mcap", *ends, "-o", "plan.yaml")
    assert code == 2
    assert ".ros2.yaml" in err
    code, _, err = cli("plan", "hall.mcap:/plan", *ends)
    assert code == 2
    assert "topic /plan in hall.mcap: a map is a message nav_msgs/OccupancyGrid" in err
