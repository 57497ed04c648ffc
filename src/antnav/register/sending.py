"""How users' code travels to other processes: by value, so that these need neither its file nor its folder."""

from __future__ import annotations

import sys
from typing import Any

from antnav.plugins.source import Source

#: What this process has been sent, and what it has packed, by kind and source.
RECEIVED: dict[tuple[str, Source], Any] = {}
PACKED: dict[tuple[str, Source], bytes] = {}


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
