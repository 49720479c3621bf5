"""What is printed, spoken and signalled, and in which language."""

import pytest

from tests.reading.ssipserver import SsipServer
from vbraille.layout.pages import Layout
from vbraille.reading.outputs import (
    ConsoleOutput,
    CueKind,
    Cues,
    Echo,
    Outputs,
    SpeechOutput,
    language_of,
)
from vbraille.reading.speech import Speech
from vbraille.reading.view import Cue
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
        under = [None]
        spoken_too = SpeechOutput(Speech("fr"), lambda: under[0], echo=echo)
        with Outputs(ConsoleOutput(printed.append), Cues(CueKind.NONE), spoken_too) as outputs:

            def so_far(number):
                """Wait, as the next sentence takes the place of what was not said yet."""
                server.until(lambda it: it.said == spoken[:number])

            outputs.say("line: 1")
            so_far(1)
            outputs.say("cells: ⠕⠝⠑")
            for number, known in ((1, 2), (1, 2), (2, 3)):
                for under[0] in (layout.line(number), None):
                    outputs.attend()
                if echo is Echo.NONE:
                    so_far(known)
            outputs.say("texture: 0.4")
        assert server.said == spoken
        assert ("SET SELF LANGUAGE fr", "") in server.done
    assert printed == ["line: 1", "cells: ⠕⠝⠑", "texture: 0.4"]


def test_without_speech_it_prints():
    printed = []
    with Outputs(ConsoleOutput(printed.append), Cues(CueKind.NONE)) as outputs:
        outputs.say("line: 1")
        outputs.attend()
        outputs.cue(Cue.LIMIT)
    assert printed == ["line: 1"]


def test_the_language_is_the_one_asked_for_or_the_book_s_or_the_table_s(tmp_path):
    book = layout_of(tmp_path).book
    assert language_of(book, "pt-BR") == "pt-BR"
    assert language_of(book) == "en"
    assert language_of(Book(book.source, BrailleTable("de-g1.ctb"))) == "de"
    assert language_of(Book(book.source)) == "en"
