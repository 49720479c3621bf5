"""Deflection maps: what the actuators do everywhere on a line or a page, as one picture.

Lévesque 2009, 8.3.3: each pixel of a map is a deflection, and white is rest. All actuators of a
row do the same where they stand at the same place. So one row of pixels tells of all of them.
"""

from __future__ import annotations

import base64
import io
from dataclasses import dataclass
from typing import TYPE_CHECKING
from xml.sax.saxutils import escape

import numpy as np

from vbraille.render import work
from vbraille.render.work import ProgramKind

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.render.program import Program

STEP_MM = 0.1
# A map is no larger, whatever is asked for.
MOST_PIXELS = 50_000_000
_BLACK = {8: 255, 16: 65_535}
# A single row of actuators is drawn so high, as a share of the distance between lines.
_SINGLE_ROW = 0.4
_BAR_MM = 10.0
_MAPLESS = "a {} has no map of lines; vbraille map draws tactile pictures"
_NOTE = "White is rest, black is full deflection."


@dataclass(frozen=True, slots=True)
class MapShape:
    """How a deflection map lies on the canvas.

    Parameters
    ----------
    rows
        Number of actuator rows of each line.
    start_mm
        Place of the first column of pixels.
    step_mm
        Distance between columns of pixels.
    row_mm
        Height that an actuator row is drawn with.
    line_mm
        Distance between lines.

    Raises
    ------
    ValueError
        If a number is out of range.
    """

    rows: int
    start_mm: float = 0.0
    step_mm: float = STEP_MM
    row_mm: float = 1.0
    line_mm: float = 10.0

    def __post_init__(self) -> None:
        if self.rows < 1:
            raise ValueError(f"a map of {self.rows} rows is not possible; it has at least 1")
        for name in ("step_mm", "row_mm", "line_mm"):
            if not 0 < getattr(self, name) < 1000:
                raise ValueError(f"{name} is {getattr(self, name):g}; it must be above 0 to 1000")


def line_map(
    program: Program, *, start_mm: float, end_mm: float, step_mm: float = STEP_MM
) -> NDArray[np.float32]:
    """Make the map of a line or a page of braille, from its program alone.

    Parameters
    ----------
    program
        The line or page, compiled.
    start_mm, end_mm, step_mm
        Places on the canvas: column i of the map is for ``start_mm + i · step_mm``.

    Returns
    -------
    float32[rows, places] or float32[lines · rows, places]
        Deflection, 0 … 1, of an actuator of each row that stands at each place itself, whichever
        column it is in. Those of a page are line after line.

    Raises
    ------
    ValueError
        If the places are no stretch of the canvas, are too many, or the picture is no braille.
    """
    if program.kind not in (ProgramKind.LINE, ProgramKind.PAGE):
        raise ValueError(_MAPLESS.format(program.kind.name.lower()))
    if not (step_mm > 0 and end_mm >= start_mm and np.isfinite([start_mm, end_mm]).all()):
        raise ValueError(
            f"a map from {start_mm:g} to {end_mm:g} mm in steps of {step_mm:g} mm is not possible"
        )
    places = int((end_mm - start_mm) / step_mm + 1e-9) + 1
    lines = lines_of(program)
    if places * lines * program.shape[0] > MOST_PIXELS:
        raise ValueError(f"the map would have {places} columns; choose a longer step")
    x_mm = start_mm + step_mm * np.arange(places, dtype=np.float64)
    # The left column tells its own place then. What it does, all columns do at that place.
    left = program.with_anchor(0.0)
    if program.kind is ProgramKind.LINE:
        return np.ascontiguousarray(left.path(x_mm)[:, :, 0].T)
    made = np.empty((lines, program.shape[0], places), np.float32)
    for line in range(lines):
        y_mm = (line + 0.5) * float(program.numbers[work.LINE_PITCH])
        _, frames = left.poses(x_mm, np.full(places, y_mm))
        made[line] = frames[:, :, 0].T
    return made.reshape(-1, places)


def lines_of(program: Program) -> int:
    """Count the lines of a program of braille."""
    return int(program.numbers[work.LINES]) if program.kind is ProgramKind.PAGE else 1


def picture(program: Program, form: str, title: str, note: str = "") -> bytes:
    """Make the map of the whole line or page of a program, as a file.

    It begins and ends a cell beside the braille.

    Parameters
    ----------
    program
        The line or page, compiled.
    form
        "png" or "svg".
    title
        Title of the picture.
    note
        Sentence that goes to its description.

    Raises
    ------
    ValueError
        If the form is another one, or the picture is no braille.
    """
    if form not in ("png", "svg"):
        raise ValueError(f"a map is a png or an svg, not {form!r}")
    if program.kind not in (ProgramKind.LINE, ProgramKind.PAGE):
        raise ValueError(_MAPLESS.format(program.kind.name.lower()))
    cell_mm = float(program.numbers[work.CELL_PITCH]) or _BAR_MM  # no braille, no cells
    cells = max(int(program.numbers[work.SLOTS]) // 2 - 2, 0)
    shape = shape_of(program, -cell_mm)
    deflections = line_map(program, start_mm=-cell_mm, end_mm=(cells + 1) * cell_mm)
    if form == "png":
        return to_png(deflections, shape, title=title, desc=note)
    return to_svg(deflections, shape, title=title, desc=note)


def shape_of(program: Program, start_mm: float, step_mm: float = STEP_MM) -> MapShape:
    """Tell how the map of a program that begins at a place lies on the canvas."""
    rows = program.shape[0]
    line_mm = float(program.numbers[work.LINE_PITCH]) or _BAR_MM
    row_mm = float(program.numbers[work.ROW_PITCH])
    if rows == 1 or not row_mm > 0:  # then the distance of rows has no meaning
        row_mm = _SINGLE_ROW * line_mm
    # An array that is higher than a line is drawn within its line: the whole array shows that one.
    return MapShape(rows, start_mm, step_mm, min(row_mm, line_mm / rows), line_mm)


def to_png(
    deflections: NDArray[np.floating],
    shape: MapShape,
    *,
    title: str,
    desc: str = "",
    bits: int = 8,
) -> bytes:
    """Write a map as a PNG in shades of grey, to scale.

    Parameters
    ----------
    deflections : float[lines · rows, places]
        A map as `line_map` makes it; NaN, which is not known, is white.
    shape
        How it lies on the canvas; pixels are square.
    title, desc
        Words that the file carries. The size and what the shades mean are added.
    bits
        Bits of a pixel, 8 or 16.

    Raises
    ------
    ValueError
        If the map does not have whole lines, or there are no such PNGs.
    """
    from PIL import Image
    from PIL.PngImagePlugin import PngInfo

    if bits not in _BLACK:
        raise ValueError(f"a map has 8 or 16 bits a pixel, not {bits}")
    grey = _on_canvas(deflections, shape, _BLACK[bits])
    words = PngInfo()
    words.add_itxt("Title", _clean(title))
    words.add_itxt("Description", _clean(_description(deflections, shape, desc)))
    made = io.BytesIO()
    per_inch = 25.4 / shape.step_mm
    image = Image.fromarray(grey)
    image.save(made, "PNG", pnginfo=words, dpi=(per_inch, per_inch))
    return made.getvalue()


def to_svg(
    deflections: NDArray[np.floating], shape: MapShape, *, title: str, desc: str = ""
) -> bytes:
    """Write a map as an SVG in millimetres, with a scale bar of 10 mm below it.

    Parameters
    ----------
    deflections, shape
        As `to_png` takes them.
    title, desc
        Words for those who do not see the picture. The size and what the shades mean are added.

    Raises
    ------
    ValueError
        If the map does not have whole lines.
    """
    width_mm, height_mm = _size_mm(deflections, shape)
    drawn = base64.b64encode(to_png(deflections, shape, title=title, desc=desc)).decode()
    wide_mm, high_mm = max(width_mm, 2 * _BAR_MM), height_mm + 8.0
    bar_mm = height_mm + 3.0
    left_mm, name = shape.start_mm - shape.step_mm / 2, _xml(title)
    svg = f"""<?xml version="1.0" encoding="UTF-8"?>
<svg xmlns="http://www.w3.org/2000/svg" width="{wide_mm:g}mm" height="{high_mm:g}mm" \
viewBox="{left_mm:g} 0 {wide_mm:g} {high_mm:g}" role="img" aria-labelledby="title desc">
<title id="title">{name}</title>
<desc id="desc">{_xml(_description(deflections, shape, desc))}</desc>
<rect x="{left_mm:g}" width="{wide_mm:g}" height="{high_mm:g}" fill="white"/>
<image x="{left_mm:g}" y="0" width="{width_mm:g}" height="{height_mm:g}" \
preserveAspectRatio="none" image-rendering="pixelated" href="data:image/png;base64,{drawn}"/>
<path d="M {left_mm:g} {bar_mm:g} h {_BAR_MM:g} m 0 -1 v 2 m -{_BAR_MM:g} -2 v 2" \
fill="none" stroke="black" stroke-width="0.3"/>
<text x="{left_mm + _BAR_MM + 1:g}" y="{bar_mm + 1:g}" font-family="sans-serif" \
font-size="3">{_BAR_MM:g} mm</text>
</svg>
"""
    return svg.encode()


def _on_canvas(
    deflections: NDArray[np.floating], shape: MapShape, black: int
) -> NDArray[np.unsignedinteger]:
    """Draw rows as bands, each line's in the middle of its line; what is not known is white."""
    lines = _lines(deflections, shape)
    kind = np.uint8 if black == 255 else np.uint16
    inked = np.clip(np.nan_to_num(deflections.astype(np.float64)), 0, 1) * black
    grey = (black - np.rint(inked)).astype(kind)
    high = _pixels(shape.line_mm, shape)
    edges_mm = shape.line_mm / 2 + shape.row_mm * (np.arange(shape.rows + 1) - shape.rows / 2)
    edges = np.clip(np.rint(edges_mm / shape.step_mm).astype(int), 0, high)
    canvas = np.full((lines, high, deflections.shape[1]), black, kind)
    for row in range(shape.rows):
        band = slice(edges[row], edges[row + 1])
        canvas[:, band] = grey[row :: shape.rows, None, :]
    return canvas.reshape(lines * high, -1)


def _pixels(length_mm: float, shape: MapShape) -> int:
    return max(round(length_mm / shape.step_mm), 1)


def _lines(deflections: NDArray[np.floating], shape: MapShape) -> int:
    lines, rest = divmod(deflections.shape[0], shape.rows)
    if rest or not deflections.size:
        raise ValueError(
            f"a map of {deflections.shape[0]} rows is not possible for lines of {shape.rows}"
        )
    return lines


def _size_mm(deflections: NDArray[np.floating], shape: MapShape) -> tuple[float, float]:
    """Tell the width and the height of a map as it is drawn, in whole pixels."""
    high = _lines(deflections, shape) * _pixels(shape.line_mm, shape)
    return deflections.shape[1] * shape.step_mm, high * shape.step_mm


def _description(deflections: NDArray[np.floating], shape: MapShape, desc: str) -> str:
    """Words on what a map shows and how large it is."""
    width_mm, height_mm = _size_mm(deflections, shape)
    end_mm = shape.start_mm + (deflections.shape[1] - 1) * shape.step_mm
    size = (
        f"Deflection of the actuators from {shape.start_mm:g} to {end_mm:g} mm; the picture is "
        f"{width_mm:g} mm × {height_mm:g} mm, {shape.step_mm:g} mm a pixel."
    )
    return " ".join(part for part in (desc, size, _NOTE) if part)


def _xml(text: str) -> str:
    return escape(_clean(text))


def _clean(text: str) -> str:
    """Text that any file can hold: control characters and lone surrogates are replaced."""
    return "".join(c if c.isprintable() or c in "\n\t" else "\ufffd" for c in text)
