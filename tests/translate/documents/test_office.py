"""Word processors' files: what they say beside their text, and what cannot be read."""

import hashlib
import io
import zipfile
from pathlib import Path

import pytest

from tests.cli.books import ODT, WORD, archive, docx, odt
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


def described(blocks):
    return [(block.kind.value, block.level, str(block.text)) for block in blocks]


def test_pages_ruby_breaks_and_fields_of_docx():
    ruby = (
        "<w:r><w:ruby><w:rubyPr/><w:rt>"
        + run("kan")
        + "</w:rt><w:rubyBase>"
        + run("漢")
        + "</w:rubyBase>"
        "</w:ruby></w:r>"
    )
    simple = '<w:fldSimple w:instr=" HYPERLINK https://a.b ">' + run("there") + "</w:fldSimple>"
    number = '<w:fldSimple w:instr=" PAGE ">' + run("7") + "</w:fldSimple>"
    body = (
        f"<w:p>{run('one')}<w:r><w:br/></w:r>{run('two')}</w:p>"
        f"<w:p><w:pPr><w:pageBreakBefore/></w:pPr>{simple}{number}</w:p>"
        f"<w:p>{ruby}</w:p>"
        f'<w:bookmarkStart w:name="_GoBack"/><w:bookmarkStart w:name="end"/><w:p>{run("end")}</w:p>'
    )
    found = docx_blocks(body=body)
    assert described(found) == [
        ("paragraph", 0, "one"),
        ("line", 0, "two"),
        ("page", 0, ""),
        ("paragraph", 0, "there7"),
        ("paragraph", 0, "漢(kan)"),
        ("paragraph", 0, "end"),
    ]
    assert marks(found[3]) == [(MarkKind.LINK, "there", "https://a.b")]
    assert found[5].anchors == ("end",)


def test_a_link_of_a_field_ends_with_its_paragraph():
    """A field that is never ended does not draw the rest of the book into its paragraph."""
    begin = '<w:r><w:fldChar w:fldCharType="begin"/><w:instrText>HYPERLINK "#a"</w:instrText>'
    opening = begin + '<w:fldChar w:fldCharType="separate"/></w:r>'
    first, second = docx_blocks(opening + run("linked"), run("not linked"))
    assert (str(first.text), marks(first)) == ("linked", [(MarkKind.LINK, "linked", "#a")])
    assert (str(second.text), marks(second)) == ("not linked", [])


@pytest.mark.parametrize(
    ("inner", "told"),
    [
        ("<w:object><x/></w:object>", "[embedded object]"),
        (
            '<w:drawing><y uri="u/diagram"/></w:drawing>'.replace("y", "graphicData"),
            "[drawing: diagram]",
        ),
        ("<w:pict><imagedata/></w:pict>", "[picture]"),
        ('<w:drawing><docPr descr=" a boat "/><pic/></w:drawing>', "a boat"),
        ('<w:pict><shape alt="a rope"/></w:pict>', "a rope"),
    ],
)
def test_what_stands_for_a_drawing_of_docx(inner, told):
    assert docx_texts(f"<w:r>{inner}</w:r>") == [told]


STYLES = (
    '<w:styles xmlns:w="http://schemas.openxmlformats.org/wordprocessingml/2006/main">'
    '<w:docDefaults><w:rPrDefault><w:rPr><w:lang w:val="nl-NL"/></w:rPr></w:rPrDefault>'
    "</w:docDefaults>"
    '<w:style w:styleId="T"><w:name w:val="Title"/></w:style>'
    '<w:style w:styleId="H"><w:name w:val="heading 2"/><w:rPr><w:b/></w:rPr></w:style>'
    '<w:style w:styleId="I"><w:name w:val="Chapter"/><w:basedOn w:val="H"/></w:style>'
    '<w:style w:styleId="Q"><w:name w:val="Quote"/><w:rPr><w:i/></w:rPr></w:style>'
    '<w:style w:styleId="C"><w:name w:val="Source Code"/></w:style>'
    '<w:style w:styleId="O"><w:name w:val="Part"/><w:pPr><w:outlineLvl w:val="0"/>'
    "</w:pPr></w:style>"
    '<w:style w:styleId="B"><w:name w:val="Body"/><w:basedOn w:val="H"/><w:pPr>'
    '<w:outlineLvl w:val="9"/>'
    "</w:pPr></w:style>"
    '<w:style w:styleId="S"><w:name w:val="Small"/><w:rPr>'
    '<w:vertAlign w:val="superscript"/></w:rPr></w:style>'
    '<w:style w:styleId="X"><w:basedOn w:val="Y"/></w:style>'
    '<w:style w:styleId="Y"><w:basedOn w:val="X"/></w:style>'
    "</w:styles>"
)


def styled(style, inner, more=""):
    return f'<w:p><w:pPr><w:pStyle w:val="{style}"/>{more}</w:pPr>{inner}</w:p>'


def test_styles_of_docx_say_what_a_paragraph_is():
    level = '<w:outlineLvl w:val="2"/>'
    body = (
        styled("T", run("The Harbour"))
        + styled("I", run("Boats"))
        + styled("O", run("One"))
        + styled("B", run("text"))
        + styled("X", run("in a circle"))
        + styled("Q", run("quoted") + run(" plain", 'i w:val="0"'))
        + styled("Q", run("again"))
        + styled("C", run("x = 1"))
        + styled("S", run("2") + run("on", 'vertAlign w:val="baseline"'))
        + styled("Q", run("three"), level)
    )
    source, found = opened(docx(WORD.format(body), {"word/styles.xml": STYLES}), "docx")
    assert source.language == "nl-NL"
    assert described(found) == [
        ("heading", 1, "The Harbour"),
        ("heading", 2, "Boats"),
        ("heading", 1, "One"),
        ("paragraph", 0, "text"),
        ("paragraph", 0, "in a circle"),
        ("quote", 1, "quoted plain"),
        ("quote", 1, "again"),
        ("line", 0, "x = 1"),
        ("paragraph", 0, "²on"),
        ("heading", 3, "three"),
    ]
    bold = {"Boats": [], "quoted plain": [(MarkKind.ITALIC, "quoted", "")], "again": []}
    assert {str(b.text): marks(b) for b in found if str(b.text) in bold} == bold


def test_numbered_headings_and_lists_that_go_on_in_docx():
    members = numbered(
        [(1, "decimal", "%1"), (1, "upperRoman", "%2.")], [(1, "none", ""), (5, "ordinal", "%2)")]
    )
    override = (
        '<w:num w:numId="3"><w:abstractNumId w:val="2"/><w:lvlOverride w:ilvl="1"><w:startOverride '
        'w:val="9"/></w:lvlOverride></w:num></w:numbering>'
    )
    numbering = members["word/numbering.xml"].replace("</w:numbering>", override)
    place = '<w:numPr><w:ilvl w:val="0"/><w:numId w:val="1"/></w:numPr>'
    body = (
        styled("H", run("Boats"), place)
        + item(2, 0, "in no item")
        + item(2, 1, "five")
        + item(2, 0, "of five")
        + item(3, 1, "nine")
        + item(1, 1, "deeper at once")
        + item(9, 0, "no such list")
    )
    parts = {"word/numbering.xml": numbering, "word/styles.xml": STYLES}
    assert described(opened(docx(WORD.format(body), parts), "docx")[1]) == [
        ("heading", 2, "1 Boats"),
        ("paragraph", 0, "in no item"),
        ("item", 1, "5) five"),
        ("paragraph", 0, "of five"),
        ("item", 1, "9) nine"),
        ("item", 1, "I. deeper at once"),
        ("paragraph", 0, "no such list"),
    ]


def test_notes_of_docx_have_links_of_their_own():
    relations = (
        '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
        '<Relationship Id="a" Target="https://{}"/></Relationships>'
    )
    link = '<w:hyperlink r:id="a" xmlns:r="r">' + run("there") + "</w:hyperlink>"
    notes = (
        '<w:footnotes xmlns:w="http://schemas.openxmlformats.org/wordprocessingml/2006/main">'
        f'<w:footnote w:id="1"><w:p>{run("other")}</w:p></w:footnote>'
        f'<w:footnote w:id="2"><w:p>{run("a note, ")}{link}</w:p></w:footnote></w:footnotes>'
    )
    parts = {
        "word/footnotes.xml": notes,
        "word/_rels/document.xml.rels": relations.format("text"),
        "word/_rels/footnotes.xml.rels": relations.format("note"),
    }
    body = paragraphs(run("one") + '<w:r><w:footnoteReference w:id="2"/></w:r> ' + link)
    text, note = opened(docx(body, parts), "docx")[1]
    assert (str(text.text), str(note.text)) == ("one[1]there", "1. a note, there")
    assert next(mark for mark in marks(text) if mark[0] is MarkKind.LINK)[2] == "https://text"
    assert marks(note)[0][2] == "https://note"


def formula_of(inner):
    return docx_texts(f'<m:oMath xmlns:m="m">{inner}</m:oMath>')


def of(name, *parts):
    """Element of a formula, with parts of these names and texts."""
    inner = "".join(f"<m:{part}><m:r><m:t>{text}</m:t></m:r></m:{part}>" for part, text in parts)
    return f"<m:{name}>{inner}</m:{name}>"


@pytest.mark.parametrize(
    ("inner", "tex"),
    [
        (of("rad", ("deg", "3"), ("e", "x")), "\\sqrt[3]{x}"),
        (of("rad", ("e", "x")), "\\sqrt{x}"),
        (of("nary", ("sub", "0"), ("sup", "1"), ("e", "x")), "\\int_{0}^{1} x"),
        (
            '<m:nary><m:naryPr><m:chr m:val="∑"/></m:naryPr><m:e><m:t>x</m:t></m:e></m:nary>',
            "\\sum x",
        ),
        (of("acc", ("e", "x")), "x\u0302"),
        (of("sSubSup", ("e", "x"), ("sub", "i"), ("sup", "2")), "x_{i}^{2}"),
        (of("func", ("fName", "sin"), ("e", "x")), "sin x"),
        (of("eqArr", ("e", "a"), ("e", "b")), "a \\\\ b"),
        (
            '<m:d><m:dPr><m:begChr m:val="["/><m:endChr m:val=""/></m:dPr><m:e><m:t>a</m:t></m:e>'
            "<m:e><m:t>b</m:t></m:e></m:d>",
            "[a|b",
        ),
        (
            "<m:m><m:mPr/><m:mr><m:e><m:t>1</m:t></m:e><m:e><m:t>2</m:t></m:e></m:mr></m:m>",
            "\\begin{matrix} 1 & 2 \\end{matrix}",
        ),
        ("<m:box><m:e><m:t>y</m:t></m:e></m:box>", "y"),
    ],
)
def test_formulas_of_docx_are_read_as_tex(inner, tex):
    assert formula_of(inner) == [tex]


def test_a_table_of_one_cell_is_a_box():
    box = f"<w:tbl><w:tr><w:tc><w:p>{run('one')}</w:p><w:p>{run('two')}</w:p></w:tc></w:tr></w:tbl>"
    assert described(docx_blocks(body=box)) == [("paragraph", 0, "one"), ("paragraph", 0, "two")]
    lines = cell("A") + f"<w:tc><w:p>{run('B')}</w:p><w:p>{run('C')}</w:p></w:tc>"
    assert docx_texts(body=f"<w:tbl><w:tr>{lines}</w:tr></w:tbl>") == ["A  B C"]


def test_a_part_of_docx_without_relations_is_found_by_its_usual_name():
    content = paragraphs(run("one"))
    _, blocks = opened(docx(content, {"_rels/.rels": "<Relationships/>"}), "docx")
    assert [str(block.text) for block in blocks] == ["one"]


DRAWING = ' xmlns:draw="d" xmlns:svg="s" xmlns:xlink="http://www.w3.org/1999/xlink"'


def frame(inner):
    return f"<draw:frame{DRAWING}>{inner}</draw:frame>"


MATH = '<math:math xmlns:math="http://www.w3.org/1998/Math/MathML">{}</math:math>'


@pytest.mark.parametrize(
    ("inner", "told"),
    [
        (frame("<draw:image/>"), "[picture]"),
        (frame("<draw:object/>"), "[embedded object]"),
        (frame("<svg:title>title</svg:title><svg:desc>a boat</svg:desc>"), "a boat"),
        (frame("<draw:text-box><text:p>in a box</text:p></draw:text-box>"), "in a box"),
        (f"<draw:rect{DRAWING}/>", "[drawing]"),
        (f"<draw:g{DRAWING}><draw:rect><text:p>in it</text:p></draw:rect></draw:g>", "in it"),
        (frame("<draw:object>" + MATH.format("<mi>x</mi><mo>+</mo>") + "</draw:object>"), "x+"),
        (
            frame(
                "<draw:object>"
                + MATH.format(
                    "<semantics><mfrac/><annotation encoding='StarMath 5.0'>{1} over {2}"
                    "</annotation>"
                    "<annotation encoding='TeX'>\\frac12</annotation></semantics>"
                )
                + "</draw:object>"
            ),
            "\\frac12",
        ),
    ],
)
def test_what_stands_for_a_frame_of_odt(inner, told):
    assert odt_texts(f"<text:p>{inner}</text:p>") == [told]
    assert odt_texts(inner) == [told]


def test_a_formula_of_odt_in_a_part_of_its_own():
    inner = frame('<draw:object xlink:href="./Object 1"/>')
    other = frame('<draw:object xlink:href="./Object 2"/>')
    content = odt_of(f"<text:p>{inner} {other}</text:p>")
    with zipfile.ZipFile(io.BytesIO(content)) as source:
        members = {name: source.read(name) for name in source.namelist()}
    members["Object 1/content.xml"] = MATH.format("<mi>x</mi>")
    members["Object 2/content.xml"] = "<chart/>"
    _, blocks = opened(archive(members, kind=""), "odt")
    assert [str(block.text) for block in blocks] == ["x [embedded object]"]


def test_forms_ruby_breaks_and_marks_of_odt():
    form = ' xmlns:form="urn:oasis:names:tc:opendocument:xmlns:form:1.0"'
    boxes = (
        f'<office:forms{form}><form:checkbox form:id="a" form:current-state="checked"/>'
        '<form:checkbox form:id="b"/></office:forms>'
    )
    control = f'<draw:control{DRAWING} draw:control="{{}}"/>'
    body = (
        boxes
        + f"<text:p>{control.format('a')}{control.format('b')}{control.format('c')}</text:p>"
        + "<text:p>one<text:line-break/>two</text:p>"
        + '<text:p><text:bookmark text:name="here"/><text:ruby><text:ruby-base>漢</text:ruby-base>'
        "<text:ruby-text>kan</text:ruby-text></text:ruby></text:p>"
        '<text:p><text:a xlink:href="#here|outline" xmlns:xlink="http://www.w3.org/1999/xlink">'
        "back</text:a><text:a>nowhere</text:a></text:p>"
    )
    _, found = opened(odt_of(body), "odt")
    assert described(found) == [
        ("paragraph", 0, "☑☐ [form field]"),
        ("paragraph", 0, "one"),
        ("line", 0, "two"),
        ("paragraph", 0, "漢(kan)"),
        ("paragraph", 0, "backnowhere"),
    ]
    assert found[3].anchors == ("here",)
    assert marks(found[4]) == [(MarkKind.LINK, "back", "#here")]


ODT_MORE = (
    '<style:default-style style:family="paragraph"><style:text-properties fo:language="de" '
    'fo:country="DE"/></style:default-style>'
    '<style:style style:name="V"><style:text-properties text:display="none"/></style:style>'
    '<style:style style:name="B"><style:text-properties fo:font-weight="700" '
    'fo:font-style="italic" '
    'style:text-underline-style="solid"/></style:style>'
    '<style:style style:name="N" style:parent-style-name="B"><style:text-properties '
    'fo:font-weight="normal" style:text-underline-style="none" text:display="true"/></style:style>'
    '<style:style style:name="Quotations"/><style:style style:name="Q1" '
    'style:parent-style-name="Quotations"/><style:style style:name="Preformatted_20_Text"/>'
    '<style:style style:name="Table_20_Heading"/>'
    '<style:style style:name="U"><style:text-properties style:text-position="33% 58%"/>'
    "</style:style>"
)


def test_styles_of_odt():
    def p(style, inner):
        return f'<text:p text:style-name="{style}">{inner}</text:p>'

    body = (
        '<text:h text:outline-level="2">Boote</text:h>'
        + p("V", "no")
        + p("x", 'a<text:span text:style-name="V">no</text:span>b')
        + p("B", 'all <text:span text:style-name="N">some</text:span>')
        + p("Q1", "eins")
        + p("Quotations", "zwei")
        + p("Preformatted_20_Text", "x = 1")
        + p("x", 'x<text:span text:style-name="U">2</text:span>')
    )
    source, found = opened(odt_of(body, ODT_MORE), "odt")
    assert source.language == "de-DE"
    assert described(found) == [
        ("heading", 2, "Boote"),
        ("paragraph", 0, "ab"),
        ("paragraph", 0, "all some"),
        ("quote", 1, "eins"),
        ("quote", 1, "zwei"),
        ("line", 0, "x = 1"),
        ("paragraph", 0, "x²"),
    ]
    assert set(marks(found[2])) >= {
        (MarkKind.BOLD, "all", ""),
        (MarkKind.UNDERLINE, "all", ""),
    }
    assert [text for kind, text, _ in marks(found[2]) if kind is MarkKind.BOLD] == ["all"]


def test_lists_of_odt_that_go_on_and_have_no_number():
    levels = (
        '<text:list-style style:name="L"><text:list-level-style-number text:level="1" '
        'style:num-format="i" style:num-suffix="."/></text:list-style>'
        '<text:list-style style:name="E"><text:list-level-style-number text:level="1" '
        'style:num-format=""/></text:list-style><text:list-style style:name="C">'
        '<text:list-level-style-bullet text:level="1" text:bullet-char="☐"/></text:list-style>'
        '<style:style style:name="P1" style:list-style-name="L"/>'
    )

    def listed(style, *items, more=""):
        inner = "".join(
            f"<text:list-item{m}><text:p>{t}</text:p></text:list-item>" for m, t in items
        )
        return f'<text:list text:style-name="{style}"{more}>{inner}</text:list>'

    again = ' text:continue-numbering="true"'
    body = (
        listed("L", ("", "one"), (' text:start-value="4"', "four"))
        + listed("L", ("", "five"), more=again)
        + listed("L", ("", "anew"))
        + listed("E", ("", "plain"))
        + listed("C", ("", "to do"))
        + listed("none", ("", "dot"))
        + "<text:list><text:list-header><text:p>head</text:p></text:list-header><text:list-item>"
        '<text:p text:style-name="P1">two</text:p><table:table><table:table-row><table:table-cell>'
        "<text:p>in a box</text:p></table:table-cell></table:table-row></table:table>"
        "<text:soft-page-break/></text:list-item></text:list>"
    )
    _, found = opened(odt_of(body, levels), "odt")
    assert [d for d in described(found) if d[0] != "page"] == [
        ("item", 1, "i. one"),
        ("item", 1, "iv. four"),
        ("item", 1, "v. five"),
        ("item", 1, "i. anew"),
        ("item", 1, "plain"),
        ("item", 1, "☐ to do"),
        ("item", 1, "• dot"),
        ("paragraph", 0, "head"),
        ("item", 1, "• two"),
        ("paragraph", 0, "in a box"),
    ]


def test_a_head_of_a_table_of_odt_that_only_its_style_tells():
    def row(*texts, style=""):
        cells = "".join(
            f'<table:table-cell><text:p text:style-name="{style}">{text}</text:p>'
            "</table:table-cell>"
            for text in texts
        )
        return f"<table:table-row>{cells}</table:table-row>"

    body = f"<table:table>{row('A', 'B', style='Table_20_Heading')}{row('1', '2')}</table:table>"
    _, found = opened(odt_of(body, ODT_MORE), "odt")
    assert [(str(b.text), b.headers) for b in found] == [("A  B", ()), ("1  2", ("A", "B"))]


def test_an_odt_file_that_is_locked_is_refused():
    locked = odt("<x/>", {"META-INF/manifest.xml": "<manifest:encryption-data/>"})
    with pytest.raises(InputError, match="locked with a password"):
        opened(locked, "odt")


def test_what_nests_spans_and_lists_very_deep_in_odt_is_read():
    for begin, end in (
        ("text:span", "text:span"),
        ("text:list><text:list-item", "text:list-item></text:list"),
    ):
        inner = "x" if "span" in begin else "<text:p>x</text:p>"
        deep = f"<{begin}>" * 100 + inner + f"</{end}>" * 100
        body = f"<text:p>{deep}</text:p>" if "span" in begin else deep
        assert "".join(odt_texts(body)).strip("• ") == "x"


def test_pages_breaks_and_pictures_of_rtf():
    picture = r"{\pict{\*\picprop{\sp{\sn wzDescription}{\sv a boat}}}\pngblip 8950}"
    known = (
        r"{\*\shppict{\pict{\sp{\sn wzDescription}{\sv a boat}}\pngblip 8950}}"
        r"{\nonshppict{\pict x}}"
    )
    text = r"\pard one\line two\page three\par\pard " + known + r"\par\pard " + picture + r"\par"
    assert described(rtf_blocks(text)) == [
        ("paragraph", 0, "one"),
        ("line", 0, "two"),
        ("page", 0, ""),
        ("line", 0, "three"),
        ("paragraph", 0, "a boat"),
        ("paragraph", 0, "[picture]"),
    ]


@pytest.mark.parametrize(
    ("header", "text", "expected"),
    [
        (r"\ansicpg1251", r"\'ec", "м"),
        (r"\ansicpg65001", r"\'c3\'a9", "é"),
        (r"\ansicpg99999", r"\'e9", "é"),
        (r"\mac", r"\'8e", "é"),
        (r"\pc", r"\'82", "é"),
        (r"\pca", r"\'82", "é"),
        ("", "é", "é"),
        ("", r"\u61537?", "α"),
        ("", r"\u57345?x", "\ue001x"),
        ("", "a\\\nb", "a"),
        (r"{\fonttbl{\f7 Wingdings;}}", r"{\f7\'fe}", "☑"),
    ],
)
def test_bytes_of_rtf_in_many_alphabets(header, text, expected):
    content = b"{\\rtf1\\ansi" + header.encode() + b"\\pard " + text.encode("cp1252") + b"\\par}"
    assert str(opened(content, "rtf")[1][0].text) == expected


def test_looks_and_languages_of_rtf():
    text = (
        r"\pard\lang1033 {\lang1036 un} and {\lang1024 no} {\lang99 odd} {\ul under\ulnone  not} "
        r"{\b0 x}{\super 2\nosupersub  y}{\b bold\plain  plain}\par"
    )
    source, (block,) = opened(b"{\\rtf1\\deflang1033" + text.encode() + b"}", "rtf")
    assert source.language == "en-US"
    assert str(block.text) == "un and no odd under not x² ybold plain"
    told = marks(block)
    assert (MarkKind.LANGUAGE, "un", "fr-FR") in told
    assert (MarkKind.UNDERLINE, "under", "") in told
    assert (MarkKind.BOLD, "bold", "") in told


def test_tables_of_rtf_whose_cells_are_merged_or_never_ended():
    text = (
        r"\trowd\clmgf\cellx1\clmrg\cellx2\cellx3\pard\intbl A\cell\cell C\cell\row"
        r"\trowd\cellx1\cellx2\cellx3\pard\intbl 1\cell 2\cell 3\cell\row\pard after\par"
        r"\trowd\clbrdrb\cellx1\cellx2\pard\intbl X\cell Y\cell\row"
        r"\trowd\cellx1\cellx2\pard\intbl 4\cell 5\cell\row\pard\intbl in none\par\pard end\par"
    )
    assert [(str(b.text), b.headers) for b in rtf_blocks(text)] == [
        ("A  C", ()),
        ("1  2  3", ()),
        ("after", ()),
        ("X  Y", ()),
        ("4  5", ("X", "Y")),
        ("in none", ()),
        ("end", ()),
    ]
    unended = r"\trowd\cellx1\cellx2\pard\intbl A\cell B\cell"
    assert rtf_texts(unended) == ["A  B"]
    bold = r"\trowd\cellx1\cellx2\pard\intbl {\b A}\cell {\b B}\cell\row"
    rows = r"\trowd\cellx1\cellx2\pard\intbl 1\cell 2\cell\row"
    assert [b.headers for b in rtf_blocks(bold + rows)] == [(), ("A", "B")]


def test_styles_bookmarks_and_circles_of_rtf():
    text = (
        r"{\stylesheet{\s1\sbasedon2 One;}{\s2\sbasedon1 Two;}{\s3 heading 3;}{\s4 Source Code;}"
        r"{\s6\outlinelevel1 Part;}{\*\cs5 Char;}}"
        r"{\pard\s1 a\par}{\pard\s3 b\par}{\pard\s4 c\par}{\pard\outlinelevel1 d\par}"
        r"{\pard\s6 g\par}"
        r"\pard{\*\bkmkstart here}{\*\bkmkend here}e{\*\unknown no}\par"
        r"\pard{\field{\*\fldinst PAGE}{\fldrslt 7}} f\par"
    )
    found = rtf_blocks(text)
    assert described(found) == [
        ("paragraph", 0, "a"),
        ("heading", 3, "b"),
        ("line", 0, "c"),
        ("heading", 2, "d"),
        ("heading", 2, "g"),
        ("paragraph", 0, "e"),
        ("paragraph", 0, "7 f"),
    ]
    assert found[5].anchors == ("here",)


def test_long_paragraphs_of_many_pieces_stay_whole():
    many = "".join(run(f"word {n} ", *(["b"] if n % 2 else [])) for n in range(2_000))
    words = "".join(f"word {n} " for n in range(2_000)).strip()
    assert "".join(docx_texts(many)) == words
