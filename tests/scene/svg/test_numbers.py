"""Numbers of SVG: what CSS and SVG 1.1 say they mean."""

import math
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.tiers import examples
from vbraille.scene.svg.numbers import AffineMap, fit, length_px, numbers_of, transform_of
from vbraille.scene.svg.outlines import FLATNESS_MM, contours_of_path


@pytest.mark.parametrize(
    ("text", "pixels"),
    [
        ("10", 10), ("10px", 10), ("1in", 96), ("25.4mm", 96), ("2.54cm", 96), ("72pt", 96),
        ("6pc", 96), ("50%", 100), ("2em", 20), ("1ex", 5), (" -1.5e1 px ", -15), (".5", 0.5),
        ("auto", None), ("", None), (None, None), ("1 2", None), ("nan", None), ("1e999", None),
        ("calc(1px)", None), ("١", None),
    ],
)  # fmt: skip
def test_lengths(text, pixels):
    found = length_px(text, 200, 10)
    assert found is None if pixels is None else found == pytest.approx(pixels)


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("", 1 + 2j),
        ("translate(10)", 11 + 2j),
        ("translate(10,20)", 11 + 22j),
        ("scale(2)", 2 + 4j),
        ("scale(2 3)", 2 + 6j),
        ("rotate(90)", -2 + 1j),
        ("rotate(90 1 2)", 1 + 2j),
        ("rotate(180, 10, 10)", 19 + 18j),
        ("skewX(45)", 3 + 2j),
        ("skewY(45)", 1 + 3j),
        ("matrix(1,2,3,4,5,6)", 12 + 16j),
        ("matrix(1 2 3 4 5 6)", 12 + 16j),
        ("translate(10 0) scale(2)", 12 + 4j),
        ("scale(2), translate(10,0)", 22 + 4j),
        ("translate(1-2)", 2 + 0j),
    ],
)
def test_transforms(text, place):
    assert transform_of(text).put(1 + 2j) == pytest.approx(place)


@pytest.mark.parametrize(
    "text", ["spin(3)", "rotate(1 2)", "matrix(1 2)", "scale()", "scale(1e999)", "translate(1", "2"]
)
def test_transforms_that_are_none(text):
    assert transform_of(text) is None


@pytest.mark.parametrize(
    ("how", "corner", "other"),
    [
        ("", 25 + 0j, 75 + 50j),
        ("xMinYMin", 0j, 50 + 50j),
        ("xMaxYMid meet", 50 + 0j, 100 + 50j),
        ("xMidYMid slice", 0 - 25j, 100 + 75j),
        ("none", 0j, 100 + 50j),
    ],
)
def test_a_viewbox_is_fitted(how, corner, other):
    matrix = fit((10, 20, 5, 5), (100, 50), how)
    assert matrix.put(10 + 20j) == pytest.approx(corner)
    assert matrix.put(15 + 25j) == pytest.approx(other)


def test_numbers_stand_without_spaces():
    assert numbers_of("1-2.5.5,3e1 4") == [1, -2.5, 0.5, 30, 4]


def test_factors_of_lengths():
    assert AffineMap(a=2, d=-2).keeps_circles
    assert transform_of("rotate(30) scale(3)").keeps_circles
    assert not AffineMap(a=2, d=2.1).keeps_circles
    assert not transform_of("skewX(10)").keeps_circles
    assert AffineMap(a=4, d=1).scale == 2
    assert transform_of("rotate(20) scale(4 1)").largest == pytest.approx(4)


CURVES = {
    "cubic": ("M0 0C{} {} {} {} 50 10", lambda t, p: sum(
        w * q for w, q in zip(((1 - t)**3, 3*t*(1-t)**2, 3*t*t*(1-t), t**3),
                              (0, complex(*p[:2]), complex(*p[2:]), 50 + 10j), strict=True))),
    "quadratic": ("M0 0Q{} {} 50 10", lambda t, p: 2*t*(1-t)*complex(*p[:2]) + t*t*(50 + 10j)),
}  # fmt: skip


@pytest.mark.parametrize("kind", CURVES)
@given(
    places=st.lists(st.floats(-100, 100), min_size=4, max_size=4), angle=st.floats(0, 7),
    scale=st.floats(0.1, 5),
)  # fmt: skip
@examples(20)
def test_chords_are_no_farther_from_their_curve_than_said(kind, places, angle, scale):
    text, at = CURVES[kind]
    cos, sin = scale * math.cos(angle), scale * math.sin(angle)
    matrix = AffineMap(cos, sin, -2 * sin, 2 * cos, 3, 4)
    (contour,) = contours_of_path(text.format(*map(repr, places)), matrix)
    ends = [complex(*point) for point in contour.points_mm]
    farthest = max(
        min(_distance(matrix.put(at(t / 50, places)), a, b) for a, b in pairwise(ends))
        for t in range(51)
    )
    assert farthest <= FLATNESS_MM + 2e-4


def _distance(place, a, b):
    along = (b - a).conjugate() * (place - a)
    share = min(max(along.real / abs(b - a) ** 2, 0), 1)
    return abs(place - a - share * (b - a))


@pytest.mark.parametrize("radius", [1, 10, 200])
def test_arcs_are_flattened_on_their_circle(radius):
    d = f"M{-radius} 0A{radius} {radius} 0 0 1 {radius} 0A{radius} {radius} 0 1 1 {-radius} 0z"
    (circle,) = contours_of_path(d, AffineMap())
    assert circle.closed
    points = [complex(*point) for point in circle.points_mm]
    assert all(abs(abs(point) - radius) < 1e-3 for point in points)
    middles = [abs(a + b) / 2 for a, b in zip(points, points[1:] + points[:1], strict=True)]
    assert radius - FLATNESS_MM - 1e-3 <= min(middles)
    assert len(points) < 12 * math.sqrt(radius) + 8


def test_contours_end_where_they_are_closed_and_begin_anew():
    d = "m 10,10 5,0 0,5 z l 0,-5 M 50 50 h 5 m 1 1 v 0 z M 0 0 L 1 1 2 0 0 0"
    found = [(one.closed, len(one.points_mm)) for one in contours_of_path(d, AffineMap())]
    assert found == [(True, 3), (False, 2), (False, 2), (True, 3)]


@pytest.mark.parametrize(
    "d",
    ["L 1 1", "M 0 0 L 1", "M 0 0 A 1 1 0 2 3 4 5", "M 0 0 L 1e9 0", "M 0 0 L 1e999 0", "hello",
     "M 0 0 C 1 1 2 2 3", "M é", "M 0 0 Q 1e300 1e300 1 1", "z"],
)  # fmt: skip
def test_paths_that_cannot_be_drawn_are_refused(d):
    with pytest.raises(ValueError, match=r"not understood|10 m|begin"):
        contours_of_path(d, AffineMap())
