"""The equations of strokes and dots: their values, coordinates, markers, and that nothing jumps."""

import math

import numpy as np

from tests.render.scene.showing import felt
from vbraille.scene.patterns import (
    Along,
    Circle,
    Dots,
    DotStyle,
    Dotting,
    Fill,
    Polygon,
    StraightLine,
    Stroke,
    Uniform,
    VertexMarkers,
    Vibration,
)

SQUARE = ((0, 0), (30, 0), (30, 30), (0, 30))


# Profiles: 8.7-8.10, 6.1


# Coordinates: 8.15-8.19


# Strokes: 8.11-8.14


def test_a_texture_along_cuts_into_the_stroke():
    def stroke(**more):
        return Stroke(
            width_mm=8, edge_mm=1, amplitude=0.8, along=Along(ridge_mm=2, gap_mm=1, **more)
        )

    x = np.array([1, 2.5, 0.5])  # in the middle of a cut, between, and halfway in
    line = StraightLine(start_mm=(0, 0), end_mm=(30, 0), stroke=stroke())
    np.testing.assert_allclose(felt(line, x), [0, 0.8, 0.4], atol=1e-12)
    shallow = StraightLine(start_mm=(0, 0), end_mm=(30, 0), stroke=stroke(amplitude=0.5))
    np.testing.assert_allclose(felt(shallow, x), [0.4, 0.8, 0.6], atol=1e-12)
    whole = StraightLine(start_mm=(0, 0), end_mm=(30, 0), stroke=stroke(whole_edges=True))
    np.testing.assert_allclose(felt(whole, x), [0, 0.8, 0.4], atol=1e-12)
    np.testing.assert_allclose(felt(whole, x, 3), [0.8, 0.8, 0.8], atol=1e-12)
    np.testing.assert_allclose(felt(line, x, 3), [0, 0.8, 0.4], atol=1e-12)


def test_what_is_up_vibrates_or_what_is_down():
    along = Along(ridge_mm=2, gap_mm=1)
    x = np.array([1, 2.5])  # in a cut, and between
    for of, low, high in (("high", [0, 0], [0, 1]), ("low", [1, 1], [0, 1])):
        stroke = Stroke(width_mm=8, along=along, vibration=Vibration(of=of))
        line = StraightLine(start_mm=(0, 0), end_mm=(30, 0), stroke=stroke)
        np.testing.assert_allclose(felt(line, x, time_s=0.015), low, atol=1e-9)
        np.testing.assert_allclose(felt(line, x, time_s=0.005), high, atol=1e-9)


def test_an_outlined_stroke_is_two_lines():
    line = StraightLine(
        start_mm=(0, 0), end_mm=(30, 0), stroke=Stroke(width_mm=8, edge_mm=1, outlined=True)
    )
    np.testing.assert_allclose(felt(line, 15, [0, 2, 3, 3.5, 4]), [0, 0, 1, 0.5, 0], atol=1e-12)


# Markers: figs. 8.19, 8.20


def test_a_marker_takes_the_place_of_the_texture_within_the_profile():
    swing = Vibration(frequency_hz=10)
    polygon = Polygon(
        vertices_mm=SQUARE,
        markers=VertexMarkers(span="square", vibration=swing),
        stroke=Stroke(width_mm=4, edge_mm=1, amplitude=0.5, along=Along(ridge_mm=2)),
    )
    for time_s, want in ((0.025, 1), (0.075, 0)):
        np.testing.assert_allclose(
            felt(polygon, [0, -1.5], [0, 0], time_s=time_s), [0.5 * want, 0.25 * want], atol=1e-9
        )
    plain = Polygon(
        vertices_mm=SQUARE,
        markers=VertexMarkers(plain=True),
        stroke=Stroke(width_mm=4, along=Along(ridge_mm=2)),
    )
    np.testing.assert_allclose(felt(plain, [0, 30, 30], [0, 0, 30]), 1)


# Fills: fig. 8.21


def test_a_fill_begins_at_the_strokes_inner_edge_after_its_gap():
    fill = Fill(texture=Uniform(level=0.8), gap_mm=2, fade_mm=1)
    disc = Circle(center_mm=(0, 0), radius_mm=20, stroke=Stroke(width_mm=4), fill=fill)
    np.testing.assert_allclose(
        felt(disc, [20, 17, 16, 15.5, 15, 0, 23]), [1, 0, 0, 0.4, 0.8, 0.8, 0], atol=1e-12
    )
    bare = Circle(center_mm=(0, 0), radius_mm=20, fill=Fill(texture=Uniform(), fade_mm=0))
    np.testing.assert_allclose(felt(bare, [0, 19.99, 20.01]), [1, 1, 0])
    dotted = Circle(
        center_mm=(0, 0),
        radius_mm=20,
        dots=Dotting(dot=DotStyle(radius_mm=1.5)),
        fill=Fill(texture=Uniform(), gap_mm=0, fade_mm=1),
    )
    np.testing.assert_allclose(felt(dotted, [18.5, 18, 17.5]), [0, 0.5, 1], atol=1e-12)


def test_a_blended_fill_goes_on_under_the_stroke_and_does_not_shine_through():
    weak = Stroke(width_mm=4, edge_mm=1, amplitude=0.3)
    fill = Fill(texture=Uniform(level=0.8), blended=True)
    disc = Circle(center_mm=(0, 0), radius_mm=20, stroke=weak, fill=fill)
    np.testing.assert_allclose(
        felt(disc, [20, 18.5, 18, 10, 21.5]), [0.3, 0.15 + 0.4, 0.8, 0.8, 0.15], atol=1e-12
    )


# Dots: 8.4.4


def test_the_largest_of_dots_counts():
    dots = Dots(centers_mm=((0, 0), (1, 0)), dot=DotStyle(radius_mm=1, amplitude=0.6))
    np.testing.assert_allclose(
        felt(dots, [0, 0.25, 0.5, 1, 3]),
        [0.6, *[0.6 * (0.5 + 0.5 * math.cos(math.pi * r)) for r in (0.25, 0.5)], 0.6, 0],
    )


def test_dots_on_vertices_may_vibrate_alone():
    square = Polygon(vertices_mm=SQUARE, dots=Dotting(vertex_vibration=Vibration()))
    third = 30 / 10
    np.testing.assert_allclose(felt(square, [0, third], time_s=0.015), [0, 1], atol=1e-9)
    np.testing.assert_allclose(felt(square, [0, third], time_s=0.005), [1, 1], atol=1e-9)


# Opacity: fig. 8.25
