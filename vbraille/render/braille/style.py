"""Style of braille, as one value, which compiles a line or a page of braille."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace
from numbers import Integral, Real
from typing import TYPE_CHECKING, Any, Final, Literal, Self, TypedDict, Unpack

import numpy as np

from vbraille.braille.geometry import Geometry
from vbraille.errors import InputError, check_range
from vbraille.render import work
from vbraille.render.braille.dots import Profile, Tuning, coefficients
from vbraille.render.braille.mappings import Mapping
from vbraille.render.work import ProgramKind
from vbraille.wording import nearest

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from vbraille.display import Display
    from vbraille.render.program import Program


# How an array is read that does not stand where the line has its dots, as options name it.
Manner = Literal["line", "free"]
MANNERS: Final[tuple[Manner, ...]] = ("line", "free")

# Measured with hands that drift: `python -m tests.benchmarks straying`, and docs/measured.md.
BAND: Final = 0.25
BAND_BOUNDS: Final = (0.0, 0.9)
# Farther turned than this, an array shows no braille. Measured likewise, in the same table: the
# ends of a row of actuators then lie over another row of dots than the one that they show.
MOST_TILT_RAD: Final = math.radians(20.0)


@dataclass(frozen=True, slots=True)
class Straying:
    """Response of a page to a finger that strays from the middle of a line.

    Parameters
    ----------
    manner
        "line" if rows of actuators keep to the rows of dots of the line that the finger is on;
        "free" if each actuator shows what lies under it.
    band
        Way in y between going to the next line and coming back, in line pitches, 0 to 0.9: the
        finger stays on its line until it is beyond the line's edge by half of that.

    Raises
    ------
    ValueError
        If a value is out of range.
    """

    manner: Manner = "line"
    band: float = BAND

    def __post_init__(self) -> None:
        if self.manner not in MANNERS:
            raise ValueError(f"straying is {self.manner!r}; it must be line or free")
        check_range("band", self.band, *BAND_BOUNDS)


_USUAL = Straying()


class StyleChanges(TypedDict, total=False):
    """Fields that a style is changed in: its own, and those of its `Tuning` and its `Geometry`."""

    profile: Profile
    mapping: Mapping
    geometry: Geometry
    tuning: Tuning
    first_row: int | None
    straying: Straying
    texture: float
    contrast: float
    cycles: int
    dot_width_mm: float
    dot_spacing_mm: float
    cell_gap_mm: float
    row_spacing_mm: float
    line_pitch_mm: float
    travel_mm: float


@dataclass(frozen=True, slots=True)
class BrailleStyle:
    """Style in which braille is shown on a display.

    Parameters
    ----------
    profile
        Profile by which a dot swings the actuators.
    mapping
        Mapping from dots to rows of actuators.
    geometry
        Distances of the dots.
    tuning
        Texture and contrast of the dots.
    first_row
        Row of the display at which the mapping begins; None puts the mapping into the middle.
        Rows outside the mapping rest.
    straying
        What is shown of a page to a finger that strays from its line.
    """

    profile: Profile
    mapping: Mapping
    geometry: Geometry
    tuning: Tuning
    first_row: int | None = None
    straying: Straying = _USUAL

    def replace(self, **changes: Unpack[StyleChanges]) -> Self:
        """Make a style that differs from this one in the given fields.

        Parameters
        ----------
        changes
            Fields of the style, or of its `Tuning` (texture, contrast, cycles) or its `Geometry`
            (such as dot_width_mm), with new values.

        Raises
        ------
        InputError
            If there is no such field, or it cannot have the value.

        Examples
        --------
        >>> from vbraille import VBD
        >>> VBD.style.replace(texture=0.5).tuning
        Tuning(texture=0.5, contrast=1.0, cycles=7)
        """
        others: dict[str, Any] = {**changes}
        turned = {name: _number(name, others.pop(name)) for name in _TUNED if name in changes}
        lengths = {name: _number(name, others.pop(name)) for name in _LENGTHS if name in changes}
        for name, value in others.items():
            _check_field(name, value)
        try:
            tuning = replace(others.pop("tuning", self.tuning), **turned)
            geometry = replace(others.pop("geometry", self.geometry), **lengths)
        except ValueError as error:
            raise InputError(str(error)) from None
        return replace(self, tuning=tuning, geometry=geometry, **others)

    def rows_on(self, display: Display) -> slice:
        """Tell which rows of a display the mapping takes.

        Raises
        ------
        ValueError
            If the display has too few rows.
        """
        first = self.first_row
        if first is None:
            first = max(display.rows - self.mapping.rows, 0) // 2
        if not 0 <= first <= display.rows - self.mapping.rows:
            raise ValueError(
                f"mapping {self.mapping.name} needs {self.mapping.rows} actuator rows from row "
                f"{first} on; the array has {display.rows}"
            )
        return slice(first, first + self.mapping.rows)

    def render(self, masks: NDArray[np.uint8], display: Display) -> Program:
        """Compile a line of braille.

        Parameters
        ----------
        masks : uint8[cells]
            Dot masks; bit 0 is dot 1.
        display
            Display that the line is shown on.

        Raises
        ------
        ValueError
            If the mapping needs more rows than the display has.
        """
        return self._compile([masks], display, ProgramKind.LINE)

    def render_page(
        self,
        lines: Sequence[NDArray[np.uint8]],
        display: Display,
        *,
        hysteresis: float | None = None,
    ) -> Program:
        """Compile a page of lines, one below the other.

        Parameters
        ----------
        lines : sequence of uint8[cells]
            Dot masks of each line; they need not be of one length.
        display
            Display that the page is shown on.
        hysteresis
            Distance in y between going to the next line and coming back, in line pitches, 0 to 1;
            None for the band of the style's `Straying`.

        Raises
        ------
        ValueError
            If the mapping needs more rows than the display has, there is no line, or the
            hysteresis is out of range.
        """
        if not lines:
            raise ValueError("a page of no lines cannot be shown")
        hysteresis = self.straying.band if hysteresis is None else hysteresis
        if not 0 <= hysteresis <= 1:
            raise ValueError(f"the hysteresis is {hysteresis:g}; it must be 0 to 1 line pitches")
        program = self._compile(lines, display, ProgramKind.PAGE)
        program.numbers[work.LINES] = len(lines)
        program.numbers[work.HYSTERESIS] = hysteresis
        return self._freed(program, lines) if self.straying.manner == "free" else program

    def _freed(self, page: Program, lines: Sequence[NDArray[np.uint8]]) -> Program:
        """Have each actuator of a page show what lies under it, whatever the mapping."""
        from vbraille.render.braille.packing import pack_cells
        from vbraille.render.program import Program

        geometry = self.geometry
        down_mm = geometry.line_pitch_mm / 2 - geometry.row_spacing_mm - geometry.dot_width_mm / 2
        place = (0.0, down_mm, 0.0)
        cells = pack_cells(lines, geometry, self.profile, self.tuning, place)
        numbers = page.numbers.copy()
        numbers[work.FREE] = 1.0
        return Program(np.concatenate([numbers, cells.numbers]), cells.table)

    def room(self, display: Display, cells: int, lines: int = 1) -> int:
        """Tell how many bytes a program of so many lines and cells takes; each is at least 1."""
        numbers = work.IDLE + 2 * display.rows
        return numbers * 8 + (lines + 2) * 2 * (cells + 2) * 2

    def _compile(
        self, lines: Sequence[NDArray[np.uint8]], display: Display, kind: ProgramKind
    ) -> Program:
        # This import compiles the kernels, which a command that renders nothing must not wait for.
        from vbraille.render.program import Program, head

        geometry, tuning = self.geometry, self.tuning
        own = self.rows_on(display)
        slots = 2 * (max(len(masks) for masks in lines) + 2)
        numbers = head(display, kind, work.IDLE + 2 * display.rows, geometry.line_pitch_mm / 2)
        numbers[work.ANCHOR] = display.span_mm / 2
        numbers[work.COLUMN_PITCH] = display.column_pitch_mm
        numbers[work.ROW_PITCH] = display.row_pitch_mm
        numbers[work.LINE_PITCH] = geometry.line_pitch_mm
        numbers[work.SLOTS] = slots
        numbers[work.CELLS_PER_MM] = 1 / geometry.cell_pitch_mm
        numbers[work.CELL_PITCH] = geometry.cell_pitch_mm
        numbers[work.DOTS_PER_MM] = 1 / geometry.dot_width_mm
        numbers[work.DOT_SPACING] = geometry.dot_spacing_mm
        numbers[work.PROFILE] = self.profile
        numbers[work.OVERLAP] = geometry.dot_width_mm > min(
            geometry.dot_spacing_mm, geometry.cell_gap_mm
        )
        numbers[work.DOT_ROW_PITCH] = geometry.row_spacing_mm
        numbers[work.TILT] = MOST_TILT_RAD
        numbers[work.SHAPE : work.SHAPE + 6] = coefficients(self.profile, tuning)
        idle = self.mapping.idle()
        numbers[work.IDLE : work.IDLE + display.rows][own] = idle
        numbers[work.IDLE + display.rows :][own] = tuning.contrast * (1 - 2 * idle)
        page = kind is ProgramKind.PAGE
        bits = self.mapping.row_bits() << own.start
        table = np.zeros((len(lines) + 2 * page, slots), np.uint16)
        for row, masks in zip(table[page:], lines, strict=False):
            row[2 : 2 + 2 * len(masks)] = bits[masks].ravel()
        return Program(numbers, table.ravel())


# What the fields of a style are, where a program may give something else, and where to find them.
_KINDS: dict[str, tuple[tuple[type, ...], str]] = {
    "profile": ((Profile,), "a Profile, such as vbraille.VBD.style.profile"),
    "mapping": ((Mapping,), "one of vbraille.MAPPINGS, such as vbraille.MAPPINGS['sheared']"),
    "geometry": ((Geometry,), "a vbraille.Geometry"),
    "tuning": ((Tuning,), "a vbraille.Tuning"),
    "first_row": ((Integral, type(None)), "a row, from 0, or None"),
    "straying": ((Straying,), "a vbraille.Straying"),
}


_TUNED = [field.name for field in fields(Tuning)]
_LENGTHS = [field.name for field in fields(Geometry)]


def _number(name: str, value: object) -> Any:
    """A value of the tuning or the geometry; InputError if it is no number."""
    if not isinstance(value, Real):
        raise InputError(f"{name} is {value!r}; it must be a number")
    return value


def _check_field(name: str, value: object) -> None:
    """Raise InputError if a style has no such field, or it cannot have such a value."""
    if name not in _KINDS:
        raise InputError(f"a style has no {name}{nearest(name, (*_KINDS, *_TUNED, *_LENGTHS))}")
    kinds, wanted = _KINDS[name]
    if not isinstance(value, kinds):
        raise InputError(f"{name} is {value!r}; it must be {wanted}")
