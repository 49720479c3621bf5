"""Find out how braille feels best: two ways at a time, from far apart to close together.

Knob after knob, an interval is narrowed by golden sections: of two values in it the reader chooses
one, and what lies beyond the other is given up. One of the two is felt again in the next choice. A
course is a value that follows from the choices alone, so that it is undone, kept and taken up
again by its list of choices.
"""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

from vbraille.errors import InputError
from vbraille.render.braille.knobs import KNOBS, StyleKnob, kept_values, obstacle, with_values

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.render import Model
    from vbraille.render.braille.style import BrailleStyle

    Which = Literal[1, 2]

ORDER = ("texture", "contrast", "dot_width_mm", "dot_spacing_mm")
CHOICES_PER_KNOB = 5  # which narrow an interval to 9 % of its width
FORMAT = 1
_GOLDEN = 0.618033988749895
_PLACES = 2  # decimal places of a value that is felt
# Least and largest value of each knob: as it is, or as a multiple of what the style begins with.
_LEAST_CONTRAST = 0.2
_SHARES = {"dot_width_mm": (0.5, 2.0), "dot_spacing_mm": (0.6, 1.8)}


@dataclass(frozen=True, slots=True)
class Span:
    """An interval in which the best value of a knob is looked for.

    Parameters
    ----------
    low, high
        Ends of the interval.
    least, most
        Ends that it began with.
    best
        Value chosen last; None before the first choice.
    """

    low: float
    high: float
    least: float
    most: float
    best: float | None = None

    @property
    def pair(self) -> tuple[float, float]:
        """The two values that are compared next, the lower first."""
        part = _GOLDEN * (self.high - self.low)
        return round(self.high - part, _PLACES), round(self.low + part, _PLACES)

    def after(self, *, lower: bool) -> Span:
        """Interval after a choice of the lower or the higher of the two."""
        part = _GOLDEN * (self.high - self.low)
        best = self.pair[0 if lower else 1]
        if lower:
            return replace(self, high=self.low + part, best=best)
        return replace(self, low=self.high - part, best=best)

    @property
    def result(self) -> float:
        """Value that was found; an end from which every choice led nowhere else is it."""
        if self.best is None:
            return round((self.low + self.high) / 2, _PLACES)
        if self.high == self.most:
            return self.most
        return self.least if self.low == self.least else self.best


@dataclass(frozen=True, slots=True)
class _Stand:
    """How far the choices have brought a course."""

    style: BrailleStyle
    found: tuple[tuple[StyleKnob, float], ...]
    knob: StyleKnob | None
    span: Span | None


@dataclass(frozen=True, slots=True)
class TuningCourse:
    """A reader's way to a tuning, by choices of this or that.

    Parameters
    ----------
    start
        Display, and the style that the course begins with.
    choices
        The choices so far, each 1 or 2.
    """

    start: Model
    choices: tuple[Which, ...] = ()

    @property
    def total(self) -> int:
        """Number of choices in all."""
        return len(ORDER) * CHOICES_PER_KNOB

    @property
    def done(self) -> bool:
        """Whether every choice is made."""
        return len(self.choices) >= self.total

    @property
    def knob(self) -> StyleKnob | None:
        """StyleKnob that the next choice is about; None at the end."""
        return self._stand().knob

    @property
    def found(self) -> tuple[tuple[StyleKnob, float], ...]:
        """Knobs that are settled so far, with their values."""
        return self._stand().found

    @property
    def style(self) -> BrailleStyle:
        """Style with all values that are settled so far."""
        return self._stand().style

    def shown(self, which: Which) -> BrailleStyle:
        """Style of the one or the other of the next choice; at the end, the one that was found."""
        stand = self._stand()
        if stand.knob is None or stand.span is None:
            return stand.style
        value = stand.span.pair[which - 1 if self._lower_first else 2 - which]
        return stand.style.replace(**{stand.knob.field: value})

    def choose(self, which: Which) -> TuningCourse:
        """Course after a choice.

        Raises
        ------
        ValueError
            If every choice is made.
        """
        if self.done:
            raise ValueError("every choice of this course is made")
        return replace(self, choices=(*self.choices, which))

    def undo(self) -> TuningCourse:
        """Course before the last choice; the same one if there was none."""
        return replace(self, choices=self.choices[:-1])

    @property
    def _lower_first(self) -> bool:
        return _lower_first(len(self.choices))

    def _stand(self) -> _Stand:
        style, found = self.start.style, []
        choices = iter(enumerate(self.choices))
        for name in ORDER:
            knob = KNOBS[name]
            span = _span(knob, style, self.start)
            for _ in range(CHOICES_PER_KNOB):
                made = next(choices, None)
                if made is None:
                    return _Stand(style, tuple(found), knob, span)
                number, which = made
                span = span.after(lower=(which == 1) == _lower_first(number))
            style = style.replace(**{knob.field: span.result})
            found.append((knob, span.result))
        return _Stand(style, tuple(found), None, None)


def _lower_first(number: int) -> bool:
    """Whether the lower value is the first of a choice: every other time, so that nobody learns."""
    return number % 2 == 0


def _span(knob: StyleKnob, style: BrailleStyle, start: Model) -> Span:
    """Interval of values of a knob that are tried in a style."""
    low, high = knob.low, knob.high
    if knob.name == "contrast":
        low = _LEAST_CONTRAST
    if knob.name in _SHARES:
        value = knob.value(start.style)
        low, high = (round(value * share, _PLACES) for share in _SHARES[knob.name])
    low, high = max(low, knob.low), min(high, knob.high)
    for end in _halves(high, low):
        if not obstacle(knob, style.geometry, start.display, end):
            high = end
            break
    for end in _halves(low, high):
        if not obstacle(knob, style.geometry, start.display, end):
            low = end
            break
    return Span(low, high, low, high)


def _halves(end: float, other: float) -> Iterator[float]:
    """Values from one end of an interval to the other, which the last of them is."""
    for n in range(21):
        yield round(end + (other - end) * n / 20, _PLACES)


def to_json(course: TuningCourse, profile: str, display: str) -> str:
    """Text that keeps a course.

    Parameters
    ----------
    profile
        Name of the profile that it is for.
    display
        Name of the display, as a settings file has it.
    """
    kept = {
        "format": FORMAT,
        "profile": profile,
        "display": display,
        "start": kept_values(course.start.style),
        "choices": list(course.choices),
    }
    return json.dumps(kept, indent=1) + "\n"


def from_json(text: str, model: Model) -> TuningCourse:
    """Course that a text keeps, on the same display.

    Raises
    ------
    InputError
        If the text keeps none that goes on with this program and display.
    """
    try:
        kept = json.loads(text)
        if kept["format"] != FORMAT:
            raise ValueError
        style = with_values(model.style, model.display, kept["start"])
        course = TuningCourse(replace(model, style=style), tuple(kept["choices"]))
        if len(course.choices) > course.total or not {1, 2}.issuperset(course.choices):
            raise ValueError
    except (ValueError, KeyError, TypeError, InputError, RecursionError):
        raise InputError("the choices that were kept cannot be gone on with") from None
    return course
