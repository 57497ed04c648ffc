"""What the tests of the view share."""

from __future__ import annotations

import msgspec
import pytest

from antnav.maps import builtin
from antnav.view import messages as say
from antnav.view.messages import Panel
from antnav.view.packet import Packet
from antnav.view.session import Session, Start


def unpacked(packet):
    """The header of a packet, with its arrays as lists."""
    import numpy as np

    content = bytes(packet)
    length = int.from_bytes(content[:4], "little")
    header = msgspec.json.decode(content[4 : 4 + length])
    at = 4 + length
    for name, kind, size in header["blobs"]:
        array = np.frombuffer(content, kind, size, at)
        header[name] = array
        at += -(-array.nbytes // 8) * 8
    assert at == len(content)
    return header


class Page:
    """A page without a browser: says, takes what comes, acknowledges."""

    def __init__(self, *panels, seed=0, grid=None, **options):
        grid = builtin("equiv20") if grid is None else grid
        self.session = Session(Start(grid, panels=[Panel(name) for name in panels or ["npaco"]], seed=seed, **options))
        self.heard = []

    def say(self, message, content=b""):
        self.session.do(message, content)
        return self.take()

    def take_in_silence(self):
        new = [unpacked(one) if isinstance(one, Packet) else one for one in self.session.frames()]
        self.heard += new
        return new

    def take(self):
        new = self.take_in_silence()
        if any(one["is"] == "state" for one in new):
            self.session.do(say.Ack())
        return new

    def last(self, kind):
        return next(one for one in reversed(self.heard) if one["is"] == kind)

    def step(self, count=1):
        for _ in range(count):
            self.say(say.Step())

    def calm(self):
        """Wait until the ants begin anew."""
        import time

        time.sleep(max(self.session.due(), 0) + 0.01)
        self.take()


@pytest.fixture
def page():
    made = Page()
    made.say(say.Open())
    return made
