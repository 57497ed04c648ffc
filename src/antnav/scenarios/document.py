"""Document: a scenario as JSON types, the one schema for writing and reading."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import msgspec
import numpy as np
from msgspec import UNSET

from antnav.planner.document import ProblemPart, decoded
from antnav.planner.plan import Measure
from antnav.world.problem import CellIndex

if TYPE_CHECKING:
    from antnav.scenarios.scenario import Event, Scenario

SCHEMA = "antnav/scenario"
VERSION = 1
#: Fields that a scenario shares with its document.
KEPT = ("ticks", "seconds", "speed", "radius", "sensor", "name", "seed")


class EventPart(msgspec.Struct, kw_only=True, omit_defaults=True):
    """An event; what it does not change is left out."""

    tick: Annotated[int, msgspec.Meta(ge=0)]
    blocked: list[CellIndex] = []
    freed: list[CellIndex] = []
    priced: list[CellIndex] = []
    prices: list[float] = []


class Document(msgspec.Struct, kw_only=True):
    """A file of a scenario."""

    schema: str = SCHEMA
    version: int = VERSION
    name: str
    seed: int
    ticks: int
    seconds: Measure
    speed: int
    radius: Measure
    sensor: int | None
    query: ProblemPart
    events: list[EventPart]

    @classmethod
    def read(cls, content: bytes) -> Document:
        """The document in a file's content.

        Raises
        ------
        ResultFormatError
            It is none, or of a newer version.
        """
        return decoded(content, cls, SCHEMA, VERSION)

    def fields(self, event: type[Event]) -> dict[str, Any]:
        """What the scenario is made of."""
        same = {name: getattr(self, name) for name in KEPT}
        return same | {"query": self.query, "events": [event(**msgspec.structs.asdict(part)) for part in self.events]}


def of(scenario: Scenario, *, map_cells: bool) -> Document:
    """A scenario as what a file says."""
    query = scenario.query
    if not map_cells:
        bare = msgspec.structs.replace(query.map, cells=UNSET)
        cost = query.cost and msgspec.structs.replace(query.cost, values=UNSET, elevation=UNSET)
        query = msgspec.structs.replace(query, map=bare, cost=cost)
    names = EventPart.__struct_fields__
    events = [EventPart(**{name: _listed(getattr(event, name)) for name in names}) for event in scenario.events]
    return Document(query=query, events=events, **{name: getattr(scenario, name) for name in KEPT})


def _listed(value: Any) -> Any:
    return value.tolist() if isinstance(value, np.ndarray) else value
