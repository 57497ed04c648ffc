"""Maps in bags of ROS: nav_msgs/OccupancyGrid and nav2_msgs/Costmap."""

from __future__ import annotations

import math
import warnings
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from antnav.errors import MapError
from antnav.exchange import bag, messages
from antnav.maps.occupancy import lost_grades, to_cells
from antnav.maps.source import MapWarning, located
from antnav.world.grid import Cell, GridMap, check_size

#: nav2's costs: where an obstacle is, where a robot's centre would touch one, and what nobody has seen.
_LETHAL, _INSCRIBED, _NO_INFORMATION = 254, 253, 255


def read(path: Path, topic: str | None = None, occupied_from: int = 100) -> GridMap:
    """The last map of a bag: an OccupancyGrid by `to_cells`; of a Costmap what is lethal, inscribed or unknown.

    Occupancy 99 is what nav2 publishes for inscribed cells, so they are closed as inflated ones.

    Raises
    ------
    MapFileError, MapFormatError, MapSizeError
        Missing or damaged; no map in it; too large.
    ParameterError
        Maps on several topics and none named; rosbags is missing.
    """
    kind, message = bag.latest(path, (messages.GRID, messages.COSTMAP), topic)
    return grid_of(message, path, path.stem, occupied_from, costmap=kind == messages.COSTMAP)


def grid_of(message: Any, source: Path | str, name: str, occupied_from: int = 100, *, costmap: bool) -> GridMap:
    """The map of a message, of rosbags or of rclpy, an OccupancyGrid or a Costmap.

    Parameters
    ----------
    source : path-like
        For errors and warnings.

    Raises
    ------
    MapFormatError, MapSizeError
        Its parts do not fit together; too large.
    """
    place = message.metadata if costmap else message.info
    rows, cols = (place.size_y, place.size_x) if costmap else (place.height, place.width)
    with located(source):
        check_size(rows, cols)
        if len(message.data) != rows * cols:
            raise MapError(f"{len(message.data)} cells", f"it has {rows} x {cols}", "record it again")
        data = np.asarray(message.data).reshape(rows, cols)[::-1]
        cells = _of_costs(data) if costmap else _of_occupancy(data, occupied_from)
        corner, turn = place.origin.position, place.origin.orientation
        if not math.hypot(turn.x, turn.y) < 1e-3:
            raise MapError("orientation of the origin", "a map lies flat, turned by yaw only", "record a flat one")
        origin = (float(corner.x), float(corner.y), messages.yaw_of(turn))
        grid = GridMap(cells, _as_float32(place.resolution), origin, name)
    if not costmap and (lost := lost_grades(np.where(cells == Cell.FREE, data, 0), occupied_from)):
        warnings.warn(f"{source}: {lost}", MapWarning, stacklevel=4)  # the caller of load_map
    return grid


def _of_occupancy(data: NDArray[np.int8], occupied_from: int) -> NDArray[np.uint8]:
    cells = to_cells(data, occupied_from)
    cells[(data == messages.OCCUPANCY[Cell.INFLATED]) & (cells == Cell.FREE)] = Cell.INFLATED
    return cells


def _of_costs(data: NDArray[np.uint8]) -> NDArray[np.uint8]:
    table = np.full(256, Cell.FREE, np.uint8)
    table[[_LETHAL, _INSCRIBED, _NO_INFORMATION]] = Cell.OCCUPIED, Cell.INFLATED, Cell.UNKNOWN
    return table[data]


def _as_float32(resolution: float) -> float:
    """The shortest number that the message's float32 may have come from: 0.05, not 0.05000000074505806."""
    return float(str(np.float32(resolution)))


def write(grid: GridMap, path: Path) -> None:
    """A bag with the map as OccupancyGrid on /map; inflated cells have 99, as in nav2's costmaps."""
    bag.write(path, [messages.grid_message(grid, "map", 0.0)], 0)
