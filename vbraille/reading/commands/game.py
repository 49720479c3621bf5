"""The commands of the memory game: one table of what keys do, for help and documents."""

from __future__ import annotations

from operator import methodcaller

from vbraille.reading.commands.table import PAUSE, ending
from vbraille.reading.keys import Bindings, Command, bind

# Keys mean what they mean to a reader, as far as a game has it.
COMMANDS = (
    Command("RIGHT", ("right",), "the place to the right", methodcaller("move", 1, 0)),
    Command("LEFT", ("left",), "the place to the left", methodcaller("move", -1, 0)),
    Command("DOWN", ("down",), "the place below", methodcaller("move", 0, 1)),
    Command("UP", ("up",), "the place above", methodcaller("move", 0, -1)),
    Command("NEXT", ("n",), "the next card that lies face down", methodcaller("step_card", 1)),
    Command("PREVIOUS", ("p",), "the one before", methodcaller("step_card", -1)),
    Command(
        "TURN",
        ("\n",),
        "turn the card up; after the second, find out whether they match",
        methodcaller("turn"),
    ),
    Command("OTHER", ("o",), "feel the other card that is turned up", methodcaller("feel_other")),
    Command("PLACE", ("i", "u"), "say the place, and how its card lies", methodcaller("say_place")),
    Command("TABLE", ("O",), "say how all cards lie", methodcaller("say_table")),
    Command("POINTS", ("V", "f5"), "say the points", methodcaller("say_points")),
    Command("ONE", ("1",), "deal anew for one player", methodcaller("begin", 1)),
    Command("TWO", ("2",), "deal anew for two players", methodcaller("begin", 2)),
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
