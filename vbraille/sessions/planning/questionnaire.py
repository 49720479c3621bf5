"""Questions beside the trials: before the first, after each, after each block, and at the end."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

from vbraille.sessions.planning.questions import Scale
from vbraille.sessions.planning.trial import Trial
from vbraille.sessions.planning.values import Label, Sentence
from vbraille.toml import Table, WrongValue


class Item(Table, kw_only=True):
    """A question of the questionnaire.

    Parameters
    ----------
    name
        Name of its column.
    ask
        The question in words.
    when
        When it is asked: at the "begin", after each "trial" or "block", or at the "end".
    choices, scale
        Answers to choose from, or the scale; neither for any text.
    right
        The right answer; empty if none is.
    """

    name: Label
    ask: Sentence
    when: Literal["begin", "trial", "block", "end"]
    choices: tuple[str, ...] = ()
    scale: Scale | None = None
    right: str = ""

    def __post_init__(self) -> None:
        if self.choices and self.scale is not None:
            raise WrongValue("scale", "there are choices; give one of the two")
        if self.right and self.choices and self.right not in self.choices:
            raise WrongValue("right", f"{self.right!r} is not one of choices")

    @property
    def typed(self) -> str:
        """What may be typed."""
        if self.scale is not None:
            return f"{self.scale.least} to {self.scale.most}"
        return " or ".join(self.choices) or "an answer"

    def parse(self, text: str) -> str:
        """Read a reply; ValueError if the text is none."""
        if self.scale is not None:
            return str(self.scale.parse(text))
        word = text.strip()
        for choice in self.choices:
            if word.casefold() == choice.casefold():
                return choice
        if self.choices or not word:
            raise ValueError(f"{word!r} is not an answer; type {self.typed}")
        return word


def due(items: tuple[Item, ...], trials: list[Trial], done: int) -> Iterator[tuple[Item, int]]:
    """Go through what is asked now, each with the number of its trial or block.

    Parameters
    ----------
    items
        The questionnaire.
    trials
        All trials but practice.
    done
        How many of them have answers.
    """
    whens = {"begin": 0}
    if done:
        last = trials[done - 1]
        if not last.catch:
            whens["trial"] = last.number
        if done == len(trials) or trials[done].block != last.block:
            whens["block"] = last.block
    if done == len(trials):
        whens["end"] = 0
    for item in items:
        if item.when in whens:
            yield item, whens[item.when]
