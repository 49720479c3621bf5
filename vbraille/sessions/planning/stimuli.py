"""Trials, the stimuli that they put under the hand, and the numbers in which stimuli may differ."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

from msgspec import Struct

from vbraille.braille.geometry import BOUNDS_MM
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
    """A string, or a picture, that is put under the hand.

    Parameters
    ----------
    masks
        Dot masks of all cells shown, delimiters included; none for a picture.
    tuning, geometry
        Tuning and distances that the cells are shown with; of a picture only the contrast counts.
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
    scene, picture
        File of a scene, and the ids of its elements that are shown; None for cells.
    answer
        Right answer to what is asked about a picture; None where nothing is right.

    Raises
    ------
    ValueError
        If there is neither a cell nor a picture, or a dot mask is out of range.
    """

    masks: tuple[int, ...]
    tuning: Tuning
    geometry: Geometry
    value: float | None = None
    mapping: str | None = None
    text: str | None = None
    table: str | None = None
    on: str | None = None
    scene: str | None = None
    picture: str | None = None
    answer: str | None = None

    def __post_init__(self) -> None:
        if not self.masks and self.picture is None:
            raise ValueError("a stimulus has no cells; it must have one or more")
        for mask in self.masks:
            if not 0 <= mask <= 0xFF:
                raise ValueError(f"a cell's dot mask is {mask}; it must be 0 to 255")

    @property
    def conventional(self) -> bool:
        """True if it stands on the conventional display, and not on the device."""
        return self.on is not None


class Stimuli(tuple[Stimulus, ...]):
    """The stimuli of a trial, in the order in which they are shown."""

    __slots__ = ()


def joined(stimuli: Stimuli) -> tuple[int, ...]:
    """Dot masks of all lines of a text, with a blank cell where a line ends."""
    masks: tuple[int, ...] = ()
    for stimulus in stimuli:
        masks += (0, *stimulus.masks) if masks else stimulus.masks
    return masks


def broken(masks: tuple[int, ...], room: int) -> list[tuple[int, ...]]:
    """Lines of a text, broken at blank cells; words that are too long are cut.

    >>> broken((1, 0, 2, 2, 0, 3, 3, 3, 3, 3), 4)
    [(1, 0, 2, 2), (3, 3, 3, 3), (3,)]
    """
    words: list[tuple[int, ...]] = [()]
    for mask in masks:
        if mask:
            words[-1] += (mask,)
        elif words[-1]:
            words.append(())
    lines: list[tuple[int, ...]] = [()]
    for word in filter(None, words):
        if lines[-1] and len(lines[-1]) + 1 + len(word) <= room:
            lines[-1] += (0, *word)
            continue
        parts = [word[at : at + room] for at in range(0, len(word), room)]
        lines[-1:] = [lines[-1], *parts] if lines[-1] else parts
    return lines


class Trial(Struct, frozen=True, forbid_unknown_fields=True):
    """A trial: stimuli in the order in which they are shown. Files have its fields in this order.

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
        last; both are 0 for a picture.
    stimuli
        One stimulus to read, or several to compare.
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
        if not self.stimuli:
            raise ValueError(f"trial {self.number} has no stimulus; it must have one or more")
        first, stop = self.asked
        if self.stimuli[0].picture is not None:
            return
        if not 0 <= first < stop <= min(len(stimulus.masks) for stimulus in self.stimuli):
            raise ValueError(
                f"trial {self.number} asks for the cells from {first} to {stop}; "
                f"they must be cells of what it shows"
            )

    @property
    def practice(self) -> bool:
        """True if the trial is practice."""
        return self.block == 0

    @property
    def item(self) -> tuple[int, ...]:
        """Content, whatever the condition: masks of cells asked for, text or picture's name."""
        stimulus = self.stimuli[0]
        if stimulus.picture is not None:
            return WrittenText.of(stimulus.picture)
        if stimulus.text is not None:
            return WrittenText.of(stimulus.text)
        return stimulus.masks[slice(*self.asked)]

    @property
    def presented(self) -> str:
        """Cells asked for, in Unicode braille, of the first stimulus; of a picture its answer."""
        stimulus = self.stimuli[0]
        if stimulus.picture is not None:
            return stimulus.answer or stimulus.picture
        if stimulus.text is not None and len(self.stimuli) > 1:
            return to_braille(joined(self.stimuli))
        return to_braille(self.stimuli[0].masks[slice(*self.asked)])


GAP = "dot_gap_mm"  # from edge to edge between the two dots of a cell
KnobName = Literal[
    "texture", "contrast", "texture_cycles", "dot_width_mm", "dot_gap_mm", "dot_spacing_mm",
    "cell_gap_mm", "row_spacing_mm", "line_pitch_mm",
]  # fmt: skip


@dataclass(frozen=True, slots=True)
class StimulusKnob:
    """A number that stimuli may differ in.

    Parameters
    ----------
    words
        What people call it.
    unit
        Unit, with a space before it; empty if it has none.
    low, high
        Bounds of its values, whatever the display.
    """

    words: str
    unit: str
    low: float
    high: float


KNOBS: dict[str, StimulusKnob] = {
    "texture": StimulusKnob("texture", "", 0.0, 1.0),
    "contrast": StimulusKnob("contrast", "", 0.0, 1.0),
    "texture_cycles": StimulusKnob("texture cycles", "", 1.0, 50.0),
    GAP: StimulusKnob("gap between dots", " mm", 0.0, 50.0),
    **{
        name: StimulusKnob(name.removesuffix("_mm").replace("_", " "), " mm", low, high)
        for name, (low, high) in BOUNDS_MM.items()
        if name != "travel_mm"
    },
}


def with_value(stimulus: Stimulus, knob: str, value: float) -> Stimulus:
    """Stimulus in which one number has another value; what it says of its value stays.

    Raises
    ------
    ValueError
        If the value is out of range.
    """
    geometry, tuning = stimulus.geometry, stimulus.tuning
    if knob == GAP:
        # The gap is from edge to edge; the centres of the dots are a dot's width further apart.
        geometry = replace(geometry, dot_spacing_mm=geometry.dot_width_mm + value)
    elif knob in BOUNDS_MM:
        geometry = replace(geometry, **{knob: value})
    elif knob == "texture_cycles":
        if value != int(value):
            raise ValueError(f"texture_cycles is {value:g}; it must be a whole number")
        tuning = replace(tuning, cycles=int(value))
    else:
        tuning = replace(tuning, **{knob: value})
    return replace(stimulus, geometry=geometry, tuning=tuning)


def said_value(value: float, knob: str | None) -> str:
    """Words for a value of a number that stimuli differ in, with its unit if it has one."""
    return f"{value:g}{KNOBS[knob].unit if knob in KNOBS else ''}"


def value_at(stimulus: Stimulus, knob: str) -> float:
    """Value that a number has in a stimulus."""
    if knob == GAP:
        return stimulus.geometry.dot_spacing_mm - stimulus.geometry.dot_width_mm
    if knob in BOUNDS_MM:
        return getattr(stimulus.geometry, knob)
    return float(getattr(stimulus.tuning, "cycles" if knob == "texture_cycles" else knob))
