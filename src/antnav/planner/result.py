"""Result: what a planner found, how good it is, and all that is needed to repeat it."""

from __future__ import annotations

import base64
import csv
import io
import math
import os
import platform
import zlib
from collections.abc import Callable
from dataclasses import asdict, dataclass
from enum import StrEnum
from functools import cache, cached_property
from pathlib import Path as FilePath
from typing import Annotated, Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from antnav.colony.colony import check_seed
from antnav.colony.parameters import Algorithm
from antnav.errors import AntnavError, ParameterError, ResultFormatError
from antnav.files import as_path, open_regular, write_whole
from antnav.kernels.ant_kernels import COUNTS, History
from antnav.planner.phases import Phase
from antnav.search import exact
from antnav.values import read_only
from antnav.world.grid import MAX_CELLS, GridMap
from antnav.world.moves import CornerRule
from antnav.world.path import Path, check_path
from antnav.world.problem import CellIndex, Point, Problem

SCHEMA = "antnav/result"
VERSION = 1

#: What a file may say.
Count = Annotated[int, msgspec.Meta(ge=0)]
Measure = Annotated[float, msgspec.Meta(ge=0)]


class Status(StrEnum):
    """How a search ended.

    - found: there is a path
    - unreachable: no path exists; no ant walked
    - no_ant_arrived: a path exists, but no ant found one
    """

    FOUND = "found"
    UNREACHABLE = "unreachable"
    NO_ANT_ARRIVED = "no_ant_arrived"


class StoppedBy(StrEnum):
    """What ended the search.

    - schedule: all iterations were done, or none were needed
    - criterion: the stopping criterion
    - cancelled: somebody set `cancel`
    """

    SCHEDULE = "schedule"
    CRITERION = "criterion"
    CANCELLED = "cancelled"


@dataclass(frozen=True, slots=True)
class ColonyReport:
    """Account of one colony: its ends, iterations, best length, moves of its ants, wall and CPU seconds."""

    start: CellIndex
    goal: CellIndex
    iterations: Count
    length: Measure | None
    steps: Count
    seconds: Measure
    cpu_seconds: Measure


@dataclass(frozen=True, slots=True)
class Stage:
    """Account of colonies that ran side by side; `seconds` is the wall time, t1 or t2 of the paper."""

    name: str
    seconds: Measure
    colonies: tuple[ColonyReport, ...]

    @property
    def balance(self) -> float:
        """Moves of the busiest colony's ants over the mean: 1 is even; nan without colonies."""
        steps = [colony.steps for colony in self.colonies]
        return max(steps) * len(steps) / sum(steps) if sum(steps) else math.nan


@dataclass(frozen=True, eq=False)
class Result:
    """Outcome of `solve`.

    Attributes
    ----------
    status : Status
    stopped_by : StoppedBy
    problem, algorithm, seed
        What was asked. The algorithm's certainty travels with it.
    path : Path or None
        None unless the status is "found".
    optimum : float
        Length in cells of a shortest path on the grid's eight directions, from an exact search; inf where no path
        exists. A path at any angle can be 3 to 6 % shorter. Searched when it is first asked for, unless the problem's
        other results know it.
    auxiliary_cell : (row, col) or None
        Where PACO divided the map in two; None where it did not. See also `crossing_cells`.
    stages : tuple of Stage
    history : History
        One value an iteration. For a divided problem: the better colony in stage one, the sum of all in stage two. With
        `coarse` lengths are those on the graph of regions, which only estimate.
    pheromone : ndarray of float32, shape (rows, cols), or None
        Mean pheromone of each cell's edges at the end, nan where no ant could walk. Not kept in files.
    heat : callable or None
        Makes the pheromone's map.
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
        antnav, Python, NumPy and Numba.
    """

    status: Status
    stopped_by: StoppedBy
    problem: Problem
    algorithm: Algorithm
    seed: int
    path: Path | None
    auxiliary_cell: CellIndex | None
    stages: tuple[Stage, ...]
    history: History
    heat: Callable[[], NDArray[np.float32]] | None
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
        return found.length, found.seconds

    @property
    def optimum(self) -> float:
        """Length in cells of a shortest path on the grid's eight directions; inf where none exists."""
        return self._exact[0]

    @property
    def seconds_exact(self) -> float:
        """Wall time of the search for the optimum."""
        return self._exact[1]

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
        """Length / optimum - 1, both in cells: 0 is the shortest on the grid's eight directions; nan without a path."""
        if self.path is None:
            return math.nan
        return self.length / self.optimum - 1.0 if self.optimum > 0 else 0.0

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
    def nav2_code(self) -> int:
        """Error code of nav2's ComputePathToPose action: 0 found, 207 out of time, 208 no path."""
        if self.status is Status.FOUND:
            return 0
        timed_out = self.status is Status.NO_ANT_ARRIVED and self.stopped_by is not StoppedBy.SCHEDULE
        return 207 if timed_out else 208

    @cached_property
    def table(self) -> list[tuple[str, str]]:
        """The summary as pairs of name and text."""
        algorithm, grid = self.algorithm, self.problem.grid
        rows = [("status", f"{self.status.replace('_', ' ')}" + self._ending())]
        if self.path:
            rows += [
                ("length", f"{self.length:.4f} cells between centres, {self.length_m:.3f} m from start to goal"),
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
        rows += [
            ("iterations", f"{self.iterations} of {algorithm.iterations}, {algorithm.ants} ants, {self.steps} steps"),
            (
                "seconds",
                f"{self.seconds_run:.4f} run, {self.seconds_compile:.2f} compile, {self.seconds_exact:.4f} exact",
            ),
            ("algorithm", f"{algorithm.name}, heuristic {algorithm.heuristic}, seed {self.seed}"),
            ("certainty", algorithm.certainty),
        ]
        return rows + [("note", note) for note in self.notes]

    def _ending(self) -> str:
        if self.stopped_by is StoppedBy.SCHEDULE:
            return ""
        return f" (stopped: {self.stop if self.stopped_by is StoppedBy.CRITERION else self.stopped_by})"

    def summary(self) -> str:
        """A short table: status, length, gap to the optimum, turns, clearance, seconds."""
        return "\n".join(f"{name:<14} {text}" for name, text in self.table)

    def to_dict(self, *, map_cells: bool = True) -> dict[str, Any]:
        """The result as JSON types, infinities and nan as None.

        Parameters
        ----------
        map_cells : bool
            Whether the map itself goes along, compressed; without it a file cannot be loaded again.
        """
        grid, problem = self.problem.grid, self.problem
        map_part: dict[str, Any] = {
            "digest": grid.digest,
            "name": grid.name.encode(errors="replace").decode(),  # a file name need not be text
            "rows": grid.rows,
            "cols": grid.cols,
            "resolution": grid.resolution,
            "origin": list(grid.origin),
        }
        if map_cells:
            map_part["cells"] = base64.b64encode(zlib.compress(grid.cells.tobytes(), 6)).decode()
        path = self.path
        return {
            "schema": SCHEMA,
            "version": VERSION,
            "status": self.status.value,
            "stopped_by": self.stopped_by.value,
            "length": _finite(self.length),
            "length_m": _finite(self.length_m),
            "optimum": _finite(self.optimum),
            "gap": _finite(self.gap),
            "turns": path.turns if path else None,
            "turning_angle": path.turning_angle if path else None,
            "clearance_m": _finite(path.clearance) if path else None,
            "wall_distance_m": _finite(path.wall_distance) if path else None,
            "seconds_run": self.seconds_run,
            "seconds_compile": self.seconds_compile,
            "seconds_exact": self.seconds_exact,
            "cpu_seconds": self.cpu_seconds,
            "seed": self.seed,
            "path": path.cells.tolist() if path else None,
            "path_m": path.points.tolist() if path else None,
            "auxiliary_cell": list(self.auxiliary_cell) if self.auxiliary_cell else None,
            "algorithm": asdict(self.algorithm),
            "problem": {
                "map": map_part,
                "start": list(problem.start),
                "goal": list(problem.goal),
                "start_cell": list(problem.start_cell),
                "goal_cell": list(problem.goal_cell),
                "corner_rule": problem.corner_rule.value,
                "allow_unknown": problem.allow_unknown,
                "goal_tolerance": problem.goal_tolerance,
                "start_tolerance": problem.start_tolerance,
                "requested_goal": list(problem.requested_goal) if problem.requested_goal else None,
                "requested_start": list(problem.requested_start) if problem.requested_start else None,
            },
            "stages": [asdict(stage) for stage in self.stages],
            "history": {
                name: [_finite(value) for value in array.tolist()]
                for name, array in zip(History._fields, self.history, strict=True)
            },
            "stop": self.stop,
            "notes": list(self.notes),
            "nav2_code": self.nav2_code,
            "versions": self.versions,
        }

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the result, whole or not at all, in the format that the name's ending says.

        ".json": everything but the pheromone, see `Result.load`. ".csv": the path, one line a cell: row, col, x and y
        in metres, heading in radians. Pictures are drawn by `plot_result`.

        Raises
        ------
        ParameterError
            Another ending.
        OutputError
            The file cannot be written.
        """
        ending = as_path(path).suffix.lower()
        if ending == ".json":
            write_whole(path, msgspec.json.format(msgspec.json.encode(self.to_dict()), indent=1) + b"\n")
        elif ending == ".csv":
            write_whole(path, self._csv().encode())
        else:
            raise ParameterError(
                f"file name {FilePath(path).name}", "results are saved as .json or .csv", "choose one of them"
            )

    def _csv(self) -> str:
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(["row", "col", "x_m", "y_m", "heading_rad"])
        if self.path:
            points = self.path.points
            cells = self.path.cells.repeat(len(points) // len(self.path), axis=0)  # two points may share a cell
            for (row, col), (x, y), heading in zip(
                cells.tolist(), points.tolist(), self.path.headings.tolist(), strict=True
            ):
                writer.writerow([row, col, x, y, heading])
        return text.getvalue()

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Result:
        """Read a result that `save` wrote as JSON.

        Raises
        ------
        ResultFormatError
            No such file, not a result, of a newer version, or with a map that does not have the digest it claims.
        """
        file = as_path(path)
        try:
            with open_regular(file) as stream:
                content = stream.read()
        except OSError as error:
            raise ResultFormatError(
                f"file {file}", error.strerror or str(error), "name a file that `save` wrote"
            ) from error
        return _Document.read(content).result()


def _clearance(path: Path) -> str:
    if path.clearance == math.inf:
        return "no walls"
    return f"{path.clearance:.3f} m between cell centres, {path.wall_distance:.3f} m from the path to the walls' edges"


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None


@cache
def versions() -> dict[str, str]:
    """Versions that a result depends on."""
    from importlib.metadata import version

    return {"python": platform.python_version()} | {name: version(name) for name in ("antnav", "numpy", "numba")}


class _MapPart(msgspec.Struct):
    digest: str
    name: str
    rows: int
    cols: int
    resolution: float
    origin: tuple[float, float, float]
    cells: str = ""

    def grid(self) -> GridMap:
        if not (self.rows > 0 and self.cols > 0 and self.rows * self.cols <= MAX_CELLS):
            raise _unreadable(f"a map of {self.rows} x {self.cols} cells", "its size is out of range")
        size = self.rows * self.cols
        try:
            data = zlib.decompressobj().decompress(base64.b64decode(self.cells, validate=True), size + 1)
        except (ValueError, zlib.error) as error:
            raise _unreadable("the map", "its cells cannot be decoded") from error
        if len(data) != size:
            raise _unreadable("the map", f"it should have {size} cells")
        grid = GridMap(
            np.frombuffer(data, np.uint8).reshape(self.rows, self.cols), self.resolution, self.origin, self.name
        )
        if grid.digest != self.digest:
            raise _unreadable("the map", "its cells do not have the digest that the file states")
        return grid


class _ProblemPart(msgspec.Struct):
    map: _MapPart
    start: Point
    goal: Point
    corner_rule: CornerRule
    allow_unknown: bool
    goal_tolerance: float
    requested_goal: Point | None = None
    start_tolerance: float = 0.0
    requested_start: Point | None = None


class _Document(msgspec.Struct):
    """The JSON schema, as far as reading needs it; the other fields can be computed."""

    schema: str
    version: int
    status: Status
    stopped_by: StoppedBy
    length: Measure | None
    optimum: Measure | None
    seconds_run: Measure
    seconds_compile: Measure
    seconds_exact: Measure
    cpu_seconds: Measure
    seed: int
    path: list[tuple[int, int]] | None
    auxiliary_cell: CellIndex | None
    algorithm: Algorithm
    problem: _ProblemPart
    stages: tuple[Stage, ...]
    history: dict[str, list[Measure | None]]
    stop: str | None
    notes: tuple[str, ...]
    versions: dict[str, str]

    @classmethod
    def read(cls, content: bytes) -> _Document:
        try:
            head = msgspec.json.decode(content)
            if not isinstance(head, dict) or head.get("schema") != SCHEMA:
                raise _unreadable("the file", f"it does not say that it is {SCHEMA}")
            if head.get("version") != VERSION:
                raise _unreadable(f"version {head.get('version')!r}", f"this antnav reads version {VERSION}")
            return msgspec.convert(head, cls)
        except (msgspec.MsgspecError, UnicodeDecodeError, RecursionError) as error:
            raise _unreadable("the file", str(error)) from error
        except ParameterError as error:
            raise _unreadable("the algorithm", str(error)) from error

    def result(self) -> Result:
        try:
            grid = self.problem.map.grid()
            problem = Problem(
                grid,
                self.problem.requested_start or self.problem.start,
                self.problem.requested_goal or self.problem.goal,
                self.problem.corner_rule,
                self.problem.allow_unknown,
                self.problem.goal_tolerance,
                self.problem.start_tolerance,
            )
            history = History(*(self._column(name) for name in History._fields))
            path = None if self.path is None else Path(np.array(self.path), grid, problem.start, problem.goal)
            if path is not None:
                check_path(path, problem)
            self._check(problem, path, history)
        except ResultFormatError:
            raise
        except (AntnavError, KeyError, ValueError, OverflowError) as error:
            raise _unreadable("the file", str(error)) from error
        return Result(
            self.status,
            self.stopped_by,
            problem,
            self.algorithm,
            self.seed,
            path,
            self.auxiliary_cell,
            self.stages,
            history,
            None,
            self.stop,
            self.notes,
            self.seconds_run,
            self.seconds_compile,
            self.cpu_seconds,
            self.versions,
            (math.inf if self.optimum is None else self.optimum, self.seconds_exact),
        )

    def _column(self, name: str) -> NDArray[Any]:
        missing = math.inf if name in {"best", "iteration_best"} else math.nan
        values = np.array([missing if value is None else value for value in self.history[name]], np.float64)
        if name not in COUNTS:
            return read_only(values)
        if (values % 1 != 0).any():
            raise _unreadable(f"{name} in the history", "these are whole numbers")
        return read_only(values.astype(np.int64))

    def _check(self, problem: Problem, path: Path | None, history: History) -> None:
        """Refuse what cannot be true together."""
        check_seed(self.seed)
        if (path is not None) != (self.status is Status.FOUND):
            raise _unreadable(f"status {self.status}", "a path goes with the status found, and with no other")
        if path is None and problem.connected == (self.status is Status.UNREACHABLE):
            raise _unreadable(f"status {self.status}", "whether a path exists is another matter on this map")
        self._check_lengths(problem, path)
        if len({len(column) for column in history}) != 1:
            raise _unreadable("the history", "its columns are of different lengths")
        done = sum(max((colony.iterations for colony in stage.colonies), default=0) for stage in self.stages)
        steps = sum(colony.steps for stage in self.stages for colony in stage.colonies)
        if (done, steps) != (len(history.best), history.steps.sum()):
            raise _unreadable("the history", f"it is of {done} iterations and {steps} steps, as the stages say")
        ends = [end for stage in self.stages for colony in stage.colonies for end in (colony.start, colony.goal)]
        for end in ends:
            if not problem.grid.contains(end):
                raise _unreadable(f"end of a colony {end}", "it lies outside the map")
        if self.auxiliary_cell is not None and not problem.grid.contains(self.auxiliary_cell):
            raise _unreadable(f"auxiliary cell {self.auxiliary_cell}", "it lies outside the map")

    def _check_lengths(self, problem: Problem, path: Path | None) -> None:
        length = math.inf if path is None else path.length
        if not math.isclose(math.inf if self.length is None else self.length, length, rel_tol=1e-9):
            raise _unreadable(f"length {self.length}", f"the moves of the path add up to {length}")
        if (self.optimum is None) != (self.status is Status.UNREACHABLE):
            raise _unreadable(f"optimum {self.optimum}", "there is one where a path exists, and only there")
        straight = math.dist(problem.start_cell, problem.goal_cell)
        if self.optimum is not None and not straight * (1 - 1e-9) <= self.optimum <= length * (1 + 1e-9):
            raise _unreadable(
                f"optimum {self.optimum}", f"it lies between {straight}, straight, and {length}, the path"
            )


def _unreadable(given: str, rule: str) -> ResultFormatError:
    return ResultFormatError(given, rule, "use a file that Result.save wrote with this version of antnav")
