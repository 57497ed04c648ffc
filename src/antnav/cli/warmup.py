"""`antnav warmup`: compile the kernels now rather than at the first plan."""

from __future__ import annotations

import time
from typing import Annotated

import typer

from antnav.cli.running import cache_folder, compilation_announced
from antnav.cli.terminal import FOUND, say
from antnav.plan.warmup import warmup as compile_kernels


def warmup(
    everything: Annotated[
        bool,
        typer.Option(
            "--all",
            help="Those of `tour`, `pareto`, `replay`, `view`, --alternatives and --trajectory, too: minutes more.",
        ),
    ] = False,
) -> int:
    """Compile the kernels of all planners now, once an environment, so that the first plan is as fast as the next."""
    with compilation_announced(quiet=False):
        seconds = compile_kernels()
        if everything:
            from antnav.fronts.pareto import METHODS
            from antnav.fronts.pareto import warmup as compile_fronts
            from antnav.live.methods import METHODS as REPLANNERS
            from antnav.routes.alternatives import prepare as compile_routes
            from antnav.scenarios.replay import prepare as compile_replanner
            from antnav.tours.tour import prepare as compile_tours
            from antnav.trajectories.trajectory import prepare as compile_trajectories

            seconds += sum(compile_fronts(name) for name, method in METHODS.items() if not method.extra)
            seconds += compile_routes() + compile_tours()
            seconds += sum(compile_replanner(name) for name in REPLANNERS)
            begin = time.perf_counter()
            compile_trajectories()
            seconds += time.perf_counter() - begin
    folder = cache_folder()
    kept = f"kept in {folder}" if folder else "not kept: no folder can be written, set NUMBA_CACHE_DIR"
    say(f"kernels ready in {seconds:.2f} s, {kept}")
    return FOUND
