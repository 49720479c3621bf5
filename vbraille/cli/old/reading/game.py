"""The memory game of Lévesque 2009, ch. 5: cards face down, told apart by the finger alone.

Two cards are turned up, one after the other. If they match, a point is scored and both leave the
table; if not, both are turned back. The source lets a mouse choose the card; here keys do, and all
is said, so that no player needs to see.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import Enum
from pathlib import Path
from random import Random
from typing import TYPE_CHECKING, Final

from vbraille.cli.old.reading.view import Cue, View
from vbraille.errors import InputError
from vbraille.feeling.composing import compose
from vbraille.feeling.loading import check_fits, load_scene
from vbraille.scene.scene import Scene
from vbraille.simulation.steering import ReadPage
from vbraille.wording import count

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import numpy as np
    from numpy.typing import NDArray

    from vbraille.cli.old.reading.device import OpenDevice
    from vbraille.cli.old.reading.keys import Bound
    from vbraille.display import Display
    from vbraille.feeling.loading import LoadedScene
    from vbraille.render.braille.style import BrailleStyle
    from vbraille.render.program import Program

DECK: Final = Path(__file__).parent / "deck"  # the cards that come with the program
_LEAST_CARDS, _MOST_CARDS = 2, 50
_COLUMNS: Final = 6  # of the table; the source does not say how its cards lie
_LINE_MM: Final = 10.0  # between the lines that a simulated hand goes along


class Side(Enum):
    """Sides of a card's place, in words."""

    DOWN = "face down"
    UP = "turned up"
    GONE = "empty"


@dataclass(frozen=True, slots=True)
class MemoryGame:
    """The state of a game: the cards on the table, and the players' points.

    Parameters
    ----------
    cards
        Number of the picture at each place, row by row; each picture is there twice.
    points
        Points of each player.
    player
        Number of the player whose turn it is, from 0.
    up
        Places of the cards that are turned up, in order.
    gone
        Places from which cards are gone.
    turns
        Number of turns that are over.
    """

    cards: tuple[int, ...]
    points: tuple[int, ...] = (0,)
    player: int = 0
    up: tuple[int, ...] = ()
    gone: frozenset[int] = frozenset()
    turns: int = 0

    @classmethod
    def dealt(cls, pictures: int, players: int, seed: int) -> MemoryGame:
        """Deal two cards of each picture in the random order of a seed."""
        random = Random(seed)
        cards = sorted([*range(pictures)] * 2, key=lambda _: random.random())
        return cls(tuple(cards), (0,) * players)

    def side(self, place: int) -> Side:
        """Tell how the card at a place lies."""
        if place in self.gone:
            return Side.GONE
        return Side.UP if place in self.up else Side.DOWN

    def turned(self, place: int) -> MemoryGame:
        """Turn a card up, which is face down, while fewer than two are."""
        return replace(self, up=(*self.up, place))

    @property
    def matches(self) -> bool:
        """Tell whether the two cards that are turned up have one picture."""
        first, second = self.up
        return self.cards[first] == self.cards[second]

    def settled(self) -> MemoryGame:
        """End a turn: after a match both cards leave, and the player has a point and goes on."""
        after = replace(self, up=(), turns=self.turns + 1)
        if not self.matches:
            return replace(after, player=(self.player + 1) % len(self.points))
        points = list(self.points)
        points[self.player] += 1
        return replace(after, points=tuple(points), gone=self.gone.union(self.up))

    @property
    def over(self) -> bool:
        """Tell whether all cards are gone."""
        return len(self.gone) == len(self.cards)


def load_deck(folder: Path, style: BrailleStyle, display: Display) -> list[LoadedScene]:
    """Read a deck: a folder of scenes, each the picture of two cards.

    Raises
    ------
    InputError
        If there is no such folder, it has too few scenes or too many, or one cannot be felt on the
        display.
    """
    if not folder.is_dir():
        raise InputError(f"{folder}: there is no such folder; a deck is a folder of scenes")
    paths = sorted(path for path in folder.iterdir() if path.suffix in (".scene", ".svg"))
    if not _LEAST_CARDS <= len(paths) <= _MOST_CARDS:
        has = count(len(paths), "scene")
        raise InputError(f"{folder} has {has}; a deck has {_LEAST_CARDS} to {_MOST_CARDS}")
    deck = [load_scene(path, style) for path in paths]
    for card in deck:
        check_fits(card.scene, display)
    return deck


class GameView(View):
    """The view of a game: a table of cards, of which one that is turned up is under the hand.

    Parameters
    ----------
    deck, programs
        Pictures of the cards, and their programs as `programs_of` gives them.
    device
        Device that they are felt on, whose carriage goes along x and y.
    players
        Number of players, 1 or 2.
    seed
        Seed of the order of the cards; the next game's is one more.
    say, cue, bound
        As for a `View`.

    Attributes
    ----------
    game : MemoryGame
        Cards and points.
    place : int
        Place on the table that keys have chosen.
    felt : int or None
        Place of the card under the hand.
    """

    does, doing = "play", "playing"

    def __init__(
        self,
        deck: Sequence[LoadedScene],
        programs: Sequence[Program],
        device: OpenDevice,
        *,
        players: int,
        seed: int,
        say: Callable[[str], None],
        bound: Bound,
        cue: Callable[[Cue], None] = lambda _: None,
    ) -> None:
        super().__init__(device.engine, say, bound, cue)
        self._deck, self._device, self._seed = deck, device, seed
        self._programs = programs
        self.felt: int | None = None
        self._shown = 0
        self._deal(players)

    def start(self) -> None:
        """Put no card under the hand, and say how the cards lie."""
        self._feel(None)
        cards, rows = len(self.game.cards), len(self.rows())
        self.say(f"table: {count(cards, 'card')} face down, {count(rows, 'row')} of {_COLUMNS}")
        self._say_turn()
        self.say_place()

    def steer(self) -> None:
        """Have a simulated hand go over the card that it feels."""
        if self._device.steering is None or self.felt is None:
            return
        canvas = self._deck[self.game.cards[self.felt]].scene.canvas
        lines = max(1, round(canvas.height_mm / _LINE_MM))
        self._device.steering.give(ReadPage(lines, canvas.height_mm / lines, canvas.width_mm))

    def step(self, ticks: NDArray[np.void]) -> None:
        """Do nothing by itself: a player takes the time that the finger needs."""

    # What is asked for

    def say_place(self) -> None:
        """Say the chosen place, and how its card lies."""
        self.say(f"place: {self.name(self.place)}, {self.game.side(self.place).value}")

    def say_table(self) -> None:
        """Say how all cards lie, a row in each sentence."""
        for number, places in enumerate(self.rows(), 1):
            sides = ", ".join(self.game.side(place).value for place in places)
            self.say(f"row {number}: {sides}")

    def say_points(self) -> None:
        """Say the points, and how many cards are left."""
        for player, points in enumerate(self.game.points):
            self.say(f"{self._player(player)}: {count(points, 'point')}")
        left = len(self.game.cards) - len(self.game.gone)
        self.say(f"left: {count(left, 'card')}, after {count(self.game.turns, 'turn')}")

    # What is done

    def move(self, right: int, down: int) -> None:
        """Choose another place of the table."""
        row, column = divmod(self.place, _COLUMNS)
        place = (row + down) * _COLUMNS + column + right
        if 0 <= column + right < _COLUMNS and 0 <= place < len(self.game.cards):
            self.place = place
        else:
            self.cue(Cue.LIMIT)
        self.say_place()

    def step_card(self, step: int) -> None:
        """Choose the next card that lies face down, or the one before."""
        places = range(self.place + step, len(self.game.cards) if step > 0 else -1, step)
        found = (place for place in places if self.game.side(place) is Side.DOWN)
        place = next(found, None)
        if place is None:
            self.cue(Cue.LIMIT)
        else:
            self.place = place
        self.say_place()

    def turn(self) -> None:
        """Turn the chosen card up, or, if two are, find out whether they match."""
        if len(self.game.up) == 2:
            self._settle()
        elif self.game.side(self.place) is not Side.DOWN:
            self.cue(Cue.NOT_FOUND)
            self.say_place()
        else:
            self.game = self.game.turned(self.place)
            self._feel(self.place)
            self.say(f"card: {self.name(self.place)}; feel it")
            if len(self.game.up) == 2:
                self.say(f"two cards: {self.key('OTHER', 'o')} feels the other, {self._again()}")

    def turn_at(self, place: int) -> None:
        """Choose a place by its number, and do with its card what `turn` does, or feel it again."""
        if not 0 <= place < len(self.game.cards):
            self.say_not_found(f"place: there is none with number {place + 1}")
            return
        self.place = place
        if self.game.side(place) is Side.UP and place != self.felt:
            self.feel_other()
        else:
            self.turn()

    def feel_other(self) -> None:
        """Put the other of two cards that are turned up under the hand."""
        others = [place for place in self.game.up if place != self.felt]
        if not others:
            self.say(f"card: none other is turned up; {self.key('TURN', 'enter')} turns one")
            return
        self._feel(others[0])
        self.say(f"card: {self.name(others[0])}; feel it")

    def begin(self, players: int) -> None:
        """Deal the cards for so many players, unless a game is going on."""
        if self.game.turns + len(self.game.up) and not self.game.over:
            self.say_not_found(f"game: it is not over; {self.key('QUIT', 'q')} stops it")
            return
        self._seed += 1
        self._deal(players)
        self.start()

    def _deal(self, players: int) -> None:
        self.game = MemoryGame.dealt(len(self._deck), players, self._seed)
        self.place = 0

    def _settle(self) -> None:
        """End a turn, and say what came of it."""
        before, self.game = self.game, self.game.settled()
        self._feel(None)
        if before.matches:
            title = self._deck[before.cards[before.up[0]]].title
            points = self.game.points[before.player]
            self.say(f"match: {title}; {self._player(before.player)}: {count(points, 'point')}")
        else:
            self.say("no match: both cards are turned back")
        if not self.game.over:
            self._say_turn()
            return
        best = max(self.game.points)
        winners = [n for n, points in enumerate(self.game.points) if points == best]
        self.say_points()
        if len(self.game.points) > 1:
            won = f"{self._player(winners[0])} has won" if len(winners) == 1 else "a draw"
            self.say(f"result: {won}")
        again = self.key(("ONE", "TWO")[len(self.game.points) - 1], "1")
        self.say(f"game over: {again} plays again, {self.key('QUIT', 'q')} stops")
        self.done = not self._device.attended

    def _feel(self, place: int | None) -> None:
        """Put the card of a place under the hand, or nothing."""
        self.felt = place
        self._shown += 1
        number = -1 if place is None else self.game.cards[place]
        self.engine.show(self._programs[number], self._shown)
        self.steer()

    def _say_turn(self) -> None:
        if len(self.game.points) > 1:
            self.say(f"turn: {self._player(self.game.player)}")

    def _again(self) -> str:
        return f"{self.key('TURN', 'enter')} says whether they match"

    def _player(self, number: int) -> str:
        return f"player {number + 1}"

    def rows(self) -> list[list[int]]:
        """Give the places of the table, row by row."""
        count = len(self.game.cards)
        return [
            [*range(begin, min(begin + _COLUMNS, count))] for begin in range(0, count, _COLUMNS)
        ]

    def name(self, place: int) -> str:
        """Words for a place of the table."""
        row, column = divmod(place, _COLUMNS)
        return f"row {row + 1}, card {column + 1}"


def programs_of(deck: Sequence[LoadedScene], display: Display, rate_hz: float) -> list[Program]:
    """Compile the pictures of a deck for a display, and last a picture in which nothing is felt."""
    first = deck[0]
    blank = replace(first, scene=Scene(canvas=first.scene.canvas), numbers=())
    return [compose(card, display, rate_hz=rate_hz) for card in (*deck, blank)]
