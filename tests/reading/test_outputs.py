"""What is printed, spoken and signalled, and in which language."""

import pytest

from tests.reading.ssipserver import SsipServer
from vbraille.layout.pages import Layout
from vbraille.reading.cues import Cue, CueKind, Cues
from vbraille.reading.outputs import Echo, Outputs, language_of
from vbraille.translate import Book, BrailleTable, Document

TABLE = BrailleTable("en-ueb-g2.ctb")


def layout_of(tmp_path):
    path = tmp_path / "text.txt"
    path.write_text("One two.\n\nThree.\n")
    return Layout(Book(Document.open(path), TABLE), 26)


@pytest.mark.parametrize(
    ("echo", "spoken"),
    [
        (Echo.NONE, ["line: 1", "One two.", "Three.", "texture: 0.4"]),
        (Echo.TEXT, ["line: 1", "texture: 0.4"]),
    ],
)
def test_sentences_and_lines_are_spoken_each_once(tmp_path, monkeypatch, echo, spoken):
    monkeypatch.setenv("SPEECHD_ADDRESS", f"unix_socket:{tmp_path / 'sock'}")
    layout, printed = layout_of(tmp_path), []
    with SsipServer(tmp_path / "sock") as server:
        with Outputs(printed.append, Cues(CueKind.NONE), echo=echo) as hearing:
            hearing.speak("fr")

            def so_far(number):
                """Wait, as the next sentence takes the place of what was not said yet."""
                server.until(lambda it: it.said == spoken[:number])

            hearing.say("line: 1")
            so_far(1)
            hearing.say("cells: ⠕⠝⠑")
            for number, known in ((1, 2), (1, 2), (2, 3)):
                hearing.see(layout.line(number))
                hearing.see(None)
                if echo is Echo.NONE:
                    so_far(known)
            hearing.say("texture: 0.4")
        assert server.said == spoken
        assert ("SET SELF LANGUAGE fr", "") in server.done
    assert printed == ["line: 1", "cells: ⠕⠝⠑", "texture: 0.4"]


def test_without_speech_it_prints(tmp_path):
    printed = []
    with Outputs(printed.append, Cues(CueKind.NONE)) as hearing:
        hearing.say("line: 1")
        hearing.see(layout_of(tmp_path).line(1))
        hearing.cue(Cue.LIMIT)
    assert printed == ["line: 1"]


def test_the_language_is_the_one_asked_for_or_the_book_s_or_the_table_s(tmp_path):
    book = layout_of(tmp_path).book
    assert language_of(book, "pt-BR") == "pt-BR"
    assert language_of(book) == "en"
    assert language_of(Book(book.source, BrailleTable("de-g1.ctb"))) == "de"
    assert language_of(Book(book.source)) == "en"
