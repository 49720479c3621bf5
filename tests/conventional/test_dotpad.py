"""A Dot Pad at a pseudo-terminal, by the display as a program has it."""

import os
import pty
import threading
import tty

import pytest

from tests.conventional.dotpad import (
    FUNCTION,
    PAN_RIGHT,
    PERKINS,
    ROUTING,
    TEXT_ONLY,
    SimulatedDotPad,
)
from tests.conventional.handytech import until
from vbraille.conventional.display import ConventionalDisplay
from vbraille.conventional.dotpad import DotPadDisplay
from vbraille.conventional.driver import DisplayGoneError
from vbraille.conventional.messages import DisplayStands, KeyPressed


def heard(display, kind):
    """Poll until the display tells something of a kind, and give it."""
    return until(lambda: next((m for m in display.poll() if isinstance(m, kind)), None))


def test_cells_come_to_it_keys_from_it_and_it_may_go_and_come_back(tmp_path):
    link = tmp_path / "ttyUSB0"
    with SimulatedDotPad(link) as dot_pad, ConventionalDisplay(f"dotpad:{link}") as display:
        assert heard(display, DisplayStands) == DisplayStands("DotPad", "320", 20, 1)
        display.show(b"\x01\x08\xff")
        dot_pad.wait({0: b"\x01\x10\xff".ljust(20, b"\0")})
        for group, number, size, key in (
            (PERKINS, PAN_RIGHT, 4, KeyPressed("FWINRT")),
            (ROUTING, 7, 8, KeyPressed("ROUTE", 7)),
            (FUNCTION, 3, 4, KeyPressed("LNDN")),
        ):
            dot_pad.press(group, number, size)
            assert heard(display, KeyPressed) == key
        dot_pad.unplug()
        display.show(b"\x02")
        until(lambda: display.poll() is not None and display.away.startswith("there is no"))
        assert display.away == (
            f"there is no serial port {link}; plug the display in, or give its path"
        )
        dot_pad.plug()
        assert heard(display, DisplayStands).columns == 20
        dot_pad.wait({0: b"\x02".ljust(20, b"\0")})
        display.close()
        dot_pad.wait({0: bytes(20)})
        assert set(dot_pad.came) == {0}  # the area of pins is left as it is
        assert dot_pad.faults == []


def test_the_area_of_pins_has_several_rows(tmp_path):
    link = tmp_path / "ttyUSB0"
    with SimulatedDotPad(link, answers=(1, 2, 3)) as dot_pad:
        display = DotPadDisplay(str(link), pins=True)
        assert display.check() == DisplayStands("DotPad", "320", 20, 8)
        display.write(b"\xff")
        display.close()  # which waits until all lines stand, those too that it refused at first
        blank = {at: bytes(30) for at in range(2, 11)}
        dot_pad.wait({1: b"\xff" + bytes(29), **blank})
        assert dot_pad.came == [1, 1, 1, *range(1, 11)]


def test_without_an_area_of_pins_none_is_given(tmp_path):
    link = tmp_path / "ttyUSB0"
    with SimulatedDotPad(link, board=TEXT_ONLY), pytest.raises(DisplayGoneError) as raised:
        DotPadDisplay(str(link), pins=True)
    assert str(raised.value) == (
        f"the Dot Pad at {link} has no area of pins; leave ?pins out for its line of text"
    )


def test_one_that_takes_no_lines_is_said_to(tmp_path):
    link = tmp_path / "ttyUSB0"
    with SimulatedDotPad(link, answers=[1] * 9):
        display = DotPadDisplay(str(link))

        def refused():
            try:
                display.write(b"\1")
            except DisplayGoneError as error:
                return str(error)
            return ""

        assert until(refused) == (
            f"the Dot Pad at {link} takes no lines; switch it off and on again"
        )
        display.close()


@pytest.fixture
def port():
    ends = pty.openpty()
    for end in ends:
        tty.setraw(end)
    yield ends[0], os.ttyname(ends[1])
    for end in ends:
        os.close(end)


def test_another_device_is_no_dot_pad(port):
    end, path = port
    device = threading.Thread(target=lambda: os.write(end, os.read(end, 1) + b"OK\r\n"))
    device.start()
    with pytest.raises(DisplayGoneError) as raised:
        DotPadDisplay(path)
    device.join()
    assert str(raised.value) == f"what is at {path} is no Dot Pad; give another port"


def test_a_port_at_which_nothing_answers(port):
    _, path = port
    with pytest.raises(DisplayGoneError) as raised:
        DotPadDisplay(path)
    assert str(raised.value) == (
        f"no Dot Pad answers at {path}; switch it on, or give another port"
    )


def test_one_that_is_unplugged_says_so_whatever_is_done_next(tmp_path):
    link = tmp_path / "ttyUSB0"
    with SimulatedDotPad(link) as dot_pad:
        display = DotPadDisplay(str(link))
        dot_pad.unplug()
        for does in (display.pressed, display.check, lambda: display.write(b"")):
            with pytest.raises(DisplayGoneError) as raised:
                does()
            assert str(raised.value) == f"the Dot Pad at {link} is gone; plug it in again"
        display.close()
        display.close()


def test_a_port_that_another_program_has_and_what_is_no_port(tmp_path):
    link, file = tmp_path / "ttyUSB0", tmp_path / "file"
    file.write_text("no port\n")
    with SimulatedDotPad(link):
        first = DotPadDisplay(str(link))
        with pytest.raises(DisplayGoneError, match="is busy; end the other program that uses it"):
            DotPadDisplay(str(link))
        first.close()
    with pytest.raises(DisplayGoneError, match="is no serial port; give the path of the display"):
        DotPadDisplay(str(file))
