"""Document: alternatives as JSON types, the one schema for writing and reading."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated, Any

import msgspec

from antnav.planner.document import ProblemPart, decoded, finite, same, unreadable
from antnav.planner.plan import Measure, Status
from antnav.planner.planner import plain
from antnav.world.problem import CellIndex, Point

if TYPE_CHECKING:
    from antnav.routes.model import Alternatives

SCHEMA = "antnav/alternatives"
VERSION = 1
#: Fields that alternatives share with their document.
KEPT = (
    *("seed", "k", "least_difference", "longest", "tolerance", "seconds_run", "seconds_compile"),
    *("notes", "versions"),
)
Share = Annotated[float, msgspec.Meta(ge=0, le=1)]


class RoutePart(msgspec.Struct, kw_only=True):
    """A route; all but the path follows from it."""

    cost: Measure
    gap: float
    length: Measure
    length_m: Measure
    difference: Share
    obstacles: int
    turns: int
    turning_angle: Measure
    clearance_m: Measure | None
    wall_distance_m: Measure | None
    path: list[CellIndex]
    path_m: list[Point]


class Document(msgspec.Struct, kw_only=True):
    """A file of alternatives. Infinities are None."""

    schema: str = SCHEMA
    version: int = VERSION
    status: Status
    k: Annotated[int, msgspec.Meta(ge=1, le=100)]
    least_difference: Share
    longest: Annotated[float, msgspec.Meta(ge=1)]
    tolerance: Measure
    optimum: Measure | None
    seconds_run: Measure
    seconds_compile: Measure
    seed: int
    algorithm: dict[str, Any] | None
    routes: list[RoutePart]
    problem: ProblemPart
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

    def check(self, again: Document) -> None:
        """Compare routes and status with those that the file's paths make.

        Raises
        ------
        ResultFormatError
            They differ.
        """
        straight = math.dist(self.problem.start, self.problem.goal) / self.problem.map.resolution
        least = min((route.cost for route in self.routes), default=math.inf) * (1 + 1e-9)
        if self.routes and not (self.optimum is not None and (straight - 2) <= self.optimum <= least):
            raise unreadable(
                f"optimum {self.optimum}", "it is no more than the cheapest route, and no shorter than straight"
            )
        for one, other in ((self.status, again.status), (self.routes, again.routes)):
            if not same(msgspec.to_builtins(one), msgspec.to_builtins(other)):
                raise unreadable("the routes", "they are others than the paths and the map make")


def of(found: Alternatives, *, map_cells: bool) -> Document:
    """Alternatives as what a file says."""
    routes = [
        RoutePart(
            cost=route.cost,
            gap=route.gap,
            length=route.path.length,
            length_m=route.path.length_m,
            difference=route.difference,
            obstacles=route.obstacles,
            turns=route.path.turns,
            turning_angle=route.path.turning_angle,
            clearance_m=finite(route.path.clearance),
            wall_distance_m=finite(route.path.wall_distance),
            path=route.path.cells.tolist(),
            path_m=route.path.points.tolist(),
        )
        for route in found.routes
    ]
    algorithm = found.algorithm
    return Document(
        status=found.status,
        optimum=finite(found.optimum),
        algorithm=None if algorithm is None else plain(algorithm, algorithm.document()),
        routes=routes,
        problem=ProblemPart.of(found.problem, map_cells=map_cells),
        **{name: getattr(found, name) for name in KEPT},
    )
