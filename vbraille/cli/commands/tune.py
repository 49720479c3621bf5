"""``vbraille tune``: how braille feels best, two ways at a time."""

from __future__ import annotations

from typing import Any

import click

from vbraille.cli import options


@options.command(
    "tune --profile evening",
    options.optional_file, options.profile, *options.HAND, options.language, options.grade,
    options.table, *options.AROUND,
)  # fmt: skip
@click.pass_context
def command(ctx: click.Context, **chosen: Any) -> None:
    """It takes five minutes at a terminal, and saves a profile.

    Without a file, there is a text to practise on.
    """
    from pathlib import Path

    from vbraille.cli.build import save_style
    from vbraille.cli.exploring import equipped, refuse_terminal
    from vbraille.cli.settings import settings_of
    from vbraille.reading.places import Places
    from vbraille.reading.reader import Reader
    from vbraille.reading.tuning import Tuning, practice_text
    from vbraille.render import MODELS
    from vbraille.translate import Book, choose_table, open_source, text_source

    table = choose_table(chosen["language"], chosen["grade"], chosen["table"])
    if chosen["file"] is None:
        source = text_source(practice_text(chosen["language"]))
    else:
        source = open_source(chosen["file"])
    asked = MODELS[chosen["model"] or "stress2"]
    with equipped(ctx, asked.display) as equipment:
        refuse_terminal(equipment.keyboard, "vbraille tune")
        model = equipment.find(asked)
        equipment.start(model, language=chosen["language"] or "en")
        kept = Places(None, equipment.say).book("", Path(), "")
        reader = Reader(Book(source, table), equipment.device, equipment.outputs, kept)
        reader.begin()
        tuning = Tuning(reader, settings_of(ctx).profile)
        tuning.begin()
        equipment.explore(tuning)
        course = tuning.course
        if course.knob is None:
            tuning.say(save_style(ctx, model, course.style))
        else:
            made = len(course.choices)
            tuning.say(f"{made} of {course.total} choices made; nothing is saved")
