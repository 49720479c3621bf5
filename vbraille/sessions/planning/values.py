"""Types of values in protocols, and the look of a stimulus."""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta, structs

from vbraille.render import MAPPINGS, BrailleStyle, Model, Profile, single_row
from vbraille.toml import Table

Share = Annotated[float, Meta(ge=0, le=1)]
Count = Annotated[int, Meta(ge=1, le=100_000)]
Seconds = Annotated[float, Meta(ge=0, le=36_000)]
Length = Annotated[float, Meta(gt=0, le=50)]
Sentence = Annotated[str, Meta(min_length=1, max_length=200)]
Name = Annotated[str, Meta(pattern="^[a-z0-9-]{1,40}$")]
Label = Annotated[str, Meta(pattern="^[A-Za-z0-9][A-Za-z0-9_-]{0,31}$")]
Participant = Label


class Look(Table, kw_only=True):
    """How cells are shown. A value that is None is left to what the look is put over."""

    texture: Share | None = None
    contrast: Share | None = None
    texture_cycles: Literal[1, 3, 5, 7, 9, 11] | None = None
    dot_row: Annotated[int, Meta(ge=1, le=3)] | None = None
    mapping: Literal[tuple(MAPPINGS)] | None = None
    dot_width_mm: Length | None = None
    dot_spacing_mm: Length | None = None
    cell_gap_mm: Length | None = None
    row_spacing_mm: Length | None = None
    line_pitch_mm: Length | None = None

    @property
    def given(self) -> dict[str, float | int | str]:
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
        changes = dict(self.given)
        one_row = model.style.mapping.rows == 1
        if "mapping" in changes and one_row:
            raise ValueError(f"mapping: the {model.title} has one row of actuators; give dot_row")
        if "dot_row" in changes and not one_row:
            raise ValueError(f"dot_row: the {model.title} has several rows; give mapping")
        if "texture_cycles" in changes and model.style.profile is Profile.HALF_SINE:
            raise ValueError(f"texture_cycles: the texture of the {model.title} is fixed")
        if "mapping" in changes:
            changes["mapping"] = MAPPINGS[changes["mapping"]]
        if "dot_row" in changes:
            changes["mapping"] = single_row(changes.pop("dot_row"))
        if "texture_cycles" in changes:
            changes["cycles"] = changes.pop("texture_cycles")
        return model.style.replace(**changes)

    def changed(self, name: str, value: float) -> Look:
        """Return the look with another value of one name."""
        return structs.replace(self, **{name: value})
