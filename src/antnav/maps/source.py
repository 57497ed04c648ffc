"""What the readers share: bytes of a file, lines of a text, and the warning category."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO

from antnav.errors import MapError, MapFileError, MapFormatError, MapSizeError
from antnav.files import open_regular
from antnav.world.grid import MAX_CELLS

#: Longest text file that is read: the largest map at four characters a cell.
MAX_TEXT_BYTES = 4 * MAX_CELLS
#: Bytes that tell the format of a file.
HEAD_BYTES = 4096
#: Lines that a text file may have. Each becomes a Python object, so a cell a line would cost gigabytes.
MAX_LINES = 2**20


class MapWarning(UserWarning):
    """A map was read or written as asked, but probably not as meant."""


def open_binary(path: Path) -> BinaryIO:
    """Open a regular file for reading.

    Raises
    ------
    MapFileError
        It is missing, may not be read, or is a folder, a pipe or a device (which could block for ever).
    """
    try:
        return open_regular(path)
    except OSError as error:
        raise unreadable(path, error) from error


def read_bytes(path: Path, limit: int = MAX_TEXT_BYTES) -> bytes:
    """Read a whole file of at most `limit` bytes.

    Raises
    ------
    MapFileError, MapSizeError
        The file cannot be read; it is longer than `limit`.
    """
    with open_binary(path) as stream:
        size = os.fstat(stream.fileno()).st_size
        if size > limit:
            raise MapSizeError(
                f"{path} of {size} bytes", f"such a file has at most {limit} bytes", "check that it is the right file"
            )
        try:
            return stream.read(size)  # read(limit) would allocate the limit
        except OSError as error:
            raise unreadable(path, error) from error


def unreadable(path: Path, error: Exception) -> MapFileError:
    """Turn an error of the operating system into one that names the file."""
    reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
    return MapFileError(f"cannot read {path}", reason, "check the name and the permissions")


def split_lines(data: bytes, source: str) -> list[bytes]:
    """Split at line feeds, without a byte order mark, carriage returns and blanks at line ends.

    Raises
    ------
    MapSizeError
        More than `MAX_LINES` lines.
    """
    count = data.count(b"\n")
    if count >= MAX_LINES:
        raise MapSizeError(
            f"{source} of {count} lines",
            f"a text map has at most {MAX_LINES} lines",
            "save the map as an image or .npy",
        )
    return [line.rstrip(b" \r") for line in data.removeprefix(b"\xef\xbb\xbf").split(b"\n")]


@contextlib.contextmanager
def located(path: Path | str) -> Iterator[None]:
    """Put the file's name before what the checks of a map say."""
    try:
        yield
    except MapSizeError as error:
        raise MapSizeError(f"{path}: {error.given}", error.rule, error.remedy) from error
    except MapError as error:
        raise MapFormatError(f"{path}: {error.given}", error.rule, error.remedy) from error
