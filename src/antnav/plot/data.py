"""What figures show, gathered without matplotlib: lengths by iteration, shades, the colour of each cell."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from antnav.planner.phases import Phase
from antnav.planner.plan import Status
from antnav.planner.result import Result
from antnav.world.grid import Cell, GridMap
from antnav.world.problem import Problem

#: Colours of the cells, in the order of `Cell`. In grey print they keep four steps: 100, 16, 91 and 74 %.
CELL_COLOURS = np.array([(255, 255, 255), (38, 41, 46), (240, 231, 205), (186, 189, 194)], np.uint8)
#: Colours of the shades 1/2 and 1: sky blue and blue of the palette in `antnav.plot.style`; for costs, its orange.
BLUES = np.array([(86, 180, 233), (0, 114, 178)], np.float32)
ORANGES = np.array([(246, 207, 128), (230, 159, 0)], np.float32)


@dataclass(frozen=True, eq=False)
class Convergence:
    """What a convergence figure shows: one value an iteration, lengths in cells, nan before any ant arrived.

    Attributes
    ----------
    iteration : ndarray of int64
        1, 2, ...
    best, iteration_best, mean : ndarray of float64
        Best so far, best of the iteration, mean of the ants that arrived in it. Of a divided problem: in stage one the
        better colony (the mean: of both), in stage two the sum over the parts, so `best` may jump between them.
    stage_one : int
        How many of the iterations belong to stage one; 0 where the problem was not divided.
    divided : bool
        Whether stage two took place.
    optimum : float
        Length of a shortest path; inf where none exists, or where the lengths are estimates.
    length : float
        Length of the path that was returned; inf without one, or where the lengths are estimates. A repaired join may
        be shorter than `best`.
    estimated : bool
        Whether the lengths of the iterations are lengths on a graph of regions, not on cells.
    quantity : str
        "length", or "cost" where the problem has costs: then all lengths are costs.
    """

    iteration: NDArray[np.int64]
    best: NDArray[np.float64]
    iteration_best: NDArray[np.float64]
    mean: NDArray[np.float64]
    stage_one: int
    divided: bool
    optimum: float
    length: float
    estimated: bool
    quantity: str = "length"

    @property
    def stages(self) -> list[slice]:
        """The iterations of each stage; values of different stages are not joined by a line."""
        parts = [slice(0, self.stage_one), slice(self.stage_one, len(self.iteration))]
        return [part for part in parts if part.stop > part.start]


def convergence(result: Result) -> Convergence:
    """Gather what `plot_convergence` draws."""
    history = result.history
    best, iteration_best, mean = (
        np.where(np.isfinite(values), values, np.nan) for values in (history.best, history.iteration_best, history.mean)
    )
    stages = [stage for stage in result.stages if stage.colonies]
    names = [stage.name for stage in stages]
    divided = names[-1:] == [Phase.STAGE_TWO]
    stage_one = 0
    if divided:  # earlier attempts at stage one, in which no ant arrived, have left no history
        stage_one = max(colony.iterations for colony in stages[-2].colonies)
    elif names[-1:] == [Phase.STAGE_ONE]:
        stage_one = len(best)
    number = np.arange(1, len(best) + 1, dtype=np.int64)
    estimated = result.estimated
    optimum, length = (math.inf, math.inf) if estimated else (result.optimum, result.cost)
    quantity = "length" if result.problem.objective.plain else "cost"
    return Convergence(number, best, iteration_best, mean, stage_one, divided, optimum, length, estimated, quantity)


@dataclass(frozen=True, eq=False)
class Heat:
    """Shades for the cells of a map.

    Attributes
    ----------
    shade : ndarray of float32, shape (rows, cols)
        0 keeps the cell's own colour, 1 is the darkest.
    label : str
        What the legend says.
    even : bool
        Whether there is one shade only.
    palette : ndarray of float32, shape (2, 3)
        Colours of the shades 1/2 and 1.
    """

    shade: NDArray[np.float32]
    label: str
    even: bool = False
    palette: NDArray[np.float32] = dataclasses.field(default_factory=lambda: BLUES)


def heat(result: Result) -> Heat | None:
    """Gather the pheromone, as shades: 1 at the most, 0 at a hundredth of it or at the median, logarithmic between.

    Few cells are on the ants' way, so the median is near what evaporation leaves; ants hardly feel less than a
    hundredth. Of a divided problem the pheromone is the sum of both halves'. Where no path exists, the shaded cells
    are those that can be reached from the start. None where there is nothing to show.
    """
    if result.status is Status.UNREACHABLE:
        return Heat(np.float32(0.2) * result.problem.reachable.astype(np.float32), "reachable from the start", True)
    field = result.pheromone
    if field is None or not np.isfinite(field).any():
        return None
    high = float(np.nanmax(field))
    low = max(float(np.nanmedian(field)), high / 100)
    if not 0 < low < high:
        return None
    with np.errstate(invalid="ignore"):
        shade = np.log(np.clip(np.nan_to_num(field, nan=low), low, high) / low) / math.log(high / low)
    return Heat(shade.astype(np.float32), f"pheromone, {low:.2g} to {high:.2g} (log)")


def costs(problem: Problem) -> Heat | None:
    """Gather what cells cost, as shades: 1 at the most. None where the problem has no costs."""
    field = problem.cost
    if field is not None and field.slope and not field.values.any():
        heights = field.slope.elevation
        low, high = float(heights.min()), float(heights.max())
        shade = np.where(problem.passable, (heights - low) / (high - low or 1.0), 0.0)
        return Heat(shade.astype(np.float32), f"{field.name}, heights from {low:.3g} to {high:.3g} m", palette=ORANGES)
    if field is None or not field.values.any():
        return None
    values = np.where(problem.passable, field.values, 0.0)
    most = float(values.max()) or 1.0
    return Heat((values / most).astype(np.float32), f"{field.name}, 0 to {most:.3g} per metre", palette=ORANGES)


def map_colours(grid: GridMap, heat: Heat | None = None) -> NDArray[np.uint8]:
    """Colour of each cell, shape (rows, cols, 3): free white, wall dark, inflated grey, unknown sand; shades blue."""
    colours: NDArray[np.uint8] = CELL_COLOURS[grid.cells]
    if heat is None:
        return colours
    cells = heat.shade > 0
    colours[cells] = shaded(colours[cells], heat.shade[cells], heat.palette)
    return colours


def shaded(
    colours: NDArray[np.uint8], shade: NDArray[np.float32], palette: NDArray[np.float32] = BLUES
) -> NDArray[np.uint8]:
    """Colours on the way from the cell's own (0) over the palette's first (1/2) to its second (1); (n, 3) and (n,)."""
    lower, upper = np.minimum(2 * shade, 1)[:, None], np.maximum(2 * shade - 1, 0)[:, None]
    mixed: NDArray[np.float32] = colours + (palette[0] - colours) * lower
    colours = np.rint(mixed + (palette[1] - mixed) * upper).astype(np.uint8)
    return colours


def known_corners(grid: GridMap) -> NDArray[np.float64]:
    """Corners, shape (4, 2) in metres, of the part of a map that is known, with a rim; of all of it where that is most.

    Maps from SLAM lie in wide borders of unknown cells.
    """
    rows, cols = ((grid.cells != Cell.UNKNOWN).any(axis=axis).nonzero()[0] for axis in (1, 0))
    if not len(rows):
        return grid.corners()
    rim = 3 + max(np.ptp(rows), np.ptp(cols)) // 40
    top, left = max(int(rows[0]) - rim, 0), max(int(cols[0]) - rim, 0)
    bottom, right = min(int(rows[-1]) + rim, grid.rows - 1), min(int(cols[-1]) + rim, grid.cols - 1)
    if (bottom - top + 1) * (right - left + 1) > 0.8 * grid.rows * grid.cols:
        return grid.corners()
    ends = np.array(
        [(bottom + 0.5, left - 0.5), (bottom + 0.5, right + 0.5), (top - 0.5, right + 0.5), (top - 0.5, left - 0.5)]
    )
    return grid.cell_to_world(ends)
