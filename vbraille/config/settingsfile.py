"""The tables of the settings file, whose keys are the options that it may have."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

import msgspec

from vbraille.config.options import FILE, PROFILE, held_in
from vbraille.tomlfile import Table, TomlFile, which

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.config.options import Option

    Values = dict[str, float | int | str]
    Parsed = tuple[
        dict[str, Any],
        dict[str, tuple[str, ...]],
        dict[str, str],
        dict[str, dict[str, Values]],
        dict[tuple[str | int, ...], int],
    ]


def _table(name: str, place: str, check: Callable[[Any], None]) -> Any:
    """Make the type of a table of the file from the options that hold in it."""

    def check_all(table: Table) -> None:
        for option in options:
            option.check(getattr(table, option.key), option.label)
        check(table)

    options = held_in(place)
    fields = [(option.key, _type(option) | None, None) for option in options]
    checks = {"__post_init__": check_all}
    return msgspec.defstruct(name, fields, bases=(Table,), namespace=checks, frozen=True)


def _type(option: Option) -> Any:
    """Give the type that the value of an option has in a file."""
    if isinstance(option.choices, tuple):
        return Literal[option.choices]
    return option.kind if isinstance(option.kind, type) else str


def _check_read(read: Any) -> None:
    if read.profile is not None:
        check_name(read.profile)
    if read.table is not None and (read.language is not None or read.grade is not None):
        raise ValueError("table has its language and grade; give either the table or those")


def _check_profile(profile: Any) -> None:
    cycles = profile.texture_cycles
    if cycles is not None and cycles % 2 == 0:
        raise ValueError(f"texture cycles are {cycles}; they must be odd")


def check_name(name: str) -> None:
    """Check that a profile can have a name.

    Raises
    ------
    ValueError
        If it is empty, or has anything but letters, digits, blanks, ``-``, ``_`` and ``.``.
    """
    if not name.strip() or not all(c.isalnum() or c in " -_." for c in name):
        raise ValueError(f"profile is {name!r}; it must be a name of letters and digits")


# Options of `vbraille read` where none are given, and how braille is shown on a display.
ReadTable = _table("ReadTable", FILE, _check_read)
ProfileTable = _table("ProfileTable", PROFILE, _check_profile)
_TABLES = ("read", "keys", "buttons", "profile")


def parse_tables(text: str, where: str) -> Parsed:
    """Read [read], [keys], [buttons] and the profiles of a file, and the line of each value.

    Raises
    ------
    InputError
        If the text has something that no settings file can have.
    """
    file = TomlFile(text, where)
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
    return (
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
