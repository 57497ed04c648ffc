"""One place that decides how kernels are compiled, and how their machine code is kept."""

from __future__ import annotations

import contextlib
import hashlib
import logging
import os
import pickle
import zlib
from collections.abc import Callable
from functools import cache, partial
from pathlib import Path
from typing import Any, TypeVar, cast

import numba
from numba.core.caching import FunctionCache, IndexDataCacheFile
from numba.core.environment import Environment
from numba.core.runtime.nrt import rtsys

F = TypeVar("F", bound=Callable[..., Any])

#: Digest of all that machine code is made from. Numba looks only at the file of a kernel itself, but constants and
#: codes of parts from other files are frozen into it, too.
SOURCES = hashlib.sha256(b"".join(file.read_bytes() for file in sorted(Path(__file__).parent.glob("*.py")))).hexdigest()


def jit(function: F) -> F:
    """Compile a kernel: no Python objects, no interpreter lock, machine code kept on disk.

    Where no folder for the machine code can be written (read-only install, user without a home) Numba raises at
    decoration, that is at import. The kernel is then compiled in memory, once a process. `NUMBA_CACHE_DIR` names a
    folder to use instead. No fastmath: the order of additions decides which way an ant goes.

    Where other kernels call it, it becomes part of their machine code: it is compiled without what lets Python call it,
    and not kept. That wrapper unpacks every array of every argument, a fifth of all seconds of compilation. Not so a
    kernel that calls itself, which Numba must know as the one that it is compiling.
    """
    njit: Any = partial(cast(Any, numba.njit), nogil=True, no_cfunc_wrapper=True)
    kernel = njit(function)
    if kernel is not function:  # as it is where the compiler is switched off
        if function.__name__ not in function.__code__.co_names:
            part = cache(lambda: njit(no_cpython_wrapper=True)(function))
            kernel.get_call_template = lambda *args: part().get_call_template(*args)
            kernel.get_overload = lambda signature: part().get_overload(signature)
        with contextlib.suppress(RuntimeError):
            kernel._cache = _Kept(function)  # what cache=True does, with a class of our own
    return cast(F, kernel)


def folder_of(kernel: Callable[..., Any]) -> Path | None:
    """Where the machine code of a kernel is kept; None where it is not."""
    cache = getattr(kernel, "_cache", None)
    return Path(cache.cache_path) if isinstance(cache, _Kept) else None


def is_kept(kernel: Callable[..., Any]) -> bool:
    """Whether there is machine code of a kernel as it is today."""
    cache = getattr(kernel, "_cache", None)
    return isinstance(cache, _Kept) and cache.has_any()


class _Kept(FunctionCache):
    """Numba's cache, but what it cannot read is compiled anew, and what it cannot write stays in memory."""

    def __init__(self, function: Callable[..., Any]) -> None:
        super().__init__(function)
        self._cache_file = _SummedFile(self.cache_path, self._impl.filename_base, self._impl.locator.get_source_stamp())

    def has_any(self) -> bool:
        """Whether there is machine code for any signature."""
        try:
            return bool(self._cache_file._load_index())
        except Exception:  # see below
            return False

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """The machine code for a signature, or None."""
        try:
            rtsys.initialize(target_context)  # and no `target_context.refresh()`, the compiler's library: 0.3 s
            with self._guard_against_spurious_io_errors():
                return self._load_overload(sig, target_context)
        except Exception:  # unpickling damaged bytes raises whatever they say
            _tell(self.cache_path, "cannot be read: they are compiled anew")
            with contextlib.suppress(OSError):
                self.flush()  # or the damaged index would stop saving, too
            return None

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep the machine code for a signature."""
        try:
            super().save_overload(sig, data)
        except Exception as error:
            reason = isinstance(error, OSError) and error.strerror
            _tell(self.cache_path, f"cannot be written ({reason or type(error).__name__}): each run compiles them")


class _SummedFile(IndexDataCacheFile):
    """Machine code with a checksum: a flipped bit in it would not raise but run.

    The sum covers what the code was made from, too: where the disk is full, Numba can write the index of new code and
    leave the file of old code that it names.
    """

    def __init__(self, folder: str, name: str, stamp: object) -> None:
        super().__init__(folder, name, ("summed", SOURCES, stamp))  # files without a checksum are stale, not damaged

    def load(self, key: object) -> Any:
        """What was kept under a key, or None."""
        kept = super().load(key)
        if kept is None:
            return None
        checksum, content = kept
        if checksum != self._sum(key, content):
            raise ValueError("wrong checksum")
        return pickle.loads(content)

    def save(self, key: object, data: object) -> None:
        """Keep something under a key."""
        *compiled, environments = cast(tuple[Any, ...], data)
        content = self._dump((*compiled, [_light(environment) for environment in environments]))
        super().save(key, (self._sum(key, content), content))

    def _sum(self, key: object, content: bytes) -> int:
        return zlib.crc32(content, zlib.crc32(repr((self._source_stamp, key)).encode()))


def _light(environment: Any) -> Any:
    """An environment that is read without an import of its module, whose names only object mode looks up.

    Numba's own import SciPy's linear algebra: 0.2 s at each start, for an error message.
    """
    light = Environment({"__name__": "builtins"})
    light.consts[:] = environment.consts
    light.env_name = environment.env_name
    return light


@cache
def _tell(folder: str | os.PathLike[str], what: str) -> None:
    """Say it once a process: there are fifty kernels."""
    logging.getLogger("antnav").warning("antnav: compiled kernels in %s %s", folder, what)
