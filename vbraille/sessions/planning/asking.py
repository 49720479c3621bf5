"""What questions of every kind have in common: their words, confidence, and how a scale is typed.

An answer is kept in one spelling, whichever of several was typed.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

from vbraille.sessions.planning.conduct import check_line
from vbraille.toml.tomlfile import Table

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

    name: ClassVar[str]  # name of the kind in tables
    stimuli: ClassVar[tuple[int, ...]] = (1, 2)  # how many stimuli a trial may have

    ask: str = ""
    confidence: ConfidenceScale | None = None

    def __post_init__(self) -> None:
        if self.ask:
            check_line("ask", self.ask)

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

    @property
    def positive_known(self) -> bool:
        """Whether a procedure can go by the answers."""
        return False

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
