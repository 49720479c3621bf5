"""Strokes of drawings against the twin of the kernels: ink is where they are felt."""

import io
from functools import cache

import numpy as np
import pytest
from PIL import Image

from tests.render.scene.twin import deflections
from tests.tiers import by_tier, heavy
from vbraille.pictures.abstract import abstract_drawing
from vbraille.pictures.drawink import ink_png
from vbraille.pictures.ink import InkDiscs
from vbraille.pictures.inkfelt import felt_contours
from vbraille.pictures.looks import ABSTRACT, RAISED
from vbraille.render.scene.assets import Assets
from vbraille.scene.patterns import Circle, PathShape, Polygon
from vbraille.scene.scene import Canvas, Scene
from vbraille.scene.shapes import StraightLine
from vbraille.scene.strokes import (
    Across,
    Along,
    DotStyle,
    Dotting,
    Stroke,
    VertexMarkers,
)

CANVAS = Canvas(width_mm=70, height_mm=56)
PER_MM = 5
X_MM, Y_MM = ((np.arange(round(mm * PER_MM)) + 0.5) / PER_MM for mm in (70, 56))
CORNERS = ((12.0, 44.0), (34.0, 9.0), (58.0, 44.0))
# Cuts are long enough for fingers, so that a raised drawing changes nothing.
ALONG = Along(ridge_mm=5, gap_mm=3)
CLOSE = Dotting(dot=DotStyle(radius_mm=0.5), separation_mm=0.2)
STROKE = Stroke(width_mm=9, edge_mm=1, along=ALONG)
UP_S, DOWN_S = 0.005, 0.015
JOINS = {
    "straight": {"join": "straight"},
    "rounded": {"join": "rounded"},
    "offset": {"join": "rounded", "rounding_offset_mm": 4.0},
}
SPANS = ("angle", "square", "edges", "arc")
# The twin is slow; in the everyday tier one of each will do.
LOOKS = pytest.mark.parametrize(
    "look",
    by_tier([RAISED], *([ABSTRACT, RAISED],) * 2),
    ids=lambda look: "raised" if look.raised else "abstract",
)
FEW_SPANS = by_tier(SPANS[1:2], SPANS, SPANS)


def triangle(stroke=STROKE, **own):
    return Polygon(vertices_mm=CORNERS, stroke=stroke, **own)


def scene_of(*elements):
    return Scene(canvas=CANVAS, elements=elements)


@cache
def felt(element, time_s=UP_S):
    """Deflections of an element all over the canvas, by the twin."""
    x, y = (each.ravel() for each in np.meshgrid(X_MM, Y_MM))
    parity = np.zeros(x.size, int)
    return deflections(scene_of(element), Assets(), x, y, parity, time_s).reshape(
        Y_MM.size, X_MM.size
    )


def inked(element, look):
    drawing = abstract_drawing(scene_of(element), Assets(), look)
    with Image.open(io.BytesIO(ink_png(drawing, PER_MM))) as image:
        return drawing, 1 - np.array(image, float) / 255


def discs_of(drawing):
    marks = (mark for clip in drawing.marks for mark in clip.marks)
    return [mark for mark in marks if isinstance(mark, InkDiscs)]


def differing(ink, up):
    """Share of the places that are ink and not felt, or the other way, of those that are felt."""
    return (ink != up).sum() / up.sum()


def near(element, look):
    _, ink = inked(element, look)
    return differing(ink > half_of(look), felt(element) > 0.5)


def half_of(look):
    """Half of the darkest ink, which is what an edge that halves a pixel has."""
    return 0.5 if look.raised else 0.375


@LOOKS
@pytest.mark.parametrize("join", JOINS)
def test_cuts_go_round_corners_as_they_are_felt(look, join):
    """Within 3 % of the stroke; drawn with another way of going round it would be 7 % at least."""
    _, ink = inked(triangle(**JOINS[join]), look)
    ups = {name: felt(triangle(**own)) > 0.5 for name, own in JOINS.items()}
    apart = {name: differing(ink > half_of(look), up) for name, up in ups.items()}
    assert apart.pop(join) < 0.03
    assert min(apart.values()) > 0.07


@pytest.mark.parametrize("span", FEW_SPANS)
def test_plain_markers_have_their_spans(span):
    """Within 2.5 % of the stroke; drawn with another span it would be 3.5 % at least."""
    markers = {
        name: VertexMarkers(span=name, angle_deg=20, plain=True, blend_mm=0.5) for name in SPANS
    }
    _, ink = inked(triangle(markers=markers[span], join="rounded"), RAISED)
    ups = {name: felt(triangle(markers=own, join="rounded")) > 0.5 for name, own in markers.items()}
    apart = {name: differing(ink > 0.5, up) for name, up in ups.items()}
    assert apart.pop(span) < 0.025
    assert min(apart.values()) > 0.035


SHAPES = {
    "line": StraightLine(start_mm=(10, 10), end_mm=(60, 40), stroke=STROKE),
    "circle": Circle(center_mm=(35, 28), radius_mm=18, stroke=STROKE),
    "path": PathShape(contours_mm=(((10, 10), (50, 12), (50, 45), (20, 40)),), stroke=STROKE),
    "whole edges": triangle(
        Stroke(width_mm=9, edge_mm=1.5, along=Along(ridge_mm=6, whole_edges=True))
    ),
    "weaker": triangle(Stroke(width_mm=9, edge_mm=1, along=ALONG, amplitude=0.999), join="rounded"),
    "beyond the canvas": StraightLine(start_mm=(-5, -5), end_mm=(75, 50), stroke=STROKE),
}


@pytest.mark.parametrize("name", by_tier(["path", "whole edges"], SHAPES, SHAPES))
@LOOKS
def test_each_shape_is_ink_where_it_is_felt(name, look):
    assert near(SHAPES[name], look) < 0.03


def test_stripes_along_a_stroke_are_ink_where_they_are_felt():
    stroke = Stroke(width_mm=9, edge_mm=1, across=Across(amplitude=1.0, cycles=5))
    assert near(triangle(stroke), ABSTRACT) < 0.03


def test_shallow_cuts_are_gray():
    cut = Along(ridge_mm=6, gap_mm=0, amplitude=0.4)
    line = StraightLine(
        start_mm=(10, 20), end_mm=(58, 20), stroke=Stroke(width_mm=8, edge_mm=1, along=cut)
    )
    _, ink = inked(line, ABSTRACT)
    row = ink[20 * PER_MM, 10 * PER_MM : 58 * PER_MM].reshape(8, -1)
    assert row[:, 3 * PER_MM] == pytest.approx(0.75 * 0.6, abs=0.01)  # in the middle of a cut
    assert row[:, 0] == pytest.approx(0.75, abs=0.01)


@pytest.mark.parametrize("span", FEW_SPANS)
def test_vibrating_markers_are_dots_within_their_spans_and_away_from_ink(span):
    swinging = triangle(markers=VertexMarkers(span=span))
    drawing, ink = inked(swinging, RAISED)
    (discs,) = discs_of(drawing)
    assert 2 * discs.radius_mm == pytest.approx(1.5)
    for corner in CORNERS:
        assert np.hypot(*(discs.centers_mm - corner).T).min() < 1e-9
    # What swings there is the marker: its middle is up at one time and down at another.
    columns, rows = np.floor(discs.centers_mm * PER_MM).astype(int).T
    assert (felt(swinging, UP_S)[rows, columns] > 0.5).all()
    assert (felt(swinging, DOWN_S)[rows, columns] < 0.5).all()
    x, y = np.meshgrid(X_MM, Y_MM)
    away = np.min([np.hypot(x - a, y - b) for a, b in discs.centers_mm], axis=0)
    black = ink > 0.5
    assert black[away < 0.6].all()
    assert not black[(away > 0.9) & (away < 2.6)].any()
    far = away > 4.0  # what is left beside them is the stroke without its markers
    assert differing(black & far, (felt(swinging, DOWN_S) > 0.5) & far) < 0.06


def test_vibrating_markers_have_white_dots_on_abstract_drawings():
    swinging = triangle(markers=VertexMarkers())
    _, ink = inked(swinging, ABSTRACT)
    for x, y in CORNERS:
        assert ink[int(y * PER_MM), int(x * PER_MM)] < 0.2
        assert ink[int(y * PER_MM), int((x + 0.9) * PER_MM)] > 0.7


@LOOKS
@pytest.mark.parametrize("make", by_tier(["triangle"], *(["line", "circle", "triangle"],) * 2))
def test_dotted_shapes_are_ink_where_they_are_felt(make, look):
    dots = Dotting(dot=DotStyle(radius_mm=2, edge_mm=0.5), separation_mm=3)
    shape = {
        "line": StraightLine(start_mm=(8, 8), end_mm=(60, 44), dots=dots),
        "circle": Circle(center_mm=(35, 28), radius_mm=18, dots=dots),
        "triangle": Polygon(vertices_mm=CORNERS, dots=dots),
    }[make]
    assert near(shape, look) < 0.05  # many small edges, of which pixels see less


@pytest.mark.parametrize(
    "shape",
    [
        Polygon(vertices_mm=CORNERS, dots=CLOSE),
        Circle(center_mm=(35, 28), radius_mm=9, dots=CLOSE),
    ],
    ids=["triangle", "circle"],
)
def test_dots_of_a_raised_shape_have_blanks_between_them(shape):
    drawing = abstract_drawing(scene_of(shape), Assets(), RAISED)
    centers = np.vstack([mark.centers_mm for mark in discs_of(drawing)])
    apart = np.hypot(*(centers[:, None] - centers).transpose(2, 0, 1))
    assert len(centers) > 9
    assert np.min(apart + 9 * np.eye(len(centers))) >= 1.5 + 2 - 1e-6
    if isinstance(shape, Polygon):
        assert set(CORNERS) <= set(map(tuple, centers.tolist()))


def test_a_shape_beyond_the_canvas_has_no_ink():
    line = StraightLine(start_mm=(-50, -50), end_mm=(-40, -20), stroke=STROKE)
    assert felt_contours(line, CANVAS, RAISED, np.zeros((0, 2))) == ()


@heavy
@pytest.mark.parametrize("angle", [8, 25, 60, 90, 140, 172])
@pytest.mark.parametrize("join", JOINS)
def test_corners_of_any_angle_are_ink_where_they_are_felt(angle, join):
    half = np.radians(angle / 2)
    arm = 28 * np.array([np.cos(half), np.sin(half)])
    corners = ((20.0, 28.0), (20 + arm[0], 28 + arm[1]), (20 + arm[0], 28 - arm[1]))
    stroke = Stroke(width_mm=6, edge_mm=1, along=Along(ridge_mm=4, gap_mm=2))
    assert near(Polygon(vertices_mm=corners, stroke=stroke, **JOINS[join]), ABSTRACT) < 0.05
