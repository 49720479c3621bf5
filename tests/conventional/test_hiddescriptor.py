"""Report descriptors: bytes to fields of reports."""

from hypothesis import given
from hypothesis import strategies as st

from tests.conventional.hiddescriptors import MOUSE, NUMBERED, STANDARD
from vbraille.conventional.hiddescriptor import HidKind, parse_descriptor


def test_a_mouse():
    reports = parse_descriptor(MOUSE)
    assert not reports.numbered
    assert reports.bits == {(HidKind.INPUT, 0): 24}
    buttons, moves = reports.fields
    assert (buttons.bit, buttons.size, buttons.count, buttons.variable) == (0, 1, 3, True)
    assert buttons.usages == (0x90001, 0x90002, 0x90003)
    assert (moves.bit, moves.usages) == (8, (0x10030, 0x10031))
    assert (moves.lowest, moves.highest) == (-127, 127)
    assert [within.usage for within in moves.collections] == [0x10002, 0x10001]


def test_reports_have_the_lengths_that_the_descriptor_gives_them():
    assert parse_descriptor(STANDARD).bits == {(HidKind.INPUT, 0): 56, (HidKind.OUTPUT, 0): 160}
    assert parse_descriptor(NUMBERED).bits == {
        (HidKind.INPUT, 9): 8,
        (HidKind.INPUT, 1): 16,
        (HidKind.INPUT, 2): 40,
        (HidKind.OUTPUT, 3): 320,
    }


def test_what_is_pushed_comes_back_and_long_items_are_passed_over():
    reports = parse_descriptor(
        bytes.fromhex("0541 7508 9501 a4 0509 7501 b4 fe0203aabb 0903 9102 b4 c0 0904 9102")
    )
    assert [(f.usages, f.size, f.bit) for f in reports.fields] == [
        ((0x410003,), 8, 0),
        ((0x410004,), 8, 8),
    ]


@given(st.binary(max_size=60))
def test_no_bytes_are_too_strange(noise):
    for field in parse_descriptor(noise).fields:
        assert len(field.usages) <= 5000
