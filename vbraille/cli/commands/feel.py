"""``vbraille feel``."""

from __future__ import annotations

import time
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from vbraille.cli.atdevice import AtDevice, say_summary, surrounded
from vbraille.cli.options.exploring import check_live_options
from vbraille.cli.terminal import say_line
from vbraille.devices.events import Button
from vbraille.devices.registry import check_actuators, find_driver
from vbraille.display import check_rate
from vbraille.errors import InputError
from vbraille.feeling.composing import compose
from vbraille.feeling.loading import FileWatch, check_fits, load_scene
from vbraille.reading.commands.scene import BOUND
from vbraille.reading.commands.table import press_button
from vbraille.reading.keyboard import Keyboard
from vbraille.reading.sceneview import SceneView
from vbraille.render import MODELS, model_of
from vbraille.simulation.hand import Still
from vbraille.simulation.specs import (
    STILL,
    has_hand,
    is_simulated,
    parse_hand,
    refuse_hand,
)
from vbraille.simulation.steering import ReadPage

if TYPE_CHECKING:
    import argparse
    from collections.abc import Iterable

    from vbraille.cli.atdevice import Surroundings
    from vbraille.devices.events import Event
    from vbraille.display import Display
    from vbraille.engine.host import HostDiedError
    from vbraille.feeling.loading import LoadedScene
    from vbraille.reading.device import OpenDevice
    from vbraille.reading.keyboard import StoppableKeyboard
    from vbraille.reading.liveview import FeltState, LastSentences

_MODEL = "stress2-8x8"
_LINE_MM = 10.0  # between the lines that a hand goes along which reads
# A picture may grow while somebody works on it.
_SPARE, _LEAST_ROOM = 3, 1 << 21


def run(arguments: argparse.Namespace) -> int:
    """Have a picture under the hand until a key says so, or a hand that moves by itself is done."""
    check_live_options(arguments)
    rate_hz = check_rate(arguments.rate)
    refuse_hand(arguments.device, hand=arguments.hand, seed=arguments.seed)
    hand = STILL if arguments.hand is None else arguments.hand
    moved = parse_hand(hand, pointed=True)
    wanted = replace(MODELS[arguments.model or _MODEL].display, rate_hz=rate_hz)
    find_driver(arguments.device)
    loaded = load_scene(arguments.file, model_of(wanted).style)
    if is_simulated(arguments.device):
        _check(loaded, wanted, arguments.at)
    with Keyboard() as keyboard:
        still = isinstance(moved, Still) and has_hand(arguments.device)
        if still and not (keyboard.attached or arguments.monitor):
            raise InputError(
                "nothing would move the hand: start vbraille feel at a terminal, with --monitor, "
                "or with a hand such as --hand wide"
            )
        with surrounded(arguments, keyboard, wanted, hand, loaded.scene.language) as around:
            device, outputs = around.device, around.outputs
            display = device.find()
            if arguments.model is not None:
                check_actuators(display, wanted)
            _check(loaded, display, arguments.at)
            model = model_of(display)
            program = compose(loaded, display, rate_hz=rate_hz, own_y_mm=arguments.at)
            room = max(_SPARE * program.nbytes, _LEAST_ROOM)
            device.start(model, room)
            keys = around.keys()
            feeler = SceneView(
                loaded,
                device,
                rate_hz=rate_hz,
                say=outputs.say,
                bound=BOUND,
                room=room,
                cue=outputs.cue,
                at_mm=arguments.at,
                entering=arguments.say_entering,
            )
            feeler.start(program)
            for warning in loaded.notes:
                say_line(f"note: {warning}", aside=True)
            if around.live is not None:
                around.live.show(lambda said, facts: _view(device, feeler, said, facts), hand)
            _Feeling(around, feeler, keys, goes=not still).run()
    say_summary(device, rate_hz=rate_hz)
    return 0


def _check(loaded: LoadedScene, display: Display, at_mm: float | None) -> None:
    """Refuse a scene that a device's carriage cannot go over, or a height that it does not need."""
    check_fits(loaded.scene, display)
    height_mm = loaded.scene.canvas.height_mm
    if at_mm is not None and display.height_mm:
        raise InputError(
            f"--at is for a device of one axis, and {display.name} has two; leave --at out"
        )
    if at_mm is not None and not 0 <= at_mm <= height_mm:
        raise InputError(f"--at is {at_mm:g} mm; it must be 0 to {height_mm:g} mm")


def _view(
    device: OpenDevice, feeler: SceneView, said: LastSentences, facts: list[tuple[str, str]]
) -> FeltState:
    """Describe what is felt, as the state of the live view."""
    # Only who has a live view waits for what it needs.
    from vbraille.reading.liveview import FeltState

    return FeltState(device, feeler, said, facts)


class _Feeling(AtDevice):
    """A picture that is felt until somebody has enough.

    A simulated hand that goes by itself sets out, and without anybody at keys ends the feeling.
    """

    def __init__(
        self, around: Surroundings, feeler: SceneView, keys: StoppableKeyboard, *, goes: bool
    ) -> None:
        super().__init__(around, feeler, keys)
        self._feeler = feeler
        self._goes = goes and self._device.steering is not None
        self._watch = FileWatch(Path(feeler.loaded.opened.path))

    def run(self) -> None:
        """Feel until somebody has enough; see `AtDevice.run`."""
        self._set_out()
        super().run()

    def _start_again(self, fault: HostDiedError) -> None:
        super()._start_again(fault)
        self._set_out()

    def _set_out(self) -> None:
        """Have a hand that goes by itself go over the whole picture, another to its middle."""
        steering = self._device.steering
        if self._goes and steering is not None:
            canvas = self._feeler.loaded.scene.canvas
            lines = max(1, round(canvas.height_mm / _LINE_MM))
            steering.give(ReadPage(lines, canvas.height_mm / lines, canvas.width_mm))
        elif steering is not None:
            self._feeler.go_to_middle()

    def _see(self, events: Iterable[Event]) -> None:
        device, feeler = self._device, self._feeler
        for event in events:
            if isinstance(event, Button) and event.pressed:
                press_button(feeler, event.number)
        if device.held:
            feeler.forget_aim()
        feeler.attend(time.monotonic())
        if self._watch.changed():
            feeler.reload()
        if self._goes and not self._keys.attached and self._is_done():
            feeler.quit()

    def _is_done(self) -> bool:
        """Whether a simulated hand has gone all of its way."""
        pose, steering = self._device.pose, self._device.steering
        return pose is not None and steering is not None and steering.done_at(pose.time_ns)
