"""Buttons and knobs of a device that speaks the wire protocol, from a script to what is felt."""

import os
import select
import time
from contextlib import contextmanager
from threading import Event, Thread

import numpy as np
import pytest

from tests.cli import program
from vbraille.devices.serial.wire import Encoder
from vbraille.render import STRESS2
from vbraille.simulation.controls import Controls, parse_script
from vbraille.simulation.firmware import describe
from vbraille.simulation.pty import Port
from vbraille.simulation.recorded import Recorded
from vbraille.simulation.simulator import Simulator

FADE_S = 0.1
STEADY = 60  # frames that are alike when the picture has faded in and the hand stays
STAYS_S = 1.0  # from then on the hand stays
TOP = STRESS2.display.levels - 1
# A knob that is turned in many steps, then jitters by one count, then is pressed a button beside.
SCRIPT = "\n".join(
    [
        *(f"{20 * step}ms knob 1 {0.5 - step / 100:.4f}" for step in range(31)),
        *(f"{1200 + 10 * step}ms knob 1 {0.2 + step % 2 / 255:.4f}" for step in range(100)),
        "2.5s press 2",
        "2.7s release 2",
    ]
)
SETTINGS = '[buttons]\n"knob 1" = "CONTRAST"\n"button 2" = "LEARN"\n'


class ControlsInTime(Controls):
    """Controls that move by their script from when something has been felt for a while."""

    from_s = None
    felt = False

    def advance(self, now_s):
        if self.felt:
            self.from_s = now_s if self.from_s is None else self.from_s
            super().advance(now_s - self.from_s)


@contextmanager
def kept_device(script):
    """A controller whose hand goes into the line and stays there; its spec, it and its frames.

    Each entry of the frames is the levels of the last of some that came at once, when that was in
    µs, where the knob stood, and whether the device was at rest or on its own way there before.
    """
    stay_s = np.arange(0, 60, 0.5)
    hand = Recorded(stay_s, 20.0 * np.minimum(stay_s, STAYS_S))
    info = describe(STRESS2.display, Encoder.ABSOLUTE)
    port, stopped, frames = Port(), Event(), []
    controls = ControlsInTime(parse_script(script, "script"))
    simulator = Simulator(info, hand, port, say=lambda _: None, controls=controls)
    controller, receive = simulator.controller, simulator.controller.receive

    def seen(chunk, now_us):
        before, resting = controller.frames, controller.resting
        answer = receive(chunk, now_us)
        if controller.frames > before:
            levels = controller.levels.astype(int)
            frames.append((levels, now_us, controller.knobs[0], resting))
            before = frames[-STEADY:][0][0]
            stays = now_us > STAYS_S * 1e6
            controls.felt |= stays and levels.max() > TOP / 2 and np.array_equal(levels, before)
        return answer

    controller.receive = seen
    thread = Thread(target=simulator.run, args=(stopped.is_set,), daemon=True)
    thread.start()
    try:
        yield f"serial:{port.path}", controller, frames
    finally:
        stopped.set()
        thread.join()
        port.unplug()


def settled_at(frames, most):
    """Number of the last frame once a run of equal frames is felt and within a bound.

    On a busy machine the array rests now and then, and is late for what is said of it.
    """
    end_s = time.monotonic() + program.PATIENCE_S
    while True:
        assert time.monotonic() < end_s
        last = len(frames)
        levels, _, _, resting = zip(*frames[last - STEADY : last], strict=True)
        if not any(resting) and np.ptp(levels, axis=0).max() == 0 < np.max(levels) <= most:
            return last
        time.sleep(0.01)


def said_until(process, enough):
    """Lines that a process prints until one of them is the last that is waited for."""
    lines, end_s = [], time.monotonic() + program.PATIENCE_S
    while not any(map(enough, lines)):
        assert time.monotonic() < end_s, lines
        assert select.select([process.stdout], [], [], program.PATIENCE_S)[0], lines
        lines.append(process.stdout.readline().rstrip("\n"))
        assert process.poll() is None, lines
    return lines


@pytest.mark.real_time
def test_a_knob_turns_contrast_while_the_hand_stays_and_is_said_once(tmp_path, text):
    settings = tmp_path / "settings.toml"
    settings.write_text(SETTINGS)
    environment = os.environ | {"VBRAILLE_SETTINGS": str(settings)}
    with kept_device(SCRIPT) as (spec, controller, frames):
        arguments = ("read", text, "--device", spec, "--no-places", "--texture", "0")
        with program.start(*arguments, env=environment, encoding="utf-8", bufsize=1) as process:
            try:
                lines = said_until(process, lambda line: line.startswith("learn: "))
                turned = settled_at(frames, 0.2 * TOP + 2)  # as it was turned
            finally:
                process.terminate()
                process.communicate()
        # REST does what is left of the fade where its last FRAMEs came at once with REST.
        end_s = time.monotonic() + program.PATIENCE_S
        while not controller.at_rest and time.monotonic() < end_s:
            time.sleep(0.01)
        assert not controller.levels.any()
    assert [line for line in lines if line.startswith("contrast: ")] == ["contrast: 0.2"]
    levels, at_us, knob, resting = map(np.array, zip(*frames, strict=True))
    highest = levels.max(axis=1)
    settled = highest[turned - 1]
    assert settled > 0.1 * TOP
    assert highest.max() > 2 * settled  # as it was before
    # Faded: by no more than a fade goes meanwhile. Where the machine was busy, what comes at once
    # has waited since the time before, and what is next found the line full. The hand stays since
    # long before the knob was turned.
    steps = np.abs(np.diff(levels, axis=0)).max(axis=1)[1:]
    fades = (at_us[2:] - at_us[:-2]) / 1e6 * TOP / FADE_S + 2
    assert (steps <= fades)[(knob[1:-1] < 0.5) & ~resting[2:]].all()
    assert np.median(fades) < TOP / 10  # so that a jump would be seen
