"""Base of patterns of every kind."""

from __future__ import annotations

from typing import Annotated

from vbraille.scene.measures import Measured, Share, check_file, limits
from vbraille.scene.strokes import Vibration

Zoom = Annotated[float, limits(0.5, 16.0)]


class Pattern(Measured, frozen=True, kw_only=True, tag_field="kind"):
    """Base of patterns of every kind.

    The changes are made in this order: amplitude, inversion, vibration, factor.

    Parameters
    ----------
    id
        Name by which other elements and people call it; empty if it has none.
    title, description
        What it is, in a word and in a sentence, for the person who feels it; empty for nothing.
    amplitude
        Factor of its deflections, from 0 to 1.
    inverted
        Whether 1 - δ is shown in place of δ.
    vibration
        Vibration of its high or of its low parts; None for none.
    words
        Words that are said in place of its title when the finger comes to it; empty for none.
    sound
        Name of a WAV file that is played then, seen from the file of the scene; empty for none.
    factor
        Name of a signal by which its deflections, and what it hides of others, are multiplied;
        empty for none.
    zoom_from, zoom_to
        Zooms of the picture from which on it is there, and from which on it is not; None for no
        such limit. The picture as it is written has a zoom of 1.

    Raises
    ------
    ValueError
        If a value is out of range, or two cannot go together.
    """

    id: str = ""
    title: str = ""
    description: str = ""
    amplitude: Share = 1.0
    inverted: bool = False
    vibration: Vibration | None = None
    words: str = ""
    sound: str = ""
    factor: str = ""
    zoom_from: Zoom | None = None
    zoom_to: Zoom | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.sound:
            check_file(self.sound, "sound")
        begins, ends = self.zoom_from, self.zoom_to
        if begins is not None and ends is not None and begins >= ends:
            raise ValueError(
                f"zoom_to is {ends:g}, and zoom_from {begins:g}, so that it is never there; "
                "give zoom_to a larger number"
            )

    @property
    def kind(self) -> str:
        """Kind as files have it, such as "linear-grating"."""
        return str(self.__struct_config__.tag)
