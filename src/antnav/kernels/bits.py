"""Bits of machine words, as kernels and plain Python count them."""

from __future__ import annotations

from numba.core import cgutils, types
from numba.extending import intrinsic, overload


def lowest_bit(word):
    """Place of the lowest bit that is set in an int64, which is not 0."""
    return (int(word) & -int(word)).bit_length() - 1


@intrinsic
def _trailing_zeros(typing_context, word):
    def build(context, builder, signature, arguments):
        return builder.cttz(arguments[0], cgutils.true_bit)

    return types.int64(types.int64), build


@overload(lowest_bit)
def _lowest_bit(word):
    def count(word):
        return _trailing_zeros(word)

    return count
