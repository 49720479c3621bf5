"""Markup as blocks: HTML, DTBook, and what Markdown is made into."""

import pytest

from tests.translate.reading import blocks, opened, said
from vbraille.translate import BlockKind, MarkKind

EMPTY = "⠐⠐⠐"


def marks(block):
    """Kind, text and target of each mark."""
    return [(m.kind.value, block.text[m.start : m.end], m.target) for m in block.marks]


@pytest.mark.parametrize(
    ("markup", "wanted"),
    [
        ("<h2>One</h2><p>two\n  three", ["heading One", "paragraph two three"]),
        ("<p>one<br>two", ["paragraph one", "line two"]),
        ("<pre>\na  b\n c\fd</pre>", ["line a  b", "line  c d"]),
        ("<blockquote>one<p>two</blockquote>", ["quote one", "quote two"]),
        ("<ul><li>a<ol><li>b<li>c</ol><li>d</ul>", ["item • a", "item 1. b", "item 2. c", "item • d"]),
        ("<ol reversed><li>a<li>b</ol>", ["item 2. a", "item 1. b"]),
        ("<ol type=a start=27><li>a<li value=5>b</ol>", ["item aa. a", "item e. b"]),
        ("<dl><dt>a<dd>b</dl>", ["item a", "item b"]),
        ("<p>one<hr><p>two", ["paragraph one", "paragraph * * *", "paragraph two"]),
        ("<q>a <q>b</q></q>", ["paragraph “a ‘b’”"]),
        ("<p lang=de><q>a</q>", ["paragraph „a“"]),
        ("<ruby>漢<rp>(</rp><rt>かん</rt></ruby>", ["paragraph 漢(かん)"]),
        ("10<sup>6</sup> H<sub>2</sub>O 4<sup>th</sup>", ["paragraph 10⁶ H₂O 4th"]),
        ("<p>the <del>old</del><ins>new</ins> rule", ["paragraph the [deleted: old] new rule"]),
        ("<p>a<script>b</script><style>c</style><p hidden>d<template>e</template>", ["paragraph a"]),
        ("It&#146;s &#147;so&#148;", ["paragraph It’s “so”"]),
        ("cafe\u0301 Schiff\u00adfahrt", ["paragraph café Schifffahrt"]),
        ("<img src=a alt=One><img src=b alt=Two>!", ["paragraph One Two !"]),
        ("<img src=o alt=O>nce upon", ["paragraph Once upon"]),
        ("<p>a <img src=x> <video></video> <img alt=''>b", ["paragraph a [picture] [film] b"]),
        ("<img src=map.svg alt='A map'>", ["line figure: A map"]),
        ("<svg><title>A map</title><text>x</text></svg>", ["paragraph A map"]),
        ("<svg><text>Once</text><text>upon</text></svg>", ["paragraph Once upon"]),
        ("<input type=checkbox disabled checked>done", ["paragraph ☒ done"]),
        ("<span class=pagebreak title=7></span>one", ["page 7", "paragraph one"]),
        ("<p>on<span role=doc-pagebreak title=8></span>e two", ["paragraph one", "page 8", "paragraph two"]),
        ("<figure><img alt=Cat src=c><figcaption>Cat</figcaption></figure>", ["paragraph Cat"]),
    ],
)  # fmt: skip
def test_elements_are_blocks(markup, wanted):
    assert said(f"<html><body>{markup}") == wanted


@pytest.mark.parametrize(
    ("rows", "wanted", "headers"),
    [
        ("<tr><th>Name<th>Mon<th>Tue<tr><th>Bob<td><td>6", f"Bob  {EMPTY}  6", ("Name", "Mon", "Tue")),
        ("<tr><th>N<th>M<tr><th rowspan=2>Ann<td>1<tr><td>2", "Ann  2", ("N", "M")),
        (
            "<tr><td><th id=a colspan=2>Paris<tr><td><th id=b>Meals<th id=c>Hotels"
            "<tr><th id=d>25<td headers='a b d'>37<td headers='a c d'>112",
            "25  37  112", ("", "Paris Meals", "Paris Hotels"),
        ),
        ("<tr><th>A<th>B<th>C<tr><td colspan=2>x<td>y", "x  x  y", ("A", "B", "C")),
        ("<thead><tr><td>A<td>B</thead><tr><td>1<td>2", "1  2", ("A", "B")),
        ("<tr><td><ol><li>one<li>two</ol><td>x<tr><td>y", f"y  {EMPTY}", ()),
        ("<tr><td colspan=2>whole<tr><td>a<td>b<tr><td colspan=2>end", "end", ()),
    ],
)  # fmt: skip
def test_a_row_has_a_text_for_each_column(rows, wanted, headers):
    last = blocks(f"<html><table>{rows}</table>")[-1]
    assert (last.kind, last.text, last.headers) == (BlockKind.ROW, wanted, headers)


def test_a_table_that_only_lays_out_is_its_text():
    assert said("<html><table><tr><td><h1>A</h1><td>b</table>") == ["heading A", "paragraph b"]
    assert said("<html><table role=presentation><tr><td>a<td>b</table>") == [
        "paragraph a",
        "paragraph b",
    ]
    assert said("<html><table><tr><td><ol><li>a<li>b</ol><td>x</table>") == ["row 1. a 2. b  x"]


def test_two_lists_and_tables_are_told_apart():
    found = blocks("<html><ul><li>a<li>b</ul><ul><li>c</ul><table><tr><td>1<td>2</table>")
    assert [block.group for block in found] == [1, 1, 2, 3]


def test_marks_say_what_is_so_about_a_part():
    block = blocks(
        "<html lang=en><p>a <b>bold <i>and</i></b> <a href='#x'>link</a> <span lang=fr>où</span>"
    )[0]
    assert marks(block) == [
        ("bold", "bold and", ""), ("italic", "and", ""), ("link", "link", "#x"), ("language", "où", "fr"),
    ]  # fmt: skip
    whole = blocks("<html lang=en><p><span lang=fr>où</span><p lang=en-GB>a")
    assert [block.language for block in whole] == ["fr", ""]


@pytest.mark.parametrize(
    "markup",
    [
        "one<a role=doc-noteref href='#n'>1</a><aside role=doc-footnote id=n>1. two <a role=doc-backlink>↩</a></aside>",
        "one<sup class=footnote-ref><a href='#n'>[1]</a></sup><section class=footnotes><ol><li id=n>two</ol></section>",
    ],
)  # fmt: skip
def test_notes_are_referred_to(markup):
    source = opened(f"<html>{markup}", "a.html")
    text, note = source.blocks()
    assert (text.text, note.kind, note.text) == ("one[1]", BlockKind.NOTE, "1. two")
    assert marks(text) == [("note", "[1]", "#n")]
    assert source.anchor("n") == note.start


@pytest.mark.parametrize(
    ("math", "tex"),
    [
        ("<msup><mi>x</mi><mn>2</mn></msup><mo>+</mo><mfrac><mn>1</mn><mn>2</mn></mfrac>", "x^{2}+\\frac{1}{2}"),
        ("<mi>sin</mi><mo>&#x2061;</mo><mi>x</mi>", "\\sin x"),
        ("<msqrt><mi>a</mi></msqrt><mroot><mi>b</mi><mn>3</mn></mroot>", "\\sqrt{a}\\sqrt[3]{b}"),
        ("<munderover><mo>∑</mo><mi>i</mi><mi>n</mi></munderover>", "\\sum_{i}^{n}"),
        ("<mi>y</mi><annotation encoding='application/x-tex'>y_0</annotation>", "y_0"),
        ("<mover><mi>v</mi><mo>→</mo></mover>", "\\vec{v}"),
    ],
)  # fmt: skip
def test_formulas_are_tex(math, tex):
    assert said(f"<html><p>f <math>{math}</math>") == [f"paragraph f {tex}"]
    assert said("<html><p>f <math></math>") == ["paragraph f [formula]"]


def test_what_is_nested_deep_is_read_flat():
    source = opened("<html>" + "<div><p>x" * 300 + "deepest", "a.html")
    assert "deepest" in source.text
    assert source.text.count("x") == 300
    assert "deep" in source.notes()[0]


def test_dtbook_has_its_own_names():
    book = (
        "<?xml version='1.0'?><dtbook xml:lang='en'><book><frontmatter><doctitle>T</doctitle>"
        "</frontmatter><bodymatter><level1><h1>One</h1><pagenum id='p'>3</pagenum><level2><hd>Two</hd>"
        "<p>a<noteref idref='#n'>1</noteref></p><note id='n'>b</note><list type='pl'><li><lic>Chapter"
        "</lic><lic>19</lic></li></list></level2></level1></bodymatter></book></dtbook>"
    )
    assert said(book, "a.xml") == [
        "heading T", "heading One", "page 3", "heading Two", "paragraph a[1]", "note b", "item Chapter  19",
    ]  # fmt: skip
    assert [block.level for block in blocks(book, "a.xml")][:4] == [1, 1, 0, 2]


@pytest.mark.parametrize(
    ("markdown", "wanted"),
    [
        ("Price $5 and $6 today, $20,000 or US$15.", ["paragraph Price $5 and $6 today, $20,000 or US$15."]),
        ("so $x^2$ is", ["paragraph so x^2 is"]),
        ("# One {#a}\n\n- b\n  1. c\n", ["heading One", "item • b", "item 1. c"]),
        ("|a|b|\n|-|-|\n|1||\n", ["row a  b", f"row 1  {EMPTY}"]),
        ("one[^1]\n\n[^1]: two", ["paragraph one[1]", "note 1. two"]),
        ("x\n: y", ["item x", "item y"]),
        ("![](a.png) ![A map](m.svg)", ["paragraph [picture]", "line figure: A map"]),
    ],
)  # fmt: skip
def test_markdown_is_markup(markdown, wanted):
    assert said(markdown, "a.md") == wanted


@pytest.mark.parametrize("markdown", ["*a* " * 100_000, "[a" * 50_000, ">" * 50_000 + "a"])
def test_markdown_that_never_ends_is_its_text(markdown):
    assert opened(markdown, "a.md").text.replace("\n", "").count("a") == markdown.count("a")


def test_front_matter_says_title_and_language():
    source = opened("---\ntitle: >-\n  A long\n  title\nlang: pt_BR\n---\n\nText.", "a.md")
    assert (source.title, source.language, source.text) == ("A long title", "pt-BR", "Text.")


@pytest.mark.parametrize(
    ("content", "text"),
    [
        ("<?xml version='1.0' encoding='utf-8'?><html><p>Глава первая, старая".encode("cp1251"), "Глава первая, старая"),
        ("<html><meta charset=latin1><p>Глава".encode(), "Глава"),
        ("<html><meta charset=koi8-r><p>Глава".encode("koi8-r"), "Глава"),
        ("<html><p>it\x92s".encode("latin-1"), "it’s"),
        (b"<?xml version='1.0'?><html><title/><p>a&nbsp;b &eacute;</p></html>", "a\u00a0b é"),
        (b"<?xml version='1.0'?><html><p>a & b <br> c</html>", "a & b\nc"),
    ],
)  # fmt: skip
def test_markup_is_read_whatever_it_declares(content, text):
    assert opened(content, "a.html").text == text


def test_a_picture_s_file_is_told():
    block = blocks("<html><img src='figs/map.scene#x' alt=Map>")[0]
    assert [(mark.kind, mark.target) for mark in block.marks] == [
        (MarkKind.IMAGE, "figs/map.scene")
    ]
