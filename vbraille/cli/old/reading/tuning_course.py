"""Find out how braille feels best, two ways at a time: whichever two tell most.

Knob after knob, of two values the reader chooses the one that is nearer to what is liked. Which two
come next, and what is liked, follow from the choices so far by QUEST+ (`vbraille.adaptive`): a
reader who is not sure, or errs, is asked again about what is in doubt. A course is a value that
follows from the choices alone, so that it is undone, kept and taken up again by its list of
choices.
"""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TYPE_CHECKING, Literal, NamedTuple

from vbraille.cli.old.reading.questplus import GridAxis, geometric, nearer_quest, ordered_pairs
from vbraille.config.settings import KNOBS, kept_values, obstacle, with_values
from vbraille.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.cli.old.reading.questplus import GridQuest
    from vbraille.config.options import StyleKnob
    from vbraille.render import Model
    from vbraille.render.braille.style import BrailleStyle

    Which = Literal[1, 2]
    Compared = tuple[tuple[tuple[float, float], int], ...]

ORDER = ("texture", "contrast", "dot_width_mm", "dot_spacing_mm")
CHOICES_PER_KNOB = 7  # at ten seconds each, the four knobs take five minutes
FORMAT = 2
_PLACES = 2  # decimal places of a value that is felt
# Least and largest value of each knob: as it is, or as a multiple of what the style begins with.
_LEAST_CONTRAST = 0.2
_SHARES = {"dot_width_mm": (0.5, 2.0), "dot_spacing_mm": (0.6, 1.8)}
# Ours: the model's grid. Values stand so many steps apart; how sure a reader is, as the standard
# deviation of what is felt, is so many parts of the interval; and one choice in so many is a slip.
_STEPS = 24
_UNSURE = geometric(0.03, 0.4, 6)
_SLIPS = 0.03
_FARTHEST = 0.5  # between two values, as a part of the interval: no two are a world apart
_LIKED = "liked"


class TunedKnob(NamedTuple):
    """Finding on a knob.

    Parameters
    ----------
    knob
        The knob.
    value
        Value that is liked best.
    low, high
        Ends of the interval that holds it with 95 %.
    """

    knob: StyleKnob
    value: float
    low: float
    high: float


@dataclass(frozen=True, slots=True)
class Span:
    """Values of a knob among which the best is looked for, and the choices made of them.

    Parameters
    ----------
    low, high
        Ends of the interval.
    asked
        Pairs that were compared, as shares of the interval, the lower first, each with whether the
        lower was chosen, 1 or 0.
    """

    low: float
    high: float
    asked: Compared = ()

    @property
    def pair(self) -> tuple[float, float]:
        """The two values that are compared next, the lower first."""
        return self._scaled(_next(self.asked))

    def after(self, *, lower: bool) -> Span:
        """Values and choices after a choice of the lower or the higher of the two."""
        return replace(self, asked=(*self.asked, (_next(self.asked), int(lower))))

    def found(self, knob: StyleKnob) -> TunedKnob:
        """Value that is liked best; an end from which every choice led nowhere else is it."""
        estimate = _quest().estimate(self.asked, _LIKED)
        low, high = self._scaled((estimate.low, estimate.high))
        value, _ = self._scaled((estimate.mean, estimate.mean))
        lower = {chosen for _, chosen in self.asked}
        if lower == {1}:
            value = low = self.low
        elif lower == {0}:
            value = high = self.high
        return TunedKnob(knob, value, low, high)

    def _scaled(self, shares: tuple[float, float]) -> tuple[float, float]:
        """Values at two shares of the interval, as they are felt."""
        width = self.high - self.low
        low, high = (round(self.low + share * width, _PLACES) for share in shares)
        return low, high


@lru_cache(maxsize=1)
def _quest() -> GridQuest:
    """Model of a reader who compares shares of an interval, 0 to 1."""
    shares = tuple(n / _STEPS for n in range(_STEPS + 1))
    return nearer_quest(
        [(low, high) for low, high in ordered_pairs(shares) if high - low <= _FARTHEST],
        GridAxis(_LIKED, shares),
        GridAxis("unsure", _UNSURE),
        GridAxis("slips", (_SLIPS,)),
        about=_LIKED,
    )


@lru_cache(maxsize=256)
def _next(asked: Compared) -> tuple[float, float]:
    """Shares that are compared after some choices."""
    low, high = _quest().next(asked)
    return low, high


@dataclass(frozen=True, slots=True)
class _Progress:
    """Progress of a course after its choices."""

    style: BrailleStyle
    found: tuple[TunedKnob, ...]
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
        """Tell whether every choice is made."""
        return len(self.choices) >= self.total

    @property
    def knob(self) -> StyleKnob | None:
        """StyleKnob that the next choice is about; None at the end."""
        return self._progress().knob

    @property
    def found(self) -> tuple[TunedKnob, ...]:
        """Knobs that are settled so far, with their values."""
        return self._progress().found

    @property
    def style(self) -> BrailleStyle:
        """Style with all values that are settled so far."""
        return self._progress().style

    def shown(self, which: Which) -> BrailleStyle:
        """Style of the one or the other of the next choice; at the end, the one that was found."""
        progress = self._progress()
        if progress.knob is None or progress.span is None:
            return progress.style
        value = progress.span.pair[which - 1 if self._lower_first else 2 - which]
        return progress.knob.applied(progress.style, value)

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

    def _progress(self) -> _Progress:
        style, found = self.start.style, []
        choices = iter(enumerate(self.choices))
        for name in ORDER:
            knob = KNOBS[name]
            span = _span(knob, style, self.start)
            for _ in range(CHOICES_PER_KNOB):
                made = next(choices, None)
                if made is None:
                    return _Progress(style, tuple(found), knob, span)
                number, which = made
                span = span.after(lower=(which == 1) == _lower_first(number))
            settled = span.found(knob)
            style = knob.applied(style, settled.value)
            found.append(settled)
        return _Progress(style, tuple(found), None, None)


def _lower_first(number: int) -> bool:
    """Tell whether the lower value is the first of a choice: every other time, against learning."""
    return number % 2 == 0


def _span(knob: StyleKnob, style: BrailleStyle, start: Model) -> Span:
    """Interval of values of a knob that are tried in a style."""
    low, high = knob.low, knob.high
    if knob.key == "contrast":
        low = _LEAST_CONTRAST
    if knob.key in _SHARES:
        value = knob.value(start.style)
        low, high = (round(value * share, _PLACES) for share in _SHARES[knob.key])
    low, high = max(low, knob.low), min(high, knob.high)
    for end in _halves(high, low):
        if not obstacle(knob, style.geometry, start.display, end):
            high = end
            break
    for end in _halves(low, high):
        if not obstacle(knob, style.geometry, start.display, end):
            low = end
            break
    return Span(low, high)


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


_TEXTS = {
    "en": (
        "The night train stops at a small station where nobody gets on. A man with a lamp walks "
        "along the carriages, knocks at each wheel and listens. When the last one has rung, he "
        "lifts the lamp, and the train goes on towards the sea."
    ),
    "fr": (
        "Le train de nuit s'arrête dans une petite gare où personne ne monte. Un homme avec une "
        "lampe longe les voitures, frappe sur chaque roue et écoute. Quand la dernière a sonné, "
        "il lève la lampe, et le train repart vers la mer."
    ),
    "de": (
        "Der Nachtzug hält an einem kleinen Bahnhof, an dem niemand einsteigt. Ein Mann mit einer "
        "Lampe geht an den Wagen entlang, klopft an jedes Rad und horcht. Wenn das letzte "
        "geklungen hat, hebt er die Lampe, und der Zug fährt weiter zum Meer."
    ),
}
_TIMES = 100  # paragraphs; a reader who tries everything twice needs some twenty


def practice_text(language: str | None = None) -> str:
    """Text to practise on, again and again the same paragraph, in a language if there is one.

    Parameters
    ----------
    language
        Language, such as "fr" or "fr-CA"; English for None and where there is no such text.
    """
    known = _TEXTS.get((language or "en").split("-")[0].lower(), _TEXTS["en"])
    return "\n\n".join([known] * _TIMES)
