"""A reading as pages are told of it: made anew when something changes, and only then."""

import base64
import io
import re
from dataclasses import replace

import numpy as np
import pytest

from tests.render.braille.reference import deflections
from vbraille.devices.base import Placing
from vbraille.devices.events import Back, Silent
from vbraille.engine.clock import ManualClock
from vbraille.layout.pages import Layout
from vbraille.live.messages import PagePress
from vbraille.reading.device import OpenDevice
from vbraille.reading.liveview import MOST_SAID, LastSentences, ReadState
from vbraille.render import STRESS2, VBD
from vbraille.simulation.steering import BeAt, Pointer
from vbraille.testing import simulated_device
from vbraille.translate import Book, BrailleTable, Document
from vbraille.translate.braillefiles.lines import open_brf

TEXT = (
    "The little children can knowledge fast, and twelve people had a long evening together; "
    "then they went home again through the dark of a night.\n\nThat is a second paragraph.\n"
)

SLOW = replace(STRESS2, display=replace(STRESS2.display, rate_hz=200.0))  # for long waits


class Watch:
    """A reading on a device in memory, and what pages are told of it."""

    def __init__(
        self, model=STRESS2, hand="still", book=None, width=None, attended=True, table=2, **how
    ):
        self.clock, self.said = ManualClock(), LastSentences()
        device = simulated_device(model, hand=hand, clock=self.clock, pointer=Pointer())
        self.device = OpenDevice(
            device, model.display, clock=self.clock, say=self.said.add, attended=attended
        )
        self.device.start(model)
        if book is None:
            book = Book(Document.from_text(TEXT), BrailleTable(f"en-ueb-g{table}.ctb"))
        self.device.show(Layout(book, width or 20), **how)
        self.viewed = ReadState(self.device, "A title", self.said, [("hand", hand)])

    @property
    def reader(self):
        return self.device.reader

    def step(self, polls=1):
        for _ in range(polls):
            self.viewed.see(self.device.poll())
        return self.viewed.changed()

    def hold(self, x_mm):
        """Hold the hand at a place, until it is there."""
        self.device.pointer.hold(BeAt(x_mm))
        state = self.step()
        while abs(self.device.x_mm - x_mm) > 0.01:
            state = self.step() or state
        return state or self.viewed.changed()


def test_the_first_state_has_all_that_a_page_draws():
    watch = Watch()
    state = watch.viewed.changed()
    assert (state.number, state.title, state.place) == (1, "A title", "line 1, 0 %")
    assert state.array.name == STRESS2.display.name
    assert state.geometry["line_pitch_mm"] == 14.0
    assert state.rows_shown[0] == (0, 0)
    assert state.knobs[0].name == "texture"
    assert state.mapping == "mapping: alternate"
    assert (state.paused, state.held, state.done, state.blind) == (False, False, False, False)
    assert state.simulated
    assert state.device == "reading"
    assert state.facts == [("hand", "still")]
    assert [(line.number, line.top_mm, line.under) for line in state.lines] == [
        (1, 0.0, True), (2, 14.0, False), (3, 28.0, False), (4, 42.0, False),
    ]  # fmt: skip
    for line in state.lines:
        known = watch.reader.layout.line(line.number)
        assert line.cells == known.masks.tolist()
        assert line.text == known.text


def test_nothing_is_told_twice():
    watch = Watch()
    assert watch.viewed.changed() is not None
    assert watch.step(30) is None


def test_nothing_is_translated_or_laid_out_for_a_page():
    watch = Watch(width=40)
    watch.viewed.changed()
    layout = watch.reader.layout
    last = max(line.number for line in watch.viewed._parts()["lines"])
    assert layout.lines_to(last + 1) == 1  # the next paragraph is not there yet
    assert last < layout.count()


@pytest.mark.parametrize(
    ("change", "field", "value"),
    [
        (lambda watch: watch.reader.tune(texture=0.5), "knobs", 0.5),
        (lambda watch: setattr(watch.device, "paused", True), "paused", True),
        (lambda watch: setattr(watch.device, "paused", True), "device", "paused"),
        (lambda watch: watch.said.add("page: 3"), "said", ["page: 3"]),
        (lambda watch: watch.reader.go_by(1), "place", "line 2, 24 %"),
        (lambda watch: watch.reader.quit(), "done", True),
        (lambda watch: watch.reader.quit(), "device", "reading is over"),
        (
            lambda watch: setattr(watch.device, "placing", Placing.STOP),
            "device",
            "place: the carriage has to be shown its place",
        ),
        (lambda watch: setattr(watch.viewed, "standing", "fault: gone"), "device", "fault: gone"),
        (
            lambda watch: watch.viewed.see([Silent(60.0)]),
            "device",
            "device: silent, and sent to rest; reading goes on once it speaks",
        ),
        (lambda watch: watch.viewed.see([Silent(60.0), Back()]), "device", None),
    ],
)
def test_what_changes_is_told_once(change, field, value):
    watch = Watch()
    first = watch.viewed.changed()
    change(watch)
    state = watch.viewed.changed()
    if value is None:
        assert state is None
        return
    assert state.number == first.number + 1
    found = getattr(state, field)
    assert (found[0].value if field == "knobs" else found) == value
    assert watch.viewed.changed() is None


def test_who_holds_the_hand_is_told_and_said():
    watch = Watch()
    assert not watch.viewed.changed().held
    state = watch.hold(30.0)
    assert state.held
    assert state.said[-1] == "hand: moved in the live view"
    watch.device.pointer.let_go()
    state = watch.step(2)
    assert not state.held
    assert state.said[-1] == "hand: simulated again"


@pytest.mark.parametrize("attended", [True, False])
def test_a_held_hand_reads_line_after_line_and_is_never_told_to_hurry(attended):
    watch = Watch(SLOW, attended=attended)
    for number in (1, 2):
        assert watch.reader.line.number == number
        for x_mm in (-5.4, 100.0, 290.0, 100.0, -5.4):
            watch.hold(x_mm)
        watch.step()
    assert watch.reader.line.number == 3
    for _ in range(4):  # to and fro short of the end, and still for long
        watch.hold(60.0)
        watch.hold(-5.4)
    watch.step(600)
    assert watch.said.last == ["hand: moved in the live view"]
    watch.device.pointer.let_go()
    watch.step(600)
    assert watch.said.last[1:] == ["hand: simulated again"]


def test_let_go_a_hand_that_reads_goes_on_and_the_text_ends():
    watch = Watch(hand="sweep:500", attended=False)
    watch.hold(30.0)
    watch.device.pointer.let_go()
    state = None
    while not watch.device.done:
        state = watch.step() or state
    assert state.done
    assert watch.reader.lines == watch.reader.layout.count()


def test_a_part_of_a_long_line_is_shown_where_it_is_felt():
    book = Book(Document.from_text("wide " * 30), BrailleTable("en-ueb-g1.ctb"))
    watch = Watch(book=book, width=120)
    state = watch.viewed.changed()
    (under,) = [line for line in state.lines if line.under]
    assert len(under.cells) == watch.reader.under.width < 120
    watch.reader.pan(1)
    (under,) = [line for line in watch.viewed.changed().lines if line.under]
    window = watch.reader.window
    assert under.cells == window.masks.tolist()
    assert window.offset > 0
    assert under.text in watch.reader.line.text
    assert {under.text[slice(*source)] for source in under.sources} <= {*"wide "}
    watch.hold(100.0)
    watch.reader.tune(cell_gap_mm=6.0)
    (under,) = [line for line in watch.viewed.changed().lines if line.under]
    assert under.start_mm == watch.reader.window.start_mm != 0
    assert under.cells == watch.reader.window.masks.tolist()


def test_uncontracted_and_braille_texts_and_the_other_display():
    watch = Watch(VBD, table=1)
    state = watch.viewed.changed()
    assert state.rows_shown == [(0, 0)]
    assert state.mapping == "dot row: 1"
    assert state.lines[0].text[slice(*state.lines[0].sources[4])] == "h"
    braille = Book(open_brf(io.BytesIO(b",read ,me\n#c"), "text"))
    state = Watch(book=braille).viewed.changed()
    assert state.lines[0].text == ""
    assert any(state.lines[0].cells)


def test_only_the_last_sentences_are_told_and_counted():
    watch = Watch()
    for number in range(50):
        watch.said.add(f"line: {number}")
    state = watch.viewed.changed()
    assert state.said == [f"line: {number}" for number in range(50 - MOST_SAID, 50)]
    assert state.said_before == 50 - MOST_SAID


def test_a_person_s_device_has_no_hand_to_be():
    clock = ManualClock()
    device = OpenDevice(simulated_device(clock=clock), STRESS2.display, clock=clock)
    device.start(STRESS2)
    device.show("one two")
    state = ReadState(device, "", LastSentences()).changed()
    assert not state.simulated
    assert not state.held


def test_a_place_in_a_book_whose_lines_are_not_counted_is_told_as_a_share():
    text = "\n\n".join(f"Paragraph {n} has some words of its own." for n in range(6000))
    book = Book(Document.from_text(text), BrailleTable("en-ueb-g1.ctb"))
    watch = Watch(book=book, at=len(text) // 2)
    state = watch.viewed.changed()
    assert re.fullmatch("about (4[0-9]|50) %", state.place)
    (under,) = [line for line in state.lines if line.under]
    assert under.number == watch.reader.line.number & 0xFFFF_FFFF
    assert under.number < 1 << 32


def test_a_change_of_the_table_is_told():
    watch = Watch()
    before = watch.viewed.changed().lines[0].cells
    watch.reader.lay_out_again(book=Book(Document.from_text(TEXT), BrailleTable("en-ueb-g1.ctb")))
    assert watch.viewed.changed().lines[0].cells != before


def test_the_style_of_another_model_is_that_of_the_device():
    model = replace(STRESS2, style=STRESS2.style.replace(texture=0.3))
    assert Watch(model).viewed.changed().knobs[0].value == 0.3


def test_another_mapping_beside_it_is_that_of_the_same_line():
    watch = Watch()
    assert watch.viewed.changed().beside is None
    watch.viewed.obey(PagePress("BESIDE"))
    state = watch.viewed.changed()
    mapping = watch.reader.beside
    assert mapping not in (None, watch.reader.style.mapping)
    assert state.mapping == "mapping: alternate"
    assert state.beside.mapping == f"mapping: {mapping.name}" == watch.said.last[-1][8:]
    places_mm = state.beside.first_mm + state.beside.step_mm * np.arange(
        len(base64.b64decode(state.beside.rows[0]))
    )
    style = watch.reader.style.replace(mapping=mapping)
    window, array = watch.reader.window, watch.device.display
    assert places_mm[0] == -style.geometry.cell_pitch_mm
    assert places_mm[-1] > style.geometry.extent_mm(len(window))
    # What the array feels with its centre somewhere is what its rows do at its columns' places.
    for x_mm in (0.0, 11.3, 40.7):
        felt = style.render(window.masks, array).path(np.array([x_mm]))[0]
        columns_mm = x_mm + array.column_offsets_mm() - array.span_mm / 2
        at = np.rint((columns_mm - places_mm[0]) / state.beside.step_mm).astype(int)
        rows = [np.frombuffer(base64.b64decode(row), np.uint8) for row in state.beside.rows]
        near = np.array([row[at] / 255 for row in rows])
        there = deflections_at_places(style, window.masks, array, places_mm[at])
        np.testing.assert_allclose(near, there, atol=1 / 255)
        assert np.abs(near - felt).mean() < 0.1
    while watch.reader.beside is not None:
        watch.viewed.obey(PagePress("BESIDE"))
    assert watch.said.last[-1] == "beside: nothing"
    assert watch.viewed.changed().beside is None


def deflections_at_places(style, masks, array, places_mm):
    """Deflections of each row of actuators at places, by the equations in plain numpy."""
    column = replace(array, columns=1)
    return deflections(places_mm, masks, style, column)[:, :, 0].T
