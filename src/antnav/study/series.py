"""What a study's figures show, gathered from records."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from antnav.report import statistics
from antnav.study.groups import lengths
from antnav.study.model import Sweep
from antnav.study.record import Record
from antnav.world.grid import Cell
from antnav.world.problem import CellIndex, Problem

MOST_CURVES = 7  #: More in one panel cannot be told apart: the best of them are shown.


@dataclass(frozen=True, eq=False)
class Band:
    """One quantity of an algorithm by iteration, over its runs: the mean, and the quartiles.

    The mean is of the finite values, nan where less than half of the runs have one. Quartiles are of all runs and may
    be infinite. `arrived` counts the runs that end with a finite value.
    """

    iteration: NDArray[np.int64]
    mean: NDArray[np.float64]
    low: NDArray[np.float64]
    high: NDArray[np.float64]
    arrived: int


def band(series: Sequence[Sequence[float | None]]) -> Band:
    """Gather runs, one series each, None standing for inf; a run that ended earlier keeps its last value."""
    longest = max((len(values) for values in series), default=0)
    if longest == 0:
        empty = np.empty(0)
        return Band(np.empty(0, np.int64), empty, empty, empty, 0)
    rows = [[math.inf if value is None else float(value) for value in values] for values in series if len(values)]
    table = np.array([values + values[-1:] * (longest - len(values)) for values in rows])
    known = np.isfinite(table)
    count = known.sum(axis=0)
    mean = np.where(known, table, 0.0).sum(axis=0) / np.maximum(count, 1)
    low, high = statistics.quantiles(table, (0.25, 0.75))
    number = np.arange(1, longest + 1, dtype=np.int64)
    return Band(number, np.where(2 * count >= len(table), mean, np.nan), low, high, int(count[-1]))


def best_bands(group: Mapping[str, Sequence[Record]], names: Sequence[str]) -> dict[str, Band]:
    """Best length so far by iteration."""
    return {name: band([run.best for run in group[name]]) for name in names if name in group}


def lost_bands(group: Mapping[str, Sequence[Record]], names: Sequence[str]) -> dict[str, Band]:
    """Lost ants by iteration."""
    return {name: band([run.lost for run in group[name]]) for name in names if name in group}


def best_run(runs: Sequence[Record]) -> Record | None:
    """The run with the shortest path, of these the first seed; None where no run has a path."""
    arrived = [run for run in runs if run.path is not None and run.cost is not None]
    return min(arrived, key=lambda run: (round(run.cost or 0.0, 9), run.seed), default=None)


def leaders(group: Mapping[str, Sequence[Record]]) -> list[str]:
    """The algorithms of a group, or where they are many the best `MOST_CURVES`, in the group's order.

    Best is the shortest median; where medians are equal, the shortest mean; where these are too, the group's order.
    """
    merits = {name: _merit(runs) for name, runs in group.items()}
    best = sorted(group, key=lambda name: merits[name])[:MOST_CURVES]
    return [name for name in group if name in best]


def _merit(runs: Sequence[Record]) -> tuple[float, float]:
    """Median and mean length, a missing path counting as infinitely long."""
    values = np.round(np.asarray(lengths(runs)) / statistics.TIE) * statistics.TIE
    return float(statistics.quantiles(values, (0.5,))[0]), round(float(values.mean()), 9)


def equals_left_out(group: Mapping[str, Sequence[Record]]) -> int:
    """How many algorithms outside `leaders` are as good as one in it."""
    shown = leaders(group)
    merits = {name: _merit(group[name]) for name in group}
    worst = max(merits[name] for name in shown)
    return sum(merits[name] == worst for name in group if name not in shown)


def choice_of_leaders(group: Mapping[str, Sequence[Record]]) -> str:
    """Which algorithms of a crowd are shown, in words; empty where all are."""
    if len(group) <= MOST_CURVES:
        return ""
    more = equals_left_out(group)
    others = f"; as good as the last of them, but later in the study: {more} more" if more else ""
    return f"{MOST_CURVES} of {len(group)} algorithms, those with the shortest median, then mean{others}"


def beside(points: NDArray[np.float64], shift: float) -> NDArray[np.float64]:
    """A line moved sideways, so that paths through the same cells are seen side by side."""
    if len(points) < 2:
        return points
    along = np.gradient(points, axis=0)
    length = np.linalg.norm(along, axis=1, keepdims=True)
    across = np.stack((-along[:, 1], along[:, 0]), axis=1) / np.where(length > 0, length, 1)
    return points + shift * across


MARGIN = 0.03  #: Around what is shown of a map, in parts of its longer side.


def shown_part(problem: Problem, paths: Sequence[Sequence[CellIndex]]) -> tuple[CellIndex, CellIndex] | None:
    """Bottom left and top right cell of what is worth seeing: known cells, ends, paths; None: the whole map.

    A map from a robot lies in a field of unknown cells, many times as large.
    """
    known = problem.grid.cells != Cell.UNKNOWN
    if known.all():
        return None
    walked = np.array([problem.start_cell, problem.goal_cell, *(cell for path in paths for cell in path)])
    rows, cols = (np.concatenate((np.flatnonzero(known.any(axis=1 - axis)), walked[:, axis])) for axis in (0, 1))
    more = max(1, round(MARGIN * max(np.ptp(rows), np.ptp(cols))))
    top, left = max(0, int(rows.min()) - more), max(0, int(cols.min()) - more)
    bottom = min(problem.grid.rows - 1, int(rows.max()) + more)
    return (bottom, left), (top, min(problem.grid.cols - 1, int(cols.max()) + more))


@dataclass(frozen=True)
class Plane:
    """A sweep's algorithms over one parameter, x, or two; with y None, over x alone.

    `points` holds their parameters by label, as far as these are numbers; those in `averaged` vary besides x and y.
    """

    name: str
    points: Mapping[str, Mapping[str, float]]
    x: str
    y: str | None
    averaged: tuple[str, ...] = ()


def planes(sweep: Sweep) -> list[Plane]:
    """Each pair of a sweep's parameters by itself; those that are no numbers are part of the name."""
    families: dict[str, dict[str, dict[str, float]]] = {}
    for label, values in sweep.points.items():
        numbers = {key: float(value) for key, value in values.items() if _is_number(value)}
        name = " ".join([sweep.name, *(f"{key}={value}" for key, value in values.items() if key not in numbers)])
        families.setdefault(name, {})[label] = numbers
    found = []
    for name, points in families.items():
        keys = next(iter(points.values()))
        varied = [key for key in keys if len({point[key] for point in points.values()}) > 1]
        pairs: list[tuple[str, str | None]] = list(combinations(varied, 2)) or [(key, None) for key in varied]
        found += [Plane(name, points, x, y, tuple(key for key in varied if key not in (x, y))) for x, y in pairs]
    return found


def _is_number(value: float | str) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


@dataclass(frozen=True, eq=False)
class SweepGrid:
    """Mean gap in per cent, and share of runs without a path, over two parameters; rows are y; nan: no runs."""

    xs: list[float]
    ys: list[float]
    gap: NDArray[np.float64]
    missing: NDArray[np.float64]


def sweep_grid(records: Sequence[Record], plane: Plane) -> SweepGrid:
    """Gather what `draw_sweep` shows; the gap is of the runs with a path."""
    places = {label: (point[plane.x], point[plane.y] if plane.y else 0.0) for label, point in plane.points.items()}
    xs, ys = (sorted({place[axis] for place in places.values()}) for axis in (0, 1))
    gaps: dict[tuple[int, int], list[float | None]] = {}
    for record in records:
        if record.algorithm in places:
            x, y = places[record.algorithm]
            gaps.setdefault((ys.index(y), xs.index(x)), []).append(record.gap)
    gap, missing = np.full((len(ys), len(xs)), np.nan), np.full((len(ys), len(xs)), np.nan)
    for cell, values in gaps.items():
        arrived = [100 * value for value in values if value is not None]
        gap[cell] = sum(arrived) / len(arrived) if arrived else np.nan
        missing[cell] = 1 - len(arrived) / len(values)
    return SweepGrid(xs, ys, gap, missing)
