"""Where answers come from: an experimenter who types, a file, or a simulated reader."""

from __future__ import annotations

import os
import select
import sys
from collections.abc import Callable
from dataclasses import replace
from hashlib import sha256
from pathlib import Path
from typing import Literal, NamedTuple, Protocol

import numpy as np

from vbraille.errors import InputError
from vbraille.sessions.planning.plan import Plan
from vbraille.sessions.planning.protocol import Protocol as Study
from vbraille.sessions.planning.questionnaire import Item
from vbraille.sessions.planning.trial import Trial
from vbraille.sessions.simulated.feeling import FeltTrial
from vbraille.sessions.simulated.observer import Observer
from vbraille.sessions.simulated.skin import FeltFrames

WAIT_S = 0.02


class Asked(NamedTuple):
    """What is asked now.

    Parameters
    ----------
    what
        The answer of a trial, how sure it is, or whether to go on after a break.
    trial, attempt
        The trial, and how often it was shown.
    felt
        Function that returns what was felt of each stimulus.
    answer
        The answer, where it is asked how sure it is.
    item
        What is asked of the questionnaire.
    """

    what: Literal["answer", "confidence", "reply", "go"]
    trial: Trial | None
    attempt: int
    felt: Callable[[], list[FeltFrames]]
    answer: str = ""
    item: Item | None = None


class NoMoreAnswers(Exception):
    """There will be no more answers; the session stops, and can be resumed."""


class Answers(Protocol):
    """A source of answers.

    Attributes
    ----------
    name : str
        Name in the record.
    typed : bool
        Whether a person types, who is waited for at breaks and gives commands at any time.
    """

    name: str
    typed: bool

    def line(self, asked: Asked | None) -> tuple[str, int] | None:
        """Return a line and its number in a file (or 0), or None if there is none now.

        A person's line may come at any time, others only if something is asked.

        Raises
        ------
        NoMoreAnswers
            If there will be none.
        """
        ...


class Typed:
    """Lines from standard input."""

    name = "typed"
    typed = True

    def __init__(self) -> None:
        self._descriptor = sys.stdin.fileno()
        self._partial = b""
        self._lines: list[bytes] = []
        self._over = False

    def line(self, asked: Asked | None) -> tuple[str, int] | None:
        """Return a line that was typed."""
        if not self._lines and not self._over:
            self._read()
        if self._lines:
            return self._lines.pop(0).decode("utf-8", "replace"), 0
        if self._over:
            raise NoMoreAnswers
        return None

    def _read(self) -> None:
        if not select.select([self._descriptor], [], [], WAIT_S)[0]:
            return
        said = os.read(self._descriptor, 1 << 16)
        self._over = not said
        *lines, self._partial = (self._partial + said).split(b"\n")
        self._lines += lines


class Scripted:
    """Lines of a file. Empty lines, and lines that begin with #, are left out.

    Parameters
    ----------
    path
        The file.
    after
        Number of the last line that was used in earlier runs.
    """

    typed = False

    def __init__(self, path: Path, after: int) -> None:
        try:
            text = path.read_text("utf-8-sig")
        except (OSError, UnicodeDecodeError) as error:
            raise InputError(f"{path} cannot be read: {error}") from None
        self.name = str(path)
        self._left = [
            (line.strip(), number)
            for number, line in enumerate(text.splitlines(), 1)
            if number > after and line.strip() and not line.lstrip().startswith("#")
        ]

    def line(self, asked: Asked | None) -> tuple[str, int] | None:
        """Return the next line, if something is asked."""
        if asked is None:
            return None
        if asked.what == "go":
            return "", 0
        if not self._left:
            raise NoMoreAnswers
        return self._left.pop(0)


class Simulated:
    """A simulated reader. It is given frames and places, and knows how braille is laid out.

    Parameters
    ----------
    protocol, plan
        What the reader was told: distances, and where a string begins. Nothing of a trial is told.
    noise
        Standard deviation of the noise, in units of a perfect dot.
    """

    typed = False

    def __init__(self, protocol: Study, plan: Plan, noise: float) -> None:
        self.name = f"simulated:{noise:g}"
        self._noise = noise
        self._study = protocol
        self._drawn = f"{protocol.name} {plan.participant} {plan.seed}"
        usual = protocol.display_model.style
        display = protocol.display_model.display
        self._observers = {}
        for condition in protocol.conditions:
            style = protocol.style(condition.over(protocol.display))
            told = replace(usual, mapping=style.mapping, geometry=style.geometry)
            self._observers[condition.name] = Observer(display, told, noise=noise)

    def line(self, asked: Asked | None) -> tuple[str, int] | None:
        """Return the answer to what is asked."""
        if asked is None:
            return None
        if asked.what == "go":
            return "", 0
        if asked.item is not None:
            item = asked.item
            known = item.choices or ("nothing",)
            return str(item.scale.least) if item.scale else item.right or known[0], 0
        assert asked.trial is not None, "a trial is asked about"
        drawn = f"{self._drawn} {asked.trial.practice} {asked.trial.number} {asked.attempt}"
        if asked.what == "answer":
            return self._answer(asked, random_of(drawn)), 0
        scale = self._study.asks.confidence
        assert scale is not None, "it is asked how sure the answer is"
        # The reader is surer of an answer that it would give again. After a crash between an answer
        # and its confidence there is nothing left to think of.
        habits = random_of(f"{drawn} habits")
        habits.random(2)
        is_sure = bool(asked.felt()) and self._answer(asked, habits) == asked.answer
        quarters = 3 if is_sure else 1
        return str(scale.least + round(quarters * (scale.most - scale.least) / 4)), 0

    def _answer(self, asked: Asked, random: np.random.Generator) -> str:
        trial, lead = asked.trial, self._study.display.lead_cells
        first = trial.stimuli[0]
        start = lead + len(first.before)
        felt, count = asked.felt(), len(trial.stimuli)
        sensed = FeltTrial(
            self._observers[trial.condition],
            [*felt[: count - 1], felt[-1]],  # of what was turned only the newest counts
            [len(stimulus.masks(lead)) for stimulus in trial.stimuli],
            slice(start, start + len(first.cells)),
            getattr(self._study.design, "parameter", ""),
            None,
            len(felt) - count,
        )
        return self._study.asks.simulate(sensed, self._noise, random)


def random_of(text: str) -> np.random.Generator:
    """Return a generator that is seeded by a text."""
    return np.random.default_rng(int.from_bytes(sha256(text.encode()).digest()[:8], "big"))


def answers_of(spec: str, protocol: Study, plan: Plan, after: int) -> Answers:
    """Return the source of a spec: "typed", "simulated", "simulated:NOISE" or a file.

    Raises
    ------
    InputError
        If there is no such source.
    """
    kind, _, noise = spec.partition(":")
    if kind == "typed":
        return Typed()
    if kind != "simulated":
        return Scripted(Path(spec), after)
    try:
        return Simulated(protocol, plan, float(noise or 0))
    except ValueError:
        raise InputError(f"noise is {noise!r}; give a number, 0 or more") from None
