"""Paper, or pins, in the place of a device: the experimenter says by Enter when it is read."""

from __future__ import annotations

import time

import numpy as np
from numpy.typing import NDArray

from vbraille.sessions.planning.shown import Shown
from vbraille.sessions.running.device import Happening
from vbraille.sessions.simulated.skin import FeltFrames


class Paper:
    """Does what `SessionDevice` does, but shows nothing. Its attributes are described there.

    Parameters
    ----------
    line
        Number of the last showing in earlier runs.
    at_once
        Whether reading takes no time, since nobody is there to say when it ends.
    """

    by_key = True

    def __init__(self, line: int, *, at_once: bool) -> None:
        self._at_once = at_once
        self.line = line
        self.ready = True
        self.read = False
        self._is_shown = False
        self._happened: list[Happening] = []

    @property
    def now_s(self) -> float:
        """Time of the machine."""
        return time.monotonic()

    def start(self) -> None:
        """Do nothing."""

    def close(self) -> None:
        """Do nothing."""

    def show(self, line: Shown, *, first: bool) -> None:
        """Take it that reading begins."""
        self.line += 1
        self.read, self._is_shown = self._at_once, True

    def press(self) -> None:
        """Take Enter as the end of reading."""
        if self._is_shown and not self.read:
            self.read = True
            self._happened.append(Happening("read", self.now_s, {}))

    def rest(self) -> None:
        """Do nothing."""

    def go(self) -> None:
        """Do nothing."""

    def withdraw(self) -> None:
        """Take it that nothing is read any more."""
        self._is_shown = False

    def explorations(self) -> list[FeltFrames]:
        """Return nothing: paper feels no hand."""
        return []

    def poll(self) -> tuple[NDArray[np.void], list[Happening]]:
        """Return no ticks, and the end of reading if Enter was pressed."""
        happened, self._happened = self._happened, []
        return np.empty(0), happened
