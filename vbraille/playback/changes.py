"""Where the numbers of a dataset change, found without unpacking what is the same as before."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Final

import numpy as np

if TYPE_CHECKING:
    import h5py
    from numpy.typing import NDArray

_MOST_KNOWN: Final = 4096
_BLOCK: Final = 1 << 18


def changes(dataset: h5py.Dataset) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Find where the numbers of a dataset change.

    Hours of frames have a number for each; but a chunk that has a single number is packed into the
    same few bytes as others that have the same.

    Parameters
    ----------
    dataset : int64[n]
        Numbers that seldom change.

    Returns
    -------
    int64[m], int64[m]
        Indices at which a stretch of equal numbers begins, and the numbers.
    """
    starts: list[NDArray[np.int64]] = []
    values: list[NDArray[np.int64]] = []
    known: dict[tuple[int, bytes], int] = {}
    before: int | None = None
    for first, stop in _blocks(dataset):
        packed = _packed(dataset, first) if stop - first == (dataset.chunks or (0,))[0] else None
        only = None if packed is None else known.get(packed)
        if only is not None:
            if only == before:
                continue
            at, found = np.array([first]), np.array([only])
        else:
            numbers = dataset[first:stop].astype(np.int64)
            at = np.flatnonzero(np.diff(numbers)) + 1
            at = np.concatenate([[0], at])
            found = numbers[at]
            if at.size == 1 and packed is not None and len(known) < _MOST_KNOWN:
                known[packed] = int(found[0])
            at = at + first
            if found[0] == before:
                at, found = at[1:], found[1:]
        if found.size:
            starts.append(at)
            values.append(found)
            before = int(found[-1])
    if not starts:
        return np.zeros(0, np.int64), np.zeros(0, np.int64)
    return np.concatenate(starts), np.concatenate(values)


def always_zero(dataset: h5py.Dataset) -> bool:
    """Tell whether a packed dataset has zeros alone; False where that takes long to find out.

    No chunk is packed smaller than one of zeros.
    """
    count, size = dataset.shape[0], (dataset.chunks or (0,))[0]
    if not count or not size:
        return not dataset[:1].any()
    if dataset[:size].any():
        return False
    packed = _packed(dataset, 0)
    chunks = -(-count // size)
    return packed is not None and dataset.id.get_storage_size() == chunks * len(packed[1])


def _blocks(dataset: h5py.Dataset) -> list[tuple[int, int]]:
    size = dataset.chunks[0] if dataset.chunks else _BLOCK
    bounds = (*range(0, dataset.shape[0], size), dataset.shape[0])
    return list(pairwise(bounds))


def _packed(dataset: h5py.Dataset, first: int) -> tuple[int, bytes] | None:
    """Bytes of a chunk as they are packed in the file, and which filters; None if not to be had."""
    if not dataset.chunks:
        return None
    try:
        mask, packed = dataset.id.read_direct_chunk((first,))
    except (OSError, RuntimeError, ValueError):
        return None
    return mask, packed
