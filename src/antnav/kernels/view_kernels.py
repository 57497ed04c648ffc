"""Pheromone as shades, thirty times a second."""

from __future__ import annotations

import numpy as np

from antnav.kernels.jit import jit

#: Nodes by which the usual value is known.
SAMPLE = 1024


@jit
def shade(tau, neighbours, cells, faintest, shades):
    """Darken cells by the strongest edge out of each: 255 at the most, 0 at what most have, logarithmic between.

    Parameters
    ----------
    tau : float64 (n, 8)
    neighbours : int32 (n, 8)
        n where there is no edge.
    cells : int64 (n, 2)
        Row and column of each node.
    faintest : float
        What is below this share of the most is not seen either.
    shades : uint8 (rows, cols)
        Never made lighter.
    """
    n = len(tau)
    strongest = np.zeros(n)
    most = 0.0
    for node in range(n):
        for slot in range(8):
            if neighbours[node, slot] < n and tau[node, slot] > strongest[node]:
                strongest[node] = tau[node, slot]
        most = max(most, strongest[node])
    least = max(np.median(strongest[:: max(1, n // SAMPLE)]), faintest * most)
    if not 0.0 < least < most:
        return
    scale = 255.0 / np.log(most / least)
    for node in range(n):
        if strongest[node] > least:
            row, col = cells[node]
            value = np.uint8(np.log(strongest[node] / least) * scale)
            shades[row, col] = max(shades[row, col], value)
