"""Maps in and out: readers and writers, one module a format; generators; built-in maps."""

from __future__ import annotations

import contextlib
import os
import re
from pathlib import Path

from antnav.errors import MapFormatError, ParameterError, check_type, shown
from antnav.files import as_path
from antnav.maps import bag, map_server, movingai, npy, text
from antnav.maps.builtin import builtin, builtin_names, builtin_query
from antnav.maps.foreign import refuse_foreign
from antnav.maps.generators import ends, generate, generator_names
from antnav.maps.grades import Grades
from antnav.maps.movingai import Scenario
from antnav.maps.numbers import Values, check_meaning
from antnav.maps.occupancy import Rules, check_occupied_from, check_rules, to_cells
from antnav.maps.source import HEAD_BYTES, MapWarning, open_binary, unreadable
from antnav.world.grid import GridMap

__all__ = [
    "Grades",
    "MapWarning",
    "Scenario",
    "builtin",
    "builtin_names",
    "builtin_query",
    "ends",
    "generate",
    "generator_names",
    "load_grades",
    "load_map",
    "load_scenarios",
    "save_map",
    "to_cells",
]

_ACCEPTED = (
    "ROS map_server (.yaml, .yml), images (.pgm, .png, .bmp, .tif, .webp, .gif, .jpg), MovingAI (.map), "
    "text of 0 and 1 (.txt, .csv), NumPy (.npy), bags of ROS (.mcap, .db3, .bag, their folders)"
)
_SUFFIXES = {
    ".yaml": "map_server",
    ".yml": "map_server",
    ".pgm": "image",
    ".ppm": "image",
    ".pbm": "image",
    ".png": "image",
    ".bmp": "image",
    ".tif": "image",
    ".tiff": "image",
    ".webp": "image",
    ".gif": "image",
    ".jpg": "image",
    ".jpeg": "image",
    ".map": "movingai",
    ".txt": "text",
    ".csv": "text",
    ".tsv": "text",
    ".npy": "npy",
    ".mcap": "bag",
    ".db3": "bag",
    ".bag": "bag",
}
_WRITERS = {
    ".yaml": map_server.write,
    ".yml": map_server.write,
    ".map": movingai.write,
    ".txt": text.write,
    ".npy": npy.write,
    ".mcap": bag.write,
    ".rosbag2": bag.write,
}
_MARK = rb"\A(?:\xef\xbb\xbf)?"  # the byte order mark that Windows editors put first
_SIGNATURES = (
    (re.compile(rb"\A\x93NUMPY"), "npy"),
    (re.compile(rb"\A(?:\x89MCAP|SQLite format 3\0|#ROSBAG V2)"), "bag"),
    (
        re.compile(rb"\A(?:\x89PNG|P[1-6][\s#]|BM[^\0]{0,13}\0|\xff\xd8\xff|GIF8|II[*+]\0|MM\0[*+]|RIFF....WEBP)"),
        "image",
    ),
    (re.compile(_MARK + rb"type\s+octile\b"), "movingai"),
    (re.compile(_MARK + rb"version\s+1\b"), "scenarios"),
    (re.compile(_MARK + rb"[ ,;\t\r\n]*[01][01 ,;\t\r\n]*\Z"), "text"),
    (re.compile(rb"^(?:image|resolution|origin|free_thresh|occupied_thresh)\s*:", re.MULTILINE), "map_server"),
)


def load_map(
    path: str | os.PathLike[str],
    *,
    rules: Rules = "nav2",
    occupied_from: int = 100,
    values: Values = "cells",
    invert: bool = False,
    topic: str | None = None,
) -> GridMap:
    """Read a map file of any accepted format.

    The content decides on the format; where it tells nothing, the extension does.

    Parameters
    ----------
    path : path-like
        A map_server YAML file, a bare PGM, PNG, BMP, TIFF, WebP, GIF or JPEG image (read with map_saver's thresholds
        0.65 and 0.196, 1 m a cell), a MovingAI map, a text of 0 and 1 or of `.` and `#`, a CSV file, a .npy array of
        cell values, or a bag of ROS 2 or ROS 1 (.mcap, .db3, .bag, or its folder; needs the extra ``antnav[ros]``) with
        a nav_msgs/OccupancyGrid or nav2_msgs/Costmap, of which the last counts.
    rules : {"nav2", "humble", "ros1"}
        Whose arithmetic turns colours and gray into occupancy; of effect for YAML and images only. See
        `antnav.maps.occupancy.occupancy`.
    occupied_from : int
        Occupancy, 1..100, from which a cell is occupied; of effect in `mode: scale` and `raw` and with `values`
        "occupancy" only. nav2 treats all below 100 as free.
    values : {"cells", "occupancy"}
        What the numbers of a text, CSV or .npy file mean: values of `Cell`, or those of a ROS OccupancyGrid, -1 and 0
        to 100.
    invert : bool
        Free and occupied change places: for text, CSV and .npy files in which 1 is passable, and for bare images in
        which obstacles are bright.
    topic : str, optional
        Of a bag with maps on several.

    Raises
    ------
    MapFileError, MapFormatError, MapSizeError
        The file, or the image that it names, is missing; breaks its format, or has none of those; is too large.
    ParameterError
        `rules`, `occupied_from`, `values` or `invert` is not one of the values above; `values` "occupancy", `invert` or
        `topic` for a format that has no use for it; `path` is no path; rosbags is missing.

    Warns
    -----
    MapWarning
        Gray 205, map_saver's mark for unknown, loads as free because of the file's free_thresh, or because it is a
        JPEG; grades between free and occupied are lost.
    """
    path = as_path(path)
    check_rules(rules)
    check_occupied_from(occupied_from)
    check_meaning(values, invert)
    kind = _kind_of_file(path)
    if values == "occupancy" and kind not in ("text", "npy"):
        raise ParameterError(f"values='occupancy' for {path}", "it is for text, CSV and .npy files", "leave it out")
    if kind == "bag" and not invert:
        return bag.read(path, topic, occupied_from)
    if topic is not None:
        raise ParameterError(f"topic {shown(topic)} for {path}", "it is for bags of ROS", "leave it out")
    if kind == "text":
        return text.read(path, values, invert, occupied_from)
    if kind == "npy":
        return npy.read(path, values, invert, occupied_from)
    if kind == "image":
        return map_server.read_bare_image(path, rules, occupied_from, negate=invert)
    if invert:
        remedy = "change `negate:` in it" if kind == "map_server" else "leave it out"
        raise ParameterError(f"invert for {path}", "the format itself says which cells are free", remedy)
    return map_server.read(path, rules, occupied_from) if kind == "map_server" else movingai.read(path)


def load_grades(path: str | os.PathLike[str], *, rules: Rules = "nav2") -> Grades:
    """Read the occupancy values of a map_server file, as nav2's speed masks carry them in `mode: scale` or `raw`.

    Parameters
    ----------
    path : path-like
        A map_server YAML file.
    rules : {"nav2", "humble", "ros1"}
        Whose arithmetic turns colours and gray into occupancy: see `antnav.maps.occupancy.occupancy`.

    Raises
    ------
    MapFileError, MapFormatError, MapSizeError
        The file, or the image that it names, is missing; breaks its format, or is no map_server file; is too large.
    ParameterError
        `rules` is none of these; `path` is no path.
    """
    path = as_path(path)
    check_rules(rules)
    if _kind_of_file(path) != "map_server":
        rule = "what gray means stands in a map_server YAML file: mode, free_thresh, occupied_thresh"
        raise MapFormatError(f"{path}", rule, "name or write that file")
    return map_server.read_grades(path, rules)


def _kind_of_file(path: Path) -> str:
    """Name of the format of a file.

    Raises
    ------
    MapFileError, MapFormatError
        It cannot be read; it has no format that is read as a map.
    """
    with contextlib.suppress(OSError, ValueError):  # of names that cannot be; opened below
        if (path / "metadata.yaml").is_file():
            return "bag"
    with open_binary(path) as stream:
        try:
            head = stream.read(HEAD_BYTES)
        except OSError as error:
            raise unreadable(path, error) from error
    kind = _kind_of(head)
    if kind is None:
        kind = _SUFFIXES.get(path.suffix.lower())
        if kind != "map_server":  # YAML may begin as JSON and be of UTF-16
            refuse_foreign(head, path)
    if kind == "scenarios":
        raise MapFormatError(f"{path}", "it holds MovingAI scenarios, not a map", "read it with load_scenarios")
    if kind is None:
        raise MapFormatError(f"{path}", f"accepted are {_ACCEPTED}", "convert the map to one of these formats")
    return kind


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
        .npy: cells only. .map (MovingAI) and .txt: free or blocked only. .mcap, .rosbag2: a bag of ROS with the map as
        OccupancyGrid on /map, inflated cells at 99.

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
    path = as_path(path)
    check_type("grid", grid, GridMap, "make one of the array first")
    write = _WRITERS.get(path.suffix.lower())
    if write is None:
        raise ParameterError(
            f"{path}", "maps are written as .yaml, .yml, .map, .txt, .npy, .mcap or .rosbag2", "choose one of these"
        )
    write(grid, path)


def load_scenarios(path: str | os.PathLike[str]) -> list[Scenario]:
    """Read the queries of a MovingAI .scen file.

    Raises
    ------
    MapFileError, MapFormatError, MapSizeError
        Missing; a wrong line, with its number; too large.
    """
    return movingai.read_scenarios(as_path(path))
