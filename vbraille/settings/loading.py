"""The settings file, read if there is one."""

from __future__ import annotations

from vbraille.files import settings_path
from vbraille.settings.values import Settings


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
    from vbraille.settings.tables import parse_settings
    from vbraille.toml.textfile import read_text

    return parse_settings(read_text(path, "settings file"), path)
