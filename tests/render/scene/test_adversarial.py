"""Pictures that are hard to render: degenerate, huge, tiny, far away, and felt for hours."""

import math

import numpy as np
import pytest

from tests.render.scene.showing import STRESS2_8X8_ARRAY, At, poses, scene_of, shown
from tests.tiers import by_tier
from vbraille.scene.patterns import (
    Across,
    Along,
    AxialGrating,
    Circle,
    Dots,
    DotStyle,
    Dotting,
    Fill,
    Image,
    Label,
    LinearGrating,
    PathShape,
    Polygon,
    RadialGrating,
    Stroke,
    Tile,
    TurnPeak,
    Uniform,
    UniformVibration,
    VertexMarkers,
    Vibration,
)

HOURS_S = 36_000.0
COUNT = by_tier(4, 12, 200)  # of poses at which a picture is felt
ALONG = Stroke(width_mm=4, along=Along(ridge_mm=2, gap_mm=1, whole_cycles=False))
SQUARE = ((10, 10), (40, 10), (40, 40), (10, 40))


def over(x_mm, y_mm, theta_rad=0.0, time_s=0.3):
    """A pose at which an actuator stands at this very place."""
    return At(x_mm - 0.6, y_mm - 0.7, theta_rad, time_s)


def everywhere(scene, rng, *, around=(30.0, 30.0), count=COUNT, time_s=None):
    """Compare kernel and twin around a place."""
    for pose in poses(rng, count):
        at = At(
            pose.x_mm - 30 + around[0],
            pose.y_mm - 30 + around[1],
            pose.theta_rad,
            pose.time_s if time_s is None else time_s,
        )
        frame = shown(scene, STRESS2_8X8_ARRAY, at)
        assert np.isfinite(frame).all()


def wide(width, **more):
    return Stroke(width_mm=width, **more)


STAR = tuple(
    (30 + r * math.cos(math.pi * n / 5), 30 + r * math.sin(math.pi * n / 5))
    for n in range(10)
    for r in [25 if n % 2 else 4]
)
NEARLY_STRAIGHT = ((5, 30), (20, 30.0000001), (35, 30), (50, 30.000001), (30, 55))
NEEDLE = ((5, 30), (55, 30), (5.001, 30.02))
STEPS = (*tuple((10 + n * 1e-05, 30 - 1e-05 * (n % 2)) for n in range(20)), (40, 30), (30, 45))
SHAPES = {
    "star": STAR,
    "nearly straight corners": NEARLY_STRAIGHT,
    "needle": NEEDLE,
    "edges of 14 nm": STEPS,
    "nearly crossing itself": ((10, 10), (50, 50), (50.001, 49.999), (10.002, 10)),
    "nearly back on itself": ((10, 30), (50, 30), (30, 30.0000001), (30, 50)),
    "far larger than the array": ((-9000, -9000), (9000, -9000), (30, 31)),
}


@pytest.mark.parametrize("join", ["straight", "rounded"])
@pytest.mark.parametrize("name", SHAPES)
@pytest.mark.parametrize(
    "stroke",
    [
        pytest.param(wide(1, along=Along(ridge_mm=0.5, gap_mm=0.3)), id="thin"),
        pytest.param(wide(6, along=Along(ridge_mm=3, whole_edges=True), edge_mm=1), id="wide"),
        pytest.param(wide(60, along=Along(ridge_mm=3)), id="wider than its edges are long"),
    ],
)
def test_polygons_of_any_shape(name, stroke, join, rng):
    # Places as near to one edge as to another differ by rounding: odd coordinates have none.
    scene = scene_of(
        Polygon(
            vertices_mm=SHAPES[name],
            stroke=stroke,
            join=join,
            markers=VertexMarkers(span="arc", blend_mm=2),
            fill=Fill(texture=LinearGrating(ridge_mm=3), gap_mm=0.5),
        )
    )
    everywhere(scene, rng, count=by_tier(2, 6, 50))


AT_HEARTS = {
    "circle of strokes": Circle(center_mm=(30, 30), radius_mm=3, stroke=ALONG),
    "circle smaller than its stroke": Circle(
        center_mm=(30, 30), radius_mm=0.05, stroke=wide(20, along=Along(ridge_mm=2))
    ),
    "filled circle": Circle(center_mm=(30, 30), radius_mm=9, fill=Fill(texture=Uniform())),
    "circle whose fill hardly fades in": Circle(
        center_mm=(30, 30), radius_mm=9, fill=Fill(texture=Uniform(), fade_mm=5e-324)
    ),
    "weak circle whose dots and fill are more than 1 together": Circle(
        center_mm=(30, 35),
        radius_mm=5.3,
        amplitude=0.2,
        dots=Dotting(
            dot=DotStyle(radius_mm=2.5, edge_mm=2.4, across=Across(amplitude=1, cycles=3))
        ),
        fill=Fill(texture=Uniform(), blended=True),
    ),
    "radial grating": RadialGrating(center_mm=(30, 30), ridge_mm=3),
    "axial grating": AxialGrating(center_mm=(30, 30), ridge_deg=30),
    "axial grating that fades nowhere": AxialGrating(
        center_mm=(30, 30), ridge_deg=0.5, fade_mm=(0, 1e-6), whole_cycles=False
    ),
    "turning": AxialGrating(center_mm=(30, 30), ridge_deg=20, velocity_deg_s=3600),
    "spokes with a peak": AxialGrating(
        center_mm=(30, 30), ridge_deg=20, distortion=TurnPeak(factor=20, length_deg=0.5)
    ),
    "dot": Dots(centers_mm=((30, 30),), dot=DotStyle(radius_mm=2, across=Across())),
    "dot with hardly an edge": Dots(centers_mm=((30, 30),), dot=DotStyle(plateau=0.95)),
    "dots on one place": Dots(centers_mm=((30, 30),) * 3, dot=DotStyle(radius_mm=5)),
    "tile": Tile(width_mm=0.1, height_mm=0.1, part=LinearGrating(ridge_mm=3), origin_mm=(30, 30)),
    "corner": Polygon(vertices_mm=((30, 30), (50, 30), (50, 50)), stroke=ALONG),
    "pivot": Polygon(
        vertices_mm=((28, 28), (50, 28), (50, 50), (28, 50)), stroke=ALONG, markers=VertexMarkers()
    ),
    "label": Label(text="map", place_mm=(30, 30), angle_deg=33),
    "image of a pixel": Image(file="one.png", place_mm=(30, 30), width_mm=0.1, height_mm=0.1),
}


@pytest.mark.parametrize("name", AT_HEARTS)
def test_the_very_middle_of_things(name, rng):
    scene = scene_of(AT_HEARTS[name])
    for theta in (0.0, 0.5):
        shown(scene, STRESS2_8X8_ARRAY, over(30, 30) if theta == 0 else At(30, 30, theta, 0.1))
    for dx, dy in rng.uniform(-1e-7, 1e-7, (3, 2)):
        frame = shown(scene, STRESS2_8X8_ARRAY, over(30 + dx, 30 + dy))
        assert np.isfinite(frame).all()
    everywhere(scene, rng, count=4)


@pytest.mark.parametrize("place", [(9950.0, 9950.0), (9950.0, 30.0)])
def test_places_ten_metres_away(place, rng):
    x, y = place
    shapes = (
        LinearGrating(ridge_mm=3, wave_angle_deg=70, amplitude=0.3),
        Circle(center_mm=(x, y), radius_mm=9, stroke=ALONG, fill=Fill(texture=Uniform())),
        Dots(centers_mm=((x + 9, y - 9), (x - 9, y - 9)), dot=DotStyle(radius_mm=3)),
        Polygon(
            vertices_mm=((x - 20, y - 20), (x + 20, y - 20), (x, y + 20)),
            stroke=ALONG,
            markers=VertexMarkers(),
        ),
    )
    for operation in ("maximum", "overwrite"):
        scene = scene_of(*shapes, operation=operation, side_mm=10_000)
        everywhere(scene, rng, around=place)


MOVING = {
    "vibration": UniformVibration(frequency_hz=49.9),
    "fastest ridges": LinearGrating(ridge_mm=2.1, velocity_mm_s=1000),
    "slowest ridges": LinearGrating(ridge_mm=2.1, velocity_mm_s=-0.01),
    "spokes": AxialGrating(center_mm=(30, 30), ridge_deg=7, velocity_deg_s=-1234.5),
    "along": Circle(
        center_mm=(30, 30),
        radius_mm=20,
        stroke=wide(9, along=Along(ridge_mm=3, gap_mm=0.7, velocity_mm_s=333.3)),
    ),
    "contours": PathShape(
        contours_mm=(SQUARE, ((20, 20), (30, 20), (30, 33))),
        closed=True,
        stroke=wide(
            6, along=Along(ridge_mm=3, gap_mm=0.7, velocity_mm_s=-77), vibration=Vibration(of="low")
        ),
    ),
}


@pytest.mark.parametrize("name", MOVING)
@pytest.mark.parametrize("time_s", [HOURS_S, HOURS_S + 1 / 3, 1e-9])
def test_what_moves_after_hours(name, time_s, rng):
    everywhere(scene_of(MOVING[name]), rng, time_s=time_s, count=4)
