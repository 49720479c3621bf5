"""The equations of strokes and dots: their values, coordinates, markers, and that nothing jumps."""

import math

import numpy as np

from tests.render.scene.showing import felt
from vbraille.scene.patterns import (
    Along,
    Circle,
    Dots,
    DotStyle,
    Fill,
    Polygon,
    StraightLine,
    Stroke,
    Uniform,
    VertexMarkers,
    Vibration,
)

SQUARE = ((0, 0), (30, 0), (30, 30), (0, 30))


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
