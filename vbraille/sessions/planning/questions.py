"""The kinds of question, a class each. A new kind is a new class, and its name in `AnyQuestion`.

A class knows everything about its kind: what may be typed, how that is read and scored, how an
answer is said, what stands in the table, and how the simulated reader answers.

The simulated reader goes by the cells that it feels, or by one number of a stimulus: a length in
mm, or the strength of its strongest dot in units of E₀. Noise is normal. It says yes, or different,
beyond one standard deviation of its noise. All this is for trying out protocols, and claims nothing
about people.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import product
from typing import Annotated, ClassVar, Literal, NamedTuple

import numpy as np
from msgspec import Meta

from vbraille.braille.spelling import ORDINALS, UNREAD, parse_answer, say_cells, to_braille
from vbraille.devices.events import Button, Knob
from vbraille.sessions.planning.spellings import parse_text
from vbraille.sessions.planning.trial import BLANK, Trial
from vbraille.sessions.planning.values import ButtonNumber, Label, Number, Positive, Sentence
from vbraille.sessions.simulated.feeling import LENGTHS, TIE, FeltTrial
from vbraille.sessions.simulated.observer import LEAST_FELT
from vbraille.toml import Table, WrongValue

RIGHT, WRONG = "right", "wrong"
HIT, MISS, FALSE_ALARM, REJECTION = "hit", "miss", "false alarm", "correct rejection"
GOOD = frozenset((RIGHT, HIT, REJECTION))
LEAST_SHARE = 1e-3  # a magnitude may not be 0
MOST_STEPS = 100
LEAST_NUMBER = math.ulp(0.0)  # above 0
ANY = ("strings", "pictures", "single", "pairs", "standard")


class Spelling(NamedTuple):
    """Spelling of cells in answers: dot masks of the keys, and the dots that are shown."""

    keys: dict[str, int]
    shown_dots: int


def choose(text: str, answers: dict[str, str], typed: str) -> str:
    """Return the one of some answers that a text stands for, in either case.

    Raises
    ------
    ValueError
        If it stands for none of them; the sentence says what may be typed.
    """
    word = text.strip()
    if word.casefold() not in answers:
        raise ValueError(f"{word!r} is not an answer; type {typed}")
    return answers[word.casefold()]


def parse_number(text: str, least: float, most: float, typed: str) -> str:
    """Read a number with a point or a comma; ValueError if it is none, or out of bounds."""
    try:
        number = float(text.strip().replace(",", "."))
    except ValueError:
        number = math.nan
    if not (least <= number <= most and math.isfinite(number)):
        raise ValueError(f"{text.strip()!r} is not an answer; type {typed}")
    return f"{number:.15g}"


class Scale(Table, frozen=True, kw_only=True):
    """A scale of whole numbers, with words for all its steps, for its two ends, or for none."""

    least: int
    most: int
    labels: tuple[Sentence, ...] = ()

    def __post_init__(self) -> None:
        if not self.least < self.most <= self.least + MOST_STEPS:
            raise WrongValue("most", f"must be more than least, by {MOST_STEPS} at most")
        if len(self.labels) not in (0, 2, self.most - self.least + 1):
            raise WrongValue("labels", "must be two, for the ends, or one for each step")

    @property
    def names(self) -> dict[int, str]:
        """The labels, by their steps."""
        if len(self.labels) == 2:
            return {self.least: self.labels[0], self.most: self.labels[1]}
        return dict(enumerate(self.labels, self.least))

    @property
    def typed(self) -> str:
        """Words for what may be typed."""
        ends = (self.least, self.most)
        return " to ".join(f"{n} ({self.names[n]})" if n in self.names else str(n) for n in ends)

    @property
    def answers(self) -> dict[str, str]:
        """The steps, by their numbers and labels."""
        steps = {str(n): str(n) for n in range(self.least, self.most + 1)}
        return steps | {label.casefold(): str(n) for n, label in self.names.items()}

    def parse(self, text: str) -> int:
        """Read a number of the scale, or its label; ValueError if the text is neither."""
        return int(choose(text, self.answers, self.typed))


class Question(Table, frozen=True, kw_only=True, tag_field="kind"):
    """Keys of all kinds.

    Parameters
    ----------
    ask
        The question in words, which the experimenter says.
    confidence
        Scale on which it is asked how sure the answer is; None if it is not asked.
    """

    typed = "the answer"
    asks_of = ANY
    counts_catch = False  # whether catch trials are what is asked about
    scores = False  # whether a procedure can go by its answers
    alarm = ""  # answer that is right where there is a signal; empty if answers tell of none
    confirm = False  # whether a typed answer is said back before it counts

    ask: str = ""
    confidence: Scale | None = None

    @property
    def kind(self) -> str:
        """Name of the kind in protocols and tables."""
        return str(self.__struct_config__.tag)

    def steps(self, line: str) -> int | None:
        """Return by how many steps a line turns what is shown; None if it turns nothing."""
        return None

    def controlled(self, control: Button | Knob, trial: Trial) -> str:
        """Return the line that a button or a knob of the device stands for; empty for none."""
        return ""

    def answers(self, trial: Trial) -> dict[str, str]:
        """Return the answers that there are, by what may be typed for them."""
        return {}

    def parse(self, text: str, trial: Trial, spelling: Spelling) -> str:
        """Return an answer in the spelling in which it is kept; ValueError if the text is none."""
        return choose(text, self.answers(trial), self.typed)

    def right_answer(self, trial: Trial) -> str:
        """Return the right answer as it is kept; empty if there is none."""
        return ""

    def outcome(self, trial: Trial, answer: str) -> str:
        """Return how an answer is scored; empty if nothing is right or wrong."""
        right = self.right_answer(trial)
        if not right:
            return ""
        is_right = answer == right
        if not self.alarm:
            return RIGHT if is_right else WRONG
        if right == self.alarm:
            return HIT if is_right else MISS
        return REJECTION if is_right else FALSE_ALARM

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
        right = self.right_answer(trial)
        return self.said(right, spelling) if right else ""

    def cell(self, trial: Trial, answer: str) -> str:
        """Return an answer as it stands in the table."""
        return answer

    def is_felt(self, parameter: str) -> bool:
        """Tell whether the simulated reader can answer about a parameter."""
        return parameter in ("", "texture", "contrast", *LENGTHS)

    def simulate(self, felt: FeltTrial) -> str:
        """Answer by what was felt."""
        raise NotImplementedError

    def guesses(self, trial: Trial) -> Sequence[str]:
        """Return the answers from which the simulated reader guesses if it felt nothing."""
        return sorted({*self.answers(trial).values()})


class Identify(Question, frozen=True, kw_only=True, tag="identify"):
    """Asks which cells were shown."""

    typed = "what was read: letters, keys or dot numbers, or a text in print; ? if not read"
    asks_of = ("strings",)
    scores = True

    def parse(self, text: str, trial: Trial, spelling: Spelling) -> str:
        """Read cells, or a text."""
        first, cells = trial.stimuli[0], trial.cells
        if first.look.table is not None:
            return parse_text(text, first.text, cells, first.look.table)
        keys, shown_dots = spelling
        return parse_answer(text, places=len(cells), keys=keys, shown_dots=shown_dots)

    def right_answer(self, trial: Trial) -> str:
        """Return the cells."""
        return trial.cells

    def outcome(self, trial: Trial, answer: str) -> str:
        """Return right if all cells are; of a blank catch trial, if no dot was felt."""
        felt = answer.replace(UNREAD, BLANK) if trial.catch == "blank" else answer
        return super().outcome(trial, felt)

    def said(self, answer: str, spelling: Spelling) -> str:
        """Return the cells by their letters and keys."""
        return say_cells(answer, spelling.keys)

    def was(self, trial: Trial, spelling: Spelling) -> str:
        """Return the cells, or the text that they stand for."""
        return trial.stimuli[0].text or super().was(trial, spelling)

    def simulate(self, felt: FeltTrial) -> str:
        """Give the cells as they were felt."""
        return to_braille(felt.cells())

    def guesses(self, trial: Trial) -> Sequence[str]:
        """Return the answer in which no cell was read."""
        return [UNREAD * len(trial.cells)]


class Chosen(Question, frozen=True, kw_only=True):
    """Asks for the number of a stimulus."""

    typed = "the number of one: 1, 2 and so on, or first, second"
    scores = True
    among = len(ORDINALS)  # stimuli that can be chosen: the first ones

    def answers(self, trial: Trial) -> dict[str, str]:
        """Return the numbers, by themselves and by their ordinals."""
        count = min(self.among, len(trial.stimuli))
        names = enumerate(ORDINALS[:count], 1)
        return {word: str(n) for n, name in names for word in (str(n), name)}

    def said(self, answer: str, spelling: Spelling) -> str:
        """Return the ordinal."""
        return ORDINALS[int(answer) - 1]


class Which(Chosen, frozen=True, kw_only=True, tag="which"):
    """Asks which of two to five stimuli it was.

    Parameters
    ----------
    right
        Which value is right: the one with more, with less, or nearest to the reference; None if it
        is a preference.
    reference
        Value that the nearest one is nearest to.
    """

    asks_of = ("pairs", "standard", "one")

    right: Literal["more", "less", "nearest"] | None = None
    reference: Number | None = None

    def __post_init__(self) -> None:
        if (self.right == "nearest") != (self.reference is not None):
            raise WrongValue("right", "'nearest' and reference go together; give both or neither")

    def worth(self, value: float, reference: float | None) -> float:
        """Return a number that is the higher, the more right a value is."""
        if reference is not None:
            return -abs(value - reference)
        return -value if self.right == "less" else value

    def right_answer(self, trial: Trial) -> str:
        """Return the number of the value that is right, if it is one."""
        worth = [self.worth(value, self.reference) for value in trial.values]
        if self.right is None or worth.count(max(worth)) > 1:
            return ""
        return str(worth.index(max(worth)) + 1)

    def cell(self, trial: Trial, answer: str) -> str:
        """Return the value that was chosen."""
        return f"{trial.values[int(answer) - 1]:g}"

    def is_felt(self, parameter: str) -> bool:
        """Tell whether stimuli differ in a strength, or in a length that is told in mm."""
        return parameter in LENGTHS or (self.right != "nearest" and super().is_felt(parameter))

    def simulate(self, felt: FeltTrial) -> str:
        """Choose what is right; of preferences the nearest to the usual length, or the strongest.

        The first is chosen of those that are equal.
        """
        usual = felt.unit if self.right is None and felt.by_length else self.reference
        worth = np.array([self.worth(value, usual) for value in felt.drawn()])
        tie = 0.0 if felt.noise or self.right else TIE * felt.unit
        return str(int(np.argmax(worth >= worth.max() - tie)) + 1)


class Odd(Chosen, frozen=True, kw_only=True, tag="odd"):
    """Asks which of three or more stimuli differed from the others."""

    asks_of = ("one", "triangle")

    def right_answer(self, trial: Trial) -> str:
        """Return the number of the value that is there once."""
        return next(str(n) for n, v in enumerate(trial.values, 1) if trial.values.count(v) == 1)

    def simulate(self, felt: FeltTrial) -> str:
        """Choose the one that is felt furthest from the middle one."""
        drawn = felt.drawn()
        return str(int(np.abs(drawn - np.median(drawn)).argmax()) + 1)


class Match(Chosen, frozen=True, kw_only=True, tag="match"):
    """Asks which of the first two stimuli the third one was (ABX)."""

    asks_of = ("abx",)
    among = 2

    def right_answer(self, trial: Trial) -> str:
        """Return the number of the first that has the value of the third."""
        return str(trial.values.index(trial.values[2]) + 1)

    def simulate(self, felt: FeltTrial) -> str:
        """Choose the one that is felt nearer to the third."""
        first, second, third = felt.drawn()
        return "2" if abs(second - third) < abs(first - third) else "1"


class OneOfTwo(Question, frozen=True, kw_only=True):
    """Asks for one of two words."""

    words: ClassVar[tuple[str, str]]

    def answers(self, trial: Trial) -> dict[str, str]:
        """Return the words, by themselves and by their first letters."""
        return {mark: word for word in self.words for mark in (word, word[0])}


class Same(OneOfTwo, frozen=True, kw_only=True, tag="same-different"):
    """Asks whether two stimuli were the same or different."""

    asks_of = ("pairs",)
    typed = "different or same"
    words = ("different", "same")
    alarm = "different"

    def right_answer(self, trial: Trial) -> str:
        """Return whether the two differ."""
        first, second = trial.stimuli
        return "same" if first == second else "different"

    def simulate(self, felt: FeltTrial) -> str:
        """Say different of what is felt to differ by more than the noise of both."""
        first, second = felt.drawn() / felt.unit
        least = max(felt.noise * math.sqrt(2), TIE)
        return "different" if abs(first - second) > least else "same"


class Detect(OneOfTwo, frozen=True, kw_only=True, tag="detect"):
    """Asks whether there was anything."""

    asks_of = ("strings",)
    counts_catch = True
    scores = True
    typed = "yes or no"
    words = ("yes", "no")
    alarm = "yes"

    def right_answer(self, trial: Trial) -> str:
        """Return whether there was anything to feel."""
        return "no" if trial.stimuli[0].is_blank else "yes"

    def positive(self, trial: Trial, answer: str) -> bool:
        """Tell whether the answer is yes."""
        return answer == "yes"

    def simulate(self, felt: FeltTrial) -> str:
        """Say yes to what is felt beyond the noise."""
        strength = felt.strength() + felt.jitter()
        return "yes" if strength > max(felt.noise, LEAST_FELT) else "no"


class Rate(Question, frozen=True, kw_only=True, tag="rating"):
    """Asks where on a scale something is.

    Parameters
    ----------
    scale
        Name of what is rated, such as roughness.
    least, most, labels
        The scale, as at `Scale`.
    """

    scale: Sentence
    least: int
    most: int
    labels: tuple[Sentence, ...] = ()

    def __post_init__(self) -> None:
        self._scale  # noqa: B018  (it checks itself)

    @property
    def _scale(self) -> Scale:
        return Scale(least=self.least, most=self.most, labels=self.labels)

    @property
    def typed(self) -> str:
        """Words for what may be typed."""
        return f"{self._scale.typed}, for {self.scale}"

    def answers(self, trial: Trial) -> dict[str, str]:
        """Return the steps of the scale."""
        return self._scale.answers

    def said(self, answer: str, spelling: Spelling) -> str:
        """Return the number, and its label if it has one."""
        label = self._scale.names.get(int(answer))
        return f"{answer}, {label}" if label else answer

    def simulate(self, felt: FeltTrial) -> str:
        """Put the strength, from 0 to 1, on the scale."""
        share = min(max(felt.strength(-1) + felt.jitter(), 0.0), 1.0)
        return str(self.least + round(share * (self.most - self.least)))


class Magnitude(Question, frozen=True, kw_only=True, tag="magnitude"):
    """Asks how strong something was, as any number above 0.

    Parameters
    ----------
    modulus
        Number that participants are told for a standard; None if they choose one.
    """

    modulus: Positive | None = None

    @property
    def typed(self) -> str:
        """Words for what may be typed."""
        told = "" if self.modulus is None else f"; the standard is {self.modulus:g}"
        return f"a number above 0{told}"

    def parse(self, text: str, trial: Trial, spelling: Spelling) -> str:
        """Read a number with a point or a comma."""
        return parse_number(text, LEAST_NUMBER, math.inf, self.typed)

    def simulate(self, felt: FeltTrial) -> str:
        """Give the strength times the modulus."""
        share = max(felt.share() * math.exp(felt.jitter()), LEAST_SHARE)
        return f"{(self.modulus or 1.0) * share:.3g}"

    def guesses(self, trial: Trial) -> Sequence[str]:
        """Return numbers around the modulus."""
        return [f"{(self.modulus or 1.0) * share:g}" for share in (0.25, 0.5, 1, 2, 4)]


class Names(Table, frozen=True, kw_only=True):
    """Names of which a picture has one.

    Parameters
    ----------
    names
        The names, by the keys that may be typed for them.
    of
        Column of the file of items that has the right one; None if it is the picture's own name.
    """

    names: Annotated[
        dict[Annotated[str, Meta(pattern=r"^[^\s,]$")], Label], Meta(min_length=2, max_length=40)
    ]
    of: str | None = None

    @property
    def typed(self) -> str:
        """The keys and their names."""
        return ", ".join(f"{key} {name}" for key, name in self.names.items())


class Pick(Question, frozen=True, kw_only=True, tag="name"):
    """Asks which names a picture has, such as its shape and its size.

    Parameters
    ----------
    choices
        The names to choose from, in the order in which answers keep them.
    confirm
        Whether a typed answer is said back, and counts only when it is typed again, or by Enter.
    buttons
        Whether the buttons of the device stand for the keys, in their order.
    """

    asks_of = ("pictures",)

    choices: Annotated[tuple[Names, ...], Meta(min_length=1)]
    confirm: bool = True
    buttons: bool = False

    def __post_init__(self) -> None:
        words = [word for each in self.choices for word in (*each.names, *each.names.values())]
        for word in words:
            if words.count(word) > 1:
                raise WrongValue("choices", f"{word!r} is there twice")

    @property
    def typed(self) -> str:
        """The keys of each choice, and their names."""
        return "; ".join(each.typed for each in self.choices)

    def controlled(self, control: Button | Knob, trial: Trial) -> str:
        """Return the key that a button stands for."""
        keys = dict(enumerate((key for each in self.choices for key in each.names), 1))
        return keys.get(control.number, "") if self.buttons and isinstance(control, Button) else ""

    def marked(self, text: str) -> list[str]:
        """Return the name of each choice that a line gives last; empty where it gives none."""
        known = {
            mark: (place, name)
            for place, each in enumerate(self.choices)
            for key, name in each.names.items()
            for mark in (key, name)
        }
        found = [""] * len(self.choices)
        for word in text.replace(",", " ").split():
            for mark in [word] if word in known else word:
                if mark not in known:
                    raise ValueError(f"{mark!r} is not an answer; type {self.typed}")
                place, name = known[mark]
                found[place] = name
        return found

    def missing(self, names: list[str]) -> str:
        """Return the keys of the first choice without a name; empty if all have one."""
        pairs = zip(self.choices, names, strict=True)
        return next((each.typed for each, name in pairs if not name), "")

    def parse(self, text: str, trial: Trial, spelling: Spelling) -> str:
        """Read keys or names, one for each choice, in any order."""
        names = self.marked(text)
        if missing := self.missing(names):
            raise ValueError(f"a name is missing; type one of {missing}")
        return " ".join(names)

    def right_answer(self, trial: Trial) -> str:
        """Return the right names."""
        named = (trial.columns.get(each.of) if each.of else trial.item for each in self.choices)
        return " ".join(filter(None, named))

    def guesses(self, trial: Trial) -> Sequence[str]:
        """Return all combinations of names."""
        return list(map(" ".join, product(*(each.names.values() for each in self.choices))))


class Read(OneOfTwo, frozen=True, kw_only=True, tag="read"):
    """Says whether a passage was read to its end."""

    typed = "read, or broken off"
    asks_of = ("passages",)
    words = ("read", "broken off")

    def simulate(self, felt: FeltTrial) -> str:
        """Say that it was read."""
        return "read"


class Adjust(Question, frozen=True, kw_only=True, tag="adjust"):
    """Asks to turn the last stimulus until it is equal to the standard, or as it should be.

    Parameters
    ----------
    step, least, most
        Smallest turn of the value, and its bounds.
    knob
        Number of the device's knob whose way from end to end is that from least to most.
    buttons
        Numbers of three buttons of the device: for less, for more, and for equal.
    """

    typed = "+ or - to turn it (++ twice), equal when it is; standard shows both again"
    asks_of = ("single", "standard")

    step: Positive
    least: Number
    most: Number
    knob: ButtonNumber | None = None
    buttons: Annotated[tuple[ButtonNumber, ...], Meta(max_length=3)] = ()

    def __post_init__(self) -> None:
        if self.least + self.step > self.most:
            raise WrongValue("most", "must be a step above least, or more")
        if len(set(self.buttons)) not in (0, 3):
            raise WrongValue("buttons", "must be three, for less, for more and for equal")

    def steps(self, line: str) -> int | None:
        """Return the steps of a line; 0 shows both again; None if it is an answer."""
        word = line.strip().casefold()
        if word == "standard":
            return 0
        return word.count("+") - word.count("-") if word and not set(word) - {*"+-"} else None

    def controlled(self, control: Button | Knob, trial: Trial) -> str:
        """Return the line that a button stands for, or a turn of the knob."""
        if isinstance(control, Button):
            return dict(zip(self.buttons, "-+=", strict=False)).get(control.number, "")
        if control.number != self.knob:
            return ""
        wanted = self.least + control.value * (self.most - self.least)
        steps = round((wanted - trial.values[-1]) / self.step)
        return ("+" if steps > 0 else "-") * abs(steps)

    def turned(self, value: float, steps: int) -> float:
        """Return a value turned by some steps."""
        return round(min(max(value + steps * self.step, self.least), self.most), 9)

    def answers(self, trial: Trial) -> dict[str, str]:
        """Return the value that is shown, if it is equal."""
        return dict.fromkeys(("equal", "="), f"{trial.values[-1]:.9g}")

    def simulate(self, felt: FeltTrial) -> str:
        """Turn by as many steps as the two, or it and the usual value, are felt to differ."""
        *standard, last = felt.drawn()
        apart = last - (standard[0] if standard else felt.unit)
        steps = round(abs(apart) / self.step)
        if not steps or felt.turns > (self.most - self.least) / self.step:
            return "equal"
        return ("-" if apart > 0 else "+") * steps

    def guesses(self, trial: Trial) -> Sequence[str]:
        """Leave it as it is."""
        return ["equal"]


class Free(Question, frozen=True, kw_only=True, tag="free"):
    """Asks for any words."""

    typed = "any words"

    def parse(self, text: str, trial: Trial, spelling: Spelling) -> str:
        """Return the words."""
        if not text.strip():
            raise ValueError("nothing was typed; type any words")
        return text.strip()

    def is_felt(self, parameter: str) -> bool:
        """Return False: the simulated reader has no words of its own."""
        return False


AnyQuestion = (
    Identify | Which | Odd | Match | Same | Detect | Rate | Magnitude | Pick | Read | Adjust | Free
)
