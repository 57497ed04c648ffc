"""The view as a notebook's widget, in Jupyter and marimo."""

from __future__ import annotations

import contextlib
import math
import threading
from importlib.resources import files
from typing import TYPE_CHECKING, Any

from antnav.errors import AntnavError, ParameterError
from antnav.plan.algorithms import short_name
from antnav.plan.warmup import warmup
from antnav.values import check_seed
from antnav.view import messages
from antnav.view.menu import planners
from antnav.view.messages import Panel, decoded
from antnav.view.packet import Packet
from antnav.view.session import Session, Start
from antnav.world.problem import Problem, check_problem

if TYPE_CHECKING:
    from anywidget import AnyWidget


def View(problem: Problem, *algorithms: str, seed: int = 0) -> AnyWidget:  # noqa: N802 - notebooks call it as a class
    """Watch ants in a notebook, and draw on the map: the page of `antnav view` as a widget.

    Parameters
    ----------
    problem : Problem
        Map, ends, corner rule and costs to begin with; up to 512 x 512 cells.
    *algorithms : str
        One or two names that the view offers, side by side under the same seed; default: "paco".
    seed : int
        0 <= seed < 2**53, what a page's numbers hold exactly.

    Returns
    -------
    anywidget.AnyWidget
        Shown where it is a cell's last line.

    Raises
    ------
    ParameterError
        anywidget is not installed; there is no such algorithm, or more than two; the seed is out of range.
    MapSizeError
        The map is too large for the view.

    Examples
    --------
    ::

        an.View(problem, "paco", "npaco")
    """
    check_problem(problem)
    check_seed(seed)
    names = algorithms or ("paco",)
    ends = problem.start_cell, problem.goal_cell
    panels = [Panel(short_name(name)) for name in names]
    start = Start(problem.grid, *ends, panels, int(seed), problem.corner_rule, cost=problem.cost)
    for planner in planners(panels):
        warmup(planner)
    return _widget(start)


def _widget(start: Start) -> AnyWidget:
    try:
        import anywidget
    except ImportError as error:
        raise ParameterError("a widget", "anywidget is not installed", 'pip install "antnav[notebook]"') from error

    page = files(__package__).joinpath("page")

    class Widget(anywidget.AnyWidget):
        """One view; a thread of its own lets the ants walk."""

        _esm = page.joinpath("view.js").read_text("utf-8")
        _css = page.joinpath("view.css").read_text("utf-8")

        def __init__(self, **traits: Any) -> None:
            super().__init__(**traits)
            self._channel = _Channel(Session(start), self.send)
            self.on_msg(self._channel.hear)

        def close(self) -> None:
            self._channel.ended.set()
            self._channel.heard.set()
            super().close()

    return Widget()


class _Channel:
    """Messages in, packets out, as the widget's own messages with buffers."""

    def __init__(self, session: Session, send: Any) -> None:
        self.session, self._send = session, send
        self.heard, self.ended = threading.Event(), threading.Event()
        self._lock = threading.Lock()
        self._thread: threading.Thread | None = None

    def hear(self, _widget: Any, content: Any, buffers: Any) -> None:
        """What the page says."""
        data = bytes(buffers[0]) if buffers else content.get("message", "") if isinstance(content, dict) else ""
        try:
            message, rest = decoded(data)
        except AntnavError:  # not of the view's page
            return
        with self._lock:
            self.session.do(message, rest)
        if isinstance(message, messages.Open) and self._thread is None:
            self._thread = threading.Thread(target=self._serve, name="antnav-view", daemon=True)
            self._thread.start()
        self.heard.set()

    def _serve(self) -> None:
        while not self.ended.is_set():
            self.heard.clear()
            with self._lock:
                wait = self.session.due()
                packets = [] if wait > 0 else self.session.frames()
            with contextlib.suppress(Exception):  # of a notebook that is gone
                for packet in packets:
                    if isinstance(packet, Packet):
                        self._send({"packet": True}, buffers=[bytes(packet)])
                    else:
                        self._send(packet)
            if wait > 0:
                self.heard.wait(None if math.isinf(wait) else wait)
