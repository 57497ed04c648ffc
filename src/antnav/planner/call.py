"""Call: how a planner is asked, everything but the problem."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Executor
from typing import TYPE_CHECKING

import msgspec

from antnav.errors import ParameterError, check_type, shown
from antnav.planner.memory import Memory
from antnav.planner.plan import StoppedBy
from antnav.run import spmd
from antnav.run.stop import Clock, Progress, Stop

if TYPE_CHECKING:
    from antnav.run.channel import Asked


class CancelOrFailure:
    """The caller's event, or a failure here: that must end all work of the run, but not set the caller's event."""

    def __init__(self, event: Asked | None = None) -> None:
        self.event, self.failed = event, False

    def is_set(self) -> bool:
        """Whether to stop."""
        return self.failed or (self.event is not None and self.event.is_set())


def check_conduct(stop: Stop | None, executor: Executor | None, cancel: Asked | None) -> None:
    """Refuse what cannot end a run, or carry it.

    Raises
    ------
    ParameterError
    """
    check_type("stop", stop, Stop | None, "give a criterion of antnav.run.stop, such as Seconds(0.5)")
    spmd.shares_memory(executor)  # checks it
    if not (cancel is None or callable(getattr(cancel, "is_set", None))):
        raise ParameterError(f"cancel {shown(cancel)}", "it has is_set()", "give a threading.Event")


class Event:
    """Something that happens in a run: see `antnav.events`."""

    __slots__ = ()


class Call(msgspec.Struct, frozen=True, eq=False):
    """What `solve` was given beside the problem; a planner reads what it needs.

    Attributes
    ----------
    seed : int
        The only source of chance.
    stop : Stop or None
    executor : concurrent.futures.Executor or None
        For work side by side; None: threads.
    cancel : CancelOrFailure
        Ask `is_set()` now and then, and return the best so far once it is.
    events : callable or None
        Gets an `Event` now and then: see `antnav.events`.
    began : Clock
        Runs since the call.
    warm : Memory or None
        The pheromone to begin with; only planners that say so (`remembers`) are asked.
    remember : bool
        Whether the plan should have a memory; only they are asked.
    """

    seed: int = 0
    stop: Stop | None = None
    executor: Executor | None = None
    cancel: CancelOrFailure = msgspec.field(default_factory=CancelOrFailure)
    events: Callable[[Event], None] | None = None
    began: Clock = msgspec.field(default_factory=Clock)
    warm: Memory | None = None
    remember: bool = False

    def ending(self, iterations: int, best: float, stagnant: int = 0) -> StoppedBy | None:
        """What ends the run now, after so many iterations with that best length; None: nothing does."""
        if self.cancel.is_set():
            return StoppedBy.CANCELLED
        if self.stop and self.stop.reached(Progress(iterations, self.began.seconds(), best, stagnant)):
            return StoppedBy.CRITERION
        return None

    def tell(self, event: Event) -> None:
        """Tell whoever listens."""
        if self.events:
            self.events(event)
