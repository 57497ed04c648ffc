"""Random numbers without a state, to be compiled in the file of each kernel that draws: SplitMix64.

Draw number i of a stream is `unit(mix(key + i * GOLDEN))` (Steele, Lea & Flood 2014, doi 10.1145/2714064.2660195).
"""

from __future__ import annotations

import numpy as np

GOLDEN = np.uint64(0x9E3779B97F4A7C15)
_MIX_1 = np.uint64(0xBF58476D1CE4E5B9)
_MIX_2 = np.uint64(0x94D049BB133111EB)
_S27, _S30, _S31, _S11 = np.uint64(27), np.uint64(30), np.uint64(31), np.uint64(11)
_TO_UNIT = 2.0**-53


def mix(z):
    """Finalizer of SplitMix64."""
    z = (z ^ (z >> _S30)) * _MIX_1
    z = (z ^ (z >> _S27)) * _MIX_2
    return z ^ (z >> _S31)


def unit(z):
    """The upper 53 bits as a number in [0, 1)."""
    return np.float64(z >> _S11) * _TO_UNIT
