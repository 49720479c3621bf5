"""``vbraille page`` of whole books: by several processes, and in several languages."""

import zipfile
from resource import RUSAGE_CHILDREN, getrusage

import pytest

from tests.tiers import heavy
from tests.translate.documents.epubs import epub

SIZE = 140_000  # characters, of which the processes that translate get some, too
PAGE = ("--layout", "bana", "--cells", "40", "--lines", "25")


@pytest.fixture(scope="module")
def book(texts, tmp_path_factory):
    """A book with headings, lists, emphasis, French, print pages and what no table knows."""
    english = (texts / "english.txt").read_text().strip().split("\n\n")
    parts, size = ["<html lang='en'><title>Long</title>"], 0
    while size < SIZE:
        n = len(parts)
        text = english[n % len(english)]
        parts.append(
            f"<h2>Part {n}</h2><span role='doc-pagebreak' aria-label='{n}'></span><p>{text}"
            f" <em>all of it</em> \u4e2d</p><ul><li>one<li>two</ul><p lang='fr'>déjà vu, naïve</p>"
        )
        size += len(text) + 60
    path = tmp_path_factory.mktemp("book") / "long.html"
    path.write_text("\n".join(parts), encoding="utf-8")
    return path


FORMS = [
    pytest.param(("--format", "brf", "--grade", "1", *PAGE), id="pages"),
    pytest.param(("--format", "unicode"), id="unicode", marks=heavy),
    pytest.param(("--format", "brf", "--cells", "40"), id="brf", marks=heavy),
    pytest.param(("--format", "text"), id="text", marks=heavy),
    pytest.param(("--format", "dots", "--lines", "30-"), id="dots", marks=heavy),
    pytest.param(("--format", "pef"), id="pef", marks=heavy),
    pytest.param(("--format", "pef", *PAGE), id="pef on pages", marks=heavy),
    pytest.param(("--format", "ebrl"), id="ebrl", marks=heavy),
]


@pytest.mark.parametrize("options", FORMS)
def test_more_processes_write_the_same_bytes(call, book, tmp_path, options):
    written = []
    for workers in (1, 2):
        out = tmp_path / f"{workers}"
        before = getrusage(RUSAGE_CHILDREN).ru_utime
        said = call("page", book, *options, "--workers", workers, "--out", out)
        assert said.code == 0
        assert "does not know" in said.err
        assert (getrusage(RUSAGE_CHILDREN).ru_utime > before) == (workers > 1)
        if "ebrl" in options:  # which has the time of its writing in it
            with zipfile.ZipFile(out) as archive:
                names = sorted(set(archive.namelist()) - {"package.opf"})
                written.append((said.err, [(name, archive.read(name)) for name in names]))
        else:
            written.append((said.err, out.read_bytes()))
    assert written[0] == written[1]


@pytest.mark.parametrize("workers", ["0", "65"])
def test_a_number_of_processes_out_of_range_is_said(call, text, workers):
    said = call("page", text, "--workers", workers)
    assert (said.code, said.out) == (2, "")
    assert said.err == f"vbraille: --workers is {workers}; it must be 1 to 64\n"


BODY = "<p>I know that the people have it.</p><p lang='fr'>Le ça est très bien, parce que.</p>"
FRENCH = "Le ça est très bien, parce que."


def braille(call, tmp_path, text, *options):
    """Lines of a text by itself."""
    path = tmp_path / "one.txt"
    path.write_text(text, encoding="utf-8")
    return call("page", path, "--cells", "40", *options).out


@pytest.fixture(params=["html", "epub"])
def bilingual(tmp_path, request):
    """A book in English with a French paragraph."""
    path = tmp_path / f"two.{request.param}"
    if request.param == "html":
        path.write_text(f"<html lang='en'><title>x</title>{BODY}", encoding="utf-8")
    else:
        path.write_bytes(epub({"a.xhtml": BODY}))
    return path


@pytest.mark.parametrize("grade", [(), ("--grade", "1")])
def test_a_french_passage_has_the_french_table_of_the_grade(call, tmp_path, bilingual, grade):
    def joined(lines):
        return lines.replace("\u2800", "").replace("\n", "")

    found = joined(call("page", bilingual, "--cells", "40", *grade).out)
    wanted = joined(braille(call, tmp_path, FRENCH, "--language", "fr", *grade))
    assert found.endswith(f"⠐⠷⠋⠗⠄{wanted}⠠⠐⠾")
    by_own = joined(braille(call, tmp_path, FRENCH, *grade))
    own = joined(call("page", bilingual, "--cells", "40", "--foreign", "own", *grade).out)
    assert own.endswith(by_own)
    assert wanted != by_own


def test_a_language_that_the_reader_chose_is_the_book_s_own(call, tmp_path, bilingual):
    said = call("page", bilingual, "--cells", "40", "--language", "fr", "--format", "text")
    assert said.err == "line width: 40 cells, table fr-bfu-comp6.utb\n"
    lines = call("page", bilingual, "--cells", "40", "--language", "fr").out
    assert lines.endswith(braille(call, tmp_path, FRENCH, "--language", "fr"))
