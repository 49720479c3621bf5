"""``vbraille feel``."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from vbraille.cli.old.exploring import around_device, say_summary
from vbraille.cli.old.terminal import say_line
from vbraille.devices.registry import check_actuators, find_driver
from vbraille.display import check_rate
from vbraille.errors import InputError
from vbraille.feeling.composing import compose
from vbraille.feeling.loading import check_fits, load_scene
from vbraille.reading.commands.scene import BOUND
from vbraille.reading.exploration import Exploration
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

if TYPE_CHECKING:
    import argparse

    from vbraille.display import Display
    from vbraille.feeling.loading import LoadedScene
    from vbraille.reading.device import OpenDevice
    from vbraille.reading.liveview import LiveView

_MODEL = "stress2-8x8"
# A picture may grow while its author works on it, and has more tiles the nearer it is.
_SPARE, _LEAST_ROOM = 6, 1 << 22


def run(arguments: argparse.Namespace) -> int:
    """Have a picture under the hand until a key says so, or a hand that moves by itself is done."""
    rate_hz = check_rate(arguments.rate)
    refuse_hand(arguments.device, hand=arguments.hand, seed=arguments.seed)
    hand = STILL if arguments.hand is None else arguments.hand
    moved = parse_hand(hand, pointed=True)
    wanted = replace(MODELS[arguments.model or _MODEL].display, rate_hz=rate_hz)
    find_driver(arguments.device)
    loaded = load_scene(arguments.file, model_of(wanted).style)
    if is_simulated(arguments.device):
        _check(loaded, wanted, arguments.y)
    with Keyboard() as keyboard:
        still = isinstance(moved, Still) and has_hand(arguments.device)
        if still and not (keyboard.attached or arguments.monitor):
            raise InputError(
                "nothing would move the hand: start vbraille feel at a terminal, with --monitor, "
                "or with a hand such as --hand wide"
            )
        with around_device(arguments, keyboard, wanted, hand, loaded.scene.language) as around:
            device, outputs = around.device, around.outputs
            display = device.find()
            if arguments.model is not None:
                check_actuators(display, wanted)
            _check(loaded, display, arguments.y)
            model = model_of(display)
            program = compose(loaded, display, rate_hz=rate_hz, own_y_mm=arguments.y)
            room = max(_SPARE * program.nbytes, _LEAST_ROOM)
            device.start(model, room)
            keys = around.keys()
            view = SceneView(
                loaded,
                device,
                rate_hz=rate_hz,
                say=outputs.say,
                bound=BOUND,
                room=room,
                cue=outputs.cue,
                at_mm=arguments.y,
                entering=arguments.say_entering,
                watched=True,
                goes=not still,
                zoom=arguments.zoom,
                sound=outputs.sound,
                sounding=arguments.sounds,
            )
            device.explore(view)
            view.start(program)
            for warning in loaded.notes:
                say_line(f"note: {warning}", aside=True)
            if around.live is not None:
                _show_live(around.live, device, view, hand)
            Exploration(view, device, keys, outputs).run()
    say_summary(device, rate_hz=rate_hz)
    return 0


def _check(loaded: LoadedScene, display: Display, at_mm: float | None) -> None:
    """Refuse a scene that a device's carriage cannot go over, or a height that it does not need."""
    check_fits(loaded.scene, display)
    height_mm = loaded.scene.canvas.height_mm
    if at_mm is not None and display.height_mm:
        raise InputError(
            f"--y is for a device of one axis, and {display.name} has two; leave --y out"
        )
    if at_mm is not None and not 0 <= at_mm <= height_mm:
        raise InputError(f"--y is {at_mm:g} mm; it must be 0 to {height_mm:g} mm")


def _show_live(live: LiveView, device: OpenDevice, view: SceneView, hand: str) -> None:
    """Show what is felt on the pages of the live view."""
    # Only who has a live view waits for what it needs.
    from vbraille.reading.liveview import FeltState

    facts = [] if device.pointer is None else [("hand", hand)]
    live.show(FeltState(device, view, live.said, facts))
