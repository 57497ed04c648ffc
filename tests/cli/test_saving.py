"""What pictures need is imported while kernels run; without pictures, or matplotlib, nothing is."""

from __future__ import annotations

import subprocess
import sys

import pytest

SCRIPT = """
import sys, threading
from pathlib import Path
from antnav.cli.saving import import_for_pictures

if sys.argv[2:] == ["broken"]:
    sys.modules["matplotlib"] = None
import_for_pictures([Path("path.json"), Path(sys.argv[1])])
for thread in threading.enumerate():
    if thread is not threading.main_thread():
        thread.join()
print("matplotlib.figure" in sys.modules)
"""


@pytest.mark.parametrize(
    ("words", "imported"), [(["path.csv"], False), (["path.png"], True), (["path.png", "broken"], False)]
)
def test_matplotlib_is_imported_ahead_for_pictures_alone(words: list[str], imported: bool) -> None:
    run = subprocess.run([sys.executable, "-c", SCRIPT, *words], capture_output=True, text=True, check=False)
    assert (run.stdout, run.stderr) == (f"{imported}\n", "")
