"""The options of the commands for tactile pictures, and of paths over them."""

from __future__ import annotations

import argparse

from vbraille.config.options import HAND, HEARD, LIVE, OPTIONS, number, seed, whole

TYPE_CHECKING = False  # as in vbraille.cli
if TYPE_CHECKING:
    from vbraille.cli.options.commandparser import CommandParser

# Options of a path over a picture, beside its name.
PATH_OPTIONS = ("at", "radius", "seconds", "spacing", "speed", "sway", "unsteady", "back")


def add_model(parser: CommandParser, text: str, default: str | None = None) -> None:
    """Add the display, with a sentence on what a command does with it."""
    added = parser.add_argument("--model", help=text, default=default)
    added.choices = OPTIONS["model"].choices


def feel(parser: CommandParser) -> None:
    """Add the options of ``vbraille feel``."""
    parser.add_argument(
        "file", metavar="FILE", help="Feel this scene, SVG or file of OpenLatero's."
    )
    parser.take("device")
    add_model(
        parser,
        "Simulate this display, or refuse a device that is another one (default: the STReSS² of "
        "8 × 8 on the Tactograph).",
    )
    parser.take(*HAND)
    parser.set_defaults(hand=None, seed=None)
    parser.option(
        "--at",
        "MM",
        "On a device of one axis: feel the picture at this height, from its top (default: its "
        "middle).",
        number,
    )
    parser.flag("--say-entering", "Say the name of each element when the finger comes to it.")
    parser.take(*HEARD, *LIVE)


def path(parser: CommandParser) -> None:
    """Add the options of a path over a picture."""
    parser.option(
        "--path",
        "PATH",
        "Go over a picture by this path: wide goes round its canvas and then inward, spot swings "
        "about a place, recorded:FILE.csv moves as recorded (default: wide).",
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
        parser.option(f"--{name}", metavar, f"{text}.", str if name == "at" else number)


def profile(parser: CommandParser) -> None:
    """Add the options of ``vbraille profile``."""
    parser.add_argument(
        "file", metavar="FILE", help="Time the frames of this scene, SVG or file of OpenLatero's."
    )
    add_model(parser, "Render for this display (default: stress2-8x8).", "stress2-8x8")
    path(parser)
    parser.flag(
        "--elements", "Say, too, how much longer a frame takes with each element than without it."
    )
    parser.option(
        "--out",
        "FILE.csv",
        "Write each place with its cost, and what kinds of patterns have in that, to a CSV file "
        "(default: none).",
    )
    parser.option("--map", "FILE.png", "Draw the map of the cost as PNG or SVG (default: none).")
    parser.take("force")


def check(parser: CommandParser) -> None:
    """Add the options of ``vbraille scene check``."""
    parser.add_argument(
        "file", metavar="FILE", help="Check this scene, SVG or file of OpenLatero's."
    )
    parser.flag("--json", "Print the report as JSON.")


def convert(parser: CommandParser) -> None:
    """Add the options of ``vbraille scene convert``."""
    parser.add_argument(
        "file", metavar="OLD", help="File of OpenLatero's (.gen, .tx) or drawing in SVG."
    )
    parser.option("--out", "NEW", "Write to this scene file.", required=True)
    parser.flag(
        "--as-shown",
        "Convert what OpenLatero shows, where that is not what its file says (default: what the "
        "file says).",
    )
    parser.take("force")


def scene_map(parser: CommandParser) -> None:
    """Add the options of ``vbraille map``."""
    parser.add_argument(
        "file",
        metavar="SCENE",
        help="Draw this tactile picture: a scene file, a drawing in SVG, or a file of OpenLatero.",
    )
    parser.option(
        "--out",
        "F.png|F.svg|F.csv|F.pdf|F.gif",
        "Write the picture to this file, whole or not at all; its suffix says the form. CSV has "
        "a row for each pixel with x, y and the deflection there.",
        required=True,
    )
    parser.take("force")
    parser.option(
        "--resolution", "N", "Draw so many pixels a mm (default: 4; abstract drawings 12).", number
    )
    parser.choice(
        "--vibration",
        ("noise", "sequence"),
        "Show what vibrates as noise of the same range, or as a sequence of maps at times of one "
        "swing: an animation in F.gif, and numbered files otherwise, such as F-001.png to "
        "F-008.png.",
        default="noise",
    )
    parser.option(
        "--frames",
        "N",
        "Give a sequence so many maps, evenly over the slowest swing (default: 8).",
        whole,
    )
    parser.choice(
        "--parity",
        (0, 1),
        "Show a sequence as these actuators swing: 0 those whose row and column are both even or "
        "both odd, 1 the others (default: 0).",
        kind=int,
    )
    parser.option("--seed", "N", "Seed the noise.", seed, default=0)
    parser.option(
        "--array",
        "X,Y[,θ]",
        "Draw the array over the picture with its centre at this place, in mm, turned by θ "
        "degrees against the clock: a bar for each contactor, shifted by its deflection "
        "(default: no array).",
        place,
    )
    add_model(
        parser,
        "Draw the array of this display, in whose style labels are written as well (default: "
        "stress2-8x8).",
        "stress2-8x8",
    )
    parser.flag("--axes", "Draw axes in mm around the picture.")
    parser.flag(
        "--outline",
        "Draw what is felt in black on white instead, true to scale, for eyes and for swell "
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
