"""Keys and buttons of the settings file, for the commands of a reader."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.reading.bindings import Bindings, Bound
from vbraille.reading.commands.table import COMMANDS, TURNED, bound_by

if TYPE_CHECKING:
    from vbraille.settings.chosen import Settings


def bind_settings(settings: Settings) -> Bound:
    """Give commands the keys and buttons that the settings file has for them.

    Raises
    ------
    InputError
        If a command is not known, a key would call two commands, or a button is none.
    """
    names = [command.name for command in COMMANDS]
    settings.check_names("keys", names)
    settings.check_names("buttons", [*names, *TURNED])
    return bound_by(Bindings(settings.keys, settings.buttons))
