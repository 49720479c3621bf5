"""The program as users have it: a process of its own."""

import os
import pty
import select
import subprocess
import sys
import termios

VBRAILLE = [sys.executable, "-m", "vbraille"]
PATIENCE_S = 60


def run(*arguments, **options) -> subprocess.CompletedProcess[str]:
    """Run a command to its end, without a terminal."""
    return subprocess.run(
        [*VBRAILLE, *map(str, arguments)],
        **{"stdin": subprocess.DEVNULL, "capture_output": True, "text": True, "check": False}
        | {"timeout": PATIENCE_S}
        | options,
    )


class Terminal:
    """A command at a terminal; a context manager."""

    def __init__(self, *arguments) -> None:
        self._ours, self._its = pty.openpty()
        self.before = termios.tcgetattr(self._its)
        self.process = subprocess.Popen(
            [*VBRAILLE, *map(str, arguments)],
            stdin=self._its,
            stdout=self._its,
            stderr=self._its,
            start_new_session=True,
        )
        self.shown = ""

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()
        os.close(self._ours)
        os.close(self._its)

    def type(self, keys: str) -> None:
        os.write(self._ours, keys.encode())

    def read_until(self, text: str) -> str:
        """What it shows up to some text, and not more than has been read before."""
        start = len(self.shown)
        while text not in self.shown[start:]:
            ready, _, _ = select.select([self._ours], [], [], PATIENCE_S)
            assert ready, f"waited in vain for {text!r} after {self.shown!r}"
            self.shown += os.read(self._ours, 65536).decode()
        return self.shown[start:]

    def settings(self):
        """How the terminal is set now."""
        return termios.tcgetattr(self._its)
