"""What tiles are told of one large shape, and of what is hidden."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given

from tests.benchmarks.scenes import DISPLAY, toothed
from tests.render.scene.scenes import examples, scenes, seeds
from tests.render.scene.showing import assets_of
from tests.render.scenes import JIT
from vbraille.render import STRESS2_8X8
from vbraille.render.machine import words
from vbraille.render.scene.compiling import compile_scene
from vbraille.render.scene.labels import Assets, Written
from vbraille.scene.bitmap import Bitmap
from vbraille.scene.patterns import (
    Circle,
    Dots,
    Fill,
    Group,
    Image,
    Label,
    PathShape,
    Polygon,
    StraightLine,
)
from vbraille.scene.scene import Canvas, Scene
from vbraille.scene.strokes import Along, DotStyle, Dotting, Stroke, VertexMarkers
from vbraille.scene.textures import LinearGrating, Uniform

_GRATING = LinearGrating(ridge_mm=3.0)
_MANY = 10_000
_COMPILED = pytest.mark.skipif(not JIT, reason="many segments take minutes unless compiled")
_WIDE = Canvas(width_mm=1000.0, height_mm=1000.0)
_SMALL = Canvas(width_mm=120.0, height_mm=90.0)


def _around(count, radius_mm=450.0):
    """Places round the middle of the wide canvas, every other one farther out."""
    turns = np.arange(count) * math.tau / count
    far = radius_mm + 3.0 * (np.arange(count) % 2)
    places = 500 + far[:, None] * np.stack([np.cos(turns), np.sin(turns)], axis=1)
    return tuple(map(tuple, places.tolist()))


def _same_frames(scene, assets=None, seed=3, count=300 if JIT else 10, display=DISPLAY):
    """Frames of a scene, which are the same bit for bit without pruning."""
    ours, whole = (compile_scene(scene, display, assets, pruned=is_so) for is_so in (True, False))
    random = np.random.default_rng(seed)
    end = scene.canvas.width_mm + 8, scene.canvas.height_mm + 8
    x, y = random.uniform((-8, -8), end, (count, 2)).T
    theta, times = random.uniform(-4, 4, count), random.uniform(0, 1, count)
    frames, theirs = (program.poses(x, y, theta, times)[1] for program in (ours, whole))
    assert np.array_equal(frames, theirs)
    return frames


@examples(60)
@given(scenes(), seeds)
def test_pruning_changes_nothing_in_any_scene(scene, seed):
    _same_frames(scene, assets_of(*scene.elements), seed, 20)


# One shape of many segments


def _filled_path(**more):
    more = {"stroke": Stroke(width_mm=2.0), **more}
    fill = Fill(texture=_GRATING)
    return PathShape(contours_mm=(_around(_MANY),), closed=True, fill=fill, **more)


@_COMPILED
@pytest.mark.parametrize(
    ("shape", "most"),
    [
        (_filled_path(), 150),
        (_filled_path(stroke=Stroke(width_mm=2.0, along=Along())), 150),
        (_filled_path(inverted=True), 150),
        (_filled_path(stroke=None, dots=Dotting(dot=DotStyle(radius_mm=0.5))), 150),
        (Polygon(vertices_mm=_around(_MANY), stroke=Stroke(), markers=VertexMarkers()), 150),
        (
            Polygon(
                vertices_mm=_around(_MANY),
                stroke=Stroke(width_mm=2.0),
                markers=VertexMarkers(span="square"),
                fill=Fill(texture=_GRATING),
            ),
            150,
        ),
        (
            Circle(
                center_mm=(500.0, 500.0),
                radius_mm=480.0,
                fill=Fill(texture=Dots(centers_mm=_around(_MANY))),
            ),
            150,
        ),
    ],
    ids=[
        "filled",
        "textured",
        "inverted",
        "dotted",
        "marked",
        "marked and filled",
        "filled with dots",
    ],
)
def test_a_place_is_told_of_few_segments(shape, most):
    """All about the edge, where segments of 0.3 mm go up and down between 450 and 453 mm."""
    program = compile_scene(Scene(canvas=_WIDE, elements=(shape,)), DISPLAY)
    turns = np.arange(32) * math.tau / 32 + 0.01
    counts = [
        _parts(program, 500 + 450 * math.cos(turn), 500 + 450 * math.sin(turn)) for turn in turns
    ]
    assert 10 < min(counts) <= max(counts) <= most
    # Within it there is no segment, whatever lies to the right.
    assert _parts(program, 520.0, 300.0) <= 1


@pytest.mark.parametrize("fade_mm", [0.0, 2.5])
@pytest.mark.parametrize("blended", [False, True])
@pytest.mark.parametrize(
    "look",
    [
        {"stroke": Stroke(width_mm=3.0, along=Along())},
        {"dots": Dotting(dot=DotStyle(radius_mm=1.0))},
        {},
    ],
    ids=["stroke", "dots", "fill alone"],
)
def test_few_segments_are_as_good_as_all(look, blended, fade_mm):
    """Edges that cross, contours in contours, and a fill of shapes again."""
    random = np.random.default_rng(5)
    contours = tuple(
        tuple(map(tuple, random.uniform((5, 5), (115, 85), (count, 2)).tolist()))
        for count in (5, 12, 40)
    )
    textures = (
        _GRATING,
        Group(operation="maximum", parts=(Dots(centers_mm=contours[2]), Uniform(level=0.2))),
    )
    for texture in textures:
        fill = Fill(texture=texture, gap_mm=1.0, fade_mm=fade_mm, blended=blended)
        shape = PathShape(contours_mm=contours, closed=True, fill=fill, **look)
        frames = _same_frames(Scene(canvas=_SMALL, elements=(_GRATING, shape)))
        assert frames.std() > 0.1


@_COMPILED
@pytest.mark.parametrize("span", ["angle", "square", "edges", "arc"])
def test_markers_of_few_corners_are_as_good_as_those_of_all(span):
    turns = np.sort(np.random.default_rng(6).uniform(0, math.tau, 60))
    far = np.where(np.arange(60) % 3, 40.0, 12.0)
    places = np.stack([60 + far * np.cos(turns), 45 + far * np.sin(turns)], axis=1)
    for width_mm in (2.0, 9.0):
        polygon = Polygon(
            vertices_mm=tuple(map(tuple, places.tolist())),
            stroke=Stroke(width_mm=width_mm),
            markers=VertexMarkers(span=span, angle_deg=170.0),
        )
        assert _same_frames(Scene(canvas=_SMALL, elements=(polygon,)), count=600).any()


def test_what_a_place_is_told_does_not_grow_with_the_outline():
    few, many = (compile_scene(toothed(*size), DISPLAY) for size in ((1, 3), (20, 40)))
    assert _parts(few, 38.0, 20.0) == _parts(many, 38.0 + 24 * 5, 20.0 + 40 * 7) < 20


# What hides


_CORNERS = ((10.0, 5.0), (110.0, 15.0), (115.0, 85.0), (60.0, 75.0), (5.0, 88.0))


def _outline(kind):
    fill = Fill(texture=Uniform(level=0.3))
    if kind is Polygon:
        return Polygon(vertices_mm=_CORNERS, fill=fill, stroke=Stroke(width_mm=2.0))
    return PathShape(contours_mm=(_CORNERS,), closed=True, fill=fill, amplitude=0.5)


_IMAGE = Image(file="a.png", width_mm=110.0)
_HALF = Image(file="a.png", width_mm=110.0, texture=Uniform(level=0.5))
_ASIDE = Image(file="a.png", width_mm=110.0, texture=Dots(centers_mm=((100.0, 80.0),)))
_LABEL, _TURNED = Label(text="a", place_mm=(5.0, 5.0)), Label(
    text="a", place_mm=(15.0, 5.0), angle_deg=8.0
)  # fmt: skip
_RING = Circle(center_mm=(45.0, 35.0), radius_mm=3.0, stroke=Stroke())
_LINES = tuple(
    StraightLine(
        start_mm=(10.0, 10.0 + n), end_mm=(110.0, 50.0 - n), stroke=Stroke(), amplitude=n / 40
    )
    for n in range(1, 40)
)


def _assets():
    pixels = np.full((90, 110), 20_000, np.uint16)
    pixels[:, :4] = 0
    bitmap = Bitmap(pixels, (5.0, 0.0), 110.0, 90.0)
    cells = Written((np.full(14, 63, np.uint8),) * 8, STRESS2_8X8.style)
    return Assets(dict.fromkeys((_IMAGE, _HALF, _ASIDE), bitmap), {_LABEL: cells, _TURNED: cells})


def _group(operation, *parts, **more):
    return Group(operation=operation, parts=parts, **more)


@pytest.mark.parametrize(
    "top",
    [
        _outline(Polygon),
        _outline(PathShape),
        PathShape(
            contours_mm=(_CORNERS,),
            closed=True,
            dots=Dotting(),
            fill=Fill(texture=_GRATING),
        ),
        _IMAGE,
        _HALF,
        _ASIDE,
        _LABEL,
        _TURNED,
        _group("maximum", _LINES[0], _outline(Polygon)),
        _group("overwrite", _LINES[0], _outline(Polygon), amplitude=0.5),
        _group("add", _outline(Polygon), _LINES[0]),
        _group("multiply", _outline(Polygon), _IMAGE),
        _group("blend", _outline(Polygon), _IMAGE, by=_GRATING),
        _group("overwrite", _outline(Polygon), _RING),
        _group("multiply", _outline(Polygon), _LINES[19]),
        _group("blend", _outline(Polygon), _LINES[19], by=_GRATING),
        Polygon(vertices_mm=_CORNERS, stroke=Stroke(width_mm=2.0)),
    ],
    ids=["polygon", "path", "dotted", "image", "texture", "aside", "label", "turned",
         "maximum", "overwrite", "add", "multiply", "blend",
         "under another", "product", "blend of a line", "not filled"],
)  # fmt: skip
def test_what_hides_others_is_the_same_in_parts(top):
    """On it, at its edges and beside it."""
    assert _same_frames(Scene(canvas=_SMALL, elements=(*_LINES, top)), _assets()).any()


def test_a_picture_hides_where_its_texture_is_at_rest():
    program = compile_scene(Scene(canvas=_SMALL, elements=(Uniform(), _ASIDE)), DISPLAY, _assets())
    out = np.ones((8, 8))
    program.frame(45.0, out, y_mm=35.0)
    assert not out.any()


# Words of a tile


def _said(program, x_mm, y_mm):
    """Operations of the words of a tile, each with the parts that follow it."""
    numbers = program.numbers
    column = int((x_mm - numbers[words.GRID_LEFT_MM]) * numbers[words.TILES_PER_MM])
    row = int((y_mm - numbers[words.GRID_TOP_MM]) * numbers[words.TILES_PER_MM])
    at = int(numbers[words.GRID + row * int(numbers[words.GRID_COLUMNS]) + column])
    while (operation := int(numbers[at]) % words.OPERATIONS) != words.END:
        parts = int(numbers[at + 1]) if operation == words.CALL_PARTS else 0
        yield operation, parts
        at += 1 + (1 + parts if operation == words.CALL_PARTS else 0)


def _parts(program, x_mm, y_mm):
    return sum(parts for _, parts in _said(program, x_mm, y_mm))
