"""A text on a device that a stranger built from the protocol's page, decoded from its log alone.

The log has the levels that came, each beside the pose that the device had told last. What reads it
knows where the dots of a page stand, and the alphabet; of the host it knows nothing.
"""

import math
import os
import select
import time

import numpy as np
import pytest

from tests.cli import program
from tests.devices.pagecontroller import Cable, Make, PageController
from tests.engine.test_page_read import over_dots
from tests.tiers import heavy
from vbraille.render import STRESS2

WORDS = "first", "second", "third"
INDENT = 2  # cells, of each paragraph
CELLS = INDENT + max(map(len, WORDS))
GEOMETRY = STRESS2.style.geometry
# Dots of the letters: those of the second ten are those of the first, and dot 3.
DOTS = dict(zip("abcdefghij", (1, 12, 14, 145, 15, 124, 1245, 125, 24, 245), strict=True))
DOTS |= {chr(ord(letter) + 10): int(f"{dots}3") for letter, dots in DOTS.items()}
MASKS = {letter: sum(1 << int(dot) - 1 for dot in str(dots)) for letter, dots in DOTS.items()}

MAKE = Make(rate_hz=500)
FADE_FRAMES = round(0.3 * MAKE.rate_hz)  # in which a page fades in, and some more
SPEED_MM_S, PAUSE_S, BACK_S, STRAYS, TURNS = 30.0, 0.4, 0.8, 0.15, 0.25
SLOW_MM = 1.5 * SPEED_MM_S / MAKE.rate_hz  # in a tick
ALONG_S = (GEOMETRY.extent_mm(CELLS) + 2 * MAKE.before_mm) / SPEED_MM_S
LINE_S = PAUSE_S + ALONG_S + BACK_S
SETTINGS = '[buttons]\n1 = "LEARN"\n"knob 1" = "CONTRAST"\n'


class Finger:
    """Goes along each line, back and down, and strays and turns; it stays at the end.

    It goes on with each FRAME that is felt, so that it misses nothing when the machine stalls; and
    where the device's watchdog has tripped meanwhile, it waits until the page has faded in.
    """

    def __init__(self, device):
        self.device, self.begun_s = device, math.inf
        self.waited = []  # places in the log of FRAMEs that were waited for
        self._trips = self._taken = self._gone = self._faded = 0

    def follow(self):
        taken = len(self.device.taken)
        if self.device.trips != self._trips:
            self._trips, self._faded = self.device.trips, taken + FADE_FRAMES
        for place in range(self._taken, taken):
            if place < self._faded:
                self.waited.append(place)
            else:
                self._gone += 1
        self._taken = taken

    @property
    def felt_s(self):
        return self._gone / MAKE.rate_hz

    @property
    def passed_s(self):
        return max(self.felt_s - self.begun_s, 0.0)

    @property
    def done(self):
        return self.passed_s > len(WORDS) * LINE_S - BACK_S

    def __call__(self, _s):
        self.follow()
        line, on_s = divmod(self.passed_s, LINE_S)
        line, on_s = (line, on_s) if line < len(WORDS) else (len(WORDS) - 1, LINE_S)
        along = min(max((on_s - PAUSE_S) / ALONG_S, 0.0), 1.0)
        back = max((on_s - PAUSE_S - ALONG_S) / BACK_S, 0.0) if line + 1 < len(WORDS) else 0.0
        y = line + 0.5 + back + STRAYS * math.sin(self.passed_s)
        way_mm = along * (1 - back) * ALONG_S * SPEED_MM_S
        return way_mm, y * GEOMETRY.line_pitch_mm, TURNS * math.sin(0.7 * self.passed_s)


def until(enough, process):
    """Wait until something is so, which it must be before the process ends."""
    end_s = time.monotonic() + program.PATIENCE_S
    while not enough():
        assert process.poll() is None, process.communicate()
        assert time.monotonic() < end_s
        select.select([], [], [], 0.02)


def said_until(process, start):
    """Lines that a process prints, up to the first that starts so."""
    lines = []
    while not lines or not lines[-1].startswith(start):
        assert select.select([process.stdout], [], [], program.PATIENCE_S)[0], lines
        line = process.stdout.readline()
        assert line, (lines, process.communicate())
        lines.append(line.decode().rstrip("\n"))
    return lines


def log_of(device):
    """What a device took, as records of poses and deflections."""
    of_array = STRESS2.display.shape
    kinds = [("x_mm", float), ("y_mm", float), ("theta_rad", float), ("frame", float, of_array)]
    return np.array(
        [
            (*taken.pose, np.reshape(taken.levels, of_array) / MAKE.top_level)
            for taken in device.taken
        ],
        kinds,
    )


def read_off(log):
    """The page's dots, by what most actuators that were over each of them did.

    A FRAME was made for a pose some STATEs ago, which matters where the hand goes back fast.
    """
    log = log[np.hypot(np.gradient(log["x_mm"]), np.gradient(log["y_mm"])) < SLOW_MM]
    masks = np.zeros((len(WORDS), CELLS), int)
    for line, bit, cell, felt in over_dots(log, STRESS2, masks.shape):
        crossed = np.bincount(cell, minlength=CELLS)
        raised = np.bincount(cell[felt > 0.5], minlength=CELLS)
        assert crossed.min() > 20
        assert ((raised > 0.7 * crossed) | (raised < 0.3 * crossed)).all()
        masks[line] |= (raised > 0.5 * crossed) << bit
    return masks.tolist()


@pytest.mark.real_time
@heavy  # the finger goes over the page in real time
def test_a_page_is_read_on_a_device_built_from_the_protocol_page_alone(tmp_path):
    text, settings = tmp_path / "words.txt", tmp_path / "settings.toml"
    text.write_text("\n\n".join(WORDS) + "\n")
    settings.write_text(SETTINGS)
    environment = os.environ | {"VBRAILLE_SETTINGS": str(settings)}
    device = PageController(make=MAKE)
    finger = Finger(device)
    with Cable(device, finger) as cable:
        options = ("--rate", MAKE.rate_hz, "--grade", 1, "--texture", 0, "--echo", "text")
        arguments = ("read", text, "--device", f"serial:{cable.path}", "--no-places", *options)
        with program.start(*arguments, env=environment, bufsize=0) as process:
            try:
                until(lambda: finger.felt_s > 0.5, process)
                finger.begun_s = finger.felt_s
                until(lambda: finger.done, process)
                log = log_of(device)
                log = np.delete(log, [place for place in finger.waited if place < log.size])
                device.knobs = bytes((51, 0, 0, 0))
                said = said_until(process, "contrast: ")
                device.buttons = 1
                said += said_until(process, "learn: ")
                device.buttons = 0
                after = log_of(device)[-1]
            finally:
                process.terminate()
                process.communicate()
        until_rest = time.monotonic() + program.PATIENCE_S
        while device.levels != MAKE.rest:
            assert time.monotonic() < until_rest
            select.select([], [], [], 0.02)
    assert np.ptp(log["theta_rad"]) > TURNS
    assert np.ptp(log["y_mm"] / GEOMETRY.line_pitch_mm) > len(WORDS) - 1
    wanted = [[0] * INDENT + [MASKS[letter] for letter in word] for word in WORDS]
    assert read_off(log) == [line + [0] * (CELLS - len(line)) for line in wanted]
    assert [line for line in said if line.startswith("text: ")] == [f"text: {w}" for w in WORDS]
    assert "contrast: 0.2" in said
    assert log["frame"].max() > 0.9
    assert after["frame"].max() <= 0.2 + 1 / MAKE.top_level
    # Where this machine stands still, the host's driver may cut the line that it was sending.
    assert device.dropped == device.cut
