"""Result: what a planner found, how good it is, and all that is needed to repeat it."""

from __future__ import annotations

import math
import os
import platform
from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields
from functools import cache, cached_property
from typing import TYPE_CHECKING, Any, Self

import msgspec
import numpy as np
from numpy.typing import NDArray

from antnav.errors import AntnavError, ParameterError, ResultFormatError
from antnav.files import as_path, write_whole
from antnav.kernels.ant_kernels import History
from antnav.planner.document import Document, ProblemPart, content_of, encoded, finite, unreadable, written
from antnav.planner.memory import Memory
from antnav.planner.phases import Phase
from antnav.planner.plan import Stage, Status, StoppedBy, iterations_of
from antnav.planner.planner import Planner, differing, plain
from antnav.search import exact
from antnav.values import read_only
from antnav.world.path import Path, check_path
from antnav.world.problem import CellIndex, Problem

if TYPE_CHECKING:
    from antnav.trajectories.footprint import Footprint
    from antnav.trajectories.model import Trajectory

#: Costs that differ by less, relative to the optimum, are equal: the same prices added up in another order.
SAME = 1e-12


@dataclass(frozen=True, eq=False, kw_only=True)
class Result:
    """Outcome of `solve`, whatever the planner: plain data, which can be copied, pickled and saved.

    Attributes
    ----------
    status : Status
    stopped_by : StoppedBy
    problem, algorithm, seed
        What was asked; `algorithm` is the planner, and its certainty travels with it.
    path : Path or None
        None unless the status is "found".
    optimum : float
        Cost in cells of a cheapest path on the grid's eight directions, from an exact search; inf where no path exists.
        Without costs that is the length of a shortest one, and a path at any angle can be 3 to 6 % shorter. Searched
        when it is first asked for, unless the problem's other results know it.
    auxiliary_cell : (row, col) or None
        Where PACO divided the map in two; None where it did not. See also `crossing_cells`.
    stages : tuple of Stage
    history : History
        One value an iteration. For a divided problem: the better colony in stage one, the sum of all in stage two,
        without the turns where parts meet.
    estimated : bool
        Whether the history's lengths only estimate: with `coarse` they are those on the graph of regions.
    pheromone : ndarray of float32, shape (rows, cols), or None
        Mean pheromone of each cell's edges at the end, nan where no ant could walk. Not kept in files.
    heat : callable or None
        Makes the pheromone's map.
    memory : Memory or None
        The pheromone that other runs can begin with; None without `remember`, or where nobody has walked. Not kept in
        files.
    stop : str or None
        The stopping criterion as text. A run that a time limit or a person ended cannot be repeated exactly.
    notes : tuple of str
        What a reader must know: fallbacks, crossings, extended stages.
    seconds_run, seconds_compile, seconds_exact, cpu_seconds : float
        Wall time of the ants and what belongs to them, of compiling or loading the kernels, of the exact search; CPU
        time of the ants.
    certificate : (length, seconds) or None
        What the exact search brought; None: it runs when asked for.
    versions : dict
        antnav, Python, NumPy and Numba, and the planner's own libraries.
    """

    status: Status
    stopped_by: StoppedBy
    problem: Problem
    algorithm: Planner
    seed: int
    path: Path | None
    auxiliary_cell: CellIndex | None
    stages: tuple[Stage, ...]
    history: History
    estimated: bool = False
    heat: Callable[[], NDArray[np.float32]] | None = None
    memory: Memory | None = None
    stop: str | None
    notes: tuple[str, ...]
    seconds_run: float
    seconds_compile: float
    cpu_seconds: float
    versions: dict[str, str]
    certificate: tuple[float, float] | None = None

    def __repr__(self) -> str:
        grid = self.problem.grid
        place = f"{grid.name!r}, {grid.rows} x {grid.cols} cells" if grid.name else f"{grid.rows} x {grid.cols} cells"
        found = f", path={self.path!r}" if self.path else ""
        return (
            f"Result({self.status}{found}, {self.algorithm.name} on {place}, seed={self.seed}, "
            f"{self.iterations} iterations, {self.steps} steps)"
        )

    def _repr_html_(self) -> str:
        from antnav.markup import escaped, map_html

        rows = "".join(f"<tr><th>{escaped(name)}</th><td>{escaped(text)}</td></tr>" for name, text in self.table)
        grid = self.problem.grid
        return f"{map_html(grid.cells, repr(grid), self.path.cells if self.path else None)}<table>{rows}</table>"

    @cached_property
    def pheromone(self) -> NDArray[np.float32] | None:
        """Mean pheromone of each cell's edges at the end, shape (rows, cols), nan where no ant could walk."""
        return None if self.heat is None else read_only(self.heat())

    @cached_property
    def _exact(self) -> tuple[float, float]:
        if self.certificate is not None:
            return self.certificate
        if not self.problem.connected:
            return math.inf, 0.0
        found = exact.optimum(self.problem)
        return found.cost, found.seconds

    @property
    def optimum(self) -> float:
        """Cost in cells of a cheapest path on the grid's eight directions; inf where none exists."""
        return self._exact[0]

    @property
    def any_angle_bound(self) -> float | None:
        """Length in cells between centres of the shortest line at any angle: no path of any planner is shorter.

        Exact and searched when it is first asked for, once for each problem; inf where no path exists, None where the
        problem has costs. The line is that of a point, see `antnav.exact.any_angle`.
        """
        return exact.any_angle_bound(self.problem)

    @property
    def seconds_exact(self) -> float:
        """Wall time of the search for the optimum."""
        return self._exact[1]

    @cached_property
    def cost(self) -> float:
        """Cost in cells by the problem's objective, which is the length where it has no costs; inf without a path."""
        return self.problem.objective.of(self.path.cells, self.problem.grid) if self.path else math.inf

    @property
    def length(self) -> float:
        """Length in cells between centres; inf without a path."""
        return self.path.length if self.path else math.inf

    @property
    def length_m(self) -> float:
        """Length in metres of the polyline from the exact start to the exact goal; inf without a path."""
        return self.path.length_m if self.path else math.inf

    @property
    def gap(self) -> float:
        """Cost / optimum - 1: 0 is the cheapest on the grid's eight directions; nan without a path."""
        if self.path is None:
            return math.nan
        above = self.cost / self.optimum - 1.0 if self.optimum > 0 else 0.0
        return above if abs(above) > SAME else 0.0

    @property
    def crossing_cells(self) -> tuple[CellIndex, ...]:
        """Where the map was divided: the auxiliary cell, or one cell on each level."""
        divided = [stage for stage in self.stages if stage.name == Phase.STAGE_TWO]
        return tuple(colony.start for stage in divided for colony in stage.colonies[1:])

    @property
    def iterations(self) -> int:
        """Iterations done, one after the other."""
        return len(self.history.best)

    @property
    def steps(self) -> int:
        """Moves of all ants of all colonies."""
        return sum(colony.steps for stage in self.stages for colony in stage.colonies)

    @property
    def critical_steps(self) -> int:
        """Moves on the critical path: the longer colony of each stage."""
        return sum(max((colony.steps for colony in stage.colonies), default=0) for stage in self.stages)

    @property
    def walks(self) -> int:
        """Paths that were tried, arrived or not: ants, or cost evaluations of a metaheuristic."""
        return sum(colony.walks for stage in self.stages for colony in stage.colonies)

    @cached_property
    def table(self) -> list[tuple[str, str]]:
        """The summary as pairs of name and text."""
        grid = self.problem.grid
        rows = [("status", f"{self.status.replace('_', ' ')}" + self._ending())]
        if self.path:
            rows += [
                ("length", f"{self.length:.4f} cells between centres, {self.length_m:.3f} m from start to goal"),
                *self._priced(),
                ("optimum", f"{self.optimum:.4f} cells (exact, on the grid's eight directions)"),
                ("gap", f"{100 * self.gap:.2f} % above that optimum"),
                ("turns", f"{self.path.turns} ({math.degrees(self.path.turning_angle):.0f} degrees)"),
                ("clearance", _clearance(self.path)),
            ]
        if self.auxiliary_cell:
            x, y = grid.cell_to_world(self.auxiliary_cell)
            passed = self.path is None or self.auxiliary_cell in map(tuple, self.path.cells.tolist())
            aside = "" if passed else "; as long a path with fewer turns passes elsewhere (see straighten)"
            rows.append(("auxiliary cell", f"{self.auxiliary_cell} = ({x:g}, {y:g}) m{aside}"))
        searched = self.algorithm.schedule or self.iterations  # an exact search has no iterations
        rows += [
            ("iterations", f"{self.iterations}{self.algorithm.schedule}, {self.steps} steps")
            if searched
            else ("steps", f"{self.steps}"),
            (
                "seconds",
                f"{self.seconds_run:.4f} run, {self.seconds_compile:.2f} compile, {self.seconds_exact:.4f} exact",
            ),
            ("algorithm", f"{self.algorithm.outline}, seed {self.seed}"),
            ("certainty", str(self.algorithm.certainty)),
        ]
        return rows + [("note", note) for note in self.notes]

    def _priced(self) -> list[tuple[str, str]]:
        field, turning = self.problem.cost, self.problem.turning
        shares = ([field.name] if field else []) + [f"turns, {turning:g} a radian"] * (turning > 0)
        return [("cost", f"{self.cost:.4f} cells: the length, {', '.join(shares)}")] if shares else []

    def _ending(self) -> str:
        if self.stopped_by is StoppedBy.SCHEDULE:
            return ""
        return f" (stopped: {self.stop if self.stopped_by is StoppedBy.CRITERION else self.stopped_by})"

    def summary(self) -> str:
        """A short table: status, length, gap to the optimum, turns, clearance, seconds."""
        return "\n".join(f"{name:<14} {text}" for name, text in self.table)

    def trajectory(
        self,
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
        """A curve that a robot can drive along the path; see `antnav.trajectory`.

        Raises
        ------
        ParameterError
            There is no path, or as there.
        """
        from antnav.trajectories.trajectory import trajectory

        if self.path is None:
            raise ParameterError(f"status {self.status}", "a trajectory follows a path", "solve a problem that has one")
        return trajectory(
            self.path,
            self.problem,
            spacing=spacing,
            radius=radius,
            margin=margin,
            start_heading=start_heading,
            goal_heading=goal_heading,
            max_curvature=max_curvature,
            footprint=footprint,
            footprint_padding=footprint_padding,
            max_speed=max_speed,
            max_acceleration=max_acceleration,
            max_lateral_acceleration=max_lateral_acceleration,
            max_angular_speed=max_angular_speed,
        )

    def document(self, *, map_cells: bool = True) -> Document:
        """The result as what a file says."""
        path = self.path
        return Document(
            length=finite(self.length),
            length_m=finite(self.length_m),
            cost=finite(self.cost),
            optimum=finite(self.optimum),
            gap=finite(self.gap),
            turns=path.turns if path else None,
            turning_angle=path.turning_angle if path else None,
            clearance_m=finite(path.clearance) if path else None,
            wall_distance_m=finite(path.wall_distance) if path else None,
            seconds_exact=self.seconds_exact,
            path=path.cells.tolist() if path else None,
            path_m=path.points.tolist() if path else None,
            algorithm=plain(self.algorithm, self.algorithm.document()),
            problem=ProblemPart.of(self.problem, map_cells=map_cells),
            history=written(self.history),
            **{name: getattr(self, name) for name in _KEPT},
        )

    def to_dict(self, *, map_cells: bool = True) -> dict[str, Any]:
        """The result as JSON types, infinities and nan as None.

        Parameters
        ----------
        map_cells : bool
            Whether the map itself goes along, compressed; without it a file cannot be loaded again.
        """
        document: dict[str, Any] = msgspec.to_builtins(self.document(map_cells=map_cells))
        return document

    def save(self, path: str | os.PathLike[str], *, frame: str = "map", stamp: float = 0.0) -> None:
        """Write the result, whole or not at all, in the format that the name's ending says.

        ".json": everything but the pheromone, see `Result.load`. ".csv": the path, one line a cell: row, col, x and y
        in metres, heading in radians. ".geojson", ".ros2.yaml", ".mcap", ".rosbag2": the path for other programs, with
        `frame` and `stamp` as of `Trajectory.save`. Pictures are drawn by `plot_result`.

        Raises
        ------
        ParameterError
            Another ending; no such frame or stamp; rosbags is missing; a planner of one's own with what no file can
            hold, such as an array.
        OutputError
            The file cannot be written.
        """
        from antnav.trajectories.files import is_line, save_line

        if not is_line(path):
            write_whole(path, encoded(as_path(path).name, self.document, self.path))
            return
        poses = np.column_stack((self.path.points, self.path.headings)) if self.path else np.zeros((0, 3))
        told = {"status": self.status, "algorithm": self.algorithm.name, "seed": self.seed}
        told |= {name: finite(getattr(self, name)) for name in ("length_m", "cost", "optimum", "gap")}
        save_line(path, poses, self.problem.grid, told, frame, stamp)

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Self:
        """Read a result that `save` wrote as JSON.

        What follows from the path, the map and the history, such as length, gap and clearance, is worked out anew and
        compared with the file.

        Raises
        ------
        ResultFormatError
            No such file, not a result, of a newer version, or one that cannot be true.
        """
        return cls._of(Document.read(content_of(path)))

    @classmethod
    def _of(cls, document: Document) -> Self:
        try:
            problem = document.problem.problem()
            path = None
            if document.path is not None:
                path = Path(np.array(document.path), problem.grid, problem.start, problem.goal)
                check_path(path, problem)
            optimum = math.inf if document.optimum is None else document.optimum
            algorithm = document.planner()
            result = cls(
                problem=problem,
                algorithm=algorithm,
                path=path,
                history=document.columns(),
                certificate=(optimum, document.seconds_exact),
                estimated=document.is_estimated(),
                notes=tuple(dict.fromkeys((*document.notes, *differing(algorithm, document.algorithm)))),
                **{name: getattr(document, name) for name in _KEPT - {"estimated", "notes"}},
            )
            result._check()
            document.check_derived(result.document(map_cells=False))
        except ResultFormatError:
            raise
        except (AntnavError, ValueError, OverflowError) as error:
            raise unreadable("the file", str(error)) from error
        return result

    def _check(self) -> None:
        """Refuse what cannot be true together."""
        problem, found = self.problem, self.status is Status.FOUND
        if (self.path is not None) != found:
            raise unreadable(f"status {self.status}", "a path goes with the status found, and with no other")
        if not found and problem.connected == (self.status is Status.UNREACHABLE):
            raise unreadable(f"status {self.status}", "whether a path exists is another matter on this map")
        if math.isinf(self.optimum) != (self.status is Status.UNREACHABLE):
            raise unreadable(f"optimum {self.optimum}", "there is one where a path exists, and only there")
        straight = math.dist(problem.start_cell, problem.goal_cell)
        if problem.connected and not straight * (1 - 1e-9) <= self.optimum <= self.cost * (1 + 1e-9):
            raise unreadable(
                f"optimum {self.optimum}", f"it lies between {straight}, straight, and {self.cost}, the path"
            )
        self._check_history()
        ends = [end for stage in self.stages for colony in stage.colonies for end in (colony.start, colony.goal)]
        for end in [*ends, *([self.auxiliary_cell] if self.auxiliary_cell else [])]:
            if not problem.grid.contains(end):
                raise unreadable(f"a colony or auxiliary cell at {end}", "it lies outside the map")

    def _check_history(self) -> None:
        history = self.history
        done = iterations_of(self.stages)
        rest = self.steps - history.steps.sum()  # a rival may end within an iteration
        if done != len(history.best) or rest < 0 or (rest and self.algorithm.ants):
            raise unreadable("the history", f"it is of {done} iterations and {self.steps} steps, as the stages say")
        if self.walks and (history.arrived + history.lost).sum() > self.walks:
            raise unreadable("the history", f"no more than the {self.walks} ants that walked arrived or were lost")
        lengths = np.concatenate((history.best, history.iteration_best, history.mean))
        joints = math.pi * self.problem.turning * len(self.crossing_cells)  # turns there are in no part's cost
        if not self.estimated and (lengths < self.optimum * (1 - 1e-9) - joints).any():
            raise unreadable("the history", f"no length lies below the optimum {self.optimum}")


#: Fields that a result shares with its document.
_KEPT = ({field.name for field in fields(Result)} & set(Document.__struct_fields__)) - {
    "problem",
    "algorithm",
    "path",
    "history",
}


def _clearance(path: Path) -> str:
    if path.clearance == math.inf:
        return "no walls"
    return f"{path.clearance:.3f} m between cell centres, {path.wall_distance:.3f} m from the path to the walls' edges"


@cache
def versions() -> dict[str, str]:
    """Versions that a result depends on."""
    from importlib.metadata import version

    return {"python": platform.python_version()} | {name: version(name) for name in ("antnav", "numpy", "numba")}
