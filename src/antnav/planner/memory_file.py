"""The file of a memory: .npz, written whole or not at all, checked when it is read."""

from __future__ import annotations

import io
import os
import zipfile
import zlib
from collections.abc import Callable, Mapping, Sequence
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from antnav.errors import ParameterError, ResultFormatError
from antnav.files import as_path, open_regular, write_whole

T = TypeVar("T")

VERSION = 1
#: Fields that are tuples of arrays.
PATHS = ("paths", "earlier")
#: Bytes of an array, at most.
MOST = 2**32
#: What reading a damaged file raises.
_DAMAGED = (
    OSError,
    ValueError,
    TypeError,
    KeyError,
    EOFError,
    MemoryError,
    RuntimeError,
    zipfile.BadZipFile,
    zlib.error,
)


def write(fields: Mapping[str, Any], path: str | os.PathLike[str]) -> None:
    """Write the fields of a memory, tuples of arrays among them; see `Memory.save`."""
    arrays: dict[str, Any] = {"antnav_memory": VERSION}
    for name, value in fields.items():
        arrays |= _joined(name, value) if name in PATHS else {name: value}
    stream = io.BytesIO()
    np.savez_compressed(stream, **arrays)
    write_whole(path, stream.getvalue())


def read(path: str | os.PathLike[str], make: Callable[..., T]) -> T:
    """What `make` makes of the fields; see `Memory.load`."""
    path = as_path(path)
    try:
        with open_regular(path) as stream, zipfile.ZipFile(stream) as archive:
            arrays = {info.filename.removesuffix(".npy"): _array(archive, info) for info in archive.infolist()}
        if arrays["antnav_memory"] != VERSION:
            raise ValueError(f"its version is {arrays['antnav_memory']}, not {VERSION}")
        fields: dict[str, Any] = {name: _parted(arrays, name) for name in PATHS}
        fields |= {"shape": tuple(arrays["shape"].tolist()), "tau0": arrays["tau0"].item()}
        return make(flat=arrays["flat"], tau=arrays["tau"], **fields)
    except ParameterError as error:
        raise _unreadable(path, f"{error.given}: {error.rule}") from error
    except KeyError as error:
        raise _unreadable(path, f"it has no {error.args[0]}") from error
    except _DAMAGED as error:
        raise _unreadable(path, (isinstance(error, OSError) and error.strerror) or str(error)) from error


def _unreadable(path: os.PathLike[str], reason: str) -> ResultFormatError:
    return ResultFormatError(f"memory {path}", reason, "use a file that Memory.save of this version has written")


def _array(archive: zipfile.ZipFile, info: zipfile.ZipInfo) -> NDArray[Any]:
    if info.file_size > MOST:
        raise ValueError(f"{info.filename} has {info.file_size} bytes")
    array: NDArray[Any] = np.lib.format.read_array(io.BytesIO(archive.read(info)), allow_pickle=False)
    return array


def _joined(name: str, paths: Sequence[NDArray[np.int32]]) -> dict[str, NDArray[Any]]:
    """Paths as one array and their lengths."""
    lengths = np.array([len(path) for path in paths], np.int64)
    return {name: np.concatenate([np.empty(0, np.int32), *paths]), f"{name}_lengths": lengths}


def _parted(arrays: Mapping[str, NDArray[Any]], name: str) -> tuple[NDArray[Any], ...]:
    """The paths that `_joined` has made one."""
    lengths = arrays[f"{name}_lengths"]
    if lengths.ndim != 1 or (lengths < 1).any() or lengths.sum() != arrays[name].size:
        raise ValueError(f"the lengths of its {name} do not add up")
    return tuple(part.copy() for part in np.split(arrays[name], lengths.cumsum()[:-1])) if len(lengths) else ()
