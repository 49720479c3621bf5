"""The memory game of Lévesque 2009, ch. 5: cards face down, told apart by the finger alone.

Two cards are turned up, one after the other. If they match, a point is scored and both leave the
table; if not, both are turned back. The source lets a mouse choose the card; here keys do, and all
is said, so that no player needs to see.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from pathlib import Path
from random import Random
from typing import TYPE_CHECKING

from vbraille.errors import InputError
from vbraille.pictures.composing import compose
from vbraille.pictures.loading import check_fits, load_scene
from vbraille.reading.commands import WAYS, Where, both_ways, command
from vbraille.reading.explored import Explored
from vbraille.reading.picture import sweep
from vbraille.scene.scene import Scene
from vbraille.wording import count

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vbraille.display import Display
    from vbraille.pictures.loading import LoadedScene
    from vbraille.reading.device import ReadingDevice
    from vbraille.reading.outputs import Output
    from vbraille.render import BrailleStyle

DECK = Path(__file__).parent / "deck"  # the cards that come with the program
_LEAST_CARDS, _MOST_CARDS = 2, 50
COLUMNS = 6  # of the table; the source does not say how its cards lie
DOWN, UP, GONE = "face down", "turned up", "empty"
_command = partial(command, where=Where.GAME)


def load_deck(folder: Path, style: BrailleStyle, display: Display) -> list[LoadedScene]:
    """Read a deck: a folder of scenes, each the picture of two cards.

    Raises
    ------
    InputError
        If there is no such folder, it has too few scenes or too many, or one cannot be felt on the
        display.
    """
    if not folder.is_dir():
        raise InputError(f"no folder {folder}; a deck is a folder of scenes")
    paths = sorted(path for path in folder.iterdir() if path.suffix in (".scene", ".svg"))
    if not _LEAST_CARDS <= len(paths) <= _MOST_CARDS:
        has = count(len(paths), "scene")
        raise InputError(f"{folder} has {has}; a deck has {_LEAST_CARDS} to {_MOST_CARDS}")
    deck = [load_scene(path, style) for path in paths]
    for card in deck:
        check_fits(card.scene, display)
    return deck


class Game(Explored):
    """A table of cards, of which one that is turned up is under the hand.

    Parameters
    ----------
    deck
        Pictures of the cards.
    device, outputs
        As of `Explored`; the carriage goes along x and y.
    players
        Number of players, 1 or 2.
    seed
        Seed of the order of the cards; the next game's is one more.
    attended
        Whether a person is at a keyboard, so that the end of a game is not the end of playing.

    Attributes
    ----------
    cards : list[int]
        Number of the picture at each place, row by row; each picture is there twice.
    sides : list[str]
        How the card at each place lies: `DOWN`, `UP` or `GONE`.
    up : list[int]
        Places of the cards that are turned up, in order.
    points : list[int]
        Points of each player.
    player : int
        Number of the player whose turn it is, from 0.
    turns : int
        Number of turns that are over.
    place : int
        Place of the table that keys have chosen.
    felt : int or None
        Place of the card under the hand.
    """

    where = Where.GAME
    doing = "playing"

    def __init__(
        self,
        deck: Sequence[LoadedScene],
        device: ReadingDevice,
        outputs: Sequence[Output],
        *,
        players: int,
        seed: int,
        attended: bool = True,
    ) -> None:
        super().__init__(device, outputs)
        self._deck, self._seed, self._attended = deck, seed, attended
        blank = replace(deck[0], scene=Scene(canvas=deck[0].scene.canvas), numbers=())
        rate_hz = device.display.rate_hz
        self._programs = [compose(card, device.display, rate_hz=rate_hz) for card in (*deck, blank)]
        self._number = 0
        self._deal(players)

    def _deal(self, players: int) -> None:
        """Deal two cards of each picture in the random order of the seed."""
        random = Random(self._seed)
        self.cards = sorted([*range(len(self._deck))] * 2, key=lambda _: random.random())
        self.sides = [DOWN] * len(self.cards)
        self.points, self.player, self.turns = [0] * players, 0, 0
        self.up: list[int] = []
        self.place = 0
        self._feel(None)

    def begin(self) -> None:
        """Say how the cards lie, and whose turn it is."""
        rows = -(-len(self.cards) // COLUMNS)
        self.say(f"{count(len(self.cards), 'card')} face down, {rows} rows of {COLUMNS}")
        self._say_turn()
        self.say_place()

    @property
    def over(self) -> bool:
        """Tell whether all cards are gone."""
        return all(side == GONE for side in self.sides)

    def name(self, place: int) -> str:
        """Words for a place of the table."""
        row, column = divmod(place, COLUMNS)
        return f"row {row + 1}, card {column + 1}"

    def _say_turn(self) -> None:
        if len(self.points) > 1:
            self.say(f"player {self.player + 1}'s turn")

    def _feel(self, place: int | None) -> None:
        """Put the card of a place under the hand, or nothing."""
        self.felt = place
        self._number += 1
        self.device.put(self._programs[-1 if place is None else self.cards[place]], self._number)
        self.steer()

    def steer(self) -> None:
        """Have a simulated hand go over the card that it feels."""
        if self.felt is not None:
            self.device.give(sweep(self._deck[self.cards[self.felt]].scene.canvas))

    def route(self, cell: int) -> None:
        """Choose a place that was pointed at, and turn its card, or feel it again."""
        if not 0 <= cell < len(self.cards):
            return
        self.place = cell
        if self.sides[cell] == UP and cell != self.felt:
            self.other()
        else:
            self.turn_up()

    @both_ways(
        "card that lies face down",
        "n | p",
        also="button:1 | pins:LNDN",
        first=True,
        where=Where.GAME,
    )
    def card(self, step: int) -> None:
        """Choose the next card that lies face down, or the one before."""
        places = range(self.place + step, len(self.cards) if step > 0 else -1, step)
        place = next((each for each in places if self.sides[each] == DOWN), None)
        if place is None:
            self.refuse_step(step, "card face down")
        else:
            self.place = place
            self.say_place()

    def move(self, right: int, down: int) -> None:
        """Choose the place beside, above or below."""
        row, column = divmod(self.place, COLUMNS)
        place = (row + down) * COLUMNS + column + right
        if 0 <= column + right < COLUMNS and 0 <= place < len(self.cards):
            self.place = place
            self.say_place()
        else:
            self.refuse(f"edge of the table; {self.name(self.place)}")

    @_command("turn the card up; after the second, find out whether they match", "enter",
              also="button:2 pins:HOME", first=True, steers=True, name="turn")  # fmt: skip
    def turn_up(self) -> None:
        """Turn the chosen card up; if two are up, find out whether they match."""
        if len(self.up) == 2:
            self._settle()
        elif self.sides[self.place] != DOWN:
            self.refuse(f"{self.name(self.place)}: {self.sides[self.place]}")
        else:
            self.sides[self.place] = UP
            self.up.append(self.place)
            self._feel(self.place)
            then = "; o feels the other, enter says whether they match" if self.up[1:] else ""
            self.say(f"{self.name(self.place)}: feel it{then}")

    def _settle(self) -> None:
        """End a turn: after a match both cards leave, and the player has a point and goes on."""
        (first, second), self.up = self.up, []
        self.turns += 1
        self._feel(None)
        matches = self.cards[first] == self.cards[second]
        self.sides[first] = self.sides[second] = GONE if matches else DOWN
        if matches:
            self.points[self.player] += 1
            title = self._deck[self.cards[first]].title
            points = count(self.points[self.player], "point")
            self.say(f"match: {title}; player {self.player + 1}: {points}")
        else:
            self.player = (self.player + 1) % len(self.points)
            self.say("no match: both cards are turned back")
        if not self.over:
            self._say_turn()
            return
        self.say_points()
        best = [n for n, points in enumerate(self.points, 1) if points == max(self.points)]
        if len(self.points) > 1:
            self.say("a draw" if best[1:] else f"player {best[0]} has won")
        self.say(f"game over: {len(self.points)} plays again, q stops")
        self.done = not self._attended

    @_command("feel the other card that is turned up", "o", also="button:3", first=True,
              steers=True)  # fmt: skip
    def other(self) -> None:
        """Feel the other card that is turned up."""
        others = [place for place in self.up if place != self.felt]
        if others:
            self._feel(others[0])
            self.say(f"{self.name(others[0])}: feel it")
        else:
            self.refuse("no other card is turned up; enter turns one")

    @_command("say the place, and how its card lies", "i u")
    def say_place(self) -> None:
        """Say the chosen place, and how its card lies."""
        self.say(f"{self.name(self.place)}: {self.sides[self.place]}")

    @_command("say how all cards lie", "O", first=True, steers=True)
    def say_table(self) -> None:
        """Say how all cards lie, row by row."""
        for begin in range(0, len(self.sides), COLUMNS):
            row = ", ".join(self.sides[begin : begin + COLUMNS])
            self.say(f"row {begin // COLUMNS + 1}: {row}")

    @_command("say the points", "V f5", first=True, steers=True)
    def say_points(self) -> None:
        """Say the points of each player, and what is left."""
        points = [f"player {n}: {count(each, 'point')}" for n, each in enumerate(self.points, 1)]
        left = sum(side != GONE for side in self.sides)
        self.say(f"{', '.join(points)}; {count(left, 'card')} left, {count(self.turns, 'turn')}")

    def again(self, players: int) -> None:
        """Deal again, for one player or two, unless a game is going on."""
        if (self.turns or self.up) and not self.over:
            self.refuse("this game is not over; q stops it")
            return
        self._seed += 1
        self._deal(players)
        self.begin()


for name, (right, down) in WAYS.items():
    _command(f"place {name}", name, name=name)(partial(Game.move, right=right, down=down))
for players, name in ((1, "one"), (2, "two")):
    _command(f"deal again for {name} player{'s' if players > 1 else ''}", str(players), name=name,
             steers=True)(partial(Game.again, players=players))  # fmt: skip
