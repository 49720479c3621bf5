"""What a drawing has that cannot be felt is said; one that would fill the memory is refused."""

import pytest

from tests.scene.svg.plans import warned
from tests.tiers import heavy
from vbraille.errors import InputError

IGNORED = {
    "<script>alert(1)</script>": ["its script is never run"],
    '<circle r="5" onclick="alert(1)"/>': ["its script is never run"],
    '<image href="http://localhost/a.png"/>': [
        'it is ignored; put the picture into a scene file, as kind = "image"'
    ],
    '<use xlink:href="http://localhost/a.svg#b"/>': [
        "it uses 'http://localhost/a.svg#b', but nothing is fetched; ignored"
    ],
    '<use href="other.svg"/>': ["it uses 'other.svg', but nothing is fetched; ignored"],
    '<use href="#none"/>': ["it uses '#none', which is not there; ignored"],
    '<g id="a"><use href="#a"/></g>': ["it uses an element that it stands in; ignored"],
    "<style>@import url(http://localhost/a.css); @media print {g{fill:red}}</style>": [
        "the style sheet's @import url(http://localhost/a.css) is ignored",
    ],
    "<style>g::before::after(2) {fill:red}</style>": [
        "the style sheet's selector 'g::before::after(2)' is ignored"
    ],
    "<style>@media (min-width: 9px) {g{fill:red}}</style>": [
        "the style sheet's @media (min-width: 9px) is ignored"
    ],
    '<circle r="5" fill="url(http://localhost/a.svg#b)"/>': [
        "its fill is a gradient that is not there; it has none"
    ],
    '<circle r="5" filter="url(#f)" mask="url(#m)" clip-path="url(#c)"/>': [
        "its filter is ignored", "its mask is ignored", "its clip-path url(#c) is ignored",
    ],
    '<circle r="5"><animate attributeName="r" to="9"/></circle><animate/>': ["it is ignored"],
    "<foreignObject/>": ["it is ignored"],
    '<circle r="5" transform="spin(4)"/>': [
        "its transform is not understood; it is drawn without"
    ],
    '<path d="M0 0 L x"/>': [
        "its path is not understood from some place on; the rest is left out"
    ],
    '<circle r="1e9"/>': ["it goes farther than 10 m from the drawing's corner; it is left out"],
    '<rect width="-5" height="5"/>': ["it has no size, and is left out"],
    '<path d="M9 9z" stroke="#000" stroke-width="9"/>': ["it has no size, and is left out"],
    '<polygon points="5,5 9,9"/>': ["it has no size, and is left out"],
    '<g transform="scale(1e200)"><rect width="1e200" height="1"/></g>': [
        "it goes farther than 10 m from the drawing's corner; it is left out"
    ],
    '<polygon points="5,5 5,5"/>': ["it has no size, and is left out"],
    '<path d="M0 0H9" fill="none" stroke="red"/>': [
        "its line is drawn 2 mm wide, not to be missed"
    ],
    '<circle r="5" fill="currentcolour"/>': [
        "its fill 'currentcolour' is not understood; it is ignored"
    ],
    '<circle r="5" id="a"/><circle r="5" id="a"/>': [
        "another element has the same id, so it is left without"
    ],
}  # fmt: skip


@pytest.mark.parametrize("text", IGNORED)
def test_what_is_ignored_is_said(read, text):
    found = read(text)
    assert warned(found) == IGNORED[text]
    assert all(warning.startswith("line 2, ") for warning in found.warnings)


def test_the_same_of_many_elements_is_said_once_with_their_lines(read):
    found = read('<g filter="url(#f)"/>\n' * 9)
    assert found.warnings == (
        "line 2, g: its filter is ignored (and lines 3, 4, 5, 6, 7 and 3 more)",
    )


@heavy  # it takes two seconds to find out
def test_uses_that_multiply_are_refused_before_they_fill_the_memory(read):
    levels = "".join(
        f'<g id="a{n}">' + f'<use href="#a{n - 1}"/>' * 10 + "</g>" if n else '<g id="a0"/>'
        for n in range(10)
    )
    with pytest.raises(InputError, match="more than 50000 elements; use fewer"):
        read(f'<defs>{levels}</defs><use href="#a9"/>')


def test_what_would_take_for_ever_is_left_out_or_refused(read):
    places = [((n * 37) % 100, (n * 61) % 50) for n in range(4000)]
    tangle = "M" + " ".join(f"{x + n / 9000} {y}" for n, (x, y) in enumerate(places))
    left = read(f'<path d="{tangle}z" stroke="red" stroke-width="3"/>')
    assert warned(left) == [
        "it has too many places to find where it overlaps itself; it is filled by the even-odd rule"
    ]
    clip = f'<clipPath id="c"><path d="{tangle}z"/></clipPath><circle r="5" clip-path="url(#c)"/>'
    assert any("too many places or crossings" in one for one in warned(read(clip)))
    with pytest.raises(InputError, match="brackets nested too deep"):
        read(f"<style>{'@media all{' * 3000}</style>")


def test_elements_and_uses_that_nest_too_deep_are_refused(read):
    with pytest.raises(InputError, match="more than 100 deep; ungroup"):
        read("<g>" * 200 + "</g>" * 200)
    levels = "".join(f'<g id="a{n}"><use href="#a{n + 1}"/></g>' for n in range(300))
    with pytest.raises(InputError, match="deep; ungroup"):
        read(f'<defs>{levels}</defs><use href="#a0"/>')


@heavy  # as many places take some seconds
def test_half_a_million_places_are_refused(read):
    d = "M0 0" + "".join(f"a9 9 0 0 {n % 2} {9000 * (-1) ** n} 9" for n in range(60))
    path = f'<path id="p" stroke="red" fill="none" d="{d}"/>'
    with pytest.raises(InputError, match="more than 500000 places"):
        read(f"<defs>{path}</defs>" + '<use href="#p"/>' * 30)
