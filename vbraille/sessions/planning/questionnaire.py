"""Questions beside the trials: before the first, after each, after each block, and at the end."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from typing import Literal

from msgspec import structs

from vbraille.sessions.planning.questions import Scale, choose, parse_number
from vbraille.sessions.planning.trial import Trial
from vbraille.sessions.planning.values import Label, Number, Sentence
from vbraille.toml import Table, WrongValue

COLUMN = re.compile(r"\{(\w[\w-]*)\}")


class Item(Table, frozen=True, kw_only=True):
    """A question of the questionnaire.

    Parameters
    ----------
    kind
        Whether the answer is one of the choices, a number, a step of a scale, or any words.
    name
        Name of its column.
    when
        When it is asked: at the "begin", after each "trial" or "block", or at the "end".
    ask
        The question in words. In it, in choices and in right, {NAME} stands for that column of the
        file of items, if it is asked after a trial.
    choices
        Answers to choose from.
    least, most
        Bounds of a number, or ends of a scale.
    labels
        Words for the steps of a scale, or for its two ends.
    right
        The right answer; empty if none is.
    """

    kind: Literal["choice", "number", "rating", "text"]
    name: Label
    when: Literal["begin", "trial", "block", "end"]
    ask: Sentence
    choices: tuple[Sentence, ...] = ()
    least: Number | None = None
    most: Number | None = None
    labels: tuple[Sentence, ...] = ()
    right: str = ""

    def __post_init__(self) -> None:
        if (self.kind == "choice") != (len(self.choices) > 1):
            raise WrongValue("choices", "two or more are for kind = 'choice', which needs them")
        if self.kind == "rating":
            if self.least is None or self.most is None:
                raise WrongValue("kind", "is 'rating'; give the ends of the scale, least and most")
            self._scale  # noqa: B018  (it checks itself)
        fixed = not any(COLUMN.search(each) for each in (self.right, *self.choices))
        if self.right and fixed and self.choices and self.right not in self.choices:
            raise WrongValue("right", f"{self.right!r} is not one of choices")

    @property
    def _scale(self) -> Scale:
        return Scale(least=int(self.least or 0), most=int(self.most or 0), labels=self.labels)

    @property
    def columns(self) -> set[str]:
        """Columns of the file of items that it names."""
        return {
            name for each in (self.ask, self.right, *self.choices) for name in COLUMN.findall(each)
        }

    def of(self, columns: dict[str, str]) -> Item:
        """Return the question about an item, with its columns filled in."""

        def filled(text: str) -> str:
            return COLUMN.sub(lambda found: columns.get(found[1], ""), text)

        choices = tuple(map(filled, self.choices))
        return structs.replace(
            self, ask=filled(self.ask), choices=choices, right=filled(self.right)
        )

    @property
    def typed(self) -> str:
        """Words for what may be typed."""
        match self.kind:
            case "choice":
                return " or ".join(self.choices)
            case "rating":
                return self._scale.typed
            case "number":
                least = "" if self.least is None else f" from {self.least:g}"
                return f"a number{least}" + ("" if self.most is None else f" to {self.most:g}")
        return "an answer"

    def parse(self, text: str) -> str:
        """Read a reply; ValueError if the text is none."""
        match self.kind:
            case "choice":
                return choose(text, {each.casefold(): each for each in self.choices}, self.typed)
            case "rating":
                return str(self._scale.parse(text))
            case "number":
                least = -math.inf if self.least is None else self.least
                most = math.inf if self.most is None else self.most
                return parse_number(text, least, most, self.typed)
        if not text.strip():
            raise ValueError("nothing was typed; type an answer")
        return text.strip()

    def simulate(self) -> str:
        """Give the right answer, or the first that there may be."""
        number = f"{self.most or 0 if self.least is None else self.least:g}"
        return self.right or next(iter(self.choices), number)


def due(
    items: tuple[Item, ...], last: Trial | None, coming: Trial | None
) -> Iterator[tuple[Item, int]]:
    """Go through what is asked now, each with the number of its trial or block.

    Parameters
    ----------
    items
        The questionnaire.
    last, coming
        The last trial that is over, practice left out, and the next one; None if there is none.
    """
    whens = {"begin": 0}
    if last is not None:
        if not last.catch:
            whens["trial"] = last.number
        if coming is None or coming.block != last.block:
            whens["block"] = last.block
    if coming is None:
        whens["end"] = 0
    for item in items:
        if item.when in whens:
            columns = last.columns if last is not None and item.when == "trial" else {}
            yield (item.of(columns) if columns else item), whens[item.when]
