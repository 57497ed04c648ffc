"""A link: the whole state of a view as text for a URL."""

from __future__ import annotations

import base64
import zlib
from typing import Annotated

import msgspec
import numpy as np
from msgspec import Meta
from numpy.typing import NDArray

from antnav.errors import ParameterError
from antnav.view.messages import MOST_CELLS, MOST_PANELS, MOST_SEED, Panel

#: Bytes of a state at most, before they are unpacked: cells as text, and a number and a price of each.
_MOST = 32 * MOST_CELLS


class State(msgspec.Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """What a view shows: all that the same bytes come of.

    Attributes
    ----------
    name : str
        Of the map.
    rows, cols : int
    start, goal : (row, col)
    cells : str
        Two bits a cell, four cells a byte, row by row, as base64; "" for a built-in map as it is.
    resolution : float
        Metres a cell.
    origin : (x, y, yaw)
    radius : float
        Of the robot in metres; `cells` are those without it.
    prices : tuple of lists
        Numbers of the cells that cost something, row by row, and what they cost.
    panels : list of Panel
    seed : int
    corner_rule : str
    speed : float
    """

    name: Annotated[str, Meta(max_length=100)]
    rows: Annotated[int, Meta(ge=1, le=MOST_CELLS)]
    cols: Annotated[int, Meta(ge=1, le=MOST_CELLS)]
    start: tuple[int, int]
    goal: tuple[int, int]
    panels: Annotated[list[Panel], Meta(min_length=1, max_length=MOST_PANELS)]
    cells: str = ""
    resolution: float = 1.0
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)
    radius: float = 0.0
    prices: tuple[list[int], list[float]] = ([], [])
    seed: Annotated[int, Meta(ge=0, lt=MOST_SEED)] = 0
    corner_rule: str = "allow"
    speed: float = 2.0


_DECODER = msgspec.json.Decoder(State)


def link_of(state: State) -> str:
    """The state as letters, digits, - and _."""
    return base64.urlsafe_b64encode(zlib.compress(msgspec.json.encode(state), 9)).decode().rstrip("=")


def state_of(link: str) -> State:
    """The state of a link.

    Raises
    ------
    ParameterError
        It is none, or too large.
    """
    try:
        packed = base64.b64decode(link + "=" * (-len(link) % 4), altchars=b"-_", validate=True)
        unpacking = zlib.decompressobj()
        content = unpacking.decompress(packed, _MOST)
        if unpacking.unconsumed_tail:
            raise ValueError("it holds too much")
        return _DECODER.decode(content)
    except (ValueError, zlib.error, msgspec.DecodeError, RecursionError) as error:
        raise ParameterError("link", f"it holds no view: {error}", "copy it whole, or open the view without") from None


def packed(cells: NDArray[np.uint8]) -> str:
    """Cells as `State` keeps them."""
    flat = np.pad(cells.ravel(), (0, -cells.size % 4)).reshape(-1, 4)
    return base64.b64encode((flat << np.array([0, 2, 4, 6], np.uint8)).sum(axis=1, dtype=np.uint8).tobytes()).decode()


def unpacked(text: str, rows: int, cols: int) -> NDArray[np.uint8]:
    """Cells of a `State`.

    Raises
    ------
    ParameterError
        It holds another number of cells.
    """
    try:
        content = np.frombuffer(base64.b64decode(text, validate=True), np.uint8)
    except ValueError:
        content = np.empty(0, np.uint8)
    if len(content) != -(-rows * cols // 4):
        raise ParameterError("link", f"its map has not {rows} x {cols} cells", "copy it whole")
    flat = (content[:, None] >> np.array([0, 2, 4, 6], np.uint8)) & 3
    return flat.ravel()[: rows * cols].reshape(rows, cols).astype(np.uint8)
