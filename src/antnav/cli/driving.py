"""`antnav plan --trajectory`: the options of a trajectory, its file and its rows."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from antnav.cli.inputs import check_output, files_of_map
from antnav.errors import AntnavError, ParameterError
from antnav.planner.result import Result

if TYPE_CHECKING:
    from antnav.trajectories.model import Trajectory

_ENDINGS = (".csv", ".json")


@dataclass(frozen=True)
class Drive:
    """Where a trajectory goes, and what it should be like."""

    path: Path
    spacing: float
    margin: float
    max_curvature: float | None
    start_heading: float | None
    goal_heading: float | None

    @classmethod
    def of(cls, name: str | None, *numbers: float | None, alone: bool) -> Drive | None:
        """The options together, or a `ParameterError`; None without a file."""
        if name is None:
            if any(number is not None for number in numbers):
                given = "--spacing, --margin, --max-curvature, --start-heading or --goal-heading"
                raise ParameterError(given, "they are of --trajectory", "give --trajectory FILE")
            return None
        if not alone:
            raise ParameterError(
                "--trajectory with --alternatives", "a trajectory follows one path", "give one of them"
            )
        spacing, margin, *others = numbers
        drive = cls(Path(name), 0.05 if spacing is None else spacing, margin or 0.0, *others)
        for option in ("spacing", "margin", "max_curvature", "start_heading", "goal_heading"):
            number = getattr(drive, option)
            least = {"spacing": 1e-4, "margin": 0.0, "max_curvature": 1e-6}.get(option, -math.inf)
            if number is not None and not (math.isfinite(number) and number >= least):
                given = f"--{option.replace('_', '-')} {number}"
                raise ParameterError(given, f"it is a finite number, >= {least:g}", "give one")
        return drive

    def check(self, map_name: str) -> None:
        """Refuse a file that could not be written later."""
        check_output(self.path, _ENDINGS, files_of_map(map_name))

    def along(self, result: Result, radius: float) -> tuple[Trajectory | None, BaseException | None]:
        """The trajectory along a result's path, saved; a failure comes back, for the path is found all the same."""
        if result.path is None:
            return None, None
        made = None
        try:
            made = result.trajectory(
                spacing=self.spacing,
                radius=radius or None,
                margin=self.margin,
                start_heading=self.start_heading,
                goal_heading=self.goal_heading,
                max_curvature=self.max_curvature,
            )
            made.save(self.path)
        except AntnavError as error:
            return made, error
        return made, None

    def rows(self, made: Trajectory) -> list[tuple[str, str]]:
        """What is printed of it."""
        bent = f"curvature up to {made.max_curvature:.3g} / m" if made.smooth else "with corners"
        room = f"{made.wall_distance:.3f} m from walls' edges" if math.isfinite(made.wall_distance) else "no walls"
        rows = [("trajectory", f"{len(made)} poses, {made.length:.3f} m, {bent}, {room}, checked; in {self.path}")]
        return rows + [("note", made.note)] * bool(made.note)
