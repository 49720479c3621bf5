"""The program at a pseudo-terminal, where keys are typed and sentences are read."""

from __future__ import annotations

import os
import pty
import re
import select
import signal
import sys
import time
from pathlib import Path
from typing import Self

_PATIENCE_S = 20.0
PROGRAM = str(Path(sys.executable).with_name("vbraille"))
KEYS = {
    "enter": "\r", "escape": "\x1b", "tab": "\t", "backspace": "\x7f", "space": " ",
    "up": "\x1b[A", "down": "\x1b[B", "right": "\x1b[C", "left": "\x1b[D", "home": "\x1b[H",
    "end": "\x1b[F", "delete": "\x1b[3~", "pageup": "\x1b[5~", "pagedown": "\x1b[6~",
    "ctrl-pageup": "\x1b[5;5~", "ctrl-pagedown": "\x1b[6;5~", "ctrl-up": "\x1b[1;5A",
    "ctrl-down": "\x1b[1;5B", "alt-left": "\x1b[1;3D", "shift-tab": "\x1b[Z", "f1": "\x1bOP",
    "f2": "\x1bOQ", "f3": "\x1bOR", "f4": "\x1bOS", "f5": "\x1b[15~", "f7": "\x1b[18~",
    "f8": "\x1b[19~", "ctrl-home": "\x1b[1;5H", "ctrl-end": "\x1b[1;5F",
    "ctrl-right": "\x1b[1;5C", "ctrl-left": "\x1b[1;5D", "f6": "\x1b[17~",
}  # fmt: skip


class Terminal:
    """A reading at a pseudo-terminal; a context manager."""

    def __init__(self, *arguments: str, program: list[str] | None = None) -> None:
        self.said, self.open = b"", True
        self.status: int | None = None
        self.pid, self.fd = pty.fork()
        if self.pid == 0:
            os.environ["TERM"] = "xterm"
            program = program or [PROGRAM, *arguments]
            os.execvp(program[0], program)

    def __enter__(self) -> Self:
        self.wait("for the keys", 60)
        return self

    def __exit__(self, *_: object) -> None:
        if self.status is None:
            os.kill(self.pid, signal.SIGKILL)
            os.waitpid(self.pid, 0)
        os.close(self.fd)

    def press(self, *keys: str, wait_s: float = 0.12) -> str:
        """Press keys one after the other, and give what is said soon after each.

        Nothing said at once is waited for, until a machine that is busy has said it.
        """
        before = len(self.said)
        for key in keys:
            typed = KEYS.get(key, key)
            if key.startswith("ctrl-") and key not in KEYS:
                typed = chr(ord(key[-1]) - 96)
            elif key.startswith("alt-") and key not in KEYS:
                typed = "\x1b" + key[-1]
            said = len(self.said)
            os.write(self.fd, typed.encode())
            end_s = time.monotonic() + _PATIENCE_S
            while len(self.said) == said and self.open and time.monotonic() < end_s:
                self.listen(0.02)
            self.listen(wait_s)
        return plain(self.said[before:])

    def wait(self, words: str, most_s: float = 30.0) -> None:
        end_s = time.monotonic() + most_s
        while words.encode() not in self.said and time.monotonic() < end_s:
            self.listen(0.05)
        assert words.encode() in self.said, plain(self.said)

    def listen(self, wait_s: float) -> None:
        end_s = time.monotonic() + wait_s
        while (left_s := end_s - time.monotonic()) > 0:
            if select.select([self.fd], [], [], left_s)[0]:
                try:
                    self.said += os.read(self.fd, 65536)
                except OSError:
                    self.open = False
                    return

    def end(self, number: int | None = None) -> int:
        """Wait for the end, after a signal or without one, and give the exit code."""
        if number is not None:
            os.kill(self.pid, number)
        end_s = time.monotonic() + _PATIENCE_S
        while time.monotonic() < end_s:
            self.listen(0.05)
            pid, status = os.waitpid(self.pid, os.WNOHANG)
            if pid:
                self.status = os.waitstatus_to_exitcode(status)
                return self.status
        raise AssertionError("it did not end")


def plain(said: bytes) -> str:
    """Sentences without the terminal's control sequences."""
    text = re.sub(r"\x1b\[[0-9?;]*[a-zA-Z]", "", said.decode(errors="replace"))
    lines = text.replace("\r", "\n").split("\n")
    return "\n".join(line for line in lines if line.strip())
