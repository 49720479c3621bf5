"""Designs: what is shown and practised, how often, in which order, and by which rules."""

from __future__ import annotations

from collections import Counter
from itertools import permutations, product
from typing import TYPE_CHECKING, Literal

from msgspec import structs

from vbraille.braille.spelling import name_dots, to_braille
from vbraille.errors import check_range
from vbraille.sessions.planning.pace import check_file_name
from vbraille.sessions.planning.spellings import Mask, Masks, WrittenText
from vbraille.sessions.planning.stimuli import KNOBS, KnobName, StimulusKnob
from vbraille.tomlfile import Table

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence


class Catch(Table, frozen=True, kw_only=True):
    """Trials that keep watch over the participant; they belong to no item.

    Parameters
    ----------
    every
        Number of trials among which there is one catch trial, at a random place; None if the
        share is given.
    share
        Share of catch trials among all, above 0 and at most 0.5; None if ``every`` is given.
    show
        What a catch trial shows: "blank" for cells without dots, "repeat" for what the trial
        before it has shown.

    Raises
    ------
    ValueError
        If a number is out of range, or both or neither of the two is given.
    """

    every: int | None = None
    share: float | None = None
    show: Literal["blank", "repeat"] = "blank"

    def __post_init__(self) -> None:
        check_range("every", self.every, 2, 1000)
        check_range("share", self.share, 0.001, 0.5)
        if (self.every is None) == (self.share is None):
            raise ValueError("every and share say the same; give one of the two")

    def number(self, trials: int) -> int:
        """Number of catch trials beside so many others."""
        if self.every is not None:
            # One of every n trials is a catch trial, and so there are n - 1 others for each.
            return trials // (self.every - 1)
        assert self.share is not None
        return max(1, round(trials * self.share / (1 - self.share)))

    def stretches(self, trials: int) -> list[int]:
        """Ends of the stretches of so many other trials, each of which has one catch trial."""
        number = self.number(trials)
        if self.every is not None:
            return [(self.every - 1) * part for part in range(1, number + 1)]
        return [part * trials // number for part in range(1, number + 1)]


class BlockOrder(Table, frozen=True, kw_only=True):
    """The table ``[order]``: in which order participants have the blocks of the conditions.

    Parameters
    ----------
    kind
        "williams" or "balanced" for Williams squares over participants, "listed" for the order of
        the file, "random" for an order of each participant's own, "table" for the order that a
        file gives each participant.
    file
        Name of the file of orders, which stands beside the protocol.

    Raises
    ------
    ValueError
        If a table has no file, or something else has one.
    """

    kind: Literal["williams", "balanced", "listed", "random", "table"]
    file: str | None = None

    def __post_init__(self) -> None:
        if self.kind == "table" and self.file is None:
            raise ValueError('file is missing; give the file of orders, such as "orders.csv"')
        if self.kind != "table" and self.file is not None:
            raise ValueError("file is of kind = 'table'; leave it out")

    @property
    def of_blocks(self) -> Literal["balanced", "listed", "shuffled"]:
        """Name that ``[design] order`` has for this order; that of a table counts as listed."""
        if self.kind == "random":
            return "shuffled"
        return "balanced" if self.kind in ("williams", "balanced") else "listed"

    def check(self, design: Design, conditions: int) -> None:
        """Check that so many conditions of a design can be ordered so.

        Raises
        ------
        ValueError
            If they cannot.
        """
        if design.order is not None:
            raise ValueError("kind stands beside order of [design]; leave one of the two out")
        if design.blocks != "conditions" and self.kind != "random":
            raise ValueError(
                f"kind is {self.kind!r}, which orders blocks of a condition each; give 'random', "
                f"or [design] blocks = 'conditions'"
            )
        if self.kind != "listed" and conditions < 2:
            raise ValueError(
                f"kind is {self.kind!r}, and there is one condition, so that nothing can be "
                f"ordered; leave it out, or give more conditions"
            )


MOST_TRIALS = 10_000
MOST_INTERVALS = 5
UNFELT = ("row_spacing_mm", "line_pitch_mm")  # lengths that change nothing in a single line

# Dot masks of the cells asked for, or the values compared, or a `WrittenText`.
Item = tuple[float, ...]

_LEFT_DOTS, _RIGHT_DOTS = 0b01000111, 0b10111000


class _Design(Table, frozen=True, kw_only=True, tag_field="kind"):
    """Common part of the designs of every kind.

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
        """Content of an item; equal for two items that count as showing the same."""
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
    passage
        Whether each string is a passage: a text that is broken into lines, which are read one
        after the other in one trial.

    Raises
    ------
    ValueError
        If a number is out of range, or a string has no dots.
    """

    strings: tuple[Masks, ...]
    reorder: bool = False
    passage: bool = False

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
    """A design that compares one string at values of a parameter.

    Parameters
    ----------
    parameter
        What is compared; ``dot_gap_mm`` is the gap between the two dots of a cell,
        from edge to edge.
    values
        Values of the parameter, in mm if it is a length.
    string
        Dot masks of the string that is shown at all of them.
    reference
        The standard, which each of the values is compared with; None if there is none.
    form
        Stimuli of a trial, whose places are balanced. "pairs": each value and each other one, or
        the standard if there is one, in both orders. "single": each value alone. "standard": the
        standard, and then a value. "one": a value at each place among as many standards as
        ``intervals`` has room for. "triangle": three, one of which differs: a value among
        standards, or the standard among values. "abx": the standard and a value in either order,
        and one of the two again.
    intervals
        Number of stimuli in a trial of the form "one".
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
    form: Literal["pairs", "single", "standard", "one", "triangle", "abx"] = "pairs"
    intervals: int = 2
    same: int = 0

    def __post_init__(self) -> None:
        super().__post_init__()
        check_range("same", self.same, 0, MOST_TRIALS)
        check_range("intervals", self.intervals, 2, MOST_INTERVALS)
        if self.intervals != 2 and self.form != "one":
            raise ValueError("intervals are of form = 'one'; leave them out")
        alone = self.form == "single"
        if alone and self.reference is not None:
            raise ValueError("reference is compared, and form is 'single'; leave one of them out")
        if self.form not in ("pairs", "single") and self.reference is None:
            raise ValueError(f"reference is missing, and form is {self.form!r}; add it")
        if self.same and self.form != "pairs":
            raise ValueError("same is of form = 'pairs'; leave it out")
        if len(self.values) < 2 and self.reference is None:
            raise ValueError(f"values are {len(self.values)}; give two or more to compare")
        if not self.values:
            raise ValueError("values are none; give one or more to compare with the reference")
        _check_distinct("values have", (f"{value:.15g}" for value in self.values))
        knob = KNOBS[self.parameter]
        for value in self.values:
            check_range("values: one", value, *_bounds(knob), knob.unit)
        check_range("reference", self.reference, *_bounds(knob), knob.unit)
        if self.reference in self.values and self.form != "standard":
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

    @property
    def trials(self) -> int:
        """Number of trials in each condition."""
        return len(self.items())

    @property
    def alternatives(self) -> int:
        """Number of answers that there are to a trial, of which one is right."""
        return 2 if self.form == "abx" else self.stimuli

    @property
    def differences(self) -> tuple[float, ...]:
        """Differences of the values from the standard, increasing, for a procedure to choose from.

        Raises
        ------
        ValueError
            If the values do not lie on one side of a standard, which a trial shows at any place.
        """
        if self.reference is None:
            raise ValueError("there is no reference that values differ from; add it")
        if self.form == "standard":
            raise ValueError(
                "form is 'standard', whose second stimulus would always be the right one; give "
                "'pairs', 'one', 'triangle' or 'abx'"
            )
        if min(self.values) < self.reference < max(self.values):
            raise ValueError(
                f"[design] values lie on both sides of reference {self.reference:g}, and a "
                f"procedure goes to one side of it; give those of one side"
            )
        if len(self.values) < 2:
            raise ValueError(
                "[design] values is one; give the one nearest to reference, and the furthest one"
            )
        return tuple(sorted(round(abs(value - self.reference), 9) for value in self.values))

    def apart(self, difference: float) -> float:
        """Value that differs by so much from the standard, on the side of the design's values."""
        assert self.reference is not None
        away = difference if self.values[0] > self.reference else -difference
        return round(self.reference + away, 9)

    @property
    def cells(self) -> int:
        """Number of cells in the line."""
        return len(self.string)

    @property
    def masks(self) -> frozenset[int]:
        """Dot masks of all cells that are shown."""
        return frozenset(self.string)

    def items(self) -> Sequence[Item]:
        """Values of the stimuli in the trials of a condition."""
        alike = [(value, value) for value in self.values] * self.same
        return [*self.of_values(self.values), *alike] * self.repeats

    @property
    def stimuli(self) -> int:
        """Number of stimuli in a trial."""
        return len(self.items()[0])

    def of_values(self, values: tuple[float, ...]) -> list[Item]:
        """Values of the stimuli of each trial in which some values are shown."""
        standard = self.reference
        if standard is None:
            return [(v,) for v in values] if self.form == "single" else [*permutations(values, 2)]
        first = [(standard, value) for value in values]
        match self.form:
            case "standard":
                return first
            case "one":
                places = range(self.intervals)
                return [
                    tuple(value if place == at else standard for place in places)
                    for at in places
                    for value in values
                ]
            case "triangle":
                odd = [pair for one, other in first for pair in ((one, other), (other, one))]
                return [
                    tuple(other if place == at else one for place in range(3))
                    for at in range(3)
                    for one, other in odd
                ]
            case "abx":
                pairs = [*first, *(pair[::-1] for pair in first)]
                return [(*pair, again) for pair in pairs for again in pair]
            case _:
                return [*first, *(pair[::-1] for pair in first)]


class ItemList(_Design, frozen=True, tag="items"):
    """A design that shows the items of the table ``[items]``, which `strings_of` puts in.

    Parameters
    ----------
    reorder
        Whether the cells of an item are shown in another order each time.
    passage
        Whether each item is a passage: a text that is broken into lines, which are read one after
        the other in one trial.
    """

    reorder: bool = False
    passage: bool = False

    def strings_of(self, strings: tuple[Masks, ...]) -> StringList:
        """Design that shows some strings as this one shows its items."""
        return StringList(strings=strings, **structs.asdict(self))


Design = Combinations | StringList | Choice


def _check_distinct(what: str, names: Iterable[str]) -> None:
    for name, times in Counter(names).items():
        if times > 1:
            raise ValueError(f"{what} {name} twice; leave one out")


def _bounds(knob: StimulusKnob) -> tuple[float, float]:
    """Bounds of the values compared; geometry itself says which lengths go together."""
    return (0, max(50, knob.high)) if knob.unit else (knob.low, knob.high)


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

    def items(self, design: Design) -> tuple[Item, ...]:
        """Items of practice: the strings, or the values as the design arranges its own."""
        if isinstance(design, Choice):
            return tuple(design.of_values(self.values)) if self.values else ()
        return self.strings

    def lines(self, design: Design) -> list[tuple[int, ...]]:
        """Cells of all strings practised, with delimiters; empty if values are compared."""
        before, after = design.around
        return [(*before, *string, *after) for string in self.strings]

    def check(self, design: Design, *, pictures: bool = False) -> None:
        """Check that this practice goes with a test of a design, and gives nothing of it away.

        Pictures are learnt before they are asked for, and may be those of the test.

        Raises
        ------
        ValueError
            If it does not.
        """
        compares = isinstance(design, Choice)
        if self.strings if compares else self.values:
            given, wanted = ("strings", "values") if compares else ("values", "strings")
            raise ValueError(f"{given} are not of this kind of design; give {wanted} instead")
        if compares:
            if shared := set(self.values) & {*design.values, design.reference}:
                unit = KNOBS[design.parameter].unit
                raise ValueError(
                    f"values have {min(shared):g}{unit}, which the test compares; give another"
                )
            return
        for string, line in zip(self.strings, self.lines(design), strict=True):
            if not any(line):
                raise ValueError("strings have one without dots, and nothing can be felt of it")
            if not pictures and _is_shown(design, string):
                raise ValueError(
                    f"strings have {name_item(string)}, which the test shows; give another"
                )


def name_item(item: Item) -> str:
    """Words for an item: its text in quotation marks, or its cells in Unicode braille."""
    if isinstance(item, WrittenText):
        return repr(str(item))
    return to_braille(map(int, item))


def _is_shown(design: Design, item: Item) -> bool:
    if isinstance(design, Combinations):
        return len(item) == design.length and set(item) <= set(design.characters)
    return design.content(item) in map(design.content, design.items())
