"""What a user waits for at the command line: `python benchmarks/bench_startup.py`.

Import, the first `antnav plan` with an empty kernel cache, and the next ones on a 40x40 map, each as a new process.
"""

from __future__ import annotations

import argparse
import os
import statistics
import subprocess
import sys
import tempfile
import time


def seconds(command: list[str], environment: dict[str, str]) -> float:
    begin = time.perf_counter()
    subprocess.run(command, check=True, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return time.perf_counter() - begin


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=11)
    options = parser.parse_args()
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    with tempfile.TemporaryDirectory() as folder:
        environment["NUMBA_CACHE_DIR"] = folder
        plan = [sys.executable, "-m", "antnav", "plan", "equiv40", "--corner-rule", "allow", "--seed", "7"]
        print(f"{'first plan, kernels compiled':<36}{seconds(plan, environment):>8.2f} s")
        jobs = {
            "python -c pass": [sys.executable, "-c", "pass"],
            "import numpy, numba": [sys.executable, "-c", "import numpy, numba"],
            "import antnav": [sys.executable, "-c", "import antnav"],
            "plan equiv40, kernels on disk": plan,
        }
        times: dict[str, list[float]] = {name: [] for name in jobs}
        for _ in range(options.rounds):
            for name, command in jobs.items():
                times[name].append(seconds(command, environment))
        for name, values in times.items():
            spread = f"(median of {options.rounds}, fastest {min(values):.2f})"
            print(f"{name:<36}{statistics.median(values):>8.2f} s   {spread}")


if __name__ == "__main__":
    main()
