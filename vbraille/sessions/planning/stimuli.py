"""Trials, and the stimuli that they put under the hand."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from msgspec import Struct

from vbraille.braille.spelling import to_braille
from vbraille.sessions.planning.spellings import WrittenText

if TYPE_CHECKING:
    from vbraille.braille.geometry import Geometry
    from vbraille.render import Tuning

MOST_SEED = 2**63 - 1

_PARTICIPANT = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]{0,31}")


def check_participant(participant: str) -> None:
    """Check a participant's pseudonym, which folders and tables are named after.

    Raises
    ------
    ValueError
        If the text cannot be a pseudonym.
    """
    if not _PARTICIPANT.fullmatch(participant):
        raise ValueError(
            f"participant is {participant[:40]!r}; it must be a pseudonym such as P07: 1 to 32 "
            f"letters a to z, digits, hyphens or underscores, a letter or digit first"
        )


def check_seed(seed: int) -> None:
    """Check a seed.

    Raises
    ------
    ValueError
        If the seed is out of range.
    """
    if not 0 <= seed <= MOST_SEED:
        raise ValueError("seed is out of range; it must be 0 to 2⁶³ - 1")


@dataclass(frozen=True, slots=True)
class Stimulus:
    """A string that is put under the hand.

    Parameters
    ----------
    masks
        Dot masks of all cells shown, delimiters included.
    tuning, geometry
        Tuning and distances that the cells are shown with.
    value
        Value of the parameter that is compared, in mm if it is a length; None if none is compared.
    mapping
        Name of the mapping, where conditions differ in it; None for the display's.
    text, table
        Text that the cells stand for, and the braille table that made them of it; None where a
        protocol gives the cells themselves. The text is empty where a catch trial shows nothing.
    on
        "brlapi" if it stands on the conventional display that BRLTTY drives; None if it is put
        under the hand on the device.

    Raises
    ------
    ValueError
        If there is no cell, or a dot mask is out of range.
    """

    masks: tuple[int, ...]
    tuning: Tuning
    geometry: Geometry
    value: float | None = None
    mapping: str | None = None
    text: str | None = None
    table: str | None = None
    on: str | None = None

    def __post_init__(self) -> None:
        if not self.masks:
            raise ValueError("a stimulus has no cells; it must have one or more")
        for mask in self.masks:
            if not 0 <= mask <= 0xFF:
                raise ValueError(f"a cell's dot mask is {mask}; it must be 0 to 255")


class Stimuli(tuple[Stimulus, ...]):
    """The stimuli of a trial, in the order in which they are shown."""

    __slots__ = ()


class Trial(Struct, frozen=True, forbid_unknown_fields=True):
    """A trial: a string to read, or two to compare. Files have its fields in the order given here.

    Parameters
    ----------
    number
        Number of the trial in the session, from 1. Practice trials are numbered separately.
    block
        Number of the block, from 1; 0 for practice.
    condition
        Name of the condition.
    asked
        Cells of the stimulus that are asked for: index of the first, and of the one after the
        last.
    stimuli
        One stimulus to read, or two to compare.
    catch
        Empty; or, for a trial that only keeps watch over the participant, what it shows: "blank"
        for cells without dots, "repeat" for what the trial before it has shown.

    Raises
    ------
    ValueError
        If a number, or the number of stimuli, is out of range.
    """

    number: int
    block: int
    condition: str
    asked: tuple[int, int]
    stimuli: Stimuli
    catch: Literal["", "blank", "repeat"] = ""

    def __post_init__(self) -> None:
        if self.number < 1:
            raise ValueError(f"a trial's number is {self.number}; it must be 1 or more")
        if self.block < 0:
            raise ValueError(f"trial {self.number} has block {self.block}; it must be 0 or more")
        if len(self.stimuli) not in (1, 2):
            raise ValueError(
                f"trial {self.number} has {len(self.stimuli)} stimuli; it must have 1 or 2"
            )
        first, stop = self.asked
        if not 0 <= first < stop <= min(len(stimulus.masks) for stimulus in self.stimuli):
            raise ValueError(
                f"trial {self.number} asks for the cells from {first} to {stop}; "
                f"they must be cells of what it shows"
            )

    @property
    def practice(self) -> bool:
        """Whether the trial is practice."""
        return self.block == 0

    @property
    def item(self) -> tuple[int, ...]:
        """What is shown, whatever the condition: dot masks of the cells asked for, or the text."""
        stimulus = self.stimuli[0]
        if stimulus.text is not None:
            return WrittenText.of(stimulus.text)
        return stimulus.masks[slice(*self.asked)]

    @property
    def presented(self) -> str:
        """Cells asked for, in Unicode braille; those of the first stimulus, if there are two."""
        return to_braille(self.stimuli[0].masks[slice(*self.asked)])
