"""The sample scenes are as they say, and what is hard to feel in them is meant."""

from pathlib import Path

import numpy as np
import pytest

from vbraille.pictures.checking import check_scene
from vbraille.pictures.index import SceneIndex
from vbraille.pictures.loading import load_scene
from vbraille.render import MODELS
from vbraille.render.compiling import SceneMap
from vbraille.scene.geometry import around
from vbraille.scene.patterns import Circle, Polygon
from vbraille.scene.signals import packed

SAMPLES = Path(__file__).parents[2] / "texts" / "scenes"
NAMES = (
    "house", "chart", "map", "world", "route", "prices", "triangle",
    "shapes-vibration", "shapes-dots", "shapes-gratings",
)  # fmt: skip
DROWNS = "both are under one finger"
# The source's outlines of 1.5 mm are thinner than what its later chapters recommend, and a chart's
# bars, continents and shapes to compare stand close together.
MEANT = {
    "shapes-vibration": ("has a stroke of 1.5 mm", *4 * (DROWNS,)),
    "chart": 3 * ("stands less than 2.5 mm",),
    "map": ("label wood lies on element 3",),
    "world": 2 * (DROWNS,),
}


def load(name):
    return load_scene(SAMPLES / f"{name}.scene", MODELS["stress2"].style)


def test_every_sample_is_one_of_these():
    assert {path.stem for path in SAMPLES.glob("*.scene")} == set(NAMES)


@pytest.mark.parametrize("name", NAMES)
def test_a_sample_has_no_remarks_but_those_that_are_meant(name):
    loaded = load(name)
    report = check_scene(loaded)
    remarks = [*loaded.notes, *report.advice]
    meant = MEANT.get(name, ())
    assert len(remarks) == len(meant)
    assert all(part in remark for part, remark in zip(meant, remarks, strict=True))
    assert loaded.title
    assert all(element.name for element in report.elements)


def test_the_shapes_of_the_first_experiment_fill_their_squares():
    """Lévesque 2009, 6.4.1: six shapes that fill squares of 2 and of 3 cm."""
    kinds = ("square", "circle", "inverted-triangle", "right-triangle", "diamond", "plus")
    for method in ("vibration", "dots", "gratings"):
        shapes = load(f"shapes-{method}").scene.elements
        assert [shape.id for shape in shapes] == [f"{kind}-{n}" for n in (3, 2) for kind in kinds]
        for shape in shapes:
            side_mm = 10.0 * int(shape.id[-1])
            if isinstance(shape, Circle):
                assert 2 * shape.radius_mm == side_mm
                continue
            assert isinstance(shape, Polygon)
            box = around(shape.vertices_mm)
            assert (box.right - box.left, box.bottom - box.top) == pytest.approx((side_mm, side_mm))


def test_the_shapes_are_drawn_by_the_sources_three_methods():
    """Outlines of 1.5 mm that vibrate at 50 Hz, dots of 1 mm radius, ridges of 2 mm that stand."""
    for shape in load("shapes-vibration").scene.elements:
        assert (shape.stroke.width_mm, shape.stroke.vibration.frequency_hz) == (1.5, 50)
    for shape in load("shapes-dots").scene.elements:
        assert (shape.dots.dot.radius_mm, shape.dots.separation_mm) == (1, 1)
    for shape in load("shapes-gratings").scene.elements:
        texture = shape.fill.texture
        assert (shape.stroke, texture.ridge_mm, texture.gap_mm) == (None, 2, 0)
        assert texture.ridge_angle_deg == 90


def test_the_world_has_two_views_by_a_key():
    """Lévesque 2009, 9.5: textured continents, or textured regions; coasts vibrate in both."""
    loaded = load("world")
    drawn, signals = SceneMap(loaded.scene, loaded.assets), loaded.scene.signals
    elements = {element.id: element for element in loaded.scene.elements}
    across = np.arange(-5.0, 5.0, 0.5)
    for name, views in (("siberia", (6.0, 10.0)), ("amazon", (6.0, 3.0))):
        x, y = elements[name].center_mm
        for view, wave in enumerate(views):
            switches = packed({1: view}, signals)
            shown = drawn.deflections(x + across, np.array([y]), switches=switches)[0]
            spectrum = np.abs(np.fft.rfft(shown - shown.mean(), 2000))
            assert 2000 * 0.5 / spectrum.argmax() == pytest.approx(wave, rel=0.3), (name, view)
    index = SceneIndex(loaded.scene, loaded.assets, loaded.boxes())
    assert index.here(*elements["amazon"].center_mm).name == "South America"
    index.switches = packed({1: 1}, signals)
    assert index.here(*elements["amazon"].center_mm).name == "Amazon"
