"""``vbraille settings``."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.cli.build import build_lengths, build_show, chosen_profile
from vbraille.cli.terminal import say_line
from vbraille.config.options import PROFILE, held_in
from vbraille.config.settings import (
    load_settings,
    say_bindings,
    say_settings,
    say_tuning,
    with_profile,
)
from vbraille.files import settings_path
from vbraille.reading.commands.table import bound_for
from vbraille.render import MODELS

if TYPE_CHECKING:
    import argparse


def run(arguments: argparse.Namespace) -> int:
    """Print a line for each setting, or the path of the file."""
    if arguments.where:
        say_line(str(settings_path(arguments.settings)))
        return 0
    settings = load_settings(arguments.settings)
    bound_for(settings)  # which refuses what reading would
    there = "" if settings.path.exists() else " (not there)"
    say_line(f"settings file: {settings.path}{there}")
    profile = chosen_profile(arguments, settings)
    model = MODELS[arguments.model or "stress2"]
    if arguments.profile is not None:
        origin = "option"
    else:
        origin = settings.where("read", "profile") if "profile" in settings.read else "default"
    say_line(f"profile: {profile} ({origin})")
    say_line(f"display: {model.title} ({'default' if arguments.model is None else 'option'})")
    shown = build_show(arguments, with_profile(settings, profile, model))
    shown = build_lengths(arguments, shown)
    for sentence in (
        *say_tuning(settings, profile, model, shown.style, _given(arguments)),
        *say_settings(settings, vars(arguments)),
        *say_bindings(settings),
    ):
        say_line(sentence)
    return 0


def _given(arguments: argparse.Namespace) -> set[str]:
    """Names, as a settings file has them, of what options say about the style."""
    options = held_in(PROFILE)
    return {each.key for each in options if getattr(arguments, each.name) is not None}
