"""Front: paths that no other beats, with their values."""

from __future__ import annotations

import csv
import io
import os
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Self

import msgspec
import numpy as np
from numpy.typing import ArrayLike, NDArray

from antnav.errors import AntnavError, ParameterError, ResultFormatError, shown
from antnav.files import as_path, write_whole
from antnav.planner.document import ProblemPart, content_of, decoded, unreadable
from antnav.planner.plan import Measure, Status, StoppedBy
from antnav.values import finite_row, read_only
from antnav.world.path import Path, check_path
from antnav.world.problem import CellIndex, Problem

SCHEMA = "antnav/front"
VERSION = 1
#: Paths of a front in a notebook; the others are counted.
MOST_SHOWN = 12


class ObjectivePart(msgspec.Struct, frozen=True):
    """An objective as a file names it: its name, its unit, and the whole step that searches counted in."""

    name: str
    unit: str
    step: float

    @property
    def label(self) -> str:
        """Name and unit."""
        return f"{self.name} [{self.unit}]" if self.unit else self.name


class Document(msgspec.Struct, kw_only=True):
    """A file of a front."""

    schema: str = SCHEMA
    version: int = VERSION
    status: Status
    stopped_by: StoppedBy
    complete: bool
    objectives: tuple[ObjectivePart, ...]
    values: list[tuple[float, ...]]
    paths: list[list[CellIndex]]
    method: dict[str, Any]
    certainty: str
    seed: int
    work: dict[str, int]
    stop: str | None
    notes: tuple[str, ...]
    problem: ProblemPart
    seconds_run: Measure
    seconds_compile: Measure
    versions: dict[str, str]


@dataclass(frozen=True, eq=False, kw_only=True)
class Front:
    """Outcome of `antnav.pareto`: paths, none of which is beaten by another in all objectives.

    Path i has the values `values[i]`; paths are sorted by their values, the first objective first.

    Attributes
    ----------
    status : Status
        "found", or "unreachable" where no path exists.
    stopped_by : StoppedBy
    complete : bool
        Whether these are all: every vector of the true front is there, counted in the objectives' whole steps.
    problem : Problem
    objectives : tuple of ObjectivePart
        Name, unit and step of each.
    values : ndarray of float64, shape (p, k)
        In the objectives' units, added up move by move; less is better. Read-only.
    paths : tuple of Path
    method : dict
        Name and parameters of the method.
    certainty : str
        Where the method comes from.
    seed : int
    work : dict
        What was done, by name, such as labels or searches.
    stop : str or None
        The stopping criterion as text.
    notes : tuple of str
        What a reader must know.
    seconds_run, seconds_compile : float
    versions : dict
    """

    status: Status
    stopped_by: StoppedBy
    complete: bool
    problem: Problem
    objectives: tuple[ObjectivePart, ...]
    values: NDArray[np.float64]
    paths: tuple[Path, ...]
    method: dict[str, Any]
    certainty: str
    seed: int
    work: dict[str, int]
    stop: str | None = None
    notes: tuple[str, ...] = ()
    seconds_run: float = 0.0
    seconds_compile: float = 0.0
    versions: dict[str, str]

    def __setstate__(self, state: dict[str, Any]) -> None:
        read_only(state["values"])  # pickling drops the flag
        self.__dict__.update(state)

    def __len__(self) -> int:
        return len(self.paths)

    def __repr__(self) -> str:
        names = ", ".join(objective.label for objective in self.objectives)
        whole = "complete" if self.complete else "not known to be complete"
        return f"Front({len(self)} paths, {names}, {self.method['name']}, {whole})"

    def _repr_html_(self) -> str:
        from antnav.markup import table_html

        head, *rows = self.table
        return table_html(repr(self), head, rows[:MOST_SHOWN], len(rows))

    @cached_property
    def ideal(self) -> NDArray[np.float64]:
        """Least value of each objective over the paths, shape (k,)."""
        return read_only(self.values.min(axis=0, initial=np.inf))

    @cached_property
    def nadir(self) -> NDArray[np.float64]:
        """Largest value of each objective over the paths, shape (k,)."""
        return read_only(self.values.max(axis=0, initial=-np.inf))

    @property
    def normalised(self) -> NDArray[np.float64]:
        """Values between 0 at `ideal` and 1 at `nadir`, shape (p, k)."""
        scaled: NDArray[np.float64] = (self.values - self.ideal) / np.where(
            self.nadir > self.ideal, self.nadir - self.ideal, 1.0
        )
        return scaled

    def best(self, weights: ArrayLike) -> int:
        """Number of the path whose weighted sum of values, in their units, is least; of equal ones the first.

        Parameters
        ----------
        weights : array_like, shape (k,)
            Finite, >= 0, not all 0.

        Raises
        ------
        ParameterError
            Other weights, or a front without paths.
        """
        self._check_found()
        given = finite_row("weights", weights, len(self.objectives))
        if not ((given >= 0).all() and given.any()):
            raise ParameterError(f"weights {shown(weights)}", "they are >= 0, and not all 0", "give such as [1, 0.5]")
        return int(np.argmin(self.values @ (given / given.max())))

    def knee(self) -> int:
        """Number of the path where giving up a little of one objective no longer saves much of another.

        The one farthest below the plane through the ends of the front, all ranges scaled to 1 (Das 1999): that whose
        normalised values have the least sum.

        Raises
        ------
        ParameterError
            A front without paths.
        """
        self._check_found()
        return int(np.argmin(self.normalised.sum(axis=1)))

    def hypervolume(self, reference: ArrayLike) -> float:
        """Volume that the front beats, up to a reference point (Zitzler & Thiele 1998), by the library moocore.

        Comparable between fronts only for one reference. It depends on units: compare shares of one front's.

        Parameters
        ----------
        reference : array_like, shape (k,)
            In the objectives' units; what is not below it in each counts nothing.

        Raises
        ------
        ParameterError
            No such point, or moocore is not installed (``pip install "antnav[fronts]"``).
        """
        from antnav.fronts import indicators

        return indicators.hypervolume(self.values, reference)

    @property
    def table(self) -> list[tuple[str, ...]]:
        """A header and a row for each path: its number, and its values; "knee" behind the one."""
        rows = [("path", *(objective.label for objective in self.objectives), "")]
        knee = self.knee() if len(self) else -1
        for number, values in enumerate(self.values.tolist()):
            rows.append((str(number), *(f"{value:.6g}" for value in values), "knee" if number == knee else ""))
        return rows

    def summary(self) -> str:
        """What was found in a few lines, and the table."""
        lines = [f"{name:<12} {text}" for name, text in self.account]
        widths = [max(map(len, column)) for column in zip(*self.table, strict=True)]
        lines += [
            "  ".join(text.rjust(width) for text, width in zip(row, widths, strict=True)).rstrip() for row in self.table
        ]
        return "\n".join(lines)

    @property
    def account(self) -> list[tuple[str, str]]:
        """How it was found, as pairs of name and text."""
        whole = "complete" if self.complete else "not known to be complete"
        ending = "" if self.stopped_by is StoppedBy.SCHEDULE else f" (stopped: {self.stop or self.stopped_by})"
        rows = [
            ("status", self.status.replace("_", " ") + ending),
            ("front", f"{len(self)} path{'s' * (len(self) != 1)}, {whole}"),
            ("counted in", ", ".join(f"{each.name}: {each.step:.4g} {each.unit}".strip() for each in self.objectives)),
            ("work", ", ".join(f"{count} {name}" for name, count in self.work.items())),
            ("seconds", f"{self.seconds_run:.4f} run, {self.seconds_compile:.2f} compile"),
            ("method", f"{self.method['name']}, seed {self.seed}"),
            ("certainty", self.certainty),
        ]
        return rows + [("note", note) for note in self.notes]

    def _check_found(self) -> None:
        if not len(self):
            raise ParameterError("a front without paths", "no path leads from the start to the goal", "look at status")

    def document(self, *, map_cells: bool = True) -> Document:
        """The front as what a file says."""
        return Document(
            objectives=self.objectives,
            values=[tuple(row) for row in self.values.tolist()],
            paths=[path.cells.tolist() for path in self.paths],
            problem=ProblemPart.of(self.problem, map_cells=map_cells),
            **{name: getattr(self, name) for name in _KEPT},
        )

    def to_dict(self, *, map_cells: bool = True) -> dict[str, Any]:
        """The front as JSON types; see `Result.to_dict`."""
        found: dict[str, Any] = msgspec.to_builtins(self.document(map_cells=map_cells))
        return found

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the front, whole or not at all: ".json" everything, see `load`; ".csv" the values, a line a path.

        Raises
        ------
        ParameterError
            Another ending.
        OutputError
            The file cannot be written.
        """
        name = as_path(path).name
        if name.lower().endswith(".json"):
            write_whole(path, msgspec.json.format(msgspec.json.encode(self.document()), indent=1) + b"\n")
        elif name.lower().endswith(".csv"):
            text = io.StringIO()
            writer = csv.writer(text, lineterminator="\n")
            writer.writerow(["path", *(objective.label for objective in self.objectives)])
            writer.writerows([number, *values] for number, values in enumerate(self.values.tolist()))
            write_whole(path, text.getvalue().encode())
        else:
            raise ParameterError(f"file name {name}", "fronts are saved as .json or .csv", "choose one of them")

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Self:
        """Read a front that `save` wrote as JSON. Paths are checked against the map, values are taken as they stand.

        Raises
        ------
        ResultFormatError
            No such file, no front, of a newer version, or one that cannot be true.
        """
        document = decoded(content_of(path), Document, SCHEMA, VERSION)
        try:
            problem = document.problem.problem()
            paths = tuple(Path(np.array(cells), problem.grid, problem.start, problem.goal) for cells in document.paths)
            for each in paths:
                check_path(each, problem)
        except ResultFormatError:
            raise
        except (AntnavError, ValueError) as error:
            raise unreadable("the file", str(error)) from error
        k = len(document.objectives)
        if len(paths) != len(document.values) or any(len(row) != k for row in document.values):
            raise unreadable("the values", f"there are {k} for each of {len(paths)} paths")
        if bool(paths) != (document.status is Status.FOUND):
            raise unreadable(f"status {document.status}", "paths go with the status found, and with no other")
        return cls(
            problem=problem,
            objectives=document.objectives,
            values=read_only(np.array(document.values, np.float64).reshape(-1, k)),
            paths=paths,
            **{name: getattr(document, name) for name in _KEPT},
        )


#: Fields that a front shares with its document.
_KEPT: Sequence[str] = tuple(
    set(Document.__struct_fields__) - {"schema", "version", "objectives", "values", "paths", "problem"}
)
