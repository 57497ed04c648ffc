"""Tour: the order of the stops, the legs between them, and how good that is."""

from __future__ import annotations

import csv
import io
import math
import os
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from antnav.errors import ParameterError
from antnav.files import as_path, write_whole
from antnav.planner.document import MapPart, finite
from antnav.planner.plan import Status
from antnav.planner.planner import Planner, plain
from antnav.planner.result import SAME, Result
from antnav.tours.order import said_of
from antnav.values import read_only
from antnav.world.grid import GridMap
from antnav.world.path import Path
from antnav.world.problem import Point

if TYPE_CHECKING:
    from antnav.trajectories.model import Trajectory

SCHEMA = "antnav/tour"
ENDINGS = (".json", ".csv")


@dataclass(frozen=True, eq=False, kw_only=True)
class Tour:
    """What `tour` found: one trip from a start to all stops.

    Attributes
    ----------
    status : Status
        "found"; "unreachable" where a stop cannot be reached, and the notes say which; else that of the first leg for
        which the planner found no path.
    grid : GridMap
        As the robot sees it, inflated by radius and margin.
    places : tuple of (x, y)
        Metres: the start, number 0, then the stops as they were given, from number 1.
    order : tuple of int
        Numbers of the stops as they are visited; empty where one cannot be reached.
    legs : tuple of Result
        From the start to the first stop, and so on; with the way back, where that is asked for.
    return_to_start : bool
    distances : ndarray of float64, shape (n + 1, n + 1)
        Cost in cells of a cheapest path from each place to each other, from exact searches; inf where there is none.
    method : str
        How the order was found: "exact", "ils", "ants", "library", or "given".
    optimum : float or None
        Cost of the best order in cells; None where it is not known.
    bound : float
        What no order costs less than, which is the optimum where that is known.
    radius, margin : float
        Metres that the legs keep from walls' edges, together.
    algorithm : Planner
        Of the legs.
    seed : int
    seconds_distances, seconds_order, seconds_legs, seconds_compile : float
        Wall time.
    notes : tuple of str
        What a reader must know.
    versions : dict
    """

    status: Status
    grid: GridMap
    places: tuple[Point, ...]
    order: tuple[int, ...]
    legs: tuple[Result, ...]
    return_to_start: bool
    distances: NDArray[np.float64] = field(repr=False)
    method: str
    optimum: float | None
    bound: float
    radius: float
    margin: float
    algorithm: Planner
    seed: int
    seconds_distances: float
    seconds_order: float
    seconds_legs: float
    seconds_compile: float
    notes: tuple[str, ...]
    versions: dict[str, str]

    def __post_init__(self) -> None:
        read_only(self.distances)

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self.__post_init__()  # pickling drops the flag

    def __len__(self) -> int:
        return len(self.places) - 1

    def __repr__(self) -> str:
        found = f"{self.length_m:.3f} m, gap={self.gap:.4f}, " if self.path else ""
        return f"Tour({self.status}, {len(self)} stops, {found}{self.method} on {self.grid.name or 'a map'!r})"

    def _repr_html_(self) -> str:
        from antnav.markup import escaped, map_html

        rows = "".join(f"<tr><th>{escaped(name)}</th><td>{escaped(text)}</td></tr>" for name, text in self.table)
        return f"{map_html(self.grid.cells, repr(self), self.path.cells if self.path else None)}<table>{rows}</table>"

    @property
    def visited(self) -> tuple[int, ...]:
        """Numbers of all places on the way, from 0, the start, to where the tour ends; empty without an order."""
        return (0, *self.order, *([0] if self.return_to_start else [])) if self.order else ()

    @cached_property
    def path(self) -> Path | None:
        """All legs as one path over cells; None where a leg has none."""
        paths = [leg.path for leg in self.legs if leg.path is not None]
        if not paths or self.status is not Status.FOUND:
            return None
        cells = [paths[0].cells, *(path.cells[1:] for path in paths[1:])]
        return Path(np.concatenate(cells), self.grid, self.places[0], self.places[self.visited[-1]])

    @cached_property
    def points(self) -> NDArray[np.float64] | None:
        """The way in metres, shape (k, 2), exactly through all stops; None where a leg has no path."""
        if self.path is None:
            return None
        points: NDArray[np.float64] = np.concatenate([leg.path.points for leg in self.legs if leg.path is not None])
        new: NDArray[np.bool_] = np.append(True, (np.diff(points, axis=0) != 0).any(axis=1))
        apart: NDArray[np.float64] = points[new]
        return read_only(apart)

    @property
    def length_m(self) -> float:
        """Length of all legs in metres; inf where one has no path."""
        return sum(leg.length_m for leg in self.legs) if self.order else math.inf

    @cached_property
    def cost(self) -> float:
        """Cost of all legs in cells, their length where the map has no costs; inf where one has no path."""
        return sum(leg.cost for leg in self.legs) if self.order else math.inf

    @property
    def gap(self) -> float:
        """Cost / bound - 1: at most so much above the best order of cheapest paths; nan without a path."""
        if self.path is None:
            return math.nan
        above = self.cost / self.bound - 1.0 if self.bound > 0 else 0.0
        return above if abs(above) > 10 * SAME else 0.0

    @property
    def proven(self) -> bool:
        """Whether no order of cheapest paths is better than this tour."""
        return self.gap <= 1e-9

    @cached_property
    def table(self) -> list[tuple[str, str]]:
        """The summary as pairs of name and text."""
        rows = [("status", f"{self.status.replace('_', ' ')}, {len(self)} stops" + ", and back" * self.return_to_start)]
        if self.order:
            rows.append(("order", ", ".join(map(str, self.order))))
        if self.path:
            rows.append(
                ("length", f"{self.length_m:.3f} m, longest leg {max(leg.length_m for leg in self.legs):.3f} m")
            )
            rows += [] if self.legs[0].problem.objective.plain else [("cost", f"{self.cost:.4f} cells")]
            rows.append(("gap", self._judged()))
            if math.isfinite(self.path.wall_distance):
                rows.append(("clearance", f"{self.path.wall_distance:.3f} m to walls' edges"))
        rows += [
            ("method", f"{said_of(self.method)}, seed {self.seed}"),
            ("legs", f"{self.algorithm.outline}; {self.algorithm.certainty}"),
            ("seconds", f"{self.seconds_distances:.4f} distances, {self.seconds_order:.4f} order, "
                        f"{self.seconds_legs:.4f} legs, {self.seconds_compile:.2f} compile"),
        ]  # fmt: skip
        return rows + [("note", note) for note in self.notes]

    def _judged(self) -> str:
        if self.proven:
            return "0.00 %: no order is better (proven)"
        if self.optimum is not None:
            return f"{100 * self.gap:.2f} % above the best order"
        return f"at most {100 * self.gap:.2f} % above the best order (bound by spanning trees)"

    def summary(self) -> str:
        """A short table: order, length, gap, method, seconds."""
        return "\n".join(f"{name:<14} {text}" for name, text in self.table)

    def trajectory(
        self, *, start_heading: float | None = None, goal_heading: float | None = None, **choices: Any
    ) -> Trajectory:
        """One curve that a robot can drive over all legs, each checked; radius and margin are the tour's.

        It leads through stops without a turn where there is room; else the robot turns on the spot there, which the
        note says, and `smooth` is False.

        Parameters
        ----------
        start_heading, goal_heading : float, optional
            In radians, of the whole.
        choices
            What else `antnav.trajectory` takes; a `footprint` counts instead of the tour's radius.

        Raises
        ------
        ParameterError
            There is no path, or as there.
        """
        from antnav.tours.drive import driven

        if self.path is None:
            raise ParameterError(f"status {self.status}", "a trajectory follows paths", "make a tour that has them")
        radius = self.radius if self.radius and choices.get("footprint") is None else None
        choices = {"radius": radius, "margin": self.margin} | choices
        return driven(self.legs, self.visited[1:], start_heading, goal_heading, **choices)

    def to_dict(self) -> dict[str, Any]:
        """Everything but the map's cells as JSON types; infinities are None."""
        total, legs = 0.0, []
        for one, other, leg in zip(self.visited[:-1], self.visited[1:], self.legs, strict=True):
            total += leg.length_m
            legs.append(
                {
                    "start": one,
                    "stop": other,
                    "status": leg.status,
                    "length_m": finite(leg.length_m),
                    "total_m": finite(total),
                    "cost": finite(leg.cost),
                    "path": leg.path.cells.tolist() if leg.path else None,
                    "path_m": leg.path.points.tolist() if leg.path else None,
                }
            )
        told = {
            "schema": SCHEMA,
            "version": 1,
            "status": self.status,
            "places": self.places,
            "order": self.order,
            "return_to_start": self.return_to_start,
            "length_m": finite(self.length_m),
            "cost": finite(self.cost),
            "optimum": self.optimum,
            "bound": finite(self.bound),
            "gap": finite(self.gap),
            "proven": self.proven,
            "method": self.method,
            "seed": self.seed,
            "radius": self.radius,
            "margin": self.margin,
            "algorithm": plain(self.algorithm, self.algorithm.document()),
            "legs": legs,
            "distances": [[finite(value) for value in row] for row in self.distances.tolist()],
            "map": MapPart.of(self.grid, cells=False),
            "notes": self.notes,
            "versions": self.versions,
        }
        told |= {name: getattr(self, name) for name in vars(self) if name.startswith("seconds_")}
        builtins: dict[str, Any] = msgspec.to_builtins(told)
        return builtins

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the tour, whole or not at all; pictures are drawn by `antnav.plot_tour`.

        ".json": everything but the map. ".csv": a line for the start and for each place on the way: the place's number,
        x and y in metres, length of the leg to it and of the way so far in metres.

        Raises
        ------
        ParameterError
            Another ending.
        OutputError
            The file cannot be written.
        """
        ending = as_path(path).suffix.lower()
        if ending == ".json":
            write_whole(path, msgspec.json.encode(self.to_dict()) + b"\n")
        elif ending == ".csv":
            text = io.StringIO()
            writer = csv.writer(text, lineterminator="\n")
            writer.writerow(("stop", "x", "y", "length_m", "total_m"))
            total = 0.0
            lengths = [0.0] * bool(self.order) + [leg.length_m for leg in self.legs]
            for number, length in zip(self.visited, lengths, strict=True):
                total += length
                writer.writerow((number, *self.places[number], length, total))
            write_whole(path, text.getvalue().encode())
        else:
            rule = f"tours end in {' or '.join(ENDINGS)}"
            raise ParameterError(f"file name {as_path(path).name}", rule, "choose one of them")
