"""Maps in and out: readers and writers, one module a format; generators; built-in maps."""

from __future__ import annotations

import os
import re
from pathlib import Path

from antnav.errors import MapFormatError, ParameterError
from antnav.grid import GridMap
from antnav.maps import map_server, movingai, npy, text
from antnav.maps.builtin import builtin, builtin_names, builtin_query
from antnav.maps.generators import ends, generate, generator_names
from antnav.maps.movingai import Scenario
from antnav.maps.occupancy import Rules, check_occupied_from, check_rules
from antnav.maps.source import MapWarning, open_binary, unreadable

__all__ = [
    "MapWarning",
    "Scenario",
    "builtin",
    "builtin_names",
    "builtin_query",
    "ends",
    "generate",
    "generator_names",
    "load_map",
    "load_scenarios",
    "save_map",
]

_ACCEPTED = (
    "ROS map_server (.yaml, .yml), images (.pgm, .png, .bmp), MovingAI (.map), text of 0 and 1 (.txt), NumPy (.npy)"
)
_SUFFIXES = {
    ".yaml": "map_server",
    ".yml": "map_server",
    ".pgm": "image",
    ".ppm": "image",
    ".pbm": "image",
    ".png": "image",
    ".bmp": "image",
    ".map": "movingai",
    ".txt": "text",
    ".npy": "npy",
}
_WRITERS = {"map_server": map_server.write, "movingai": movingai.write, "text": text.write, "npy": npy.write}
_HEAD_BYTES = 4096
_MARK = rb"\A(?:\xef\xbb\xbf)?"  # the byte order mark that Windows editors put first
_SIGNATURES = (
    (re.compile(rb"\A\x93NUMPY"), "npy"),
    (re.compile(rb"\A(?:\x89PNG|P[1-6][\s#]|BM[^\0]{0,13}\0)"), "image"),
    (re.compile(_MARK + rb"type\s+octile\b"), "movingai"),
    (re.compile(_MARK + rb"version\s+1\b"), "scenarios"),
    (re.compile(_MARK + rb"[ ,\t\r\n]*[01][01 ,\t\r\n]*\Z"), "text"),
    (re.compile(rb"^(?:image|resolution|origin|free_thresh|occupied_thresh)\s*:", re.MULTILINE), "map_server"),
)


def load_map(path: str | os.PathLike[str], *, rules: Rules = "nav2", occupied_from: int = 100) -> GridMap:
    """Read a map file of any accepted format.

    The content decides on the format; where it tells nothing, the extension does.

    Parameters
    ----------
    path : path-like
        A map_server YAML file, a bare PGM, PNG or BMP image (read with map_saver's thresholds 0.65 and 0.196, 1 m a
        cell), a MovingAI map, a text of 0 and 1, or a .npy array of cell values.
    rules : {"nav2", "ros1"}
        Whose arithmetic turns gray into occupancy; for YAML and images. See `antnav.maps.occupancy.occupancy`.
    occupied_from : int
        Occupancy, 1..100, from which a cell is occupied; for YAML and images, and of effect in `mode: scale` and `raw`
        only. nav2 treats all below 100 as free.

    Raises
    ------
    MapFileError, MapFormatError, MapSizeError
        The file, or the image that it names, is missing; breaks its format, or has none of those; is too large.
    ParameterError
        `rules` or `occupied_from` is not one of the values above.

    Warns
    -----
    MapWarning
        Gray 205, map_saver's mark for unknown, loads as free because of the file's free_thresh.
    """
    path = Path(path)
    check_rules(rules)
    check_occupied_from(occupied_from)
    kind = _kind_of(_read_head(path)) or _SUFFIXES.get(path.suffix.lower())
    if kind == "map_server":
        return map_server.read(path, rules, occupied_from)
    if kind == "image":
        return map_server.read_bare_image(path, rules, occupied_from)
    if kind == "movingai":
        return movingai.read(path)
    if kind == "text":
        return text.read(path)
    if kind == "npy":
        return npy.read(path)
    if kind == "scenarios":
        raise MapFormatError(f"{path}", "it holds MovingAI scenarios, not a map", "read it with load_scenarios")
    raise MapFormatError(f"{path}", f"accepted are {_ACCEPTED}", "convert the map to one of these formats")


def _read_head(path: Path) -> bytes:
    with open_binary(path) as stream:
        try:
            return stream.read(_HEAD_BYTES)
        except OSError as error:
            raise unreadable(path, error) from error


def _kind_of(head: bytes) -> str | None:
    """Name of the format that the first bytes give away, or None."""
    return next((kind for pattern, kind in _SIGNATURES if pattern.search(head)), None)


def save_map(grid: GridMap, path: str | os.PathLike[str]) -> None:
    """Write a map in the format of the extension, whole or not at all.

    Parameters
    ----------
    grid : GridMap
        Inflated cells are written as occupied.
    path : path-like
        .yaml or .yml: map_server YAML, and the image `<stem>.pgm` beside it, written first; keeps everything.
        .npy: cells only. .map (MovingAI) and .txt: free or blocked only.

    Raises
    ------
    ParameterError
        Another extension.
    OutputError
        A file cannot be written.

    Warns
    -----
    MapWarning
        Unknown cells become blocked, because the format does not know them.
    """
    path = Path(path)
    write = _WRITERS.get(_SUFFIXES.get(path.suffix.lower(), ""))
    if write is None:
        raise ParameterError(f"{path}", "maps are written as .yaml, .yml, .map, .txt or .npy", "choose one of these")
    write(grid, path)


def load_scenarios(path: str | os.PathLike[str]) -> list[Scenario]:
    """Read the queries of a MovingAI .scen file.

    Raises
    ------
    MapFileError, MapFormatError, MapSizeError
        Missing; a wrong line, with its number; too large.
    """
    return movingai.read_scenarios(Path(path))
