"""GridMap: an immutable occupancy grid that knows where it lies in the world."""

from __future__ import annotations

import hashlib
import math
from dataclasses import dataclass, field, replace
from enum import IntEnum
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from antnav.errors import MapError, MapSizeError, ParameterError

#: Cells that a map may have: 11585 x 11585. Larger headers are refused before anything is allocated.
MAX_CELLS = 2**27


class Cell(IntEnum):
    """What a cell of a map holds.

    - FREE: a robot may stand there
    - OCCUPIED: a wall or another obstacle
    - UNKNOWN: nobody has seen it; closed unless a problem allows it
    - INFLATED: free or unknown by itself, but nearer to an occupied cell than the robot's radius
    """

    FREE = 0
    OCCUPIED = 1
    UNKNOWN = 2
    INFLATED = 3


def check_size(rows: int, cols: int, source: str = "the map") -> None:
    """Refuse a size before memory is asked for.

    Raises
    ------
    MapSizeError
        A side is below 1, or the map has more than `MAX_CELLS` cells.
    """
    if rows < 1 or cols < 1:
        raise MapSizeError(
            f"{source} has {rows} rows and {cols} columns", "a map has at least one cell", "check the file"
        )
    if rows * cols > MAX_CELLS:
        raise MapSizeError(
            f"{source} has {rows} x {cols} = {rows * cols} cells",
            f"at most {MAX_CELLS} cells are accepted",
            "crop the map or lower its resolution",
        )


@dataclass(frozen=True, eq=False)
class GridMap:
    """An occupancy grid, row 0 at the top, with its place in the world.

    Parameters
    ----------
    cells : array_like, shape (rows, cols)
        Values of `Cell`: 0 free, 1 occupied, 2 unknown, 3 inflated; booleans mean occupied. Copied.
    resolution : float
        Side of a cell in metres, > 0. 1 where nothing better is known: then metres are cells, and with the default
        origin world coordinates are the paper's (eq. 2.1).
    origin : tuple of 3 floats
        World pose (x in m, y in m, yaw in rad) of the outer corner of the bottom left cell, as in ROS map_server.
    name : str
        For titles and reports; not part of the map's identity.

    Raises
    ------
    MapError, MapSizeError
        Not two-dimensional, an unknown cell value, a resolution or an origin that is not a finite number.

    Notes
    -----
    World coordinates have y up; rows count down. Two maps are equal when cells, resolution and origin are.
    """

    cells: NDArray[np.uint8] = field(repr=False)
    resolution: float = 1.0
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)
    name: str = ""

    def __post_init__(self) -> None:
        cells = np.asarray(self.cells)
        if cells.ndim != 2:
            raise MapError(f"cells of shape {cells.shape}", "a map has two dimensions", "pass an array (rows, cols)")
        check_size(*cells.shape)
        if cells.dtype.kind not in "bui" or cells.min() < 0 or cells.max() > max(Cell):
            low, high = cells.min(), cells.max()
            raise MapError(
                f"cells of type {cells.dtype} with values {low} to {high}",
                "cells are 0 free, 1 occupied, 2 unknown or 3 inflated",
                "convert the array, for instance (image < 128) for dark obstacles",
            )
        resolution = _finite("resolution", self.resolution)
        if resolution <= 0:
            raise MapError(
                f"resolution {resolution}", "a cell has a side above 0 m", "give metres per cell, such as 0.05"
            )
        if len(self.origin) != 3:
            raise MapError(f"origin {self.origin}", "an origin is x, y and yaw", "give three numbers")
        own = np.array(cells, dtype=np.uint8, order="C")
        own.flags.writeable = False
        object.__setattr__(self, "cells", own)
        object.__setattr__(self, "resolution", resolution)
        object.__setattr__(self, "origin", tuple(_finite("origin", value) + 0.0 for value in self.origin))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, GridMap):
            return NotImplemented
        same_place = self.resolution == other.resolution and self.origin == other.origin
        return same_place and np.array_equal(self.cells, other.cells)

    def __hash__(self) -> int:
        return hash(self.digest)

    def __repr__(self) -> str:
        name = f"{self.name!r}, " if self.name else ""
        return f"GridMap({name}{self.rows} x {self.cols} cells, resolution={self.resolution}, origin={self.origin})"

    def _repr_html_(self) -> str:
        from antnav.markup import map_html

        return map_html(self.cells, repr(self))

    def __getstate__(self) -> dict[str, Any]:
        return {name: value for name, value in self.__dict__.items() if name != "derived"}

    def __setstate__(self, state: dict[str, Any]) -> None:
        state["cells"].flags.writeable = False  # pickling drops the flag
        self.__dict__.update(state)

    @cached_property
    def derived(self) -> dict[Any, Any]:
        """What others have worked out from this map, each by its own key: kept with the map, left out of pickles."""
        return {}

    @property
    def rows(self) -> int:
        """Number of rows."""
        return int(self.cells.shape[0])

    @property
    def cols(self) -> int:
        """Number of columns, N in the paper."""
        return int(self.cells.shape[1])

    @property
    def shape(self) -> tuple[int, int]:
        """(rows, cols)."""
        return self.rows, self.cols

    @cached_property
    def digest(self) -> str:
        """SHA-256 of size, cells, resolution and origin, as hexadecimal digits."""
        head = f"{self.rows} {self.cols} {self.resolution!r} {self.origin!r}\n".encode()
        return hashlib.sha256(head + self.cells.tobytes()).hexdigest()

    def counts(self) -> dict[str, int]:
        """Number of cells of each kind, by lower-case name."""
        numbers = np.bincount(self.cells.ravel(), minlength=len(Cell))
        return {kind.name.lower(): int(numbers[kind]) for kind in Cell}

    def passable(self, *, unknown: bool = False) -> NDArray[np.bool_]:
        """Cells that a robot may enter, shape (rows, cols): the free ones, and with `unknown` the unknown ones too."""
        free: NDArray[np.bool_] = self.cells == Cell.FREE
        return free | (self.cells == Cell.UNKNOWN) if unknown else free

    def inflated(self, radius: float) -> GridMap:
        """Close every cell whose centre lies within `radius` metres of the centre of an occupied cell.

        Parameters
        ----------
        radius : float
            Radius of the robot in metres, >= 0. The distance is Euclidean and exact, the comparison is <=, as for the
            inscribed radius in nav2's inflation layer. Unknown cells do not spread.

        Returns
        -------
        GridMap
            The same map with those cells `INFLATED`; the occupied ones stay `OCCUPIED`, so inflating again with
            another radius starts from the walls.
        """
        if not isinstance(radius, int | float) or not 0 <= radius < math.inf:
            rule = "a radius is a finite number of metres, >= 0"
            raise ParameterError(f"radius {radius!r}", rule, "give one, such as 0.2")
        occupied = self.cells == Cell.OCCUPIED
        if radius == 0 or not occupied.any():
            return self
        from scipy import ndimage

        distance = ndimage.distance_transform_edt(~occupied)
        near = distance <= radius / self.resolution * (1 + 1e-12)  # 0.3 / 0.1 is a hair below 3
        return replace(self, cells=np.where(near & ~occupied, np.uint8(Cell.INFLATED), self.cells))

    def cell_to_world(self, cells: ArrayLike) -> NDArray[np.float64]:
        """World coordinates (x, y) in metres of cell centres.

        Parameters
        ----------
        cells : array_like, shape (..., 2)
            Row and column, from the top left, counted from 0. Fractions are allowed.
        """
        cells = np.asarray(cells, dtype=np.float64)
        x = (cells[..., 1] + 0.5) * self.resolution
        y = (self.rows - cells[..., 0] - 0.5) * self.resolution
        cos, sin = math.cos(self.origin[2]), math.sin(self.origin[2])
        return np.stack((self.origin[0] + cos * x - sin * y, self.origin[1] + sin * x + cos * y), axis=-1)

    def world_to_cell(self, points: ArrayLike) -> NDArray[np.int64]:
        """Row and column of the cells that hold world points; inverse of `cell_to_world`, also outside the map.

        Parameters
        ----------
        points : array_like, shape (..., 2)
            x and y in metres, finite.
        """
        points = np.asarray(points, dtype=np.float64)
        dx, dy = points[..., 0] - self.origin[0], points[..., 1] - self.origin[1]
        cos, sin = math.cos(self.origin[2]), math.sin(self.origin[2])
        col = np.floor((cos * dx + sin * dy) / self.resolution)
        row = self.rows - 1 - np.floor((cos * dy - sin * dx) / self.resolution)
        return np.stack((row, col), axis=-1).astype(np.int64)

    def cell_to_number(self, cell: tuple[int, int]) -> int:
        """The paper's cell number n = 1, 2, ... row by row from the top left (section 2)."""
        row, col = cell
        if not self.contains(cell):
            raise ParameterError(
                f"cell {cell}", f"rows are 0..{self.rows - 1}, columns 0..{self.cols - 1}", "choose one of them"
            )
        return int(row) * self.cols + int(col) + 1

    def number_to_cell(self, number: int) -> tuple[int, int]:
        """(row, col) of the paper's cell number."""
        if not 1 <= number <= self.rows * self.cols:
            raise ParameterError(
                f"cell number {number}", f"numbers are 1..{self.rows * self.cols}", "choose one of them"
            )
        return (number - 1) // self.cols, (number - 1) % self.cols

    def number_to_paper(self, number: int) -> tuple[float, float]:
        """The paper's coordinates (x, y) of the centre of cell n, in cells, y up: eq. (2.1).

        x = mod(n, N) - 0.5, or N - 0.5 where mod(n, N) = 0; y = rows + 0.5 - ceil(n / N).
        """
        row, col = self.number_to_cell(number)
        return col + 0.5, self.rows - row - 0.5

    def contains(self, cell: tuple[int, int]) -> bool:
        """Whether (row, col) lies inside the map."""
        return 0 <= cell[0] < self.rows and 0 <= cell[1] < self.cols


def _finite(name: str, value: float) -> float:
    try:
        number = float(value)
    except (TypeError, ValueError):
        number = math.nan
    if not math.isfinite(number):
        raise MapError(f"{name} {value!r}", f"{name} is made of finite numbers", "give numbers, such as 0.05")
    return number
