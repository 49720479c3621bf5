"""A page of braille with a figure in it."""

import numpy as np
import pytest

from tests.render.scene.lanes import lane_places
from tests.render.scene.twinbraille import label_deflections
from vbraille.errors import InputError
from vbraille.labelling import write_labels
from vbraille.render import LATERO, STRESS2_8X8, Straying
from vbraille.render.compiling import compile_scene
from vbraille.render.figures import FIGURE, PAGE, FigureAt, page_with_figures
from vbraille.render.labels import Assets
from vbraille.scene.bitmap import Bitmap
from vbraille.scene.patterns import (
    Circle,
    Group,
    Image,
    Label,
    LinearGrating,
    Stroke,
    Tile,
    Uniform,
)
from vbraille.scene.scene import Canvas, Scene

STYLE = STRESS2_8X8.style


def figure(*elements, **more):
    return Scene(canvas=Canvas(width_mm=60, height_mm=40), elements=elements, **more)


def page_with_figure(lines, style, figure, place_mm, assets=None):
    return page_with_figures(lines, style, (FigureAt(figure, place_mm, assets or Assets()),))


CIRCLE = Circle(center_mm=(30, 20), radius_mm=10, stroke=Stroke())


@pytest.mark.parametrize("model", [STRESS2_8X8, LATERO], ids=["stress2-8x8", "latero"])
def test_the_text_stands_where_a_page_has_it(model, rng):
    lines = [rng.integers(0, 256, 6 + n).astype(np.uint8) for n in range(4)]
    style = model.style.replace(straying=Straying("free"))
    page = style.render_page(lines, model.display)
    scene, assets = page_with_figure(lines, style, figure(), (0.0, 0.0))
    (label,) = scene.elements
    frame = np.zeros(model.display.shape)
    for x_mm, y_mm, theta in rng.uniform((0, 0, -0.3), (70, 50, 0.3), (40, 3)):
        page.frame(x_mm, frame, y_mm=y_mm, theta_rad=theta)
        places = lane_places(model.display, x_mm, y_mm, theta)
        found = label_deflections(label, assets.written[label], *places)
        np.testing.assert_allclose(found.reshape(frame.shape), frame, rtol=0, atol=1e-9)


def test_the_figure_stands_at_its_place_and_takes_what_it_needs_along():
    name = Label(text="moon", place_mm=(2.0, 3.0))
    image = Image(file="m.png", place_mm=(10.0, 10.0), width_mm=5, texture=Uniform())
    tile = Tile(width_mm=5, height_mm=5, part=Label(text="x", place_mm=(1.0, 1.0)))
    own = figure(CIRCLE, Group(operation="maximum", parts=(name, image)), tile)
    bitmap = Bitmap(np.full((2, 2), 9, np.uint16), (10.0, 10.0), 5.0, 5.0)
    assets = Assets({image: bitmap}, write_labels(own, STYLE))
    lines = [np.full(8, 63, np.uint8)] * 12
    scene, taken = page_with_figure(lines, STYLE, own, (15.0, 22.0), assets)
    text, shown = scene.elements
    assert (text.id, shown.id) == (PAGE, FIGURE)
    assert taken.written[text].lines == tuple(lines)
    whole = shown.parts[0] if shown.operation == "multiply" else shown
    circle, group, tiled = whole.parts
    assert circle.center_mm == (45, 42)
    assert group.parts[0].place_mm == (17, 25)
    assert taken.written[group.parts[0]] is assets.written[name]
    assert taken.bitmaps[group.parts[1]].place_mm == (25, 32)
    assert taken.bitmaps[group.parts[1]].intensities is bitmap.intensities
    assert tiled.part == tile.part
    assert taken.written[tiled.part] is assets.written[tile.part]
    assert scene.canvas.height_mm == pytest.approx(12 * STYLE.geometry.line_pitch_mm)
    assert scene.canvas.width_mm == pytest.approx(STYLE.geometry.extent_mm(8))


def test_a_figure_within_its_canvas_is_not_cut_and_others_are():
    lines = [np.full(8, 63, np.uint8)]
    scene, _ = page_with_figure(lines, STYLE, figure(CIRCLE), (5.0, 0.0))
    assert len(scene.elements[1].parts) == 1
    beyond = Circle(center_mm=(5, 20), radius_mm=10, stroke=Stroke())
    for element in (beyond, LinearGrating(ridge_mm=3)):
        scene, _ = page_with_figure(lines, STYLE, figure(element), (5.0, 0.0))
        assert len(scene.elements[1].parts) == 2


def test_a_program_of_both_is_the_page_where_the_figure_is_not_and_the_figure_where_it_is(rng):
    display, geometry = STRESS2_8X8.display, STYLE.geometry
    lines = [rng.integers(1, 64, 16).astype(np.uint8) for _ in range(9)]
    left_mm, top_mm = 8 * geometry.cell_pitch_mm, 3 * geometry.line_pitch_mm
    for number in (3, 4, 5, 6):
        lines[number] = lines[number][:7]
    free = STYLE.replace(straying=Straying("free"))
    alone = free.render_page(lines, display)
    grating = LinearGrating(ridge_mm=3.0)  # which goes beyond the figure's rectangle
    own = figure(grating)
    scene, assets = page_with_figure(lines, STYLE, own, (left_mm, top_mm), Assets())
    both = compile_scene(scene, display, assets)
    frames = np.zeros((2, *display.shape))
    felt = set()
    for x_mm, y_mm, theta in rng.uniform((0, 0, -0.3), (170, 95, 0.3), (200, 3)):
        for frame, program in zip(frames, (both, alone), strict=True):
            program.frame(x_mm, frame, y_mm=y_mm, theta_rad=theta)
        x, y = (at.reshape(display.shape) for at in lane_places(display, x_mm, y_mm, theta))
        within = (x > left_mm) & (x < left_mm + 60) & (y > top_mm) & (y < top_mm + 40)
        np.testing.assert_allclose(frames[0][~within], frames[1][~within], rtol=0, atol=1e-9)
        inner = (x > left_mm + 1) & (x < left_mm + 59) & (y > top_mm + 1) & (y < top_mm + 39)
        ridges = 0.5 - 0.5 * np.cos(2 * np.pi * (x - left_mm) / 3.0)
        np.testing.assert_allclose(frames[0][inner], ridges[inner], rtol=0, atol=1e-6)
        felt |= {"page"} if (~within).all() and frames[0].any() else set()
        felt |= {"figure"} if inner.all() else set()
    assert felt == {"page", "figure"}


def test_no_page_and_no_place():
    with pytest.raises(InputError, match="a page without cells"):
        page_with_figure([np.zeros(0, np.uint8)], STYLE, figure(CIRCLE), (0.0, 0.0))
    with pytest.raises(InputError, match="the figure cannot stand there"):
        page_with_figure([np.ones(3, np.uint8)], STYLE, figure(CIRCLE), (9990.0, 0.0))
