"""Covers: what lies on some cells for some time. Scenarios are drawn as covers that may overlap, and told as events."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from antnav.scenarios.scenario import Event


class Cover(NamedTuple):
    """Something that lies on cells from tick `begin` on and is gone at tick `end`.

    Attributes
    ----------
    cells : ndarray of int64
        Cells of the map by number, row * cols + col, each once.
    price : float or None
        What it adds to the price of a cell per metre; None: it blocks the cell.
    """

    begin: int
    end: int
    cells: NDArray[np.int64]
    price: float | None = None


def events_of(covers: Sequence[Cover], shape: tuple[int, int], ticks: int) -> Iterator[Event]:
    """The changes of cells that covers make: blocked where the first one comes, freed where the last one goes."""
    lying = np.zeros(shape[0] * shape[1], np.int32)  # how many block each cell
    prices = np.zeros(lying.size)
    turns: dict[int, tuple[list[Cover], list[Cover]]] = {}
    for cover in covers:
        if cover.begin < min(cover.end, ticks):
            turns.setdefault(cover.begin, ([], []))[0].append(cover)
            turns.setdefault(cover.end, ([], []))[1].append(cover)
    jams: list[Cover] = []
    for tick in sorted(tick for tick in turns if tick < ticks):
        coming, going = turns[tick]
        blocked, freed = _counted(lying, _blocking(coming), _blocking(going))
        gone = {id(cover) for cover in going}
        now = [cover for cover in [*jams, *coming] if cover.price is not None and id(cover) not in gone]
        priced = np.empty(0, np.int64)
        if now != jams:
            jams, before = now, prices
            prices = np.zeros(lying.size)  # summed anew: a sum that is taken back leaves its rounding behind
            for cover in jams:
                prices[cover.cells] += cover.price or 0.0
            priced = np.flatnonzero(prices != before)
        if len(blocked) or len(freed) or len(priced):
            one, other, third = (np.stack(np.divmod(cells, shape[1]), axis=-1) for cells in (blocked, freed, priced))
            yield Event(tick, one, other, third, prices[priced])


def _blocking(covers: Sequence[Cover]) -> NDArray[np.int64]:
    """Cells that they block, as often as they do."""
    return np.concatenate([np.empty(0, np.int64), *(cover.cells for cover in covers if cover.price is None)])


def _counted(
    lying: NDArray[np.int32], coming: NDArray[np.int64], going: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Count what comes and goes; the cells that are blocked and freed by it, ascending."""
    touched = np.unique(np.concatenate((coming, going)))
    before = lying[touched] > 0
    np.add.at(lying, coming, 1)
    np.add.at(lying, going, -1)
    after = lying[touched] > 0
    return touched[after & ~before], touched[before & ~after]
