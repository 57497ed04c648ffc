"""The command `antnav`: Ctrl-C ends it in one line from the start, also while Python still imports.

It stands beside the package, not in it: to import any part of antnav is to import NumPy and Numba first.
"""

from __future__ import annotations

import os
import signal
import sys
from importlib.metadata import version
from types import FrameType

INTERRUPTED = 130


def main() -> int:
    """Run the process's command line and return its exit code."""
    if sys.argv[1:] == ["--version"] and version_told():
        return 0
    ours = signal.getsignal(signal.SIGINT) != signal.SIG_IGN  # not under nohup
    before = signal.signal(signal.SIGINT, _leave) if ours else None
    from antnav import cli

    cli.load(sys.argv[1:])  # imports what the command needs
    if ours:
        signal.signal(signal.SIGINT, before)
    return cli.main()


def version_told() -> bool:
    """Whether the version could be printed without the package, whose import takes half a second."""
    try:
        print(f"antnav {version('antnav')}", flush=True)
    except OSError:  # a full disk, a reader that has gone: the package has words for them
        return False
    return True


def _leave(_signal: int, _frame: FrameType | None) -> None:
    """End the process at once: an exception would be taken for a failed import by those that try several."""
    if sys.stderr is not None:
        os.write(2, b"antnav: interrupted\n")
    os._exit(INTERRUPTED)
