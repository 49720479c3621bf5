"""Labels of a picture, in braille."""

from __future__ import annotations

from vbraille.scene.measures import Point, check_angle, check_length, check_point
from vbraille.scene.pattern import Pattern


class Label(Pattern, frozen=True, kw_only=True, tag="label"):
    """Braille in the picture: a text, translated by the same tables as books are.

    Parameters
    ----------
    text
        The text.
    place_mm
        Top left corner of its first cell.
    width_mm
        Width at which its lines are broken; None for one line.
    table
        Language or table of liblouis; empty for that of the scene.
    angle_deg
        Direction of its lines, from +x towards +y.

    Raises
    ------
    ValueError
        If the text is empty, or a number is out of range.
    """

    text: str
    place_mm: Point
    width_mm: float | None = None
    table: str = ""
    angle_deg: float = 0.0

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.text.strip():
            raise ValueError("text is empty; a label needs one")
        check_point("place", self.place_mm)
        check_length("width", self.width_mm, 1.0)
        check_angle("angle", self.angle_deg)
