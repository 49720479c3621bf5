"""Word processors' files, EPUB, plain text and braille files as blocks."""

from hashlib import sha256
from pathlib import Path

import pytest

from tests.translate.documents.epubs import epub, packed
from tests.translate.reading import blocks, docx, odt, opened, said, zipped
from vbraille.errors import InputError
from vbraille.translate import BlockKind, Book, Cells, open_source, text_source

FILES = Path(__file__).parent / "documents" / "files"
EMPTY = "⠐⠐⠐"


def run(text, look=""):
    return f"<w:r><w:rPr>{look}</w:rPr><w:t xml:space='preserve'>{text}</w:t></w:r>"


def paragraph(content, properties=""):
    return f"<w:p><w:pPr>{properties}</w:pPr>{content}</w:p>"


def numbered(text, level, numbers="1"):
    at = "" if level is None else f"<w:ilvl w:val='{level}'/>"
    return paragraph(run(text), f"<w:numPr>{at}<w:numId w:val='{numbers}'/></w:numPr>")


def levels(*texts, forms=("decimal",) * 9, extra=""):
    return "".join(
        f"<w:lvl w:ilvl='{at}'><w:start w:val='1'/><w:numFmt w:val='{form}'/>{extra if at else ''}"
        f"<w:lvlText w:val='{text}'/></w:lvl>"
        for at, (text, form) in enumerate(zip(texts, forms, strict=False))
    )


def numbering(levels, nums="<w:num w:numId='1'><w:abstractNumId w:val='0'/></w:num>"):
    return f"<w:abstractNum w:abstractNumId='0'>{levels}</w:abstractNum>{nums}"


# One text that independent programs wrote in many formats.


@pytest.mark.parametrize(
    "name",
    ["hand.html", "harbour.md", "dtbook.xml", "libreoffice.docx", "libreoffice.html", "libreoffice.odt", "pandoc-2.epub", "pandoc-3.epub", "pandoc.docx", "pandoc.html", "pandoc.odt", "word.html"],
)  # fmt: skip
def test_one_text_is_the_same_in_all_formats(name):
    source = open_source(str(FILES / name))
    found = {f"{block.kind.value} {block.words}" for block in source.blocks()}
    wanted = {
        "heading What is brought", "item 1. herring", "item 2. nets", "item • torn", "item 3. salt",
        "row Fish Price", "row cod 12", "quote Count nothing on a Friday.",
    }  # fmt: skip
    assert wanted <= found
    assert (source.title, source.language[:2].lower()) == ("The Harbour", "en")
    assert "nobody counts them.[1]" in source.text
    rows = [block for block in source.blocks() if block.kind is BlockKind.ROW]
    assert [block.headers for block in rows] == [(), ("Fish", "Price"), ("Fish", "Price")]
    assert any(block.kind is BlockKind.NOTE and "Except" in block.text for block in source.blocks())


# DOCX


@pytest.mark.parametrize(
    ("body", "wanted"),
    [
        (paragraph(run("The boat "), "<w:rPr><w:del w:id='1'/></w:rPr>") + paragraph(run("came in.")),
         ["paragraph The boat came in."]),
        (paragraph(run("O"), "<w:framePr w:dropCap='drop'/>") + paragraph(run("nce upon")), ["paragraph Once upon"]),
        (paragraph(run("\uf0fc", "<w:rFonts w:ascii='Wingdings'/>") + run(" \uf061", "<w:rFonts w:ascii='Symbol'/>")),
         ["paragraph ✔ α"]),
        (paragraph(run("a") + "<w:del>" + run("b") + "</w:del>" + run("c", "<w:vanish/>")), ["paragraph a"]),
        (paragraph(run("10") + run("6", "<w:vertAlign w:val='superscript'/>")), ["paragraph 10⁶"]),
        (paragraph("<m:oMath><m:sSup><m:e><m:r><m:t>x</m:t></m:r></m:e><m:sup><m:r><m:t>2</m:t></m:r></m:sup>"
                   "</m:sSup></m:oMath>"), ["paragraph x^{2}"]),
        (paragraph("<w:r><w:drawing/></w:r>"), ["paragraph [drawing]"]),
        ("<w:tbl><w:tr><w:tc><w:tcPr><w:vMerge w:val='restart'/></w:tcPr>" + paragraph(run("a"))
         + "</w:tc><w:tc>" + paragraph(run("b")) + "</w:tc></w:tr><w:tr><w:tc><w:tcPr><w:vMerge/></w:tcPr><w:p/></w:tc>"
         "<w:tc><w:p/></w:tc></w:tr></w:tbl>", ["row a  b", f"row a  {EMPTY}"]),
    ],
)  # fmt: skip
def test_docx_is_read_as_it_is_seen(body, wanted):
    assert said(docx(body), "a.docx") == wanted


@pytest.mark.parametrize(
    ("items", "lists", "wanted"),
    [
        ([("a", 0), ("b", 1), ("c", 0)], levels("%1.", "%1.%2."), ["1. a", "1.1. b", "2. c"]),
        ([("a", 0), ("b", 1)], levels("Article %1", "%1.%2", forms=("upperRoman", "decimal"), extra="<w:isLgl/>"),
         ["Article I a", "1.1 b"]),
        ([("a", None)], levels("%1)", forms=("decimalZero",)), ["01) a"]),
        ([("a", 0), ("b", 1), ("c", 0)], levels("%1.", "%1.%2.").replace(" w:ilvl='0'", "").replace(" w:ilvl='1'", ""),
         ["1. a", "1.1. b", "2. c"]),
        ([("a", 0)], levels("\uf0b7", forms=("bullet",)), ["• a"]),
    ],
)  # fmt: skip
def test_docx_lists_have_the_numbers_that_are_seen(items, lists, wanted):
    body = "".join(numbered(text, at) for text, at in items)
    assert [
        block.text for block in blocks(docx(body, numbering=numbering(lists)), "a.docx")
    ] == wanted


def test_docx_lists_of_one_kind_count_on_unless_they_begin_anew():
    nums = "".join(f"<w:num w:numId='{n}'><w:abstractNumId w:val='0'/>{how}</w:num>" for n, how in (
        ("1", ""), ("2", ""), ("3", "<w:lvlOverride w:ilvl='0'><w:startOverride w:val='1'/></w:lvlOverride>")))  # fmt: skip
    body = numbered("a", 0) + paragraph(run("x")) + numbered("b", 0, "2") + numbered("c", 0, "3")
    found = blocks(docx(body, numbering=numbering(levels("%1."), nums)), "a.docx")
    assert [block.text for block in found] == ["1. a", "x", "2. b", "1. c"]


def test_docx_notes_links_and_languages():
    body = paragraph(
        run("a", "<w:lang w:val='en-GB'/>") + run("où", "<w:lang w:val='fr-FR'/>")
        + "<w:r><w:footnoteReference w:id='2'/></w:r><w:hyperlink w:anchor='x'>" + run("here") + "</w:hyperlink>"
    ) + paragraph("<w:bookmarkStart w:name='x'/>" + run("much more English", "<w:lang w:val='en-GB'/>"))  # fmt: skip
    notes = f"<w:footnote w:id='2'>{paragraph(run('b'))}</w:footnote>"
    source = opened(docx(body, footnotes=notes), "a.docx")
    assert [block.text for block in source.blocks()] == ["aoù[1]here", "much more English", "1. b"]
    assert source.language == "en-GB"
    first = source.block(0)
    assert {(mark.kind.value, mark.target) for mark in first.marks} >= {
        ("language", "fr-FR"), ("note", "#footnote-2"), ("link", "#x"),
    }  # fmt: skip
    assert source.anchor("x") == source.block(1).start


# ODT


@pytest.mark.parametrize(
    ("body", "wanted"),
    [
        ("<table:table><table:table-row table:number-rows-repeated='2'><table:table-cell><text:p>v</text:p>"
         "</table:table-cell><table:table-cell/></table:table-row></table:table>", [f"row v  {EMPTY}"] * 2),
        ("<text:h text:outline-level='2'>A</text:h><text:p>b<text:s text:c='2'/>c<text:line-break/>d</text:p>",
         ["heading A", "paragraph b c", "line d"]),
        ("<text:list text:style-name='L'><text:list-item><text:p>a</text:p><text:list><text:list-item><text:p>b"
         "</text:p></text:list-item></text:list></text:list-item><text:list-item text:start-value='7'><text:p>c"
         "</text:p></text:list-item></text:list>", ["item 1. a", "item 1.1. b", "item 7. c"]),
        ("<text:p>a<text:note><text:note-citation>1</text:note-citation><text:note-body><text:p>b</text:p>"
         "</text:note-body></text:note></text:p>", ["paragraph a[1]", "note 1. b"]),
        ("<text:p>a<text:tracked-changes>x</text:tracked-changes></text:p>", ["paragraph a"]),
    ],
)  # fmt: skip
def test_odt_is_read_as_it_is_seen(body, wanted):
    style = "".join(
        f"<text:list-level-style-number text:level='{level}' style:num-format='1' style:num-suffix='.' "
        f"text:display-levels='{level}'/>".replace("style:num", "style:num")
        for level in (1, 2)
    )
    styles = f"<text:list-style style:name='L'>{style}</text:list-style>"
    assert said(odt(body, styles), "a.odt") == wanted


def test_odt_does_not_repeat_cells_without_end():
    cell = "<table:table-cell table:number-columns-repeated='999'><text:p>a</text:p></table:table-cell>"
    row = f"<table:table-row table:number-rows-repeated='999'>{cell}</table:table-row>"
    source = opened(odt(f"<table:table>{row * 9}</table:table>"), "a.odt")
    assert 9 <= source.text.count("a") < 30_000


# EPUB

NCX = (
    "<ncx xmlns='http://www.daisy.org/z3986/2005/ncx/'><navMap><navPoint><navLabel><text>One & co</text></navLabel>"
    "<content src='a.xhtml'/><navPoint><navLabel><text>Part</text></navLabel><content src='b.xhtml#p'/></navPoint>"
    "</navPoint></navMap></ncx>"
)  # fmt: skip
NAV = "<nav epub:type='toc'><ol><li><a href='a.xhtml'>First</a><li><a href='b.xhtml'>Second</a></ol></nav>"


def test_contents_are_the_nav_or_else_the_ncx():
    ncx = "<item id='n' href='n.ncx' media-type='application/x-dtbncx+xml'/>"
    nav = "<item id='v' href='v.xhtml' properties='nav' media-type='application/xhtml+xml'/>"
    bodies = {"a.xhtml": "<p>one", "b.xhtml": "<p>two<p id='p'>three"}
    source = opened(epub(bodies, items=ncx, **{"OPS/n.ncx": NCX}), "b.epub")
    assert [(h.level, h.title, source.text[h.place :][:3]) for h in source.headings()] == [
        (1, "One & co", "one"), (2, "Part", "thr"),
    ]  # fmt: skip
    page = f"<html xmlns:epub='x'>{NAV}</html>"
    source = opened(
        epub(bodies, items=ncx + nav, **{"OPS/n.ncx": NCX, "OPS/v.xhtml": page}), "b.epub"
    )
    assert [h.title for h in source.headings()] == ["First", "Second"]
    empty = "<html xmlns:epub='x'><nav epub:type='toc'><ol><li>One</ol></nav></html>"
    source = opened(
        epub(bodies, items=ncx + nav, **{"OPS/n.ncx": NCX, "OPS/v.xhtml": empty}), "b.epub"
    )
    assert [h.title for h in source.headings()] == ["One & co", "Part"]
    bodies["a.xhtml"] = "<h1>Own</h1><p>one"
    source = opened(epub(bodies, items=ncx, **{"OPS/n.ncx": NCX}), "b.epub")
    assert [h.title for h in source.headings()] == ["Own", "Part"]


def test_chapters_are_found_marked_or_read_in_part():
    book = epub(
        {"a.xhtml": "<p>one", "B.xhtml": "<p>two", "c.xhtml": "<p>three & <br>four"},
        order=["a.xhtml", "b.xhtml", "x.xhtml", "c.xhtml"],
    )
    source = opened(book, "b.epub")
    assert [block.text for block in source.blocks()] == [
        "one", "two", "[missing chapter: OPS/x.xhtml]", "three &", "four",
    ]  # fmt: skip
    assert source.anchor("OPS/B.xhtml") is None or source.anchor("OPS/b.xhtml") == 4


def test_links_notes_and_files_of_an_epub():
    book = epub(
        {"a.xhtml": "<p>see <a href='b.xhtml#x'>there</a>", "b.xhtml": "<p>b<p id='x'>there"},
        **{"OPS/map.svg": "<svg/>"},
    )
    source = opened(book, "b.epub")
    link = source.block(0).marks[0]
    assert source.text[source.anchor(link.target[1:]) :] == "there"
    assert source.file("OPS/map.svg") == b"<svg/>"
    with pytest.raises(InputError):
        source.file("OPS/none.svg")


def test_pages_of_print_come_from_the_list_of_pages():
    nav = "<item id='v' href='v.xhtml' properties='nav' media-type='application/xhtml+xml'/>"
    page = "<html xmlns:epub='x'><nav epub:type='page-list'><ol><li><a href='a.xhtml#p'>7</a></ol></nav></html>"
    book = epub({"a.xhtml": "<p>one<p id='p'>two"}, items=nav, **{"OPS/v.xhtml": page})
    assert [(b.kind.value, b.page_number or b.text) for b in blocks(book, "b.epub")] == [
        ("paragraph", "one"), ("page", "7"), ("paragraph", "two"),
    ]  # fmt: skip


def test_a_book_in_braille_is_not_translated():
    package = epub({"a.xhtml": "<ul><li>⠁⠃</li></ul><p>⠉ é"})
    import io
    from zipfile import ZipFile

    members = {
        name: ZipFile(io.BytesIO(package)).read(name)
        for name in ZipFile(io.BytesIO(package)).namelist()
    }
    del members["mimetype"]
    source = opened(packed(members, "application/ebrl+zip"), "b.ebrl")
    assert source.in_cells
    item, paragraph = source.blocks()
    assert Book(source).cells(item).to_unicode() == "⠸⠲⠀⠁⠃"
    assert paragraph.cells.to_unicode() == "⠉⠀⠿"
    assert "1 other character" in source.notes()[0]


# Plain text


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        ("one\ntwo\n\nthree", ["one two", "three"]),
        ("- a\n- b\nand c", ["- a", "- b and c"]),
        ("Which?\nA. First\nB. Second", ["Which?", "A. First", "B. Second"]),
        ("in the year\n1931. It was", ["in the year 1931. It was"]),
        ("1. a\n2. b\n\tc", ["1. a", "2. b c"]),
        ("well-\nknown pre-\nand post-war", ["well-known pre- and post-war"]),
        ("Schiff\u00ad\nfahrt", ["Schifffahrt"]),
        ("_\bo_\bn_\be b\bbo\bol\bld\bd", ["one bold"]),
        ("cafe\u0301 10\u202f000", ["café 10\u00a0000"]),
        ("a\fb\r\n\r\nc\rd", ["a", "b", "c d"]),
    ],
)  # fmt: skip
def test_paragraphs_and_items_of_plain_text(text, wanted):
    assert [block.text for block in text_source(text).blocks()] == wanted


def test_lines_are_kept_if_asked_for():
    lines = text_source("one\n  two\n\nthree\n", keep_lines=True)
    assert [(b.kind.value, b.text) for b in lines.blocks()] == [
        ("line", "one"), ("line", "  two"), ("line", ""), ("line", "three"),
    ]  # fmt: skip


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-32", "cp1252"])
def test_encodings_that_are_found(encoding):
    source = opened("Größe – naïve “text” of a page".encode(encoding))
    assert source.text == "Größe – naïve “text” of a page"
    assert len(source.notes()) == (encoding == "cp1252")


def test_texts_of_other_scripts_are_guessed_and_others_named():
    greek = "Όλοι οι άνθρωποι γεννιούνται ελεύθεροι και ίσοι στην αξιοπρέπεια και τα δικαιώματα."
    source = opened(greek.encode("cp1253"))
    assert source.text == greek
    assert "is not UTF-8" in source.notes()[0]
    assert source.notes() == []
    assert opened("dzień".encode("cp1250"), encoding="cp1250").text == "dzień"
    with pytest.raises(InputError, match="unknown text encoding"):
        opened("a", encoding="utf-99")


# Braille files


def test_brf_and_unicode_braille_are_lines_and_pages():
    source = opened(b",! 9vi*t\r\n\r\n  #b\x0cx\x1a", "a.brf")
    assert source.in_cells
    found = [(b.kind.value, b.page_number or b.cells.to_unicode()) for b in source.blocks()]
    assert found == [
        ("page", "1"), ("line", "⠠⠮⠀⠔⠧⠊⠡⠞"), ("line", ""), ("line", "⠀⠀⠼⠃"), ("page", "2"), ("line", "⠭"),
    ]  # fmt: skip
    assert opened("⠁⣿\n⠃").form == "unicode-braille"


@pytest.mark.parametrize("stray", [b"\x1b", b"\x07", b"\x80"])
def test_stray_bytes_are_passed_over_and_counted(stray):
    source = opened(b"AB" + stray + b"C\xa0D\n", "a.brf")
    assert source.block(0).cells.to_unicode() == "⠁⠃⠉⠀⠙"
    assert source.gather(9)
    assert "1 character" in source.notes()[0]


def test_a_space_in_a_row_of_pef_is_a_blank_cell():
    pef = (
        "<?xml version='1.0'?><pef xmlns='http://www.daisy.org/ns/2008/pef'><head><meta xmlns:dc='http://purl.org/dc/"
        "elements/1.1/'><dc:title>T</dc:title></meta></head><body><volume><section><page><row>⠁ ⠃x</row><row/></page>"
        "</section></volume></body></pef>"
    )  # fmt: skip
    source = opened(pef, "a.pef")
    lines = [block for block in source.blocks() if block.kind is BlockKind.LINE]
    assert [line.cells.to_unicode() for line in lines] == ["⠁⠀⠃", ""]
    assert (source.title, len(source.notes())) == ("T", 1)


# RTF, without LibreOffice


def test_rtf_is_plain_text_where_nothing_better_is(monkeypatch):
    monkeypatch.setenv("PATH", "")
    source = opened(rb"{\rtf1\ansi One\par caf\'e9 \u128512?\par}", "a.rtf")
    assert [block.text for block in source.blocks()] == ["One", "café 😀"]
    assert "plain text" in source.notes()[0]


def test_rtf_is_read_as_libreoffice_converts_it(monkeypatch, tmp_path):
    (tmp_path / "made.docx").write_bytes(docx(paragraph(run("One"), "<w:outlineLvl w:val='0'/>")))
    office = tmp_path / "soffice"
    office.write_text(
        f'#!/bin/sh\nfor last; do :; done\ncp {tmp_path}/made.docx "${{last%.rtf}}.docx"\n'
    )
    office.chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:/bin:/usr/bin")
    content = rb"{\rtf1 One\par}"
    source = opened(content, "a.rtf")
    assert [(block.kind.value, block.text) for block in source.blocks()] == [("heading", "One")]
    assert source.sha256() == sha256(content).hexdigest()
    assert source.notes() == []


# Sources


@pytest.mark.parametrize("name", ["pandoc-3.epub", "harbour.md", "file2brl.brf", "libreoffice.odt"])
def test_a_place_is_an_index_of_the_text(name):
    source = open_source(str(FILES / name))
    found = list(source.blocks())
    assert source.text == "\n".join(block.text for block in found)
    assert [block.number for block in found] == list(range(len(found)))
    assert list(source.blocks(len(found) - 1, -1)) == found[::-1]
    for block in found:
        assert source.text[block.start : block.end] == block.text
        assert source.block_at(block.start) is source.block_at(block.end) is block
        assert all(0 <= mark.start <= mark.end <= len(block.text) for mark in block.marks)
        assert all(source.anchor(anchor) is not None for anchor in block.anchors)
    assert source.block_at(source.end + 1) is None
    assert (source.progress(0), source.progress(source.end)) == (0.0, 1.0)
    assert source.block(-1) is None
    assert source.block(len(found)) is None


def test_a_long_paragraph_comes_in_pieces():
    text = "One sentence of some words. " * 1_000
    source = text_source(text)
    found = list(source.blocks())
    assert "".join(block.text for block in found) == text.strip()
    assert [block.continues for block in found] == [False, *[True] * (len(found) - 1)]
    assert all(block.text.endswith(". ") for block in found[:-1])


def test_a_source_is_read_as_far_as_it_is_asked_for():
    source = text_source("one\n\n" * 1_000)
    assert not source.complete
    assert source.block(10).text == "one"
    assert source.end < 100
    assert 0 < source.progress(40) < 0.05
    assert source.gather(10_000)
    assert len(list(source.blocks())) == 1_000


def test_the_file_s_digest_is_that_of_its_bytes(tmp_path):
    path = tmp_path / "a.txt"
    path.write_text("one")
    assert open_source(str(path)).sha256() == sha256(b"one").hexdigest()
    archive = tmp_path / "a.docx"
    archive.write_bytes(docx(paragraph(run("one"))))
    assert open_source(str(archive)).sha256() == sha256(archive.read_bytes()).hexdigest()


def test_unlike_books_are_named():
    for content, name, word in (
        (b"%PDF-1.4", "a.pdf", "PDF"),
        (zipped({"xl/a.xml": ""}), "a.xlsx", "Excel"),
        (b"\x89PNG\r\n\x1a\n", "a.png", "PNG"),
        (b"<svg/>", "a.svg", "picture"),
        (b"<FictionBook/>", "a.fb2", "FB2"),
        (b"x" * 60 + b"BOOKMOBI" + bytes(100), "a.mobi", "Kindle"),
    ):
        with pytest.raises(InputError, match=word):
            opened(content, name)
    assert Cells.from_unicode("⠁").to_brf() == "A"
