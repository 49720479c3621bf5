"""Figures of a text: on the page below their line, under a hand that a test holds, or alone."""

import time
from dataclasses import replace

import numpy as np
import pytest

from tests.reading.held import Held
from tests.reading.test_sounding import write_sound
from tests.render.scene.lanes import lane_places
from tests.render.scene.twin import deflections
from tests.tiers import heavy
from vbraille.feeling.index import SceneIndex
from vbraille.layout.pages import Layout
from vbraille.layout.texts import choose_table
from vbraille.live.messages import PagePress
from vbraille.reading.bookfigures import BookFigures
from vbraille.reading.device import OpenDevice
from vbraille.reading.liveview import LastSentences, ReadState
from vbraille.render import STRESS2, STRESS2_8X8, model_of
from vbraille.render.braille.style import Straying
from vbraille.scene.reading import open_scene
from vbraille.translate import Book
from vbraille.translate.formats import open_source

PITCH_MM = STRESS2_8X8.style.geometry.line_pitch_mm
SCENE = """
title = "Water cycle"
[canvas]
width_mm = 40
height_mm = 30
[[elements]]
kind = "circle"
title = "lake"
center_mm = [20, 15]
radius_mm = 8
stroke = {}
"""
TEXT = """ab

![Water](water.scene "water")

cd

ef

gh

ij
"""
CAPTION, AFTER = "figure: water", "cd"
ON_A_MM = 2 * STRESS2_8X8.style.geometry.cell_pitch_mm + 2.0  # after the indent
ROWS = 6  # of a page: two lines, the figure of three rows, and a line


class Bench(Held):
    """A text with figures on a page, under a hand that is held."""

    def __init__(
        self, folder, text=TEXT, model=STRESS2_8X8, rows=ROWS, scene=SCENE, sounding=False, **style
    ):
        (folder / "water.scene").write_text(scene)
        (folder / "text.md").write_text(text)
        self.said, self.notes, self.heard = [], [], []
        super().__init__(model, rows, self.said.append)
        self.y_mm = PITCH_MM / 2
        own = self.own.style.replace(**style)
        self.opened.start(replace(self.own, style=own))
        source = open_source(str(folder / "text.md"))
        self.figures = BookFigures(
            source, folder, self.opened, self.notes.append, rate_hz=1000.0, room=1 << 21,
            sound=self.heard.append, sounding=sounding,
        )  # fmt: skip
        layout = Layout(Book(source, choose_table("en", 1, None)), 17)
        self.opened.show(layout, figures=lambda: self.figures)
        while rows and any(self.surface.kept) and not self.under.figured.placed:
            self.run(0.02)  # until the compiler is loaded, which real time does meanwhile

    @property
    def under(self):
        return self.reader.under

    @property
    def texts(self):
        """Text in each row of the page; None where no line is."""
        windows = self.surface.windows
        return [None if part is None else part.line.text.strip() for part in windows]

    def to(self, x_mm, y_mm, seconds=0.4):
        """Put the finger somewhere and stay until all has faded in; the frame there."""
        self.x_mm, self.y_mm = x_mm, y_mm
        self.run(seconds)
        return self.opened.frame

    def press(self, key):
        before = len(self.said)
        self.reader.listener().press(key)
        self.reader.listener()
        return self.said[before:]

    def resolved(self):
        return open_scene(self.figures._folder / "water.scene").resolved


@pytest.fixture
def bench(tmp_path):
    return Bench(tmp_path)


def twin(bench, x_mm, y_mm):
    """What the figure alone does to actuators around a place of its canvas, by its twin."""
    display = bench.opened.display
    places = lane_places(display, x_mm, y_mm, 0.0)
    own = bench.resolved()
    return deflections(own, bench.figures.find("water.scene").loaded.assets, *places, 0, 0.0)


def test_rows_below_its_line_are_kept_free(bench):
    assert bench.texts == ["ab", CAPTION, None, None, None, AFTER]


def test_the_frames_over_it_are_the_figure_as_its_twin_has_it(bench):
    top_mm = 2 * PITCH_MM
    felt = 0
    for x_mm, y_mm in [(12.0, 15.0), (20.0, 7.0), (27.5, 15.0), (20.0, 15.0), (14.0, 21.0)]:
        frame = bench.to(x_mm, top_mm + y_mm)
        wanted = twin(bench, x_mm, y_mm).reshape(frame.shape)
        np.testing.assert_allclose(frame, wanted, rtol=0, atol=1e-6)
        felt += wanted.max() > 0.5
    assert felt >= 4


def test_the_braille_around_it_is_that_of_a_page(bench):
    style = bench.opened.style.replace(straying=Straying("free"))
    display = bench.opened.display
    blank = np.zeros(0, np.uint8)
    masks = [blank if part is None else part.masks for part in bench.surface.windows]
    page = style.render_page(masks, display)
    wanted = np.zeros(display.shape, np.float32)
    for x_mm, row in [(ON_A_MM, 0), (ON_A_MM + 1.5, 0), (ON_A_MM, 5), (ON_A_MM - 1.5, 5)]:
        y_mm = (row + 0.5) * PITCH_MM
        frame = bench.to(x_mm, y_mm)
        page.frame(x_mm, wanted, y_mm=y_mm)
        assert wanted.max() > 0.3
        np.testing.assert_allclose(frame, wanted, rtol=0, atol=1e-6)


def test_the_line_under_a_finger_on_it_is_the_line_that_it_stands_below(bench):
    bench.to(12.0, 0.5 * PITCH_MM)
    assert bench.reader.line.text.strip() == "ab"
    bench.to(12.0, 3.5 * PITCH_MM)
    assert bench.reader.line.text.strip() == CAPTION
    assert "figure: Water cycle, 40 mm × 30 mm; below this line" in bench.said
    bench.to(5.0, 5.5 * PITCH_MM)
    assert bench.reader.line.text.strip() == AFTER


def test_it_is_said_what_of_it_is_under_the_finger(bench):
    bench.to(12.0, 2 * PITCH_MM + 15)
    assert bench.press("i")[:3] == ["figure: Water cycle", "here: lake", "line: 2"]
    assert bench.press("u") == ["figure: Water cycle", "here: lake"]
    assert bench.press("w") == ["word: none here"]
    bench.to(1.0, 2 * PITCH_MM + 2)
    assert bench.press("u") == ["figure: Water cycle", "here: nothing with a name"]
    bench.to(5.0, 0.5 * PITCH_MM)
    assert bench.press("i")[0] == "line: 1"


def test_a_band_keeps_the_finger_on_its_row(bench):
    bench.to(5.0, 4.5 * PITCH_MM)
    bench.to(5.0, 5.1 * PITCH_MM)
    assert bench.reader.line.text.strip() == CAPTION
    bench.to(5.0, 5.2 * PITCH_MM)
    assert bench.reader.line.text.strip() == AFTER
    bench.to(5.0, 4.9 * PITCH_MM)
    assert bench.reader.line.text.strip() == AFTER


def test_pages_turn_and_a_figure_is_never_cut(tmp_path):
    bench = Bench(tmp_path, rows=4)
    assert bench.texts == ["ab"]
    bench.press("]")
    assert bench.texts == [CAPTION, None, None, None]
    bench.press("]")
    assert bench.texts == [AFTER, "ef", "gh", "ij"]
    bench.press("[")
    assert bench.texts == [CAPTION, None, None, None]
    bench.to(5.0, 2.5 * PITCH_MM)
    bench.press("n")  # it comes into the finger's row, and a figure above it finds no room
    assert bench.texts == [None, None, AFTER, "ef"]
    bench.press("p")
    assert bench.texts == [CAPTION, None, None, None]


def test_a_finger_below_it_asks_for_the_next_page(tmp_path):
    bench = Bench(tmp_path, rows=4)
    bench.press("]")
    bench.run(0.5)
    bench.to(5.0, 3.5 * PITCH_MM)
    bench.to(5.0, 4.4 * PITCH_MM, 1.0)
    assert bench.texts == [AFTER, "ef", "gh", "ij"]


@pytest.mark.parametrize(
    ("rows", "scene"), [(3, SCENE), (ROWS, SCENE.replace("= 40", "= 400"))], ids=["high", "wide"]
)
def test_one_that_a_page_has_no_room_for_is_a_line(tmp_path, rows, scene):
    bench = Bench(tmp_path, rows=rows, scene=scene)
    assert bench.texts[:3] == ["ab", CAPTION, AFTER]
    bench.to(5.0, 1.5 * PITCH_MM)
    assert any(s.startswith("figure: Water cycle") and "shift-g feels it" in s for s in bench.said)


def test_another_tuning_changes_its_braille_and_not_the_place(bench):
    bench.to(12.0, 2 * PITCH_MM + 15)
    line = bench.reader.line
    bench.press("C")
    frame = bench.to(12.1, 2 * PITCH_MM + 15)
    wanted = twin(bench, 12.1, 15).reshape(frame.shape)
    np.testing.assert_allclose(frame, wanted, rtol=0, atol=1e-6)
    assert bench.reader.line is line
    more = bench.to(ON_A_MM, 0.5 * PITCH_MM).max()
    bench.press("C")
    assert 0.3 < bench.to(ON_A_MM, 0.5 * PITCH_MM).max() < more - 0.02


def test_what_is_missing_or_wrong_costs_one_sentence(tmp_path):
    text = "ab\n\n![one](gone.scene)\n\n![two](bad.scene)\n\n![one](gone.scene)\n\ncd\n"
    (tmp_path / "bad.scene").write_text("canvas = 3\n")
    bench = Bench(tmp_path, text)
    assert bench.texts == ["ab", "figure: one", "figure: two", "figure: one", "cd"]
    assert len(bench.notes) == 2
    assert all(note.startswith("figure not felt: ") for note in bench.notes)
    assert "gone.scene" in bench.notes[0]
    assert "bad.scene" in bench.notes[1]


def test_two_figures_stand_on_one_page(tmp_path):
    text = "![a](water.scene)\n\n![b](water.scene)\n\nzz\n"
    bench = Bench(tmp_path, text, rows=9)
    names = ["figure: a", None, None, None, "figure: b", None, None, None, "zz"]
    assert bench.texts == names
    for top_mm in (PITCH_MM, 5 * PITCH_MM):
        frame = bench.to(12.0, top_mm + 15)
        wanted = twin(bench, 12.0, 15).reshape(frame.shape)
        assert wanted.max() > 0.5
        np.testing.assert_allclose(frame, wanted, rtol=0, atol=1e-6)


def test_a_key_feels_it_alone_and_leads_back(tmp_path):
    bench = Bench(tmp_path, model=STRESS2, rows=0)
    assert bench.press("G") == ["figure: none on this line"]
    bench.press("n")
    assert bench.said[-2] == "figure: Water cycle, 40 mm × 30 mm; shift-g feels it"
    bench.run(0.3)
    said = bench.press("G")
    assert said[0] == "picture: Water cycle"
    assert said[-1] == "shift-g or escape goes back to the text"
    frame = bench.to(12.0, 0.0)
    loaded = bench.figures.find("water.scene").loaded
    height_mm = SceneIndex(loaded.scene, loaded.assets, loaded.boxes()).inside()[1]
    wanted = twin(bench, 12.0, height_mm).reshape(frame.shape)
    assert wanted.max() > 0.5
    np.testing.assert_allclose(frame, wanted, rtol=0, atol=1e-6)
    assert bench.press("i")[0] == "here: edge of lake"
    assert bench.press("escape") == ["line: 2"]
    bench.run(0.3)
    assert bench.under.alone is None
    assert bench.reader.line.text.strip() == CAPTION
    felt = np.zeros(frame.shape, np.float32)
    frame = bench.to(ON_A_MM, 0.0)
    bench.opened.style.render(bench.reader.line.masks, bench.opened.display).frame(ON_A_MM, felt)
    assert felt.max() > 0.3
    np.testing.assert_allclose(frame, felt, rtol=0, atol=1e-6)


def test_sounds_of_its_elements_are_played_while_it_is_felt_alone(tmp_path):
    write_sound(tmp_path / "lake.wav", [0, 16384, -32768])
    scene = SCENE.replace('title = "lake"', 'title = "lake"\nwords = "water"\nsound = "lake.wav"')
    bench = Bench(tmp_path, model=STRESS2, rows=0, scene=scene, sounding=True)
    bench.press("n")
    bench.run(0.3)
    bench.press("G")
    bench.to(12.0, 0.0)
    assert "water" in bench.said
    assert bench.heard == [tmp_path / "lake.wav"]
    bench.press("escape")


def test_pages_of_the_live_view_draw_it_where_it_stands_and_alone(bench):
    told = ReadState(bench.opened, "A pond", LastSentences())

    def state(so):
        end_s, newest = time.monotonic() + 60, told.changed()
        while newest is None or not so(newest):  # it is drawn meanwhile
            assert time.monotonic() < end_s
            newest = told.changed() or newest
        return newest

    (figure,) = state(lambda new: new.figures and new.figures[0].image).figures
    assert (figure.title, figure.width_mm, figure.height_mm) == ("Water cycle", 40, 30)
    assert figure.top_mm == -2 * PITCH_MM
    assert figure.image.startswith("data:image/png")
    assert told.changed() is None

    bench.to(12.0, 3.5 * PITCH_MM)
    told.obey(PagePress("FEEL"))
    bench.run(0.3)
    alone = state(lambda new: new.scene)
    assert (alone.title, alone.lines, alone.figures) == ("Water cycle", [], [])
    assert alone.scene.image == figure.image
    assert alone.commands[0].name == "BACK"
    told.obey(PagePress("BACK"))
    bench.run(0.3)
    back = state(lambda new: new.lines)
    assert back.scene is None
    assert [command.name for command in back.commands][:2] == ["LNUP", "LNDN"]


def test_a_page_comes_back_with_its_figure(bench):
    bench.to(12.0, 3.5 * PITCH_MM)
    bench.press("G")
    bench.run(0.3)
    bench.press("G")
    top_mm = 2 * PITCH_MM
    frame = bench.to(12.0, top_mm + 15)
    wanted = twin(bench, 12.0, 15).reshape(frame.shape)
    np.testing.assert_allclose(frame, wanted, rtol=0, atol=1e-6)
    assert bench.reader.line.text.strip() == CAPTION


@heavy
def test_a_host_sends_its_frames(tmp_path):
    """The same through a process of the program's own, under a simulated hand that reads on."""
    (tmp_path / "water.scene").write_text(SCENE)
    (tmp_path / "text.md").write_text(TEXT)
    display = replace(STRESS2_8X8.display, height_mm=(ROWS + 0.5) * PITCH_MM, travel_mm=60.0)
    source, notes, seen = open_source(str(tmp_path / "text.md")), [], []
    with OpenDevice("sim", display, hand="sweep:300") as opened:
        opened.find()
        opened.start(model_of(display), 1 << 21)
        figures = BookFigures(source, tmp_path, opened, notes.append, rate_hz=1000.0, room=1 << 21)
        layout = Layout(Book(source, choose_table("en", 1, None)), 10)
        opened.show(layout, figures=lambda: figures)
        while not opened.done:
            opened.poll()
            placed, tick = opened.reader.under.figured.placed, opened._newest
            if placed and tick is not None and tick["share"] == 1.0:
                seen.append((placed[0].top_mm, tick.copy()))
        felt = 0
        loaded = figures.find("water.scene").loaded
        for top_mm, tick in seen:
            x_mm, y_mm = float(tick["x_mm"]), float(tick["y_mm"]) - top_mm
            if 4 < x_mm < 36 and 4 < y_mm < 26:
                places = lane_places(display, x_mm, y_mm, 0.0)
                wanted = deflections(loaded.scene, loaded.assets, *places, 0, 0.0)
                wanted = wanted.reshape(display.shape)
                np.testing.assert_allclose(tick["frame"], wanted, rtol=0, atol=1e-6)
                felt += wanted.max() > 0.5
    assert felt >= 5
    assert notes == []
