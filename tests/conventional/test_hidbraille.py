"""Braille displays of HID: cells to reports, reports to keys."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.conventional.hiddescriptors import MOUSE, NUMBERED, PACKED, ROWS, STANDARD
from vbraille.conventional.hidbraille import braille_of
from vbraille.conventional.messages import KeyPressed


def down(descriptor, report):
    """The keys that a report, given in hexadecimal, says are down."""
    keys = braille_of(descriptor).keys_down(bytes.fromhex(report))[1]
    return sorted((key.name, key.argument) for key in keys)


def size(descriptor):
    braille = braille_of(descriptor)
    return len(braille.rows), braille.columns


def test_rows_and_columns():
    assert size(STANDARD) == (1, 20)
    assert size(NUMBERED) == (1, 40)
    assert size(ROWS) == (2, 3)  # the status is no row of them
    assert size(PACKED) == (1, 4)


@pytest.mark.parametrize("descriptor", [MOUSE, b"", STANDARD[:60], NUMBERED[:-40]])
def test_what_has_no_cells_is_no_braille_display(descriptor):
    assert braille_of(descriptor) is None


def test_cells_of_a_row():
    # Without numbers of reports a 0 stands before what is written.
    assert braille_of(STANDARD).packed(b"\x01\xff") == [bytes((0, 0x01, 0xFF)) + bytes(18)]
    assert braille_of(NUMBERED).packed(b"\x80" * 50) == [b"\x03" + b"\x80" * 40]


def test_cells_of_several_rows_are_a_report_each():
    assert braille_of(ROWS).packed(bytes((1, 2, 3, 4))) == [b"\1\1\2\3", b"\2\4\0\0"]


def test_cells_of_six_dots_in_six_bits():
    # A byte of something else, then 6 bits a cell, the lowest first; dots 7 and 8 are left out.
    bits = 0x3F | 0x01 << 6 | 0x20 << 12 | 0x15 << 18
    wanted = b"\0\0" + bits.to_bytes(3, "little")
    assert braille_of(PACKED).packed(b"\xff\x01\x20\x15") == [wanted]


def test_keys_of_the_sample_in_the_standard():
    assert down(STANDARD, "00000000000000") == []
    assert down(STANDARD, "ff830000000000") == []  # what types is left out, and what is constant
    assert down(STANDARD, "00040000000000") == [("HOME", 0)]
    assert down(STANDARD, "00780000000000") == [
        ("FWINLT", 0),
        ("FWINRT", 0),
        ("LNDN", 0),
        ("LNUP", 0),
    ]
    assert down(STANDARD, "00001108000000") == [("FACE_4", 0), ("LEFT_1", 0), ("RIGHT_2", 0)]
    assert down(STANDARD, "00000000010008") == [("ROUTE", 0), ("ROUTE", 19)]


def test_keys_in_reports_with_numbers():
    assert down(NUMBERED, "010001") == [("FWINLT", 0)]
    assert down(NUMBERED, "01000a") == [("FWINRT", 0), ("LNDN", 0)]
    assert down(NUMBERED, "020000000080") == [("ROUTE", 39)]
    assert down(NUMBERED, "09ff") == []  # the letters' keyboard
    assert down(NUMBERED, "0200") == []  # cut off
    assert down(NUMBERED, "") == []


def test_routing_keys_of_each_row_go_on_where_those_above_end():
    assert down(ROWS, "0104") == [("ROUTE", 2)]
    assert down(ROWS, "0205") == [("ROUTE", 3), ("ROUTE", 5)]


def test_routing_keys_that_are_told_by_number():
    assert down(PACKED, "00") == []
    assert down(PACKED, "01") == [("ROUTE", 0)]
    assert down(PACKED, "10") == [("ROUTE", 15)]
    assert down(PACKED, "11") == []


@given(st.sampled_from((STANDARD, NUMBERED, ROWS, PACKED)), st.binary(max_size=12))
def test_no_report_is_too_strange(descriptor, told):
    assert all(
        isinstance(key, KeyPressed) and key.argument < 160
        for key in braille_of(descriptor).keys_down(told)[1]
    )


@given(st.binary(max_size=30))
def test_no_descriptor_is_too_strange(noise):
    start = bytes.fromhex("0541 0901 a101 0902 a102 0903 7508 9503 9102")
    braille = braille_of(start + noise)
    if braille is not None:
        assert sum(map(len, braille.packed(b"\xff" * 2000))) < 20_000
        braille.keys_down(bytes(30))
