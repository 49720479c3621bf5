"""Displays that BRLTTY drives: a real BRLTTY with a display of Handy Tech at a pseudo-terminal."""

import signal
import socket
import time
from contextlib import closing
from itertools import count

import pytest

from tests.conventional.handytech import (
    HOME,
    Brltty,
    needs_brltty,
    until,
)
from tests.tiers import heavy
from vbraille.conventional.display import (
    CellsTaken,
    ConventionalDisplay,
    DisplayAway,
    DisplayStands,
)
from vbraille.errors import InputError

SHOWN = bytes((0x11, 0xFF, 0x00, 0x80))


@pytest.fixture
def brltty(tmp_path):
    with Brltty(tmp_path) as brltty:
        yield brltty


@pytest.fixture
def display(brltty):
    with closing(ConventionalDisplay(f"brlapi:{brltty.host}")) as display:
        yield display


def heard(display, kind):
    """Poll until the display tells something of a kind, and give it."""
    return until(lambda: next((m for m in display.poll() if isinstance(m, kind)), None))


@needs_brltty
def test_cells_come_to_the_display(brltty, display):
    assert heard(display, DisplayStands) == DisplayStands("HandyTech", "mdlr", 40, 1)
    shown_ns = time.monotonic_ns()
    number = display.show(SHOWN)
    brltty.display.wait(SHOWN)
    taken = until(lambda: [m for m in display.poll() if m == CellsTaken(number, m.at_ns)])[0]
    assert shown_ns < taken.at_ns < time.monotonic_ns()
    for _ in range(20):
        brltty.display.press(HOME)  # its keys are nothing to it, and hold nothing up
    # More than there is room for is cut, and less is followed by blank cells.
    display.show(bytes((1,)) * 50)
    brltty.display.wait(bytes((1,)) * 40)
    display.show(b"\2")
    brltty.display.wait(b"\2")
    display.rest()
    brltty.display.wait(b"")
    display.show(b"\3")
    brltty.display.wait(b"\3")


@needs_brltty
@heavy  # BRLTTY goes and comes in a session of tests/sessions/running/test_pins.py
def test_it_is_there_again_after_brltty_the_display_and_its_own_process_were_gone(brltty, display):
    heard(display, DisplayStands)
    display.show(SHOWN)
    brltty.display.wait(SHOWN)

    brltty.process.kill()
    brltty.stop()
    assert f"no BRLTTY answers at {brltty.host}" in heard(display, DisplayAway).why
    display.show(b"\1")
    brltty.start()
    heard(display, DisplayStands)
    brltty.display.wait(b"\1")

    # Of a display on a serial line BRLTTY knows that it is gone when something goes there.
    brltty.display.unplug()
    numbers = count()

    def gone():
        display.show(bytes((2 + next(numbers) % 100,)))
        time.sleep(0.1)
        return next((m.why for m in display.poll() if isinstance(m, DisplayAway)), None)

    # Which of the two it is depends on whether BRLTTY has already let go of its driver.
    assert until(gone).endswith(("drives no display; plug one in", "plug it in, or switch it on"))
    display.show(b"\2")
    brltty.display.plug(80)
    assert heard(display, DisplayStands).columns == 80
    brltty.display.wait(b"\2")


@heavy  # it waits for three seconds of silence, twice
@needs_brltty
def test_what_does_not_answer_is_said_and_found_again(brltty, display):
    heard(display, DisplayStands)
    display.show(SHOWN)
    brltty.display.wait(SHOWN)
    brltty.process.send_signal(signal.SIGSTOP)
    assert heard(display, DisplayAway).why.startswith("what drives the display does not answer")
    brltty.process.send_signal(signal.SIGCONT)
    heard(display, DisplayStands)


@needs_brltty
@pytest.mark.parametrize(
    ("how", "why"), [({"auth": "keyfile:"}, "let you in"), ({"driver": "no"}, "no display")]
)
def test_why_there_is_none_is_said(tmp_path, how, why):
    key = tmp_path / "key"
    key.write_text("secret\n")
    how = {name: value + str(key) * value.endswith(":") for name, value in how.items()}
    with (
        Brltty(tmp_path, **how) as brltty,
        closing(ConventionalDisplay(f"brlapi:{brltty.host}")) as display,
    ):
        until(lambda: why in getattr(heard(display, DisplayAway), "why", ""))


@needs_brltty
def test_another_service_at_the_port_is_no_brltty():
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = server.getsockname()[1]
        number = port - 4101
        if number < 0:
            pytest.skip("the port is below those of BRLTTY")
        with closing(ConventionalDisplay(f"brlapi:127.0.0.1:{number}")) as display:
            taken, _ = server.accept()
            taken.sendall(b"HTTP/1.1 400 Bad Request\r\n\r\n" * 20)
            taken.close()
            assert "BRLTTY" in heard(display, DisplayAway).why


@pytest.mark.parametrize(
    "spec", ["", "brltty", "brlapi:localhost", "brlapi:a b:1", "brlapi:host:x", "hid", "dotpad:/d"]
)
def test_what_is_no_display_of_brltty_is_refused(spec):
    with pytest.raises(InputError, match="brlapi:HOST:N"):
        ConventionalDisplay(spec)
