"""once: what a process does a single time, such as compiling kernels, and how long it took."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Mapping

_lock = threading.RLock()  # what is done once may need something else that is
_done: set[str] = set()


def once(work: Mapping[str, Callable[[], object]]) -> float:
    """Do each named piece of work unless this process has done it; seconds that it took, 0 where all was done."""
    with _lock:
        begin = time.perf_counter()
        missing = [name for name in work if name not in _done]
        for name in missing:
            work[name]()
            _done.add(name)
        return time.perf_counter() - begin if missing else 0.0
