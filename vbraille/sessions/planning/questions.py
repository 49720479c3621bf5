"""The table ``[question]`` of a protocol: what is asked of a trial, a class for each kind.

A class has all that is known of its kind: which answers there are, how they are read, scored and
said, the sentence on it in a report, and how the simulated reader answers. Without the table, a
string is to be identified, and of two stimuli one is to be chosen.

**The simulated reader** goes by one number of a stimulus where it is not asked which cells there
are: a length in mm, or how strong its strongest dot is felt, in units of E₀
(`vbraille.sessions.simulated.observer`). Where it is asked which of two it likes, it takes the one
nearer to the length that it was told, or the stronger one. Noise is normal. It says yes, or
different, beyond one standard deviation of its noise, so that it gives a false alarm in 16 % of
trials with nothing. On a scale it puts strengths of 0 to 1 evenly from end to end, and as a
magnitude it gives the strength times the modulus. All this is for trying out protocols, and claims
nothing about people.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, ClassVar, Literal, get_args

import numpy as np

from vbraille.braille.spelling import (
    ORDINALS,
    UNREAD,
    parse_answer,
    parse_choice,
    say_cells,
    to_answer,
    to_braille,
)
from vbraille.errors import check_range
from vbraille.sessions.planning.naming import NameQuestion
from vbraille.sessions.planning.pace import LONGEST_LINE, MOST_BUTTONS, check_line
from vbraille.sessions.planning.questiontable import (
    FALSE_ALARM,
    HIT,
    MISS,
    REJECTION,
    RIGHT,
    WRONG,
    CellSpelling,
    QuestionTable,
)
from vbraille.sessions.planning.scales import (
    LARGEST,
    check_labels,
    check_scale,
    labels_of,
    quoted,
    read_label,
    read_number,
    say_scale,
)
from vbraille.sessions.planning.spellings import parse_text
from vbraille.sessions.planning.stimuli import KNOBS, said_value
from vbraille.sessions.simulated.feeling import LENGTHS, nearer
from vbraille.sessions.simulated.observer import LEAST_FELT, TIE

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vbraille.sessions.planning.design import Design
    from vbraille.sessions.planning.stimuli import Trial
    from vbraille.sessions.simulated.feeling import FeltTrial

LEAST_MAGNITUDE = 1e-3  # smallest magnitude given, as a share of the modulus: none may be 0


def of_all(number: int, rows: Sequence[Any], noun: str, of_the: str = "") -> str:
    """Words for a number of things out of all.

    >>> of_all(2, [0, 0, 0], "trial"), of_all(3, [0, 0, 0], "trial", "of the ")
    ('2 of 3 trials', 'all 3 of the trials')
    >>> of_all(1, [0], "trial"), of_all(0, [0], "trial")
    ('the only trial', '0 of 1 trial')
    """
    if number == len(rows) == 1:
        return f"the only {noun}"
    part = f"all {number}" if number == len(rows) else f"{number} of {len(rows)}"
    return f"{part} {of_the}{noun}{'s' * (len(rows) != 1)}"


YES, NO = "yes", "no"
SAME, DIFFERENT = "same", "different"


class IdentifyQuestion(QuestionTable, frozen=True, kw_only=True, tag="identify"):
    """The question which cells were shown."""

    positive_known: ClassVar[bool] = True
    stimuli: ClassVar[tuple[int, ...]] = (1,)
    forms: ClassVar[tuple[str, ...]] = ("strings",)
    outcomes: ClassVar[frozenset[str]] = frozenset((RIGHT, WRONG))
    asked_of: ClassVar[str] = "cells"

    def help(self, keys: dict[str, int], written: bool, /) -> str:
        """Say how cells, or a text, may be typed."""
        if written:
            return "the text that was read; ? for a cell not read, or for nothing"
        own = f"the keys {' '.join(keys)}, " if keys else ""
        return f"letters, dot numbers with a space between cells, {own}? for a place not read"

    def outcome(self, trial: Trial, answer: str, /) -> str:
        """Right if all cells are; of a blank catch trial, if no dot was felt."""
        if trial.catch == "blank":
            return RIGHT if set(answer) <= {UNREAD, to_braille((0,))} else WRONG
        return RIGHT if answer == trial.presented else WRONG

    def was(self, trial: Trial, keys: dict[str, int], /) -> str:
        """Words for the cells, or the text that they stand for."""
        return trial.stimuli[0].text or self.said(trial.presented, keys)

    def parse(self, text: str, trial: Trial, spelling: CellSpelling, /) -> str:
        """Read cells, or a text; see `vbraille.braille.spelling.parse_answer`, `parse_text`."""
        first, stop = trial.asked
        (stimulus,) = trial.stimuli
        if stimulus.text is not None and stimulus.table is not None:
            return parse_text(text, stimulus.text, stimulus.masks, stimulus.table)
        return parse_answer(
            text, places=stop - first, keys=spelling.keys, shown_dots=spelling.shown_dots
        )

    def said(self, answer: str, keys: dict[str, int], /) -> str:
        """Words for the cells."""
        return say_cells(answer, keys)

    def simulate(self, felt: FeltTrial, _noise: float, random: np.random.Generator, /) -> str:
        """Give the cells as they were felt."""
        return to_answer(felt.cells(random))

    def guess(self, trial: Trial, _random: np.random.Generator, /) -> str:
        """Say that no cell was read."""
        return to_answer([None] * (trial.asked[1] - trial.asked[0]))


class _Chosen(QuestionTable, frozen=True, kw_only=True):
    """A question that is answered by the number of a stimulus."""

    outcomes: ClassVar[frozenset[str]] = frozenset((RIGHT, WRONG))
    among: ClassVar[int | None] = None  # how many may be chosen from; None for all

    def right_one(self, trial: Trial) -> str:
        """Right answer, such as "1" or "2"; empty if there is none."""
        raise NotImplementedError

    def outcome(self, trial: Trial, answer: str, /) -> str:
        """Right or wrong, if one is right."""
        right = self.right_one(trial)
        return "" if not right else RIGHT if answer == right else WRONG

    def was(self, trial: Trial, _keys: dict[str, int], /) -> str:
        """Words for the right one."""
        right = self.right_one(trial)
        return self.said(right, {}) if right else ""

    def parse(self, text: str, trial: Trial, _spelling: CellSpelling, /) -> str:
        """Read a choice; see `vbraille.braille.spelling.parse_choice`."""
        return parse_choice(text, self.among or len(trial.stimuli))

    def said(self, answer: str, _keys: dict[str, int], /) -> str:
        """Words for the one that was chosen."""
        return ORDINALS[int(answer) - 1]

    def guess(self, trial: Trial, random: np.random.Generator, /) -> str:
        """Choose any."""
        return str(random.integers(self.among or len(trial.stimuli)) + 1)


class WhichQuestion(_Chosen, frozen=True, kw_only=True, tag="which"):
    """The question which of two or more stimuli it was: the one with most, or nearest to something.

    Parameters
    ----------
    right
        Which value is right; None if it is what participants like, and nothing is right.
    reference
        Value that the nearest one is nearest to.

    Raises
    ------
    ValueError
        If a reference is missing, or is given and not used.
    """

    positive_known: ClassVar[bool] = True
    stimuli: ClassVar[tuple[int, ...]] = (2, 3, 4, 5)
    forms: ClassVar[tuple[str, ...]] = ("pairs", "standard", "one")
    typed: ClassVar[str] = "1 or 2, for the first or the second"

    right: Literal["more", "less", "nearest"] | None = None
    reference: float | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        check_range("reference", self.reference, -LARGEST, LARGEST)
        if (self.right == "nearest") != (self.reference is not None):
            raise ValueError(
                "right = 'nearest' and reference go together; give both, or neither of them"
            )

    def check(self, design: Design, *, passages: bool, pictures: bool, adaptive: bool) -> None:
        """Check that this question can be asked of trials; see `QuestionTable.check`."""
        super().check(design, passages=passages, pictures=pictures, adaptive=adaptive)
        if getattr(design, "stimuli", 1) > 2 and self.right is None:
            raise ValueError(
                "[question] right is missing, and there are more than two to choose from; add it"
            )
        standard = getattr(design, "reference", None)
        if adaptive:
            self._check_chosen(design)
        if standard is not None and standard in getattr(design, "values", ()):
            raise ValueError(
                f"[design] reference is {standard:g}, which is one of values, and of two that are "
                f"the same none can be chosen; leave it out there"
            )

    def _check_chosen(self, design: Design) -> None:
        """Check that a procedure knows which answers are right, or that none is.

        Raises
        ------
        ValueError
            If it does not.
        """
        standard = getattr(design, "reference", None)
        if standard is None:
            if self.right is not None:
                raise ValueError(
                    "[question] right is of values and a standard, where [procedure] chooses them; "
                    "add reference to [design], or leave right out"
                )
            return
        if self.right not in ("more", "less"):
            raise ValueError(
                "[question] right must be 'more' or 'less', since [procedure] goes by right answers"
            )
        above = getattr(design, "values", (standard,))[0] > standard
        if getattr(design, "stimuli", 2) > 2 and above != (self.right == "more"):
            other = "less" if self.right == "more" else "more"
            raise ValueError(
                f"[question] right is {self.right!r}, and several stimuli of each trial are the "
                f"standard, which has it; give {other!r}"
            )

    def unfelt(self, parameter: str, *, pairs: bool) -> str:
        """Reason why the simulated reader cannot answer; see `QuestionTable.unfelt`."""
        if parameter == "texture_cycles":
            return (
                f"compares {parameter}, and the simulated reader does not feel which texture is "
                f"finer"
            )
        if self.right == "nearest" and parameter not in LENGTHS:
            return (
                f"asks which of two is nearest to a {parameter} of {self.reference:g}, and the "
                f"simulated reader feels how strong a dot is, not its {parameter}"
            )
        return super().unfelt(parameter, pairs=pairs)

    def right_one(self, trial: Trial) -> str:
        """Right answer, such as "1" or "2"; empty if there is none."""
        values = [stimulus.value for stimulus in trial.stimuli]
        if self.right is None or None in values:
            return ""
        worth = [self.worth(value or 0.0) for value in values]
        return f"{worth.index(max(worth)) + 1}" if worth.count(max(worth)) == 1 else ""

    def worth(self, value: float) -> float:
        """Number that is the higher, the more right a value is."""
        if self.right == "nearest":
            return -abs(value - (self.reference or 0.0))
        return value if self.right == "more" else -value

    def cell(self, trial: Trial, answer: str, /) -> str:
        """Value that was chosen."""
        return f"{trial.stimuli[int(answer) - 1].value:g}"

    def verdict(self, trial: Trial, answer: str, _keys: dict[str, int], knob: str | None, /) -> str:
        """Words for the value that was chosen, of all."""
        values = [said_value(stimulus.value or 0.0, knob) for stimulus in trial.stimuli]
        return f"{values[int(answer) - 1]} of {', '.join(values[:-1])} and {values[-1]}"

    def describe(self, rows: Sequence[dict[str, Any]], knob: str | None, /) -> str:
        """Sentence on the choice, and on which one was right."""
        several = rows and len(str(rows[0]["presented"]).split()) > 2
        of_what = "the stimuli of each trial" if several else "each pair"
        of = KNOBS[knob or "contrast"]
        if self.right is None:
            how = ", and neither was right or wrong"
        elif self.right == "nearest":
            how = f"; the one nearest to {self.reference:g}{of.unit} was right"
        else:
            how = f"; the one with {self.right} {of.words} was right"
        return f"Of {of_what} one was chosen{how}"

    def simulate(self, felt: FeltTrial, noise: float, random: np.random.Generator, /) -> str:
        """Choose the largest, the one nearest to the nominal length, or the one that is right."""
        values, unit = felt.values()
        if self.right is None and felt.by_length:
            return str(nearer(values, unit, noise, random))
        worth = [value if self.right is None else self.worth(value) for value in values]
        drawn = noise * unit * random.standard_normal(len(values))
        felt_so = [-math.inf if math.isnan(w) else w + d for w, d in zip(worth, drawn, strict=True)]
        return f"{felt_so.index(max(felt_so)) + 1}"


class OddQuestion(_Chosen, frozen=True, kw_only=True, tag="odd"):
    """The question which of the stimuli differed from the others."""

    positive_known: ClassVar[bool] = True
    stimuli: ClassVar[tuple[int, ...]] = (3, 4, 5)
    forms: ClassVar[tuple[str, ...]] = ("one", "triangle")
    typed: ClassVar[str] = "1, 2 or 3, for the one that differs"

    def right_one(self, trial: Trial) -> str:
        """Right answer: the place of the value that is there once."""
        values = [stimulus.value for stimulus in trial.stimuli]
        return next(f"{n}" for n, value in enumerate(values, 1) if values.count(value) == 1)

    def describe(self, _rows: Sequence[dict[str, Any]], _knob: str | None, /) -> str:
        """Sentence on what was asked."""
        return "One stimulus of each trial differed from the others, and it was said which"

    def simulate(self, felt: FeltTrial, noise: float, random: np.random.Generator, /) -> str:
        """Choose the one that is felt furthest from the middle one of all."""
        values, unit = felt.values()
        drawn = noise * unit * random.standard_normal(len(values))
        so = [0.0 if math.isnan(v) else v + d for v, d in zip(values, drawn, strict=True)]
        off = [abs(value - np.median(so)) for value in so]
        return f"{off.index(max(off)) + 1}"


class MatchQuestion(_Chosen, frozen=True, kw_only=True, tag="match"):
    """The question which of the first two stimuli the third one was (ABX)."""

    positive_known: ClassVar[bool] = True
    stimuli: ClassVar[tuple[int, ...]] = (3,)
    forms: ClassVar[tuple[str, ...]] = ("abx",)
    among: ClassVar[int | None] = 2
    typed: ClassVar[str] = "1 or 2, for the one that the third was like"

    def right_one(self, trial: Trial) -> str:
        """Right answer: the first that has the value of the third."""
        values = [stimulus.value for stimulus in trial.stimuli]
        return f"{values.index(values[2]) + 1}"

    def describe(self, _rows: Sequence[dict[str, Any]], _knob: str | None, /) -> str:
        """Sentence on what was asked."""
        return "It was said which of two stimuli a third one was"

    def simulate(self, felt: FeltTrial, noise: float, random: np.random.Generator, /) -> str:
        """Choose the one that is felt nearer to the third."""
        values, unit = felt.values()
        drawn = noise * unit * random.standard_normal(3)
        so = [0.0 if math.isnan(v) else v + d for v, d in zip(values, drawn, strict=True)]
        return "2" if abs(so[1] - so[2]) < abs(so[0] - so[2]) else "1"


class OneOfTwo(QuestionTable, frozen=True, kw_only=True):
    """A question answered by one of two words; trials with a signal are answered by the first."""

    outcomes: ClassVar[frozenset[str]] = frozenset((HIT, MISS, FALSE_ALARM, REJECTION))
    noun: ClassVar[str]  # what a trial shows
    clauses: ClassVar[tuple[str, str]]  # of the sentence in a report, around a number

    def prompt(self) -> str:
        """Name the two words, and the letters that they begin with."""
        first, second = self.words
        return f"{first} or {second} ({first[0]} or {second[0]})"

    def has_signal(self, trial: Trial) -> bool:
        """True if the trial has a signal, such as a difference."""
        raise NotImplementedError

    def outcome(self, trial: Trial, answer: str, /) -> str:
        """Hit or miss with a signal, false alarm or correct rejection without one."""
        return self.score(self.has_signal(trial), answer)

    def guess(self, _trial: Trial, random: np.random.Generator, /) -> str:
        """Say either word."""
        return self.words[random.integers(2)]

    @classmethod
    def score(cls, signal: bool, answer: str) -> str:
        """Score an answer to a trial with a signal, or without one."""
        positive = answer == cls.words[0]
        if signal:
            return HIT if positive else MISS
        return FALSE_ALARM if positive else REJECTION

    def describe(self, rows: Sequence[dict[str, Any]], _knob: str | None, /) -> str:
        """Sentence on what was asked, and how many trials had a signal."""
        signals = of_all(sum(row["outcome"] in (HIT, MISS) for row in rows), rows, self.noun)
        return signals.join(self.clauses)

    def parse(self, text: str, _trial: Trial, _spelling: CellSpelling, /) -> str:
        """Read one of the two words, in either case, or its first letter."""
        word = text.strip().lower()
        for known in self.words:
            if word in (known, known[0]):
                return known
        raise ValueError(f"{quoted(text)}type {self.words[0]} or {self.words[1]}")


class SameQuestion(OneOfTwo, frozen=True, kw_only=True, tag="same-different"):
    """The question whether two stimuli were different or the same."""

    stimuli: ClassVar[tuple[int, ...]] = (2,)
    forms: ClassVar[tuple[str, ...]] = ("pairs",)
    words: ClassVar[tuple[str, ...]] = (DIFFERENT, SAME)
    of_equals: ClassVar[bool] = True
    noun: ClassVar[str] = "pair"
    clauses: ClassVar[tuple[str, str]] = (
        "Of each pair it was said whether the two were the same or different; ",
        " differed",
    )

    def has_signal(self, trial: Trial) -> bool:
        """True if the two differ in anything."""
        return trial.stimuli[0] != trial.stimuli[1]

    def was(self, trial: Trial, _keys: dict[str, int], /) -> str:
        """Words for what the two were."""
        return DIFFERENT if self.has_signal(trial) else SAME

    def simulate(self, felt: FeltTrial, noise: float, random: np.random.Generator, /) -> str:
        """Say that two differ if they are felt to, beyond the noise of both."""
        (one, two), unit = felt.values()
        if math.isnan(one) or math.isnan(two):
            return DIFFERENT if math.isnan(one) != math.isnan(two) else SAME
        apart = (one - two) / unit + noise * math.sqrt(2) * float(random.standard_normal())
        return DIFFERENT if abs(apart) > max(noise * math.sqrt(2), TIE) else SAME


class DetectQuestion(OneOfTwo, frozen=True, kw_only=True, tag="detect"):
    """The question whether there was anything: a cell with dots, and some contrast to feel it."""

    positive_known: ClassVar[bool] = True
    stimuli: ClassVar[tuple[int, ...]] = (1,)
    words: ClassVar[tuple[str, ...]] = (YES, NO)
    asked_of: ClassVar[str] = "cells"
    of_catch: ClassVar[bool] = True
    noun: ClassVar[str] = "trial"
    clauses: ClassVar[tuple[str, str]] = (
        "It was said whether there was anything; there was something in ",
        "",
    )

    def positive(self, _trial: Trial, answer: str, /) -> bool:
        """True if the answer is yes."""
        return answer == YES

    def has_signal(self, trial: Trial) -> bool:
        """True if there was anything to be felt in the cells asked for."""
        (stimulus,) = trial.stimuli
        return stimulus.tuning.contrast > 0 and any(stimulus.masks[slice(*trial.asked)])

    def was(self, trial: Trial, _keys: dict[str, int], /) -> str:
        """Words for what there was."""
        return "something" if self.has_signal(trial) else "nothing"

    def simulate(self, felt: FeltTrial, noise: float, random: np.random.Generator, /) -> str:
        """Say yes beyond one standard deviation of the noise."""
        strength = felt.strength() + noise * float(random.standard_normal())
        return YES if strength > max(noise, LEAST_FELT) else NO


class RatingQuestion(QuestionTable, frozen=True, kw_only=True, tag="rating"):
    """The question where on a scale of whole numbers something is.

    Parameters
    ----------
    scale
        Name of what is rated, such as roughness.
    least, most
        Ends of the scale.
    labels
        Words for all steps of the scale, or for its two ends; none for numbers alone. They may be
        typed instead of the numbers.

    Raises
    ------
    ValueError
        If the scale is read backwards or is too long, or the labels are not one for each.
    """

    numeric: ClassVar[bool] = True

    scale: str
    least: int
    most: int
    labels: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        super().__post_init__()
        check_line("scale", self.scale)
        check_scale(self.least, self.most)
        check_labels(self.labels, self.least, self.most)

    @property
    def named(self) -> dict[int, str]:
        """Labels of the steps that have one."""
        return labels_of(self.labels, self.least, self.most)

    def prompt(self) -> str:
        """Name the numbers of the scale, with the labels of its ends."""
        return say_scale(self.least, self.most, self.named, f" for {self.scale}")

    def parse(self, text: str, _trial: Trial, _spelling: CellSpelling, /) -> str:
        """Read a step of the scale: its number, or its label."""
        return str(read_label(text, self.least, self.most, self.named))

    def said(self, answer: str, _keys: dict[str, int], /) -> str:
        """Words for a step: its number, and its label if it has one."""
        label = self.named.get(int(answer), "")
        return f"{answer}, {label}" if label else answer

    def describe(self, _rows: Sequence[dict[str, Any]], _knob: str | None, /) -> str:
        """Sentence on the scale."""
        least, most = (
            f"{step} ({self.named[step]})" if step in self.named else f"{step}"
            for step in (self.least, self.most)
        )
        return f"They rated {self.scale} in whole numbers, from {least} to {most}"

    def simulate(self, felt: FeltTrial, noise: float, random: np.random.Generator, /) -> str:
        """Put a strength of 0 to 1 evenly on the scale."""
        share = felt.strength(-1) + noise * float(random.standard_normal())
        return str(self.least + round(min(max(share, 0.0), 1.0) * (self.most - self.least)))

    def guess(self, _trial: Trial, random: np.random.Generator, /) -> str:
        """Give any step of the scale."""
        return str(random.integers(self.least, self.most + 1))


class MagnitudeQuestion(QuestionTable, frozen=True, kw_only=True, tag="magnitude"):
    """The question how strong something is, as a positive number.

    Parameters
    ----------
    modulus
        Number that the participant is told for the standard, which is shown first in each trial
        with ``form = "standard"`` of the design; None if participants choose.

    Raises
    ------
    ValueError
        If the modulus is not a positive number.
    """

    numeric: ClassVar[bool] = True

    modulus: float | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.modulus is not None and not 0 < self.modulus <= LARGEST:
            raise ValueError(f"modulus is {self.modulus:g}; it must be a number above 0")

    def prompt(self) -> str:
        """Ask for a number above 0, and tell the standard's."""
        told = "" if self.modulus is None else f"; the standard is {self.modulus:g}"
        return f"a number above 0{told}"

    def parse(self, text: str, _trial: Trial, _spelling: CellSpelling, /) -> str:
        """Read a positive number, with a point or a comma in it."""
        wanted = "a number above 0, such as 12 or 0.5"
        return f"{read_number(text, math.ulp(0.0), LARGEST, wanted):.15g}"

    def describe(self, _rows: Sequence[dict[str, Any]], _knob: str | None, /) -> str:
        """Sentence on the standard."""
        standard = (
            "everybody chose their own standard"
            if self.modulus is None
            else f"the standard was {self.modulus:g}"
        )
        return f"They estimated a magnitude, as a number above 0; {standard}"

    def simulate(self, felt: FeltTrial, noise: float, random: np.random.Generator, /) -> str:
        """Give the share of the standard times the modulus, with noise on its logarithm."""
        share = max(felt.share(), LEAST_MAGNITUDE)
        share *= math.exp(noise * float(random.standard_normal()))
        return f"{(self.modulus or 1.0) * max(share, LEAST_MAGNITUDE):.3g}"

    def guess(self, _trial: Trial, random: np.random.Generator, /) -> str:
        """Give any number around the modulus."""
        return f"{(self.modulus or 1.0) * math.exp(random.standard_normal()):.3g}"


class AdjustQuestion(QuestionTable, frozen=True, kw_only=True, tag="adjust"):
    """The request to turn the last stimulus until it is equal to the standard, or as it should be.

    Parameters
    ----------
    step
        Smallest turn of the value.
    least, most
        Bounds of the value.
    knob
        Number of the device's knob whose way from end to end is that from ``least`` to ``most``;
        None for none.
    buttons
        Numbers of three buttons of the device: for less, for more, and for equal; empty for none.

    Raises
    ------
    ValueError
        If there is nothing to turn, or a number is out of range.
    """

    numeric: ClassVar[bool] = True
    turns: ClassVar[bool] = True
    forms: ClassVar[tuple[str, ...]] = ("single", "standard")

    step: float
    least: float
    most: float
    knob: int | None = None
    buttons: tuple[int, ...] = ()

    def __post_init__(self) -> None:
        super().__post_init__()
        check_range("step", self.step, 1e-4, LARGEST)
        if not self.least + self.step <= self.most:
            raise ValueError("most is less than a step above least; make it larger")
        check_range("knob", self.knob, 1, MOST_BUTTONS)
        if len(set(self.buttons)) not in (0, 3) or len(self.buttons) != len(set(self.buttons)):
            raise ValueError("buttons must be three, for less, for more and for equal")
        for number in self.buttons:
            check_range("buttons: one", number, 1, MOST_BUTTONS)

    def prompt(self) -> str:
        """Say how the value is turned."""
        return "+ or - to turn it (++ twice), equal when it is; standard shows both again"

    def steps(self, line: str, /) -> int | None:
        """Steps by which a line turns the value; 0 for "standard", which shows both again."""
        word = line.strip()
        turned = word.count("+") - word.count("-") if not set(word) - {"+", "-"} else 0
        return turned or (0 if word == "standard" else None)

    def turned(self, value: float, steps: int, /) -> float:
        """Value turned by some steps, within the bounds."""
        return round(min(max(value + steps * self.step, self.least), self.most), 9)

    def by_knob(self, number: int, share: float, /) -> float | None:
        """Value at which the knob stands, given the share of its way."""
        steps = round(share * (self.most - self.least) / self.step)
        return self.turned(self.least, steps) if number == self.knob else None

    def by_button(self, number: int, /) -> str:
        """Line for less, for more, or for equal."""
        lines = dict(zip(self.buttons, ("-", "+", "equal"), strict=False))
        return lines.get(number, "")

    def parse(self, text: str, trial: Trial, _spelling: CellSpelling, /) -> str:
        """Take the value that the last stimulus has, or one that is typed as a number."""
        if text.strip().lower() in ("equal", "="):
            return f"{trial.stimuli[-1].value:.9g}"
        return f"{read_number(text, self.least, self.most, self.prompt()):.9g}"

    def describe(self, _rows: Sequence[dict[str, Any]], knob: str | None, /) -> str:
        """Sentence on what was turned."""
        of = KNOBS[knob or "contrast"]
        return f"They turned the {of.words} until it was equal, in steps of {self.step:g}{of.unit}"

    def simulate(self, felt: FeltTrial, noise: float, random: np.random.Generator, /) -> str:
        """Turn towards what is felt as equal, by one noise in a trial, until it is within a step.

        Nothing is equal to what cannot be reached: after a turn through all steps it says so.
        """
        values, unit = felt.values()
        standard = unit if len(values) == 1 else values[0]
        drawn = noise * unit * random.standard_normal(2)
        apart = values[-1] + drawn[1] - (standard + drawn[0])
        span = (self.most - self.least) / self.step
        if math.isnan(apart) or felt.turns > span + 2:
            return "equal"
        step = self.step if felt.by_length else TIE
        if abs(apart) <= step / 2:
            return "equal"
        steps = min(round(abs(apart) / step), round(span)) if felt.by_length else 1
        return ("-" if apart > 0 else "+") * max(steps, 1)

    def guess(self, _trial: Trial, _random: np.random.Generator, /) -> str:
        """Leave the value where it is."""
        return "equal"


class ReadQuestion(QuestionTable, frozen=True, kw_only=True, tag="read"):
    """The request to read a passage, and to say that it was read."""

    stimuli: ClassVar[tuple[int, ...]] = (1,)
    forms: ClassVar[tuple[str, ...]] = ("passages",)
    words: ClassVar[tuple[str, ...]] = ("read", "broken off")
    typed: ClassVar[str] = "read, or broken off (r or b)"

    def parse(self, text: str, _trial: Trial, _spelling: CellSpelling, /) -> str:
        """Read one of the two words, or its first letter."""
        word = " ".join(text.lower().split())
        for known in self.words:
            if word in (known, known[0]):
                return known
        raise ValueError(f"{quoted(text)}type {self.typed}")

    def describe(self, rows: Sequence[dict[str, Any]], _knob: str | None, /) -> str:
        """Sentence on the passages."""
        read = sum(row["answered"] == self.words[0] for row in rows)
        return f"They read passages, line by line, {of_all(read, rows, 'passage')} to the end"

    def simulate(self, _felt: FeltTrial, _noise: float, _random: np.random.Generator, /) -> str:
        """Say that it was read."""
        return self.words[0]

    def guess(self, _trial: Trial, _random: np.random.Generator, /) -> str:
        """Say that it was read."""
        return self.words[0]


class FreeQuestion(QuestionTable, frozen=True, kw_only=True, tag="free"):
    """A question that is answered in words, which are not scored."""

    simulated: ClassVar[bool] = False
    typed: ClassVar[str] = "the answer in words"

    def describe(self, _rows: Sequence[dict[str, Any]], _knob: str | None, /) -> str:
        """Sentence on the words."""
        return "They answered in words of their own, which were not scored"

    def parse(self, text: str, _trial: Trial, _spelling: CellSpelling, /) -> str:
        """Read any line of text that is not empty."""
        answer = text.strip()
        if not answer or not answer.isprintable():
            raise ValueError("nothing was typed that can be kept; type a line of words")
        if len(answer) > 10 * LONGEST_LINE:
            raise ValueError(f"it has {len(answer)} characters; type at most {10 * LONGEST_LINE}")
        return answer


AnyQuestion = (
    IdentifyQuestion
    | WhichQuestion
    | OddQuestion
    | MatchQuestion
    | SameQuestion
    | DetectQuestion
    | RatingQuestion
    | MagnitudeQuestion
    | AdjustQuestion
    | ReadQuestion
    | NameQuestion
    | FreeQuestion
)
KINDS: dict[str, type[QuestionTable]] = {
    str(kind.__struct_config__.tag): kind for kind in get_args(AnyQuestion)
}


def usual_question(stimuli: int) -> AnyQuestion:
    """Question of a protocol without the table, for trials with one stimulus or more."""
    return WhichQuestion() if stimuli > 1 else IdentifyQuestion()
