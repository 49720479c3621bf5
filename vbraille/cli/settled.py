"""Options that nobody gave, from the settings file or as is usual."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.cli.options.groups import SETTLED
from vbraille.cli.terminal import say_line
from vbraille.logs import want_tracebacks
from vbraille.reading.bindings import Bindings, Bound
from vbraille.reading.commands.table import bound_by
from vbraille.settings.loading import load_settings

if TYPE_CHECKING:
    import argparse

    from vbraille.settings.values import Settings

TRANSLATION = ("language", "grade", "table")


def settle(arguments: argparse.Namespace, names: tuple[str, ...] = SETTLED) -> Settings:
    """Fill in options that were not given; afterwards `settled` names those from the file.

    Parameters
    ----------
    arguments
        Parsed options, in which None stands for what was not given.
    names
        Options that the settings file may say.

    Raises
    ------
    InputError
        If the settings file cannot be used.
    """
    settings = load_settings(arguments.settings)
    usual = getattr(arguments, "usual", {})
    # A table of the command line's own stands for its language, and the other way round.
    given = {name for name in TRANSLATION if getattr(arguments, name) is not None}
    beside = {"language", "grade"} if "table" in given else {"table"} if given else set()
    settled = set()
    for name in names:
        if getattr(arguments, name, None) is None:
            if name in settings.read and name not in beside:
                settled.add(name)
                setattr(arguments, name, settings.read[name])
            else:
                setattr(arguments, name, usual.get(name))
    arguments.settled = frozenset(settled)
    if arguments.verbose:
        want_tracebacks()
    return settings


def chosen_profile(arguments: argparse.Namespace, settings: Settings) -> str:
    """Name of the profile in use; one that an option names and is not there is said on stderr."""
    from vbraille.settings.values import missing_profile

    if arguments.profile is None:
        return settings.profile
    if note := missing_profile(settings, arguments.profile):
        say_line(note, aside=True)
    return arguments.profile


def bind_settings(settings: Settings, keys: str | None) -> Bound:
    """Give commands the keys and buttons that the settings file has for them.

    Parameters
    ----------
    settings
        Settings of the file.
    keys
        Name of the ready set of keys; None for the one of the settings.

    Raises
    ------
    InputError
        If a command is not known, a key would call two commands, or a button is none.
    """
    ready = keys or settings.read.get("keys", "usual")
    return bound_by(Bindings(settings.keys, settings.buttons, settings.where), ready)
