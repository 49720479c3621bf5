"""``vbraille settings``."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.cli.old.build import build_lengths, build_show, chosen_profile
from vbraille.cli.old.reading.commands.table import bound_for
from vbraille.cli.old.terminal import print_json, say_line
from vbraille.config.option import PROFILE
from vbraille.config.options import held_in
from vbraille.config.settings import (
    Setting,
    bindings_said,
    load_settings,
    settings_said,
    tuning_said,
    with_profile,
)
from vbraille.files import settings_path
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
    profile = chosen_profile(arguments, settings)
    model = MODELS[arguments.model or "stress2"]
    if arguments.profile is not None:
        origin = "option"
    else:
        origin = settings.where("read", "profile") if "profile" in settings.read else "default"
    shown = build_show(arguments, with_profile(settings, profile, model))
    shown = build_lengths(arguments, shown)
    rows = [
        Setting("profile", profile, origin),
        Setting("display", model.title, "default" if arguments.model is None else "option"),
        *tuning_said(settings, profile, model, shown.style, _given(arguments)),
        *settings_said(settings, vars(arguments)),
        *bindings_said(settings),
    ]
    if arguments.json:
        kept = [row._asdict() for row in rows]
        there = settings.path.exists()
        print_json({"file": str(settings.path), "there": there, "settings": kept})
        return 0
    say_line(f"settings file: {settings.path}{'' if settings.path.exists() else ' (not there)'}")
    for row in rows:
        say_line(str(row))
    return 0


def _given(arguments: argparse.Namespace) -> set[str]:
    """Names, as a settings file has them, of what options say about the style."""
    options = held_in(PROFILE)
    return {each.key for each in options if getattr(arguments, each.name) is not None}
