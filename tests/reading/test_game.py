"""The memory game: its rules, a whole game by a player who only hears, and the deck's cards."""

import re
from itertools import combinations

import numpy as np
import pytest

from tests.engine.planar import Bench
from vbraille.devices.base import Placing
from vbraille.errors import InputError
from vbraille.feeling.loading import load_scene
from vbraille.live.messages import PagePress
from vbraille.reading.commands.game import BOUND
from vbraille.reading.game import DECK, GameView, MemoryGame, Side, load_deck, programs_of
from vbraille.reading.liveview import LastSentences, PlayedState
from vbraille.render import MODELS
from vbraille.simulation.steering import ReadPage, Steering

DISPLAY = MODELS["stress2-8x8"].display
STYLE = MODELS["stress2-8x8"].style
PLACE = re.compile(r"place: row (\d), card (\d), (.*)")


class Played:
    """A game on a device in memory, what was said of it, and its keys."""

    def __init__(self, deck=None, *, players=1, seed=1, steering=None):
        self.bench = Bench(lambda _: (10.0, 10.0, 0.0), DISPLAY)
        self.said, self.attended, self.steering = [], True, steering
        self.engine, self.display = self.bench.engine, DISPLAY
        self.placing, self.paused, self.held, self.pointer = Placing.DONE, False, False, None
        self.deck = load_deck(DECK, STYLE, DISPLAY) if deck is None else deck
        programs = programs_of(self.deck, DISPLAY, 1000.0)
        self.view = GameView(
            self.deck, programs, self, players=players, seed=seed, say=self.said.append, bound=BOUND
        )
        self.view.start()

    def press(self, *keys):
        """Press keys; what was said."""
        self.said.clear()
        for key in keys:
            self.view.press(key)
        return list(self.said)

    def go(self, row, column):
        """Go to a place by the arrow keys and what is said of each place."""
        said = self.press("i")
        while (at := tuple(map(int, PLACE.match(said[-1]).groups()[:2]))) != (row, column):
            key = "down" if at[0] < row else "up" if at[0] > row else ""
            said = self.press(key or ("right" if at[1] < column else "left"))
        return said[-1]


def listener(played):
    """Play to the end by ear: remember which pairs did not match, and try the others."""
    tried, turns = set(), 0
    while True:
        rows = [line.split(": ")[1].split(", ") for line in played.press("O")]
        left = [
            (row + 1, column + 1)
            for row, sides in enumerate(rows)
            for column, side in enumerate(sides)
            if side == "face down"
        ]
        if not left:
            return turns
        pair = next(pair for pair in combinations(left, 2) if pair not in tried)
        tried.add(pair)
        for place in pair:
            assert played.go(*place).endswith("face down")
            assert f"card: row {place[0]}, card {place[1]}; feel it" in played.press("\n")
        said = played.press("\n")
        turns += 1
        assert said[0].startswith(("match: ", "no match: "))


@pytest.mark.parametrize("players", [1, 2])
def test_a_whole_game_is_played_by_ear(players):
    played = Played(players=players)
    turns = listener(played)
    assert played.view.game.over
    assert sum(played.view.game.points) == 12
    assert f"left: 0 cards, after {turns} turns" in played.press("V")
    assert played.press("1")[0] == "table: 24 cards face down, 4 rows of 6"  # another game


def test_two_cards_of_each_are_dealt_by_the_seed():
    first, again, other = (MemoryGame.dealt(12, 1, seed) for seed in (1, 1, 2))
    assert first == again != other
    assert sorted(first.cards) == sorted([*range(12)] * 2)


def test_a_match_scores_and_leaves_and_the_player_goes_on_else_both_turn_back():
    game = MemoryGame((0, 1, 0, 1), (0, 0))
    missed = game.turned(0).turned(1).settled()
    assert (missed.points, missed.player, missed.gone) == ((0, 0), 1, frozenset())
    won = missed.turned(0).turned(2).settled()
    assert (won.points, won.player, won.gone) == ((0, 1), 1, {0, 2})
    assert [won.side(place) for place in range(4)] == [Side.GONE, Side.DOWN, Side.GONE, Side.DOWN]
    assert won.turned(1).turned(3).settled().over


def test_a_card_is_felt_from_its_turn_to_the_end_of_it_and_its_name_is_not_said():
    played = Played()
    played.bench.run(0.2)
    assert played.bench.sent[-1].max() == 0.0
    said = played.press("\n")
    played.bench.device.place = lambda now_s: (100.0 * now_s % 113.0, 30.0, 0.0)
    felt = np.array([tick["frame"].max() for tick in played.bench.run(1.1)])
    assert felt.max() > 0.0
    said += played.press("n", "\n", "o", "i", "O", "V")
    assert not [card.title for card in played.deck if any(card.title in line for line in said)]
    played.press("\n")
    assert played.press("o") == ["card: none other is turned up; enter turns one"]


def test_a_simulated_hand_goes_over_each_card_that_is_turned_up():
    steering = Steering()
    hand = Steering(steering.descriptor)
    played = Played(steering=steering)
    assert hand.take() is None
    played.press("\n")
    assert hand.take() == ReadPage(6, 10.0, 113.0)


def test_what_cannot_be_done_is_said():
    played = Played()
    played.press("\n")
    assert played.press("\n") == ["place: row 1, card 1, turned up"]
    assert played.press("left", "up") == ["place: row 1, card 1, turned up"] * 2
    assert played.press("2") == ["game: it is not over; q stops it"]
    assert played.press("x") == ["no command: x; h says the keys"]


def test_cards_of_the_deck_are_told_apart_by_what_is_felt():
    """Between any two cards most of what is felt along one path differs."""
    deck = load_deck(DECK, STYLE, DISPLAY)
    programs = programs_of(deck, DISPLAY, 1000.0)
    x, y = (at.ravel() for at in np.meshgrid(np.arange(5, 110, 1.5), np.arange(5, 60, 5.0)))
    time = np.arange(x.size) / 1000
    still = np.zeros((x.size, 2))
    felt = [program.poses(x, y, np.zeros(x.size), time, still)[1] for program in programs]
    assert len(deck) == 12
    assert felt[-1].max() == 0.0  # nothing is felt of a card that lies face down
    for first, second in combinations(felt[:-1], 2):
        assert np.abs(first - second).mean() > 0.5 * np.maximum(first, second).mean()


@pytest.mark.parametrize("path", sorted(DECK.iterdir()), ids=lambda path: path.stem)
def test_an_author_has_nothing_to_mend_on_a_card(path):
    loaded = load_scene(path, STYLE)
    assert loaded.title
    assert loaded.scene.description


def test_a_folder_that_is_no_deck_is_refused(tmp_path):
    with pytest.raises(InputError, match="no such folder"):
        load_deck(tmp_path / "none", STYLE, DISPLAY)
    with pytest.raises(InputError, match="2 to 50"):
        load_deck(tmp_path, STYLE, DISPLAY)
    for name in ("one", "two"):
        (tmp_path / f"{name}.scene").write_text("canvas = { width_mm = 900, height_mm = 20 }\n")
    with pytest.raises(InputError, match="canvas is 900"):
        load_deck(tmp_path, STYLE, DISPLAY)


def test_a_page_turns_cards_by_the_same_table_and_is_not_told_what_they_are():
    played = Played()
    told = PlayedState(played, played.view, LastSentences())
    state = told.changed()
    assert [len(row) for row in state.cards] == [6, 6, 6, 6]
    assert {card.side for row in state.cards for card in row} == {"face down"}
    assert (state.blind, state.scene, state.title) == (True, None, "memory game")
    assert [command.name for command in state.commands][:2] == ["TURN", "OTHER"]
    assert told.changed() is None

    def press(*request):
        played.said.clear()
        told.obey(PagePress(*request))
        return list(played.said)

    assert press("POINT", 7) == ["card: row 2, card 2; feel it"]
    card = told.changed().cards[1][1]
    assert (card.side, card.felt) == ("turned up", True)
    cards = played.view.game.cards
    other = next(n for n, one in enumerate(cards) if n != 7 and one == cards[7])
    assert press("POINT", other)[0].startswith("card: row")
    assert press("POINT", 7) == ["card: row 2, card 2; feel it"]  # which is up: it is felt again
    assert press("POINT", 7)[0].startswith("match: ")
    state = told.changed()
    assert state.cards[1][1].side == "empty"
    assert ("points", "1") in state.facts
    assert press("POINT", 24) == ["place: there is none with number 25"]
    assert press("POINT") == ["live view: POINT is for a place"]
    assert press("TURN", 3) == ["live view: TURN is not for a place"]
    assert press("QUIT") == ["live view: QUIT is no command that a page may call"]
