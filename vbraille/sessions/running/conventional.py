"""Stimuli and references that stand on a conventional display, and what becomes of them."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

from vbraille.braille.spelling import to_braille
from vbraille.conventional.brlapi import CellsTaken, DisplayAway, DisplayStands
from vbraille.errors import DeviceError, InputError
from vbraille.sessions.record import events
from vbraille.sessions.running.presenters import Occurrence, Presentation, Presenter
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.conventional.display import ConventionalDisplay
    from vbraille.sessions.planning.style import ConventionalTable

_COMES_S = 10.0  # by then a display that is there has said so
_GONE_S = 2.0  # so long one may come that is not there yet
_POLL_S = 0.02


class OnConventional(Presenter):
    """Presenter on a conventional display.

    Parameters
    ----------
    display
        The display. Nothing here waits for it, but `begin`.
    table
        What the protocol says of it.
    cells
        Number of cells that it must have.
    spec
        Display that was asked for.
    """

    def __init__(
        self, display: ConventionalDisplay, table: ConventionalTable, *, cells: int, spec: str
    ) -> None:
        super().__init__()
        self.taken = False
        self._presentation: Presentation | None = None
        self._display = display
        self._table = table
        self._cells = cells
        self._spec = spec
        self._number = 0
        self._shown: bytes | None = None  # what it was told to show last
        self._reference = False
        self._open = False  # whether a trial needs what was shown
        self._known: DisplayStands | None = None  # what the journal knows
        self._early: list[Occurrence] = []  # what happened before the session began

    @property
    def why(self) -> str:
        """Reason why nothing can stand on it, in words for people; empty if something can."""
        standing = self._display.standing
        if standing is None:
            return self._display.away or "the conventional display is not there yet"
        return self._short(standing)

    def begin(self, sleep: Callable[[float], None] = time.sleep) -> None:
        """Wait until the display is there.

        Parameters
        ----------
        sleep
            Function that waits for a number of seconds.

        Raises
        ------
        DeviceError
            If it does not come.
        InputError
            If it has too few cells.
        """
        waited_s = gone_s = 0.0
        while self._display.standing is None and waited_s < _COMES_S and gone_s < _GONE_S:
            self._early = self.poll()
            sleep(_POLL_S)
            waited_s += _POLL_S
            gone_s += _POLL_S if self._display.away else 0.0
        standing = self._display.standing
        if standing is None:
            raise DeviceError(
                f"the protocol needs a conventional display: {self.why} ({setting('also')})"
            )
        if short := self._short(standing):
            raise InputError(f"{short}; give another display with {setting('also')}")

    def show(self, presentation: Presentation, *, first: bool = True) -> None:
        """Put a stimulus on the display."""
        super().show(presentation, first=first)
        self._presentation = presentation
        self._put(self._table.placed(presentation.masks), reference=False)

    def go(self) -> None:
        """Put the stimulus there again after a rest, unless it was read."""
        if self._presentation is not None and not self.read:
            self._put(self._table.placed(self._presentation.masks), reference=False)

    def end_reading(self) -> None:
        """Take the stimulus away, since it was read."""
        super().end_reading()
        self.rest()

    def show_reference(self) -> None:
        """Put what stimuli on the device are compared with on the display."""
        self._put(self._table.placed(self._table.reference), reference=True)

    def rest(self) -> None:
        """Take the stimulus away; a reference stays where it is, for a finger rests on it.

        The trial still needs the display, which may be found to be gone by this.
        """
        if self._shown and not self._reference:
            self._put(b"", reference=False)

    def withdraw(self) -> None:
        """Take the stimulus away, since the attempt at the trial is over."""
        self.rest()
        self._open = False

    def poll(self) -> list[Occurrence]:
        """Give what has happened since the last call."""
        early, self._early = self._early, []
        return early + [each for message in self._display.poll() for each in self._take(message)]

    def close(self) -> None:
        """Give the display back."""
        self._display.close()

    def _put(self, cells: bytes, *, reference: bool) -> None:
        self._shown, self._reference, self.taken = cells, reference, False
        self._open = True
        self._number = self._display.show(cells)

    def _take(self, message: object) -> list[Occurrence]:
        match message:
            case DisplayStands():
                return self._come(message)
            case DisplayAway():
                self.taken = False
                said = f"display: {message.why}"
                return [*self._lost(message.why), Occurrence(events.Device, {"what": said}, said)]
            case CellsTaken() if message.number == self._number:
                first, self.taken = not self.taken, True
                return [Occurrence(events.Stood, self._told(message.at_ns))] if first else []
        return []

    def _come(self, standing: DisplayStands) -> list[Occurrence]:
        """Say what display it is, and that what stood on another one is gone with it."""
        if standing == self._known:
            return []
        another, self._known = self._known is not None, standing
        fields = {name: getattr(standing, name) for name in ("driver", "model", "columns", "rows")}
        said = f"display: {standing.title}, {standing.columns} cells"
        short = self._short(standing)
        came = Occurrence(
            events.DisplayBeside,
            {**fields, "spec": self._spec},
            f"{said}; {short}" if short else said,
        )
        lost = self._lost("the conventional display is another one") if another else []
        return [*lost, came]

    def _lost(self, why: str) -> list[Occurrence]:
        return [Occurrence(events.Fault, {"what": why})] if self._open else []

    def _short(self, standing: DisplayStands) -> str:
        if standing.columns >= self._cells:
            return ""
        return (
            f"the conventional display has {standing.columns} cells, and the protocol needs "
            f"{self._cells}"
        )

    def _told(self, at_ns: int) -> dict[str, Any]:
        told: dict[str, Any] = {"time_ns": at_ns}
        if self._shown:
            told["cells"] = to_braille(tuple(self._shown))
        return told | {"reference": True} if self._reference else told
