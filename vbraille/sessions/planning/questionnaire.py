"""The tables ``[[questionnaire]]`` of a protocol: what people are asked beside the trials.

A class for each kind reads the answers. Questions are asked at the beginning, beside the answer to
each trial, after each block, or at the end.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, Literal

from vbraille.errors import check_range
from vbraille.sessions.planning.pace import LONGEST_LINE, check_line, check_name
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
from vbraille.tomlfile import Table

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping

    import numpy as np


class _Item(Table, frozen=True, kw_only=True, tag_field="kind"):
    """Common part of the questions of every kind.

    Parameters
    ----------
    name
        Name of the question; its answers are in the column ``asked_NAME`` of tables.
    when
        Time at which it is asked: at the "begin" of the session, after the answer to each "trial"
        of the test that is no catch trial, after each "block", or at the "end".
    ask
        The question in words. A name in braces, of a question beside a trial, stands for that
        column of the trial's item, as in ``"{question}"``.
    right
        Right answer, which may be such a column too; the column ``asked_NAME_correct`` says if it
        was given. Empty if no answer is right or wrong.

    Raises
    ------
    ValueError
        If the name or the words cannot be used.
    """

    words_only: ClassVar[bool] = False  # whether an answer may hold anything

    name: str
    when: Literal["begin", "trial", "block", "end"]
    ask: str
    right: str = ""

    def __post_init__(self) -> None:
        check_name("name", self.name)
        check_line("ask", self.ask)

    @property
    def texts(self) -> tuple[str, ...]:
        """Texts in which a column of an item may stand."""
        return self.ask, self.right

    def check(self, columns: Collection[str]) -> None:
        """Check that the columns which it names are there.

        Raises
        ------
        ValueError
            If one is not, or the right answer is none.
        """
        given = {} if self.when != "trial" else dict.fromkeys(columns, "x")
        try:
            for text in self.texts:
                text.format(**given)
        except (KeyError, IndexError, ValueError, AttributeError) as error:
            why = f"; there is {', '.join(given)}" if given else ", and it has no items here"
            raise ValueError(f"ask names {error} in braces, which is no column{why}") from None
        if self.right and not any("{" in text for text in self.texts):
            self.parse(self.right, {})

    def asked(self, columns: Mapping[str, str]) -> str:
        """Words of the question, with what may be typed; ``columns`` are those of the item."""
        return f"{self.ask.format(**columns)} ({self.prompt(columns)})"

    def prompt(self, _columns: Mapping[str, str], /) -> str:
        """Say what may be typed as an answer."""
        raise NotImplementedError

    def parse(self, text: str, _columns: Mapping[str, str], /) -> str:
        """Read an answer, and bring it into the form in which it is kept.

        Raises
        ------
        ValueError
            If the text is no answer to the question.
        """
        raise NotImplementedError

    def good(self, answer: str, columns: Mapping[str, str]) -> bool | None:
        """True if an answer is right; None if no answer is right or wrong."""
        right = self.right.format(**columns)
        if not right:
            return None
        return answer.casefold() == self.parse(right, columns).casefold()

    def simulate(
        self, columns: Mapping[str, str], noise: float, random: np.random.Generator
    ) -> str:
        """Answer for the simulated reader, who knows what is right unless noise is in the way."""
        right = self.right.format(**columns)
        if right and float(random.random()) >= min(noise, 1.0) / 2:
            return right
        return self.guess(columns, random)

    def guess(self, _columns: Mapping[str, str], _random: np.random.Generator, /) -> str:
        """Answer at random."""
        raise NotImplementedError


class ChoiceItem(_Item, frozen=True, kw_only=True, tag="choice"):
    """A question with a few answers, of which one is typed: its number or its words.

    Parameters
    ----------
    choices
        The answers; a column of the trial's item may stand in one, as in the question.

    Raises
    ------
    ValueError
        If there are fewer than two, or one is given twice.
    """

    choices: tuple[str, ...]

    def __post_init__(self) -> None:
        super().__post_init__()
        if len(set(self.choices)) < max(2, len(self.choices)):
            raise ValueError("choices must be two or more, each another; add one")
        for choice in self.choices:
            check_line("choices: one", choice)

    @property
    def texts(self) -> tuple[str, ...]:
        """Texts in which a column of an item may stand."""
        return self.ask, self.right, *self.choices

    def prompt(self, columns: Mapping[str, str], /) -> str:
        """Name the answers with their numbers."""
        choices = enumerate(self.choices, 1)
        return ", ".join(f"{number} {choice.format(**columns)}" for number, choice in choices)

    def parse(self, text: str, columns: Mapping[str, str], /) -> str:
        """Read one of the answers, by its words or its number."""
        choices, word = [choice.format(**columns) for choice in self.choices], text.strip()
        for number, choice in enumerate(choices, 1):
            if word.casefold() == choice.casefold():
                return choice
            if word == f"{number}" and word not in choices:
                return choice
        raise ValueError(f"{quoted(text)}type a number, {self.prompt(columns)}")

    def guess(self, columns: Mapping[str, str], random: np.random.Generator, /) -> str:
        """Choose any."""
        return self.choices[int(random.integers(len(self.choices)))].format(**columns)


class NumberItem(_Item, frozen=True, kw_only=True, tag="number"):
    """A question that is answered by a number.

    Parameters
    ----------
    least, most
        Bounds of the answer; None for none.

    Raises
    ------
    ValueError
        If no number is between the bounds.
    """

    least: float | None = None
    most: float | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        for name in ("least", "most"):
            check_range(name, getattr(self, name), -LARGEST, LARGEST)
        if self.least is not None and self.most is not None and self.least >= self.most:
            raise ValueError("least is not below most, so that nothing can be answered; change one")

    def prompt(self, _columns: Mapping[str, str], /) -> str:
        """Say which numbers may be typed."""
        bounds = ((self.least, "from"), (self.most, "to"))
        return " ".join(["a number", *(f"{w} {n:g}" for n, w in bounds if n is not None)])

    def parse(self, text: str, _columns: Mapping[str, str], /) -> str:
        """Read a number, with a point or a comma in it."""
        low = -LARGEST if self.least is None else self.least
        high = LARGEST if self.most is None else self.most
        return f"{read_number(text, low, high, self.prompt({})):.15g}"

    def guess(self, _columns: Mapping[str, str], random: np.random.Generator, /) -> str:
        """Give any number between the bounds."""
        low = 0.0 if self.least is None else self.least
        high = low + 100 if self.most is None else self.most
        return f"{low + (high - low) * float(random.random()):.3g}"


class TextItem(_Item, frozen=True, kw_only=True, tag="text"):
    """A question that is answered by a line of words."""

    words_only: ClassVar[bool] = True

    def prompt(self, _columns: Mapping[str, str], /) -> str:
        """Ask for words."""
        return "a line of words; - for none"

    def parse(self, text: str, _columns: Mapping[str, str], /) -> str:
        """Read any line of text that is not empty."""
        answer = text.strip()
        if not answer or not answer.isprintable() or len(answer) > 10 * LONGEST_LINE:
            raise ValueError(f"type a line of 1 to {10 * LONGEST_LINE} characters")
        return answer

    def guess(self, _columns: Mapping[str, str], _random: np.random.Generator, /) -> str:
        """Say nothing."""
        return "-"


class RatingItem(_Item, frozen=True, kw_only=True, tag="rating"):
    """A question that is answered on a scale of whole numbers.

    Parameters
    ----------
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

    least: int
    most: int
    labels: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        super().__post_init__()
        check_scale(self.least, self.most)
        check_labels(self.labels, self.least, self.most)

    def prompt(self, _columns: Mapping[str, str], /) -> str:
        """Name the numbers of the scale, with the labels of its ends."""
        return say_scale(self.least, self.most, labels_of(self.labels, self.least, self.most))

    def parse(self, text: str, _columns: Mapping[str, str], /) -> str:
        """Read a step of the scale: its number, or its label."""
        named = labels_of(self.labels, self.least, self.most)
        return str(read_label(text, self.least, self.most, named))

    def guess(self, _columns: Mapping[str, str], random: np.random.Generator, /) -> str:
        """Give any step."""
        return str(int(random.integers(self.least, self.most + 1)))


AnyItem = ChoiceItem | NumberItem | TextItem | RatingItem
