"""Drawings in SVG as scenes: shapes, units, fills, and files of drawing programs."""

import re
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.scene.svg.plans import element_of, warned
from tests.tiers import examples
from vbraille.errors import InputError
from vbraille.scene.patterns import (
    Along,
    Circle,
    Fill,
    Group,
    Label,
    Polygon,
    StraightLine,
    Stroke,
    Uniform,
    Use,
)
from vbraille.scene.patterns import PathShape as Lines
from vbraille.scene.reading import SceneFile, open_scene
from vbraille.scene.stock import stock_textures
from vbraille.scene.svg.document import color_of
from vbraille.scene.svg.drawing import read_svg
from vbraille.scene.svg.looks import BY_HUE, hue_of
from vbraille.scene.traversal import each
from vbraille.toml import TomlFile

FILES = Path(__file__).parent / "files"


def test_a_drawing_of_inkscape():
    found = read_svg(FILES / "inkscape.svg")
    scene = found.scene
    assert (scene.canvas.width_mm, scene.canvas.height_mm) == (210, 148)
    assert (scene.title, scene.language) == ("Lake", "de")
    (layer,) = scene.elements
    assert layer.title == "Layer 1"
    assert isinstance(layer, Group)
    water, house, tower, great, lake, again = layer.parts
    assert isinstance(water, Lines)
    assert (water.title, water.description, water.id) == ("Water", "Deep and cold", "water")
    assert water.closed
    assert water.contours_mm[0][0] == (20, 30)
    assert water.contours_mm[0][-3:] == ((40, 50), (50, 50), (50, 70))
    assert water.fill == Fill(texture=Use(name="stock:linear-90"))
    assert water.stroke == Stroke(width_mm=2.5, edge_mm=1)
    assert isinstance(house, Polygon)
    assert house.vertices_mm == ((70, 30), (110, 30), (110, 60), (70, 60))
    assert house.stroke == Stroke(width_mm=3, edge_mm=1, along=Along(ridge_mm=2, gap_mm=6))
    assert tower == Circle(
        center_mm=(130, 50), radius_mm=12.5, fill=Fill(texture=Use(name="stock:linear-0"))
    )
    assert (great.text, lake.text) == ("Great", "Lake")
    assert lake.place_mm[1] - great.place_mm[1] == pytest.approx(12.5)
    assert again.vertices_mm == tuple((x + 5, y + 60) for x, y in house.vertices_mm)
    text = (FILES / "inkscape.svg").read_text().splitlines()
    assert text[found.lines["elements", 0] - 1].startswith("     transform")  # where its tag ends
    assert text[found.lines["elements", 0, "parts", 0] - 1].endswith("<title")
    assert "Lake" in text[found.lines["elements", 0, "parts", 4] - 1]
    assert warned(found) == [
        "its filter is ignored",
        "its fill is a gradient or a pattern, felt as plain black",
    ]


def test_a_drawing_of_illustrator():
    found = read_svg(FILES / "illustrator.svg")
    assert found.scene.canvas.width_mm == pytest.approx(595.28 * 25.4 / 96, abs=1e-3)
    layer = element_of(found)
    assert layer.id == "streets"
    square, way, word = layer.parts
    assert square.vertices_mm[2] == pytest.approx((50 * 25.4 / 96, 50 * 25.4 / 96), abs=1e-3)
    assert square.fill.texture == Use(name="stock:dots")
    assert way.stroke.amplitude == pytest.approx(0.6, abs=0.01)
    assert isinstance(word, Label)
    assert word.text == "Main Street"
    assert word.angle_deg == pytest.approx(90)
    assert not found.warnings


def test_drawings_are_opened_and_included_with_textures_of_the_bank(tmp_path):
    (tmp_path / "plan.svg").write_bytes((FILES / "inkscape.svg").read_bytes())
    (tmp_path / "my.scene").write_text(
        'include = ["plan.svg"]\n[canvas]\nwidth_mm = 300\nheight_mm = 200\n'
    )
    opened, included = open_scene(tmp_path / "plan.svg"), open_scene(tmp_path / "my.scene")
    assert not any(isinstance(one, Use) for one in each(*opened.resolved.elements))
    assert included.warnings == opened.warnings


def test_each_hue_has_a_texture_of_the_bank():
    assert {name.removeprefix("stock:") for name in BY_HUE.values()} <= set(stock_textures())


@pytest.mark.parametrize(
    ("head", "size", "corner"),
    [
        ('width="10cm" height="50mm"', (100, 50), (25.4, 25.4)),
        ('width="192" height="96px" viewBox="0 0 2 1"', (50.8, 25.4), None),
        ('viewBox="0 0 960 480"', (254, 127), (25.4, 25.4)),
        ('width="100%" height="100%" viewBox="10 20 960 480"', (254, 127), (22.7542, 20.1083)),
        ('width="50.8mm" viewBox="0 0 192 96"', (50.8, 25.4), (25.4, 25.4)),
        ('width="2in" height="3in" viewBox="0 0 192 96"', (50.8, 76.2), (25.4, 50.8)),
        ('width="72pt" height="6pc"', (25.4, 25.4), (25.4, 25.4)),
    ],
)
def test_units_and_viewbox_give_millimetres(read, head, size, corner):
    found = read('<circle cx="96" cy="96" r="48"/>', head)
    canvas = found.scene.canvas
    assert (canvas.width_mm, canvas.height_mm) == pytest.approx(size, abs=1e-3)
    if corner is not None:
        circle = element_of(found)
        assert circle.center_mm == pytest.approx(corner, abs=1e-3)
        assert circle.radius_mm == pytest.approx(12.7, abs=1e-3)


@pytest.mark.parametrize(
    ("head", "said"),
    [
        ("", "has no size"),
        ('width="0" height="5"', "has no size"),
        ('width="nan" height="nan"', "has no size"),
        ('viewBox="0 0 0 0"', "has no size"),
        ('width="20m" height="5"', "has no size"),
        ('width="20000mm" height="5mm"', "cannot be a canvas: its width is 20000 mm"),
    ],
)
def test_drawings_without_a_size_that_can_be_are_refused(read, head, said):
    with pytest.raises(InputError, match=said):
        read("<g/>", head)


SHAPES = {
    '<path d="M0 0h10v10z" stroke="#000" fill="none"/>': Lines(
        contours_mm=(((0, 0), (10, 0), (10, 10)),), closed=True, stroke=Stroke(width_mm=2)
    ),
    '<line x1="1" y1="2" x2="3" y2="4" stroke="black" stroke-width="5"/>': StraightLine(
        start_mm=(1, 2), end_mm=(3, 4), stroke=Stroke(width_mm=5)
    ),
    '<polygon points="1,2 3 4,5,0" fill="white"/>': Polygon(
        vertices_mm=((1, 2), (3, 4), (5, 0)), fill=Fill(texture=Uniform(level=0))
    ),
    '<rect x="1" y="2" width="10%" height="4" fill="red"/>': Polygon(
        vertices_mm=((1, 2), (11, 2), (11, 6), (1, 6)),
        fill=Fill(texture=Use(name="stock:vibration")),
    ),
    '<ellipse cx="9" cy="9" rx="5" ry="5" fill="#ff0"/>': Circle(
        center_mm=(9, 9), radius_mm=5, fill=Fill(texture=Use(name="stock:linear-45"))
    ),
    '<g transform="translate(5 5) rotate(90) scale(2)"><circle r="3" fill="purple"/></g>': Circle(
        center_mm=(5, 5), radius_mm=6, fill=Fill(texture=Use(name="stock:grid"))
    ),
    '<circle r="5" fill="black" opacity="50%" id="sun"><title> The\n sun </title></circle>': Circle(
        id="sun", title="The sun", amplitude=0.5,
        center_mm=(0, 0), radius_mm=5, fill=Fill(texture=Use(name="stock:linear-0")),
    ),
    '<g opacity=".5"><circle r="5" fill-opacity=".5" fill="rgb(9,0,0)" opacity=".5"/></g>': Circle(
        amplitude=0.25,
        center_mm=(0, 0), radius_mm=5,
        fill=Fill(texture=Use(name="stock:linear-0", amplitude=0.495)),
    ),
    '<text x="20" y="30">A <tspan font-weight="bold">b</tspan>\n c</text>': Label(
        text="A b c", place_mm=(20, 21)
    ),
    '<text x="50" y="30" text-anchor="end" transform="rotate(-90 50 30)">ab</text>': Label(
        text="ab", place_mm=(41, 52.2), angle_deg=-90
    ),
    '<defs><path id="way" d="M30 40 L60 40"/></defs>'
    '<text><textPath href="#way">along</textPath></text>': Label(
        text="along", place_mm=(30, 31)
    ),
    '<style>.a{fill:blue} circle.a{fill:red} #b{fill:green} /* {} */ circle{fill:yellow}</style>'
    '<circle class="c a" fill="white" r="5"/>': Circle(
        center_mm=(0, 0), radius_mm=5, fill=Fill(texture=Use(name="stock:vibration"))
    ),
}  # fmt: skip


@pytest.mark.parametrize("text", SHAPES)
def test_shapes(read, text):
    assert element_of(read(text)) == SHAPES[text]


@pytest.mark.parametrize(
    "text",
    [
        '<g display="none"><circle r="5"/></g>',
        '<circle r="5" style="display:none"/>',
        '<g visibility="hidden"><circle r="5"/></g>',
        '<circle r="5" opacity="0"/>',
        '<circle r="5" fill="none"/>',
        '<circle r="5" fill="none" stroke="red" stroke-width="0"/>',
        '<line x1="1" y1="1" x2="9" y2="9"/>',
        '<defs><circle r="5"/></defs><symbol><circle r="5"/></symbol>',
        '<clipPath id="a"><circle r="5"/></clipPath><text x="5"> </text>',
        '<metadata><rdf:RDF xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#"/></metadata>',
    ],
)
def test_what_is_not_seen_is_not_felt(read, text):
    found = read(text)
    assert found.scene.elements == ()
    assert found.warnings == ()


def test_a_fill_that_is_not_closed_has_a_stroke_that_is_not(read):
    fill, stroke = read('<path d="M0 0H9V9" stroke="red" stroke-width="2"/>').scene.elements
    assert (fill.closed, fill.stroke, stroke.closed, stroke.fill) == (True, None, False, None)
    assert fill.contours_mm == stroke.contours_mm


@given(st.data())
@examples(60)
def test_damaged_drawings_are_read_or_refused_in_one_sentence(tmp_path_factory, data):
    whole = (FILES / "inkscape.svg").read_bytes()
    at = data.draw(st.integers(0, len(whole) - 1))
    to = data.draw(st.integers(at, min(at + 30, len(whole))))
    put = data.draw(st.sampled_from([b"", b"9", b"-1e308", b"<g>", b'"', b"&x;", b"nan", b"{"]))
    path = tmp_path_factory.mktemp("svg") / "damaged.svg"
    path.write_bytes(whole[:at] + put + whole[to:])
    try:
        found = [repr(one) for one in each(*read_svg(path).scene.elements)]
    except InputError as error:
        found = []
        said = str(error)
    else:
        said = ""
    assert "\n" not in said
    assert len(found) < 30
    assert not any(re.search(r"[=(, ]-?(nan|inf)[,)]", one) for one in found)


def test_scenes_in_the_documentation_are_scenes():
    page = Path(__file__).parents[3] / "docs" / "drawings.md"
    texts = re.findall(r"```toml\n(.*?)```", page.read_text("utf-8"), re.DOTALL)
    assert len(texts) == 4
    for text in texts:
        assert TomlFile(text, page.name).read(SceneFile)


def test_the_table_of_colours_in_the_documentation_is_the_one_that_counts():
    page = (Path(__file__).parents[3] / "docs" / "drawings.md").read_text("utf-8")
    rows = dict(re.findall(r"^\| ([\w, ]+) \| `(stock:[\w-]+)`", page, re.MULTILINE))
    told = {hue: texture for hues, texture in rows.items() for hue in hues.split(", ")}
    for word, texture in told.items():
        assert BY_HUE[hue_of(color_of(word))] == texture, word
