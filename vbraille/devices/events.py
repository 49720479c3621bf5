"""Events of a device, or of the engine that drives it: facts with numbers, and their sentences.

What has no kind of its own here, a driver tells as a `Notice`.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass, field, replace
from enum import IntEnum
from typing import TYPE_CHECKING, Any, Final

import msgspec

if TYPE_CHECKING:
    from collections.abc import Hashable, Iterable, Mapping, Sequence

    from vbraille.display import Display


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

    def say(self) -> str:
        """Sentence for the event, with the number of times if it stands for several."""
        more = f" ({self.times} times in the last second)" if self.times > 1 else ""
        return self._said() + more

    def _said(self) -> str:
        raise TypeError(f"there are no words for {self!r}")


@dataclass(frozen=True, slots=True)
class Unplugged(Event):
    """The port is gone; reading goes on when the device is plugged in again."""

    def _said(self) -> str:
        return "device: unplugged; plug it in again and reading goes on"


@dataclass(frozen=True, slots=True)
class Silent(Event):
    """The device sends nothing any more, and was told to rest.

    Parameters
    ----------
    silent_ms
        Time for which the device has been silent, in ms.
    """

    silent_ms: float

    def _said(self) -> str:
        return "device: silent, and sent to rest; reading goes on once it speaks"


@dataclass(frozen=True, slots=True)
class Stalled(Event):
    """The driver has not come back from a call, so that the device is neither read nor sent frames.

    Parameters
    ----------
    stalled_ms
        Time for which no tick was done, in ms.
    """

    stalled_ms: float

    def _said(self) -> str:
        return (
            f"device: its driver has not answered for {self.stalled_ms / 1e3:.0f} s; "
            f"reading goes on once it does"
        )


@dataclass(frozen=True, slots=True)
class Back(Event):
    """A device that was away can be read on again."""

    def _said(self) -> str:
        return "device: back"


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
    was: bool | int | float | str
    now: bool | int | float | str


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

    def _said(self) -> str:
        if self.version is not None:
            return (
                f"device: a device of version {self.version} of the protocol came back, and this "
                f"vbraille speaks version {SERIAL_VERSION}; plug in {self.was} again and reading "
                f"goes on"
            )
        if self.fault:
            return f"device: what came back says in its INFO what cannot be: {self.fault}"
        others = ", ".join(map(_difference, self.differences))
        if self.name != self.was:
            return (
                f"device: {self.name} came back in its place ({others}); plug in {self.was} again "
                f"and reading goes on"
            )
        return (
            f"device: another {self.was} came back ({others}); plug in the one that reading began "
            f"on, or set this one as that was, and reading goes on"
        )


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

    def _said(self) -> str:
        said = [_change(one) for one in self.what]
        said += [
            f"{number} of its actuators have another {what}"
            for what, number in (
                ("gain", self.gain),
                ("rest level", self.inverted),
                ("fitness for use", self.enabled),
            )
            if number
        ]
        return f"device: changed, for {', '.join(said)}{_TO_DO[self.placing]}"


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

    def _said(self) -> str:
        late = _LATE.get(self.late, "")
        return f"device: {late}no frame reached it in time, so it went to rest; reading goes on"


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

    def _said(self) -> str:
        return f"device: {self.text or f'notice {self.code}'}"


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

    def _said(self) -> str:
        if self.stuck:
            return (
                f"{self.name} does not go to rest, neither when it is told to nor without frames; "
                f"switch it off, and do not read on it until that is mended"
            )
        if self.code is None:
            return f"{self.name} has a fault; switch it off and on, and try again"
        return f"{self.name}: {self.text or f'error {self.code}'}"


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

    def _said(self) -> str:
        return f"device: button {self.number} {'pressed' if self.pressed else 'let go'}"


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

    def _said(self) -> str:
        return f"device: knob {self.number} at {self.value:.0%}"


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

    def _said(self) -> str:
        return {
            Placing.DONE: "device: its place is known",
            Placing.MARK: "device: it waits for the carriage to pass its mark",
            Placing.STOP: "device: it waits to be shown its place",
        }[self.placing]


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

    def _said(self) -> str:
        return "hand: moved in the live view" if self.held else "hand: simulated again"


@dataclass(frozen=True, slots=True)
class NotInTime(Event):
    """The system refuses to give the engine what it needs to do ticks in time.

    Parameters
    ----------
    refused
        What is refused: "priority", "memory", or both.
    """

    refused: tuple[str, ...]

    def _said(self) -> str:
        refused = " and ".join(_REFUSED[one] for one in self.refused)
        return f"timing: {refused}, so that ticks may come late; {_ALLOW}"


@dataclass(frozen=True, slots=True)
class Exposed(Event):
    """A picture has moved by itself for as long as it may, and was faded to rest.

    Parameters
    ----------
    limit_s
        Longest time that a picture may move by itself, in seconds.
    """

    limit_s: float

    def _said(self) -> str:
        return (
            f"picture: it has moved by itself for {self.limit_s:g} s, and rests, which spares the "
            f"skin; a pause and going on begin it anew"
        )


# Names and units of the fields of a display.
_FIELDS: Final = {
    "rows": ("rows of actuators", ""),
    "columns": ("columns of actuators", ""),
    "column_pitch_mm": ("pitch along the line", " mm"),
    "row_pitch_mm": ("pitch across the line", " mm"),
    "levels": ("levels", ""),
    "rest_side": ("rest side", ""),
    "travel_mm": ("travel", " mm"),
    "height_mm": ("way across the lines", " mm"),
    "turns": ("measured angles", ""),
    "rate_hz": ("rate", " Hz"),
}
_TO_DO: Final = {
    Placing.DONE: "",
    Placing.MARK: "; if asked to, move the carriage over its mark",
    Placing.STOP: "; its place must be shown again",
}
# Which way counts grow, in words.
_PLAIN: Final[dict[object, str]] = {
    "towards": "towards the reader",
    "away": "away from the reader",
    "anticlockwise": "against the clock",
    "clockwise": "with the clock",
}
_REFUSED: Final = {"priority": "no real-time priority", "memory": "no locked memory"}
_ALLOW: Final = (
    "to allow it, put '@audio - rtprio 95' and '@audio - memlock unlimited' into "
    "/etc/security/limits.d/audio.conf, join the group audio, and log in again"
)
_LATE: Final = {
    "host": "this computer was late, and ",
    "line": "the line was late, and ",
    "device": "it was late itself, and ",
}


def _difference(one: Difference) -> str:
    what, unit = _FIELDS[one.what]
    return f"{what} {_plain(one.now)}{unit}, not {_plain(one.was)}{unit}"


def _plain(value: float | str) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    return value if isinstance(value, str) else f"{value:g}"


def _change(one: Difference) -> str:
    was, now = one.was, one.now
    match one.what:
        case "name":
            return f"its name is {now}, not {was}"
        case "counts_per_m":
            per_mm = [f"{1e6 / float(count):.6g} µm" for count in (now, was)]
            return f"a count is {per_mm[0]}, not {per_mm[1]}"
        case "count_sign":
            return f"its counts grow {now}"
        case "encoder":
            return f"its encoder is {now}, not {was}"
        case "y_counts_per_m":
            per_mm = [f"{1e6 / float(count or 1):.6g} µm" for count in (now, was)]
            return f"a count across the lines is {per_mm[0]}, not {per_mm[1]}"
        case "y_count_sign":
            return f"its counts across the lines grow {_PLAIN[now]}"
        case "counts_per_turn":
            return f"a turn of its array is {now} counts, not {was}"
        case "turn_sign":
            return f"its counts grow as it turns {_PLAIN[now]}"
        case "left_stop_count" | "far_stop_count":
            return f"its {one.what.split('_')[0]} stop is at count {now}, not {was}"
        case "straight_count":
            return f"its array is straight at count {now}, not {was}"
    return f"its actuators may move {_slew(now)}, not {_slew(was)}"


def _slew(speed: float | str) -> str:
    return f"{speed} swings a second" if speed else "without a limit"


# Of a dataclass with slots there are two classes by a name, and the later one is meant.
_KINDS: Final = {kind.__name__: kind for kind in Event.__subclasses__()}


# Events that a reader hears of in another way: by what they do, by what he is asked to do, or by
# the error that ends the reading.
_UNSAID: Final = (Button, Knob, Placed, Fault)


def told(events: Iterable[Event]) -> list[str]:
    """Sentences for the reader, one for each event that is to be said."""
    return [event.say() for event in events if not isinstance(event, _UNSAID)]


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
    if placing is Placing.MARK:
        return "place: move the carriage over its mark"
    if not display.height_mm:
        return f"place: move left to the stop, then {press}"
    return f"place: move to {shown_place(display)}, with the array straight, then {press}"


def shown_place(display: Display) -> str:
    """Tell where a carriage is to be shown its place: the left stop, or a corner."""
    if not display.height_mm:
        return "the left stop"
    return f"the {'near' if display.shown_near else 'far'} left corner"


def is_known(event: object) -> bool:
    """Tell whether an event is of a kind defined here, which every part of a program knows."""
    return type(event) in _KINDS.values()


def to_json(event: Event) -> dict[str, Any]:
    """Values of an event that JSON can hold; `from_json` makes an equal event of them."""
    return {"event": type(event).__name__, **asdict(event)}


def from_json(told: Mapping[str, Any]) -> Event:
    """Event of which `to_json` made these values."""
    values = {name: value for name, value in told.items() if name != "event"}
    return msgspec.convert(values, _KINDS[told["event"]])


def shortened(event: Event, most: int) -> Event:
    """Event whose texts are cut to a number of characters."""

    def cut(value: Any) -> Any:
        if isinstance(value, str):
            return value[:most]
        if isinstance(value, dict):
            return {name: cut(one) for name, one in value.items()}
        return [*map(cut, value)] if isinstance(value, tuple) else value

    return from_json({**cut(asdict(event)), "event": type(event).__name__})


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
