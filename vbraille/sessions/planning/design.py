"""Designs: which items a study has, and what each shows.

An item is a text: cells in Unicode braille, a text in print, a picture's name, or the values that
are compared.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable
from random import Random
from typing import Annotated, Literal, NamedTuple

from msgspec import Meta

from vbraille.braille.spelling import spell, spell_string, to_braille
from vbraille.sessions.planning.spellings import cells_of
from vbraille.sessions.planning.trial import BLANK, Stimulus
from vbraille.sessions.planning.values import Count, FileName, Look, Number, Parameter
from vbraille.toml import Table, WrongValue

MOST_INTERVALS = 5


class Setting(NamedTuple):
    """Context in which an item is shown.

    Parameters
    ----------
    keys
        Dot masks of the keys of the protocol.
    room
        Returns how many cells a line of a look has room for.
    random
        Generator that reordered cells are drawn from.
    """

    keys: dict[str, int]
    room: Callable[[Look], int]
    random: Random


class Catch(Table, frozen=True, kw_only=True):
    """Catch trials: one in every few, and what they show."""

    every: Annotated[int, Meta(ge=2, le=10_000)]
    show: Literal["blank", "repeat"] = "blank"


class Repeated(Table, frozen=True, kw_only=True, tag_field="kind"):
    """Keys of all designs.

    Parameters
    ----------
    repeats
        How often each item is shown in each condition.
    blocks
        How many blocks the trials are spread over, or "conditions" for a block of each.
    order
        Order of the blocks of conditions: balanced over participants, as listed, or shuffled.
    orders
        File with the order of each participant.
    catch
        Catch trials; None for none.
    counterbalanced
        Whether each item is shown in one condition only, and participants differ in which.
    """

    repeats: Count = 1
    blocks: Annotated[int, Meta(ge=1, le=1000)] | Literal["conditions"] = "conditions"
    order: Literal["balanced", "listed", "shuffled"] | None = None
    orders: FileName | None = None
    catch: Catch | None = None
    counterbalanced: bool = False

    # What only some designs have as keys.
    passage = False
    parameter = form = ""

    def items(self, keys: dict[str, int] | None) -> list[str]:
        """Return the items, each once."""
        raise NotImplementedError

    def stimuli(self, item: str, look: Look, setting: Setting) -> tuple[Stimulus, ...]:
        """Return what a trial with an item shows."""
        raise NotImplementedError


class StringList(Repeated, frozen=True, kw_only=True, tag="list"):
    """The strings of a list, which are cells, texts or names of pictures.

    Parameters
    ----------
    strings
        The strings.
    reorder
        Whether the cells of a string are shuffled in each trial.
    passage
        Whether each string is a text that is broken into lines, which are read one after the other.
    """

    strings: Annotated[tuple[str, ...], Meta(min_length=1)]
    reorder: bool = False
    passage: bool = False

    def items(self, keys: dict[str, int] | None) -> list[str]:
        """Return the strings as cells; as they are without keys, for texts and pictures."""
        if keys is None:
            return list(self.strings)
        return [to_braille(spell_string(text, keys)) for text in self.strings]

    def stimuli(self, item: str, look: Look, setting: Setting) -> tuple[Stimulus, ...]:
        """Return the string, in another order if the design says so; or its lines."""
        if look.scene is not None:
            return (Stimulus("", look, picture=item),)
        if look.table is None:
            cells = "".join(setting.random.sample(item, len(item))) if self.reorder else item
            return (Stimulus(cells, look),)
        cells = cells_of(item, look.table)
        lines = broken(cells, setting.room(look)) if self.passage else [cells]
        return tuple(Stimulus(line, look, text=item) for line in lines)


class ItemList(StringList, frozen=True, kw_only=True, tag="items"):
    """The strings of the table [items]."""

    strings: tuple[str, ...] = ()


class Combinations(Repeated, frozen=True, kw_only=True, tag="combinations"):
    """Every combination of some characters.

    Parameters
    ----------
    characters, length
        The characters, and how many of them a combination has.
    before, after
        Delimiters, which are shown and not asked for.
    """

    characters: Annotated[tuple[str, ...], Meta(min_length=1, max_length=256)]
    length: Annotated[int, Meta(ge=1, le=6)]
    before: str = ""
    after: str = ""

    def items(self, keys: dict[str, int] | None) -> list[str]:
        """Return the combinations as cells."""
        cells = [to_braille(spell(text, keys or {})) for text in self.characters]
        return ["".join(chosen) for chosen in itertools.product(cells, repeat=self.length)]

    def stimuli(self, item: str, look: Look, setting: Setting) -> tuple[Stimulus, ...]:
        """Return the combination between the delimiters."""
        around = (self.before, self.after)
        before, after = (to_braille(spell_string(text, setting.keys)) for text in around)
        return (Stimulus(item, look, before, after),)


class Compared(Repeated, frozen=True, kw_only=True, tag="choice"):
    """One string at several values of a parameter.

    Parameters
    ----------
    parameter, values
        What is compared, and its values.
    string
        What is shown at all of them.
    reference
        The standard, which each value is compared with; None for none.
    form
        Stimuli of a trial. "pairs": each value and each other one, or the standard if there is one,
        in both orders. "single": each value alone. "standard": the standard, and then a value.
        "one": a value at each place among standards. "triangle": three, one of which differs.
        "abx": the standard and a value in either order, and one of the two again.
    intervals
        Stimuli in a trial of the form "one".
    same
        How often each value is compared with itself, in each of the repeats.
    """

    parameter: Parameter
    values: Annotated[tuple[Number, ...], Meta(min_length=1)]
    string: str
    reference: Number | None = None
    form: Literal["pairs", "single", "standard", "one", "triangle", "abx"] = "pairs"
    intervals: Annotated[int, Meta(ge=2, le=MOST_INTERVALS)] = 2
    same: Annotated[int, Meta(ge=0, le=10_000)] = 0

    def __post_init__(self) -> None:
        form, reference = self.form, self.reference
        if len(set(self.values)) < len(self.values):
            raise WrongValue("values", "one is there twice")
        if reference is None and form not in ("pairs", "single"):
            raise WrongValue("form", f"is {form!r}, which needs a reference")
        again = reference in self.values and form != "standard"
        if reference is not None and (form == "single" or again):
            raise WrongValue("reference", "is one of values, or form is 'single'; leave it out")
        if self.same and form != "pairs":
            raise WrongValue("same", "is for form = 'pairs'; leave it out")

    def items(self, keys: dict[str, int] | None) -> list[str]:
        """Return the values of the stimuli of each trial, with blanks between them."""
        alike = [(value, value) for value in self.values] * self.same
        return [values_said(each) for each in [*self.of(self.values), *alike]]

    def of(self, values: tuple[float, ...]) -> list[tuple[float, ...]]:
        """Return the values of the stimuli of each trial in which some values are shown."""
        standard = self.reference
        if standard is None:
            alone = self.form == "single"
            return [(v,) for v in values] if alone else list(itertools.permutations(values, 2))
        pairs = [(standard, value) for value in values]
        both = [*pairs, *((value, standard) for value in values)]
        match self.form:
            case "standard":
                return pairs
            case "one":
                return _placed(pairs, self.intervals)
            case "triangle":
                return _placed(both, 3)
            case "abx":
                return [(*pair, again) for pair in both for again in pair]
        return both

    def stimuli(self, item: str, look: Look, setting: Setting) -> tuple[Stimulus, ...]:
        """Return the string at each value of an item."""
        cells = to_braille(spell_string(self.string, setting.keys))
        return tuple(
            Stimulus(cells, look.changed(self.parameter, value), value=value)
            for value in map(float, item.split())
        )


def values_said(values: tuple[float, ...]) -> str:
    """Return the item that compared values are: the values, with blanks between them."""
    return " ".join(f"{value:.9g}" for value in values)


def _placed(pairs: list[tuple[float, float]], count: int) -> list[tuple[float, ...]]:
    """Return the second of each pair at each place among so many of the first."""
    return [
        tuple(odd if place == at else one for place in range(count))
        for at in range(count)
        for one, odd in pairs
    ]


def broken(cells: str, room: int) -> list[str]:
    """Return the lines of a text, broken at blank cells; words that are too long are cut.

    >>> broken("⠁⠀⠃⠃⠀⠉⠉⠉⠉⠉", 4)
    ['⠁⠀⠃⠃', '⠉⠉⠉⠉', '⠉']
    """
    lines = [""]
    for word in filter(None, cells.split(BLANK)):
        if lines[-1] and len(lines[-1]) + 1 + len(word) <= room:
            lines[-1] += BLANK + word
        else:
            lines += [word[at : at + room] for at in range(0, len(word), room)]
    return lines[1:]


AnyDesign = StringList | ItemList | Combinations | Compared
