"""Deflection maps of scenes: one pixel, one deflection (Lévesque 2009, 8.3.3).

Rest is white and full swing is black, as in the maps of the source's author. What vibrates has
either the deflections of one moment, or random ones of the same range in their place.
"""

from __future__ import annotations

import io
import math
from typing import TYPE_CHECKING

import numpy as np
from PIL import Image
from PIL.PngImagePlugin import PngInfo

from vbraille.errors import InputError
from vbraille.pictures.words import plain
from vbraille.scene.patterns import Moving
from vbraille.scene.signals import Pulse
from vbraille.scene.traversal import each, vibrations, waves_of
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from numpy.typing import NDArray

    from vbraille.render.labels import Assets
    from vbraille.scene.scene import Canvas, Scene

PIXELS_PER_MM = 4.0
# Pixels of a map that each kind of file is made of within 300 MB; A3 has 12 million at 10 a mm.
MOST_PIXELS = {
    "png": 13_000_000,
    "gif": 16_000_000,
    "csv": 10_000_000,
    "svg": 3_700_000,
    "pdf": 2_000_000,
}
MOST_PLACED_PIXELS = 1_300_000  # of a map with axes or an array in a PNG: A4 at 4 a mm
_FRAME_MS = 100  # how long an animation shows each map: eyes see no 50 Hz
MM_PER_INCH = 25.4
_UNKNOWN_MM = 10.0  # way of what moves without a wave, in a sequence
# Limits of a small map, which a page loads and a recording keeps.
_SMALL_PIXELS, _SMALL_BYTES = 300_000, 120_000


def map_places(
    canvas: Canvas, pixels_per_mm: float = PIXELS_PER_MM
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Places of the middles of a map's pixels.

    Parameters
    ----------
    canvas
        The canvas that is shown whole.
    pixels_per_mm
        Resolution, above 0.

    Returns
    -------
    float64[columns], float64[rows]
        x and y in mm.

    Raises
    ------
    InputError
        If the resolution is no number above 0, or the map would have too many pixels.
    """
    columns, rows = check_pixels(canvas, pixels_per_mm)
    x, y = (np.arange(count, dtype=np.float64) + 0.5 for count in (columns, rows))
    return x / pixels_per_mm, y / pixels_per_mm


def check_pixels(
    canvas: Canvas, pixels_per_mm: float, maps: int = 1, most: int = MOST_PIXELS["png"]
) -> tuple[int, int]:
    """Compute the columns and rows of a map, if there is room for all the maps.

    Parameters
    ----------
    canvas
        The canvas that is shown whole.
    pixels_per_mm
        Resolution, above 0.
    maps
        Number of maps.
    most
        Number of pixels that there is room for.

    Raises
    ------
    InputError
        If the resolution is no number above 0, or there would be too many pixels.
    """
    if not 0 < pixels_per_mm <= 1000:
        raise InputError(
            f"{setting('resolution')} is {pixels_per_mm:g} pixels a mm; it must be above 0 and at "
            "most 1000"
        )
    columns = max(round(canvas.width_mm * pixels_per_mm), 1)
    rows = max(round(canvas.height_mm * pixels_per_mm), 1)
    if columns * rows * maps > most:
        fits = (most / (maps * canvas.width_mm * canvas.height_mm)) ** 0.5
        what = "the picture would be" if maps == 1 else f"{maps} maps would each be"
        raise InputError(
            f"{what} {columns} × {rows} pixels, and there is room for "
            f"{most // 10**6} million; give {setting('resolution')} {0.99 * fits:.2g} or "
            "less"
        )
    return columns, rows


def slowest_s(scene: Scene) -> float | None:
    """Longest period of what vibrates or moves in a scene, in s; None if nothing does."""
    swings = [swing.frequency_hz for one in scene.elements for swing in vibrations(one)]
    periods = [1.0 / frequency_hz for frequency_hz in swings]
    periods += [one.period_s for one in scene.signals.values() if isinstance(one, Pulse)]
    waves = (wave for part in each(*scene.elements) for _, wave in waves_of(part))
    periods += [1.0 / wave.flow_hz for wave in waves if wave.speed]
    periods += [
        _passing_s(part)
        for part in each(*scene.elements)
        if isinstance(part, Moving) and any(part.velocity_mm_s)
    ]
    return max(periods, default=None)


def _passing_s(moving: Moving) -> float:
    """Time in which the longest wave of a texture goes by that moves as a whole, s."""
    waves = (wave for part in each(moving.part) for _, wave in waves_of(part))
    lengths = [wave.length for wave in waves if wave.in_mm]
    return max(lengths, default=_UNKNOWN_MM) / math.hypot(*moving.velocity_mm_s)


def map_deflections(
    scene: Scene,
    assets: Assets,
    pixels_per_mm: float = PIXELS_PER_MM,
    *,
    noise_seed: int | None = 0,
    time_s: float = 0.0,
    parity: int = 0,
) -> NDArray[np.float32]:
    """Deflections of a scene all over its canvas.

    Parameters
    ----------
    scene, assets
        A resolved scene, and what it takes from image files and labels.
    pixels_per_mm
        Resolution.
    noise_seed
        Seed of the noise that stands for vibration; None for the deflections at a time.
    time_s, parity
        That time, and the actuators that are meant: 0 those whose row and column are both even
        or both odd, 1 the others.

    Returns
    -------
    float32[rows, columns]
        Deflections from 0 to 1; row 0 is far from the reader.

    Raises
    ------
    InputError
        As `map_places` has it.
    """
    from vbraille.render.compiling import SceneMap  # loads the kernels

    x_mm, y_mm = map_places(scene.canvas, pixels_per_mm)
    drawn = SceneMap(scene, assets)
    if noise_seed is not None and any(map(vibrations, scene.elements)):
        return drawn.deflections(x_mm, y_mm, noise_seed=noise_seed)
    return drawn.deflections(x_mm, y_mm, time_s=time_s, parity=parity)


def grays(deflections: NDArray[np.floating]) -> NDArray[np.uint8]:
    """Gray levels of deflections: 255, white, at rest, and 0, black, at full swing.

    Parameters
    ----------
    deflections : floating[…]
        Deflections from 0 to 1.

    Returns
    -------
    uint8[…]
        Gray levels, in the same shape.
    """
    levels = np.empty(deflections.shape, np.uint8)
    for row, from_there in zip(np.atleast_2d(levels), np.atleast_2d(deflections), strict=True):
        row[...] = 255.0 * (1.0 - from_there) + 0.5
    return levels


def small_png(scene: Scene, assets: Assets) -> bytes:
    """Make the deflection map of a scene as a PNG of 120 kB at most, for pages and recordings.

    What vibrates is as it is at the beginning, since noise would make the file larger.

    Parameters
    ----------
    scene, assets
        A resolved scene, and what it takes from image files and labels.
    """
    canvas = scene.canvas
    area_mm2 = canvas.width_mm * canvas.height_mm
    per_mm = min(PIXELS_PER_MM, math.sqrt(_SMALL_PIXELS / area_mm2))
    while True:
        drawn = map_deflections(scene, assets, per_mm, noise_seed=None)
        content = png(grays(drawn), per_mm)
        if len(content) <= _SMALL_BYTES:
            return content
        per_mm /= 1.5


def png(
    pixels: NDArray[np.uint8], pixels_per_mm: float, told: Mapping[str, str] | None = None
) -> bytes:
    """Make a PNG of a gray map.

    Parameters
    ----------
    pixels : uint8[rows, columns]
        The map.
    pixels_per_mm
        Resolution, which is kept in the file.
    told
        Texts to be kept in the file, by their keywords; empty ones are left out.
    """
    inside = PngInfo()
    for key, text in {**(told or {}), "Software": "vbraille"}.items():
        if text.strip():
            inside.add_text(key, plain(text))
    dpi = pixels_per_mm * MM_PER_INCH
    content = io.BytesIO()
    Image.fromarray(pixels).save(content, "png", dpi=(dpi, dpi), pnginfo=inside, optimize=True)
    return content.getvalue()


def gif(maps: Sequence[NDArray[np.uint8]], told: str = "") -> bytes:
    """Make an animated GIF of gray maps, with a text as its comment.

    Parameters
    ----------
    maps : sequence of uint8[rows, columns]
        The maps, at least one, all of one shape.
    told
        The text.
    """
    first, *others = map(Image.fromarray, maps)
    content = io.BytesIO()
    first.save(
        content,
        "gif",
        save_all=True,
        append_images=others,
        duration=_FRAME_MS,
        loop=0,
        comment=plain(told).encode(),
    )
    return content.getvalue()


def map_csv(
    header: str,
    x: NDArray[np.float64],
    y: NDArray[np.float64],
    values: NDArray[np.floating],
) -> Iterator[bytes]:
    """Write a map as CSV in the long form: a row for each pixel with x, y and its value.

    Parameters
    ----------
    header
        Names of the three columns.
    x, y : float64[columns], float64[rows]
        Places of its columns and rows.
    values : floating[rows, columns]
        The map.

    Yields
    ------
    bytes
        The file, a row of pixels at a time.
    """
    yield f"{header}\n".encode()
    across = [f"{one:.10g}" for one in x.tolist()]
    for down, row in zip(y.tolist(), values, strict=True):
        cells = zip(across, row.tolist(), strict=True)
        yield "".join(f"{one},{down:.10g},{round(value, 6):g}\n" for one, value in cells).encode()
