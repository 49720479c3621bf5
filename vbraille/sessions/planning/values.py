"""Types of values in protocols, and the look of a stimulus."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from msgspec import Meta, structs

from vbraille.render import MAPPINGS, BrailleStyle, Model, Profile, single_row
from vbraille.toml import Table

Share = Annotated[float, Meta(ge=0, le=1)]
Count = Annotated[int, Meta(ge=1, le=100_000)]
Seed = Annotated[int, Meta(ge=0, le=2**63 - 1)]
Seconds = Annotated[float, Meta(ge=0, le=86_400)]
Duration = Annotated[float, Meta(gt=0, le=86_400)]
Length = Annotated[float, Meta(gt=0, le=50)]
Number = Annotated[float, Meta(ge=-1e9, le=1e9)]
Positive = Annotated[float, Meta(gt=0, le=1e9)]
ButtonNumber = Annotated[int, Meta(ge=1, le=8)]
Sentence = Annotated[str, Meta(min_length=1, max_length=300)]
Name = Annotated[str, Meta(pattern="^[a-z0-9-]{1,40}$")]
Label = Annotated[str, Meta(pattern="^[A-Za-z0-9][A-Za-z0-9_-]{0,31}$")]
FileName = Annotated[str, Meta(pattern="^[A-Za-z0-9][A-Za-z0-9._-]{0,63}$")]
# Values of a look that a style has not, or under another name.
APART = ("table", "on", "scene", "mapping", "dot_row", "texture_cycles", "dot_gap_mm")
# Numbers of a look that stimuli may differ in.
Parameter = Literal[
    "texture",
    "contrast",
    "texture_cycles",
    "dot_width_mm",
    "dot_gap_mm",
    "dot_spacing_mm",
    "cell_gap_mm",
    "row_spacing_mm",
    "line_pitch_mm",
]


class Look(Table, frozen=True, kw_only=True):
    """Look of stimuli. A value that is None is left to what the look is put over.

    Parameters
    ----------
    texture, contrast, texture_cycles
        Tuning, as at `vbraille.render.Tuning`.
    dot_row, mapping
        Row of dots that a single row of actuators shows, from 1; or the name of the mapping of dots
        to several rows.
    table
        Braille table of liblouis that makes the cells of texts.
    on
        Whether strings stand under the array or on the pins of a conventional display.
    scene
        File beside the protocol with the scene whose elements are shown as pictures.
    dot_gap_mm
        From edge to edge of the two dots of a cell, in place of the distance of their centres.
    """

    texture: Share | None = None
    contrast: Share | None = None
    texture_cycles: Literal[1, 3, 5, 7, 9, 11] | None = None
    dot_row: Annotated[int, Meta(ge=1, le=3)] | None = None
    mapping: Literal[tuple(MAPPINGS)] | None = None  # pyright: ignore
    table: Annotated[str, Meta(pattern=r"^[^/\s]+$")] | None = None
    on: Literal["device", "pins"] | None = None
    scene: FileName | None = None
    dot_width_mm: Length | None = None
    dot_gap_mm: Length | None = None
    dot_spacing_mm: Length | None = None
    cell_gap_mm: Length | None = None
    row_spacing_mm: Length | None = None
    line_pitch_mm: Length | None = None

    @property
    def given(self) -> dict[str, Any]:
        """The values that are not None."""
        named = ((name, getattr(self, name)) for name in Look.__struct_fields__)
        return {name: value for name, value in named if value is not None}

    def over(self, other: Look) -> Look:
        """Return the look that has these values, and the other's where there is none here."""
        return Look(**(other.given | self.given))

    def style(self, model: Model) -> BrailleStyle:
        """Return the model's style with these values.

        Raises
        ------
        ValueError
            If the model has no use for a value, or distances contradict each other.
        """
        one_row = model.style.mapping.rows == 1
        if self.mapping and one_row:
            raise ValueError(f"mapping: the {model.title} has one row of actuators; give dot_row")
        if self.dot_row and not one_row:
            raise ValueError(f"dot_row: the {model.title} has several rows; give mapping")
        if self.texture_cycles and model.style.profile is Profile.HALF_SINE:
            raise ValueError(f"texture_cycles: the texture of the {model.title} is fixed")
        changes = {name: value for name, value in self.given.items() if name not in APART}
        if self.mapping:
            changes["mapping"] = MAPPINGS[self.mapping]
        if self.dot_row:
            changes["mapping"] = single_row(self.dot_row)
        if self.texture_cycles:
            changes["cycles"] = self.texture_cycles
        if self.dot_gap_mm:
            width_mm = self.dot_width_mm or model.style.geometry.dot_width_mm
            changes["dot_spacing_mm"] = width_mm + self.dot_gap_mm
        return model.style.replace(**changes)

    def changed(self, parameter: str, value: float) -> Look:
        """Return the look with another value of a parameter."""
        whole = parameter == "texture_cycles" and value == int(value)
        return structs.replace(self, **{parameter: int(value) if whole else value})
