"""Garbage at the decoder: nothing is taken for a message that was not sent."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tests.benchmarks.timing import Result
from tests.conftest import SEED
from vbraille.devices.serial.wire import Decoder, Frame, Hello, Rest, State, Watchdog, encode

if TYPE_CHECKING:
    from collections.abc import Iterator

TOTAL_BYTES = 100_000_000
CHUNK_BYTES = 1 << 20


def run() -> Iterator[Result]:
    random = np.random.default_rng(SEED)
    messages = sent(random)
    ours = {encode(message) for message in messages}
    line = np.frombuffer(b"".join(encode(message) for message in messages), np.uint8)
    decoder = Decoder()
    fed = taken = 0
    strange = 0
    makers = (noise, flipped, cut, spliced)
    while fed < TOTAL_BYTES:
        chunk = makers[fed // CHUNK_BYTES % len(makers)](random, line)
        fed += len(chunk)
        for event in decoder.feed(chunk):
            taken += 1
            strange += encode(event) not in ours
    dropped = sum(decoder.dropped.values())
    yield Result(
        "bytes of noise, flipped bits, truncations and splices fed to the decoder",
        "≥ 10⁸, no exception, no frame that was not sent",
        f"{fed:.2g} bytes, {dropped} frames dropped, {taken} whole ones taken, {strange} not sent",
        fed >= TOTAL_BYTES and not strange,
    )


def sent(random: np.random.Generator) -> list:
    """Messages of many kinds."""
    messages = [Hello(), Rest(), Watchdog(1, 2)]
    for number in range(2000):
        messages.append(Frame(number, random.bytes(75)))
        values = random.integers(0, 1 << 16, 4).tolist()
        messages.append(State(number, values[0] << 8, values[1], values[2], 1, 0, None, 0, 0, 0))
    return messages


def noise(random: np.random.Generator, _line: np.ndarray) -> bytes:
    return random.bytes(CHUNK_BYTES)


def flipped(random: np.random.Generator, line: np.ndarray) -> bytes:
    """A bit in some hundred."""
    chunk = np.resize(line, CHUNK_BYTES).copy()
    at = random.integers(0, chunk.size, chunk.size // 20)
    chunk[at] ^= (1 << random.integers(0, 8, at.size)).astype(np.uint8)
    return chunk.tobytes()


def cut(random: np.random.Generator, line: np.ndarray) -> bytes:
    """Bytes are missing."""
    chunk = np.resize(line, CHUNK_BYTES)
    return chunk[random.random(chunk.size) > 0.02].tobytes()


def spliced(random: np.random.Generator, line: np.ndarray) -> bytes:
    """Pieces from anywhere, one behind the other."""
    starts = random.integers(0, line.size - 200, CHUNK_BYTES // 100).tolist()
    lengths = random.integers(1, 200, len(starts)).tolist()
    pieces = (line[start : start + length] for start, length in zip(starts, lengths, strict=True))
    return b"".join(piece.tobytes() for piece in pieces)
