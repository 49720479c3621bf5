"""The controller that was written from the protocol's page alone, with the page's own examples.

``tests/cli/test_read_alone.py`` reads a text on it.
"""

import math
import re
from pathlib import Path

from tests.devices.secondversion import Make, Pose, SecondVersion, body_of, line_of

PAGE = (Path(__file__).parents[2] / "docs/wire-protocol.md").read_text()
EXAMPLE = Make(
    2, 3, slew_per_s=700, name="Example", firmware="2.0", contactor_nm=(500_000, 1_400_000),
    inverted=b"\0\0\0\1\1\1", gain=b"\xff\xff\xcc\xff\xff\xff", enabled=b"\1\1\1\1\1\0",
)  # fmt: skip
POSE = Pose(22.12, 130.0, math.radians(-16.875))


def line_on_the_page(name):
    """Bytes of an example's line."""
    block = re.search(rf"```text\n{name}\(.+?\nline ([0-9a-f\s]+)```", PAGE, re.DOTALL)
    assert block
    return bytes.fromhex(block[1])


def greeted(make=None):
    device = SecondVersion(make=make)
    device.receive(line_on_the_page("Hello"), 0)
    return device


def test_it_says_of_itself_what_the_page_says_of_its_example():
    said = SecondVersion(make=EXAMPLE).receive(b"\0" + line_on_the_page("Hello"), 0)
    assert said.startswith(line_on_the_page("Info2"))
    assert said.count(b"\0") == 2  # and WATCHDOG


def test_its_state_is_that_of_the_page():
    device = greeted(EXAMPLE)
    device._sequence, device._frame, device._resting = 257, 513, False
    device.buttons, device.knobs = 1, bytes((128, 255, 0, 0))
    way_mm = POSE.x_mm + EXAMPLE.before_mm
    state = line_on_the_page("State2")
    # An absolute encoder is always placed; the example has no flags.
    body = bytearray(body_of(device.tick(1_000_000, way_mm, POSE.y_mm, POSE.theta)[:-1]) or b"")
    assert body[13] == 1
    body[13] = 0
    assert line_of(bytes(body)) == state


def test_it_shows_the_levels_of_the_page():
    device = greeted(EXAMPLE)
    device.receive(line_on_the_page("Frame"), 1000)
    assert device.taken == []  # from rest it takes a small step only
    device.receive(line_of(b"\2\0\2" + EXAMPLE_REST), 2000)
    device.receive(line_on_the_page("Frame"), 3000)
    assert device.levels == (0, 1023, 512, 1, 1022, 1023)


EXAMPLE_REST = bytes.fromhex("000000000ffffffff0")[:8]
