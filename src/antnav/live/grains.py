"""Costs as whole numbers, as `replan_kernels` count them."""

from __future__ import annotations

import math

import numpy as np

from antnav.kernels.graph import SQRT2
from antnav.kernels.replan_kernels import FAR, GRAIN, Scale
from antnav.live.terrain import LiveTerrain

NOTHING = np.empty(0, np.int32)


def scale_of(terrain: LiveTerrain, less: int = 0) -> tuple[Scale, float]:
    """How the costs of a terrain become grains, and the largest price with which that can go on.

    Parameters
    ----------
    terrain : LiveTerrain
    less : int
        Grains by which bounds lie below the least cost of each move.

    Notes
    -----
    A cost is rounded by less than 1e-9 of itself unless cells cost more than some thousands per metre: grains grow with
    the dearest cell then, so that a path of eight times a map's perimeter can be counted.
    """
    if not terrain.priced:
        spare = 62 - math.ceil(math.log2(SQRT2 * GRAIN * terrain.moves.size))
        return Scale(GRAIN, round(GRAIN) - less, round(SQRT2 * GRAIN) - less, spare), math.inf
    prices, moves = terrain.prices, 16 * sum(terrain.shape)
    climb = float(np.ptp(prices.heights)) if prices.heights.size else 0.0
    dearest = float(prices.cells.max()) + climb
    grain = min(GRAIN, 2.0 ** math.floor(math.log2(float(FAR) / (moves * dearest))))
    most = min(64 * dearest, float(FAR) / (moves * grain))
    spare = 62 - math.ceil(math.log2(moves * most * grain))
    least = prices.cheapest * grain
    return Scale(grain, int(least) - less, int(SQRT2 * least) - less, spare), most - climb
