"""Drawings as the standards of SVG and CSS have them: places, strokes and colours."""

import pyclipper
import pytest

from tests.scene.svg.plans import warned
from vbraille.scene.patterns import Circle, Label, Polygon
from vbraille.scene.traversal import each

HEAD = 'width="100mm" height="80mm" viewBox="0 0 100 80"'
LINE = 'fill="none" stroke="black" stroke-width="3"'


def box(pattern):
    """Left, top, right and bottom of a shape, without its stroke."""
    if isinstance(pattern, Circle):
        (x, y), r = pattern.center_mm, pattern.radius_mm
        return x - r, y - r, x + r, y + r
    contours = getattr(pattern, "contours_mm", None) or (pattern.vertices_mm,)
    points = [point for contour in contours for point in contour]
    xs, ys = zip(*points, strict=True)
    return min(xs), min(ys), max(xs), max(ys)


PLACES = {
    '<rect width="20" height="10" style="transform: translate(30px, 30px) rotate(90deg)"/>': (
        20, 30, 30, 50),
    f'<rect x="40" y="30" width="20" height="10" {LINE} transform="matrix(0 1 -1 0 0 0)" '
    'style="transform-box: fill-box; transform-origin: 50% 50%"/>': (45, 25, 55, 45),
    '<rect x="40" y="20" width="20" height="20" transform="rotate(90)" '
    'transform-origin="50 30"/>': (40, 20, 60, 40),
    '<rect width="10" height="10" transform="rotate(180)" transform-origin="bottom right"/>': (
        190, 150, 200, 160),
    '<g font-size="4"><rect x="1em" y="1em" width="10em" height="5em"/></g>': (4, 4, 44, 24),
    '<g font-size="4"><g font-size="2em"><rect width="1em" height="1em"/></g></g>': (0, 0, 8, 8),
    '<g style="font: italic 700 4px/2 serif"><rect width="10em" height="5em"/></g>': (0, 0, 40, 20),
    '<rect x="calc(50% - 5px)" width="10" height="min(10%, 3px)"/>': (45, 0, 55, 3),
    '<rect x="50%" y="50%" width="calc(2 * (1px + 4px))" height="10"/>': (50, 40, 60, 50),
    '<style>rect{width:30px}</style><rect width="10" height="10"/>': (0, 0, 30, 10),
    '<svg x="10" y="10" width="20" height="20"><rect width="80" height="45"/></svg>': (
        10, 10, 30, 30),
    '<clipPath id="c"><rect x="5" y="5" width="10" height="10"/></clipPath>'
    '<g clip-path="url(#c)"><rect width="40" height="40"/></g>': (5, 5, 15, 15),
    '<clipPath id="c" clipPathUnits="objectBoundingBox"><rect width=".5" height=".5"/></clipPath>'
    '<rect x="10" width="40" height="40" clip-path="url(#c)"/>': (10, 0, 30, 20),
    '<symbol id="s" viewBox="0 0 10 10"><circle cx="10" cy="5" r="5"/></symbol>'
    '<use href="#s" x="50%" y="40" width="20" height="20"/>': (60, 40, 70, 60),
    '<marker id="m" markerWidth="4" markerHeight="4" refX="2" refY="2" '
    'markerUnits="userSpaceOnUse">'
    '<rect width="4" height="4"/></marker>'
    '<path d="M20 20H30" marker-end="url(#m)"/>': (28, 18, 32, 22),
    '<marker id="m" orient="auto" overflow="visible"><rect width="5" height="1"/></marker>'
    '<path d="M20 20V30" stroke-width="2" marker-end="url(#m)"/>': (18, 30, 20, 40),
    '<path d="M0 0H9V9H5 bad 3"/>': (0, 0, 9, 9),
    '<polygon points="0,0 10,0 10,10 x 50,50"/>': (0, 0, 10, 10),
    '<switch><g systemLanguage="xx"><circle r="9"/></g><rect width="5" height="5"/></switch>': (
        0, 0, 5, 5),
}  # fmt: skip


@pytest.mark.parametrize("text", PLACES)
def test_shapes_stand_where_the_standard_has_them(read, text):
    elements = read(text, HEAD).scene.elements
    assert box(elements[-1]) == pytest.approx(PLACES[text], abs=0.06)


# Widths of strokes in mm, and whether a shape is drawn at all.
STROKES = {
    '<path d="M10 10H90" style="fill:none;stroke:black;stroke-width:4%"/>': 3.622,
    f'<g transform="scale(10)"><path d="M1 1H4" {LINE} vector-effect="non-scaling-stroke"/></g>': 3,
    '<path d="M10 20H90" style="fill:none;stroke:black;stroke-width:.5em;font-size:8px"/>': 4,
    '<path d="M0 0H9" fill="none" stroke="black" stroke-width="calc(1px + 2px)"/>': 3,
    '<style media="print">path{stroke:none}</style>'
    '<style media="screen">path{stroke-width:6}</style>'
    f'<path d="M0 0H9" {LINE}/>': 6,
    '<style>@media screen{path{stroke-width:5}}</style>' f'<path d="M0 0H9" {LINE}/>': 5,
    '<style>g > path{stroke-width:7}</style>' f'<g><path d="M0 0H9" {LINE}/></g>': 7,
    '<style>.q{stroke-width:8 !important}</style>'
    f'<path class="q" d="M0 0H9" {LINE} style="stroke-width:4"/>': 8,
}  # fmt: skip


@pytest.mark.parametrize("text", STROKES)
def test_strokes_are_as_wide_as_the_cascade_has_them(read, text):
    (line,) = read(text, HEAD).scene.elements
    assert line.stroke.width_mm == pytest.approx(STROKES[text], abs=1e-3)


@pytest.mark.parametrize(
    ("paint", "amplitude"),
    [
        ("rgba(0,0,0,0)", None),
        ("#00000000", None),
        ("#0000", None),
        ("transparent", None),
        ("rgba(0,128,0,0.25)", 0.25),
        ("hsl(120deg 100% 25% / 50%)", 0.5),
        ("light-dark(red, white)", 1.0),
        ("url(#none)", None),
        ("url(#none) red", 1.0),
        ("#ff0000 icc-color(a)", 1.0),
    ],
)
def test_colours_and_their_alpha(read, paint, amplitude):
    elements = read(f'<circle r="5" fill="{paint}"/>', HEAD).scene.elements
    found = [one.fill.texture.amplitude for one in elements]
    assert found == ([] if amplitude is None else [amplitude])


def test_a_value_that_is_not_understood_falls_through_the_cascade(read):
    found = read(
        '<rect width="9" height="9" fill="none" stroke="black" stroke-width="3" '
        'style="fill: var(--b); stroke: color-mix(in srgb, red, blue)"/>',
        HEAD,
    )
    (shape,) = found.scene.elements
    assert shape.fill is None
    assert shape.stroke.amplitude == 1.0
    assert len(warned(found)) == 2


def test_areas_that_overlap_in_one_path_are_one(read):
    wedges = "M50 30L90 10V50Z M50 30L90 55H10Z M50 30L10 50V10Z M50 30L10 5H90Z"
    squares = "M10 10H50V40H10Z M30 20H80V50H30Z"
    for path, area in ((wedges, 800 + 1000 + 800 + 1000), (squares, 1200 + 1500 - 400)):
        (shape,) = read(f'<path d="{path}"/>', HEAD).scene.elements
        rings = [
            [(round(1000 * x), round(1000 * y)) for x, y in ring] for ring in shape.contours_mm
        ]
        assert sum(map(pyclipper.Area, rings)) / 1e6 == pytest.approx(area, rel=1e-3)


def test_a_veil_that_is_seen_through_hides_nothing(read):
    below, *veil = read(
        '<rect width="9" height="9" fill="blue"/>'
        '<rect width="50" height="50" fill="white" fill-opacity="0.5"/>',
        HEAD,
    ).scene.elements
    assert isinstance(below, Polygon)
    assert not veil


def test_opacity_of_what_is_used_counts(read):
    found = read(
        '<symbol id="s" opacity="0.2"><rect width="9" height="9"/></symbol><use href="#s"/>', HEAD
    )
    assert found.scene.elements[0].amplitude == 0.2


def test_a_label_is_centred_by_percent_anchor_and_baseline(read):
    (label,) = read(
        '<text x="50%" y="50%" text-anchor="middle" dominant-baseline="middle">Lake</text>', HEAD
    ).scene.elements
    assert isinstance(label, Label)
    assert label.place_mm == (50 - 2 * 11.1, 40 - 4.5)


def test_the_language_of_a_switch_is_the_systems(read, monkeypatch):
    text = (
        '<switch><text systemLanguage="fr">rue</text><text systemLanguage="de">Gasse</text>'
        "<text>street</text></switch>"
    )
    for lang, word in (("de_AT.UTF-8", "Gasse"), ("fr", "rue"), ("C.UTF-8", "street")):
        monkeypatch.setenv("LANG", lang)
        assert [one.text for one in each(*read(text, HEAD).scene.elements)] == [word]
