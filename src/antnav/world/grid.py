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

from antnav.errors import MapError, MapSizeError, ParameterError, shown
from antnav.values import finite_number, is_whole, read_only
from antnav.world.kept import KeptWithMap

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
        Values of `Cell`: 0 free, 1 occupied, 2 unknown, 3 inflated; booleans mean occupied. Of a masked array, what is
        masked is unknown. Copied.
    resolution : float
        Side of a cell in metres, > 0. 1 where nothing better is known: then metres are cells, and with the default
        origin world coordinates are the paper's (eq. 2.1).
    origin : tuple of 3 floats
        World pose (x in m, y in m, yaw in rad) of the outer corner of the bottom left cell, as in ROS map_server.
    name : str
        For titles and reports; not part of the map's identity.
    covered : array_like of bool, shape (rows, cols), optional
        Inflated cells that are unknown beneath, as `inflated` notes them: what opens inflated cells again for a smaller
        robot leaves these closed. Not part of the map's identity.

    Raises
    ------
    MapError, MapSizeError
        Not two-dimensional, an unknown cell value, a resolution or an origin that is not a finite number, an origin so
        far away that coordinates of neighbouring cells round to each other, a name that is not text.

    Examples
    --------
    >>> import antnav as an
    >>> import numpy as np
    >>> grid = an.GridMap(np.array([[0, 0, 0], [0, 1, 0]]), resolution=0.5)
    >>> grid.inflated(0.5).cells  # 3: a wall within 0.5 m
    array([[0, 3, 0],
           [3, 1, 3]], dtype=uint8)

    Notes
    -----
    World coordinates have y up; rows count down. Two maps are equal when cells, resolution and origin are.
    """

    cells: NDArray[np.uint8] = field(repr=False)
    resolution: float = 1.0
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)
    name: str = ""
    covered: NDArray[np.bool_] | None = field(default=None, repr=False)
    kept: KeptWithMap = field(init=False, repr=False, default_factory=KeptWithMap)  #: see `world.terrain`

    def __post_init__(self) -> None:
        cells = _checked_cells(self.cells)
        resolution = _finite("resolution", self.resolution)
        if resolution <= 0:
            raise MapError(
                f"resolution {resolution}", "a cell has a side above 0 m", "give metres per cell, such as 0.05"
            )
        try:
            x, y, yaw = self.origin
        except (TypeError, ValueError) as error:
            raise MapError(f"origin {shown(self.origin)}", "an origin is x, y and yaw", "give three numbers") from error
        origin = tuple(_finite("origin", value) + 0.0 for value in (x, y, yaw))
        _check_place(cells.shape, resolution, origin)
        if not isinstance(self.name, str):
            raise MapError(f"name {shown(self.name)}", "a name is text", "give a string")
        if self.covered is not None:
            try:
                covered = np.array(self.covered, dtype=np.bool_)
            except (TypeError, ValueError):
                covered = np.empty(0, np.bool_)
            if covered.shape != cells.shape:
                rule = f"it is a truth value for each cell, of shape {cells.shape}"
                raise MapError(f"covered {shown(self.covered)}", rule, "leave it to `inflated`")
            object.__setattr__(self, "covered", read_only(covered))
        own = np.array(cells, dtype=np.uint8, order="C")
        object.__setattr__(self, "cells", read_only(own))
        object.__setattr__(self, "resolution", resolution)
        object.__setattr__(self, "origin", origin)

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
        return {name: value for name, value in self.__dict__.items() if name not in ("kept", "rows_to_wall", "_yaw")}

    def __setstate__(self, state: dict[str, Any]) -> None:
        read_only(state["cells"])  # pickling drops the flag
        if state["covered"] is not None:
            read_only(state["covered"])
        self.__dict__.update(state, kept=KeptWithMap())

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

    @cached_property
    def rows_to_wall(self) -> NDArray[np.int32]:
        """Rows from each cell to the nearest occupied one of its column, 2**30 or more where there is none."""
        occupied, rows = self.cells == Cell.OCCUPIED, np.arange(self.rows, dtype=np.int32)[:, None]
        above = np.maximum.accumulate(np.where(occupied, rows, np.int32(-(2**30))), axis=0)
        below = np.minimum.accumulate(np.where(occupied, rows, np.int32(2**30 + self.rows))[::-1], axis=0)[::-1]
        distance: NDArray[np.int32] = np.minimum(rows - above, below - rows)
        return read_only(distance)

    def inflated(self, radius: float, *, strict: bool = False) -> GridMap:
        """Close every cell that is too near to an occupied one for a robot.

        Parameters
        ----------
        radius : float
            Radius of the robot in metres, >= 0. Unknown cells do not spread.
        strict : bool
            False (default): cells are closed whose centre lies within `radius` of the centre of an occupied cell, as
            for the inscribed radius in nav2's inflation layer (the comparison is <=). The walls' edges may then be
            half a cell's diagonal nearer than the radius. True: cells are closed whose centre lies nearer than
            `radius` to any point of an occupied cell. Every move between open cells then keeps the radius on its whole
            length under corner rule "forbid"; "graze" and "allow" can pass a corner on a diagonal move nearer than
            that. Either is exact. Where a path begins and ends within its cells is up to start and goal.

        Returns
        -------
        GridMap
            The same map with those cells `INFLATED`; the occupied ones stay `OCCUPIED`, so inflating again with
            a larger radius starts from the walls.
        """
        number = finite_number(radius)
        if not number >= 0:
            rule = "a radius is a finite number of metres, >= 0"
            raise ParameterError(f"radius {shown(radius)}", rule, "give one, such as 0.2")
        occupied = self.cells == Cell.OCCUPIED
        if number == 0 or not occupied.any():
            return self
        if strict:
            near = self._nearer_than(number / self.resolution * (1 - 1e-12))
        else:
            from scipy import ndimage

            # 0.3 / 0.1 is a hair below 3
            near = ndimage.distance_transform_edt(~occupied) <= number / self.resolution * (1 + 1e-12)
        unknown = near & (self.cells == Cell.UNKNOWN)
        if self.covered is not None:
            unknown |= self.covered
        return replace(
            self,
            cells=np.where(near & ~occupied, np.uint8(Cell.INFLATED), self.cells),
            covered=unknown if unknown.any() else None,
        )

    def _nearer_than(self, radius: float) -> NDArray[np.bool_]:
        """Cells whose centre is nearer than `radius`, in cells, to the square of an occupied one."""
        near = np.zeros(self.shape, np.bool_)
        to_wall = self.rows_to_wall
        for aside in range(min(math.ceil(radius + 0.5), self.cols)):  # columns to the occupied cell, on either side
            along = 0.5 + math.sqrt(radius**2 - max(aside - 0.5, 0.0) ** 2)
            closed = to_wall < along
            near[:, aside:] |= closed[:, : self.cols - aside]
            near[:, : self.cols - aside] |= closed[:, aside:]
        return near

    def cell_to_world(self, cells: ArrayLike) -> NDArray[np.float64]:
        """World coordinates (x, y) in metres of cell centres.

        Parameters
        ----------
        cells : array_like, shape (..., 2)
            Row and column, from the top left, counted from 0. Fractions are allowed.
        """
        cells = _pairs("cell", cells)
        x = (cells[..., 1] + 0.5) * self.resolution
        y = (self.rows - cells[..., 0] - 0.5) * self.resolution
        cos, sin = math.cos(self.origin[2]), math.sin(self.origin[2])
        return np.stack((self.origin[0] + cos * x - sin * y, self.origin[1] + sin * x + cos * y), axis=-1)

    def corners(self) -> NDArray[np.float64]:
        """World coordinates of the map's outer corners, shape (4, 2): from the bottom left clockwise."""
        low, high = (self.rows - 0.5, -0.5), (-0.5, self.cols - 0.5)
        return self.cell_to_world([low, (high[0], low[1]), high, (low[0], high[1])])

    def world_to_cell(self, points: ArrayLike) -> NDArray[np.int64]:
        """Row and column of the cells that hold world points; inverse of `cell_to_world`, also outside the map.

        Parameters
        ----------
        points : array_like, shape (..., 2)
            x and y in metres, finite.

        Raises
        ------
        ParameterError
            No points, or one so far away that its cell has no exact number.
        """
        given, points = points, _pairs("point", points)
        cos, sin = math.cos(self.origin[2]), math.sin(self.origin[2])
        with np.errstate(all="ignore"):  # of numbers near the largest there are
            dx, dy = points[..., 0] - self.origin[0], points[..., 1] - self.origin[1]
            col = np.floor((cos * dx + sin * dy) / self.resolution)
            row = self.rows - 1 - np.floor((cos * dy - sin * dx) / self.resolution)
        cells = np.stack((row, col), axis=-1)
        if not (np.abs(cells) < 2.0**53).all():
            raise ParameterError(
                f"point {shown(given)}",
                "it lies so far away that cells there have no exact number",
                "give a nearer one",
            )
        return cells.astype(np.int64)

    def world_to_plane(self, points: ArrayLike) -> NDArray[np.float64]:
        """World points in cells: x to the right, y down, whole numbers at the cells' centres.

        Parameters
        ----------
        points : array_like, shape (..., 2)
            x and y in metres.
        """
        dx, dy = np.moveaxis((_pairs("point", points) - self.origin[:2]) / self.resolution, -1, 0)
        cos, sin = math.cos(self.origin[2]), math.sin(self.origin[2])
        return np.stack((cos * dx + sin * dy - 0.5, self.rows - 0.5 - (cos * dy - sin * dx)), axis=-1)

    def cell_at(self, point: tuple[float, float]) -> tuple[int, int]:
        """`world_to_cell` of one point of two floats, in a tenth of the time."""
        cos, sin = self._yaw
        try:
            x, y = map(float, point)
        except (TypeError, ValueError, OverflowError) as error:
            raise ParameterError(
                f"point {shown(point)}", "it is two numbers, x and y in metres", "give both"
            ) from error
        dx, dy = x - self.origin[0], y - self.origin[1]
        col = (cos * dx + sin * dy) / self.resolution
        row = (cos * dy - sin * dx) / self.resolution
        if not (abs(row) < 2.0**52 and abs(col) < 2.0**52):
            return tuple(self.world_to_cell(point).tolist())
        return self.rows - 1 - math.floor(row), math.floor(col)

    @cached_property
    def _yaw(self) -> tuple[float, float]:
        return math.cos(self.origin[2]), math.sin(self.origin[2])

    def cell_to_number(self, cell: tuple[int, int]) -> int:
        """The paper's cell number n = 1, 2, ... row by row from the top left (section 2)."""
        row, col = self.checked_cell(cell)
        return row * self.cols + col + 1

    def number_to_cell(self, number: int) -> tuple[int, int]:
        """(row, col) of the paper's cell number."""
        if not is_whole(number) or not 1 <= number <= self.rows * self.cols:
            raise ParameterError(
                f"cell number {shown(number)}", f"numbers are 1..{self.rows * self.cols}", "choose one of them"
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
        try:
            row, col = cell
            return bool(0 <= row < self.rows and 0 <= col < self.cols)
        except (TypeError, ValueError) as error:
            raise ParameterError(f"cell {shown(cell)}", "a cell is (row, col)", "give two whole numbers") from error

    def closed(self, mask: NDArray[np.bool_]) -> GridMap:
        """The map with the free and unknown cells of a mask, shape (rows, cols), closed as inflated ones are."""
        if not (isinstance(mask, np.ndarray) and mask.dtype == np.bool_ and mask.shape == self.shape):
            rule = f"it is an array of truths, {self.rows} x {self.cols}"
            raise ParameterError(f"mask {shown(mask)}", rule, "give one of the map's shape")
        mask = mask & np.isin(self.cells, (Cell.FREE, Cell.UNKNOWN))
        if not mask.any():
            return self
        return self.kept.closed.of(
            mask.tobytes(), lambda: replace(self, cells=np.where(mask, np.uint8(Cell.INFLATED), self.cells))
        )

    def checked_cell(self, cell: tuple[int, int]) -> tuple[int, int]:
        """A cell of the map as two whole numbers, or a `ParameterError`."""
        whole = whole_pair("cell", cell)
        if not self.contains(whole):
            rule = f"rows are 0..{self.rows - 1}, columns 0..{self.cols - 1}"
            raise ParameterError(f"cell {shown(whole)}", rule, "choose one of them")
        return whole


def whole_pair(end: str, given: Any) -> tuple[int, int]:
    """A cell as two whole numbers, or a `ParameterError`."""
    try:
        row, col = (_whole(part) for part in given)
    except (TypeError, ValueError, OverflowError) as error:
        rule = "a cell is a row and a column"
        raise ParameterError(f"{end} {shown(given)}", rule, "give two whole numbers") from error
    return row, col


def _whole(value: Any) -> int:
    number = int(value)
    if isinstance(value, bool | np.bool_ | str) or number != value:
        raise ValueError
    return number


def check_kind(dtype: np.dtype[Any], shape: tuple[int, ...]) -> None:
    """Refuse an array by its type and shape, before its values are looked at.

    Raises
    ------
    MapError, MapSizeError
        Not numbers; not two-dimensional; empty or too large.
    """
    if len(shape) != 2:
        layers = len(shape) == 3 and shape[2] <= 4
        raise MapError(
            f"cells of shape {shape}",
            "a map has two dimensions",
            "for a picture, save it as a PNG file and load that" if layers else "pass an array of (rows, cols)",
        )
    if dtype.kind not in "buif":
        remedy = "convert them, array.astype(int), and see that 0 is free and 1 occupied"
        raise MapError(f"cells of type {dtype}", "cells are whole numbers or booleans", remedy)
    check_size(*shape)


def check_values(cells: NDArray[Any]) -> None:
    """Refuse numbers that are not values of `Cell`.

    Raises
    ------
    MapError
        A fraction, or a number outside 0..3. The remedy depends on what the numbers look like, so that none inverts
        or closes the map.
    """
    low, high = cells.min(), cells.max()
    whole = cells.dtype.kind != "f" or bool((cells == np.floor(cells)).all())
    if cells.dtype.kind != "f" and low >= 0 and high <= max(Cell):
        return
    if whole and low >= 0 and high <= max(Cell):
        remedy = "convert them, array.astype('uint8'), if 0 is free and 1 occupied"
    elif whole and low >= -1 and high <= 100:
        remedy = (
            "for OccupancyGrid values take antnav.maps.to_cells(array.astype('int8')); load_map has values='occupancy'"
        )
    elif whole and low >= 0 and high <= 255:
        remedy = "for a gray image save it as a PNG file and load that; for costs compare with the lowest that blocks"
    elif low >= 0 and high <= 1:
        remedy = "for probabilities of being occupied pass array > 0.65; where 1 means free, 1 - array first"
    else:
        remedy = "say which of them are obstacles, as an array of booleans"
    raise MapError(
        f"cells of type {cells.dtype} with values {low} to {high}",
        "cells are 0 free, 1 occupied, 2 unknown or 3 inflated",
        remedy,
    )


def _checked_cells(given: Any) -> NDArray[Any]:
    try:
        cells = np.asarray(given)
    except (TypeError, ValueError) as error:
        raise MapError("rows of different lengths", "all rows of a map are equally long", "fill them up") from error
    check_kind(cells.dtype, cells.shape)
    mask = np.ma.getmaskarray(given) if isinstance(given, np.ma.MaskedArray) else None
    if mask is not None:
        cells = np.where(mask, np.uint8(Cell.UNKNOWN), cells)
    check_values(cells)
    return cells


def _check_place(shape: tuple[int, ...], resolution: float, origin: tuple[float, ...]) -> None:
    """Refuse a place where the centre of a cell could round into the next: half a cell, after a few roundings."""
    gap = math.ulp(max(abs(origin[0]), abs(origin[1])) + max(shape) * resolution)
    if not gap <= resolution / 8:
        raise MapError(
            f"origin {origin} with cells of {resolution:g} m",
            f"coordinates there are {gap:g} m apart in double precision, too far to tell cells apart",
            "give coordinates that count from a nearer point",
        )


def _finite(name: str, value: Any) -> float:
    number = finite_number(value)
    if math.isnan(number):
        raise MapError(f"{name} {shown(value)}", f"{name} is made of finite numbers", "give numbers, such as 0.05")
    return number


def _pairs(what: str, values: ArrayLike) -> NDArray[np.float64]:
    try:
        pairs = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        pairs = np.empty(0)
    if pairs.shape[-1:] != (2,) or not np.isfinite(pairs).all():
        raise ParameterError(f"{what} {shown(values)}", "it is two finite numbers, or rows of two", "give a pair")
    return pairs
