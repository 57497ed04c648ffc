"""The program: this folder, run by an interpreter that has never heard of antnav."""

import sys
from pathlib import Path

here = Path(__file__).resolve().parent
sys.path[:] = [str(here.parent), *(entry for entry in sys.path if Path(entry).resolve() != here)]
from peers.worker import main  # noqa: E402 - found by the line above

del sys.path[0]  # what lies there must not pass for a peer's module
main(sys.argv[1:])
