"""The controller that was written from the protocol's page alone, with the page's own examples.

``tests/cli/test_read_alone.py`` reads a text on it.
"""

import math
import re
from pathlib import Path

import numpy as np
import pytest

from tests.devices.bench import HALF, LINE_LATE, Bench
from tests.devices.pagecontroller import (
    Make,
    PageController,
    Pose,
    body_of,
    line_of,
    stuffed,
    unstuffed,
)
from vbraille.devices.events import Button, Knob, told
from vbraille.devices.serial.wire import Decoder
from vbraille.simulation.firmware import Controller

PAGE = (Path(__file__).parents[2] / "docs/wire-protocol.md").read_text()
EXAMPLE = Make(
    2, 3, slew_per_s=700, name="Example", firmware="2.0", knobs=2,
    contactor_nm=(500_000, 1_400_000), inverted=b"\0\0\0\1\1\1",
    gain=b"\xff\xff\xcc\xff\xff\xff", enabled=b"\1\1\1\1\1\0",
)  # fmt: skip
LEVELS = (0, 1023, 512, 1, 1022, 1023)  # of the FRAME on the page
OF_REST = bytes.fromhex("00000003fffffff0")  # three levels of 0, three of 1023, 4 bits left over


def line_on_the_page(name):
    """Bytes of an example's line."""
    block = re.search(rf"```text\n{name}\([^`]+?\nline ([0-9a-f\s]+)```", PAGE)
    assert block
    return bytes.fromhex(block[1])


def greeted():
    device = PageController(make=EXAMPLE)
    said = device.receive(b"\0" + line_on_the_page("Hello"), 0)
    return device, said


def frame(sequence, packed=OF_REST):
    return line_of(bytes([2, sequence & 255, sequence >> 8]) + packed)


def test_its_info_is_that_of_the_page():
    said = greeted()[1]
    assert said == line_on_the_page("Info") + line_of(b"\x83" + bytes(8))


def test_its_state_is_that_of_the_page():
    device, _ = greeted()
    device._sequence = 257
    device.receive(frame(513), 999_000)
    device.buttons, device.knobs = 1, bytes((128, 255, 0, 0))
    x_mm, theta = 22.12, math.radians(-16.875)
    said = device.tick(1_000_000, x_mm + EXAMPLE.before_mm, 130.0, theta)
    assert said == line_on_the_page("State")


def test_it_shows_the_frame_of_the_page_but_not_out_of_rest():
    device, _ = greeted()
    device.receive(line_on_the_page("Frame"), 1000)
    assert (device.levels, device.dropped) == (EXAMPLE.rest, 0)
    device.receive(frame(512), 2000)
    for ms in (2, 3, 4):
        device.tick(1000 * ms, 0.0)
    device.receive(line_on_the_page("Frame"), 4000)
    device.tick(5000, 0.0)
    assert device.levels == LEVELS
    device.receive(line_on_the_page("Frame"), 5000)  # twice
    assert (len(device.taken), device.dropped) == (2, 1)
    device.receive(line_on_the_page("Rest"), 6000)
    for ms in range(6, 27):
        device.tick(1000 * ms, 0.0)
    assert device.levels == EXAMPLE.rest


@pytest.mark.parametrize("name", ["Info", "State", "Watchdog", "Error"])
def test_it_spells_frames_as_the_page_does(name):
    line = line_on_the_page(name)
    body = body_of(line[:-1])
    assert body
    assert line_of(body) == line


def test_runs_of_254_bytes_are_spelled_as_on_the_page():
    run = bytes(range(1, 255))
    for plain, spelled in (
        (run, b"\xff" + run),
        (run + b"\0", b"\xff" + run + b"\1\1"),
        (run + b"\xff", b"\xff" + run + b"\2\xff"),
    ):
        assert stuffed(plain) == spelled
        assert unstuffed(spelled) == plain
    assert unstuffed(b"\xff" + run + b"\1") == run


def test_places_are_those_of_the_page():
    section = PAGE.split("\n## Place\n")[1].split("\n## ")[0]
    rows = [row.strip("| ").split(" | ") for row in section.splitlines() if row[:3] > "| 0"]
    rows = [list(map(float, row)) for row in rows if row[0].isdecimal()]
    assert len(rows) == 5
    for *counts, x_mm, y_mm, degrees, _, _ in rows:
        pose = EXAMPLE.pose(*map(int, counts))
        assert pose == pytest.approx((x_mm, y_mm, math.radians(degrees)), abs=1e-5)
        assert EXAMPLE.counts(pose) == tuple(counts)


@pytest.mark.parametrize(
    "made_as",
    [
        lambda info: Controller(Decoder().feed(info)[0]),
        lambda _info: PageController(make=EXAMPLE),
    ],
    ids=["simulated", "alone"],
)
def test_the_conversation_of_the_page_is_had_byte_for_byte(made_as):
    """Both controllers know the page; they were written by different hands."""
    section = PAGE.split("\n## A conversation to test with\n")[1]
    rows = re.findall(r"^\| (\d+) \| ([←→]) \| .+? \| `(.+?)` \|$", section, re.MULTILINE)
    assert [way for _, way, _ in rows].count("←") == 8
    info = line_on_the_page("Info")
    device = made_as(info)
    now_ms = 0
    for (ms, way, line), (next_ms, next_way, _) in zip(rows, [*rows[1:], rows[0]], strict=True):
        while now_ms < int(ms):
            now_ms += 1
            heard = device.tick(1000 * now_ms, 0.0)
        if way == "→":
            heard = device.receive(bytes.fromhex(line), 1000 * now_ms)
            # What is shown of a device is all that it says to what it has heard.
            assert (next_ms, next_way) == (ms, "←") or heard == b""
        else:
            assert heard == bytes.fromhex(line.replace("…", info.hex()))


def test_vbraille_has_its_place_its_buttons_and_its_knob():
    made = Bench(PageController)
    device = made.open()
    assert device.display.axes == "xyθ"
    made.settle(device)
    assert np.unique(made.controller.levels).tolist() == [512]
    for way_mm, y_mm, theta in ((0.0, 0.0, 0.0), (150.0, 70.0, 0.3), (300.0, 200.0, -3.0)):
        made.way_mm, made.y_mm, made.theta_rad = way_mm, y_mm, theta
        here = made.run(device, 3)
        pose = Pose(way_mm - made.controller.make.before_mm, y_mm, theta)
        assert here[1:] == pytest.approx(pose, abs=1e-3)
    made.controller.buttons, made.controller.knobs = 0b10, bytes((51, 0, 0, 0))
    made.run(device, 2)
    button, knob = sorted(device.take_events(), key=lambda event: type(event).__name__)
    assert button == Button(2, pressed=True)
    assert knob == Knob(1, pytest.approx(0.2))
    device.close()
    made.pause(0.03)
    assert made.controller.levels == made.controller.make.rest
    assert (made.controller.dropped, made.controller.trips) == (0, 0)


def test_its_watchdog_trips_and_vbraille_begins_again():
    made = Bench(PageController)
    device = made.open()
    made.settle(device)
    made.deaf = True
    made.run(device, 75)
    assert made.controller.levels == made.controller.make.rest
    made.deaf = False
    made.run(device, 60)
    made.settle(device, HALF)
    assert told(device.take_events()) == [LINE_LATE]
    assert made.controller.trips == 1
    device.close()


def test_a_hello_of_another_version_is_answered_and_nothing_is_taken():
    device, said = greeted()
    device.receive(frame(1), 1000)
    device.tick(1000, 0.0)
    assert device.receive(line_of(b"\1\3"), 2000) == said
    assert device.tick(3000, 0.0) == b""
    device.receive(frame(2), 4000)
    device.tick(4000, 0.0)
    assert len(device.taken) == 1
