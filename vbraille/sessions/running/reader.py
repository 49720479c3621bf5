"""The simulated reader as a source of answers."""

from __future__ import annotations

from dataclasses import replace
from hashlib import sha256
from itertools import pairwise
from typing import Annotated

import numpy as np
from msgspec import Meta, Struct, ValidationError, convert, structs

from vbraille.errors import InputError
from vbraille.sessions.planning.plan import Plan
from vbraille.sessions.planning.protocol import Protocol
from vbraille.sessions.planning.shown import edges_mm, make_shown
from vbraille.sessions.planning.trial import Trial
from vbraille.sessions.planning.values import Share
from vbraille.sessions.running.answers import Answers, Asked, Line
from vbraille.sessions.simulated.feeling import CELL_GAP, LENGTHS, DotPair, FeltTrial
from vbraille.sessions.simulated.matching import differences, most_like
from vbraille.sessions.simulated.observer import Observer

INSTEAD = "type the answers, or give a file of them"


class Habits(Struct, frozen=True, rename="kebab", forbid_unknown_fields=True):
    """Habits of a simulated reader.

    Parameters
    ----------
    noise
        Standard deviation of the noise, in units of a perfect dot or of the nominal length.
    lapses
        Share of the trials that are answered by chance alone.
    false_alarms
        Share of the other trials that are answered "yes" or "different" whatever was felt.
    """

    noise: Annotated[float, Meta(ge=0, le=100)] = 0.0
    lapses: Share = 0.0
    false_alarms: Share = 0.0


def parse_habits(text: str) -> Habits:
    """Read what follows "simulated:", such as "0.4,lapses=0.05,false-alarms=0.1".

    Raises
    ------
    InputError
        If it cannot be read, or is out of range.
    """
    parts = (part.rpartition("=") for part in text.split(",") if part)
    try:
        given = {name or "noise": number for name, _, number in parts}
        return convert(given, Habits, strict=False)
    except ValidationError:
        raise InputError(
            f"{text!r} are no habits of a simulated reader; give noise from 0 to 100, lapses and "
            "false-alarms from 0 to 1, such as simulated:0.2,lapses=0.05"
        ) from None


def simulated_answers(protocol: Protocol, plan: Plan, habits: str) -> Simulated:
    """Return the simulated reader for a protocol.

    Raises
    ------
    InputError
        If the habits cannot be read, or the reader cannot feel what the protocol shows.
    """
    stimuli = [stimulus for trial in plan.trials for stimulus in trial.stimuli]
    if protocol.medium == "paper" or any(stimulus.on == "pins" for stimulus in stimuli):
        where = "paper" if protocol.medium == "paper" else "a conventional display"
        raise InputError(
            f"{protocol.name} is read on {where}, which the simulated reader cannot feel; {INSTEAD}"
        )
    kind = SimulatedNaming if stimuli[0].picture else Simulated
    return kind(protocol, plan, habits)


class Simulated(Answers):
    """A simulated reader, which is given the frames that were sent and where the array was.

    Like a person, it was told the task: where a string begins, how many characters it has, and by
    which length two stimuli are compared. It is told nothing of a trial. It is surer of an answer
    that it would give again; after a lapse it is least sure.

    Parameters
    ----------
    protocol, plan
        What the reader was told, and what its noise is drawn by: name, participant and seed.
    habits
        Noise, lapses and false alarms, as `parse_habits` reads them.

    Raises
    ------
    InputError
        If the reader cannot answer the question.
    """

    felt = True

    def __init__(self, protocol: Protocol, plan: Plan, habits: str) -> None:
        self._habits = parse_habits(habits)
        self._noise = self._habits.noise
        self.name = f"simulated:{habits or 0}"
        self._answered = ""
        self._study, self._question = protocol, protocol.asks
        self._drawn = f"{protocol.name} {plan.participant} {plan.seed}"
        self._parameter = protocol.design.parameter
        if self._habits.false_alarms and not self._question.alarm:
            raise InputError(
                f"{protocol.name} asks {self._question.kind}, to which no answer is a false alarm; "
                f"leave false-alarms out"
            )
        if why := self._question.unfelt(self._parameter):
            raise InputError(f"{protocol.name}: {why}; {INSTEAD}")
        self._learn(plan)

    def give(self, asked: Asked) -> Line:
        """Return the answer to what is asked."""
        if asked.item is not None:
            return Line(asked.item.simulate())
        assert asked.trial is not None, "a trial is asked about"
        drawn = f"{self._drawn} {asked.trial.practice} {asked.trial.number} {asked.attempt}"
        habits = random_of(f"{drawn} habits")
        lapsed = habits.random() < self._habits.lapses
        alarmed = habits.random() < self._habits.false_alarms
        scale = self._question.confidence
        if asked.what == "confidence" and scale is not None:
            # After a crash between an answer and its confidence there is nothing left to think of.
            is_sure = asked.felt() and self._answer(asked, asked.trial, habits) == self._answered
            quarters = 0 if lapsed else 3 if is_sure else 1
            return Line(str(scale.least + round(quarters * (scale.most - scale.least) / 4)))
        if lapsed:
            guesses = self._question.guesses(asked.trial)
            return Line(guesses[habits.integers(len(guesses))])
        if alarmed:
            return Line(self._question.alarm)
        self._answered = self._answer(asked, asked.trial, random_of(drawn))
        return Line(self._answered)

    def _learn(self, plan: Plan) -> None:
        """Learn what a reader is told before the session."""
        self._observers: dict[str, Observer] = {}
        self._pairs: dict[str, DotPair | None] = {}
        usual, display = self._study.display_model.style, self._study.display_model.display
        for trial in {trial.condition: trial for trial in plan.trials}.values():
            style = self._study.style(self._study.look(trial.condition))
            told = replace(usual, mapping=style.mapping, geometry=style.geometry)
            self._observers[trial.condition] = Observer(display, told, noise=self._noise)
            self._pairs[trial.condition] = self._pair_of(trial)

    def _pair_of(self, trial: Trial) -> DotPair | None:
        """Return two dot columns by which a distance is told; None if it has none, or needs none.

        The cells are the same in all trials of a comparison, and known to the reader.
        """
        if self._parameter not in LENGTHS:
            return None
        look = self._study.look(trial.condition)
        edges = edges_mm(self._study, structs.replace(trial.stimuli[0], look=look))
        pitch_mm = self._study.style(look).geometry.cell_pitch_mm
        for number, (one, two) in enumerate(pairwise(edges)):
            cells = int(two // pitch_mm) - int(one // pitch_mm)
            if (cells > 0) is (self._parameter == CELL_GAP):
                return DotPair(len(edges), number, two - one, cells)
        return None

    def _answer(self, asked: Asked, trial: Trial, random: np.random.Generator) -> str:
        """Answer by what was felt."""
        first, count = trial.stimuli[0], len(trial.stimuli)
        lead, felt = self._study.display.lead_cells, asked.felt()
        start = lead + len(first.before)
        sensed = FeltTrial(
            self._observers[trial.condition],
            random,
            [*felt[: count - 1], felt[-1]],  # of what was turned only the newest counts
            [len(stimulus.masks(lead)) for stimulus in trial.stimuli],
            slice(start, start + len(first.cells)),
            self._parameter,
            self._pairs[trial.condition],
            len(felt) - count,
        )
        return self._question.simulate(sensed)


class SimulatedNaming(Simulated):
    """A simulated person who has learnt the pictures of each condition, and names the one felt.

    It is told nothing of a trial but its condition; `vbraille.sessions.simulated.matching` says
    what it does with the frames.
    """

    def _learn(self, plan: Plan) -> None:
        if self._question.kind != "name":
            raise InputError(
                f"{self._study.name} asks {self._question.kind} of pictures, which the simulated "
                f"reader cannot answer; {INSTEAD}"
            )
        self._known: dict[str, dict[str, Trial]] = {}
        for trial in plan.trials:
            self._known.setdefault(trial.condition, {}).setdefault(trial.item, trial)
        self._thought: dict[str, list] = {}

    def _answer(self, asked: Asked, trial: Trial, random: np.random.Generator) -> str:
        condition, known = trial.condition, self._known[trial.condition].values()
        if condition not in self._thought:
            shown = [make_shown(self._study, each.stimuli[0]) for each in known]
            self._thought[condition] = [each.program for each in shown]
        apart = differences(asked.felt()[-1], self._thought[condition])
        names = [self._question.right_answer(each) for each in known]
        return most_like(apart, names, self._noise, random)


def random_of(text: str) -> np.random.Generator:
    """Return a generator that is seeded by the SHA-256 of a text."""
    return np.random.default_rng(int.from_bytes(sha256(text.encode()).digest()[:8], "big"))
