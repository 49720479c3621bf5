"""Names in scenes: each use becomes what it names, moved and changed, or is refused."""

import typing

import msgspec
import pytest

from tests.tiers import heavy
from vbraille.errors import InputError
from vbraille.scene.patterns import (
    AnyPattern,
    Circle,
    Dots,
    Fill,
    Group,
    Image,
    PathShape,
    StraightLine,
    Stroke,
    Tile,
    Uniform,
    Use,
    Vibration,
)
from vbraille.scene.reading import MOST_DEPTH, resolve
from vbraille.scene.scene import Canvas, Scene
from vbraille.scene.traversal import ONE, SEVERAL, moved, with_children

CANVAS = Canvas(width_mm=200, height_mm=100)


def scene(*elements, **textures):
    return Scene(canvas=CANVAS, elements=elements, textures=textures)


def resolved(*elements, **textures):
    return resolve(scene(*elements, **textures)).elements


def refusal(*elements, **textures):
    with pytest.raises(InputError) as caught:
        resolved(*elements, **textures)
    return str(caught.value)


def circle(**more):
    return Circle(center_mm=(10.0, 20.0), radius_mm=5.0, stroke=Stroke(), **more)


def test_a_use_becomes_what_it_names_without_its_id_and_the_scene_has_no_names_left():
    shown = resolve(scene(circle(id="moon", title="Moon"), Use(name="moon", id="other")))
    assert shown.elements == (circle(id="moon", title="Moon"), circle(id="other", title="Moon"))
    assert resolve(scene(Use(name="a"), a=Uniform(level=0.5))).textures == {}


def test_a_use_with_changes_stands_in_a_group_that_has_them():
    swing = Vibration(frequency_hz=20.0)
    (found,) = resolved(
        Use(name="a", title="here", amplitude=0.5, inverted=True, vibration=swing), a=circle()
    )
    assert found == Group(
        operation="maximum",
        parts=(circle(),),
        title="here",
        amplitude=0.5,
        inverted=True,
        vibration=swing,
    )


def test_uses_of_uses_are_moved_by_the_sum_of_their_moves():
    (found,) = resolved(
        Use(name="b", move_mm=(1.0, 2.0)), a=circle(), b=Use(name="a", move_mm=(10.0, 20.0))
    )
    assert found.center_mm == (21.0, 42.0)


def test_uses_within_fills_tiles_images_and_groups_are_found():
    use, level = Use(name="a"), Uniform(level=0.25)
    around = [
        Circle(center_mm=(0, 0), radius_mm=5, fill=Fill(texture=use)),
        Tile(width_mm=5, height_mm=5, part=use),
        Image(file="x.png", texture=use),
        Group(parts=(use, use)),
        Group(operation="blend", parts=(level, use), by=use),
    ]
    wanted = [with_children(one, lambda _, __: level) for one in around]
    assert list(resolved(*around, a=level)) == wanted


def test_an_element_deep_in_a_group_can_be_used_by_its_id():
    inner = Group(parts=(Group(parts=(circle(id="deep"),)),), id="outer")
    assert resolved(inner, Use(name="deep"))[1] == circle()
    assert resolved(inner, Use(name="outer"))[1] == Group(parts=(Group(parts=(circle(),)),))


MOVED = [
    (
        StraightLine(start_mm=(0.0, 0.0), end_mm=(9.0, 9.0), stroke=Stroke()),
        {"start_mm": (3.0, -4.0), "end_mm": (12.0, 5.0)},
    ),
    (
        PathShape(contours_mm=(((0.0, 0.0), (9.0, 9.0)),), stroke=Stroke()),
        {"contours_mm": (((3.0, -4.0), (12.0, 5.0)),)},
    ),
    (Dots(centers_mm=((0.0, 0.0), (5.0, 5.0))), {"centers_mm": ((3.0, -4.0), (8.0, 1.0))}),
    (
        Tile(width_mm=5.0, height_mm=5.0, part=circle()),
        {"origin_mm": (3.0, -4.0), "part": circle()},
    ),
    (Uniform(), {}),
]


@pytest.mark.parametrize(("pattern", "places"), MOVED, ids=lambda one: type(one).__name__)
def test_a_pattern_is_moved_with_all_its_places(pattern, places):
    assert moved(pattern, (3.0, -4.0)) == msgspec.structs.replace(pattern, **places)


def test_every_field_that_is_a_place_is_moved():
    """A place that a new kind of pattern has is not left behind."""
    of_kinds = {one for kind in typing.get_args(AnyPattern) for one in kind.__struct_fields__}
    sizes = {"width_mm", "height_mm", "blur_mm", "radius_mm", "ridge_mm", "gap_mm", "fade_mm"}
    sizes |= {"rounding_offset_mm", "cell_mm"}
    lengths = {name for name in of_kinds if name.endswith("_mm")}
    assert lengths - sizes == {*ONE, *SEVERAL}


def test_an_unknown_name_is_answered_with_the_nearest():
    assert refusal(circle(id="roof"), Use(name="rof")) == (
        "elements, number 2 name is 'rof', which nothing here is called; the nearest is roof"
    )
    assert "the nearest is stock:radial" in refusal(Use(name="stock:radiall"))
    assert "the nearest is stock:radial" in refusal(Use(name="stcok:radial"))


def test_a_texture_that_nothing_uses_is_checked_all_the_same():
    assert "textures a name is 'no'" in refusal(a=Use(name="no"))


def test_names_are_given_once_and_not_for_the_programs_own():
    assert refusal(circle(id="a"), circle(id="a")) == (
        "elements, number 2 is called a, as is elements, number 1; give it another name"
    )
    assert "as is textures a" in refusal(circle(id="a"), a=Uniform())
    assert "only the program's own names begin with stock:" in refusal(circle(id="stock:mine"))


def test_what_nests_too_deep_is_refused_before_it_is_gone_through():
    deep = circle()
    for _ in range(MOST_DEPTH - 1):
        deep = Group(parts=(deep,))
    assert resolved(deep) == (deep,)
    assert f"nests more than {MOST_DEPTH} deep" in refusal(Group(parts=(deep,)))
    for _ in range(5000):
        deep = Group(parts=(deep,))
    assert f"nests more than {MOST_DEPTH} deep" in refusal(deep)
    chain = {f"t{n}": Use(name=f"t{n + 1}") for n in range(500)}
    assert "uses uses more than" in refusal(**chain, t500=Uniform())
    long = {}
    for n in range(30):
        long[f"t{n}"] = Use(name=f"t{n + 1}")
        for _ in range(28):
            long[f"t{n}"] = Group(parts=(long[f"t{n}"],))
    assert "deep by what it uses" in refusal(**long, t30=Uniform())


@heavy
def test_uses_that_multiply_are_refused_before_they_fill_the_memory():
    many = {f"t{n}": Group(parts=(Use(name=f"t{n + 1}"),) * 10) for n in range(20)}
    assert "makes it more than 200000 patterns; use fewer" in refusal(**many, t20=Uniform())


def test_more_points_than_there_may_be_are_refused():
    many = Dots(centers_mm=tuple((x / 1000, 1.0) for x in range(50_000)), id="many")
    sentence = refusal(many, *(Use(name="many") for _ in range(90)))
    assert sentence == "elements, number 80 makes it more than 4000000 points; use fewer"


def test_what_is_moved_too_far_is_refused():
    far = Circle(center_mm=(9000.0, 0.0), radius_mm=5.0, stroke=Stroke(), id="a")
    assert refusal(far, Use(name="a", move_mm=(2000.0, 0.0))) == (
        "elements, number 2 cannot be moved so far: center, x is 11000 mm; "
        "it must be -10000 to 10000 mm"
    )
