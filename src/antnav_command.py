"""The command `antnav`: Ctrl-C ends it in one line from the start, also while Python still imports.

It stands beside the package, not in it: to import any part of antnav is to import NumPy and Numba first.
"""

from __future__ import annotations

import os
import signal
import sys
from types import FrameType

INTERRUPTED = 130


def main() -> int:
    """Run the process's command line and return its exit code."""
    ours = signal.getsignal(signal.SIGINT) != signal.SIG_IGN  # not under nohup
    before = signal.signal(signal.SIGINT, _leave) if ours else None
    from antnav.cli import main as run

    if ours:
        signal.signal(signal.SIGINT, before)
    return run()


def _leave(_signal: int, _frame: FrameType | None) -> None:
    """End the process at once: an exception would be taken for a failed import by those that try several."""
    if sys.stderr is not None:
        os.write(2, b"antnav: interrupted\n")
    os._exit(INTERRUPTED)
