"""A hand that is too fast for the texture of the braille."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from vbraille.render import BrailleStyle

# Above this the devices' reconstruction filters take texture away (Lévesque 2009, 6.2).
FILTER_HZ = 200.0


def too_fast_note(speed_mm_s: float, style: BrailleStyle) -> str | None:
    """Note on a hand so fast that the filters take texture away; None if it is not."""
    if not style.tuning.texture:
        return None
    period_mm = style.profile.texture_period_mm(style.geometry.dot_width_mm, style.tuning.cycles)
    if speed_mm_s / period_mm <= FILTER_HZ:
        return None
    return (
        f"speed: {speed_mm_s:.0f} mm/s, at which texture passes {FILTER_HZ:g} Hz and fades; "
        f"below {FILTER_HZ * period_mm:.0f} mm/s it is felt"
    )
