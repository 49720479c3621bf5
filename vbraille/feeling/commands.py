"""The commands of whoever feels a picture: one table of what keys do, for help and documents."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from vbraille.reading.bindings import ANY, Bindings, Command, Context, bind
from vbraille.reading.commands import control
from vbraille.reading.commands.table import TYPING, say_keys

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.feeling.feeler import Feeler

STEP_MM, FAR_MM = 1.0, 10.0
# Buttons of the device, by their numbers.
BUTTONS = {"1": "HERE", "2": "DESCRIBE", "3": "PAUSE"}


def _move(right: float, down: float) -> Callable[[Feeler], None]:
    def move(feeler: Feeler) -> None:
        feeler.move(right, down)

    return move


def _turn(step: int) -> Callable[[Feeler], None]:
    def turn(feeler: Feeler) -> None:
        feeler.turn_contrast(step)

    return turn


def _does(name: str) -> Callable[[Feeler], None]:
    """Make a function that calls a method of the feeler."""

    def handler(feeler: Feeler) -> None:
        getattr(feeler, name)()

    return handler


COMMANDS = (
    Command("HERE", ("i", "f5"), "say what is under the finger, and where", _does("say_here")),
    Command("DESCRIBE", ("d",), "say more of what is under the finger", _does("describe_here")),
    Command("SCENE", ("t",), "say what the picture is", _does("say_scene")),
    Command("ELEMENTS", ("e",), "say the elements that have a name", _does("say_elements")),
    Command("GOTO", ("g",), "go to an element by its name", _does("ask_element")),
    Command("CANCEL", ("escape",), "say the way to an element no more", _does("cancel")),
    Command(
        "ENTERING",
        ("s",),
        "say each element when the finger comes to it, or no longer",
        _does("toggle_entering"),
    ),
    Command("RIGHT", ("right",), "simulated hand: 1 mm right", _move(STEP_MM, 0)),
    Command("LEFT", ("left",), "simulated hand: 1 mm left", _move(-STEP_MM, 0)),
    Command(
        "DOWN", ("down",), "simulated hand: 1 mm down; one axis: 1 mm lower", _move(0, STEP_MM)
    ),
    Command("UP", ("up",), "simulated hand: 1 mm up; one axis: higher", _move(0, -STEP_MM)),
    Command("FAR_RIGHT", ("shift-right", "l"), "simulated hand: 10 mm right", _move(FAR_MM, 0)),
    Command("FAR_LEFT", ("shift-left", "j"), "simulated hand: 10 mm left", _move(-FAR_MM, 0)),
    Command(
        "FAR_DOWN",
        ("shift-down", "k"),
        "simulated hand: 10 mm down; one axis: lower",
        _move(0, FAR_MM),
    ),
    Command(
        "FAR_UP",
        ("shift-up", "o"),
        "simulated hand: 10 mm up; one axis: higher",
        _move(0, -FAR_MM),
    ),
    Command("MIDDLE", ("m", "home"), "go to the middle of the picture", _does("go_to_middle")),
    Command("CONTRAST_UP", ("c",), "more contrast", _turn(1)),
    Command("CONTRAST_DOWN", ("C",), "less contrast", _turn(-1)),
    Command("RELOAD", ("r",), "read the file of the picture again", _does("reload")),
    Command("PAUSE", (" ",), "rest the array at once, or go on", control.pause),
    Command("HELP", ("h", "f1"), "say the keys", say_keys),
    Command(
        "LEARN",
        ("?", "f2"),
        "learn the keys: each says what it does, and does nothing",
        control.learn,
        (Context.READING, Context.LEARNING),
    ),
    Command(
        "QUIT",
        ("q",),
        "stop feeling",
        control.stop,
        (Context.READING, Context.PLACING, Context.LEARNING),
    ),
    *TYPING,
    Command(
        "ZERO",
        (ANY,),
        "the carriage is at its corner or stop, when that is asked for",
        control.set_zero,
        (Context.PLACING,),
    ),
)
BOUND = bind(COMMANDS, Bindings(buttons=BUTTONS))


def back(feeler: Feeler) -> None:
    """Go back to the text."""
    feeler.quit()


# In a text Escape leads back; the way to an element is then said until the finger is there.
_OTHERS = tuple(
    replace(command, keys=()) if command.name == "CANCEL" else command for command in COMMANDS
)
FROM_TEXT = (Command("BACK", ("G", "escape"), "back to the text", back), *_OTHERS)
BOUND_FROM_TEXT = bind(FROM_TEXT, Bindings(buttons=BUTTONS))
