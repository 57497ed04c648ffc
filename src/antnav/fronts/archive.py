"""Archive: vectors that no other beats, with their paths, for methods that find them in any order."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from antnav.errors import ParameterError
from antnav.fronts.instance import Instance
from antnav.kernels import archive_kernels as kernels

#: The least tolerance above none, as a share of each objective's range.
_FINEST = 1 / 4096
#: Paths one after the other: values (p, k), nodes of each, nodes of all.
Paths = tuple[NDArray[np.int64], NDArray[np.int32], NDArray[np.int32]]


def empty(size: int, room: int, ranges: NDArray[np.int64], tolerance: NDArray[np.int64]) -> kernels.Archive:
    """An archive for some more than `size` vectors with paths of `room` nodes in all."""
    k, blocks = len(ranges), 2 + 4 * size // kernels.BLOCK
    places = blocks * kernels.BLOCK
    return kernels.Archive(
        values=np.empty((places, k), np.int64),
        begin=np.zeros(places, np.int64),
        length=np.zeros(places, np.int32),
        size=np.zeros(blocks, np.int32),
        low=np.zeros((blocks, k), np.int64),
        high=np.zeros((blocks, k), np.int64),
        tolerance=tolerance,
        scale=1.0 / np.maximum(ranges, 1),
        pool=np.empty(room, np.int32),
        counts=np.zeros(4, np.int64),
    )


def sketch(archive: kernels.Archive, room: int) -> kernels.Archive:
    """A copy that knows all vectors, and has room for paths of its own."""
    copies = {name: getattr(archive, name).copy() for name in ("values", "begin", "size", "low", "high", "counts")}
    copies["counts"][kernels.USED] = 0
    nowhere = np.zeros_like(archive.length)
    return archive._replace(**copies, length=nowhere, pool=np.empty(room, np.int32))


def paths_of(archive: kernels.Archive) -> Paths:
    """All paths that lie there, in the order in which they came."""
    places = kernels.listed(archive)
    return archive.values[places], archive.length[places], kernels.gathered(archive, places)


def taken(archive: kernels.Archive, paths: Paths, limit: int) -> kernels.Archive:
    """The archive with these paths, those that are not beaten; where more than `limit` are left, a coarser one."""
    values, lengths, nodes = paths
    compacted = False
    while True:
        count = kernels.add(archive, values, lengths, nodes)
        if count == len(lengths) and archive.counts[kernels.ENTRIES] <= limit:
            return archive
        values, lengths, nodes = values[count:], lengths[count:], nodes[int(lengths[:count].sum()) :]
        full = compacted and count == 0  # of paths that are all needed: no gap is left to close
        if full and not archive.counts[kernels.ENTRIES]:
            raise ParameterError(f"a path of {lengths[0]} cells", "the archive has no room for it", "crop the map")
        archive = _compact(archive, limit, coarser=full)
        compacted = True


def _compact(archive: kernels.Archive, limit: int, *, coarser: bool) -> kernels.Archive:
    """The same without gaps; with a larger tolerance where there are more than `limit`, or on demand."""
    paths = paths_of(archive)
    tolerance = _coarser(archive, archive.tolerance) if coarser else archive.tolerance
    while True:
        fresh = empty(limit, len(archive.pool), archive.tolerance, tolerance)._replace(scale=archive.scale)
        kernels.add(fresh, *paths)
        if fresh.counts[kernels.ENTRIES] <= limit:
            return fresh
        tolerance = _coarser(archive, tolerance)


def _coarser(archive: kernels.Archive, tolerance: NDArray[np.int64]) -> NDArray[np.int64]:
    """Twice the tolerance, or the finest that there is."""
    finer: NDArray[np.int64] = np.maximum(2 * tolerance, np.ceil(_FINEST / archive.scale).astype(np.int64))
    return finer


def none(k: int) -> Paths:
    """No paths, of k objectives."""
    return np.empty((0, k), np.int64), np.empty(0, np.int32), np.empty(0, np.int32)


def joined(instance: Instance, paths: Sequence[NDArray[np.int32]]) -> Paths:
    """Paths one after the other, with their values."""
    values = instance.steps(paths)
    return values, np.array([len(path) for path in paths], np.int32), np.concatenate(paths).astype(np.int32)


def split(archive: kernels.Archive) -> list[NDArray[np.int32]]:
    """The paths, one by one."""
    _, lengths, nodes = paths_of(archive)
    return np.split(nodes, np.cumsum(lengths)[:-1])


def left_out(archive: kernels.Archive, instance: Instance) -> tuple[str, ...]:
    """What a reader must know of an archive that was too small; nothing where it was not."""
    if not archive.tolerance.any():
        return ()
    hairs = [f"{number * each.step:.3g}" for number, each in zip(archive.tolerance, instance.prices, strict=True)]
    return (f"too many paths to keep: those better by up to {', '.join(hairs)} in the objectives were left out",)
