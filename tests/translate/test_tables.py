"""Text to cells: liblouis first, as the text stands; then what it leaves undefined."""

import os
import signal
import threading

import pytest

import vbraille
from vbraille.errors import InputError
from vbraille.translate import BrailleTable, Mark, MarkKind, Undefined, find_table, list_tables
from vbraille.translate.liblouis import LOUIS
from vbraille.translate.spellings import Kind

UNENDING = "— - —https://example.org"  # German contracted braille does not come to an end with it


def braille(text, language, **how):
    return vbraille.translate_text(text, language=language, **how).to_unicode()


@pytest.mark.parametrize(
    ("language", "text", "cells"),
    [
        ("el", "(άλφα) «βήτα» [γάμμα]", "⠶⠐⠁⠇⠋⠁⠶⠀⠦⠃⠐⠜⠞⠁⠴⠀⠷⠛⠐⠁⠍⠍⠁⠾"),  # known beside letters only
        ("el", "τι κάνεις\u037e ναι\u0387", "⠞⠊⠀⠅⠐⠁⠝⠩⠎⠢⠀⠝⠣⠆"),
        ("el", "τι κάνεις; ναι·", "⠞⠊⠀⠅⠐⠁⠝⠩⠎⠢⠀⠝⠣⠆"),
        ("fa", "Windows", "⠺⠊⠝⠙⠕⠺⠎"),  # without the table's dots 7 and 8
        ("pa", "ਸਖਤ਼", "⠎⠨⠐⠞"),
        ("ar", "م\u064e\u0651د", "⠠⠍⠂⠙"),
        ("ar", "م\u0651\u064eد", "⠠⠍⠂⠙"),
        ("he", "שׁלום", braille("שלום", "he")),
    ],
)
def test_a_text_is_written_as_liblouis_writes_it_where_it_stands(language, text, cells):
    assert braille(text, language) == cells


@pytest.mark.parametrize(
    ("language", "text", "like"),
    [
        ("bn", "ভাত।", "ভাত⠲"),
        ("it", "porta-bagagli", "porta⠤bagagli"),
        ("en", "‹yes›", "'yes'"),
        ("lt", "Müller, André", "Muller, Andre"),
        ("ar", "٣٫٥", "٣.٥"),
        ("it", "5′", "5'"),
        ("en", "🅽🅴🆆", "NEW"),
        ("en", "🇫🇷", "[FR]"),
        ("de", "Schiff\u00adfahrt", "Schifffahrt"),
        ("fr", "10⁶", "10^6"),
        ("de", "ja\u0387", "ja."),  # the table has a blank for the sign that it is equal to
    ],
)
def test_what_a_table_lacks_is_spelled_plainly(language, text, like):
    def spelled(text):
        return braille(text, language)

    assert spelled(text) in (spelled(like), spelled(like.replace("^", "")), spelled(text))
    table = BrailleTable(find_table(language))
    assert table.unknown(text) == ""
    if "^" not in like:
        assert spelled(text) == spelled(like)


def test_no_usual_sign_is_a_marker_in_any_language_s_table():
    usual = "•-–—‘’“”‹›«»′″।.,;:!?()…/*'\"[]éüa"
    marked = []
    for language in {table.language for table in list_tables() if table.language}:
        written = BrailleTable(find_table(language)).write(" ".join(usual))
        marked += [(language, part) for kind, part in written.otherwise if kind is Kind.MARKED]
    assert marked == []


def test_what_nothing_can_write_is_marked_as_one_chooses():
    assert braille("a\ue123\ue124b", "en") == braille("a[?]b", "en")
    assert braille("a\ue123b", "en", undefined="drop") == braille("ab", "en")
    assert braille("☃", "de") == braille("[snowman]", "de")
    assert BrailleTable("de-g2.ctb").unknown("ab\ue123") == "\ue123"
    with pytest.raises(InputError, match="undefined is 'x'; it must be mark or"):
        braille("a", "en", undefined="x")
    assert list(Undefined) == ["mark", "drop"]


def test_superscripts_have_the_table_s_sign():
    assert braille("10⁶", "en") == "⠼⠁⠚⠰⠔⠼⠋"
    assert braille("H₂O", "en") == "⠠⠓⠰⠢⠼⠃⠠⠕"
    assert braille("10⁶", "de") == "⠼⠁⠚⠌⠖"


def test_emphasis_is_that_of_the_table():
    table = BrailleTable("en-ueb-g2.ctb")
    bold, link = Mark(MarkKind.BOLD, 0, 3), Mark(MarkKind.LINK, 0, 3, "x")
    assert table.write("one", [bold]).cells(3).to_unicode() == "⠘⠂⠐⠕"
    assert table.write("one", [link]).cells(3).to_unicode() == "⠐⠕"


@pytest.mark.parametrize(
    "text", ["", "a", "the world", "a\0b", "\ud800x", "\t\n", "☃ ü\u0301", "🇫🇷👍🏽"]
)
@pytest.mark.parametrize("table", ["en-ueb-g2.ctb", "de-g2.ctb", "zh-tw.ctb", "ar.tbl"])
def test_cells_and_text_lead_to_each_other(table, text):
    cells = BrailleTable(table).write(text).cells(len(text), 100)
    assert cells.end == 100 + len(text)
    assert (cells.starts[1:] >= cells.starts[:-1]).all()
    assert all(100 <= start < cells.end for start in cells.starts)
    for cell in range(len(cells)):
        start, after = cells.source(cell)
        assert start < after <= cells.end
        assert cells.of_source(start)[0] <= cell


def test_a_translation_that_does_not_end_is_made_word_by_word():
    written = BrailleTable("de-g2.ctb").write(f"Haus {UNENDING}")
    assert not written.otherwise
    cells = vbraille.translate_text(f"Haus {UNENDING}", language="de")
    words = [braille(word, "de") for word in ("Haus", *UNENDING.split())]
    assert cells.to_unicode() == "\u2800".join(words)
    assert cells.end == len(f"Haus {UNENDING}")


def test_a_child_that_is_killed_is_asked_again():
    table, right = BrailleTable("en-ueb-g2.ctb"), braille("the quick brown fox", "en")
    killed = 0
    for _ in range(20):
        assert LOUIS._child is not None
        os.kill(LOUIS._child.pid, signal.SIGKILL)
        killed += 1
        assert table.translate("the quick brown fox").to_unicode() == right
    assert killed == 20


def test_threads_ask_one_after_the_other():
    right, wrong = braille("the quick brown fox", "en"), []

    def ask():
        wrong.extend(n for n in range(50) if braille("the quick brown fox", "en") != right)

    threads = [threading.Thread(target=ask) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert wrong == []


def test_a_fork_has_a_child_of_its_own():
    right = braille("the quick brown fox", "en")
    forked = os.fork()
    if not forked:
        os._exit(braille("the quick brown fox", "en") != right)
    assert os.waitstatus_to_exitcode(os.waitpid(forked, 0)[1]) == 0
    assert braille("the quick brown fox", "en") == right


@pytest.mark.parametrize("name", ["en-ueb-g3.ctb", "", "a\0b", "x" * 2_000, "/etc/passwd"])
def test_a_table_that_is_none_is_refused(name):
    with pytest.raises(InputError, match="unknown braille table"):
        BrailleTable(name)
