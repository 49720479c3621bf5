"""What a simulated controller says of itself."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from vbraille.devices.serial.wire import (
    MOST_BUTTONS,
    MOST_KNOBS,
    VERSION,
    CountSign,
    Encoder,
    Info,
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


def describe(display: Display, encoder: Encoder) -> Info:
    """INFO of a device whose actuators are all alike, and whose encoders wrap on the way.

    It has all the buttons and knobs that there is room for.

    Raises
    ------
    ValueError
        If a number does not fit into its field on the wire.
    """
    actuators = display.rows * display.columns
    counts = round(max(display.travel_mm, display.height_mm) * display.counts_per_mm)
    count_bits = min(max(24, counts.bit_length() + 1), 32)  # the travel is below half the range
    counts_per_m = round(display.counts_per_mm * 1e3)
    stop_count = 0 if encoder is Encoder.INCREMENTAL else (1 << count_bits) - BEFORE_WRAP
    width_mm, height_mm = display.contactor_mm or (0.0, 0.0)
    return Info(
        version=VERSION,
        rows=display.rows,
        columns=display.columns,
        column_pitch_nm=round(display.column_pitch_mm * 1e6),
        row_pitch_nm=round(display.row_pitch_mm * 1e6),
        rest_side=RestSide[display.rest_side.upper()],
        top_level=display.levels - 1,
        rate_hz=round(display.rate_hz),
        largest_slew_per_s=0,
        travel_um=round(display.travel_mm * 1e3),
        encoder=encoder,
        counts_per_m=counts_per_m,
        count_sign=CountSign.RIGHTWARD,
        count_bits=count_bits,
        left_stop_count=stop_count,
        name=display.name,
        firmware=__version__,
        inverted=bytes(actuators),
        gain=b"\xff" * actuators,
        enabled=b"\1" * actuators,
        buttons=MOST_BUTTONS,
        knobs=MOST_KNOBS,
        contactor_width_nm=round(width_mm * 1e6),
        contactor_height_nm=round(height_mm * 1e6),
        height_um=round(display.height_mm * 1e3),
        y_counts_per_m=counts_per_m if display.height_mm else 0,
        y_count_sign=YCountSign.TOWARDS,
        far_stop_count=stop_count,
        counts_per_turn=COUNTS_PER_TURN if display.turns else 0,
        turn_sign=TurnSign.ANTICLOCKWISE,
        straight_count=0,
    )
