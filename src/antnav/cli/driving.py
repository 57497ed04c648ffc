"""`--trajectory` of `antnav plan` and `antnav tour`: the options of a trajectory, its file and its rows."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from antnav.cli.inputs import check_output, files_of_map
from antnav.errors import AntnavError, ParameterError
from antnav.exchange import bag
from antnav.planner.result import Result
from antnav.trajectories.files import ending_of

if TYPE_CHECKING:
    from antnav.tours.model import Tour
    from antnav.trajectories.footprint import Footprint
    from antnav.trajectories.model import Trajectory

Spacing = Annotated[
    float | None, typer.Option(metavar="METRES", help="With --trajectory: from pose to pose, at most [0.05].")
]
MaxCurvature = Annotated[
    float | None, typer.Option(metavar="1/M", help="With --trajectory: one over the turning radius [no limit].")
]
StartHeading = Annotated[
    float | None, typer.Option(metavar="RADIANS", help="With --trajectory: where the robot heads at the start.")
]
GoalHeading = Annotated[
    float | None, typer.Option(metavar="RADIANS", help="With --trajectory: where it heads at the goal.")
]
MaxSpeed = Annotated[
    float | None, typer.Option(metavar="M/S", help="With --trajectory: speeds and times, as fast as limits allow.")
]
MaxAcceleration = Annotated[
    float | None, typer.Option(metavar="M/S2", help="With --max-speed: along the curve [speeds change at once].")
]
MaxLateralAcceleration = Annotated[
    float | None, typer.Option(metavar="M/S2", help="With --max-speed: across the curve [no limit].")
]
MaxAngularSpeed = Annotated[
    float | None, typer.Option(metavar="RAD/S", help="With --max-speed: how fast it turns [no limit].")
]

_LIMITS = ("max_acceleration", "max_lateral_acceleration", "max_angular_speed")


@dataclass(frozen=True)
class Drive:
    """Where a trajectory goes, and what it should be like."""

    path: Path
    spacing: float
    margin: float
    max_curvature: float | None
    start_heading: float | None
    goal_heading: float | None
    max_speed: float | None = None
    max_acceleration: float | None = None
    max_lateral_acceleration: float | None = None
    max_angular_speed: float | None = None

    @classmethod
    def of(cls, name: str | None, *numbers: float | None, alone: bool) -> Drive | None:
        """The options together, or a `ParameterError`; None without a file."""
        if name is None:
            parts = zip(fields(cls)[1:], numbers, strict=False)
            if meant := [_option(part.name) for part, number in parts if number is not None]:
                raise ParameterError(", ".join(meant), "they are of --trajectory", "give --trajectory FILE")
            return None
        if not alone:
            raise ParameterError(
                "--trajectory with --alternatives", "a trajectory follows one path", "give one of them"
            )
        spacing, margin, *others = numbers
        drive = cls(Path(name), 0.05 if spacing is None else spacing, margin or 0.0, *others)
        for option in (part.name for part in fields(cls)[1:]):
            number = getattr(drive, option)
            least = {"spacing": 1e-4, "margin": 0.0}.get(option, 1e-6 if option.startswith("max") else -math.inf)
            if number is not None and not (math.isfinite(number) and number >= least):
                rule = (
                    f"it is a finite number, >= {least:g}"
                    if math.isfinite(least)
                    else "it is a finite number of radians"
                )
                raise ParameterError(f"{_option(option)} {number}", rule, "give one")
        if drive.max_speed is None and any(getattr(drive, option) is not None for option in _LIMITS):
            given = f"one of {', '.join(_option(name) for name in _LIMITS)}"
            raise ParameterError(given, "they need --max-speed", "give --max-speed METRES_A_SECOND")
        return drive

    def check(self, map_name: str, outputs: Sequence[Path]) -> None:
        """Refuse a file that could not be written later, or is one of the other outputs."""
        ending = ending_of(self.path)
        if self.path in outputs:
            raise ParameterError(f"--trajectory {self.path}", "it is an --output, too", "choose another name")
        if ending in bag.ENDINGS:
            bag.require_rosbags()
        check_output(self.path, (self.path.suffix.lower(),), files_of_map(map_name), folder=ending == ".rosbag2")

    def along(
        self, result: Result | Tour, radius: float, outline: Footprint | None = None
    ) -> tuple[Trajectory | None, BaseException | None]:
        """The trajectory along a result's path, saved; a failure comes back, for the path is found all the same."""
        if result.path is None:
            return None, None
        made = None
        try:
            made = result.trajectory(
                spacing=self.spacing,
                radius=None if outline else radius or None,
                footprint=outline,
                margin=self.margin,
                start_heading=self.start_heading,
                goal_heading=self.goal_heading,
                max_curvature=self.max_curvature,
                max_speed=self.max_speed,
                max_acceleration=self.max_acceleration,
                max_lateral_acceleration=self.max_lateral_acceleration,
                max_angular_speed=self.max_angular_speed,
            )
            made.save(self.path)
        except AntnavError as error:
            return made, error
        return made, None

    def rows(self, made: Trajectory) -> list[tuple[str, str]]:
        """What is printed of it."""
        bent = f"curvature up to {made.max_curvature:.3g} / m" if made.smooth else "with corners"
        centre = "the centre " if made.footprint else ""
        room = (
            f"{centre}{made.wall_distance:.3f} m from walls' edges" if math.isfinite(made.wall_distance) else "no walls"
        )
        pace = "" if made.duration is None else f" in {made.duration:.1f} s"
        told = f"{len(made)} poses, {made.length:.3f} m{pace}, {bent}, {room}, checked; in {self.path}"
        rows = [("trajectory", told)]
        return rows + [("note", made.note)] * bool(made.note)


def outline_of(text: str | None, padding: float | None, radius: float, *, driven: bool) -> Footprint | None:
    """The options of a robot that is no disc, or a `ParameterError`; None without."""
    if text is None:
        if padding is not None:
            raise ParameterError("--footprint-padding", "it is of --footprint", "give --footprint POINTS")
        return None
    if not driven or radius > 0:
        rule = "the robot is a disc or a polygon" if radius > 0 else "it is of --trajectory"
        given = "--footprint with --robot-radius" if radius > 0 else "--footprint"
        raise ParameterError(given, rule, "give one of them" if radius > 0 else "give --trajectory FILE")
    from antnav.trajectories.footprint import Footprint

    return Footprint.of_nav2(text).padded(0.0 if padding is None else padding)


def _option(name: str) -> str:
    return f"--{name.replace('_', '-')}"
