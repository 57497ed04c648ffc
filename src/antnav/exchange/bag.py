"""Bags of ROS, written whole and read by rosbags, without ROS; the extra ``antnav[ros]``."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from antnav.errors import AntnavError, MapFileError, MapFormatError, OutputError, ParameterError
from antnav.files import write_whole

if TYPE_CHECKING:
    from rosbags.interfaces import Qos
    from rosbags.typesys.store import Typestore

#: Endings of bags that are written: one file, and a folder with metadata.yaml and a database.
ENDINGS = (".mcap", ".rosbag2")
#: nav2's costmaps, which are not among the messages that rosbags knows.
_COSTMAP = {
    "nav2_msgs/msg/CostmapMetaData": """builtin_interfaces/Time map_load_time
builtin_interfaces/Time update_time
string layer
float32 resolution
uint32 size_x
uint32 size_y
geometry_msgs/Pose origin
""",
    "nav2_msgs/msg/Costmap": """std_msgs/Header header
nav2_msgs/CostmapMetaData metadata
uint8[] data
""",
}


class Recorded(NamedTuple):
    """A message of a bag."""

    topic: str
    msgtype: str
    message: Any
    latched: bool = False  #: whether whoever subscribes later gets it, too


def require_rosbags() -> None:
    """Refuse to go on without rosbags.

    Raises
    ------
    ParameterError
    """
    if find_spec("rosbags") is None or find_spec("rosbags.typesys") is None:  # an empty folder may be left of it
        raise ParameterError("a bag of ROS", "it needs rosbags", 'run: pip install "antnav[ros]"')


def typestore() -> Typestore:
    """The message types of ROS 2, nav2's costmaps among them."""
    require_rosbags()
    return _typestore()


@cache
def _typestore() -> Typestore:
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore

    store = get_typestore(Stores.ROS2_JAZZY)
    for name, text in _COSTMAP.items():
        store.register(get_types_from_msg(text, name))
    return store


def write(path: Path, messages: Sequence[Recorded], nanoseconds: int) -> None:
    """Write a bag, whole or not at all, with all messages at one time.

    Parameters
    ----------
    path : Path
        ".mcap": a file. ".rosbag2": a folder, as `ros2 bag record` makes one, with SQLite in it.
    messages : sequence of Recorded
    nanoseconds : int
        Of the time at which the messages were received.

    Raises
    ------
    OutputError
        It cannot be written.
    ParameterError
        rosbags is missing.
    """
    store = typestore()
    from rosbags.rosbag2 import StoragePlugin, Writer, WriterError

    alone = path.name.lower().endswith(".mcap")
    plugin = StoragePlugin.MCAP if alone else StoragePlugin.SQLITE3
    try:
        with tempfile.TemporaryDirectory(prefix=".antnav-", dir=None if alone else path.absolute().parent) as folder:
            bag = Path(folder, path.stem)
            with Writer(bag, version=8, storage_plugin=plugin) as writer:  # humble cannot read the profiles of 9
                for topic, msgtype, message, latched in messages:
                    profiles = [_latched()] if latched else []
                    connection = writer.add_connection(topic, msgtype, typestore=store, offered_qos_profiles=profiles)
                    writer.write(connection, nanoseconds, store.serialize_cdr(message, msgtype))
            if alone:
                write_whole(path, (bag / f"{bag.name}.mcap").read_bytes())
            else:
                _replace(bag, path)
    except AntnavError:
        raise
    except (OSError, ValueError, WriterError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise OutputError(
            f"cannot write {path}", reason, "name one in a folder that is writable and has room"
        ) from error


def _replace(new: Path, target: Path) -> None:
    """Give a folder the name of another one, which must be a bag."""
    if target.is_dir() and (target / "metadata.yaml").exists():
        old = new.with_name(f"{new.name}.old")
        target.rename(old)
    elif os.path.lexists(target):
        raise OutputError(f"cannot write {target}", "it exists and is no bag", "choose another name")
    shutil.move(new, target)


def _latched() -> Qos:
    """The profile with which map servers publish."""
    from rosbags.interfaces import Qos, QosDurability, QosHistory, QosLiveliness, QosReliability, QosTime

    ever = QosTime(2147483647, 4294967295)
    return Qos(
        history=QosHistory.KEEP_LAST,
        depth=1,
        reliability=QosReliability.RELIABLE,
        durability=QosDurability.TRANSIENT_LOCAL,
        deadline=ever,
        lifespan=ever,
        liveliness=QosLiveliness.AUTOMATIC,
        liveliness_lease_duration=ever,
        avoid_ros_namespace_conventions=False,
    )


def latest(path: Path, msgtypes: Sequence[str], topic: str | None = None) -> tuple[str, Any]:
    """The last message of some types in a bag of ROS 2 or ROS 1.

    Parameters
    ----------
    path : Path
        .mcap, .db3, .bag, or the folder of a bag.
    msgtypes : sequence of str
        As in "nav_msgs/msg/OccupancyGrid".
    topic : str, optional
        Where topics with such messages are several.

    Returns
    -------
    (str, message)
        Its type, and the message as rosbags gives it.

    Raises
    ------
    MapFileError, MapFormatError
        Missing or damaged; no such message.
    ParameterError
        Several topics and none named; rosbags is missing.
    """
    require_rosbags()
    from rosbags import rosbag1, rosbag2
    from rosbags.typesys import Stores, get_typestore

    # not by AnyReader: it refuses a bag for what it cannot parse of any other topic
    old = path.suffix.lower() == ".bag"
    with _readable(path), (rosbag1.Reader if old else rosbag2.Reader)(path) as reader:
        found = [each for each in reader.connections if each.msgtype in msgtypes and each.msgcount]
        topics = sorted({each.topic for each in found})
        names = " or ".join(name.replace("/msg/", "/") for name in msgtypes)
        if not topics or (topic is not None and topic not in topics):
            given = f"{path}" if topic is None else f"topic {topic} in {path}"
            has = ", ".join(sorted({f"{each.topic} ({each.msgtype})" for each in reader.connections})) or "nothing"
            raise MapFormatError(given, f"a map is a message {names}", f"it holds {has}")
        if topic is None and len(topics) > 1:
            remedy = f"name one: topic={topics[0]!r}, or {path.name}:{topics[0]} on the command line"
            raise ParameterError(f"{path}", f"it holds {names} on {', '.join(topics)}", remedy)
        chosen = [each for each in found if each.topic == (topic or topics[0])]
        msgtype, data = "", b""
        for connection, _, data in reader.messages(chosen):  # noqa: B007  # the last one counts
            msgtype = connection.msgtype
        if old:
            return msgtype, get_typestore(Stores.ROS1_NOETIC).deserialize_ros1(data, msgtype)
        return msgtype, typestore().deserialize_cdr(data, msgtype)


@contextmanager
def _readable(path: Path) -> Iterator[None]:
    """Turn what rosbags and its decoders raise into an error that names the file."""
    try:
        yield
    except AntnavError:
        raise
    except OSError as error:
        raise MapFileError(f"cannot read {path}", error.strerror or str(error), "check the name") from error
    except Exception as error:  # of damaged files: struct, SQLite, zstandard, YAML, rosbags' own
        reason = str(error) or type(error).__name__
        raise MapFormatError(
            f"{path}", f"it must be a bag that rosbags can read: {reason}", "record it again"
        ) from error
