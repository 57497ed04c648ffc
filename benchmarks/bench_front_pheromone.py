"""What pheromone adds to ants for fronts: `python benchmarks/bench_front_pheromone.py [SECONDS [SEEDS]]`.

Four objectives of `bench_pareto.py` on random maps and caves of 128 cells a side; the power alpha of the pheromone 0
(none), 1 and 2, in turn at every seed, with the five temperatures of the colonies and with one. SECONDS (default 1.5)
of CPU time a run with one worker, SEEDS (default 6). Share of the hypervolume of all runs' union: mean, least.
"""

from __future__ import annotations

import sys

import numpy as np
from bench_pareto import CpuSeconds, asked

import antnav as an
from antnav import maps
from antnav.fronts import colonies, indicators
from antnav.fronts.pareto import warmup
from antnav.run.spmd import Serial

ALPHAS = (0.0, 1.0, 2.0)


def main() -> None:
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 1.5
    seeds = int(sys.argv[2]) if len(sys.argv) > 2 else 6
    warmup("ants")
    print("map         temperatures  alpha    mean   least")
    for kind in ("random", "caves"):
        grid = maps.generate(kind, 128, 128, seed=1)
        problem = an.Problem.from_cells(grid, *maps.ends(grid))
        objectives = asked(grid, 4)
        for heats in (colonies._HEATS, (5e-3,)):
            before, colonies._HEATS = colonies._HEATS, heats
            found = {}
            for seed in range(seeds):
                for alpha in ALPHAS:
                    ants = an.fronts.Colonies(rounds=10**6, alpha=alpha)
                    stop = CpuSeconds(seconds)
                    front = an.pareto(problem, objectives, algorithm=ants, seed=seed, stop=stop, executor=Serial())
                    found[alpha, seed] = front.values
            colonies._HEATS = before
            union = indicators.undominated(np.concatenate(list(found.values())))
            for alpha in ALPHAS:
                shares = [indicators.compare(found[alpha, seed], union)["hypervolume"] for seed in range(seeds)]
                figures = f"{np.mean(shares):6.4f}  {min(shares):6.4f}"
                print(f"{kind:<10}  {len(heats):12}  {alpha:5g}  {figures}", flush=True)


if __name__ == "__main__":
    main()
