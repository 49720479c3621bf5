"""The tables of a settings file, with their keys and values, and settings made of its text."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

import msgspec

from vbraille.errors import check_range
from vbraille.render.braille.knobs import KNOBS
from vbraille.render.braille.straying import BAND_BOUNDS
from vbraille.settings.values import Settings
from vbraille.toml.tomlfile import Table, TomlFile, which

if TYPE_CHECKING:
    from pathlib import Path


class ReadTable(Table, frozen=True):
    """The table ``[read]``: options of ``vbraille read`` for whoever does not give them.

    Parameters
    ----------
    profile
        Name of the profile in use.
    device, language, grade, table, encoding, foreign, undefined, keep_lines, advance, echo, verbose
        Options of the same names.
    speech
        Whether what is said is spoken too.
    cues
        How signals are given.
    straying, band
        What a page shows to a finger that strays from its line; see
        `vbraille.render.braille.straying`.
    also
        Conventional display that shows the lines, too.
    keys
        Ready set of keys, before those of the table ``[keys]``.
    """

    profile: str | None = None
    device: str | None = None
    language: str | None = None
    grade: int | None = None
    table: str | None = None
    encoding: str | None = None
    foreign: Literal["switch", "own"] | None = None
    undefined: Literal["mark", "name", "code", "drop"] | None = None
    keep_lines: bool | None = None
    advance: Literal["return", "key"] | None = None
    echo: Literal["none", "text", "cells", "both"] | None = None
    speech: bool | None = None
    cues: Literal["sound", "bell", "none"] | None = None
    also: str | None = None
    verbose: bool | None = None
    straying: Literal["line", "free"] | None = None
    band: float | None = None
    keys: Literal["usual", "nvda"] | None = None

    def __post_init__(self) -> None:
        check_range("band", self.band, *BAND_BOUNDS)
        if self.profile is not None:
            check_name(self.profile)
        if self.table is not None and (self.language is not None or self.grade is not None):
            raise ValueError("table has its language and grade; give either the table or those")


class ProfileTable(Table, frozen=True):
    """A table ``[profile.NAME.DISPLAY]``: how braille is shown to a reader on a display.

    Parameters
    ----------
    texture, contrast, texture_cycles, dot_width_mm, dot_spacing_mm, cell_gap_mm, line_pitch_mm
        Values of the knobs of the same names.
    mapping
        Name of the mapping, on a display that shows all rows of dots.
    dot_row
        Row of dots that is shown, 1 to 3, on a display that shows one.
    """

    texture: float | None = None
    contrast: float | None = None
    texture_cycles: int | None = None
    dot_width_mm: float | None = None
    dot_spacing_mm: float | None = None
    cell_gap_mm: float | None = None
    line_pitch_mm: float | None = None
    mapping: str | None = None
    dot_row: int | None = None

    def __post_init__(self) -> None:
        for name, knob in KNOBS.items():
            unit = f" {knob.unit}" if knob.unit else ""
            check_range(knob.label, getattr(self, name), knob.low, knob.high, unit)
        if self.texture_cycles is not None and self.texture_cycles % 2 == 0:
            raise ValueError(f"texture cycles are {self.texture_cycles}; they must be odd")
        check_range("dot row", self.dot_row, 1, 3)


def check_name(name: str) -> None:
    """Check that a profile can have a name.

    Raises
    ------
    ValueError
        If it is empty, or has anything but letters, digits, blanks, ``-``, ``_`` and ``.``.
    """
    if not name.strip() or not all(c.isalnum() or c in " -_." for c in name):
        raise ValueError(f"profile is {name!r}; it must be a name of letters and digits")


_TABLES = ("read", "keys", "buttons", "profile")


def parse_settings(text: str, path: Path) -> Settings:
    """Make settings of the text of their file.

    Raises
    ------
    InputError
        If the text has something that no settings file can have.
    """
    file = TomlFile(text, path.name)
    for table in file.names():
        if table not in _TABLES:
            file.fail((table,), f"is no table of settings{which(table, _TABLES)}")
        if table == "profile" and not file.is_table(table):
            file.fail((table,), "is no table; write which one is in use under [read]")
        file.names(table)  # it must be a table
    read = file.read(ReadTable, under=("read",)) if "read" in file.names() else ReadTable()
    profiles = {
        name: {
            display: _given(file.read(ProfileTable, under=("profile", name, display)))
            for display in file.names("profile", name)
        }
        for name in file.names("profile")
    }
    for name in profiles:
        try:
            check_name(name)
        except ValueError as error:
            file.fail(("profile", name), f": {error}")
    return Settings(
        path,
        _given(read),
        {key: file.read(tuple[str, ...], under=("keys", key)) for key in file.names("keys")},
        {key: file.read(str, under=("buttons", key)) for key in file.names("buttons")},
        profiles,
        file.lines(),
    )


def _given(table: msgspec.Struct) -> dict[str, Any]:
    """Values that a table of the file has."""
    return {
        name: value for name, value in msgspec.structs.asdict(table).items() if value is not None
    }
