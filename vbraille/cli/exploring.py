"""A device that is explored, with keyboard, outputs and live view, as options ask for."""

from __future__ import annotations

import sys
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from vbraille.cli.build import build_model
from vbraille.cli.printing import say
from vbraille.cli.settings import given, settings_of
from vbraille.devices.registry import check_actuators, check_height, check_travel
from vbraille.errors import InputError
from vbraille.reading.commands import own_keys
from vbraille.reading.device import ReadingDevice
from vbraille.reading.exploration import Exploration
from vbraille.reading.keys import Keyboard
from vbraille.reading.outputs import Behind, Console, Signals, Speech
from vbraille.render import MODELS, model_of
from vbraille.signals import EAR
from vbraille.simulation.specs import is_simulated, parse_hand, refuse_hand

if TYPE_CHECKING:
    from collections.abc import Iterator

    import click

    from vbraille.display import Display
    from vbraille.reading.explored import Explored
    from vbraille.render import Model


@dataclass(slots=True)
class Equipment:
    """Device, outputs and keyboard of a person who explores.

    Parameters
    ----------
    device
        The device, which is not driven yet.
    keyboard
        Keys of the terminal.
    outputs
        Where sentences go, the console first.
    sources
        Where keys come from beside the terminal.
    stack
        What is closed once the device is.
    """

    device: ReadingDevice
    keyboard: Keyboard
    outputs: list[Any]
    sources: list[Any]
    stack: ExitStack

    @property
    def signals(self) -> Any:
        """Output that plays cues and sounds; None if none does."""
        return next((each for each in self.outputs if hasattr(each, "sound")), None)

    def say(self, sentence: str) -> None:
        """Say a sentence on every output."""
        for output in self.outputs:
            output.say(sentence)

    def start(
        self, ctx: click.Context, model: Model, *, language: str = "en", table: Any = None
    ) -> None:
        """Drive the device; all that is said is spoken, or on pins, too, as options ask."""
        self.device.start(model)
        console, chosen = self.outputs[0], ctx.params
        if chosen["speech"]:
            self.outputs.append(Behind("speech", lambda: Speech(language), console.say))
            self.stack.callback(self.outputs[-1].close)
        if chosen.get("also"):
            from vbraille.reading.pins import Pins
            from vbraille.translate import choose_table

            pins = Pins(chosen["also"], table or choose_table(), console.say)
            self.stack.callback(pins.close)
            self.outputs.append(pins)
            self.sources.append(pins)

    def explore(self, ctx: click.Context, what: Explored, *, own: bool = False) -> None:
        """Explore until there is no more, or a person ends it."""
        self.stack.enter_context(self.keyboard)
        if self.keyboard.attached:
            what.say(f"press {'h' if what.key_set == 'usual' else 'f1'} for the keys")
        keys = {}
        if own:
            settings = settings_of(ctx)
            keys = own_keys(settings.table("keys"), settings.table("buttons"))
        Exploration(what, self.device, self.keyboard, self.outputs[0], self.sources, keys).run()


@contextmanager
def equipped(
    ctx: click.Context, wanted: Display, *, hand: str, echo: str = "none", beside: bool = False
) -> Iterator[Equipment]:
    """Set up a device with its outputs; at the end it goes to rest.

    Parameters
    ----------
    ctx
        Context of a command with the options of device and output.
    wanted
        Display that a simulated device is made like.
    hand
        Hand of a simulated device.
    echo
        What is printed of each line.
    beside
        Whether standard input is read by others.
    """
    chosen, asked = ctx.params, given(ctx)
    if not is_simulated(chosen["device"]):
        refuse_hand(chosen["device"], **{n: chosen[n] for n in ("hand", "seed") if n in asked})
    with ExitStack() as stack:
        keyboard = Keyboard(beside=beside)
        if is_simulated(chosen["device"]):  # refused before a process is begun
            moved = bool(chosen["monitor"]) or ctx.info_name == "feel"
            parse_hand(hand, chosen["seed"], pointed=moved)
        device = ReadingDevice(
            chosen["device"],
            replace(wanted, rate_hz=chosen["rate"]),
            often="rate" in asked,
            hand=hand,
            seed=chosen["seed"],
        )
        outputs: list[Any] = [Console(echo)]
        cues = chosen["cues"] or _cues(keyboard)
        if cues != "none":
            tones = cues == "tones"
            outputs.append(Behind("cues", lambda: Signals(tones=tones), outputs[0].say))
            stack.callback(outputs[-1].close)
        equipment = Equipment(device, keyboard, outputs, [], stack)
        if chosen["monitor"]:
            _add_view(equipment, ctx)
        try:
            yield equipment
        finally:
            EAR.close()  # so that the array goes to rest
            device.close()
    faults = ", ".join(f"{name} {count}" for name, count in device.counts.items() if count)
    if faults:
        say(f"device: {faults}")


def _add_view(equipment: Equipment, ctx: click.Context) -> None:
    from vbraille.live.view import LiveView
    from vbraille.reading.liveview import LiveOutput

    view = LiveView(host=ctx.params["host"], port=ctx.params["port"])
    equipment.stack.enter_context(view)
    for sentence in view.addresses:
        equipment.outputs[0].say(sentence)
    output = LiveOutput(view, equipment.device, equipment.outputs[0].say)
    equipment.outputs.append(output)
    equipment.sources.append(output)


def _cues(keyboard: Keyboard) -> str:
    """Cues where none were asked for: the terminal's bell through SSH, and tones nearer by."""
    import os

    if not (keyboard.attached and sys.stdout.isatty()):
        return "none"
    return "bell" if os.environ.get("SSH_CONNECTION") else "tones"


def find_model(ctx: click.Context, device: ReadingDevice, asked: Model) -> Model:
    """Model of the device that is there: the one that was asked for, or the one like it.

    It has the style that the options say.

    Raises
    ------
    VbrailleError
        If the device cannot be opened, has other actuators than the model that was asked for, or
        a carriage that does not go as far as options ask.
    """
    display = device.find()
    if is_simulated(ctx.params["device"]):
        model = replace(asked, display=display)
    else:
        if (travel_mm := ctx.params.get("travel")) is not None:
            check_travel(display, travel_mm)
        check_height(display, ctx.params.get("height"))
        model = model_of(display)
        if ctx.params.get("model"):
            check_actuators(display, asked.display)
            model = replace(MODELS[ctx.params["model"]], display=display)
    if "profile" not in ctx.params:  # of a command whose options say how braille is shown
        return model
    return build_model(ctx, model, display.travel_mm)


def say_summary(device: ReadingDevice, *parts: str, speed: bool = False) -> None:
    """Print how long a device was driven, and what else is told at the end."""
    tally = device.tally
    said = [*parts, f"seconds {(tally.ticks + tally.late) / device.display.rate_hz:.1f}"]
    if speed:
        said.append(f"mean scanning speed {tally.scanning_mm_s:.1f} mm/s")
    if not device.steered:  # that ticks come late does not matter to a device that is not there
        said += [f"ticks {tally.ticks}", f"late ticks {tally.late}"]
    say(f"summary: {', '.join(said)}")


def refuse_terminal(keyboard: Keyboard, what: str) -> None:
    """Raise InputError if there is no terminal to type keys at."""
    if not keyboard.attached:
        raise InputError(f"{what} is led by keys; start it at a terminal")
