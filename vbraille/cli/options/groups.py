"""Groups of options that several commands have, each with a sentence that stands alone."""

from __future__ import annotations

import argparse
import re

TYPE_CHECKING = False  # as in vbraille.cli
if TYPE_CHECKING:
    from collections.abc import Sequence

    from vbraille.cli.options.commandparser import CommandParser


class Pairs(argparse.Action):
    """Options NAME=VALUE, gathered in a dictionary."""

    def __call__(
        self,
        _parser: argparse.ArgumentParser,
        namespace: argparse.Namespace,
        values: str | Sequence[object] | None,
        _option: str | None = None,
    ) -> None:
        """Add a pair to those before."""
        name, equals, value = str(values).partition("=")
        if not equals or not name:
            raise argparse.ArgumentError(self, f"{values!r} is not NAME=VALUE")
        setattr(namespace, self.dest, {**getattr(namespace, self.dest), name: value})


def duration(text: str) -> float:
    """Seconds of a duration such as 200ms or 5s."""
    found = re.fullmatch(r"([0-9]{1,9}(?:\.[0-9]{1,9})?)(ms|s)", text)
    seconds = float(found[1]) / (1000 if found[2] == "ms" else 1) if found else 0.0
    if not 0.001 <= seconds <= 3600:
        raise argparse.ArgumentTypeError(
            f"{text!r} is no duration from 1ms to 3600s, such as 200ms or 5s"
        )
    return seconds


def number(text: str) -> float:
    """A number."""
    try:
        return float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number") from None


def checksum(text: str) -> str:
    """A SHA-256, or enough of its first digits to tell it from others."""
    if not re.fullmatch(r"[0-9a-fA-F]{16,64}", text):
        raise argparse.ArgumentTypeError(
            f"{text!r} is no SHA-256; give its 64 digits, 0 to 9 and a to f, or the first 16"
        )
    return text.lower()


def whole(text: str) -> int:
    """A whole number."""
    if not re.fullmatch(r"[+-]?[0-9]{1,18}", text):
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number")
    return int(text)


def seed(text: str) -> int:
    """A seed: 0 or more."""
    value = whole(text)
    if value < 0:
        raise argparse.ArgumentTypeError(f"seed is {value}; it must be 0 or more")
    return value


def names(text: str) -> tuple[str, ...]:
    """Names with commas between."""
    given = tuple(name.strip() for name in text.split(","))
    if not all(given) or len(set(given)) < len(given):
        raise argparse.ArgumentTypeError(f"{text!r} is no list of different names, such as a,b")
    return given


def marks(text: str) -> tuple[int, ...]:
    """Counts with commas between, each larger than the one before."""
    counts = tuple(whole(count) for count in text.split(","))
    if list(counts) != sorted(set(counts)) or counts[0] < 0:
        raise argparse.ArgumentTypeError(f"{text!r} are no counts that grow, such as 4,9")
    return counts


def lines(text: str) -> tuple[int, int | None]:
    """First and last of a range of lines, such as 3-10; the last is None where it is open."""
    found = re.fullmatch(r"([0-9]{1,15})?(-)?([0-9]{1,15})?", text)
    if found is None or not (found[1] or found[3]):
        raise argparse.ArgumentTypeError(f"{text!r} is not a range of lines, such as 3-10")
    first = int(found[1] or 1)
    last = int(found[3]) if found[3] else None if found[2] else first
    if first < 1 or (last is not None and last < first):
        raise argparse.ArgumentTypeError(f"{text!r} is no range: lines count from 1 upwards")
    return first, last


MAPPINGS = (
    *("alternate", "paired", "sheared", "split-columns", "row-sheared", "compact"),
    "eight-dots",
)
MODELS = ("stress2", "stress2-8x8", "pantograph", "latero", "vbd")

# Options of reading that a settings file may say.
SETTLED = (
    "device",
    "language",
    "grade",
    "table",
    "encoding",
    "foreign",
    "undefined",
    "keep_lines",
    "advance",
    "echo",
    "speech",
    "cues",
    "also",
    "verbose",
    "straying",
    "band",
    "keys",
)
KEY_SETS = ("usual", "nvda")

HANDS = (
    "sweep:SPEED goes along each line at so many mm/s, slow reads as people do on such displays "
    "(device is its older name), fluent as on paper, recorded:FILE.csv moves as recorded, "
    "wander:SPEED goes about without reading, wide goes round a picture and inward, spot:X,Y "
    "swings about a place of it, and still moves only in the live view of --monitor"
)
SPEC = "Name the device, such as serial:/dev/ttyACM0, latero:HOST, or sim for a simulated one"


def text(parser: CommandParser, *, optional: bool = False, file: bool = True) -> None:
    """Add the options that say what text is read, and in which braille."""
    if file:
        source(parser, optional=optional)
    translation(parser)
    parser.choice(
        "--foreign",
        ("switch", "own"),
        "Choose how passages in another language are written: switch to that language's table, "
        "with marks where it begins and ends, or stay with the book's own.",
        default="switch",
    )
    parser.choice(
        "--undefined",
        ("mark", "name", "code", "drop"),
        "Choose what is written for a character that the table does not know: a marker such as "
        "[?], but an emoji's name; any character's name in Unicode, its number, or nothing; they "
        "are counted at the end.",
        default="mark",
    )
    parser.flag("--keep-lines", "Keep the text's own line breaks, as for verse or a program.")
    parser.option(
        "--lines",
        "3-10",
        "Take these lines of the page only, counted from 1 (default: all).",
        lines,
        default=(1, None),
    )


def source(parser: CommandParser, *, optional: bool = False) -> None:
    """Add the options that say which file is read, and how."""
    parser.add_argument(
        "file",
        metavar="FILE",
        nargs="?" if optional else None,
        help="Take this text file, or standard input for -.",
    )
    parser.option(
        "--encoding", "NAME", "Read the file in this text encoding (default: what its bytes say)."
    )
    parser.option(
        "--form",
        "NAME",
        "Read the file as text, markdown, html, epub, dtbook, docx, odt, rtf, brf, "
        "unicode-braille or pef (default: what its content and then its name say).",
    )
    parser.option(
        "--brf-table",
        "NAME",
        "Read a BRF file in the dialect of this display table of liblouis, such as "
        "de-eurobrl6.dis (default: North American ASCII braille).",
    )


def translation(parser: CommandParser) -> None:
    """Add the options that choose a braille table."""
    parser.option("--table", "NAME", "Translate with this liblouis table (default: by language).")
    parser.option(
        "--language",
        "TAG",
        "Translate with the usual table of this language, such as fr or pt-BR (default: en).",
    )
    parser.option(
        "--grade",
        "N",
        "Take uncontracted braille, 0 or 1, or contracted, 2 and up (default: what is usual in "
        "the language).",
        whole,
    )
    settings_file(parser)


def protocol(parser: CommandParser) -> None:
    """Add the protocol that a command is about."""
    parser.add_argument(
        "protocol",
        metavar="PROTOCOL",
        help="Take this protocol: a name, or a file such as mine.toml.",
    )


def device(parser: CommandParser) -> None:
    """Add the option that names the device, or a simulated one."""
    parser.option("--device", "SPEC", f"{SPEC} (default: sim).", default="sim")


def heard(parser: CommandParser) -> None:
    """Add the options of what is heard beside what is felt."""
    parser.flag(
        "--speech", "Speak all that is said, such as lines and settings, through Speech Dispatcher."
    )
    parser.choice(
        "--cues",
        ("sound", "bell", "none"),
        "Signal a limit, what is not found, and in a text the end of a line or page: by tones, "
        "by the terminal's bell, or not (default: tones at a terminal, the bell through SSH, "
        "otherwise none).",
    )


def force(parser: CommandParser) -> None:
    """Add the option that has files replaced."""
    parser.flag("--force", "Replace files that are there already.")


def settings_file(parser: CommandParser) -> None:
    """Add the option that names another settings file."""
    parser.option(
        "--settings",
        "FILE.toml",
        "Take what options do not say from this settings file (default: the one that vbraille "
        "settings --path names).",
    )


def keys(parser: CommandParser) -> None:
    """Add the option that chooses a ready set of keys."""
    parser.choice(
        "--keys",
        KEY_SETS,
        "Choose a set of keys: the program's own, or the letters of NVDA's browse mode; keys of "
        "the settings file come before both.",
        default="usual",
    )


def profile(parser: CommandParser) -> None:
    """Add the option that chooses a profile of the settings file."""
    parser.option(
        "--profile",
        "NAME",
        "Show braille as this profile of the settings file has it; one that is not there is made "
        "when it is saved (default: the file's, or the one called default).",
    )


def leave_to_settings(parser: CommandParser) -> None:
    """Leave options that a settings file may say without a value; `usual` has the usual ones."""
    usual = {name: parser.get_default(name) for name in SETTLED}
    parser.set_defaults(usual={**usual, "verbose": False})  # which every command gets later
    parser.set_defaults(**dict.fromkeys(SETTLED))


def layout(parser: CommandParser) -> None:
    """Add the options that say for which display, and how large, braille is."""
    parser.choice(
        "--model",
        MODELS,
        "Lay out for this display: the STReSS² of 10 × 6 or of 8 × 8 actuators, that on the "
        "Pantograph, the Latero, or the VBD (default: the device's own, or stress2).",
        default="stress2",
    )
    parser.choice(
        "--geometry",
        (*MODELS, "standard"),
        "Start from the distances of this display, or of embossed braille (default: the "
        "display's own).",
    )
    for name, text in (
        ("dot-width", "Make a dot so wide along the line"),
        ("dot-spacing", "Set the two dot columns of a cell so far apart"),
        ("cell-gap", "Leave so much from a cell's right dot column to the next cell's left one"),
        ("line-pitch", "Set lines so far apart"),
    ):
        parser.option(f"--{name}", "MM", f"{text}, in mm (default: the geometry's).", number)
    parser.option(
        "--travel",
        "MM",
        "Let the carriage go so far, in mm, which says how long a line is (default: what the "
        "device has, or 300).",
        number,
    )


def show(parser: CommandParser) -> None:
    """Add the options of how braille is shown on the actuators, and those of `layout`."""
    layout(parser)
    parser.option(
        "--texture",
        "0…1",
        "Set the level of texture between the dots (default: the model's, 1 for the STReSS², 0 "
        "for the VBD).",
        number,
    )
    parser.option(
        "--texture-cycles",
        "K",
        "On the STReSS²: have so many half-cycles of texture in a dot's radius, an odd number "
        "(default: 7).",
        whole,
    )
    parser.option(
        "--contrast", "0…1", "Use this share of the actuators' full swing (default: 1).", number
    )
    parser.choice(
        "--mapping",
        MAPPINGS,
        "On a display of several rows: choose which rows of actuators show which dots (default: "
        "alternate, or eight-dots where there are eight rows).",
    )
    parser.option("--dot-row", "1|2|3", "On the VBD: show this row of dots (default: 1).", whole)


def page(parser: CommandParser) -> None:
    """Add the options of a page on a surface of two axes."""
    parser.option(
        "--height",
        "MM",
        "Let the carriage go so far down the page, too: the hand reads pages of lines, or one "
        "line for 0 (default: what the device has).",
        number,
    )
    parser.choice(
        "--straying",
        ("line", "free"),
        "Show a finger that strays from the middle of a line of a page that line, or what lies "
        "under each actuator (default: line).",
    )
    parser.option(
        "--band",
        "0…0.9",
        "Leave a line of a page half so far beyond its edge, in line pitches (default: 0.25).",
        number,
    )


def hand(parser: CommandParser, usual_rate: str = "1000") -> None:
    """Add the options of the hand that moves a simulated device."""
    parser.option(
        "--hand",
        "HAND",
        f"Move the simulated device by this hand: {HANDS} (default: sweep:60).",
        default="sweep:60",
    )
    parser.option("--seed", "N", "Draw the hand's chances from this.", seed, default=1)
    parser.option(
        "--rate",
        "HZ",
        f"Have so many frames a second (default: {usual_rate}).",
        number,
        default=1000.0,
    )
