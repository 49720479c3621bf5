"""A trial, and the stimuli that it shows. The plan in a session's file has these as JSON."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

from msgspec import Struct, structs

from vbraille.braille.cells import UNICODE_BLANK
from vbraille.sessions.planning.values import Look

BLANK = chr(UNICODE_BLANK)


class Stimulus(Struct, frozen=True, omit_defaults=True):
    """A string of cells, or a picture, that is felt at once.

    Parameters
    ----------
    cells
        Cells that are asked for, in Unicode braille; empty for a picture.
    look
        How they are shown.
    before, after
        Cells around them that are shown and not asked for.
    value
        Value of the parameter that stimuli are compared by; None if they are not compared.
    text
        Text that the cells were translated from; empty if a protocol gives the cells themselves.
    picture
        Ids of the elements of the look's scene that are shown; empty for cells.
    """

    cells: str
    look: Look
    before: str = ""
    after: str = ""
    value: float | None = None
    text: str = ""
    picture: str = ""

    @property
    def on(self) -> Literal["device", "pins"]:
        """Place of it: under the array, or on the pins of a conventional display."""
        return self.look.on or "device"

    @property
    def is_blank(self) -> bool:
        """Tell whether there is nothing to feel in what is asked for."""
        return self.look.contrast == 0 or not set(self.cells) - {BLANK}

    def at(self, parameter: str, value: float) -> Stimulus:
        """Return the stimulus with another value of a parameter, by which it may be compared."""
        compared = value if self.value is not None else None
        return structs.replace(self, look=self.look.changed(parameter, value), value=compared)

    def masks(self, lead_cells: int) -> list[int]:
        """Return the dot masks of the whole line, with blank cells before it."""
        shown = self.before + self.cells + self.after
        return [0] * lead_cells + [ord(cell) - UNICODE_BLANK for cell in shown]


class Trial(Struct, frozen=True):
    """A trial of the plan.

    Parameters
    ----------
    practice, number
        Whether it is practice, and its number, from 1. Practice is numbered by itself.
    block
        Number of the block, from 1; 0 in practice.
    condition
        Name of the condition.
    item
        What is shown as the protocol lists it: cells in Unicode braille, a text, a picture's
        name, or the values that are compared.
    stimuli
        One stimulus to read, several to compare, or the lines of a passage, in their order.
    gap_s
        Time before the cue.
    catch
        "blank" or "repeat" for a trial that only keeps watch over the participant; else empty.
    columns
        What the file of items says of the item besides, by column.
    """

    practice: bool
    number: int
    block: int
    condition: str
    item: str
    stimuli: tuple[Stimulus, ...]
    gap_s: float = 0.0
    catch: Literal["", "blank", "repeat"] = ""
    columns: dict[str, str] = {}

    @property
    def key(self) -> tuple[bool, int]:
        """Practice and number, which no other trial of the session has."""
        return self.practice, self.number

    @property
    def name(self) -> str:
        """Name in sentences."""
        return f"practice {self.number}" if self.practice else f"trial {self.number}"

    @property
    def cells(self) -> str:
        """Cells that are asked for; lines of a passage have a blank between them."""
        if self.stimuli[0].value is not None:
            return self.stimuli[0].cells
        return BLANK.join(stimulus.cells for stimulus in self.stimuli)

    @property
    def values(self) -> list[float]:
        """Values that are compared; none if a string or a picture is shown."""
        return [each.value for each in self.stimuli if each.value is not None]

    @property
    def presented(self) -> str:
        """Cells, picture's name or compared values that were shown, as tables have them."""
        if self.values:
            return " ".join(f"{value:g}" for value in self.values)
        return self.stimuli[0].picture or self.cells

    def with_values(self, parameter: str, values: Sequence[float]) -> Trial:
        """Return the trial with other values of its stimuli."""
        pairs = zip(self.stimuli, values, strict=True)
        return structs.replace(self, stimuli=tuple(each.at(parameter, v) for each, v in pairs))

    def turned(self, parameter: str, value: float) -> Trial:
        """Return the trial with its last stimulus at another value."""
        return self.with_values(parameter, [*self.values[:-1], value])

    def at(self, parameter: str, value: float) -> Trial:
        """Return the trial with all its stimuli at a value."""
        return self.with_values(parameter, [value] * len(self.stimuli))
