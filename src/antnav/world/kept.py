"""What has been worked out once and is kept: by key, bounded, typed, in no copy and no pickle."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from threading import Lock
from typing import TYPE_CHECKING, Any, Generic, TypeVar
from weakref import WeakValueDictionary

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from antnav.world.grid import GridMap
    from antnav.world.grid_graph import GridGraph
    from antnav.world.moves import CornerRule
    from antnav.world.path_cost import PathCost
    from antnav.world.terrain import Terrain

Key = TypeVar("Key", bound=Hashable)
Value = TypeVar("Value")


class Kept(Generic[Key, Value]):
    """Values by key: the latest few that were asked for, and every other one for as long as somebody holds it.

    All threads get one value. Two that ask for it at the same time both work it out, and the first one's is kept:
    nothing is worked out under a lock, so what a value needs may be kept in the same way.
    """

    def __init__(self, latest: int) -> None:
        self._most = latest
        self._latest: dict[Key, Value] = {}
        self._held: WeakValueDictionary[Key, Value] = WeakValueDictionary()
        self._lock = Lock()

    def of(self, key: Key, work: Callable[[], Value]) -> Value:
        """The value of a key, worked out where there is none."""
        value = self._latest.get(key)
        if value is not None and len(self._latest) <= 1:
            return value
        if value is None:
            with self._lock:
                value = self._held.get(key)
        if value is None:
            value = work()
        with self._lock:
            value = self._held.setdefault(key, value)
            self._latest.pop(key, None)
            self._latest[key] = value
            gone = self._latest.pop(next(iter(self._latest))) if len(self._latest) > self._most else None
        del gone  # what it frees is freed without the lock
        return value

    def __len__(self) -> int:
        return len(self._held)

    def __reduce__(self) -> tuple[Any, ...]:
        return Kept, (self._most,)  # a copy begins empty


class KeptByKind:
    """What rooms above keep with a terrain or a problem: one value of each kind and key."""

    def __init__(self) -> None:
        self._kept: Kept[tuple[type, Hashable], object] = Kept(8)

    def of(self, kind: type[Value], key: Hashable, work: Callable[[], Value]) -> Value:
        """The value of that kind and key, worked out where there is none."""
        value = self._kept.of((kind, key), work)
        assert isinstance(value, kind)
        return value


Choice = tuple["CornerRule", bool]
PricedChoice = tuple[Choice, str]  #: and the key of an `PathCost`


class KeptWithMap:
    """What is worked out from a map: it dies with the map, for it holds no reference to it.

    A graph of a million nodes takes 100 MB, so that of one component is kept, the latest; others live as long as a
    problem or a colony uses them. The numbering of nodes depends on the map alone, so that one worked out again fits.
    """

    def __init__(self) -> None:
        self.terrains: Kept[PricedChoice, Terrain] = Kept(0)  # they hold the map
        self.closed: Kept[bytes, GridMap] = Kept(1)  # other maps, which hold nothing of this one
        self.objectives: Kept[str, PathCost] = Kept(2)  # with their prices
        self.passable: Kept[bool, NDArray[np.bool_]] = Kept(2)
        self.moves: Kept[Choice, NDArray[np.uint8]] = Kept(6)
        self.jump_ends: Kept[Choice, NDArray[np.int64]] = Kept(6)
        self.components: Kept[Choice, NDArray[np.int32]] = Kept(6)
        self.graphs: Kept[tuple[PricedChoice, int], GridGraph] = Kept(1)
        self.by_terrain: Kept[PricedChoice, KeptByKind] = Kept(6)
