"""Paper and conventional displays in the place of a device: Enter says when reading ends."""

from __future__ import annotations

import time
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vbraille.braille.spelling import to_braille
from vbraille.conventional.display import (
    CellsTaken,
    ConventionalDisplay,
    DisplayAway,
    DisplayStands,
)
from vbraille.errors import DeviceError, InputError
from vbraille.sessions.planning.plan import Plan
from vbraille.sessions.planning.protocol import Protocol
from vbraille.sessions.planning.shown import pins_masks
from vbraille.sessions.planning.trial import Stimulus
from vbraille.sessions.running.device import Happening
from vbraille.sessions.simulated.skin import FeltFrames
from vbraille.wording import setting

_COMES_S = 10.0  # by then a display that is there has said so
_GONE_S = 2.0  # how long one may come that says it is not there
_POLL_S = 0.02


class Paper:
    """Does what `SessionDevice` does, but shows nothing. Its attributes are described there.

    Attributes
    ----------
    why : str
        Why nothing can be shown now; empty if something can.
    """

    by_key = True
    why = ""

    def __init__(self) -> None:
        self.read = self.ended = False
        self._is_shown = False
        self._happened: list[Happening] = []

    @property
    def now_s(self) -> float:
        """Time of the machine."""
        return time.monotonic()

    @property
    def ready(self) -> bool:
        """True if a trial may begin."""
        return not self.why

    @property
    def reached(self) -> bool:
        """True if Enter has said that the stimulus was read."""
        return self.read

    def show(self, stimulus: Stimulus, *, first: bool = True, turned: bool = False) -> None:
        """Take it that reading begins."""
        self.read, self.ended, self._is_shown = False, False, True

    def press(self) -> str:
        """Take Enter as the end of reading; return why it is none, or nothing."""
        if self._is_shown and not self.read:
            self.end_reading()
            self._happened.append(Happening("read", self.now_s, {}))
        return ""

    def end_reading(self) -> None:
        """Take it that the stimulus was read."""
        self.read = self.ended = True

    def rest(self) -> None:
        """Do nothing."""

    def go(self) -> None:
        """Do nothing."""

    def withdraw(self) -> None:
        """Take it that nothing is read any more."""
        self._is_shown = False

    def confirm(self) -> bool:
        """Return False: no carriage is to be shown its place."""
        return False

    def explorations(self) -> list[FeltFrames]:
        """Return nothing: paper feels no hand."""
        return []

    def take_controls(self) -> list[Any]:
        """Return nothing: paper has no buttons."""
        return []

    def start(self) -> None:
        """Do nothing."""

    def close(self) -> None:
        """Do nothing."""

    def poll(self) -> tuple[NDArray[Any], list[Happening]]:
        """Return no ticks, and the end of reading if Enter was pressed."""
        happened, self._happened = self._happened, []
        return np.empty(0), happened


class Pins(Paper):
    """A conventional display, with a stimulus or with the reference of a comparison.

    Parameters
    ----------
    protocol, plan
        What is shown.
    spec
        Which display, such as "brlapi".
    """

    def __init__(self, protocol: Protocol, plan: Plan, spec: str) -> None:
        super().__init__()
        self.spec = spec
        self._protocol = protocol
        self._display = ConventionalDisplay(spec)
        stimuli = [s for trial in plan.trials for s in trial.stimuli if s.on == "pins"]
        self._cells = max(len(pins_masks(protocol, each)) for each in (None, *stimuli))
        self._masks = self._put_cells = b""
        self._number = 0
        self._put_cells = b""
        self._taken = True
        self._is_reference = False

    @property
    def why(self) -> str:
        """Why nothing can stand on it; empty if something can."""
        standing = self._display.standing
        if standing is None:
            return self._display.away or "the conventional display is not there yet"
        if standing.columns < self._cells:
            return (
                f"the conventional display has {standing.columns} cells, and the protocol needs "
                f"{self._cells}"
            )
        return ""

    def start(self) -> None:
        """Wait until the display is there.

        Raises
        ------
        DeviceError
            If it does not come.
        InputError
            If it has too few cells.
        """
        waited_s = gone_s = 0.0
        while self._display.standing is None and waited_s < _COMES_S and gone_s < _GONE_S:
            self._happened += self._heard()
            time.sleep(_POLL_S)
            waited_s += _POLL_S
            gone_s += _POLL_S if self._display.away else 0.0
        if self._display.standing is None:
            said = f"the protocol needs a conventional display: {self.why}"
            raise DeviceError(f"{said} ({setting('also')})")
        if self.why:
            raise InputError(f"{self.why}; give another display with {setting('also')}")

    def show(self, stimulus: Stimulus, *, first: bool = True, turned: bool = False) -> None:
        """Put a stimulus on the display."""
        super().show(stimulus, first=first)
        self._is_reference = False
        self._masks = pins_masks(self._protocol, stimulus)
        self._put(self._masks)

    def show_reference(self) -> None:
        """Put up what the stimuli of a trial are compared with, until it is withdrawn."""
        self._is_reference = True
        self._masks = pins_masks(self._protocol, None)
        self._put(self._masks)

    def press(self) -> str:
        """Take Enter as the end of reading, once the display shows the stimulus."""
        if not self._taken:
            return "the display does not show it yet; read it, then press Enter again"
        return super().press()

    def end_reading(self) -> None:
        """Take the stimulus away, since it was read."""
        super().end_reading()
        self._put(b"")

    def rest(self) -> None:
        """Take away what is read there; a reference stays."""
        if self._masks and not self._is_reference:
            self._put(b"")

    def go(self) -> None:
        """Put the stimulus up again, unless it was read."""
        if self._is_shown and not self.read:
            self._put(self._masks)

    def withdraw(self) -> None:
        """Take away what is there."""
        super().withdraw()
        if self._masks:
            self._put(b"")
        self._masks = b""

    def close(self) -> None:
        """Give the display back."""
        self._display.close()

    def poll(self) -> tuple[NDArray[Any], list[Happening]]:
        """Return what the display has told."""
        self._happened += self._heard()
        return super().poll()

    def _put(self, cells: bytes) -> None:
        self._taken = False
        self._number = self._display.show(cells)
        self._put_cells = cells

    def _heard(self) -> list[Happening]:
        found = []
        for message in self._display.poll():
            match message:
                case DisplayStands():
                    data = {"display": message.title, "columns": message.columns, "spec": self.spec}
                    said = f"display: {message.title}, {message.columns} cells"
                    found += [*self._lost(), Happening("display", self.now_s, data, said)]
                case DisplayAway():
                    self._taken = False
                    said = f"display: {message.why}"
                    found += self._lost(message.why)
                    found.append(Happening("device", self.now_s, {"what": said}, said))
                case CellsTaken() if message.number == self._number and not self._taken:
                    self._taken = True
                    if not self._number:  # the blank cells of a display that came late
                        continue
                    data: dict[str, Any] = {"cells": to_braille(tuple(self._put_cells))}
                    if self._is_reference:
                        data["reference"] = True
                    found.append(Happening("pins", message.at_ns / 1e9, data))
        return found

    def _lost(self, why: str = "the conventional display is another one") -> list[Happening]:
        """Return a fault if something stood on a display that is gone."""
        return [Happening("fault", self.now_s, {"what": why})] if self._masks else []
