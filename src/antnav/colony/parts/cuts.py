"""Cuts of users: at which nodes PACO divides the way. Antnav's own are `Cuts`, by lines and levels."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from antnav.colony.parts import names
from antnav.colony.parts.ground import Ground
from antnav.colony.parts.part import Part


class CutsPart(Part):
    """What divides the map, as a user's function says it."""

    @classmethod
    def kind(cls) -> type[names.Cuts]:
        """The names of antnav's own."""
        return names.Cuts

    @classmethod
    def known(cls) -> dict[str, type[Part]]:
        """Of antnav's own there are no parts: they belong to the steps of PACO."""
        return cls.registered

    def crossings(self, ground: Ground, paths: Sequence[NDArray[np.int32]], pieces: int) -> list[int]:
        """Nodes between the start and the goal, in the order in which the path is to pass them."""
        raise NotImplementedError
