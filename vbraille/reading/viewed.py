"""Readings, and all that is explored, as pages of the live view are told of it."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections import deque
from typing import TYPE_CHECKING, Any, Final

from vbraille.config.knobs import say_mapping
from vbraille.devices.base import Placing
from vbraille.devices.events import Back, Changed, Silent, Stalled, Stranger, Unplugged
from vbraille.devices.sentences import say
from vbraille.live.messages import LineShown, ViewState
from vbraille.live.states import (
    array_shown,
    geometry_shown,
    knobs_shown,
    line_shown,
    rows_shown,
)
from vbraille.reading.commands.paged import obey
from vbraille.reading.whereabouts import is_counted, line_name, percent

if TYPE_CHECKING:
    from collections.abc import Iterable

    from vbraille.devices.events import Event
    from vbraille.layout.pages import Line
    from vbraille.live.messages import PagePress, Turn
    from vbraille.reading.activity import Activity
    from vbraille.reading.device import OpenDevice
    from vbraille.reading.surface import Window

MOST_SAID: Final = 20
BEFORE, AFTER = 2, 3  # lines around the one under the hand
_NUMBER: Final = 0xFFFF_FFFF  # as much of a line's number as a frame has room for
_PLACES: Final = {
    Placing.MARK: "place: the carriage has to pass its mark",
    Placing.STOP: "place: the carriage has to be shown its place",
}
_GONE: Final = (Unplugged, Silent, Stalled, Stranger)
_BACK: Final = (Back, Changed)


class Said:
    """The last sentences that a reader was told.

    Attributes
    ----------
    count : int
        Number of all sentences so far.
    """

    def __init__(self) -> None:
        self.count = 0
        self._last: deque[str] = deque(maxlen=MOST_SAID)

    def add(self, sentence: str) -> None:
        """Keep a sentence."""
        self.count += 1
        self._last.append(sentence)

    @property
    def last(self) -> list[str]:
        """The last sentences, oldest first, `MOST_SAID` at most."""
        return list(self._last)


class View(ABC):
    """What is explored on a device, as the state of the live view.

    Parameters
    ----------
    device
        Device that something is explored on.
    activity
        Reader or feeler.
    said
        What was said.
    facts
        Name and value of whatever else is to be shown.

    Attributes
    ----------
    standing : str
        Sentence on why nothing is done, such as that the program is stopped; empty if it is.
    """

    def __init__(
        self,
        device: OpenDevice,
        activity: Activity,
        said: Said,
        facts: Iterable[tuple[str, str]] = (),
    ) -> None:
        self.standing = ""
        self._device = device
        self._activity = activity
        self._said = said
        self._facts = list(facts)
        self._gone = ""  # sentence on where the device is
        self._number = 0
        self._told: tuple[object, ...] = ()

    @abstractmethod
    def _compared(self) -> tuple[object, ...]:
        """What else may change, which is compared as objects but for plain values."""

    @abstractmethod
    def _parts(self) -> dict[str, Any]:
        """Parts of the state that are of one activity alone."""

    @abstractmethod
    def obey(self, asked: PagePress | Turn) -> None:
        """Do what a page has asked for."""

    def see(self, events: Iterable[Event]) -> None:
        """Take note of events of the device."""
        for event in events:
            if isinstance(event, _GONE):
                self._gone = say(event)
            elif isinstance(event, _BACK):
                self._gone = ""

    def changed(self) -> ViewState | None:
        """State of the activity; None if it is what it was at the last call."""
        device, done = self._device, self._activity.done
        # What is compared is small, for this is asked fifty times a second. What cannot change is
        # compared as an object, and kept here, so that no other can take its place in memory.
        now = (
            *(done, device.paused, device.placing, device.held),
            *(self._said.count, self._gone, self.standing),
            *self._compared(),
        )
        if len(now) == len(self._told) and all(
            a is b or (isinstance(a, bool | int | str) and a == b)
            for a, b in zip(now, self._told, strict=True)
        ):
            return None
        self._told = now
        self._number += 1
        said = self._said.last
        return ViewState(
            number=self._number,
            array=array_shown(device.display),
            paused=device.paused,
            simulated=device.pointer is not None,
            held=device.held,
            device=self._standing(),
            said=said,
            said_before=self._said.count - len(said),
            facts=self._facts,
            done=done,
            **self._parts(),
        )

    def _standing(self) -> str:
        """Sentence on the state of the device."""
        doing, placing = self._activity.doing, self._device.placing
        if self.standing:
            return self.standing
        if self._activity.done:
            return f"{doing} is over"
        if self._gone:
            return self._gone
        if placing is Placing.DONE:
            return "paused" if self._device.paused else doing
        return _PLACES[placing]


class ReadView(View):
    """A text that is read.

    Nothing is translated or laid out for it: of the lines around the one under the hand it shows
    those that are there already.

    Parameters
    ----------
    device
        Device that a text is shown on.
    title
        Title of what is read.
    said, facts
        As for a `View`.
    """

    def __init__(
        self, device: OpenDevice, title: str, said: Said, facts: Iterable[tuple[str, str]] = ()
    ) -> None:
        super().__init__(device, device.reader, said, facts)
        self._title = title

    def obey(self, asked: PagePress | Turn) -> None:
        """Do what a page has asked for."""
        obey(self._device.reader, asked)

    def _compared(self) -> tuple[object, ...]:
        reader = self._device.reader
        under, layout = reader.under, reader.layout
        return reader.window, under.style, layout, under.shown, under.reached, layout.counted

    def _parts(self) -> dict[str, Any]:
        reader = self._device.reader
        style, layout, line = reader.style, reader.layout, reader.line
        where = ""
        if line is not None:
            counted = f"{line_name(layout, line)}, " if is_counted(layout) else ""
            where = f"{counted}{percent(layout, line)} %"
        return {
            "title": self._title,
            "geometry": geometry_shown(style.geometry),
            "rows_shown": rows_shown(style, self._device.display),
            "lines": [] if line is None else list(self._lines(line)),
            "place": where,
            "knobs": knobs_shown(style),
            "mapping": say_mapping(style.mapping),
        }

    def _lines(self, line: Line) -> Iterable[LineShown]:
        """Lines to be drawn, from top to bottom."""
        reader = self._device.reader
        window, layout, surface = reader.window, reader.layout, reader.under.surface
        assert window is not None, "a line is under the hand"
        assert surface is not None
        pitch_mm = reader.style.geometry.line_pitch_mm
        if surface.paged:
            for row, part in enumerate(surface.windows):
                if part is not None:
                    yield _part_shown(part, top_mm=row * pitch_mm, under=part is window)
            return
        for step in range(-BEFORE, AFTER + 1):
            if step == 0:
                yield _part_shown(window, under=True)
                continue
            other = layout.laid_near(line, step)
            if other is not None:
                yield line_shown(
                    other,
                    count=min(len(other), window.width),
                    top_mm=step * pitch_mm,
                    number=other.number & _NUMBER,
                )


def _part_shown(part: Window, *, under: bool, top_mm: float = 0.0) -> LineShown:
    """Show a part of a line, whose upper edge is at a place, as a page draws it."""
    return line_shown(
        part.line,
        first=part.offset,
        count=len(part),
        start_mm=part.start_mm,
        top_mm=top_mm,
        number=part.line.number & _NUMBER,
        under=under,
    )
