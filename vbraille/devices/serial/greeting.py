"""The greeting: HELLO, and what INFO tells of a device for those who read on it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from vbraille.devices.base import Particulars
from vbraille.devices.wire.codec import DELIMITER, encode
from vbraille.devices.wire.messages import Encoder, Hello
from vbraille.display import Display

if TYPE_CHECKING:
    from collections.abc import Iterable

    from vbraille.devices.wire.messages import Info

# The zero ends whatever was on the line before.
HELLO: Final = DELIMITER + encode(Hello())


def misfit(info: Info) -> str:
    """Reason why a device cannot be read on, with fields and values; empty if it can."""
    if info.encoder is Encoder.INCREMENTAL:
        return ""
    # One count alone tells where the carriage is when the conversation begins.
    counts, told = info.travel_um * info.counts_per_m // 1_000_000, 1 << (info.count_bits - 1)
    if counts < told:
        return ""
    return (
        f"travel_um is {info.travel_um}, which takes {counts} counts with a counts_per_m of "
        f"{info.counts_per_m}; it must take less than {told}, half the range of count_bits "
        f"{info.count_bits}"
    )


def info_of(info: Info) -> Display:
    """Display of a device, in mm, from what it says of itself."""
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
    )
