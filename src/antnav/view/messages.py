"""What a page may say: one message a thing to do, bounded before anything is made of it."""

from __future__ import annotations

from typing import Annotated, Any

import msgspec
from msgspec import Meta

from antnav.errors import ParameterError

#: Cells of a map in the view at most: a page draws them sixty times a second.
MOST_CELLS = 512 * 512
#: Bytes of a message at most: a dropped map file.
MOST_BYTES = 8_000_000
#: Panels at most, and what seeds are below: a page's numbers hold them exactly.
MOST_PANELS, MOST_SEED = 2, 2**53
#: Iterations a second; 0: as many as there can be.
FASTEST = 240.0

_Row = Annotated[int, Meta(ge=-1, le=MOST_CELLS)]
_Pair = tuple[_Row, _Row]
_Name = Annotated[str, Meta(max_length=60)]


class Message(msgspec.Struct, tag_field="do", tag=str.lower, forbid_unknown_fields=True):
    """Something to do."""


class Open(Message):
    """Begin: as a link says, or as the server was started."""

    link: Annotated[str, Meta(max_length=MOST_BYTES)] = ""


class Ack(Message):
    """A frame has been drawn; another may come."""


class Play(Message):
    """Let the iterations go on."""


class Pause(Message):
    """Halt after the iteration."""


class Step(Message):
    """One iteration, then halt."""


class Restart(Message):
    """From the first iteration again."""


class Speed(Message):
    """Iterations a second; 0: as many as there can be."""

    speed: Annotated[float, Meta(ge=0, le=FASTEST)]


class Panel(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """An algorithm, and the parameters in which it differs from its preset."""

    algorithm: _Name
    parameters: dict[_Name, int | float | str | bool | None] = {}


class Choose(Message):
    """Which algorithms, with which seed, under which corner rule; begins again."""

    panels: Annotated[list[Panel], Meta(min_length=1, max_length=MOST_PANELS)]
    seed: Annotated[int, Meta(ge=0, lt=MOST_SEED)] = 0
    corner_rule: _Name = "allow"


class Draw(Message):
    """Cells that are something else now."""

    cells: Annotated[list[_Pair], Meta(max_length=MOST_CELLS)]
    kind: Annotated[str, Meta(pattern="^(wall|free|cost)$")]
    cost: Annotated[float, Meta(ge=0, le=100)] = 0.0


class Ends(Message):
    """The start or the goal is elsewhere."""

    start: _Pair | None = None
    goal: _Pair | None = None


class Load(Message):
    """Another map: a built-in one, an empty one, or one drawn by a generator."""

    name: _Name
    rows: Annotated[int, Meta(ge=2, le=2048)] = 40
    cols: Annotated[int, Meta(ge=2, le=2048)] = 40
    seed: Annotated[int, Meta(ge=0, lt=MOST_SEED)] = 0
    drawn: bool = False  # by a generator, though a built-in map has the same name


class Save(Message):
    """Send a file."""

    what: Annotated[str, Meta(pattern="^(map|result|link)$")]
    panel: Annotated[int, Meta(ge=0, le=1)] = 0


class Drop(Message):
    """Map files: the header of a message of bytes, which follow."""

    files: Annotated[
        list[tuple[Annotated[str, Meta(max_length=200)], Annotated[int, Meta(ge=0, le=MOST_BYTES)]]],
        Meta(min_length=1, max_length=4),
    ]


#: All of them.
Said = Open | Ack | Play | Pause | Step | Restart | Speed | Choose | Draw | Ends | Load | Save | Drop
_DECODER = msgspec.json.Decoder(Said)


def decoded(data: str | bytes) -> tuple[Said, bytes]:
    """A message, and the bytes that follow its header.

    Parameters
    ----------
    data : str or bytes
        JSON; or the length of JSON as four bytes, lowest first, the JSON, and bytes.

    Raises
    ------
    ParameterError
        It is none.
    """
    rest = b""
    if isinstance(data, bytes):
        length = int.from_bytes(data[:4], "little")
        data, rest = data[4 : 4 + length], data[4 + length :]
    try:
        return _DECODER.decode(data), rest
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        raise ParameterError("message", str(error), "reload the page") from None


def encoded(value: Any) -> str:
    """JSON text."""
    return msgspec.json.encode(value).decode()
