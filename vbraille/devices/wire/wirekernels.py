"""The serial protocol's bytes, compiled: what a tick does of `vbraille.devices.wire.codec`.

Nothing here allocates, waits or raises. Places in an array are given as its first index and
the one after its last. What is asked of bytes that cannot be true, or of an array that is too
small, is answered with a negative number, and never read or written past an array's end.
"""

import numpy as np
from numba import njit

from vbraille.caching import keep_compiled

BAD_COBS = -1
BAD_CRC = -2
TOO_SMALL = -3

_CRC_BYTES = 4
_POLYNOMIAL = 0xEDB88320
_LONGEST_RUN = 0xFE  # bytes that are not zero, in one block of COBS


def _slices():
    """CRC-32 of a byte with 0 to 3 zeros after it: four bytes are then looked up at once."""
    table = np.zeros((4, 256), np.int64)
    for byte in range(256):
        rest = byte
        for _ in range(8):
            rest = (rest >> 1) ^ (_POLYNOMIAL if rest & 1 else 0)
        table[0, byte] = rest
    for zeros in range(1, 4):
        before = table[zeros - 1]
        table[zeros] = (before >> 8) ^ table[0, before & 0xFF]
    return table.astype(np.uint32)  # 4 kB, for the nearest cache is the renderer's, too


_SLICES = _slices()


@njit(cache=keep_compiled(), error_model="numpy", nogil=True)
def crc32(source, start, end):
    """CRC-32 of ``source[start:end]``, the same as zlib's.

    Parameters
    ----------
    source : uint8[bytes]
        Bytes, with others around them.
    start, end : int64
        First index, and one past the last; both are in the array.

    Returns
    -------
    int64
        CRC from 0 to 2³² - 1.
    """
    rest = 0xFFFFFFFF
    at = start
    while at + 4 <= end:
        rest ^= (
            np.int64(source[at])
            | np.int64(source[at + 1]) << 8
            | np.int64(source[at + 2]) << 16
            | np.int64(source[at + 3]) << 24
        )
        rest = (
            np.int64(_SLICES[3, rest & 0xFF])
            ^ np.int64(_SLICES[2, (rest >> 8) & 0xFF])
            ^ np.int64(_SLICES[1, (rest >> 16) & 0xFF])
            ^ np.int64(_SLICES[0, rest >> 24])
        )
        at += 4
    while at < end:
        rest = (rest >> 8) ^ np.int64(_SLICES[0, (rest ^ np.int64(source[at])) & 0xFF])
        at += 1
    return rest ^ 0xFFFFFFFF


@njit(cache=keep_compiled(), error_model="numpy", nogil=True)
def cobs_encode(source, start, end, out, at):
    """Write COBS of ``source[start:end]``, beginning at ``out[at]``.

    Returns
    -------
    int64
        Index in ``out`` after the last byte written; TOO_SMALL, with nothing written, if the
        longest COBS of so many bytes would not fit.
    """
    size = end - start
    blocks = max(1, (size + _LONGEST_RUN - 1) // _LONGEST_RUN)
    if size < 0 or at < 0 or at + size + blocks > out.size:
        return TOO_SMALL
    head = at  # place of the block's length
    at += 1
    for place in range(start, end):
        byte = source[place]
        if byte != 0:
            out[at] = byte
            at += 1
            if at - head <= _LONGEST_RUN or place + 1 == end:
                continue
        out[head] = at - head
        head = at
        at += 1
    out[head] = at - head
    return at


@njit(cache=keep_compiled(), error_model="numpy", nogil=True)
def cobs_decode(source, start, end, out):
    """Decode the COBS in ``source[start:end]``, and write the result to the beginning of ``out``.

    Returns
    -------
    int64
        Number of bytes decoded; BAD_COBS if the source is no COBS, TOO_SMALL if ``out`` is smaller
        than the source. In both cases ``out`` is undefined.
    """
    if end - start > out.size:
        return TOO_SMALL
    written = 0
    at = start
    while at < end:
        length = np.int64(source[at])
        block_end = at + length
        if length == 0 or block_end > end:
            return BAD_COBS
        for place in range(at + 1, block_end):
            byte = source[place]
            if byte == 0:
                return BAD_COBS
            out[written] = byte
            written += 1
        at = block_end
        if at < end and length <= _LONGEST_RUN:
            out[written] = 0
            written += 1
    return written


@njit(cache=keep_compiled(), error_model="numpy", nogil=True)
def delimiter(source, start, end):
    """Index of the first zero in ``source[start:end]``; ``end`` if there is none."""
    at = start
    while at < end and source[at] != 0:
        at += 1
    return at


@njit(cache=keep_compiled(), error_model="numpy", nogil=True)
def unframe(source, start, end, body):
    """Write the body of the frame ``source[start:end]``, and its CRC, to the beginning of ``body``.

    Parameters
    ----------
    source : uint8[bytes]
        Bytes that were received.
    start, end : int64
        First index of a frame, and one past its last without the delimiter.
    body : uint8[bytes]
        Room for the body, at least as long as the frame.

    Returns
    -------
    int64
        Number of bytes in the body without its CRC, 1 or more; or BAD_COBS, BAD_CRC, TOO_SMALL.
    """
    size = cobs_decode(source, start, end, body)
    if size < 0:
        return size
    size -= _CRC_BYTES
    if size < 1:
        return BAD_CRC
    if crc32(body, 0, size) != number(body, size, _CRC_BYTES, 0):
        return BAD_CRC
    return size


@njit(cache=keep_compiled(), error_model="numpy", nogil=True)
def enframe(body, size, out, at):
    """Write the frame of a body, with its delimiter, from ``out[at]`` on.

    Parameters
    ----------
    body : uint8[bytes]
        The body, and room for the four bytes of its CRC, which are written.
    size : int64
        Number of bytes in the body without its CRC.
    out : uint8[bytes]
        Room for `vbraille.devices.wire.codec.line_bytes` of the body, from ``at`` on.
    at : int64
        Index in ``out`` at which the frame begins.

    Returns
    -------
    int64
        Index in ``out`` after the delimiter; TOO_SMALL, with no frame written, if the body or
        ``out`` has no room.
    """
    if size < 0 or size + _CRC_BYTES > body.size:
        return TOO_SMALL
    put_number(body, size, _CRC_BYTES, crc32(body, 0, size))
    # The last byte of `out` is kept for the delimiter.
    at = cobs_encode(body, 0, size + _CRC_BYTES, out[: out.size - 1], at)
    if at < 0:
        return TOO_SMALL
    out[at] = 0
    return at + 1


@njit(cache=keep_compiled(), error_model="numpy", nogil=True)
def number(source, at, width, signed):
    """Integer of ``width`` bytes from ``source[at]`` on, least significant first, as int64.

    `vbraille.devices.wire.fields.places_of` gives the arguments for a message's numbers.
    """
    value = 0
    for place in range(width):
        value |= np.int64(source[at + place]) << (8 * place)
    if signed and value >= 1 << (8 * width - 1):
        value -= 1 << (8 * width)
    return value


@njit(cache=keep_compiled(), error_model="numpy", nogil=True)
def put_number(out, at, width, value):
    """Write an integer's ``width`` bytes from ``out[at]`` on, least significant first."""
    for place in range(width):
        out[at + place] = (value >> (8 * place)) & 0xFF
