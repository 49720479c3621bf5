"""Style of braille, as one value, which compiles a line or a page of braille.

Lines of cells have a frame of their own: u along them and v down across them, in mm, from the top
left corner of the first cell, which is where the square around dot 1 begins. With angle φ::

    u = (x - x0) cos φ + (y - y0) sin φ,    v = (y - y0) cos φ - (x - x0) sin φ

The dot in column s (0 left, 1 right) and row r of cell c of line n is round where actuators show
what lies under them; its square begins at u = c · cell pitch + s · dot spacing and v = n · line
pitch + r · row spacing. Off the dots such lines are at rest, whatever the mapping of their style.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace
from enum import IntEnum
from numbers import Integral, Real
from typing import TYPE_CHECKING, Any, Final, Literal, Self, TypedDict, Unpack

import numpy as np
from numpy.polynomial import chebyshev

from vbraille.braille.geometry import Geometry
from vbraille.errors import InputError, check_range
from vbraille.render import work
from vbraille.render.braille.mappings import DOT_BITS, Mapping
from vbraille.render.work import ProgramKind
from vbraille.wording import nearest

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from vbraille.display import Display
    from vbraille.render.program import Program


# The kernels' polynomial of T_k has six coefficients; finer texture than this is below what the
# source's encoders resolve.
MOST_TEXTURE_CYCLES = 11


@dataclass(frozen=True, slots=True)
class Tuning:
    """Texture and contrast of braille, which a reader may change while reading.

    Parameters
    ----------
    texture
        Level T in [0, 1], from no texture to what Lévesque 2009 calls "textured" (VBD) or to the
        texture alone (STReSS², eq. 4.3).
    contrast
        Share of the full swing, in [0, 1].
    cycles
        Half-cycles of texture in a dot's radius, k of eq. 4.2; an odd number, so that the waveform
        meets rest at both edges. The VBD does not use it.

    Raises
    ------
    ValueError
        If a value is out of range.
    """

    texture: float = 0.0
    contrast: float = 1.0
    cycles: int = 7

    def __post_init__(self) -> None:
        for name in ("texture", "contrast"):
            check_range(name, getattr(self, name), 0, 1)
        if self.cycles % 2 != 1 or not 1 <= self.cycles <= MOST_TEXTURE_CYCLES:
            raise ValueError(
                f"texture cycles are {self.cycles}; "
                f"they must be an odd number, 1 to {MOST_TEXTURE_CYCLES}"
            )


class Profile(IntEnum):
    """Swing of the deflection across a dot."""

    HALF_SINE = 0
    """The profile of the VBD: Lévesque 2009, 3.2; its texture's phase and norm are our choice."""
    RAISED_COSINE = 1
    """The profile of the STReSS²: Lévesque 2009, eqs. 4.1-4.3."""


# How an array is read that does not stand where the line has its dots, as options name it.
Manner = Literal["line", "free"]
MANNERS: Final[tuple[Manner, ...]] = ("line", "free")

# Measured with hands that drift: `python -m tests.benchmarks straying`, and docs/measured.md.
BAND: Final = 0.25
BAND_BOUNDS: Final = (0.0, 0.9)
_EIGHT_DOTS = 0xC0  # dots 7 and 8, which make a fourth row
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
        for name, value in changes.items():
            if name not in (*_KINDS, *_TUNED, *_LENGTHS):
                names = (*_KINDS, *_TUNED, *_LENGTHS)
                raise InputError(f"a style has no {name}{nearest(name, names)}")
            kinds, wanted = _KINDS.get(name, (Real, "a number"))
            if not isinstance(value, kinds):
                raise InputError(f"{name} is {value!r}; it must be {wanted}")
        own: dict[str, Any] = {name: changes.get(name, getattr(self, name)) for name in _KINDS}
        try:
            for part, names in (("tuning", _TUNED), ("geometry", _LENGTHS)):
                given = {name: changes[name] for name in names if name in changes}
                own[part] = replace(own[part], **given)
        except ValueError as error:
            raise InputError(str(error)) from None
        return replace(self, **own)

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
    ) -> Program:
        """Compile a page of lines, one below the other.

        Parameters
        ----------
        lines : sequence of uint8[cells]
            Dot masks of each line; they need not be of one length.
        display
            Display that the page is shown on.

        Raises
        ------
        ValueError
            If the mapping needs more rows than the display has, or there is no line.
        """
        if not lines:
            raise ValueError("a page of no lines cannot be shown")
        return self._compile(lines, display, ProgramKind.PAGE)

    def _compile(
        self, lines: Sequence[NDArray[np.uint8]], display: Display, kind: ProgramKind
    ) -> Program:
        # This import compiles the kernels, which a command that renders nothing must not wait for.
        from vbraille.render.program import Program, head

        geometry, own = self.geometry, self.rows_on(display)
        is_free = kind is ProgramKind.PAGE and self.straying.manner == "free"
        bits = DOT_BITS if is_free else self.mapping.row_bits() << own.start
        down_mm = geometry.line_pitch_mm / 2 - geometry.row_spacing_mm - geometry.dot_width_mm / 2
        cells, table = pack_cells(lines, self, bits, (0.0, down_mm, 0.0))
        numbers = head(display, kind, work.CELLS, geometry.line_pitch_mm / 2)
        numbers[work.TILT] = MOST_TILT_RAD
        numbers[work.HYSTERESIS], numbers[work.FREE] = self.straying.band, is_free
        idle, gain = np.zeros((2, display.rows))
        idle[own] = self.mapping.idle()
        gain[own] = self.tuning.contrast * (1 - 2 * idle[own])
        return Program(np.concatenate([numbers, cells, idle, gain]), table)


def cells_size_mm(lines: Sequence[NDArray[np.uint8]], geometry: Geometry) -> tuple[float, float]:
    """Width and height of the rectangle of cells, in mm; 0, 0 without cells."""
    cells = max((len(masks) for masks in lines), default=0)
    if cells == 0:
        return 0.0, 0.0
    rows = work.LAST_ROW + any(bool(np.any(masks & _EIGHT_DOTS)) for masks in lines)
    down_mm = (len(lines) - 1) * geometry.line_pitch_mm + (rows - 1) * geometry.row_spacing_mm
    return geometry.extent_mm(cells), down_mm + geometry.dot_width_mm


def pack_cells(
    lines: Sequence[NDArray[np.uint8]],
    style: BrailleStyle,
    bits: NDArray[np.uint16],
    place: tuple[float, float, float],
) -> tuple[NDArray[np.float64], NDArray[np.uint16]]:
    """Make the numbers and the words of lines of cells for the kernels.

    Parameters
    ----------
    lines : sequence of uint8[n]
        Dot masks of each line.
    style
        Distances, profile and tuning of the dots.
    bits : uint16[256, 2]
        Words of the two slots of each possible cell.
    place
        Corner of the first cell, in mm, and direction of the lines, in radians.

    Returns
    -------
    float64[CELL_NUMBERS], uint16[lines + 2, slots]
        Numbers at the places that `vbraille.render.work` names, and the words.
    """
    geometry, (x_mm, y_mm, angle) = style.geometry, place
    slots = 2 * (max((len(masks) for masks in lines), default=0) + 2)
    dot_mm = geometry.dot_width_mm
    numbers = np.array(
        (
            x_mm,
            y_mm,
            math.cos(angle),
            math.sin(angle),
            *cells_size_mm(lines, geometry),
            len(lines),
            geometry.line_pitch_mm,
            geometry.row_spacing_mm,
            slots,
            geometry.cell_pitch_mm,
            geometry.dot_spacing_mm,
            dot_mm,
            0.0,
            dot_mm <= min(geometry.dot_spacing_mm, geometry.cell_gap_mm),
            style.tuning.contrast,
            style.profile,
            *_coefficients(style.profile, style.tuning),
        ),
        np.float64,
    )
    table = np.zeros((len(lines) + 2, slots), np.uint16)
    for row, masks in zip(table[1:], lines, strict=False):
        row[2 : 2 + 2 * len(masks)] = bits[masks].ravel()
    return numbers, table.ravel()


def _half_sine_peak(level: float) -> float:
    """Find M(a), the largest value of sin θ + a sin 8θ on [0, π], with a = level / 8."""
    a = level / 8
    theta = np.linspace(0, np.pi, 4097)
    best = theta[np.argmax(np.sin(theta) + a * np.sin(8 * theta))]
    for _ in range(4):  # Newton, on the derivative
        slope = np.cos(best) + 8 * a * np.cos(8 * best)
        best -= slope / (-np.sin(best) - 64 * a * np.sin(8 * best))
    return float(np.sin(best) + a * np.sin(8 * best))


def _coefficients(profile: Profile, tuning: Tuning) -> NDArray[np.float64]:
    """Compute the coefficients from which the kernels make a dot's profile; float64[6]."""
    shape = np.zeros(6)
    if profile is Profile.HALF_SINE:
        shape[0] = 1 / _half_sine_peak(tuning.texture)
        shape[1] = tuning.texture * shape[0]  # a = T / 8, and sin 8θ brings a factor of 8
    else:
        odd = chebyshev.cheb2poly([0] * tuning.cycles + [1])[1::2]  # coefficients of T_k, k odd
        shape[: odd.size] = tuning.texture * odd / 2
        shape[0] += (1 - tuning.texture) / 2
    return shape


# What the fields of a style are, where a program may give something else, and where to find them.
_KINDS: dict[str, tuple[Any, str]] = {
    "profile": (Profile, "a Profile, such as vbraille.VBD.style.profile"),
    "mapping": (Mapping, "one of vbraille.MAPPINGS, such as vbraille.MAPPINGS['sheared']"),
    "geometry": (Geometry, "a vbraille.Geometry"),
    "tuning": (Tuning, "a vbraille.Tuning"),
    "first_row": (Integral | None, "a row, from 0, or None"),
    "straying": (Straying, "a vbraille.Straying"),
}


_TUNED = [field.name for field in fields(Tuning)]
_LENGTHS = [field.name for field in fields(Geometry)]
