"""Deflection maps: what the actuators do everywhere on a line or a page, as one picture.

Lévesque 2009, 8.3.3: each pixel of a map is a deflection, and white is rest. All actuators of a
row do the same where they stand at the same place. So one row of pixels tells of all of them.
"""

from __future__ import annotations

import base64
import io
from typing import TYPE_CHECKING, Final
from xml.sax.saxutils import escape

import numpy as np

from vbraille.render import work
from vbraille.render.work import ProgramKind

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.render.program import Program

STEP_MM: Final = 0.1  # side of a pixel
# A map is no larger.
MOST_PIXELS: Final = 50_000_000
# A single row of actuators is drawn so high, as a share of the distance between lines.
_SINGLE_ROW: Final = 0.4
_BAR_MM: Final = 10.0


def deflections_at(program: Program, x_mm: NDArray[np.float64]) -> NDArray[np.float32]:
    """Tell what actuators do at places of a line or a page of braille, from its program alone.

    Parameters
    ----------
    program
        The line or page, compiled.
    x_mm : float64[places]
        Places on the canvas.

    Returns
    -------
    float32[lines, rows, places]
        Deflection, 0 … 1, of an actuator of each row that stands at each place itself, whichever
        column it is in.

    Raises
    ------
    ValueError
        If these are too many places.
    """
    paged = program.kind is ProgramKind.PAGE
    lines = int(program.numbers[work.LINES]) if paged else 1
    rows = program.shape[0]
    if x_mm.size * lines * rows > MOST_PIXELS:
        raise ValueError(f"the map would have {x_mm.size} columns, which is too large")
    # The left column tells its own place then. What it does, all columns do at that place.
    left = program.with_anchor(0.0)
    if not paged:
        return left.path(x_mm)[:, :, 0].T[None]
    made = np.empty((lines, rows, x_mm.size), np.float32)
    for line in range(lines):
        y_mm = (line + 0.5) * float(program.numbers[work.LINE_PITCH])
        _, frames = left.poses(x_mm, np.full(x_mm.size, y_mm))
        made[line] = frames[:, :, 0].T
    return made


def picture(program: Program, form: str, title: str, note: str = "") -> bytes:
    """Make the map of the whole line or page of a program, as a file to scale.

    It begins and ends a cell beside the braille. Each line has its actuator rows as bands around
    its middle. A PNG has shades of grey, and an SVG has such a PNG with a scale bar of 10 mm below.

    Parameters
    ----------
    program
        The line or page, compiled.
    form
        "png" or "svg".
    title
        Title of the picture.
    note
        Sentence for those who do not see the picture. The size and what the shades mean are added.

    Raises
    ------
    ValueError
        If the form is another one, the picture is no braille, or it is too long.
    """
    if form not in ("png", "svg"):
        raise ValueError(f"a map is a png or an svg, not {form!r}")
    if program.kind not in (ProgramKind.LINE, ProgramKind.PAGE):
        kind = program.kind.name.lower()
        raise ValueError(f"a {kind} has no map of lines; vbraille map draws tactile pictures")
    cell_mm = float(program.numbers[work.CELL_PITCH]) or _BAR_MM  # no braille, no cells
    cells = max(int(program.numbers[work.SLOTS]) // 2 - 2, 0)
    places = int((cells + 2) * cell_mm / STEP_MM + 1e-9) + 1
    x_mm = STEP_MM * np.arange(places, dtype=np.float64) - cell_mm
    grey = _grey(program, deflections_at(program, x_mm))
    width_mm, height_mm = grey.shape[1] * STEP_MM, grey.shape[0] * STEP_MM
    title = _clean(title)
    shown = (
        f"Deflection of the actuators from {x_mm[0]:g} to {x_mm[-1]:g} mm; the picture is "
        f"{width_mm:g} mm × {height_mm:g} mm, {STEP_MM:g} mm a pixel. "
        f"White is rest, black is full deflection."
    )
    shown = _clean(f"{note} {shown}" if note else shown)
    png = _png(grey, title, shown)
    return png if form == "png" else _svg(png, x_mm[0], width_mm, height_mm, title, shown)


def _grey(program: Program, deflections: NDArray[np.float32]) -> NDArray[np.uint8]:
    """Draw rows as bands, each line's in the middle of its line; what is not known is white."""
    lines, rows, places = deflections.shape
    line_mm = float(program.numbers[work.LINE_PITCH]) or _BAR_MM
    row_mm = float(program.numbers[work.ROW_PITCH])
    if rows == 1 or not row_mm > 0:  # then the distance of rows has no meaning
        row_mm = _SINGLE_ROW * line_mm
    # An array that is higher than a line is drawn within its line: the whole array shows that one.
    row_mm = min(row_mm, line_mm / rows)
    high = max(round(line_mm / STEP_MM), 1)
    edges_mm = line_mm / 2 + row_mm * (np.arange(rows + 1) - rows / 2)
    edges = np.clip(np.rint(edges_mm / STEP_MM).astype(int), 0, high)
    inked = np.clip(np.nan_to_num(deflections.astype(np.float64)), 0, 1)
    grey = (255 - np.rint(255 * inked)).astype(np.uint8)
    canvas = np.full((lines, high, places), 255, np.uint8)
    for row in range(rows):
        canvas[:, edges[row] : edges[row + 1]] = grey[:, row, None]
    return canvas.reshape(lines * high, places)


def _png(grey: NDArray[np.uint8], title: str, desc: str) -> bytes:
    from PIL import Image
    from PIL.PngImagePlugin import PngInfo

    words = PngInfo()
    words.add_itxt("Title", title)
    words.add_itxt("Description", desc)
    made = io.BytesIO()
    per_inch = 25.4 / STEP_MM
    Image.fromarray(grey).save(made, "PNG", pnginfo=words, dpi=(per_inch, per_inch))
    return made.getvalue()


def _svg(
    png: bytes, start_mm: float, width_mm: float, height_mm: float, title: str, desc: str
) -> bytes:
    """Put a PNG whose first pixels are at a place into an SVG in millimetres."""
    drawn = base64.b64encode(png).decode()
    wide_mm, high_mm = max(width_mm, 2 * _BAR_MM), height_mm + 8.0
    left_mm, bar_mm = start_mm - STEP_MM / 2, height_mm + 3.0
    svg = f"""<?xml version="1.0" encoding="UTF-8"?>
<svg xmlns="http://www.w3.org/2000/svg" width="{wide_mm:g}mm" height="{high_mm:g}mm" \
viewBox="{left_mm:g} 0 {wide_mm:g} {high_mm:g}" role="img" aria-labelledby="title desc">
<title id="title">{escape(title)}</title>
<desc id="desc">{escape(desc)}</desc>
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


def _clean(text: str) -> str:
    """Text that any file can hold: control characters and lone surrogates are replaced."""
    return "".join(c if c.isprintable() or c in "\n\t" else "\ufffd" for c in text)
