"""The constants of the presets, as their sources print them or as docs/algorithms says that they were calibrated.

Written out here once more, so that a slip in a preset or in a default is seen.
"""

from __future__ import annotations

from typing import Any

import pytest

import antnav as an
from antnav import maps
from antnav.ants.presets import preset
from antnav.colony.parts import Hybrid, Target

#: Si & Bao 2024, sections 3 to 5; rho, tau0 and tau_min are not printed there [calibrated].
PAPER = {"ants": 50, "iterations": 50, "alpha": 1, "beta": 7, "q": 1, "rho": 0.1, "tau0": 1, "tau_min": 0.001}
HYBRID = {"pheromone": "reward_and_punish", "deadlock": "hybrid", "transition": "roulette", "punish": 0.2}

PUBLISHED: dict[str, dict[str, Any]] = {
    # rho as in widespread grid-ant code
    "traditional": PAPER | {"rho": 0.3, "heuristic": "edge", "pheromone": "ant_system", "deadlock": "death"},
    "npaco": PAPER | HYBRID | {"deposit": "both", "initial": "uniform", "local_search": "none"},
    "paco": PAPER | HYBRID | {"stage_one": 3, "search": "whole", "inherit": False, "join": "paper", "axis": "auto"},
    "paco_extended": PAPER | HYBRID | {"stage_one": 3, "search": "half", "inherit": True, "join": "repair"},
    "paco_ls": PAPER | HYBRID | {"local_search": "shortcut"},
    # Luo et al. 2020
    "luo": PAPER
    | {"q0_min": 0.1, "q0_max": 0.8, "q0_relief": 0.8, "initial": "unequal", "initial_weight": 1, "punish": 0.2}
    | {"pheromone": "best_and_worst", "deadlock": "luo", "transition": "pseudo_random"},
    # Dai et al. 2019: Q1, Q2, Q3, phi, psi = 10 / pi
    "dai": PAPER
    | {"q": 1.2, "q2": 1.5, "q3": 1.2, "bend_turn": 2, "bend_angle": 3.183098861837907, "bend_with_start": False}
    | {"rho": 0.3, "heuristic": "astar", "pheromone": "best_and_turns", "deadlock": "retract"},
    # Bullnheimer, Hartl & Strauss 1999: w
    "rank_as": PAPER | {"elite": 6, "pheromone": "rank_based"},
    # Stuetzle & Hoos 2000
    "mmas": {"best_every": 25, "pheromone": "max_min"},
    # Dorigo & Gambardella 1997
    "acs": {"ants": 10, "q0_min": 0.9, "q0_max": 0.9, "local_rate": 0.1, "rho": 0.1, "tau0": 0.01}
    | {"pheromone": "best_so_far", "transition": "pseudo_random"},
    "akka": {"openness": 1, "rho": 0.3, "rho_last": 0.05},
    "you": {"ants": 10, "beta": 7, "beta_last": 2, "q0_max": 0.9, "local_rate": 0.1},
    "gao": {"spread": 0.1, "deadlock": "backtrack", "local_search": "merge"},
    "deng": {"deposit": "cells"},
    "liu": {"spread": 0.2, "local_search": "shortcut"},
}


@pytest.mark.parametrize("name", PUBLISHED)
def test_constants(name: str) -> None:
    choices = preset(name).choices()
    assert {key: choices[key] for key in PUBLISHED[name]} == PUBLISHED[name]


@pytest.mark.parametrize(("side", "share"), [(20, 0.6), (30, 0.7), (40, 0.8)])
def test_when_dead_ends_begin_to_kill_depends_on_the_map(side: int, share: float) -> None:
    """b of section 4.2; the heuristic of npaco on the paper's sizes."""
    found = an.npaco().on(maps.builtin(f"equiv{side}"))
    assert (found.deadlock, found.heuristic) == (Hybrid(switch=share), Target())
