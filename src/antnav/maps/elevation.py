"""Heights from a file: .npy, a gray image, or a text of numbers."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from antnav.errors import MapFormatError
from antnav.maps import npy
from antnav.maps.image import read_gray
from antnav.maps.source import read_bytes, split_lines
from antnav.world.grid import check_size


def read_elevation(path: Path) -> NDArray[Any]:
    """The numbers of a file, row 0 at the top: .npy, .csv or .txt as they are, else the gray levels of an image.

    Raises
    ------
    MapFileError, MapFormatError, MapSizeError
        The file is missing; damaged, or no such numbers; too large.
    """
    suffix = path.suffix.lower()
    if suffix == ".npy":
        return npy.read_array(path)
    if suffix not in (".csv", ".txt"):
        return read_gray(path)
    data = read_bytes(path)
    lines = [line.decode("latin-1") for line in split_lines(data, str(path)) if line]
    separator = next((mark for mark in ",;" if lines and mark in lines[0]), None)
    try:
        numbers = np.loadtxt(lines, delimiter=separator, ndmin=2, comments=None) if lines else np.empty((0, 0))
    except ValueError as error:
        rule = "it has a number for each cell, by commas, semicolons or blanks, a row a line"
        raise MapFormatError(f"{path}: {error}", rule, "save it with numpy.savetxt or numpy.save") from error
    rows, cols = numbers.shape
    check_size(rows, cols, str(path))
    return numbers
