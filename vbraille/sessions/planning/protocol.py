"""A protocol: what a session shows, to be repeated by another lab from one file.

`docs/session-format.md` and the files in ``protocols/`` describe the TOML.
"""

from __future__ import annotations

import re
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Literal

import msgspec
from msgspec import field

from vbraille.render import MODELS
from vbraille.sessions.planning.agreement import check_agreement
from vbraille.sessions.planning.appearance import Appearance, Condition
from vbraille.sessions.planning.conduct import (
    FaultRules,
    Question,
    SessionPace,
    SignalSound,
    TrialPace,
    check_line,
)
from vbraille.sessions.planning.design import Choice, Combinations, Rules, StringList
from vbraille.sessions.planning.practice import Practice
from vbraille.sessions.planning.protocolfiles import builtin_names, builtin_text, read_file
from vbraille.sessions.planning.spellings import SpellingKeys, read_keys, spelled
from vbraille.sessions.planning.tomlfile import Table, TomlFile, which

if TYPE_CHECKING:
    from vbraille.braille.geometry import Geometry
    from vbraille.render import BrailleStyle, Mapping, Model, Tuning

__all__ = ["Protocol", "builtin_names", "builtin_text", "load_protocol", "parse_protocol"]

FORMAT = 1
ONLY_CONDITION = "all"
_NAME = re.compile(r"[a-z0-9-]{1,40}")


class _File(Table, frozen=True, kw_only=True):
    """What a protocol's file has, key by key."""

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
    practice: Practice = Practice()
    trial: TrialPace = TrialPace()
    session: SessionPace = SessionPace()
    faults: FaultRules = FaultRules()
    sound: SignalSound = SignalSound()
    fields: tuple[Question, ...] = ()


class Protocol(_File, frozen=True, kw_only=True, dict=True):
    """What a session shows, and how it is conducted: what its file has, and what follows from it.

    Parameters
    ----------
    format
        Of the file: 1.
    name, title, source
        What options call it, what people do, and where it comes from.
    model_name
        The display, by its name.
    medium
        "device", or "paper": what the source shows on paper or on a
        conventional display, timed by key.
    display
        How strings are shown on the display.
    keys
        Dot mask of each spelling beside a to z.
    design
        What is shown in each condition.
    listed
        Conditions of the file; none if there is only one, without a name.
    rules
        What the finished plan is checked for, beside its design.
    practice
        What comes before block 1.
    trial, session
        Their paces.
    faults
        What becomes of a trial in which the device failed.
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
        check_agreement(self)

    @property
    def model(self) -> Model:
        """The display."""
        return MODELS[self.model_name]

    @cached_property
    def style(self) -> BrailleStyle:
        """How strings are shown on it."""
        return self.display.style(self.model)

    @property
    def mapping(self) -> Mapping:
        """Which dots its rows show."""
        return self.style.mapping

    @property
    def geometry(self) -> Geometry:
        """Distances on it."""
        return self.style.geometry

    @property
    def conditions(self) -> tuple[Condition, ...]:
        """One or more."""
        return self.listed or (Condition(name=ONLY_CONDITION),)

    @property
    def repeat_faults(self) -> bool:
        """Whether a trial in which the device failed is shown again."""
        return self.faults.repeat

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

    @property
    def lead_cells(self) -> int:
        """Blank cells before each string, so that the array at its left stop is clear of it."""
        return self.display.lead_cells

    def tuning(self, condition: Condition) -> Tuning:
        """What a condition is shown with."""
        return condition.tune(self.model, self.style.tuning)

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
    file = TomlFile(text, where)
    file.read(_Format)  # before all keys are known: another format may have others
    keys = file.read(_Keyed, read_keys).keys
    tables = file.read(_File, spelled(keys, planned=planned))
    with file.checking():
        protocol = Protocol(**msgspec.structs.asdict(tables), text=text)
        if protocol.practice.trials and not protocol.practice.items and not planned:
            raise ValueError(
                f"[practice] has no items of its own, and those of the test would be given away; "
                f"give {'values' if protocol.parameter else 'strings'} that the test does not "
                f"have, or trials = 0"
            )
    return protocol


class _Format(msgspec.Struct):
    """What is known of a file of any format."""

    format: int

    def __post_init__(self) -> None:
        if self.format != FORMAT:
            raise ValueError(
                f"format is {self.format}, and this vbraille knows format {FORMAT}; "
                f"use a vbraille that knows it"
            )


class _Keyed(msgspec.Struct):
    """What is read before the strings that are spelled by it."""

    keys: SpellingKeys = field(default_factory=SpellingKeys)
