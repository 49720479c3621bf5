"""What has become of a device that came back: the same, changed, or another one."""

from __future__ import annotations

from enum import IntEnum
from typing import TYPE_CHECKING, Final

from vbraille.devices.events import Changed, Difference, Placing
from vbraille.devices.wire.messages import Encoder

if TYPE_CHECKING:
    from vbraille.devices.wire.messages import Info
    from vbraille.display import Display

_OF_DISPLAY: Final = (
    "rows",
    "columns",
    "column_pitch_mm",
    "row_pitch_mm",
    "levels",
    "rest_side",
    "travel_mm",
    "height_mm",
    "turns",
    "rate_hz",
)
# Fields of INFO about y and θ, which version 1 has not.
_OF_AXES: Final = ("y_counts_per_m", "y_count_sign", "counts_per_turn", "turn_sign")
PLACING: Final = {
    Encoder.ABSOLUTE: Placing.DONE,
    Encoder.INDEX: Placing.MARK,
    Encoder.INCREMENTAL: Placing.STOP,
}


def differences(was: Display, now: Display) -> tuple[Difference, ...]:
    """Fields of a device in which it differs from what a page and a loop were made for.

    The name does not count, and neither does the resolution: places are in millimetres.
    """
    both = ((name, getattr(was, name), getattr(now, name)) for name in _OF_DISPLAY)
    return tuple(Difference(name, old, new) for name, old, new in both if old != new)


def changes(was: Info, now: Info) -> Changed | None:
    """What has changed in a device that can be read on, since the conversation before."""
    what = [
        Difference("name", was.name, now.name),
        Difference("counts_per_m", was.counts_per_m, now.counts_per_m),
        Difference("count_sign", was.count_sign.name.lower(), now.count_sign.name.lower()),
        Difference("encoder", was.encoder.name.lower(), now.encoder.name.lower()),
    ]
    for name in _OF_AXES:
        old, new = (getattr(info, name, None) for info in (was, now))
        if old is not None and new is not None:  # of one version, or both have it
            what.append(Difference(name, _said(old), _said(new)))
    if now.encoder is not Encoder.INCREMENTAL:  # the reader shows where its stops are
        for name in ("left_stop_count", "far_stop_count", "straight_count"):
            old, new = (getattr(info, name, None) for info in (was, now))
            if old is not None and new is not None:
                what.append(Difference(name, old, new))
    what.append(Difference("largest_slew_per_s", was.largest_slew_per_s, now.largest_slew_per_s))
    changed = Changed(
        tuple(each for each in what if each.was != each.now),
        _others(was.gain, now.gain),
        _others(was.inverted, now.inverted),
        _others(was.enabled, now.enabled),
        PLACING[now.encoder],
    )
    none = Changed(placing=changed.placing)
    return None if changed == none else changed


def _said(value: int) -> int | str:
    """Name of a sign; any other number as it is."""
    return value.name.lower() if isinstance(value, IntEnum) else value


def _others(was: bytes, now: bytes) -> int:
    """Number of actuators that have another value."""
    return sum(old != new for old, new in zip(was, now, strict=True))
