"""Maps from files that somebody dropped on the page: they come from anywhere, so they are looked at first."""

from __future__ import annotations

import io
import os
import tempfile
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from antnav.errors import MapFormatError, MapSizeError, ParameterError
from antnav.maps import load_map
from antnav.maps.map_server import read_meta
from antnav.view.messages import MOST_CELLS
from antnav.world.grid import GridMap

_IMAGES = (".png", ".pgm", ".ppm", ".pbm", ".bmp", ".gif", ".webp", ".jpg", ".jpeg", ".tif", ".tiff")
_ACCEPTED = (*_IMAGES, ".yaml", ".yml", ".map", ".txt", ".csv", ".tsv", ".npy")


def map_of(files: Mapping[str, bytes]) -> GridMap:
    """The map of a file, or of a YAML file and its image.

    Raises
    ------
    MapError, ParameterError
        It is none, or too large for the view.
    """
    names = [name for name in files if not name.lower().endswith((".yaml", ".yml"))]
    chosen = next((name for name in files if name not in names), names[0] if names else "")
    for name, content in files.items():
        if Path(name).name != name or name in ("", ".", "..") or "\0" in name:
            raise ParameterError(f"file {name!r}", "a dropped file has a name without folders", "rename it")
        if not name.lower().endswith(_ACCEPTED):
            raise MapFormatError(f"{name}", f"the view reads {', '.join(_ACCEPTED)}", "convert it: antnav maps convert")
        _check_size(name, content)
    with tempfile.TemporaryDirectory(prefix="antnav-view-") as folder:
        for name, content in files.items():
            Path(folder, name).write_bytes(content)
        path = Path(folder, chosen)
        try:
            if path.suffix.lower() in (".yaml", ".yml"):
                image = read_meta(path).image
                if image.name in files:  # wherever it lay: it was dropped, and lies beside the YAML file now
                    told = os.path.relpath(image, folder) if image.is_relative_to(folder) else str(image)
                    path.write_bytes(files[chosen].replace(told.encode(), image.name.encode()))
                    image = read_meta(path).image
                if image.parent.resolve() != Path(folder).resolve() or image.name not in files:
                    rule = f"its image {image.name} was not dropped with it"
                    raise MapFormatError(chosen, rule, "drop both files at once")
            grid = load_map(path)
        except (MapFormatError, MapSizeError) as error:  # without the name of the folder
            raise type(error)(error.given.replace(f"{folder}/", ""), error.rule, error.remedy) from None
    check_cells(grid.rows, grid.cols, grid.name)
    return grid


def check_cells(rows: int, cols: int, name: str) -> None:
    """Refuse a map that is too large for the view.

    Raises
    ------
    MapSizeError
    """
    if rows * cols > MOST_CELLS:
        rule = f"the view takes up to {MOST_CELLS} cells, as 512 x 512"
        raise MapSizeError(f"{name or 'the map'} of {rows} x {cols} cells", rule, "crop it, or use antnav plan")


def _check_size(name: str, content: bytes) -> None:
    """Look at the size that a file tells of, before room is made for its cells."""
    if name.lower().endswith(_IMAGES):
        from PIL import Image, UnidentifiedImageError

        try:
            with Image.open(io.BytesIO(content)) as image:
                cols, rows = image.size
        except UnidentifiedImageError:
            return  # the reader of maps says why
        except Exception as error:  # of a damaged file, whatever Pillow's readers raise
            raise MapFormatError(name, f"it is no image: {error}", "check the file") from None
        check_cells(rows, cols, name)
    elif name.lower().endswith(".npy"):
        stream = io.BytesIO(content)
        try:
            major = np.lib.format.read_magic(stream)[0]
            read = np.lib.format.read_array_header_1_0 if major == 1 else np.lib.format.read_array_header_2_0
            shape = read(stream)[0]
        except ValueError as error:
            raise MapFormatError(name, str(error), "save it with numpy.save") from None
        check_cells(int(np.prod(shape, dtype=object)), 1, name)
