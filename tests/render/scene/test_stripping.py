"""Programs without some of their words."""

import numpy as np
import pytest

from vbraille.render import LATERO
from vbraille.render.machine.words import DEPTH, STACK
from vbraille.render.scene.assets import Assets, Written
from vbraille.render.scene.compiling import compile_scene
from vbraille.render.scene.stripping import WordKind, emptied, kinds_in, stripped
from vbraille.scene.bitmap import Bitmap
from vbraille.scene.dots import Dots
from vbraille.scene.labels import Label
from vbraille.scene.patterns import Circle, Fill, Group, Image, Polygon
from vbraille.scene.scene import Canvas, Scene
from vbraille.scene.strokes import Along, DotStyle, Dotting, Stroke, VertexMarkers, Vibration
from vbraille.scene.textures import LinearGrating, Uniform

CANVAS = Canvas(width_mm=60, height_mm=40)
AT = (30.0, 20.0)
RING = Circle(center_mm=AT, radius_mm=3, stroke=Stroke(width_mm=4))
FULL = Uniform(level=1)
IMAGE = Image(file="a.png", place_mm=(25, 15), width_mm=10)
LABEL = Label(text="l", place_mm=(29, 18))
ASSETS = Assets(
    bitmaps={IMAGE: Bitmap(np.full((4, 4), 65535, np.uint16), (25, 15), 10, 10)},
    written={LABEL: Written((np.array([0b111111] * 4, np.uint8),), LATERO.style)},
)
EACH = {
    WordKind.STROKES: RING,
    WordKind.GRATINGS: LinearGrating(ridge_mm=4),
    WordKind.DOTS: Dots(centers_mm=(AT,), dot=DotStyle(radius_mm=3)),
    WordKind.IMAGES: IMAGE,
    WordKind.LABELS: LABEL,
}


def program_of(*elements, operation="overwrite"):
    scene = Scene(canvas=CANVAS, elements=elements, operation=operation)
    return compile_scene(scene, LATERO.display, ASSETS)


def frame_of(program):
    out = np.empty(program.shape, np.float32)
    program.frame(AT[0], out, y_mm=AT[1], time_s=0.003)
    return out


@pytest.mark.parametrize("kind", EACH)
def test_a_pattern_is_gone_without_the_words_of_its_kind_and_only_then(kind):
    program = program_of(EACH[kind])
    assert kinds_in(program) == [kind]
    whole = frame_of(program)
    assert whole.max() > 0.4
    assert not frame_of(stripped(program, {kind})).any()
    np.testing.assert_array_equal(frame_of(stripped(program, set(WordKind) - {kind})), whole)
    np.testing.assert_array_equal(frame_of(program), whole)  # it is as it was
    assert not frame_of(emptied(program)).any()


@pytest.mark.parametrize("blended", [False, True])
@pytest.mark.parametrize("dotted", [False, True])
def test_without_the_words_of_its_fill_nothing_but_the_texture_is_left(blended, dotted):
    shape = {"stroke": Stroke(width_mm=3)} if not dotted else {"dots": Dotting()}
    fill = Fill(texture=Uniform(level=0.3), blended=blended)
    program = program_of(Circle(center_mm=AT, radius_mm=4, fill=fill, **shape))
    own = WordKind.DOTS if dotted else WordKind.STROKES
    assert WordKind.FILLS in kinds_in(program)
    assert frame_of(program).max() > 0.5
    fills = {WordKind.FILLS, WordKind.DOTS} if dotted else {WordKind.FILLS}
    np.testing.assert_allclose(frame_of(stripped(program, fills)), 0.3)
    without = frame_of(stripped(program, {own}))
    assert 0 <= without.min() <= without.max() <= 0.31  # of the fill alone


def test_vibration_of_patterns_and_of_groups_is_left_out():
    shaking = LinearGrating(ridge_mm=4, vibration=Vibration())
    plain = LinearGrating(ridge_mm=4)
    for one, other in (
        (shaking, plain),
        (
            Group(parts=(plain, RING), operation="add", vibration=Vibration()),
            Group(parts=(plain, RING), operation="add"),
        ),
    ):
        program = program_of(one, RING)
        assert WordKind.VIBRATION in kinds_in(program)
        np.testing.assert_allclose(
            frame_of(stripped(program, {WordKind.VIBRATION})), frame_of(program_of(other, RING))
        )


def test_no_row_beyond_the_stack_is_touched():
    stroke = Stroke(width_mm=3, along=Along())
    corners = ((25.0, 15.0), (35.0, 15.0), (30.0, 25.0))
    triangle = Polygon(
        vertices_mm=corners,
        stroke=stroke,
        fill=Fill(texture=Group(parts=(RING, FULL)), blended=True),
        markers=VertexMarkers(),
    )
    shaken = Group(parts=(triangle, IMAGE), operation="add", vibration=Vibration())
    program = program_of(triangle, shaken, LABEL, *EACH.values())
    for kinds in (*({kind} for kind in WordKind), set(WordKind)):
        left = stripped(program, kinds)
        left._scratch[STACK + DEPTH // 2 :] = 7.0
        assert np.isfinite(frame_of(left)).all()
        assert (left._scratch[STACK + DEPTH // 2 :] == 7.0).all()


def test_a_scene_of_nothing_has_no_kinds():
    program = program_of()
    assert kinds_in(program) == []
    assert not frame_of(stripped(program, set(WordKind))).any()
