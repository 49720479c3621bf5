"""The text of all blocks is the text that another parser, html5lib, finds in the same markup."""

import re

import html5lib
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.tiers import examples
from tests.translate.documents.markup.reading import passages
from vbraille.translate.source import BlockKind

FRAGMENTS = [
    "a",
    "<p>a<p>b",
    "<p>a<b>b<p>c</b>d",
    "<b><p>a</b>b</p>c",
    "<b><i>a</b>b</i>c",
    "<ul><li>a<li>b<ul><li>c</ul><li>d</ul>e",
    "<li>a<li>b",
    "<dl><dt>a<dd>b<dt>c<p>d</dl>e",
    "<table><tr><td>a<td>b<tr><td>c</table>d",
    "<table><td>a<table><tr><td>b</table>c</table>d",
    "<table><tbody><tr><th>a<td>b</tbody><tfoot><tr><td>c</table>",
    "<table><caption>a<tr><td>b",
    "<div>a<span>b</div>c</span>d",
    "<p>a<div>b</p>c</div>d",
    "a<br>b<br/>c",
    "a&amp;b&nbsp;c&notin;d&#65;e&#x41;f&bogus;g&ampx;",
    "a<!-- b -->c<!b>d<?e?>f<!-->g",
    "a</b>c</p>d",
    "<a href=1>a<a href=2>b</a>c",
    "<h1>a<h2>b</h1>c</h2>d",
    "<button>a<p>b</button>c",
    "<form>a<form>b</form>c",
    "<nobr>a<nobr>b",
    "<p>a<pre>b\nc</pre>d",
    "<pre>\na\n\n  b</pre>",
    "a<plaintext>b<c>",
    "a<xmp>b<c></xmp>d",
    "a<textarea>b<c></textarea>d",
    "<select><option>a<option>b</select>c",
    "<ruby>a<rt>b</ruby>c",
    "<fieldset><legend>a</legend>b</fieldset>c",
    "<details><summary>a</summary>b</details>",
    "<em>a<em>b</em>c</em>d",
    "a<unknown>b</unknown>c<x-y>d",
    "<svg><foreignObject><p>a</p></foreignObject></svg>b",
    "a<style>b</style>c<script>d</script>e",
    "<body>a</body>b<body>c</html>d",
    "<html><head><title>a</title><meta><body>b",
    "a<b",
    "a < b > c",
    "a<>b</>c",
    '<p title="a>b">c',
    "<p title=a>b<p title='c",
    "a\x00b",
    "\ufeffa\u200bb\u00adc",
]
# What is not text, or stands for something, or is added by a reader of markup.
_NO_TEXT = frozenset(("script", "style", "template", "noscript", "title", "svg", "math", "iframe"))
_MARKERS = re.compile(r"^(?:(?:•|\d+\.) )+")
_REMARKS = re.compile(r"\[(?:form field|drawing|picture)\]")


def text_of_tree(markup):
    """Text of all elements that are shown, without white space."""
    found = []

    def walk(element):
        name = element.tag if isinstance(element.tag, str) else "!"
        if name not in _NO_TEXT and not name.startswith("!"):
            found.append(element.text or "")
            for child in element:
                walk(child)
                found.append(child.tail or "")
        elif name == "svg":
            found.extend("".join(p.itertext()) for p in element.iter("p"))

    walk(html5lib.parse(markup, namespaceHTMLElements=False))
    return squeezed("".join(found))


def text_of_blocks(markup):
    texts = []
    for passage in passages(markup):
        text = passage.text
        if passage.kind is BlockKind.ITEM:
            text = _MARKERS.sub("", text)
        texts.append(_REMARKS.sub("", text).replace("a(b)", "ab"))
    return squeezed("".join(texts))


def squeezed(text):
    return "".join(text.translate(dict.fromkeys((0, 0xFFFD, 0xAD, 0x200B, 0xFEFF))).split())


@pytest.mark.parametrize("markup", FRAGMENTS)
def test_no_text_is_lost_or_doubled(markup):
    found = text_of_blocks(markup)
    assert found == text_of_tree(markup)
    assert found


_TAGS = "p div b i span a h1 ul li ol dl dt dd blockquote pre em section u".split()  # noqa: SIM905
_PIECES = st.one_of(
    st.sampled_from(_TAGS).map("<{}>".format),
    st.sampled_from(_TAGS).map("</{}>".format),
    st.sampled_from(["x", "y z", " ", "&amp;", "é", "<br>", "<!-- c -->"]),
)


@examples(200)
@given(st.lists(_PIECES, max_size=30))
def test_no_text_is_lost_in_any_soup(pieces):
    markup = "".join(pieces)
    assert sorted(text_of_blocks(markup)) == sorted(text_of_tree(markup))
