"""Styles in which strings are shown: that of the display, and what each condition changes of it."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, Literal

from msgspec import field

from vbraille.braille.geometry import BOUNDS_MM
from vbraille.errors import check_range
from vbraille.render import MAPPINGS, Profile, Tuning, single_row
from vbraille.sessions.planning.pace import check_file_name, check_name
from vbraille.sessions.planning.spellings import Masks
from vbraille.tomlfile import Table, which

if TYPE_CHECKING:
    from collections.abc import Iterable

    from vbraille.render import BrailleStyle, Mapping, Model


Where = Literal["device", "brlapi"]
CONVENTIONAL: Where = "brlapi"  # on the display that BRLTTY drives
MOST_CELLS = 200  # no conventional display has a longer row


class ConventionalTable(Table, frozen=True, kw_only=True):
    """The table ``[conventional]``.

    Parameters
    ----------
    cell
        Cell of the conventional display at which everything on it begins, from 1.
    reference
        Dot masks of what stands there throughout each trial on the device, to be compared with;
        empty for nothing.

    Raises
    ------
    ValueError
        If the number is out of range.
    """

    cell: int = 1
    reference: Masks = Masks()

    def __post_init__(self) -> None:
        check_range("cell", self.cell, 1, MOST_CELLS)

    def placed(self, masks: tuple[int, ...]) -> bytes:
        """Cells of the display, from its left, on which some cells stand in their place."""
        return bytes((0,) * (self.cell - 1) + tuple(masks))


MOST_LEAD = 20
# Lengths that conditions may differ in; the travel is the device's, and the same for all.
LENGTHS = tuple(name for name in BOUNDS_MM if name != "travel_mm")
TUNED = ("texture", "contrast", "cycles")
STYLE = (*TUNED, "dot_row", "mapping", "table", "on", "scene", *LENGTHS)


class Style(Table, frozen=True, kw_only=True):
    """Any part of the style in which strings are shown; a value that is left out is None.

    Parameters
    ----------
    texture, contrast, cycles
        These are described at `Tuning`.
    dot_row
        Row of dots that the VBD shows, from 1.
    mapping
        Name of the mapping that the STReSS² uses.
    table
        File name of the braille table of liblouis that makes the cells of texts.
    on
        Where strings stand: on the "device", or on the conventional display that BRLTTY drives,
        "brlapi".
    scene
        File beside the protocol with the scene whose elements are shown as pictures.
    dot_width_mm, dot_spacing_mm, cell_gap_mm, row_spacing_mm, line_pitch_mm
        These are described at `Geometry`.

    Raises
    ------
    ValueError
        If a value is out of range.
    """

    texture: float | None = None
    contrast: float | None = None
    cycles: int | None = field(name="texture_cycles", default=None)
    dot_row: int | None = None
    mapping: str | None = None
    table: str | None = None
    on: Where | None = None
    scene: str | None = None
    dot_width_mm: float | None = None
    dot_spacing_mm: float | None = None
    cell_gap_mm: float | None = None
    row_spacing_mm: float | None = None
    line_pitch_mm: float | None = None

    def __post_init__(self) -> None:
        Tuning(**_given(self, TUNED))
        if self.table is not None and (not self.table.strip() or "/" in self.table):
            raise ValueError(
                f"table is {self.table!r}; it must be the name of a braille table that liblouis "
                f"has, such as en-ueb-g2.ctb (vbraille tables lists all)"
            )
        if self.scene is not None:
            check_file_name(self.scene, "scene", ("scene",))

    @property
    def changes(self) -> dict[str, Any]:
        """All values that the file gives, by their names as attributes."""
        return _given(self, STYLE)

    def over(self, model: Model, style: BrailleStyle) -> BrailleStyle:
        """Style in which the values given here take the place of its own.

        Raises
        ------
        ValueError
            If values contradict each other, or the model has no use for them.
        """
        if self.cycles is not None and model.style.profile is Profile.HALF_SINE:
            raise ValueError(
                f"texture_cycles is of the STReSS²; the texture of the {model.title} has a fixed "
                f"wavelength, leave it out"
            )
        geometry = replace(style.geometry, **_given(self, LENGTHS))
        mapping = self._mapping(model) or style.mapping
        tuning = replace(style.tuning, **_given(self, TUNED))
        return replace(style, mapping=mapping, geometry=geometry, tuning=tuning)

    def _mapping(self, model: Model) -> Mapping | None:
        """Mapping that the file gives; None if it gives none."""
        one_row = model.style.mapping.rows == 1
        if self.dot_row is not None and not one_row:
            raise ValueError(f"dot_row is of the VBD; the {model.title} shows all, leave it out")
        if self.mapping is not None and one_row:
            raise ValueError(f"mapping is of the STReSS²; for the {model.title} give dot_row")
        if self.dot_row is not None:
            return single_row(self.dot_row)
        if self.mapping is None:
            return None
        if self.mapping not in MAPPINGS:
            raise ValueError(f"mapping is {self.mapping!r}{which(self.mapping, MAPPINGS)}")
        mapping = MAPPINGS[self.mapping]
        if mapping.rows > model.display.rows:
            raise ValueError(
                f"mapping {mapping.name} is for {mapping.rows} rows of actuators; the "
                f"{model.title} has {model.display.rows}"
            )
        return mapping


class Condition(Style, frozen=True):
    """A named way of showing strings: a condition of a protocol, or a level of a factor.

    Parameters
    ----------
    name
        Name that plans and tables have it by.

    Raises
    ------
    ValueError
        If the name cannot be used, or a value is out of range.
    """

    name: str

    def __post_init__(self) -> None:
        check_name("name", self.name)
        super().__post_init__()


class DisplayStyle(Style, frozen=True, kw_only=True):
    """The table ``[display]``. A value that is left out is None, and the model's own is used.

    Parameters
    ----------
    lead_cells
        Number of blank cells before each string.
    travel_mm
        Length of the carriage's travel.

    Raises
    ------
    ValueError
        If a value is out of range.
    """

    # With one cell, the array's right column is well before the first dot at the left stop.
    lead_cells: int = 1
    travel_mm: float | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        if not 0 <= self.lead_cells <= MOST_LEAD:
            raise ValueError(f"lead_cells is {self.lead_cells}; it must be 0 to {MOST_LEAD}")

    def style(self, model: Model) -> BrailleStyle:
        """Style in which strings are shown on a model.

        Raises
        ------
        ValueError
            If values contradict each other, or the model has no use for them.
        """
        geometry = replace(model.style.geometry, **_given(self, ("travel_mm",)))
        return self.over(model, replace(model.style, geometry=geometry))


def mapping_named(name: str) -> Mapping:
    """Mapping of a name, as plans have it: one of `MAPPINGS`, or ``dot-row-1`` to ``dot-row-3``.

    Raises
    ------
    ValueError
        If there is no such mapping.
    """
    rows = {single_row(number).name: number for number in (1, 2, 3)}
    if name in rows:
        return single_row(rows[name])
    if name not in MAPPINGS:
        raise ValueError(f"mapping is {name!r}{which(name, MAPPINGS)}")
    return MAPPINGS[name]


def _given(values: object, names: Iterable[str]) -> dict[str, Any]:
    return {name: value for name in names if (value := getattr(values, name)) is not None}
