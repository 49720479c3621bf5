"""Corners of polygons, held to the formulas: s = R'/tan(θ/2), √(s² + R'²), (π - θ) R'."""

import math

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from vbraille.scene.geometry import joint, marker_half_angle_rad
from vbraille.scene.patterns import VertexMarkers


def corner(angle, radius, before=50.0, after=50.0, turned=0.0, left=1):
    """A corner at (7, 3) with this angle between its edges."""
    x, y = 7.0, 3.0

    def end(far, at):
        return x + far * math.cos(at), y + far * math.sin(at)

    return joint(end(before, turned), (x, y), end(after, turned + left * angle), radius)


angles = st.floats(0.01, math.pi - 0.01)
turns = st.floats(-math.pi, math.pi)


@given(angles, st.floats(0.05, 5), turns, st.sampled_from([1, -1]))
def test_a_corner_is_what_the_formulas_say(angle, radius, turned, left):
    assume(radius / math.tan(angle / 2) < 25)
    found = corner(angle, radius, turned=turned, left=left)
    s = radius / math.tan(angle / 2)
    assert found.angle_rad == pytest.approx(angle)
    assert found.radius_mm == radius
    assert found.reach_mm == pytest.approx(s)
    assert found.arc_mm == pytest.approx((math.pi - angle) * radius)
    assert math.dist(found.pivot_mm, (7, 3)) == pytest.approx(math.hypot(s, radius))
    # The pivot lies on the bisector: so far along both edges, and the radius away from them.
    for at in (turned, turned + left * angle):
        dx, dy = found.pivot_mm[0] - 7, found.pivot_mm[1] - 3
        assert dx * math.cos(at) + dy * math.sin(at) == pytest.approx(s, abs=1e-9)
        assert abs(dy * math.cos(at) - dx * math.sin(at)) == pytest.approx(radius, abs=1e-9)
    after = (math.cos(turned + left * angle), math.sin(turned + left * angle))
    assert sum(a * b for a, b in zip(found.onward, after, strict=True)) > 0
    assert sum(a * b for a, b in zip(found.inward, found.onward, strict=True)) == 0
    assert math.hypot(*found.inward) == pytest.approx(1)


@given(st.floats(0, math.pi), st.floats(0, 500), st.floats(1e-3, 50), st.floats(1e-3, 50), turns)
def test_no_arc_goes_beyond_the_middle_of_an_edge(angle, radius, before, after, turned):
    found = corner(angle, radius, before, after, turned)
    assert 0 <= found.reach_mm <= min(before, after) / 2 + 1e-9
    assert 0 <= found.radius_mm <= radius
    assert all(map(math.isfinite, (*found.pivot_mm, *found.inward, *found.onward, found.arc_mm)))
    assert math.hypot(*found.inward) == pytest.approx(1)
    assert found.reach_mm * math.tan(found.angle_rad / 2) == pytest.approx(
        found.radius_mm, rel=1e-6, abs=1e-6
    )


@pytest.mark.parametrize("angle", [0.0, math.pi, 1e-12, math.pi - 1e-12])
def test_edges_that_go_on_or_back_have_a_pivot_all_the_same(angle):
    found = corner(angle, 2.0)
    assert math.isfinite(math.dist(found.pivot_mm, (7, 3)))
    assert found.arc_mm == pytest.approx(0 if angle > 1 else math.pi * found.radius_mm, abs=1e-9)
    assert found.radius_mm == pytest.approx(2.0 if angle > 1 else 0.0, abs=1e-9)


def test_a_marker_is_no_wider_than_the_wider_of_what_edges_allow():
    wide = VertexMarkers(span="angle", angle_deg=180)
    assert math.degrees(2 * marker_half_angle_rad(wide, math.radians(60))) == pytest.approx(120)
    assert math.degrees(2 * marker_half_angle_rad(wide, math.radians(130))) == pytest.approx(130)
