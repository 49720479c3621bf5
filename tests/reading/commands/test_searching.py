"""Looking for a text: typed, found near by at once, or far away while reading goes on."""

import pytest

from tests.reading.test_reader import Bench
from vbraille.reading.keys import Context
from vbraille.reading.outputs import Echo
from vbraille.reading.search.questions import (
    Counted,
    CountLines,
    Failed,
    FindText,
    Found,
    NotFound,
    Searched,
)
from vbraille.reading.search.seeker import look, look_everywhere
from vbraille.reading.view import Cue
from vbraille.translate import Document

TEXT = "The Café is here.\n\nno\n\nA cafe, two\ncafés, and THE\nstreet Straße.\n"


class Seeker:
    """A process that answers what a test says."""

    def __init__(self):
        self.asked = []
        self.answers = []
        self.cancelled = 0

    def ask(self, query):
        self.asked.append(query)

    def poll(self):
        return self.answers.pop(0) if self.answers else None

    def cancel(self):
        self.cancelled += 1


@pytest.fixture
def bench():
    return Bench(TEXT, width=30, echo=Echo.TEXT)


def test_a_text_is_typed_in_silence_and_found_at_once(bench):
    assert bench.press("/") == ["search: type the text, Enter"]
    assert bench.reader.context is Context.PROMPT
    assert bench.press("twq\x7fo") == []
    assert bench.press("\n") == ["text: two", "line: 3", "text: A cafe, two cafés, and THE"]
    assert bench.reader.context is Context.READING


def test_case_and_blanks_do_not_matter_and_accents_only_if_asked(bench):
    assert bench.press("/the  STREET\n")[2] == "line: 3"
    assert bench.press("</strasse\n")[-2:] == ["line: 4", "text: street Straße."]
    assert bench.press("</cafe\n")[-1] == "line: 1"  # which was under the hand, and has it
    assert bench.press("..") == ["line: 3", "text: A cafe, two cafés, and THE", "line: 3"]
    assert bench.press("'") == ["accents: matter"]
    assert bench.press(".") == ["not found after this: cafe"]


def test_a_search_goes_backward_again_and_with_the_last_text():
    cues = []
    bench = Bench(TEXT, width=30, cue=cues.append)
    assert bench.press(".") == ["search: nothing was searched yet; slash asks what"]
    bench.press(">")
    assert bench.press("\\the\n") == ["search backward: type the text, Enter", "text: the",
                                      "line: 3"]  # fmt: skip
    assert bench.press(".") == ["line: 1"]
    assert bench.press(".") == ["not found before this: the"]
    assert cues == [Cue.NOT_FOUND]
    assert bench.press("/\n")[1:] == ["text: the", "line: 3"]
    assert bench.press("b") == ["line: 1"]


def test_escape_forgets_and_an_empty_text_searches_nothing(bench):
    bench.press("/th")
    assert bench.press(["escape"]) == ["text: given up"]
    assert bench.press("/\n")[1:] == ["text: nothing was typed"]
    assert bench.press(["/", "f5", "ctrl-left", "é", "\n"])[1:3] == ["text: é", "line: 1"]
    assert bench.press(["escape"]) == ["search: nothing is looked for"]


def far(seeker, verbose=False):
    """A reader of a book whose end is far away."""
    text = "\n\n".join(["nothing here"] * 5_000 + ["the needle"])
    bench = Bench(text, seeker=seeker, verbose=verbose)
    document = bench.layout.book.source
    return bench, document, text


def test_what_is_far_is_looked_for_while_reading_goes_on():
    seeker = Seeker()
    bench, document, text = far(seeker)
    assert bench.press("/needle\n") == ["search: type the text, Enter", "text: needle", "searching"]
    (asked,) = seeker.asked
    assert asked.text == "needle"
    assert bench.press("n") == ["line: 2"]
    seeker.answers = [Searched(0.5), Found(text.index("needle"), document.index())]
    bench.run(0.05)
    assert bench.said[-1] == "place: 100 %"  # the lines are counted only now
    count = seeker.asked[-1]
    assert count == CountLines(20, 5_000)
    seeker.answers = [Counted(5_000, document.index(), count.width, count.block)]
    bench.run(0.05)
    # The line under the hand is called by its number as soon as there is one.
    assert bench.press("i")[:2] == ["line: 5001", "page: 201 in braille"]
    assert bench.press("F") == ["line: 4976"]
    assert bench.press("b") == ["line: 5001"]
    assert bench.press("p") == ["line: 5000"]
    assert bench.press("b") == ["line: 2"]


def test_progress_is_said_every_two_seconds_and_only_if_asked_for():
    for verbose in (False, True):
        seeker = Seeker()
        bench, *_ = far(seeker, verbose)
        bench.press("/needle\n")
        for n in range(50):
            seeker.answers.append(Searched(n / 100))
            bench.run(0.1)
        said = [s for s in bench.said if s.startswith("searching")]
        assert said == ["searching", *(["searching: 20 %", "searching: 40 %"] if verbose else [])]
        seeker.answers = [NotFound()]
        bench.run(0.05)
        assert bench.said[-1] == "not found after this: needle"


def test_escape_gives_a_search_up_and_a_failure_is_said():
    seeker = Seeker()
    bench, document, text = far(seeker)
    bench.press("/needle\n")
    assert bench.press(["escape"]) == ["search: given up"]
    assert seeker.cancelled == 1
    seeker.answers = [Found(text.index("needle"), document.index())]
    bench.run(0.05)
    assert bench.reader.line.number == 1
    bench.press("/needle\n")
    seeker.answers = [Failed("the file is gone")]
    bench.run(0.05)
    assert bench.said[-1] == "search: the file is gone"


def test_without_such_a_process_the_reader_looks_to_the_end_itself():
    bench, *_ = far(None)
    assert bench.press("/needle\n")[-1] == "place: 100 %"
    assert bench.press("/nowhere\n")[-1] == "not found after this: nowhere"


def test_a_text_across_two_pieces_of_a_long_paragraph_is_found_both_ways():
    text = "word " * 20_000
    document = Document.from_text(text)
    second = document.block(1)
    assert second.continues
    edge = int(second.text.places[0])
    marked = text[: edge - 5] + "left right" + text[edge + 5 :]
    document = Document.from_text(marked)
    place = marked.index("left")
    for start, backward in ((0, False), (place, False), (place + 9_000, True), (place + 1, True)):
        assert look(document, FindText("LEFT  right", start, backward)) == place
    assert look(document, FindText("left right", place, backward=True)) is None
    assert look_everywhere(document, FindText("left right", len(text), True)) == place
    assert look_everywhere(document, FindText("left right", place + 1)) is None


@pytest.mark.parametrize(
    ("keys", "said", "typed"),
    [
        (["a", "b", "left", "c"], ["cursor: b"], "acb"),
        (["a", "b", "left", "left", "left", "c"], ["cursor: b", "cursor: a", "cursor: a"], "cab"),
        (["a", "b", "home", "c", "end", "d"], ["cursor: a", "cursor: end"], "cabd"),
        (["a", "b", "\x01", "right", "\x7f", "\x05"],
         ["cursor: a", "cursor: b", "cursor: end"], "b"),
        (["a", ".", "B", " ", "\t"], ["text: a.B "], "a.B"),
        (["a", ".", "B", " ", "c", "left", "left", "left", "left"],
         ["cursor: c", "cursor: space", "cursor: capital B", "cursor: full stop"], "a.B c"),
        (["a", "b", "c", "home", "delete", "delete"], ["cursor: a", "cursor: b", "cursor: c"], "c"),
        ([*"one two ", "\x17"], ["erased: two"], "one"),
        ([*"one two", "\x17", "\x17", "\x17", "x"], ["erased: two", "erased: one",
                                                     "erased: nothing"], "x"),
        ([*"one two", "left", "\x15"], ["cursor: o", "erased: one tw"], "o"),
        ([*"one", "\x15", "\x7f", "\t", "x"], ["erased: one", "text: nothing"], "x"),
        (["a", "\x7f", "\x7f", "b", "f9", "\x0b"], [], "b"),
    ],
)  # fmt: skip
def test_a_text_is_edited_as_in_a_shell_and_the_place_is_said(bench, keys, said, typed):
    bench.press("/")
    assert bench.press(keys) == said
    assert bench.press("\n")[0] == f"text: {typed}"


def test_what_was_typed_before_is_brought_again_each_kind_by_itself(bench):
    for text in ("one", "two", "one"):
        bench.press(["/", *text, "\n"])
    bench.press("mhere\n")
    bench.press("/x")
    assert bench.press(["up", "up", "up", "down", "down"]) == [
        "text: one",
        "text: two",
        "text: none before this",
        "text: one",
        "text: none after this",
    ]
    assert bench.press(["e", "\n"])[0] == "text: onee"
    assert bench.press(["o", "\x10"])[1] == "name: here"
