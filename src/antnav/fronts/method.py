"""Method: a way to find paths that no other beats, and what it answers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from antnav.fronts.instance import Instance
from antnav.planner.call import Call
from antnav.planner.plan import StoppedBy


@dataclass(frozen=True, eq=False, kw_only=True)
class Found:
    """What a method answers.

    Attributes
    ----------
    paths : sequence of ndarray of int32
        Nodes from the start to the goal; some may be beaten by others.
    complete : bool
        Whether every vector of the true front is there, counted in whole steps.
    stopped_by : StoppedBy
    work : dict
        What was done, by name, such as labels or walks.
    notes : tuple of str
        What a reader must know.
    """

    paths: Sequence[NDArray[np.int32]]
    complete: bool = False
    stopped_by: StoppedBy = StoppedBy.SCHEDULE
    work: dict[str, int]
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class Method:
    """A way to find a front: a frozen choice of parameters."""

    extra: ClassVar[str] = ""  #: of antnav, with the library that it needs
    draws: ClassVar[bool] = True  #: whether the seed decides what it finds

    @property
    def name(self) -> str:
        """Short, for tables."""
        raise NotImplementedError

    @property
    def certainty(self) -> str:
        """Where it comes from, and how sure that is."""
        raise NotImplementedError

    @property
    def parts(self) -> tuple[Method, ...]:
        """The methods whose kernels it needs."""
        return (self,)

    def find(self, instance: Instance, call: Call) -> Found:
        """Search; asks `call.ending` now and then, and returns what there is once it says so."""
        raise NotImplementedError

    def versions(self) -> dict[str, str]:
        """Versions of the libraries beside antnav's own that decide its outcome."""
        return {}

    def document(self) -> dict[str, Any]:
        """Name and parameters as JSON types."""
        return {"name": self.name} | {field.name: getattr(self, field.name) for field in fields(self)}
