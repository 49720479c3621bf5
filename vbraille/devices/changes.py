"""What has become of a device that came back: the same, changed, or another one."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.devices.messages import Encoder

if TYPE_CHECKING:
    from vbraille.devices.messages import Info
    from vbraille.display import Display


def differences(was: Display, now: Display) -> list[str]:
    """What of a device is another than a page and a loop were made for; nothing of its name.

    A count is no part of it: places are in millimetres.
    """
    kinds = (
        ("rows of actuators", was.rows, now.rows, ""),
        ("columns of actuators", was.columns, now.columns, ""),
        ("pitch along the line", was.column_pitch_mm, now.column_pitch_mm, " mm"),
        ("pitch across the line", was.row_pitch_mm, now.row_pitch_mm, " mm"),
        ("levels", was.levels, now.levels, ""),
        ("rest side", was.rest_side, now.rest_side, ""),
        ("travel", was.travel_mm, now.travel_mm, " mm"),
        ("rate", was.rate_hz, now.rate_hz, " Hz"),
    )
    return [
        f"{what} {_plain(new)}{unit}, not {_plain(old)}{unit}"
        for what, old, new, unit in kinds
        if old != new
    ]


def another(was: Display, now: Display, others: list[str]) -> str:
    """What to say of a device in the place of the one that reading began on."""
    if now.name != was.name:
        return (
            f"{now.name} came back in its place ({', '.join(others)}); plug in {was.name} again "
            f"and reading goes on"
        )
    return (
        f"another {was.name} came back ({', '.join(others)}); plug in the one that reading began "
        f"on, or set this one as that was, and reading goes on"
    )


def changes(was: Info, now: Info) -> list[str]:
    """What of a device that can be read on is otherwise than in the conversation before."""
    said = []
    if now.name != was.name:
        said.append(f"its name is {now.name}, not {was.name}")
    if now.counts_per_m != was.counts_per_m:
        per_mm = [f"{1e6 / info.counts_per_m:.6g} µm" for info in (now, was)]
        said.append(f"a count is {per_mm[0]}, not {per_mm[1]}")
    if now.count_sign != was.count_sign:
        said.append(f"its counts grow {now.count_sign.name.lower()}")
    if now.encoder != was.encoder:
        said.append(f"its encoder is {now.encoder.name.lower()}, not {was.encoder.name.lower()}")
    incremental = now.encoder is Encoder.INCREMENTAL
    if not incremental and now.left_stop_count != was.left_stop_count:
        said.append(f"its left stop is at count {now.left_stop_count}, not {was.left_stop_count}")
    if now.largest_slew_per_s != was.largest_slew_per_s:
        said.append(f"its actuators may move {_slew(now)}, not {_slew(was)}")
    for what, new, old in (
        ("gain", now.gain, was.gain),
        ("rest level", now.inverted, was.inverted),
        ("fitness for use", now.enabled, was.enabled),
    ):
        others = sum(one != other for one, other in zip(new, old, strict=True))
        if others:
            said.append(f"{others} of its actuators have another {what}")
    return said


def to_do(info: Info) -> str:
    """What the reader has to do before places of a device are known again; empty for nothing."""
    return {
        Encoder.ABSOLUTE: "",
        Encoder.INDEX: "; if asked to, move the carriage over its mark",
        Encoder.INCREMENTAL: "; its left stop must be shown again",
    }[info.encoder]


def _slew(info: Info) -> str:
    speed = info.largest_slew_per_s
    return f"{speed} swings a second" if speed else "without a limit"


def _plain(value: float | str) -> str:
    return value if isinstance(value, str) else f"{value:g}"
