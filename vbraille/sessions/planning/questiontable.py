"""Common part of the kinds of questions: how each is checked, read, scored, said and simulated."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

from vbraille.sessions.planning.pace import check_line
from vbraille.sessions.planning.scales import ConfidenceScale
from vbraille.sessions.planning.stimuli import said_value
from vbraille.tomlfile import Table

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    import numpy as np

    from vbraille.sessions.planning.design import Design
    from vbraille.sessions.planning.stimuli import Trial
    from vbraille.sessions.simulated.feeling import FeltTrial

RIGHT, WRONG = "right", "wrong"
HIT, MISS, FALSE_ALARM, REJECTION = "hit", "miss", "false alarm", "correct rejection"
GOOD = frozenset((RIGHT, HIT, REJECTION))  # outcomes of right answers
_NUMBERS = ("", "one", "two", "three", "four", "five")


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
    asked_of: ClassVar[str] = ""  # "cells" or "pictures" if it is asked of these alone
    of_equals: ClassVar[bool] = False  # whether two stimuli may be the same by the design
    of_catch: ClassVar[bool] = False  # whether catch trials are what it asks about

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

    def check(self, design: Design, *, passages: bool, pictures: bool, adaptive: bool) -> None:
        """Check that this question can be asked of the trials of a design.

        Parameters
        ----------
        design
            The design.
        passages, pictures
            Whether trials show passages, or pictures.
        adaptive
            Whether the answers choose what is shown.

        Raises
        ------
        ValueError
            If it cannot.
        """
        stimuli = getattr(design, "stimuli", 1)
        if stimuli not in self.stimuli:
            more = " or more" if len(self.stimuli) > 1 else ""
            fewest = min(self.stimuli)
            wanted = "one stimulus" if fewest == 1 else f"{_NUMBERS[fewest]} stimuli{more}"
            given = _NUMBERS[stimuli]
            raise ValueError(
                f"[question] kind is {self.name!r}, which is asked of {wanted}, and each trial of "
                f"[design] has {given}; choose another kind of question or of design"
            )
        form = "passages" if passages else getattr(design, "form", "strings")
        if self.forms and form not in self.forms:
            raise ValueError(
                f"[question] kind is {self.name!r}, which is asked of {_of_forms(self.forms)}, and "
                f"[design] has {_of_forms((form,))}; choose another"
            )
        if adaptive and not self.positive_known:
            raise ValueError(
                f"[question] kind is {self.name!r}, whose answers cannot choose what is shown "
                f"next; leave [procedure] out, or ask something else"
            )
        if self.asked_of == "pictures" and not pictures:
            raise ValueError(
                f"[question] kind is {self.name!r}, which is asked of pictures; give a scene"
            )
        if getattr(design, "same", 0) and (adaptive or not self.of_equals):
            raise ValueError(
                "[design] same is of [question] kind = 'same-different' in a fixed order; leave "
                "it out"
            )

    def check_items(self, _columns: Sequence[str], _rows: Sequence[Mapping[str, str]], /) -> None:
        """Check that the columns of the file of items which it names are there.

        Parameters
        ----------
        columns, rows
            Names of the columns, and the cells of each item by column.

        Raises
        ------
        ValueError
            If one is not, or has what cannot be answered.
        """

    def unfelt(self, parameter: str, *, pairs: bool) -> str:  # noqa: ARG002
        """Reason why the simulated reader cannot answer, as the end of a sentence; empty if it can.

        Parameters
        ----------
        parameter
            What stimuli are compared by; empty if strings are read.
        pairs
            Whether each value is compared with each other one.
        """
        if self.simulated and not (pairs and 1 in self.stimuli):
            return ""
        of = f"asks a question of the kind {self.name!r}"
        return f"{of}, which the simulated reader cannot answer"

    def help(self, _keys: dict[str, int], _written: bool, /) -> str:
        """Say at the console what may be typed, where strings are written in print or in cells."""
        return self.prompt()

    def right_of(self, _picture: str, _columns: dict[str, str], /) -> str | None:
        """Right answer about a picture, by the columns of the file of items; None if none is."""
        return None

    def by_button(self, _number: int, /) -> str:
        """Line that a button of the device stands for; empty if it stands for none."""
        return ""

    def by_knob(self, _number: int, _share: float, /) -> float | None:
        """Value that a knob of the device turns to, by the share of its way; None for none."""
        return None

    def steps(self, _line: str, /) -> int | None:
        """Steps by which a line turns the value, 0 to show the standard again; None if neither."""
        return None

    def turned(self, value: float, _steps: int, /) -> float:
        """Value turned by some steps."""
        return value

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


def _of_forms(forms: Sequence[str]) -> str:
    """Words for forms of trials."""
    plain = [form for form in forms if form in ("strings", "passages")]
    chosen = " or ".join(repr(form) for form in forms if form not in plain)
    return " or ".join([*plain, *([f"form = {chosen}"] if chosen else [])])
