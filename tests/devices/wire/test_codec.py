"""The protocol from both ends: what is sent arrives, and nothing else does."""

import tracemalloc
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Annotated

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.devices.wire.samples import (
    CODES,
    EVERY_MESSAGE,
    INFO,
    SAMPLES,
    STATE,
    body_of,
    messages_of,
)
from tests.tiers import examples
from vbraille.devices.serial.wire import (
    DELIMITER,
    FAULTY,
    MOST_FRAME_BYTES,
    RESTING,
    U16,
    BodyCodec,
    Decoder,
    Drop,
    Error,
    Frame,
    Hello,
    Message,
    Number,
    OtherVersion,
    ShortText,
    State,
    WrongLengthError,
    encode,
    enframe,
    line_bytes,
)

any_message = st.sampled_from(list(CODES)).flatmap(messages_of)
# Zeros, length bytes and types come often, so that garbage gets as far as it can.
garbage = st.binary(max_size=60) | st.lists(
    st.sampled_from([0, 0, 1, 2, 3, 0x81, 0x85, 0xFF]), max_size=60
).map(bytes)


def fed(stream):
    decoder = Decoder()
    return decoder.feed(stream), decoder.dropped


def only(kind, times=1):
    return dict.fromkeys(Drop, 0) | {kind: times}


# There and back


@EVERY_MESSAGE
@examples(50)  # of each of seven messages
@given(choice=st.data())
def test_what_is_encoded_is_decoded(kind, choice):
    message = choice.draw(messages_of(kind))
    line = encode(message)
    assert line.index(DELIMITER) == len(line) - 1
    assert len(line) <= line_bytes(len(body_of(message)))
    assert fed(line) == ([message], dict.fromkeys(Drop, 0))


def test_messages_are_frozen():
    with pytest.raises(AttributeError):
        STATE.count = 5


def test_flags_of_a_state():
    assert [s.placed for s in (STATE, replace(STATE, flags=0))] == [True, False]
    assert [s.resting for s in (STATE, replace(STATE, flags=RESTING))] == [False, True]
    assert [s.faulty for s in (STATE, replace(STATE, flags=FAULTY))] == [False, True]


def test_the_largest_messages_fit():
    actuators = 16 * 64
    largest = replace(
        INFO,
        rows=16,
        columns=64,
        name="n" * 255,
        firmware="f" * 255,
        inverted=bytes(actuators),
        gain=b"\xff" * actuators,
        enabled=bytes(actuators),
    )
    for message in (largest, Frame(0, b"\xff" * 2048), Error(0, "e" * 255)):
        assert len(encode(message)) <= MOST_FRAME_BYTES
        assert fed(encode(message))[0] == [message]


# Any bytes, in any chunks


@given(
    pieces=st.lists(garbage | any_message.map(encode), max_size=6),
    cuts=st.lists(st.integers(0, 2000), max_size=10),
)
def test_chunks_make_no_difference(pieces, cuts):
    stream = b"".join(pieces)
    whole = fed(stream)
    for bounds in (range(len(stream) + 1), sorted({0, len(stream), *cuts})):
        decoder = Decoder()
        events = [e for a, b in pairwise(bounds) for e in decoder.feed(stream[a:b])]
        assert (events, decoder.dropped) == whole


@pytest.mark.parametrize("sort", [bytes, bytearray, memoryview])
def test_any_bytes_like_chunk(sort):
    assert fed(sort(encode(STATE)))[0] == [STATE]


@st.composite
def damage(draw, stream):
    """A stream after flips, cuts, repeats and garbage."""
    stream = bytearray(stream)
    for _ in range(draw(st.integers(1, 6))):
        a, b = sorted(draw(st.tuples(*[st.integers(0, len(stream))] * 2)))
        match draw(st.sampled_from(["flip", "cut", "repeat", "insert"])):
            case "flip" if a < len(stream):
                stream[a] ^= 1 << draw(st.integers(0, 7))
            case "cut":
                del stream[a:b]
            case "repeat":
                stream[draw(st.integers(0, len(stream))) :] = stream[a:b]
            case "insert":
                stream[a:a] = draw(garbage)
    return bytes(stream)


@given(sent=st.lists(any_message, min_size=1, max_size=4), choice=st.data())
def test_nothing_is_accepted_that_was_not_sent(sent, choice):
    stream = choice.draw(damage(b"".join(map(encode, sent))))
    assert all(event in sent for event in fed(stream)[0])


def test_random_bytes_come_to_nothing(rng):
    decoder = Decoder()
    for _ in range(50):
        assert decoder.feed(rng.bytes(4096)) == []
    assert decoder.dropped[Drop.BAD_CRC] + decoder.dropped[Drop.BAD_COBS] > 500


@given(noise=garbage, first=any_message, second=any_message)
def test_in_step_again_within_a_frame(noise, first, second):
    events = fed(noise + encode(first) + encode(second))[0]
    assert events[-1] == second
    events = fed(noise + DELIMITER + encode(first) + encode(second))[0]
    assert events[-2:] == [first, second]


@pytest.mark.parametrize("chunk", [1, 64, 5000, 100_000])
def test_a_stream_without_an_end_is_one_drop_and_little_memory(chunk):
    decoder = Decoder()
    noise = b"\x55" * chunk
    tracemalloc.start()
    try:
        for _ in range(1 + 5 * MOST_FRAME_BYTES // chunk):
            assert decoder.feed(noise) == []
        held, _ = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert held < 3 * MOST_FRAME_BYTES
    assert decoder.dropped == only(Drop.TOO_LONG)
    assert decoder.feed(DELIMITER + encode(STATE)) == [STATE]


def test_the_longest_frame_is_not_too_long():
    for surplus, kind in ((0, Drop.BAD_COBS), (1, Drop.TOO_LONG)):
        noise = b"\xfe" * (MOST_FRAME_BYTES + surplus) + DELIMITER
        assert fed(noise) == ([], only(kind))


def test_empty_frames_mean_nothing():
    assert fed(DELIMITER * 5) == ([], dict.fromkeys(Drop, 0))


# What is dropped is counted by kind

BEHIND = body_of(INFO).index(INFO.enabled) + len(INFO.enabled)


def changed(message, at, byte):
    body = bytearray(body_of(message))
    body[at] = byte
    return enframe(bytes(body))


@pytest.mark.parametrize(
    ("line", "kind"),
    [
        (b"\x05ab\x00", Drop.BAD_COBS),
        (b"\x01\x00", Drop.BAD_CRC),
        (b"\x03ab\x00", Drop.BAD_CRC),
        (enframe(b""), Drop.BAD_CRC),
        (encode(STATE)[:-3] + b"\x77\x77\x00", Drop.BAD_CRC),
        (enframe(b"\x7f later"), Drop.UNKNOWN_TYPE),
        (enframe(body_of(STATE)[:-1]), Drop.WRONG_LENGTH),
        (enframe(b"\x02\x00\x00"), Drop.WRONG_LENGTH),
        (enframe(b"\x02\x00\x00" + bytes(2049)), Drop.WRONG_LENGTH),
        (changed(Hello(), 1, 0), Drop.OUT_OF_RANGE),
        (changed(INFO, 2, 0), Drop.OUT_OF_RANGE),  # no rows, and so no actuators
        (changed(INFO, 23, 3), Drop.OUT_OF_RANGE),  # an encoder of no known kind
        (changed(INFO, 28, 0), Drop.OUT_OF_RANGE),  # a sign that is none
        (changed(INFO, BEHIND - 1, 2), Drop.OUT_OF_RANGE),
        (changed(INFO, BEHIND, 9), Drop.OUT_OF_RANGE),  # buttons
        (changed(INFO, BEHIND + 1, 5), Drop.OUT_OF_RANGE),  # knobs
    ],
)
def test_drops_by_kind(line, kind):
    assert fed(line + encode(STATE)) == ([STATE], only(kind))


@EVERY_MESSAGE
def test_a_body_too_short_is_dropped_wherever_it_ends(kind):
    message = next(m for m in SAMPLES if type(m) is kind)
    body = body_of(message)
    assert fed(enframe(body))[0] == [message]
    # A FRAME has as many levels as it has; the device knows how many it expects.
    for end in range(1, 4 if kind is Frame else len(body)):
        assert fed(enframe(body[:end])) == ([], only(Drop.WRONG_LENGTH))


def test_text_that_a_terminal_should_not_see_is_replaced():
    body = bytearray(body_of(Error(1, "aXbYc")))
    body[4], body[6] = 0x1B, 0xE9  # escape, and é in Latin-1
    assert fed(enframe(bytes(body)))[0] == [Error(1, "a\ufffdb\ufffdc")]


# Other versions


@EVERY_MESSAGE
@given(appended=st.binary(min_size=1, max_size=40))
def test_what_a_later_version_appends_is_left_alone(kind, appended):
    message = next(m for m in SAMPLES if type(m) is kind)
    events, dropped = fed(enframe(body_of(message) + appended))
    if kind is not Frame:  # whose levels go on to its end
        assert (events, dropped) == ([message], dict.fromkeys(Drop, 0))


@pytest.mark.parametrize("rest", [b"", b"all that is different"])
def test_another_version_is_told_and_not_guessed_at(rest):
    assert fed(enframe(b"\x81\x03" + rest))[0] == [OtherVersion(3)]
    assert fed(enframe(b"\x81\x01" + rest))[0] == [OtherVersion(1)]
    assert fed(encode(Hello(version=3)))[0] == [Hello(3)]


# One table, both ways


def test_a_new_field_is_encoded_decoded_and_checked():
    @dataclass(frozen=True, slots=True)
    class StateWithSkin(State):
        skin_ck: Annotated[int, Number("H", 0, 40_000, "cK")]
        mood: Annotated[str, ShortText(fewest=1)]
        pulse: Annotated[int | None, Number("H", 0, 300, none=0xFFFF)]

    codec = BodyCodec(0x85, StateWithSkin)
    state = StateWithSkin(1, 2, 3, 4, 0, 0, None, 5, 6, 7, skin_ck=30_500, mood="ö", pulse=None)
    body = codec.encode(state)
    assert body[:29] == body_of(State(1, 2, 3, 4, 0, 0, None, 5, 6, 7))
    assert body[29:] == b"\x24\x77" + b"\x02\xc3\xb6" + b"\xff\xff"
    assert codec.decode(body) == state
    assert fed(enframe(body))[0] == [State(1, 2, 3, 4, 0, 0, None, 5, 6, 7)]
    for end in range(len(body)):
        with pytest.raises(WrongLengthError):
            codec.decode(body[:end])
    with pytest.raises(ValueError, match="skin_ck is 40001; it must be 0 to 40000 cK"):
        replace(state, skin_ck=40_001)


def test_fields_follow_one_another_in_the_order_of_the_class():
    @dataclass(frozen=True, slots=True)
    class Pair(Message):
        first: Annotated[int, U16]
        second: Annotated[int, U16]

    assert BodyCodec(0x55, Pair).encode(Pair(first=1, second=2)) == b"\x55\x01\x00\x02\x00"
