"""The commands of a reader: one table of what keys do, from which help and documents are made.

Names are BRLTTY's where it has the command.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any, ParamSpec

from vbraille.config.options import knobs
from vbraille.reading.keys import (
    ANY,
    LONGEST,
    TURNED,
    Bindings,
    Bound,
    Command,
    Context,
    bind,
    call,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from vbraille.config.settings import Settings
    from vbraille.reading.commands import (
        control,
        marking,
        moving,
        reporting,
        searching,
        structure,
        turning,
    )

Given = ParamSpec("Given")


class Deferred:
    """A module beside this one, of which only functions are known that load it when called.

    What the commands are called and what their keys do is asked for by help, which shall not wait
    for all that reading needs.

    Parameters
    ----------
    name
        Name of the module, such as "moving".
    """

    def __init__(self, name: str) -> None:
        self._module = f"{__package__}.{name}"

    def __getattr__(self, name: str) -> Callable[..., Any]:
        """Give the function of a name, whether or not there is one."""
        return partial(call, self._module, name)


if not TYPE_CHECKING:
    control, marking, moving = map(Deferred, ("control", "marking", "moving"))
    reporting, searching = map(Deferred, ("reporting", "searching"))
    structure, turning = map(Deferred, ("structure", "turning"))

# Kinds of blocks, and of what is in them.
HEADING, LIST, TABLE, QUOTE = "heading", "item", "row", "quote"
EACH_ITEM, LINK, IMAGE = "each item", "link", "image"

_LEVELS = 6
# A command that pages of the live view may call, too. Not what asks for a text, which is typed
# where the reader is; what is kept for another time, and the end of reading, which are the
# reader's; and what only a person beside the device can know, such as that its carriage is at rest.
shared = partial(Command, paged=True)


def made(
    make: Callable[Given, Callable[[Any], None]], *given: Given.args, **named: Given.kwargs
) -> Callable[[Any], None]:
    """Give a command that is made, of a function and what it is given, when it is called."""

    def handler(reader: Any) -> None:
        make(*given, **named)(reader)

    return handler


def bound_for(settings: Settings, keys: str | None = None) -> Bound:
    """Give the commands the keys and buttons of a settings file.

    Parameters
    ----------
    settings
        Settings of the file.
    keys
        Name of the ready set of keys; None for the one of the settings.

    Raises
    ------
    InputError
        If a command is not known, a key would call two commands, or a button is none.
    """
    ready = keys or settings.read.get("keys", "usual")
    return bound_by(Bindings(settings.keys, settings.buttons, settings.where), ready)


def bound_by(bindings: Bindings, keys: str = "usual") -> Bound:
    """Give the commands the keys and buttons of a user.

    Parameters
    ----------
    bindings
        Keys and buttons of the settings, which come before those of the set.
    keys
        Name of a ready set of keys, one of `KEY_SETS`.

    Raises
    ------
    InputError
        If a command is not known, a key would call two commands, or a button is none.
    """
    ready = bind(COMMANDS, Bindings(KEY_SETS[keys])).commands
    return bind(ready, bindings, tuple(TURNED))


def _levels(*, backward: bool) -> tuple[Command, ...]:
    """Commands that go by headings down to a level."""
    return tuple(
        shared(
            f"{'PR' if backward else 'NX'}HEADING{level}",
            (f"alt-{level}" if backward else str(level),),
            f"{'previous' if backward else 'next'} heading of level {level}"
            + (" or above" if level > 1 else ""),
            made(structure.go_to, HEADING, backward=backward, level=level),
        )
        for level in range(1, _LEVELS + 1)
    )


def _knobs() -> Iterator[Command]:
    """Commands that turn the knobs of the schema."""
    for knob in knobs():
        name = knob.name.upper()
        for at, key in enumerate(knob.keys):
            turned = made(turning.turn, knob.key, -1 if at else 1)
            yield shared(f"{name}_{'DOWN' if at else 'UP'}", (key,), knob.turns[at], turned)


_TYPING = (Context.PROMPT,)
TYPING = (
    Command("ENTER", ("\n",), "take the text that was typed", control.enter, _TYPING),
    Command("GIVE_UP", ("escape",), "forget what was typed", control.give_up, _TYPING),
    Command("ERASE", ("\x7f", "\b"), "erase the character before", control.erase, _TYPING),
    Command("ERASE_NEXT", ("delete",), "erase the character here", control.erase_next, _TYPING),
    Command("ERASE_WORD", ("\x17",), "erase the word before", control.erase_word, _TYPING),
    Command("ERASE_START", ("\x15",), "erase all before", control.erase_start, _TYPING),
    Command("TYPED_LEFT", ("left",), "one character back", made(control.move, -1), _TYPING),
    Command("TYPED_RIGHT", ("right",), "one character on", made(control.move, 1), _TYPING),
    Command("TYPED_START", ("home", "\x01"), "to the start", made(control.move, -LONGEST), _TYPING),
    Command("TYPED_END", ("end", "\x05"), "to the end", made(control.move, LONGEST), _TYPING),
    Command(
        "TYPED_EARLIER",
        ("up", "\x10"),
        "the text before, of those typed earlier or listed",
        made(control.bring, -1),
        _TYPING,
    ),
    Command(
        "TYPED_LATER",
        ("down", "\x0e"),
        "the text after, of those typed earlier or listed",
        made(control.bring, 1),
        _TYPING,
    ),
    Command("SAY_TYPED", ("\t",), "say what is typed so far", control.say_typed, _TYPING),
)
COMMANDS = (
    shared("LNDN", ("n", "down"), "next line", moving.next_line),
    shared("LNUP", ("p", "up"), "previous line", moving.previous_line),
    shared("FWINRT", ("right",), "on along the line, then the next line", moving.pan_right),
    shared("FWINLT", ("left",), "back along the line, then the line before", moving.pan_left),
    shared("WINDN", ("]", "ctrl-pagedown"), "next page of the surface", turning.next_page),
    shared("WINUP", ("[", "ctrl-pageup"), "previous page of the surface", turning.previous_page),
    shared("LNBEG", ("home",), "start of the line", moving.line_start),
    shared("LNEND", ("end",), "end of the line", moving.line_end),
    shared("NXPGRPH", ("a", "ctrl-down"), "next paragraph", structure.next_paragraph),
    shared("PRPGRPH", ("A", "ctrl-up"), "previous paragraph", structure.previous_paragraph),
    shared("NXPAGE", ("f", "pagedown"), "next page", structure.next_page),
    shared("PRPAGE", ("F", "pageup"), "previous page", structure.previous_page),
    shared("NXHEADING", ("e",), "next heading", made(structure.go_to, HEADING)),
    shared("PRHEADING", ("E",), "previous heading", made(structure.go_to, HEADING, backward=True)),
    *_levels(backward=False),
    *_levels(backward=True),
    shared("NXLIST", ("l",), "next list", made(structure.go_to, LIST)),
    shared("PRLIST", ("L",), "previous list", made(structure.go_to, LIST, backward=True)),
    shared("NXITEM", ("I",), "next item of a list", made(structure.go_to, EACH_ITEM)),
    shared(
        "PRITEM",
        ("alt-i",),
        "previous item of a list",
        made(structure.go_to, EACH_ITEM, backward=True),
    ),
    shared("NXTABLE", ("r",), "next table", made(structure.go_to, TABLE)),
    shared("PRTABLE", ("R",), "previous table", made(structure.go_to, TABLE, backward=True)),
    shared("NXQUOTE", ("Q",), "next quotation", made(structure.go_to, QUOTE)),
    shared(
        "PRQUOTE", ("alt-q",), "previous quotation", made(structure.go_to, QUOTE, backward=True)
    ),
    shared("NXLINK", ("k",), "next link or note", made(structure.go_to_mark, LINK)),
    shared(
        "PRLINK", ("K",), "previous link or note", made(structure.go_to_mark, LINK, backward=True)
    ),
    shared("NXFIGURE", (",",), "next figure or picture", made(structure.go_to_mark, IMAGE)),
    shared(
        "PRFIGURE",
        (";",),
        "previous figure or picture",
        made(structure.go_to_mark, IMAGE, backward=True),
    ),
    shared(
        "FOLLOW",
        ("\n",),
        "follow the link or note under the finger; from a note, go back",
        structure.follow,
    ),
    Command("FEEL", ("G",), "feel the figure of this line, alone", structure.feel),
    shared("TOP", ("<", "ctrl-home"), "first line of the text", moving.top),
    shared("BOT", (">", "ctrl-end"), "last line of the text", moving.bottom),
    Command(
        "GOTOLINE", ("g", "\x07"), "go to a page, or to percent of the text", structure.ask_place
    ),
    Command("CONTENTS", ("O",), "list the headings, and go to one", structure.ask_heading),
    shared("BACK", ("b", "alt-left"), "back to the place before the last jump", moving.back),
    Command("NXSEARCH", ("/", "f3"), "search forward for a text", searching.search_forward),
    Command("PRSEARCH", ("\\", "f4"), "search backward for a text", searching.search_backward),
    Command("SEARCH_AGAIN", (".",), "search again in the same direction", searching.search_again),
    Command("ACCENTS", ("'",), "let accents matter in a search, or not", searching.fold_accents),
    Command("CANCEL", ("escape",), "give the search up", searching.cancel),
    Command("SETMARK", ("m",), "set a bookmark with a name", marking.ask_mark),
    Command("QUICKMARK", ("M",), "set a bookmark with a number", marking.quick_mark),
    Command("GOTOMARK", ("o",), "go to a bookmark", marking.ask_way),
    Command("SAY_MARKS", ("B",), "say the bookmarks", marking.say_marks),
    Command("DELMARK", ("delete", "X"), "delete a bookmark", marking.ask_deletion),
    shared("INFO", ("i",), "say line, page, percent, heading, words left", reporting.say_place),
    shared("DESC_CURR_CHAR", ("u",), "say what is under the finger", reporting.say_character),
    shared("SPEAK_CURR_WORD", ("w",), "say the word under the finger", reporting.say_word),
    shared("SPELL_CURR_WORD", ("W",), "spell the word under the finger", reporting.spell_word),
    shared("SAY_LINE", ("V", "f5"), "say the line again", reporting.say_line),
    shared("SAY_HEADERS", ("H",), "say the headers of the table", reporting.say_headers),
    shared("CONTRACTED", ("x",), "contracted braille, or uncontracted", turning.contracted),
    Command("LANGUAGE", ("y",), "translate by the table of a language", turning.ask_language),
    shared("SKPBLNKWINS", ("z",), "pass over blank lines, or read them", turning.skip_blank),
    shared("AUTOSCROLL", ("v", "f6"), "lines come by time, or no longer", turning.scroll),
    shared("AUTOSCROLL_FASTER", ("+", "f8"), "lines come sooner", turning.faster),
    shared("AUTOSCROLL_SLOWER", ("-", "f7"), "lines come later", turning.slower),
    shared("PAUSE", (" ",), "rest the array at once, or go on", control.pause),
    *_knobs(),
    shared("MAPPING", ("#",), "another way to show dots by actuators", turning.change_mapping),
    shared("STRAYING", ("=",), "keep the finger on its line, or show all", turning.change_straying),
    shared("BAND_UP", (")",), "leave a line of a page later", made(turning.turn_band, 1)),
    shared("BAND_DOWN", ("(",), "leave a line of a page sooner", made(turning.turn_band, -1)),
    shared("UNDO", ("U",), "take back the last change of how braille feels", turning.undo_turn),
    Command("PREFSAVE", ("P",), "save how braille feels", turning.save_settings),
    Command("HELP", ("h", "f1"), "say the keys", control.say_keys),
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
        "stop reading",
        control.stop,
        (Context.READING, Context.PLACING, Context.LEARNING),
    ),
    *TYPING,
    Command(
        "ZERO",
        (ANY,),
        "the carriage is at the left stop, when that is asked for",
        control.set_zero,
        (Context.PLACING,),
    ),
)
# Ready sets of keys, each for what it does not leave as it is. NVDA's are those of its browse mode;
# what its letters did moves to others that its users do not know as something else.
KEY_SETS: dict[str, dict[str, tuple[str, ...]]] = {
    "usual": {},
    "nvda": {
        **{
            f"{way}{kind}": (shift(letter),)
            for kind, letter in {
                "HEADING": "h",
                "LIST": "l",
                "ITEM": "i",
                "TABLE": "t",
                "FIGURE": "g",
                "QUOTE": "q",
            }.items()
            for way, shift in (("NX", str.lower), ("PR", str.upper))
        },
        "LNDN": ("down",),
        "LNUP": ("up",),
        "NXLINK": ("k", "tab"),
        "PRLINK": ("K", "shift-tab"),
        "NXPGRPH": ("p", "ctrl-down"),
        "PRPGRPH": ("P", "ctrl-up"),
        "CONTENTS": ("f7",),
        "NXSEARCH": ("ctrl-f", "/"),
        "SEARCH_AGAIN": ("f3", "."),
        "FEEL": ("E",),
        "INFO": ("delete",),
        "DELMARK": ("X",),
        "SAY_HEADERS": ("e",),
        "PREFSAVE": ("ctrl-w",),
        "TEXTURE_UP": ("r",),
        "TEXTURE_DOWN": ("R",),
        "QUIT": ("ctrl-x", "ctrl-d"),
    },
}
BOUND = bound_by(Bindings())
