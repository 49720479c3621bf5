"""The controller's header: its limits under random hosts, and its twin in Python."""

import random
import struct
import subprocess

import numpy as np
import pytest

from tests.devices.firmware import FIRMWARE, Header
from vbraille.devices.protocol import line_of
from vbraille.simulation.controller import Controller

ABOUT = {
    "name": "H",
    "pitch_mm": [1, 1],
    "rest": "left",
    "counts_per_mm": [200],
    "travel_mm": [100],
}


def frame(number, levels=b""):
    return line_of(struct.pack("<BH", 2, number & 0xFFFF) + levels)


def packed(levels, top):
    if top <= 255:
        return bytes(levels)
    bits = sum(level << 10 * n for n, level in enumerate(levels))
    return bits.to_bytes((10 * len(levels) + 7) // 8, "little")


def random_host(chance, count, top, actuators=6):
    """Bytes before each of many ticks, of a host that is wrong in all ways."""
    number = chance.randrange(65536)
    chunks = []
    for _ in range(count):
        draw = chance.random()
        if draw < 0.45:
            number += chance.choice((1, 1, 1, 1, 2, 40, -1, 30000))
            levels = [chance.randrange(top + 1) for _ in range(actuators)]
            if chance.random() < 0.02:
                levels[-1] = min(top + 1, 255 if top <= 255 else 1023)
            chunk = frame(number, packed(levels, top))
        elif draw < 0.47:
            number += chance.randrange(3)
            chunk = frame(number)
        elif draw < 0.475:
            chunk = line_of(bytes((1, chance.choice((3, 3, 3, 2)))))
        elif draw < 0.48:
            chunk = chance.choice((line_of(b"\x03"), line_of(b"\x07\x01"), frame(number, b"\x01")))
        elif draw < 0.5:
            chunk = chance.randbytes(chance.randrange(1, 60)) + b"\0" * chance.randrange(2)
        else:
            chunk = b""
        if chunk and chance.random() < 0.03:
            spoilt = bytearray(chunk)
            spoilt[chance.randrange(len(spoilt))] ^= 1 << chance.randrange(8)
            chunk = bytes(spoilt)
        chunks.append(chunk)
    return chunks


@pytest.mark.parametrize(("top", "fast"), [(255, 166), (1023, 400), (1, 1)])
def test_no_actuator_is_faster_than_its_limits(tmp_path, top, fast):
    device = Header(tmp_path, VB_TOP=top, VB_FAST=fast)
    chance = random.Random(top)
    ticks = 400_000 if top == 255 else 300_000
    some = random_host(chance, 20_000, top)
    chunks = [line_of(b"\x01\x03"), *(chance.choice(some) for _ in range(ticks - 1))]
    steps = np.array([chance.choice((1000, 1000, 1000, 1100, 2500, 30000)) for _ in chunks])
    us = np.cumsum(steps).astype(np.uint32)
    step, resting_step, above, rising, _, trips = device.soak(chunks, us)[:6]
    assert 0 < step <= fast
    assert resting_step <= -(-top // 20)
    assert above == 0
    assert rising == 0
    assert trips > 0


@pytest.mark.parametrize(("top", "rate"), [(255, 1000), (1023, 250)])
def test_header_and_simulated_controller_answer_alike(tmp_path, top, rate):
    fast = top // 2
    device = Header(tmp_path, VB_TOP=top, VB_FAST=fast, VB_RATE=rate)
    info = {"rows": 2, "columns": 3, "top": top, "fast": fast, "rate": rate}
    twin = Controller(info | ABOUT, placed=False)
    chance = random.Random(5)
    us = 0
    for number, chunk in enumerate([line_of(b"\x01\x03"), *random_host(chance, 10_000, top)]):
        us += chance.choice((1000, 1000, 1000, 1200, 20000))
        x, room = chance.randrange(-(10**6), 10**6), chance.random() < 0.95
        if number % 500 == 499:
            code = chance.randrange(2)
            device.say(code)
            twin.say(code, "too hot")
        device.hear(chunk)
        twin.receive(chunk)
        twin.x, twin.y, twin.turn = x, 2 * x, -x
        assert device.tick(us, x, room=room) == twin.tick(us, room=room), number
        assert device.levels == twin.level.tolist(), number


def test_it_rests_by_itself_within_71_ms(tmp_path):
    device = Header(tmp_path, VB_TOP=1023, VB_FAST=1023)
    device.hear(line_of(b"\x01\x03") + frame(1))
    for us in range(0, 40_000, 1000):
        device.tick(us)
    device.hear(frame(2, packed([1023] * 6, 1023)))
    last = us
    device.tick(last + 1000)
    assert device.levels == [1023] * 6
    for ms in range(2, 72):
        device.tick(last + 1000 * ms)
        if not any(device.levels):
            break
    assert not any(device.levels)
    assert ms > 48


@pytest.mark.parametrize("macros", ["VB_TOP=1024", "VB_FAST=12", "VB_RATE=300", "VB_ROWS=0"])
def test_macros_that_cannot_be_are_refused(tmp_path, macros):
    name, value = macros.split("=")
    with pytest.raises(subprocess.CalledProcessError):
        Header(tmp_path, **{name: int(value)})


def test_it_is_cpp_as_well_and_no_longer_than_it_should_be(tmp_path):
    source = tmp_path / "device.cpp"
    example = (FIRMWARE / "example" / "example.ino").read_text()
    arduino = (
        "#include <stdint.h>\nstruct Port { int availableForWrite(); void begin(long);"
        "int write(const uint8_t *, int); int available(); int read(); } Serial;\n"
        "enum { CHANGE, INPUT_PULLUP, OUTPUT };\n"
        "void analogWrite(int, int); int digitalRead(int); void pinMode(int, int);"
        "int digitalPinToInterrupt(int); void attachInterrupt(int, void (*)(), int);"
        "uint32_t micros(); void interrupts(); void noInterrupts();\n"
    )
    source.write_text(arduino + example)
    flags = ["-std=c++11", "-Wall", "-Wextra", "-Werror", "-fsyntax-only", f"-I{FIRMWARE}"]
    subprocess.run(["c++", *flags, str(source)], check=True)
    assert len((FIRMWARE / "vbraille.h").read_text().splitlines()) <= 200
