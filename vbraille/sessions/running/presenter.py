"""Paper, and the base of all that stimuli are felt on. Enter says when reading of paper ends."""

from __future__ import annotations

import time
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vbraille.devices.events import Button, Knob
from vbraille.sessions.planning.trial import Stimulus
from vbraille.sessions.simulated.observer import FeltFrames


class Happening(NamedTuple):
    """Something that the hand or the device did.

    Parameters
    ----------
    kind, time_s, data
        Kind of the event, when it was by the session's clock, and what else the record has.
    said
        Sentence for the experimenter; empty for none.
    """

    kind: str
    time_s: float
    data: dict[str, Any]
    said: str = ""


class Presenter:
    """Paper, on which nothing is shown.

    Attributes
    ----------
    by_key : bool
        Whether Enter says when reading ends, and not the hand.
    read, ended : bool
        Whether the stimulus was read; whether a key or the time ended that.
    """

    by_key = True

    def __init__(self) -> None:
        self.read = self.ended = False
        self._shown: Stimulus | None = None
        self._happened: list[Happening] = []

    @property
    def told(self) -> dict[str, Any]:
        """Description of it for the event of a run."""
        return {}

    @property
    def now_s(self) -> float:
        """Time of the session's clock, which is the machine's."""
        return time.monotonic()

    @property
    def why(self) -> str:
        """Why nothing can be shown now; empty if something can."""
        return ""

    @property
    def ready(self) -> bool:
        """True if a trial may begin."""
        return not self.why

    @property
    def reached(self) -> bool:
        """True if the hand has been at the end of the stimulus."""
        return self.read

    def start(self) -> None:
        """Open what is shown on."""

    def close(self) -> dict[str, Any]:
        """Close it, and return what the record has of that."""
        return {}

    def prepare(self, stimulus: Stimulus) -> dict[str, Any]:
        """Make a stimulus ready, and return what the event of its cue says of it."""
        self._shown = stimulus
        return {}

    def show(self, *, first: bool, turned: bool) -> None:
        """Show what was prepared.

        Parameters
        ----------
        first
            Whether it is the first stimulus of a trial.
        turned
            Whether it takes the place of the last one, at another value.
        """
        self.read = self.ended = False

    def press(self) -> str:
        """Take Enter as the end of reading; return why it is none, or nothing."""
        if self._shown is not None and not self.read:
            self.end_reading()
            self._happened.append(Happening("read", self.now_s, {}))
        return ""

    def end_reading(self) -> None:
        """Bring it to rest, since a key or the time has ended reading."""
        self.read = self.ended = True
        self.rest()

    def rest(self) -> None:
        """Let nothing be felt."""

    def go(self) -> None:
        """Let the stimulus be felt again after a rest, unless its reading was ended."""

    def withdraw(self) -> None:
        """Take the stimulus away."""
        self.rest()
        self._shown = None

    def confirm(self) -> bool:
        """Take Enter as a sign to the device; False if none is awaited."""
        return False

    def explorations(self) -> list[FeltFrames]:
        """Return frames, places and times of each stimulus of the open trial."""
        return []

    def take_controls(self) -> list[Button | Knob]:
        """Return presses and turns since the last call, while a stimulus was shown."""
        return []

    def poll(self) -> tuple[NDArray[Any], list[Happening]]:
        """Return the ticks since the last call, and what happened in them."""
        happened, self._happened = self._happened, []
        return np.empty(0), happened
