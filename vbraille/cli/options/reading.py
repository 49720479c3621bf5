"""The options of reading, drawing and devices, each with a sentence that stands alone."""

from __future__ import annotations

from vbraille.cli.options import groups, pictures
from vbraille.cli.options.groups import MODELS, SPEC, duration, number, whole
from vbraille.cli.options.live import add_live_options

TYPE_CHECKING = False  # as in vbraille.cli
if TYPE_CHECKING:
    from vbraille.cli.options.commandparser import CommandParser

PLOTS = ("profile", "mapping", "wave", "strain", "page", "resolution")


_OWN_RATE = "1000, or what the device takes if that is less"


def nothing(_parser: CommandParser) -> None:
    """Add no option."""


def read(parser: CommandParser) -> None:
    """Add the options of ``vbraille read``."""
    groups.text(parser, optional=True)
    parser.option(
        "--book",
        "N",
        "Read on in the book with this number in the list of vbraille books (default: FILE, or "
        "the book that was read last).",
        whole,
    )
    _reading(parser)
    parser.flag(
        "--no-places",
        "Begin at the beginning, and keep neither the place nor anything else of the book.",
    )
    add_live_options(parser)


def settings(parser: CommandParser) -> None:
    """Add the options of ``vbraille settings``, which are those of reading."""
    groups.text(parser, file=False)
    _reading(parser)
    parser.flag("--path", "Print where the settings file is, and nothing else.")


def tune(parser: CommandParser) -> None:
    """Add the options of ``vbraille tune``."""
    parser.add_argument(
        "file", nargs="?", metavar="TEXT", help="Practise on this text (default: a short one)."
    )
    groups.profile(parser)
    groups.device(parser)
    parser.choice("--model", MODELS, "Refuse a device that is not this display.")
    groups.translation(parser)
    groups.hand(parser, _OWN_RATE)
    parser.flag("--again", "Begin anew, and forget the choices made so far.")
    parser.set_defaults(hand=None, seed=None, rate=None, monitor=False)
    groups.leave_to_settings(parser)


def _reading(parser: CommandParser) -> None:
    """Add the options of reading that are not the text's."""
    groups.show(parser)
    groups.profile(parser)
    groups.device(parser)
    parser.choice(
        "--advance",
        ("return", "key"),
        "Say when the next line comes: when the hand returns to the left, or only by a key.",
        default="return",
    )
    parser.choice(
        "--echo",
        ("none", "text", "cells", "both"),
        "Say what is printed of each line: nothing, its text, its cells in Unicode braille, or "
        "both (default: none at a terminal, otherwise both).",
    )
    groups.heard(parser)
    parser.option(
        "--also",
        "DISPLAY",
        "Show each line on a conventional display beside, and obey its keys: brlapi for the one "
        "that BRLTTY drives, brlapi:HOST:N for BRLTTY at another address (default: none).",
    )
    groups.keys(parser)
    parser.option(
        "--cells",
        "N",
        "Lay out lines of so many cells; the hand goes along a longer one part by part (default: "
        "as many as the hand can cross).",
        whole,
    )
    groups.page(parser)
    groups.hand(parser, _OWN_RATE)
    # The model is the device's own, and only a simulated one has a hand.
    parser.set_defaults(model=None, hand=None, seed=None, rate=None)
    groups.leave_to_settings(parser)


def books(parser: CommandParser) -> None:
    """Add the options of ``vbraille books``."""
    parser.add_argument(
        "number",
        nargs="?",
        type=whole,
        metavar="N",
        help="Read on in the book with this number in the list, as vbraille read --book N does "
        "(default: list the books).",
    )
    parser.option(
        "--forget",
        "N",
        "Delete all that is kept of the book with this number in the list; the book's file stays "
        "(default: nothing is deleted).",
        whole,
    )
    parser.flag("--json", "Print the list as JSON, for another program.")


def keys(parser: CommandParser) -> None:
    """Add the options of ``vbraille keys``."""
    parser.flag("--json", "Print the commands as JSON, for other programs.")
    groups.keys(parser)
    parser.set_defaults(keys=None)
    groups.settings_file(parser)


def page(parser: CommandParser) -> None:
    """Add the options of ``vbraille page``."""
    groups.text(parser)
    groups.layout(parser)
    parser.choice(
        "--format",
        ("unicode", "brf", "dots", "text", "pef"),
        "Write Unicode braille, ASCII braille (BRF), dot numbers, the text of each line, or PEF.",
        default="unicode",
    )
    parser.option("--out", "FILE", "Write to this file, whole or not at all (default: print).")
    groups.force(parser)
    parser.option(
        "--cells",
        "N",
        "Lay out for lines of so many cells, whatever the display (default: the display's, or 40 "
        "in PEF).",
        whole,
    )
    parser.set_defaults(model=None)  # so that it is known whether a display was asked for


def structure(parser: CommandParser) -> None:
    """Add the options of ``vbraille structure``."""
    groups.source(parser)
    parser.flag("--json", "Print the same as JSON.")
    parser.set_defaults(table=None, language=None, grade=None, undefined="mark", keep_lines=False)
    parser.set_defaults(foreign="switch")
    parser.set_defaults(settled=frozenset())


def render(parser: CommandParser) -> None:
    """Add the options of ``vbraille render``."""
    groups.text(parser)
    groups.show(parser)
    groups.hand(parser)
    parser.option("--out", "FILE.h5", "Write to this file.", required=True)
    groups.page(parser)
    groups.force(parser)
    pictures.path(parser)
    parser.set_defaults(model=None)  # which is another one for lines than for pictures
    parser.flag("--plain", "Print progress as lines, without a bar.")


def plot(parser: CommandParser) -> None:
    """Add the options of ``vbraille plot``."""
    parser.add_argument(
        "kind",
        choices=PLOTS,
        metavar="KIND",
        help="Choose the picture: profile (how far an actuator leans along a dot), mapping (which "
        "row of actuators shows which row of dots), wave (the actuators as the array passes a "
        "dot), strain (between neighbouring actuators), page (lines with the array on one) or "
        "resolution (how finely the arms of the Tactograph measure, over its tray).",
    )
    groups.text(parser, optional=True)
    groups.show(parser)
    parser.option(
        "--out", "F.png|F.svg", "Write the picture to this file (default: a new vbraille-KIND.png)."
    )
    parser.flag("--csv", "Print the picture's numbers as CSV, and draw nothing.")
    parser.option(
        "--at",
        "MM",
        "Of a page: put the array's left column at this place, in mm.",
        number,
        default=20.0,
    )
    parser.add_argument("--letter", help="Of a mapping: show this letter (default: z).")
    parser.set_defaults(model=None)  # the one that the source drew the figure for


def simulate(parser: CommandParser) -> None:
    """Add the options of ``vbraille simulate``."""
    parser.add_argument(
        "what",
        nargs="?",
        choices=("serial", "latero"),
        default="serial",
        help="Be a device at a serial port, or a Latero on the network (default: serial).",
    )
    parser.choice(
        "--model",
        MODELS,
        "Be this display: the STReSS² of 10 × 6 or of 8 × 8 actuators, that on the Pantograph, "
        "the Latero, or the VBD.",
        default="stress2",
    )
    groups.hand(parser)
    parser.set_defaults(rate=1000)
    parser.option(
        "--link", "PATH", "Make a link to the port at this path, and remove it at the end."
    )
    parser.choice(
        "--encoder",
        ("absolute", "index", "incremental"),
        "Choose what the encoder knows of the carriage's place when it starts: the place, "
        "nothing before it has passed its mark, or nothing before somebody says where the left "
        "stop is.",
        default="absolute",
    )
    parser.option("--travel", "MM", "Let the carriage go so far (default: 300 mm).", number)
    parser.choice(
        "--axes",
        ("x", "xy", "xyθ"),
        "Measure the carriage along the line only, or across the lines as well, or the angle of "
        "the array as well; the hand then reads a page.",
        default="x",
    )
    parser.option(
        "--height",
        "MM",
        "Let a carriage of two axes go so far across the lines (default: as the display's own "
        "does, or 200 mm).",
        number,
    )
    parser.option(
        "--script",
        "FILE",
        "Move buttons and knobs as this file says, with a time after the first greeting and an "
        "event in each line: 2.5s press 1, 3s release 1, 4s knob 1 0.8 (default: nothing).",
    )
    parser.option(
        "--press",
        "N@TIME,…",
        "Press button N, 1 to 8, so long after the first greeting, as in 1@2.5s,2@4s, or hold it "
        "for a while, as in 1@2.5s-4s (default: no button).",
        default="",
    )
    for name, text in (
        ("drop", "Lose this share of the messages, both ways"),
        ("corrupt", "Damage this share of the messages, both ways"),
    ):
        parser.option(f"--{name}", "0…1", f"{text} (default: 0).", number, default=0.0)
    parser.option(
        "--stall",
        "DURATION",
        "Do nothing for so long every second, such as 200ms (default: never).",
        duration,
        default=0.0,
    )
    parser.option(
        "--unplug-every",
        "DURATION",
        "Be unplugged so long after each greeting, such as 5s; this needs --link (default: never).",
        duration,
        default=0.0,
    )
    parser.choice(
        "--defect",
        (
            "no-acknowledgement",
            "no-actuators",
            "off-place",
            "slow-clock",
            "no-watchdog",
            "late-watchdog",
        ),
        "Be built wrong in this way, which vbraille device check finds (default: none).",
    )

    simulate_latero(parser)


def simulate_latero(parser: CommandParser) -> None:
    """Add the options that only a simulated Latero has."""
    latero = parser.add_argument_group("a Latero's own options")
    latero.add_argument(
        "--port",
        type=whole,
        metavar="N",
        help="Listen at this UDP port, 0 for any that is free (default: 8900).",
    )
    latero.add_argument(
        "--lines",
        type=whole,
        metavar="N",
        help="Have the hand read so many lines of a page, 10 mm apart (default: 1).",
    )
    latero.add_argument(
        "--wait",
        type=duration,
        metavar="DURATION",
        help="Have the hand wait so long at the lower left when a program comes, such as 5s "
        "(default: 1s).",
    )
    for name, text in (
        ("late", "Send this share of the answers 20 ms late"),
        ("double", "Have this share of the datagrams come twice, both ways"),
        ("foreign", "Send somebody else's datagram along with this share of the answers"),
    ):
        latero.add_argument(f"--{name}", type=number, metavar="0…1", help=f"{text} (default: 0).")


def device_info(parser: CommandParser) -> None:
    """Add the options of ``vbraille device info`` and ``check``."""
    parser.add_argument("spec", metavar="SPEC", help=f"{SPEC}.")
    parser.choice("--model", MODELS, "Refuse a device that is not this display.")


def device_calibrate(parser: CommandParser) -> None:
    """Add the options of ``vbraille device calibrate``."""
    device_info(parser)
    chosen = parser.add_mutually_exclusive_group()
    chosen.add_argument(
        "--show", action="store_true", help="Print what is kept of the device's actuators only."
    )
    chosen.add_argument(
        "--forget", action="store_true", help="Remove what is kept of the device's actuators."
    )


def tables(parser: CommandParser) -> None:
    """Add the options of ``vbraille tables``."""
    parser.option("--language", "TAG", "List only tables of this language, such as fr or fr-CA.")
