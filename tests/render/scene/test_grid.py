"""Pruning changes nothing, and leaves little."""

from __future__ import annotations

import numpy as np
import pytest

from tests.benchmarks.scenes import DISPLAY, nested, shapes, short_lines
from vbraille.render.scene.compiling import compile_scene
from vbraille.render.scene.labels import Assets
from vbraille.scene.patterns import Circle, Fill, Group, Polygon, StraightLine
from vbraille.scene.scene import Canvas, Scene
from vbraille.scene.strokes import Stroke
from vbraille.scene.textures import LinearGrating, Uniform

_CIRCLE = Circle(center_mm=(40.0, 30.0), radius_mm=12.0, stroke=Stroke(width_mm=3.0))
_LINE = StraightLine(start_mm=(10.0, 10.0), end_mm=(60.0, 45.0), stroke=Stroke(width_mm=4.0))
_GRATING = LinearGrating(ridge_mm=3.0)
_DISC = Circle(center_mm=(40.0, 30.0), radius_mm=24.0, fill=Fill(texture=_GRATING, gap_mm=2.0))
_RECTANGLE = Polygon(
    vertices_mm=((10.0, 5.0), (70.0, 5.0), (70.0, 55.0), (10.0, 55.0)),
    fill=Fill(texture=Uniform(level=0.3)),
    stroke=Stroke(width_mm=2.0),
)


def _scene(*elements, operation="overwrite"):
    return Scene(
        canvas=Canvas(width_mm=80.0, height_mm=60.0), elements=elements, operation=operation
    )


def _group(operation, *parts, **more):
    return Group(operation=operation, parts=parts, **more)


@pytest.mark.parametrize(
    "scene",
    [
        short_lines(),
        nested()[0],
        shapes(50),
        _scene(_group("multiply", _CIRCLE, _GRATING), _LINE),
        _scene(_group("multiply", _CIRCLE, _LINE), _group("add", _LINE, _CIRCLE, inverted=True)),
        _scene(_group("blend", _GRATING, _CIRCLE, by=_LINE)),
        _scene(_group("blend", _LINE, _GRATING, by=_CIRCLE)),
        _scene(_LINE, _group("blend", _LINE, _CIRCLE, by=Uniform())),
        _scene(_group("blend", _LINE, _CIRCLE, by=_GRATING, amplitude=0.5), operation="maximum"),
        _scene(_GRATING, _group("overwrite", _LINE, _group("maximum", _CIRCLE, _LINE))),
        _scene(_LINE, _group("weighted", _CIRCLE, _LINE, weights=(0.3, 0.7)), operation="add"),
        _scene(_LINE, Circle(center_mm=(40.0, 30.0), radius_mm=9.0, fill=Fill(texture=_GRATING))),
        _scene(_LINE, _GRATING, _DISC, _LINE),
        _scene(_GRATING, _group("overwrite", _LINE, _RECTANGLE, _CIRCLE)),
        _scene(_LINE, _DISC, _RECTANGLE, operation="add"),
    ],
)  # fmt: skip
def test_pruning_changes_nothing(scene):
    pruned, whole = (compile_scene(scene, DISPLAY, pruned=pruned) for pruned in (True, False))
    random = np.random.default_rng(3)
    end = scene.canvas.width_mm + 8, scene.canvas.height_mm + 8
    x, y = random.uniform((-8, -8), end, (300, 2)).T
    theta, times = random.uniform(-4, 4, 300), random.uniform(0, 1, 300)
    ours, theirs = (program.poses(x, y, theta, times)[1] for program in (pruned, whole))
    assert np.array_equal(ours, theirs)
    assert ours.any()


def test_words_of_a_tile_do_not_grow_with_the_scene():
    few, many = (compile_scene(shapes(count), DISPLAY) for count in (100, 2000))
    assert many.nbytes < 25 * few.nbytes


def test_where_nothing_can_be_touched_nothing_is_said():
    program = compile_scene(short_lines(), DISPLAY, Assets())
    out = np.ones((8, 8))
    program.frame(48.0, out, y_mm=50.0)
    assert not out.any()
