"""Events of a device and of the engine that drives it: values with a sentence each.

A class is an event; its `says` is the sentence for the reader, with the fields by name, or empty
if the reader hears of it in another way.
"""

from __future__ import annotations

from enum import IntEnum
from typing import TYPE_CHECKING, ClassVar, Final, Union

import msgspec

if TYPE_CHECKING:
    from collections.abc import Hashable, Iterable

    from vbraille.display import Display

_NS_PER_S = 1_000_000_000
_KNOB_NS = 20_000_000
_MOST = 256  # a button that bounces for ever must not fill the memory


class Placing(IntEnum):
    """Act that a device waits for before it knows where its carriage is."""

    DONE = 0  # nothing: it knows
    STOP = 1  # the reader moves it to the left stop and presses a key: `Device.set_zero`


class Event(msgspec.Struct, frozen=True, tag=True):
    """Something that happened."""

    says: ClassVar[str] = ""
    every: ClassVar[bool] = False  # whether each one is told, however many come

    @property
    def key(self) -> Hashable:
        """Key of events of which one is told in a second."""
        return type(self)

    def say(self) -> str:
        """Sentence for the event."""
        return self.says.format_map({n: getattr(self, n) for n in self.__struct_fields__})


class Unplugged(Event, frozen=True):
    """The port is gone; reading goes on when the device is plugged in again."""

    says = "device: unplugged; plug it in again and reading goes on"


class Silent(Event, frozen=True):
    """The device sends nothing any more, and is told to rest."""

    says = "device: silent, and sent to rest; reading goes on once it speaks"


class Stalled(Event, frozen=True):
    """No tick was done for a while, since the driver does not return from a call."""

    seconds: float
    says = "device: its driver has not answered for {seconds:.0f} s; reading goes on once it does"


class Back(Event, frozen=True):
    """A device that was away can be read on again."""

    says = "device: back"


class WatchdogTripped(Event, frozen=True):
    """The device went to rest because no frame reached it in time."""

    trips: int
    says = "device: no frame reached it in time, so it went to rest; reading goes on"


class SlowActuators(Event, frozen=True):
    """The actuators cannot follow the usual texture at all speeds of a hand."""

    speed_mm_s: int
    says = "device: its actuators cannot follow the usual texture above {speed_mm_s} mm/s"


class Notice(Event, frozen=True):
    """The device says something in words of its own, and goes on."""

    code: int
    text: str

    @property
    def key(self) -> Hashable:
        """Notices with one code are alike."""
        return Notice, self.code

    def say(self) -> str:
        """Sentence for the event."""
        return f"device: {self.text or f'notice {self.code}'}"


class Button(Event, frozen=True):
    """A button of the device was pressed or let go.

    Parameters
    ----------
    number
        Number of the button, from 1.
    pressed
        Whether it is down now.
    at_ns
        When that was, by the engine's clock; None if the device does not tell.
    """

    every = True
    number: int
    pressed: bool
    at_ns: int | None = None


def moved(before: int, now: int, count: int, at_ns: int) -> list[Event]:
    """Return an event for each button whose bit has changed, among the first ``count``."""
    return [
        Button(bit + 1, pressed=bool(now >> bit & 1), at_ns=at_ns)
        for bit in range(count)
        if (before ^ now) >> bit & 1
    ]


class Knob(Event, frozen=True):
    """A knob of the device was turned to a position from 0 to 1; knobs are counted from 1."""

    number: int
    value: float

    @property
    def key(self) -> Hashable:
        """Turns of one knob are alike."""
        return Knob, self.number


class HandHeld(Event, frozen=True):
    """A person has taken the hand of a simulated device in the live view, or has let it go."""

    every = True
    held: bool

    def say(self) -> str:
        """Sentence for the event."""
        return "hand: moved in the live view" if self.held else "hand: simulated again"


class HandDone(Event, frozen=True):
    """The simulated hand has followed its last order, at a time of the device's clock."""

    every = True
    at_ns: int


class NotInTime(Event, frozen=True):
    """The system refuses what the engine needs to do ticks in time: "priority", "memory"."""

    refused: tuple[str, ...]

    def say(self) -> str:
        """Sentence for the event."""
        what = " and no locked ".join(self.refused)
        return (
            f"timing: the system gives no real-time {what}, so that ticks may come late; to allow "
            f"it, put '@vbraille - rtprio 50' and '@vbraille - memlock unlimited' into "
            f"/etc/security/limits.d/95-vbraille-rtprio.conf, join the group vbraille, and log in "
            f"again"
        )


class Placed(Event, frozen=True):
    """The device waits for another act before it knows its place, or knows it now."""

    every = True
    placing: Placing


class LineRead(Event, frozen=True):
    """The hand was at the end of the line that is shown, and is back at the left."""

    every = True
    line: int
    tick: int
    time_ns: int


class AtStart(Event, frozen=True):
    """The array is at the left, and what is shown can be felt: a trial may begin."""

    every = True
    tick: int
    time_ns: int


class Unfelt(Event, frozen=True):
    """Tell that what is shown cannot be felt from a tick on."""

    every = True
    why: str
    tick: int
    time_ns: int


class FeltAgain(Event, frozen=True):
    """Tell that what is shown can be felt again from a tick on."""

    every = True
    tick: int
    time_ns: int


class Turned(Event, frozen=True):
    """The array is turned too far for what is shown, by some degrees; 0 if it is no more."""

    every = True
    degrees: float
    most: float

    def say(self) -> str:
        """Sentence for the event."""
        if not self.degrees:
            return "upright: braille is felt again"
        side = "left" if self.degrees < 0 else "right"  # against the clock is positive
        return (
            f"turned: the array is turned by {abs(self.degrees):.0f} degrees, and braille is felt "
            f"up to {self.most:.0f}; turn it back to the {side}"
        )


KINDS: Final = tuple(Event.__subclasses__())
_decoder = msgspec.json.Decoder(type=Union[KINDS])  # noqa: UP007


def to_json(event: Event) -> bytes:
    """JSON of an event; `from_json` makes an equal event of it."""
    return msgspec.json.encode(event)


def from_json(told: bytes | str) -> Event:
    """Event of which `to_json` made this."""
    return _decoder.decode(told)


def is_known(event: object) -> bool:
    """Tell whether an event is of a kind defined here, which every part of the program knows."""
    return type(event) in KINDS


def told(events: Iterable[Event]) -> list[str]:
    """Sentences for the reader, one for each event that is to be said."""
    return [sentence for event in events if (sentence := event.say())]


def shown_place(display: Display) -> str:
    """Tell where a carriage is to be shown its place: the left stop, or a corner."""
    if not display.height_mm:
        return "the left stop"
    return f"the {'near' if display.shown_near else 'far'} left corner"


def placing_sentence(placing: Placing, display: Display, *, press: str = "press a key") -> str:
    """Tell what the reader is to do so that the place of a carriage is known, or that it is.

    Parameters
    ----------
    placing
        What is waited for.
    display
        Display of the device, which says where its carriage is to be shown its place.
    press
        How the reader says that the carriage is there.
    """
    if placing is Placing.DONE:
        return "place: known"
    left = "left to the stop"
    if display.height_mm:
        left = f"to {shown_place(display)}, with the array straight"
    return f"place: move {left}, then {press}"


class Throttle:
    """Events for the reader, who must not hear the same a thousand times a second.

    The first event of a key is told at once; of those that follow within a second the last is told
    when the second is over, or within 20 ms if it is a knob's.
    """

    def __init__(self) -> None:
        self._told_ns: dict[Hashable, int] = {}
        self._held: dict[Hashable, Event] = {}
        self._due: list[Event] = []

    def add(self, event: Event) -> None:
        """Add an event that is to be told."""
        if event.every:
            self._due = [*self._due, event][:_MOST]
            return
        key = event.key if len(self._held) < _MOST else type(event)
        self._held.pop(key, None)  # the last one is told last: of "silent" and "back" it is true
        self._held[key] = event

    def take(self, now_ns: int) -> list[Event]:
        """Events that are to be told by now, in order; each is given once."""
        due, self._due = self._due, []
        told_ns = self._told_ns
        for key, event in list(self._held.items()):
            every_ns = _KNOB_NS if isinstance(event, Knob) else _NS_PER_S
            if now_ns - told_ns.get(key, -_NS_PER_S) >= every_ns:
                due.append(self._held.pop(key))
                told_ns[key] = now_ns
        while len(told_ns) > _MOST:
            del told_ns[next(iter(told_ns))]
        return due
