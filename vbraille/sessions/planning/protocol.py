"""A protocol: what a study shows, asks and keeps to, as a TOML file has it.

Ranges of values stand in the types. What only two tables together can get wrong is checked in
`Protocol.__post_init__`.
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

import msgspec
from msgspec import Meta

from vbraille.braille.spelling import LETTERS, spell
from vbraille.errors import InputError
from vbraille.render import MODELS, BrailleStyle, Model
from vbraille.sessions.planning.design import AnyDesign, Pairs, Standard, StringList
from vbraille.sessions.planning.factors import Factor, crossed
from vbraille.sessions.planning.procedures import AnyProcedure
from vbraille.sessions.planning.questionnaire import Item
from vbraille.sessions.planning.questions import AnyQuestion, Choose, Identify
from vbraille.sessions.planning.values import Count, Label, Look, Name, Seconds, Sentence
from vbraille.toml import Table, WrongValue, read_toml

FOLDER = Path(__file__).parents[1] / "protocols"


class Display(Look, kw_only=True):
    """How strings are shown where no condition says it.

    Parameters
    ----------
    lead_cells
        Blank cells before each string, which keep it clear of the left stop.
    """

    lead_cells: Annotated[int, Meta(ge=0, le=20)] = 1


class Condition(Look, kw_only=True):
    """A condition: its name, and what it changes of the display."""

    name: Label


class Rules(Table, kw_only=True):
    """What the order of the trials keeps to.

    Parameters
    ----------
    never_twice_running
        Whether two neighbouring trials may not show the same item.
    at_most_running
        How many neighbouring trials may have the same condition, or level of a factor.
    balanced_quarters
        Whether each quarter of the session has an even share of each condition.
    each_letter, each_letter_at_least
        How often each letter is shown in a condition.
    """

    never_twice_running: bool = False
    at_most_running: dict[str, Count] = {}
    balanced_quarters: bool = False
    each_letter: Count | None = None
    each_letter_at_least: Count | None = None


class Until(Table, kw_only=True):
    """A criterion that ends practice: so many right of the last trials, or the most trials."""

    right: Count
    of: Count
    most: Count

    def __post_init__(self) -> None:
        if not self.right <= self.of <= self.most:
            raise WrongValue("right", "must not be more than of, and of not more than most")


class Practice(Table, kw_only=True):
    """Trials before the first block.

    Parameters
    ----------
    trials
        How many there are, unless a criterion ends them.
    strings
        What is shown; nothing for the items of the design.
    until
        Criterion that ends practice.
    """

    trials: Annotated[int, Meta(ge=0, le=200)] = 0
    strings: tuple[str, ...] = ()
    until: Until | None = None


class Pace(Table, kw_only=True):
    """The pace of each trial.

    Parameters
    ----------
    gap_s
        Time from the answer to the next cue, or the two ends of a range from which it is drawn.
    warning_s
        Time after the cue at which the participant is warned.
    exposure_s
        Time after the cue at which the stimulus is taken away.
    feedback
        Whether the participant is told after each answer if it is right. In practice it always is.
    """

    # A fixed tuple beside a number with bounds crashes msgspec 0.22.
    gap_s: Seconds | Annotated[tuple[Seconds, ...], Meta(min_length=2, max_length=2)] = 0.5
    warning_s: Seconds | None = None
    exposure_s: Seconds | None = None
    feedback: bool = False


class SessionPace(Table, kw_only=True):
    """The pace of the session: after how many trials of a block there is a break, and the limit."""

    break_every: Count | None = None
    limit_s: Seconds | None = None


class Faults(Table, kw_only=True):
    """What is done about a trial in which the device failed."""

    repeat: bool = True


class Sound(Table, kw_only=True):
    """Tones that the participant hears, by their frequency in Hz and their duration in ms."""

    cue: tuple[int, int] = (880, 150)
    warning: tuple[int, int] = (440, 400)


class Field(Table, kw_only=True):
    """Something that is asked about the participant; its name is that of a column."""

    name: Label
    ask: Sentence
    choices: tuple[str, ...] = ()


class Analysis(Table, kw_only=True):
    """What the sessions are for, fixed before the first of them."""

    measure: Literal["legibility", "threshold", "preferred", "time"]
    correction: Literal["holm", "bonferroni", "fdr", "none"] = "holm"
    participants: Count = 12
    stop: str = ""


class Protocol(Table, kw_only=True):
    """A whole protocol.

    Parameters
    ----------
    name, title, source
        Name in commands and tables, name in sentences, and where the protocol comes from.
    model
        Display that it is written for.
    medium
        Whether strings are felt on the device or on paper.
    keys
        Spellings of cells beside the letters a to z: one character each, and its dots.
    """

    name: Name
    title: Sentence
    source: Sentence = "ours"
    model: Literal["vbd", "stress2"]
    medium: Literal["device", "paper"] = "device"
    display: Display = Display()
    keys: dict[str, str] = {}
    question: AnyQuestion | None = None
    design: AnyDesign
    procedure: AnyProcedure | None = None
    listed: tuple[Condition, ...] = msgspec.field(name="conditions", default=())
    factors: tuple[Factor, ...] = ()
    rules: Rules = Rules()
    practice: Practice = Practice()
    trial: Pace = Pace()
    session: SessionPace = SessionPace()
    faults: Faults = Faults()
    sound: Sound = Sound()
    fields: tuple[Field, ...] = ()
    questionnaire: tuple[Item, ...] = ()
    analysis: Analysis | None = None

    def __post_init__(self) -> None:
        self._check_spellings()
        self._check_names()
        self._check_letters()
        varied = ["condition", *(factor.name for factor in self.factors if not factor.between)]
        for name in self.rules.at_most_running:
            if name not in varied:
                known = ", ".join(varied)
                raise WrongValue(f"rules.at_most_running.{name}", f"does not vary; known: {known}")
        form = self.design.__struct_config__.tag
        if self.asks.designs and form not in self.asks.designs:
            raise WrongValue("question.kind", f"{self.asks.kind} is not asked of {form}")
        if self.design.blocks != "conditions" and self.design.order is not None:
            raise WrongValue("design.order", "is for blocks = 'conditions'; leave it out")
        for number, condition in enumerate(self.conditions):
            try:
                self.style(condition.over(self.display))
            except ValueError as error:
                raise WrongValue(f"conditions.{number}", str(error)) from None

    @property
    def conditions(self) -> tuple[Condition, ...]:
        """Conditions: those that are listed, or all combinations of factors; at least one."""
        if not any(not factor.between for factor in self.factors):
            return self.listed or (Condition(name="only"),)
        cells = crossed(self.factors, between=False)
        return tuple(Condition(name=cell.name, **cell.look.given) for cell in cells)

    @property
    def groups(self) -> tuple[str, ...]:
        """Names of the groups of participants; none if all do the same."""
        return tuple(cell.name for cell in crossed(self.factors, between=True) if cell.name)

    def of_group(self, group: str) -> Protocol:
        """Return the protocol as a group has it."""
        looks = {cell.name: cell.look for cell in crossed(self.factors, between=True)}
        display = Display(
            **(self.display.given | looks[group].given), lead_cells=self.display.lead_cells
        )
        return msgspec.structs.replace(self, display=display)

    def levels(self, condition: str, group: str) -> dict[str, str]:
        """Return the level of each factor in a condition of a group."""
        found = {}
        for between, name in ((False, condition), (True, group)):
            cells = crossed(self.factors, between=between)
            found |= next((cell.levels for cell in cells if cell.name == name), {})
        return found

    @property
    def asks(self) -> AnyQuestion:
        """The question of each trial; without a table it is which cells, or which of two."""
        if self.question is not None:
            return self.question
        return Choose() if isinstance(self.design, Pairs | Standard) else Identify()

    @property
    def masks(self) -> dict[str, int]:
        """Dot mask of each key."""
        return {key: spell(dots, {})[0] for key, dots in self.keys.items()}

    @property
    def display_model(self) -> Model:
        """Model of the display."""
        return MODELS[self.model]

    def style(self, look: Look) -> BrailleStyle:
        """Return the style in which the model shows a look."""
        return look.style(self.display_model)

    def _check_spellings(self) -> None:
        for key, dots in self.keys.items():
            if len(key) != 1 or len(_spelled(f"keys.{key}", dots, {})) != 1:
                raise WrongValue(f"keys.{key}", "a key is one character, and stands for one cell")
        strings = {"practice.strings": self.practice.strings, **self.design.spellings()}
        for path, spellings in strings.items():
            for spelling in spellings:
                _spelled(path, spelling, self.masks)

    def _check_names(self) -> None:
        if self.listed and self.factors:
            raise WrongValue("conditions", "are made by [[factors]]; leave one of the two out")
        for path, tables in (
            ("conditions", self.listed),
            ("factors", self.factors),
            ("fields", self.fields),
            ("questionnaire", self.questionnaire),
        ):
            names = [table.name for table in tables]
            for number, name in enumerate(names):
                if name in names[:number]:
                    raise WrongValue(f"{path}.{number}.name", f"{name!r} is there twice")

    def _check_letters(self) -> None:
        exactly, least = self.rules.each_letter, self.rules.each_letter_at_least or 0
        if not isinstance(self.design, StringList) or (exactly is None and not least):
            return
        shown = "".join(self.design.strings) * self.design.repeats
        for letter in LETTERS:
            count = shown.count(letter)
            if exactly not in (None, count) or count < least:
                key = "each_letter" if exactly is not None else "each_letter_at_least"
                raise WrongValue(f"rules.{key}", f"{letter} is shown {count} times")


def _spelled(path: str, text: str, keys: dict[str, int]) -> tuple[int, ...]:
    """Return the dot masks of a spelling."""
    try:
        return spell(text, keys)
    except ValueError as error:
        raise WrongValue(path, str(error)) from None


def load_protocol(name: str) -> tuple[Protocol, bytes]:
    """Read a protocol that comes with the program, or a TOML file; return it with the file's bytes.

    Raises
    ------
    InputError
        If there is no such protocol, or it cannot be used.
    """
    path = FOLDER / f"{name}.toml" if "." not in name else Path(name)
    try:
        content = path.read_bytes()
    except OSError as error:
        known = ", ".join(sorted(each.stem for each in FOLDER.glob("*.toml")))
        raise InputError(f"{name}: {error.strerror}; known: {known}") from None
    return parse_protocol(content, str(path)), content


def parse_protocol(content: bytes, where: str) -> Protocol:
    """Read the protocol of a file's bytes.

    Raises
    ------
    InputError
        If it cannot be used; the line is named.
    """
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError:
        raise InputError(f"{where} is not UTF-8; save it as UTF-8") from None
    return read_toml(text, Protocol, where)
