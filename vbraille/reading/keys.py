"""Keys of a terminal: names for the bytes that it sends (ECMA-48, xterm, Linux console, rxvt)."""

from __future__ import annotations

import codecs
import errno
import os
import re
import select
import sys
import termios
import tty
from contextlib import suppress
from typing import TYPE_CHECKING, Self

from vbraille.signals import Suspension

if TYPE_CHECKING:
    from collections.abc import Iterator

_ESCAPE_S = 0.05  # a lone Escape is followed by nothing for so long

_ENDS = dict(
    zip(
        "ABCDFHPQRSZ",
        ["up", "down", "right", "left", "end", "home", "f1", "f2", "f3", "f4", "shift-tab"],
        strict=False,
    )
)
_ENDS |= {f"[{letter}": f"f{number}" for number, letter in enumerate("ABCDE", 1)}
_NUMBERS = dict(
    enumerate(["home", "insert", "delete", "end", "pageup", "pagedown", "home", "end"], 1)
)
_NUMBERS |= {n: f"f{f}" for f, n in enumerate((*range(11, 16), *range(17, 22), 23, 24), 1)}
_PASTE = "\x1b[200~"
_HELD = ("shift-", "alt-", "ctrl-")
_CONTROLS = {"\r": "enter", "\n": "enter", "\t": "tab", "\x7f": "backspace", "\x08": "backspace"}
_KEY = re.compile(
    r"\x1b\[200~(?P<paste>.*?)\x1b\[201~"
    r"|\x1b\[(?P<number>\d*)(?:;(?P<held>\d+))?(?P<end>\[[A-E]|[A-Z~])"
    r"|\x1bO(?P<ss3>.)"
    r"|\x1b\[[0-?]*[ -/]*[@-Z\\-~]"  # a sequence that means nothing here
    r"|\x1b(?P<alt>[^\x1b\[O])"
    r"|(?P<character>[^\x1b])",
    re.DOTALL,
)
_BEGUN = re.compile(r"\x1b(?:\[200~.*|\[[0-?]*[ -/]*|\[\[|O)?", re.DOTALL)


class KeyDecoder:
    """Names of keys from bytes, however they are cut."""

    def __init__(self) -> None:
        self._decode = codecs.getincrementaldecoder("utf-8")("ignore").decode
        self._rest = ""

    def feed(self, data: bytes) -> Iterator[str]:
        """Names of the keys that are complete with these bytes."""
        self._rest += self._decode(data)
        while self._rest:
            match = _KEY.match(self._rest)
            pasting = self._rest.startswith(_PASTE) and (match is None or match["paste"] is None)
            if match is None or pasting:
                if _BEGUN.fullmatch(self._rest):
                    return
                self._rest = self._rest[1:]
                yield "escape"
                continue
            self._rest = self._rest[match.end() :]
            name = _name(match)
            if name:
                yield name

    def settle(self) -> list[str]:
        """Keys that are complete because nothing has followed: a lone Escape."""
        if self._rest.startswith(_PASTE):
            return []  # more of it will come
        rest, self._rest = self._rest, ""
        return ["escape"] if rest == "\x1b" else []

    @property
    def waits(self) -> bool:
        """Tell whether a sequence has begun that is not complete."""
        return bool(self._rest)


def _name(match: re.Match[str]) -> str:
    if match["paste"] is not None:
        return "paste:" + "".join(match["paste"].splitlines()[:1])
    if match["character"]:
        return _plain(match["character"])
    if match["alt"]:
        return "alt-" + _plain(match["alt"])
    if match["ss3"]:
        return _ENDS.get(match["ss3"], "")
    if not match["end"]:
        return ""
    if match["end"] == "~":
        name = _NUMBERS.get(int(match["number"] or 0), "")
    else:
        name = _ENDS.get(match["end"], "")
    held = int(match["held"] or 1) - 1
    return name and "".join(word for bit, word in enumerate(_HELD) if held >> bit & 1) + name


def _plain(character: str) -> str:
    if character in _CONTROLS:
        return _CONTROLS[character]
    if character < " ":
        return f"ctrl-{chr(ord(character) + 96)}"
    return character


class Keyboard:
    """The keys of a terminal, one at a time; a context manager that leaves the terminal as it was.

    Where there is no terminal, no key ever comes.

    Parameters
    ----------
    beside
        Whether standard input has something else, so that keys come from the terminal at which the
        program was started, if there is one.

    Attributes
    ----------
    attached : bool
        Whether there is a terminal to type at.
    also : list[int]
        Descriptors that end the wait for keys when they have something to read.
    """

    def __init__(self, *, beside: bool = False) -> None:
        self._descriptor = self._own = -1
        if sys.stdin is not None and sys.stdin.isatty():
            self._descriptor = sys.stdin.fileno()
        elif beside:
            with suppress(OSError):
                self._own = os.open("/dev/tty", os.O_RDWR | os.O_NOCTTY | os.O_CLOEXEC)
            self._descriptor = self._own
        self.attached = self._descriptor >= 0
        self.also: list[int] = []
        self._decoder = KeyDecoder()
        self._before: list | None = None
        self._catches = False
        self._suspension = Suspension()

    @property
    def must_stop(self) -> bool:
        """Tell whether the shell has asked the process to stop for a while; see `stop`."""
        return self._suspension.asked

    def __enter__(self) -> Self:
        self._suspension.__enter__()
        self.take()
        return self

    def __exit__(self, *_: object) -> None:
        self.give_back()
        self._suspension.__exit__()
        if self._own >= 0:
            os.close(self._own)
            self._own = self._descriptor = -1

    def take(self) -> None:
        """Have the terminal send each key at once, and mark pasted text."""
        while self.attached:
            try:
                self._before = self._before or termios.tcgetattr(self._descriptor)
                tty.setcbreak(self._descriptor, termios.TCSANOW)
                self._mark_pastes("h")
                return
            except termios.error as error:
                if error.args[0] != errno.EINTR:  # by what brought us to the foreground
                    self.attached = False

    def catch_interrupts(self, *, caught: bool) -> None:
        """Have Ctrl-C come as a key, as while a line is typed, or end the program again."""
        if self.attached and caught is not self._catches:
            self._catches = caught
            with suppress(termios.error):
                how = termios.tcgetattr(self._descriptor)
                how[6][termios.VINTR] = b"\0" if caught else b"\x03"
                termios.tcsetattr(self._descriptor, termios.TCSANOW, how)

    def give_back(self) -> None:
        """Leave the terminal as it was."""
        if self._before is not None:
            with suppress(termios.error, OSError):  # the terminal is gone
                self._mark_pastes("l")
                # At once: output that the terminal holds back must not hold up the end.
                termios.tcsetattr(self._descriptor, termios.TCSANOW, self._before)

    def _mark_pastes(self, how: str) -> None:
        if os.environ.get("TERM", "dumb") != "dumb":
            os.write(self._descriptor, f"\x1b[?2004{how}".encode())

    def stop(self) -> None:
        """Stop the process, with the terminal as it was, until the shell has it go on."""
        self.give_back()
        self._suspension.stop()
        self.take()

    def pressed(self, wait_s: float = 0.0) -> list[str]:
        """Wait for keys, and name them."""
        if self._suspension.continued:  # the shell has had the terminal
            self._suspension.continued = False
            self.take()
        if self._decoder.waits:
            wait_s = _ESCAPE_S
        watched = [self._descriptor] if self.attached else []
        ready = select.select([*watched, *self.also], [], [], wait_s)[0]
        if not ready:
            return self._decoder.settle()
        if self._descriptor not in ready:
            return []
        try:
            data = os.read(self._descriptor, 4096)
        except OSError:
            data = b""
        self.attached = bool(data)
        return list(self._decoder.feed(data))
