"""The simulated person as a source of answers about pictures."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

from vbraille.errors import InputError
from vbraille.sessions.planning.questions import NameQuestion
from vbraille.sessions.running.reader import INSTEAD, ReaderHabits, SimulatedPerson
from vbraille.sessions.simulated.matching import differences, name_one

if TYPE_CHECKING:
    import numpy as np

    from vbraille.sessions.planning.plan import Plan
    from vbraille.sessions.planning.protocol import Protocol
    from vbraille.sessions.planning.stimuli import Stimulus, Trial
    from vbraille.sessions.simulated.matching import PictureFrames
    from vbraille.sessions.simulated.skin import FeltFrames


class SimulatedNaming(SimulatedPerson):
    """A simulated person who has learnt the pictures of each condition, and names the one felt.

    It is given the frames sent to the device and where the array was, and nothing of the trial but
    its condition; `vbraille.sessions.simulated.matching` has what it does with them.

    Parameters
    ----------
    protocol, plan
        Protocol and plan of the session: they have the pictures that are learnt, and what the
        noise is drawn by.
    habits
        Habits of the person; noise is in units of the mean difference of the pictures.

    Raises
    ------
    InputError
        If the protocol asks for something else than names, or a habit cannot be used.
    """

    def __init__(self, protocol: Protocol, plan: Plan, habits: ReaderHabits) -> None:
        if not isinstance(protocol.asks, NameQuestion):
            raise InputError(
                f"{protocol.name} asks a question of the kind {protocol.asks.name!r} about "
                f"pictures, which the simulated reader cannot answer; {INSTEAD}"
            )
        super().__init__(protocol, plan, habits)
        self._protocol, self._plan = protocol, plan

    @cached_property
    def _learnt(self) -> dict[str, dict[str, tuple[str, PictureFrames]]]:
        """Answer and frames of each picture, by its name and its condition."""
        found: dict[str, dict[str, tuple[str, PictureFrames]]] = {}
        for trial in (*self._plan.practice, *self._plan.trials):
            (stimulus,) = trial.stimuli
            of = found.setdefault(trial.condition, {})
            if stimulus.picture not in of:
                of[str(stimulus.picture)] = stimulus.answer or "", self._frames(stimulus)
        return found

    def _frames(self, stimulus: Stimulus) -> PictureFrames:
        program = self._protocol.program(stimulus, stimulus.tuning)
        return lambda *poses: program.poses(*poses)[1]

    def next(self, trial: Trial, attempt: int, felt: list[FeltFrames], /) -> tuple[str, int]:
        """Answer to a trial, by what was felt of it."""
        answers, frames = zip(*self._learnt[trial.condition].values(), strict=True)
        apart = differences(felt[-1], frames)
        line = self._answered(
            trial, attempt, lambda random: answers[name_one(apart, self._noise, random)]
        )
        return line, 0

    def _guess(self, trial: Trial, random: np.random.Generator) -> str:
        """Give the name of any picture."""
        answers = [answer for answer, _ in self._learnt[trial.condition].values()]
        return answers[random.integers(len(answers))]
