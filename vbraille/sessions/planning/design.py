"""Designs: what is shown in each condition of a session, how often, and in which blocks."""

from __future__ import annotations

from collections import Counter
from itertools import permutations, product
from typing import TYPE_CHECKING, Literal

from vbraille.braille.spelling import name_dots
from vbraille.errors import check_range
from vbraille.sessions.planning.knobs import KNOBS, KnobName
from vbraille.sessions.planning.ordering import Catch
from vbraille.sessions.planning.spellings import Mask, Masks
from vbraille.toml.tomlfile import Table

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from vbraille.sessions.planning.knobs import StimulusKnob

MOST_TRIALS = 10_000
UNFELT = ("row_spacing_mm", "line_pitch_mm")  # lengths that change nothing in a single line

# Dot masks of the cells asked for, or the values compared, or a `WrittenText`.
Item = tuple[float, ...]

_LEFT_DOTS, _RIGHT_DOTS = 0b01000111, 0b10111000


class _Design(Table, frozen=True, kw_only=True, tag_field="kind"):
    """What designs of every kind have in common.

    Parameters
    ----------
    repeats
        How often each item is shown in each condition.
    blocks
        Number of blocks, over which the mixed conditions are spread; or "conditions" if each
        condition has a block of its own.
    order
        Order of the blocks of conditions: "balanced" over participants, "listed" or "shuffled";
        None if the file does not say it.
    catch
        Trials that keep watch over the participant; None for none.

    Raises
    ------
    ValueError
        If a number is out of range, or an order is given though conditions have no blocks.
    """

    repeats: int = 1
    blocks: int | Literal["conditions"] = "conditions"
    order: Literal["balanced", "listed", "shuffled"] | None = None
    catch: Catch | None = None

    def __post_init__(self) -> None:
        check_range("repeats", self.repeats, 1, MOST_TRIALS)
        if self.order is not None and self.blocks != "conditions":
            raise ValueError(
                "order is of a block each condition; leave it out, or give blocks = 'conditions'"
            )

    @property
    def around(self) -> tuple[Masks, Masks]:
        """Dot masks of the delimiters before and after the cells asked for."""
        return Masks(), Masks()

    def content(self, item: Item) -> Item:
        """What an item shows; equal for two items that count as showing the same."""
        return item


class Combinations(_Design, frozen=True, tag="combinations"):
    """A design that shows every combination of some cells.

    Parameters
    ----------
    characters
        Dot masks of the cells.
    length
        Number of cells in a combination.
    before, after
        Dot masks of the delimiters, which are shown but not asked for.

    Raises
    ------
    ValueError
        If a number is out of range, a cell is given twice, or a combination would have no dots.
    """

    characters: tuple[Mask, ...]
    length: int
    before: Masks = Masks()
    after: Masks = Masks()

    def __post_init__(self) -> None:
        super().__post_init__()
        check_range("length", self.length, 1, 100)
        if not self.characters:
            raise ValueError("characters are none; give one or more")
        _check_distinct("characters have", map(name_dots, self.characters))
        if 0 in self.characters and not any(self.before + self.after):
            raise ValueError(
                "characters have a blank, and nothing can be felt of a combination of blanks; "
                "give before and after"
            )

    @property
    def around(self) -> tuple[Masks, Masks]:
        """Dot masks of the delimiters before and after the cells asked for."""
        return self.before, self.after

    @property
    def trials(self) -> int:
        """Number of trials in each condition."""
        return len(self.characters) ** self.length * self.repeats

    @property
    def cells(self) -> int:
        """Number of cells in the longest line."""
        return len(self.before) + self.length + len(self.after)

    @property
    def masks(self) -> frozenset[int]:
        """Dot masks of all cells that are shown."""
        return frozenset(self.before + self.characters + self.after)

    def items(self) -> Sequence[Item]:
        """Cells asked for in the trials of a condition, in the order of the design."""
        return list(product(self.characters, repeat=self.length)) * self.repeats


class StringList(_Design, frozen=True, tag="list"):
    """A design that shows the strings of a list.

    Parameters
    ----------
    strings
        Dot masks of the strings.
    reorder
        Whether the cells of a string are shown in another order each time.

    Raises
    ------
    ValueError
        If a number is out of range, or a string has no dots.
    """

    strings: tuple[Masks, ...]
    reorder: bool = False

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.strings:
            raise ValueError("strings are none; give one or more")
        for number, masks in enumerate(self.strings, 1):
            if not any(masks):
                raise ValueError(
                    f"strings, number {number}, has no dots, and nothing can be felt of it; "
                    f"give it a cell with some"
                )

    @property
    def trials(self) -> int:
        """Number of trials in each condition."""
        return len(self.strings) * self.repeats

    @property
    def cells(self) -> int:
        """Number of cells in the longest line."""
        return max(map(len, self.strings))

    @property
    def masks(self) -> frozenset[int]:
        """Dot masks of all cells that are shown."""
        return frozenset(mask for masks in self.strings for mask in masks)

    def items(self) -> Sequence[tuple[int, ...]]:
        """Cells asked for in the trials of a condition, in the order of the design."""
        return list(self.strings) * self.repeats

    def content(self, item: Item) -> Item:
        """Cells of an item, sorted if their order changes from showing to showing."""
        return tuple(sorted(item)) if self.reorder else item

    def listed(self, masks: tuple[int, ...]) -> tuple[int, ...] | None:
        """String of the list that these cells are an order of.

        None if there is no such string, or strings are always shown in their own order.
        """
        if not self.reorder:
            return None
        cells = self.content(masks)
        return next((string for string in self.strings if self.content(string) == cells), None)


class Choice(_Design, frozen=True, tag="choice"):
    """A design that compares one string at two values of a parameter.

    Parameters
    ----------
    parameter
        What is compared, one of `KNOBS`; ``dot_gap_mm`` is the gap between the two dots of a cell,
        from edge to edge.
    values
        Values of the parameter, in mm if it is a length; each is compared with each other one.
    string
        Dot masks of the string that is shown at both values.
    reference
        Value that each of the values is compared with, in both orders, instead of with each
        other; None if there is none.
    same
        How often each value is compared with itself, in each of the repeats.

    Raises
    ------
    ValueError
        If a number is out of range, there are too few values, a value is given twice, or the
        parameter cannot be felt in the string.
    """

    parameter: KnobName
    values: tuple[float, ...]
    string: Masks
    reference: float | None = None
    same: int = 0

    def __post_init__(self) -> None:
        super().__post_init__()
        check_range("same", self.same, 0, MOST_TRIALS)
        if len(self.values) < 2 and self.reference is None:
            raise ValueError(f"values are {len(self.values)}; give two or more to compare")
        if not self.values:
            raise ValueError("values are none; give one or more to compare with the reference")
        _check_distinct("values have", (f"{value:.15g}" for value in self.values))
        knob = KNOBS[self.parameter]
        for value in self.values:
            check_range("values: one", value, *_bounds(knob), knob.unit)
        check_range("reference", self.reference, *_bounds(knob), knob.unit)
        if self.reference in self.values:
            raise ValueError(
                f"reference is {self.reference:g}, which is one of values; leave it out there"
            )
        if not any(self.string):
            raise ValueError("string has no dots; give one with some")
        both = any(mask & _LEFT_DOTS and mask & _RIGHT_DOTS for mask in self.string)
        if self.parameter in ("dot_gap_mm", "dot_spacing_mm") and not both:
            raise ValueError("string has no cell with a gap; give one with a left and a right dot")
        if self.parameter == "cell_gap_mm" and sum(map(bool, self.string)) < 2:
            raise ValueError("string has no gap between cells; give two cells with dots or more")
        if self.parameter in UNFELT:
            raise ValueError(
                f"parameter is {self.parameter!r}, which no actuator shows in a line of its own; "
                f"give another"
            )

    @property
    def trials(self) -> int:
        """Number of trials in each condition."""
        return len(self.items())

    @property
    def cells(self) -> int:
        """Number of cells in the line."""
        return len(self.string)

    @property
    def masks(self) -> frozenset[int]:
        """Dot masks of all cells that are shown."""
        return frozenset(self.string)

    def items(self) -> Sequence[Item]:
        """Values of the first and the second stimulus in the trials of a condition."""
        return self.pairs() * self.repeats

    def pairs(self) -> list[Item]:
        """Pairs of values that are compared in each of the repeats."""
        alike = [(value, value) for value in self.values] * self.same
        if self.reference is None:
            return [*permutations(self.values, 2), *alike]
        compared = [(self.reference, value) for value in self.values]
        return [*compared, *(pair[::-1] for pair in compared), *alike]


class ItemList(_Design, frozen=True, tag="items"):
    """A design that shows the items of the table ``[items]``, which `strings_of` puts in.

    Parameters
    ----------
    reorder
        Whether the cells of an item are shown in another order each time.
    """

    reorder: bool = False

    def strings_of(self, strings: tuple[Masks, ...]) -> StringList:
        """Design that shows some strings as this one shows its items."""
        return StringList(
            repeats=self.repeats,
            blocks=self.blocks,
            order=self.order,
            catch=self.catch,
            strings=strings,
            reorder=self.reorder,
        )


Design = Combinations | StringList | Choice


def _check_distinct(what: str, names: Iterable[str]) -> None:
    for name, times in Counter(names).items():
        if times > 1:
            raise ValueError(f"{what} {name} twice; leave one out")


def _bounds(knob: StimulusKnob) -> tuple[float, float]:
    """Bounds of the values compared; geometry itself says which lengths go together."""
    return (0, max(50, knob.high)) if knob.unit else (knob.low, knob.high)
