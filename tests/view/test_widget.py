"""The view as a notebook's widget, with a page that is a list."""

from __future__ import annotations

import time

import msgspec
import pytest

import antnav as an
from antnav.errors import AntnavError

pytest.importorskip("anywidget", reason="the extra antnav[notebook] is not installed")


@pytest.fixture(scope="module")
def problem():
    start, goal = an.maps.builtin_query("equiv20")
    return an.Problem.from_cells(an.maps.builtin("equiv20"), start, goal, corner_rule="allow")


def said(widget, **message):
    widget._channel.hear(widget, {"message": msgspec.json.encode(message).decode()}, [])


def waited(condition, seconds=20):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if condition():
            return
        time.sleep(0.02)
    raise AssertionError("it does not come")


def test_a_page_in_a_notebook_plays_to_the_end_and_closes(problem):
    widget = an.View(problem, "npaco", "paco", seed=2)
    heard = []
    widget._channel._send = lambda content, buffers=None: heard.append((content, buffers))
    said(widget, do="open", link="")
    waited(lambda: any(content.get("is") == "menu" for content, _ in heard))
    said(widget, do="speed", speed=0)
    said(widget, do="play")
    done = 0

    def ended():
        nonlocal done
        states = [content for content, _ in heard if content.get("is") == "state"]
        for _ in range(len(states) - done):
            said(widget, do="ack")
        done = len(states)
        return states and states[-1]["done"]

    waited(ended)
    assert sum(bool(buffers) for _, buffers in heard) > 4
    widget._channel.hear(widget, "nonsense", [])
    thread = widget._channel._thread
    widget.close()
    waited(lambda: not thread.is_alive())


def test_the_module_and_its_style_are_those_of_the_page(problem):
    widget = an.View(problem)
    assert "export default" in str(widget._esm)
    assert "body" not in str(widget._css)  # a notebook's page is not ours
    widget.close()


@pytest.mark.parametrize(
    ("algorithms", "seed"), [(("paco", "npaco", "acs"), 0), (("nobody",), 0), ((), 2**60), ((), "x"), ((3,), 0)]
)
def test_what_it_cannot_show_is_refused(problem, algorithms, seed):
    with pytest.raises(AntnavError):
        an.View(problem, *algorithms, seed=seed)


def test_fronts_are_tables_in_notebooks(problem):
    front = an.pareto(problem, [an.objectives.Length(), an.objectives.Turns()])
    html = front._repr_html_()
    assert html.count("<tr>") == 1 + min(len(front), 12)
