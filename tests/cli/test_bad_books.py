"""Bad books of every form, by the command itself: one sentence, exit code 2, no end of memory."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests.cli import books
from tests.cli.books import BOMB, ODT, WORD, XHTML, docx, epub, item, locked, odt, with_bomb
from tests.cli.judging import FILES, SAMPLES, sentence, usable
from tests.cli.program import PROGRAM
from tests.tiers import by_tier, heavy

OLE = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + bytes(2000)
DEEP = "<w:p>" * 5_000 + "<w:r><w:t>x</w:t></w:r>" + "</w:p>" * 5_000
CHAPTER = XHTML.format("<p>one</p>")
ENCRYPTION = (
    '<encryption xmlns="urn:oasis:names:tc:opendocument:xmlns:container">'
    '<EncryptedData xmlns="http://www.w3.org/2001/04/xmlenc#">'
    '<EncryptionMethod Algorithm="http://www.w3.org/2001/04/xmlenc#aes128-cbc"/>'
    '<CipherData><CipherReference URI="a.xhtml"/></CipherData></EncryptedData></encryption>'
)


BAD = {
    "epub without package": (epub({}, members={"META-INF/container.xml": "<x/>"}), ".epub"),
    "epub of no chapters": (epub({}), ".epub"),
    "epub whose package is itself": (
        books.archive({"META-INF/container.xml": books.CONTAINER.format("META-INF/container.xml")}),
        ".epub",
    ),
    "epub of paths leading out": (
        epub(
            {"../../../etc/passwd": "x"},
            spine='<itemref idref="out"/>',
            manifest=item("out", "../../../../../../etc/passwd"),
        ),
        ".epub",
    ),
    "epub of an absolute path": (
        epub({}, spine='<itemref idref="out"/>', manifest=item("out", "/etc/passwd")),
        ".epub",
    ),
    "epub of a far chapter": (
        epub({}, spine='<itemref idref="out"/>', manifest=item("out", "https://example.org/x")),
        ".epub",
    ),
    "epub of missing chapters": (
        epub({}, spine='<itemref idref="a"/>', manifest=item("a", "no.xhtml")),
        ".epub",
    ),
    "epub locked in the zip": (locked(epub({"a.xhtml": CHAPTER}), "a.xhtml"), ".epub"),
    "epub locked by Adobe": (
        epub(
            {"a.xhtml": CHAPTER},
            members={
                "META-INF/rights.xml": "<x/>",
                "META-INF/encryption.xml": ENCRYPTION,
            },
        ),
        ".epub",
    ),
    "docx locked": (OLE + "EncryptedPackage".encode("utf-16-le"), ".docx"),
    "docx locked in the zip": (locked(docx(WORD.format("x")), "word/document.xml"), ".docx"),
    "docx without document": (docx(members={"word/a.xml": "<x/>"}), ".docx"),
    "docx of broken XML": (docx(WORD[:-20]), ".docx"),
    "docx of deep XML": (docx(WORD.format(DEEP)), ".docx"),
    "docx of nothing": (docx(WORD.format("")), ".docx"),
    "doc": (OLE + "WordDocument".encode("utf-16-le"), ".doc"),
    "odt without content": (odt(), ".odt"),
    "odt of broken XML": (odt(ODT[:-20]), ".odt"),
    "odt of nothing": (odt(ODT.format("")), ".odt"),
    "odt locked": (
        odt(
            b"\1\2\3",
            {
                "META-INF/manifest.xml": '<manifest:manifest xmlns:manifest="urn:oasis:'
                'names:tc:opendocument:xmlns:manifest:1.0"><manifest:file-entry manifest:full-path='
                '"content.xml" manifest:media-type="text/xml"><manifest:encryption-data '
                'manifest:checksum="x"/></manifest:file-entry></manifest:manifest>'
            },
        ),
        ".odt",
    ),
    "rtf of nothing": (b"{\\rtf1}", ".rtf"),
    "rtf of brackets": (b"{\\rtf1" + b"{" * 200_000, ".rtf"),
    "html of scripts": (b"<html><script>document.write('one')</script></html>", ".html"),
    "html of nothing": (b"<!DOCTYPE html>", ".html"),
    "markdown of blanks": (b" \n\n \n", ".md"),
    "dtbook of nothing": (b"<?xml version='1.0'?><dtbook/>", ".xml"),
    "dtbook cut off": (b"<?xml version='1.0'?><dtbook><book>", ".xml"),
    "pef of nothing": (
        b"<?xml version='1.0'?><pef xmlns='http://www.daisy.org/ns/2008/pef'/>",
        ".pef",
    ),
    "pef named so": (b"no XML at all", ".pef"),
    "brf of blanks": (b" \r\n\f", ".brf"),
    "a zip of nothing": (b"PK\5\6" + bytes(18), ".epub"),
}
BAD_BY_ENTITIES = {
    "epub": (epub({"a.xhtml": BOMB.format(root="html") + XHTML.format("<p>&j;</p>")}), ".epub"),
    "package": (
        books.archive(
            {
                "META-INF/container.xml": BOMB.format(root="container")
                + books.CONTAINER.format("&j;"),
            }
        ),
        ".epub",
    ),
    "docx": (
        docx(BOMB.format(root="x") + WORD.format("<w:p><w:r><w:t>&j;</w:t></w:r></w:p>")),
        ".docx",
    ),
    "odt": (odt(BOMB.format(root="x") + ODT.format("<text:p>&j;</text:p>")), ".odt"),
    "dtbook": (
        (
            BOMB.format(root="dtbook") + "<dtbook><book><bodymatter><p>&j;</p></bodymatter>"
            "</book></dtbook>"
        ).encode(),
        ".xml",
    ),
    "pef": (
        (
            BOMB.format(root="pef") + "<pef xmlns='http://www.daisy.org/ns/2008/pef'><body>"
            "<volume><section><page><row>&j;</row></page></section></volume></body></pef>"
        ).encode(),
        ".pef",
    ),
    "passwd": (
        epub(
            {
                "a.xhtml": "<?xml version='1.0'?><!DOCTYPE html [<!ENTITY p SYSTEM 'file:///etc/"
                "passwd'>]>" + XHTML.format("<p>&p;</p>")
            }
        ),
        ".epub",
    ),
}


@pytest.mark.parametrize("name", BAD)
def test_books_with_nothing_to_read_in_them(call, tmp_path, name):
    content, suffix = BAD[name]
    path = tmp_path / f"book{suffix}"
    path.write_bytes(content)
    said = call("page", path)
    assert said.code == 2
    told = sentence(said)
    assert str(path) in told or "book" in told
    assert re.search(r"[;:]", told), "it says what to do"


@pytest.mark.parametrize("name", BAD_BY_ENTITIES)
def test_entities_are_not_unfolded(call, tmp_path, name):
    content, suffix = BAD_BY_ENTITIES[name]
    path = tmp_path / f"book{suffix}"
    path.write_bytes(content)
    said = call("page", path, "--format", "text")
    usable(said)
    assert len(said.out) < 2_000
    assert "root:" not in said.out


@pytest.mark.parametrize("name", SAMPLES)
def test_books_cut_short(call, tmp_path, name):
    content = (FILES / name).read_bytes()
    path = tmp_path / name
    read = 0
    for eighth in range(1, 8):
        path.write_bytes(content[: len(content) * eighth // 8])
        said = call("page", path, "--format", "text")
        read += usable(said)
        if name.endswith((".epub", ".docx", ".odt")):
            assert said.code == 2
    if name.endswith((".html", ".md", ".brf")):
        assert read >= 2  # text that is there is read


@pytest.mark.parametrize("suffix", [Path(name).suffix for name in SAMPLES] + [".txt"])
def test_empty_files(call, tmp_path, suffix):
    path = tmp_path / f"book{suffix}"
    path.touch()
    assert sentence(call("page", path)).startswith(f"{path} is empty; give a")


@pytest.mark.parametrize("form", [None, "epub", "docx", "rtf", "html", "brf", "pef", "markdown"])
@pytest.mark.parametrize("file", ["/dev/zero", "/dev/null", "/dev/urandom", "."])
def test_what_is_no_file(call, file, form):
    said = call("page", file, *(() if form is None else ("--form", form)))
    assert said.code == 2
    sentence(said)


def test_bytes_that_are_no_braille(call, tmp_path):
    path = tmp_path / "book.brf"
    path.write_bytes(b",! ,h>b|r\r\n\x80\xff\1\2 one\r\n")
    said = call("page", path)
    assert said.code == 0
    assert "4 characters that are no braille" in said.err


def test_forms_and_options_that_do_not_fit(call, tmp_path):
    epub_file, text = FILES / "pandoc-3.epub", tmp_path / "book.txt"
    text.write_text("one\n")
    for arguments, said in (
        ((epub_file, "--encoding", "latin-1"), "read as epub, for which there is no --encoding"),
        ((epub_file, "--keep-lines"), "read as epub, for which there is no --keep-lines"),
        ((text, "--form", "epbu"), "unknown file format 'epbu'; the nearest is epub"),
        ((text, "--form", "epub"), ""),
        ((FILES / "brailleutils.pef", "--table", "fr-bfu-g2.ctb"), "is in braille already; leave"),
        ((FILES / "brailleutils.pef", "--grade", "2"), "is in braille already; leave out --grade"),
    ):
        found = call("page", *arguments)
        assert found.code == 2
        assert said in sentence(found)


def test_a_form_that_is_named_goes_before_all_else(call, tmp_path):
    path = tmp_path / "book.txt"
    path.write_text("<h1>One</h1>two")
    assert "<h1>" in call("page", path, "--format", "text").out
    said = call("page", path, "--format", "text", "--form", "html").out
    assert [line.strip() for line in said.splitlines()] == ["One", "two"]
    path.write_text("<html><p>One")
    assert "<html>" in call("page", path, "--format", "text", "--form", "text").out


def test_the_language_of_a_book_chooses_its_table(call, tmp_path):
    path = tmp_path / "book.html"
    path.write_text("<html lang='fr-CA'><p>Les bateaux rentrent.")
    assert "French uncontracted braille\n" in call("page", path).err
    assert "German contracted braille, grade 2\n" in call("page", path, "--language", "de").err
    path.write_text("<html lang='fre'><p>Les bateaux rentrent.")
    assert "French uncontracted braille\n" in call("page", path).err
    assert "French contracted braille, grade 2\n" in call("page", path, "--grade", "2").err
    assert (
        "Unified English uncontracted braille, grade 1\n"
        in call("page", path, "--table", "en-ueb-g1.ctb").err
    )
    path.write_text("<html lang='tlh-x'><p>Heghlu'meH QaQ jajvam.")
    assert "Unified English contracted braille, grade 2\n" in call("page", path).err


@pytest.mark.parametrize("name", by_tier(["pandoc-3.epub", "file2brl.brf"], SAMPLES, SAMPLES))
def test_standard_input_is_read_like_the_file(name):
    form = {".md": ("--form", "markdown"), ".brf": ("--form", "brf")}.get(Path(name).suffix, ())
    path = FILES / name
    wanted = run_page(path, "--format", "text")
    with path.open("rb") as stream:
        found = run_page("-", "--format", "text", *form, stdin=stream)
    assert found.stdout == wanted.stdout
    assert found.stdout.strip()


def run_page(*arguments, **options):
    options = {"stdin": subprocess.DEVNULL, **options}
    return subprocess.run(
        [*PROGRAM, "page", *map(str, arguments)],
        capture_output=True,
        check=False,
        timeout=120,
        **options,
    )


# A process between: the memory of a child counts from what its parent has when it is started.
MEASURED = """
import resource, subprocess, sys
resource.setrlimit(resource.RLIMIT_CPU, (60, 60))
process = subprocess.Popen(sys.argv[1:], stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
tail = b""
while chunk := process.stdout.read(1 << 16):
    tail = (tail + chunk)[-4096:]
code = process.wait()
usage = resource.getrusage(resource.RUSAGE_CHILDREN)
print(code, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1e3, flush=True)
sys.stdout.buffer.write(tail)
"""


def bounded(path, *arguments):
    """Run the command on a file; how long it computed, and how much memory it took, in MB."""
    command = [sys.executable, "-c", MEASURED, *PROGRAM, "page", str(path), *arguments]
    done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, check=True)
    numbers, _, said = done.stdout.decode().partition("\n")
    code, seconds, megabytes = map(float, numbers.split())
    return int(code), said, seconds, megabytes


CHAPTER_BOMB = epub(
    {"a.xhtml": CHAPTER}, manifest=item("z", "z.xhtml"), spine='<itemref idref="z"/>'
)
LARGE = {
    "epub": lambda: (with_bomb(CHAPTER_BOMB, "z.xhtml", 1500), ".epub"),
    "epub that lies": lambda: (with_bomb(CHAPTER_BOMB, "z.xhtml", 1500, told=100), ".epub"),
    "docx": lambda: (
        with_bomb(docx(members={"word/a.xml": ""}), "word/document.xml", 1500),
        ".docx",
    ),
    "docx that lies": lambda: (
        with_bomb(docx(members={"word/a.xml": ""}), "word/document.xml", 1500, told=100),
        ".docx",
    ),
    "docx with a picture": lambda: (
        with_bomb(
            docx(WORD.format("<w:p><w:r><w:t>one</w:t></w:r></w:p>")), "word/media/a.png", 1500
        ),
        ".docx",
    ),
    "odt": lambda: (with_bomb(odt(), "content.xml", 1500), ".odt"),
    "html": lambda: (b"<div>" * 1_000_000 + b"one" + b"</div>" * 1_000_000, ".html"),
    "html of tables": lambda: (b"<table><tr><td>" * 1_000_000 + b"one", ".html"),
    "html of emphasis": lambda: (b"<b><i>" * 500_000 + b"one", ".html"),
    "dtbook": lambda: (b"<dtbook>" + b"<p>" * 1_000_000 + b"one", ".xml"),
    "markdown": lambda: (b">" * 20_000 + b" one\n", ".md"),
    "rtf": lambda: (b"{\\rtf1" + b"{" * 1_000_000 + b"one", ".rtf"),
    "brf": lambda: (b"one " * 5_000_000, ".brf"),
}


@heavy  # processes of seconds
@pytest.mark.parametrize("name", LARGE)
def test_time_and_memory_have_bounds(tmp_path, name):
    content, suffix = LARGE[name]()
    path = tmp_path / f"book{suffix}"
    path.write_bytes(content)
    code, said, seconds, megabytes = bounded(path, "--format", "text", "--lines", "1-3")
    assert "Traceback" not in said
    assert "fault of vbraille" not in said
    assert code == 2 or (code == 0 and "one" in said), said
    assert seconds < 30
    assert megabytes < 700
