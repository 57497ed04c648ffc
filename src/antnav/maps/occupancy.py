"""From gray levels to occupancy values to cells: the arithmetic of ROS map_server."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from antnav.errors import ParameterError
from antnav.grid import Cell

Rules = Literal["nav2", "ros1"]

_BAND = 2**20  # pixels of a colour image that are turned into floats at once


@dataclass(frozen=True)
class MapMeta:
    """What the YAML file says; the defaults are map_saver's.

    Attributes
    ----------
    image : Path
        The image, absolute or below the current folder.
    resolution : float
        Metres a cell.
    origin : tuple of 3 floats
        x, y in metres and yaw in radians of the lower left corner.
    negate : bool
        White means occupied.
    occupied_thresh, free_thresh : float
        Occupancy from which a cell is occupied, and up to which it is free.
    mode : {"trinary", "scale", "raw"}
        How gray between the thresholds is read.
    """

    image: Path
    resolution: float = 1.0
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)
    negate: bool = False
    occupied_thresh: float = 0.65
    free_thresh: float = 0.196
    mode: str = "trinary"


def occupancy(
    pixels: NDArray[np.uint8], alpha: NDArray[np.uint8] | None, meta: MapMeta, rules: Rules = "nav2"
) -> NDArray[np.int8]:
    """Occupancy values that the map server would publish.

    Parameters
    ----------
    pixels : ndarray of uint8, shape (rows, cols) or (rows, cols, 3)
        Gray, or colour whose channels are averaged.
    alpha : ndarray of uint8, shape (rows, cols), or None
        255 opaque.
    meta : MapMeta
        Thresholds, mode and negate.
    rules : {"nav2", "ros1"}
        With n = 1 - gray / 255, or gray / 255 where negated:

        ======== ============================================== ==============================================
        mode     nav2 (float32)                                 ros1 (float64)
        ======== ============================================== ==============================================
        trinary  n >= occupied: 100, n <= free: 0, else -1      n > occupied: 100, n < free: 0, else -1
        scale    ends as above, between round(100 r)            ends as above, between floor(1 + 98 r)
        raw      gray 0..100 kept, others -1, negate ignored    gray's byte, inverted where negated, as int8
        alpha    below 255 is -1, except in raw mode            averaged with the channels in trinary mode; 0 makes
                                                                values between the ends -1 in scale mode
        ======== ============================================== ==============================================

        where r = (n - free) / (occupied - free).

    Returns
    -------
    ndarray of int8, shape (rows, cols)
        0 free, 100 occupied, -1 unknown, 1..99 between. Row 0 is the top; ROS publishes the rows bottom first.
    """
    check_rules(rules)
    levels = _nav2_levels if rules == "nav2" else _ros1_levels
    mixed = alpha if rules == "ros1" and meta.mode == "trinary" else None
    if pixels.ndim == 2 and mixed is None:
        values = levels(np.arange(256), meta)[pixels]
    else:
        values = np.empty(pixels.shape[:2], dtype=np.int8)
        step = max(1, _BAND // pixels.shape[1])
        for top in range(0, len(pixels), step):
            band = slice(top, top + step)
            values[band] = levels(_mean_channel(pixels[band], None if mixed is None else mixed[band]), meta)
    if alpha is not None and rules == "nav2" and meta.mode != "raw":
        values[alpha < 255] = -1
    if alpha is not None and rules == "ros1" and meta.mode == "scale":
        values[(alpha == 0) & (values > 0) & (values < 100)] = -1
    return values


def _mean_channel(pixels: NDArray[np.uint8], alpha: NDArray[np.uint8] | None) -> NDArray[np.float64]:
    colour = pixels if pixels.ndim == 3 else np.repeat(pixels[..., None], 3, axis=2)
    total: NDArray[np.float64] = colour.sum(axis=2, dtype=np.float64)
    return total / 3 if alpha is None else (total + alpha) / 4


def _nav2_levels(gray: NDArray[Any], meta: MapMeta) -> NDArray[np.int8]:
    if meta.mode == "raw":
        return np.where(gray <= 100, gray, -1).astype(np.int8)
    n = gray.astype(np.float32) / np.float32(255)
    if not meta.negate:
        n = np.float32(1) - n
    occupied, free = np.float32(meta.occupied_thresh), np.float32(meta.free_thresh)
    values = np.full(n.shape, -1, dtype=np.int8)
    if meta.mode == "scale":
        span = np.float32(meta.occupied_thresh - meta.free_thresh) or np.float32(1)  # nothing lies between equal ends
        scaled = np.clip((n - free) / span, 0, 1) * np.float32(100)
        whole = np.floor(scaled)
        values = (whole + (scaled - whole >= 0.5)).astype(np.int8)  # C rounds halves up, NumPy to even
    values[n >= occupied] = 100
    values[n <= free] = 0
    return values


def _ros1_levels(gray: NDArray[Any], meta: MapMeta) -> NDArray[np.int8]:
    level = 255.0 - gray if meta.negate else gray.astype(np.float64)
    if meta.mode == "raw":
        return level.astype(np.uint8).view(np.int8)
    n = (255.0 - level) / 255.0
    values = np.full(n.shape, -1, dtype=np.int8)
    if meta.mode == "scale":
        span = (meta.occupied_thresh - meta.free_thresh) or 1.0
        values = (1 + 98 * np.clip((n - meta.free_thresh) / span, 0, 1)).astype(np.int8)
    values[n < meta.free_thresh] = 0
    values[n > meta.occupied_thresh] = 100
    return values


def to_cells(values: NDArray[np.int8], occupied_from: int = 100) -> NDArray[np.uint8]:
    """Turn occupancy values into `Cell` values, as nav2's static costmap layer does by default.

    Parameters
    ----------
    values : ndarray of int8
        From `occupancy`. Read as unsigned bytes, as ROS does: -1 is 255.
    occupied_from : int
        Values from here on are occupied, as with nav2's `lethal_cost_threshold`; -1 is unknown; all below are free,
        even 99 of scale mode, as with nav2's `trinary_costmap`. Lower it to keep out of cells that are rather full.

    Raises
    ------
    ParameterError
        `occupied_from` outside 1..100.
    """
    check_occupied_from(occupied_from)
    table = np.full(256, Cell.FREE, dtype=np.uint8)
    table[occupied_from:] = Cell.OCCUPIED
    table[255] = Cell.UNKNOWN
    cells: NDArray[np.uint8] = table[values.view(np.uint8)]
    return cells


def check_rules(rules: str) -> None:
    """Refuse rules that are neither of the two."""
    if rules not in ("nav2", "ros1"):
        raise ParameterError(f"rules {rules!r}", "they are nav2 or ros1", "choose one; nav2 is the default")


def check_occupied_from(value: int) -> None:
    """Refuse an occupancy outside 1..100."""
    if isinstance(value, bool) or not isinstance(value, int) or not 1 <= value <= 100:
        raise ParameterError(
            f"occupied_from {value!r}", "it is a whole number from 1 to 100", "leave it at 100, as nav2"
        )
