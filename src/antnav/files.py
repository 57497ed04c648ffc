"""Files: outputs that are written whole or not at all, inputs that cannot block."""

from __future__ import annotations

import contextlib
import errno
import os
import stat
import uuid
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO

from antnav.errors import AntnavError, OutputError, ParameterError, shown

_IRREGULAR = "it is a folder, a pipe or a device"


def as_path(path: str | os.PathLike[str]) -> Path:
    """A path from what stands for one.

    Raises
    ------
    ParameterError
        Nothing does.
    """
    try:
        return Path(path)
    except TypeError as error:
        raise ParameterError(f"path {shown(path)}", "it is text or a path-like object", "name a file") from error


def open_regular(path: str | os.PathLike[str]) -> BinaryIO:
    """Open a file for reading.

    Raises
    ------
    OSError
        It is missing or may not be read; it is a folder, or a pipe or a device, which could block for ever; its name is
        none.
    """
    try:
        file = Path(path)
        if not stat.S_ISREG(file.stat().st_mode):
            raise OSError(errno.EINVAL, _IRREGULAR)
        return file.open("rb")
    except (TypeError, ValueError) as error:  # ValueError: a NUL in the name
        raise OSError(errno.EINVAL, str(error)) from error


def write_whole(path: str | os.PathLike[str], content: bytes) -> None:
    """Write a file so that readers see the old content or the new, never a part: see `writing_whole`."""
    with writing_whole(path) as stream:
        stream.write(content)


@contextlib.contextmanager
def writing_whole(path: str | os.PathLike[str]) -> Iterator[BinaryIO]:
    """A stream for what becomes the file once all is written; where that fails, nothing does.

    The bytes go to a temporary file in the same folder, which then takes the name. What existed keeps its mode, and its
    owner where that is allowed; behind a symbolic link the file that it leads to is written.

    Raises
    ------
    OutputError
        The folder is missing, is not writable or is full; the name is that of a folder, a pipe or a device, or none.
        The old file, if any, is untouched.
    """
    temporary = None
    try:
        target = Path(os.path.realpath(path))
        old = _status(target)
        temporary = target.with_name(f".antnav-{uuid.uuid4().hex}")
        mode = 0o600 if old else 0o666  # closed until it takes over the old one's; else what the umask allows
        with os.fdopen(os.open(temporary, os.O_WRONLY | os.O_CREAT | os.O_EXCL, mode), "wb") as stream:
            yield stream
        if old:
            _take_over(temporary, old)
        os.replace(temporary, target)
    except AntnavError:  # of whoever writes
        raise
    except (OSError, TypeError, ValueError) as error:  # ValueError: a NUL in the name
        raise OutputError(
            f"cannot write {path}",
            getattr(error, "strerror", None) or str(error),
            "name a file in a folder that exists, is writable and has room",
        ) from error
    finally:
        if temporary is not None:
            with contextlib.suppress(OSError):
                temporary.unlink()


def _status(target: Path) -> os.stat_result | None:
    """What the system knows of a file that is to be replaced; None where there is none."""
    try:
        status = target.stat()
    except FileNotFoundError:
        return None
    if not stat.S_ISREG(status.st_mode):
        raise OSError(errno.EINVAL, _IRREGULAR)
    return status


def _take_over(path: Path, old: os.stat_result) -> None:
    """Give a file the owner and the mode of another one, as far as the file system has such things."""
    with contextlib.suppress(OSError):
        if hasattr(os, "chown"):
            os.chown(path, old.st_uid, old.st_gid)
    with contextlib.suppress(OSError):
        path.chmod(stat.S_IMODE(old.st_mode))
