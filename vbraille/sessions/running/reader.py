"""The simulated reader as a source of answers: to each kind of question but words.

Questions other than which cells these are it answers by one number of a stimulus: a length in mm,
or how strong its strongest dot is felt, in units of E₀ (`vbraille.sessions.simulated.observer`).
Where it is asked which of two it likes, it takes the one nearer to the length that it was told, or
the stronger one. Noise is normal. It says yes, or different, beyond one standard deviation of its
noise, so that it gives a false alarm in 16 % of trials with nothing. On a scale it puts strengths
of 0 to 1 evenly from end to end, and as a magnitude it gives the strength times the modulus. How
sure it is it cannot tell: its confidence is the middle of the scale. All this is for trying out
protocols, and claims nothing about people.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from hashlib import sha256
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from vbraille.braille.spelling import to_answer
from vbraille.errors import InputError
from vbraille.sessions.planning.appearance import CONVENTIONAL, Condition
from vbraille.sessions.planning.design import Choice
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
from vbraille.sessions.record.trajectory import columns_of, edges_mm
from vbraille.sessions.running.answers import AnswersAtTrials
from vbraille.sessions.simulated.observer import LEAST_FELT, TIE, Observer

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vbraille.braille.geometry import Geometry
    from vbraille.render import Mapping
    from vbraille.render.braille.models import Model
    from vbraille.sessions.planning.plan import Plan
    from vbraille.sessions.planning.protocol import Protocol
    from vbraille.sessions.planning.stimuli import Trial
    from vbraille.sessions.simulated.skin import Exploration

LEAST_MAGNITUDE = 1e-3  # smallest magnitude given, as a share of the modulus: none may be 0


def detects(felt: float, noise: float, random: np.random.Generator) -> bool:
    """Whether the reader says that there was something, of this strength."""
    return felt + noise * float(random.standard_normal()) > max(noise, LEAST_FELT)


def differ(
    first: float, second: float, unit: float, noise: float, random: np.random.Generator
) -> bool:
    """Whether the reader takes two values for different.

    Parameters
    ----------
    first, second
        What was felt; NaN for what was not.
    unit
        Unit that noise is given in: the nominal length in mm, or 1 for strengths.
    noise
        Standard deviation of the noise of each.
    random
        Generator that draws the noise.
    """
    if math.isnan(first) or math.isnan(second):
        return math.isnan(first) != math.isnan(second)
    off = (first - second) / unit + noise * math.sqrt(2) * float(random.standard_normal())
    return abs(off) > max(noise * math.sqrt(2), TIE)


def larger(
    first: float, second: float, unit: float, noise: float, random: np.random.Generator
) -> int:
    """Which of two values the reader takes for the larger: 1 or 2; see `differ`."""
    drawn = noise * unit * random.standard_normal(2)
    one, two = (-math.inf if math.isnan(felt) else felt for felt in (first, second))
    return 2 if two + drawn[1] > one + drawn[0] else 1


def nearer(
    first: float, second: float, nominal: float, noise: float, random: np.random.Generator
) -> int:
    """Which of two lengths the reader takes for the one nearer to a length: 1 or 2; 1 if equal.

    Noise is in units of that length, and so is what counts as equal without noise.
    """
    drawn = noise * nominal * random.standard_normal(2)
    off = [
        math.inf if math.isnan(felt) else abs(felt + more - nominal)
        for felt, more in zip((first, second), drawn, strict=True)
    ]
    return 2 if off[1] < off[0] - (0.0 if noise else TIE * nominal) else 1


def rate(felt: float, least: int, most: int, noise: float, random: np.random.Generator) -> int:
    """Step of a scale that the reader gives a strength."""
    share = min(max(felt + noise * float(random.standard_normal()), 0.0), 1.0)
    return least + round(share * (most - least))


def magnitude(felt: float, modulus: float, noise: float, random: np.random.Generator) -> float:
    """Magnitude that the reader gives a strength, with noise on its logarithm; above 0."""
    share = max(felt, LEAST_MAGNITUDE) * math.exp(noise * float(random.standard_normal()))
    return modulus * max(share, LEAST_MAGNITUDE)


WIDTH, GAP, SPACING, CELL_GAP = "dot_width_mm", "dot_gap_mm", "dot_spacing_mm", "cell_gap_mm"
LENGTHS = (WIDTH, GAP, SPACING, CELL_GAP)


def nominal_mm(parameter: str, geometry: Geometry) -> float:
    """Value of a length that the reader was told, by the nominal distances."""
    if parameter == GAP:
        return geometry.dot_spacing_mm - geometry.dot_width_mm
    return getattr(geometry, parameter)


@dataclass(frozen=True, slots=True)
class DotPair:
    """Two neighbouring dot columns of a line, whose distance tells a length.

    Parameters
    ----------
    columns
        Number of dot columns that are shown of the line.
    first
        Number of the first of the two, from 0.
    distance_mm
        Distance between the two by the nominal distances.
    cells
        How many cells further the second one is: 0 in the same cell.
    """

    columns: int
    first: int
    distance_mm: float
    cells: int


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


def felt_mm(
    observer: Observer, parameter: str, exploration: Exploration, pair: DotPair | None
) -> float:
    """Length that is felt of a stimulus; NaN if it is not felt."""
    if parameter in (WIDTH, GAP):
        return observer.lengths_mm(exploration)[(WIDTH, GAP).index(parameter)]
    dots_mm = observer.dots_mm(exploration)
    if pair is None or len(dots_mm) != pair.columns:
        return math.nan
    distance_mm = dots_mm[pair.first + 1, 0] - dots_mm[pair.first, 0]
    more_mm = (distance_mm - pair.distance_mm) / max(pair.cells, 1)
    return float(nominal_mm(parameter, observer.geometry) + more_mm)


MOST_NOISE = 100.0
_INSTEAD = "type the answers, or give a file of them"


class Simulated(AnswersAtTrials):
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

    Raises
    ------
    InputError
        If the protocol is for paper, or the noise is out of range.
    """

    felt = True

    def __init__(self, protocol: Protocol, plan: Plan, noise: float = 0.0) -> None:
        if protocol.medium == "paper":
            raise InputError(
                f"{protocol.name} is read on paper, which the simulated reader cannot feel; "
                f"{_INSTEAD}"
            )
        if any(protocol.place_of(c) == CONVENTIONAL for c in protocol.conditions):
            raise InputError(
                f"{protocol.name} is read on a conventional display too, which the simulated "
                f"reader cannot feel; {_INSTEAD}"
            )
        if not 0 <= noise <= MOST_NOISE:
            raise InputError(f"noise is {noise:g}; it must be 0 to {MOST_NOISE:g}")
        self.name = f"simulated:{noise:g}"
        model: Model = protocol.model

        def told(condition: Condition) -> Observer:
            style = protocol.style_of(condition)
            style = replace(model.style, mapping=style.mapping, geometry=style.geometry)
            return Observer(model.display, style, noise=noise)

        self._noise = noise
        self._observers = {c.name: told(c) for c in protocol.conditions}
        self._lead_cells = protocol.lead_cells
        self._parameter = protocol.parameter or ""
        self._question = protocol.asks
        self._pairs = {c.name: _dot_pair(protocol, c) for c in protocol.conditions}
        pairs = protocol.task == "choice"
        if isinstance(self._question, FreeQuestion) or (pairs and not self._compares):
            raise InputError(
                f"{protocol.name} asks a question of the kind {self._question.name!r}, which the "
                f"simulated reader cannot answer; {_INSTEAD}"
            )
        self._check_feels(protocol)
        self._drawn = f"{plan.protocol} {plan.participant} {plan.seed}"

    def next(self, trial: Trial, attempt: int, felt: list[Exploration], /) -> tuple[str, int]:
        """Answer to a trial, by what was felt of it."""
        drawn = f"{self._drawn} {trial.practice} {trial.number} {attempt}"
        random = np.random.default_rng(seed_of(drawn))
        scale = self._question.confidence
        sure = "" if scale is None else f"; {(scale.least + scale.most) // 2}"
        return self._answer(trial, felt, random) + sure, 0

    def _check_feels(self, protocol: Protocol) -> None:
        """Raise InputError if the model cannot tell what the question is about."""
        question, parameter = self._question, self._parameter
        if not isinstance(question, WhichQuestion):
            return
        if parameter == "texture_cycles":
            raise InputError(
                f"{protocol.name} compares {parameter}, and the simulated reader does not feel "
                f"which texture is finer; {_INSTEAD}"
            )
        if question.right == "nearest" and parameter not in LENGTHS:
            raise InputError(
                f"{protocol.name} asks which of two is nearest to a {parameter} of "
                f"{question.reference:g}, and the simulated reader feels how strong a dot is, not "
                f"its {parameter}; {_INSTEAD}"
            )

    @property
    def _compares(self) -> bool:
        return isinstance(self._question, WhichQuestion | SameQuestion)

    def _answer(self, trial: Trial, felt: list[Exploration], random: np.random.Generator) -> str:
        question, noise = self._question, self._noise
        observer = self._observers[trial.condition]
        likes = isinstance(question, WhichQuestion) and question.right is None
        if self._compares:
            one, two, unit = self._felt_of_two(trial, felt)
            if likes and self._parameter in LENGTHS:
                return str(nearer(one, two, unit, noise, random))
            if likes:
                return str(larger(one, two, unit, noise, random))
            if isinstance(question, SameQuestion):
                return DIFFERENT if differ(one, two, unit, noise, random) else SAME
            assert isinstance(question, WhichQuestion), "these are the two that compare"
            one, two = question.worth(one), question.worth(two)
            return str(larger(one, two, unit, noise, random))
        if not isinstance(question, IdentifyQuestion):
            strength = self._strength(trial, 0, felt[0])
            match question:
                case RatingQuestion():
                    return str(rate(strength, question.least, question.most, noise, random))
                case MagnitudeQuestion():
                    given = magnitude(strength, question.modulus or 1.0, noise, random)
                    return f"{given:.3g}"
            return YES if detects(strength, noise, random) else NO
        places = self._lead_cells + len(trial.stimuli[0].masks)
        masks = observer.read(felt[0], places, random)
        asked = slice(*(self._lead_cells + place for place in trial.asked))
        return to_answer(masks[asked])

    def _felt_of_two(self, trial: Trial, felt: list[Exploration]) -> tuple[float, float, float]:
        """What is felt of two stimuli, and its unit: lengths in mm, or how strong they are."""
        if self._parameter not in LENGTHS:
            one, two = (self._strength(trial, place, felt[place]) for place in (0, 1))
            return one, two, 1.0
        observer, pair = self._observers[trial.condition], self._pairs[trial.condition]
        one, two = (felt_mm(observer, self._parameter, each, pair) for each in felt[:2])
        return one, two, nominal_mm(self._parameter, observer.geometry)

    def _strength(self, trial: Trial, place: int, felt: Exploration) -> float:
        """Strength of the strongest dot asked for, in units of E₀; 0 if the hand was on none."""
        places = self._lead_cells + len(trial.stimuli[place].masks)
        first, stop = (self._lead_cells + cell for cell in trial.asked)
        evidence = self._observers[trial.condition].felt(felt, places).evidence[first:stop]
        return 0.0 if np.isnan(evidence).all() else float(np.nanmax(evidence))


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
