"""Simulated people who choose the nearer of two, and how near procedures come to what they like."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from vbraille.adaptive.questplus import nearer_quest, ordered_pairs
from vbraille.sessions.planning.procedures import PREFERRED, QuestProcedure
from vbraille.sessions.planning.protocolfiles import load_protocol

if TYPE_CHECKING:
    from vbraille.adaptive.questplus import GridQuest

PROTOCOLS = ("tuning-width", "tuning-spacing")
PEOPLE, SEED = 500, 15
ADAPTIVE_TRIALS, FIXED_REPEATS = 30, 6  # of the 15 pairs of six values, in either order: 90 trials


@dataclass(frozen=True, slots=True)
class Person:
    """A person who judges the distance of each value from the one that is liked.

    Parameters
    ----------
    liked_mm
        Value that is liked best.
    noise
        Standard deviation of the noise: of each distance in mm, or by ratio of each value.
    lapses
        Share of answers that are given by chance.
    by_ratio
        Whether each value is felt with noise, and then its ratio to the liked one is judged: a
        shape that the procedures do not have.
    """

    liked_mm: float
    noise: float
    lapses: float = 0.0
    by_ratio: bool = False

    def chooses_first(self, first_mm: float, second_mm: float, random: np.random.Generator) -> bool:
        """Whether the first of two values is chosen."""
        lapses, guess = random.random(2)
        noise = self.noise * random.standard_normal(2)
        if lapses < self.lapses:
            return bool(guess < 0.5)
        values = np.array((first_mm, second_mm))
        if self.by_ratio:
            away = np.abs(np.log(values) + noise - np.log(self.liked_mm))
        else:
            away = np.abs(values - self.liked_mm) + noise
        return bool(away[0] < away[1])


KINDS = {
    "sharp (0.1 mm)": {"noise": 0.1},
    "blunt (0.4 mm)": {"noise": 0.4},
    "lapsing 5 % (0.2 mm)": {"noise": 0.2, "lapses": 0.05},
    "of another shape (ratios, 15 %)": {"noise": 0.15, "by_ratio": True},
}


@dataclass(frozen=True, slots=True)
class Tuned:
    """Errors of the liked value in mm, each float64[people], by how it was asked."""

    adaptive: np.ndarray
    six: np.ndarray
    fixed: np.ndarray
    inside: float  # share of the adaptive intervals of 95 % that hold the liked value

    def rmse(self) -> tuple[float, float, float]:
        """Root mean squares of the errors: 30 adaptive, 30 on six values, 90 fixed."""
        return tuple(self.rmse_between(e)[1] for e in (self.adaptive, self.six, self.fixed))

    @staticmethod
    def rmse_between(errors: np.ndarray) -> tuple[float, float, float]:
        """Lower end, value, and upper end of a root mean square, with an interval of 95 %."""
        squares = errors**2
        rmse = float(np.sqrt(squares.mean()))
        # The root's slope is 1 / (2 rmse).
        apart = 1.96 * float(squares.std(ddof=1)) / np.sqrt(errors.size) / (2 * rmse)
        return rmse - apart, rmse, rmse + apart

    def ratio_error(self) -> float:
        """Standard error of the adaptive root mean square by that of the fixed trials."""
        more, less = self.adaptive**2, self.fixed**2
        each = more / more.mean() - less / less.mean()
        ratio = np.sqrt(more.mean() / less.mean())
        return float(ratio / 2 * each.std(ddof=1) / np.sqrt(each.size))


def tune(kind: str, people: int, seed: int, name: str = "tuning-width") -> Tuned:
    """Ask so many people of a kind in three ways; the liked values are drawn over the range."""
    fixed, protocol = load_protocol(name), load_protocol(f"{name}-adaptive")
    table, values = protocol.procedure, fixed.design.values
    assert isinstance(table, QuestProcedure)
    quest = table.quest(protocol.design)
    # The same estimator for all: only the values that may be asked differ.
    near = [p for p in ordered_pairs(values) if p[1] - p[0] <= table.furthest + 1e-9]
    six = _same(quest, near)
    every = _same(quest, ordered_pairs(values))
    random = np.random.default_rng(seed)
    errors, inside = [], 0
    for _ in range(people):
        person = Person(float(random.uniform(min(values), max(values))), **KINDS[kind])
        found = _ask(quest, person, random)
        inside += found.low <= person.liked_mm <= found.high
        likes = (found.mean, _ask(six, person, random).mean, _fixed(every, person, random))
        errors.append([like - person.liked_mm for like in likes])
    return Tuned(*np.array(errors).T, inside / people)


def _same(quest: GridQuest, pairs: list) -> GridQuest:
    return nearer_quest(pairs, *quest.axes, about=PREFERRED)


def _ask(quest: GridQuest, person: Person, random: np.random.Generator):
    history = []
    for _ in range(ADAPTIVE_TRIALS):
        pair = quest.next(history)
        history.append((pair, int(person.chooses_first(*pair, random))))
    return quest.estimate(history, PREFERRED)


def _fixed(quest: GridQuest, person: Person, random: np.random.Generator) -> float:
    history = [
        (pair, int(person.chooses_first(*pair, random)))
        for pair in quest.stimuli
        for _ in range(FIXED_REPEATS)
    ]
    return quest.estimate(history, PREFERRED).mean
