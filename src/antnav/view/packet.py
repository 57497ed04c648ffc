"""A packet: a header of JSON and arrays, as one message of bytes that a page reads without copying."""

from __future__ import annotations

from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

#: Arrays begin at multiples of it, as typed arrays of JavaScript must.
_ALIGNMENT = 8


class Packet:
    """A header, and arrays by name.

    Parameters
    ----------
    header : dict
        JSON types, with "is": what it is.
    """

    def __init__(self, header: dict[str, Any]) -> None:
        self.header = header
        self._arrays: list[tuple[str, NDArray[Any]]] = []

    def add(self, name: str, array: NDArray[Any]) -> None:
        """An array of numbers."""
        self._arrays.append((name, np.ascontiguousarray(array)))

    def __bytes__(self) -> bytes:
        blobs = [(name, str(array.dtype), array.size) for name, array in self._arrays]
        header = msgspec.json.encode(self.header | {"blobs": blobs})
        header += b" " * (-(len(header) + 4) % _ALIGNMENT)
        parts = [len(header).to_bytes(4, "little"), header]
        for _, array in self._arrays:
            content = array.astype(array.dtype.newbyteorder("<"), copy=False).tobytes()
            parts += [content, b"\0" * (-len(content) % _ALIGNMENT)]
        return b"".join(parts)
