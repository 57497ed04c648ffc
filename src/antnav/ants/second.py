"""A second process that compiles some kernels while this one compiles others: threads cannot, Numba has a lock."""

from __future__ import annotations

import contextlib
import os
import subprocess
import sys
import threading
import time
from collections.abc import Sequence
from pathlib import Path
from types import TracebackType
from typing import Self

from antnav.kernels import ant_kernels
from antnav.kernels.jit import folder_of, is_kept

#: Seconds after which the lock of a process that was killed counts no more.
STALE = 300.0
#: Python code of the second process. Where it finds another antnav than the first, it has nothing to give.
CODE = """
import sys
from antnav.ants import second, warmup
if second.__file__ == sys.argv[1]:
    second.end_with_the_first()
    warmup.compile_named(sys.argv[2:])
"""


class SecondProcess:
    """Compiles what it is told, into the folder of the cache, from where this process loads it.

    Nothing depends on it: what it fails to do is compiled here.
    """

    def __init__(self) -> None:
        self._process: subprocess.Popen[bytes] | None = None
        self._lock: Path | None = None
        self._began = 0.0

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._process:
            self._process.kill()
            self._process.communicate()
        if self._lock:
            self._lock.unlink(missing_ok=True)

    def start(self, names: Sequence[str]) -> None:
        """Let it compile, where nothing is kept yet, another core is there, and nobody else does it already."""
        if not names or is_kept(ant_kernels.advance) or _cores() < 2 or not _is_python(sys.executable):
            return
        self._began = time.perf_counter()
        with contextlib.suppress(OSError):
            self._lock = _locked(folder_of(ant_kernels.advance))
            if self._lock:
                self._process = subprocess.Popen(
                    [sys.executable, "-P", "-c", CODE, __file__, *names],
                    stdin=subprocess.PIPE,
                    stdout=subprocess.DEVNULL,
                    stderr=subprocess.DEVNULL,
                    creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
                )

    def join(self) -> None:
        """Wait until it is done, but no longer than this process has worked beside it."""
        if self._process:
            with contextlib.suppress(subprocess.TimeoutExpired):
                self._process.wait(time.perf_counter() - self._began)


def end_with_the_first() -> None:
    """In the second process: end as soon as nobody holds the other end of its input, however the first one ended."""

    def watch() -> None:
        os.read(0, 1)
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


def _locked(folder: Path | None) -> Path | None:
    """The lock of a folder, if it was free."""
    if folder is None:
        return None
    lock = folder / "compiling.lock"
    with contextlib.suppress(FileNotFoundError):
        if time.time() - lock.stat().st_mtime > STALE:
            lock.unlink()
    lock.touch(exist_ok=False)
    return lock


def _cores() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _is_python(executable: str | None) -> bool:
    """Whether that program takes Python's options: where Python is embedded or frozen it is any program."""
    return Path(executable or "").name.lower().startswith("python")
