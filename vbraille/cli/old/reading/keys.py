"""Keys: as a terminal sends them, however it is cut into reads, and the commands that they call.

A terminal sends characters, and escape sequences for the keys that are none. Both may come in
pieces: what is unfinished is kept until the rest comes.
"""

from __future__ import annotations

import codecs
import re
from dataclasses import dataclass, field, replace
from enum import Enum
from importlib import import_module
from typing import TYPE_CHECKING, Any

from vbraille.errors import InputError
from vbraille.wording import nearest

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

PASTE = "paste:"  # before the first line of a pasted text, the two of which stand for one key
PASTE_REST = "paste, rest:"  # before more of that line, which comes when it was taken for all
ESC, ESCAPE = "\x1b", "escape"
PASTE_ON, PASTE_OFF = b"\x1b[?2004h", b"\x1b[?2004l"  # switch marks around pasted text on and off
# An Escape that nothing follows for so long is the key Escape: a slow line may take as long to
# bring the rest of an arrow, and readline waits as long (keyseq-timeout).
ESCAPE_S = 0.5
_ALT_S = 0.05  # what comes later than this after an Escape, and goes on no sequence, is a key alone
BROKEN_S = 1.0  # the rest of a sequence or of a paste does not come so long after its last byte
# So many different characters in one read are no typing: they are a paste that is not marked.
BURST = 20
_BURST_S = 0.1  # what comes so soon after such a paste belongs to it
_LONGEST = 64  # characters of a sequence; a longer one is none
_LONGEST_PASTE = 1_000  # characters that are kept of one
_LINE_END = re.compile(r"[\n\r]")

# The one table of sequences (ECMA-48 5.4, xterm, the Linux console, tmux, PuTTY, rxvt). The end of
# a sequence names the key, or the number before a ~ does; a number after a semicolon says what was
# held with it.
_LETTERS = {
    "A": "up",
    "B": "down",
    "C": "right",
    "D": "left",
    "F": "end",
    "H": "home",
    "P": "f1",
    "Q": "f2",
    "R": "f3",
    "S": "f4",
    "Z": "backtab",
    **{f"[{letter}": f"f{n}" for n, letter in enumerate("ABCDE", 1)},
}
_NUMBERS = {
    **dict(enumerate(("home", "insert", "delete", "end", "pageup", "pagedown", "home", "end"), 1)),
    **{number: f"f{n}" for n, number in enumerate((*range(11, 16), *range(17, 22), 23, 24), 1)},
    **{number: f"f{n}" for n, number in enumerate((25, 26, 28, 29, 31, 32, 33, 34), 13)},
}
_ARROWS = frozenset("ABCD")
# After ESC O only: what PuTTY sends as a VT100+ for more function keys, and rxvt with Ctrl.
_SINGLE = {
    **{letter: f"f{n}" for n, letter in enumerate("TUVWXYZ", 5)},
    **{letter.lower(): f"ctrl-{_LETTERS[letter]}" for letter in "ABCD"},
}
_PASTE_BEGINS, _PASTE_ENDS = 200, "\x1b[201~"
HELD = ("shift-", "alt-", "ctrl-", "meta-")  # one for each bit of the number less 1

NAMED = frozenset((*_LETTERS.values(), *_NUMBERS.values(), ESCAPE))  # keys that have words

_KEY = re.compile(
    r"\x1b(?:\[(?P<first>[0-9]{0,4})(?:;(?P<held>[0-9]{1,4}))?(?P<end>\[[A-E]|[@-Z\\-~])"
    r"|O(?P<letter>[!-~])"
    r"|\[[0-?]*[ -/]*[@-Z\\-~]"  # other sequences, as a whole
    r"|(?P<alt>[^\x1b\[O]))"
    r"|(?P<character>[^\x1b])",
    re.DOTALL,
)
_BEGUN = re.compile(r"\x1b(?:\[(?:\[|[0-?]*[ -/]*)|O)?")


def pasted(key: str) -> str | None:
    """First line of a pasted text, or the rest of that; None for a key that was typed."""
    for prefix in (PASTE, PASTE_REST):
        if key.startswith(prefix):
            return key.removeprefix(prefix)
    return None


class _FirstLine:
    """First line of a text that comes in pieces; no more than anybody types is kept of it."""

    def __init__(self) -> None:
        self.text = ""
        self._ended = False

    def add(self, piece: str) -> str:
        """Take a piece of the text, and give what of it belongs to the line."""
        if self._ended:
            return ""
        line = _LINE_END.split(piece, maxsplit=1)
        self._ended = len(line) > 1
        more = line[0][: _LONGEST_PASTE - len(self.text)]
        self.text += more
        return more


class Keys:
    """Names of keys out of a terminal's bytes.

    A character is its own name. Arrows, function keys and the like have words, what was held
    with them before: "up", "ctrl-right", "f5", "alt-x". "escape" is the key alone. A whole pasted
    text is one key that begins with `PASTE`; see `pasted`. Sequences that are not in the table
    give nothing.
    """

    def __init__(self) -> None:
        self._decoder = codecs.getincrementaldecoder("utf-8")("ignore")
        self._tail = ""
        self._pasting = False
        self._pasted = _FirstLine()
        self._plain_arrows = False  # whether an arrow came as ESC [, as it does by itself
        self._apart = False  # whether the rest of a sequence came later than its Escape
        self._fed_s = 0.0
        self._burst_end_s = float("-inf")

    def feed(self, typed: bytes, now_s: float) -> list[str]:
        """Names of the keys that these bytes, which came now, complete."""
        late, self._fed_s = now_s - self._fed_s >= _ALT_S, now_s
        more = self._decoder.decode(typed)
        keys: list[str] = []
        if self._tail == ESC and more:
            self._apart = late
            if late and more[0] not in "[O":
                keys, self._tail = [ESCAPE], ""
        self._tail += more
        keys += self._take()
        plain = [key for key in keys if len(key) == 1]
        within = now_s < self._burst_end_s
        if not within and (len(plain) < BURST or len(set(plain)) == 1):
            return keys
        self._burst_end_s = now_s + _BURST_S
        if not within:
            self._pasted = _FirstLine()
        more = self._pasted.add("".join(plain))
        if not within:
            return [PASTE + more]
        return [PASTE_REST + more] if more else []

    def wait(self, now_s: float) -> list[str]:
        """Keys that are complete because nothing has come until now."""
        since_s = now_s - self._fed_s
        if self._tail == ESC and not self._pasting and since_s >= ESCAPE_S:
            self._tail = ""
            return [ESCAPE]
        if self._apart and self._tail in (f"{ESC}[", f"{ESC}O") and since_s >= ESCAPE_S:
            after, self._tail = self._tail[1], ""
            return [ESCAPE, after]  # two keys that were pressed quickly
        if since_s >= BROKEN_S:
            ended, self._pasting = self._pasting, False
            tail, self._tail = self._tail, ""
            if ended:  # the mark of its end was lost
                self._pasted.add(tail)
                return [PASTE + self._pasted.text]
        return []

    def _take(self) -> list[str]:
        """Take complete keys off the bytes that wait."""
        keys: list[str] = []
        while self._tail:
            if self._pasting:
                text, ends, after = self._tail.partition(_PASTE_ENDS)
                if not ends:  # the end's mark may have come in part
                    cut = max(len(text) + 1 - len(_PASTE_ENDS), 0)
                    self._pasted.add(text[:cut])
                    self._tail = text[cut:]
                    break
                self._pasted.add(text)
                self._pasting, self._tail = False, after
                keys.append(PASTE + self._pasted.text)
                continue
            found = _KEY.match(self._tail)
            begun = _BEGUN.match(self._tail)
            if found is not None:
                self._tail = self._tail[found.end() :]
                key = self._name(found)
                if not key and self._apart and found["letter"]:
                    keys += [ESCAPE, "O"]
                    key = found["letter"]
                self._apart = False
            elif begun is not None and begun.end() == len(self._tail) < _LONGEST:
                break
            else:  # an Escape before another key, or an unknown sequence
                assert begun is not None, "whatever does not begin with Escape is a key"
                self._tail = self._tail[begun.end() :]
                key = ESCAPE if begun.end() == 1 else ""
            if key:
                keys.append(key)
        return keys

    def _name(self, found: re.Match[str]) -> str:
        if found["character"]:
            return found["character"]
        if found["alt"]:
            return f"alt-{found['alt']}"
        if found["letter"]:
            return self._single(found["letter"])
        if found["end"] is None:
            return ""
        if found["end"] == "~":
            number = int(found["first"] or 0)
            if number == _PASTE_BEGINS:
                self._pasting, self._pasted = True, _FirstLine()
                return ""
            name = _NUMBERS.get(number, "")
            held = int(found["held"] or 1) - 1
        else:
            first, held = int(found["first"] or 1), int(found["held"] or 1) - 1
            if found["end"] in _ARROWS and first > 1 and not held:
                first, held = 1, first - 1  # as older terminals say what was held
            self._plain_arrows |= found["end"] in _ARROWS and not held
            name = _LETTERS.get(found["end"], "") if first == 1 else ""
        prefix = "".join(word for bit, word in enumerate(HELD) if held >> bit & 1)
        return f"{prefix}{name}" if name else ""

    def _single(self, letter: str) -> str:
        """Name of a key that is ESC O and a letter.

        A terminal sends arrows so if another program left it in that mode, or always (Emacs); but
        if arrows come as ESC [, this is PuTTY's way to say that Ctrl was held.
        """
        name = _SINGLE.get(letter) or _LETTERS.get(letter, "")
        return f"ctrl-{name}" if letter in _ARROWS and self._plain_arrows else name


ANY = "any key"
LONGEST = 200  # characters that are typed as one answer
# Values of the tuning that a knob of the device may turn.
TURNED = {"TEXTURE": "texture", "CONTRAST": "contrast"}
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
    """Contexts of a reader, which decide what each key stands for."""

    READING = "reading"
    """A line is under the hand."""
    PLACING = "placing"
    """The device waits to be told that its carriage is at the left stop."""
    PROMPT = "typing"
    """A text is being typed, such as what to look for."""
    LEARNING = "learning"
    """A key says what it does, and does nothing."""


def call(module: str, name: str, *given: Any, **named: Any) -> Any:
    """Call a function of a module, which is loaded now; help knows commands without it."""
    return getattr(import_module(module), name)(*given, **named)


@dataclass(frozen=True, slots=True)
class Command:
    """Something that a reader can be told to do by a key.

    Parameters
    ----------
    name
        Name in documents and settings, in capitals as BRLTTY has it.
    keys
        Keys that call the command, as `vbraille.cli.old.reading.keys` names them; `ANY` for every key that
        calls no other command of the context.
    help
        What the command does, in words for its users.
    handler
        Function that does it, which is given the `vbraille.cli.old.reading.reader.Reader`.
    contexts
        Contexts in which the command can be called.
    paged
        Whether a page of the live view may call it, too.
    placed
        Whether the handler is given the number of a place, which a page points at.
    """

    name: str
    keys: tuple[str, ...]
    help: str
    # A reader knows its bindings, so that naming its type here would be a circle.
    handler: Callable[..., None]
    contexts: tuple[Context, ...] = (Context.READING,)
    paged: bool = False
    placed: bool = False

    @property
    def spoken_keys(self) -> str:
        """Names of the command's keys as people say them."""
        return " or ".join(map(spoken, self.keys)) or "no key"


@dataclass(frozen=True, slots=True)
class Bindings:
    """Keys and buttons as a user's settings have them.

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
    """Give commands the keys and buttons of a user's settings.

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
    """Name that a key has when it is typed, by the one that a user wrote."""
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
        Key, as `vbraille.cli.old.reading.keys` names it.
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
