"""How strings are shown: the display's style, and how each condition may differ from it."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from msgspec import field

from vbraille.braille.geometry import BOUNDS_MM
from vbraille.render import MAPPINGS, Profile, Tuning, single_row
from vbraille.sessions.planning.conduct import check_name
from vbraille.toml.tomlfile import Table, which

if TYPE_CHECKING:
    from collections.abc import Iterable

    from vbraille.render import BrailleStyle, Mapping, Model

MOST_LEAD = 20


class Tuned(Table, frozen=True, kw_only=True):
    """Values that a file gives for a `Tuning`; a value that is left out is None.

    Parameters
    ----------
    texture, contrast, cycles
        These are described at `Tuning`.

    Raises
    ------
    ValueError
        If a value is out of range.
    """

    texture: float | None = None
    contrast: float | None = None
    cycles: int | None = field(name="texture_cycles", default=None)

    def __post_init__(self) -> None:
        Tuning(**self.given)

    @property
    def given(self) -> dict[str, Any]:
        """Values that the file gives, by their names in `Tuning`."""
        return _given(self, ("texture", "contrast", "cycles"))

    def tune(self, model: Model, tuning: Tuning) -> Tuning:
        """Tuning in which the values given here take the place of its own.

        Raises
        ------
        ValueError
            If the model has no use for one of the values.
        """
        if self.cycles is not None and model.style.profile is Profile.HALF_SINE:
            raise ValueError(
                f"texture_cycles is of the STReSS²; the texture of the {model.title} has a fixed "
                f"wavelength, leave it out"
            )
        return replace(tuning, **self.given)


class Condition(Tuned, frozen=True):
    """One condition of a protocol: the display's tuning, but for the values given here.

    Parameters
    ----------
    name
        Name of the condition.

    Raises
    ------
    ValueError
        If the name cannot be used, or a value is out of range.
    """

    name: str

    def __post_init__(self) -> None:
        check_name("name", self.name)
        super().__post_init__()


class Appearance(Tuned, frozen=True, kw_only=True):
    """The table ``[display]``. A value that is left out is None, and the model's own is used.

    Parameters
    ----------
    dot_row
        Row of dots that the VBD shows, from 1.
    mapping
        Name of the mapping that the STReSS² uses.
    lead_cells
        Number of blank cells before each string.
    dot_width_mm, dot_spacing_mm, cell_gap_mm, row_spacing_mm, line_pitch_mm, travel_mm
        These are described at `Geometry`.

    Raises
    ------
    ValueError
        If a value is out of range.
    """

    dot_row: int | None = None
    mapping: str | None = None
    # With one cell, the array's right column is well before the first dot at the left stop.
    lead_cells: int = 1
    dot_width_mm: float | None = None
    dot_spacing_mm: float | None = None
    cell_gap_mm: float | None = None
    row_spacing_mm: float | None = None
    line_pitch_mm: float | None = None
    travel_mm: float | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        if not 0 <= self.lead_cells <= MOST_LEAD:
            raise ValueError(f"lead_cells is {self.lead_cells}; it must be 0 to {MOST_LEAD}")

    def style(self, model: Model) -> BrailleStyle:
        """How strings are shown on a model.

        Raises
        ------
        ValueError
            If values contradict each other, or the model has no use for them.
        """
        geometry = replace(model.style.geometry, **_given(self, BOUNDS_MM))
        tuning = self.tune(model, model.style.tuning)
        return replace(model.style, mapping=self._mapping(model), geometry=geometry, tuning=tuning)

    def _mapping(self, model: Model) -> Mapping:
        one_row = model.style.mapping.rows == 1
        if self.dot_row is not None and not one_row:
            raise ValueError(f"dot_row is of the VBD; the {model.title} shows all, leave it out")
        if self.mapping is not None and one_row:
            raise ValueError(f"mapping is of the STReSS²; for the {model.title} give dot_row")
        if self.dot_row is not None:
            return single_row(self.dot_row)
        if self.mapping is None:
            return model.style.mapping
        if self.mapping not in MAPPINGS:
            raise ValueError(f"mapping is {self.mapping!r}{which(self.mapping, MAPPINGS)}")
        return MAPPINGS[self.mapping]


def _given(values: object, names: Iterable[str]) -> dict[str, Any]:
    return {name: value for name in names if (value := getattr(values, name)) is not None}
