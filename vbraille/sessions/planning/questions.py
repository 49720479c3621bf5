"""The kinds of question, a class each. A new kind is a new class, and its name in `AnyQuestion`.

A class knows everything about its kind: what may be typed, how that is read and scored, how an
answer is said, what stands in the table, and how the simulated reader answers.
"""

from __future__ import annotations

import math
from typing import Annotated, ClassVar, Literal, NamedTuple

import numpy as np
from msgspec import Meta

from vbraille.braille.cells import UNICODE_BLANK
from vbraille.braille.spelling import (
    ORDINALS,
    UNREAD,
    parse_answer,
    parse_choice,
    say_cells,
    to_answer,
    to_braille,
)
from vbraille.sessions.planning.trial import Trial
from vbraille.sessions.planning.values import Label, Sentence
from vbraille.sessions.simulated.feeling import FeltTrial, nearer
from vbraille.sessions.simulated.observer import LEAST_FELT, TIE
from vbraille.toml import Table, WrongValue

RIGHT, WRONG = "right", "wrong"
HIT, MISS, FALSE_ALARM, REJECTION = "hit", "miss", "false alarm", "correct rejection"
GOOD = frozenset((RIGHT, HIT, REJECTION))
LEAST_SHARE = 1e-3  # a magnitude may not be 0


class Spelling(NamedTuple):
    """How cells are spelled in answers: dot masks of the keys, and the dots that are shown."""

    keys: dict[str, int]
    shown_dots: int


class Scale(Table, kw_only=True):
    """A scale of whole numbers."""

    least: int
    most: int

    def __post_init__(self) -> None:
        if not self.least < self.most <= self.least + 100:
            raise WrongValue("most", f"must be more than least, {self.least}, by 100 at most")

    def parse(self, text: str) -> int:
        """Read a number of the scale; ValueError if the text is none."""
        word = text.strip()
        if not word.removeprefix("-").isdecimal() or not self.least <= int(word) <= self.most:
            raise ValueError(f"{word!r} is not on the scale; type {self.least} to {self.most}")
        return int(word)


class Question(Table, kw_only=True, tag_field="kind"):
    """What all kinds have.

    Parameters
    ----------
    ask
        The question in words, which the experimenter says.
    confidence
        Scale on which it is asked how sure the answer is; None if it is not asked.
    """

    typed: ClassVar[str] = "the answer"  # what may be typed
    designs: ClassVar[tuple[str, ...]] = ()  # kinds of design that it is asked of; none for all
    counts_catch: ClassVar[bool] = False  # whether catch trials are what is asked about

    ask: Sentence = "What was it?"
    confidence: Scale | None = None

    @property
    def kind(self) -> str:
        """Name of the kind in protocols and tables."""
        return str(self.__struct_config__.tag)

    def steps(self, line: str) -> int | None:
        """Return by how many steps a line turns what is shown; None if it turns nothing."""
        return None

    def parse(self, text: str, trial: Trial, spelling: Spelling) -> str:
        """Return an answer in the spelling in which it is kept; ValueError if the text is none."""
        raise NotImplementedError

    def outcome(self, trial: Trial, answer: str) -> str:
        """Return how an answer is scored; empty if nothing is right or wrong."""
        return ""

    def correct(self, trial: Trial, answer: str) -> bool | None:
        """Tell whether an answer is right; None if nothing is."""
        outcome = self.outcome(trial, answer)
        return outcome in GOOD if outcome else None

    def positive(self, trial: Trial, answer: str) -> bool:
        """Tell whether an answer counts as a positive one for a procedure."""
        return bool(self.correct(trial, answer))

    def said(self, answer: str, spelling: Spelling) -> str:
        """Return an answer as it is spoken."""
        return answer

    def was(self, trial: Trial, spelling: Spelling) -> str:
        """Return the right answer as it is spoken, for feedback; empty if there is none."""
        return ""

    def cell(self, trial: Trial, answer: str) -> str:
        """Return an answer as it stands in the table."""
        return answer

    def simulate(self, felt: FeltTrial, noise: float, random: np.random.Generator) -> str:
        """Answer by what was felt."""
        raise NotImplementedError


class Identify(Question, kw_only=True, tag="identify"):
    """Which cells were shown?"""

    designs = ("list", "combinations")
    typed = "letters, keys or dot numbers; ? for a cell that was not read"

    def parse(self, text: str, trial: Trial, spelling: Spelling) -> str:
        """Read cells."""
        places = len(trial.stimuli[0].cells)
        keys, shown_dots = spelling
        return parse_answer(text, places=places, keys=keys, shown_dots=shown_dots)

    def outcome(self, trial: Trial, answer: str) -> str:
        """Return right if all cells are; of a blank catch trial, if no dot was felt."""
        if trial.catch == "blank":
            return RIGHT if set(answer) <= {UNREAD, to_braille((0,))} else WRONG
        return RIGHT if answer == trial.stimuli[0].cells else WRONG

    def said(self, answer: str, spelling: Spelling) -> str:
        """Return the cells by their letters and keys."""
        return say_cells(answer, spelling.keys)

    def was(self, trial: Trial, spelling: Spelling) -> str:
        """Return the cells."""
        return self.said(trial.stimuli[0].cells, spelling)

    def simulate(self, felt: FeltTrial, noise: float, random: np.random.Generator) -> str:
        """Give the cells as they were felt."""
        return to_answer(felt.cells(random))


class Choose(Question, kw_only=True, tag="which"):
    """Which of the stimuli was it?

    Parameters
    ----------
    right
        Which value is right: the one with more, or with less; None if it is a preference.
    """

    designs = ("pairs", "standard")
    typed = "1 or 2, for the first or the second"

    right: Literal["more", "less"] | None = None

    def parse(self, text: str, trial: Trial, spelling: Spelling) -> str:
        """Read a choice."""
        return parse_choice(text, len(trial.stimuli))

    def outcome(self, trial: Trial, answer: str) -> str:
        """Return right if the chosen value is the most, or the least."""
        if self.right is None:
            return ""
        values = [stimulus.value for stimulus in trial.stimuli]
        best = max(values) if self.right == "more" else min(values)
        return RIGHT if values[int(answer) - 1] == best else WRONG

    def said(self, answer: str, spelling: Spelling) -> str:
        """Return the ordinal."""
        return ORDINALS[int(answer) - 1]

    def cell(self, trial: Trial, answer: str) -> str:
        """Return the value that was chosen."""
        return f"{trial.stimuli[int(answer) - 1].value:g}"

    def simulate(self, felt: FeltTrial, noise: float, random: np.random.Generator) -> str:
        """Choose what is nearest to the usual length, or what is right, or the strongest."""
        values, unit = felt.values()
        if self.right is None and felt.by_length:
            return str(nearer(values, unit, noise, random))
        worth = [-value if self.right == "less" else value for value in values]
        drawn = np.array(worth) + noise * unit * random.standard_normal(len(worth))
        return str(int(np.nan_to_num(drawn, nan=-math.inf).argmax()) + 1)


class Same(Question, kw_only=True, tag="same-different"):
    """Were the two the same, or different?"""

    designs = ("pairs", "standard")
    typed = "same or different"

    def parse(self, text: str, trial: Trial, spelling: Spelling) -> str:
        """Read same or different, or the first letter."""
        for word in ("same", "different"):
            if text.strip().lower() in (word, word[0]):
                return word
        raise ValueError(f"{text.strip()!r} is not an answer; type same or different")

    def outcome(self, trial: Trial, answer: str) -> str:
        """Return hit, miss, false alarm or correct rejection; different ones are the signal."""
        first, second = trial.stimuli
        if first == second:
            return FALSE_ALARM if answer == "different" else REJECTION
        return HIT if answer == "different" else MISS

    def simulate(self, felt: FeltTrial, noise: float, random: np.random.Generator) -> str:
        """Say different of what is felt to differ by more than the noise."""
        (one, two), unit = felt.values()
        apart = abs(one - two) / unit + noise * math.sqrt(2) * float(random.standard_normal())
        return "different" if abs(apart) > max(noise * math.sqrt(2), TIE) else "same"


class Adjust(Question, kw_only=True, tag="adjust"):
    """Make it equal.

    Parameters
    ----------
    step
        Smallest turn of the value.
    least, most
        Bounds of the value.
    """

    designs = ("standard",)
    typed = "+ or - to turn it (++ twice), equal when it is"

    step: Annotated[float, Meta(gt=0)]
    least: float
    most: float

    def __post_init__(self) -> None:
        if self.least + self.step > self.most:
            raise WrongValue("most", "must be a step above least, or more")

    def steps(self, line: str) -> int | None:
        """Return by how many steps a line turns the value; None if it is an answer."""
        word = line.strip()
        if not word or set(word) - {"+", "-"}:
            return None
        return word.count("+") - word.count("-")

    def turned(self, value: float, steps: int) -> float:
        """Return a value turned by some steps."""
        return round(min(max(value + steps * self.step, self.least), self.most), 9)

    def parse(self, text: str, trial: Trial, spelling: Spelling) -> str:
        """Return the value that is shown, if it is equal."""
        if text.strip().lower() not in ("equal", "="):
            raise ValueError(f"{text.strip()!r} is not an answer; type {self.typed}")
        return f"{trial.stimuli[-1].value:.9g}"

    def simulate(self, felt: FeltTrial, noise: float, random: np.random.Generator) -> str:
        """Turn by as many steps as the two are felt to differ."""
        values, unit = felt.values()
        drawn = noise * unit * random.standard_normal(2)
        apart = values[-1] + drawn[1] - (values[0] + drawn[0])
        steps = round(abs(apart) / self.step) if math.isfinite(apart) else 0
        if not steps or felt.turns > (self.most - self.least) / self.step:
            return "equal"
        return ("-" if apart > 0 else "+") * steps


class Free(Question, kw_only=True, tag="free"):
    """What was it, in any words?"""

    def parse(self, text: str, trial: Trial, spelling: Spelling) -> str:
        """Return the words."""
        if not text.strip():
            raise ValueError("nothing was typed; type any words")
        return text.strip()

    def simulate(self, felt: FeltTrial, noise: float, random: np.random.Generator) -> str:
        """Say how strong it was."""
        return f"strength {felt.strength():.2f}"


class Detect(Question, kw_only=True, tag="detect"):
    """Was there anything?"""

    designs = ("list", "combinations")
    typed = "yes or no"
    counts_catch = True

    def parse(self, text: str, trial: Trial, spelling: Spelling) -> str:
        """Read yes or no, or the first letter."""
        for word in ("yes", "no"):
            if text.strip().lower() in (word, word[0]):
                return word
        raise ValueError(f"{text.strip()!r} is not an answer; type yes or no")

    def outcome(self, trial: Trial, answer: str) -> str:
        """Return hit, miss, false alarm or correct rejection."""
        (stimulus,) = trial.stimuli
        blank = set(stimulus.cells) == {chr(UNICODE_BLANK)} or stimulus.look.contrast == 0
        if blank:
            return FALSE_ALARM if answer == "yes" else REJECTION
        return HIT if answer == "yes" else MISS

    def positive(self, trial: Trial, answer: str) -> bool:
        """Tell whether the answer is yes."""
        return answer == "yes"

    def simulate(self, felt: FeltTrial, noise: float, random: np.random.Generator) -> str:
        """Say yes to what is felt beyond the noise."""
        strength = felt.strength() + noise * float(random.standard_normal())
        return "yes" if strength > max(noise, LEAST_FELT) else "no"


class Rate(Question, kw_only=True, tag="rating"):
    """How much of something was there, on a scale?"""

    scale: Label
    least: int = 1
    most: int = 7

    def __post_init__(self) -> None:
        Scale(least=self.least, most=self.most)

    def parse(self, text: str, trial: Trial, spelling: Spelling) -> str:
        """Read a number of the scale."""
        return str(Scale(least=self.least, most=self.most).parse(text))

    def simulate(self, felt: FeltTrial, noise: float, random: np.random.Generator) -> str:
        """Put the strength, from 0 to 1, on the scale."""
        share = felt.strength(-1) + noise * float(random.standard_normal())
        return str(self.least + round(min(max(share, 0.0), 1.0) * (self.most - self.least)))


class Magnitude(Question, kw_only=True, tag="magnitude"):
    """How strong was it, as any number above 0?

    Parameters
    ----------
    modulus
        Number that participants are told for a standard; None if they choose one.
    """

    typed = "a number above 0"

    modulus: Annotated[float, Meta(gt=0)] | None = None

    def parse(self, text: str, trial: Trial, spelling: Spelling) -> str:
        """Read a number with a point or a comma."""
        try:
            number = float(text.strip().replace(",", "."))
        except ValueError:
            number = math.nan
        if not 0 < number < math.inf:
            raise ValueError(f"{text.strip()!r} is not an answer; type a number above 0")
        return f"{number:.15g}"

    def simulate(self, felt: FeltTrial, noise: float, random: np.random.Generator) -> str:
        """Give the strength times the modulus."""
        share = max(felt.share(), LEAST_SHARE) * math.exp(noise * float(random.standard_normal()))
        return f"{(self.modulus or 1.0) * max(share, LEAST_SHARE):.3g}"


class Pick(Question, kw_only=True, tag="name"):
    """Which of some names does it have?

    Parameters
    ----------
    names
        The names, by the keys that may be typed for them.
    right
        Right name of each item, by the item as the protocol spells it.
    """

    names: Annotated[dict[str, Label], Meta(min_length=2)]
    right: dict[str, str] = {}

    def __post_init__(self) -> None:
        for key, name in self.names.items():
            if list(self.names.values()).count(name) > 1:
                raise WrongValue(f"names.{key}", f"{name!r} is there twice")
        for item, name in self.right.items():
            if name not in self.names.values():
                raise WrongValue(f"right.{item}", f"{name!r} is not one of the names")

    def parse(self, text: str, trial: Trial, spelling: Spelling) -> str:
        """Read a key or a name."""
        word = text.strip()
        name = self.names.get(word, word)
        if name not in self.names.values():
            known = ", ".join(f"{key} {name}" for key, name in self.names.items())
            raise ValueError(f"{word!r} is not an answer; type {known}")
        return name

    def outcome(self, trial: Trial, answer: str) -> str:
        """Return right if the item has the name."""
        right = self.was(trial, Spelling({}, 0))
        return "" if not right else RIGHT if answer == right else WRONG

    def was(self, trial: Trial, spelling: Spelling) -> str:
        """Return the right name."""
        return self.right.get(say_cells(trial.item, {}).replace(" ", ""), "")

    def simulate(self, felt: FeltTrial, noise: float, random: np.random.Generator) -> str:
        """Name what the cells spell, or any."""
        letters = say_cells(to_answer(felt.cells(random)), {}).replace(" ", "")
        names = list(self.names.values())
        return self.right.get(letters, names[random.integers(len(names))])


AnyQuestion = (
    Identify | Choose | Same | Adjust | Free | Detect | Rate | Magnitude | Pick
)  # fmt: skip
