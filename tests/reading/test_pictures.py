"""Pictures, figures of a book, the game and tuning."""

from dataclasses import replace
from pathlib import Path

from tests.reading.bench import ONE, TWO, Heard, NoKeyboard, Reading
from vbraille.pictures.loading import load_scene
from vbraille.reading.device import ReadingDevice
from vbraille.reading.exploration import Exploration
from vbraille.reading.figures import BookFigures
from vbraille.reading.game import DECK, DOWN, GONE, Game, load_deck
from vbraille.reading.picture import Picture
from vbraille.reading.tuning import Course, Tuning, practice_text
from vbraille.testing import ManualClock, simulated_device
from vbraille.translate import open_source

HOUSE = "texts/scenes/house.scene"


class Felt:
    """Something that is no text, under a simulated hand."""

    def __init__(self, make, model=TWO):
        clock = ManualClock()
        given = simulated_device(model, hand="sweep:1000", clock=clock)
        self.device = ReadingDevice(given, model.display, clock=clock)
        self.device.start(replace(model, display=given.display))
        self.heard = Heard()
        self.what = make(self.device, [self.heard])
        self.what.begin()
        self.loop = Exploration(self.what, self.device, NoKeyboard(), self.heard)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.device.close()

    press, run, finger, type = Reading.press, Reading.run, Reading.finger, Reading.type
    until = Reading.until


def picture(path=HOUSE, model=TWO, **how):
    loaded = load_scene(path, model.style)
    return Felt(lambda device, outputs: Picture(loaded, device, outputs, **how), model)


def test_a_picture_says_what_is_under_the_finger():
    with picture() as felt:
        for element in felt.what.index.elements:
            felt.finger(*felt.what.index.point_on(element))
            here = felt.what.index.here(*felt.what.place)
            assert here.name in felt.press("i")[0]
            assert felt.press("w")[0].startswith(f"{here.name}: ")


def test_an_element_is_gone_to_by_name_and_said_as_the_finger_comes():
    with picture() as felt:
        name = felt.what.index.elements[-1].name
        felt.press("v", "g")
        assert felt.type(name)[0] == f"going to: {name}"
        assert f"there: {name}" in felt.run(4)
        felt.press("g")
        assert "no element 'zzz'" in felt.type("zzz")[0]


def test_zoom_and_pan_end_somewhere():
    with picture() as felt:
        for key in "+-":
            for _ in range(12):
                felt.press(key)
            assert felt.what.aperture.zoom == (16.0 if key == "+" else 0.5)
        felt.press(*"+++")
        while felt.press("]") != ["no more of the picture that way"]:
            pass
        felt.press("0")
        assert felt.what.aperture.is_whole


def test_a_device_of_one_axis_feels_a_line_that_keys_choose():
    with picture(model=ONE) as felt:
        before = felt.what.height
        assert felt.press("shift-down")[0].startswith("height: ")
        assert felt.what.height != before


def test_a_picture_is_read_again_when_its_file_changes(tmp_path):
    path = tmp_path / "a.scene"
    text = Path(HOUSE).read_text()
    path.write_text(text)
    with picture(path) as felt:
        path.write_text(text.replace("title = ", "title = 'new' #", 1))
        assert "reloaded: new" in felt.run(1)
        path.write_text("nonsense")
        assert any(said.startswith("not reloaded") for said in felt.run(1))
        assert felt.press("V")[0].startswith("new, ")


# Figures of a book


def book_with_figure(model):
    source = open_source("texts/scenes/pond.md")
    reading = Reading(source, model, hand="sweep:1")
    figures = BookFigures(reading.book.source, Path("texts/scenes"), model.style)
    reading.reader.figures = figures
    return reading


def test_a_figure_is_felt_alone_and_left():
    with book_with_figure(ONE) as reading:
        assert reading.press("G") == ["no figure here"]
        while not any("shift-g feels it" in each for each in reading.run(0.1)):
            assert reading.press("n") != ["no next line"]
        line = reading.line
        assert reading.press("G")[0].startswith("A map with braille")
        assert reading.press("z")[0].startswith("zoom: 1")
        reading.press("escape")
        reading.run(0.1)
        assert reading.reader.inside is None
        assert reading.line == line
        assert reading.press("i")[0].startswith(f"line {line}")


# The game


def game(players, seed=3):
    deck = load_deck(DECK, TWO.style, TWO.display)[:3]

    def make(device, outputs):
        return Game(deck, device, outputs, players=players, seed=seed)

    return Felt(make)


def test_a_game_is_played_to_its_end():
    with game(2) as felt:
        cards = felt.what.cards
        assert sorted(cards) == [0, 0, 1, 1, 2, 2]
        for number in range(3):
            places = [place for place, card in enumerate(cards) if card == number]
            for place in places:
                felt.what.place = place
                assert felt.press("enter")[0].startswith(felt.what.name(place))
            assert felt.press("enter")[0].startswith("match: ")
        assert felt.what.over
        assert felt.what.points == [3, 0]
        assert "player 1 has won" in felt.heard.said
        felt.press("2")
        assert felt.what.sides == [DOWN] * 6


def test_cards_that_do_not_match_are_turned_back_and_the_other_plays():
    with game(2) as felt:
        cards = felt.what.cards
        other = next(place for place, card in enumerate(cards) if card != cards[0])
        felt.press("enter", f"place:{other}")
        assert felt.press("o")[0].endswith("feel it")
        assert felt.press("enter")[0].startswith("no match")
        assert felt.what.player == 1
        assert GONE not in felt.what.sides
        assert felt.press("1") == ["this game is not over; q stops it"]


# Tuning


def test_a_course_finds_what_is_liked():
    liked = {"texture": 0.3, "contrast": 0.8, "dot_width": 1.5, "dot_spacing": 3.0, "cell_gap": 4.0}
    choices = []
    while (course := Course(ONE.style, choices)).knob is not None:
        first, second = course.pair
        want = liked[course.knob.name]
        choices.append(1 if abs(first - want) <= abs(second - want) else 2)
    assert len(choices) == Course.total
    for name, low, high in (("texture", 0.15, 0.45), ("contrast", 0.65, 0.95)):
        assert low <= getattr(course.style.tuning, name) <= high
    assert len(course.found) == 5


def test_a_choice_is_made_and_taken_back():
    with Reading(practice_text(), hand="sweep:1") as reading:
        tuning = Tuning(reading.reader, "evening")
        reading.loop = Exploration(tuning, reading.device, NoKeyboard(), reading.heard)
        tuning.begin()
        assert reading.press("1")[0].startswith("choice 2 of")
        reading.press(" ", "2")
        assert tuning.course.choices == [1, 2]
        reading.press("u", "u")
        assert reading.press("u") == ["nothing to undo"]
