"""A conventional display beside the device: it shows a stimulus, or what is compared with."""

from __future__ import annotations

import time
from typing import Any

from numpy.typing import NDArray

from vbraille.braille.spelling import to_braille
from vbraille.conventional.display import (
    CellsTaken,
    ConventionalDisplay,
    DisplayAway,
    DisplayStands,
)
from vbraille.errors import DeviceError
from vbraille.sessions.planning.plan import Plan
from vbraille.sessions.planning.protocol import Protocol
from vbraille.sessions.planning.shown import pins_masks
from vbraille.sessions.running.presenter import Happening, Presenter
from vbraille.wording import setting

_COMES_S = 5.0  # by then a display that is there has said so
_POLL_S = 0.02


class Pins(Presenter):
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
        self._protocol, self._spec = protocol, spec
        self._display = ConventionalDisplay(spec)
        stimuli = [s for trial in plan.trials for s in trial.stimuli if s.on == "pins"]
        self._cells = max(len(pins_masks(protocol, each)) for each in (None, *stimuli))
        self._masks = self._stands = b""  # what belongs there, and what stands there now
        self._number = 0
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
            If it does not come, or has too few cells.
        """
        end_s = time.monotonic() + _COMES_S
        while self.why and time.monotonic() < end_s:
            time.sleep(_POLL_S)
            self._hear()
        if self.why:
            hint = f"give another display with {setting('also')}"
            raise DeviceError(f"the protocol needs a conventional display: {self.why}; {hint}")

    def close(self) -> dict[str, Any]:
        """Give the display back."""
        self._display.close()
        return {}

    def show(self, *, first: bool, turned: bool) -> None:
        """Put the stimulus on the display."""
        super().show(first=first, turned=turned)
        self._is_reference = False
        self._put(pins_masks(self._protocol, self._shown))

    def show_reference(self) -> None:
        """Put up what the stimuli of a trial are compared with, until it is withdrawn."""
        self._is_reference = True
        self._put(pins_masks(self._protocol, None))

    def press(self) -> str:
        """Take Enter as the end of reading, once the display shows the stimulus."""
        if not self._taken:
            return "the display does not show it yet; read it, then press Enter again"
        return super().press()

    def rest(self) -> None:
        """Take away what is read there; a reference stays."""
        if not self._is_reference:
            self._put(b"", self._masks)

    def go(self) -> None:
        """Put the stimulus up again, unless it was read."""
        if self._shown is not None and not self.read:
            self._put(self._masks)

    def withdraw(self) -> None:
        """Take away what is there."""
        self._is_reference, self._shown = False, None
        self._put(b"")

    def poll(self) -> tuple[NDArray[Any], list[Happening]]:
        """Return what the display has told."""
        self._hear()
        return super().poll()

    def _put(self, cells: bytes, belongs: bytes | None = None) -> None:
        """Have cells stand on the display, and take down which belong there."""
        if cells or self._masks:
            self._taken, self._stands = False, cells
            self._number = self._display.show(cells)
        self._masks = cells if belongs is None else belongs

    def _hear(self) -> None:
        """Take what the display has told."""
        for message in self._display.poll():
            match message:
                case DisplayStands():
                    self._lose("the conventional display is another one")
                    data: dict[str, Any] = {"display": message.title, "columns": message.columns}
                    said = f"display: {message.title}, {message.columns} cells"
                    data["spec"] = self._spec
                    self._happened.append(Happening("display", self.now_s, data, said))
                case DisplayAway():
                    self._taken = False
                    self._lose(message.why)
                    said = f"display: {message.why}"
                    self._happened.append(Happening("device", self.now_s, {"what": said}, said))
                case CellsTaken() if message.number == self._number and not self._taken:
                    self._taken = True
                    # Number 0 are the blank cells of a display that came late.
                    reference = {"reference": True} if self._is_reference else {}
                    data = {"cells": to_braille(self._stands), **reference}
                    if self._number:
                        self._happened.append(Happening("pins", message.at_ns / 1e9, data))

    def _lose(self, why: str) -> None:
        """Tell of a fault if something stood on a display that is gone."""
        if self._masks:
            self._happened.append(Happening("fault", self.now_s, {"what": why}))
