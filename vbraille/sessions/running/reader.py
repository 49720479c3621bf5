"""The simulated reader as a source of answers."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from hashlib import sha256
from typing import Annotated

import numpy as np
from msgspec import Meta, Struct, ValidationError, convert

from vbraille.errors import InputError
from vbraille.sessions.planning.plan import Plan
from vbraille.sessions.planning.protocol import Protocol
from vbraille.sessions.planning.shown import make_shown
from vbraille.sessions.planning.trial import Trial
from vbraille.sessions.planning.values import Share
from vbraille.sessions.running.answers import Answers, Asked, Line
from vbraille.sessions.simulated.feeling import FeltTrial, differences, most_like
from vbraille.sessions.simulated.observer import Observer


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


class Simulated(Answers):
    """A simulated reader, which is given the frames that were sent and where the array was.

    Like a person, it was told the task: where a string begins, how many characters it has, by which
    length two stimuli are compared, and which pictures a condition has. It is told nothing of a
    trial but its condition. It is surer of an answer that it would give again; after a lapse it is
    least sure.

    Parameters
    ----------
    protocol, plan
        What the reader was told, and what its noise is drawn by: name, participant and seed.
    habits
        Noise, lapses and false alarms, as `parse_habits` reads them.

    Raises
    ------
    InputError
        If the habits cannot be read, or the reader cannot feel what the protocol shows, or answer
        the question.
    """

    felt = True

    def __init__(self, protocol: Protocol, plan: Plan, habits: str) -> None:
        self._habits = parse_habits(habits)
        self._noise = self._habits.noise
        self.name = f"simulated:{habits or 0}"
        self._study, self._plan, self._question = protocol, plan, protocol.asks
        self._drawn = f"{protocol.name} {plan.participant} {plan.seed}"
        self._parameter = protocol.design.parameter
        self._answered = ""
        self._program = lru_cache(maxsize=None)(lambda shown: make_shown(protocol, shown).program)
        kind, why = self._question.kind, ""
        if protocol.medium == "paper":
            why = "the simulated reader cannot feel paper"
        elif any(stimulus.on == "pins" for trial in plan.trials for stimulus in trial.stimuli):
            why = "the simulated reader cannot feel a conventional display"
        elif protocol.shows_pictures and kind != "name":
            why = f"the simulated reader cannot answer {kind} of pictures"
        elif not self._question.is_felt(self._parameter):
            why = f"the simulated reader cannot answer {kind} {self._parameter}".rstrip()
        if why:
            raise InputError(f"{protocol.name}: {why}; type the answers, or give a file of them")
        if self._habits.false_alarms and not self._question.alarm:
            raise InputError(
                f"{protocol.name} asks {kind}, to which no answer is a false alarm; leave "
                f"false-alarms out"
            )

    def give(self, asked: Asked) -> Line:
        """Return the answer to what is asked."""
        if asked.item is not None:
            return Line(asked.item.simulate())
        trial = asked.trial
        assert trial is not None, "a trial is asked about"
        drawn = f"{self._drawn} {trial.practice} {trial.number} {asked.attempt}"
        habits = random_of(f"{drawn} habits")
        lapsed = habits.random() < self._habits.lapses
        alarmed = habits.random() < self._habits.false_alarms
        if asked.what == "rating":
            scale = self._question.confidence
            # After a crash between an answer and its confidence there is nothing left to think of.
            is_sure = asked.felt() and self._answer(asked, trial, habits) == self._answered
            quarters = 0 if lapsed else 3 if is_sure else 1
            return Line(str(scale.least + round(quarters * (scale.most - scale.least) / 4)))
        if lapsed:
            guesses = self._question.guesses(trial)
            self._answered = guesses[habits.integers(len(guesses))]
        elif alarmed:
            self._answered = self._question.alarm
        else:
            self._answered = self._answer(asked, trial, random_of(drawn))
        return Line(self._answered)

    def _answer(self, asked: Asked, trial: Trial, random: np.random.Generator) -> str:
        """Answer by what was felt."""
        first, count, felt = trial.stimuli[0], len(trial.stimuli), asked.felt()
        if first.picture:
            alike = [each for each in self._plan.trials if each.condition == trial.condition]
            known = {each.item: each for each in alike}.values()
            apart = differences(felt[-1], [self._program(each.stimuli[0]) for each in known])
            names = [self._question.right_answer(each) for each in known]
            return most_like(apart, names, self._noise, random)
        model, style = (
            self._study.display_model,
            self._study.style(self._study.look(trial.condition)),
        )
        told = replace(model.style, mapping=style.mapping, geometry=style.geometry)
        lead = self._study.display.lead_cells
        start = lead + len(first.before)
        sensed = FeltTrial(
            Observer(model.display, told, noise=self._noise),
            random,
            [*felt[: count - 1], felt[-1]],  # of what was turned only the newest counts
            [len(stimulus.masks(lead)) for stimulus in trial.stimuli],
            slice(start, start + len(first.cells)),
            self._parameter,
            len(felt) - count,
        )
        return self._question.simulate(sensed)


def random_of(text: str) -> np.random.Generator:
    """Return a generator that is seeded by the SHA-256 of a text."""
    return np.random.default_rng(int.from_bytes(sha256(text.encode()).digest()[:8], "big"))
