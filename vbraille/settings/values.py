"""Settings as a value: read from their file, and put to use in a display's style."""

from __future__ import annotations

import re
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import msgspec

from vbraille.errors import InputError
from vbraille.files import settings_path
from vbraille.render.braille.knobs import with_values
from vbraille.settings.tables import ProfileTable, ReadTable, check_name
from vbraille.toml.tomlfile import TomlFile, which
from vbraille.wording import nearest

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from vbraille.render import Model

    Values = dict[str, float | int | str]

DEFAULT_PROFILE = "default"


@dataclass(frozen=True, slots=True)
class Settings:
    """What a settings file has.

    Parameters
    ----------
    path
        Path of the file, which need not be there.
    read
        Values of the table ``[read]``: only those that the file has.
    keys
        Keys of commands, by the command's name.
    buttons
        Names of commands, by the button of the device.
    profiles
        Values of each profile for each display, by their names.
    lines
        Line of the file for each value, by the keys that lead to it.
    """

    path: Path
    read: Mapping[str, Any] = field(default_factory=dict)
    keys: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    buttons: Mapping[str, str] = field(default_factory=dict)
    profiles: Mapping[str, Mapping[str, Values]] = field(default_factory=dict)
    lines: Mapping[tuple[str | int, ...], int] = field(default_factory=dict)

    @property
    def profile(self) -> str:
        """Name of the profile in use unless an option names another."""
        return self.read.get("profile", DEFAULT_PROFILE)

    def where(self, *keys: str) -> str:
        """File and line of a value, such as "settings.toml line 12"."""
        line = self.lines.get(keys)
        return self.path.name if line is None else f"{self.path.name} line {line}"

    def tuning(self, profile: str, model: Model) -> Values:
        """Values of a profile for a display; none if it has none."""
        return dict(self.profiles.get(profile, {}).get(display_name(model), {}))


def display_name(model: Model) -> str:
    """Name of a display in a settings file: its model's, or its own in small letters."""
    return model.name or re.sub(r"[^a-z0-9]+", "-", model.title.lower()).strip("-") or "display"


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


def load_settings(given: str | None = None) -> Settings:
    """Read the settings file; without one there are no settings.

    Parameters
    ----------
    given
        Path that an option gives, at which there must be a file; None for the usual place.

    Raises
    ------
    InputError
        If the file cannot be read, or has something that no settings file can have. One sentence
        says the line, the key, and the nearest name.
    """
    path = settings_path(given)
    if given is None and not path.exists():
        return Settings(path)
    # Imported here, since most have no such file, and need not wait for what reads it.
    from vbraille.settings.values import parse_settings
    from vbraille.toml.textfile import read_text

    return parse_settings(read_text(path, "settings file"), path)


def with_profile(settings: Settings, profile: str, model: Model) -> Model:
    """Display with the style that a profile has for it.

    Parameters
    ----------
    settings
        Settings with the profile; without it the style stays as it is.
    profile
        Name of the profile.
    model
        Display, and the style whose other values stay.

    Raises
    ------
    InputError
        If the display cannot be read like this; the message says the line of the file.
    """
    style = model.style
    values = settings.tuning(profile, model)
    place = ("profile", profile, display_name(model))
    # One after the other, so that the fault has a line; lengths bound each other, and go together.
    lengths = {name: values.pop(name) for name in list(values) if name.endswith("_mm")}
    for part, at in [(lengths, place), *(({n: v}, (*place, n)) for n, v in values.items())]:
        try:
            style = with_values(style, model.display, part)
            style.geometry.cells_per_line(model.display.span_mm)
        except (InputError, ValueError) as error:
            raise InputError(f"{settings.where(*at)}: [{'.'.join(place)}] {error}") from None
    return replace(model, style=style)


def missing_profile(settings: Settings, profile: str) -> str:
    """Sentence on a profile that somebody names and is not there; empty if it is."""
    if profile in settings.profiles:
        return ""
    near = nearest(profile, settings.profiles)
    return f"profile: {profile} is new, and is made when it is saved{near}"
