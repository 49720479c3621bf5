"""What pages of the live view ask of a reader: commands by their names, and knobs by values."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

from vbraille.errors import InputError
from vbraille.live.messages import PagePress, Turn
from vbraille.reading.bindings import Context
from vbraille.reading.commands.table import COMMANDS
from vbraille.reading.commands.turning import turn_to
from vbraille.render.braille.knobs import KNOBS
from vbraille.wording import printable, spelled

if TYPE_CHECKING:
    from vbraille.reading.reader import Reader

# Not among them: what asks for a text, which is typed where the reader is; what is kept for another
# time, and the end of reading, which are the reader's; and what only somebody beside the device can
# know, such as that its carriage is at the stop.
ALLOWED: Final = frozenset(
    {
        *("WINDN", "WINUP", "STRAYING", "BAND_UP", "BAND_DOWN"),
        *("LNDN", "LNUP", "FWINRT", "FWINLT", "LNBEG", "LNEND", "TOP", "BOT", "BACK"),
        *("NXPGRPH", "PRPGRPH", "NXPAGE", "PRPAGE", "NXHEADING", "PRHEADING"),
        *(f"{way}HEADING{level}" for way in ("NX", "PR") for level in range(1, 7)),
        *("NXLIST", "PRLIST", "NXITEM", "PRITEM", "NXTABLE", "PRTABLE", "NXQUOTE", "PRQUOTE"),
        *("NXLINK", "PRLINK", "FOLLOW", "NXFIGURE", "PRFIGURE"),
        *("INFO", "DESC_CURR_CHAR", "SPEAK_CURR_WORD", "SPELL_CURR_WORD", "SAY_LINE"),
        *("SAY_HEADERS", "CONTRACTED", "SKPBLNKWINS", "PAUSE", "MAPPING", "UNDO"),
        *("AUTOSCROLL", "AUTOSCROLL_FASTER", "AUTOSCROLL_SLOWER"),
        *(
            f"{knob}_{way}"
            for knob in ("TEXTURE", "CONTRAST", "DOT_WIDTH", "DOT_SPACING", "CELL_GAP")
            for way in ("UP", "DOWN")
        ),
    }
)
_COMMANDS: Final = {command.name: command for command in COMMANDS if command.name in ALLOWED}
_MOST_NAMED = 40  # characters of a name that nobody knows


def obey(reader: Reader, asked: PagePress | Turn) -> None:
    """Do what a page asks, as if the reader had pressed a key, or say why it cannot be done."""
    if reader.context is not Context.READING:
        reader.say("live view: not now; what the keys have begun comes first")
        return
    try:
        if isinstance(asked, PagePress):
            _press(reader, asked.command)
        else:
            _turn(reader, asked.knob, asked.value)
    except InputError as error:  # reading goes on
        reader.say(f"live view: {spelled(str(error))}")


def _press(reader: Reader, name: str) -> None:
    command = _COMMANDS.get(name)
    if command is None:
        raise InputError(f"{printable(name[:_MOST_NAMED])} is no command that a page may call")
    command.handler(reader)


def _turn(reader: Reader, name: str, value: float) -> None:
    if name not in KNOBS:
        raise InputError(f"{printable(name[:_MOST_NAMED])} is no knob")
    if not math.isfinite(value):
        raise InputError(f"{KNOBS[name].label} cannot be {value}; it must be a number")
    turn_to(reader, name, value)
