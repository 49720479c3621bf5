"""The simulated reader as a source of answers: what it feels of a trial, and what it cannot tell.

Each class of `vbraille.sessions.planning.questions` says how it is answered by what is felt.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from hashlib import sha256
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from vbraille.errors import InputError
from vbraille.sessions.planning.design import Choice
from vbraille.sessions.planning.questions import NameQuestion, OneOfTwo
from vbraille.sessions.planning.style import CONVENTIONAL, Condition
from vbraille.sessions.record.trajectory import columns_of, edges_mm
from vbraille.sessions.running.responses import TrialResponses
from vbraille.sessions.simulated.feeling import CELL_GAP, LENGTHS, DotPair, FeltTrial
from vbraille.sessions.simulated.matching import differences, name_one
from vbraille.sessions.simulated.observer import Observer

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from collections.abc import Mapping as Named

    from vbraille.braille.geometry import Geometry
    from vbraille.render import Mapping
    from vbraille.render.braille.models import Model
    from vbraille.sessions.planning.plan import Plan
    from vbraille.sessions.planning.protocol import Protocol
    from vbraille.sessions.planning.questionnaire import AnyItem
    from vbraille.sessions.planning.stimuli import Stimulus, Trial
    from vbraille.sessions.simulated.matching import PictureFrames
    from vbraille.sessions.simulated.skin import FeltFrames


def pair_of(
    parameter: str, masks: Sequence[int], mapping: Mapping, geometry: Geometry
) -> DotPair | None:
    """Find two dot columns by which a distance can be told; None if the line has none.

    Parameters
    ----------
    parameter
        "dot_spacing_mm" or "cell_gap_mm".
    masks
        Dot masks of the line's cells, which are the same in all trials and known to the reader.
    mapping, geometry
        Which dots are shown, and the nominal distances.
    """
    columns = columns_of(masks, mapping)
    edges = edges_mm(masks, mapping, geometry)
    for number, (one, two) in enumerate(pairwise(columns)):
        cells = two[0] - one[0]
        if (cells > 0) is (parameter == CELL_GAP):
            return DotPair(len(columns), number, edges[number + 1] - edges[number], cells)
    return None


MOST_NOISE = 100.0
INSTEAD = "type the answers, or give a file of them"


class ReaderHabits(NamedTuple):
    """ReaderHabits of a simulated person.

    Parameters
    ----------
    noise
        Standard deviation of the noise, in a unit of the person's own.
    lapses
        Share of the trials that are not attended to, and answered by chance alone.
    false_alarms
        Share of the other trials with "yes" or "different" whatever was felt, where that is asked.
    """

    noise: float = 0.0
    lapses: float = 0.0
    false_alarms: float = 0.0

    @property
    def spec(self) -> str:
        """Source of answers that names them: "simulated:0.4,lapses=0.05"."""
        shares = {"lapses": self.lapses, "false-alarms": self.false_alarms}
        told = [f"{name}={share:g}" for name, share in shares.items() if share]
        return ",".join([f"simulated:{self.noise:g}", *told])

    @classmethod
    def parse(cls, text: str) -> ReaderHabits:
        """Read what follows "simulated:", such as "0.4,lapses=0.05,false-alarms=0.1".

        Raises
        ------
        InputError
            If it cannot be read, or is out of range.
        """
        found = {}
        for part in filter(None, text.split(",")):
            name, _, value = part.rpartition("=")
            field = (name or "noise").replace("-", "_")
            try:
                found[field] = float(value)
            except ValueError:
                field = ""
            if field not in cls._fields:
                raise InputError(
                    f"{part!r} is no habit of a simulated reader; give its noise, lapses or false "
                    f"alarms, such as simulated:0.2,lapses=0.05,false-alarms=0.1"
                )
        return cls(**found).checked()

    def checked(self) -> ReaderHabits:
        """These habits, if all are in range.

        Raises
        ------
        InputError
            If one is not.
        """
        for name, value, most in zip(self._fields, self, (MOST_NOISE, 1.0, 1.0), strict=True):
            if not 0 <= value <= most:
                words = name.replace("_", " ")
                verb = "is" if name == "noise" else "are"
                raise InputError(f"{words} {verb} {value:g}; it must be 0 to {most:g}")
        return self


USUAL = ReaderHabits()


class SimulatedPerson(TrialResponses):
    """A simulated person, whose noise and replies are drawn by protocol, participant and seed.

    Of how sure an answer is, the person tells whether it would be given again: after a lapse, the
    least of the scale; else a quarter or three quarters of it, as the same frames, thought of once
    more with noise of their own, give another answer or the same.

    Parameters
    ----------
    protocol, plan
        Protocol and plan of the session.
    habits
        Noise, lapses and false alarms.

    Raises
    ------
    InputError
        If a habit is out of range, or false alarms are given where no answer can be one.
    """

    felt = True

    def __init__(self, protocol: Protocol, plan: Plan, habits: ReaderHabits) -> None:
        self._habits = habits.checked()
        self._question = protocol.asks
        if habits.false_alarms and not isinstance(self._question, OneOfTwo):
            raise InputError(
                f"false alarms are of the questions detect and same-different, and "
                f"{protocol.name} asks {self._question.name}; leave them out"
            )
        self.name = habits.spec
        self._noise = habits.noise
        self._drawn = f"{plan.protocol} {plan.participant} {plan.seed}"
        self._replied = 0

    def reply(self, item: AnyItem, columns: Named[str, str], /) -> tuple[str, int]:
        """Answer to a question of the questionnaire: the right one, or any."""
        self._replied += 1
        random = np.random.default_rng(seed_of(f"{self._drawn} {item.name} {self._replied}"))
        return item.simulate(columns, self._noise, random), 0

    def _answered(
        self, trial: Trial, attempt: int, by_feeling: Callable[[np.random.Generator], str]
    ) -> str:
        """Answer to an attempt at a trial, and how sure it is if that is asked.

        Parameters
        ----------
        by_feeling
            Function that answers by what was felt, with noise of a generator.
        """
        of = f"{self._drawn} {trial.practice} {trial.number} {attempt}"
        noise, habits = (np.random.default_rng(seed_of(f"{of}{part}")) for part in ("", " habits"))
        question, scale = self._question, self._question.confidence
        lapsed = habits.random() < self._habits.lapses
        alarmed = habits.random() < self._habits.false_alarms
        if lapsed:
            line = self._guess(trial, habits)
        elif alarmed and isinstance(question, OneOfTwo):
            line = question.words[0]
        else:
            line = by_feeling(noise)
        if scale is None or question.steps(line) is not None:
            return line
        quarters = 0 if lapsed else 3 if by_feeling(habits) == line else 1
        return f"{line}; {scale.least + round(quarters * (scale.most - scale.least) / 4)}"

    def _guess(self, trial: Trial, random: np.random.Generator) -> str:
        """Answer by chance alone."""
        return self._question.guess(trial, random)


class Simulated(SimulatedPerson):
    """A simulated reader, which is given the frames sent to the device, and nothing of the plan.

    Like a person, it has been told the task: where a string begins, how many characters it has,
    which of them are asked for, and by which length two stimuli are compared.

    Parameters
    ----------
    protocol
        Protocol of the session, which has the task and the display's nominal distances.
    plan
        Plan of the session. The noise is drawn by its protocol, participant and seed, and by the
        number and the attempt of the trial.
    habits
        Habits of the reader; its noise is described at `vbraille.sessions.simulated.observer`.

    Raises
    ------
    InputError
        If the protocol is for paper, or a habit cannot be used.
    """

    def __init__(self, protocol: Protocol, plan: Plan, habits: ReaderHabits = USUAL) -> None:
        if protocol.medium == "paper":
            raise InputError(
                f"{protocol.name} is read on paper, which the simulated reader cannot feel; "
                f"{INSTEAD}"
            )
        if any(protocol.place_of(c) == CONVENTIONAL for c in protocol.conditions):
            raise InputError(
                f"{protocol.name} is read on a conventional display too, which the simulated "
                f"reader cannot feel; {INSTEAD}"
            )
        super().__init__(protocol, plan, habits)
        model: Model = protocol.model

        def told(condition: Condition) -> Observer:
            style = protocol.style_of(condition)
            style = replace(model.style, mapping=style.mapping, geometry=style.geometry)
            return Observer(model.display, style, noise=habits.noise)

        self._observers = {c.name: told(c) for c in protocol.conditions}
        self._lead_cells = protocol.lead_cells
        self._parameter = protocol.parameter or ""
        self._pairs = {c.name: _dot_pair(protocol, c) for c in protocol.conditions}
        self._turned: tuple[int, int, int] | None = None  # trial and showings, if it turned
        pairs = isinstance(protocol.design, Choice) and protocol.design.form == "pairs"
        if why := self._question.unfelt(self._parameter, pairs=pairs):
            raise InputError(f"{protocol.name} {why}; {INSTEAD}")

    def next(self, trial: Trial, attempt: int, felt: list[FeltFrames], /) -> tuple[str, int]:
        """Answer to a trial, by what was felt of it."""
        number = len(trial.stimuli)  # of what was turned only the newest counts
        told = FeltTrial(
            self._observers[trial.condition],
            [*felt[: number - 1], felt[-1]],
            [self._lead_cells + len(stimulus.masks) for stimulus in trial.stimuli],
            slice(*(self._lead_cells + place for place in trial.asked)),
            self._parameter,
            self._pairs[trial.condition],
            len(felt) - number,
        )
        shown = (trial.number, attempt, len(felt))
        at_end = shown == self._turned  # nothing more was felt since the value was turned

        def answer(random: np.random.Generator) -> str:
            return "equal" if at_end else self._question.simulate(told, self._noise, random)

        line = self._answered(trial, attempt, answer)
        self._turned = None if self._question.steps(line) is None else shown
        return line, 0


def _dot_pair(protocol: Protocol, condition: Condition) -> DotPair | None:
    """Dots by which a distance is told in a condition; None if none is compared or can be told."""
    design = protocol.design
    if not isinstance(design, Choice) or protocol.parameter not in LENGTHS:
        return None
    style = protocol.style_of(condition)
    line = protocol.line(design.string)
    return pair_of(protocol.parameter, line, style.mapping, style.geometry)


def seed_of(text: str) -> int:
    """Seed, 0 … 2⁶⁴ - 1, made from a text by its SHA-256."""
    return int.from_bytes(sha256(text.encode()).digest()[:8], "big")


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
