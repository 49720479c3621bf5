"""Lines of a Dot Pad: cells to pins, and which is sent when."""

from vbraille.conventional.dotpadlines import (
    PATIENCE_S,
    RETRY_S,
    DotPadLines,
    graphic_lines,
    graphic_size,
    text_lines,
)
from vbraille.conventional.dotpadpackets import (
    DotPadArea,
    DotPadCommand,
    DotPadPacket,
    decode_packets,
)

TEXT = DotPadArea(0, 1, 4, 0.1)
PINS = DotPadArea(1, 10, 30, 0.3)
TAKEN = DotPadPacket(DotPadCommand.LINE_TAKEN, b"\0")
REFUSED = DotPadPacket(DotPadCommand.LINE_TAKEN, b"\1")
STANDS = DotPadPacket(DotPadCommand.LINE_STANDS, b"\0")


def raised(lines, height=4):
    """Places (x, y) of the pins that are up, with y from the first line's top."""
    return {
        (2 * column + bit // 4, (at - min(lines)) * height + bit % 4)
        for at, pins in lines.items()
        for column, byte in enumerate(pins)
        for bit in range(8)
        if byte >> bit & 1
    }


def sent(lines, now_s):
    """The line that is sent now: its destination and pins."""
    found, _ = decode_packets(lines.send(now_s))
    return [(p.destination, p.content[1:]) for p in found]


def test_dots_of_a_line_of_text_are_the_pins_of_its_columns():
    # Dots 1 to 8, and the pin of each from the top of its column.
    places = [(0, 0), (0, 1), (0, 2), (1, 0), (1, 1), (1, 2), (0, 3), (1, 3)]
    for dot, place in enumerate(places):
        assert raised(text_lines(bytes([1 << dot]), TEXT)) == {place}
    assert text_lines(b"\x01\x08\x40\x80\xff", TEXT) == {0: b"\x01\x10\x08\x80"}


def test_cells_in_the_area_of_pins_stand_a_pin_apart():
    assert graphic_size(PINS, 4) == (8, 20)
    assert list(graphic_lines(b"", PINS, 4)) == list(range(1, 11))
    cells = bytearray(160)
    cells[1], cells[20], cells[159] = 0xFF, 0x01, 0x80
    up = raised(graphic_lines(bytes(cells), PINS, 4))
    assert up == {(x, y) for x in (3, 4) for y in range(4)} | {(0, 5), (58, 38)}


def test_lines_of_three_pins_show_the_same():
    area = DotPadArea(1, 4, 5, 0.1)
    assert graphic_size(area, 3) == (2, 3)
    up = raised(graphic_lines(b"\xff\x00\x00\x01", area, 3), 3)
    assert up == {(x, y) for x in (0, 1) for y in range(4)} | {(0, 5)}


def test_one_line_goes_after_the_other_and_only_what_changed():
    lines = DotPadLines(0.1)
    lines.want({1: b"a", 2: b"b"})
    assert sent(lines, 0) == [(1, b"a")]
    assert sent(lines, 0) == []
    lines.take(TAKEN, 0)
    assert sent(lines, 0) == []
    lines.want({1: b"c"})  # wanted while another is on its way
    lines.take(STANDS, 0)
    assert sent(lines, 0) == [(1, b"c")]
    lines.take(STANDS, 0)
    assert sent(lines, 0) == [(2, b"b")]
    assert not lines.settled
    lines.take(STANDS, 0)
    assert lines.settled
    assert sent(lines, 0) == []


def test_silence_and_what_was_only_taken():
    lines, late_s = DotPadLines(0.1), 0.11 + PATIENCE_S
    lines.want({1: b"a", 2: b"b"})
    lines.send(0)
    assert not lines.silent(PATIENCE_S)
    assert lines.silent(late_s)
    lines.take(TAKEN, 0)
    assert not lines.silent(late_s)
    assert sent(lines, late_s) == [(2, b"b")]


def test_what_is_refused_is_sent_again_but_not_for_ever():
    lines = DotPadLines(0.1)
    lines.want({1: b"a"})
    lines.send(0)
    lines.take(REFUSED, 0)
    assert sent(lines, 0) == []
    for number in range(1, 4):
        assert not lines.refused
        assert sent(lines, number * RETRY_S) == [(1, b"a")]
        lines.take(REFUSED, number * RETRY_S)
    assert lines.refused
