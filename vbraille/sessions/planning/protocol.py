"""A protocol: what a session shows, to be repeated by another lab from one file.

`docs/session-format.md` and the files in ``protocols/`` describe the TOML.
"""

from __future__ import annotations

import re
import tomllib
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from vbraille.braille.spelling import name_dots
from vbraille.errors import InputError
from vbraille.render import MODELS
from vbraille.sessions.planning import fromtoml
from vbraille.sessions.planning.conduct import check_line
from vbraille.sessions.planning.design import MOST_TRIALS, Choice, StringList, name_cell
from vbraille.sessions.planning.protocolfiles import builtin_names, builtin_text, read_file
from vbraille.sessions.planning.section import Section

if TYPE_CHECKING:
    from vbraille.braille.geometry import Geometry
    from vbraille.render import Mapping, Model
    from vbraille.sessions.planning.conduct import Question, SessionPace, SignalSound, TrialPace
    from vbraille.sessions.planning.design import Condition, Design, Rules
    from vbraille.sessions.planning.practice import Practice

__all__ = ["MEDIA", "Protocol", "builtin_names", "builtin_text", "load_protocol", "parse_protocol"]

FORMAT = 1
MEDIA = ("device", "paper")
_KEYS = ("format", "name", "title", "source", "model", "medium", "display", "keys", "design")
_TABLES = ("conditions", "rules", "practice", "trial", "session", "faults", "sound", "fields")
MOST_LEAD = 20
_NAME = re.compile(r"[a-z0-9-]{1,40}")


@dataclass(frozen=True, slots=True)
class Protocol:
    """What a session shows, and how it is conducted.

    Parameters
    ----------
    name, title, source
        What options call it, what people do, and where it comes from.
    model
        The display.
    medium
        "device", or "paper": what the source shows on paper or on a
        conventional display, timed by key.
    mapping, geometry
        Of the display.
    lead_cells
        Blank cells before each string, so that the array at its left stop is clear of it.
    keys
        Dot mask of each spelling beside a to z.
    design
        What is shown in each condition.
    blocks
        Conditions are mixed and spread over so many; None for a block each.
    order
        Of the blocks of conditions: "balanced" over participants, "listed" or
        "shuffled".
    conditions
        One or more.
    rules
        What the finished plan is checked for, beside its design.
    practice
        What comes before block 1.
    trial, session
        Their paces.
    repeat_faults
        Whether a trial in which the device failed is shown again.
    sound
        What is heard.
    fields
        What is asked about the participant.
    text
        The TOML, as read.

    Raises
    ------
    ValueError
        If values are out of range or do not go together.
    """

    name: str
    title: str
    source: str
    model: Model
    medium: str
    mapping: Mapping
    geometry: Geometry
    lead_cells: int
    keys: dict[str, int]
    design: Design
    blocks: int | None
    order: str
    conditions: tuple[Condition, ...]
    rules: Rules
    practice: Practice
    trial: TrialPace
    session: SessionPace
    repeat_faults: bool
    sound: SignalSound
    fields: tuple[Question, ...]
    text: str

    def __post_init__(self) -> None:
        if not _NAME.fullmatch(self.name):
            raise ValueError(
                f"name is {self.name!r}; it must be 1 to 40 small letters a to z, digits or hyphens"
            )
        check_line("title", self.title)
        check_line("source", self.source)
        _check_names("[[conditions]]", [condition.name for condition in self.conditions])
        _check_names("[[fields]]", [field.name for field in self.fields])
        self._check_trials()
        self._check_cells()
        self._check_lines()
        self._check_letters()

    @property
    def task(self) -> str:
        """What the participant does: read "strings", or make a "choice"."""
        return "choice" if isinstance(self.design, Choice) else "strings"

    @property
    def parameter(self) -> str | None:
        """What is compared, "dot_width_mm" or "dot_gap_mm"; None if strings are read."""
        return self.design.parameter if isinstance(self.design, Choice) else None

    @property
    def trials(self) -> int:
        """Trials of all conditions, without practice."""
        return self.design.trials * len(self.conditions)

    def line(self, masks: tuple[int, ...]) -> tuple[int, ...]:
        """Cells of the line that a string is shown as."""
        return (0,) * self.lead_cells + masks

    def geometry_at(self, value: float | None) -> Geometry:
        """Geometry at a value of the parameter compared; None for that of the display.

        Raises
        ------
        ValueError
            If the value gives a length out of bounds.
        """
        if value is None or not isinstance(self.design, Choice):
            return self.geometry
        if self.design.parameter == "dot_width_mm":
            return replace(self.geometry, dot_width_mm=value)
        # From edge to edge, as the source has it: the centres stand a dot's width further apart.
        return replace(self.geometry, dot_spacing_mm=self.geometry.dot_width_mm + value)

    def _check_trials(self) -> None:
        if self.trials + self.practice.trials > MOST_TRIALS:
            raise ValueError(
                f"[design] makes a session of more than {MOST_TRIALS} trials; make it smaller"
            )
        if self.blocks is not None and not 1 <= self.blocks <= self.trials:
            raise ValueError(
                f"[design] blocks is {self.blocks}; it must be 1 to {self.trials}, "
                f"since there are {self.trials} trials"
            )

    def _check_cells(self) -> None:
        shown = self.mapping.shown_dots()
        only = f"{_display(self.model, self.mapping)} shows {name_dots(shown)} only"
        practised = {mask for line in self.practice.lines(self.design) for mask in line}
        for table, masks in (("[design]", self.design.masks), ("[practice]", practised)):
            for mask in sorted(masks):
                if mask & ~shown:
                    raise ValueError(
                        f"{table} has the cell {name_cell(mask)}, and {only}; leave the cell out"
                    )
        for key, mask in self.keys.items():
            if mask & ~shown:
                raise ValueError(
                    f"[keys] {key} is {name_dots(mask)}, and {only}; leave the key out"
                )

    def _check_lines(self) -> None:
        if not 0 <= self.lead_cells <= MOST_LEAD:
            raise ValueError(
                f"[display] lead_cells is {self.lead_cells}; it must be 0 to {MOST_LEAD}"
            )
        values = self.design.values if isinstance(self.design, Choice) else (None,)
        practised = self.practice.lines(self.design)
        longest = max((self.design.cells, *map(len, practised)))
        whose = "[design]" if longest == self.design.cells else "[practice]"
        for value in (*values, *sorted(self.practice.values(self.design))):
            at = "" if value is None else f" at a value of {value:g} mm"
            try:
                room = self.geometry_at(value).cells_per_line(self.model.display.span_mm)
            except ValueError as error:
                raise ValueError(f"[design]{at}: {error}") from None
            cells = self.lead_cells + longest
            if cells > room:
                raise ValueError(
                    f"{whose} has a line of {cells} cells{at}, lead_cells among them, and the "
                    f"{self.model.title} has room for {room}; make it shorter, or travel_mm longer"
                )

    def _check_letters(self) -> None:
        if isinstance(self.design, StringList):
            problem = self.rules.problem(self.design.items())
            if problem:
                raise ValueError(f"[rules] {problem}; change the strings or the rule")
        elif (self.rules.each_letter, self.rules.each_letter_at_least) != (None, None):
            raise ValueError("[rules] count the letters of kind = 'list'; leave them out")


def load_protocol(spec: str) -> Protocol:
    """Read a protocol.

    Parameters
    ----------
    spec
        Name of one that comes with the program; or a file, if it ends in
        ``.toml`` or has a ``/`` in it.

    Raises
    ------
    InputError
        If there is no such protocol, or it cannot be used.
    """
    if spec.endswith(".toml") or "/" in spec:
        return parse_protocol(read_file(spec), spec)
    return parse_protocol(builtin_text(spec), f"{spec}.toml")


def parse_protocol(text: str, where: str, *, planned: bool = False) -> Protocol:
    """Check a protocol.

    Parameters
    ----------
    text
        TOML.
    where
        The file, as messages name it.
    planned
        Whether it is that of a session: its plan has been made, and what version 0.1 took
        is taken still (blanks and dot numbers in strings, practice of the test's items).

    Raises
    ------
    InputError
        If it cannot be used. One sentence says where, why, and what to do.
    """
    try:
        tree = tomllib.loads(text)
    except RecursionError:
        raise InputError(f"{where} is not TOML: its brackets nest too deep; mend it") from None
    except ValueError as error:
        raise InputError(f"{where} is not TOML: {error}; mend it there") from None
    # Before all keys are known: another format may have others.
    version = Section(where, "", tree, None).whole("format")
    if version != FORMAT:
        raise InputError(
            f"{where}: format is {version}, and this vbraille knows format {FORMAT}; "
            f"use a vbraille that knows it"
        )
    root = Section(where, "", tree, (*_KEYS, *_TABLES))
    model = MODELS[root.one_of("model", MODELS)]
    mapping, geometry, lead_cells, tuning = fromtoml.read_display(root, model)
    keys = fromtoml.read_keys(root)
    design, blocks, order = fromtoml.read_design(root, keys, planned=planned)
    trial, session = fromtoml.read_paces(root)
    with root.checking():
        return Protocol(
            name=root.text("name"),
            title=root.text("title"),
            source=root.text("source"),
            model=model,
            medium=root.one_of("medium", MEDIA, MEDIA[0]),
            mapping=mapping,
            geometry=geometry,
            lead_cells=lead_cells,
            keys=keys,
            design=design,
            blocks=blocks,
            order=order,
            conditions=fromtoml.read_conditions(root, model, tuning),
            rules=fromtoml.read_rules(root),
            practice=fromtoml.read_practice(root, keys, design, planned=planned),
            trial=trial,
            session=session,
            repeat_faults=root.table("faults", ("repeat",)).flag("repeat", True),
            sound=fromtoml.read_sound(root),
            fields=fromtoml.read_fields(root),
            text=text,
        )


def _display(model: Model, mapping: Mapping) -> str:
    if mapping.rows == 1:
        return f"the {model.title}'s row {mapping.left[0] + 1}"
    return f"the {model.title} with the mapping {mapping.name}"


def _check_names(table: str, names: list[str]) -> None:
    for name in names:
        if names.count(name) > 1:
            raise ValueError(f"{table} has the name {name!r} twice; give each its own")
