"""Find how braille feels best, two ways at a time.

Knob after knob, of two values the reader chooses the one that is nearer to what is liked. Each
choice narrows the interval in which that is, by less than half, so that one error is made good by
the next choices. All follows from the list of choices.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

from vbraille.knobs import KNOBS
from vbraille.reading.commands import Where, both_ways, command
from vbraille.reading.explored import Explored

if TYPE_CHECKING:
    from vbraille.knobs import Knob
    from vbraille.reading.reader import Reader
    from vbraille.render import BrailleStyle

CHOICES_PER_KNOB = 6  # at ten seconds each, the five knobs take five minutes
# Interval of each knob; of distances, as parts of what the style has.
_WITHIN = {
    "texture": (0.0, 1.0), "contrast": (0.2, 1.0), "dot_width": (0.5, 2.0),
    "dot_spacing": (0.6, 1.8), "cell_gap": (0.6, 1.8),
}  # fmt: skip
_KEPT = 0.7  # of an interval, after a choice; an error is made good as long as this is over 0.5
_command = partial(command, where=Where.TUNING)


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

    total = len(_WITHIN) * CHOICES_PER_KNOB

    def __init__(self, style: BrailleStyle, choices: list[int]) -> None:
        self.choices, self.style = choices, style
        self.found: list[str] = []
        self.knob: Knob | None = None
        self.pair = (0.0, 0.0)
        for number, (name, within) in enumerate(_WITHIN.items()):
            knob = KNOBS[name]
            least, most = (end * (knob.value(style) if knob.unit else 1.0) for end in within)
            low, high, made = least, most, choices[number * CHOICES_PER_KNOB :][:CHOICES_PER_KNOB]
            for asked, which in enumerate(made):
                kept = _KEPT * (high - low)
                if (which == 1) == (asked % 2 == 0):  # the lower value comes first every other time
                    high = low + kept
                else:
                    low = high - kept
            quarter = (high - low) / 4
            if len(made) < CHOICES_PER_KNOB:
                self.knob = knob
                ends = knob.nearest(low + quarter), knob.nearest(high - quarter)
                self.pair = ends if len(made) % 2 == 0 else ends[::-1]
                return
            # An end that every choice led to is liked best.
            liked = low if low == least else high if high == most else (low + high) / 2
            self.style = _with(self.style, knob, knob.nearest(liked))
            self.found.append(knob.said(knob.nearest(liked)))

    def shown(self, which: int) -> BrailleStyle:
        """Style of the one or the other of the next choice, 1 or 2."""
        if self.knob is None:
            return self.style
        return _with(self.style, self.knob, self.pair[which - 1])


def _with(style: BrailleStyle, knob: Knob, value: Any) -> BrailleStyle:
    """Style with a value of a knob."""
    return style.replace(**{knob.field: value})


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

    @both_ways(
        ("choose the first", "choose the second"), "1 | 2", also="button:1 | button:2",
        name="first second", first=True, where=Where.TUNING,
    )  # fmt: skip
    def choose(self, step: int) -> None:
        """Choose the first, or the second where the step is -1."""
        self._choose([*self.course.choices, 1 if step > 0 else 2])

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
