"""Running a planner while a person watches: progress, Ctrl-C, and a word before the long first compilation."""

from __future__ import annotations

import contextlib
import math
import os
import shutil
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING, Any, TypeVar

from antnav.cli.terminal import INTERRUPTED, complain, is_terminal
from antnav.kernels import ant_kernels
from antnav.planner.events import Event, Improved, Iterated

if TYPE_CHECKING:
    from rich.progress import Progress

Outcome = TypeVar("Outcome")

#: Seconds between two looks at a run, and the age from which it is worth a progress bar.
TICK, PATIENCE = 0.1, 0.3
#: Columns of the bar. The terminal writes ^C behind it, and must not wrap: the wrong line would be cleared.
WIDEST_BAR, ROOM_FOR_ECHO = 100, 3
#: Loading compiled kernels takes tenths of a second; what takes longer is compiling, whatever the cache folder holds.
LONGEST_LOADING = 1.5
#: Seconds between two figures while kernels compile.
COUNTING = 1.0


@contextlib.contextmanager
def compilation_announced(quiet: bool, kernel: str = "ant_kernels.advance") -> Iterator[None]:
    """Say that kernels are being compiled: at once where that one is not kept on disk, else when it takes long.

    A person at a terminal sees the seconds go by, below that line, until it is done.
    """
    folder = cache_folder()
    kept = folder is not None and any(folder.glob(f"{kernel}-*.nbc"))
    often = (
        "once per machine; `antnav warmup` does it ahead of time"
        if folder
        else "each time, since no folder can keep them: set NUMBA_CACHE_DIR"
    )
    ended = threading.Event()
    delay = LONGEST_LOADING if kept else 0.0
    teller = threading.Thread(target=_tell, args=(f"compiling the kernels ({often})...", delay, ended), daemon=True)
    if not quiet and hasattr(ant_kernels.advance, "stats"):  # not where the compiler is switched off
        teller.start()
    try:
        yield
    finally:
        ended.set()
        if teller.ident is not None:
            teller.join()


def _tell(message: str, delay: float, ended: threading.Event) -> None:
    """Say what lasts longer than `delay` seconds, and on a terminal count the seconds until it has ended."""
    begin = time.perf_counter()
    if ended.wait(delay):
        return
    complain(message, "")
    stream = sys.stderr
    if stream is None or not is_terminal(stream):
        return
    with contextlib.suppress(OSError):
        while not ended.wait(COUNTING):
            stream.write(f"\r{time.perf_counter() - begin:.0f} s")
            stream.flush()
        stream.write("\r\x1b[K")
        stream.flush()


def cache_folder() -> Path | None:
    """Where Numba keeps the compiled kernels; None where it cannot."""
    dispatcher: Any = ant_kernels.advance
    path = dispatcher.stats.cache_path if hasattr(dispatcher, "stats") else None
    return Path(path) if path else None


class Watch:
    """A progress bar on stderr for runs that last; fed by the planner's threads, drawn by the main one.

    Parameters
    ----------
    name : str
        The algorithm, shown before the bar.
    limit : float or None
        Time limit in seconds.
    quiet : bool
        Never draw.
    """

    on_interrupt = "taking the best so far"  #: What is done then, in words.

    def __init__(self, name: str, limit: float | None, quiet: bool) -> None:
        self.optimum = math.inf  #: set as soon as it is known
        self._name, self._limit = name, limit
        self._stage, self._fraction, self._best = "", 0.0, math.inf
        self._begin = time.perf_counter()
        self._bar: Progress | None = None
        self._wanted = not quiet and is_terminal(sys.stderr)

    def hear(self, event: Event) -> None:
        """Events of `solve`."""
        if isinstance(event, Iterated):
            self._fraction = event.fraction
        if isinstance(event, Iterated | Improved):
            self._stage = event.stage
            self._best = event.best if math.isfinite(event.best) else self._best

    def tick(self) -> None:
        """Draw the state of things."""
        seconds = time.perf_counter() - self._begin
        if not self._wanted or seconds < PATIENCE:
            return
        self._bar = self._bar or self._new_bar()
        done = max(self._fraction, seconds / self._limit if self._limit else 0.0)
        self._bar.update(self._bar.task_ids[0], completed=min(1.0, done), state=self._state())
        self._bar.refresh()

    def close(self) -> None:
        """Take the bar away, for good."""
        self._wanted = False
        if self._bar:
            self._bar.stop()
            self._bar = None

    def _state(self) -> str:
        if not math.isfinite(self._best):
            return f"{self._stage}: no path yet" if self._stage else ""
        gap = f", gap {100 * (self._best / self.optimum - 1):.2f} %" if 0 < self.optimum < math.inf else ""
        return f"{self._stage}: {self._best:.2f} cells{gap}"

    def _new_bar(self) -> Progress:
        from rich.console import Console
        from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeElapsedColumn

        bar = Progress(
            TextColumn("{task.description}"),
            BarColumn(bar_width=None),
            TaskProgressColumn(),
            TextColumn("{task.fields[state]}"),
            TimeElapsedColumn(),
            console=Console(stderr=True, width=_bar_width()),
            auto_refresh=False,
            redirect_stdout=False,
            redirect_stderr=False,
            transient=True,
            expand=True,
        )
        bar.add_task(self._name, total=1.0, state="")
        bar.start()
        return bar


class CountWatch(Watch):
    """A progress bar that counts what is done instead of telling lengths.

    Parameters
    ----------
    name : str
        What is counted, in the plural, shown before the bar.
    quiet : bool
        Never draw.
    """

    on_interrupt = "ending"

    def __init__(self, name: str, quiet: bool) -> None:
        super().__init__(name, None, quiet)

    def count(self, done: int, total: int, seconds_left: float | None = None) -> None:
        """Take note that `done` of `total` are done."""
        left = "" if seconds_left is None else f", {seconds_left:.0f} s left"
        self._stage, self._fraction = f"{done} of {total}{left}", done / total

    def _state(self) -> str:
        return self._stage


def _bar_width() -> int:
    return max(20, min(shutil.get_terminal_size().columns - ROOM_FOR_ECHO, WIDEST_BAR))


def run_interruptibly(work: Callable[[threading.Event], Outcome], watch: Watch) -> tuple[Outcome, bool]:
    """Run `work(cancel)` in a thread of its own while the main one listens.

    The first Ctrl-C sets `cancel`, so that the best so far comes back. The second ends the process at once: a kernel
    cannot be stopped, and Python would wait for the thread that runs it.

    Returns
    -------
    outcome
        What `work` returned.
    bool
        Whether it was interrupted.
    """
    cancel = threading.Event()
    interrupted = False  # not `cancel.is_set()`: the solver sets that too, when it fails
    outcomes: list[Outcome] = []
    errors: list[BaseException] = []

    def target() -> None:
        try:
            outcomes.append(work(cancel))
        except BaseException as error:
            errors.append(error)

    def on_interrupt(_signal: int, _frame: FrameType | None) -> None:
        nonlocal interrupted
        if interrupted:
            leave_at_once()
        interrupted = True
        cancel.set()

    thread = threading.Thread(target=target, name="antnav-solve", daemon=True)
    told = False
    with _sigint_to(on_interrupt):
        thread.start()
        while thread.is_alive():
            thread.join(TICK)
            watch.tick()
            if interrupted and not told:
                told = True
                watch.close()
                complain(f"interrupted: {watch.on_interrupt} (Ctrl-C again leaves at once)", kind="")
        watch.close()
    if errors:
        raise errors[0]
    return outcomes[0], interrupted


def leave_at_once() -> None:
    """End the process without waiting for any thread."""
    show_cursor = b"\x1b[?25h\r\x1b[K" if is_terminal(sys.stderr) else b""
    with contextlib.suppress(OSError):
        os.write(2, show_cursor + b"antnav: interrupted\n")
    os._exit(INTERRUPTED)


@contextlib.contextmanager
def _sigint_to(handler: Callable[[int, FrameType | None], Any]) -> Iterator[None]:
    """Handle SIGINT for a while, unless the process was told to ignore it (nohup) or this is not the main thread."""
    ours = threading.current_thread() is threading.main_thread() and signal.getsignal(signal.SIGINT) != signal.SIG_IGN
    before = signal.signal(signal.SIGINT, handler) if ours else None
    try:
        yield
    finally:
        if ours:
            signal.signal(signal.SIGINT, before)
