"""The commands of the memory game: one table of what keys do, for help and documents."""

from __future__ import annotations

from operator import methodcaller

from vbraille.cli.old.reading.commands.table import PAUSE, ending, shared
from vbraille.cli.old.reading.keys import Bindings, bind

# Keys mean what they mean to a reader, as far as a game has it.
COMMANDS = (
    shared("RIGHT", ("right",), "the place to the right", methodcaller("move", 1, 0)),
    shared("LEFT", ("left",), "the place to the left", methodcaller("move", -1, 0)),
    shared("DOWN", ("down",), "the place below", methodcaller("move", 0, 1)),
    shared("UP", ("up",), "the place above", methodcaller("move", 0, -1)),
    shared("NEXT", ("n",), "the next card that lies face down", methodcaller("step_card", 1)),
    shared("PREVIOUS", ("p",), "the one before", methodcaller("step_card", -1)),
    shared(
        "TURN",
        ("\n",),
        "turn the card up; after the second, find out whether they match",
        methodcaller("turn"),
    ),
    shared(
        "POINT",
        (),
        "turn the card that is pointed at in the live view, as TURN does",
        lambda view, place: view.turn_at(place),
        placed=True,
    ),
    shared("OTHER", ("o",), "feel the other card that is turned up", methodcaller("feel_other")),
    shared("PLACE", ("i", "u"), "say the place, and how its card lies", methodcaller("say_place")),
    shared("TABLE", ("O",), "say how all cards lie", methodcaller("say_table")),
    shared("POINTS", ("V", "f5"), "say the points", methodcaller("say_points")),
    shared("ONE", ("1",), "deal anew for one player", methodcaller("begin", 1)),
    shared("TWO", ("2",), "deal anew for two players", methodcaller("begin", 2)),
    PAUSE,
    *ending("playing", "its corner or stop"),
)
# Buttons of the device, and keys of a conventional display, by BRLTTY's names.
BUTTONS = {
    "1": "NEXT",
    "2": "TURN",
    "3": "OTHER",
    "display LNDN": "DOWN",
    "display LNUP": "UP",
    "display HOME": "TURN",
}
BOUND = bind(COMMANDS, Bindings(buttons=BUTTONS))
