"""``vbraille page`` of books in several languages."""

import pytest

from tests.cli import program
from tests.translate.documents.epubs import epub

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
    assert said.err == program.line_width(40, "French uncontracted braille")
    lines = call("page", bilingual, "--cells", "40", "--language", "fr").out
    assert lines.endswith(braille(call, tmp_path, FRENCH, "--language", "fr"))
