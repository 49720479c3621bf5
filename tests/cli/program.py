"""The program as its users have it: a process, perhaps at a terminal."""

import os
import re
import select
import subprocess
import sys
import termios
import time

from tests.forking import AtTerminal

PROGRAM = [sys.executable, "-m", "vbraille"]
PATIENCE_S = 60.0
CONTRACTED = "Unified English contracted braille, grade 2"


def line_width(cells, braille=CONTRACTED):
    """The line on standard error that says how wide lines are, and in which braille."""
    return f"line width: {cells} cell{'s' * (cells != 1)}, {braille}\n"


def run(*arguments, **options):
    """Run the program to its end, without a terminal."""
    options = {"stdin": subprocess.DEVNULL, "capture_output": True, "encoding": "utf-8", **options}
    return subprocess.run(
        [*PROGRAM, *map(str, arguments)], check=False, timeout=PATIENCE_S, **options
    )


def start(*arguments, **options):
    """Start the program, its output and its messages in pipes."""
    pipes = {"stdin": subprocess.DEVNULL, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    return subprocess.Popen([*PROGRAM, *map(str, arguments)], **{**pipes, **options})


class Terminal:
    """A process at a terminal of its own: what it prints is read, keys are typed."""

    def __init__(self, *arguments, program=PROGRAM, **environment):
        self.master, self._slave = os.openpty()
        self.before = termios.tcgetattr(self._slave)
        self.printed = ""
        self.process = AtTerminal(
            os.ttyname(self._slave),
            [*program, *map(str, arguments)],
            env={**os.environ, "TERM": "xterm", **environment},
        )

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()
        os.close(self.master)
        os.close(self._slave)

    def type(self, keys):
        """Type keys."""
        os.write(self.master, keys.encode())

    def until(self, pattern):
        """Read until something new that matches is printed; give the new part."""
        new = ""
        end = time.monotonic() + PATIENCE_S
        while not re.search(pattern, new):
            assert time.monotonic() < end, f"{pattern!r} was not printed, but {self.printed!r}"
            new += self._read(1.0)
        return new

    def end(self):
        """Wait for the process's end; its exit code."""
        code = self.process.wait(PATIENCE_S)
        while self._read(0.0):
            pass
        return code

    @property
    def lines(self):
        """What was printed, without the marks that turn the marking of pastes on and off."""
        return re.sub(r"\x1b\[\?2004[hl]", "", self.printed)

    def settings(self):
        """The terminal's settings now."""
        return termios.tcgetattr(self._slave)

    def _read(self, seconds):
        if not select.select([self.master], [], [], seconds)[0]:
            return ""
        text = os.read(self.master, 65_536).decode("utf-8", "replace")
        text = text.replace("\a", "")
        self.printed += text
        return text
