"""Where the dots of dotted shapes stand."""

import math
from itertools import combinations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec.structs import replace

from tests.tiers import examples
from vbraille.scene.geometry import dots_of, most_dots_of
from vbraille.scene.patterns import (
    Circle,
    DotStyle,
    Dotting,
    PathShape,
    Polygon,
    StraightLine,
    Stroke,
    meeting_edges,
)

DOTTING = Dotting()  # a radius of 1 mm, and 1 mm between: m = 3 mm


def apart(dots):
    return min((math.dist(a[:2], b[:2]) for a, b in combinations(dots, 2)), default=math.inf)


coordinates = st.integers(-2000, 2000).map(lambda n: n / 100)
points = st.tuples(coordinates, coordinates)


def in_order_around(places):
    """The places in order around their middle, so that edges between them seldom cross."""
    x, y = (sum(axis) / len(places) for axis in zip(*places, strict=True))
    return tuple(sorted(places, key=lambda place: math.atan2(place[1] - y, place[0] - x)))


def follow(places):
    return all(
        math.dist(a, b) > 0.01 for a, b in zip(places, [*places[1:], places[0]], strict=True)
    )


rings = st.lists(points, min_size=3, max_size=7).map(tuple).filter(follow)
uncrossed = rings.map(in_order_around).filter(lambda ring: meeting_edges(ring) is None)
dottings = st.builds(
    Dotting, dot=st.builds(DotStyle, radius_mm=st.floats(0.1, 3)), separation_mm=st.floats(0, 5)
)
shapes = st.one_of(
    st.builds(Polygon, vertices_mm=uncrossed, dots=dottings),
    st.builds(
        PathShape,
        contours_mm=st.lists(rings, min_size=1, max_size=2).map(tuple),
        closed=st.booleans(),
        dots=dottings,
    ),
    st.builds(Circle, center_mm=points, radius_mm=st.floats(0.1, 20), dots=dottings),
    st.builds(StraightLine, start_mm=points, end_mm=st.just((50, 0)), dots=dottings),
)


@examples(120)
@given(shapes)
def test_there_are_no_more_dots_than_are_counted_before_they_are_placed(shape):
    count = len(dots_of(shape))
    assert count <= most_dots_of(shape)
    assert most_dots_of(replace(shape, dots=None, stroke=Stroke())) == 0


@examples(120)
@given(shapes)
def test_no_dots_are_nearer_than_the_separation_also_across_joints(shape):
    dots = dots_of(shape)
    least = 2 * shape.dots.dot.radius_mm + shape.dots.separation_mm
    assert dots
    assert apart(dots) >= least * (1 - 1e-6)


def test_a_line_has_dots_at_its_ends_and_evenly_between():
    dots = dots_of(StraightLine(start_mm=(0, 0), end_mm=(10, 0), dots=DOTTING))
    assert [dot.x_mm for dot in dots] == pytest.approx([0, 10 / 3, 20 / 3, 10])  # ⌊10/3⌋ + 1
    assert not any(dot.vertex for dot in dots)
    # A length that is a whole number of separations is not one dot short by rounding.
    assert len(dots_of(StraightLine(start_mm=(0, 0), end_mm=(0.9, 0), dots=dotting(0.1, 0.1)))) == 4


def dotting(radius, separation):
    return Dotting(dot=DotStyle(radius_mm=radius), separation_mm=separation)


def test_a_line_too_short_for_two_has_one():
    dots = dots_of(StraightLine(start_mm=(1, 1), end_mm=(3, 1), dots=DOTTING))
    assert [dot[:2] for dot in dots] == [(1, 1)]


def test_a_circle_smaller_than_a_dot_has_one():
    dots = dots_of(Circle(center_mm=(0, 0), radius_mm=1, dots=DOTTING))
    assert [dot[:2] for dot in dots] == [(1, 0)]


def test_dots_beside_a_sharp_corner_are_farther_apart():
    triangle = Polygon(vertices_mm=((0, 0), (30, 0), (30, 30)), dots=DOTTING)
    dots = dots_of(triangle)
    # 3 / sin 45° along every edge: ⌊30/4.24⌋, ⌊30/4.24⌋ and ⌊42.4/4.24⌋ spaces.
    assert len(dots) == 7 + 7 + 10
    assert dots[1].x_mm == pytest.approx(30 / 7)


def test_a_curve_of_many_edges_is_dotted_evenly_along_it():
    turns = [math.tau * n / 400 for n in range(400)]
    curve = tuple((10 * math.cos(a), 10 * math.sin(a)) for a in turns)
    path = PathShape(contours_mm=(curve,), closed=True, dots=DOTTING)
    dots = dots_of(path)
    assert len(dots) == len(dots_of(Circle(center_mm=(0, 0), radius_mm=10, dots=DOTTING)))
    assert not any(dot.vertex for dot in dots)
    steps = [math.dist(a[:2], b[:2]) for a, b in zip(dots, [*dots[1:], dots[0]], strict=True)]
    assert max(steps) - min(steps) < 0.01


def test_a_path_has_dots_on_its_ends_and_where_it_turns():
    bent = PathShape(contours_mm=(((0, 0), (10, 0), (20, 1), (20, 12)),), dots=DOTTING)
    dots = dots_of(bent)
    assert dots[0][:2] == (0, 0)
    assert dots[-1][:2] == (20, 12)
    assert [dot[:2] for dot in dots if dot.vertex] == [(20, 1)]


def test_a_long_path_is_dotted_at_once():
    wave = tuple((n * 0.05, 3 * math.sin(n * 0.02)) for n in range(20_000))
    dots = dots_of(PathShape(contours_mm=(wave,), dots=DOTTING))
    assert len(dots) > 300
