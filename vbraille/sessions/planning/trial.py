"""A trial, and the stimuli that it shows. The plan in a session's file has these as JSON."""

from __future__ import annotations

from typing import Literal

from msgspec import Struct, structs

from vbraille.braille.cells import UNICODE_BLANK
from vbraille.sessions.planning.values import Look


class Stimulus(Struct, frozen=True, omit_defaults=True):
    """A string of cells that is felt at once.

    Parameters
    ----------
    cells
        Cells that are asked for, in Unicode braille.
    look
        How they are shown.
    before, after
        Cells around them that are shown and not asked for.
    value
        Value of the parameter that stimuli are compared by; None if they are not compared.
    """

    cells: str
    look: Look
    before: str = ""
    after: str = ""
    value: float | None = None

    def masks(self, lead_cells: int) -> list[int]:
        """Return the dot masks of the whole line, with blank cells before it."""
        shown = self.before + self.cells + self.after
        return [0] * lead_cells + [ord(cell) - UNICODE_BLANK for cell in shown]


class Trial(Struct, frozen=True):
    """What is shown in a trial.

    Parameters
    ----------
    practice, number
        Whether it is practice, and its number, from 1. Practice is numbered by itself.
    block
        Number of the block, from 1; 0 in practice.
    condition
        Name of the condition.
    item
        What is shown as the protocol lists it: cells in Unicode braille, or values.
    stimuli
        One stimulus to read, or several to compare, in the order in which they are felt.
    gap_s
        Time before the cue.
    catch
        "blank" or "repeat" for a trial that only keeps watch over the participant; else empty.
    """

    practice: bool
    number: int
    block: int
    condition: str
    item: str
    stimuli: tuple[Stimulus, ...]
    gap_s: float = 0.0
    catch: Literal["", "blank", "repeat"] = ""

    @property
    def key(self) -> tuple[bool, int]:
        """Practice and number, which no other trial of the session has."""
        return self.practice, self.number

    @property
    def name(self) -> str:
        """Name in sentences."""
        return f"practice {self.number}" if self.practice else f"trial {self.number}"

    @property
    def presented(self) -> str:
        """What the first stimulus is, or the values that are compared."""
        if self.stimuli[0].value is None:
            return self.stimuli[0].cells
        return " ".join(f"{stimulus.value:g}" for stimulus in self.stimuli)

    def turned(self, parameter: str, value: float) -> Trial:
        """Return the trial with its last stimulus at another value."""
        last = self.stimuli[-1]
        turned = structs.replace(last, look=last.look.changed(parameter, value), value=value)
        return structs.replace(self, stimuli=(*self.stimuli[:-1], turned))

    def at(self, parameter: str, value: float) -> Trial:
        """Return the trial with a number of its look changed."""
        stimuli = tuple(
            structs.replace(each, look=each.look.changed(parameter, value)) for each in self.stimuli
        )
        return structs.replace(self, stimuli=stimuli)
