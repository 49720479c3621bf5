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
magnitude it gives the strength times the modulus. How sure it is it cannot tell: its confidence is
the middle of the scale. All this is for trying out protocols, and claims nothing about people.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
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
from vbraille.sessions.planning.pace import LONGEST_LINE, MOST_BUTTONS, check_line, check_name
from vbraille.sessions.planning.spellings import parse_text
from vbraille.sessions.planning.stimuli import KNOBS, said_value
from vbraille.sessions.simulated.feeling import nearer
from vbraille.sessions.simulated.observer import LEAST_FELT, TIE
from vbraille.tomlfile import Table

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vbraille.sessions.planning.stimuli import Trial
    from vbraille.sessions.simulated.feeling import FeltTrial


RIGHT, WRONG = "right", "wrong"
HIT, MISS, FALSE_ALARM, REJECTION = "hit", "miss", "false alarm", "correct rejection"
_NUMBERS = ("", "one", "two", "three", "four", "five")
GOOD = frozenset((RIGHT, HIT, REJECTION))  # outcomes of right answers
_MOST_STEPS = 101
LARGEST = 1e9
LEAST_MAGNITUDE = 1e-3  # smallest magnitude given, as a share of the modulus: none may be 0


@dataclass(frozen=True, slots=True)
class CellSpelling:
    """Spelling of cells in answers.

    Parameters
    ----------
    keys
        Dot mask of each key of the protocol.
    shown_dots
        Mask of the dots that the display shows.
    """

    keys: dict[str, int]
    shown_dots: int


class ConfidenceScale(Table, frozen=True, kw_only=True):
    """The scale on which participants say how sure an answer is.

    Parameters
    ----------
    least, most
        Ends of the scale, in whole numbers: least sure and most sure.

    Raises
    ------
    ValueError
        If the scale is read backwards, or is too long.
    """

    least: int
    most: int

    def __post_init__(self) -> None:
        check_scale(self.least, self.most)

    @property
    def typed(self) -> str:
        """Words for what may be typed."""
        return f"{self.least} to {self.most}"

    def parse(self, text: str) -> int:
        """Read a confidence.

        Raises
        ------
        ValueError
            If the text is no whole number of the scale.
        """
        return read_step(text, self.least, self.most)

    def split(self, line: str, spelling: CellSpelling) -> tuple[str, int | None]:
        """Part a line into an answer and the confidence after a semicolon; None if it has none."""
        answer, semicolon, rest = line.rpartition(";")
        if not semicolon or ";" in spelling.keys or not is_whole(rest.strip()):
            return line, None
        return answer.strip(), self.parse(rest)


class QuestionTable(Table, frozen=True, kw_only=True, tag_field="kind"):
    """Common part of the questions of every kind.

    Parameters
    ----------
    ask
        The question in words, for the experimenter to say; may be empty.
    confidence
        Scale on which it is asked how sure the answer is; None if it is not asked.

    Raises
    ------
    ValueError
        If the words are too long.
    """

    stimuli: ClassVar[tuple[int, ...]] = (1, 2)  # how many stimuli a trial may have
    forms: ClassVar[tuple[str, ...]] = ()  # forms of a choice that it can be asked of; none for any
    outcomes: ClassVar[frozenset[str]] = frozenset()  # how answers may be scored
    words: ClassVar[tuple[str, ...]] = ()  # all answers, the one that is looked for first
    numeric: ClassVar[bool] = False  # whether answers are numbers on a scale
    positive_known: ClassVar[bool] = False  # whether a procedure can go by the answers
    turns: ClassVar[bool] = False  # whether the participant turns the value of the last stimulus
    simulated: ClassVar[bool] = True  # whether the simulated reader can answer
    typed: ClassVar[str] = "the answer"  # what may be typed as an answer

    ask: str = ""
    confidence: ConfidenceScale | None = None

    def __post_init__(self) -> None:
        if self.ask:
            check_line("ask", self.ask)

    @property
    def name(self) -> str:
        """Name of the kind in tables."""
        return str(self.__struct_config__.tag)

    def prompt(self) -> str:
        """Say what may be typed as an answer."""
        return self.typed

    def check(self, stimuli: int, form: str, *, adaptive: bool) -> None:
        """Check that this question can be asked of trials.

        Parameters
        ----------
        stimuli
            Number of stimuli in a trial.
        form
            Form of a choice; empty if strings are read.
        adaptive
            Whether the answers choose what is shown.

        Raises
        ------
        ValueError
            If it cannot.
        """
        if stimuli not in self.stimuli:
            more = " or more" if len(self.stimuli) > 1 else ""
            fewest = min(self.stimuli)
            wanted = "one stimulus" if fewest == 1 else f"{_NUMBERS[fewest]} stimuli{more}"
            given = _NUMBERS[stimuli]
            raise ValueError(
                f"kind is {self.name!r}, which is asked of {wanted}, and each trial of [design] "
                f"has {given}; choose another kind of question or of design"
            )
        if form and self.forms and form not in self.forms:
            raise ValueError(
                f"kind is {self.name!r}, which is asked of form = "
                f"{' or '.join(map(repr, self.forms))}, and form of [design] is {form!r}; choose "
                f"another"
            )
        if adaptive and not self.positive_known:
            raise ValueError(
                f"kind is {self.name!r}, whose answers cannot choose what is shown next; leave "
                f"[procedure] out, or ask something else"
            )

    def help(self, _keys: dict[str, int], _written: bool, /) -> str:
        """Say at the console what may be typed, where strings are written in print or in cells."""
        return self.prompt()

    def right_of(self, _picture: str, _columns: dict[str, str], /) -> str | None:
        """Right answer about a picture, by the columns of the file of items; None if none is."""
        return None

    def by_button(self, _number: int, /) -> str:
        """Answer that a button of the device stands for; empty if it stands for none."""
        return ""

    def parse(self, text: str, trial: Trial, spelling: CellSpelling, /) -> str:
        """Read an answer, and bring it into the spelling in which it is kept.

        Raises
        ------
        ValueError
            If the text is no answer to the question.
        """
        raise NotImplementedError

    def positive(self, trial: Trial, answer: str, /) -> bool:
        """True if an answer counts as a positive one for a procedure."""
        return self.good(trial, answer)

    def outcome(self, _trial: Trial, _answer: str, /) -> str:
        """Score an answer, as "right" or "hit" for example; empty if it is not scored."""
        return ""

    def good(self, trial: Trial, answer: str, /) -> bool:
        """True if an answer is right."""
        return self.outcome(trial, answer) in GOOD

    def was(self, _trial: Trial, _keys: dict[str, int], /) -> str:
        """Words for what is right; empty if nothing is."""
        return ""

    def said(self, answer: str, _keys: dict[str, int], /) -> str:
        """Words for an answer."""
        return answer

    def verdict(self, trial: Trial, answer: str, keys: dict[str, int], _knob: str | None, /) -> str:
        """Words for an answer, and for whether it is right."""
        said, was = self.said(answer, keys), self.was(trial, keys)
        if not was:
            return said
        return f"{said}, right" if self.good(trial, answer) else f"{said}, wrong: it was {was}"

    def feedback(self, trial: Trial, answer: str, keys: dict[str, int], knob: str | None, /) -> str:
        """Words for what a practice trial has shown; empty if there is nothing to say."""
        if was := self.was(trial, keys):
            return f"{'right' if self.good(trial, answer) else 'wrong'}, it was {was}"
        values = [said_value(s.value, knob) for s in trial.stimuli if s.value is not None]
        return f"they were {', '.join(values[:-1])} and {values[-1]}" if len(values) > 1 else ""

    def cell(self, _trial: Trial, answer: str, /) -> str:
        """Text for an answer in tables."""
        return answer

    def columns(self, trial: Trial, answer: str | None, /) -> dict[str, Any]:
        """Cells of a trial's row for the question and the answer's score; see `COLUMNS`."""
        row: dict[str, Any] = {"question": self.name}
        if answer is not None and (outcome := self.outcome(trial, answer)):
            row |= {"outcome": outcome, "correct": int(outcome in GOOD)}
        return row

    def describe(self, _rows: Sequence[dict[str, Any]], _knob: str | None, /) -> str:
        """Sentence on the question in a report, for some answered trials; may be empty."""
        return ""

    def simulate(self, felt: FeltTrial, noise: float, random: np.random.Generator, /) -> str:
        """Answer by what was felt, with normal noise of a standard deviation."""
        raise NotImplementedError

    def guess(self, trial: Trial, random: np.random.Generator, /) -> str:
        """Answer to a trial that was not attended to: any, by chance alone."""
        raise NotImplementedError


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


def check_scale(least: int, most: int) -> None:
    """Check the ends of a scale.

    Raises
    ------
    ValueError
        If the scale is read backwards, or is too long.
    """
    if least >= most:
        raise ValueError(
            f"least is {least} and most is {most}, so that the scale is read backwards; "
            f"make most larger than least"
        )
    if most - least + 1 > _MOST_STEPS:
        raise ValueError(f"the scale has more than {_MOST_STEPS} steps; make it shorter")


def check_labels(labels: tuple[str, ...], least: int, most: int) -> None:
    """Check the words for the steps of a scale.

    Raises
    ------
    ValueError
        If they are not one for each step or for each end, or two are alike.
    """
    steps = most - least + 1
    if len(labels) not in (0, 2, steps):
        raise ValueError(
            f"labels are {len(labels)}; give 2 for the ends of the scale, {steps} for all its "
            f"steps, or none"
        )
    known: set[str] = set()
    for label in labels:
        check_line("labels: one", label)
        if label.strip().lower() in known:
            raise ValueError(f"labels have {label!r} twice; give each step its own")
        if is_whole(label.strip()):
            raise ValueError(f"labels have {label!r}, which is a number; give words")
        known.add(label.strip().lower())


def labels_of(labels: tuple[str, ...], least: int, most: int) -> dict[int, str]:
    """Words of the steps that have some."""
    if len(labels) == 2:
        return dict(zip((least, most), labels, strict=True))
    return dict(enumerate(labels, least))


def say_scale(least: int, most: int, named: dict[int, str], what: str = "") -> str:
    """Name the numbers of a scale, what they are for, and the words of its ends."""
    said = f"{least} to {most}{what}"
    return f"{said}: {least} is {named[least]}, {most} is {named[most]}" if named else said


def read_label(text: str, least: int, most: int, named: dict[int, str]) -> int:
    """Read a step of a scale: its number, or its words.

    Raises
    ------
    ValueError
        If the text is neither.
    """
    for step, label in named.items():
        if text.strip().lower() == label.strip().lower():
            return step
    return read_step(text, least, most)


def read_step(text: str, least: int, most: int) -> int:
    """Read a step of a scale.

    Raises
    ------
    ValueError
        If the text is no whole number of the scale.
    """
    word = text.strip()
    if not is_whole(word) or not least <= int(word) <= most:
        raise ValueError(f"{quoted(text)}type a whole number, {least} to {most}")
    return int(word)


def is_whole(word: str) -> bool:
    """True if a word is a whole number."""
    return len(word) < 10 and word.removeprefix("-").isdecimal()


def quoted(text: str) -> str:
    """Words for what was typed and is no answer, as the beginning of a sentence."""
    word = text.strip()
    if not word:
        return "nothing was typed; "
    return f"{word if len(word) <= 20 else word[:20] + '…'!r} is not an answer; "


YES, NO = "yes", "no"
SAME, DIFFERENT = "same", "different"


class IdentifyQuestion(QuestionTable, frozen=True, kw_only=True, tag="identify"):
    """The question which cells were shown."""

    positive_known: ClassVar[bool] = True
    stimuli: ClassVar[tuple[int, ...]] = (1,)
    forms: ClassVar[tuple[str, ...]] = ("",)
    outcomes: ClassVar[frozenset[str]] = frozenset((RIGHT, WRONG))

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


class WhichQuestion(QuestionTable, frozen=True, kw_only=True, tag="which"):
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
    outcomes: ClassVar[frozenset[str]] = frozenset((RIGHT, WRONG))
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

    def check(self, stimuli: int, form: str, *, adaptive: bool) -> None:
        """Check that this question can be asked of trials; see `QuestionTable.check`."""
        super().check(stimuli, form, adaptive=adaptive)
        if stimuli > 2 and self.right is None:
            raise ValueError("right is missing, and there are more than two to choose from; add it")

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

    def outcome(self, trial: Trial, answer: str, /) -> str:
        """Right or wrong, if one of the two is right."""
        right = self.right_one(trial)
        return "" if not right else RIGHT if answer == right else WRONG

    def was(self, trial: Trial, _keys: dict[str, int], /) -> str:
        """Words for the right one."""
        right = self.right_one(trial)
        return self.said(right, {}) if right else ""

    def parse(self, text: str, trial: Trial, _spelling: CellSpelling, /) -> str:
        """Read a choice; see `vbraille.braille.spelling.parse_choice`."""
        return parse_choice(text, len(trial.stimuli))

    def said(self, answer: str, _keys: dict[str, int], /) -> str:
        """Words for the one that was chosen."""
        return ORDINALS[int(answer) - 1]

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

    def guess(self, trial: Trial, random: np.random.Generator, /) -> str:
        """Choose any."""
        return str(random.integers(len(trial.stimuli)) + 1)


class OddQuestion(QuestionTable, frozen=True, kw_only=True, tag="odd"):
    """The question which of the stimuli differed from the others."""

    stimuli: ClassVar[tuple[int, ...]] = (3, 4, 5)
    forms: ClassVar[tuple[str, ...]] = ("one", "triangle")
    outcomes: ClassVar[frozenset[str]] = frozenset((RIGHT, WRONG))
    typed: ClassVar[str] = "1, 2 or 3, for the one that differs"

    def right_one(self, trial: Trial) -> str:
        """Right answer: the place of the value that is there once."""
        values = [stimulus.value for stimulus in trial.stimuli]
        return next(f"{n}" for n, value in enumerate(values, 1) if values.count(value) == 1)

    def outcome(self, trial: Trial, answer: str, /) -> str:
        """Right if it is the one that differs."""
        return RIGHT if answer == self.right_one(trial) else WRONG

    def was(self, trial: Trial, _keys: dict[str, int], /) -> str:
        """Words for the right one."""
        return ORDINALS[int(self.right_one(trial)) - 1]

    def parse(self, text: str, trial: Trial, _spelling: CellSpelling, /) -> str:
        """Read a choice; see `vbraille.braille.spelling.parse_choice`."""
        return parse_choice(text, len(trial.stimuli))

    def said(self, answer: str, _keys: dict[str, int], /) -> str:
        """Words for the one that was chosen."""
        return ORDINALS[int(answer) - 1]

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

    def guess(self, trial: Trial, random: np.random.Generator, /) -> str:
        """Choose any."""
        return str(random.integers(len(trial.stimuli)) + 1)


class MatchQuestion(QuestionTable, frozen=True, kw_only=True, tag="match"):
    """The question which of the first two stimuli the third one was (ABX)."""

    stimuli: ClassVar[tuple[int, ...]] = (3,)
    forms: ClassVar[tuple[str, ...]] = ("abx",)
    outcomes: ClassVar[frozenset[str]] = frozenset((RIGHT, WRONG))
    typed: ClassVar[str] = "1 or 2, for the one that the third was like"

    def outcome(self, trial: Trial, answer: str, /) -> str:
        """Right if the third has the value of the one that was chosen."""
        values = [stimulus.value for stimulus in trial.stimuli]
        return RIGHT if values[int(answer) - 1] == values[2] else WRONG

    def was(self, trial: Trial, _keys: dict[str, int], /) -> str:
        """Words for the right one."""
        return ORDINALS[0 if self.good(trial, "1") else 1]

    def parse(self, text: str, _trial: Trial, _spelling: CellSpelling, /) -> str:
        """Read a choice of two; see `vbraille.braille.spelling.parse_choice`."""
        return parse_choice(text)

    def said(self, answer: str, _keys: dict[str, int], /) -> str:
        """Words for the one that was chosen."""
        return ORDINALS[int(answer) - 1]

    def describe(self, _rows: Sequence[dict[str, Any]], _knob: str | None, /) -> str:
        """Sentence on what was asked."""
        return "It was said which of two stimuli a third one was"

    def simulate(self, felt: FeltTrial, noise: float, random: np.random.Generator, /) -> str:
        """Choose the one that is felt nearer to the third."""
        values, unit = felt.values()
        drawn = noise * unit * random.standard_normal(3)
        so = [0.0 if math.isnan(v) else v + d for v, d in zip(values, drawn, strict=True)]
        return "2" if abs(so[1] - so[2]) < abs(so[0] - so[2]) else "1"

    def guess(self, _trial: Trial, random: np.random.Generator, /) -> str:
        """Choose either."""
        return str(random.integers(2) + 1)


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
        try:
            number = float(text.strip().replace(",", "."))
        except ValueError:
            number = math.nan
        if not 0 < number <= LARGEST:
            raise ValueError(f"{quoted(text)}type a number above 0, such as 12 or 0.5")
        return f"{number:.15g}"

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


class Naming(Table, frozen=True, kw_only=True):
    """One of the names that a picture is given.

    Parameters
    ----------
    of
        Column of the file of items that has the right name, such as "shape"; None if the picture's
        own name is right.
    names
        Names that may be given, by the keys that stand for them, such as 1 or s.

    Raises
    ------
    ValueError
        If there are fewer than two, a name is given twice, or one cannot be typed.
    """

    names: dict[str, str]
    of: str | None = None

    def __post_init__(self) -> None:
        if len(self.names) < 2:
            raise ValueError(f"names are {len(self.names)}; give two or more to choose from")
        for key, name in self.names.items():
            check_name("names: one", name)
            if len(key) != 1 or not key.isprintable() or key.isspace():
                raise ValueError(f"names have the key {key!r}; a key must be one character")
            if [*self.names.values()].count(name) > 1:
                raise ValueError(f"names have {name!r} twice; give each its own")

    @property
    def words(self) -> str:
        """Words for the keys and their names."""
        return ", ".join(f"{key} {name}" for key, name in self.names.items())


class NameQuestion(QuestionTable, frozen=True, kw_only=True, tag="name"):
    """The question which of some names a picture has; or several, such as its shape and its size.

    Parameters
    ----------
    choices
        The names to choose from, in the order in which answers keep them.
    confirm
        Whether a typed answer is said back, and counts only when it is typed again, or by Enter.
        Until then another one takes its place.
    buttons
        Whether the buttons of the device stand for the keys, in their order.

    Raises
    ------
    ValueError
        If there is no choice, a key or a name is in two, or the device cannot have so many buttons.
    """

    stimuli: ClassVar[tuple[int, ...]] = (1,)
    outcomes: ClassVar[frozenset[str]] = frozenset((RIGHT, WRONG))

    choices: tuple[Naming, ...]
    confirm: bool = True
    buttons: bool = False

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.choices:
            raise ValueError("choices are none; give one or more")
        marks = [mark for each in self.choices for mark in (*each.names, *each.names.values())]
        for mark in marks:
            if sum(mark in (*one.names, *one.names.values()) for one in self.choices) > 1:
                raise ValueError(f"choices have {mark!r} twice; give each its own")
        if self.buttons and len(self.keys) > MOST_BUTTONS:
            raise ValueError(
                f"buttons would be {len(self.keys)}, and a device has up to {MOST_BUTTONS}; leave "
                f"it out"
            )

    @property
    def keys(self) -> tuple[str, ...]:
        """All keys, in their order."""
        return tuple(key for each in self.choices for key in each.names)

    def by_button(self, number: int, /) -> str:
        """Key that a button stands for."""
        return self.keys[number - 1] if self.buttons and number <= len(self.keys) else ""

    def prompt(self) -> str:
        """Name the keys of each choice."""
        return "; ".join(each.words for each in self.choices)

    def right_of(self, picture: str, columns: dict[str, str], /) -> str:
        """Right answer about a picture, by the columns of the file of items."""
        return " ".join(picture if each.of is None else columns[each.of] for each in self.choices)

    def marked(self, text: str, before: Sequence[str | None] = ()) -> list[str | None]:
        """Names that a line gives, in the order of the choices, over those given before.

        Raises
        ------
        ValueError
            If the line has something else.
        """
        found = list(before) or [None] * len(self.choices)
        words = text.replace(",", " ").split()
        if not words:
            raise ValueError(f"nothing was typed; type {self.prompt()}")
        for word in words:
            known = any(word in (*one.names, *one.names.values()) for one in self.choices)
            for mark in (word,) if known else word:  # keys may stand without a blank between them
                for number, one in enumerate(self.choices):
                    name = one.names.get(mark, mark)
                    if name in one.names.values():
                        found[number] = name
                        break
                else:
                    raise ValueError(f"{quoted(word)}type {self.prompt()}")
        return found

    def missing(self, names: Sequence[str | None]) -> str:
        """Words for the keys of the first choice that has no name yet; empty if all have one."""
        return next((o.words for o, n in zip(self.choices, names, strict=True) if n is None), "")

    def parse(self, text: str, _trial: Trial, _spelling: CellSpelling, /) -> str:
        """Read keys or names, one for each choice, in any order."""
        names = self.marked(text)
        if missing := self.missing(names):
            raise ValueError(f"a name is missing; type one of {missing} as well")
        return " ".join(map(str, names))

    def outcome(self, trial: Trial, answer: str, /) -> str:
        """Right if all names are."""
        right = trial.stimuli[0].answer
        return "" if right is None else RIGHT if answer == right else WRONG

    def was(self, trial: Trial, _keys: dict[str, int], /) -> str:
        """Words for the right names."""
        return trial.stimuli[0].answer or ""

    def describe(self, _rows: Sequence[dict[str, Any]], _knob: str | None, /) -> str:
        """Sentence on the names."""
        many = " and ".join(str(len(each.names)) for each in self.choices)
        return f"Of each picture it was said which of {many} names it has"


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

    def check(self, stimuli: int, form: str, *, adaptive: bool) -> None:
        """Check that this question can be asked of trials; see `QuestionTable.check`."""
        super().check(stimuli, form, adaptive=adaptive)
        if not form:
            raise ValueError("kind is 'adjust', which turns values of kind = 'choice' of [design]")

    def steps(self, line: str) -> int:
        """Steps by which a typed line turns the value; 0 if it does not."""
        word = line.strip()
        return 0 if set(word) - {"+", "-"} else word.count("+") - word.count("-")

    def turned(self, value: float, steps: int) -> float:
        """Value turned by some steps, within the bounds."""
        return round(min(max(value + steps * self.step, self.least), self.most), 9)

    def at(self, share: float) -> float:
        """Value at which the knob stands, given the share of its way."""
        return self.turned(self.least, round(share * (self.most - self.least) / self.step))

    def parse(self, text: str, trial: Trial, _spelling: CellSpelling, /) -> str:
        """Take the value that the last stimulus has, or one that is typed as a number."""
        if text.strip().lower() in ("equal", "="):
            return f"{trial.stimuli[-1].value:.9g}"
        try:
            number = float(text.strip().replace(",", "."))
        except ValueError:
            number = math.nan
        if not self.least <= number <= self.most:
            raise ValueError(f"{quoted(text)}type {self.prompt()}")
        return f"{number:.9g}"

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
    forms: ClassVar[tuple[str, ...]] = ("passage",)
    words: ClassVar[tuple[str, ...]] = ("read", "broken off")
    typed: ClassVar[str] = "read, or broken off (r or b)"

    def check(self, stimuli: int, form: str, *, adaptive: bool) -> None:
        """Check that this question can be asked of trials; see `QuestionTable.check`."""
        super().check(stimuli, form, adaptive=adaptive)
        if form != "passage":
            raise ValueError("kind is 'read', which is asked of passages; give passage = true")

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
