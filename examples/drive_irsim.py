"""Drive planned trajectories in the simulator ir-sim, and count arrivals and touches.

    pip install "antnav[sim]"
    python examples/drive_irsim.py MAP.yaml --trajectory drive.csv --radius 0.2
    python examples/drive_irsim.py MAP.yaml --queries 20 --radius 0.2 --margin 0.05

The first drives a saved trajectory, the second those of some random queries. A robot with two driven wheels, as large
as the radius that antnav was told, follows by pure pursuit (Coulter 1992). Whether it touches a wall is for ir-sim to
say, which knows nothing of antnav.
"""

from __future__ import annotations

import argparse
import contextlib
import io
import math
import sys
import tempfile
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import yaml
from PIL import Image

import antnav as an

STEP = 0.05  #: Seconds of a step of the simulation.
SPEED = 0.4  #: m/s, at most.
SPIN = 1.5  #: rad/s, at most.
BRAKE = 0.5  #: m/s^2, towards a place where the robot turns or stops.
CLOSE = 0.01  #: Metres or radians at which a place or a heading is reached.


@dataclass(frozen=True)
class Outcome:
    """What came of a drive."""

    arrived: bool
    touched: bool
    seconds: float
    off: float  #: Metres from the trajectory, at most.
    track: np.ndarray  #: Poses that the robot took, shape (k, 3).


class World:
    """A map as a world of ir-sim, with one robot in it."""

    def __init__(self, grid: an.GridMap, radius: float, *, watch: bool = False) -> None:
        with contextlib.redirect_stdout(sys.stdout if watch else io.StringIO()):  # it tries all window systems
            try:
                import irsim
            except ImportError as error:
                raise SystemExit('error: the simulator is missing; run: pip install "antnav[sim]"') from error

        if grid.origin[2]:
            raise SystemExit("error: ir-sim has no turned maps, and the origin of this one has a yaw")
        with tempfile.TemporaryDirectory() as folder:
            picture, world = Path(folder, "map.png"), Path(folder, "world.yaml")
            Image.fromarray(np.where(grid.cells == an.Cell.OCCUPIED, 0, 255).astype(np.uint8)).save(picture)
            setting = {
                "width": grid.cols * grid.resolution,
                "height": grid.rows * grid.resolution,
                "offset": list(grid.origin[:2]),
                "step_time": STEP,
                "collision_mode": "stop",
                "obstacle_map": str(picture),
            }
            robot = {
                "kinematics": {"name": "diff"},
                "shape": {"name": "circle", "radius": radius},
                "state": [*map(float, grid.cell_to_world(np.argwhere(grid.passable())[0])), 0.0],
                "vel_min": [-SPEED, -SPIN],
                "vel_max": [SPEED, SPIN],
                "goal_threshold": 0.0,
            }
            world.write_text(yaml.safe_dump({"world": setting, "robot": [robot]}))
            self.env = irsim.make(str(world), display=watch, headless=not watch, log_level="ERROR")
        self.robot = self.env.robot
        self.watch = watch

    def drive(self, trajectory: an.Trajectory) -> Outcome:
        """Follow a trajectory until its end, a touch, or three times the time that it should take."""
        self.robot.set_state([[value] for value in trajectory.poses[0]], init=True)
        self.env.reset()
        track = [self._pose()]
        off = 0.0
        patience = 10.0 + 3 * (trajectory.length / SPEED + 4 * len(list(stretches(trajectory))))
        for poses in stretches(trajectory):
            follower = Follower(poses)
            while (command := follower.command(track[-1])) is not None:
                self.env.step(np.array(command).reshape(2, 1))
                if self.watch:
                    self.env.render(STEP)
                track.append(self._pose())
                off = max(off, follower.off(track[-1]))
                if self.robot.collision or len(track) * STEP > patience:
                    return Outcome(False, bool(self.robot.collision), len(track) * STEP, off, np.array(track))
        arrived = math.dist(track[-1][:2], trajectory.poses[-1, :2]) < 5 * CLOSE
        return Outcome(arrived, False, len(track) * STEP, off, np.array(track))

    def _pose(self) -> np.ndarray:
        return np.asarray(self.robot.state, np.float64)[:3, 0].copy()


def stretches(trajectory: an.Trajectory) -> Iterator[np.ndarray]:
    """The poses between places where the robot turns on the spot."""
    jumps = np.flatnonzero((np.diff(trajectory.points, axis=0) == 0).all(axis=1)) + 1
    yield from np.split(trajectory.poses, jumps)


class Follower:
    """Pure pursuit along poses without a jump: steer on the circle through a point ahead."""

    AHEAD = 0.15  #: Metres from the nearest point of the curve to the point ahead.

    def __init__(self, poses: np.ndarray) -> None:
        self.poses = poses
        self.s = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(poses[:, :2], axis=0).T))))
        self.at = 0.0  # so far along the curve

    def command(self, pose: np.ndarray) -> tuple[float, float] | None:
        """Speed and rate of turn; None at the end."""
        x, y, heading = pose
        self.at = self._nearest(x, y)
        left = self.s[-1] - self.at
        if left < CLOSE:
            error = math.remainder(self.poses[-1, 2] - heading, math.tau)
            return None if abs(error) < CLOSE else (0.0, _within(5 * error, SPIN))
        if self.at == 0 and abs(error := math.remainder(self.poses[0, 2] - heading, math.tau)) > 5 * CLOSE:
            return 0.0, _within(5 * error, SPIN)
        ahead = self._point(self.at + self.AHEAD)
        towards = math.remainder(math.atan2(ahead[1] - y, ahead[0] - x) - heading, math.tau)
        bend = 2 * math.sin(towards) / max(math.hypot(ahead[0] - x, ahead[1] - y), CLOSE)
        speed = min(SPEED, math.sqrt(2 * BRAKE * left), SPIN / max(abs(bend), 1e-9))
        return speed, _within(bend * speed, SPIN)

    def off(self, pose: np.ndarray) -> float:
        """Metres from the curve."""
        return math.dist(pose[:2], self._point(self._nearest(pose[0], pose[1])))

    def _nearest(self, x: float, y: float) -> float:
        """Where on the curve, not before where it was, the nearest point lies."""
        places = np.linspace(self.at, min(self.at + 0.2, self.s[-1]), 81)
        points = np.column_stack([np.interp(places, self.s, self.poses[:, axis]) for axis in (0, 1)])
        return float(places[np.argmin(np.hypot(points[:, 0] - x, points[:, 1] - y))])

    def _point(self, s: float) -> tuple[float, float]:
        """A point of the curve, or behind it straight on."""
        x, y = (float(np.interp(s, self.s, self.poses[:, axis])) for axis in (0, 1))
        beyond = max(s - self.s[-1], 0.0)
        return x + beyond * math.cos(self.poses[-1, 2]), y + beyond * math.sin(self.poses[-1, 2])


def _within(value: float, limit: float) -> float:
    return max(-limit, min(value, limit))


def queries(grid: an.GridMap, count: int, seed: int) -> Iterator[an.Problem]:
    """Random queries with a way, at least a tenth of the map's longer side long."""
    cells = np.argwhere(grid.passable())
    generator = np.random.default_rng(seed)
    while count:
        start, goal = cells[generator.integers(len(cells), size=2)]
        if np.hypot(*(start - goal)) >= max(grid.shape) / 10:
            problem = an.Problem.from_cells(grid, start, goal)
            if np.isfinite(an.exact.optimum(problem).cost):
                count -= 1
                yield problem


def main() -> int:
    """Drive a saved trajectory, or some random queries of a map."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("map", help="a map file, or the name of a built-in map")
    parser.add_argument("--trajectory", metavar="FILE", help="a saved one, .csv or .json, instead of random queries")
    parser.add_argument("--queries", type=int, default=20)
    parser.add_argument("--radius", type=float, default=0.2, help="of the robot and for antnav, in metres")
    parser.add_argument("--margin", type=float, default=0.05, help="for what the follower strays, in metres")
    parser.add_argument("--max-curvature", type=float, default=2.0)
    parser.add_argument("--algorithm", default="paco")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--watch", action="store_true", help="in a window")
    given = parser.parse_args()
    warnings.simplefilter("ignore", an.maps.MapWarning)
    try:
        walls = an.load_map(given.map) if Path(given.map).exists() else an.maps.builtin(given.map)
        world = World(walls, given.radius, watch=given.watch)
        outcomes = [told(world, number + 1, drive) for number, drive in enumerate(drives(walls, given))]
    except an.AntnavError as error:
        parser.exit(2, f"error: {error}\n")
    except KeyboardInterrupt:
        parser.exit(130, "interrupted\n")
    arrived, touched = (sum(getattr(outcome, what) for outcome in outcomes) for what in ("arrived", "touched"))
    print(f"{len(outcomes)} drives: {arrived} arrived, {touched} touched")
    return 0 if arrived == len(outcomes) else 1


def drives(walls: an.GridMap, given: argparse.Namespace) -> Iterator[an.Trajectory]:
    """The trajectories to drive."""
    if given.trajectory:
        yield an.Trajectory.load(given.trajectory, walls)
        return
    grid = walls.inflated(given.radius + given.margin, strict=True)
    for problem in queries(grid, given.queries, given.seed):
        yield an.solve(problem, an.algorithm(given.algorithm), seed=given.seed).trajectory(
            radius=given.radius, margin=given.margin, max_curvature=given.max_curvature, spacing=0.02
        )


def told(world: World, number: int, trajectory: an.Trajectory) -> Outcome:
    """Drive, and print what came of it."""
    outcome = world.drive(trajectory)
    word = "touched" if outcome.touched else "arrived" if outcome.arrived else "did not arrive"
    corners = "" if trajectory.smooth else ", with corners"
    print(
        f"{number:3d}  {word}  {trajectory.length:6.2f} m in {outcome.seconds:5.1f} s, "
        f"at most {100 * outcome.off:.1f} cm off the curve{corners}"
    )
    return outcome


if __name__ == "__main__":
    sys.exit(main())
