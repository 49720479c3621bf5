"""The host's side of the wire protocol, without a port: the page's bytes, and what it does when."""

import json
import random
import re
from contextlib import suppress
from pathlib import Path

import pytest

from vbraille.devices.events import Back, Button, Knob, Notice, Silent, SlowActuators
from vbraille.devices.protocol import Conversation, Stage, info_pieces, line_of, read_info
from vbraille.errors import DeviceError
from vbraille.simulation.controller import Controller

PAGE = Path(__file__).parents[2] / "docs" / "wire-protocol.md"
MS = 1_000_000
INFO = {
    "name": "VBD", "rows": 1, "columns": 4, "pitch_mm": [1, 1], "rest": "left", "top": 255,
    "fast": 166, "rate": 1000, "counts_per_mm": [200], "travel_mm": [100], "buttons": 2, "knobs": 1,
}  # fmt: skip


class Bench:
    """A conversation and a controller, a millisecond at a time, with lines that can be cut."""

    def __init__(self, number=65_530, delay_ms=0, **info):
        self.device = Controller(INFO | info)
        self.ms = 0
        self.talk = Conversation(0, number)
        self.in_ = self.out = True  # whether the line carries to the device, and from it
        self.frames = True
        self.delay_ms = delay_ms
        self.to_device, self.to_host = [], []
        self.steps = []
        self.pose = None

    def run(self, ms, level=200):
        for _ in range(ms):
            self.ms += 1
            now_ns = self.ms * MS
            message = self.talk.due(now_ns)
            if self.frames and (frame := self.talk.frame(bytes([level] * 4), now_ns)):
                self.talk.sent(now_ns)
                message += frame
            if self.in_:
                self.to_device.append((self.ms + self.delay_ms, message))
            while self.to_device and self.to_device[0][0] <= self.ms:
                self.device.receive(self.to_device.pop(0)[1])
            before = self.device.level.copy()
            line = self.device.tick(self.ms * 1000)
            self.steps.append(int(abs(self.device.level - before).max()))
            if self.out:
                self.to_host.append((self.ms + self.delay_ms, line))
            while self.to_host and self.to_host[0][0] <= self.ms:
                self.pose = self.talk.hear(self.to_host.pop(0)[1], now_ns) or self.pose
        return self

    def events(self, kind):
        return [event for event in self.talk.events if isinstance(event, kind)]


def examples():
    """The bodies and lines of the page's examples."""
    text = PAGE.read_text().partition("## Bytes")[2]
    found = re.findall(
        r"\b([0-9A-F]{2}(?: [0-9A-F]{2})*)(?:\s{2,}|\n\s*)([0-9A-F]{2}(?: [0-9A-F]{2})*)", text
    )
    return [(bytes.fromhex(body), bytes.fromhex(line)) for body, line in found]


def test_the_bytes_of_the_page_are_right():
    found = examples()
    assert len(found) >= 7
    for body, line in found:
        assert line_of(body) == line


def test_the_page_is_short():
    assert len(PAGE.read_text().split()) <= 2000


def test_a_device_is_greeted_and_takes_frames():
    bench = Bench().run(100)
    assert bench.talk.live
    assert bench.device.level.tolist() == [200] * 4
    assert bench.device.dropped == 0
    assert bench.pose.x_mm == -1.5
    assert bench.talk.acknowledged_ns is not None


@pytest.mark.parametrize("delay_ms", [20, 200])
def test_a_slow_line_goes_live_within_a_second(delay_ms):
    bench = Bench(delay_ms=delay_ms).run(1200)
    assert bench.talk.live
    assert bench.device.level.max() == 200


def test_it_lives_through_lost_and_damaged_lines():
    bench = Bench()
    chance = random.Random(1)
    for _ in range(4000):
        bench.in_, bench.out = chance.random() > 0.2, chance.random() > 0.2
        bench.run(1)
    assert bench.talk.missed > 500
    bench.in_ = bench.out = True
    assert bench.run(150).talk.live


def test_numbers_wrap():
    assert Bench(65_500).run(300).talk.live


def test_a_host_that_owes_frames_has_the_device_rest_and_goes_on():
    bench = Bench().run(100)
    bench.frames = False
    bench.run(45)
    assert bench.talk.rests == 1
    bench.run(30)
    assert bench.device.at_rest
    bench.frames = True
    assert bench.run(100).talk.live
    assert bench.device.trips == 0


def test_silence_is_told_and_ended():
    bench = Bench().run(100)
    bench.out = False
    bench.run(300)
    assert not bench.talk.live
    assert bench.events(Silent)
    bench.run(400)
    assert bench.talk.stage is Stage.GREETING
    bench.out = True
    bench.run(400)
    assert bench.talk.live
    assert bench.events(Back)


def test_a_device_that_starts_again_is_greeted_again():
    bench = Bench().run(100)
    bench.device = Controller(INFO)
    assert bench.run(1000).talk.live


def test_another_device_in_its_place_is_told_nothing_but_hello():
    bench = Bench().run(100)
    bench.device = Controller(INFO | {"name": "other", "columns": 5})
    with pytest.raises(DeviceError, match="other came back in the place of VBD"):
        bench.run(1500)
    assert not bench.device.frames


def test_two_hosts_are_told_of_each_other_and_nothing_jumps():
    bench = Bench().run(100)
    other = Conversation(0, 7)

    def run():
        for _ in range(10_000):
            bench.device.receive(other.due(bench.ms * MS))
            bench.run(1)

    with pytest.raises(DeviceError, match="another program"):
        run()
    assert max(bench.steps) <= INFO["fast"]


def test_a_fault_is_an_error_with_the_devices_words():
    bench = Bench().run(100)
    bench.device.say(1, "too \x1bhot")
    with pytest.raises(DeviceError, match="too <escape>hot"):
        bench.run(5)
    assert bench.device.goal.max() == 0


def test_a_note_buttons_and_knobs_are_events():
    bench = Bench().run(100)
    bench.device.say(0, "warm")
    bench.device.buttons, bench.device.knobs = 2, (100, 9, 0, 0)
    bench.run(5)
    assert bench.events(Notice)[0].say() == "device: warm"
    assert [(event.number, event.pressed) for event in bench.events(Button)] == [(2, True)]
    assert [event.number for event in bench.events(Knob)] == [1]
    bench.device.knobs = (101, 9, 0, 0)  # it jitters
    assert len(bench.run(5).events(Knob)) == 1


def test_a_watchdog_trip_is_measured_by_the_devices_clock():
    bench = Bench().run(100)
    bench.in_ = False
    bench.run(120)
    bench.in_ = True
    bench.run(200)
    assert bench.talk.trips == 1
    assert 46 <= bench.talk.tripped_ms <= 52


def test_zero_is_repeated_until_the_device_has_taken_it():
    bench = Bench()
    bench.device.placed = False
    bench.device.x = 5000
    bench.run(100)
    assert bench.pose is None
    bench.in_ = False
    bench.talk.zero(bench.ms * MS)
    bench.run(30)
    bench.in_ = True
    bench.run(200)
    assert bench.pose.x_mm == -1.5


def test_slow_actuators_are_told_with_the_speed_that_they_follow():
    bench = Bench(fast=72).run(100)
    (event,) = bench.events(SlowActuators)
    assert event.speed_mm_s == 34
    assert not Bench().run(100).events(SlowActuators)


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("rows", 0), ("rows", True), ("columns", 256), ("top", 1024), ("fast", 12), ("rate", 300),
        ("rest", "up"), ("name", ""), ("name", None), ("pitch_mm", [1]), ("counts_per_mm", [0]),
        ("counts_per_mm", [1, 2, 3]), ("travel_mm", [-5]), ("travel_mm", [1e9]), ("knobs", 5),
        ("analog", ["x"] * 9), ("pitch_mm", [float("inf"), 1]), ("serial", 5),
    ],
)  # fmt: skip
def test_info_that_cannot_be_is_refused(key, value):
    with pytest.raises(ValueError, match="INFO"):
        read_info(json.dumps(INFO | {key: value}).encode())


def test_spoilt_info_is_refused_or_read_and_nothing_else():
    chance = random.Random(2)
    text = json.dumps(INFO).encode()
    for _ in range(300):
        spoilt = bytearray(text)
        for _ in range(chance.randrange(1, 4)):
            spoilt[chance.randrange(len(spoilt))] = chance.randrange(256)
        with suppress(ValueError):  # and nothing else
            read_info(bytes(spoilt))


def test_info_in_pieces_of_several_answers_is_put_together():
    talk = Conversation(0)
    pieces = info_pieces(INFO)
    for piece in [pieces[-1], *pieces[:-2], pieces[0], pieces[-2]]:
        assert talk.info is None
        talk.hear(line_of(piece), 1)
    assert talk.info.name == "VBD"


def test_another_version_is_refused():
    with pytest.raises(DeviceError, match="version 2"):
        Conversation(0).hear(line_of(b"\x81\x02\x00\x01{}"), 1)


def test_rubbish_is_counted_and_changes_nothing():
    bench = Bench().run(100)
    chance = random.Random(3)
    for _ in range(2000):
        kind = chance.choice((0x81, 0x82, 0x83, 0x55))
        bench.talk.hear(chance.randbytes(chance.randrange(1, 50)), bench.ms * MS)
        if kind != 0x83:
            bench.talk.hear(line_of(bytes((kind,)) + chance.randbytes(3)), bench.ms * MS)
    bench.talk.hear(b"\0", bench.ms * MS)
    assert bench.talk.lines.damaged > 100
    assert bench.run(100).talk.live


def test_nothing_grows_in_a_week():
    bench = Bench()
    bench.run(50)
    for _ in range(7 * 24):  # the clock of µs wraps 141 times
        bench.ms += 3_600_000
        bench.run(600)
        bench.talk.events.clear()
    assert bench.run(200).talk.live
    state = vars(bench.talk)
    assert all(
        len(value) < 100 for value in state.values() if isinstance(value, (list, dict, bytes))
    )


def test_levels_are_packed_as_the_page_says():
    import numpy as np

    from vbraille.devices.levels import pack

    out = np.zeros(5, np.uint8)
    pack(np.array([[0.0, 1.0], [512 / 1023, 1 / 1023]]), 1023, out)
    assert out.tobytes() == bytes.fromhex("00FC0F6000")
    pack(np.array([[0.0, 128 / 255], [1.0, 1 / 255]]), 255, out)
    assert out[:4].tobytes() == bytes.fromhex("0080FF01")
