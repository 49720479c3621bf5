"""``vbraille tune``."""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import replace
from typing import TYPE_CHECKING, Literal

from vbraille.cli.settled import chosen_profile, settle
from vbraille.cli.stoppable import POLL_S, STOPPED, StoppableKeyboard
from vbraille.cli.stopping import EAR
from vbraille.cli.terminal import say_line
from vbraille.devices.base import Placing
from vbraille.devices.registry import check_actuators
from vbraille.devices.saying import placing_sentence
from vbraille.display import USUAL_RATE_HZ, check_rate
from vbraille.errors import InputError
from vbraille.files import write_file
from vbraille.layout.pages import Layout
from vbraille.layout.texts import cells_per_line, choose_table
from vbraille.reading.bindings import spoken
from vbraille.reading.device import HAND, OpenDevice
from vbraille.reading.keyboard import Keyboard
from vbraille.reading.tuning_course import TuningCourse, from_json, practice_text, to_json
from vbraille.render import MODELS, model_of
from vbraille.settings.saving import save_profile
from vbraille.settings.values import display_name, with_profile
from vbraille.simulation.specs import is_simulated, refuse_hand
from vbraille.toml.textfile import read_text
from vbraille.translate import Book, Document

if TYPE_CHECKING:
    import argparse
    from pathlib import Path

    from vbraille.render import Model
    from vbraille.settings.values import Settings

_KEYS = {
    "space": "feel the other one",
    "1 or 2": "choose this one",
    "u": "take the last choice back",
    "n or p": "next line, previous line",
    "h": "say the keys",
    "q": "leave; the same command goes on from here",
}


def run(arguments: argparse.Namespace) -> int:
    """Lead a reader through the choices, and save what comes of them."""
    settings = settle(arguments)
    profile = chosen_profile(arguments, settings)
    rate_hz = USUAL_RATE_HZ if arguments.rate is None else check_rate(arguments.rate)
    refuse_hand(arguments.device, hand=arguments.hand, seed=arguments.seed)
    asked = MODELS[arguments.model or "stress2"]
    wanted = asked.on(asked.style.geometry, rate_hz)
    with ExitStack() as listening, Keyboard() as keyboard:
        if not keyboard.attached:
            raise InputError("vbraille tune is led by keys; start it at a terminal")
        book = _book(arguments)
        device = OpenDevice(
            arguments.device,
            wanted,
            often=arguments.rate is not None,
            hand=arguments.hand or HAND,
            seed=1 if arguments.seed is None else arguments.seed,
            say=say_line,
            attended=True,
        )
        try:
            display = device.find()
            if arguments.model is not None or is_simulated(arguments.device):
                check_actuators(display, wanted)
            usual = model_of(display)
            geometry = replace(usual.style.geometry, travel_mm=display.travel_mm)
            model = with_profile(
                settings, profile, replace(usual, style=replace(usual.style, geometry=geometry))
            )
            course = _Guided(arguments, settings, profile, model)
            text = Layout(book, cells_per_line(model.style.geometry, model.display))
            if text.line(1) is None:
                raise InputError(f"{arguments.file} has no text in it; give a text file")
            device.start(replace(model, style=course.course.shown(1)))
            keys = listening.enter_context(StoppableKeyboard(keyboard))
            device.show(text)
            course.run(device, keys)
        finally:
            EAR.close()  # so that the array goes to rest
            device.close()
    return 0


def _book(arguments: argparse.Namespace) -> Book:
    """Text to practise on, and its table.

    Raises
    ------
    InputError
        If one of the two cannot be used.
    """
    table = choose_table(arguments.language, arguments.grade, arguments.table)
    if arguments.file is None:
        return Book(Document.from_text(practice_text(arguments.language)), table)
    return Book(Document.open(arguments.file), table)


class _Guided:
    """A course on its way at a terminal, whose choices are kept in a file until it is done."""

    def __init__(
        self, arguments: argparse.Namespace, settings: Settings, profile: str, model: Model
    ) -> None:
        self._settings, self._profile, self._model = settings, profile, model
        self._display = display_name(model)
        self._which: Literal[1, 2] = 1
        self._left = False
        self.course = TuningCourse(model)
        if not arguments.again and self._path.exists():
            try:
                self.course = from_json(read_text(self._path, "file of choices"), model)
            except InputError as error:
                raise InputError(f"{self._path}: {error}; begin anew with --again") from None

    @property
    def _path(self) -> Path:
        """File that keeps the choices until the course is done."""
        path = self._settings.path
        return path.with_name(f"{path.stem}-tune-{self._profile}-{self._display}.json")

    def run(self, device: OpenDevice, keys: StoppableKeyboard) -> None:
        """Lead through the choices that are left, then save."""
        say_line(f"display: {self._model.title}")
        say_line(f"profile: {self._profile}")
        say_line("h says the keys")
        if self.course.choices:
            say_line(f"going on: choices made {len(self.course.choices)}")
        self._ask(device)
        placing = Placing.DONE
        while not (self._left or self.course.done):
            if keys.asked:
                _suspend(device, keys)
            for key in keys.pressed(POLL_S):
                if device.placing is Placing.STOP:
                    device.set_zero()
                elif not (self._left or self.course.done):
                    self._press(device, key)
            device.poll(0.0)
            if device.placing is not placing:
                placing = device.placing
                say_line(placing_sentence(placing, device.display))
        if self.course.done:
            self._save()

    def _press(self, device: OpenDevice, key: str) -> None:
        match key:
            case " ":
                self._which = 2 if self._which == 1 else 1
                self._show(device)
            case "1" | "2":
                say_line(f"chosen: {key}")
                self._choose(device, self.course.choose(1 if key == "1" else 2))
            case "u" if self.course.choices:
                self._choose(device, self.course.undo())
            case "u":
                say_line("undo: nothing was chosen")
            case "n" | "down" | "p" | "up":
                step = 1 if key in ("n", "down") else -1
                if not device.reader.go(device.reader.line_number + step):
                    say_line("last line" if step > 0 else "first line")
            case "q":
                self._left = True
                say_line(f"left: {len(self.course.choices)} of {self.course.total} choices made")
            case "h" | "?":
                for name, does in _KEYS.items():
                    say_line(f"{name}: {does}")
            case _:
                say_line(f"no command: {spoken(key)}; h says the keys")

    def _choose(self, device: OpenDevice, course: TuningCourse) -> None:
        """Take a choice, or take one back, and ask the next."""
        settled = len(self.course.found)
        self.course = course
        self._keep()
        for found in course.found[settled:]:
            say_line(found.knob.said(found.value))
            say_line(f"95 % interval: {found.low:g} to {found.high:g} {found.knob.unit}".rstrip())
        if not course.done:
            self._which = 1
            self._ask(device)

    def _ask(self, device: OpenDevice) -> None:
        knob = self.course.knob
        if knob is not None:
            say_line(f"choice {len(self.course.choices) + 1} of {self.course.total}: {knob.label}")
            self._show(device)

    def _show(self, device: OpenDevice) -> None:
        style = self.course.shown(self._which)
        device.tune(geometry=style.geometry, tuning=style.tuning)
        say_line(f"now: {self._which}")

    def _keep(self) -> None:
        """Keep the choices, whole or not at all."""
        self._path.parent.mkdir(parents=True, exist_ok=True)
        text = to_json(self.course, self._profile, self._display)
        write_file(self._path, text.encode(), replace=True, durable=True)

    def _save(self) -> None:
        model = replace(self._model, style=self.course.style)
        say_line(save_profile(self._settings.path, self._profile, model))
        self._path.unlink(missing_ok=True)


def _suspend(device: OpenDevice, keys: StoppableKeyboard) -> None:
    """Stop, with the array at rest, until the shell says to go on."""
    device.paused = True
    say_line(STOPPED)
    keys.stop()
    device.paused = False
    say_line("reading")
