"""Events of a device, or of the engine that drives it: facts with numbers, no sentences.

`vbraille.devices.sentences` makes sentences of them. What has no kind of its own here, a driver
tells as a `Notice`.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass, field, fields, replace
from enum import IntEnum
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable, Mapping, Sequence


# Version of the serial protocol, which a sentence on a stranger names.
SERIAL_VERSION: Final = 2


class Placing(IntEnum):
    """Act that a device waits for before it knows where its carriage is."""

    DONE = 0  # nothing: it knows
    MARK = 1  # the reader moves the carriage over the encoder's mark
    STOP = 2  # the reader moves it to the left stop and presses a key: `Device.set_zero`


@dataclass(frozen=True, slots=True)
class Event:
    """Something that happened.

    Parameters
    ----------
    times
        How often it happened, where one event stands for all that came within a second.
    """

    times: int = field(default=1, kw_only=True)

    @property
    def kind(self) -> Hashable:
        """Key of events that stand for one another: one of each kind is told in a second."""
        return type(self)

    @property
    def tells_place(self) -> bool:
        """Tell whether an event says where something is: only the last of its kind matters."""
        return False


@dataclass(frozen=True, slots=True)
class Unplugged(Event):
    """The port is gone; reading goes on when the device is plugged in again."""


@dataclass(frozen=True, slots=True)
class Silent(Event):
    """The device sends nothing any more, and was told to rest.

    Parameters
    ----------
    silent_ms
        Time for which the device has been silent, in ms.
    """

    silent_ms: float


@dataclass(frozen=True, slots=True)
class Stalled(Event):
    """The driver has not come back from a call, so that the device is neither read nor sent frames.

    Parameters
    ----------
    stalled_ms
        Time for which no tick was done, in ms.
    """

    stalled_ms: float


@dataclass(frozen=True, slots=True)
class Back(Event):
    """A device that was away can be read on again."""


@dataclass(frozen=True, slots=True)
class Difference:
    """One property in which a device differs from what it was.

    Parameters
    ----------
    what
        Name of a field of `Display`, or of INFO.
    was, now
        What the field was before, and what it is now.
    """

    what: str
    was: float | str
    now: float | str


@dataclass(frozen=True, slots=True)
class Stranger(Event):
    """A device has come back that cannot take the place of the one that reading began on.

    Parameters
    ----------
    was
        Name of the device that reading began on.
    name
        Name of the device that came back; empty if it does not say.
    differences
        Fields of `Display` in which the two differ.
    version
        Version of the protocol that the device speaks, if it is another one.
    fault
        What in the device's description cannot be true, with field and value; empty if nothing.
    """

    was: str
    name: str = ""
    differences: tuple[Difference, ...] = ()
    version: int | None = None
    fault: str = ""


@dataclass(frozen=True, slots=True)
class Changed(Event):
    """A device that came back differs from what it was, but can be read on.

    Parameters
    ----------
    what
        Fields of INFO in which it differs.
    gain, inverted, enabled
        Numbers of actuators that have another gain, another rest level, and another fitness for
        use.
    placing
        What the reader has to do before the place is known again.
    """

    what: tuple[Difference, ...] = ()
    gain: int = 0
    inverted: int = 0
    enabled: int = 0
    placing: Placing = Placing.DONE


@dataclass(frozen=True, slots=True)
class WatchdogTripped(Event):
    """The device went to rest, or is about to, because no frame reached it in time.

    Parameters
    ----------
    trips
        Number of trips of its watchdog that the device has reported so far.
    late
        Part that was late: "host", "line" or "device"; empty if that is not known.
    """

    trips: int
    late: str = ""


@dataclass(frozen=True, slots=True)
class Notice(Event):
    """The device says something in words of its own, and goes on.

    Parameters
    ----------
    code
        Number that the device's maker has given to the notice.
    text
        The device's words, which may be empty.
    """

    code: int
    text: str

    @property
    def kind(self) -> Hashable:
        """Notices with one code are of one kind."""
        return type(self), self.code


@dataclass(frozen=True, slots=True)
class Fault(Event):
    """The device cannot go on; `Device.read` raises this in a `DeviceError` as well.

    Parameters
    ----------
    name
        Name of the device.
    code
        Number that the device gives to the fault; None if it does not say what is wrong.
    text
        The device's words, which may be empty.
    stuck
        Whether the device does not go to rest though it must.
    """

    name: str
    code: int | None = None
    text: str = ""
    stuck: bool = False


@dataclass(frozen=True, slots=True)
class Button(Event):
    """A button of the device was pressed or let go.

    Parameters
    ----------
    number
        Number of the button, counted from 1.
    pressed
        Whether the button is down now.
    at_ns
        When that was, by the engine's clock; None if the device does not tell.
    """

    number: int
    pressed: bool
    at_ns: int | None = field(default=None, kw_only=True, compare=False)

    @property
    def kind(self) -> Hashable:
        """No event stands for another: each press of each button is told."""
        return None


@dataclass(frozen=True, slots=True)
class Knob(Event):
    """A knob of the device was turned.

    Parameters
    ----------
    number
        Number of the knob, counted from 1.
    value
        Position of the knob, 0 to 1.
    """

    number: int
    value: float

    @property
    def kind(self) -> Hashable:
        """Turns of the same knob stand for one another."""
        return type(self), self.number

    @property
    def tells_place(self) -> bool:
        """A knob that is being turned is followed, and stands in the end where it was left."""
        return True


@dataclass(frozen=True, slots=True)
class Placed(Event):
    """The device waits for another act before it knows its place.

    Parameters
    ----------
    placing
        What the device waits for now.
    """

    placing: Placing

    @property
    def kind(self) -> Hashable:
        """No event stands for another: each change is told."""
        return None


@dataclass(frozen=True, slots=True)
class HandHeld(Event):
    """A person has taken the hand of a simulated device in the live view, or has let it go.

    Parameters
    ----------
    held
        Whether a person holds the hand now.
    """

    held: bool

    @property
    def kind(self) -> Hashable:
        """No event stands for another: each change is told."""
        return None


@dataclass(frozen=True, slots=True)
class NotInTime(Event):
    """The system refuses to give the engine what it needs to do ticks in time.

    Parameters
    ----------
    refused
        What is refused: "priority", "memory", or both.
    """

    refused: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Exposed(Event):
    """A picture has moved by itself for as long as it may, and was faded to rest.

    Parameters
    ----------
    limit_s
        Longest time that a picture may move by itself, in seconds.
    """

    limit_s: float


_KINDS: Final = {
    kind.__name__: kind
    for kind in (
        Unplugged,
        Silent,
        Stalled,
        Back,
        Stranger,
        Changed,
        WatchdogTripped,
        Notice,
        Fault,
        Button,
        Knob,
        Placed,
        HandHeld,
        NotInTime,
        Exposed,
    )
}


def is_known(event: object) -> bool:
    """Tell whether an event is of a kind defined here, which every part of a program knows."""
    return type(event) in _KINDS.values()


def to_json(event: Event) -> dict[str, Any]:
    """Values of an event that JSON can hold; `from_json` makes an equal event of them."""
    return {"event": type(event).__name__, **asdict(event)}


def from_json(told: Mapping[str, Any]) -> Event:
    """Event of which `to_json` made these values."""
    values = {name: _value(name, value) for name, value in told.items() if name != "event"}
    return _KINDS[told["event"]](**values)


def shortened(event: Event, most: int) -> Event:
    """Event whose texts are cut to a number of characters."""

    def cut(value: object) -> object:
        if isinstance(value, str):
            return value[:most]
        if isinstance(value, Difference):
            return Difference(value.what, _cut(value.was, most), _cut(value.now, most))
        return tuple(map(cut, value)) if isinstance(value, tuple) else value

    return _changed(event, cut)


def _cut(value: float | str, most: int) -> float | str:
    return value[:most] if isinstance(value, str) else value


def _changed(event: Event, change: Callable[[object], Any]) -> Event:
    values = {one.name: change(getattr(event, one.name)) for one in fields(event)}
    return replace(event, **values)


def _value(name: str, value: Any) -> Any:
    if name == "placing":
        return Placing(value)
    if isinstance(value, dict):
        return Difference(**value)
    return tuple(_value("", one) for one in value) if isinstance(value, list) else value


EVERY_NS: Final = 1_000_000_000
PLACE_EVERY_NS: Final = 20_000_000  # of a knob: a finger feels each change at once
# So many kinds are told apart at a time; further ones share a kind.
_MOST_KINDS = 16
_OTHERS = "others"
# So many events wait to be taken; a button that bounces for ever must not fill the memory.
_MOST_DUE = 256


@dataclass(slots=True)
class _NoticeKind:
    """State of one kind of event: when it was told last, and what came since."""

    told_ns: int
    event: Event
    held: int = 0

    def due(self, now_ns: int) -> bool:
        """Tell whether the next event of the kind may be told."""
        every_ns = PLACE_EVERY_NS if self.event.tells_place else EVERY_NS
        return now_ns - self.told_ns >= every_ns


class Notices:
    """Events for the reader, who must not have to hear the same a thousand times a second.

    The first event of a kind is told at once. Those that follow within a second are counted; when
    the second is over, the last of them is told with their number. Where only the last matters, as
    of a knob, it is told fifty times a second, without a number.
    """

    def __init__(self) -> None:
        self._kinds: dict[Hashable, _NoticeKind] = {}
        self._due: list[Event] = []
        self._holding = False

    def add(self, event: Event, now_ns: int, kind: Hashable = None) -> None:
        """Add an event that is to be told.

        Parameters
        ----------
        event
            The event.
        now_ns
            Time by a clock that does not go back.
        kind
            Key of events that are throttled together; None for the event's own kind. An event
            without a kind is told as often as it happens.
        """
        kind = kind or event.kind
        if kind is None:
            self._tell(event)
            return
        if kind not in self._kinds and len(self._kinds) >= _MOST_KINDS:
            self._forget(now_ns)
            kind = kind if len(self._kinds) < _MOST_KINDS else _OTHERS
        known = self._kinds.get(kind)
        if known is None or (not known.held and known.due(now_ns)):
            self._kinds[kind] = _NoticeKind(now_ns, event)
            self._tell(event)
            return
        # The event held last is told last: of "silent" and "back" the later one is true.
        self._kinds[kind] = self._kinds.pop(kind)
        known.event = event
        known.held += 1
        self._holding = True

    def take(self, now_ns: int) -> Sequence[Event]:
        """Events that are to be told by now, in order; each is given once."""
        if self._holding:
            self._release(now_ns)
        due, self._due = self._due, []
        return due

    def _tell(self, event: Event) -> None:
        if len(self._due) < _MOST_DUE:
            self._due.append(event)

    def _forget(self, now_ns: int) -> None:
        """Forget kinds of which the next event may be told at once."""
        self._kinds = {
            name: kind for name, kind in self._kinds.items() if kind.held or not kind.due(now_ns)
        }

    def _release(self, now_ns: int) -> None:
        """Release events that were held for a second."""
        self._holding = False
        for kind in self._kinds.values():
            if not kind.held:
                continue
            if not kind.due(now_ns):
                self._holding = True
                continue
            counted = kind.held > 1 and not kind.event.tells_place
            self._tell(replace(kind.event, times=kind.held) if counted else kind.event)
            kind.told_ns, kind.held = now_ns, 0
