"""What a device, or the engine that drives it, has to tell: facts with numbers, no sentences.

`vbraille.devices.saying` makes sentences of them. What has no kind of its own here, a driver
tells as a `Notice`.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass, field, fields, replace
from enum import IntEnum
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable, Mapping


class Placing(IntEnum):
    """What a device waits for before it knows where its carriage is."""

    DONE = 0  # nothing: it knows
    MARK = 1  # the reader moves the carriage over the encoder's mark
    STOP = 2  # the reader moves it to the left stop and presses a key: `Device.set_zero`


@dataclass(frozen=True, slots=True)
class Event:
    """Something that happened.

    Parameters
    ----------
    times
        How often, where it is told once for all the times in a second.
    """

    times: int = field(default=1, kw_only=True)

    @property
    def kind(self) -> Hashable:
        """What is told once a second at most; events of one kind stand for one another."""
        return type(self)


@dataclass(frozen=True, slots=True)
class Unplugged(Event):
    """The port is gone; reading goes on when the device is plugged in again."""


@dataclass(frozen=True, slots=True)
class Silent(Event):
    """The device sends nothing any more, and was told to rest.

    Parameters
    ----------
    silent_ms
        For how long it has been silent.
    """

    silent_ms: float


@dataclass(frozen=True, slots=True)
class Back(Event):
    """A device that was away is read on again."""


@dataclass(frozen=True, slots=True)
class Difference:
    """One property in which a device is otherwise than before.

    Parameters
    ----------
    what
        Field of `Display`, or of INFO.
    was, now
        Its values.
    """

    what: str
    was: float | str
    now: float | str


@dataclass(frozen=True, slots=True)
class Stranger(Event):
    """What came back cannot be read on in the place of the device that reading began on.

    Parameters
    ----------
    was
        Name of the device that reading began on.
    name
        Name of what came back; empty if it does not say.
    differences
        In what it is otherwise: fields of `Display`.
    version
        Of the protocol that it speaks, if it is another one.
    fault
        What cannot be in what it says of itself, with field and value; empty if that is not it.
    """

    was: str
    name: str = ""
    differences: tuple[Difference, ...] = ()
    version: int | None = None
    fault: str = ""


@dataclass(frozen=True, slots=True)
class Changed(Event):
    """A device that came back is otherwise than it was, and can be read on.

    Parameters
    ----------
    what
        In what: fields of INFO.
    gain, inverted, enabled
        How many of its actuators have another gain, rest level, and fitness for use.
    placing
        What the reader has to do before its place is known again.
    """

    what: tuple[Difference, ...] = ()
    gain: int = 0
    inverted: int = 0
    enabled: int = 0
    placing: Placing = Placing.DONE


@dataclass(frozen=True, slots=True)
class WatchdogTripped(Event):
    """No frame reached the device in time, so it went to rest, or is about to.

    Parameters
    ----------
    trips
        Trips of its watchdog that the device has told of until now.
    """

    trips: int


@dataclass(frozen=True, slots=True)
class Notice(Event):
    """What a device says in words of its own, and goes on.

    Parameters
    ----------
    code
        Its maker's number for it.
    text
        Its words; may be empty.
    """

    code: int
    text: str

    @property
    def kind(self) -> Hashable:
        """Notices with one code are of one kind."""
        return type(self), self.code


@dataclass(frozen=True, slots=True)
class Fault(Event):
    """Why a device cannot go on; `Device.read` raises it in a `DeviceError` as well.

    Parameters
    ----------
    name
        The device's.
    code
        The device's number for it; None if it does not say what is wrong.
    text
        Its words; may be empty.
    stuck
        Whether it does not go to rest when it must.
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
        From 1.
    pressed
        Whether it is down now.
    """

    number: int
    pressed: bool

    @property
    def kind(self) -> Hashable:
        """Each press of each button is one of its own."""
        return None


@dataclass(frozen=True, slots=True)
class Knob(Event):
    """A knob of the device was turned.

    Parameters
    ----------
    number
        From 1.
    value
        Where it stands, 0 to 1.
    """

    number: int
    value: float

    @property
    def kind(self) -> Hashable:
        """Knobs stand for themselves."""
        return type(self), self.number


@dataclass(frozen=True, slots=True)
class Placed(Event):
    """What a device waits for before it knows its place has changed.

    Parameters
    ----------
    placing
        What it is now.
    """

    placing: Placing

    @property
    def kind(self) -> Hashable:
        """Each change is one of its own."""
        return None


@dataclass(frozen=True, slots=True)
class NotInTime(Event):
    """The system refuses the engine what it needs for ticks in time.

    Parameters
    ----------
    refused
        "priority", "memory", or both.
    """

    refused: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Exposed(Event):
    """A picture has moved by itself for as long as it may, and was faded to rest.

    Parameters
    ----------
    limit_s
        How long that is, in seconds.
    """

    limit_s: float


_KINDS: Final = {
    kind.__name__: kind
    for kind in (
        Unplugged,
        Silent,
        Back,
        Stranger,
        Changed,
        WatchdogTripped,
        Notice,
        Fault,
        Button,
        Knob,
        Placed,
        NotInTime,
        Exposed,
    )
}


def is_known(event: object) -> bool:
    """Whether something is an event of one of these kinds, which every part of a program knows."""
    return type(event) in _KINDS.values()


def to_json(event: Event) -> dict[str, Any]:
    """Event as it goes through JSON; `from_json` gives an equal one."""
    return {"event": type(event).__name__, **asdict(event)}


def from_json(told: Mapping[str, Any]) -> Event:
    """Event that `to_json` made this of."""
    values = {name: _value(name, value) for name, value in told.items() if name != "event"}
    return _KINDS[told["event"]](**values)


def shortened(event: Event, most: int) -> Event:
    """Event whose texts have so many characters at most."""

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
