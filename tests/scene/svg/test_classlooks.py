"""What classes of a drawing become, which a scene says."""

import pytest

from tests.scene.svg.plans import NS, element_of
from vbraille.scene.patterns import (
    Dotting,
    Fill,
    LinearGrating,
    StraightLine,
    Stroke,
    UniformVibration,
)
from vbraille.scene.reading import open_scene
from vbraille.scene.svg.looks import ClassLook

WATER = ClassLook(fill=Fill(texture=UniformVibration(), gap_mm=1), stroke=Stroke(width_mm=5))


@pytest.mark.parametrize(
    "text",
    [
        '<circle r="5" class="a water" fill="red"/>',
        '<g class="water"><g><circle r="5"/></g></g>',
        '<circle r="5" id="water"/>',
    ],
)
def test_a_scene_says_what_a_class_becomes(read, text):
    circle = element_of(read(text, looks={"water": WATER}))
    assert (circle.fill, circle.stroke) == (WATER.fill, WATER.stroke)


def test_a_scene_file_says_what_classes_of_the_drawings_it_includes_become(tmp_path):
    (tmp_path / "plan.svg").write_text(
        f'<svg {NS} width="9" height="9"><circle r="5" class="water"/></svg>'
    )
    (tmp_path / "my.scene").write_text(
        'include = ["plan.svg"]\n'
        "[canvas]\nwidth_mm = 30\nheight_mm = 20\n"
        "[textures.waves]\n"
        'kind = "linear-grating"\nridge_mm = 3\n'
        '[classes.water.fill]\ntexture = {kind = "use", name = "waves"}\n'
        "[classes.water.stroke]\nwidth_mm = 5\n"
        "[classes.watr]\nhidden = true\n"
    )
    opened = open_scene(tmp_path / "my.scene")
    (circle,) = opened.resolved.elements
    assert circle.fill.texture == LinearGrating(ridge_mm=3)
    assert circle.stroke.width_mm == 5
    (warning,) = opened.warnings
    assert warning == (
        f"{tmp_path / 'plan.svg'}: nothing that is shown has the class, label or id watr, "
        "which the scene speaks of"
    )


def test_a_class_may_be_dotted_or_hidden(read):
    looks = {"way": ClassLook(dots=Dotting()), "frame": ClassLook(hidden=True)}
    found = read('<g class="frame"><circle r="5"/></g><line x2="9" class="way"/>', looks=looks)
    assert element_of(found) == StraightLine(start_mm=(0, 0), end_mm=(9, 0), dots=Dotting())
    with pytest.raises(ValueError, match="dots cannot be given beside a stroke"):
        ClassLook(dots=Dotting(), stroke=Stroke())
