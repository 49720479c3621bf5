"""Sentences for the events of devices and engines: the one place that has words for them."""

from __future__ import annotations

from functools import singledispatch
from typing import TYPE_CHECKING, Final

from vbraille.devices.events import (
    SERIAL_VERSION,
    Back,
    Button,
    Changed,
    Difference,
    Event,
    Exposed,
    Fault,
    HandHeld,
    Knob,
    Notice,
    NotInTime,
    Placed,
    Placing,
    Silent,
    Stalled,
    Stranger,
    Unplugged,
    WatchdogTripped,
)

if TYPE_CHECKING:
    from collections.abc import Iterable

    from vbraille.display import Display

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
# Events that a reader hears of in another way: by what they do, by what he is asked to do, or by
# the error that ends the reading.
_UNSAID: Final = (Button, Knob, Placed, Fault)


def told(events: Iterable[Event]) -> list[str]:
    """Sentences for the reader, one for each event that is to be said."""
    return [say(event) for event in events if not isinstance(event, _UNSAID)]


def say(event: Event) -> str:
    """Sentence for an event, with the number of times if it stands for several."""
    more = f" ({event.times} times in the last second)" if event.times > 1 else ""
    return _say(event) + more


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


@singledispatch
def _say(event: Event) -> str:
    raise TypeError(f"there are no words for {event!r}")


@_say.register
def _(_event: Unplugged) -> str:
    return "device: unplugged; plug it in again and reading goes on"


@_say.register
def _(_event: Silent) -> str:
    return "device: silent, and sent to rest; reading goes on once it speaks"


@_say.register
def _(event: Stalled) -> str:
    return (
        f"device: its driver has not answered for {event.stalled_ms / 1e3:.0f} s; "
        f"reading goes on once it does"
    )


@_say.register
def _(_event: Back) -> str:
    return "device: back"


@_say.register
def _(event: Stranger) -> str:
    if event.version is not None:
        return (
            f"device: a device of version {event.version} of the protocol came back, and this "
            f"vbraille speaks version {SERIAL_VERSION}; plug in {event.was} again and reading "
            f"goes on"
        )
    if event.fault:
        return f"device: what came back says in its INFO what cannot be: {event.fault}"
    others = ", ".join(map(_difference, event.differences))
    if event.name != event.was:
        return (
            f"device: {event.name} came back in its place ({others}); plug in {event.was} again "
            f"and reading goes on"
        )
    return (
        f"device: another {event.was} came back ({others}); plug in the one that reading began "
        f"on, or set this one as that was, and reading goes on"
    )


def _difference(one: Difference) -> str:
    what, unit = _FIELDS[one.what]
    return f"{what} {_plain(one.now)}{unit}, not {_plain(one.was)}{unit}"


def _plain(value: float | str) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    return value if isinstance(value, str) else f"{value:g}"


@_say.register
def _(event: Changed) -> str:
    said = [_change(one) for one in event.what]
    said += [
        f"{number} of its actuators have another {what}"
        for what, number in (
            ("gain", event.gain),
            ("rest level", event.inverted),
            ("fitness for use", event.enabled),
        )
        if number
    ]
    return f"device: changed, for {', '.join(said)}{_TO_DO[event.placing]}"


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


_LATE: Final = {
    "host": "this computer was late, and ",
    "line": "the line was late, and ",
    "device": "it was late itself, and ",
}


@_say.register
def _(event: WatchdogTripped) -> str:
    late = _LATE.get(event.late, "")
    return f"device: {late}no frame reached it in time, so it went to rest; reading goes on"


@_say.register
def _(event: Notice) -> str:
    return f"device: {event.text or f'notice {event.code}'}"


@_say.register
def _(event: Fault) -> str:
    if event.stuck:
        return (
            f"{event.name} does not go to rest, neither when it is told to nor without frames; "
            f"switch it off, and do not read on it until that is mended"
        )
    if event.code is None:
        return f"{event.name} has a fault; switch it off and on, and try again"
    return f"{event.name}: {event.text or f'error {event.code}'}"


@_say.register
def _(event: Button) -> str:
    return f"device: button {event.number} {'pressed' if event.pressed else 'let go'}"


@_say.register
def _(event: Knob) -> str:
    return f"device: knob {event.number} at {event.value:.0%}"


@_say.register
def _(event: Placed) -> str:
    return {
        Placing.DONE: "device: its place is known",
        Placing.MARK: "device: it waits for the carriage to pass its mark",
        Placing.STOP: "device: it waits to be shown its place",
    }[event.placing]


@_say.register
def _(event: HandHeld) -> str:
    return "hand: moved in the live view" if event.held else "hand: simulated again"


@_say.register
def _(event: NotInTime) -> str:
    refused = " and ".join(_REFUSED[one] for one in event.refused)
    return f"timing: {refused}, so that ticks may come late; {_ALLOW}"


@_say.register
def _(event: Exposed) -> str:
    return (
        f"picture: it has moved by itself for {event.limit_s:g} s, and rests, which spares the "
        f"skin; a pause and going on begin it anew"
    )
