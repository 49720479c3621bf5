"""The options of pictures of scenes, each with a sentence that stands alone."""

from __future__ import annotations

import argparse

from vbraille.cli.options.groups import MODELS
from vbraille.cli.options.values import number, seed, whole

TYPE_CHECKING = False  # as in vbraille.cli
if TYPE_CHECKING:
    from argparse import ArgumentParser


def scene_map(parser: ArgumentParser) -> None:
    """Add the options of ``vbraille map``."""
    parser.add_argument(
        "file",
        metavar="SCENE",
        help="Draw this tactile picture: a scene file, a drawing in SVG, or a file of OpenLatero.",
    )
    parser.add_argument(
        "--out",
        required=True,
        metavar="F.png|F.svg|F.csv|F.pdf|F.gif",
        help="Write the picture to this file, whole or not at all; its suffix says the form. CSV "
        "has a row for each pixel with x, y and the deflection there.",
    )
    parser.add_argument(
        "--force", action="store_true", help="Replace a file that is there already."
    )
    parser.add_argument(
        "--resolution",
        type=number,
        metavar="N",
        help="Draw so many pixels a mm (default: 4; abstract drawings 12).",
    )
    parser.add_argument(
        "--vibration",
        choices=("noise", "sequence"),
        default="noise",
        help="Show what vibrates as noise of the same range, or as a sequence of maps at times of "
        "one swing: an animation in F.gif, and numbered files otherwise, such as F-001.png to "
        "F-008.png (default: noise).",
    )
    parser.add_argument(
        "--frames",
        type=whole,
        metavar="N",
        help="Give a sequence so many maps, evenly over the slowest swing (default: 8).",
    )
    parser.add_argument(
        "--parity",
        type=int,
        choices=(0, 1),
        help="Show a sequence as these actuators swing: 0 those whose row and column are both even "
        "or both odd, 1 the others (default: 0).",
    )
    parser.add_argument(
        "--seed", type=seed, default=0, metavar="N", help="Seed the noise (default: 0)."
    )
    parser.add_argument(
        "--array",
        type=place,
        metavar="X,Y[,θ]",
        help="Draw the array over the picture with its centre at this place, in mm, turned by θ "
        "degrees against the clock: a bar for each contactor, shifted by its deflection (default: "
        "no array).",
    )
    parser.add_argument(
        "--model",
        choices=MODELS,
        default="stress2-8x8",
        help="Draw the array of this display, in whose style labels are written as well (default: "
        "stress2-8x8).",
    )
    parser.add_argument("--axes", action="store_true", help="Draw axes in mm around the picture.")
    parser.add_argument(
        "--outline",
        action="store_true",
        help="Draw what is felt in black on white instead, true to scale, for eyes and for swell "
        "paper (default: a deflection map).",
    )


def place(text: str) -> tuple[float, ...]:
    """Read a place X,Y, or a place and an angle X,Y,θ."""
    try:
        values = tuple(float(part) for part in text.split(","))
    except ValueError:
        values = ()
    if len(values) not in (2, 3):
        raise argparse.ArgumentTypeError(
            f"{text!r} is no place; give X,Y in mm, or X,Y,θ with an angle in degrees"
        )
    return values
