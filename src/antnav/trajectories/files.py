"""Files of trajectories, by the ending of their names."""

from __future__ import annotations

import csv
import io
import math
import os
from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from antnav.errors import ParameterError, ResultFormatError, shown
from antnav.exchange import bag, messages
from antnav.files import as_path, open_regular, write_whole
from antnav.trajectories.footprint import Footprint
from antnav.values import finite_number
from antnav.world.grid import GridMap

if TYPE_CHECKING:
    from antnav.trajectories.model import Trajectory

LINE_ENDINGS = (".geojson", ".ros2.yaml", *bag.ENDINGS)
ENDINGS = (".csv", ".json", ".geojson", ".yaml", ".ros2.yaml", *bag.ENDINGS)
_MOST_BYTES = 2**30


def ending_of(path: str | os.PathLike[str]) -> str:
    """The ending that tells the format, or a `ParameterError`."""
    name = as_path(path).name.lower()
    for ending in sorted(ENDINGS, key=len, reverse=True):
        if name.endswith(ending):
            return ending
    raise ParameterError(f"file name {as_path(path).name}", f"trajectories end in {', '.join(ENDINGS)}", "choose one")


def save(trajectory: Trajectory, path: str | os.PathLike[str], frame: str, stamp: float) -> None:
    """See `Trajectory.save`."""
    ending = ending_of(path)
    check_header(frame, stamp, trajectory.duration or 0.0)
    if ending in LINE_ENDINGS:
        whole = {key: value for key, value in trajectory.to_dict().items() if not isinstance(value, list)}
        save_line(path, trajectory.poses, trajectory.grid, whole, frame, stamp, trajectory.times)
        return
    writers = {
        ".csv": lambda: _csv(trajectory),
        ".json": lambda: msgspec.json.encode(trajectory.to_dict()) + b"\n",
        ".yaml": lambda: msgspec.yaml.encode(_rows(trajectory)),
    }
    write_whole(path, writers[ending]())


def is_line(path: str | os.PathLike[str]) -> bool:
    """Whether a name's ending is that of a format of `save_line`."""
    return as_path(path).name.lower().endswith(LINE_ENDINGS)


def save_line(
    path: str | os.PathLike[str],
    poses: NDArray[np.float64],
    grid: GridMap,
    whole: dict[str, Any],
    frame: str,
    stamp: float,
    times: NDArray[np.float64] | None = None,
) -> None:
    """Write poses, of a trajectory or of cells, for other programs.

    Parameters
    ----------
    path : path-like
        One of `LINE_ENDINGS`.
    poses : ndarray of float64, shape (k, 3)
        x and y in metres, heading in radians.
    whole : dict
        What GeoJSON says of the whole, as JSON types.
    times : ndarray of float64, shape (k,), optional
        Seconds after the stamp at which each pose is reached.
    """
    check_header(frame, stamp)
    name = as_path(path).name.lower()
    if name.endswith(".geojson"):
        write_whole(path, _geojson(poses, whole, frame))
    elif name.endswith(".ros2.yaml"):
        write_whole(path, msgspec.yaml.encode(_ros2(poses, times, frame, stamp)))
    else:
        plan = messages.path_message(poses, times, frame, stamp)
        seconds, rest = messages.clock(stamp)
        bag.write(as_path(path), [messages.grid_message(grid, frame, stamp), plan], seconds * 10**9 + rest)


def check_header(frame: object, stamp: object, duration: float = 0.0) -> None:
    """Refuse what is no frame, or no stamp that with all seconds after it is in the range of ROS."""
    if not isinstance(frame, str) or not frame.isprintable() or not frame:
        raise ParameterError(f"frame {shown(frame)}", "it is the name of a frame", 'give one, such as "map"')
    if not 0 <= finite_number(stamp) < 2**31 - duration:
        rule = "it is seconds since 1970, and all ends below 2**31"
        raise ParameterError(f"stamp {shown(stamp)}", rule, "give time.time()")


def _columns(trajectory: Trajectory) -> dict[str, NDArray[np.float64]]:
    x, y, heading = trajectory.poses.T
    columns = {"s": trajectory.arc_length, "x": x, "y": y, "heading": heading, "curvature": trajectory.curvature}
    if trajectory.speeds is not None and trajectory.times is not None:
        columns |= {"speed": trajectory.speeds, "t": trajectory.times}
    return columns


def _csv(trajectory: Trajectory) -> bytes:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    columns = _columns(trajectory)
    writer.writerow(columns)
    writer.writerows(np.column_stack(list(columns.values())).tolist())
    return text.getvalue().encode()


def _rows(trajectory: Trajectory) -> dict[str, Any]:
    """What is known of the whole, and a row a pose."""
    columns = _columns(trajectory)
    whole = {key: value for key, value in trajectory.to_dict().items() if not isinstance(value, list)}
    rows = np.column_stack(list(columns.values())).tolist()
    return whole | {"poses": [dict(zip(columns, row, strict=True)) for row in rows]}


def _geojson(poses: NDArray[np.float64], whole: dict[str, Any], frame: str) -> bytes:
    points = poses[:, :2].tolist()
    headings = [round(math.degrees(heading), 9) for heading in poses[:, 2].tolist()]
    geometry = {"type": "LineString", "coordinates": points if len(points) > 1 else points * 2} if points else None
    feature = {
        "type": "Feature",
        "geometry": geometry,
        "properties": {"frame": frame, "unit": "m", **whole, "headings_degrees": headings},
    }
    return msgspec.json.encode({"type": "FeatureCollection", "features": [feature]}) + b"\n"


def _ros2(poses: NDArray[np.float64], times: NDArray[np.float64] | None, frame: str, stamp: float) -> dict[str, Any]:
    """nav_msgs/Path as `ros2 topic pub` takes it."""

    def header(after: float) -> dict[str, Any]:
        seconds, rest = messages.clock(stamp, after)
        return {"stamp": {"sec": seconds, "nanosec": rest}, "frame_id": frame}

    later = [0.0] * len(poses) if times is None else times.tolist()
    turns = messages.quaternions(poses[:, 2]).tolist()
    return {
        "header": header(0.0),
        "poses": [
            {
                "header": header(after),
                "pose": {
                    "position": {"x": x, "y": y, "z": 0.0},
                    "orientation": dict(zip("xyzw", turn, strict=True)),
                },
            }
            for (x, y), turn, after in zip(poses[:, :2].tolist(), turns, later, strict=True)
        ],
    }


class Read(msgspec.Struct, kw_only=True):
    """A trajectory's file of JSON, or of CSV with what that lacks left at its default."""

    schema: str = ""
    version: int = 1
    radius: float = 0.0
    margin: float = 0.0
    smooth: bool = True
    note: str = ""
    poses: list[tuple[float, float, float]]
    curvature: list[float | None]
    speeds: list[float] | None = None
    times: list[float] | None = None
    footprint: list[tuple[float, float]] | None = None


def load(path: str | os.PathLike[str], schema: str) -> dict[str, Any]:
    """What `save` wrote as .json or .csv, as fields of a trajectory but for its map.

    Raises
    ------
    ResultFormatError, ParameterError
    """
    ending, file = ending_of(path), as_path(path)
    if ending not in (".json", ".csv"):
        raise ParameterError(f"file name {file.name}", "trajectories are read from .json and .csv", "save it as one")
    try:
        with open_regular(file) as stream:
            content = stream.read(_MOST_BYTES)
        read = msgspec.json.decode(content, type=Read) if ending == ".json" else _of_csv(content)
        if ending == ".json" and (read.schema, read.version) != (schema, 1):
            raise ValueError(f"its schema is {shown(read.schema)}, version {read.version}")
        fields = msgspec.structs.asdict(read)
        del fields["schema"], fields["version"]
        fields["footprint"] = None if read.footprint is None else Footprint(tuple(read.footprint))
        curvature = [math.inf if bend is None else bend for bend in read.curvature]
        for name, values in (
            ("poses", read.poses),
            ("curvature", curvature),
            ("speeds", read.speeds),
            ("times", read.times),
        ):
            fields[name] = None if values is None else np.array(values, np.float64)
            if values is not None and len(values) != len(read.poses):
                raise ValueError(f"it has {len(read.poses)} poses and {len(values)} {name}")
        if not len(read.poses) or not np.isfinite(fields["poses"]).all():
            raise ValueError("it has no poses, or poses that are no numbers")
        if np.isnan(fields["curvature"]).any():
            raise ValueError("it has a curvature that is no number")
        if not all(fields[name] is None or np.isfinite(fields[name]).all() for name in ("speeds", "times")):
            raise ValueError("it has speeds or times that are no numbers")
        if (read.speeds is None) != (read.times is None):
            raise ValueError("it has speeds without times, or times without speeds")
        if read.times is not None and (np.diff(fields["times"]) < 0).any():
            raise ValueError("its times fall")
        if not (0 <= read.radius < math.inf and 0 <= read.margin < math.inf):
            raise ValueError(f"its radius is {read.radius} and its margin {read.margin}")
    except OSError as error:
        raise ResultFormatError(f"cannot read {file}", error.strerror or str(error), "check the name") from error
    except (ValueError, csv.Error, msgspec.DecodeError) as error:
        raise ResultFormatError(f"{file}", f"it must be a trajectory: {error}", "save it again") from error
    return fields


def _of_csv(content: bytes) -> Read:
    rows = list(csv.DictReader(io.StringIO(content.decode("utf-8-sig"))))
    if any(None in row for row in rows):
        raise ValueError("a line has more values than the first has names")
    columns = {name: [float(row[name] or "") for row in rows] for name in rows[0]} if rows else {}
    missing = [name for name in ("x", "y", "heading", "curvature") if name not in columns]
    if missing:
        raise ValueError(f"it has no column {missing[0]}")
    poses = list(zip(columns["x"], columns["y"], columns["heading"], strict=True))
    return Read(
        poses=poses,
        curvature=list(columns["curvature"]),
        speeds=columns.get("speed"),
        times=columns.get("t"),
        smooth=all(map(math.isfinite, columns["curvature"])),
    )
