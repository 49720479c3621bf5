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
# Fields of INFO that may change, and those of them that are the reader's to show where encoders are
# incremental.
_OF_INFO: Final = (
    "name",
    "counts_per_m",
    "count_sign",
    "encoder",
    "y_counts_per_m",
    "y_count_sign",
    "counts_per_turn",
    "turn_sign",
    "left_stop_count",
    "far_stop_count",
    "straight_count",
    "largest_slew_per_s",
)
_SHOWN: Final = ("left_stop_count", "far_stop_count", "straight_count")
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
    shown = _SHOWN if now.encoder is Encoder.INCREMENTAL else ()
    both = (
        (name, _said(getattr(was, name)), _said(getattr(now, name)))
        for name in _OF_INFO
        if name not in shown
    )
    changed = Changed(
        tuple(Difference(name, old, new) for name, old, new in both if old != new),
        _others(was.gain, now.gain),
        _others(was.inverted, now.inverted),
        _others(was.enabled, now.enabled),
        PLACING[now.encoder],
    )
    none = Changed(placing=changed.placing)
    return None if changed == none else changed


def _said(value: int | str) -> int | str:
    """Name of a member of an enumeration; any other value as it is."""
    return value.name.lower() if isinstance(value, IntEnum) else value


def _others(was: bytes, now: bytes) -> int:
    """Number of actuators that have another value."""
    return sum(old != new for old, new in zip(was, now, strict=True))
