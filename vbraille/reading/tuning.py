"""Find how braille feels best, two ways at a time: whichever two tell most.

Knob after knob, of two values the reader chooses the one that is nearer to what is liked. Which two
come next, and what is liked, follow from the choices so far by QUEST+ (`vbraille.adaptive`): a
reader who is not sure, or errs, is asked again about what is in doubt. All follows from the list of
choices.
"""

from __future__ import annotations

from functools import lru_cache, partial
from typing import TYPE_CHECKING, Any

from vbraille.adaptive.observer import Grid, Quest, nearer
from vbraille.knobs import KNOBS
from vbraille.reading.commands import Where, both_ways, command
from vbraille.reading.explored import Explored

if TYPE_CHECKING:
    from vbraille.knobs import Knob
    from vbraille.reading.reader import Reader
    from vbraille.render import BrailleStyle

ORDER = ("texture", "contrast", "dot_width", "dot_spacing", "cell_gap")
CHOICES_PER_KNOB = 6  # at ten seconds each, the five knobs take five minutes
_SHARES = {"dot_width": (0.5, 2.0), "dot_spacing": (0.6, 1.8), "cell_gap": (0.6, 1.8)}
_LEAST = {"contrast": 0.2}
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
    style
        Style that the course begins with.
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

    def __init__(self, style: BrailleStyle, choices: list[int]) -> None:
        self.choices, self.style = choices, style
        self.found: list[str] = []
        self.knob: Knob | None = None
        self.pair = (0.0, 0.0)
        for number, knob in enumerate(KNOBS[name] for name in ORDER):
            low, high = _LEAST.get(knob.name, 0.0), 1.0
            if knob.unit:
                low, high = (knob.value(style) * share for share in _SHARES[knob.name])
            asked: Asked = ()
            for which in choices[number * CHOICES_PER_KNOB :][:CHOICES_PER_KNOB]:
                asked = (*asked, (_next(asked), (which == 1) == _lower_first(asked)))
            if len(asked) < CHOICES_PER_KNOB:
                self.knob = knob
                ends = [knob.nearest(round(low + s * (high - low), 2)) for s in _next(asked)]
                first, second = ends if _lower_first(asked) else ends[::-1]
                self.pair = first, second
                return
            liked, least, most = (round(low + s * (high - low), 2) for s in _liked(asked))
            value = knob.nearest(liked)
            self.style = _with(self.style, knob, value)
            ends = f"{least:g} to {most:g} {knob.unit}".rstrip()
            self.found.append(f"{knob.said(value)}, 95 % interval {ends}")

    def shown(self, which: int) -> BrailleStyle:
        """Style of the one or the other of the next choice, 1 or 2."""
        if self.knob is None:
            return self.style
        return _with(self.style, self.knob, self.pair[which - 1])


def _with(style: BrailleStyle, knob: Knob, value: Any) -> BrailleStyle:
    """Style with a value of a knob."""
    return style.replace(**{knob.field: value})


def _lower_first(asked: Asked) -> bool:
    """Tell whether the lower value is the first of a choice: every other time, against learning."""
    return len(asked) % 2 == 0


def _liked(asked: Asked) -> tuple[float, float, float]:
    """Share that is liked best and its interval; an end that every choice led to is it."""
    estimate = _quest().estimate(_LIKED, asked)
    lower = [lower for _, lower in asked]
    if all(lower):
        return 0.0, 0.0, estimate.high
    if not any(lower):
        return 1.0, estimate.low, 1.0
    return estimate.mean, estimate.low, estimate.high


class Tuning(Explored):
    """A course on its way: a practice text under the hand in one of two styles.

    Parameters
    ----------
    reader
        Reader of the practice text.
    profile
        Name of the profile that the course is for.
    """

    where = Where.TUNING
    doing = "tuning"

    def __init__(self, reader: Reader, profile: str) -> None:
        super().__init__(reader.device, reader.outputs)
        self.reader, self._profile = reader, profile
        self._start, self._which = reader.style, 1
        self.course = Course(self._start, [])
        # What the loop asks of a reader:
        self.follow, self.steer = reader.follow, reader.steer

    def begin(self) -> None:
        """Say what the course is for, and ask for the first choice that is left."""
        self.say(f"profile: {self._profile}")
        self._ask()

    def _ask(self) -> None:
        """Ask for the next choice."""
        if self.course.knob is None:
            self.done = True
            return
        label = self.course.knob.label
        self.say(f"choice {len(self.course.choices) + 1} of {Course.total}: {label}")
        self._feel(1)

    def _feel(self, which: int) -> None:
        """Show the one or the other of the two."""
        self._which = which
        self.reader.use(self.course.shown(which))
        self.say(f"this is {which}; space feels the other, 1 or 2 chooses")

    def _choose(self, choices: list[int]) -> None:
        """Take a choice, or take one back, and ask the next."""
        settled = len(self.course.found)
        self.course = Course(self._start, choices)
        for sentence in self.course.found[settled:]:
            self.say(sentence)
        self._ask()

    @_command("feel the other one", "space", also="button:3", first=True)
    def other(self) -> None:
        """Feel the other one."""
        self._feel(3 - self._which)

    @_command("choose the first", "1", also="button:1", first=True)
    def first(self) -> None:
        """Choose the first."""
        self._choose([*self.course.choices, 1])

    @_command("choose the second", "2", also="button:2", first=True)
    def second(self) -> None:
        """Choose the second."""
        self._choose([*self.course.choices, 2])

    @_command("take the last choice back", "u", first=True)
    def undo(self) -> None:
        """Take the last choice back."""
        if self.course.choices:
            self._choose(self.course.choices[:-1])
        else:
            self.refuse("nothing to undo")

    @both_ways("line", "n down | p up", first=True, where=Where.TUNING)
    def line(self, step: int) -> None:
        """Read the next line, or the one before."""
        line = self.reader.beside(step)
        if line is None:
            self.refuse_step(step, "line")
        else:
            self.reader.show(line)


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
