"""The options of the commands for tactile pictures that are felt."""

from __future__ import annotations

from vbraille.cli.options import groups
from vbraille.cli.options.groups import MODELS, SPEC
from vbraille.cli.options.live import add_live_options
from vbraille.cli.options.values import number

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
    parser.add_argument("--device", default="sim", metavar="SPEC", help=f"{SPEC} (default: sim).")
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
    parser.add_argument(
        "--speech",
        action="store_true",
        help="Speak all that is said, through Speech Dispatcher.",
    )
    parser.add_argument(
        "--cues",
        choices=("sound", "bell", "none"),
        help="Signal a limit and what is not found: by tones, by the terminal's bell, or not "
        "(default: tones at a terminal, the bell through SSH, otherwise none).",
    )
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
    parser.add_argument(
        "--force", action="store_true", help="Replace files that are there already."
    )
