"""``vbraille tune``: how braille feels best, two ways at a time."""

from __future__ import annotations

from typing import Any

import click

from vbraille.cli import options


@click.command(cls=options.Command, epilog="Example: vbraille tune --profile evening")
@options.optional_file
@options.takes(
    options.profile, options.device, options.hand, options.language, options.grade, options.table,
    options.speech, options.model(group=options.FIRST), options.cues, options.rate, options.seed,
    options.monitor(group="Live view"), options.host, options.port, options.settings,
)  # fmt: skip
@click.pass_context
def command(ctx: click.Context, **chosen: Any) -> None:
    """It takes five minutes at a terminal, and saves a profile.

    Without a file, there is a text to practise on.
    """
    from pathlib import Path

    from vbraille.cli.build import display_name
    from vbraille.cli.exploring import equipped, find_model, refuse_terminal
    from vbraille.cli.settings import save_profile, settings_of
    from vbraille.knobs import profile_values
    from vbraille.reading.places import Places
    from vbraille.reading.reader import Reader
    from vbraille.reading.tuning import Tuning, practice_text
    from vbraille.render import MODELS
    from vbraille.translate import Book, choose_table, open_source, text_source

    settings = settings_of(ctx)
    table = choose_table(chosen["language"], chosen["grade"], chosen["table"])
    if chosen["file"] is None:
        source = text_source(practice_text(chosen["language"]))
    else:
        source = open_source(chosen["file"])
    asked = MODELS[chosen["model"] or "stress2"]
    with equipped(ctx, asked.display, hand=chosen["hand"]) as equipment:
        refuse_terminal(equipment.keyboard, "vbraille tune")
        device = equipment.device
        model = find_model(ctx, device, asked)
        equipment.start(ctx, model, language=chosen["language"] or "en")
        reader = Reader(
            Book(source, table),
            device,
            equipment.outputs,
            Places(None, equipment.say).book("", Path(), ""),
        )
        reader.begin()
        name = display_name(model)
        tuning = Tuning(reader, settings.profile)
        tuning.begin()
        equipment.explore(ctx, tuning)
        if tuning.course.knob is None:
            values = profile_values(tuning.course.style)
            save_profile(settings.path, settings.profile, name, values)
            tuning.say(f"profile {settings.profile}: saved")
        else:
            made = len(tuning.course.choices)
            tuning.say(f"{made} of {tuning.course.total} choices made; nothing is saved")
