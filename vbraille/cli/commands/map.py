"""``vbraille map``."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import click

from vbraille.cli import options
from vbraille.cli.printing import say

_ANSWERS = "Pictures that answer the hand"


def _numbers(text: str, counts: tuple[int, ...], most: float) -> tuple[float, ...]:
    number = options.Number(-most, most)
    parts = text.split(",")
    if len(parts) not in counts:
        count = " or ".join(map(str, counts))
        raise click.BadParameter(f"{text!r} is not {count} numbers with commas between")
    return tuple(number.convert(part, None, None) for part in parts)


def _pose(text: str) -> tuple[float, ...]:
    """Place of the array, such as X,Y or X,Y,θ."""
    return _numbers(text, (2, 3), 1e6)


def _velocity(text: str) -> tuple[float, ...]:
    """Velocity of the hand, X,Y."""
    return _numbers(text, (2,), 1000)


def _states(text: str) -> dict[int, int]:
    """States of switches such as 1=2,3=1, from 1; as states from 0 by keys."""
    if not re.fullmatch(r"[1-8]=[1-8](,[1-8]=[1-8])*", text):
        raise click.BadParameter(f"{text!r} is not a list of switch states such as 1=2")
    return {int(part[0]): int(part[2]) - 1 for part in text.split(",")}


@options.command(
    "map texts/scenes/gallery/layers.scene --out layers.png",
    options.file,
    options.out(required=True, help="Picture to write: .png, .svg, .pdf, .csv or .gif."),
    options.force,
    options.option("--outline", is_flag=True, help="Draw black outlines, true to scale, for swell "
                   "paper."),
    options.option("--key", is_flag=True, help="Draw numbers for labels that do not fit, and the "
                   "key in a second file."),
    options.option("--array", type=_pose, metavar="X,Y[,θ]", help="Draw the array with its "
                   "centre here, in mm and degrees."),
    options.model(group=options.FIRST, default="stress2-8x8", help="Display whose array is drawn."),
    options.option("--rulers", is_flag=True, help="Draw rulers in mm."),
    options.option("--frames", type=options.whole(2, 500), metavar="N", help="Draw N maps over one "
                   "swing: a .gif, or numbered files."),
    options.option("--resolution", type=options.Number(0.01, 1000), metavar="N",
                   help="Pixels a mm."),
    options.option("--velocity", type=_velocity, metavar="X,Y", default="0,0",
                   help="Velocity of the hand in mm/s.", group=_ANSWERS),
    options.option("--switch", type=_states, metavar="K=N",
                   help="State N of the switch of key K.", group=_ANSWERS),
    options.option("--signal", metavar="NAME", group=_ANSWERS,
                   help="Draw how this signal answers to the hand's velocity."),
    options.seed(group="Vibration", help="Seed of the noise that stands for vibration."),
)  # fmt: skip
def command(file: str, out: str, force: bool, outline: bool, model: str, **chosen: Any) -> None:
    """Rest is white and full swing is black."""
    from dataclasses import replace

    from vbraille.files import write_files
    from vbraille.pictures.keys import keyed
    from vbraille.pictures.loading import load_scene
    from vbraille.pictures.maps import MapRequest, draw_map, kind_of
    from vbraille.render import MODELS

    path = Path(out)
    request = MapRequest(
        kind_of(path), MODELS[model], chosen["resolution"], chosen["seed"], chosen["frames"],
        chosen["velocity"], chosen["switch"] or {}, chosen["array"] or (), chosen["rulers"],
        outline, chosen["signal"] or "",
    )  # fmt: skip
    style = request.model.style
    # Dots of braille have no texture on paper, for which it is too fine.
    style = style.replace(texture=0.0) if outline else style
    loaded = load_scene(file, style)
    key = None
    if chosen["key"]:
        loaded, key = keyed(loaded, style)
    for note in loaded.notes:
        say(note, aside=True)
    files, said = draw_map(loaded, request, path)
    if key is not None:
        page, words = draw_map(key, replace(request, signal=""), path.with_stem(f"{path.stem}-key"))
        files, said = [*files, *page], [*said, *words]
    write_files(files, replace=force)
    for line in said:
        say(line)
