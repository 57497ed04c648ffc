"""How users' code travels to other processes: by value, so that these need neither its file nor its folder."""

from __future__ import annotations

import pickle
import sys
from collections.abc import Callable
from typing import Any

from antnav.plugins.source import Source

#: What this process has packed, by kind and source, and what it has been sent, by these and the bytes.
_PACKED: dict[tuple[str, Source], bytes] = {}
_RECEIVED: dict[tuple[str, Source, bytes], Any] = {}


def packed(kind: str, source: Source, module: str, content: Any) -> bytes:
    """The code of something, see `by_value`, made once; in notebooks each time: globals may have changed."""
    if not source.file:
        return by_value(module, content)
    if (kind, source) not in _PACKED:
        _PACKED[kind, source] = by_value(module, content)
    return _PACKED[kind, source]


def received(kind: str, source: Source, code: bytes, made: Callable[[Any], Any]) -> Any:
    """What is made of the code that was packed, made once."""
    key = kind, source, code
    if key not in _RECEIVED:
        _RECEIVED[key] = made(pickle.loads(code))
    return _RECEIVED[key]


def by_value(module: str, content: Any) -> bytes:
    """A pickle in which what that module defines stands as code, and not as its name."""
    from numba import cloudpickle as typed

    cloudpickle: Any = typed  # which has no types

    home = sys.modules.get(module)
    if home is None or module == "__main__":  # as it is then anyway
        packed: bytes = cloudpickle.dumps(content)
        return packed
    listed = module in cloudpickle.list_registry_pickle_by_value()
    cloudpickle.register_pickle_by_value(home)
    try:
        packed = cloudpickle.dumps(content)
    finally:
        if not listed:
            cloudpickle.unregister_pickle_by_value(home)
    return packed
