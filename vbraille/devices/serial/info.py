"""INFO of a device: what it tells those who read on it, and what has changed since it was lost."""

from __future__ import annotations

from enum import IntEnum
from typing import TYPE_CHECKING, Final

from vbraille.devices.base import Particulars
from vbraille.devices.events import Changed, Difference, Placing
from vbraille.devices.serial.wire import Encoder
from vbraille.display import Display

if TYPE_CHECKING:
    from collections.abc import Iterable

    from vbraille.devices.serial.wire import Info

# How far the carriage goes, and how finely that is counted, by the fields of INFO.
_AXES: Final = (("travel_um", "counts_per_m"), ("height_um", "y_counts_per_m"))


def misfit(info: Info) -> str:
    """Reason why a device cannot be read on, with fields and values; empty if it can."""
    # One count alone tells where the carriage is when the conversation begins.
    told = 1 << (info.count_bits - 1)
    for way, per_m in _AXES:
        way_um, counts_per_m = getattr(info, way), getattr(info, per_m)
        if way_um and not counts_per_m:
            return f"{way} is {way_um}, and {per_m} is 0; a carriage that goes there counts it"
        counts = way_um * counts_per_m // 1_000_000
        if counts >= told and info.encoder is not Encoder.INCREMENTAL:
            return (
                f"{way} is {way_um}, which takes {counts} counts with a {per_m} of "
                f"{counts_per_m}; it must take less than {told}, half the range of count_bits "
                f"{info.count_bits}"
            )
    return ""


def info_of(info: Info) -> Display:
    """Display of a device, in mm, from what it says of itself."""
    contactor_mm = None
    if info.contactor_width_nm and info.contactor_height_nm:
        contactor_mm = info.contactor_width_nm / 1e6, info.contactor_height_nm / 1e6
    return Display(
        name=info.name,
        rows=info.rows,
        columns=info.columns,
        column_pitch_mm=info.column_pitch_nm / 1e6,
        row_pitch_mm=info.row_pitch_nm / 1e6,
        levels=info.top_level + 1,
        rest_side=info.rest_side.name.lower(),
        travel_mm=info.travel_um / 1e3,
        counts_per_mm=info.counts_per_m / 1e3,
        rate_hz=float(info.rate_hz),
        height_mm=info.height_um / 1e3,
        turns=info.counts_per_turn > 0,
        contactor_mm=contactor_mm,
    )


_ENCODERS: Final = {
    Encoder.ABSOLUTE: "absolute",
    Encoder.INDEX: "relative, with an index mark that must be passed",
    Encoder.INCREMENTAL: "relative, and must be shown the left stop",
}


def particulars_of(info: Info) -> Particulars:
    """Particulars of a device, which reading does not ask for, from what it says of itself."""

    def where(chosen: Iterable[bool]) -> tuple[tuple[int, int], ...]:
        return tuple(divmod(at, info.columns) for at, is_one in enumerate(chosen) if is_one)

    return Particulars(
        firmware=info.firmware,
        encoder=_ENCODERS[info.encoder],
        largest_slew_per_s=info.largest_slew_per_s,
        disabled=where(not (on and gain) for on, gain in zip(info.enabled, info.gain, strict=True)),
        inverted=where(map(bool, info.inverted)),
        protocol=f"serial, version {info.version}",
        buttons=info.buttons,
        knobs=info.knobs,
    )


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
