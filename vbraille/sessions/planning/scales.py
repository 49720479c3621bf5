"""Scales and numbers, by which questions are answered: their ends, their words, how one is read."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from vbraille.sessions.planning.pace import check_line
from vbraille.tomlfile import Table

if TYPE_CHECKING:
    from collections.abc import Mapping

_MOST_STEPS = 101
LARGEST = 1e9


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


def read_number(text: str, low: float, high: float, wanted: str) -> float:
    """Read a number, with a point or a comma in it.

    Raises
    ------
    ValueError
        If the text is none, or it is out of its bounds; the sentence says what is wanted.
    """
    try:
        number = float(text.strip().replace(",", "."))
    except ValueError:
        number = math.nan
    if not low <= number <= high:
        raise ValueError(f"{quoted(text)}type {wanted}")
    return number


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

    def split(self, line: str, keys: Mapping[str, int]) -> tuple[str, int | None]:
        """Part a line into an answer and the confidence after a semicolon; None if it has none."""
        answer, semicolon, rest = line.rpartition(";")
        if not semicolon or ";" in keys or not is_whole(rest.strip()):
            return line, None
        return answer.strip(), self.parse(rest)
