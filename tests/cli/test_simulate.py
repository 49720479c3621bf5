"""``vbraille simulate``, a real process at a real pseudo-terminal."""

import os
import re
import select
import signal
import subprocess
import sys
import time
from contextlib import contextmanager
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from tests.cli import program
from tests.packing import packed
from vbraille.devices.serial.wire import (
    Decoder,
    Encoder,
    Frame,
    Hello,
    Info,
    State,
    Watchdog,
    encode,
)

PATIENCE_S = 30.0


class Host:
    """A host at a port, while what the device prints is read, too."""

    def __init__(self, device, path):
        self.device = device
        self.descriptor = os.open(path, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
        self.decoder = Decoder()
        self.heard = []
        self.sequence = 0

    def close(self):
        os.close(self.descriptor)

    def say(self, message):
        line = encode(message)
        assert os.write(self.descriptor, line) == len(line)

    def show(self):
        """Show something; at rest, what takes the device out of it."""
        info = self.of(Info)[0]
        levels = np.full(info.rows * info.columns, 0 if self.of(State)[-1].resting else 512)
        self.sequence += 1
        self.say(Frame(self.sequence, packed(levels, info.top_level)))

    def until(self, found, step=lambda: None):
        """Hear until something comes true, doing something every few milliseconds."""
        end = time.monotonic() + PATIENCE_S
        while not found():
            assert time.monotonic() < end
            step()
            if select.select([self.descriptor], [], [], 0.005)[0]:
                self.heard += self.decoder.feed(os.read(self.descriptor, 65_536))

    def greet(self):
        """Say HELLO until it is answered."""
        asked = [0.0]

        def ask():
            if time.monotonic() > asked[0]:
                asked[0] = time.monotonic() + 0.25
                self.say(Hello())

        self.until(lambda: self.of(Info) and self.of(State), ask)

    def gaps(self):
        """How far the sequences of neighbouring STATEs are apart."""
        sequences = [state.sequence for state in self.of(State)]
        return [later - earlier for earlier, later in pairwise(sequences)]

    def of(self, kind):
        return [message for message in self.heard if isinstance(message, kind)]


class Simulated:
    """The process, and what it has printed."""

    def __init__(self, *arguments):
        self.process = program.start("simulate", *arguments)
        os.set_blocking(self.process.stdout.fileno(), False)
        self._printed = b""

    @property
    def printed(self):
        """Lines so far."""
        while chunk := self.process.stdout.read():
            self._printed += chunk
        return self._printed.decode().splitlines()

    def until(self, pattern):
        """Wait for a line; the first that matches."""
        end = time.monotonic() + PATIENCE_S
        while True:
            for line in self.printed:
                if re.fullmatch(pattern, line):
                    return line
            assert time.monotonic() < end, f"{pattern} was not printed, but {self.printed}"
            assert self.process.poll() is None, self.process.stderr.read()
            time.sleep(0.005)

    def end(self, number=signal.SIGTERM):
        """Stop it by a signal; its summary."""
        self.process.send_signal(number)
        assert self.process.wait(PATIENCE_S) == 0
        assert self.process.stderr.read() == b""
        found = re.fullmatch(
            r"summary: seconds ([\d.]+), frames (\d+), dropped (\d+), trips (\d+), "
            r"states sent (\d+), states dropped (\d+)",
            self.printed[-1],
        )
        names = ("seconds", "frames", "dropped", "trips", "sent", "lost")
        return dict(zip(names, map(float, found.groups()), strict=True))


@contextmanager
def simulated(*arguments):
    device = Simulated(*arguments)
    try:
        yield device
    finally:
        device.process.kill()
        device.process.wait()
        device.process.stdout.close()
        device.process.stderr.close()


@contextmanager
def host_of(device, path):
    host = Host(device, path)
    try:
        yield host
    finally:
        host.close()


def test_a_host_reads_on_it(tmp_path):
    link = tmp_path / "vb0"
    options = ("--model", "stress2", "--hand", "sweep:500", "--link", link, "--travel", "80")
    with simulated(*options, "--rate", "500", "--encoder", "index") as device:
        device.until(f"link: {link}")
        assert device.printed == [f"port: {link.readlink()}", f"link: {link}"]
        with host_of(device, link) as host:
            host.greet()
            (info,) = host.of(Info)
            assert (info.rows, info.columns, info.rate_hz) == (6, 10, 500)
            assert (info.travel_um, info.encoder) == (80_000, Encoder.INDEX)
            assert host.of(Watchdog) == [Watchdog(0, 0)]
            host.until(lambda: host.of(State)[-1].placed)
            stop = info.left_stop_count
            placed = len(host.of(State))
            host.until(lambda: stop in [state.count for state in host.of(State)[placed:]])
            host.until(lambda: host.of(State)[-1].count > stop + 2000, host.show)
            assert host.of(State)[-1].frame_sequence > 0
            host.until(lambda: len(host.of(Watchdog)) > 1)
            line = device.until(r"watchdog: trip \d+, at rest [\d.]+ ms after the last frame")
        assert 70 <= float(re.search(r"rest ([\d.]+) ms", line)[1]) <= 74  # it ticks every 2 ms
        summary = device.end()
        assert "greeted by a host" in device.printed
    assert not os.path.lexists(link)
    # Of those that come together at rest only the last is taken.
    assert host.sequence // 2 < summary["frames"] <= host.sequence
    assert summary["trips"] >= 1
    assert summary["sent"] > 20
    assert summary["dropped"] == 0


def test_it_misbehaves_when_told_to():
    options = ("--model=vbd", "--drop=0.2", "--corrupt=0.2", "--stall=0.2s", "--seed=5")
    with simulated(*options, "--rate=200") as device:
        port = device.until("port: .*").removeprefix("port: ")
        with host_of(device, port) as host:
            host.greet()
            assert host.of(Info)[0].columns == 12
            host.until(lambda: host.sequence >= 100, host.show)
            host.until(lambda: sum(host.decoder.dropped.values()) > 5)
            host.until(lambda: any(gap > 25 for gap in host.gaps()))
        summary = device.end(signal.SIGINT)
    assert 20 < summary["frames"] < 90
    assert summary["dropped"] > 5
    assert summary["lost"] > 25


def test_it_is_unplugged_and_comes_back(tmp_path):
    link = tmp_path / "vb0"
    with simulated("--unplug-every=1.5s", "--rate=200", "--link", link) as device:
        device.until("port: .*")
        with host_of(device, link) as host:
            host.greet()
            device.until("unplugged")
            with pytest.raises(OSError, match="Input/output error"):
                os.write(host.descriptor, b"\0")
        device.until("plugged in again: .*")
        with host_of(device, link) as host:
            host.greet()
        device.end(signal.SIGHUP)
    assert not os.path.lexists(link)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ("--rate=20", "rate is 20 Hz; it must be 50 to 10000 Hz, and whole"),
        ("--rate=100.5", "rate is 100.5 Hz; it must be 50 to 10000 Hz, and whole"),
        ("--rate=nan", "rate is nan Hz; it must be 50 to 10000 Hz, and whole"),
        ("--travel=0", "travel is 0 mm; it must be 1 to 10000 mm"),
        ("--hand=fast", "there is no hand 'fast'; give sweep:SPEED in mm/s"),
        ("--drop=1.5", "drop is 1.5; it must be 0 to 1"),
        ("--corrupt=nan", "corrupt is nan; it must be 0 to 1"),
        ("--stall=200", "'200' is no duration from 1ms to 3600s, such as 200ms or 5s"),
        ("--stall=0s", "'0s' is no duration"),
        ("--unplug-every=5h --link=x", "'5h' is no duration"),
        ("--unplug-every=5s", "--unplug-every needs --link, for the port has a new name"),
        ("--encoder=odd", "argument --encoder: invalid choice: 'odd'"),
        ("--height=100", "--height is for a carriage of two axes; add --axes xy or --axes xyθ"),
        ("--axes=xy --height=0", "height is 0 mm; it must be above 0"),
        ("--protocol=1", "--protocol is gone; a simulated controller speaks the one version"),
        ("--axes=yx", "argument --axes: invalid choice: 'yx'"),
        ("--script=none", "the script none cannot be read: No such file or directory; check"),
        ("--script=text", "text, line 1: 'kept' is no event; write a time and what is done then"),
        ("--link=none/vb0", "no link can be made at none/vb0: No such file or directory; choose"),
        ("--link=text", "text is there already; remove it, or choose another name for --link"),
    ],
)
def test_what_it_cannot_be_is_said_in_a_sentence(call, tmp_path, monkeypatch, options, said):
    monkeypatch.chdir(tmp_path)
    Path("text").write_text("kept")
    done = call("simulate", *options.split())
    assert (done.code, done.out) == (2, "")
    assert said in done.err
    assert done.err.count("\n") == 1
    assert Path("text").read_text() == "kept"
    assert list(tmp_path.iterdir()) == [tmp_path / "text"]


def test_it_loads_nothing_heavy():
    code = "import sys, vbraille.cli.old.commands.simulate; print(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    loaded = set(done.stdout.split())
    assert "vbraille.simulation.simulator" in loaded
    assert not loaded & {"numba", "louis", "matplotlib", "h5py", "serial"}


def test_its_buttons_are_pressed_when_they_are_to_be(tmp_path):
    link = tmp_path / "vb0"
    presses = "1@0.1s-0.5s,3@0.3s-3000s"
    with simulated("--link", link, "--press", presses) as device:
        device.until("link: .*")
        with host_of(device, link) as host:
            host.greet()
            host.until(lambda: host.of(State)[-1].buttons == 0b100)
            buttons = [state.buttons for state in host.of(State)]
        assert [*dict.fromkeys(buttons)] == [0, 1, 5, 4]
        device.end()


def test_a_page_is_read_on_two_axes_and_a_script_moves_the_knobs(tmp_path):
    script = tmp_path / "script.txt"
    script.write_text("100ms knob 2 1\n0.2s press 4\n")
    options = ("--axes", "xyθ", "--height", "30", "--hand", "sweep:1000", "--script", script)
    with simulated(*options) as device:
        port = device.until("port: .*").removeprefix("port: ")
        with host_of(device, port) as host:
            host.greet()
            (info,) = host.of(Info)
            assert (info.height_um, info.counts_per_turn > 0) == (30_000, True)
            host.until(lambda: host.of(State)[-1].buttons == 0b1000)
            assert host.of(State)[0].knobs == 0x8080_8080
            assert host.of(State)[-1].knobs == 0x8080_FF80
            far = info.far_stop_count
            host.until(lambda: host.of(State)[-1].y_count - far > 2000, host.show)  # 10 mm
        device.end()


def test_keys_at_its_terminal_move_buttons_and_knobs():
    with program.Terminal("simulate") as terminal:
        terminal.until(r"port: .*\r\nkeys: 1 to 8 press a button, a to d turn a knob up, A to D")
        terminal.type("3")
        terminal.until("button 3: pressed")
        terminal.type("aab?D")
        terminal.until(r"(?s)knob 1: 0\.6.*knob 2: 0\.55.*knob 4: 0\.45")
        terminal.type("\x03")
        assert terminal.end() == 0
        assert terminal.settings() == terminal.before


def test_a_press_that_is_none_is_refused():
    done = program.run("simulate", "--press", "1@2s,9@3s")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == "vbraille: button is 9; it must be 1 to 8\n"
