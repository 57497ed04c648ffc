"""ROS map_server maps: a YAML file that names an image, as nav2 or ROS 1 would load them."""

from __future__ import annotations

import contextlib
import math
import os
import re
import warnings
from collections.abc import Iterable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from antnav.errors import AntnavError, MapFileError, MapFormatError, OutputError, shown
from antnav.files import write_whole
from antnav.maps.foreign import refuse_foreign
from antnav.maps.grades import Grades
from antnav.maps.image import Picture, read_image
from antnav.maps.occupancy import MapMeta, Rules, lost_grades, occupancy, to_cells
from antnav.maps.source import HEAD_BYTES, MapWarning, read_bytes
from antnav.values import read_only
from antnav.world.grid import GridMap

if TYPE_CHECKING:
    from yaml import Event

#: Real files have a few hundred bytes; PyYAML takes up to 10 s for a megabyte.
MAX_YAML_BYTES = 2**16
_MAX_DEPTH = 20  # PyYAML's time grows with the square of the depth: 20 s at 20,000
#: Gray levels of map_saver by cell kind: free, occupied, unknown, and inflated written as occupied.
_SAVED = np.array([254, 0, 205, 0], dtype=np.uint8)
_UNKNOWN_GRAY = 205
_SLACK = 8  # gray levels by which lossy compression of usual quality moves flat areas beside walls
_KEYS = ("image", "resolution", "origin", "negate", "occupied_thresh", "free_thresh", "mode")
_TRUE, _FALSE = ("y", "yes", "true", "on"), ("n", "no", "false", "off")  # yaml-cpp's booleans
_NUMBER = re.compile(r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?")


def read(path: Path, rules: Rules = "nav2", occupied_from: int = 100) -> GridMap:
    """Read a map_server YAML file and its image.

    Parameters
    ----------
    path : Path
        The YAML file.
    rules : {"nav2", "humble", "ros1"}
        Whose arithmetic: see `occupancy`.
    occupied_from : int
        Occupancy, 1..100, from which a cell counts as occupied: see `to_cells`.

    Raises
    ------
    MapFileError, MapFormatError, MapSizeError, ParameterError
        The YAML file or the image is missing; breaks the format; is too large; a parameter is out of range.
    """
    picture, meta = _picture(path)
    return _grid(picture, meta, rules, occupied_from, path)


def read_grades(path: Path, rules: Rules = "nav2") -> Grades:
    """Read the occupancy values of a map_server YAML file and its image; parameters and errors of `read`."""
    picture, meta = _picture(path)
    values = occupancy(picture.pixels, picture.alpha, meta, rules)
    return Grades(read_only(values), GridMap(to_cells(values), meta.resolution, meta.origin, path.stem))


def _picture(path: Path) -> tuple[Picture, MapMeta]:
    meta = read_meta(path)
    try:
        return read_image(meta.image), meta
    except MapFileError as error:
        raise MapFileError(f"image {meta.image} named by {path}", error.rule, _where(meta.image, path)) from error


def _where(image: Path, path: Path) -> str:
    """What helps where an image is missing: the file beside the YAML file that is probably meant, if there is one."""
    parts = re.split(r"[/\\]+", str(image))
    names = ["/".join(parts[at:]) for at in range(1, len(parts))]  # with ever fewer folders
    names += [path.stem + suffix for suffix in (".pgm", ".png", ".bmp")]
    for name in names:
        if path.parent / name != image and os.path.isfile(path.parent / name):  # noqa: PTH113  any name is possible
            return f"write `image: {name}`, which is there"
    return (
        "correct `image:` or put the file there; it counts from the folder of the YAML file, "
        "without ~, package:// or backslashes"
    )


def read_bare_image(path: Path, rules: Rules = "nav2", occupied_from: int = 100, *, negate: bool = False) -> GridMap:
    """Read an image without YAML, with map_saver's thresholds: 0.65, 0.196, trinary, 1 m a cell, origin (0, 0, 0)."""
    return _grid(read_image(path), MapMeta(path, negate=negate), rules, occupied_from, path)


def _grid(picture: Picture, meta: MapMeta, rules: Rules, occupied_from: int, path: Path) -> GridMap:
    values = occupancy(picture.pixels, picture.alpha, meta, rules)
    trap = _trap(picture, values, meta)
    lost = lost_grades(values, occupied_from)
    for text in filter(None, (trap, lost)):
        warnings.warn(f"{path}: {text}", MapWarning, stacklevel=4)  # the caller of load_map
    return GridMap(to_cells(values, occupied_from), meta.resolution, meta.origin, path.stem)


def _trap(picture: Picture, values: NDArray[np.int8], meta: MapMeta) -> str:
    """What to warn of: unknown cells that load as free."""
    slack = _SLACK if picture.blurred else 0
    near = abs(np.arange(256) - _UNKNOWN_GRAY) <= slack
    marked = near[picture.pixels].reshape(*values.shape, -1).all(axis=2)
    trapped = int(np.count_nonzero(marked & (values == 0)))
    if not trapped:
        return ""
    if picture.blurred:
        return (
            f"{trapped} pixels near gray 205, map_saver's mark for unknown, load as free, because lossy compression "
            "moves gray levels; save the map as PNG or PGM"
        )
    return (
        f"{trapped} pixels of gray 205, map_saver's mark for unknown, load as free because free_thresh is "
        f"{meta.free_thresh}; set free_thresh: 0.196 in the YAML file if they are unknown"
    )


def read_meta(path: Path) -> MapMeta:
    """Read the YAML file only.

    Read as by yaml-cpp: quotes do not matter, tabs may follow a colon, UTF-16 and OpenCV's first line `%YAML:1.0` are
    accepted. Keys that map_server does not know are ignored. `image` counts from the folder of the YAML file.

    Raises
    ------
    MapFileError, MapFormatError, MapSizeError
        Missing; not YAML, a missing key, one that stands twice or a wrong value; longer than `MAX_YAML_BYTES`.
    """
    document = _parse(path)
    name = _require(document, "image", path)
    if not isinstance(name, str):
        raise _wrong(path, "image", name, "the name of an image file", "put the name in quotes")
    origin = _require(document, "origin", path)
    if not isinstance(origin, list) or len(origin) != 3:
        raise _wrong(path, "origin", origin, "a list of three numbers", "give [x, y, yaw] in metres and radians")
    x, y = (_number(path, "origin", value) for value in origin[:2])
    yaw = _number(path, "origin", origin[2], "write 0 as its yaw where the map is not turned")
    resolution = _number(path, "resolution", _require(document, "resolution", path))
    if resolution <= 0:
        raise _wrong(path, "resolution", resolution, "above 0", "give metres per cell, such as 0.05")
    occupied, free = (_threshold(path, document, key) for key in ("occupied_thresh", "free_thresh"))
    if free > occupied:
        raise _wrong(
            path, "free_thresh", free, f"at most occupied_thresh, {occupied}", "use map_saver's 0.65 and 0.196"
        )
    mode = document.get("mode", "trinary")
    if not isinstance(mode, str) or mode.lower() not in ("trinary", "scale", "raw"):
        raise _wrong(path, "mode", mode, "trinary, scale or raw", "use trinary if in doubt")
    negate = _truth(path, _require(document, "negate", path))
    return MapMeta(path.parent / name, resolution, (x, y, yaw), negate, occupied, free, mode.lower())


def _parse(path: Path) -> dict[str, Any]:
    """The keys of the first document; scalars stay text, as YAML 1.1 and yaml-cpp disagree on what they are."""
    data = read_bytes(path, MAX_YAML_BYTES)
    try:
        entries = _entries(_decode(data), path)
    except AntnavError:
        raise
    except Exception as error:  # YAMLError, and ValueError, RecursionError... from odd input
        reason = " ".join(str(error).split())[:300] or type(error).__name__
        raise MapFormatError(
            f"{path}: {reason}", "the file must be YAML", "compare it with a file that map_saver wrote"
        ) from error
    if not entries:
        refuse_foreign(data[:HEAD_BYTES], path)
        raise MapFormatError(f"{path}", "a map's YAML file is made of `key: value` lines", "name the map's YAML file")
    document: dict[str, Any] = {}
    lines: dict[str, int] = {}
    for key, value, line in entries:
        if key in _KEYS and key in document:
            raise MapFormatError(
                f"{path}: {key} on lines {lines[key]} and {line}",
                "each key stands once, since readers differ on which of two counts (map_server takes the first)",
                "take one out",
            )
        if isinstance(key, str):
            document[key], lines[key] = value, line
    return document


def _entries(text: str, path: Path) -> list[tuple[Any, Any, int]]:
    """Key, value and line of each entry; none where the text is not made of keys and values."""
    import yaml

    _refuse_bombs(yaml.parse(text, Loader=yaml.BaseLoader), path)
    loader = yaml.BaseLoader(text)
    node = loader.get_node() if loader.check_node() else None
    if not isinstance(node, yaml.MappingNode):
        return []
    build = partial(loader.construct_object, deep=True)
    return [(build(key), build(value), key.start_mark.line + 1) for key, value in node.value]


def _decode(data: bytes) -> str:
    """The text of a YAML file, without the traits that yaml-cpp takes and PyYAML does not."""
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        text = data.decode("utf-16", errors="replace")
    else:
        text = data.decode("utf-8-sig", errors="replace")
    text = re.sub(r"\A%YAML:", "#", text)  # as OpenCV writes it
    return re.sub(r"(?<=\S)[ ]*\t[ \t]*", " ", text)


def _refuse_bombs(events: Iterable[Event], path: Path) -> None:
    """Look through the parser's events before anything is built from them."""
    from yaml import AliasEvent, CollectionEndEvent, CollectionStartEvent

    depth = 0
    for event in events:
        depth += isinstance(event, CollectionStartEvent) - isinstance(event, CollectionEndEvent)
        if isinstance(event, AliasEvent):
            raise MapFormatError(
                f"{path} uses YAML aliases", "a few of them can fill the memory", "write the values out"
            )
        if depth > _MAX_DEPTH:
            raise MapFormatError(
                f"{path} nests its YAML", f"at most {_MAX_DEPTH} levels are read", "flatten the extra keys"
            )


def _require(document: dict[str, Any], key: str, path: Path) -> Any:
    if not document.get(key):
        found = ", ".join(name[:40] for name in list(document)[:20]) or "none"
        raise MapFormatError(
            f"{path} without the key {key}", f"map_server requires it (found: {found})", f"add a line `{key}: ...`"
        )
    return document[key]


def _number(path: Path, key: str, value: Any, remedy: str = "write it like 0.05") -> float:
    number = float(value) if isinstance(value, str) and _NUMBER.fullmatch(value) else math.nan
    if not math.isfinite(number):
        raise _wrong(path, key, value, "a finite number", remedy)
    return number


def _threshold(path: Path, document: dict[str, Any], key: str) -> float:
    number = _number(path, key, _require(document, key, path))
    if not 0 <= number <= 1:  # nav2 would load 65, meant as per cent, as a map without obstacles
        raise _wrong(path, key, number, "between 0 and 1", "use map_saver's 0.65 and 0.196")
    return number


def _truth(path: Path, value: Any) -> bool:
    word = value.lower() if isinstance(value, str) else ""
    if re.fullmatch(r"[-+]?[0-9]+", word):
        return bool(word.strip("-+0"))
    if word not in _TRUE + _FALSE:
        raise _wrong(path, "negate", value, "0, 1, true or false", "use 0 where dark pixels are obstacles")
    return word in _TRUE


def _wrong(path: Path, key: str, value: Any, rule: str, remedy: str) -> MapFormatError:
    return MapFormatError(f"{path}: {key} {shown(value)}", f"{key} must be {rule}", remedy)


def image_beside(path: Path) -> Path:
    """The image that goes with a YAML file that is to be written.

    Raises
    ------
    OutputError
        It exists, and no YAML file of that name says that it is its own.
    """
    image = path.with_suffix(".pgm")
    own = False
    with contextlib.suppress(AntnavError, OSError, ValueError):
        own = not image.exists() or image.samefile(read_meta(path).image)
    if not own:
        raise OutputError(
            f"image {image}", f"it exists, and is not known to belong to {path.name}", "choose another name, or move it"
        )
    return image


def write(grid: GridMap, path: Path) -> None:
    """Write the image `<stem>.pgm`, then the YAML file that names it.

    Free is 254, occupied and inflated 0, unknown 205; thresholds 0.65 and 0.196, trinary: both rules read it alike.

    Raises
    ------
    OutputError
        A file could not be written, or the image exists and is not this map's.
    """
    import yaml

    image = image_beside(path)
    document = {
        "image": image.name,
        "mode": "trinary",
        "resolution": grid.resolution,
        "origin": list(grid.origin),
        "negate": 0,
        "occupied_thresh": 0.65,
        "free_thresh": 0.196,
    }
    text = yaml.safe_dump(document, sort_keys=False, default_flow_style=None, allow_unicode=True)
    write_whole(image, f"P5\n{grid.cols} {grid.rows}\n255\n".encode() + _SAVED[grid.cells].tobytes())
    write_whole(path, text.encode())
