"""What is said about files of OpenLatero's, and what is made of odd ones."""

import pytest

from tests.scene.openlatero.files import (
    circle,
    grating,
    line,
    polygon,
    scene,
    stroke,
    swings,
    texture,
)
from vbraille.errors import InputError
from vbraille.scene.openlatero import read_gen
from vbraille.scene.patterns import (
    Circle,
    LinearGrating,
    PathShape,
    Stroke,
    Tile,
    Vibration,
)


def said(found):
    return "\n".join(found.warnings)


def test_a_clean_scene_is_taken_over_without_a_word(read):
    found = read(circle(stroke()), grating())
    assert found.warnings == ()
    assert found.scene.operation == "maximum"
    assert (found.scene.canvas.width_mm, found.scene.canvas.height_mm) == (289.9, 230.1875)
    assert found.scene.elements == (
        Circle(center_mm=(50, 40), radius_mm=18, stroke=Stroke(width_mm=8, edge_mm=1.5)),
        LinearGrating(ridge_mm=4, gap_mm=2, start_mm=(3.5, 1.25), wave_angle_deg=0),
    )


def test_lines_of_elements_and_of_their_parts_are_known(read):
    found = read('<Pattern type="Group">\n' + circle() + "\n" + line() + "\n</Pattern>", circle())
    assert found.lines == {
        ("elements", 0): 6,
        ("elements", 0, "parts", 0): 7,
        ("elements", 0, "parts", 1): 8,
        ("elements", 1): 10,
    }


@pytest.mark.parametrize("root", ["laterographics_xml", "stressr_xml", "anything"])
def test_the_root_may_have_any_name(read, root):
    found = read(scene(circle()).replace("laterographics_xml", root))
    assert len(found.scene.elements) == 1
    assert not found.warnings


def test_a_library_file_is_a_scene_of_its_texture(read):
    found = read(
        f'<?xml version="1.0"?><laterographics_xml type="Texture">{grating()}</laterographics_xml>',
        name="fine.tx",
    )
    assert found.scene.title == "fine"
    assert [type(element) for element in found.scene.elements] == [LinearGrating]


def test_stray_characters_harm_nothing(read):
    found = read(scene(circle(stroke())).replace("</Generator>", "</Generator>\\"))
    assert found == read(circle(stroke()))
    odd = circle(stroke(), radius="18\\")
    assert read(odd).scene.elements == read(circle(stroke())).scene.elements


def test_an_operation_may_be_text_as_in_old_files(read):
    assert read(circle(), line(), operation="<operation>add</operation>").scene.operation == "add"


def test_a_group_without_an_operation_is_a_maximum(read):
    assert read(circle(), line(), operation="").scene.operation == "maximum"


DECIMALS = [
    ("<radius>12,5</radius>", 12.5, 'radius "12,5" has a decimal comma; 12.5 is taken'),
    ("<radius>12.5</radius>", 12.5, ""),
    ("<radius> 1.25e1 </radius>", 12.5, ""),
    ('<radius units="cm">3</radius>', 3, "radius is in mm, although its units say cm"),
    ("<radius>12 mm</radius>", 12, 'radius has "mm" after its number, which is ignored'),
    ("<radius>wide</radius>", 100, 'radius is "wide", which is no number; 100 is taken'),
    ("<radius></radius>", 100, "radius is empty; 100 is taken"),
    ("<radius>nan</radius>", 100, 'radius is "nan", which is no number; 100 is taken'),
    ("<radius>1e999</radius>", 100, "radius is too large a number; 100 is taken"),
    (
        "<radius>99999</radius>",
        10_000,
        "radius is 99999, and it must be 0 to 10000; 10000 is taken",
    ),
    (
        "<radius>5</radius><radius>6</radius>",
        5,
        "another radius is ignored, since the first counts",
    ),
]


@pytest.mark.parametrize(("radius", "expected", "message"), DECIMALS)
def test_numbers_are_read_in_every_locale(read, radius, expected, message):
    found = read(f'<Pattern type="Circle">{radius}{stroke()}</Pattern>')
    assert found.scene.elements[0].radius_mm == expected
    assert said(found) == (f"line 6, Circle: {message}" if message else "")


PLACES = [
    ("12,5", (12, 5), False),
    ("12.5, 7.25", (12.5, 7.25), False),
    ("12,5,7,25", (12.5, 7.25), True),
    ("12,5,7", (12.5, 7), True),
    ("-1.5,2e1", (-1.5, 20), False),
    ("here", (0, 0), True),
    ("5", (0, 0), True),
]


@pytest.mark.parametrize(("text", "place", "is_said"), PLACES)
def test_places_have_a_comma_between_x_and_y_and_some_have_decimal_commas(
    read, text, place, is_said
):
    found = read(circle(stroke(), center=text))
    assert found.scene.elements[0].center_mm == place
    assert bool(found.warnings) == is_said


def test_a_polygon_that_crosses_itself_is_a_path(read):
    found = read(polygon(stroke(), ("0,0", "30,30", "30,0", "0,30")))
    (path,) = found.scene.elements
    assert isinstance(path, PathShape)
    assert path.closed
    assert "its edges cross" in said(found)


def test_low_vibration_is_as_the_file_says_or_as_it_is_shown(read):
    text = grating(inside=swings(30, 0.5, "low"))
    as_said, shown = read(text), read(text, as_shown=True)
    assert as_said.scene.elements[0].vibration == Vibration(
        frequency_hz=30, amplitude=0.5, of="low"
    )
    vibration = shown.scene.elements[0].vibration
    assert vibration.of == "high"
    assert vibration.frequency_hz == 1e6 / 33_333
    assert "OpenLatero ignores blend_mode low" in said(as_said)
    assert not said(shown)


def test_changes_of_tiles_are_as_the_file_says_or_as_they_are_shown(read):
    text = texture("Pattern", f"{circle(stroke())}<amplitude>0.5</amplitude><invert>yes</invert>")
    (tile,) = read(text).scene.elements
    assert isinstance(tile, Tile)
    assert (tile.amplitude, tile.inverted) == (0.5, True)
    (tile,) = read(text, as_shown=True).scene.elements
    assert (tile.amplitude, tile.inverted) == (1.0, False)


def test_elements_in_a_group_as_deep_as_can_be(read):
    group = '<Pattern type="Group"><operation>max</operation>' + line()
    found = read(group * 40 + "</Pattern>" * 40)
    assert "this is in 32 other patterns; left out" in said(found)


REFUSED = {
    "nothing": (b"", "is no XML"),
    "no XML": (b"hello", "is no XML"),
    "other XML": (b"<html/>", "holds no Generator and no Pattern"),
    "entities": (
        b'<!DOCTYPE a [<!ENTITY a "b"><!ENTITY c "&a;&a;">]><a>&c;</a>', "declares entities"
    ),
    "entities in UTF-16": (
        '<?xml version="1.0" encoding="UTF-16"?><!DOCTYPE a [<!ENTITY a "b">]><a/>'.encode(
            "utf-16"
        ),
        "declares entities",
    ),
    "a bottomless pit": (b"<a>" * 10_001 + b"</a>" * 10_001, "holds no Generator and no Pattern"),
    "a crowd": (b"<a>" + b"<b/>" * 200_001 + b"</a>", "more than 200000 elements"),
}  # fmt: skip


@pytest.mark.parametrize("name", REFUSED)
def test_bad_files_are_refused_in_one_sentence(tmp_path, name):
    content, message = REFUSED[name]
    path = tmp_path / "bad.gen"
    path.write_bytes(content)
    with pytest.raises(InputError, match=message) as refused:
        read_gen(path)
    assert "\n" not in str(refused.value)


def test_nothing_is_looked_up_elsewhere(tmp_path):
    secret = tmp_path / "secret.txt"
    secret.write_text("9")
    path = tmp_path / "bad.gen"
    path.write_text(
        f'<!DOCTYPE a [<!ENTITY % x SYSTEM "file://{secret}"> %x;]>' + scene(circle())[22:]
    )
    with pytest.raises(InputError, match="declares entities"):
        read_gen(path)


def test_broken_xml_is_read_as_far_as_it_can_be(read):
    text = scene(circle(stroke()), line(stroke())).replace("</Generator>", "")
    found = read(text)
    assert len(found.scene.elements) == 2
    assert "XML: it is broken here, and read as far as it can be" in said(found)


def test_a_file_that_is_not_there_is_said(tmp_path):
    with pytest.raises(InputError, match=r"there is no file .*no\.gen"):
        read_gen(tmp_path / "no.gen")


@pytest.mark.parametrize(
    "vertices",
    [("0,0", "9,0", "9,0", "9,9"), ("0,0", "9,0", "9,9", "0,0")],
    ids=["twice", "closed"],
)
def test_a_vertex_on_the_one_before_is_passed_over(read, vertices):
    found = read(polygon(stroke(), vertices))
    assert found == read(polygon(stroke(), ("0,0", "9,0", "9,9")))
    assert not said(found)
