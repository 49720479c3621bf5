"""The text of a settings file to settings, or to one sentence that says the line."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import msgspec

from vbraille.settings.chosen import Settings
from vbraille.settings.tables import ProfileTable, ReadTable, check_name
from vbraille.toml.tomlfile import TomlFile, which

if TYPE_CHECKING:
    from pathlib import Path

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
