"""Alternatives: several routes for one problem, what sets them apart, and all that is needed to find them again."""

from __future__ import annotations

import math
import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Self

import msgspec
import numpy as np

from antnav.errors import AntnavError, ResultFormatError
from antnav.files import as_path, write_whole
from antnav.planner import planner
from antnav.planner.document import content_of, only_json, unreadable
from antnav.planner.facts import Basis
from antnav.planner.plan import Status
from antnav.planner.planner import Planner
from antnav.routes import document
from antnav.routes.difference import Zone, flat_cells
from antnav.routes.sides import obstacles_between
from antnav.world.path import Path, check_path
from antnav.world.problem import Problem


@dataclass(frozen=True, eq=False, kw_only=True)
class Route:
    """One of several ways.

    Attributes
    ----------
    path : Path
    cost : float
        In cells, by the problem's objective.
    gap : float
        Cost / optimum - 1.
    difference : float
        Share of its length that runs along none of the cheaper routes; of each one, the least. 1 of the first.
    obstacles : int
        How many obstacles lie between it and the first route. 0: it passes on the same side of all, as it may where
        cells have costs.
    """

    path: Path
    cost: float
    gap: float
    difference: float
    obstacles: int

    def __repr__(self) -> str:
        return f"Route({self.path.length_m:.3f} m, cost={self.cost:.4f}, difference={self.difference:.2f})"


@dataclass(frozen=True, eq=False, kw_only=True)
class Alternatives:
    """What `alternatives` found: a sequence of routes, cheapest first.

    Attributes
    ----------
    routes : tuple of Route
        Fewer than `k` where there are no more, and the notes say so; none where no path exists.
    problem, algorithm, seed, k, least_difference, longest
        What was asked; `algorithm` is None where the routes are exact.
    tolerance : float
        Metres within which a route runs along another one.
    optimum : float
        Cost of a cheapest path, from an exact search; inf where no path exists.
    seconds_run, seconds_compile : float
        Wall time; of compiling or loading kernels.
    notes : tuple of str
        What a reader must know.
    versions : dict
    """

    routes: tuple[Route, ...]
    problem: Problem
    algorithm: Planner | None
    seed: int
    k: int
    least_difference: float
    longest: float
    tolerance: float
    optimum: float
    seconds_run: float
    seconds_compile: float
    notes: tuple[str, ...]
    versions: dict[str, str]

    def __len__(self) -> int:
        return len(self.routes)

    def __getitem__(self, number: int) -> Route:
        return self.routes[number]

    def __iter__(self) -> Iterator[Route]:
        return iter(self.routes)

    def __repr__(self) -> str:
        grid = self.problem.grid
        return f"Alternatives({len(self)} of {self.k} routes on {grid.name or 'a map'!r}, {list(self.routes)!r})"

    @property
    def status(self) -> Status:
        """As of a `Result`: "found" with one route or more."""
        if self.routes:
            return Status.FOUND
        if not self.problem.connected:
            return Status.UNREACHABLE
        return Status.NO_ANT_ARRIVED if self.algorithm and self.algorithm.ants else Status.NO_PATH

    @property
    def table(self) -> list[tuple[str, str]]:
        """The summary as pairs of name and text."""
        rows = [("status", f"{self.status.replace('_', ' ')}, {len(self)} of {self.k} routes")]
        for number, route in enumerate(self.routes, 1):
            priced = "" if self.problem.objective.plain else f", cost {route.cost:.4f}"
            text = f"{route.path.length_m:.3f} m{priced}, {100 * route.gap:.2f} % above the optimum"
            if number > 1:
                lie = "obstacle lies" if route.obstacles == 1 else "obstacles lie"
                text += f", {100 * route.difference:.0f} % different; {route.obstacles} {lie} between it and route 1"
            if math.isfinite(route.path.clearance):
                text += f"; clearance {route.path.clearance:.3f} m"
            rows.append((f"route {number}", text))
        rows += [
            ("asked", f"at least {100 * self.least_difference:g} % different beyond {self.tolerance:.3g} m, "
                      f"at most {self.longest:g} times the optimum"),
            ("seconds", f"{self.seconds_run:.4f} run, {self.seconds_compile:.2f} compile"),
            ("method", self.method),
        ]  # fmt: skip
        return rows + [("note", note) for note in self.notes]

    @property
    def method(self) -> str:
        """How the routes were found, and how sure that is."""
        if self.algorithm is None:
            return f"{Basis.OURS}: via cells (Abraham et al. 2013), on each side the cheapest; knows exact distances"
        certainty = self.algorithm.certainty
        return f"penalties (Chen et al. 2007) around routes of {self.algorithm.outline}, seed {self.seed}; {certainty}"

    def summary(self) -> str:
        """A short table: a line for each route, what was asked, seconds."""
        return "\n".join(f"{name:<14} {text}" for name, text in self.table)

    def to_dict(self, *, map_cells: bool = True) -> dict[str, Any]:
        """Everything as JSON types.

        Parameters
        ----------
        map_cells : bool
            Whether the map itself goes along, compressed; without it a file cannot be loaded again.
        """
        found: dict[str, Any] = msgspec.to_builtins(document.of(self, map_cells=map_cells))
        return found

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write everything as .json, whole or not at all; pictures are drawn by `antnav.plot_alternatives`."""
        write_whole(path, only_json(as_path(path).name, "alternatives", lambda: document.of(self, map_cells=True)))

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Self:
        """Read what `save` wrote.

        What follows from the paths and the map is worked out anew and compared with the file.

        Raises
        ------
        ResultFormatError
            No such file, none of alternatives, of a newer version, or one that cannot be true.
        """
        read = document.Document.read(content_of(path))
        try:
            return cls._of(read)
        except ResultFormatError:
            raise
        except (AntnavError, msgspec.MsgspecError, KeyError, TypeError, ValueError, OverflowError) as error:
            raise unreadable("the file", str(error)) from error

    @classmethod
    def _of(cls, read: document.Document) -> Self:
        problem = read.problem.problem()
        paths = [Path(np.array(route.path), problem.grid, problem.start, problem.goal) for route in read.routes]
        for path in paths:
            check_path(path, problem)
        reach = read.tolerance / problem.grid.resolution
        optimum = math.inf if read.optimum is None else read.optimum
        found = cls(
            routes=compared(paths, problem, optimum, 1 - read.least_difference, reach),
            problem=problem,
            algorithm=None if read.algorithm is None else planner.read(read.algorithm),
            optimum=optimum,
            **{name: getattr(read, name) for name in document.KEPT},
        )
        read.check(document.of(found, map_cells=False))
        return found


def compared(
    paths: Sequence[Path], problem: Problem, optimum: float, most_shared: float, reach: float
) -> tuple[Route, ...]:
    """Paths as routes, cheapest first, without those that share more with a cheaper one; `reach` in cells."""
    terrain, routes, zones, first = problem.terrain, list[Route](), list[Zone](), None
    priced = [(problem.objective.of(path.cells, problem.grid), path) for path in paths]
    for cost, path in sorted(priced, key=lambda pair: round(pair[0], 9)):  # sums differ in their last digits
        flat = flat_cells(path, terrain)
        first = flat if first is None else first
        share = max((zone.share(flat) for zone in zones), default=0.0)
        if share <= most_shared + 1e-12:
            between = obstacles_between(first, flat, terrain)
            gap = max(cost / optimum - 1.0, 0.0) if optimum > 0 else 0.0  # sums differ in their last digits
            routes.append(Route(path=path, cost=cost, gap=gap, difference=1.0 - share, obstacles=between))
            zones.append(Zone.of(flat, terrain, reach))
    return tuple(routes)
