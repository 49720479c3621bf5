"""Bytes of a Dot Pad."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.conventional.dotpad import BOARD, TEXT_ONLY, packet
from vbraille.conventional.dotpadpackets import (
    DotPadArea,
    DotPadBoard,
    DotPadCommand,
    DotPadPacket,
    board_of,
    decode_packets,
    encode_packet,
    keys_down,
    keys_named,
)
from vbraille.conventional.messages import KeyPressed

LINE = DotPadPacket(DotPadCommand.SHOW_LINE, bytes((0, 0x01, 0xFF)), 3)
LINE_BYTES = bytes.fromhex("aa55 0008 03 0200 00 0001ff 5a")

packets = st.builds(
    DotPadPacket, st.integers(0, 0xFFFF), st.binary(max_size=90), st.integers(0, 255)
)


def test_a_line_is_these_bytes():
    # A5 ^ 03 ^ 02 ^ 00 ^ 00 ^ 00 ^ 01 ^ FF = 5A
    assert encode_packet(LINE) == LINE_BYTES
    assert decode_packets(LINE_BYTES) == ([LINE], b"")


@given(st.lists(packets, max_size=4), st.binary(max_size=20), st.data())
def test_packets_come_out_as_they_went_in_however_they_are_cut(sent, noise, draw):
    noise = noise.replace(b"\xaa", b"\x00")
    line = noise + b"".join(map(encode_packet, sent))
    cut = draw.draw(st.integers(0, len(line)))
    first, rest = decode_packets(line[:cut])
    second, left = decode_packets(rest + line[cut:])
    assert (first + second, left) == (sent, b"")


def test_what_is_corrupt_is_passed_over_and_the_next_is_taken():
    for place in range(2, len(LINE_BYTES)):
        corrupt = bytearray(LINE_BYTES)
        corrupt[place] ^= 0x10
        found, _ = decode_packets(bytes(corrupt) + LINE_BYTES * 40)
        assert found
        assert set(found) == {LINE}


def test_a_length_that_no_packet_has_is_not_waited_for():
    assert decode_packets(b"\xaa\x55\xff\xff" + LINE_BYTES)[0] == [LINE]
    assert decode_packets(b"\xaa\x55\x00\x01" + LINE_BYTES)[0] == [LINE]


def test_what_a_board_says():
    assert board_of(BOARD) == DotPadBoard(DotPadArea(0, 1, 20, 0.1), DotPadArea(1, 10, 30, 0.3), 4)
    assert board_of(TEXT_ONLY) == DotPadBoard(DotPadArea(0, 1, 20, 0.1), None, 4)
    assert board_of(bytes(12)) is None
    assert board_of(BOARD[:11]) is None


@pytest.mark.parametrize(
    ("command", "down", "named"),
    [
        (DotPadCommand.PERKINS_KEYS, "00040000", [KeyPressed("FWINLT")]),
        (DotPadCommand.PERKINS_KEYS, "00020000", [KeyPressed("FWINRT")]),
        (DotPadCommand.PERKINS_KEYS, "00005000", [KeyPressed("LNUP"), KeyPressed("LNDN")]),
        (DotPadCommand.PERKINS_KEYS, "10000000", []),  # dot 1 of its keyboard
        (DotPadCommand.ROUTING_KEYS, "0000100000000000", [KeyPressed("ROUTE", 19)]),
        (DotPadCommand.FUNCTION_KEYS, "50000000", [KeyPressed("F2"), KeyPressed("LNDN")]),
        (DotPadCommand.SCROLL_KEYS, "00000008", [KeyPressed("FWINRT")]),
    ],
)
def test_keys(command, down, named):
    (told,), _ = decode_packets(packet(command, bytes.fromhex(down)))
    assert list(keys_named(told.command, keys_down(told.content))) == named
