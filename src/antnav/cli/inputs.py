"""What commands are given: maps by name or file, points, and files to write."""

from __future__ import annotations

import contextlib
import difflib
import os
import tempfile
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Annotated, cast

import typer

from antnav.errors import AntnavError, MapFileError, OutputError, OutsideMapError, ParameterError
from antnav.maps import builtin, builtin_names, load_map
from antnav.maps.map_server import read_meta
from antnav.maps.numbers import Values
from antnav.maps.occupancy import RULES, Rules
from antnav.world.grid import GridMap
from antnav.world.problem import CellIndex, Point

#: Endings of `save_map`.
MAP_ENDINGS = (".yaml", ".yml", ".map", ".txt", ".npy", ".mcap", ".rosbag2")

MapName = Annotated[
    str,
    typer.Argument(
        metavar="MAP",
        help="A map file (ROS map_server YAML, PGM, PNG, BMP, TIFF, WebP, GIF, JPEG, MovingAI .map, .txt or .csv of "
        "0/1, .npy, a bag of ROS, with :/TOPIC where it has several maps) or the name of a built-in map "
        "(`antnav maps list`).",
        show_default=False,
    ),
]
RulesOption = Annotated[
    str,
    typer.Option(
        "--rules",
        metavar="|".join(RULES),
        help="Whose map_server reads colours and gray levels: nav2's since jazzy, nav2's up to humble, or ROS 1's.",
    ),
]
ValuesOption = Annotated[
    str,
    typer.Option(
        "--values",
        metavar="cells|occupancy",
        help="What numbers in .txt, .csv and .npy mean: cells, 0 and 1, or those of an OccupancyGrid, -1 and 0 to 100.",
    ),
]
Invert = Annotated[
    bool, typer.Option("--invert", help="In the .txt, .csv or .npy file 1 is passable; in the image, black is free.")
]


def read_map(name: str, rules: str = "nav2", values: str = "cells", invert: bool = False) -> GridMap:
    """A built-in map by its name, or a map from a file; `./NAME` means the file, `BAG:/TOPIC` a topic of a bag.

    Raises
    ------
    MapError
        Neither, or the file is no map.
    ParameterError
        An option that is wrong, or of no use for this map.
    """
    if name in builtin_names():
        if (rules, values, invert) != ("nav2", "cells", False):
            rule = "--rules, --values and --invert are for map files"
            raise ParameterError(f"built-in map {name}", rule, "leave them out")
        return builtin(name)
    bare = not Path(name).suffix and os.sep not in name
    if bare and not os.path.lexists(name):
        close = difflib.get_close_matches(name, builtin_names(), 1)
        remedy = f"did you mean {close[0]}?" if close else "name a file or one of these"
        raise MapFileError(
            f"map {name!r}", f"it is neither a file nor a built-in map ({', '.join(builtin_names())})", remedy
        )
    file, topic = _topic(name)
    grid = load_map(file, rules=cast(Rules, rules), values=cast(Values, values), invert=invert, topic=topic)
    text = grid.name.encode(errors="replace").decode()  # a file name need not be text, but a result's JSON is
    return grid if text == grid.name else replace(grid, name=text)


def _topic(name: str) -> tuple[str, str | None]:
    """A bag and a topic from "run.mcap:/map"; a file that has such a name comes first."""
    file, colon, topic = name.rpartition(":/")
    return (file, f"/{topic}") if colon and not os.path.lexists(name) else (name, None)


def files_of_map(name: str) -> list[Path]:
    """The files that `read_map` read: none for a built-in map, the image too for map_server's YAML."""
    if name in builtin_names():
        return []
    files = [Path(_topic(name)[0])]
    if files[0].suffix.lower() in {".yaml", ".yml"}:
        with contextlib.suppress(AntnavError):  # YAML by its ending only
            files.append(read_meta(files[0]).image)
    return files


def check_output(path: Path, endings: Sequence[str], inputs: Sequence[Path] = (), *, folder: bool = False) -> None:
    """Refuse a file, or a folder that is written as one, that could not be written later, before any work is done.

    Raises
    ------
    ParameterError
        Another ending than `endings`, or one of the `inputs` would be overwritten.
    OutputError
        It is a folder, or its folder is missing or not writable.
    """
    if not path.name.lower().endswith(tuple(endings)):
        raise ParameterError(
            f"output {path}", f"its ending must be one of {', '.join(endings)}", "choose one, and with it the format"
        )
    for given in inputs:
        if _same_file(path, given):
            raise ParameterError(f"output {path}", "it would overwrite the map", "choose another name or folder")
    remedy = "name a file in a folder that exists and is writable"
    try:
        if path.is_dir() and not folder:
            raise OutputError(f"output {path}", "it is a folder", remedy)
        with tempfile.NamedTemporaryFile(prefix=f".{path.name}.", dir=path.parent):
            pass
    except OutputError:
        raise
    except (OSError, ValueError) as error:  # ValueError: a NUL in the name
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        raise OutputError(f"output {path}", reason, remedy) from error


def check_folder(path: Path) -> None:
    """Refuse a folder for outputs that could not be made or written to later, before any work is done.

    Raises
    ------
    OutputError
        It is a file, or the nearest folder above it that exists is not writable.
    """
    try:
        above = next(folder for folder in (path, *path.absolute().parents) if folder.exists())
        with tempfile.NamedTemporaryFile(prefix=".antnav.", dir=above):
            pass
    except (OSError, ValueError) as error:  # ValueError: a NUL in the name
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        raise OutputError(f"folder {path}", reason, "name a folder that can be made or written to") from error


def _same_file(one: Path, other: Path) -> bool:
    try:
        return one.samefile(other)
    except (OSError, ValueError):
        return False


def point(name: str, text: str) -> Point:
    """A point from "X,Y".

    Raises
    ------
    ParameterError
        Not two numbers.
    """
    try:
        x, y = (float(part) for part in text.split(","))
    except ValueError:
        raise ParameterError(f"--{name} {text!r}", "a point is X,Y in metres", "write it like 1.5,-2") from None
    return x, y


def cell_point(name: str, text: str, grid: GridMap) -> Point:
    """The centre of a cell from "ROW,COL".

    Raises
    ------
    ParameterError
        Not two whole numbers.
    OutsideMapError
        No such cell.
    """
    try:
        row, col = (int(part) for part in text.split(","))
    except ValueError:
        raise ParameterError(
            f"--{name} {text!r}", "with --cells it is ROW,COL, two whole numbers", "write it like 3,17"
        ) from None
    if not grid.contains((row, col)):
        raise OutsideMapError(
            name,
            f"--{name} {row},{col}",
            f"the map has rows 0..{grid.rows - 1} and columns 0..{grid.cols - 1}",
            "choose a cell inside, ROW,COL from 0,0 at the top left",
        )
    return centre(grid, (row, col))


def centre(grid: GridMap, cell: CellIndex) -> Point:
    """Where the middle of a cell lies, in metres."""
    x, y = grid.cell_to_world(cell)
    return float(x), float(y)
