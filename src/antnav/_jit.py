"""One place that decides how kernels are compiled."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar, cast

import numba

F = TypeVar("F", bound=Callable[..., Any])


def jit(function: F) -> F:
    """Compile a kernel: no Python objects, no interpreter lock, machine code kept on disk.

    Where no folder for the machine code can be written (read-only install, user without a home) Numba raises at
    decoration, that is at import. The kernel is then compiled in memory, once a process. `NUMBA_CACHE_DIR` names a
    folder to use instead. No fastmath: the order of additions decides which way an ant goes.
    """
    try:
        return cast(F, numba.njit(nogil=True, cache=True)(function))
    except RuntimeError:
        return cast(F, numba.njit(nogil=True)(function))
