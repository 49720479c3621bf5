"""``vbraille tune``."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Literal

from vbraille.cli.old.build import chosen_profile
from vbraille.cli.old.exploring import around_device
from vbraille.config.settings import display_name, save_profile, settle, with_profile
from vbraille.devices.base import Placing
from vbraille.devices.registry import check_actuators
from vbraille.display import USUAL_RATE_HZ, check_rate
from vbraille.errors import InputError
from vbraille.files import read_text, write_file
from vbraille.layout.pages import Layout
from vbraille.layout.texts import cells_per_line, choose_table
from vbraille.reading.commands.table import BOUND
from vbraille.reading.device import HAND
from vbraille.reading.exploration import Exploration
from vbraille.reading.keyboard import Keyboard
from vbraille.reading.keys import spoken
from vbraille.reading.outputs import language_of
from vbraille.reading.tuning_course import TuningCourse, from_json, practice_text, to_json
from vbraille.reading.view import View
from vbraille.render import MODELS, model_of
from vbraille.simulation.specs import is_simulated, refuse_hand
from vbraille.translate import Book, Document

if TYPE_CHECKING:
    import argparse
    from pathlib import Path

    from vbraille.cli.old.exploring import Around
    from vbraille.render import Model

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
    with Keyboard() as keyboard:
        if not keyboard.attached:
            raise InputError("vbraille tune is led by keys; start it at a terminal")
        book = _book(arguments)
        hand, language = arguments.hand or HAND, language_of(book, arguments.language)
        often = arguments.rate is not None
        with around_device(arguments, keyboard, wanted, hand, language, often=often) as around:
            device = around.device
            display = device.find()
            if arguments.model is not None or is_simulated(arguments.device):
                check_actuators(display, wanted)
            usual = model_of(display)
            model = with_profile(
                settings,
                profile,
                replace(usual, style=usual.style.replace(travel_mm=display.travel_mm)),
            )
            path = settings.path.with_name(
                f"{settings.path.stem}-tune-{profile}-{display_name(model)}.json"
            )
            course = TuningCourse(model) if arguments.again else _taken_up(path, model)
            text = Layout(book, cells_per_line(model.style.geometry, model.display))
            if text.line(1) is None:
                raise InputError(f"{arguments.file} has no text in it; give a text file")
            device.start(replace(model, style=course.shown(1)))
            keys = around.keys()
            device.show(text)
            guided = _Guided(around, course, path, profile)
            guided.start()
            Exploration(guided, device, keys, around.outputs).run()
            if guided.course.done:
                style = guided.course.style
                saved = replace(model, style=style)
                around.outputs.say(save_profile(settings.path, profile, saved))
                path.unlink(missing_ok=True)
    return 0


def _taken_up(path: Path, model: Model) -> TuningCourse:
    """Course whose choices a file keeps; a new one if there is no such file.

    Raises
    ------
    InputError
        If the file cannot be gone on with.
    """
    if not path.exists():
        return TuningCourse(model)
    try:
        return from_json(read_text(path, "file of choices"), model)
    except InputError as error:
        raise InputError(f"{path}: {error}; begin anew with --again") from None


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


class _Guided(View):
    """A course on its way at a terminal, whose choices are kept in a file until it is done."""

    does, doing = "tune", "reading"

    def __init__(self, around: Around, course: TuningCourse, path: Path, profile: str) -> None:
        outputs = around.outputs
        super().__init__(around.device.engine, outputs.say, BOUND, outputs.cue)
        self.course = course
        self._device = around.device
        self._path, self._profile = path, profile
        self._which: Literal[1, 2] = 1

    def start(self) -> None:
        """Say what the course is for, and ask for the first choice that is left."""
        self.say(f"display: {self.course.start.title}")
        self.say(f"profile: {self._profile}")
        if self.course.choices:
            self.say(f"going on: choices made {len(self.course.choices)}")
        self._ask()

    def press(self, key: str) -> None:
        """Feel the other of the two, choose, or whatever else a key stands for."""
        device, say = self._device, self.say
        if self.done:
            return
        if device.placing is Placing.STOP:
            device.set_zero()
            return
        match key:
            case " ":
                self._which = 2 if self._which == 1 else 1
                self._feel()
            case "1" | "2":
                say(f"chosen: {key}")
                self._choose(self.course.choose(1 if key == "1" else 2))
            case "u" if self.course.choices:
                self._choose(self.course.undo())
            case "u":
                say("undo: nothing was chosen")
            case "n" | "down" | "p" | "up":
                step = 1 if key in ("n", "down") else -1
                if not device.reader.go(device.reader.line.number + step):
                    say("last line" if step > 0 else "first line")
            case "q":
                self.quit()
                say(f"left: {len(self.course.choices)} of {self.course.total} choices made")
            case "h" | "?":
                for name, does in _KEYS.items():
                    say(f"{name}: {does}")
            case _:
                say(f"no command: {spoken(key)}; h says the keys")

    def _choose(self, course: TuningCourse) -> None:
        """Take a choice, or take one back, and ask the next."""
        settled = len(self.course.found)
        self.course = course
        self._path.parent.mkdir(parents=True, exist_ok=True)
        kept = to_json(course, self._profile, display_name(course.start))
        write_file(self._path, kept.encode(), replace=True, durable=True)
        for found in course.found[settled:]:
            self.say(found.knob.said(found.value))
            interval = f"{found.low:g} to {found.high:g} {found.knob.unit}".rstrip()
            self.say(f"95 % interval: {interval}")
        if course.done:
            self.quit()
            return
        self._which = 1
        self._ask()

    def _ask(self) -> None:
        knob = self.course.knob
        if knob is not None:
            made = len(self.course.choices)
            self.say(f"choice {made + 1} of {self.course.total}: {knob.label}")
            self._feel()

    def _feel(self) -> None:
        """Show the one or the other."""
        style = self.course.shown(self._which)
        self._device.tune(geometry=style.geometry, tuning=style.tuning)
        self.say(f"now: {self._which}")
