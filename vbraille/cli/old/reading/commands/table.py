"""The commands of a reader: one table of what keys do, from which help and documents are made.

Names are BRLTTY's where it has the command.
"""

from __future__ import annotations

from functools import partial
from operator import methodcaller
from typing import TYPE_CHECKING, Any, Concatenate, ParamSpec

from vbraille.cli.old.reading.keys import (
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
from vbraille.config.options import knobs

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from vbraille.cli.old.reading.commands import (
        control,
        marking,
        moving,
        reporting,
        searching,
        structure,
        turning,
    )
    from vbraille.config.settings import Settings

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
PARAGRAPH, HEADING, LIST, TABLE, QUOTE = "start", "heading", "item", "row", "quote"
EACH_ITEM, LINK, IMAGE = "each item", "link", "image"

_LEVELS = 6
# A command that pages of the live view may call, too. Not what asks for a text, which is typed
# where the reader is; what is kept for another time, and the end of reading, which are the
# reader's; and what only a person beside the device can know, such as that its carriage is at rest.
shared = partial(Command, paged=True)


def calling(
    function: Callable[Concatenate[Any, Given], None], *given: Given.args, **named: Given.kwargs
) -> Callable[[Any], None]:
    """Make a handler that calls a function with the view, and with what is given here."""

    def handler(view: Any) -> None:
        function(view, *given, **named)

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


def _both_ways(
    name: str,
    keys: tuple[tuple[str, ...], tuple[str, ...]],
    goal: str,
    go: Callable[..., None],
    *given: Any,
) -> tuple[Command, Command]:
    """Commands that go to the next of a kind, and to the previous one, by their keys."""
    following, before = keys
    return (
        shared(f"NX{name}", following, f"next {goal}", calling(go, *given, backward=False)),
        shared(f"PR{name}", before, f"previous {goal}", calling(go, *given, backward=True)),
    )


def _levels(*, backward: bool) -> Iterator[Command]:
    """Commands that go by headings down to a level."""
    for level in range(1, _LEVELS + 1):
        goal = f"heading of level {level}" + (" or above" if level > 1 else "")
        keys = (str(level),), (f"alt-{level}",)
        yield _both_ways(
            f"HEADING{level}", keys, goal, partial(structure.go_to, level=level), HEADING
        )[backward]


def _knobs() -> Iterator[Command]:
    """Commands that turn the knobs of the schema."""
    for knob in knobs():
        name = knob.name.upper()
        for at, key in enumerate(knob.keys):
            handler = calling(turning.turn, knob.key, -1 if at else 1)
            yield shared(f"{name}_{'DOWN' if at else 'UP'}", (key,), knob.turns[at], handler)


def _edit(name: str, keys: tuple[str, ...], does: str, method: str, *given: Any) -> Command:
    """Command that calls a method of the prompt, and says what that gives."""
    handler = calling(control.edit, methodcaller(method, *given))
    return Command(name, keys, does, handler, _TYPING)


def ending(doing: str, place: str, typing: tuple[Command, ...] = ()) -> tuple[Command, ...]:
    """Commands that every view has at the end of its table.

    Parameters
    ----------
    doing
        What the view is for, such as "reading".
    place
        Where the carriage is when a device that does not know it is shown it.
    typing
        Commands that edit what is typed; none where nothing is.
    """
    return (
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
            f"stop {doing}",
            control.stop,
            (Context.READING, Context.PLACING, Context.LEARNING),
        ),
        *typing,
        Command(
            "ZERO",
            (ANY,),
            f"the carriage is at {place}, when that is asked for",
            control.set_zero,
            (Context.PLACING,),
        ),
    )


_TYPING = (Context.PROMPT,)
TYPING = (
    Command("ENTER", ("\n",), "take the text that was typed", control.enter, _TYPING),
    Command("GIVE_UP", ("escape",), "forget what was typed", control.give_up, _TYPING),
    _edit("ERASE", ("\x7f", "\b"), "erase the character before", "erase_before"),
    _edit("ERASE_NEXT", ("delete",), "erase the character here", "erase_next"),
    _edit("ERASE_WORD", ("\x17",), "erase the word before", "erase_word"),
    _edit("ERASE_START", ("\x15",), "erase all before", "erase_start"),
    _edit("TYPED_LEFT", ("left",), "one character back", "move", -1),
    _edit("TYPED_RIGHT", ("right",), "one character on", "move", 1),
    _edit("TYPED_START", ("home", "\x01"), "to the start", "move", -LONGEST),
    _edit("TYPED_END", ("end", "\x05"), "to the end", "move", LONGEST),
    _edit(
        "TYPED_EARLIER",
        ("up", "\x10"),
        "the text before, of those typed earlier or listed",
        "bring",
        -1,
    ),
    _edit(
        "TYPED_LATER",
        ("down", "\x0e"),
        "the text after, of those typed earlier or listed",
        "bring",
        1,
    ),
    _edit("SAY_TYPED", ("\t",), "say what is typed so far", "say_typed"),
)
PAUSE = shared("PAUSE", (" ",), "rest the array at once, or go on", control.pause)
COMMANDS = (
    shared("LNDN", ("n", "down"), "next line", calling(moving.go_by_line, 1)),
    shared("LNUP", ("p", "up"), "previous line", calling(moving.go_by_line, -1)),
    shared("FWINRT", ("right",), "on along the line, then the next line", calling(moving.pan, 1)),
    shared(
        "FWINLT", ("left",), "back along the line, then the line before", calling(moving.pan, -1)
    ),
    shared(
        "WINDN", ("]", "ctrl-pagedown"), "next page of the surface", calling(turning.turn_page, 1)
    ),
    shared(
        "WINUP",
        ("[", "ctrl-pageup"),
        "previous page of the surface",
        calling(turning.turn_page, -1),
    ),
    shared("LNBEG", ("home",), "start of the line", moving.line_start),
    shared("LNEND", ("end",), "end of the line", moving.line_end),
    *_both_ways(
        "PGRPH", (("a", "ctrl-down"), ("A", "ctrl-up")), "paragraph", structure.go_to, PARAGRAPH
    ),
    *_both_ways("PAGE", (("f", "pagedown"), ("F", "pageup")), "page", structure.go_to_page),
    *_both_ways("HEADING", (("e",), ("E",)), "heading", structure.go_to, HEADING),
    *_levels(backward=False),
    *_levels(backward=True),
    *_both_ways("LIST", (("l",), ("L",)), "list", structure.go_to, LIST),
    *_both_ways("ITEM", (("I",), ("alt-i",)), "item of a list", structure.go_to, EACH_ITEM),
    *_both_ways("TABLE", (("r",), ("R",)), "table", structure.go_to, TABLE),
    *_both_ways("QUOTE", (("Q",), ("alt-q",)), "quotation", structure.go_to, QUOTE),
    *_both_ways("LINK", (("k",), ("K",)), "link or note", structure.go_to_mark, LINK),
    *_both_ways("FIGURE", ((",",), (";",)), "figure or picture", structure.go_to_mark, IMAGE),
    shared(
        "FOLLOW",
        ("\n",),
        "follow the link or note under the finger; from a note, go back",
        structure.follow,
    ),
    shared("FEEL", ("G",), "feel the figure of this line, alone", structure.feel),
    shared("TOP", ("<", "ctrl-home"), "first line of the text", moving.top),
    shared("BOT", (">", "ctrl-end"), "last line of the text", moving.bottom),
    Command(
        "GOTOLINE", ("g", "\x07"), "go to a page, or to percent of the text", structure.ask_place
    ),
    Command("CONTENTS", ("O",), "list the headings, and go to one", structure.ask_heading),
    shared("BACK", ("b", "alt-left"), "back to the place before the last jump", moving.back),
    Command("NXSEARCH", ("/", "f3"), "search forward for a text", searching.ask_text),
    Command(
        "PRSEARCH",
        ("\\", "f4"),
        "search backward for a text",
        calling(searching.ask_text, backward=True),
    ),
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
    shared("AUTOSCROLL_FASTER", ("+", "f8"), "lines come sooner", calling(turning.change_speed, 1)),
    shared("AUTOSCROLL_SLOWER", ("-", "f7"), "lines come later", calling(turning.change_speed, -1)),
    PAUSE,
    *_knobs(),
    shared("MAPPING", ("#",), "another way to show dots by actuators", turning.change_mapping),
    shared("BESIDE", ("|",), "in the live view: another mapping beside it", turning.show_beside),
    shared("STRAYING", ("=",), "keep the finger on its line, or show all", turning.change_straying),
    shared("BAND_UP", (")",), "leave a line of a page later", calling(turning.turn_band, 1)),
    shared("BAND_DOWN", ("(",), "leave a line of a page sooner", calling(turning.turn_band, -1)),
    shared("UNDO", ("U",), "take back the last change of how braille feels", turning.undo_turn),
    Command("PREFSAVE", ("P",), "save how braille feels", turning.save_settings),
    *ending("reading", "the left stop", TYPING),
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
