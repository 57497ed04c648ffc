"""`import antnav` stays light: what is heavy is imported where it is used."""

from __future__ import annotations

import subprocess
import sys

HEAVY = ("matplotlib", "PIL", "rich", "typer", "scipy.ndimage", "scipy.stats", "distributed", "asyncio")


def test_import_brings_nothing_heavy_and_compiles_nothing() -> None:
    script = (
        "import sys, antnav\n"
        f"print([name for name in {HEAVY!r} if name in sys.modules])\n"
        "from antnav import grid_kernels; from antnav.colony import kernels\n"
        "print([kernel.signatures for kernel in (kernels.advance, grid_kernels.search)])\n"
        "print(sorted(name for name in antnav.__all__ if not hasattr(antnav, name)))"
    )
    lines = subprocess.run([sys.executable, "-c", script], check=True, capture_output=True, text=True).stdout.split(
        "\n"
    )
    assert lines[:3] == ["[]", "[[], []]", "[]"]
