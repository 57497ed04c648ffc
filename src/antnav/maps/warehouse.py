"""The generator `warehouse`: a hall as a laser scanner maps it."""

from __future__ import annotations

import numpy as np

from antnav.errors import ParameterError
from antnav.maps.drawing import Cells, check_count, check_share, join_corners
from antnav.world.grid import Cell


def warehouse(rows: int, cols: int, rng: np.random.Generator, *, aisle: int = 0, clutter: float = 0.5) -> Cells:
    """Draw racks in rows with aisles and cross-aisles, a staging zone with docks, an office, and pallets.

    The world outside the walls and the inside of racks is unknown: no scanner saw it. Beside every pallet three
    quarters of an aisle stay free.

    Parameters
    ----------
    rows, cols : int
        Size in cells; at least some five aisles.
    rng : numpy.random.Generator
        Where the draws come from.
    aisle : int
        Width of an aisle in cells, >= 3; 0 for a fourteenth of the shorter side. All else is in proportion.
    clutter : float
        Chance of a pallet at each of its places, 0..1.

    Returns
    -------
    ndarray of uint8, shape (rows, cols)
        `Cell` values.

    Raises
    ------
    ParameterError
        An option out of range, or a map too small for one rack.
    """
    aisle = check_count("aisle", aisle, 3) if aisle else max(3, min(rows, cols) // 14)
    chance = check_share("clutter", clutter)
    depth, wall, margin = _depth(aisle), max(1, aisle // 8), max(1, aisle // 6)
    edge, staging = margin + wall, 3 * aisle
    low = (aisle + depth + staging + 2 * edge, 5 * aisle + 2 * edge)
    if rows < low[0] or cols < low[1]:
        raise ParameterError(
            f"a warehouse of {rows} x {cols} cells with aisles of {aisle}",
            f"it needs {low[0]} x {low[1]} cells for one rack",
            "enlarge the map or narrow the aisles",
        )
    cells = np.full((rows, cols), Cell.UNKNOWN, dtype=np.uint8)
    cells[margin:-margin, margin:-margin] = Cell.OCCUPIED
    hall = cells[edge:-edge, edge:-edge]
    hall[:] = Cell.FREE
    for top in range(aisle, len(hall) - staging - depth + 1, depth + aisle):
        _draw_racks(hall, top, aisle, chance, rng)
    _draw_office(hall, aisle, wall)
    _draw_docks(hall, aisle, chance, rng)
    join_corners(hall)
    return cells


def _depth(aisle: int) -> int:
    return max(1, aisle * 3 // 4)


def _draw_racks(hall: Cells, top: int, aisle: int, chance: int, rng: np.random.Generator) -> None:
    """Draw one row of racks, with pallets below them."""
    bottom, pallet = top + _depth(aisle), max(1, aisle // 4)
    span = hall.shape[1] - aisle  # between the aisles along the walls, and one more: as many aisles as racks
    pitch = span // max(1, span // (6 * aisle))
    for left in range(aisle, span - pitch + aisle + 1, pitch):
        length = pitch - aisle - int(rng.integers(0, aisle))  # of uneven length
        rack = hall[top:bottom, left : left + length]
        rack[:] = np.where(rng.integers(0, 8, rack.shape) > 0, Cell.OCCUPIED, Cell.UNKNOWN)  # gaps between its posts
        rack[1:-1, 1:-1] = Cell.UNKNOWN
        for place in range(left, left + length - 2 * pallet, 2 * aisle):
            spot = place + int(rng.integers(0, 2 * pallet))
            if rng.integers(0, 1000) < chance:
                hall[bottom : bottom + pallet, spot : spot + 2 * pallet] = Cell.OCCUPIED


def _draw_office(hall: Cells, aisle: int, wall: int) -> None:
    """Draw a room in the bottom left corner with a door to the right."""
    office = hall[-3 * aisle // 2 :, : 3 * aisle]
    office[:wall] = office[:, -wall:] = Cell.OCCUPIED
    office[-max(1, aisle * 3 // 4) :, -wall:] = Cell.FREE


def _draw_docks(hall: Cells, aisle: int, chance: int, rng: np.random.Generator) -> None:
    """Draw the bumpers of the docks along the bottom wall, and pallets waiting before them."""
    bumper, pallet = max(1, aisle // 8), max(1, aisle // 4)
    waiting = len(hall) - aisle - pallet
    for left in range(4 * aisle, hall.shape[1] - aisle, 2 * aisle):
        hall[-bumper:, left : left + bumper] = hall[-bumper:, left + aisle - bumper : left + aisle] = Cell.OCCUPIED
        if rng.integers(0, 1000) < chance:
            hall[waiting : waiting + pallet, left : left + 2 * pallet] = Cell.OCCUPIED
