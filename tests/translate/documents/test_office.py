"""Word processors' files: what they say beside their text, and what cannot be read."""

import hashlib
import io
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from tests.cli.books import ODT, WORD, docx, odt
from vbraille.errors import InputError
from vbraille.translate.documents.office.annotations import ANNOTATED, annotation, tag_of
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
    'xmlns:fo="urn:oasis:names:tc:opendocument:xmlns:xsl-fo-compatible:1.0"'
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


def odt_of(body):
    content = ODT.format(body).replace(
        "><office:body>",
        f"{NAMES}><office:automatic-styles>{ODT_STYLES}</office:automatic-styles><office:body>",
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


def test_annotations_of_annotations_and_of_what_would_be_markup():
    text = annotation(['lang=fr"><b>', "sup"], annotation(["sub"], "x"))
    found = ANNOTATED.fullmatch(text)
    assert found is not None
    assert found[1] == "lang=frb|sup"
    assert found[2].endswith("x")


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


def test_the_sentence_where_the_reader_is_not_installed():
    """The everyday installation does not have it."""
    code = (
        "import sys\n"
        "sys.modules['anydoc'] = None\n"
        "from vbraille.cli.main import main\n"
        f"sys.exit(main(['page', {str(FILES / 'pandoc.odt')!r}]))\n"
    )
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert said.returncode == 2
    assert said.stdout == ""
    begun = "is in ODT, and what reads that is not installed; "
    command = said.stderr.partition(begun)[2].removesuffix(" installs it\n")
    pip, *arguments = shlex.split(command)
    assert arguments == ["install", "firecrawl-anydoc"]
    # Debian's own pip refuses to install anything: it must be that of the project's environment.
    whose = subprocess.run([pip, "--version"], capture_output=True, text=True, check=True)
    assert sys.prefix in whose.stdout


@pytest.mark.parametrize("form", ["docx", "odt", "rtf"])
def test_what_is_no_such_file(form):
    with pytest.raises(InputError, match="is damaged or no"):
        opened(b"no such thing", form)
