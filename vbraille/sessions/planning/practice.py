"""Practice: trials before the first block, whose items the test does not show."""

from __future__ import annotations

from itertools import permutations

from vbraille.braille.spelling import to_braille
from vbraille.errors import check_range
from vbraille.sessions.planning.besides import check_file_name
from vbraille.sessions.planning.design import MOST_TRIALS, Choice, Combinations, Design, Item
from vbraille.sessions.planning.knobs import KNOBS
from vbraille.sessions.planning.spellings import Masks, WrittenText
from vbraille.toml.tomlfile import Table


class Practice(Table, frozen=True):
    """The table ``[practice]`` of a protocol: what is practised, and how often.

    Parameters
    ----------
    trials
        Number of practice trials.
    strings, values
        Items that practice shows: dot masks of the cells asked for, or values that are compared.
        Both are empty if there is no practice.
    file
        Name of a file beside the protocol that has the strings, as for ``[items]``; None if they
        are given here.
    feedback
        Whether it is said after each trial of practice whether the answer was right.

    Raises
    ------
    ValueError
        If the number of trials is out of range.
    """

    trials: int = 0
    strings: tuple[Masks, ...] = ()
    values: tuple[float, ...] = ()
    file: str | None = None
    feedback: bool = True

    def __post_init__(self) -> None:
        if self.file is not None:
            check_file_name(self.file, "file")
            if self.strings or self.values:
                raise ValueError("file has the strings; leave strings and values out")
        check_range("trials", self.trials, 0, MOST_TRIALS)

    @property
    def items(self) -> tuple[Item, ...]:
        """Items of practice: the strings, or all pairs of two different values in both orders."""
        return self.strings or tuple(permutations(self.values, 2))

    def lines(self, design: Design) -> list[tuple[int, ...]]:
        """Cells of all strings practised, with delimiters; empty if values are compared."""
        before, after = design.around
        return [(*before, *string, *after) for string in self.strings]

    def problem(self, design: Design) -> str:
        """Say why this practice does not go with a test of a design; empty if it does."""
        compares = isinstance(design, Choice)
        if self.strings if compares else self.values:
            given, wanted = ("strings", "values") if compares else ("values", "strings")
            return f"{given} are not of this kind of design; give {wanted} instead"
        if compares:
            shared = set(self.values) & {*design.values, design.reference}
            if shared:
                unit = KNOBS[design.parameter].unit
                return f"values have {min(shared):g}{unit}, which the test compares; give another"
            return ""
        for string, line in zip(self.strings, self.lines(design), strict=True):
            if not any(line):
                return "strings have one without dots, and nothing can be felt of it"
            if _is_shown(design, string):
                return f"strings have {name_item(string)}, which the test shows; give another"
        return ""


def name_item(item: Item) -> str:
    """Words for an item: its text in quotation marks, or its cells in Unicode braille."""
    if isinstance(item, WrittenText):
        return repr(str(item))
    return to_braille(map(int, item))


def _is_shown(design: Design, item: Item) -> bool:
    if isinstance(design, Combinations):
        return len(item) == design.length and set(item) <= set(design.characters)
    return design.content(item) in map(design.content, design.items())
