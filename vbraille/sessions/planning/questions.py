"""The table ``[question]`` of a protocol: what is asked of a trial, a class for each kind.

Without the table, a string is to be identified, and of two stimuli one is to be chosen.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar, Literal

from vbraille.braille.spelling import UNREAD, parse_answer, parse_choice, say_cells, to_braille
from vbraille.errors import check_range
from vbraille.sessions.planning.conduct import LONGEST_LINE, check_line
from vbraille.sessions.planning.spellings import parse_text
from vbraille.tomlfile import Table

if TYPE_CHECKING:
    from collections.abc import Mapping

    from vbraille.sessions.planning.stimuli import Trial


RIGHT, WRONG = "right", "wrong"
HIT, MISS, FALSE_ALARM, REJECTION = "hit", "miss", "false alarm", "correct rejection"
GOOD = frozenset((RIGHT, HIT, REJECTION))  # outcomes of right answers
_MOST_STEPS = 101
LARGEST = 1e9


@dataclass(frozen=True, slots=True)
class CellSpelling:
    """How cells may be typed in answers.

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
    """The scale on which somebody says how sure an answer is.

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
        """What may be typed, in words for people."""
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
    """What questions of every kind have in common.

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
    positive_known: ClassVar[bool] = False  # whether a procedure can go by the answers

    ask: str = ""
    confidence: ConfidenceScale | None = None

    def __post_init__(self) -> None:
        if self.ask:
            check_line("ask", self.ask)

    @property
    def name(self) -> str:
        """Name of the kind in tables."""
        return str(self.__struct_config__.tag)

    @property
    def typed(self) -> str:
        """What may be typed as an answer, in words for people."""
        return "the answer"

    def problem(self, stimuli: int, *, adaptive: bool) -> str:
        """Say why this question cannot be asked of trials; empty if it can.

        Parameters
        ----------
        stimuli
            Number of stimuli in a trial, 1 or 2.
        adaptive
            Whether the answers choose what is shown.
        """
        if stimuli not in self.stimuli:
            wanted, given = ("two stimuli", "one") if stimuli == 1 else ("one stimulus", "two")
            return (
                f"kind is {self.name!r}, which is asked of {wanted}, and each trial of [design] "
                f"has {given}; choose another kind of question or of design"
            )
        if adaptive and not self.positive_known:
            return (
                f"kind is {self.name!r}, whose answers cannot choose what is shown next; leave "
                f"[procedure] out, or ask something else"
            )
        return ""

    def positive(self, trial: Trial, answer: str, /) -> bool:
        """Whether an answer counts as a positive one for a procedure."""
        return self.good(trial, answer)

    def outcome(self, _trial: Trial, _answer: str, /) -> str:
        """How an answer is scored, such as "right" or "hit"; empty if it is not."""
        return ""

    def good(self, trial: Trial, answer: str, /) -> bool:
        """Whether an answer is right."""
        return self.outcome(trial, answer) in GOOD

    def was(self, _trial: Trial, _keys: Mapping[str, int], /) -> str:
        """Words for what is right, for practice; empty if nothing is."""
        return ""

    def parse(self, text: str, trial: Trial, spelling: CellSpelling, /) -> str:
        """Read an answer, and bring it into the spelling in which it is kept.

        Raises
        ------
        ValueError
            If the text is no answer to the question.
        """
        raise NotImplementedError

    def said(self, answer: str, _keys: dict[str, int], /) -> str:
        """Words for an answer."""
        return answer

    def cell(self, _trial: Trial, answer: str, /) -> str:
        """Text for an answer in tables."""
        return answer


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
    """Whether a word is a whole number."""
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

    def outcome(self, trial: Trial, answer: str, /) -> str:
        """Right if all cells are; of a blank catch trial, if no dot was felt."""
        if trial.catch == "blank":
            return RIGHT if set(answer) <= {UNREAD, to_braille((0,))} else WRONG
        return RIGHT if answer == trial.presented else WRONG

    def was(self, trial: Trial, keys: Mapping[str, int], /) -> str:
        """Words for the cells, or the text that they stand for."""
        return trial.stimuli[0].text or self.said(trial.presented, dict(keys))

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


class WhichQuestion(QuestionTable, frozen=True, kw_only=True, tag="which"):
    """The question which of two stimuli it was: the one with more, or the one nearer to something.

    Parameters
    ----------
    right
        Which of two values is right; None if it is what somebody likes, and nothing is right.
    reference
        Value that the nearest one is nearest to.

    Raises
    ------
    ValueError
        If a reference is missing, or is given and not used.
    """

    positive_known: ClassVar[bool] = True
    stimuli: ClassVar[tuple[int, ...]] = (2,)

    right: Literal["more", "less", "nearest"] | None = None
    reference: float | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        check_range("reference", self.reference, -LARGEST, LARGEST)
        if (self.right == "nearest") != (self.reference is not None):
            raise ValueError(
                "right = 'nearest' and reference go together; give both, or neither of them"
            )

    @property
    def typed(self) -> str:
        """What may be typed: 1 or 2."""
        return "1 or 2, for the first or the second"

    def right_one(self, trial: Trial) -> str:
        """Right answer, "1" or "2"; empty if there is none."""
        values = [stimulus.value for stimulus in trial.stimuli]
        if self.right is None or None in values:
            return ""
        first, second = (self.worth(value or 0.0) for value in values)
        if first == second:
            return ""
        return "1" if first > second else "2"

    def worth(self, value: float) -> float:
        """Number that is the higher, the more right a value is."""
        if self.right == "nearest":
            return -abs(value - (self.reference or 0.0))
        return value if self.right == "more" else -value

    def outcome(self, trial: Trial, answer: str, /) -> str:
        """Right or wrong, if one of the two is right."""
        right = self.right_one(trial)
        return "" if not right else RIGHT if answer == right else WRONG

    def was(self, trial: Trial, _keys: Mapping[str, int], /) -> str:
        """Words for the right one of two."""
        right = self.right_one(trial)
        return self.said(right, {}) if right else ""

    def parse(self, text: str, _trial: Trial, _spelling: CellSpelling, /) -> str:
        """Read a choice; see `vbraille.braille.spelling.parse_choice`."""
        return parse_choice(text)

    def said(self, answer: str, _keys: dict[str, int], /) -> str:
        """Words for the one that was chosen."""
        return "first" if answer == "1" else "second"

    def cell(self, trial: Trial, answer: str, /) -> str:
        """Value that was chosen."""
        return f"{trial.stimuli[int(answer) - 1].value:g}"


class _OneOfTwo(QuestionTable, frozen=True, kw_only=True):
    """A question that is answered by one of two words, of which the first is what is looked for."""

    words: ClassVar[tuple[str, str]]

    @property
    def typed(self) -> str:
        """What may be typed: one of the two words, or the letter that it begins with."""
        first, second = self.words
        return f"{first} or {second} ({first[0]} or {second[0]})"

    def looked_for(self, trial: Trial) -> bool:
        """Whether the trial has what is looked for."""
        raise NotImplementedError

    def outcome(self, trial: Trial, answer: str, /) -> str:
        """Hit or miss, or without what is looked for, false alarm or correct rejection."""
        said = answer == self.words[0]
        if self.looked_for(trial):
            return HIT if said else MISS
        return FALSE_ALARM if said else REJECTION

    def parse(self, text: str, _trial: Trial, _spelling: CellSpelling, /) -> str:
        """Read one of the two words, in either case, or its first letter."""
        word = text.strip().lower()
        for known in self.words:
            if word in (known, known[0]):
                return known
        raise ValueError(f"{quoted(text)}type {self.words[0]} or {self.words[1]}")


class SameQuestion(_OneOfTwo, frozen=True, kw_only=True, tag="same-different"):
    """The question whether two stimuli were different or the same."""

    stimuli: ClassVar[tuple[int, ...]] = (2,)
    words: ClassVar[tuple[str, str]] = (DIFFERENT, SAME)

    def looked_for(self, trial: Trial) -> bool:
        """Whether the two differ in anything."""
        return trial.stimuli[0] != trial.stimuli[1]

    def was(self, trial: Trial, _keys: Mapping[str, int], /) -> str:
        """Words for what the two were."""
        return DIFFERENT if self.looked_for(trial) else SAME


class DetectQuestion(_OneOfTwo, frozen=True, kw_only=True, tag="detect"):
    """The question whether there was anything: a cell with dots, and some contrast to feel it."""

    positive_known: ClassVar[bool] = True
    stimuli: ClassVar[tuple[int, ...]] = (1,)
    words: ClassVar[tuple[str, str]] = (YES, NO)

    def positive(self, _trial: Trial, answer: str, /) -> bool:
        """Whether the answer is yes."""
        return answer == YES

    def looked_for(self, trial: Trial) -> bool:
        """Whether there was anything to be felt in the cells asked for."""
        (stimulus,) = trial.stimuli
        return stimulus.tuning.contrast > 0 and any(stimulus.masks[slice(*trial.asked)])

    def was(self, trial: Trial, _keys: Mapping[str, int], /) -> str:
        """Words for what there was."""
        return "something" if self.looked_for(trial) else "nothing"


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

    scale: str
    least: int
    most: int
    labels: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        super().__post_init__()
        check_line("scale", self.scale)
        check_scale(self.least, self.most)
        steps = self.most - self.least + 1
        if len(self.labels) not in (0, 2, steps):
            raise ValueError(
                f"labels are {len(self.labels)}; give 2 for the ends of the scale, "
                f"{steps} for all its steps, or none"
            )
        known: set[str] = set()
        for label in self.labels:
            check_line("labels: one", label)
            if label.strip().lower() in known:
                raise ValueError(f"labels have {label!r} twice; give each step its own")
            if is_whole(label.strip()):
                raise ValueError(f"labels have {label!r}, which is a number; give words")
            known.add(label.strip().lower())

    @property
    def named(self) -> dict[int, str]:
        """Labels of the steps that have one."""
        if len(self.labels) == 2:
            return dict(zip((self.least, self.most), self.labels, strict=True))
        return dict(enumerate(self.labels, self.least))

    @property
    def typed(self) -> str:
        """What may be typed: the numbers of the scale."""
        named = self.named
        if not named:
            return f"{self.least} to {self.most} for {self.scale}"
        ends = f"{self.least} is {named[self.least]}, {self.most} is {named[self.most]}"
        return f"{self.least} to {self.most} for {self.scale}: {ends}"

    def parse(self, text: str, _trial: Trial, _spelling: CellSpelling, /) -> str:
        """Read a step of the scale: its number, or its label."""
        for step, label in self.named.items():
            if text.strip().lower() == label.strip().lower():
                return str(step)
        return str(read_step(text, self.least, self.most))

    def said(self, answer: str, _keys: dict[str, int], /) -> str:
        """Words for a step: its number, and its label if it has one."""
        label = self.named.get(int(answer), "")
        return f"{answer}, {label}" if label else answer


class MagnitudeQuestion(QuestionTable, frozen=True, kw_only=True, tag="magnitude"):
    """The question how strong something is, as a positive number.

    Parameters
    ----------
    modulus
        Number that the participant is told for the first or a standard stimulus; None if
        everybody chooses.

    Raises
    ------
    ValueError
        If the modulus is not a positive number.
    """

    modulus: float | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.modulus is not None and not 0 < self.modulus <= LARGEST:
            raise ValueError(f"modulus is {self.modulus:g}; it must be a number above 0")

    @property
    def typed(self) -> str:
        """What may be typed: a number above 0."""
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


class FreeQuestion(QuestionTable, frozen=True, kw_only=True, tag="free"):
    """A question that is answered in words, which nobody scores."""

    @property
    def typed(self) -> str:
        """What may be typed: any words."""
        return "the answer in words"

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
    | SameQuestion
    | DetectQuestion
    | RatingQuestion
    | MagnitudeQuestion
    | FreeQuestion
)


def usual_question(stimuli: int) -> AnyQuestion:
    """Question of a protocol without the table, for trials with one stimulus or two."""
    return WhichQuestion() if stimuli == 2 else IdentifyQuestion()
