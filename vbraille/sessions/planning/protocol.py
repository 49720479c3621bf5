"""A protocol: what a study shows, asks and keeps to. Its tables are those of a TOML file.

Ranges of values stand in the types. What several tables together can get wrong is checked in
`vbraille.sessions.planning.loading`, which also reads the files beside a protocol.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterable
from typing import Annotated, Any, Literal

import msgspec
from msgspec import Meta

from vbraille.braille.spelling import spell, spell_string, to_braille
from vbraille.display import Display
from vbraille.errors import InputError
from vbraille.render import MODELS, BrailleStyle, Model
from vbraille.sessions.planning.design import AnyDesign, Compared, values_said
from vbraille.sessions.planning.items import OrderRow
from vbraille.sessions.planning.procedures import AnyProcedure
from vbraille.sessions.planning.questionnaire import Item
from vbraille.sessions.planning.questions import AnyQuestion, Identify, Read, Spelling, Which
from vbraille.sessions.planning.trial import Stimulus
from vbraille.sessions.planning.values import (
    Count,
    Duration,
    FileName,
    Label,
    Look,
    Name,
    Number,
    Seconds,
    Sentence,
    Share,
)
from vbraille.toml import Table, WrongValue

MOST_LEAD_CELLS = 20
MOST_PIN_CELLS = 200
FIRST_CODE, LEAST_CODE, MOST_CODE = 101, 40, 254  # bytes of markers; lower ones are of events
# Measures, by their names in sentences.
MEASURES = {
    "legibility": "legibility of strings",
    "characters": "legibility of characters",
    "duration": "duration of right answers",
    "right": "right answers",
    "threshold": "threshold",
    "d_prime": "d′",
    "preferred": "preferred value",
    "rating": "rating",
    "magnitude": "magnitude",
    "adjusted": "adjusted value",
    "reading_speed": "reading speed in words a minute",
}
# Measures of each kind of question, the usual one first; of words there is none.
MEASURES_OF = {
    "identify": ("legibility", "characters", "duration", "threshold"),
    "which": ("preferred", "threshold", "right", "duration"),
    "odd": ("right", "threshold", "duration"),
    "match": ("right", "threshold", "duration"),
    "same-different": ("right", "d_prime"),
    "detect": ("d_prime", "right", "threshold"),
    "rating": ("rating",),
    "magnitude": ("magnitude",),
    "name": ("right", "duration"),
    "read": ("reading_speed",),
    "adjust": ("adjusted",),
    "free": (),
}


class DisplayLook(Look, frozen=True, kw_only=True):
    """Look of strings where no condition says it: the table [display].

    Parameters
    ----------
    lead_cells
        Blank cells before each string, which keep it clear of the left stop.
    travel_mm
        Length of the carriage's travel.
    """

    lead_cells: Annotated[int, Meta(ge=0, le=MOST_LEAD_CELLS)] = 1
    travel_mm: Annotated[float, Meta(gt=0, le=5000)] | None = None


class Condition(Look, frozen=True, kw_only=True):
    """A condition, or a level of a factor: its name, and what it changes of the display."""

    name: Label


class Factor(Table, frozen=True, kw_only=True):
    """A factor.

    Parameters
    ----------
    name
        Name, which is that of a column, after "factor_".
    levels
        Two or more levels.
    between
        Whether each participant has one of the levels, and not all.
    """

    name: Label
    levels: Annotated[tuple[Condition, ...], Meta(min_length=2)]
    between: bool = False


class Rules(Table, frozen=True, kw_only=True):
    """Rules of the order of the trials.

    Parameters
    ----------
    never_twice_running
        Whether two neighbouring trials may not show the same item.
    at_most_running
        How many neighbouring trials may have the same condition, level of a factor, or cell of a
        column of the file of items.
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


class Items(Table, frozen=True, kw_only=True):
    """Source of the strings of a design of items: a CSV file with the column "string"."""

    file: FileName


class Until(Table, frozen=True, kw_only=True):
    """A criterion that ends practice: so many right of the last trials, or the most trials."""

    right: Count
    of: Count
    most: Annotated[int, Meta(ge=1, le=1000)]

    def __post_init__(self) -> None:
        if not self.right <= self.of <= self.most:
            raise WrongValue("right", "must not be more than of, nor of more than most")


class Practice(Table, frozen=True, kw_only=True):
    """Trials before the first block.

    Parameters
    ----------
    trials
        How many there are, unless a criterion ends them.
    strings, values
        What is shown: strings, or values that are compared. Pictures may be those of the test.
    order
        Whether it is shuffled, or goes through what is listed, such as from easy to hard.
    feedback
        Whether the participant is told after each answer if it is right.
    until
        Criterion that ends practice.
    """

    trials: Annotated[int, Meta(ge=0, le=1000)] = 0
    strings: tuple[str, ...] = ()
    values: tuple[Number, ...] = ()
    order: Literal["shuffled", "listed"] = "shuffled"
    feedback: bool = True
    until: Until | None = None

    @property
    def most(self) -> int:
        """Number of trials that there may be."""
        return self.until.most if self.until else self.trials


class Pace(Table, frozen=True, kw_only=True):
    """The pace of each trial: the table [trial].

    Parameters
    ----------
    gap_s
        Time from the answer to the next cue, or the two ends of a range from which it is drawn.
    warning_s
        Time after the cue at which the participant is warned.
    end
        What ends reading, if not the hand: "button:1" and so on of the device, or "key:enter".
    exposure_s, exposure_from
        Time after which the stimulus is taken away, from the cue or from the first touch.
    answer_s, late
        Time for an answer, from the end of the exposure or from the cue; and whether a later one is
        kept and marked, or the trial is over without one.
    feedback
        Whether the participant is told after each answer of the test if it is right.
    """

    # A fixed tuple beside a number with bounds crashes msgspec 0.22.
    gap_s: Seconds | Annotated[tuple[Seconds, ...], Meta(min_length=2, max_length=2)] = 0.5
    warning_s: Seconds | None = None
    end: Annotated[str, Meta(pattern="^(button:[1-8]|key:enter)$")] | None = None
    exposure_s: Duration | None = None
    exposure_from: Literal["cue", "contact"] = "cue"
    answer_s: Duration | None = None
    late: Literal["kept", "missed"] = "kept"
    feedback: bool = False

    def __post_init__(self) -> None:
        if isinstance(self.gap_s, tuple) and self.gap_s[0] > self.gap_s[1]:
            raise WrongValue("gap_s", "must have the shorter time first")

    @property
    def button(self) -> int | None:
        """Number of the button that ends reading; None if none does."""
        found = re.fullmatch(r"button:(\d)", self.end or "")
        return int(found[1]) if found else None


class SessionPace(Table, frozen=True, kw_only=True):
    """The pace of the session.

    Parameters
    ----------
    limit_s
        Time after which no further trial begins.
    break_every, break_s
        After how many trials of a block there is a break, and how long it is planned to be.
    blind
        Whether the live view keeps back all from which a stimulus or an answer could be read.
    """

    limit_s: Seconds | None = None
    break_every: Count | None = None
    break_s: Seconds | None = None
    blind: bool = True


class Faults(Table, frozen=True, kw_only=True):
    """Rule for a trial in which the device failed."""

    repeat: bool = True


Hertz = Annotated[float, Meta(ge=20, le=20_000)]
Tone = Annotated[tuple[Hertz, ...], Meta(min_length=2, max_length=2)]


class Sound(Table, frozen=True, kw_only=True):
    """Tones that the participant hears, by their frequency in Hz and their duration in ms."""

    cue: Tone = (880, 150)
    warning: Tone = (440, 400)


class Markers(Table, frozen=True, kw_only=True):
    """Bytes that tell other recorders which condition is shown, by the condition's name."""

    codes: dict[str, Annotated[int, Meta(ge=LEAST_CODE, le=MOST_CODE)]] = {}


class Pins(Table, frozen=True, kw_only=True):
    """Place of strings on a conventional display, and what is compared with."""

    cell: Annotated[int, Meta(ge=1, le=MOST_PIN_CELLS)] = 1
    reference: str = ""


class Field(Table, frozen=True, kw_only=True):
    """Something that is asked about the participant; its name is that of a column."""

    name: Label
    ask: Sentence
    choices: tuple[Sentence, ...] = ()


class Analysis(Table, frozen=True, kw_only=True):
    """Purpose of the sessions, fixed before the first of them.

    Parameters
    ----------
    measure
        Primary measure, a key of `MEASURES`; None for the usual one of the question.
    factors
        Factors that it is compared by, "condition" for conditions that are listed, or columns of
        the file of items, such as "item_size"; None for all factors.
    too_fast_s, too_slow_s
        Trials that took less, or more, are left out.
    catch_right
        A participant with a smaller share of catch trials right is left out.
    participants, stop
        How many people are planned, and in words when no more are asked.
    """

    measure: Literal[tuple(MEASURES)] | None = None  # pyright: ignore
    factors: tuple[str, ...] | None = None
    too_fast_s: Seconds | None = None
    too_slow_s: Seconds | None = None
    catch_right: Share | None = None
    participants: Annotated[int, Meta(ge=1, le=10_000)] | None = None
    stop: Annotated[str, Meta(max_length=300)] = ""

    def __post_init__(self) -> None:
        if (self.too_fast_s or 0.0) >= (self.too_slow_s or float("inf")):
            raise WrongValue("too_fast_s", "must be below too_slow_s")

    def said(self) -> str:
        """Describe it in a line."""
        if self.measure is None:
            return "none, as answers are words"
        told = [MEASURES[self.measure]]
        told[0] += " by " + " × ".join(self.factors) if self.factors else ""
        for limit, words in ((self.too_fast_s, "below"), (self.too_slow_s, "above")):
            told += [] if limit is None else [f"without trials {words} {limit:g} s"]
        if self.catch_right is not None:
            told.append(
                f"without people with less than {self.catch_right:.0%} of catch trials right"
            )
        told += [] if self.participants is None else [f"{self.participants} participants"]
        return "; ".join(filter(None, (*told, self.stop)))


class ProtocolFile(Table, frozen=True, kw_only=True):
    """A protocol as its file has it.

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

    format: Literal[1] = 1
    name: Name
    title: Sentence
    source: Sentence = "ours"
    model: Literal[tuple(MODELS)]  # pyright: ignore
    medium: Literal["device", "paper"] = "device"
    display: DisplayLook = DisplayLook()
    keys: dict[str, str] = {}
    question: AnyQuestion | None = None
    design: AnyDesign
    items: Items | None = None
    procedure: AnyProcedure | None = None
    listed: tuple[Condition, ...] = msgspec.field(name="conditions", default=())
    factors: tuple[Factor, ...] = ()
    rules: Rules = Rules()
    practice: Practice = Practice()
    trial: Pace = Pace()
    session: SessionPace = SessionPace()
    faults: Faults = Faults()
    sound: Sound = Sound()
    markers: Markers = Markers()
    pins: Pins = Pins()
    fields: tuple[Field, ...] = ()
    questionnaire: tuple[Item, ...] = ()
    analysis: Analysis = Analysis()

    @property
    def looks(self) -> list[Look]:
        """All looks that the tables name."""
        levels = [level for factor in self.factors for level in factor.levels]
        return [self.display, *self.listed, *levels]

    @property
    def beside(self) -> list[str]:
        """Names of the files beside it."""
        named = [self.items and self.items.file, self.design.orders]
        return sorted({*filter(None, (*named, *(look.scene for look in self.looks)))})


class Protocol(ProtocolFile, frozen=True, kw_only=True):
    """A protocol with what the files beside it say.

    Parameters
    ----------
    files
        Content of the protocol's file, and of those beside it, by their names.
    columns
        Other columns of the file of items, by the item.
    orders
        What a file of orders says, by the participant.
    group
        Group that it is for; empty for all.
    """

    files: dict[str, bytes] = {}
    columns: dict[str, dict[str, str]] = {}
    orders: dict[str, OrderRow] = {}
    group: str = ""

    def crossed(self, *, between: bool) -> list[tuple[Condition, dict[str, str]]]:
        """Return the combinations of the factors within participants, or between them.

        Returns
        -------
        list
            Each combination as a condition, and its level of each factor.
        """
        own = [factor for factor in self.factors if factor.between == between]
        found = []
        for levels in itertools.product(*(factor.levels for factor in own)):
            look = {key: value for level in levels for key, value in level.given.items()}
            names = {factor.name: level.name for factor, level in zip(own, levels, strict=True)}
            found.append((Condition(name="-".join(names.values()), **look), names))
        return found

    @property
    def conditions(self) -> tuple[Condition, ...]:
        """Conditions: those that are listed, or all combinations of factors; at least one."""
        if all(factor.between for factor in self.factors):
            return self.listed or (Condition(name="all"),)
        return tuple(cell for cell, _ in self.crossed(between=False))

    @property
    def groups(self) -> tuple[str, ...]:
        """Names of the groups of participants; none if all do the same."""
        return tuple(cell.name for cell, _ in self.crossed(between=True) if cell.name)

    def of_group(self, group: str) -> Protocol:
        """Return the protocol as a group has it."""
        cells = {cell.name: cell for cell, _ in self.crossed(between=True)}
        display = msgspec.structs.replace(self.display, **cells[group].given)
        return msgspec.structs.replace(self, display=display, group=group)

    def levels(self, condition: str, group: str) -> dict[str, str]:
        """Return the level of each factor in a condition of a group."""
        within, between = (
            {cell.name: levels for cell, levels in self.crossed(between=each)}
            for each in (False, True)
        )
        return within.get(condition, {}) | between.get(group, {})

    def look(self, condition: str) -> Look:
        """Return how a condition shows what has no value of its own."""
        own = next(each for each in self.conditions if each.name == condition)
        return own.over(self.display)

    @property
    def asks(self) -> Any:
        """The question of each trial; without a table it is which cells, or which of two."""
        if self.question is not None:
            return self.question
        if self.design.passage:
            return Read()
        return Which() if isinstance(self.design, Compared) else Identify()

    @property
    def varied(self) -> str:
        """Parameter that stimuli are compared by, or that a procedure varies; empty for none."""
        return self.design.parameter or getattr(self.procedure, "parameter", None) or ""

    @property
    def masks(self) -> dict[str, int]:
        """Dot mask of each key."""
        return {key: spell(dots, {})[0] for key, dots in self.keys.items()}

    @property
    def display_model(self) -> Model:
        """Model of the display."""
        return MODELS[self.model]

    @property
    def wanted(self) -> Display:
        """The display that a session needs, with its travel."""
        return self.display_model.on(self.style(self.display).geometry)

    def style(self, look: Look) -> BrailleStyle:
        """Return the style in which the model shows a look."""
        style = look.style(self.display_model)
        travel_mm = self.display.travel_mm
        return style if travel_mm is None else style.replace(travel_mm=travel_mm)

    def room(self, look: Look) -> int:
        """Return how many cells of a string a line has room for."""
        geometry = self.style(look).geometry
        try:
            return geometry.cells_per_line(self.wanted.span_mm) - self.display.lead_cells
        except InputError as error:  # its place in the protocol is told
            raise ValueError(str(error)) from None

    def spelling(self, stimulus: Stimulus) -> Spelling:
        """Return how answers about a stimulus are spelled."""
        return Spelling(self.masks, self.style(stimulus.look).mapping.shown_dots())

    @property
    def shows_pictures(self) -> bool:
        """Tell whether strings are names of pictures."""
        return any(look.scene for look in self.looks)

    @property
    def has_texts(self) -> bool:
        """Tell whether strings are texts in print, or names of pictures, and not cells."""
        return any(look.scene or look.table for look in self.looks)

    @property
    def items_shown(self) -> list[str]:
        """The items of the design, each once."""
        return self.design.items(None if self.has_texts else self.masks)

    @property
    def practised(self) -> list[str]:
        """The items of practice, each once."""
        if isinstance(self.design, Compared):
            return [values_said(values) for values in self.design.of(self.practice.values)]
        return self.spelled(self.practice.strings)

    def spelled(self, strings: Iterable[str]) -> list[str]:
        """Return strings as cells; texts in print and names of pictures as they are."""
        if self.has_texts:
            return list(strings)
        return [to_braille(spell_string(string, self.masks)) for string in strings]

    @property
    def item_columns(self) -> tuple[str, ...]:
        """Columns that the file of items has beside the strings."""
        return tuple(next(iter(self.columns.values()), ()))

    @property
    def marker_codes(self) -> dict[str, int]:
        """Byte of each condition."""
        names = [condition.name for condition in self.conditions]
        free = {name: min(FIRST_CODE + n, MOST_CODE) for n, name in enumerate(names)}
        return free | self.markers.codes

    @property
    def needs_pins(self) -> bool:
        """Tell whether a conventional display is needed."""
        return bool(self.pins.reference) or any(look.on == "pins" for look in self.looks)
