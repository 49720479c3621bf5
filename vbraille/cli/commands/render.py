"""``vbraille render``."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import click

from vbraille.cli import options
from vbraille.cli.printing import Progress, say

_SCENES = (".scene", ".svg", ".svgz", ".gen", ".tx")


@options.command(
    "render book.txt --lines 1-3 --hand slow --out reading.h5",
    options.file,
    options.out(required=True, metavar="FILE.h5", help="HDF5 file to write."),
    options.force,
    options.lines,
    options.hand(default=None, show_default=False, help="Simulated hand, such as slow, sweep:60, "
                 "recorded:FILE.csv, or wide over a picture."),
    options.rate(group=options.FIRST),
    options.model(group=options.FIRST, help="Display model."),
    options.language, options.grade, options.height(group=options.FIRST),
    options.seed,
    *options.TRANSLATION[2:], *options.FEEL, options.travel, options.straying, options.band,
    options.profile(group="Places and settings"), options.settings,
)  # fmt: skip
@click.pass_context
def command(ctx: click.Context, **chosen: Any) -> None:
    """A tactile picture is rendered on a way over it."""
    from vbraille.errors import InputError

    hand = chosen["hand"] or ""
    if Path(chosen["out"]).suffix.lower() not in (".h5", ".hdf5"):
        raise InputError(f"{chosen['out']} does not end in .h5; render writes HDF5")
    picture = Path(chosen["file"]).suffix.lower() in _SCENES
    if picture or hand.partition(":")[0] in ("wide", "spot"):
        _render_picture(chosen)
    else:
        _render_reading(ctx, chosen)


def _render_reading(ctx: click.Context, chosen: dict[str, Any]) -> None:
    from vbraille.cli.build import Page, build_book, build_model
    from vbraille.reading.rendering import lines_per_page, render_reading
    from vbraille.render import MODELS
    from vbraille.simulation.specs import parse_hand
    from vbraille.wording import count

    model = MODELS[chosen["model"] or "stress2"]
    model = build_model(ctx, replace(model, display=replace(model.display, height_mm=0.0)))
    hand = parse_hand(chosen["hand"] or "sweep:60", chosen["seed"])
    per_page = lines_per_page(chosen["height"], model.style.geometry.line_pitch_mm)
    page = Page(ctx, build_book(ctx), model)
    progress = Progress()
    rendered = render_reading(
        chosen["out"], page.lines(), page.layout, model, hand, chosen["rate"], per_page,
        replace_file=chosen["force"], done=lambda line: progress.at(page.progress(line)),
    )  # fmt: skip
    for sentence in page.remarks():
        say(sentence, aside=True)
    lines, frames = count(rendered.lines, "line"), count(rendered.frames, "frame")
    say(f"rendered: {lines}, {frames}, {rendered.seconds:.1f} s of reading")


def _render_picture(chosen: dict[str, Any]) -> None:
    from vbraille.pictures.paths import path_of
    from vbraille.reading.rendering import render_picture
    from vbraille.render import MODELS
    from vbraille.simulation.specs import parse_hand
    from vbraille.wording import count

    model = MODELS[chosen["model"] or "stress2-8x8"]
    spec = chosen["hand"] or "wide"
    hand = parse_hand(spec, chosen["seed"])
    rendered, notes = render_picture(
        chosen["out"],
        chosen["file"],
        model,
        lambda canvas: path_of(hand, canvas, model.display.span_mm, chosen["rate"]),
        chosen["rate"],
        spec,
        replace_file=chosen["force"],
        done=Progress().at,
    )
    for note in notes:
        say(note, aside=True)
    say(f"rendered: {count(rendered.frames, 'frame')}, {rendered.seconds:.1f} s on the way")
