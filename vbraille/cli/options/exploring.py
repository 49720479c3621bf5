"""Options of reading, of tactile pictures, of devices and of the live view."""

from __future__ import annotations

import argparse
import re

from vbraille.config.options import (
    ADDRESS,
    HAND,
    HEARD,
    LAYOUT,
    LIVE,
    OPTIONS,
    PAGE,
    READING,
    SHOW,
    SOURCE,
    SPEC,
    TEXT,
    TRANSLATION,
    number,
    seed,
    whole,
)
from vbraille.errors import InputError
from vbraille.wording import setting

TYPE_CHECKING = False  # as in vbraille.cli
if TYPE_CHECKING:
    from vbraille.cli.parser import CommandParser

PLOTS = ("profile", "mapping", "wave", "strain", "page", "resolution")


def nothing(_parser: CommandParser) -> None:
    """Add no option."""


def read(parser: CommandParser) -> None:
    """Add the options of ``vbraille read``."""
    _file(parser, optional=True)
    parser.take(*TEXT, "book")
    _reading(parser)
    parser.take("no_places", *LIVE)


def settings(parser: CommandParser) -> None:
    """Add the options of ``vbraille settings``, which are those of reading."""
    parser.take(*TEXT)
    _reading(parser)
    parser.flag("--where", "Print where the settings file is, and nothing else.")


def tune(parser: CommandParser) -> None:
    """Add the options of ``vbraille tune``."""
    parser.add_argument(
        "file", nargs="?", metavar="TEXT", help="Practise on this text (default: a short one)."
    )
    parser.take("profile", "device")
    add_model(parser, "Refuse a device that is not this display.")
    parser.take(*TRANSLATION)
    parser.take(*HAND, unset=True)
    parser.flag("--again", "Begin anew, and forget the choices made so far.")
    parser.set_defaults(monitor=False)
    parser.leave_to_settings()


def _reading(parser: CommandParser) -> None:
    """Add the options of reading that are not the text's."""
    parser.take(*READING, unset=True)  # only a simulated device has a hand
    parser.leave_to_settings()


def _file(parser: CommandParser, *, optional: bool = False) -> None:
    """Add the text that is read, and how it is read."""
    parser.add_argument(
        "file",
        metavar="FILE",
        nargs="?" if optional else None,
        help="Take this text file, or standard input for -.",
    )
    parser.take(*SOURCE)


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
    parser.take("keys", "settings", unset=True)


def page(parser: CommandParser) -> None:
    """Add the options of ``vbraille page``."""
    _file(parser)
    parser.take(*TEXT, *LAYOUT)
    parser.choice(
        "--format",
        ("unicode", "brf", "dots", "text", "pef"),
        "Write Unicode braille, ASCII braille (BRF), dot numbers, the text of each line, or PEF.",
        default="unicode",
    )
    parser.option("--out", "FILE", "Write to this file, whole or not at all (default: print).")
    parser.take("force")
    parser.option(
        "--cells",
        "N",
        "Lay out for lines of so many cells, whatever the display (default: the display's, or 40 "
        "in PEF).",
        whole,
    )


def structure(parser: CommandParser) -> None:
    """Add the options of ``vbraille structure``."""
    _file(parser)
    parser.flag("--json", "Print the same as JSON.")
    parser.set_defaults(**{name: OPTIONS[name].default for name in TEXT}, settled=frozenset())


def render(parser: CommandParser) -> None:
    """Add the options of ``vbraille render``."""
    _file(parser)
    parser.take(*TEXT, *SHOW, *HAND)
    parser.option("--out", "FILE.h5", "Write to this file.", required=True)
    parser.take(*PAGE, "force")
    path(parser)


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
    _file(parser, optional=True)
    parser.take(*TEXT, *SHOW)
    parser.option(
        "--out", "F.png|F.svg", "Write the picture to this file (default: a new vbraille-KIND.png)."
    )
    parser.flag("--csv", "Print the picture's numbers as CSV, and draw nothing.")
    parser.option(
        "--x",
        "MM",
        "Of a page: put the array's left column at this place, in mm.",
        number,
        default=20.0,
    )
    parser.add_argument("--letter", help="Of a mapping: show this letter (default: z).")


def simulate(parser: CommandParser) -> None:
    """Add the options of ``vbraille simulate``."""
    parser.add_argument(
        "what",
        nargs="?",
        choices=("serial", "latero"),
        default="serial",
        help="Be a device at a serial port, or a Latero on the network (default: serial).",
    )
    add_model(
        parser,
        "Be this display: the STReSS² of 10 × 6 or of 8 × 8 actuators, that on the Pantograph, "
        "the Latero, or the VBD (default: stress2).",
        "stress2",
    )
    parser.take(*HAND)
    parser.option(
        "--link", "PATH", "Make a link to the port at this path, and remove it at the end."
    )
    parser.choice(
        "--encoder",
        ("absolute", "index", "incremental"),
        "Choose what the encoder knows of the carriage's place when it starts: the place, "
        "nothing before it has passed its mark, or nothing before it is told where the left "
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
        ("foreign", "Send a stranger's datagram along with this share of the answers"),
    ):
        latero.add_argument(f"--{name}", type=number, metavar="0…1", help=f"{text} (default: 0).")


def device_info(parser: CommandParser) -> None:
    """Add the options of ``vbraille device info`` and ``check``."""
    parser.add_argument("spec", metavar="SPEC", help=f"{SPEC}.")
    add_model(parser, "Refuse a device that is not this display.")


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
    parser.flag("--json", "Print the same as JSON.")


def device_list(parser: CommandParser) -> None:
    """Add the options of ``vbraille device list``."""
    parser.flag("--json", "Print the same as JSON.")


def monitor(parser: CommandParser) -> None:
    """Add the options of ``vbraille monitor``."""
    parser.add_argument(
        "file",
        nargs="?",
        metavar="FILE",
        help="Play back what vbraille render wrote, the folder of a session, or one of its traces.",
    )
    parser.take(*ADDRESS)


def check_live_options(arguments: argparse.Namespace) -> None:
    """Refuse options of the live view that cannot be.

    Raises
    ------
    InputError
        If there is an address without a live view, or an empty one.
    """
    for name in ADDRESS:
        if getattr(arguments, name) is not None and not getattr(arguments, "monitor", True):
            raise InputError(
                f"{setting(name)} is for the live view; add {setting('monitor')}, or leave "
                f"{setting(name)} out"
            )
    if arguments.host == "":
        raise InputError(
            f"{setting('host')} is empty; give an address of this machine, or leave it out"
        )


def duration(text: str) -> float:
    """Read the seconds of a duration such as 200ms or 5s."""
    found = re.fullmatch(r"([0-9]{1,9}(?:\.[0-9]{1,9})?)(ms|s)", text)
    seconds = float(found[1]) / (1000 if found[2] == "ms" else 1) if found else 0.0
    if not 0.001 <= seconds <= 3600:
        raise argparse.ArgumentTypeError(
            f"{text!r} is no duration from 1ms to 3600s, such as 200ms or 5s"
        )
    return seconds


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
        "--y",
        "MM",
        "On a device of one axis: feel the picture at this height, from its top "
        "(default: where it is felt, near its middle).",
        number,
    )
    parser.option(
        "--zoom",
        "N",
        "Begin with the picture so many times as near, 0.5 to 16 (default: 1).",
        number,
    )
    parser.flag("--say-entering", "Say the name of each element when the finger comes to it.")
    parser.take(*HEARD, *LIVE)


def play(parser: CommandParser) -> None:
    """Add the options of ``vbraille play``."""
    parser.option(
        "--deck",
        "FOLDER",
        "Play with the scenes of this folder, two cards of each (default: twelve that come with "
        "the program).",
    )
    parser.choice("--players", (1, 2), "Deal for so many players.", default=1, kind=int)
    parser.take("device")
    add_model(
        parser,
        "Simulate this display, or refuse a device that is another one (default: the STReSS² of "
        "8 × 8 on the Tactograph).",
    )
    parser.take("hand", "rate")
    parser.option(
        "--seed",
        "N",
        "Shuffle the cards, and move a simulated hand, by this seed (default: another one each "
        "time, which is said).",
        seed,
    )
    parser.take(*HEARD, "also")
    parser.set_defaults(hand=None, monitor=False, pointer=None, begun=None, host=None, port=None)


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
        "--velocity",
        "X,Y",
        "Draw what is felt by a hand that goes on so, right and down in mm/s, where signals of the "
        "picture depend on that (default: a hand that stands still).",
        velocity,
    )
    parser.option(
        "--switch",
        "K=N[,…]",
        "Draw the picture with the switch of key K in its state N, from 1, such as 1=2 "
        "(default: each in its first).",
        switch_states,
    )
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


_MOST_MM_S = 1000


def velocity(text: str) -> tuple[float, ...]:
    """Read a velocity X,Y in mm/s."""
    try:
        values = tuple(float(part) for part in text.split(","))
    except ValueError:
        values = ()
    if len(values) != 2 or not all(abs(value) <= _MOST_MM_S for value in values):
        raise argparse.ArgumentTypeError(
            f"{text!r} is no velocity; give X,Y in mm/s, each from -{_MOST_MM_S} to {_MOST_MM_S}"
        )
    return values


def switch_states(text: str) -> dict[int, int]:
    """Read states of switches K=N,…, from 1, as states from 0 by their keys."""
    found = re.fullmatch(r"[1-8]=[1-8](?:,[1-8]=[1-8])*", text)
    if found is None:
        raise argparse.ArgumentTypeError(
            f"{text!r} is no state of a switch; give K=N with a key and a state from 1, such as 1=2"
        )
    pairs = (one.split("=") for one in text.split(","))
    return {int(key): int(state) - 1 for key, state in pairs}


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
