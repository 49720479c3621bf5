"""Where the numbers of a dataset change, found without unpacking what is the same as before."""

from __future__ import annotations

import os
import zlib
from typing import TYPE_CHECKING, Any, Final

import h5py
import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

_MOST_KNOWN: Final = 4096
_BLOCK: Final = 1 << 18
_PLAIN: Final = {h5py.h5z.FILTER_SHUFFLE, h5py.h5z.FILTER_DEFLATE}


def changes(dataset: h5py.Dataset) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Find where the numbers of a dataset change.

    Hours of frames have a number for each, and unpacking them all takes seconds. But chunks in
    which a number is always the same are the same bytes in the file.

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
    before: int | None = None
    for first, numbers in _packed(dataset) or _unpacked(dataset):
        if isinstance(numbers, int):
            at, found = np.array([first]), np.array([numbers])
        else:
            at = np.flatnonzero(np.diff(numbers, prepend=numbers[0] - 1))
            at, found = at + first, numbers[at]
        same = int(found[0] == before)
        starts.append(at[same:])
        values.append(found[same:])
        before = int(found[-1])
    return np.concatenate([*starts, np.zeros(0, np.int64)]), np.concatenate(
        [*values, np.zeros(0, np.int64)]
    )


def _unpacked(dataset: h5py.Dataset) -> Iterator[tuple[int, NDArray[np.int64]]]:
    """Read a dataset block by block, by HDF5 itself: index of the first number, and the numbers."""
    for first in range(0, dataset.shape[0], _BLOCK):
        yield first, dataset[first : first + _BLOCK].astype(np.int64)


def _packed(dataset: h5py.Dataset) -> list[tuple[int, NDArray[np.int64] | int]] | None:
    """Read a dataset from the bytes of its chunks, which is much faster.

    Returns
    -------
    list or None
        For each chunk, the index of its first number, and the numbers, or the one number that all
        of them are where there is no other than before. None where the dataset is not packed as
        `vbraille render` does it, or is not whole.
    """
    chunks = _chunks(dataset)
    if chunks is None:
        return None
    size = (dataset.chunks or (0,))[0]
    known: dict[bytes, int] = {}
    made: list[tuple[int, NDArray[np.int64] | int]] = []
    only = None
    with open(dataset.file.filename, "rb", buffering=0) as file:  # noqa: PTH123 - any path
        for first, at, length in chunks:
            packed = os.pread(file.fileno(), length, at)
            if (found := known.get(packed)) is None:
                try:
                    shuffled = np.frombuffer(zlib.decompress(packed, bufsize=8 * size), np.uint8)
                    numbers = shuffled.reshape(8, size).T.copy().view("<i8").ravel()
                except (zlib.error, ValueError):
                    return None
                numbers = numbers[: dataset.shape[0] - first]
                if (numbers != numbers[0]).any():
                    made.append((first, numbers))
                    only = None
                    continue
                found = int(numbers[0])
                if numbers.size == size and len(known) < _MOST_KNOWN:
                    known[packed] = found
            if found != only:
                made.append((first, found))
                only = found
    return made


def _chunks(dataset: h5py.Dataset) -> list[tuple[int, int, int]] | None:
    """Find the chunks of a dataset: index of the first number, and place and length in the file."""
    if dataset.dtype != np.dtype("<i8") or not dataset.chunks or dataset.file.userblock_size:
        return None
    settings = dataset.id.get_create_plist()
    filters = [settings.get_filter(n)[0] for n in range(settings.get_nfilters())]
    if len(filters) != len(_PLAIN) or set(filters) != _PLAIN:
        return None
    found: list[tuple[int, int, int]] = []
    plain = True

    def take(chunk: Any) -> None:
        nonlocal plain
        plain &= chunk.filter_mask == 0
        found.append((int(chunk.chunk_offset[0]), int(chunk.byte_offset), int(chunk.size)))

    try:
        dataset.id.chunk_iter(take)
    except (AttributeError, OSError, RuntimeError):  # an old HDF5 does not tell
        return None
    found.sort()
    whole = [first for first, *_ in found] == list(range(0, dataset.shape[0], dataset.chunks[0]))
    return found if plain and whole else None
