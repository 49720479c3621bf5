"""Commands for feeling a picture: one table of what keys do, for help and documents."""

from __future__ import annotations

from dataclasses import replace
from operator import methodcaller

from vbraille.cli.old.reading.commands import control
from vbraille.cli.old.reading.commands.table import PAUSE, TYPING, ending, shared
from vbraille.cli.old.reading.keys import Bindings, Command, bind
from vbraille.scene.signals import MOST_KEYS

STEP_MM, FAR_MM = 1.0, 10.0
PAN = 0.5  # of what is within reach
# Buttons of the device, by their numbers.
BUTTONS = {
    "1": "HERE",
    "2": "DESCRIBE",
    "3": "PAUSE",
    "4": "SWITCH_1",
    "5": "SWITCH_2",
    "6": "ZOOM_IN",
    "7": "ZOOM_OUT",
    "8": "WHOLE",
    "9": "PAN_LEFT",
    "10": "PAN_RIGHT",
    "11": "PAN_UP",
    "12": "PAN_DOWN",
}


# A command calls a method of the feeler, by its name: what feels loads the kernels.
# Keys mean what they mean to a reader, as far as a picture has it: elements are like headings.
COMMANDS = (
    shared(
        "HERE",
        ("i", "u"),
        "say what is under the finger, and where",
        methodcaller("say_here"),
    ),
    shared(
        "DESCRIBE", ("w",), "say more of what is under the finger", methodcaller("describe_here")
    ),
    shared("SCENE", ("V", "f5"), "say what the picture is", methodcaller("say_scene")),
    shared("ELEMENTS", ("O",), "list the elements that have a name", methodcaller("say_elements")),
    Command("GOTO", ("g", "/"), "go to an element by its name", methodcaller("ask_element")),
    shared("NEXT", ("n", "e"), "go to the next element", methodcaller("step_element", 1)),
    shared("PREVIOUS", ("p", "E"), "go to the element before", methodcaller("step_element", -1)),
    shared("CANCEL", ("escape",), "say the way to an element no more", methodcaller("cancel")),
    shared(
        "ENTERING",
        ("v", "f6"),
        "say each element when the finger comes to it, with its sound, or no longer",
        methodcaller("toggle_entering"),
    ),
    shared(
        "RIGHT",
        ("right",),
        "simulated hand: 1 mm right; a person's: next element",
        methodcaller("move", STEP_MM, 0),
    ),
    shared(
        "LEFT",
        ("left",),
        "simulated hand: 1 mm left; a person's: the element before",
        methodcaller("move", -STEP_MM, 0),
    ),
    shared(
        "DOWN",
        ("down",),
        "simulated hand: 1 mm down; one axis: 1 mm lower; a person's: next element",
        methodcaller("move", 0, STEP_MM),
    ),
    shared(
        "UP",
        ("up",),
        "simulated hand: 1 mm up; one axis: higher; a person's: the element before",
        methodcaller("move", 0, -STEP_MM),
    ),
    shared(
        "FAR_RIGHT",
        ("shift-right",),
        "simulated hand: 10 mm right",
        methodcaller("move", FAR_MM, 0),
    ),
    shared(
        "FAR_LEFT",
        ("shift-left",),
        "simulated hand: 10 mm left",
        methodcaller("move", -FAR_MM, 0),
    ),
    shared(
        "FAR_DOWN",
        ("shift-down",),
        "simulated hand: 10 mm down; one axis: lower",
        methodcaller("move", 0, FAR_MM),
    ),
    shared(
        "FAR_UP",
        ("shift-up",),
        "simulated hand: 10 mm up; one axis: higher",
        methodcaller("move", 0, -FAR_MM),
    ),
    shared("MIDDLE", ("home",), "go to the middle of the picture", methodcaller("go_to_middle")),
    shared("ZOOM_IN", ("+", "="), "nearer, about the finger", methodcaller("zoom", 1)),
    shared("ZOOM_OUT", ("-",), "farther, about the finger", methodcaller("zoom", -1)),
    shared("WHOLE", ("0",), "the whole picture again, as written", methodcaller("show_whole")),
    *(
        shared(f"PAN_{way.upper()}", keys, f"the part that is {said}", methodcaller("pan", *by))
        for way, keys, said, by in (
            ("right", ("ctrl-right", "]"), "farther right", (PAN, 0.0)),
            ("left", ("ctrl-left", "["), "farther left", (-PAN, 0.0)),
            ("down", ("ctrl-down", "}"), "farther down; one axis: 10 mm lower", (0.0, PAN)),
            ("up", ("ctrl-up", "{"), "farther up; one axis: 10 mm higher", (0.0, -PAN)),
        )
    ),
    shared(
        "APERTURE", ("z",), "say the zoom, and what is within reach", methodcaller("say_aperture")
    ),
    shared("CONTRAST_UP", ("c",), "more contrast", methodcaller("turn_contrast", 1)),
    shared("CONTRAST_DOWN", ("C",), "less contrast", methodcaller("turn_contrast", -1)),
    *(
        shared(
            f"SWITCH_{number}",
            (str(number),),
            f"picture: its switch {number}, such as another view",
            methodcaller("switch", number),
        )
        for number in range(1, MOST_KEYS + 1)
    ),
    Command("RELOAD", ("\x12",), "read the file of the picture again", methodcaller("reload")),
    PAUSE,
    *ending("feeling", "its corner or stop", TYPING),
)
BOUND = bind(COMMANDS, Bindings(buttons=BUTTONS))


# In a text Escape leads back; the way to an element is then said until the finger is there.
_OTHERS = tuple(
    replace(command, keys=()) if command.name == "CANCEL" else command for command in COMMANDS
)
FROM_TEXT = (shared("BACK", ("G", "escape"), "back to the text", control.stop), *_OTHERS)
BOUND_FROM_TEXT = bind(FROM_TEXT, Bindings(buttons=BUTTONS))
