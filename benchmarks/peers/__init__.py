"""Planners that can be installed, each behind the same two calls.

`antnav bench peers` runs this folder as a program, in whichever interpreter has the peer: it needs NumPy and nothing
else, not even antnav. Adapters import what they adapt where they use it.

    python benchmarks/peers list                             {peer: version} of those installed here
    python benchmarks/peers PEER TASK.npz RUNS SEED SECONDS  one line a run: seconds and path; no new run after SECONDS
"""

from __future__ import annotations

from .aco_routing_ants import AcoRouting
from .antnav_presets import PRESETS, Antnav
from .dijkstra3d_search import Dijkstra3d
from .igraph_dijkstra import Igraph
from .mealpy_acor import Mealpy
from .networkx_astar import Networkx
from .ompl_rrtconnect import Ompl
from .pathfinding_astar import Pathfinding
from .pathplan_planners import Pathplan
from .pmp1 import Pmp1
from .pmp2 import Pmp2
from .pyastar2d_astar import Pyastar2d
from .rustworkx_astar import Rustworkx
from .scipy_dijkstra import Scipy
from .skimage_mcp import Skimage
from .task import Peer
from .tcod_astar import Tcod

#: By name; antnav's own first.
PEERS: dict[str, Peer] = {
    "antnav-astar": Antnav(),
    **{f"antnav-{preset}": Antnav(preset) for preset in PRESETS},
    "scipy": Scipy("forbid"),
    "scipy-allow": Scipy("allow"),
    "tcod": Tcod(),
    "scikit-image": Skimage(),
    "pyastar2d": Pyastar2d(),
    "dijkstra3d": Dijkstra3d(),
    "rustworkx": Rustworkx(),
    "igraph": Igraph(),
    "networkx": Networkx(),
    "pathfinding": Pathfinding(),
    "pmp2-astar": Pmp2("AStar"),
    "pmp2-theta": Pmp2("ThetaStar", "any angle"),
    "pmp1-astar": Pmp1("AStar"),
    "pmp1-aco": Pmp1("ACO", n_ants=50, max_iter=50, alpha=1.0, beta=7.0),
    "pmp1-aco-defaults": Pmp1("ACO"),
    "pathplan-astar": Pathplan("AStarPlanner", "allow"),
    "pathplan-pso": Pathplan("PSOPlanner", "any angle", pop_size=50, max_iter=50),
    "pathplan-ga": Pathplan("GAPlanner", "any angle", pop_size=50, max_iter=50),
    "pathplan-gwo": Pathplan("GWOPlanner", "any angle", pop_size=50, max_iter=50),
    "aco-routing": AcoRouting(),
    "mealpy-acor": Mealpy(),
    "ompl-rrtconnect": Ompl(),
}
