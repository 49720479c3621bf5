"""Find how braille feels best, two ways at a time: whichever two tell most.

Knob after knob, of two values the reader chooses the one that is nearer to what is liked. Which two
come next, and what is liked, follow from the choices so far by QUEST+ (`vbraille.adaptive`): a
reader who is not sure, or errs, is asked again about what is in doubt. All follows from the list of
choices, which is kept until the course is done.
"""

from __future__ import annotations

import json
from functools import lru_cache, partial
from typing import TYPE_CHECKING, Any

from vbraille.adaptive.observer import Grid, Quest, nearer
from vbraille.errors import InputError
from vbraille.files import write_file
from vbraille.knobs import KNOBS
from vbraille.layout import cells_per_line
from vbraille.reading.commands import Where, command
from vbraille.reading.explored import Explored
from vbraille.wording import setting

if TYPE_CHECKING:
    from pathlib import Path

    import numpy as np
    from numpy.typing import NDArray

    from vbraille.display import Display
    from vbraille.knobs import Knob
    from vbraille.reading.reader import Reader
    from vbraille.render import BrailleStyle

ORDER = ("texture", "contrast", "dot_width", "dot_spacing", "cell_gap")
CHOICES_PER_KNOB = 6  # at ten seconds each, the five knobs take five minutes
_SHARES = {"dot_width": (0.5, 2.0), "dot_spacing": (0.6, 1.8), "cell_gap": (0.6, 1.8)}
_LEAST_CONTRAST = 0.2
# Ours: the model's grid. Values stand so many steps apart; how sure a reader is, as the standard
# deviation of what is felt, is so many parts of the interval; and one choice in so many is a slip.
_STEPS, _UNSURE, _SLIPS = 24, tuple(0.03 * (0.4 / 0.03) ** (n / 5) for n in range(6)), 0.03
_FARTHEST = 0.5  # between two values, as a part of the interval: no two are a world apart
_LIKED = "liked"
_command = partial(command, where=Where.TUNING)
Asked = tuple[tuple[tuple[float, float], bool], ...]


@lru_cache(maxsize=1)
def _quest() -> Quest:
    """Model of a reader who compares shares of an interval, 0 to 1."""
    shares = tuple(n / _STEPS for n in range(_STEPS + 1))
    pairs = [(a, b) for a in shares for b in shares if 0 < b - a <= _FARTHEST]
    axes = {_LIKED: shares, "unsure": _UNSURE, "slips": (_SLIPS,)}
    return Quest(Grid(nearer(), axes), pairs, _LIKED)


@lru_cache(maxsize=256)
def _next(asked: Asked) -> tuple[float, float]:
    low, high = _quest().next(asked)
    return low, high


class Course:
    """A reader's way to a tuning: what follows from the choices so far, each 1 or 2.

    Parameters
    ----------
    style, display
        Style that the course begins with, and the display that it is felt on.
    choices
        The choices.

    Attributes
    ----------
    knob : Knob or None
        Knob that the next choice is about; None at the end.
    pair : tuple[float, float]
        The two values of the next choice, in the order in which they are felt.
    style : BrailleStyle
        Style with all values that are settled.
    found : list[str]
        Sentences on the values that are settled.
    """

    total = len(ORDER) * CHOICES_PER_KNOB

    def __init__(self, style: BrailleStyle, display: Display, choices: list[int]) -> None:
        self.choices, self.style = choices, style
        self.found: list[str] = []
        self.knob: Knob | None = None
        self.pair = (0.0, 0.0)
        for number, name in enumerate(ORDER):
            knob = KNOBS[name]
            low, high = _interval(knob, style, self.style, display)
            made = choices[number * CHOICES_PER_KNOB :][:CHOICES_PER_KNOB]
            asked: Asked = ()
            for at, which in enumerate(made):
                asked = (*asked, (_next(asked), (which == 1) == _lower_first(at)))
            if len(made) < CHOICES_PER_KNOB:
                self.knob = knob
                pair = [knob.nearest(round(low + s * (high - low), 2)) for s in _next(asked)]
                self.pair = (pair[0], pair[1]) if _lower_first(len(made)) else (pair[1], pair[0])
                return
            value, interval = _liked(asked, low, high)
            self.style = _with(self.style, knob, knob.nearest(value))
            ends = f"{interval[0]:g} to {interval[1]:g} {knob.unit}".rstrip()
            self.found.append(f"{knob.said(knob.nearest(value))}, 95 % interval {ends}")

    def shown(self, which: int) -> BrailleStyle:
        """Style of the one or the other of the next choice, 1 or 2."""
        if self.knob is None:
            return self.style
        return _with(self.style, self.knob, self.pair[which - 1])


def _with(style: BrailleStyle, knob: Knob, value: Any) -> BrailleStyle:
    """Style with a value of a knob."""
    return style.replace(**{knob.field: value})


def _lower_first(number: int) -> bool:
    """Tell whether the lower value is the first of a choice: every other time, against learning."""
    return number % 2 == 0


def _liked(asked: Asked, low: float, high: float) -> tuple[float, tuple[float, float]]:
    """Value that is liked best and its interval; an end that every choice led to is it."""
    estimate = _quest().estimate(_LIKED, asked)
    mean, least, most = (
        round(low + share * (high - low), 2)
        for share in (estimate.mean, estimate.low, estimate.high)
    )
    chosen = {lower for _, lower in asked}
    if chosen == {1}:
        return low, (low, most)
    if chosen == {0}:
        return high, (least, high)
    return mean, (least, most)


def _interval(
    knob: Knob, start: BrailleStyle, now: BrailleStyle, display: Display
) -> tuple[float, float]:
    """Least and largest value that is tried, as far as there is room for a cell."""
    low, high = _SHARES.get(knob.name, (_LEAST_CONTRAST if knob.name == "contrast" else 0.0, 1.0))
    if knob.name in _SHARES:
        low, high = (knob.nearest(knob.value(start) * share) for share in (low, high))
    here = knob.value(now)
    ways = ([round(end + (here - end) * n / 20, 2) for n in range(20)] for end in (low, high))
    ends = [next((v for v in way if _fits(knob, now, display, v)), here) for way in ways]
    return ends[0], ends[1]


def _fits(knob: Knob, style: BrailleStyle, display: Display, value: float) -> bool:
    try:
        cells_per_line(_with(style, knob, value).geometry, display)
    except InputError:
        return False
    return True


class Tuning(Explored):
    """A course on its way: a practice text under the hand in one of two styles.

    Parameters
    ----------
    reader
        Reader of the practice text.
    path
        Path of the file that keeps the choices until the course is done.
    profile
        Name of the profile that the course is for.
    again
        Whether to begin anew, whatever is kept.

    Raises
    ------
    InputError
        If the choices that are kept are not of this course.
    """

    where = Where.TUNING
    doing = "tuning"

    def __init__(self, reader: Reader, path: Path, profile: str, *, again: bool) -> None:
        super().__init__(reader.device, reader.outputs)
        self.reader, self._path, self._profile = reader, path, profile
        self._start, self.which = reader.style, 1
        choices = [] if again else self._kept()
        self.course = Course(self._start, self.device.display, choices)

    def _kept(self) -> list[int]:
        if not self._path.exists():
            return []
        try:
            choices = json.loads(self._path.read_text())["choices"]
            if len(choices) > Course.total or not {1, 2}.issuperset(choices):
                raise ValueError
        except (OSError, ValueError, KeyError, TypeError):
            raise InputError(
                f"{self._path}: the kept choices are damaged; start anew with {setting('again')}"
            ) from None
        return choices

    def begin(self) -> None:
        """Say what the course is for, and ask for the first choice that is left."""
        self.say(f"profile: {self._profile}")
        if self.course.choices:
            self.say(f"going on: {len(self.course.choices)} choices made")
        self.ask_choice()

    def ask_choice(self) -> None:
        """Ask for the next choice."""
        knob = self.course.knob
        if knob is None:
            self.done = True
            return
        self.which = 1
        self.say(f"choice {len(self.course.choices) + 1} of {Course.total}: {knob.label}")
        self.feel()

    def feel(self) -> None:
        """Show the one or the other of the two."""
        self.reader.use(self.course.shown(self.which))
        self.say(f"this is {self.which}; space feels the other, 1 or 2 chooses")

    def choose(self, choices: list[int]) -> None:
        """Take a choice, or take one back, and ask the next."""
        settled = len(self.course.found)
        self._path.parent.mkdir(parents=True, exist_ok=True)
        kept = json.dumps({"profile": self._profile, "choices": choices}).encode()
        write_file(self._path, kept, replace=True, durable=True)
        self.course = Course(self._start, self.device.display, choices)
        for sentence in self.course.found[settled:]:
            self.say(sentence)
        self.ask_choice()

    def forget(self) -> None:
        """Delete the choices, once their outcome is saved."""
        self._path.unlink(missing_ok=True)

    def follow(self, ticks: NDArray[np.void]) -> None:
        """Read on."""
        self.reader.follow(ticks)

    def steer(self) -> None:
        """Have a simulated hand read what is under it."""
        self.reader.steer()


@_command("feel the other one", "space", also="button:3", first=True)
def other(tuning: Tuning) -> None:
    tuning.which = 3 - tuning.which
    tuning.feel()


@_command("choose the first", "1", also="button:1", first=True)
def first(tuning: Tuning) -> None:
    tuning.choose([*tuning.course.choices, 1])


@_command("choose the second", "2", also="button:2", first=True)
def second(tuning: Tuning) -> None:
    tuning.choose([*tuning.course.choices, 2])


@_command("take the last choice back", "u", first=True)
def undo(tuning: Tuning) -> None:
    if tuning.course.choices:
        tuning.choose(tuning.course.choices[:-1])
    else:
        tuning.refuse("nothing to undo")


@_command("next line", "n down", first=True)
def next_line(tuning: Tuning) -> None:
    _step(tuning, 1)


@_command("previous line", "p up", first=True)
def previous_line(tuning: Tuning) -> None:
    _step(tuning, -1)


def _step(tuning: Tuning, step: int) -> None:
    line = tuning.reader.beside(step)
    if line is None:
        tuning.refuse("no next line" if step > 0 else "no previous line")
    else:
        tuning.reader.show(line)


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
    """Text to practise on, the same paragraph again and again; English where there is no other."""
    known = _TEXTS.get((language or "en").split("-")[0].lower(), _TEXTS["en"])
    return "\n\n".join([known] * _TIMES)
