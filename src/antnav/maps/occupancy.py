"""From gray levels to occupancy values to cells: the arithmetic of ROS map_server."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from antnav.errors import MapError, ParameterError, shown
from antnav.values import is_whole
from antnav.world.grid import Cell, check_kind

#: Whose map_server: nav2's since jazzy, nav2's up to humble and iron, ROS 1's.
Rules = Literal["nav2", "humble", "ros1"]
RULES: tuple[Rules, ...] = ("nav2", "humble", "ros1")

_BAND = 2**20  # pixels of a colour image that are turned into wider numbers at once


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
        Gray, or colour.
    alpha : ndarray of uint8, shape (rows, cols), or None
        255 opaque.
    meta : MapMeta
        Thresholds, mode and negate.
    rules : {"nav2", "humble", "ros1"}
        nav2's since jazzy, nav2's up to humble and iron, ROS 1's. With n = 1 - gray / 255, or gray / 255 where negated:

        ======== ================================== ================================== ===============================
        mode     nav2 (float32)                     humble (float64)                   ros1 (float64)
        ======== ================================== ================================== ===============================
        gray     brightness, see `luma`             mean of the channels               mean of the channels
        trinary  n >= occupied: 100,                n > occupied: 100,                 n > occupied: 100,
                 n <= free: 0, else -1              n < free: 0, else -1               n < free: 0, else -1
        scale    ends as above, between             ends as above, between             ends as above, between
                 round(100 r), halves up            round(100 r), halves to even       floor(1 + 98 r)
        raw      gray 0..100 kept, others -1,       gray 0..100 kept, others -1,       gray's byte, inverted where
                 negate ignored                     negate ignored                     negated, as int8
        alpha    below 255 is -1,                   below 255 is -1 in scale mode,     0 is -1 in scale mode where n
                 except in raw mode                 a channel more in trinary mode     lies between the ends, a channel
                                                                                       more in trinary mode
        ======== ================================== ================================== ===============================

        where r = (n - free) / (occupied - free).

    Returns
    -------
    ndarray of int8, shape (rows, cols)
        0 free, 100 occupied, -1 unknown, 1..99 between. Row 0 is the top; ROS publishes the rows bottom first.
    """
    check_rules(rules)
    levels = {"nav2": _nav2_levels, "humble": _humble_levels, "ros1": _ros1_levels}[rules]
    mixed = alpha if rules != "nav2" and meta.mode == "trinary" else None
    table = levels(np.arange(256), meta)
    if pixels.ndim == 2 and mixed is None:
        values = table[pixels]
    else:
        values = np.empty(pixels.shape[:2], dtype=np.int8)
        step = max(1, _BAND // pixels.shape[1])
        for top in range(0, len(pixels), step):
            band = slice(top, top + step)
            if rules == "nav2":
                values[band] = table[luma(pixels[band])]
            else:
                values[band] = levels(_mean_channel(pixels[band], None if mixed is None else mixed[band]), meta)
    hides = {"nav2": ("trinary", "scale"), "humble": ("scale",), "ros1": ()}[rules]
    if alpha is not None and meta.mode in hides:
        values[alpha < 255] = -1
    if alpha is not None and rules == "ros1" and meta.mode == "scale":
        values[(alpha == 0) & (values > 0) & (values < 100)] = -1
    return values


def luma(colour: NDArray[np.uint8]) -> NDArray[np.int32]:
    """Gray levels as GraphicsMagick's GrayscaleType gives them, which nav2 asks for since jazzy.

    0.299 R + 0.587 G + 0.114 B, rounded to 16 bits, of which the upper 8 are kept: red 76, green 149, blue 29.

    Parameters
    ----------
    colour : ndarray of uint8, shape (rows, cols, 3)

    Returns
    -------
    ndarray of int32, shape (rows, cols)
        0..255; gray stays as it is.
    """
    weighted = colour.astype(np.int32) @ np.array([299, 587, 114], np.int32)
    gray: NDArray[np.int32] = (257 * weighted + 500) // 1000 // 257
    return gray


def _mean_channel(pixels: NDArray[np.uint8], alpha: NDArray[np.uint8] | None) -> NDArray[np.float64]:
    colour = pixels if pixels.ndim == 3 else np.repeat(pixels[..., None], 3, axis=2)
    total: NDArray[np.float64] = colour.sum(axis=2, dtype=np.float64)
    return total / 3 if alpha is None else (total + alpha) / 4


def _nav2_levels(gray: NDArray[Any], meta: MapMeta) -> NDArray[np.int8]:
    if meta.mode == "raw":
        return _raw_levels(gray)
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


def _humble_levels(gray: NDArray[Any], meta: MapMeta) -> NDArray[np.int8]:
    if meta.mode == "raw":
        return _raw_levels(np.floor(gray + 0.5))
    n = gray / 255 if meta.negate else 1.0 - gray / 255
    values = np.full(n.shape, -1, dtype=np.int8)
    if meta.mode == "scale":
        span = (meta.occupied_thresh - meta.free_thresh) or 1.0
        values = np.rint(np.clip((n - meta.free_thresh) / span, 0, 1) * 100).astype(np.int8)
    values[n < meta.free_thresh] = 0
    values[n > meta.occupied_thresh] = 100
    return values


def _raw_levels(gray: NDArray[Any]) -> NDArray[np.int8]:
    return np.where(gray <= 100, gray, -1).astype(np.int8)


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


def to_cells(values: ArrayLike, occupied_from: int = 100) -> NDArray[np.uint8]:
    """Turn occupancy values into `Cell` values, as nav2's static costmap layer does by default.

    Parameters
    ----------
    values : array_like of int, shape (rows, cols)
        From `occupancy` or of a ROS OccupancyGrid, row 0 at the top: -1 unknown, 0 free to 100 occupied. Read as
        unsigned bytes, as ROS does: -1 is 255, and what lies beyond 100 is occupied. Of a masked array, what is masked
        is unknown.
    occupied_from : int
        Values from here on are occupied, as with nav2's `lethal_cost_threshold`; -1 is unknown; all below are free,
        even 99 of scale mode, as with nav2's `trinary_costmap`. Lower it to keep out of cells that are rather full.

    Raises
    ------
    MapError
        `values` are not whole numbers in -128..127, or not two-dimensional.
    ParameterError
        `occupied_from` outside 1..100.
    """
    check_occupied_from(occupied_from)
    try:
        given = np.asarray(values)
    except (TypeError, ValueError) as error:
        raise MapError("rows of different lengths", "all rows of a map are equally long", "fill them up") from error
    check_kind(given.dtype, given.shape)
    if isinstance(values, np.ma.MaskedArray):
        given = np.where(np.ma.getmaskarray(values), np.int8(-1), given)
    if given.dtype.kind not in "ui" or given.min() < -128 or given.max() > 127:
        raise MapError(
            f"occupancy of type {given.dtype} with values {given.min()} to {given.max()}",
            "it is whole numbers: -1 unknown, 0 free to 100 occupied",
            "check what the numbers mean",
        )
    table = np.full(256, Cell.FREE, dtype=np.uint8)
    table[occupied_from:] = Cell.OCCUPIED
    table[255] = Cell.UNKNOWN
    cells: NDArray[np.uint8] = table[given.astype(np.int8).view(np.uint8)]
    return cells


def lost_grades(values: NDArray[np.int8], occupied_from: int) -> str:
    """What to warn of: values between free and occupied that `to_cells` makes free; empty where there are none."""
    lost = int(np.count_nonzero((values > 0) & (values < occupied_from)))
    if not lost:
        return ""
    return (
        f"{lost} cells of occupancy 1 to {occupied_from - 1} load as free: a map keeps no grades (maps.load_grades "
        "reads them); occupied_from in load_map closes the fuller ones"
    )


def check_rules(rules: str) -> None:
    """Refuse rules that are none of `RULES`."""
    if not isinstance(rules, str) or rules not in RULES:
        raise ParameterError(
            f"rules {shown(rules)}", "they are nav2, humble or ros1", "choose one; nav2 (since jazzy) is the default"
        )


def check_occupied_from(value: int) -> None:
    """Refuse an occupancy outside 1..100."""
    if not is_whole(value) or not 1 <= value <= 100:
        raise ParameterError(
            f"occupied_from {shown(value)}", "it is a whole number from 1 to 100", "leave it at 100, as nav2"
        )
