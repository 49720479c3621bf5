"""How much patterns hide under the finger: as their twins say, and at once."""

import math
import time

import pytest

from tests.render.scene.twin import opacity
from vbraille.feeling.opacities import Opacities
from vbraille.render.scene.assets import Assets
from vbraille.scene.patterns import Circle, Dots, Fill, Polygon
from vbraille.scene.scene import Canvas, Scene
from vbraille.scene.strokes import Along, DotStyle, Stroke
from vbraille.scene.textures import Uniform

CANVAS = Scene(canvas=Canvas(width_mm=200, height_mm=150))
AROUND = tuple(
    (90 + 60 * math.cos(math.tau * n / 5000), 70 + 60 * math.sin(math.tau * n / 5000))
    for n in range(5000)
)
MANY = {
    "dots": Dots(centers_mm=AROUND, dot=DotStyle(radius_mm=0.5)),
    "polygon": Polygon(vertices_mm=AROUND, stroke=Stroke(along=Along())),
}


def test_it_is_what_the_twin_says_also_of_those_that_were_asked_for_long_ago():
    opacities = Opacities(CANVAS, Assets())
    circles = [
        Circle(
            center_mm=(20 + n, 40),
            radius_mm=9,
            stroke=Stroke(width_mm=3),
            fill=Fill(texture=Uniform()),
        )
        for n in range(120)
    ]
    for x_mm in (24.0, 35.2, 140.4):
        said = [opacities.at(circle, x_mm, 41.0) for circle in circles]
        true = [float(opacity(circle, Assets(), x_mm, 41.0)[0]) for circle in circles]
        assert said == pytest.approx(true, abs=1e-6)
        assert 0 < sum(said) < len(said)


@pytest.mark.parametrize("name", MANY)
def test_it_takes_no_longer_where_a_pattern_has_thousands_of_parts(name):
    opacities = Opacities(CANVAS, Assets())
    few = Circle(center_mm=(90, 70), radius_mm=60, stroke=Stroke())

    def least_s(pattern):
        took_s = []
        for _ in range(9):
            began = time.thread_time()
            opacities.at(pattern, 149.9, 70.0)
            took_s.append(time.thread_time() - began)
        return min(took_s)

    assert least_s(MANY[name]) < 10 * least_s(few)
