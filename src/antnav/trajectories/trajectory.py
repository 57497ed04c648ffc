"""The wiring: a path's cells, a taut line, a curve of bounded curvature, the check."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from antnav.errors import AntnavError, ParameterError, PathError, check_type, shown
from antnav.kernels import lattice_kernels, trajectory_kernels
from antnav.kernels.trajectory_kernels import Ground
from antnav.search import exact
from antnav.trajectories import pieces as curves
from antnav.trajectories.belt import rounded
from antnav.trajectories.check import check_trajectory
from antnav.trajectories.dubins import dubins
from antnav.trajectories.footprint import Footprint
from antnav.trajectories.ground import ground_of, to_plane, to_world, turned
from antnav.trajectories.model import Trajectory
from antnav.trajectories.pieces import Pieces, Pose
from antnav.trajectories.speeds import Limits, driven
from antnav.values import finite_number
from antnav.world.grid import GridMap
from antnav.world.moves import CornerRule
from antnav.world.path import Path
from antnav.world.problem import Problem, check_problem

_SLACK = 0.02  #: Cells that the taut line keeps beyond the need, so that chords of arcs find room.
_LOOSER = (0.15, 0.4, 0.8)  #: Shares of the least turning radius that it keeps besides, one after the other.
_LONGER = 1.03  #: Times the taut line, up to which a curve is taken before other arcs are tried.
_SHARPEST = 0.25  #: Radius in cells of the smallest arc where no limit is given.
_WIDER = (0.4, 1.0)  #: Shares of what a footprint is wider than its inscribed disc, kept besides.
_ALL_ROUND = [math.tau * k / 360 for k in range(360)]
_JOINS = 0.35 * 1.3 ** np.arange(14)  #: Where a turn from a heading joins the curve, in turning radii.
_BEGINS = (0.4, 0.8, 1.2, 1.6, 2.4)  #: Lengths, in turning radii, of what may come before such a turn.
_SEARCHED = 2.0  #: Radius in cells of arcs that are searched, at least.
_LIMITS = (2_000, 50_000)  #: Poses that a search looks at.
_LIMITS_BODY = (2_000, 5_000)  #: The same with a footprint, whose tests take longer.
_ABOUT = np.array((0.0, 0.0, math.pi))
_Headings = tuple[float | None, float | None]
MAX_POSES = 10_000_000


def prepare() -> None:
    """Compile or load the kernels that trajectories need: by a way around a corner, without and with a footprint."""
    cells = np.zeros((12, 12), np.uint8)
    cells[:8, 6] = 1
    problem = Problem.from_cells(GridMap(cells), (1, 1), (1, 10))
    path = exact.optimum(problem).path
    assert path is not None
    for body in (None, Footprint.disc(0.4)):
        ends = {"start_heading": 0.0, "goal_heading": 1.0}
        trajectory(path, problem, footprint=body, margin=0.05, max_curvature=1.0, max_speed=1.0, **ends)


def trajectory(
    path: Path,
    problem: Problem,
    *,
    spacing: float = 0.05,
    radius: float | None = None,
    margin: float = 0.0,
    start_heading: float | None = None,
    goal_heading: float | None = None,
    max_curvature: float | None = None,
    footprint: Footprint | str | Sequence[Sequence[float]] | None = None,
    footprint_padding: float = 0.0,
    max_speed: float | None = None,
    max_acceleration: float | None = None,
    max_lateral_acceleration: float | None = None,
    max_angular_speed: float | None = None,
) -> Trajectory:
    """A curve that a robot can drive along a path: short, without corners, clear of walls, and checked.

    Parameters
    ----------
    path : Path
        A path of the problem.
    problem : Problem
    spacing : float
        Metres from pose to pose, at most.
    radius : float, optional
        The robot's, in metres, measured to the edges of occupied cells; cells that the map's inflation closed are then
        open again. Default: the curve keeps to cells that the problem lets the robot enter.
    margin : float
        Metres to keep beyond the radius, from the edges of occupied cells.
    start_heading, goal_heading : float, optional
        In radians, counter-clockwise from the x axis; default: along the curve.
    max_curvature : float, optional
        Limit in 1/m, one over the robot's turning radius; default: none, but the curve is as round as there is room.
    footprint : Footprint, str, or sequence of (x, y), optional
        The outline of a robot that is no disc, instead of `radius`: metres in its frame, x ahead, y to the left; nav2's
        text, too. It turns with the poses, and keeps the margin.
    footprint_padding : float
        As nav2's: metres added to ``|x|`` and ``|y|`` of each corner.
    max_speed, max_acceleration, max_lateral_acceleration, max_angular_speed : float, optional
        m/s, m/s^2 along the curve and across it, rad/s: with max_speed the trajectory has `speeds` and `times`, as fast
        as these limits allow, from rest to rest. Without max_acceleration speeds change at once, without
        max_angular_speed turns on the spot take no time.

    Returns
    -------
    Trajectory
        With `smooth` False and a note, where no curve within these limits was found: the shortened line, on whose
        corners the robot turns on the spot.

    Raises
    ------
    ParameterError
        A number out of its range; the start or the goal is nearer to a wall than radius and margin, or no path keeps
        them.

    Notes
    -----
    The path is pulled taut with a test of the moved disc against the squares of occupied cells, which is exact; each
    corner becomes an arc, between tangents, and where that would touch it is moved out or made smaller. Headings are
    joined by Dubins' curves. What is returned has passed `check_trajectory`.
    """
    check_type("path", path, Path, "take the path of a result")
    check_problem(problem)
    if not len(path) or (path.start or problem.start, path.goal or problem.goal) != (problem.start, problem.goal):
        raise ParameterError("path", "it leads from the problem's start to its goal", "take the path of its result")
    spacing = _within("spacing", spacing, 1e-4, "0.05")
    outline = None if footprint is None else Footprint.of(footprint).padded(footprint_padding)
    if outline is None and finite_number(footprint_padding) != 0:
        raise ParameterError("footprint_padding", "it is for a footprint", "give footprint=, or a larger radius")
    if outline is not None and radius is not None:
        raise ParameterError("radius and footprint", "the robot is a disc or a polygon", "give one of them")
    body = outline.inscribed if outline else 0.0 if radius is None else _within("radius", radius, 0.0, "0.2")
    margin = _within("margin", margin, 0.0, "0.05")
    limit = math.inf if max_curvature is None else _within("max_curvature", max_curvature, 1e-6, "2")
    headings = _heading("start_heading", start_heading), _heading("goal_heading", goal_heading)
    limits = Limits(max_speed, max_acceleration, max_lateral_acceleration, max_angular_speed)
    bounds = limits.checked()
    told = radius is not None or outline is not None
    made = _Maker(problem, body, margin, spacing, limit, headings, outline, told=told).made(path)
    return driven(made, bounds) if limits.given else made


class _Maker:
    """One call of `trajectory`."""

    def __init__(
        self,
        problem: Problem,
        body: float,
        margin: float,
        spacing: float,
        limit: float,
        headings: _Headings,
        footprint: Footprint | None,
        *,
        told: bool,
    ) -> None:
        self.problem, self.spacing, self.limit, self.headings = problem, spacing, limit, headings
        self.body, self.margin, self.footprint, self.keep = body, margin, footprint, body + margin
        self.side = problem.grid.resolution
        self.need = self.keep / self.side
        self.ground: Ground = ground_of(problem, body=told, footprint=footprint)

    def made(self, path: Path) -> Trajectory:
        note = ""
        self._check_ends()
        line = self._line(path)
        blocked = trajectory_kernels.line_clear(self.ground, line, self.need)
        if blocked >= 0:
            line = self._line(self._planned_anew())
            note = f"the path comes nearer to walls than {self.keep:g} m, so a shortest one that does not was planned"
        start, goal = (None if heading is None else self.problem.grid.origin[2] - heading for heading in self.headings)
        outer = 0.0 if self.footprint is None else self.footprint.circumscribed / self.side
        least = max(1 / (self.limit * self.side), _SHARPEST, outer / 3 if math.isinf(self.limit) else 0.0)
        why = "no curve" if math.isinf(self.limit) else f"no curve of curvature <= {self.limit:g} / m"
        preferred = max(least, self.need, 2.0 if math.isinf(self.limit) else 0.0)
        chords = (self.spacing / self.side) ** 2 / (8 * preferred)  # by which lines between poses cut arcs short
        attempts = [(0.0, chords, preferred)]
        if self.footprint is not None:  # its tests take long, and the search over poses mends the rest
            attempts += [(share * (outer - self.body / self.side), 0.0, preferred) for share in _WIDER]
        else:
            attempts += [(0.0, 0.0, preferred)]
            if least < preferred:
                attempts += [(0.0, 0.0, math.sqrt(least * preferred)), (0.0, 0.0, least)]
            attempts += [(share * least, 0.0, preferred) for share in _LOOSER]
        best, shortest = None, math.inf
        for looser, extra, first in attempts:
            keep = self.need + (extra if self.need > 0 else 0.0)
            taut = trajectory_kernels.pulled(self.ground, line, keep + _SLACK * (keep > 0) + looser)
            curve = self._smooth(taut, keep, least, first)
            if curve is None or curves.length_of(curve) >= shortest:
                continue
            joined = self._headed(curve, start, goal, preferred, least)
            if joined is None:
                why += " with these headings"
                break
            if found := self._checked(joined, note, smooth=True):
                best, shortest = found, curves.length_of(curve)
                if self.footprint is not None or shortest <= _LONGER * np.hypot(*np.diff(taut, axis=0).T).sum():
                    break
        if best is not None:
            return best
        joined = self._searched(line, start, goal, least)
        found = None if joined is None else self._checked(joined, note, smooth=True)
        if found:
            return found
        note += ("; " if note else "") + f"{why} was found that keeps off walls: the robot turns on the spot"
        tight = self.need + _SLACK * (self.need > 0)
        keeps = [tight] if self.footprint is None else [tight, self.footprint.circumscribed / self.side + self.need]
        for keep in keeps:
            taut = trajectory_kernels.pulled(self.ground, line, keep)
            if found := self._checked(_with_ends(taut, start, goal), note, smooth=False):
                return found
        if found := self._checked(_with_ends(line, start, goal), note, smooth=False):
            return found
        if self.footprint is not None:
            rule = "no drive was found on which it keeps the margin from walls"
            raise ParameterError("footprint", rule, "give a smaller one, less margin, or other headings")
        raise PathError("the path", "it does not keep off walls", "report this as an error")

    def _check_ends(self) -> None:
        """Refuse an end at which the footprint fits in no heading, or not in the given one."""
        if self.footprint is None:
            return
        ends = to_plane(self.problem.grid, [self.problem.start, self.problem.goal]).tolist()
        for name, (x, y), heading in zip(("start", "goal"), ends, self.headings, strict=True):
            tried = _ALL_ROUND if heading is None else [self.problem.grid.origin[2] - heading]
            margin = self.margin / self.side
            if not any(trajectory_kernels.body_clear(self.ground, x, y, h, x, y, h, margin) for h in tried):
                rule = (
                    "the footprint keeps the margin from walls there in no heading"
                    if heading is None
                    else (f"with heading {heading:g} the footprint does not keep the margin from walls")
                )
                raise ParameterError(f"{name} {getattr(self.problem, name)} m", rule, "give less, or move it")

    def _line(self, path: Path) -> NDArray[np.float64]:
        """The path through its cells' centres, with the exact ends before and behind them."""
        centres = path.cells[:, ::-1].astype(np.float64)
        ends = to_plane(path.grid, [self.problem.start, self.problem.goal])
        ends = np.where(np.abs(ends - np.rint(ends)) < 1e-9, np.rint(ends), ends)
        line = np.concatenate((ends[:1], centres, ends[1:]))
        new = np.append(True, (np.diff(line, axis=0) != 0).any(axis=1))
        return np.ascontiguousarray(line[new])

    def _planned_anew(self) -> Path:
        """A shortest path that keeps the distance; ends that do not are refused."""
        problem = self.problem
        ends = to_plane(problem.grid, [problem.start, problem.goal])
        for name, (x, y) in zip(("start", "goal"), ends.tolist(), strict=True):
            if not trajectory_kernels.clear(self.ground, x, y, x, y, self.need):
                rule = f"it is nearer to a wall than radius and margin, {self.keep:g} m"
                raise ParameterError(f"{name} {getattr(problem, name)} m", rule, "give less, or move it")
        try:
            strict = Problem(
                problem.grid.inflated(self.keep, strict=True),
                *(problem.start, problem.goal, CornerRule.FORBID, problem.allow_unknown, self.side, self.side),
                *(problem.cost, problem.turning),
            )
            path = exact.shortest_path(strict, "astar").path
        except AntnavError:
            path = None
        if path is None or trajectory_kernels.line_clear(self.ground, self._line(path), self.need) >= 0:
            rule = f"no path keeps {self.keep:g} m from walls"
            raise ParameterError("radius and margin", rule, "give less: the robot does not fit through")
        return path

    def _smooth(self, line: NDArray[np.float64], keep: float, least: float, preferred: float) -> Pieces | None:
        if len(line) < 2:
            return np.array([(*line[0], 0.0, 0.0, 0.0)])
        return rounded(self.ground, line, keep, least, preferred)

    def _headed(
        self, curve: Pieces, start: float | None, goal: float | None, radius: float, least: float
    ) -> Pieces | None:
        """The curve with other headings at its ends."""
        if curves.length_of(curve) == 0 and (start is not None or goal is not None):
            first, last = _on_the_spot(curve, start, goal)
            curve, goal = np.array([first]), (None if first[2] == last[2] else goal)
        for heading, end in ((goal, 1), (start, 0)):
            if heading is None:
                continue
            towards = curves.backwards(curve) if end else curve
            ground = turned(self.ground) if end else self.ground
            joined = self._joined(ground, towards, heading + math.pi * end, radius, least)
            if joined is None:
                return None
            curve = curves.backwards(joined) if end else joined
        return curve

    def _searched(
        self, line: NDArray[np.float64], start: float | None, goal: float | None, least: float
    ) -> Pieces | None:
        """What a search over poses finds, made shorter; a few poses from either end soon tell where none leads on."""
        begin, end = (
            np.array((*point, math.nan if heading is None else heading))
            for point, heading in ((line[0], start), (line[-1], goal))
        )
        wide = self.footprint.circumscribed / self.side if self.footprint else 0.0
        radius, ground, found = max(least, _SEARCHED, wide / 2), self.ground, np.empty((0, 5))
        for limit in _LIMITS_BODY if self.footprint else _LIMITS:
            for _ in range(2):  # forwards, then from the goal
                if not len(found):
                    found, looked = lattice_kernels.search(ground, begin, end, radius, self.need, limit)
                    if not len(found) and looked < limit:
                        return None
                if len(found):
                    found = curves.backwards(lattice_kernels.shortened(ground, found, end, radius, self.need))
                begin, end, ground = end + _ABOUT, begin + _ABOUT, turned(ground)
            if len(found):
                return found
        return None

    def _joined(self, ground: Ground, curve: Pieces, heading: float, radius: float, least: float) -> Pieces | None:
        """The curve with another heading at its start: the shortest turn that is clear and leads onto it.

        A Dubins curve, and where none is clear one after a piece of an arc or a line.
        """
        x, y, before = curve[0, :3].tolist()
        if abs(math.remainder(heading - before, math.tau)) < 1e-9:
            return curve
        total = curves.length_of(curve)
        rests = [curves.part(curve, s, total) for s in [*(s for s in _JOINS * radius if s < total), total]]
        begins = [(x, y, heading, length * radius, bend / radius) for length in _BEGINS for bend in (1.0, -1.0, 0.0)]
        while True:
            for first in ([], *([begin] for begin in begins)):
                head = np.array(first).reshape(-1, 5)
                if not trajectory_kernels.pieces_clear(ground, head, self.need):
                    continue
                found = self._onto(ground, rests, curve, curves.end_of(head) if first else (x, y, heading), radius)
                if found is not None:
                    return np.concatenate((head, found))
            if radius <= least:
                return None
            radius = max(radius * 0.6, least)

    def _onto(self, ground: Ground, rests: list[Pieces], curve: Pieces, begin: Pose, radius: float) -> Pieces | None:
        """The shortest clear Dubins curve from a pose onto a curve, and the rest of that."""
        best, shortest = None, math.inf
        for rest in rests:
            x, y, heading = curves.end_of(curve) if not len(rest) else rest[0, :3].tolist()
            onto = curves.length_of(rest)
            for turn in dubins(begin, (x, y, heading), radius):
                length = curves.length_of(turn) + onto
                if length >= shortest:
                    break
                if trajectory_kernels.pieces_clear(ground, turn, self.need):
                    best, shortest = np.concatenate((turn, rest)), length
                    break
        return best

    def _checked(self, curve: Pieces, note: str, *, smooth: bool) -> Trajectory | None:
        """The trajectory along a curve if it passes the check, with more poses where their chords would not."""
        for finer in (1, 2, 4):
            spacing = self.spacing / self.side / finer
            if curves.length_of(curve) / spacing > MAX_POSES:
                rule = f"there are at most {MAX_POSES} poses"
                raise ParameterError(f"spacing {self.spacing} m", rule, "give a larger one")
            poses, curvature = curves.sampled(curve, spacing)
            world = to_world(self.problem.grid, poses)
            for at, place, heading in (
                (0, self.problem.start, self.headings[0]),
                (-1, self.problem.goal, self.headings[1]),
            ):
                world[(poses[:, :2] == poses[at, :2]).all(axis=1), :2] = place  # turns on the spot there, too
                if heading is not None:
                    world[at, 2] = heading
            bends = np.where(np.isinf(curvature), math.inf, -curvature / self.side + 0.0)
            made = Trajectory(
                world, bends, self.problem.grid, self.body, self.margin, smooth, note, footprint=self.footprint
            )
            try:
                check_trajectory(made, self.problem, None, self.limit if smooth and self.limit < math.inf else None)
                return made
            except PathError:
                continue
        return None


def _with_ends(line: NDArray[np.float64], start: float | None, goal: float | None) -> Pieces:
    """A line with its corners, and turns on the spot at its ends where they have headings."""
    pieces = curves.polyline(line)
    if not len(pieces):
        return _on_the_spot(line, start, goal)
    for heading, pose, at in ((start, pieces[0, :3], 0), (goal, curves.end_of(pieces), len(pieces))):
        if heading is not None:
            pieces = np.insert(pieces, at if at == 0 else len(pieces), (pose[0], pose[1], heading, 0.0, 0.0), axis=0)
    return pieces


def _on_the_spot(line: NDArray[np.float64], start: float | None, goal: float | None) -> Pieces:
    """No way to go: start and goal are one point."""
    x, y = line[0, :2]
    headings = (start if start is not None else goal or 0.0, goal if goal is not None else start or 0.0)
    return np.array([(x, y, heading, 0.0, 0.0) for heading in headings])


def _within(name: str, given: object, least: float, example: str) -> float:
    number = finite_number(given)
    if not number >= least:
        rule = f"it is a finite number, >= {least:g}"
        raise ParameterError(f"{name} {shown(given)}", rule, f"give one, such as {example}")
    return number


def _heading(name: str, given: object) -> float | None:
    if given is None:
        return None
    number = finite_number(given)
    if not math.isfinite(number):
        raise ParameterError(f"{name} {shown(given)}", "it is a finite number of radians", "give one, such as 1.57")
    return math.remainder(number, math.tau)
