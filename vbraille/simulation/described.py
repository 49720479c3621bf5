"""What a simulated controller says of itself."""

from __future__ import annotations

from dataclasses import fields
from typing import TYPE_CHECKING, Any, Final

from vbraille.devices.wire.messages import (
    MOST_BUTTONS,
    MOST_KNOBS,
    VERSION,
    CountSign,
    Encoder,
    Info,
    Info2,
    RestSide,
    TurnSign,
    YCountSign,
)
from vbraille.version import __version__

if TYPE_CHECKING:
    from vbraille.display import Display

# Counts before a described encoder wraps, few so that it wraps on the way: 100 mm of 5 µm.
BEFORE_WRAP: Final = 20_000
# Counts of a simulated angle: 0.0055 degrees each.
COUNTS_PER_TURN: Final = 65_536


def describe(info: Display, encoder: Encoder, version: int = VERSION) -> Info:
    """INFO of a device whose actuators are all alike, and whose encoders wrap on the way.

    One of version 2 has all the buttons and knobs that there is room for. Version 1 knows one axis,
    and says nothing of the others.

    Raises
    ------
    ValueError
        If a number does not fit into its field on the wire.
    """
    first = _describe(info, encoder)
    if version == 1:
        return first
    known: dict[str, Any] = {field.name: getattr(first, field.name) for field in fields(first)}
    known["version"] = version
    width_mm, height_mm = info.contactor_mm or (0.0, 0.0)
    relative = encoder is Encoder.INCREMENTAL
    return Info2(
        **known,
        buttons=MOST_BUTTONS,
        knobs=MOST_KNOBS,
        contactor_width_nm=round(width_mm * 1e6),
        contactor_height_nm=round(height_mm * 1e6),
        height_um=round(info.height_mm * 1e3),
        y_counts_per_m=first.counts_per_m if info.height_mm else 0,
        y_count_sign=YCountSign.TOWARDS,
        far_stop_count=0 if relative else (1 << first.count_bits) - BEFORE_WRAP,
        counts_per_turn=COUNTS_PER_TURN if info.turns else 0,
        turn_sign=TurnSign.ANTICLOCKWISE,
        straight_count=0,
    )


def _describe(info: Display, encoder: Encoder) -> Info:
    """INFO of version 1."""
    actuators = info.rows * info.columns
    counts = round(max(info.travel_mm, info.height_mm) * info.counts_per_mm)
    count_bits = min(max(24, counts.bit_length() + 1), 32)  # the travel is below half the range
    return Info(
        version=1,
        rows=info.rows,
        columns=info.columns,
        column_pitch_nm=round(info.column_pitch_mm * 1e6),
        row_pitch_nm=round(info.row_pitch_mm * 1e6),
        rest_side=RestSide[info.rest_side.upper()],
        top_level=info.levels - 1,
        rate_hz=round(info.rate_hz),
        largest_slew_per_s=0,
        travel_um=round(info.travel_mm * 1e3),
        encoder=encoder,
        counts_per_m=round(info.counts_per_mm * 1e3),
        count_sign=CountSign.RIGHTWARD,
        count_bits=count_bits,
        left_stop_count=0 if encoder is Encoder.INCREMENTAL else (1 << count_bits) - BEFORE_WRAP,
        name=info.name,
        firmware=__version__,
        inverted=bytes(actuators),
        gain=b"\xff" * actuators,
        enabled=b"\1" * actuators,
    )
