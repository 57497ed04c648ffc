"""`python -m antnav.ros.planner_server` where there is no ROS."""

from importlib.util import find_spec

import pytest

from antnav.ros import planner_server


@pytest.mark.skipif(find_spec("rclpy") is not None, reason="ROS 2 is here")
def test_without_ros_there_is_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    assert planner_server.main() == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("antnav: error: the planner server needs ROS 2 (No module named 'rclpy')")
    assert err.count("\n") == 1
