"""What can be told to a reader, and which keys and buttons say it."""

from __future__ import annotations

import re
from dataclasses import dataclass, field, replace
from enum import Enum
from typing import TYPE_CHECKING, Any

from vbraille.errors import InputError
from vbraille.reading.keys import HELD, NAMED
from vbraille.wording import nearest

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

ANY = "any key"
# Signs by their names, as speech may pass over the signs themselves.
_SIGNS = {
    ".": "full stop",
    ",": "comma",
    ";": "semicolon",
    ":": "colon",
    "!": "exclamation mark",
    "?": "question mark",
    "'": "apostrophe",
    '"': "quotation mark",
    "`": "grave accent",
    "/": "slash",
    "\\": "backslash",
    "|": "bar",
    "-": "minus",
    "_": "underscore",
    "+": "plus",
    "*": "star",
    "=": "equals",
    "<": "less than",
    ">": "greater than",
    "(": "left parenthesis",
    ")": "right parenthesis",
    "[": "left bracket",
    "]": "right bracket",
    "{": "left brace",
    "}": "right brace",
    "#": "number sign",
    "%": "percent",
    "&": "ampersand",
    "@": "at sign",
    "$": "dollar",
    "^": "circumflex",
    "~": "tilde",
    " ": "space",
    "\n": "enter",
    "\r": "return",
    "\t": "tab",
    "\x7f": "backspace",
    "\0": "ctrl-space",
    "backtab": "shift-tab",
}
_CONTROLS = {chr(n): f"ctrl-{chr(96 + n)}" for n in range(1, 27)}
_CONTROLS |= {chr(28 + n): f"ctrl-{_SIGNS[sign]}" for n, sign in enumerate("\\]^_")}
_SPOKEN = _CONTROLS | _SIGNS
_TYPED = {name: key for names in (_CONTROLS, _SIGNS) for key, name in names.items()}
_HELD_KEY = re.compile(rf"((?:{'|'.join(HELD)})*)(.+)", re.DOTALL | re.IGNORECASE)
_DISPLAY_KEY = re.compile(r"display ([A-Za-z][A-Za-z0-9_]*)")
# Commands of BRLTTY that are a little more than one of ours, and go by its name.
NEARLY = {
    "TOP_LEFT": "TOP",
    "BOT_LEFT": "BOT",
    "WINUP": "LNUP",
    "WINDN": "LNDN",
    "PRDIFLN": "LNUP",
    "NXDIFLN": "LNDN",
    "FWINLTSKIP": "FWINLT",
    "FWINRTSKIP": "FWINRT",
}
_DEVICE_KEY = re.compile(r"(?:(button|knob) )?([1-9][0-9]{0,2})")


class Context(Enum):
    """What a reader is doing, which decides what each key stands for."""

    READING = "reading"
    """A line is under the hand."""
    PLACING = "placing"
    """The device waits to be told that its carriage is at the left stop."""
    PROMPT = "typing"
    """A text is being typed, such as what to look for."""
    LEARNING = "learning"
    """A key says what it does, and does nothing."""


@dataclass(frozen=True, slots=True)
class Command:
    """Something that a reader can be told to do by a key.

    Parameters
    ----------
    name
        Name in documents and settings, in capitals as BRLTTY has it.
    keys
        Keys that call the command, as `vbraille.reading.keys` names them; `ANY` for every key that
        calls no other command of the context.
    help
        What the command does, in words for its users.
    handler
        Function that does it, which is given the `vbraille.reading.reader.Reader`.
    contexts
        Contexts in which the command can be called.
    paged
        Whether a page of the live view may call it, too.
    """

    name: str
    keys: tuple[str, ...]
    help: str
    # A reader knows its bindings, so that naming its type here would be a circle.
    handler: Callable[[Any], None]
    contexts: tuple[Context, ...] = (Context.READING,)
    paged: bool = False

    @property
    def spoken_keys(self) -> str:
        """Names of the command's keys as people say them."""
        return " or ".join(map(spoken, self.keys)) or "no key"


@dataclass(frozen=True, slots=True)
class Bindings:
    """Keys and buttons as somebody's settings have them.

    Parameters
    ----------
    keys
        Keys of commands, by the command's name, which then has these and no others; a command that
        is not named keeps its own keys. "space", "enter", "tab" and "backspace" name those keys.
    buttons
        Names of commands, by the button of the device: "1" or "button 1". "knob 1" names the value
        of the tuning that a knob turns, such as "CONTRAST". "display HOME" is a key of a
        conventional display, by BRLTTY's name for it.
    where
        Function that tells where the settings have a value, by its table and its key.
    """

    keys: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    buttons: Mapping[str, str] = field(default_factory=dict)
    where: Callable[[str, str], str] = lambda *_: "settings"


@dataclass(frozen=True, slots=True)
class Bound:
    """Commands with the keys and buttons that call them.

    Parameters
    ----------
    commands
        All commands, each with its keys.
    buttons
        The command of each button of the device that has one, by the button's number.
    knobs
        The value of the tuning that each knob of the device turns, by the knob's number.
    display_keys
        The command of each key of a conventional display that has one, by BRLTTY's name for it.
    """

    commands: tuple[Command, ...]
    buttons: Mapping[int, Command]
    knobs: Mapping[int, str]
    _by_key: Mapping[tuple[Context, str], Command]
    display_keys: Mapping[str, Command] = field(default_factory=dict)

    def of(self, context: Context) -> Iterator[Command]:
        """Commands that can be called in a context."""
        return (command for command in self.commands if context in command.contexts)

    def keys_of(self, name: str) -> tuple[str, ...]:
        """Keys of a command as people say them; none if it has none."""
        return next((tuple(map(spoken, c.keys)) for c in self.commands if c.name == name), ())

    def find(self, key: str, context: Context) -> Command | None:
        """Command that a key calls in a context; None if it calls none."""
        return self._by_key.get((context, key)) or self._by_key.get((context, ANY))


def bind(commands: tuple[Command, ...], bindings: Bindings, turned: tuple[str, ...] = ()) -> Bound:
    """Give commands the keys and buttons of somebody's settings.

    Parameters
    ----------
    commands
        All commands with their usual keys.
    bindings
        What the settings say.
    turned
        Names that a knob may have.

    Raises
    ------
    InputError
        If a command or a key is not known, a key would call two commands, or a button is none.
    """
    by_name = {command.name: command for command in commands}
    for name in bindings.keys:
        _check_name(name, by_name, bindings.where("keys", name))
    given = {
        name: tuple(_sent(key, bindings.where("keys", name)) for key in keys)
        for name, keys in bindings.keys.items()
    }
    taken = {
        (context, key)
        for name, keys in given.items()
        for context in by_name[name].contexts
        for key in keys
    }
    bound = tuple(
        replace(
            command,
            keys=given[command.name]
            if command.name in given
            else tuple(
                key for key in command.keys if taken.isdisjoint((c, key) for c in command.contexts)
            ),
        )
        for command in commands
    )
    by_key: dict[tuple[Context, str], Command] = {}
    for command in bound:
        for context in command.contexts:
            for key in command.keys:
                other = by_key.setdefault((context, key), command)
                if other is not command or command.keys.count(key) > 1:
                    raise InputError(
                        f"{bindings.where('keys', command.name)}: "
                        f"key {spoken(key)} calls both {other.name} and {command.name}; "
                        f"give each key to one command"
                    )
    if not any(command.keys for command in bound if command.name == "QUIT"):
        where = bindings.where("keys", "QUIT")
        raise InputError(f"{where}: no key calls QUIT; give it one, or reading cannot be stopped")
    named = {command.name: command for command in bound}
    buttons, knobs = _buttons(bindings, named, turned)
    return Bound(bound, buttons, knobs, by_key, _display_keys(bindings, named))


def _buttons(
    bindings: Bindings, by_name: Mapping[str, Command], turned: tuple[str, ...]
) -> tuple[dict[int, Command], dict[int, str]]:
    """Commands of buttons, and values of knobs, by their numbers."""
    buttons: dict[int, Command] = {}
    knobs: dict[int, str] = {}
    for key, name in bindings.buttons.items():
        if _DISPLAY_KEY.fullmatch(key.strip()):
            continue
        where = bindings.where("buttons", key)
        found = _DEVICE_KEY.fullmatch(key.strip().lower())
        if found is None:
            raise InputError(
                f'{where}: {key!r} is no button; write a number such as "1", or "knob 1", or '
                f'"display HOME"'
            )
        if found[1] == "knob":
            _check_name(name, turned, where)
            knobs[int(found[2])] = name
        else:
            _check_name(name, by_name, where)
            buttons[int(found[2])] = by_name[name]
    return buttons, knobs


def _display_keys(bindings: Bindings, by_name: Mapping[str, Command]) -> dict[str, Command]:
    """Commands of a conventional display's keys, by BRLTTY's names for these."""
    keys = {**by_name, **{key: by_name[name] for key, name in NEARLY.items() if name in by_name}}
    for key, name in bindings.buttons.items():
        found = _DISPLAY_KEY.fullmatch(key.strip())
        if found is not None:
            _check_name(name, by_name, bindings.where("buttons", key))
            keys[found[1].upper()] = by_name[name]
    return keys


def _sent(name: str, where: str) -> str:
    """Name that a key has when it is typed, by the one that somebody wrote."""
    if len(name) == 1 or name == ANY:
        return name
    if name.lower() in _TYPED:
        return _TYPED[name.lower()]
    written, key = _held(name)
    held = "".join(word for word in HELD if word in written.lower())
    if key.lower() in NAMED:
        return f"{held}{key.lower()}"
    character = _TYPED.get(key.lower(), key)
    if "shift-" in held and len(character) == 1 and len(character.upper()) == 1:
        held, character = held.replace("shift-", ""), character.upper()
    if held in ("", "alt-") and len(character) == 1:
        return f"{held}{character}"
    if held in ("ctrl-", "alt-ctrl-") and f"ctrl-{key.lower()}" in _TYPED:
        return f"{held.removesuffix('ctrl-')}{_TYPED[f'ctrl-{key.lower()}']}"
    near = nearest(key.lower(), NAMED if held else (*sorted(NAMED), *_TYPED))
    near = near or '; write a character, or a name such as "down" or "ctrl-n"'
    raise InputError(f"{where}: there is no key {name!r}{near}")


def _check_name(name: str, names: Mapping[str, Command] | tuple[str, ...], where: str) -> None:
    if name not in names:
        kind = "value of the tuning" if isinstance(names, tuple) else "command"
        raise InputError(f"{where}: there is no {kind} {name!r}{nearest(name.upper(), names)}")


def spoken(key: str, *, typed: bool = False) -> str:
    r"""Name of a key as people say it, and speech as well; settings take it, too.

    Parameters
    ----------
    key
        Key, as `vbraille.reading.keys` names it.
    typed
        Whether it stands for the character that it types, and not for what is pressed.

    >>> spoken("."), spoken("A"), spoken("\x0c"), spoken("alt-,")
    ('full stop', 'shift-a', 'ctrl-l', 'alt-comma')
    """
    held, name = _held(key)
    if name in _SPOKEN:
        name = _SPOKEN[name]
    elif len(name) == 1 and name.lower() != name and len(name.lower()) == 1:
        name = f"capital {name}" if typed else f"shift-{name.lower()}"
    elif len(name) == 1 and not name.isprintable():
        name = f"character {ord(name):04x}"
    return held + name


def _held(key: str) -> tuple[str, str]:
    """Words for what is held with a key, and the key."""
    found = _HELD_KEY.fullmatch(key)
    return ("", key) if found is None else (found[1], found[2])
