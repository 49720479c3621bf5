"""The table of commands: a command is a function with its help and its keys, in one decorator.

A function takes the exploration that it works on: a book, a picture, a game or a tuning course.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Flag, auto
from functools import partial
from importlib import import_module
from typing import TYPE_CHECKING, Any

from vbraille.errors import InputError
from vbraille.wording import nearest

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping


class Where(Flag):
    """Things that a command can be called on."""

    BOOK = auto()
    PICTURE = auto()
    FIGURE = auto()
    """A picture of a book, felt in place of the text."""
    GAME = auto()
    TUNING = auto()
    SCREEN = auto()
    ANYWHERE = BOOK | PICTURE | FIGURE | GAME | TUNING | SCREEN


@dataclass(frozen=True, slots=True)
class Command:
    """A command.

    Parameters
    ----------
    name
        Name of its function with hyphens, such as "next-heading".
    run
        The function.
    help
        Phrase for what it does, such as "next heading".
    keys, nvda
        Keys of the usual set, and of NVDA's browse mode.
    where
        Things that it can be called on.
    also
        Buttons of the device ("button:1") and keys of a conventional display ("pins:LNDN").
    first
        Whether it is among those that help names.
    steers
        Whether pages of the live view offer it.
    """

    name: str
    run: Callable[[Any], None]
    help: str
    keys: tuple[str, ...]
    nvda: tuple[str, ...]
    where: Where
    also: tuple[str, ...] = ()
    first: bool = False
    steers: bool = False


_COMMANDS: list[Command] = []
_MODULES = {
    Where.BOOK: ("moving", "structure", "searching", "feeling"),
    Where.PICTURE: ("picture",),
    Where.FIGURE: ("picture",),
    Where.GAME: ("game",),
    Where.TUNING: ("tuning",),
    Where.SCREEN: ("screen", "feeling"),
}
_SPOKEN = {
    " ": "space", ",": "comma", ";": "semicolon", ".": "full stop", "/": "slash",
    "\\": "backslash", "'": "apostrophe", "<": "less than", ">": "greater than", "+": "plus",
    "-": "minus", "#": "number sign", "?": "question mark", "=": "equals", "|": "bar",
    "(": "left parenthesis", ")": "right parenthesis", "[": "left bracket", "]": "right bracket",
    "{": "left brace", "}": "right brace",
}  # fmt: skip
WAYS = {"right": (1, 0), "left": (-1, 0), "down": (0, 1), "up": (0, -1)}
_TYPED = {name: key for key, name in _SPOKEN.items()}


def command(
    help: str,  # noqa: A002 - as the field is called
    keys: str,
    nvda: str = "",
    *,
    where: Where = Where.BOOK,
    also: str = "",
    first: bool = False,
    steers: bool = False,
    name: str = "",
) -> Callable:
    """Put a function into the table.

    Keys are separated by blanks; "space" is the space bar. Without NVDA's, they are the same.
    """

    def decorate(function: Callable[[Any], None]) -> Callable[[Any], None]:
        own = tuple(key.replace("space", " ") for key in keys.split())
        made = (own, tuple(nvda.split()) or own, where, tuple(also.split()), first, steers)
        _COMMANDS.append(Command(name or _named(function), function, help, *made))
        return function

    return decorate


def both_ways(
    thing: str | tuple[str, str],
    keys: str,
    nvda: str = "",
    also: str = "",
    *,
    name: str = "",
    first: bool = False,
    **how: Any,
) -> Callable:
    """Put two commands into the table: to the next of a thing, and to the previous.

    Two phrases of help instead of a thing are of any two ways, and have two names. The function
    takes the step, 1 or -1, too. Keys before a bar go on.
    """
    helps = (f"next {thing}", f"previous {thing}") if isinstance(thing, str) else thing

    def decorate(function: Callable[..., None]) -> Callable[..., None]:
        called = name or _named(function)
        names = called.split() if " " in called else [f"next-{called}", f"previous-{called}"]
        for half, step in enumerate((1, -1)):
            own, other, more = (each.partition("|")[2 * half] for each in (keys, nvda, also))
            told = {**how, "first": first and not half, "name": names[half], "also": more}
            command(helps[half], own, other, **told)(partial(function, step=step))
        return function

    return decorate


def _named(function: Callable) -> str:
    return function.__name__.strip("_").replace("_", "-")


def table(where: Where) -> list[Command]:
    """Commands for something, what all have first, in an order that no other import changes."""
    modules = [f"vbraille.reading.{name}" for name in ("explored", *_MODULES[where])]
    for module in modules:
        import_module(module)
    found = [each for each in _COMMANDS if each.where & where]
    return sorted(found, key=lambda each: modules.index(_module(each.run)))


def _module(function: Any) -> str:
    """Name of the module of a function, or of the function of a partial."""
    return getattr(function, "func", function).__module__


def keys_of(each: Command, key_set: str) -> tuple[str, ...]:
    """Keys of a command in a set, "usual" or "nvda"."""
    return each.nvda if key_set == "nvda" else each.keys


def bindings(
    key_set: str, where: Where, own: Mapping[str, str] | None = None
) -> dict[str, Command]:
    """Commands by their keys, of those that can be called here.

    Parameters
    ----------
    key_set
        Set of keys, "usual" or "nvda".
    where
        What they are called on.
    own
        Names of commands by keys of one's own (`own_keys`), which win over the set.
    """
    own = own or {}
    commands = {each.name: each for each in table(where)}
    replaced = {name for key, name in own.items() if ":" not in key}
    found = {
        key: each
        for each in commands.values()
        for key in (() if each.name in replaced else keys_of(each, key_set)) + each.also
    }
    return found | {key: commands[name] for key, name in own.items() if name in commands}


def own_keys(keys: Mapping[str, Any], buttons: Mapping[str, Any]) -> dict[str, str]:
    """Names of commands by keys, from the tables ``[keys]`` and ``[buttons]`` of a settings file.

    Raises
    ------
    InputError
        If there is no such command, or a key is given to two.
    """
    names = {each.name for each in table(Where.BOOK)}
    found: dict[str, str] = {}
    for name, given in keys.items():
        _check_command(name, names, "[keys]")
        for key in [given] if isinstance(given, str) else given:
            if found.setdefault(typed(key), name) != name:
                raise InputError(f"[keys] gives {key!r} to {found[typed(key)]} and to {name}")
    for button, name in buttons.items():
        kind, _, number = button.rpartition(" ")
        if kind == "knob":
            _check_command(name, ("texture", "contrast"), f"[buttons] {button!r}")
        else:
            _check_command(name, names, "[buttons]")
        prefix = {"": "button", "display": "pins"}.get(kind, kind)
        found[f"{prefix}:{number}"] = name
    return found


def _check_command(name: str, names: Any, where: str) -> None:
    if name not in names:
        raise InputError(f"settings: {where} has no command {name!r}{nearest(str(name), names)}")


def spoken(key: str) -> str:
    """Name of a key as it is said: "shift-e" for "E", "button 1" for "button:1"."""
    if key in _SPOKEN:
        return _SPOKEN[key]
    if len(key) == 1 and key.isupper():
        return f"shift-{key.lower()}"
    return key if len(key) < 3 else key.replace("pins:", "display ").replace(":", " ")


def typed(name: str) -> str:
    """Key of a name as it is said or written in a settings file; see `spoken`."""
    if len(name) == len("shift-a") and name.startswith("shift-"):
        return name[-1].upper()
    return _TYPED.get(name, name)
