"""Arrows for what moves: they point where it goes, and stand in it."""

import math

import numpy as np
import pytest

from vbraille.pictures.arrows import arrows
from vbraille.pictures.drawings import map_figure
from vbraille.scene.patterns import (
    Circle,
    Fill,
    Group,
    Moving,
    PathShape,
    Polygon,
    StraightLine,
)
from vbraille.scene.scene import Canvas, Scene
from vbraille.scene.signals import Direction, Inverse
from vbraille.scene.strokes import Along, Dotting, Stroke
from vbraille.scene.textures import (
    AxialGrating,
    LinearGrating,
    RadialGrating,
    SignalLevel,
    Uniform,
)

CANVAS = Canvas(width_mm=100, height_mm=80)
SQUARE = ((10, 10), (40, 10), (40, 40), (10, 40))


def found(*elements, **signals):
    return arrows(Scene(canvas=CANVAS, elements=elements, signals=signals), {})


def filled(texture):
    return Polygon(vertices_mm=SQUARE, fill=Fill(texture=texture))


def way(arrow):
    """Direction from its first point to its last, in degrees."""
    right, down = arrow.points_mm[-1] - arrow.points_mm[0]
    return math.degrees(math.atan2(down, right))


@pytest.mark.parametrize("speed", [20, -20])
@pytest.mark.parametrize("angle", [0, 37, 90, -130])
def test_ridges_and_whole_textures_point_where_they_go(angle, speed):
    rad = math.radians(angle)
    velocity = speed * math.cos(rad), speed * math.sin(rad)
    for texture in (
        LinearGrating(ridge_mm=4, wave_angle_deg=angle, velocity_mm_s=speed),
        Moving(part=Uniform(), velocity_mm_s=velocity),
    ):
        (arrow,) = found(filled(texture))
        turned = math.radians(way(arrow) - angle)
        assert math.cos(turned) == pytest.approx(math.copysign(1, speed))
        assert math.sin(turned) == pytest.approx(0, abs=1e-9)
        np.testing.assert_allclose(arrow.points_mm.mean(axis=0), (25, 25))
        assert not arrow.hollow


@pytest.mark.parametrize("speed", [30, -30])
def test_rings_point_outward_and_spokes_and_circles_turn(speed):
    center = np.array((50.0, 40.0))
    rings = found(RadialGrating(center_mm=(50, 40), ridge_mm=4, velocity_mm_s=speed))
    assert len(rings) == 4
    for arrow in rings:
        first, last = (math.dist(point, center) for point in arrow.points_mm[[0, -1]])
        assert (last > first) == (speed > 0)
    along = Along(velocity_mm_s=speed)
    for pattern in (
        AxialGrating(center_mm=(50, 40), ridge_deg=20, velocity_deg_s=speed),
        Circle(center_mm=(50, 40), radius_mm=12, stroke=Stroke(along=along)),
    ):
        for arrow in found(pattern):
            (x0, y0), (x1, y1) = arrow.points_mm[0] - center, arrow.points_mm[-1] - center
            assert (x0 * y1 - y0 * x1 > 0) == (speed > 0)


def test_strokes_point_along_their_longest_pieces():
    stroke = Stroke(along=Along(velocity_mm_s=20))
    (line,) = found(StraightLine(start_mm=(10, 10), end_mm=(60, 10), stroke=stroke))
    assert way(line) == pytest.approx(0)
    np.testing.assert_allclose(line.points_mm.mean(axis=0), (35, 10))
    (edge,) = found(Polygon(vertices_mm=((0, 0), (30, 0), (30, 50)), stroke=stroke))
    assert way(edge) == pytest.approx(math.degrees(math.atan2(-50, -30)))
    dots = Dotting(velocity_mm_s=-20)
    (line,) = found(StraightLine(start_mm=(10, 10), end_mm=(60, 10), dots=dots))
    assert abs(way(line)) == pytest.approx(180)
    contours = (((0, 0), (5, 0), (5, 40)), ((50, 50), (50, 10)))
    down, up = found(PathShape(contours_mm=contours, stroke=stroke))
    assert (way(down), way(up)) == (pytest.approx(90), pytest.approx(-90))


def test_a_direction_is_a_hollow_arrow_and_an_axis_has_two_heads():
    signals = {
        "onward": Direction(angle_deg=90),
        "axis": Direction(axis=True),
        "across": Inverse(of="axis"),
    }
    blend = Group(
        operation="blend", parts=(Uniform(), Uniform(level=0)), by=SignalLevel(name="onward")
    )
    first, second = found(filled(blend), Uniform(factor="across"), **signals)
    assert (first.hollow, first.both, way(first)) == (True, False, pytest.approx(90))
    assert (second.hollow, second.both, way(second)) == (True, True, pytest.approx(0))


def test_arrows_of_one_element_stand_below_each_other_and_still_ones_have_none():
    moving = LinearGrating(ridge_mm=4, velocity_mm_s=20)
    both = Group(operation="add", parts=(moving, moving))
    first, second = found(filled(both))
    assert (second.points_mm - first.points_mm)[:, 1].min() >= 3
    assert found(filled(LinearGrating(ridge_mm=4)), Uniform()) == []
    beyond = ((200, 10), (240, 10), (240, 40))
    assert found(Polygon(vertices_mm=beyond, fill=Fill(texture=moving))) == []


def test_arrows_are_drawn_black_on_a_white_rim():
    one = found(filled(LinearGrating(ridge_mm=4, velocity_mm_s=20)))
    (axes,) = map_figure(CANVAS, np.zeros((80, 100)), arrows=one).axes
    rim, shaft = axes.lines
    assert rim.get_linewidth() > shaft.get_linewidth()
    assert (rim.get_color(), shaft.get_color()) == ("white", "black")
