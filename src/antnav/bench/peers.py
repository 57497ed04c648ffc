"""antnav beside what else can be installed: each peer on each map in a process of its own."""

from __future__ import annotations

import importlib.util
import json
import math
import statistics
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from antnav.ants.presets import PRESETS
from antnav.bench.courses import Course
from antnav.bench.movingai import Progress, gap_of
from antnav.bench.output import Mark, Picture
from antnav.errors import ParameterError, PathError
from antnav.report.table import Column, Table
from antnav.search import exact
from antnav.world.path import check_path
from antnav.world.problem import Problem

#: The adapters of other planners: a program in antnav's source tree, and no part of the package.
ADAPTERS = Path(__file__).resolve().parents[3] / "benchmarks" / "peers"
ANY_ANGLE = "any angle"
#: Seconds between two looks at the cancel event, and for an interpreter to say what it has.
TICK, LISTING = 0.1, 60.0
#: Lengths of equal paths, added up in another order.
SAME_LENGTH = 1e-9
#: Of a path at any angle: samples a cell, and the share of a leg's samples that may graze blocked cells.
SAMPLES, GRAZING = 20, 0.02


@dataclass(frozen=True)
class Run:
    """One run of a peer: wall time from array to path and of the query alone, CPU time, and the verdict.

    `length` is inf without a valid path; `corner` is the strictest rule that the path keeps.
    """

    total: float
    query: float
    cpu: float
    length: float = math.inf
    corner: str = ""
    fault: str = ""


@dataclass(frozen=True, eq=False)
class Trial:
    """A peer on a map: its runs, and what else there is to say."""

    peer: str
    version: str
    course: Course
    runs: Sequence[Run]
    note: str = ""

    @property
    def corner(self) -> str:
        """The peer's corner rule: the one that it promises, unless a path was found that breaks it."""
        found = {run.corner for run in self.runs if run.corner}
        promised: str = peers()[self.peer].corner
        return max([promised, *found], key=("", "forbid", "allow", ANY_ANGLE).index)


@cache
def peers() -> dict[str, Any]:
    """The adapters by name; of antnav's own, those whose preset exists.

    Raises
    ------
    ParameterError
        They are not there: antnav was not installed from its source tree.
    """
    root = ADAPTERS / "__init__.py"
    spec = importlib.util.spec_from_file_location("antnav_peers", root, submodule_search_locations=[str(ADAPTERS)])
    if not root.is_file() or spec is None or spec.loader is None:
        rule = "the adapters of other planners are in antnav's source tree, benchmarks/peers, and not in the package"
        raise ParameterError("antnav bench peers", rule, "get the source tree, and pip install -e there")
    module = sys.modules[spec.name] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    own = {f"antnav-{name}" for name in ("astar", *PRESETS)}
    return {name: peer for name, peer in module.PEERS.items() if not name.startswith("antnav-") or name in own}


def check_peers(names: Sequence[str]) -> None:
    """Refuse names of no peer.

    Raises
    ------
    ParameterError
    """
    for name in names:
        if name not in peers():
            raise ParameterError(f"peer {name!r}", f"the peers are {', '.join(peers())}", "choose among them")


def installed(interpreters: Sequence[str]) -> dict[str, tuple[str, str]]:
    """Version and interpreter of every peer that one of the interpreters has; the first that has it counts.

    Raises
    ------
    ParameterError
        An interpreter does not run, or has no NumPy.
    """
    found: dict[str, tuple[str, str]] = {}
    for interpreter in interpreters:
        command = [interpreter, str(ADAPTERS), "list"]
        remedy = "name a Python with NumPy"
        try:
            answer = subprocess.run(command, capture_output=True, text=True, timeout=LISTING, check=False)
            versions = json.loads(answer.stdout) if answer.returncode == 0 else None
        except (OSError, ValueError, subprocess.TimeoutExpired) as error:
            raise ParameterError(f"interpreter {interpreter}", f"it does not run ({error})", remedy) from error
        if versions is None:
            raise ParameterError(f"interpreter {interpreter}", _last_line(answer.stderr), remedy)
        found = {name: (version, interpreter) for name, version in versions.items() if name in peers()} | found
    return found


def run(
    names: Sequence[str],
    courses: Sequence[Course],
    known: Mapping[str, tuple[str, str]],
    *,
    runs: int = 5,
    seed: int = 0,
    timeout: float = 120.0,
    cancel: threading.Event | None = None,
    progress: Progress | None = None,
) -> list[Trial]:
    """Run the peers that are installed.

    Parameters
    ----------
    names : sequence of str
    courses : sequence of Course
        From small to large: a peer that ran out of time is not tried on those that follow.
    known : mapping
        What `installed` found; peers that are not in it are left out.
    runs : int
        Of each peer on each map, with seeds that follow each other, after one that does not count. A peer that has
        spent half of the timeout begins no further run.
    seed : int
    timeout : float
        Seconds for a peer on a map, imports included; then its process ends.
    cancel, progress
        As in `movingai.run`; trials here, not searches.

    Raises
    ------
    ParameterError
        `runs` or `timeout` is out of range.
    """
    if runs < 1 or not timeout > 0:
        raise ParameterError(f"{runs} runs, timeout {timeout:g}", "both must be above 0", "give larger ones")
    cancel = cancel or threading.Event()
    todo = [name for name in names if name in known]
    trials: list[Trial] = []
    with tempfile.TemporaryDirectory(prefix="antnav-bench-") as folder:
        files = [_task_file(Path(folder) / f"{number}.npz", course) for number, course in enumerate(courses)]
        for name in todo:
            version, interpreter = known[name]
            lost = ""
            for file, course in zip(files, courses, strict=True):
                note = lost or _too_large(name, course)
                found: list[Run] = []
                if not note:
                    command = [interpreter, str(ADAPTERS), name, file, str(runs), str(seed), str(timeout / 2)]
                    lines, note = _lines(command, timeout, cancel)
                    if cancel.is_set():
                        return trials
                    found = [_judged(line, course) for line in lines]
                    lost = f"out of time on {course.name}" if note.startswith("out of time") else ""
                trials.append(Trial(name, version, course, found, note))
                if progress:
                    progress(len(trials), len(todo) * len(courses))
    return trials


def _task_file(path: Path, course: Course) -> str:
    np.savez(path, blocked=~course.grid.passable(unknown=False), start=course.start, goal=course.goal)
    return str(path)


def _too_large(name: str, course: Course) -> str:
    largest = peers()[name].largest
    return f"too large: above {largest} cells a side" if max(course.grid.rows, course.grid.cols) > largest else ""


def _lines(command: Sequence[str], timeout: float, cancel: threading.Event) -> tuple[list[dict[str, Any]], str]:
    """What a worker wrote, and what went wrong, if anything."""
    deadline = time.monotonic() + timeout
    note = ""
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, errors="replace")
    try:
        while True:
            try:
                out, err = process.communicate(timeout=TICK)
                break
            except subprocess.TimeoutExpired:
                late = time.monotonic() > deadline
                if late or cancel.is_set():
                    note = f"out of time after {timeout:g} s" if late else "cancelled"
                    process.kill()
    finally:
        process.kill()
    lines = [json.loads(line) for line in out.splitlines() if line.endswith("}")]  # a killed one may end in mid-line
    if process.returncode and not note:
        note = f"failed: {_last_line(err)}"
    return lines, note


def _last_line(text: str) -> str:
    return (text.strip().splitlines() or ["it said nothing"])[-1][:100]


# Judging paths


def _judged(line: Mapping[str, Any], course: Course) -> Run:
    times = line["total"], line["query"], line["cpu"]
    if not line["path"]:
        return Run(*times, fault="no path")
    try:
        length, corner = judge(line["path"], course)
    except PathError as error:
        return Run(*times, fault=f"invalid: {error.rule}")
    return Run(*times, length, corner)


def judge(points: Sequence[Sequence[float]], course: Course) -> tuple[float, str]:
    """Length of a path in cells and the strictest corner rule that it keeps, or "any angle".

    Parameters
    ----------
    points : sequence of (row, col)
        Cells that follow each other, or are joined by straight or diagonal lines; else a path at any angle.

    Raises
    ------
    PathError
        It does not join start and goal over free cells.
    """
    path = unit_steps(points)
    if path is None:
        return _any_angle(np.array(points, float), course), ANY_ANGLE
    for rule in ("forbid", "allow"):
        problem = Problem.from_cells(course.grid, course.start, course.goal, corner_rule=rule)
        try:
            return check_path(np.array(path), problem), rule
        except PathError as error:
            fault = error
    raise fault


def unit_steps(points: Sequence[Sequence[float]]) -> list[tuple[int, int]] | None:
    """All cells of a path that jumps along rows, columns and diagonals; None where it leaves these."""
    if not all(float(part).is_integer() for point in points for part in point):
        return None
    cells = [(int(row), int(col)) for row, col in points]
    path = cells[:1]
    for (row, col), (next_row, next_col) in pairwise(cells):
        rows, cols = next_row - row, next_col - col
        count = max(abs(rows), abs(cols))
        if min(abs(rows), abs(cols)) not in (0, count):
            return None
        path += [(row + step * rows // count, col + step * cols // count) for step in range(1, count + 1)]
    return path


def _any_angle(points: NDArray[np.float64], course: Course) -> float:
    if not (np.allclose(points[0], course.start) and np.allclose(points[-1], course.goal)):
        raise _broken(f"{points[0]} -> {points[-1]}", "it must lead from start to goal")
    free = np.pad(course.grid.passable(unknown=False), 1)
    for first, last in pairwise(points):
        count = max(2, int(math.dist(first, last) * SAMPLES))
        samples = np.rint(np.linspace(first, last, count)).astype(int) + 1
        inside = ((samples >= 0) & (samples < free.shape)).all(axis=1)
        hits = count - int(free[tuple(samples[inside].T)].sum())
        if hits > GRAZING * count + 2:
            raise _broken(f"leg {first} -> {last}", "it crosses blocked cells")
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())


def _broken(given: str, rule: str) -> PathError:
    return PathError(given, rule, "tell the peer's authors")


# Tables


def runs_table(trials: Sequence[Trial]) -> Table:
    """One row a run."""
    heads = ("peer", "version", "map", "run", "total ms", "query ms", "CPU ms", "length", "corner rule", "fault")
    rows = tuple(
        (
            *(trial.peer, trial.version, trial.course.name, number),
            *(1000 * run.total, 1000 * run.query, 1000 * run.cpu, run.length, run.corner, run.fault),
        )
        for trial in trials
        for number, run in enumerate(trial.runs)
    )
    return Table("runs", "Every run of every peer", tuple(Column(head) for head in heads), rows)


@dataclass(frozen=True)
class Row:
    """Medians of a trial, in milliseconds, cells and per cent; nan where there is nothing to say.

    The length is that of the runs with a valid path. The gap is to the optimum under the peer's corner rule; nan for
    paths at any angle, which may be shorter than any over the cells.
    """

    peer: str
    version: str
    map_label: str
    total: float
    query: float
    cpu: float
    length: float
    gap: float
    success: float
    corner: str
    note: str


def rows(trials: Sequence[Trial]) -> list[Row]:
    """A row for each trial."""
    optima: dict[tuple[int, str], float] = {}
    return [_row(trial, optima) for trial in trials]


def _row(trial: Trial, optima: dict[tuple[int, str], float]) -> Row:
    def median(values: Sequence[float]) -> float:
        return statistics.median(values) if values else math.nan

    valid = [run for run in trial.runs if not run.fault]
    length, gap = median([run.length for run in valid]), math.nan
    if valid and trial.corner != ANY_ANGLE:
        course, key = trial.course, (id(trial.course), trial.corner)
        if key not in optima:
            problem = Problem.from_cells(course.grid, course.start, course.goal, corner_rule=trial.corner)
            optima[key] = exact.shortest_path(problem).length
        gap = 100 * gap_of(length, optima[key], SAME_LENGTH)
    faults = dict.fromkeys(run.fault for run in trial.runs if run.fault)
    return Row(
        peer=trial.peer,
        version=trial.version,
        map_label=trial.course.name,
        total=1000 * median([run.total for run in trial.runs]),
        query=1000 * median([run.query for run in trial.runs]),
        cpu=1000 * median([run.cpu for run in trial.runs]),
        length=length,
        gap=gap,
        success=100 * len(valid) / len(trial.runs) if trial.runs else math.nan,
        corner=trial.corner,
        note="; ".join([*([trial.note] if trial.note else []), *faults]),
    )


_COLUMNS = (
    Column("peer"),
    Column("version"),
    Column("map"),
    Column("total ms", ".3f"),
    Column("query ms", ".3f"),
    Column("CPU ms", ".3f"),
    Column("length", ".3f"),
    Column("gap %", ".2f"),
    Column("success %", ".0f"),
    Column("corner rule"),
    Column("note"),
)


def summary(found: Sequence[Row], absent: Sequence[str]) -> Table:
    """The rows as a table, with the names of the peers that are not installed."""
    cells = tuple(tuple(getattr(row, name) for name in Row.__dataclass_fields__) for row in found)
    note = f"Not installed: {', '.join(absent)}." if absent else ""
    return Table("summary", "antnav and its peers", _COLUMNS, cells, note)


def picture(found: Sequence[Row]) -> Picture:
    """Gap and time of every peer, a series for each map."""
    marks: dict[str, dict[str, Mark]] = {}
    for row in found:
        gap = math.inf if row.success == 0 else row.gap
        marks.setdefault(row.map_label, {})[row.peer] = Mark(gap, math.nan, row.total)
    labels = ("gap under the peer's own corner rule (%); x: no path", "median time from array to path (ms)")
    return Picture(marks, *labels)


def interpreters(more: Sequence[str]) -> list[str]:
    """The interpreter that runs this, then the others."""
    return list(dict.fromkeys([sys.executable, *more]))
