"""A protocol: all that a session shows, in one file, so that another lab can repeat it.

`docs/session-format.md` and the files in ``protocols/`` describe the format.
"""

from __future__ import annotations

import re
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Literal

from msgspec import field

from vbraille.braille.spelling import name_dots, to_braille
from vbraille.render import MODELS
from vbraille.sessions.planning.appearance import Appearance, Condition
from vbraille.sessions.planning.asking import CellSpelling
from vbraille.sessions.planning.conduct import (
    FaultRules,
    Question,
    SessionPace,
    SignalSound,
    TrialPace,
    check_line,
)
from vbraille.sessions.planning.design import (
    MOST_TRIALS,
    Choice,
    Combinations,
    Rules,
    StringList,
)
from vbraille.sessions.planning.practice import Practice
from vbraille.sessions.planning.procedures import FixedProcedure, ProcedureTable
from vbraille.sessions.planning.questions import AnyQuestion, usual_question
from vbraille.sessions.planning.spellings import SpellingKeys
from vbraille.toml.tomlfile import Table, which

if TYPE_CHECKING:
    from vbraille.braille.geometry import Geometry
    from vbraille.render import BrailleStyle, Mapping, Model, Tuning

FORMAT = 1
ONLY_CONDITION = "all"
_NAME = re.compile(r"[a-z0-9-]{1,40}")


class ProtocolFile(Table, frozen=True, kw_only=True):
    """The keys of a protocol's file."""

    format: int
    name: str
    title: str
    source: str
    model_name: str = field(name="model")
    medium: Literal["device", "paper"] = "device"
    display: Appearance = Appearance()
    keys: SpellingKeys = field(default_factory=SpellingKeys)
    design: Combinations | StringList | Choice
    listed: tuple[Condition, ...] = field(name="conditions", default=())
    rules: Rules = Rules()
    procedure: ProcedureTable = FixedProcedure()
    question: AnyQuestion | None = None
    practice: Practice = Practice()
    trial: TrialPace = TrialPace()
    session: SessionPace = SessionPace()
    faults: FaultRules = FaultRules()
    sound: SignalSound = SignalSound()
    fields: tuple[Question, ...] = ()


class Protocol(ProtocolFile, frozen=True, kw_only=True, dict=True):
    """What a session shows, and how it is conducted.

    Parameters
    ----------
    format
        Format of the file, which is 1.
    name, title, source
        Name of the protocol in options, what participants do, and where the protocol comes from.
    model_name
        Name of the display's model.
    medium
        "device"; or "paper" for strings that are read on paper or on a conventional display, and
        timed by a key.
    display
        How strings are shown on the display.
    keys
        Dot masks of the characters that may spell a cell beside a to z.
    design
        What is shown in each condition.
    listed
        Conditions that the file lists; empty if there is only one, which has no name there.
    rules
        Rules that the finished plan is checked for, beside its design.
    procedure
        Which trial comes next, and when enough was asked.
    question
        What is asked of each trial; None to identify a string, or to choose one of two.
    practice
        Practice before the first block.
    trial, session
        Pace of each trial, and of the whole session.
    faults
        What is done about a trial in which the device failed.
    sound
        Sounds that the participant hears.
    fields
        Questions about the participant.
    text
        The file's TOML text, as it was read.

    Raises
    ------
    ValueError
        If values are out of range or contradict each other.
    """

    text: str

    def __post_init__(self) -> None:
        if not _NAME.fullmatch(self.name):
            raise ValueError(
                f"name is {self.name!r}; it must be 1 to 40 small letters a to z, digits or hyphens"
            )
        check_line("title", self.title)
        check_line("source", self.source)
        if self.model_name not in MODELS:
            raise ValueError(f"model is {self.model_name!r}{which(self.model_name, MODELS)}")
        _check_agreement(self)

    @property
    def model(self) -> Model:
        """Model of the display."""
        return MODELS[self.model_name]

    @cached_property
    def style(self) -> BrailleStyle:
        """How strings are shown on the display."""
        return self.display.style(self.model)

    @property
    def mapping(self) -> Mapping:
        """Which dots the rows of the display's array show."""
        return self.style.mapping

    @property
    def geometry(self) -> Geometry:
        """Distances between the dots of a line, and the length of the carriage's travel."""
        return self.style.geometry

    @property
    def conditions(self) -> tuple[Condition, ...]:
        """Conditions of the protocol, at least one."""
        return self.listed or (Condition(name=ONLY_CONDITION),)

    @property
    def repeat_faults(self) -> bool:
        """Whether a trial in which the device failed is shown again."""
        return self.faults.repeat

    @property
    def task(self) -> str:
        """What the participant does: "strings" for reading strings, "choice" for comparing two."""
        return "choice" if isinstance(self.design, Choice) else "strings"

    @property
    def parameter(self) -> str | None:
        """Length that is compared, "dot_width_mm" or "dot_gap_mm"; None if strings are read."""
        return self.design.parameter if isinstance(self.design, Choice) else None

    @property
    def asks(self) -> AnyQuestion:
        """Question that is asked of each trial."""
        return self.question or usual_question(2 if self.task == "choice" else 1)

    @property
    def cell_spelling(self) -> CellSpelling:
        """How cells may be typed in answers."""
        return CellSpelling(self.keys, self.mapping.shown_dots())

    @property
    def adaptive(self) -> bool:
        """Whether it depends on the answers which trials there are."""
        return not isinstance(self.procedure, FixedProcedure)

    @property
    def trials(self) -> int:
        """Number of trials in all conditions, practice left out; the most if answers decide."""
        table = self.procedure
        most = None if isinstance(table, FixedProcedure) else table.trials
        if most is not None:
            return min(most, self.design.trials) * len(self.conditions)
        return self.design.trials * len(self.conditions)

    @property
    def lead_cells(self) -> int:
        """Number of blank cells before each string, which keep it clear of the left stop."""
        return self.display.lead_cells

    def tuning(self, condition: Condition) -> Tuning:
        """Tuning that a condition is shown with."""
        return condition.tune(self.model, self.style.tuning)

    def line(self, masks: tuple[int, ...]) -> tuple[int, ...]:
        """Cells of the line on which a string is shown, with the blank ones before it."""
        return (0,) * self.lead_cells + masks

    def geometry_at(self, value: float | None) -> Geometry:
        """Geometry at a value of the parameter compared; that of the display if the value is None.

        Raises
        ------
        ValueError
            If the value gives a length out of bounds.
        """
        if value is None or not isinstance(self.design, Choice):
            return self.geometry
        if self.design.parameter == "dot_width_mm":
            return replace(self.geometry, dot_width_mm=value)
        # The gap is from edge to edge; the centres of the dots are a dot's width further apart.
        return replace(self.geometry, dot_spacing_mm=self.geometry.dot_width_mm + value)


def _check_agreement(protocol: Protocol) -> None:
    """Check that the tables of a protocol agree with each other.

    Raises
    ------
    ValueError
        If values contradict each other.
    """
    for table, named in (("conditions", protocol.conditions), ("fields", protocol.fields)):
        names = [value.name for value in named]
        for number, name in enumerate(names, 1):
            if name in names[: number - 1]:
                raise ValueError(
                    f"[[{table}]] number {number} name is {name!r} again; give each its own"
                )
    _check_tuning(protocol)
    _check_procedure(protocol)
    _check_question(protocol)
    problem = protocol.practice.problem(protocol.design)
    if problem:
        raise ValueError(f"[practice] {problem}")
    _check_trials(protocol)
    _check_cells(protocol)
    _check_lines(protocol)
    _check_letters(protocol)


def _check_tuning(protocol: Protocol) -> None:
    table = "[display]"
    try:
        protocol.style  # noqa: B018
        for number, condition in enumerate(protocol.listed, 1):
            table = f"[[conditions]] number {number}"
            protocol.tuning(condition)
    except ValueError as error:
        raise ValueError(f"{table} {error}") from None


def _check_procedure(protocol: Protocol) -> None:
    problem = protocol.procedure.problem(protocol.design)
    if problem:
        raise ValueError(f"[procedure] {problem}")
    if not protocol.adaptive:
        return
    if protocol.medium == "paper":
        raise ValueError(
            "[procedure] varies what a device shows; with medium = 'paper' leave it out"
        )
    if protocol.task == "choice" and protocol.rules.never_twice_running:
        raise ValueError(
            "[rules] never_twice_running is of a fixed order of values; leave it out, since "
            "[procedure] chooses them"
        )
    own = getattr(protocol.procedure, "parameter", None)
    for condition in protocol.conditions if own else ():
        if own in condition.given:
            raise ValueError(
                f"[procedure] parameter is {own!r}, which the condition {condition.name} sets "
                f"itself; leave it out there"
            )


def _check_question(protocol: Protocol) -> None:
    stimuli = 2 if protocol.task == "choice" else 1
    problem = protocol.asks.problem(stimuli, adaptive=protocol.adaptive)
    if problem:
        raise ValueError(f"[question] {problem}")
    same = isinstance(protocol.design, Choice) and protocol.design.same
    if same and (protocol.asks.name != "same-different" or protocol.adaptive):
        raise ValueError(
            "[design] same is of [question] kind = 'same-different' in a fixed order; leave it out"
        )
    if protocol.trial.end is not None and protocol.medium == "paper":
        raise ValueError("[trial] end is of a device; on paper Enter ends reading, leave it out")


def _check_trials(protocol: Protocol) -> None:
    trials, blocks = protocol.design.trials * len(protocol.conditions), protocol.design.blocks
    if trials + protocol.practice.trials > MOST_TRIALS:
        raise ValueError(
            f"[design] makes a session of more than {MOST_TRIALS} trials; make it smaller"
        )
    if blocks != "conditions" and not 1 <= blocks <= trials:
        raise ValueError(
            f"[design] blocks is {blocks}; it must be 1 to {trials}, "
            f"since there are {trials} trials"
        )


def _check_cells(protocol: Protocol) -> None:
    """Check that the display can show every dot of every cell used."""
    model, mapping, design = protocol.model, protocol.mapping, protocol.design
    shown = mapping.shown_dots()
    how = (
        f"'s row {mapping.left[0] + 1}"
        if mapping.rows == 1
        else f" with the mapping {mapping.name}"
    )
    only = f"the {model.title}{how} shows {name_dots(shown)} only"
    practised = {mask for line in protocol.practice.lines(design) for mask in line}
    for table, masks in (("[design]", design.masks), ("[practice]", practised)):
        for mask in sorted(masks):
            if mask & ~shown:
                cell = f"{to_braille((mask,))} ({name_dots(mask)})"
                raise ValueError(f"{table} has the cell {cell}, and {only}; leave the cell out")
    for key, mask in protocol.keys.items():
        if mask & ~shown:
            raise ValueError(f"[keys] {key} is {name_dots(mask)}, and {only}; leave the key out")


def _check_lines(protocol: Protocol) -> None:
    """Check that the display has room for the longest line, at each value that is compared."""
    model, design, practice = protocol.model, protocol.design, protocol.practice
    values = (None,)
    if isinstance(design, Choice):
        values = tuple(dict.fromkeys((*design.values, *protocol.procedure.values(design))))
    longest = max((design.cells, *map(len, practice.lines(design))))
    whose = "[design]" if longest == design.cells else "[practice]"
    for value in (*values, *sorted(set(practice.values))):
        at = "" if value is None else f" at a value of {value:g} mm"
        try:
            room = protocol.geometry_at(value).cells_per_line(model.display.span_mm)
        except ValueError as error:
            raise ValueError(f"[design]{at}: {error}") from None
        cells = protocol.lead_cells + longest
        if cells > room:
            raise ValueError(
                f"{whose} has a line of {cells} cells{at}, lead_cells among them, and the "
                f"{model.title} has room for {room}; make it shorter, or travel_mm longer"
            )


def _check_letters(protocol: Protocol) -> None:
    rules = protocol.rules
    if isinstance(protocol.design, StringList):
        problem = rules.problem(protocol.design.items())
        if problem:
            raise ValueError(f"[rules] {problem}; change the strings or the rule")
    elif (rules.each_letter, rules.each_letter_at_least) != (None, None):
        raise ValueError("[rules] count the letters of kind = 'list'; leave them out")
