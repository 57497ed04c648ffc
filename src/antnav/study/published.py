"""What Si & Bao 2024 print in their Tables 2-4: published, on other machines and on the paper's own maps."""

from __future__ import annotations

import re
from dataclasses import dataclass

from antnav.world.problem import CellIndex

PAPER = "Si & Bao 2024, Math. Biosci. Eng. 21(2), doi 10.3934/mbe.2024113"
LABEL = "published (other machines, own maps)"  #: Heads every column that shows one of these figures.
RUNS = 10  #: Behind each printed figure.
SIDES = (20, 30, 40)  #: Of the paper's maps, in cells.


@dataclass(frozen=True)
class Printed:
    """One printed row: seconds, best and mean length in cells."""

    seconds: float
    best: float
    mean: float


#: By side of the map and algorithm; None: "no path".
PRINTED: dict[tuple[int, str], Printed | None] = {
    (20, "paco"): Printed(1.6300, 29.2132, 29.2132),
    (20, "dai"): Printed(4.89, 29.2133, 29.3807),
    (20, "traditional"): Printed(9.22, 37.4143, 38.6335),
    (20, "npaco"): Printed(3.3070, 29.2132, 29.2132),
    (30, "paco"): Printed(7.2252, 37.3848, 37.9173),
    (30, "dai"): Printed(17.97, 37.3849, 38.1262),
    (30, "traditional"): Printed(26.92, 38.2133, 38.6325),
    (30, "npaco"): Printed(13.5880, 37.3848, 37.3848),
    (40, "paco"): Printed(22.8895, 51.1127, 52.5414),
    (40, "dai"): Printed(88.20, 51.1128, 51.8471),
    (40, "traditional"): None,
    (40, "npaco"): Printed(42.4130, 51.1127, 51.7023),
}

#: Auxiliary cells: (row, col) from the top left, and (x, y) as printed.
AUXILIARY: dict[int, tuple[CellIndex, tuple[float, float]]] = {
    20: ((9, 8), (8.5, 10.5)),
    30: ((11, 20), (20.5, 18.5)),
    40: ((19, 11), (11.5, 20.5)),
}

#: Table 1, by our name of each parameter: the paper's symbol, and the value.
TABLE_1: dict[str, tuple[str, float]] = {
    "iterations": ("T", 50),
    "stage_one": ("T0", 3),
    "ants": ("m", 50),
    "q": ("Q", 1),
    "alpha": ("alpha", 1),
    "beta": ("beta", 7),
    "punish": ("lambda", 0.2),
}

#: b of section 5, by side: the share of the iterations after which ants in a dead end are killed.
SWITCH: dict[int, float] = {20: 0.6, 30: 0.7, 40: 0.8}

#: Per cent of NPACO's time that PACO saves.
TIME_SAVED: dict[int, float] = {20: 50.71, 30: 46.83, 40: 46.03}


def side_of(map_label: str) -> int | None:
    """Which of the paper's maps a label stands for: the number at its end, as in "equiv20" and "map 20x20"."""
    found = re.search(r"(?<!\d)(?<!\dx)(20|30|40)(?:x\1)?$", map_label)
    return int(found.group(1)) if found else None


#: What the paper leaves undefined, and what we chose.
CHOICES = (
    "Maps: printed as pictures only. The built-in ones are stand-ins with the paper's start, goal, optimum and "
    "auxiliary cell; their walls are others.",
    "Corner rule: not said. Figure 2's “6 adjacent grids due to two obstacle grids” is read as: an obstacle closes "
    "itself only, a diagonal move may pass its corner (allow, calibrated).",
    "rho and tau0: not printed. 0.1 and 1 for npaco and paco, 0.3 and 1 for traditional (calibrated).",
    "Heuristic: eq. (3.2) to the letter (1 / length of the move) cannot reach the printed lengths of npaco and paco, "
    "which use 1 / distance to the goal here (calibrated); traditional keeps eq. (3.2).",
    "Eq. (4.1) with fewer than 11 arrived ants: both sets apply, reward first. Pheromone below zero: held at 0.001 "
    "tau0. Deposits count in both directions of an edge (calibrated).",
    "Deadlock: ants retract cell by cell until a free neighbour appears while t <= b T, and die later; eq. (4.2) "
    "applies throughout, to the direction in which the ant came. M_lost counts the dead ends met in a cell in one "
    "iteration and starts at 0 in the next (calibrated).",
    "Stage one: iterations 1 to T0 of the schedule over T (section 4.3: “the first T0 iterations of the algorithm”; "
    "paper).",
    "Stage two: T - T0 iterations (paper), from fresh pheromone, its own schedule of eq. (4.1) and of b over T - T0 "
    "(both calibrated: the paper says neither).",
    "Dividing line: the paper breaks its own rule on the 30x30 map; its figures follow the middle row, and so does the "
    'reproduction (axis="row").',
    "Not covered by the paper: no arrival in stage one (it is extended, then the problem is solved undivided), a half "
    "without a path (stage one's path is returned), crossing sub-paths (joined with their loop, as the paper does).",
    "Figures 5 and 6 swap two rules and nothing else: so do ours (npaco with pheromone best_and_worst and deadlock "
    "luo). dai and luo: reconstructions of works that leave choices open.",
)
