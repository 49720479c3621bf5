"""Live view of a reading: the states sent to pages, and the commands that pages send."""

import pytest

from tests.reading.bench import ONE, TWO, Reading
from tests.reading.test_pictures import game, picture
from vbraille.live.messages import LetGo, PagePress, Point, Turn
from vbraille.reading.liveview import LiveOutput

TEXT = "\n\n".join(f"row {n} of the text" for n in range(30))


class View:
    """A live view that keeps what it is told."""

    def __init__(self):
        self.states, self.asked = [], []

    def watch(self, ring):
        pass

    def tell(self, state):
        self.states.append(state)

    def take(self):
        asked, self.asked = self.asked, []
        return asked

    def notes(self):
        return []


@pytest.fixture
def seen(monkeypatch):
    monkeypatch.setattr("vbraille.engine.loop.LocalEngine.reader", lambda _: None, raising=False)

    def show(felt):
        view = View()
        output = LiveOutput(view, felt.device, felt.heard.say)
        felt.loop._sources = [output]
        felt.loop.what.outputs.append(output)
        felt.run(0.2)
        return view

    return show


@pytest.mark.parametrize("model", [ONE, TWO])
def test_a_page_has_the_line_under_the_hand_and_those_around_it(seen, model):
    with Reading(TEXT, model, hand="sweep:1") as reading:
        view = seen(reading)
        reading.press("n", "n", "n")
        reading.run(0.2)
        state = view.states[-1]
        assert [line.text.strip() for line in state.lines if line.under] == [reading.reader.text]
        tops = [line.top_mm for line in state.lines]
        assert tops == sorted(tops)
        assert len(tops) > 3
        assert {knob.name for knob in state.knobs} >= {"texture", "dot_width"}
        assert "line 4" in state.said[-1]


def test_a_page_calls_commands_turns_knobs_and_holds_the_hand(seen):
    with Reading(TEXT, hand="sweep:1") as reading:
        view = seen(reading)
        names = [command.name for command in view.states[-1].commands]
        assert {"next-line", "pause", "undo"} <= set(names)
        assert not {"quit", "save", "bookmark"} & set(names)
        view.asked = [PagePress("next-line"), PagePress("quit"), PagePress("nonsense")]
        reading.run(0.1)
        assert reading.line == 2
        assert not reading.reader.done
        view.asked = [Turn("texture", 0.4), Turn("texture", 7.0), Turn("nonsense", 1.0)]
        reading.run(0.1)
        assert reading.reader.style.tuning.texture == 1.0
        view.asked = [Point(50.0, 0.0, 0.0)]
        reading.run(1.0)
        assert reading.device.held
        assert view.states[-1].held
        view.asked = [LetGo()]
        reading.run(0.2)
        assert not reading.device.held


def test_a_picture_and_a_game_are_shown_as_they_are(seen):
    with picture() as felt:
        view = seen(felt)
        felt.until(lambda: view.states[-1].scene.image)
        assert view.states[-1].scene.width_mm == felt.what.loaded.scene.canvas.width_mm
    with game(1) as felt:
        view = seen(felt)
        view.asked = [PagePress("POINT", 1)]
        felt.run(0.2)
        sides = [card.side for row in view.states[-1].cards for card in row]
        assert sides[1] == "turned up"
        assert view.states[-1].blind


def test_a_fault_of_the_live_view_does_not_end_a_reading(seen, monkeypatch):
    with Reading(TEXT, hand="sweep:1") as reading:
        view = seen(reading)
        monkeypatch.setattr(view, "tell", lambda _: 1 / 0)
        said = reading.run(0.2)
        assert len(said) == 1
        assert "ZeroDivisionError" in said[0]
        assert reading.press("n") == ["line 2"]
