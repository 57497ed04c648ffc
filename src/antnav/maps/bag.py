"""Maps in bags of ROS: nav_msgs/OccupancyGrid and nav2_msgs/Costmap."""

from __future__ import annotations

import math
import warnings
from pathlib import Path

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
    if kind == messages.GRID:
        rows, cols, place = message.info.height, message.info.width, message.info
    else:
        rows, cols, place = message.metadata.size_y, message.metadata.size_x, message.metadata
    with located(path):
        check_size(rows, cols)
        if len(message.data) != rows * cols:
            raise MapError(f"{len(message.data)} cells", f"it has {rows} x {cols}", "record it again")
        data = np.asarray(message.data).reshape(rows, cols)[::-1]
        cells = _of_costs(data) if kind == messages.COSTMAP else _of_occupancy(data, occupied_from)
        corner, turn = place.origin.position, place.origin.orientation
        if not math.hypot(turn.x, turn.y) < 1e-3:
            raise MapError("orientation of the origin", "a map lies flat, turned by yaw only", "record a flat one")
        origin = (float(corner.x), float(corner.y), messages.yaw_of(turn))
        grid = GridMap(cells, _as_float32(place.resolution), origin, path.stem)
    if kind == messages.GRID and (lost := lost_grades(np.where(cells == Cell.FREE, data, 0), occupied_from)):
        warnings.warn(f"{path}: {lost}", MapWarning, stacklevel=3)
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
