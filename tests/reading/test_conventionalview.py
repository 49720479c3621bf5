"""A conventional display beside a reading: what stands on it, and what its keys do."""

import pytest

from tests.reading.test_reader import Bench
from vbraille.conventional.brlapi import DisplayAway, DisplayStands, KeyPressed, KeyTyped
from vbraille.errors import InputError
from vbraille.layout.texts import choose_table, lay_out_text
from vbraille.reading.commands.table import bound_by
from vbraille.reading.conventionalview import ConventionalView, Pane, SentencesOnDisplay
from vbraille.reading.keys import Bindings, Context
from vbraille.simulation.hand import Sweep

TEXT = "one two three four five six seven eight nine ten plus\n\nthe last\n"


class Pins:
    """A display that keeps what it is told to show."""

    def __init__(self, columns=8):
        self.standing = None
        self.shown = []
        self.rested = 0
        self._told = []
        if columns:
            self.tell(DisplayStands("Made", "up", columns))

    def tell(self, message):
        self._told.append(message)

    def poll(self):
        told, self._told = self._told, []
        for message in told:
            if isinstance(message, DisplayStands):
                self.standing = message
            elif isinstance(message, DisplayAway):
                self.standing = None
        return told

    def show(self, cells):
        self.shown.append(cells)

    def rest(self):
        self.rested += 1


class Beside1:
    """A reading of a text with such a display beside it."""

    def __init__(self, columns=8, buttons=None, hand=None):
        bound = bound_by(Bindings({}, buttons or {}))
        self.bench = Bench(TEXT, hand=hand, width=60, bound=bound)
        self.pins = Pins(columns)
        self.view = ConventionalView(self.pins, lambda: self.bench.reader, self.bench.said.append)
        self.attend()

    def attend(self):
        before = len(self.bench.said)
        self.view.attend()
        return self.bench.said[before:]

    def press(self, name, argument=0):
        self.pins.tell(KeyPressed(name, argument))
        return self.attend()

    @property
    def line(self):
        return self.bench.reader.line.masks.tobytes()

    @property
    def standing(self):
        return self.pins.shown[-1]


def test_the_line_under_the_hand_stands_there_and_its_keys_are_the_reader_s():
    beside = Beside1()
    assert beside.bench.said == ["display: Made up, 8 cells"]
    assert beside.standing == beside.line[:8]
    assert beside.press("LNDN") == ["line: 2"]
    assert beside.standing == beside.line[:8]
    assert beside.press("TOP_LEFT") == ["line: 1"]
    assert beside.press("HOME") == ["display HOME: no command; the settings file can give it one"]
    shown = len(beside.pins.shown)
    assert beside.attend() == []
    assert len(beside.pins.shown) == shown  # nothing is shown twice


def test_its_panning_keys_go_along_the_line_and_then_to_the_next():
    beside = Beside1()
    line, shown = beside.line, []
    while beside.bench.reader.line.number == 1:
        shown.append(beside.standing)
        said = beside.press("FWINRT")
    assert b"".join(shown) == line
    assert said == ["line: 2"]
    assert beside.press("FWINLT") == ["line: 1"]
    assert beside.standing == shown[-1]
    assert beside.press("FWINLT") == []
    assert beside.standing == shown[-2]
    beside.press("TOP")
    assert beside.press("FWINLT")[-1] == "first line"


def test_the_hand_s_part_of_a_long_line_goes_with_them():
    beside = Beside1(columns=20)
    reader = beside.bench.reader
    assert reader.under.width < len(reader.line)
    beside.press("FWINRT")
    assert beside.press("FWINRT") == []
    assert (reader.line.number, reader.window.offset) == (1, reader.under.width)
    assert beside.standing == beside.line[40:]


def test_a_routing_key_says_what_is_there_and_brings_it_under_the_finger():
    beside = Beside1(hand=Sweep(20))
    beside.bench.run(2.0)
    reader = beside.bench.reader
    assert reader.cell not in (None, 5)
    said = beside.press("ROUTE", 5)
    assert said[0].startswith("cell: dots ")
    assert "word: two" in said
    assert reader.cell == 5
    assert beside.press("BACK") == ["line: 1"]
    beside.press("BOT")
    assert beside.press("ROUTE", 7) == ["cell: none here"]


def test_in_other_contexts_its_keys_do_no_harm():
    beside = Beside1()
    reader = beside.bench.reader
    assert beside.press("LEARN") != []
    assert beside.press("ROUTE", 1) == ["display ROUTE: say what is here, and go there"]
    assert beside.press("FWINRT") == ["display FWINRT: on along the line, then the next line"]
    beside.press("LEARN")
    assert reader.context is Context.READING
    beside.press("NXSEARCH")
    assert beside.press("LNDN") == ["display LNDN: not now; answer first"]
    assert beside.press("ROUTE") == ["display ROUTE: no command; the settings file can give it one"]
    for key in "last\n":
        beside.pins.tell(KeyTyped(key))
    assert beside.attend() == ["text: last", "line: 2"]


def test_settings_give_its_keys_commands():
    beside = Beside1(buttons={"display HOME": "LNDN", "display fwinrt": "INFO"})
    assert beside.press("HOME") == ["line: 2"]
    assert beside.press("FWINRT")[0] == "line: 2"
    with pytest.raises(InputError, match="there is no command 'LNDNN'; the nearest is LNDN"):
        bound_by(Bindings({}, {"display HOME": "LNDNN"}))


def test_a_display_that_goes_and_comes_with_another_width_is_said_and_filled():
    beside = Beside1()
    beside.pins.tell(DisplayAway("it is gone; plug it in"))
    assert beside.attend() == ["display: it is gone; plug it in"]
    beside.press("LNDN")
    beside.pins.tell(DisplayStands("Made", "longer", 30))
    assert beside.attend() == ["display: Made longer, 30 cells"]
    assert beside.standing == beside.line[:30]
    beside.view.rest()
    assert beside.pins.rested == 1
    beside.attend()
    assert beside.standing == beside.line[:30]


class TestPane:
    @pytest.fixture
    def line(self):
        return Bench(TEXT, width=60).reader.line

    def test_it_follows_the_finger_and_stands_still_at_its_edges(self, line):
        pane = Pane()
        offsets = []
        for cell in (0, 7, 8, 9, 8, 7, 6, 17, 16, 15):
            pane.follow(line, 8, cell, 0)
            offsets.append(pane.offset)
        assert offsets == [0, 0, 0, 8, 8, 8, 0, 16, 16, 16]

    def test_where_a_key_has_moved_it_it_stays_until_the_finger_goes_on(self, line):
        pane = Pane()
        pane.follow(line, 8, 3, 0)
        assert pane.pan(1, 3)
        offsets = []
        for cell in (3, 4, 2, None, 5):
            pane.follow(line, 8, cell, 0)
            offsets.append(pane.offset)
        assert offsets == [8, 8, 8, 8, 0]

    def test_without_a_finger_it_begins_where_the_hand_s_part_does(self, line):
        pane = Pane()
        pane.follow(line, 8, None, 20)
        assert pane.offset == 16
        assert pane.cells == line.masks[16:24].tobytes()


def test_sentences_stand_there_together_and_give_way_to_the_next():
    pins, bench, now_s = Pins(12), Bench(TEXT, width=60), [0.0]
    table = choose_table("en")
    view = SentencesOnDisplay(
        pins, lambda: bench.reader, bench.said.append, table, lambda: now_s[0]
    )

    def parts(sentence):
        layout = lay_out_text(sentence, 12, table)
        return [layout.line(n).masks.tobytes() for n in range(1, layout.count() + 1)]

    view.say("match: the sun")
    view.say("turn: player 2")
    view.attend()
    shown = [*parts("match: the sun"), *parts("turn: player 2")]
    assert pins.shown == [shown[0]]
    for part in (*shown[1:], shown[-1]):  # at the end it stays
        pins.tell(KeyPressed("FWINRT", 0))
        view.attend()
        assert pins.shown[-1] == part
    now_s[0] += 1.0
    view.say("place: row 1")
    view.attend()
    assert pins.shown[-1] == parts("place: row 1")[0]
    pins.tell(KeyPressed("LNDN", 0))
    view.attend()
    assert bench.reader.line.number == 2
