"""Environment: the machine that runs are made on, as records and reports state it."""

from __future__ import annotations

import os
import platform
from functools import cache
from pathlib import Path

from antnav.planner.result import versions


@cache
def machine_name() -> str:
    """Processor, cores and system of this machine."""
    return f"{_processor()}, {os.cpu_count()} cores, {platform.system()} {platform.machine()}"


def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text(errors="replace").splitlines()
    except OSError:
        lines = []
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.processor() or "unknown processor"


def machine() -> dict[str, str]:
    """Versions and machine, as the report states them."""
    from importlib.metadata import version

    names = {**versions(), "scipy": version("scipy"), "matplotlib": version("matplotlib")}
    return {
        "versions": ", ".join(f"{name} {number}" for name, number in names.items()),
        "machine": machine_name(),
    }
