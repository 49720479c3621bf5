"""The compiled bytes against the codec in Python, zlib's CRC and the cobs package."""

import random
import zlib

import numpy as np
import pytest
from cobs import cobs
from hypothesis import assume, given
from hypothesis import strategies as st

from vbraille.devices.serial import kernels
from vbraille.devices.serial.wire import (
    CRC_BYTES,
    Decoder,
    Drop,
    Error,
    Frame,
    State,
    encode,
    fields_of,
    frame_head,
    line_bytes,
    places_of,
)
from vbraille.devices.serial.wire import enframe as enframe_in_python

GUARD = 16
LENGTHS = range(601)
# Long runs without a zero are where encoders go wrong, and zeros in a row.
pieces = st.one_of(
    st.binary(max_size=300),
    st.integers(250, 260).map(lambda n: b"\x11" * n),
    st.integers(1, 20).map(bytes),
)
bodies = st.lists(pieces, max_size=4).map(b"".join)


def some_bytes(length):
    """Bytes of each kind that COBS treats differently, of a length."""
    draw = random.Random(length)
    yield bytes(length)
    yield b"\xff" * length
    yield draw.randbytes(length)
    yield bytes(draw.choice((0, 1, 0xFF)) for _ in range(length))
    yield (b"\x01" * 254 + b"\x00")[draw.randrange(255) :] * 4
    yield (b"\x01" * 254)[:length] + bytes(max(length - 254, 0))


class Guarded:
    """An array between bytes that may not be touched; ``fill`` is what stands there."""

    def __init__(self, size, fill=0xA5, given=b""):
        self._all = np.full(size + 2 * GUARD, fill, np.uint8)
        self._fill = fill
        self.array = self._all[GUARD : GUARD + size]
        self.array[: len(given)] = np.frombuffer(given, np.uint8)

    def check(self):
        assert (self._all[:GUARD] == self._fill).all()
        assert (self._all[self._all.size - GUARD :] == self._fill).all()


def between(given, fill):
    return Guarded(len(given), fill, given).array


def encoded(given, room=None, fill=0xA5):
    out = Guarded(cobs.max_encoded_length(len(given)) if room is None else room)
    end = kernels.cobs_encode(between(given, fill), 0, len(given), out.array, 0)
    out.check()
    return end if end < 0 else out.array[:end].tobytes()


def decoded(given, room=None, fill=0xA5):
    out = Guarded(len(given) if room is None else room)
    size = kernels.cobs_decode(between(given, fill), 0, len(given), out.array)
    out.check()
    return size if size < 0 else out.array[:size].tobytes()


def decoded_in_python(given):
    try:
        return cobs.decode(given)
    except cobs.DecodeError:
        return kernels.BAD_COBS


@pytest.mark.parametrize("first", range(0, 601, 50))
def test_each_length_is_encoded_and_decoded_as_in_python(first):
    for length in range(first, min(first + 50, len(LENGTHS))):
        for plain in some_bytes(length):
            stuffed = encoded(plain)
            assert stuffed == cobs.encode(plain)
            assert decoded(stuffed) == plain
            assert kernels.crc32(between(plain, 1), 0, len(plain)) == zlib.crc32(plain)


@given(bodies)
def test_any_bytes_are_encoded_and_decoded_as_in_python(given):
    assert encoded(given) == cobs.encode(given)
    assert decoded(cobs.encode(given)) == given


@given(st.one_of(st.binary(max_size=40), bodies), st.integers(0, 255))
def test_garbage_is_refused_where_python_refuses_it(garbage, neighbour):
    assert decoded(garbage, fill=neighbour) == decoded_in_python(garbage)


@given(st.binary(min_size=1, max_size=300), st.data())
def test_what_has_no_room_is_not_written_past_it(given, data):
    room = data.draw(st.integers(0, cobs.max_encoded_length(len(given)) - 1))
    assert encoded(given, room) == kernels.TOO_SMALL
    stuffed = cobs.encode(given)
    assert decoded(stuffed, data.draw(st.integers(0, len(stuffed) - 1))) == kernels.TOO_SMALL


@given(st.binary(max_size=200), st.data())
def test_a_part_of_an_array_is_all_that_is_looked_at(given, data):
    start = data.draw(st.integers(0, len(given)))
    end = data.draw(st.integers(start, len(given)))
    source = np.frombuffer(given, np.uint8)
    assert kernels.crc32(source, start, end) == zlib.crc32(given[start:end])
    found = given.find(0, start, end)
    assert kernels.delimiter(source, start, end) == (end if found < 0 else found)
    out = Guarded(end - start)
    size = kernels.cobs_decode(source, start, end, out.array)
    out.check()
    want = decoded_in_python(given[start:end])
    assert (size if size < 0 else out.array[:size].tobytes()) == want


@given(st.one_of(st.just(b""), st.binary(max_size=60), bodies), st.integers(0, 7))
def test_a_body_is_framed_as_in_python_and_comes_back(given, at):
    body = Guarded(len(given) + CRC_BYTES, given=given)
    out = Guarded(at + line_bytes(len(given)))
    end = kernels.enframe(body.array, len(given), out.array, at)
    body.check()
    out.check()
    line = out.array[at:end].tobytes()
    assert line == enframe_in_python(given)
    back = Guarded(len(line) - 1)
    size = kernels.unframe(out.array, at, end - 1, back.array)
    back.check()
    if given:
        assert back.array[:size].tobytes() == given
    else:
        assert size == kernels.BAD_CRC  # a frame without even a type


@given(st.binary(max_size=60), st.integers(0, 80), st.integers(0, 80))
def test_a_frame_without_room_is_not_written_past_it(given, body_room, out_room):
    body = Guarded(max(body_room, len(given)), given=given)
    out = Guarded(out_room)
    end = kernels.enframe(body.array, len(given), out.array, 0)
    body.check()
    out.check()
    has_room = body.array.size >= len(given) + CRC_BYTES and out_room >= line_bytes(len(given))
    assert (end > 0) == has_room


@given(st.binary(min_size=1, max_size=120), st.integers(0, 0xFFFF))
def test_a_frame_of_levels_is_that_of_the_codec(packed, sequence):
    head = frame_head(0)  # its type and the sequence
    body = np.frombuffer(head + packed + bytes(CRC_BYTES), np.uint8).copy()
    kernels.put_number(body, 1, len(head) - 1, sequence)
    out = np.zeros(line_bytes(body.size - CRC_BYTES), np.uint8)
    end = kernels.enframe(body, body.size - CRC_BYTES, out, 0)
    assert out[:end].tobytes() == encode(Frame(sequence, packed))


@given(st.binary(min_size=1, max_size=40), st.integers(0, 40), st.integers(1, 255))
def test_a_changed_byte_is_dropped_for_the_reason_that_the_decoder_gives(given, where, change):
    line = bytearray(enframe_in_python(given)[:-1])
    line[where % len(line)] ^= change
    assume(0 not in line)  # which would be two frames
    decoder = Decoder()
    decoder.feed(bytes(line) + b"\0")
    body = Guarded(len(line))
    size = kernels.unframe(np.frombuffer(bytes(line), np.uint8), 0, len(line), body.array)
    body.check()
    reason = {kernels.BAD_COBS: Drop.BAD_COBS, kernels.BAD_CRC: Drop.BAD_CRC}[size]
    assert decoder.dropped[reason] == 1


states = st.builds(
    State,
    sequence=st.integers(0, 0xFFFF),
    time_us=st.integers(0, 0xFFFF_FFFF),
    count=st.integers(0, 0xFFFF_FFFF),
    frame_sequence=st.integers(0, 0xFFFF),
    flags=st.integers(0, 0xFF),
    buttons=st.integers(0, 0xFF),
    force_mn=st.one_of(st.none(), st.integers(-0x7FFF, 0x7FFF)),
    **dict.fromkeys(("y_count", "theta_count", "knobs"), st.integers(0, 0xFFFF_FFFF)),
)


@given(states)
def test_the_numbers_of_a_message_are_read_and_written_where_the_table_says(state):
    body = cobs.decode(encode(state)[:-1])[:-CRC_BYTES]
    source = np.frombuffer(body, np.uint8)
    numbers = [kernels.number(source, *place) for place in places_of(State)]
    want = [getattr(state, name) for name, _ in fields_of(State)]
    want = [-0x8000 if value is None else value for value in want]
    assert numbers == want
    written = source.copy()
    written[1:] = 0xA5
    for (at, width, _), value in zip(places_of(State), numbers, strict=True):
        kernels.put_number(written, at, width, value)
    assert written.tobytes() == body


def test_places_end_where_the_width_is_not_fixed():
    assert places_of(Frame) == ((1, 2, False),)
    assert places_of(Error) == ((1, 1, False),)
