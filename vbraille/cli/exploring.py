"""A device that is explored, with keyboard, outputs and live view, as options ask for."""

from __future__ import annotations

import os
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
    ctx
        Context of a command with the options of device and output.
    stack
        What is closed once the device is.
    device
        The device, which is not driven yet.
    keyboard
        Keys of the terminal.
    outputs
        Where sentences go, the console first.
    sources
        Where keys come from beside the terminal.
    """

    ctx: click.Context
    stack: ExitStack
    device: ReadingDevice
    keyboard: Keyboard
    outputs: list[Any]
    sources: list[Any]

    def say(self, sentence: str) -> None:
        """Say a sentence on every output."""
        for output in self.outputs:
            output.say(sentence)

    def add(self, output: Any, *, keys: bool = False) -> None:
        """Add an output, whose keys are taken, too, if it has some."""
        self.stack.callback(output.close)
        self.outputs.append(output)
        if keys:
            self.sources.append(output)

    def find(self, asked: Model) -> Model:
        """Model of the device that is there: the one that was asked for, or the one like it.

        It has the style that the options say.

        Raises
        ------
        VbrailleError
            If the device cannot be opened, has other actuators than the model that was asked for,
            or a carriage that does not go as far as options ask.
        """
        chosen, display = self.ctx.params, self.device.find()
        model = replace(asked, display=display)
        if not is_simulated(chosen["device"]):
            if (travel_mm := chosen.get("travel")) is not None:
                check_travel(display, travel_mm)
            check_height(display, chosen.get("height"))
            if chosen["model"]:
                check_actuators(display, asked.display)
                model = replace(MODELS[chosen["model"]], display=display)
            else:
                model = model_of(display)
        if "profile" not in chosen:  # of a command whose options say how braille is shown
            return model
        return build_model(self.ctx, model, display.travel_mm)

    def start(self, model: Model, *, language: str = "en", table: Any = None) -> None:
        """Drive the device; all that is said is spoken, or on pins, too, as options ask."""
        self.device.start(model)
        console, chosen = self.outputs[0], self.ctx.params
        if chosen["speech"]:
            self.add(Behind("speech", lambda: Speech(language), console.say))
        if chosen.get("also"):
            from vbraille.reading.pins import Pins
            from vbraille.translate import choose_table

            self.add(Pins(chosen["also"], table or choose_table(), console.say), keys=True)

    def explore(self, what: Explored, *, own: bool = False) -> None:
        """Explore until there is no more, or a person ends it; by keys of their own, if `own`."""
        self.stack.enter_context(self.keyboard)
        if self.keyboard.attached:
            what.say(f"press {'h' if what.key_set == 'usual' else 'f1'} for the keys")
        keys = keys_of(self.ctx) if own else {}
        Exploration(what, self.device, self.keyboard, self.outputs[0], self.sources, keys).run()


def keys_of(ctx: click.Context) -> dict[str, str]:
    """Names of commands by the keys of one's own in the settings file."""
    settings = settings_of(ctx)
    return own_keys(settings.table("keys"), settings.table("buttons"))


@contextmanager
def equipped(ctx: click.Context, wanted: Display, echo: str = "none") -> Iterator[Equipment]:
    """Set up a device with its outputs; at the end it goes to rest.

    Parameters
    ----------
    ctx
        Context of a command with the options of device and output.
    wanted
        Display that a simulated device is made like.
    echo
        Form in which each line is printed.
    """
    chosen, asked = ctx.params, given(ctx)
    spec, hand, seed = chosen["device"], chosen["hand"], chosen["seed"]
    if is_simulated(spec):  # a wrong hand is refused before a process is begun
        parse_hand(hand, seed, pointed=chosen["monitor"] or ctx.info_name == "feel")
    else:
        refuse_hand(spec, **{name: chosen[name] for name in ("hand", "seed") if name in asked})
    with ExitStack() as stack:
        keyboard = Keyboard(beside=chosen.get("file") == "-")
        wanted = replace(wanted, rate_hz=chosen["rate"])
        device = ReadingDevice(spec, wanted, often="rate" in asked, hand=hand, seed=seed)
        console = Console(echo)
        equipment = Equipment(ctx, stack, device, keyboard, [console], [])
        cues = chosen["cues"] or "none"
        if not chosen["cues"] and keyboard.attached and sys.stdout.isatty():
            cues = "bell" if os.environ.get("SSH_CONNECTION") else "tones"
        if cues != "none":
            equipment.add(Behind("cues", lambda: Signals(tones=cues == "tones"), console.say))
        if chosen["monitor"]:
            from vbraille.live.view import LiveView
            from vbraille.reading.liveview import LiveOutput

            view = stack.enter_context(LiveView(host=chosen["host"], port=chosen["port"]))
            for sentence in view.addresses:
                console.say(sentence)
            equipment.add(LiveOutput(view, device, console.say), keys=True)
        try:
            yield equipment
        finally:
            EAR.close()  # so that the array goes to rest
            device.close()
    faults = ", ".join(f"{name} {count}" for name, count in device.counts.items() if count)
    if faults:
        say(f"device: {faults}")


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
