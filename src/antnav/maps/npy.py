"""NumPy files: a two-dimensional array of cell values."""

from __future__ import annotations

import io
import math
import os
import warnings
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from antnav.errors import MapFormatError
from antnav.files import write_whole
from antnav.maps.numbers import Values, to_grid
from antnav.maps.source import located, open_binary, unreadable
from antnav.world.grid import Cell, GridMap, check_kind, check_values


def read(path: Path, values: Values = "cells", invert: bool = False, occupied_from: int = 100) -> GridMap:
    """Read a .npy array of booleans (True is occupied) or of `Cell` values, row 0 at the top; resolution 1.

    Parameters
    ----------
    path : Path
        The file.
    values, invert, occupied_from
        See `to_grid`.

    Raises
    ------
    MapFileError, MapFormatError, MapSizeError
        See `read_array`; values that are not cells.
    """
    array = read_array(path)
    if values == "occupancy" and (array.dtype.kind not in "ui" or array.min() < -1 or array.max() > 100):
        raise MapFormatError(
            f"{path} of type {array.dtype} with values {array.min()} to {array.max()}",
            "OccupancyGrid values are whole numbers, -1 (unknown) and 0 to 100",
            "check what the numbers mean",
        )
    if values == "cells":
        with located(path):
            check_values(array)
    return to_grid(array, path, values, invert, occupied_from)


def read_array(path: Path) -> NDArray[Any]:
    """Read an array of numbers or booleans with two dimensions.

    Nothing is unpickled, and nothing is allocated before shape, type and length of the file have been checked.

    Raises
    ------
    MapFileError, MapFormatError, MapSizeError
        Missing; a damaged header, another type or shape, a truncated file; too large.
    """
    with open_binary(path) as stream:
        shape, fortran_order, dtype = _read_header(stream, path)
        with located(path):
            check_kind(dtype, shape)
        length = math.prod(shape) * dtype.itemsize
        left = os.fstat(stream.fileno()).st_size - stream.tell()
        if left < length:
            raise MapFormatError(
                f"{path} with {left} bytes of cells", f"its header says {length}", "write the file again"
            )
        try:
            data = stream.read(length)
        except OSError as error:
            raise unreadable(path, error) from error
    return np.frombuffer(data, dtype=dtype).reshape(shape, order="F" if fortran_order else "C")


def _read_header(stream: BinaryIO, path: Path) -> tuple[tuple[int, ...], bool, np.dtype[Any]]:
    readers = {(1, 0): np.lib.format.read_array_header_1_0, (2, 0): np.lib.format.read_array_header_2_0}
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of Python 2 headers and of odd escapes in damaged ones
            shape, fortran_order, dtype = readers[np.lib.format.read_magic(stream)](stream)
            if not all(type(side) is int for side in shape):
                raise ValueError(f"shape {shape} is not made of whole numbers")
            return shape, fortran_order, dtype
    except Exception as error:  # ValueError as documented; KeyError, OverflowError... from damaged headers
        raise MapFormatError(
            f"{path}: {str(error) or type(error).__name__}",
            "the file must begin with a NumPy header of version 1 or 2",
            "write it with numpy.save",
        ) from error


def write(grid: GridMap, path: Path) -> None:
    """Write the cells as uint8, inflated ones as occupied. Resolution and origin are not kept."""
    stream = io.BytesIO()
    cells = np.where(grid.cells == Cell.INFLATED, np.uint8(Cell.OCCUPIED), grid.cells)
    np.lib.format.write_array(stream, cells, allow_pickle=False)
    write_whole(path, stream.getvalue())
