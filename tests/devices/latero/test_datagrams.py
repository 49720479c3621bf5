"""The Latero's datagrams, against bytes that were written by hand from its table."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from vbraille.devices.latero.wire import (
    FULL,
    FULLR0,
    FULLR1,
    RAW,
    Answer,
    Foreign,
    LateroRequest,
    RawAnswer,
    full_request,
    number,
    pack_answer,
    pack_raw_answer,
    parse_answer,
    parse_request,
    raw_request,
)

U16, U32 = st.integers(0, 0xFFFF), st.integers(0, 0xFFFF_FFFF)
ANSWER = Answer(0x1234, 0x0060, 0x0104, 0x0100, (1, 2, 0xFFFFFFFE, 4), (5, 6, 7, 8))
ANSWERED = bytes.fromhex(
    "ca1181 1234 0060 0104 0100 00000001 00000002 fffffffe 00000004 0005 0006 0007 0008"
)


def test_a_full_at_rest_is_as_the_table_has_it():
    request = full_request()
    number(request, 0xABCD)
    assert request == bytes.fromhex("ca1101 abcd 1000" + 4 * "0000" + 64 * "96" + 21 * "ff")
    assert len(request) == 100


def test_a_raw_is_as_the_table_has_it():
    request = raw_request(0x12, 0x0034, 0x5678)
    assert request == bytes.fromhex("ca1103 0000 12 0034 5678" + 90 * "ff")


@pytest.mark.parametrize("kind", [FULLR0, FULLR1])
def test_both_kinds_of_answers_are_known(kind):
    datagram = ANSWERED[:2] + bytes((kind,)) + ANSWERED[3:]
    assert len(datagram) == 35
    assert parse_answer(datagram) == ANSWER
    assert pack_answer(ANSWER, kind) == datagram


def test_an_answer_to_raw_is_as_the_table_has_it():
    datagram = bytes.fromhex("ca1183 0102 11 0018 00ff")
    assert parse_answer(datagram) == RawAnswer(0x0102, 0x11, 0x18, 0xFF)
    assert pack_raw_answer(RawAnswer(0x0102, 0x11, 0x18, 0xFF)) == datagram


@pytest.mark.parametrize(
    ("datagram", "what"),
    [
        (b"", Foreign.OTHER),
        (b"hello", Foreign.OTHER),
        (ANSWERED[:-1], Foreign.OTHER),
        (ANSWERED + b"\0", Foreign.OTHER),
        (b"\xcb" + ANSWERED[1:], Foreign.OTHER),
        (ANSWERED[:2] + b"\x01" + ANSWERED[3:], Foreign.OTHER),
        (ANSWERED[:2] + b"\x83" + ANSWERED[3:], Foreign.OTHER),
        (bytes(full_request()), Foreign.OTHER),
        (ANSWERED[:1] + b"\x12" + ANSWERED[2:], Foreign.VERSION),
        (ANSWERED[:1] + b"\x21" + ANSWERED[2:] + b"more", Foreign.VERSION),
    ],
)
def test_what_is_no_answer(datagram, what):
    assert parse_answer(datagram) is what


@given(st.binary(max_size=120))
def test_nothing_that_comes_is_too_odd(datagram):
    parse_answer(datagram)
    parse_request(datagram)


@given(U16, U16, st.tuples(U32, U32, U32, U32), st.tuples(U16, U16, U16, U16))
def test_an_answer_comes_back_as_it_was(sequence, word, encoders, adc):
    answer = Answer(sequence, word, word, word, encoders, adc)
    assert parse_answer(pack_answer(answer, FULLR0)) == answer


def test_a_request_is_read_as_it_was_written():
    request = full_request()
    number(request, 7)
    blades = bytes(range(64))
    request[15:79] = blades
    assert parse_request(bytes(request)) == LateroRequest(FULL, 7, blades)
    raw = parse_request(bytes(raw_request(0x21, 0x10, 3)))
    assert raw == LateroRequest(RAW, 0, command=0x21, address=0x10, data=3)
    assert parse_request(bytes(request[:99])) is None
    assert parse_request(b"\xca\x12" + bytes(request[2:])) is None
    assert parse_request(bytes(request[:2]) + b"\x04" + bytes(request[3:])) is None
