"""The options of reading, drawing and devices, each with a sentence that stands alone."""

from __future__ import annotations

from vbraille.cli.options.live import add_live_options
from vbraille.cli.options.values import duration, lines, number, seed, whole

TYPE_CHECKING = False  # as in vbraille.cli
if TYPE_CHECKING:
    from argparse import ArgumentParser

MAPPINGS = ("alternate", "paired", "sheared", "split-columns", "row-sheared", "compact")
MODELS = ("stress2", "vbd")
PLOTS = ("profile", "mapping", "wave", "strain", "page")

# Options of reading that a settings file may say.
SETTLED = (
    "device",
    "language",
    "grade",
    "table",
    "encoding",
    "undefined",
    "keep_lines",
    "advance",
    "echo",
    "speech",
    "cues",
    "verbose",
)

HANDS = (
    "sweep:SPEED goes along each line at so many mm/s, slow reads as people do on such displays "
    "(device is its older name), fluent as on paper, recorded:FILE.csv moves as recorded, "
    "wander:SPEED goes about without reading, and still moves only in the live view of --monitor"
)
SPEC = "Name the device, such as serial:/dev/ttyACM0, or sim for a simulated one"


def nothing(_parser: ArgumentParser) -> None:
    """Add no option."""


def read(parser: ArgumentParser) -> None:
    """Add the options of ``vbraille read``."""
    _text(parser, optional=True)
    _reading(parser)
    parser.add_argument(
        "--no-places",
        action="store_true",
        help="Begin at the beginning, and keep neither the place nor anything else of the book.",
    )
    add_live_options(parser)


def settings(parser: ArgumentParser) -> None:
    """Add the options of ``vbraille settings``, which are those of reading."""
    _text(parser, file=False)
    _reading(parser)
    parser.add_argument(
        "--path", action="store_true", help="Print where the settings file is, and nothing else."
    )


def tune(parser: ArgumentParser) -> None:
    """Add the options of ``vbraille tune``."""
    parser.add_argument(
        "file", nargs="?", metavar="TEXT", help="Practise on this text (default: a short one)."
    )
    _profile(parser)
    parser.add_argument("--device", default="sim", metavar="SPEC", help=f"{SPEC} (default: sim).")
    parser.add_argument("--model", choices=MODELS, help="Refuse a device that is not this display.")
    _translation(parser)
    _hand(parser)
    parser.add_argument(
        "--again", action="store_true", help="Begin anew, and forget the choices made so far."
    )
    parser.set_defaults(hand=None, seed=None)
    _leave_to_settings(parser)


def _reading(parser: ArgumentParser) -> None:
    """Add the options of reading that are not the text's."""
    _show(parser)
    _profile(parser)
    parser.add_argument("--device", default="sim", metavar="SPEC", help=f"{SPEC} (default: sim).")
    parser.add_argument(
        "--advance",
        choices=("return", "key"),
        default="return",
        help="Say when the next line comes: when the hand returns to the left, or only by a key "
        "(default: return).",
    )
    parser.add_argument(
        "--echo",
        choices=("none", "text", "cells", "both"),
        help="Say what is printed of each line: nothing, its text, its cells in Unicode braille, "
        "or both (default: none at a terminal, otherwise both).",
    )
    parser.add_argument(
        "--speech",
        action="store_true",
        help="Speak lines, settings and all else that is said, through Speech Dispatcher.",
    )
    parser.add_argument(
        "--cues",
        choices=("sound", "bell", "none"),
        help="Signal the end of a line or page, a limit, and what is not found: by tones, by the "
        "terminal's bell, or not (default: tones at a terminal, the bell through SSH, otherwise "
        "none).",
    )
    parser.add_argument(
        "--cells",
        type=whole,
        metavar="N",
        help="Lay out lines of so many cells; the hand goes along a longer one part by part "
        "(default: as many as the hand can cross).",
    )
    parser.add_argument(
        "--verbose", action="store_true", help="Say more, such as how far a search has come."
    )
    _hand(parser)
    # The model is the device's own, and only a simulated one has a hand.
    parser.set_defaults(model=None, hand=None, seed=None)
    _leave_to_settings(parser)


def books(parser: ArgumentParser) -> None:
    """Add the options of ``vbraille books``."""
    parser.add_argument(
        "--forget",
        type=whole,
        metavar="N",
        help="Delete all that is kept of the book with this number in the list; the book's file "
        "stays (default: nothing is deleted).",
    )
    parser.add_argument(
        "--json", action="store_true", help="Print the list as JSON, for another program."
    )


def keys(parser: ArgumentParser) -> None:
    """Add the options of ``vbraille keys``."""
    parser.add_argument(
        "--json", action="store_true", help="Print the commands as JSON, for other programs."
    )
    _settings(parser)


def page(parser: ArgumentParser) -> None:
    """Add the options of ``vbraille page``."""
    _text(parser)
    _layout(parser)
    parser.add_argument(
        "--format",
        choices=("unicode", "brf", "dots", "text", "pef", "ebrl"),
        default="unicode",
        help="Write Unicode braille, ASCII braille (BRF), dot numbers, the text of each line, PEF, "
        "or eBraille (default: unicode).",
    )
    parser.add_argument(
        "--out", metavar="FILE", help="Write to this file, whole or not at all (default: print)."
    )
    parser.add_argument(
        "--force", action="store_true", help="Replace the file if it is there already."
    )
    parser.add_argument(
        "--cells",
        type=whole,
        metavar="N",
        help="Lay out for lines of so many cells, whatever the display (default: the display's, "
        "or 40 on pages).",
    )
    parser.add_argument(
        "--layout",
        choices=("bana",),
        help="Make pages to be embossed by the literary layout of the Braille Authority of North "
        "America, with page numbers; --lines 25 then says how many lines a page has (default: "
        "lines without pages).",
    )
    parser.add_argument(
        "--workers",
        type=whole,
        metavar="N",
        help="Translate a long text in so many processes (default: one for each processor, at "
        "most 4; only one for --lines 1-10 and the like).",
    )
    parser.set_defaults(model=None)  # so that it is known whether a display was asked for


def structure(parser: ArgumentParser) -> None:
    """Add the options of ``vbraille structure``."""
    _source(parser)
    parser.add_argument("--json", action="store_true", help="Print the same as JSON.")
    parser.set_defaults(table=None, language=None, grade=None, undefined="mark", keep_lines=False)
    parser.set_defaults(settled=frozenset())


def render(parser: ArgumentParser) -> None:
    """Add the options of ``vbraille render``."""
    _text(parser)
    _show(parser)
    _hand(parser)
    parser.add_argument("--out", required=True, metavar="FILE.h5", help="Write to this file.")
    parser.add_argument(
        "--height",
        type=number,
        metavar="MM",
        help="Let the carriage go so far down the page, too: the hand reads pages of lines "
        "(default: it goes along a line only).",
    )
    parser.add_argument(
        "--force", action="store_true", help="Replace the file if it is there already."
    )
    parser.add_argument(
        "--plain", action="store_true", help="Print progress as lines, without a bar."
    )


def plot(parser: ArgumentParser) -> None:
    """Add the options of ``vbraille plot``."""
    parser.add_argument(
        "kind",
        choices=PLOTS,
        metavar="KIND",
        help="Choose the picture: profile (how far an actuator leans along a dot), mapping (which "
        "row of actuators shows which row of dots), wave (the actuators as the array passes a "
        "dot), strain (between neighbouring actuators) or page (lines with the array on one).",
    )
    _text(parser, optional=True)
    _show(parser)
    parser.add_argument(
        "--out",
        metavar="F.png|F.svg",
        help="Write the picture to this file (default: a new vbraille-KIND.png).",
    )
    parser.add_argument(
        "--csv", action="store_true", help="Print the picture's numbers as CSV, and draw nothing."
    )
    parser.add_argument(
        "--at",
        type=number,
        default=20.0,
        metavar="MM",
        help="Of a page: put the array's left column at this place, in mm (default: 20).",
    )
    parser.add_argument("--letter", help="Of a mapping: show this letter (default: z).")
    parser.set_defaults(model=None)  # the one that the source drew the figure for


def simulate(parser: ArgumentParser) -> None:
    """Add the options of ``vbraille simulate``."""
    parser.add_argument(
        "--model",
        choices=MODELS,
        default="stress2",
        help="Be this display: the STReSS² or the VBD (default: stress2).",
    )
    _hand(parser)
    parser.set_defaults(rate=1000)
    parser.add_argument(
        "--link",
        metavar="PATH",
        help="Make a link to the port at this path, and remove it at the end.",
    )
    parser.add_argument(
        "--encoder",
        choices=("absolute", "index", "incremental"),
        default="absolute",
        help="Choose what the encoder knows of the carriage's place when it starts: the place, "
        "nothing before it has passed its mark, or nothing before somebody says where the left "
        "stop is (default: absolute).",
    )
    parser.add_argument(
        "--travel", type=number, metavar="MM", help="Let the carriage go so far (default: 300 mm)."
    )
    parser.add_argument(
        "--press",
        default="",
        metavar="N@TIME,…",
        help="Press button N, 1 to 8, so long after the first greeting, as in 1@2.5s,2@4s, or hold "
        "it for a while, as in 1@2.5s-4s (default: no button).",
    )
    for name, text in (
        ("drop", "Lose this share of the messages, both ways"),
        ("corrupt", "Damage this share of the messages, both ways"),
    ):
        parser.add_argument(
            f"--{name}", type=number, default=0.0, metavar="0…1", help=f"{text} (default: 0)."
        )
    parser.add_argument(
        "--stall",
        type=duration,
        default=0.0,
        metavar="DURATION",
        help="Do nothing for so long every second, such as 200ms (default: never).",
    )
    parser.add_argument(
        "--unplug-every",
        type=duration,
        default=0.0,
        metavar="DURATION",
        help="Be unplugged so long after each greeting, such as 5s; this needs --link "
        "(default: never).",
    )
    parser.add_argument(
        "--defect",
        choices=(
            "no-acknowledgement",
            "no-actuators",
            "off-place",
            "slow-clock",
            "no-watchdog",
            "late-watchdog",
        ),
        help="Be built wrong in this way, which vbraille device check finds (default: none).",
    )


def device_info(parser: ArgumentParser) -> None:
    """Add the options of ``vbraille device info`` and ``check``."""
    parser.add_argument("spec", metavar="SPEC", help=f"{SPEC}.")
    parser.add_argument("--model", choices=MODELS, help="Refuse a device that is not this display.")


def tables(parser: ArgumentParser) -> None:
    """Add the options of ``vbraille tables``."""
    parser.add_argument(
        "--language", metavar="TAG", help="List only tables of this language, such as fr or fr-CA."
    )


def _text(parser: ArgumentParser, *, optional: bool = False, file: bool = True) -> None:
    if file:
        _source(parser, optional=optional)
    _translation(parser)
    parser.add_argument(
        "--undefined",
        choices=("mark", "name", "code", "drop"),
        default="mark",
        help="Choose what is written for a character that the table does not know: a marker such "
        "as [?], its name in Unicode, its number, or nothing; they are counted at the end "
        "(default: mark).",
    )
    parser.add_argument(
        "--keep-lines",
        action="store_true",
        help="Keep the text's own line breaks, as for verse or a program.",
    )
    parser.add_argument(
        "--lines",
        type=lines,
        default=(1, None),
        metavar="3-10",
        help="Take these lines of the page only, counted from 1 (default: all).",
    )


def _source(parser: ArgumentParser, *, optional: bool = False) -> None:
    parser.add_argument(
        "file",
        metavar="FILE",
        nargs="?" if optional else None,
        help="Take this text file, or standard input for -.",
    )
    parser.add_argument(
        "--encoding",
        metavar="NAME",
        help="Read the file in this text encoding (default: what its bytes say).",
    )
    parser.add_argument(
        "--form",
        metavar="NAME",
        help="Read the file as text, markdown, html, epub, dtbook, docx, odt, rtf, brf, "
        "unicode-braille or pef (default: what its content and then its name say).",
    )
    parser.add_argument(
        "--brf-table",
        metavar="NAME",
        help="Read a BRF file in the dialect of this display table of liblouis, such as "
        "de-eurobrl6.dis (default: North American ASCII braille).",
    )


def _translation(parser: ArgumentParser) -> None:
    parser.add_argument(
        "--table", metavar="NAME", help="Translate with this liblouis table (default: by language)."
    )
    parser.add_argument(
        "--language",
        metavar="TAG",
        help="Translate with the usual table of this language, such as fr or pt-BR (default: en).",
    )
    parser.add_argument(
        "--grade",
        type=whole,
        metavar="N",
        help="Take uncontracted braille, 0 or 1, or contracted, 2 and up (default: what is usual "
        "in the language).",
    )
    _settings(parser)


def _settings(parser: ArgumentParser) -> None:
    parser.add_argument(
        "--settings",
        metavar="FILE.toml",
        help="Take what options do not say from this settings file (default: the one that "
        "vbraille settings --path names).",
    )


def _profile(parser: ArgumentParser) -> None:
    parser.add_argument(
        "--profile",
        metavar="NAME",
        help="Show braille as this profile of the settings file has it; one that is not there is "
        "made when it is saved (default: the file's, or the one called default).",
    )


def _leave_to_settings(parser: ArgumentParser) -> None:
    """Leave options that a settings file may say without a value; `usual` has the usual ones."""
    parser.set_defaults(usual={name: parser.get_default(name) for name in SETTLED})
    parser.set_defaults(**dict.fromkeys(SETTLED))


def _layout(parser: ArgumentParser) -> None:
    parser.add_argument(
        "--model",
        choices=MODELS,
        default="stress2",
        help="Lay out for this display: the STReSS² or the VBD (default: the device's own, or "
        "stress2).",
    )
    parser.add_argument(
        "--geometry",
        choices=("stress2", "vbd", "standard"),
        help="Start from the distances of this display, or of embossed braille (default: the "
        "display's own).",
    )
    for name, text in (
        ("dot-width", "Make a dot so wide along the line"),
        ("dot-spacing", "Set the two dot columns of a cell so far apart"),
        ("cell-gap", "Leave so much from a cell's right dot column to the next cell's left one"),
        ("line-pitch", "Set lines so far apart"),
    ):
        parser.add_argument(
            f"--{name}", type=number, metavar="MM", help=f"{text}, in mm (default: the geometry's)."
        )
    parser.add_argument(
        "--travel",
        type=number,
        metavar="MM",
        help="Let the carriage go so far, in mm, which says how long a line is (default: what the "
        "device has, or 300).",
    )


def _show(parser: ArgumentParser) -> None:
    _layout(parser)
    parser.add_argument(
        "--texture",
        type=number,
        metavar="0…1",
        help="Set the level of texture between the dots (default: the model's, 1 for the STReSS², "
        "0 for the VBD).",
    )
    parser.add_argument(
        "--texture-cycles",
        type=whole,
        metavar="K",
        help="On the STReSS²: have so many half-cycles of texture in a dot's radius, an odd number "
        "(default: 7).",
    )
    parser.add_argument(
        "--contrast",
        type=number,
        metavar="0…1",
        help="Use this share of the actuators' full swing (default: 1).",
    )
    parser.add_argument(
        "--mapping",
        choices=MAPPINGS,
        help="On the STReSS²: choose which rows of actuators show which dots (default: alternate).",
    )
    parser.add_argument(
        "--dot-row",
        type=whole,
        metavar="1|2|3",
        help="On the VBD: show this row of dots (default: 1).",
    )


def _hand(parser: ArgumentParser) -> None:
    parser.add_argument(
        "--hand",
        default="sweep:60",
        metavar="HAND",
        help=f"Move the simulated device by this hand: {HANDS} (default: sweep:60).",
    )
    parser.add_argument(
        "--seed",
        type=seed,
        default=1,
        metavar="N",
        help="Draw the hand's chances from this (default: 1).",
    )
    parser.add_argument(
        "--rate",
        type=number,
        default=1000.0,
        metavar="HZ",
        help="Have so many frames a second (default: 1000).",
    )
