"""What a process does a single time."""

from __future__ import annotations

import threading

import pytest

from antnav.planner.once import once


def test_a_piece_of_work_is_done_once_and_again_where_it_failed() -> None:
    done: list[str] = []
    assert once({"one": lambda: done.append("one"), "two": lambda: done.append("two")}) > 0
    assert once({"two": lambda: done.append("again")}) == 0.0
    with pytest.raises(ZeroDivisionError):
        once({"fails": lambda: 1 / 0})
    once({"fails": lambda: done.append("works")})
    assert done == ["one", "two", "works"]


def test_a_piece_of_work_may_do_others() -> None:
    done: list[str] = []
    outer = threading.Thread(target=lambda: once({"outer": lambda: once({"inner": lambda: done.append("inner")})}))
    outer.daemon = True
    outer.start()
    outer.join(20)
    assert done == ["inner"]
