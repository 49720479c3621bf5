"""Markup into passages: roles, order, marks, and what is left out."""

import pytest

from tests.translate.documents.markup.reading import marked, outline, passages
from vbraille.translate.source import BlockKind

ROLES = {
    "<h1>A</h1><h6>B</h6><div role=heading aria-level=3>C</div><p>d": [
        ("heading1", "A"),
        ("heading6", "B"),
        ("heading3", "C"),
        ("paragraph", "d"),
    ],
    "<p> a\n\tb <b> c</b>d &nbsp;e \u00adf<p>": [("paragraph", "a b cd \u00a0e f")],
    "<p>so<br>it<br/><br>goes": [("paragraph", "so"), ("line", "it"), ("paragraph", "goes")],
    "<h2>a<br>b</h2>": [("heading2", "a b")],
    "<ul><li>a<ol start=3><li>b<li value=9>c<p>d</ol>e<li>f</ul>": [
        ("item1", "• a"),
        ("item2", "3. b"),
        ("item2", "9. c"),
        ("paragraph", "d"),
        ("paragraph", "e"),
        ("item1", "• f"),
    ],
    "<ol type=A><li>a</ol><ol style='list-style-type: lower-roman'><li>b<li>c</ol>": [
        ("item1", "A. a"),
        ("item1", "i. b"),
        ("item1", "ii. c"),
    ],
    "<ol reversed start=2><li>a<li>b</ol><ul style='list-style:none'><li>c</ul>": [
        ("item1", "2. a"),
        ("item1", "1. b"),
        ("item1", "c"),
    ],
    "<ol><li><ul><li>a</ul><li><h3>b</h3><li></ol><p>c": [
        ("item2", "1. • a"),
        ("heading3", "2. b"),
        ("paragraph", "c"),
    ],
    "<dl><dt>t<dd>d<dd>e</dl>": [("item1", "t"), ("item2", "d"), ("item2", "e")],
    "<dl><dt>t<dd><p>a<p>b<dd><ul><li>c</ul></dl>": [
        ("item1", "t"),
        ("item2", "a"),
        ("paragraph", "b"),
        ("item2", "• c"),
    ],
    "<ol><li><table><tr><td>a<td>b</table><li>c</ol>": [
        ("item1", "1."),
        ("row", "a  b"),
        ("item1", "2. c"),
    ],
    "<table><tr><td><ul><li>a<li>b</ul><td>c<p>d</table>": [("row", "a b  c d")],
    "<pre>a<br>b</pre>": [("line", "a"), ("line", "b")],
    "<blockquote>a<p>b<blockquote>c</blockquote></blockquote>d": [
        ("quote1", "a"),
        ("quote1", "b"),
        ("quote2", "c"),
        ("paragraph", "d"),
    ],
    "a<pre>\n  x\n\n\n\ty z\n</pre>b": [
        ("paragraph", "a"),
        ("line", "  x"),
        ("line", ""),
        ("line", "        y z"),
        ("paragraph", "b"),
    ],
    "<hr>a<hr><hr><p>b<hr><h2>c</h2><hr>": [
        ("paragraph", "a"),
        ("paragraph", "* * *"),
        ("paragraph", "b"),
        ("heading2", "c"),
    ],
    "<table><tr><td>a<table><tr><td>b<td>c</table>d<td>e</table>": [
        ("row", "a"),
        ("row", "b  c"),
        ("paragraph", "d"),
        ("paragraph", "e"),
    ],
    "<table role=presentation><tr><td>a<td>b</table>": [("paragraph", "a"), ("paragraph", "b")],
    "a<script>x</script><style>x</style><template>x</template><noscript>x</noscript>b": [
        ("paragraph", "ab")
    ],
    "<p hidden>a<p aria-hidden=true>b<p style='color:red; display: none'>c<p>d": [
        ("paragraph", "d")
    ],
    "<body hidden><p>a": [("paragraph", "a")],
    "<ruby>漢<rp>(</rp><rt>kan</rt><rp>)</rp></ruby>": [("paragraph", "漢(kan)")],
    "<q>a</q>": [("paragraph", "“a”")],
    "<head><title>a</title></head>b": [("paragraph", "b")],
    "<iframe>a</iframe>b": [("paragraph", "[embedded page] b")],
    "x<svg><text>y</text><p>z</p></svg>": [
        ("paragraph", "x"),
        ("paragraph", "z"),
        ("paragraph", "[drawing]"),
    ],
}


@pytest.mark.parametrize("markup", ROLES)
def test_roles(markup):
    assert outline(markup) == ROLES[markup]


@pytest.mark.parametrize(
    ("markup", "text", "marks"),
    [
        ("a <em>b <i>c</i></em> d", "a b c d", [("italic", "b c", "")]),
        ("<b>a<u>b</u></b>c", "abc", [("bold", "ab", ""), ("underline", "b", "")]),
        (
            "H<sub>2</sub>O<sup>x</sup><code>y</code>",
            "H₂Oxy",
            [("subscript", "₂", ""), ("superscript", "x", ""), ("code", "y", "")],
        ),
        ("<span style='font-style: italic'>a</span>b", "ab", [("italic", "a", "")]),
        ("a<a href='#b%20c'> d </a>e", "a d e", [("link", "d", "#b%20c")]),
        ("a<a href='javascript:x()'>d</a>", "ad", []),
        ("a<sup><a epub:type=noteref href=#n>1</a></sup>", "a[1]", None),
        ("a<sup class=footnote-ref><a href=#n>1</a></sup>", "a[1]", None),
        ("9<span class='calibre3 super'>2</span>", "9²", [("superscript", "²", "")]),
        ("<p class=sub>12", "12", []),
        ("a[<a role=doc-noteref href=#n>1</a>]", "a[1]", [("note", "1", "#n")]),
        ("a<a role=doc-noteref href=#n>*</a>", "a*", [("note", "*", "#n")]),
        ("a <a role=doc-noteref href=#n>1 </a> b", "a [1] b", [("note", "[1]", "#n")]),
        (
            "9<sup>2<a role=doc-noteref href=#n>1</a>, <a role=doc-noteref href=#m>2</a></sup>",
            "9²[1], [2]",
            [("superscript", "²", ""), ("note", "[1]", "#n"), ("note", "[2]", "#m")],
        ),
        ("a <img alt='b'> c", "a b c", [("image", "b", "")]),
        ("a<img src=x>", "a [picture]", [("unshown", "[picture]", "picture")]),
        ("a<img alt=''>", "a", []),
        ("<math alttext='x^2'><mi>x</mi></math>", "x^2", []),
        ("<math><mi>x</mi><mo>=</mo><mn>1</mn></math>", "x=1", []),
        (
            "<math><semantics><mfrac><mi>a</mi><mi>b</mi></mfrac><annotation>\\frac</annotation>",
            "\\frac",
            [],
        ),
        (
            "<math><mfrac><mi>a</mi><mi>b</mi></mfrac></math>",
            "[formula]",
            [("unshown", "[formula]", "formula")],
        ),
        ("<svg><title>T</title><path/></svg>", "T", [("image", "T", "")]),
        ("<svg><g><title>T</title></g></svg>", "[drawing]", [("unshown", "[drawing]", "drawing")]),
        ("<canvas></canvas>", "[drawing]", [("unshown", "[drawing]", "drawing")]),
        ("<audio title='a b'></audio>", "[sound: a b]", [("unshown", "[sound: a b]", "sound")]),
        ("<video>c</video>", "[film] c", [("unshown", "[film]", "film")]),
        ("<object></object>", None, [("unshown", "[embedded object]", "object")]),
        ("<input type=hidden>a<input aria-label=b>", "a [form field: b]", None),
        ("<span role=img aria-label=star>*</span>", "star", [("image", "star", "")]),
    ],
)
def test_marks(markup, text, marks):
    (passage,) = passages(markup)
    assert text in (None, passage.text)
    if marks is None:
        kind, target = (("note", "#n"), ("unshown", "form"))["input" in markup]
        assert (kind, target) in [(mark.kind.value, mark.target) for mark in passage.marks]
    else:
        assert marked(passage) == marks


def test_emphasis_goes_on_in_the_next_block():
    found = passages("<div><b>a<div>b</div>c</b>d")
    assert [passage.text for passage in found] == ["a", "b", "cd"]
    assert [marked(passage) for passage in found] == [[("bold", c, "")] for c in "abc"]


def test_languages_of_blocks_and_of_their_parts():
    found = passages(
        "<html lang=en><p>a <i lang=fr>b</i> c<p lang=fr>d <span lang=en-GB>e</span> f"
        "<p><span lang=de>g</span><p lang=en-US>h",
    )
    assert [passage.language for passage in found] == ["", "fr", "de", ""]
    assert marked(found[0]) == [("italic", "b", ""), ("language", "b", "fr")]
    assert marked(found[1]) == [("language", "e", "en")]
    assert marked(found[2]) == marked(found[3]) == []


def test_a_source_that_says_no_language():
    first, second = passages("<p>a<p lang=fr>b")
    assert (first.language, second.language) == ("", "fr")


def test_rows_have_the_headers_of_their_cells():
    found = passages(
        "<table><caption>T</caption><tr><th>A<th colspan=2>B<tr><th><th>C<th>D"
        "<tr><td>1<td>2<td>3<tr><td>4<td><td>5<tr><td rowspan=2>6<td>7<td>8<tr><td>9<td>0</table>"
    )
    assert [(p.text, p.headers) for p in found] == [
        ("T", ()),
        ("A  B", ()),
        ("C  D", ()),
        ("1  2  3", ("A", "B C", "B D")),
        ("4  5", ("A", "B D")),
        ("6  7  8", ("A", "B C", "B D")),
        ("9  0", ("B C", "B D")),
    ]
    assert [p.kind for p in found[1:]] == [BlockKind.ROW] * 6
    assert {p.group for p in found} == {1}


def test_lists_and_tables_have_numbers():
    found = passages("<ul><li>a<ul><li>b</ul></ul><p>c<ol><li>d</ol><table><tr><td>e</table>")
    assert [p.group for p in found] == [1, 1, 0, 2, 3]


@pytest.mark.parametrize("mark", ["epub:type=pagebreak", "role=doc-pagebreak"])
def test_pages_begin_at_the_next_word(mark):
    markup = f"<p>a hy<span {mark} id=p4 title=4></span>phen b<span {mark}>5</span> c"
    found = passages(markup + f"<h1>d <i {mark} aria-label=' page 6. '></i> e</h1>", prefix="x#")
    assert [(p.kind.value, p.text) for p in found] == [
        ("paragraph", "a hyphen"),
        ("page", "4"),
        ("line", "b"),
        ("page", "5"),
        ("line", "c"),
        ("heading", "d e"),
        ("page", "6"),
    ]
    assert found[1].anchors == ("x#p4",)


@pytest.mark.parametrize(
    "notes",
    [
        "<aside epub:type=footnote id=n><p>b <a href=#r>↩︎</a></p></aside>",
        "<aside role=doc-footnote id=n hidden><p>b <a href=#r role=doc-backlink>up</a></aside>",
        "<section epub:type=endnotes><div epub:type=endnote id=n>b</div></section>",
        "<section class=footnotes><hr><ol style='list-style:none'><li id=n><p>b "
        "<a class=footnote-back href=#r>x</a></ol></section>",
    ],
)
def test_notes(notes):
    text, note = passages(f"<p>a<a epub:type=noteref href=#n>1</a>{notes}")
    assert marked(text) == [("note", "[1]", "#n")]
    assert (note.kind, note.text, note.anchors) == (BlockKind.NOTE, "b", ("n",))


def test_a_picture_and_its_caption_are_said_once():
    figures = "<figure><img alt='A {0}'><figcaption aria-hidden=true><p>A <b>{1}</b></figure>"
    assert outline(figures.format("cat", "cat")) == [("paragraph", "A cat")]
    assert outline(figures.format("cat", "dog")) == [("paragraph", "A cat"), ("paragraph", "A dog")]
    after = "<figure><figcaption>A cat</figcaption><img alt='A cat'></figure>"
    assert outline(after) == [("paragraph", "A cat")]
    assert outline("<p>A <img alt='cat'> and a <img alt='cat'>") == [
        ("paragraph", "A cat and a cat")
    ]


def test_anchors_lead_to_their_block_or_the_next():
    first, second = passages("<a id=a></a><h1 id=b>c</h1><div id=d></div><p>e<a name=f></a>g")
    assert first.anchors == ("a", "b")
    assert second.anchors == ("d", "f")
    (only,) = passages("<p>a</p><span id=end></span>", anchors=("start",))
    assert only.anchors == ("start", "end")


def test_a_very_long_block_goes_on_in_pieces():
    words = "<b>word</b> " * 30_000
    found = passages(f"<p>{words}<p>end")
    assert [p.continues for p in found] == [False, True, True, False]
    assert "".join(p.text for p in found[:-1]) == ("word " * 30_000).rstrip()
    assert all(p.text[mark.start : mark.end] == "word" for p in found for mark in p.marks)
    assert sum(len(p.marks) for p in found) == 30_000
    assert "".join(p.text for p in passages("x" * 1_000_000)) == "x" * 1_000_000


def test_xml_with_its_own_names():
    markup = (
        '<x:html xmlns:x="http://www.w3.org/1999/xhtml" xml:lang="fr"><x:p>a'
        "<x:br/>b<![CDATA[<c>]]></x:p><x:script/><x:title/>d</x:html>"
    )
    assert outline(markup, xml=True) == [("paragraph", "a"), ("line", "b<c>"), ("paragraph", "d")]
