"""Designs: which items a study has, and what each shows.

An item is a text: cells in Unicode braille, or the values that are compared.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from random import Random
from typing import Annotated, Literal

from msgspec import Meta

from vbraille.braille.spelling import spell, to_braille
from vbraille.sessions.planning.trial import Stimulus
from vbraille.sessions.planning.values import Count, Look
from vbraille.toml import Table, WrongValue

Keys = dict[str, int]


class Catch(Table, kw_only=True):
    """Trials that only keep watch: one of so many, and what it shows."""

    every: Annotated[int, Meta(ge=2)]
    show: Literal["blank", "repeat"]


class Repeated(Table, kw_only=True, tag_field="kind"):
    """What all designs have.

    Parameters
    ----------
    repeats
        How often each item is shown in each condition.
    blocks
        How many blocks the trials are spread over, or "conditions" for a block of each.
    order
        Order of the blocks of conditions: balanced over participants, as listed, or shuffled.
    catch
        Catch trials; None for none.
    """

    repeats: Count = 1
    blocks: Count | Literal["conditions"] = 1
    order: Literal["balanced", "listed", "shuffled"] | None = None
    catch: Catch | None = None

    def spellings(self) -> dict[str, tuple[str, ...]]:
        """Return the spellings of cells in the table, by the path of their key."""
        raise NotImplementedError

    def items(self, keys: Keys) -> list[str]:
        """Return the items, each once."""
        raise NotImplementedError

    def stimuli(self, item: str, look: Look, keys: Keys, random: Random) -> tuple[Stimulus, ...]:
        """Return what a trial with an item shows."""
        raise NotImplementedError


class StringList(Repeated, kw_only=True, tag="list"):
    """The strings of a list.

    Parameters
    ----------
    strings
        The strings.
    reorder
        Whether the cells of a string are shuffled in each trial.
    """

    strings: Annotated[tuple[str, ...], Meta(min_length=1)]
    reorder: bool = False

    def spellings(self) -> dict[str, tuple[str, ...]]:
        """Return the strings."""
        return {"design.strings": self.strings}

    def items(self, keys: Keys) -> list[str]:
        """Return the strings as cells."""
        return [to_braille(spell(text, keys)) for text in self.strings]

    def stimuli(self, item: str, look: Look, keys: Keys, random: Random) -> tuple[Stimulus, ...]:
        """Return the string, its cells shuffled if the design says so."""
        cells = "".join(random.sample(item, len(item))) if self.reorder else item
        return (Stimulus(cells, look),)


class Combinations(Repeated, kw_only=True, tag="combinations"):
    """Every combination of some characters.

    Parameters
    ----------
    characters, length
        The characters, and how many of them a combination has.
    before, after
        Delimiters, which are shown and not asked for.
    """

    characters: Annotated[tuple[str, ...], Meta(min_length=1)]
    length: Annotated[int, Meta(ge=1, le=6)]
    before: str = ""
    after: str = ""

    def spellings(self) -> dict[str, tuple[str, ...]]:
        """Return the characters and the delimiters."""
        return {
            "design.characters": self.characters,
            "design.before": (self.before,),
            "design.after": (self.after,),
        }

    def items(self, keys: Keys) -> list[str]:
        """Return the combinations as cells."""
        cells = [to_braille(spell(text, keys)) for text in self.characters]
        return ["".join(chosen) for chosen in itertools.product(cells, repeat=self.length)]

    def stimuli(self, item: str, look: Look, keys: Keys, random: Random) -> tuple[Stimulus, ...]:
        """Return the combination between the delimiters."""
        before, after = (to_braille(spell(text, keys)) for text in (self.before, self.after))
        return (Stimulus(item, look, before, after),)


class Pairs(Repeated, kw_only=True, tag="pairs"):
    """A string at two values of a number of its look, each pair of different values in both orders.

    Parameters
    ----------
    string
        What is shown.
    parameter, values
        Name of the number, and its values.
    """

    string: str
    parameter: Literal["texture", "contrast", "dot_width_mm", "dot_spacing_mm", "cell_gap_mm"]
    values: Annotated[tuple[float, ...], Meta(min_length=2)]

    def __post_init__(self) -> None:
        if len(set(self.values)) < len(self.values):
            raise WrongValue("values", "a value is there twice")

    def spellings(self) -> dict[str, tuple[str, ...]]:
        """Return the string."""
        return {"design.string": (self.string,)}

    def items(self, keys: Keys) -> list[str]:
        """Return the pairs of values."""
        return [f"{one:g} {other:g}" for one, other in itertools.permutations(self.values, 2)]

    def stimuli(self, item: str, look: Look, keys: Keys, random: Random) -> tuple[Stimulus, ...]:
        """Return the string at each value of the pair."""
        return _compared(self.string, self.parameter, item, look, keys)


class Standard(Repeated, kw_only=True, tag="standard"):
    """A string at a standard value of a number of its look, and then at another value.

    Parameters
    ----------
    string
        What is shown.
    parameter, reference, values
        Name of the number, its standard value, and the other values.
    """

    string: str
    parameter: Literal["texture", "contrast", "dot_width_mm", "dot_spacing_mm", "cell_gap_mm"]
    reference: float
    values: Annotated[tuple[float, ...], Meta(min_length=1)]

    def spellings(self) -> dict[str, tuple[str, ...]]:
        """Return the string."""
        return {"design.string": (self.string,)}

    def items(self, keys: Keys) -> list[str]:
        """Return the standard with each value."""
        return [f"{self.reference:g} {value:g}" for value in self.values]

    def stimuli(self, item: str, look: Look, keys: Keys, random: Random) -> tuple[Stimulus, ...]:
        """Return the string at both values."""
        return _compared(self.string, self.parameter, item, look, keys)


def _compared(
    string: str, parameter: str, item: str, look: Look, keys: Keys
) -> tuple[Stimulus, ...]:
    """Return a string at each value of an item."""
    cells = to_braille(spell(string, keys))
    values = map(float, item.split())
    return tuple(Stimulus(cells, look.changed(parameter, value), value=value) for value in values)


AnyDesign = StringList | Combinations | Pairs | Standard


def practice_items(strings: tuple[str, ...], design: AnyDesign, keys: Keys) -> Iterator[str]:
    """Go round the items of practice without end."""
    own = [to_braille(spell(text, keys)) for text in strings]
    return itertools.cycle(own or design.items(keys))
