"""Tactile pictures that are measured: dense ones, which were written before anything was."""

from __future__ import annotations

import numpy as np
from msgspec.structs import replace

from tests.conftest import SEED
from vbraille.display import Display
from vbraille.render.labels import Assets
from vbraille.scene.bitmap import Bitmap
from vbraille.scene.patterns import (
    Across,
    Along,
    AxialGrating,
    Circle,
    Dots,
    DotStyle,
    Dotting,
    Fill,
    Group,
    Image,
    LinearGrating,
    Moving,
    MovingCue,
    PathShape,
    Polygon,
    RadialGrating,
    StraightLine,
    Stroke,
    UniformVibration,
)
from vbraille.scene.scene import Canvas, Scene
from vbraille.scene.signals import Direction, Inverse, Product, Pulse, Speed, Switch

# The display of the source's own measurements: Lévesque 2009, 6.2.
DISPLAY = Display("8 × 8", 8, 8, 1.2, 1.4, travel_mm=220.0, height_mm=150.0, turns=True)
CANVAS = Canvas(width_mm=220.0, height_mm=150.0)
_PLACE_MM = 8.0  # a shape stands on each square of this size
_BLOCK = (5, 2)  # squares of ten shapes


def masked() -> tuple[Scene, Assets]:
    """Two gratings through the mask of an image that covers the canvas."""
    gratings = Group(
        operation="add",
        parts=(
            LinearGrating(ridge_mm=4.0, gap_mm=2.0, amplitude=0.5),
            LinearGrating(ridge_mm=6.0, wave_angle_deg=60.0, amplitude=0.5),
        ),
    )
    image = Image(file="noise.png", width_mm=220.0, texture=gratings)
    pixels = np.random.default_rng(SEED).integers(0, 65_536, (750, 1100)).astype(np.uint16)
    bitmap = Bitmap(pixels, (0.0, 0.0), 220.0, 150.0)
    return Scene(canvas=CANVAS, elements=(image,)), Assets({image: bitmap})


def nested() -> tuple[Scene, Assets]:
    """Ten parts in each other, each of which is under every actuator wherever it is."""
    middle = (110.0, 75.0)
    chosen = Group(
        operation="blend",
        by=RadialGrating(center_mm=middle, ridge_mm=30.0),
        parts=(
            Group(
                operation="maximum",
                parts=(
                    LinearGrating(ridge_mm=3.0, gap_mm=2.0),
                    LinearGrating(ridge_mm=5.0, wave_angle_deg=90.0),
                    Group(
                        operation="multiply",
                        parts=(LinearGrating(ridge_mm=8.0), UniformVibration(frequency_hz=40.0)),
                    ),
                ),
            ),
            Group(
                operation="weighted",
                weights=(0.4, 0.6),
                parts=(
                    AxialGrating(center_mm=middle, ridge_deg=10.0),
                    Group(
                        operation="add",
                        parts=(
                            RadialGrating(center_mm=(0.0, 0.0), ridge_mm=4.0, amplitude=0.5),
                            LinearGrating(ridge_mm=4.0, wave_angle_deg=45.0, amplitude=0.5),
                        ),
                    ),
                ),
            ),
        ),
    )
    fill = LinearGrating(ridge_mm=2.0, wave_angle_deg=30.0)
    everywhere = Circle(center_mm=middle, radius_mm=300.0, fill=Fill(texture=fill))
    return (
        Scene(canvas=CANVAS, operation="maximum", elements=(chosen, everywhere)),
        Assets(),
    )


def answering() -> Scene:
    """Eight layers under every actuator, each of which follows a signal of its own."""
    signals = {
        "slow": Speed(),
        "right": Direction(),
        "down": Direction(angle_deg=90.0, axis=True, at_rest="low"),
        "view": Switch(levels=(0.9, 0.1)),
        "beat": Pulse(period_s=0.7),
        "ramp": Pulse(shape="ramp", period_s=3.0),
        "both": Product(of=("right", "beat")),
        "fast": Inverse(of="slow"),
    }
    layers = tuple(
        LinearGrating(ridge_mm=3.0 + n, wave_angle_deg=20.0 * n, factor=name)
        for n, name in enumerate(signals)
    )
    return Scene(canvas=CANVAS, operation="add", elements=layers, signals=signals)


def without_signals(scene: Scene) -> Scene:
    """Scene whose layers are all there, whatever the hand does."""
    still = tuple(replace(element, factor="") for element in scene.elements)
    return replace(scene, elements=still, signals={})


def hidden(scene: Scene, layers: int) -> Scene:
    """Make a scene whose last layers are switched off, as many as asked for."""
    signals = {"off": Switch(levels=(0.0, 1.0))}
    shown, others = scene.elements[:-layers], scene.elements[-layers:]
    off = tuple(replace(element, factor="off") for element in others)
    return replace(scene, elements=(*shown, *off), signals=signals)


def ten_parts(speed: float) -> Scene:
    """Ten parts about one place that move at a speed, or at 0 stand still."""
    x, y = CANVAS.width_mm / 2, CANVAS.height_mm / 2
    corners = ((x - 9, y - 7), (x + 9, y - 6), (x, y + 9))
    along = Stroke(along=Along(ridge_mm=3.0, velocity_mm_s=speed))
    dots = Dotting(dot=DotStyle(radius_mm=1.0), velocity_mm_s=speed)
    carried = AxialGrating(center_mm=(x + 30, y), ridge_deg=9.0, amplitude=0.3)
    cue = MovingCue(way="add", velocity_mm_s=speed)
    parts = (
        LinearGrating(ridge_mm=4.0, velocity_mm_s=speed, amplitude=0.3),
        RadialGrating(center_mm=(x, y), ridge_mm=5.0, velocity_mm_s=speed, amplitude=0.3),
        AxialGrating(center_mm=(x, y), ridge_deg=12.0, velocity_deg_s=speed, amplitude=0.3),
        Moving(part=carried, velocity_mm_s=(speed, speed)) if speed else carried,
        StraightLine(start_mm=(x - 20, y), end_mm=(x + 20, y), stroke=along),
        Circle(center_mm=(x, y), radius_mm=6.0, stroke=along),
        StraightLine(start_mm=(x - 20, y + 4), end_mm=(x + 20, y + 4), dots=dots),
        Circle(center_mm=(x, y), radius_mm=10.0, dots=dots),
        Polygon(vertices_mm=corners, dots=dots),
        StraightLine(start_mm=(x, y - 20), end_mm=(x, y + 20), stroke=Stroke(), cue=cue),
    )
    return Scene(canvas=CANVAS, operation="maximum", elements=parts)


def short_lines() -> Scene:
    """Fifteen short lines, five in each of three rows: Lévesque 2009, 8.5.3."""
    starts = [(20.0 + 44.0 * n, 25.0 + 50.0 * row) for row in range(3) for n in range(5)]
    lines = (
        StraightLine(
            start_mm=(x, y),
            end_mm=(x + 12.0, y + 6.0),
            stroke=Stroke(width_mm=4.0, along=Along(ridge_mm=2.0)),
        )
        for x, y in starts
    )
    return Scene(canvas=CANVAS, elements=tuple(lines))


def shapes(count: int) -> Scene:
    """So many shapes, a multiple of ten: the same ten again and again, close to each other."""
    blocks = count // 10
    across = max(n for n in range(1, int(blocks**0.5) + 1) if blocks % n == 0)
    wide, high = _BLOCK[0] * _PLACE_MM, _BLOCK[1] * _PLACE_MM
    random = np.random.default_rng(SEED)
    ten = [random.uniform(-0.5, 0.5, 6).tolist() for _ in range(10)]
    elements = tuple(
        _shape(
            n,
            wide * (block % across) + _PLACE_MM * (n % _BLOCK[0] + 0.5),
            high * (block // across) + _PLACE_MM * (n // _BLOCK[0] + 0.5),
            ten[n],
        )
        for block in range(blocks)
        for n in range(10)
    )
    canvas = Canvas(width_mm=wide * across, height_mm=high * (blocks // across))
    return Scene(canvas=canvas, elements=elements)


def _shape(n: int, x: float, y: float, by: list[float]) -> StraightLine | Circle | Polygon | Dots:
    """One of ten shapes about a place: four lines, three circles, two triangles and some dots."""
    if n < 4:
        stroke = Stroke(width_mm=3.0, along=None if n % 2 else Along(ridge_mm=2.0))
        start, end = (x - 3 + by[0], y - 3 + by[1]), (x + 3 + by[2], y + 3 + by[3])
        return StraightLine(start_mm=start, end_mm=end, stroke=stroke)
    if n < 7:
        fill = Fill(texture=LinearGrating(ridge_mm=2.0)) if n == 6 else None
        stroke = Stroke(width_mm=2.0, across=Across(cycles=3) if n == 5 else None)
        return Circle(center_mm=(x + by[0], y + by[1]), radius_mm=3.0, stroke=stroke, fill=fill)
    if n < 9:
        fill = Fill(texture=LinearGrating(ridge_mm=2.0, wave_angle_deg=90.0)) if n == 8 else None
        corners = (
            (x - 3 + by[0], y - 3 + by[1]),
            (x + 3 + by[2], y - 2 + by[3]),
            (x + by[4], y + 3 + by[5]),
        )
        return Polygon(vertices_mm=corners, stroke=Stroke(width_mm=1.5), fill=fill)
    centers = ((x - 2, y - 2), (x + 2 + by[0], y - 2), (x - 2, y + 2 + by[1]), (x + 2, y + 2))
    return Dots(centers_mm=centers, dot=DotStyle(radius_mm=1.0))


def within_ten(count: int, places: int) -> np.ndarray:
    """Places in a scene of so many shapes from which the array reaches nothing beyond its ten.

    Returns
    -------
    float64[places, 2]
        Places of the array's centre; the same within their ten, in whichever these are.
    """
    blocks = count // 10
    across = max(n for n in range(1, int(blocks**0.5) + 1) if blocks % n == 0)
    wide, high = _BLOCK[0] * _PLACE_MM, _BLOCK[1] * _PLACE_MM
    inside = np.random.default_rng(SEED).uniform((7.0, 7.0), (wide - 7.0, high - 7.0), (places, 2))
    block = np.random.default_rng(SEED + 1).integers(0, blocks, places)
    return inside + np.stack([wide * (block % across), high * (block // across)], axis=1)


def through_tens(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Path of a finger through a scene of so many shapes, at 100 mm/s and 1,000 frames a second.

    It goes once through each ten of them, as far as the array reaches nothing beyond these.

    Returns
    -------
    float64[n, 2], float64[count / 10, 2]
        Places of the path within a ten, and the corners of the tens, line by line.
    """
    blocks = np.arange(count // 10)
    across = max(n for n in range(1, int(blocks.size**0.5) + 1) if blocks.size % n == 0)
    wide, high = _BLOCK[0] * _PLACE_MM, _BLOCK[1] * _PLACE_MM
    x_mm = np.arange(7.0, wide - 7.0, 0.1)
    within = np.stack([x_mm, np.linspace(7.0, high - 7.0, x_mm.size)], axis=1)
    return within, np.stack([wide * (blocks % across), high * (blocks // across)], axis=1)


_TOOTH_MM = (12.0, 40.0, 16.0)  # steps along a tooth, from tooth to tooth, and their height


def toothed(rows: int, steps: int) -> Scene:
    """One filled path: a comb of so many teeth, each with jagged edges of so many steps.

    Of 1 tooth with 3 steps it has 10 segments.
    """
    step, pitch, high = _TOOTH_MM
    places = [(0.0, 0.0)]
    for row in range(rows):
        edge = [(20.0 + step * n, pitch * row + 12.0 + 2.0 * (n % 2)) for n in range(steps + 1)]
        places += [*edge, *((x, y + high) for x, y in reversed(edge))]
    places.append((0.0, pitch * rows))
    path = PathShape(
        contours_mm=(tuple(places),),
        closed=True,
        stroke=Stroke(width_mm=2.0),
        fill=Fill(texture=LinearGrating(ridge_mm=2.0)),
    )
    canvas = Canvas(width_mm=40.0 + step * steps, height_mm=pitch * rows)
    return Scene(canvas=canvas, elements=(path,))


def along_teeth(rows: int, steps: int) -> tuple[np.ndarray, np.ndarray]:
    """Path of a finger along the edge of a tooth of a comb, and where else it can go the same way.

    Returns
    -------
    float64[n, 2], float64[m, 2]
        Places, from which the array reaches neither the tooth's ends nor others; and how far the
        same places are from there, in reading order.
    """
    step, pitch, _ = _TOOTH_MM
    x_mm = np.arange(31.0, 45.0, 0.1)
    within = np.stack([x_mm, np.linspace(8.0, 28.0, x_mm.size)], axis=1)
    column, row = np.meshgrid(np.arange(max(1, (steps - 2) // 2)), np.arange(rows))
    return within, np.stack([2 * step * column.ravel(), pitch * row.ravel()], axis=1)
