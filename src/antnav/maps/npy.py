"""NumPy files: a two-dimensional array of cell values."""

from __future__ import annotations

import io
import os
import warnings
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np

from antnav.errors import MapFormatError
from antnav.files import write_whole
from antnav.grid import Cell, GridMap, check_size
from antnav.maps.source import open_binary, unreadable


def read(path: Path) -> GridMap:
    """Read a .npy array of booleans (True is occupied) or of `Cell` values, row 0 at the top; resolution 1.

    Nothing is unpickled, and nothing is allocated before shape, type and length of the file have been checked.

    Raises
    ------
    MapFileError, MapFormatError, MapSizeError
        Missing; a damaged header, another type or shape, values that are not cells, a truncated file; too large.
    """
    with open_binary(path) as stream:
        shape, fortran_order, dtype = _read_header(stream, path)
        if len(shape) != 2 or dtype.kind not in "bui":
            raise MapFormatError(
                f"{path} of type {dtype} and shape {shape}",
                "a map is an array of integers or booleans with two dimensions",
                "convert it, for instance (array > 0.5).astype('uint8')",
            )
        rows, cols = shape
        check_size(rows, cols, str(path))
        length = rows * cols * dtype.itemsize
        left = os.fstat(stream.fileno()).st_size - stream.tell()
        if left < length:
            raise MapFormatError(
                f"{path} with {left} bytes of cells", f"its header says {length}", "write the file again"
            )
        try:
            data = stream.read(length)
        except OSError as error:
            raise unreadable(path, error) from error
    array = np.frombuffer(data, dtype=dtype).reshape(shape, order="F" if fortran_order else "C")
    if dtype.kind != "b" and (array.min() < 0 or array.max() > max(Cell)):
        raise MapFormatError(
            f"{path} with values {array.min()} to {array.max()}",
            "cells are 0 free, 1 occupied, 2 unknown or 3 inflated",
            "convert it, for instance (array >= 100).astype('uint8') for ROS occupancy values",
        )
    return GridMap(array.astype(np.uint8), name=path.stem)


def _read_header(stream: BinaryIO, path: Path) -> tuple[tuple[int, ...], bool, np.dtype[Any]]:
    readers = {(1, 0): np.lib.format.read_array_header_1_0, (2, 0): np.lib.format.read_array_header_2_0}
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of Python 2 headers and of odd escapes in damaged ones
            reader = readers[np.lib.format.read_magic(stream)]
            return reader(stream)
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
