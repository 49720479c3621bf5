"""A picture that answers on a device of two axes at a serial line, the whole way from a key."""

import math
import time
from contextlib import contextmanager
from dataclasses import replace
from itertools import accumulate
from pathlib import Path
from threading import Event, Thread

import numpy as np

from tests.cli.program import PATIENCE_S, Terminal
from tests.tiers import heavy
from vbraille.devices.serial.wire import Encoder
from vbraille.feeling.loading import load_scene
from vbraille.render import MODELS
from vbraille.render.compiling import compile_scene
from vbraille.scene.signals import packed
from vbraille.simulation.firmware import describe
from vbraille.simulation.pty import Port
from vbraille.simulation.recorded import Recorded
from vbraille.simulation.simulator import Simulator

WORLD = Path("texts/scenes/world.scene")
MODEL = MODELS["stress2-8x8"]
DISPLAY = replace(MODEL.display, travel_mm=240.0, height_mm=130.0)
TOP = DISPLAY.levels - 1
# From the sea over the coast of South America, where the hand stops, to the Amazon, where it stays.
SEA, COAST, AMAZON = (40.0, 66.5), (62.8, 66.5), (74.0, 66.5)
STAYS = ((SEA, 1.0), (COAST, 2.0), (AMAZON, 60.0))
MOVE_S = 1.0


def hand():
    """A hand that goes from place to place and stays at each."""
    times = list(accumulate(s for _, stay_s in STAYS for s in (MOVE_S, stay_s)))
    even_s = np.arange(MOVE_S, times[-1], 0.2)
    centres = np.repeat([place for place, _ in STAYS], 2, axis=0)
    x_mm, y_mm = (np.interp(even_s, times, centres[:, axis]) for axis in (0, 1))
    return Recorded(even_s, x_mm - DISPLAY.span_mm / 2, y_mm)


@contextmanager
def device():
    """A controller at a pseudo-terminal; its spec, and the place in mm and levels of each FRAME."""
    port, stopped, felt, at = Port(), Event(), [], []
    info = describe(DISPLAY, Encoder.ABSOLUTE)
    simulator = Simulator(info, hand(), port, say=lambda _: None)
    controller = simulator.controller
    tick, receive = controller.tick, controller.receive

    def ticked(now_us, way_mm, y_mm, theta_rad):
        at[:] = way_mm - DISPLAY.span_mm / 2, y_mm
        return tick(now_us, way_mm, y_mm, theta_rad)

    def received(chunk, now_us):
        before = controller.frames
        answer = receive(chunk, now_us)
        if controller.frames > before:
            felt.append((*at, controller.levels.reshape(DISPLAY.shape) / TOP))
        return answer

    controller.tick, controller.receive = ticked, received
    thread = Thread(target=simulator.run, args=(stopped.is_set,), daemon=True)
    thread.start()
    try:
        yield f"serial:{port.path}", felt
    finally:
        stopped.set()
        thread.join()
        port.unplug()


def there(felt, place):
    """Levels of the FRAMEs that came while the array was at a place; float64[n, rows, columns]."""
    return np.array([levels for *at, levels in felt if math.dist(at, place) < 0.01])


def stays(felt):
    """Wait for 300 FRAMEs more at the last place of the hand, in which all fades end."""
    more, end_s = len(there(felt, AMAZON)) + 300, time.monotonic() + PATIENCE_S
    while len(there(felt, AMAZON)) < more:
        assert time.monotonic() < end_s, "the hand is not there, or nothing is shown"
        time.sleep(0.01)


@heavy  # a host, a controller in real time, and a hand that takes its time
def test_the_world_is_felt_and_a_key_changes_the_view():
    loaded = load_scene(WORLD, MODEL.style)
    program = compile_scene(loaded.scene, DISPLAY, loaded.assets)
    continents, regions = (
        program.poses(
            np.full(1, AMAZON[0]),
            np.full(1, AMAZON[1]),
            switches=packed({1: view}, loaded.scene.signals),
        )[1][0]
        for view in (0, 1)
    )
    assert np.abs(continents - regions).max() > 0.3
    with (
        device() as (spec, felt),
        Terminal("feel", WORLD, "--device", spec, "--say-entering", "--cues", "none") as terminal,
    ):
        terminal.until("h says the keys")
        assert "picture: The world" in terminal.printed
        said = ""
        while "place: 74 mm from the left" not in said:
            terminal.type("i")
            said = terminal.until(r"place: .*\r")
        assert "entering: South America" in terminal.printed
        assert "here: South America" in said
        stays(felt)
        before = len(felt)
        terminal.type("1")
        terminal.until("View: regions")
        stays(felt)
        after = len(felt)
        terminal.type("i")
        terminal.until("here: Amazon")
        terminal.type("1")
        terminal.until("View: continents")
        terminal.type("q")
        assert terminal.end() == 0
    for frames, wanted in ((felt[:before], continents), (felt[before:after], regions)):
        # The last ones may be in a fade, where the host has found no tick in time.
        assert min(np.abs(frame - wanted).max() for frame in there(frames, AMAZON)) < 0.02
    assert np.ptp(there(felt, COAST), axis=0).max() > 0.9  # it vibrates under a hand at rest
    sea = there(felt, SEA)
    assert len(sea) > 100
    assert not sea[len(sea) // 2 :].any()  # the first ones are of places on the way there
