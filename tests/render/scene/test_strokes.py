"""The equations of strokes and dots: their values, coordinates, markers, and that nothing jumps."""

import math

import numpy as np
import pytest

from tests.render.scene.twin import deflection, mask, places
from tests.render.scene.twinstrokes import (
    coordinates,
    dot_profile,
    groove,
    is_inside,
    marked,
    profile,
    textured,
)
from vbraille.scene.patterns import Circle, Dots, Fill, PathShape, Polygon, StraightLine
from vbraille.scene.strokes import (
    Across,
    Along,
    DotStyle,
    Dotting,
    Stroke,
    VertexMarkers,
    Vibration,
)
from vbraille.scene.textures import Uniform

R = np.linspace(-6, 6, 12_001)
SQUARE = ((0, 0), (30, 0), (30, 30), (0, 30))


def at(x_mm, y_mm=0.0, parity=0, time_s=0.0):
    return places(x_mm, y_mm, parity, time_s)


def felt(pattern, x_mm, y_mm=0.0, parity=0, time_s=0.0):
    return deflection(pattern, None, at(x_mm, y_mm, parity, time_s))


# Profiles: 8.7-8.10, 6.1


@pytest.mark.parametrize("edge", [0.5, 1.0, 2.0])
def test_a_stroke_is_up_within_its_edges(edge):
    got = profile(R, 4, edge)
    assert (got[np.abs(R) >= 2] == 0).all()
    assert (got[np.abs(R) < 2 - edge] == 1).all()
    np.testing.assert_allclose(profile(np.array([2 - edge / 2]), 4, edge), 0.5)
    assert np.abs(np.diff(got)).max() / 0.001 <= math.pi / (2 * edge) + 1e-6


@pytest.mark.parametrize("edge", [0.5, 1.0])
def test_an_outline_is_up_at_its_edges_and_at_rest_in_the_middle(edge):
    cut = groove(R, 4, edge)
    outline = profile(R, 4, edge) * (1 - cut)
    assert outline[np.abs(R) < 2 - 2 * edge].max(initial=0) == 0
    np.testing.assert_allclose(outline[np.isclose(np.abs(R), 2 - edge)], 1, atol=1e-5)
    # With sin for cos, as printed, it would jump from 1 to ½ and end at ½.
    assert np.abs(np.diff(cut)).max() / 0.001 <= math.pi / (2 * edge) + 1e-6
    assert np.abs(np.diff(outline)).max() / 0.001 <= math.pi / edge


@pytest.mark.parametrize("cycles", [1, 3, 7])
def test_a_texture_across_has_its_cycles_and_ends_at_rest(cycles):
    plain = profile(R, 4, 0.5)
    got = textured(plain, R, 4, Across(amplitude=1, cycles=cycles))
    assert (got[np.abs(R) >= 2] == 0).all()
    inner = got[np.abs(R) < 2]
    turns = np.count_nonzero(np.diff(np.sign(np.diff(inner))))
    assert turns == 2 * cycles - 1
    assert np.abs(np.diff(got)).max() / 0.001 <= math.pi * cycles / 4 + 1e-6
    half = textured(plain, R, 4, Across(amplitude=0.5, cycles=cycles))
    np.testing.assert_allclose(half, 0.5 * plain + 0.5 * got)


def test_a_dot_with_a_plateau_is_eq_6_1():
    dot = DotStyle(radius_mm=2, plateau=0.25)
    r = np.abs(R) / 2
    want = np.select([r <= 0.25, r <= 1], [1, 0.5 + 0.5 * np.cos(np.pi * (r - 0.25) / 0.75)], 0)
    np.testing.assert_allclose(dot_profile(dot, R), want, atol=1e-12)


# Coordinates: 8.15-8.19


def test_a_texture_runs_on_through_the_round_ends_of_a_line():
    seen = coordinates(
        StraightLine(start_mm=(1, 1), end_mm=(4, 5), stroke=Stroke()), at([1, 4, 7], [1, 5, 9])
    )
    np.testing.assert_allclose(seen.along_mm, [0, 5, 10], atol=1e-12)
    np.testing.assert_allclose(seen.across_mm, [0, 0, 5], atol=1e-12)
    beside = coordinates(
        StraightLine(start_mm=(0, 0), end_mm=(9, 0), stroke=Stroke()), at([-3, 4], [4, -2])
    )
    np.testing.assert_allclose(beside.across_mm, [5, 2])
    np.testing.assert_allclose(beside.along_mm, [-3, 4])


def test_a_circle_begins_to_the_right_and_goes_down():
    circle = Circle(center_mm=(10, 10), radius_mm=4, stroke=Stroke())
    seen = coordinates(circle, at([16, 10, 6, 10], [10, 12, 10, 6]))
    np.testing.assert_allclose(seen.across_mm, [2, 2, 0, 0])
    np.testing.assert_allclose(seen.along_mm, np.array([0, 1, 2, 3]) * math.pi / 2 * 4)


def test_straight_joins_jump_at_the_bisector():
    square = Polygon(vertices_mm=SQUARE, join="straight", stroke=Stroke())
    # Beside the corner (30, 0), within and without, on both sides of its bisector.
    seen = coordinates(square, at([27, 29, 31, 32], [2, 3, -2, -1]))
    np.testing.assert_allclose(seen.along_mm, [27, 33, 31, 29])
    np.testing.assert_array_equal(seen.edge, [0, 1, 0, 1])
    first = coordinates(square, at([-1, -2], [-2, -1]))
    np.testing.assert_allclose(first.along_mm, [-1, 121])


def test_rounded_joins_go_round_the_place_where_the_inner_edges_meet():
    square = Polygon(vertices_mm=SQUARE, stroke=Stroke(width_mm=4))
    edge = 26 + math.pi
    middle = coordinates(square, at([15, 30, 15], [0, 15, 30]))
    np.testing.assert_allclose(middle.along_mm, np.array([0.5, 1.5, 2.5]) * edge)
    # About (28, 2): at right angles to both edges, and out through the corner.
    arc = coordinates(square, at([28, 31, 33], [-1, -1, 2]))
    np.testing.assert_allclose(arc.along_mm, edge + np.array([-0.5, 0, 0.5]) * math.pi, atol=1e-9)
    np.testing.assert_allclose(arc.across_mm, [1, math.sqrt(2), 3])


@pytest.mark.parametrize("offset", [0.0, 3.0])
@pytest.mark.parametrize("turn", [0.3, 1.0, 2.0, 3.0])
def test_rounded_joins_have_no_jump_within_a_stroke(offset, turn):
    end = (20 * math.cos(turn), 20 * math.sin(turn))
    far_away = (60 * math.cos(turn / 2), 60 * math.sin(turn / 2))
    corner = Polygon(
        vertices_mm=((20, 0), (0, 0), end, far_away),
        rounding_offset_mm=offset,
        stroke=Stroke(width_mm=2, along=Along(ridge_mm=1, whole_cycles=True)),
    )
    for far in (-0.6, -0.3, 0.0, 0.3, 0.9):
        # A way about the corner (0, 0), at one distance from the path all along.
        x, y = _beside(turn, far)
        seen = coordinates(corner, at(x, y))
        step = np.hypot(np.diff(x), np.diff(y))
        # The arc is nearest to its pivot at the inner edge, where the texture is fastest.
        assert np.abs(np.diff(seen.along_mm)).max() < 30 * step.max()


def _beside(turn, far):
    """A way along two edges that meet at (0, 0), ``far`` outside of them or, below 0, inside."""
    start = -far / math.tan(turn / 2) if far < 0 else 0.0
    back = np.linspace(start + 6, start, 3000)
    ways = [(back, np.full(back.size, -far))]
    if far > 0:
        angle = np.linspace(-math.pi / 2, turn + math.pi / 2 - math.tau, 3000)
        ways.append((far * np.cos(angle), far * np.sin(angle)))
    on = back[::-1]
    cosine, sine = math.cos(turn), math.sin(turn)
    ways.append((on * cosine - far * sine, on * sine + far * cosine))
    return np.concatenate(ways, axis=1)


def test_contours_of_a_path_have_places_of_their_own():
    two = (((0, 0), (20, 0)), ((0, 10), (10, 10), (10, 20)))
    seen = coordinates(
        PathShape(contours_mm=two, stroke=Stroke()), at([5, 3, 11, 12, -1], [1, 9, 15, 22, 11])
    )
    np.testing.assert_allclose(seen.along_mm, [5, 3, 15, 22, -1])
    np.testing.assert_array_equal(seen.contour, [0, 1, 1, 1, 1])


def test_inside_is_by_the_even_odd_rule():
    ring = (SQUARE, ((10, 10), (20, 10), (20, 20), (10, 20)))
    fill = Fill(texture=Uniform())
    path = PathShape(contours_mm=ring, closed=True, fill=fill)
    np.testing.assert_array_equal(
        is_inside(path, at([5, 15, 40], [5, 15, 5])), [True, False, False]
    )


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


@pytest.mark.parametrize(
    ("span", "inside", "outside"),
    [
        # Seen from (2, 2) the bounds of "edges" and of "square" at a right angle are the same.
        ("edges", (-1, 1.9), (5, 0)),
        ("square", (1.9, -1), (0, 5)),
        ("angle", (1, 1), (-1, 1.5)),
        ("arc", (0, 0), (3, 0)),
    ],
)
def test_markers_are_within_their_bounds(span, inside, outside):
    markers = VertexMarkers(span=span, blend_mm=0.05)
    square = Polygon(vertices_mm=SQUARE, markers=markers, stroke=Stroke(width_mm=4))
    here = at(*np.array([inside, outside, (15, 0), (-3, -3)]).T)
    share = marked(square, markers, 4, coordinates(square, here), here)
    np.testing.assert_allclose(share, [1, 0, 0, 0])


def test_a_marker_grows_over_its_blend_beyond_the_place_where_edges_meet():
    markers = VertexMarkers(span="square", blend_mm=1)
    square = Polygon(vertices_mm=SQUARE, markers=markers, stroke=Stroke(width_mm=4))
    here = at([1, 2, 2.25, 2.75, 3, 4], 0)
    share = marked(square, markers, 4, coordinates(square, here), here)
    np.testing.assert_allclose(share, [1, 1, 0.75, 0.25, 0, 0], atol=1e-12)


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


def test_a_strokes_mask_is_its_profile_at_full_amplitude_whatever_is_in_it():
    stroke = Stroke(
        width_mm=4, amplitude=0.2, along=Along(ridge_mm=2), vibration=Vibration(frequency_hz=1)
    )
    line = StraightLine(start_mm=(0, 0), end_mm=(30, 0), stroke=stroke, amplitude=0.5)
    x = np.linspace(3, 27, 50)
    np.testing.assert_allclose(mask(line, None, at(x, 1.5)), 0.5)
    outlined = StraightLine(
        start_mm=(0, 0), end_mm=(9, 0), stroke=Stroke(width_mm=8, outlined=True)
    )
    assert mask(outlined, None, at(5.0)) == 1


def test_a_filled_shapes_mask_is_its_inside_too():
    fill = Fill(texture=Uniform(level=0), gap_mm=3)
    disc = Circle(center_mm=(0, 0), radius_mm=20, stroke=Stroke(width_mm=4, edge_mm=1), fill=fill)
    np.testing.assert_allclose(mask(disc, None, at([0, 17, 20, 21.5, 22])), [1, 1, 1, 0.5, 0])
