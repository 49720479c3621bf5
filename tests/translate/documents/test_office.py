"""Word processors' files: what they say beside their text, and what cannot be read."""

import hashlib
import io
from pathlib import Path

import pytest

from tests.cli.books import ODT, WORD, docx, odt
from vbraille.errors import InputError
from vbraille.translate.documents.office.htmltree import tag_of
from vbraille.translate.documents.office.officebook import open_office
from vbraille.translate.source import BlockKind, MarkKind

FILES = Path(__file__).parent / "files"
ODT_STYLES = (
    '<style:style style:name="F" style:family="text"><style:text-properties fo:language="fr" '
    'fo:country="FR"/></style:style><style:style style:name="S" style:family="text">'
    '<style:text-properties style:text-position="super 58%"/></style:style>'
    '<style:style style:name="D" style:family="text" style:parent-style-name="F">'
    '<style:text-properties style:text-position="-33% 58%"/></style:style>'
    '<style:style style:name="P" style:family="paragraph"><style:paragraph-properties '
    'fo:break-before="page"/></style:style>'
)
NAMES = (
    ' xmlns:style="urn:oasis:names:tc:opendocument:xmlns:style:1.0" '
    'xmlns:fo="urn:oasis:names:tc:opendocument:xmlns:xsl-fo-compatible:1.0" '
    'xmlns:table="urn:oasis:names:tc:opendocument:xmlns:table:1.0"'
)


def run(text, *properties):
    inner = "".join(f"<w:{name}/>" for name in properties)
    return f'<w:r><w:rPr>{inner}</w:rPr><w:t xml:space="preserve">{text}</w:t></w:r>'


def paragraphs(*runs):
    return WORD.format("".join(f"<w:p>{inner}</w:p>" for inner in runs))


def opened(content, form):
    source = open_office(io.BytesIO(content), "book", form)
    blocks = []
    while (block := source.block(len(blocks))) is not None:
        blocks.append(block)
    return source, blocks


def odt_of(body, styles=""):
    content = ODT.format(body).replace(
        "><office:body>",
        f"{NAMES}><office:automatic-styles>{ODT_STYLES}{styles}</office:automatic-styles><office:body>",
        1,
    )
    return odt(content)


def marks(block):
    text = str(block.text)
    return [
        (mark.kind, text[block.text.index(mark.start) : block.text.index(mark.end)], mark.target)
        for mark in block.marks
    ]


def test_what_a_run_of_docx_says():
    english, french = 'lang w:val="en-GB"', 'lang w:val="fr-FR"'
    content = paragraphs(
        run("Most of it is in English, and ", english)
        + run("le reste", french)
        + run(" is not", 'lang w:val="en-US"'),
        run("H") + run("2", 'vertAlign w:val="subscript"') + run("O"),
        run("x") + run("2", 'vertAlign w:val="superscript"'),
        run("so ") + run("lined", 'u w:val="single"') + run(" plain", 'u w:val="none"'),
    )
    source, blocks = opened(docx(content), "docx")
    assert source.language == "en-GB"
    assert [str(block.text) for block in blocks] == [
        "Most of it is in English, and le reste is not",
        "H₂O",
        "x²",
        "so lined plain",
    ]
    assert [marks(block) for block in blocks] == [
        [(MarkKind.LANGUAGE, "le reste", "fr-FR")],
        [(MarkKind.SUBSCRIPT, "₂", "")],
        [(MarkKind.SUPERSCRIPT, "²", "")],
        [(MarkKind.UNDERLINE, "lined", "")],
    ]


@pytest.mark.parametrize(
    ("mark", "numbers"),
    [("lastRenderedPageBreak", ["2", "3"]), ('br w:type="page"', ["", ""])],
)
def test_pages_of_docx(mark, numbers):
    """Word's own pages have numbers, those that an author began have none."""
    turn = f"<w:r><w:{mark}/></w:r>"
    content = paragraphs(run("one"), turn + run("two"), turn + run("three"))
    _, blocks = opened(docx(content), "docx")
    pages = [str(block.text) for block in blocks if block.kind is BlockKind.PAGE]
    assert pages == numbers
    assert [str(b.text) for b in blocks if b.kind is BlockKind.PARAGRAPH] == ["one", "two", "three"]


def test_what_docx_draws_is_told():
    chart = (
        '<w:r><w:drawing><wp:inline xmlns:wp="http://schemas.openxmlformats.org/drawingml/2006/'
        'wordprocessingDrawing"><a:graphic xmlns:a="http://schemas.openxmlformats.org/drawingml/'
        '2006/main"><a:graphicData uri="http://schemas.openxmlformats.org/drawingml/2006/chart"/>'
        "</a:graphic></wp:inline></w:drawing></w:r>"
    )
    _, blocks = opened(docx(paragraphs(run("one ") + chart)), "docx")
    assert [str(block.text) for block in blocks] == ["one [drawing: chart]"]
    assert [kind for kind, _, _ in marks(blocks[0])] == [MarkKind.UNSHOWN]


def test_what_a_span_of_odt_says():
    body = (
        "<text:p>one "
        '<text:span text:style-name="F">deux</text:span> x'
        '<text:span text:style-name="S">3</text:span></text:p>'
        '<text:p text:style-name="P">H<text:span text:style-name="D">2</text:span>O</text:p>'
    )
    source, blocks = opened(odt_of(body), "odt")
    texts = [str(block.text) for block in blocks if block.kind is not BlockKind.PAGE]
    assert texts == ["one deux x³", "H₂O"]
    assert source.language == ""
    assert (MarkKind.LANGUAGE, "deux", "fr-FR") in marks(blocks[0])
    assert (MarkKind.SUPERSCRIPT, "³", "") in marks(blocks[0])
    assert (MarkKind.SUBSCRIPT, "₂", "") in marks(blocks[-1])
    assert blocks[1].kind is BlockKind.PAGE


def test_pages_of_odt_have_numbers_where_it_was_laid_out():
    body = (
        '<text:p>one <text:soft-page-break/>two</text:p><text:p text:style-name="P">three</text:p>'
    )
    _, blocks = opened(odt_of(body), "odt")
    pages = [str(block.text) for block in blocks if block.kind is BlockKind.PAGE]
    assert pages == ["2", "3"]


def test_rtf_says_its_title_and_language():
    text = b"{\\rtf1\\ansi\\deflang1036{\\info{\\title Le port}}{\\pard Les bateaux.\\par}}"
    source, blocks = opened(text, "rtf")
    assert (source.title, source.language) == ("Le port", "fr-FR")
    assert [str(block.text) for block in blocks] == ["Les bateaux."]
    source, _ = opened(b"{\\rtf1\\ansi{\\pard\\lang9 One.\\par}}", "rtf")
    assert source.language == "en"


def test_the_digest_is_of_the_file():
    content = (FILES / "pandoc.docx").read_bytes()
    source, _ = opened(content, "docx")
    assert source.sha256() == hashlib.sha256(content).hexdigest()


@pytest.mark.parametrize(
    ("given", "tag"),
    [
        (("fr", "CA"), "fr-CA"),
        (("fr", "none"), "fr"),
        (("none", "none"), ""),
        ((None,), ""),
        (("zxx",), ""),
        (("en-GB",), "en-GB"),
    ],
)
def test_tags_as_word_processors_have_them(given, tag):
    assert tag_of(*given) == tag


@pytest.mark.parametrize("form", ["docx", "odt", "rtf"])
def test_what_is_no_such_file(form):
    with pytest.raises(InputError, match=r"is damaged or no|is not a whole ZIP archive"):
        opened(b"no such thing", form)


def docx_blocks(*runs, body=None, members=None):
    content = paragraphs(*runs) if body is None else WORD.format(body)
    return opened(docx(content, members), "docx")[1]


def docx_texts(*runs, **more):
    return [str(block.text) for block in docx_blocks(*runs, **more)]


def odt_texts(body, **more):
    return [str(block.text) for block in opened(odt_of(body, **more), "odt")[1]]


def test_signs_of_docx_that_are_no_text():
    signs = (
        '<w:r><w:t>co</w:t><w:noBreakHyphen/><w:t>op </w:t><w:sym w:font="Symbol" w:char="F061"/>'
        '<w:t> </w:t><w:sym w:font="Wingdings" w:char="F0FE"/><w:softHyphen/><w:tab/><w:t>x </w:t>'
        '<w:sym w:font="Wingdings 3" w:char="F099"/></w:r>'
    )
    (block,) = docx_blocks(signs)
    assert str(block.text) == "co‑op α ☑ x [symbol]"
    assert (MarkKind.UNSHOWN, "[symbol]", "symbol") in marks(block)


def test_hidden_and_deleted_text_of_docx_is_not_read():
    hidden = run("no", "vanish") + run("yes", 'vanish w:val="0"')
    deleted = "<w:del><w:r><w:delText>no</w:delText></w:r></w:del><w:ins>" + run(" so") + "</w:ins>"
    moved = "<w:moveFrom>" + run("no") + "</w:moveFrom><w:moveTo>" + run(".") + "</w:moveTo>"
    assert docx_texts(hidden + deleted + moved) == ["yes so."]


NUMBERING = (
    '<w:numbering xmlns:w="http://schemas.openxmlformats.org/wordprocessingml/2006/main">{}'
    "</w:numbering>"
)
LEVEL = (
    '<w:lvl w:ilvl="{}"><w:start w:val="{}"/><w:numFmt w:val="{}"/><w:lvlText w:val="{}"/></w:lvl>'
)


def numbered(*lists):
    """Members with lists, each of levels of start, form and text."""
    made = []
    for number, levels in enumerate(lists, 1):
        inner = "".join(LEVEL.format(n, *level) for n, level in enumerate(levels))
        made.append(f'<w:abstractNum w:abstractNumId="{number}">{inner}</w:abstractNum>')
    made += (
        f'<w:num w:numId="{number}"><w:abstractNumId w:val="{number}"/></w:num>'
        for number in range(1, len(lists) + 1)
    )
    return {"word/numbering.xml": NUMBERING.format("".join(made))}


def item(number, level, text):
    place = f'<w:ilvl w:val="{level}"/><w:numId w:val="{number}"/>'
    return f"<w:p><w:pPr><w:numPr>{place}</w:numPr></w:pPr>{run(text)}</w:p>"


def test_lists_of_docx():
    members = numbered(
        [(3, "decimal", "%1."), (1, "lowerLetter", "%1.%2)")],
        [(1, "bullet", "·"), (1, "bullet", "o")],
        [(1, "bullet", " "), (1, "bullet", " ")],
        [(1, "bullet", "☒"), (1, "bullet", "☐")],
    )
    body = (
        item(1, 0, "one")
        + item(3, 0, "more of it")
        + item(1, 1, "inner")
        + item(1, 1, "next")
        + item(1, 0, "two")
        + f"<w:p>{run('between')}</w:p>"
        + item(1, 0, "three")
        + item(2, 0, "dot")
        + item(2, 1, "deeper")
        + item(4, 0, "done")
        + item(4, 1, "to do")
    )
    found = docx_blocks(body=body, members=members)
    assert [(b.kind.value, b.level, str(b.text)) for b in found] == [
        ("item", 1, "3. one"),
        ("paragraph", 0, "more of it"),
        ("item", 2, "3.a) inner"),
        ("item", 2, "3.b) next"),
        ("item", 1, "4. two"),
        ("paragraph", 0, "between"),
        ("item", 1, "5. three"),
        ("item", 1, "• dot"),
        ("item", 2, "• deeper"),
        ("item", 1, "☒ done"),
        ("item", 2, "☐ to do"),
    ]


def cell(text, *properties):
    told = "".join(f"<w:{name}/>" for name in properties)
    return f"<w:tc><w:tcPr>{told}</w:tcPr><w:p>{run(text)}</w:p></w:tc>"


def test_cells_of_docx_keep_their_columns():
    head = "<w:tr><w:trPr><w:tblHeader/></w:trPr>" + "".join(map(cell, "ABC")) + "</w:tr>"
    rows = (
        "<w:tr>" + cell("1", 'vMerge w:val="restart"') + cell("2") + cell("3") + "</w:tr>"
        "<w:tr>" + cell("", "vMerge") + cell("") + cell("4") + "</w:tr>"
        "<w:tr>" + cell("5", 'gridSpan w:val="2"') + cell("6") + "</w:tr>"
    )
    before = '<w:tr><w:trPr><w:gridBefore w:val="1"/></w:trPr>' + cell("7") + cell("8") + "</w:tr>"
    found = docx_blocks(body=f"<w:tbl>{head}{rows}{before}</w:tbl>")
    assert [(str(b.text), b.headers) for b in found] == [
        ("A  B  C", ()),
        ("1  2  3", ("A", "B", "C")),
        ("4", ("C",)),
        ("5  6", ("A", "C")),
        ("7  8", ("B", "C")),
    ]


def test_what_stands_in_a_drawing_of_docx():
    box = f"<w:txbxContent><w:p>{run('in a box')}</w:p></w:txbxContent>"
    empty = "<w:r><w:drawing><x/></w:drawing></w:r>"
    both = (
        '<w:r><mc:AlternateContent xmlns:mc="mc"><mc:Choice><w:pict>'
        + box
        + "</w:pict></mc:Choice>"
        "<mc:Fallback><w:pict>" + box + "</w:pict></mc:Fallback></mc:AlternateContent></w:r>"
    )
    assert docx_texts(run("one"), both, run("two ") + empty) == ["one", "in a box", "two [drawing]"]


def test_fields_boxes_and_formulas_of_docx():
    def mark(kind, inner=""):
        return f'<w:r><w:fldChar w:fldCharType="{kind}">{inner}</w:fldChar></w:r>'

    link = (
        mark("begin")
        + '<w:r><w:instrText>HYPERLINK "https://a.b" \\l "c"</w:instrText></w:r>'
        + mark("separate")
        + run("there")
        + mark("end")
    )
    box = '<w:ffData><w:checkBox><w:default w:val="{}"/></w:checkBox></w:ffData>'
    boxes = mark("begin", box.format(1)) + mark("end") + mark("begin", box.format(0)) + mark("end")
    formula = (
        '<m:oMath xmlns:m="m"><m:f><m:num><m:r><m:t>1</m:t></m:r></m:num><m:den><m:sSup><m:e><m:r>'
        "<m:t>x</m:t></m:r></m:e><m:sup><m:r><m:t>2</m:t></m:r></m:sup></m:sSup></m:den></m:f>"
        "</m:oMath>"
    )
    linked, ticked, written = docx_blocks(link + run(" on"), boxes, formula)
    assert marks(linked) == [(MarkKind.LINK, "there", "https://a.b#c")]
    assert str(linked.text) == "there on"
    assert str(ticked.text) == "☑☐"
    assert str(written.text) == "\\frac{1}{x^{2}}"


def test_comments_and_deleted_text_of_odt_are_not_read():
    body = (
        "<text:tracked-changes><text:changed-region><text:deletion><text:p>no</text:p>"
        "</text:deletion></text:changed-region></text:tracked-changes><text:p>yes"
        "<office:annotation><text:p>a remark</text:p></office:annotation> and<text:s text:c='2'/>"
        "so<text:tab/>on<office:annotation-end/></text:p>"
    )
    assert odt_texts(body) == ["yes and so on"]


def test_fields_of_odt_are_read_and_descriptions_of_pictures_once():
    body = (
        "<text:p>See <text:title>The Harbour</text:title> "
        '<draw:frame xmlns:draw="d" xmlns:svg="s"><draw:image/><svg:title>a rock</svg:title>'
        "</draw:frame></text:p>"
    )
    assert odt_texts(body) == ["See The Harbour a rock"]


def test_lists_and_tables_of_odt():
    levels = (
        '<text:list-style style:name="L"><text:list-level-style-number text:level="1" '
        'style:num-format="1" style:num-suffix="." text:start-value="4"/>'
        '<text:list-level-style-number text:level="2" style:num-format="a" style:num-suffix=")" '
        'text:display-levels="2"/></text:list-style>'
    )
    body = (
        '<text:list text:style-name="L"><text:list-item><text:p>one</text:p><text:p>more</text:p>'
        "<text:list><text:list-item><text:p>inner</text:p></text:list-item></text:list>"
        "</text:list-item><text:list-item><text:p>two</text:p></text:list-item></text:list>"
        "<table:table><table:table-header-rows><table:table-row><table:table-cell><text:p>A</text:p>"
        "</table:table-cell><table:table-cell><text:p>B</text:p></table:table-cell>"
        "</table:table-row></table:table-header-rows><table:table-row><table:table-cell/>"
        "<table:table-cell><text:p>1</text:p></table:table-cell></table:table-row><table:table-row>"
        '<table:table-cell table:number-columns-spanned="2"><text:p>2</text:p></table:table-cell>'
        "<table:covered-table-cell/></table:table-row></table:table>"
    )
    _, found = opened(odt_of(body, levels), "odt")
    assert [(b.kind.value, b.level, str(b.text), b.headers) for b in found] == [
        ("item", 1, "4. one", ()),
        ("paragraph", 0, "more", ()),
        ("item", 2, "4.a) inner", ()),
        ("item", 1, "5. two", ()),
        ("row", 0, "A  B", ()),
        ("row", 0, "1", ("B",)),
        ("row", 0, "2", ("A",)),
    ]


@pytest.mark.parametrize("form", ["docx", "odt"])
def test_what_is_nested_very_deep_is_read_or_refused(form):
    tables = {
        "docx": ("<w:tbl><w:tr><w:tc/><w:tc>", f"<w:p>{run('x')}</w:p>", "</w:tc></w:tr></w:tbl>"),
        "odt": (
            "<table:table><table:table-row><table:table-cell/><table:table-cell>",
            "<text:p>x</text:p>",
            "</table:table-cell></table:table-row></table:table>",
        ),
    }
    begin, inner, end = tables[form]
    for depth in (70, 1_000):
        body = begin * depth + inner + end * depth
        content = docx(WORD.format(body)) if form == "docx" else odt_of(body)
        if depth > 100:
            with pytest.raises(InputError, match="damaged part"):
                opened(content, form)
        else:
            assert "".join(str(block.text) for block in opened(content, form)[1]) == "x"


def rtf_blocks(text):
    return opened(b"{\\rtf1\\ansi" + text.encode("cp1252") + b"}", "rtf")[1]


def rtf_texts(text):
    return [str(block.text) for block in rtf_blocks(text)]


def test_text_in_shapes_of_rtf_is_read_and_deleted_text_is_not():
    shape = r"{\shp{\*\shpinst{\sp{\sn fFlipH}{\sv 0}}{\shptxt{\pard in a box\par}}}{\shprslt{no}}}"
    assert rtf_texts(r"\pard one " + shape + r" two\par") == ["one", "in a box", "two"]
    assert rtf_texts(r"\pard one {\deleted no}{\revised two}{\v no}\par") == ["one two"]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (r"co\_op a\~b c\-d {\b e}\tab f", "co\u2011op a\xa0b cd e f"),
        (r"\u233?\'e9\uc0\u233 \uc2\u233\'ff\'ff!", "éééé!"),
        (r"\u-10179?\u-8704? \ldblquote x\rdblquote", "\U0001f600 “x”"),
        (r"a\'", "a"),
        (r"\bin3 }}}a", "a"),
        ("a}}}b", "ab"),
    ],
)
def test_characters_of_rtf(text, expected):
    assert rtf_texts(r"\pard " + text + r"\par")[:1] == [expected]


def test_alphabets_and_signs_of_rtf():
    fonts = r"{\fonttbl{\f0 Arial;}{\f1\fcharset204 Arial Cyr;}{\f2\fcharset2 Symbol;}}"
    text = r"\pard {\f1\'ec\'e8\'f0} {\f0\'e9} {\f2\'61}\par"
    assert rtf_texts(fonts + text) == ["мир é α"]


def test_structure_of_rtf():
    text = (
        r"{\stylesheet{\s0 Normal;}{\s1\sbasedon0\outlinelevel0 heading 1;}{\s2\sbasedon0 Quote;}}"
        r"{\pard\s1\b One\par}{\pard\s2 quoted\par}"
        r"\pard{\listtext 1.\tab}\ls1\ilvl0 first\par\pard\ls1\ilvl0 more\par"
        r"\pard{\listtext\'b7\tab}\ls1\ilvl1 inner\par\pard{\listtext 2.\tab}\ls1\ilvl0 second\par"
        r"\pard{\field{\*\fldinst{HYPERLINK \"https://a.b\"}}{\fldrslt{\ul there}}} on"
        r"{\super\chftn}{\*\footnote\pard{\super\chftn} a note\par}\par"
        r"\trowd\trhdr\cellx1\cellx2\cellx3\pard\intbl A\cell B\cell C\cell\row"
        r"\trowd\clvmgf\cellx1\cellx2\cellx3\pard\intbl 1\cell\cell 2\cell\row"
        r"\trowd\clvmrg\cellx1\cellx2\cellx3\pard\intbl\cell 3\cell\cell\row"
        r"\trowd\cellx1\cellx3\pard\intbl 4\cell 5\cell\row\pard after{\pict\pngblip 89504e}\par"
    )
    found = rtf_blocks(text)
    assert [(b.kind.value, b.level, str(b.text), b.headers) for b in found] == [
        ("heading", 1, "One", ()),
        ("quote", 1, "quoted", ()),
        ("item", 1, "1. first", ()),
        ("paragraph", 0, "more", ()),
        ("item", 2, "• inner", ()),
        ("item", 1, "2. second", ()),
        ("paragraph", 0, "there on[1]", ()),
        ("row", 0, "A  B  C", ()),
        ("row", 0, "1  2", ("A", "C")),
        ("row", 0, "3", ("B",)),
        ("row", 0, "4  5", ("A", "B")),
        ("paragraph", 0, "after [picture]", ()),
        ("note", 0, "1. a note", ()),
    ]
    assert marks(found[6])[0] == (MarkKind.LINK, "there", "https://a.b")


def test_groups_of_rtf_by_the_million_are_refused():
    with pytest.raises(InputError, match="thousands of groups"):
        opened(b"{\\rtf1" + b"{" * 1_000_000 + b"one", "rtf")
