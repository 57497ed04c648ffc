"""Document: a result as JSON types, the one schema for writing and reading."""

from __future__ import annotations

import base64
import csv
import io
import math
import os
import zlib
from collections.abc import Callable
from typing import Any, Protocol, TypeVar

import msgspec
import numpy as np
from msgspec import UNSET, UnsetType
from numpy.typing import NDArray

from antnav.errors import AntnavError, ParameterError, ResultFormatError
from antnav.files import as_path, open_regular
from antnav.kernels.ant_kernels import COUNTS, History
from antnav.planner import planner
from antnav.planner.plan import Measure, Stage, Status, StoppedBy
from antnav.planner.planner import Planner
from antnav.values import check_seed, read_only
from antnav.world.cost import CostField, Slope
from antnav.world.grid import MAX_CELLS, GridMap
from antnav.world.moves import CornerRule
from antnav.world.path import Path
from antnav.world.problem import CellIndex, Point, Problem

SCHEMA = "antnav/result"
VERSION = 1


class MapPart(msgspec.Struct, kw_only=True):
    """A map, its cells compressed; a file without cells cannot be loaded again."""

    digest: str
    name: str
    rows: int
    cols: int
    resolution: float
    origin: tuple[float, float, float]
    cells: str | UnsetType = UNSET
    covered: str | UnsetType = UNSET  #: bits, where any cell is

    @classmethod
    def of(cls, grid: GridMap, *, cells: bool) -> MapPart:
        """The part of that map."""
        return cls(
            digest=grid.digest,
            name=grid.name.encode(errors="replace").decode(),  # a file name need not be text
            rows=grid.rows,
            cols=grid.cols,
            resolution=grid.resolution,
            origin=grid.origin,
            cells=_packed(grid.cells.tobytes()) if cells else UNSET,
            covered=UNSET if grid.covered is None or not cells else _packed(np.packbits(grid.covered).tobytes()),
        )

    def grid(self) -> GridMap:
        """The map, if it has the digest that the file states."""
        if not (self.rows > 0 and self.cols > 0 and self.rows * self.cols <= MAX_CELLS):
            raise unreadable(f"a map of {self.rows} x {self.cols} cells", "its size is out of range")
        size = self.rows * self.cols
        shape = self.rows, self.cols
        data = _unpacked("the map", self.cells, size)
        covered = None
        if self.covered is not UNSET:
            bits = np.frombuffer(_unpacked("the map's covered cells", self.covered, -(-size // 8)), np.uint8)
            covered = np.unpackbits(bits, count=size).reshape(shape).astype(np.bool_)
        grid = GridMap(np.frombuffer(data, np.uint8).reshape(shape), self.resolution, self.origin, self.name, covered)
        if grid.digest != self.digest:
            raise unreadable("the map", "its cells do not have the digest that the file states")
        return grid


class CostPart(msgspec.Struct, kw_only=True):
    """A cost field, compressed; float64 in map order, then a byte for each cell that is blocked."""

    digest: str
    name: str
    values: str | UnsetType = UNSET
    elevation: str | UnsetType = UNSET
    up: float | UnsetType = UNSET
    down: float | UnsetType = UNSET

    @classmethod
    def of(cls, cost: CostField, *, cells: bool) -> CostPart:
        """The part of that field."""
        part = cls(digest=cost.digest, name=cost.name)
        if cells:
            part.values = _packed(cost.values.tobytes() + cost.blocked.tobytes())
        if cost.slope:
            part.up, part.down = cost.slope.up, cost.slope.down
            part.elevation = _packed(cost.slope.elevation.tobytes()) if cells else UNSET
        return part

    def field(self, shape: tuple[int, int]) -> CostField:
        """The field, if it has the digest that the file states."""
        size = shape[0] * shape[1]
        data = _unpacked("the costs", self.values, 9 * size)
        values, blocked = np.frombuffer(data[: 8 * size]), np.frombuffer(data[8 * size :], np.bool_)
        slope = None
        if self.elevation is not UNSET:
            heights = np.frombuffer(_unpacked("the elevation", self.elevation, 8 * size))
            slope = Slope(heights.reshape(shape), self.up or 0.0, self.down or 0.0)
        field = CostField(values.reshape(shape), blocked.reshape(shape), self.name, slope)
        if field.digest != self.digest:
            raise unreadable("the costs", "they do not have the digest that the file states")
        return field


class ProblemPart(msgspec.Struct, kw_only=True):
    """A problem; the ends are those after any tolerance, the requested ones those before.

    What may be missing follows from the rest, see `Document`.
    """

    map: MapPart
    start: Point
    goal: Point
    start_cell: CellIndex | UnsetType | None = UNSET
    goal_cell: CellIndex | UnsetType | None = UNSET
    corner_rule: CornerRule
    allow_unknown: bool
    goal_tolerance: float
    start_tolerance: float = 0.0
    requested_goal: Point | None = None
    requested_start: Point | None = None
    cost: CostPart | None = None
    turning: float = 0.0

    @classmethod
    def of(cls, problem: Problem, *, map_cells: bool) -> ProblemPart:
        """The part of that problem."""
        same = {name: getattr(problem, name) for name in cls.__struct_fields__ if name not in ("map", "cost")}
        cost = None if problem.cost is None else CostPart.of(problem.cost, cells=map_cells)
        return cls(map=MapPart.of(problem.grid, cells=map_cells), cost=cost, **same)

    def problem(self) -> Problem:
        """The problem, asked again."""
        grid = self.map.grid()
        return Problem(
            grid,
            self.requested_start or self.start,
            self.requested_goal or self.goal,
            self.corner_rule,
            self.allow_unknown,
            self.goal_tolerance,
            self.start_tolerance,
            None if self.cost is None else self.cost.field(grid.shape),
            self.turning,
        )


class Document(msgspec.Struct, kw_only=True):
    """A result file. Infinities and nan are None.

    What may be missing (UNSET) follows from the rest: it is written for readers, and compared where a file has it.
    """

    schema: str = SCHEMA
    version: int = VERSION
    status: Status
    stopped_by: StoppedBy
    length: Measure | UnsetType | None = UNSET
    length_m: Measure | UnsetType | None = UNSET
    cost: Measure | UnsetType | None = UNSET
    optimum: Measure | None
    gap: float | UnsetType | None = UNSET
    turns: int | UnsetType | None = UNSET
    turning_angle: Measure | UnsetType | None = UNSET
    clearance_m: Measure | UnsetType | None = UNSET
    wall_distance_m: Measure | UnsetType | None = UNSET
    seconds_run: Measure
    seconds_compile: Measure
    seconds_exact: Measure
    cpu_seconds: Measure
    seed: int
    path: list[CellIndex] | None
    path_m: list[Point] | UnsetType | None = UNSET
    auxiliary_cell: CellIndex | None
    algorithm: dict[str, Any]
    problem: ProblemPart
    stages: tuple[Stage, ...]
    history: dict[str, list[float | None]]
    estimated: bool | UnsetType = UNSET
    stop: str | None
    notes: tuple[str, ...]
    versions: dict[str, str]

    @classmethod
    def read(cls, content: bytes) -> Document:
        """The document in a file's content.

        Raises
        ------
        ResultFormatError
            It is none, or of a newer version.
        """
        return decoded(content, cls, SCHEMA, VERSION)

    def planner(self) -> Planner:
        """The planner that the file names."""
        try:
            return planner.read(self.algorithm)
        except (AntnavError, msgspec.MsgspecError, KeyError, TypeError, ValueError) as error:
            raise unreadable("the algorithm", str(error)) from error

    def is_estimated(self) -> bool:
        """Whether the history's lengths only estimate: of ants, those on a graph of regions do."""
        coarse = self.algorithm.get("coarse")
        if self.algorithm.get("kind", "ants") != "ants":
            return self.estimated is True
        if self.estimated is not UNSET and self.estimated != bool(coarse):
            raise unreadable(f"estimated {self.estimated}", f"with coarse {coarse} it is {bool(coarse)}")
        return bool(coarse)

    def columns(self) -> History:
        """The history."""
        try:
            columns = [_column(name, self.history[name]) for name in History._fields]
        except KeyError as error:
            raise unreadable("the history", f"it has no {error}") from error
        if len({len(column) for column in columns}) != 1:
            raise unreadable("the history", "its columns are of different lengths")
        return History(*columns)

    def check_derived(self, again: Document) -> None:
        """Compare what follows from other fields with the document that these make.

        Raises
        ------
        ResultFormatError
            They differ.
        """
        for one, other in ((self, again), (self.problem, again.problem)):
            for field in msgspec.structs.fields(one):
                given, found = getattr(one, field.name), getattr(other, field.name)
                if field.default is UNSET and given is not UNSET and not same(given, found):
                    raise unreadable(f"{field.name} {_short(given)}", f"the rest of the file makes it {_short(found)}")


class Seeded(Protocol):
    """A document of something that was drawn from a seed."""

    seed: int


Drawn = TypeVar("Drawn", bound=Seeded)


def content_of(path: str | os.PathLike[str]) -> bytes:
    """A file, whole.

    Raises
    ------
    ResultFormatError
        It cannot be read.
    """
    file = as_path(path)
    try:
        with open_regular(file) as stream:
            return stream.read()
    except OSError as error:
        rule = error.strerror or str(error)
        raise ResultFormatError(f"file {file}", rule, "name a file that `save` wrote") from error


def decoded(content: bytes, kind: type[Drawn], schema: str, version: int) -> Drawn:
    """The document of that kind in a file's content.

    Raises
    ------
    ResultFormatError
        It is none, or of another version.
    """
    try:
        head = msgspec.json.decode(content)
        if not isinstance(head, dict) or head.get("schema") != schema:
            raise unreadable("the file", f"it does not say that it is {schema}")
        if head.get("version") != version:
            raise unreadable(f"version {head.get('version')!r}", f"this antnav reads version {version}")
        found = msgspec.convert(head, kind)
        check_seed(found.seed)
        return found
    except (msgspec.MsgspecError, UnicodeDecodeError, RecursionError, ParameterError) as error:
        raise unreadable("the file", str(error)) from error


def written(history: History) -> dict[str, list[float | None]]:
    """A history as JSON types."""
    return {
        name: [finite(value) for value in array.tolist()] for name, array in zip(History._fields, history, strict=True)
    }


def _packed(data: bytes) -> str:
    return base64.b64encode(zlib.compress(data, 6)).decode()


def _unpacked(what: str, text: str | UnsetType, size: int) -> bytes:
    """So many bytes that `_packed` wrote."""
    try:
        data = zlib.decompressobj().decompress(base64.b64decode(text or "", validate=True), size + 1)
    except (ValueError, zlib.error) as error:
        raise unreadable(what, "it cannot be decoded") from error
    if len(data) != size:
        raise unreadable(what, f"it should have {size} bytes")
    return data


def _column(name: str, given: list[float | None]) -> NDArray[Any]:
    missing = math.inf if name in {"best", "iteration_best"} else math.nan
    values = np.array([missing if value is None else value for value in given], np.float64)
    if (values < 0).any():
        raise unreadable(f"{name} in the history", "these are at least 0")
    if name not in COUNTS:
        return read_only(values)
    if not ((values % 1 == 0) & (values <= 2**53)).all():
        raise unreadable(f"{name} in the history", "these are whole numbers up to 2**53")
    return read_only(values.astype(np.int64))


def same(one: Any, other: Any) -> bool:
    """Whether two JSON values are equal, numbers up to what machines may differ in."""
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(same(value, other[key]) for key, value in one.items())
    if isinstance(one, list | tuple) and isinstance(other, list | tuple):
        return len(one) == len(other) and all(map(same, one, other))
    if isinstance(one, float | int) and isinstance(other, float | int):
        return math.isclose(one, other, rel_tol=1e-9, abs_tol=1e-9)
    return bool(one == other)


def _short(value: Any) -> str:
    return text if len(text := str(value)) <= 60 else text[:57] + "..."


def finite(value: float) -> float | None:
    """The number; None for an infinity or nan."""
    return value if math.isfinite(value) else None


def unreadable(given: str, rule: str) -> ResultFormatError:
    """The error of a file that cannot be what it says."""
    return ResultFormatError(given, rule, "use a file that this version of antnav has saved")


def csv_of(path: Path | None) -> str:
    """A path, one line a point: row, col, x and y in metres, heading in radians."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["row", "col", "x_m", "y_m", "heading_rad"])
    if path:
        points = path.points
        cells = path.cells.repeat(len(points) // len(path), axis=0)  # two points may share a cell
        for (row, col), (x, y), heading in zip(cells.tolist(), points.tolist(), path.headings.tolist(), strict=True):
            writer.writerow([row, col, x, y, heading])
    return text.getvalue()


def only_json(name: str, what: str, document: Callable[[], object], *, indent: int | None = 1) -> bytes:
    """What a file of that name says, where what is saved has one format.

    Parameters
    ----------
    what : str
        In the plural, for the error.
    indent : int or None
        Spaces a level; None: one line.

    Raises
    ------
    ParameterError
        The name has another ending than .json.
    """
    if not name.lower().endswith(".json"):
        raise ParameterError(f"file name {name}", f"{what} are saved as .json", "choose that")
    content = msgspec.json.encode(document())
    return (content if indent is None else msgspec.json.format(content, indent=indent)) + b"\n"


def encoded(name: str, document: Callable[[], Document], path: Path | None) -> bytes:
    """A result in the format that the ending of a file name asks for.

    Raises
    ------
    ParameterError
        There is none of that ending.
    """
    if name.lower().endswith(".json"):
        return only_json(name, "results", document)
    if name.lower().endswith(".csv"):
        return csv_of(path).encode()
    raise ParameterError(f"file name {name}", "results are saved as .json or .csv", "choose one of them")
