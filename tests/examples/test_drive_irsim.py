"""Trajectories are driven in a simulator that knows nothing of antnav: all arrive, none touches."""

import importlib.util
import sys
import warnings
from pathlib import Path

import pytest

import antnav as an

pytest.importorskip("irsim", reason='needs pip install "antnav[sim]"')


@pytest.fixture(scope="module")
def client():
    file = Path(__file__).parents[2] / "examples" / "drive_irsim.py"
    spec = importlib.util.spec_from_file_location("drive_irsim", file)
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # dataclasses look there
    spec.loader.exec_module(module)
    yield module
    del sys.modules[spec.name]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("file", "radius", "algorithm"),
    [
        ("ros/nav2_bringup/depot.yaml", 0.2, "paco"),
        ("ros/turtlebot3/map.yaml", 0.105, "astar"),
        ("paper_equivalent/equiv40.txt", 0.3, "npaco"),
    ],
)
def test_twenty_drives_arrive_and_none_touches_at_the_robots_own_radius(client, data, file, radius, algorithm):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", an.maps.MapWarning)
        walls = an.load_map(data / file)
    world = client.World(walls, radius)
    margin = 0.03
    for problem in client.queries(walls.inflated(radius + margin, strict=True), 20, seed=1):
        result = an.solve(problem, an.algorithm(algorithm), seed=1)
        outcome = world.drive(result.trajectory(radius=radius, margin=margin, max_curvature=4.0, spacing=0.02))
        assert outcome.arrived, (problem.start, problem.goal)
        assert not outcome.touched, (problem.start, problem.goal)


def test_the_simulator_sees_the_walls_a_robot_of_twice_the_radius_touches(client):
    walls = an.maps.builtin("equiv20")
    problem = an.Problem.from_cells(walls, *an.maps.builtin_query("equiv20"))
    trajectory = an.solve(problem, an.astar()).trajectory(radius=0.3, margin=0.05, spacing=0.02)
    assert client.World(walls, 0.3).drive(trajectory).arrived
    outcome = client.World(walls, 0.6).drive(trajectory)
    assert outcome.touched
    assert not outcome.arrived


def test_it_turns_on_the_spot_where_the_trajectory_does(client):
    walls = an.maps.builtin("equiv20")
    problem = an.Problem.from_cells(walls, *an.maps.builtin_query("equiv20"))
    trajectory = an.solve(problem, an.astar()).trajectory(
        radius=0.3, margin=0.05, spacing=0.02, max_curvature=0.01, start_heading=3.0
    )
    assert not trajectory.smooth
    outcome = client.World(walls, 0.3).drive(trajectory)
    assert outcome.arrived
    assert abs(outcome.track[0, 2] - 3.0) < 1e-9
