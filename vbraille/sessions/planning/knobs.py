"""Numbers that stimuli may differ in: what two are compared by, and what a procedure varies."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

from vbraille.braille.geometry import BOUNDS_MM

if TYPE_CHECKING:
    from vbraille.sessions.planning.stimuli import Stimulus

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
