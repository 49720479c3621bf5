"""Outlines of drawings against those that resvg, an independent renderer, fills."""

import io

import numpy as np
import pytest
import resvg_py
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from tests.tiers import examples
from vbraille.scene.patterns import Circle
from vbraille.scene.svg.drawing import read_svg
from vbraille.scene.traversal import each

SIZE = 100  # mm, and pixels, of a drawing
number = st.integers(-40, 40).map(lambda tenth: tenth / 2)
transforms = st.sampled_from(
    ["", "translate(12 -5)", "rotate(33)", "rotate(-70 30 20)", "scale(1.5 .7)", "skewX(25)",
     "skewY(-20)", "matrix(.9 .3 -.4 1.1 5 8)", "scale(-1 1) translate(-90)"]
)  # fmt: skip
commands = st.one_of(
    st.tuples(st.sampled_from("lLtTmM"), number, number),
    st.tuples(st.sampled_from("hHvV"), number),
    st.tuples(st.sampled_from("cC"), *(number,) * 6),
    st.tuples(st.sampled_from("sSqQ"), *(number,) * 4),
    # An arc to where it begins is left out, says SVG; resvg draws a little of it.
    st.tuples(
        st.just("a"), number.map(abs), number.map(abs), number,
        st.integers(0, 1), st.integers(0, 1), number.filter(bool), number,
    ),
    st.just(("z",)),
).map(lambda parts: parts[0] + " ".join(map(str, parts[1:])))  # fmt: skip
paths = st.lists(commands, min_size=1, max_size=6).map(
    lambda parts: f'<path fill-rule="evenodd" d="M10 10{"".join(parts)}"/>'
)
corners = st.lists(number, min_size=6, max_size=12).map(lambda of: of[: len(of) // 2 * 2])
shapes = st.one_of(
    paths,
    st.builds(
        '<rect x="{}" y="2" width="30" height="{}" rx="{}" ry="5"/>'.format, number, number, number
    ),
    st.builds('<ellipse cx="{}" cy="{}" rx="{}" ry="11"/>'.format, number, number, number),
    st.builds('<circle cx="{}" cy="{}" r="15"/>'.format, number, number),
    corners.map(lambda c: f'<polygon fill-rule="evenodd" points="{" ".join(map(str, c))}"/>'),
    st.sampled_from(["", "xMinYMax slice", "none", "xMaxYMin"]).map(
        lambda how: '<symbol id="s" viewBox="0 0 20 10" overflow="visible" preserveAspectRatio="'
        f'{how}"><path d="M1 1h18v8l-9-9z" fill-rule="evenodd"/></symbol>'
        '<use href="#s" x="3" y="4" width="30" height="40"/>'
    ),
)  # fmt: skip


def drawn(text):
    """Opacity of each pixel of a drawing."""
    png = resvg_py.svg_to_bytes(
        svg_string=text, width=SIZE, height=SIZE, dpi=96, skip_system_fonts=True
    )
    return np.asarray(Image.open(io.BytesIO(bytes(png))).convert("RGBA"))[..., 3]


@given(shape=shapes, outer=transforms, inner=transforms)
@examples(150)
def test_outlines_are_those_of_an_independent_renderer(tmp_path_factory, shape, outer, inner):
    text = (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{SIZE}mm" height="{SIZE}mm" '
        f'viewBox="-30 -30 {SIZE} {SIZE}"><g transform="{outer}"><g transform="{inner}">'
        f"{shape}</g></g></svg>"
    )
    path = tmp_path_factory.getbasetemp() / "oracle.svg"
    path.write_text(text)
    alpha = drawn(text)
    y, x = np.mgrid[:SIZE, :SIZE] + 0.5
    inside = np.zeros((SIZE, SIZE), bool)
    for one in each(*read_svg(path).scene.elements):
        if isinstance(one, Circle):
            inside |= np.hypot(x - one.center_mm[0], y - one.center_mm[1]) < one.radius_mm
        for points in getattr(one, "contours_mm", ()) or (getattr(one, "vertices_mm", ()),):
            inside ^= _inside(points, x, y)
    # Pixels that an edge goes through may be either, and so may parts that are thinner than one.
    wrong = (_all_around(inside) & (alpha == 0)) | (_all_around(~inside) & (alpha == 255))
    assert wrong.sum() <= 2


def _all_around(flags):
    """Whether all nine pixels around each are set."""
    padded = np.pad(flags, 1)
    return np.all([padded[y : y + SIZE, x : x + SIZE] for y in range(3) for x in range(3)], axis=0)


def _inside(points, x, y):
    """Whether places are inside a contour, by the even-odd rule."""
    inside = np.zeros(x.shape, bool)
    for (x0, y0), (x1, y1) in zip(points, (*points[1:], *points[:1]), strict=True):
        if y0 != y1:
            inside ^= ((y0 > y) != (y1 > y)) & (x < x0 + (y - y0) * (x1 - x0) / (y1 - y0))
    return inside


@pytest.mark.parametrize("rule", ["nonzero", "evenodd"])
def test_holes_are_those_of_an_independent_renderer(tmp_path, rule):
    rings = ["M10 10H90V90H10z", "M20 20H80V80H20z", "M30 30V70H70V30z", "M40 40H60V60H40z"]
    text = (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{SIZE}mm" height="{SIZE}mm" '
        f'viewBox="0 0 {SIZE} {SIZE}"><path fill-rule="{rule}" d="{" ".join(rings)}"/></svg>'
    )
    (tmp_path / "a.svg").write_text(text)
    (shape,) = read_svg(tmp_path / "a.svg").scene.elements
    alpha = drawn(text)
    y, x = np.mgrid[:SIZE, :SIZE] + 0.5
    inside = np.zeros((SIZE, SIZE), bool)
    for points in shape.contours_mm:
        inside ^= _inside(points, x, y)
    np.testing.assert_array_equal(inside, alpha > 0)
