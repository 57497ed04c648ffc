"""Costs as whole numbers, as `replan_kernels` count them."""

from __future__ import annotations

import math

import numpy as np

from antnav.kernels.graph import SQRT2
from antnav.kernels.replan_kernels import FAR, GRAIN, Scale
from antnav.live.terrain import LiveTerrain

NOTHING = np.empty(0, np.int32)


def scale_of(terrain: LiveTerrain) -> tuple[Scale, float]:
    """How the costs of a terrain become grains, and the largest price with which that can go on.

    Notes
    -----
    A cost is rounded by less than 1e-9 of itself unless cells cost more than some thousands per metre: grains grow with
    the dearest cell then, so that a path of eight times a map's perimeter can be counted.
    """
    if not terrain.priced:
        return Scale(GRAIN, round(GRAIN) - 1, round(SQRT2 * GRAIN) - 1), math.inf
    prices, most = terrain.prices, float(FAR) / (16 * sum(terrain.shape))
    climb = float(np.ptp(prices.heights)) if prices.heights.size else 0.0
    grain = min(GRAIN, 2.0 ** math.floor(math.log2(most / (float(prices.cells.max()) + climb))))
    least = prices.cheapest * grain
    return Scale(grain, int(least) - 1, int(SQRT2 * least) - 1), most / grain - climb
