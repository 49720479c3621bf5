"""Sources of answers: lines typed by an experimenter, a file, or a simulated reader."""

from __future__ import annotations

import os
import select
import sys
import time
from dataclasses import replace
from hashlib import sha256
from pathlib import Path
from typing import TYPE_CHECKING, Protocol, runtime_checkable

import numpy as np

from vbraille.braille.spelling import to_answer
from vbraille.errors import InputError
from vbraille.sessions.planning.conventionaltable import CONVENTIONAL
from vbraille.sessions.planning.questions import (
    DIFFERENT,
    NO,
    SAME,
    YES,
    FreeQuestion,
    IdentifyQuestion,
    MagnitudeQuestion,
    RatingQuestion,
    SameQuestion,
    WhichQuestion,
)
from vbraille.sessions.simulated import judging
from vbraille.sessions.simulated.observer import SKINS, Observer
from vbraille.wording import setting

if TYPE_CHECKING:
    from vbraille.render.braille.models import Model
    from vbraille.sessions.planning.appearance import Condition
    from vbraille.sessions.planning.plan import Plan
    from vbraille.sessions.planning.protocol import Protocol as Design
    from vbraille.sessions.planning.stimuli import Trial
    from vbraille.sessions.simulated.observer import Parameter, Skin
    from vbraille.sessions.simulated.skin import Exploration

PROGRAM = "program"  # name that the record has for answers given by a program
MOST_NOISE = 100.0
_WAIT_S = 1.0
# Names of the parameters compared: the protocol's name, and the observer's.
_COMPARED: dict[str, Parameter] = {"dot_width_mm": "dot width", "dot_gap_mm": "gap"}


@runtime_checkable
class Answers(Protocol):
    """A source of lines for the console.

    Attributes
    ----------
    name : str
        Name of the source in the record.
    typed : bool
        Whether a person types the answers. The session waits for a person at breaks, and gives
        practice.
    felt : bool
        Whether the answers come from what is felt of a device.
    """

    name: str
    typed: bool
    felt: bool

    def lines(self, wait_s: float) -> list[str] | None:
        """Lines given since the last call, waiting a while for one; None if no more will come."""
        ...

    def next(
        self, trial: Trial, attempt: int, felt: list[Exploration], /
    ) -> tuple[str, int] | None:
        """Answer to a trial that has been read: a line, and its number in a file, or 0.

        None if there are no more lines.
        """
        ...


class Typed:
    """Source of answers that reads lines from standard input, which may be a terminal."""

    name = "typed"
    typed = True
    felt = False

    def __init__(self) -> None:
        self._descriptor = sys.stdin.fileno() if sys.stdin else None
        self._partial = b""
        self._waiting: list[str] = []

    def lines(self, wait_s: float) -> list[str] | None:
        """Lines typed since the last call; see `Answers`."""
        if self._waiting:
            lines, self._waiting = self._waiting, []
            return lines
        if self._descriptor is None:
            return None
        if not select.select([self._descriptor], [], [], wait_s)[0]:
            return []
        try:
            said = os.read(self._descriptor, 1 << 16)
        except OSError:  # the terminal was closed
            said = b""
        if not said:
            self._descriptor = None
            last, self._partial = self._partial, b""
            return [last.decode("utf-8", "replace")] if last else None
        *lines, self._partial = (self._partial + said).split(b"\n")
        return [line.decode("utf-8", "replace") for line in lines]

    def line(self) -> str | None:
        """Wait for the next line; None if no more will come."""
        lines = self.lines(_WAIT_S)
        while lines == []:
            lines = self.lines(_WAIT_S)
        if lines is None:
            return None
        line, *self._waiting = lines
        return line

    def next(
        self, _trial: Trial, _attempt: int, _felt: list[Exploration], /
    ) -> tuple[str, int] | None:
        """Return None: a person answers at any time, and is not asked."""
        return None


class ScriptedAnswers:
    """Source of answers that takes the next line of a file whenever a trial has been read.

    Empty lines, and lines that begin with #, are left out.

    Parameters
    ----------
    path
        Path of the file, which is UTF-8.
    after
        Number of the last line that was used in earlier runs.

    Raises
    ------
    InputError
        If the file cannot be read.
    """

    typed = False
    felt = False

    def __init__(self, path: Path, after: int = 0) -> None:
        try:
            text = path.read_text("utf-8-sig")
        except OSError as error:
            raise InputError(f"{path} cannot be read: {error.strerror}") from None
        except UnicodeDecodeError:
            raise InputError(f"{path} is not UTF-8; save it as that") from None
        numbered = enumerate(text.splitlines(), 1)
        self.left = [
            (line.strip(), n)
            for n, line in numbered
            if n > after and line.strip() and not line.lstrip().startswith("#")
        ]
        self.path = path
        self.name = str(path)
        self._given = 0

    def lines(self, wait_s: float) -> list[str]:
        """Wait, and return no lines: the lines of the file are given to trials."""
        time.sleep(wait_s)
        return []

    def next(
        self, _trial: Trial, _attempt: int, _felt: list[Exploration], /
    ) -> tuple[str, int] | None:
        """Give the next line of the file."""
        if self._given == len(self.left):
            return None
        self._given += 1
        return self.left[self._given - 1]


class Simulated:
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
    noise
        Noise of the reader, described at `vbraille.sessions.simulated.observer`.
    skin
        Model of the skin, one of `vbraille.sessions.simulated.observer.SKINS`.

    Raises
    ------
    InputError
        If the protocol is for paper, the noise is out of range, or there is no such skin.
    """

    typed = False
    felt = True

    def __init__(
        self, protocol: Design, plan: Plan, noise: float = 0.0, skin: str = SKINS[0]
    ) -> None:
        chosen: Skin | None = next((one for one in SKINS if one == skin), None)
        if chosen is None:
            raise InputError(
                f"there is no skin {skin!r}; give {' or '.join(SKINS)}, as in "
                f"simulated:0.2:{SKINS[-1]}"
            )
        if protocol.medium == "paper":
            raise InputError(
                f"{protocol.name} is read on paper, which the simulated reader cannot feel; "
                f"type the answers, or give a file of them"
            )
        if any(protocol.place_of(c) == CONVENTIONAL for c in protocol.conditions):
            raise InputError(
                f"{protocol.name} is read on a conventional display too, which the simulated "
                f"reader cannot feel; type the answers, or give a file of them"
            )
        if not 0 <= noise <= MOST_NOISE:
            raise InputError(f"noise is {noise:g}; it must be 0 to {MOST_NOISE:g}")
        self.name = f"simulated:{noise:g}" + (f":{skin}" if skin != SKINS[0] else "")
        model: Model = protocol.model
        likes = isinstance(protocol.asks, WhichQuestion) and protocol.asks.right is None
        if likes and protocol.parameter not in _COMPARED:
            raise InputError(
                f"{protocol.name} compares {protocol.parameter}, which the simulated reader "
                f"cannot; type the answers, or give a file of them"
            )

        def told(condition: Condition, skin: Skin) -> Observer:
            style = protocol.style_of(condition)
            style = replace(model.style, mapping=style.mapping, geometry=style.geometry)
            return Observer(model.display, style, noise=noise, skin=skin)

        self._noise = noise
        self._observers = {c.name: told(c, chosen) for c in protocol.conditions}
        self._lead_cells = protocol.lead_cells
        self._compared: Parameter | None = _COMPARED.get(protocol.parameter or "")
        self._question = protocol.asks
        pairs = protocol.task == "choice"
        if isinstance(self._question, FreeQuestion) or (pairs and not self._compares):
            raise InputError(
                f"{protocol.name} asks a question of the kind {self._question.name!r}, which the "
                f"simulated reader cannot answer; type the answers, or give a file of them"
            )
        self._drawn = f"{plan.protocol} {plan.participant} {plan.seed}"

    def lines(self, wait_s: float) -> list[str]:
        """Wait, and return no lines: the reader answers when it has read a trial."""
        time.sleep(wait_s)
        return []

    def next(self, trial: Trial, attempt: int, felt: list[Exploration], /) -> tuple[str, int]:
        """Answer to a trial, by what was felt of it."""
        drawn = f"{self._drawn} {trial.practice} {trial.number} {attempt}"
        random = np.random.default_rng(seed_of(drawn))
        scale = self._question.confidence
        sure = "" if scale is None else f"; {(scale.least + scale.most) // 2}"
        return self._answer(trial, felt, random) + sure, 0

    @property
    def _compares(self) -> bool:
        return isinstance(self._question, WhichQuestion | SameQuestion)

    def _answer(self, trial: Trial, felt: list[Exploration], random: np.random.Generator) -> str:
        question, noise = self._question, self._noise
        observer = self._observers[trial.condition]
        if isinstance(question, WhichQuestion) and question.right is None and self._compared:
            first, second = felt
            return str(observer.compare(first, second, self._compared, random))
        if self._compares:
            one, two, unit = self._felt_of_two(trial, felt)
            if isinstance(question, SameQuestion):
                return DIFFERENT if judging.differ(one, two, unit, noise, random) else SAME
            assert isinstance(question, WhichQuestion), "these are the two that compare"
            one, two = question.worth(one), question.worth(two)
            return str(judging.larger(one, two, unit, noise, random))
        if not isinstance(question, IdentifyQuestion):
            strength = self._strength(trial, 0, felt[0])
            match question:
                case RatingQuestion():
                    return str(judging.rate(strength, question.least, question.most, noise, random))
                case MagnitudeQuestion():
                    given = judging.magnitude(strength, question.modulus or 1.0, noise, random)
                    return f"{given:.3g}"
            return YES if judging.detects(strength, noise, random) else NO
        places = self._lead_cells + len(trial.stimuli[0].masks)
        masks = observer.read(felt[0], places, random)
        asked = slice(*(self._lead_cells + place for place in trial.asked))
        return to_answer(masks[asked])

    def _felt_of_two(self, trial: Trial, felt: list[Exploration]) -> tuple[float, float, float]:
        """What is felt of two stimuli, and its unit: lengths in mm, or how strong they are."""
        if self._compared is None:
            one, two = (self._strength(trial, place, felt[place]) for place in (0, 1))
            return one, two, 1.0
        which = [*_COMPARED.values()].index(self._compared)
        one, two = (self._observers[trial.condition].lengths_mm(each)[which] for each in felt[:2])
        geometry = self._observers[trial.condition].geometry
        gap_mm = geometry.dot_spacing_mm - geometry.dot_width_mm
        return one, two, (geometry.dot_width_mm, gap_mm)[which]

    def _strength(self, trial: Trial, place: int, felt: Exploration) -> float:
        places = self._lead_cells + len(trial.stimuli[place].masks)
        first, stop = (self._lead_cells + cell for cell in trial.asked)
        return judging.strength(self._observers[trial.condition].felt(felt, places), first, stop)


def seed_of(text: str) -> int:
    """Seed, 0 … 2⁶⁴ - 1, made from a text by its SHA-256."""
    return int.from_bytes(sha256(text.encode()).digest()[:8], "big")


def parse_answers(spec: str, protocol: Design, plan: Plan, after: int = 0) -> Answers:
    """Make the source of answers for a spec.

    That is ``typed``, ``simulated[:NOISE[:SKIN]]``, or a file's name.

    Raises
    ------
    InputError
        If the spec, or the file that it names, cannot be used.
    """
    kind, _, noise = spec.partition(":")
    if kind == "typed" and not noise:
        return Typed()
    if spec == PROGRAM:
        raise InputError(f"the answers came from a program; give {setting('answers')} typed")
    if kind == "simulated":
        number, _, skin = noise.partition(":")
        try:
            loud = float(number or 0.0)
        except ValueError:
            raise InputError(f"noise is {number!r}; give a number, such as simulated:0.2") from None
        answers = Simulated(protocol, plan, loud, skin or SKINS[0])
    else:
        from difflib import get_close_matches  # takes long to load

        if not Path(spec).exists() and get_close_matches(kind, ("typed", "simulated")):
            raise InputError(
                f"{spec} is no file; give typed, simulated:NOISE such as simulated:0.2, or the "
                f"name of a file"
            )
        answers = ScriptedAnswers(Path(spec), after)
    answers.name = spec
    return answers
