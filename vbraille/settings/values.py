"""Settings as a value: read from their file, and put to use in a display's style."""

from __future__ import annotations

import re
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from vbraille.errors import InputError
from vbraille.render.braille.knobs import with_values
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
