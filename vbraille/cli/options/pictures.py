"""The options of the commands for tactile pictures, and of paths over them."""

from __future__ import annotations

import argparse

from vbraille.cli.options import groups
from vbraille.cli.options.groups import MODELS, number, seed, whole
from vbraille.cli.options.live import add_live_options

TYPE_CHECKING = False  # as in vbraille.cli
if TYPE_CHECKING:
    from argparse import ArgumentParser

# Options of a path over a picture, beside its name.
PATH_OPTIONS = ("at", "radius", "seconds", "spacing", "speed", "sway", "unsteady", "back")


def feel(parser: ArgumentParser) -> None:
    """Add the options of ``vbraille feel``."""
    parser.add_argument(
        "file", metavar="FILE", help="Feel this scene, SVG or file of OpenLatero's."
    )
    groups.device(parser)
    parser.add_argument(
        "--model",
        choices=MODELS,
        help="Simulate this display, or refuse a device that is another one (default: the STReSS² "
        "of 8 × 8 on the Tactograph).",
    )
    groups.hand(parser)
    parser.set_defaults(hand=None, seed=None)
    parser.add_argument(
        "--at",
        type=number,
        metavar="MM",
        help="On a device of one axis: feel the picture at this height, from its top (default: "
        "its middle).",
    )
    parser.add_argument(
        "--say-entering",
        action="store_true",
        help="Say the name of each element when the finger comes to it.",
    )
    groups.heard(parser)
    add_live_options(parser)


def path(parser: ArgumentParser) -> None:
    """Add the options of a path over a picture."""
    parser.add_argument(
        "--path",
        default=None,
        metavar="PATH",
        help="Go over a picture by this path: wide goes round its canvas and then inward, spot "
        "swings about a place, recorded:FILE.csv moves as recorded (default: wide).",
    )
    for name, metavar, text in (
        ("at", "X,Y", "Swing about this place, in mm (default: the middle)"),
        ("radius", "MM", "Swing so far from the place (default: 5)"),
        ("seconds", "S", "Swing for so long (default: 10)"),
        ("spacing", "MM", "Leave so much between turns of the wide path (default: 10)"),
        ("speed", "MM_S", "Go so fast, in mm/s (default: 60)"),
        ("sway", "MM", "Have the wide path sway so far to either side (default: 0)"),
        ("unsteady", "0…0.9", "Have the speed of the wide path change by this share (default: 0)"),
        ("back", "MM", "Have the wide path go back so far, every 50 mm (default: 0)"),
    ):
        parser.add_argument(
            f"--{name}",
            type=str if name == "at" else number,
            metavar=metavar,
            help=f"{text}.",
        )


def profile(parser: ArgumentParser) -> None:
    """Add the options of ``vbraille profile``."""
    parser.add_argument(
        "file", metavar="FILE", help="Time the frames of this scene, SVG or file of OpenLatero's."
    )
    parser.add_argument(
        "--model",
        choices=MODELS,
        default="stress2-8x8",
        help="Render for this display (default: stress2-8x8).",
    )
    path(parser)
    parser.add_argument(
        "--elements",
        action="store_true",
        help="Say, too, how much longer a frame takes with each element than without it.",
    )
    parser.add_argument(
        "--out",
        metavar="FILE.csv",
        help="Write each place with its cost, and what kinds of patterns have in that, to a CSV "
        "file (default: none).",
    )
    parser.add_argument(
        "--map",
        metavar="FILE.png",
        help="Draw the map of the cost as PNG or SVG (default: none).",
    )
    groups.force(parser)


def check(parser: ArgumentParser) -> None:
    """Add the options of ``vbraille scene check``."""
    parser.add_argument(
        "file", metavar="FILE", help="Check this scene, SVG or file of OpenLatero's."
    )
    parser.add_argument("--json", action="store_true", help="Print the report as JSON.")


def convert(parser: ArgumentParser) -> None:
    """Add the options of ``vbraille scene convert``."""
    parser.add_argument(
        "file", metavar="OLD", help="File of OpenLatero's (.gen, .tx) or drawing in SVG."
    )
    parser.add_argument("--out", required=True, metavar="NEW", help="Write to this scene file.")
    parser.add_argument(
        "--as-shown",
        action="store_true",
        help="Convert what OpenLatero shows, where that is not what its file says "
        "(default: what the file says).",
    )
    groups.force(parser)


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
    groups.force(parser)
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
