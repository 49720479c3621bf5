"""Abstract and raised drawings: true to scale, and fit for fingers."""

import io

import numpy as np
import pytest
from PIL import Image
from scipy import ndimage

from vbraille.pictures.abstract import abstract_drawing
from vbraille.pictures.drawink import ink_png
from vbraille.pictures.ink import InkClip, InkDiscs, InkLine
from vbraille.pictures.looks import RAISED
from vbraille.pictures.raised import MARGIN_MM, raised_drawing
from vbraille.render import LATERO
from vbraille.render.scene.assets import Assets, Written
from vbraille.scene.dots import Dots
from vbraille.scene.labels import Label
from vbraille.scene.patterns import Circle, Fill, Group, Polygon
from vbraille.scene.scene import Canvas, Scene
from vbraille.scene.shapes import StraightLine
from vbraille.scene.strokes import Along, DotStyle, Dotting, Stroke, Vibration
from vbraille.scene.textures import LinearGrating, RadialGrating, Uniform, UniformVibration

CANVAS = Canvas(width_mm=60, height_mm=40)
PER_MM = 10
NOTHING = Uniform(level=0)


def scene_of(*elements, canvas=CANVAS):
    return Scene(canvas=canvas, elements=elements)


def plain_marks(drawing):
    for mark in drawing.marks:
        yield from mark.marks if isinstance(mark, InkClip) else (mark,)


def ink_of(drawing):
    """Share of ink at each place; float[rows, columns] with 10 pixels a mm."""
    with Image.open(io.BytesIO(ink_png(drawing, PER_MM))) as image:
        return 1 - np.array(image, float) / 255


def at(ink, x_mm, y_mm):
    return ink[round(y_mm * PER_MM), round(x_mm * PER_MM)]


@pytest.mark.parametrize("angle", [0, 30, 90, 200])
def test_ridges_have_their_direction_and_wavelength(angle):
    grating = LinearGrating(ridge_mm=4, gap_mm=2, wave_angle_deg=angle, start_mm=(10, 10))
    ink = ink_of(abstract_drawing(scene_of(grating), Assets()))
    travel = np.array([np.cos(np.radians(angle)), np.sin(np.radians(angle))])
    for cycle in range(4):
        for along, share in ((2, 0.75), (0, 0), (5, 0)):
            x, y = np.array([30, 20]) + ((6 * cycle + along - 10) % 24 - 12) * travel
            u = (np.array([x, y]) - 10) @ travel
            shown = at(ink, x, y)
            g = 0.5 - 0.5 * np.cos(2 * np.pi * (u % 6) / 4) if u % 6 < 4 else 0  # eq. 8.4
            if abs(g - 0.5) > 0.15:
                assert (shown > 0.3) == (g > 0.5), (u, along, share)


def test_a_stroke_is_as_thick_as_it_is_felt_and_grays_are_strengths():
    stroke = Stroke(width_mm=6, edge_mm=2)
    line = StraightLine(start_mm=(10, 20), end_mm=(50, 20), stroke=stroke)
    ink = ink_of(abstract_drawing(scene_of(line), Assets()))
    thick = (ink[:, 300] > 0.3).sum() / PER_MM
    assert thick == pytest.approx(4, abs=0.15)  # 6 mm less half of an edge at each side
    weak = StraightLine(start_mm=(10, 20), end_mm=(50, 20), stroke=stroke, amplitude=0.4)
    assert ink_of(abstract_drawing(scene_of(weak), Assets())).max() == pytest.approx(0.3, abs=0.02)


def test_what_hides_something_hides_it_here_too():
    below = LinearGrating(ridge_mm=2)
    disc = Circle(
        center_mm=(30, 20),
        radius_mm=10,
        stroke=Stroke(width_mm=2),
        fill=Fill(texture=NOTHING),
    )
    ink = ink_of(abstract_drawing(scene_of(below, disc), Assets()))
    assert ink[170:230, 270:330].max() < 0.02
    union = Group(operation="maximum", parts=(below, disc))
    assert ink_of(abstract_drawing(scene_of(union), Assets()))[170:230, 270:330].max() > 0.3


def test_a_product_is_the_texture_within_the_shape():
    disc = Circle(center_mm=(30, 20), radius_mm=10, fill=Fill(texture=Uniform()))
    both = Group(operation="multiply", parts=(disc, LinearGrating(ridge_mm=4)))
    ink = ink_of(abstract_drawing(scene_of(both), Assets()))
    rows, columns = np.nonzero(ink > 0.3)
    away = np.hypot(columns / PER_MM - 30, rows / PER_MM - 20)
    assert away.max() < 10.3
    assert at(ink, 30, 20) > 0.3  # a ridge has its middle 2 mm after a multiple of 4
    assert at(ink, 28, 20) < 0.1


def gaps_and_lines(ink, mm):
    """Whether black and white are nowhere thinner than so many mm: opening changes hardly any."""
    size = round(mm * PER_MM) - 2
    disc = np.hypot(*np.mgrid[-size : size + 1, -size : size + 1]) <= size / 2
    opened = ndimage.binary_opening(ink, disc)
    return (ink & ~opened).sum() / max(ink.sum(), 1)


RAISED_SCENES = {
    "fine ridges": (LinearGrating(ridge_mm=1, wave_angle_deg=20),),
    "fine rings": (RadialGrating(center_mm=(20, 20), ridge_mm=0.7, gap_mm=0.4),),
    "vibration": (UniformVibration(),),
    "thin line": (StraightLine(start_mm=(5, 5), end_mm=(50, 30), stroke=Stroke(width_mm=0.3)),),
    "cut line": (
        StraightLine(
            start_mm=(5, 5), end_mm=(50, 30), stroke=Stroke(width_mm=4, along=Along(ridge_mm=1))
        ),
    ),
    "shaking circle": (
        Circle(center_mm=(30, 20), radius_mm=15, stroke=Stroke(width_mm=4, vibration=Vibration())),
    ),
    "dots": (Dots(centers_mm=((10, 10), (20, 20)), dot=DotStyle(radius_mm=0.4)),),
}


@pytest.mark.parametrize("name", RAISED_SCENES)
def test_raised_lines_and_blanks_are_wide_enough(name):
    drawing = abstract_drawing(scene_of(*RAISED_SCENES[name]), Assets(), RAISED)
    ink = ink_of(drawing)
    edge = (ink > 0.1) & (ink < 0.9)
    assert edge.mean() < 0.2  # of smoothed edges; there are no grays
    black = ink > 0.5
    assert black.any()
    assert gaps_and_lines(black, 0.75) < 0.1
    assert gaps_and_lines(~black, 2.0) < 0.1


def test_blank_is_left_around_what_lies_on_something_else():
    below = LinearGrating(ridge_mm=4)
    line = StraightLine(start_mm=(10, 20), end_mm=(50, 20), stroke=Stroke(width_mm=2, edge_mm=0.2))
    ink = ink_of(abstract_drawing(scene_of(below, line), Assets(), RAISED))
    assert ink[174:188, 150:450].max() < 0.1
    assert ink[212:226, 150:450].max() < 0.1
    assert ink[195:205, 150:450].min() > 0.9


def test_braille_is_of_the_size_of_paper_whatever_the_scale():
    label = Label(text="l", place_mm=(100, 50))
    masks = np.array([0b000111], np.uint8)  # dots 1, 2 and 3
    assets = Assets(written={label: Written((masks,), LATERO.style)})
    canvas = Canvas(width_mm=540, height_mm=360)
    for sheet in (None, "a4"):
        drawing = raised_drawing(scene_of(label, canvas=canvas), assets, sheet)
        discs = next(mark for mark in plain_marks(drawing) if isinstance(mark, InkDiscs))
        assert 2 * discs.radius_mm == pytest.approx(1.5)
        assert np.diff(discs.centers_mm[:, 1]) == pytest.approx([2.29, 2.29])
    assert (drawing.width_mm, drawing.height_mm) == (297, 210)
    scale = (297 - 2 * MARGIN_MM) / 540
    assert (
        drawing.said[1]
        == f"scale: {scale:.3f} of the true size, since the canvas is larger than the paper"
    )
    assert discs.centers_mm[0] == pytest.approx(
        (MARGIN_MM + 100 * scale + 0.75, (210 - 360 * scale) / 2 + 50 * scale + 0.75)
    )


def test_vibrating_dots_are_whole_and_inside():
    disc = Circle(center_mm=(30, 20), radius_mm=12, fill=Fill(texture=UniformVibration()))
    drawing = abstract_drawing(scene_of(disc), Assets(), RAISED)
    discs = next(mark for mark in plain_marks(drawing) if isinstance(mark, InkDiscs))
    away = np.hypot(*(discs.centers_mm - [30, 20]).T)
    assert len(away) > 10
    assert (away + discs.radius_mm).max() < 12.4


def test_dots_along_a_closed_stroke_are_a_whole_number():
    vertices = ((10.0, 5.0), (50.0, 5.0), (30.0, 35.0))
    stroke = Stroke(width_mm=3, vibration=Vibration())
    drawing = abstract_drawing(
        scene_of(Polygon(vertices_mm=vertices, stroke=stroke)), Assets(), RAISED
    )
    line = next(mark for mark in plain_marks(drawing) if isinstance(mark, InkLine))
    around = np.hypot(*(np.roll(vertices, -1, axis=0) - vertices).T).sum()
    assert around / sum(line.dashes_mm) == pytest.approx(round(around / sum(line.dashes_mm)))


def test_dotted_shapes_have_their_dots():
    line = StraightLine(start_mm=(10, 10), end_mm=(50, 10), dots=Dotting(dot=DotStyle(radius_mm=2)))
    drawing = abstract_drawing(scene_of(line), Assets())
    discs = next(mark for mark in plain_marks(drawing) if isinstance(mark, InkDiscs))
    assert len(discs.centers_mm) == 9  # ⌊40 / 5⌋ + 1
    assert discs.radius_mm == pytest.approx(1)  # where a smooth dot is half as high


def test_a_group_of_textures_that_vibrates_and_an_inverted_label_are_drawn():
    textures = Group(parts=(Uniform(level=0.5),), vibration=Vibration())
    label = Label(text="l", place_mm=(20, 10), inverted=True)
    masks = np.array([0b000111], np.uint8)
    assets = Assets(written={label: Written((masks,), LATERO.style)})
    drawing = abstract_drawing(scene_of(textures, label), assets)
    assert any(isinstance(mark, InkDiscs) for mark in plain_marks(drawing))
    assert ink_of(drawing).max() > 0.5
