"""A process beside the reading that is told lines, and is never waited for.

What is heard may take its time: a speech server that starts, an audio output that opens. A hand
must not wait for it, so that a process of its own does it, at the other end of a pipe.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections import deque
from contextlib import suppress
from typing import Final

# A pipe takes this many bytes whole or not at all, so that no line is cut.
MOST_BYTES: Final = 4096
# Lines that wait for room in the pipe; of more the oldest are dropped.
_MOST_WAITING = 50
_END_S = 2.0


class Attendant:
    """A process of its own, to which lines go through a pipe.

    It has a session of its own, so that keys of the terminal do not end or stop it, and it ends
    when the pipe does.

    Parameters
    ----------
    module
        Module that the process runs.
    arguments
        Arguments that the module is given.
    """

    def __init__(self, module: str, *arguments: str) -> None:
        self._process = subprocess.Popen(
            [sys.executable, "-m", module, *arguments],
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            bufsize=0,
            start_new_session=True,
        )
        assert self._process.stdin is not None
        self._pipe = self._process.stdin
        os.set_blocking(self._pipe.fileno(), False)
        self._waiting: deque[bytes] = deque(maxlen=_MOST_WAITING)

    def tell(self, line: bytes, *, alone: bool = False) -> bool:
        """Send a line as soon as there is room for it; this never waits.

        Parameters
        ----------
        line
            Line without its end, less than `MOST_BYTES` long.
        alone
            Whether lines that are still waiting here are dropped in its favour.

        Returns
        -------
        bool
            Whether the process is still there to be told; later lines may show that it is not.
        """
        if alone:
            self._waiting.clear()
        self._waiting.append(line + b"\n")
        try:
            while self._waiting and os.write(self._pipe.fileno(), self._waiting[0]):
                self._waiting.popleft()
        except BlockingIOError:
            return True
        except (OSError, ValueError):  # it has ended, or was closed
            self._waiting.clear()
            return False
        return True

    def close(self) -> None:
        """End the process once it has done what it was told; it is given two seconds for that."""
        with suppress(OSError):
            self._pipe.close()
        try:
            self._process.wait(_END_S)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
