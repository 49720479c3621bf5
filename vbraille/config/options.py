"""The schema of options: each once, with its value, its help, and where it holds.

The command line, the settings file and its checks, `vbraille settings`, what is kept with a book,
and the tables of `docs/settings.md` follow from it. It is quick to load: help needs it.
"""

from __future__ import annotations

import re
from argparse import ArgumentTypeError
from importlib import import_module

TYPE_CHECKING = False  # importing typing, for its constant, takes as long as all the rest
if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from typing import Any

    from vbraille.render.braille.style import BrailleStyle

    Reading = Callable[[str], object]

# Where an option may hold, beside the command line.
FILE = "settings file"  # under [read]
BOOK = "book"  # kept with each book, and taken when it is read again
PROFILE = "profile"  # of the settings file, for a display

_PLACES = 6  # decimal places, so that ten steps of 0.1 are 1


def number(text: str) -> float:
    """Read a number."""
    try:
        return float(text)
    except ValueError:
        raise ArgumentTypeError(f"{text!r} is not a number") from None


def whole(text: str) -> int:
    """Read a whole number."""
    if not re.fullmatch(r"[+-]?[0-9]{1,18}", text):
        raise ArgumentTypeError(f"{text!r} is not a whole number")
    return int(text)


def seed(text: str) -> int:
    """Read a seed: 0 or more."""
    value = whole(text)
    if value < 0:
        raise ArgumentTypeError(f"seed is {value}; it must be 0 or more")
    return value


def lines(text: str) -> tuple[int, int | None]:
    """Read first and last of a range of lines, such as 3-10; the last is None where it is open."""
    found = re.fullmatch(r"([0-9]{1,15})?(-)?([0-9]{1,15})?", text)
    if found is None or not (found[1] or found[3]):
        raise ArgumentTypeError(f"{text!r} is not a range of lines, such as 3-10")
    first = int(found[1] or 1)
    last = int(found[3]) if found[3] else None if found[2] else first
    if first < 1 or (last is not None and last < first):
        raise ArgumentTypeError(f"{text!r} is no range: lines count from 1 upwards")
    return first, last


class Names:
    """Names in a table of the program, which is loaded when they are asked for.

    Parameters
    ----------
    module, table
        Module, and the table in it.
    more
        Further names.
    """

    def __init__(self, module: str, table: str, *more: str) -> None:
        self._module, self._table, self._more = module, table, more

    def __iter__(self) -> Iterator[str]:
        yield from getattr(import_module(self._module), self._table)
        yield from self._more

    def __contains__(self, name: object) -> bool:
        return name in tuple(self)


class Option:
    """An option of the command line, and perhaps of files.

    Parameters
    ----------
    name
        Name, with underscores for blanks.
    help
        Sentence on what it does, without what is usual.
    kind
        bool for one that is given or not; str, int or float; the values that it may have; or a
        function that reads the value.
    metavar
        Sign for the value in help.
    default
        Value where nothing gives another.
    usual
        Words for that, where there is no value, or it does not speak for itself.
    holds
        Where it may hold beside the command line, of `FILE`, `BOOK` and `PROFILE`.
    low, high, unit
        Bounds of a number, None for none, and its unit.
    """

    def __init__(
        self,
        name: str,
        help: str,  # noqa: A002 - argparse's own word
        kind: type | tuple[str, ...] | Names | Reading = str,
        metavar: str | None = None,
        *,
        default: object = None,
        usual: str = "",
        holds: tuple[str, ...] = (),
        low: float | None = None,
        high: float | None = None,
        unit: str = "",
    ) -> None:
        self.name, self.kind, self.metavar, self.holds = name, kind, metavar, holds
        self.default = False if kind is bool else default
        self.low, self.high, self.unit = low, high, unit
        self._help, self._usual = help, usual

    @property
    def flag(self) -> str:
        """Name on the command line, such as "--keep-lines"."""
        return f"--{self.name.replace('_', '-')}"

    @property
    def label(self) -> str:
        """Name in sentences, such as "keep lines"."""
        return self.name.replace("_", " ")

    @property
    def key(self) -> str:
        """Name in files, with the unit of a length."""
        return f"{self.name}_mm" if self.unit == "mm" else self.name

    @property
    def choices(self) -> tuple[str, ...] | Names | None:
        """Values that it may have; None if any of its type."""
        return None if callable(self.kind) else self.kind

    @property
    def usual(self) -> str:
        """Words for what holds where nothing is said; empty for a flag."""
        if self._usual or self.default is None or self.kind is bool:
            return self._usual
        return f"{self.default:g}" if isinstance(self.default, float) else str(self.default)

    @property
    def sentence(self) -> str:
        """Sentence of help, with what is usual."""
        return f"{self._help[:-1]} (default: {self.usual})." if self.usual else self._help

    @property
    def does(self) -> str:
        """Sentence on what it does, without what is usual."""
        return self._help

    def check(self, value: object, name: str) -> None:
        """Check that a number, which a message calls by a name, is within the bounds.

        Raises
        ------
        ValueError
            If it is not.
        """
        if not isinstance(value, int | float):
            return
        low, high, unit = self.low, self.high, f" {self.unit}" * bool(self.unit)
        if low is not None and not low <= value <= (value if high is None else high):
            wanted = f"{low:g} or more" if high is None else f"{low:g} to {high:g}{unit}"
            raise ValueError(f"{name} is {value:g}{unit}; it must be {wanted}")


class StyleKnob(Option):
    """An option that is a number of the style, which a reader turns by keys, knobs and pages.

    Parameters
    ----------
    name, help, kind, metavar, usual, unit
        As for an `Option`; a profile has it.
    low, high
        Bounds, which are those of `vbraille.Tuning` and `vbraille.Geometry`.
    step
        Number that a turn adds.
    field
        Field of `vbraille.BrailleStyle` where that has another name.
    keys
        Keys that turn it up and down; empty for none.
    turns
        Words for the two, such as "more texture".
    """

    def __init__(
        self,
        name: str,
        help: str,  # noqa: A002
        kind: type = float,
        metavar: str = "MM",
        *,
        usual: str = "the geometry's",
        unit: str = "mm",
        low: float,
        high: float,
        step: float,
        field: str = "",
        keys: str = "",
        turns: tuple[str, str] = ("", ""),
    ) -> None:
        super().__init__(name, help, kind, metavar, usual=usual, unit=unit, holds=(PROFILE,))
        self.low, self.high, self.step = low, high, step
        self.keys, self.turns = keys, turns
        self.field = field or self.key

    def applied(self, style: BrailleStyle, value: float) -> BrailleStyle:
        """Give a style in which the knob has another value."""
        changes: Any = {self.field: value}
        return style.replace(**changes)

    def value(self, style: BrailleStyle) -> float:
        """Give the value that a style has."""
        return getattr(style.geometry if self.unit else style.tuning, self.field)

    def said(self, value: float) -> str:
        """Say a value, as in "dot width: 2.2 mm"."""
        return f"{self.label}: {value:g} {self.unit}".rstrip()

    def turned(self, value: float, steps: int) -> float:
        """Turn a value so many steps up, or down if negative; it stops at the bounds."""
        return self.nearest(value + steps * self.step)

    def nearest(self, value: float) -> float:
        """Give the value that the knob can have and that is nearest to another."""
        within = min(max(value, self.low), self.high)
        if self.kind is int:  # only whole steps make sense
            return round(self.low + self.step * round((within - self.low) / self.step))
        return round(within, _PLACES)


_MODELS = Names("vbraille.render.braille.models", "MODELS")
HANDS = (
    "sweep:SPEED goes along each line at so many mm/s, slow reads as people do on such displays "
    "(device is its older name), fluent as on paper, recorded:FILE.csv moves as recorded, "
    "wander:SPEED goes about without reading, wide goes round a picture and inward, spot:X,Y "
    "swings about a place of it, and still moves only in the live view of --monitor"
)
SPEC = "Name the device, such as serial:/dev/ttyACM0, latero:HOST, or sim for a simulated one"

OPTIONS = {
    option.name: option
    for option in (
        Option("device", f"{SPEC}.", str, "SPEC", default="sim", holds=(FILE,)),
        Option(
            "language",
            "Translate with the usual table of this language, such as fr or pt-BR.",
            str,
            "TAG",
            usual="en",
            holds=(FILE, BOOK),
        ),
        Option(
            "grade",
            "Take uncontracted braille, 0 or 1, or contracted, 2 and up.",
            int,
            "N",
            usual="what is usual in the language",
            holds=(FILE, BOOK),
        ),
        Option(
            "table",
            "Translate with this liblouis table.",
            str,
            "NAME",
            usual="by language",
            holds=(FILE, BOOK),
        ),
        Option(
            "encoding",
            "Read the file in this text encoding.",
            str,
            "NAME",
            usual="what the bytes of a file say",
            holds=(FILE, BOOK),
        ),
        Option(
            "form",
            "Read the file as text, markdown, html, epub, dtbook, docx, odt, rtf, brf, "
            "unicode-braille or pef.",
            str,
            "NAME",
            usual="what its content and then its name say",
            holds=(BOOK,),
        ),
        Option(
            "brf_table",
            "Read a BRF file in the dialect of this display table of liblouis, such as "
            "de-eurobrl6.dis.",
            str,
            "NAME",
            usual="North American ASCII braille",
            holds=(BOOK,),
        ),
        Option(
            "foreign",
            "Choose how passages in another language are written: switch to that language's "
            "table, with marks where it begins and ends, or stay with the book's own.",
            ("switch", "own"),
            default="switch",
            holds=(FILE, BOOK),
        ),
        Option(
            "undefined",
            "Choose what is written for a character that the table does not know: a marker such "
            "as [?], but an emoji's name; any character's name in Unicode, its number, or "
            "nothing; they are counted at the end.",
            ("mark", "name", "code", "drop"),
            default="mark",
            holds=(FILE, BOOK),
        ),
        Option(
            "keep_lines",
            "Keep the text's own line breaks, as for verse or a program.",
            bool,
            holds=(FILE, BOOK),
        ),
        Option(
            "advance",
            "Say when the next line comes: when the hand returns to the left, or only by a key.",
            ("return", "key"),
            default="return",
            holds=(FILE,),
        ),
        Option(
            "echo",
            "Say what is printed of each line: nothing, its text, its cells in Unicode braille, "
            "or both.",
            ("none", "text", "cells", "both"),
            usual="none at a terminal, otherwise both",
            holds=(FILE,),
        ),
        Option(
            "speech",
            "Speak all that is said, such as lines and settings, through Speech Dispatcher.",
            bool,
            holds=(FILE,),
        ),
        Option(
            "cues",
            "Signal a limit, what is not found, and in a text the end of a line or page: by "
            "tones, by the terminal's bell, or not.",
            ("sound", "bell", "none"),
            usual="tones at a terminal, the bell through SSH, otherwise none",
            holds=(FILE,),
        ),
        Option(
            "also",
            "Show each line on a conventional display beside, and obey its keys: brlapi for the "
            "one that BRLTTY drives, brlapi:HOST:N for BRLTTY at another address.",
            str,
            "DISPLAY",
            usual="none",
            holds=(FILE,),
        ),
        Option(
            "verbose",
            "Say more, such as how far a search has come, and print the traceback of a fault.",
            bool,
            holds=(FILE,),
        ),
        Option(
            "straying",
            "Show a finger that strays from the middle of a line of a page that line, or what "
            "lies under each actuator.",
            ("line", "free"),
            usual="line",
            holds=(FILE,),
        ),
        Option(
            "band",
            "Leave a line of a page half so far beyond its edge, in line pitches.",
            float,
            "0…0.9",
            usual="0.25",
            holds=(FILE,),
            low=0.0,
            high=0.9,
        ),
        Option(
            "keys",
            "Choose a set of keys: the program's own, or the letters of NVDA's browse mode; keys "
            "of the settings file come before both.",
            ("usual", "nvda"),
            default="usual",
            holds=(FILE,),
        ),
        Option(
            "profile",
            "Show braille as this profile of the settings file has it; one that is not there is "
            "made when it is saved.",
            str,
            "NAME",
            usual="the file's, or the one called default",
            holds=(FILE,),
        ),
        StyleKnob(
            "texture",
            "Set the level of texture between the dots.",
            float,
            "0…1",
            usual="the model's, 1 for the STReSS², 0 for the VBD",
            unit="",
            low=0,
            high=1,
            step=0.1,
            keys="tT",
            turns=("more texture", "less texture"),
        ),
        StyleKnob(
            "contrast",
            "Use this share of the actuators' full swing.",
            float,
            "0…1",
            usual="1",
            unit="",
            low=0,
            high=1,
            step=0.1,
            keys="cC",
            turns=("more contrast", "less contrast"),
        ),
        StyleKnob(
            "texture_cycles",
            "On the STReSS²: have so many half-cycles of texture in a dot's radius, an odd number.",
            int,
            "K",
            usual="7",
            unit="",
            low=1,
            high=11,
            step=2,
            field="cycles",
        ),
        StyleKnob(
            "dot_width",
            "Make a dot so wide along the line, in mm.",
            low=0.1,
            high=20,
            step=0.2,
            keys="dD",
            turns=("wider dots", "narrower dots"),
        ),
        StyleKnob(
            "dot_spacing",
            "Set the two dot columns of a cell so far apart, in mm.",
            low=0.1,
            high=50,
            step=0.2,
            keys="sS",
            turns=("dots farther apart", "dots closer together"),
        ),
        StyleKnob(
            "cell_gap",
            "Leave so much from a cell's right dot column to the next cell's left one, in mm.",
            low=0.1,
            high=50,
            step=0.2,
            keys="jJ",
            turns=("cells farther apart", "cells closer together"),
        ),
        StyleKnob("line_pitch", "Set lines so far apart, in mm.", low=1, high=500, step=0.5),
        Option(
            "mapping",
            "On a display of several rows: choose which rows of actuators show which dots.",
            Names("vbraille.render.braille.mappings", "MAPPINGS"),
            usual="alternate, or eight-dots where there are eight rows",
            holds=(PROFILE,),
        ),
        Option(
            "dot_row",
            "On the VBD: show this row of dots.",
            int,
            "1|2|3",
            usual="1",
            holds=(PROFILE,),
            low=1,
            high=3,
        ),
        Option(
            "settings",
            "Take what options do not say from this settings file.",
            str,
            "FILE.toml",
            usual="the one that vbraille settings --where names",
        ),
        Option(
            "lines",
            "Take these lines of the page only, counted from 1.",
            lines,
            "3-10",
            default=(1, None),
            usual="all",
        ),
        Option(
            "model",
            "Lay out for this display: the STReSS² of 10 × 6 or of 8 × 8 actuators, that on the "
            "Pantograph, the Latero, or the VBD.",
            _MODELS,
            usual="the device's own, or stress2",
        ),
        Option(
            "geometry",
            "Start from the distances of this display, or of embossed braille.",
            Names("vbraille.braille.geometry", "PRESETS"),
            usual="the display's own",
        ),
        Option(
            "travel",
            "Let the carriage go so far, in mm, which says how long a line is.",
            float,
            "MM",
            usual="what the device has, or 300",
            unit="mm",
        ),
        Option(
            "height",
            "Let the carriage go so far down the page, too: the hand reads pages of lines, or one "
            "line for 0.",
            float,
            "MM",
            usual="what the device has",
            unit="mm",
            low=0,
            high=10_000,
        ),
        Option(
            "cells",
            "Lay out lines of so many cells; the hand goes along a longer one part by part.",
            int,
            "N",
            usual="as many as the hand can cross",
            low=1,
            high=200,
        ),
        Option(
            "hand",
            f"Move the simulated device by this hand: {HANDS}.",
            str,
            "HAND",
            default="sweep:60",
        ),
        Option("seed", "Draw the hand's chances from this.", seed, "N", default=1),
        Option(
            "rate",
            "Have so many frames a second.",
            float,
            "HZ",
            default=1000.0,
            usual="1000, or what the device takes if that is less",
        ),
        Option(
            "book",
            "Read on in the book with this number in the list of vbraille books.",
            int,
            "N",
            usual="FILE, or the book that was read last",
        ),
        Option(
            "no_places",
            "Begin at the beginning, and keep neither the place nor anything else of the book.",
            bool,
        ),
        Option(
            "monitor",
            "Show a live view in a browser, at an address of this machine that is printed.",
            bool,
        ),
        Option(
            "host",
            "Offer the page of the live view at this address, so that others can see it who are "
            "told its token.",
            str,
            "ADDRESS",
            usual="to this machine only",
        ),
        Option(
            "port",
            "Offer the page of the live view at this port, 0 for any that is free.",
            int,
            "N",
            usual="one that is free",
            low=0,
            high=65_535,
        ),
        Option("force", "Replace files that are there already.", bool),
        Option(
            "log",
            "Keep a log for developers in a file, which is appended to, or on standard error "
            "with -.",
            str,
            "FILE",
            usual="no log",
        ),
    )
}

# Options that commands have together, in the order of their help.
SOURCE = ("encoding", "form", "brf_table")
CHOICE_OF_TABLE = ("table", "language", "grade")
TRANSLATION = (*CHOICE_OF_TABLE, "settings")
TEXT = (*TRANSLATION, "foreign", "undefined", "keep_lines", "lines")
_LENGTHS = ("dot_width", "dot_spacing", "cell_gap", "line_pitch", "travel")
LAYOUT = ("model", "geometry", *_LENGTHS)
SHOW = (*LAYOUT, "texture", "texture_cycles", "contrast", "mapping", "dot_row")
HEARD = ("speech", "cues")
PAGE = ("height", "straying", "band")
HAND = ("hand", "seed", "rate")
READING = (
    *SHOW,
    *("profile", "device", "advance", "echo"),
    *HEARD,
    *("also", "keys", "cells"),
    *PAGE,
    *HAND,
)
ADDRESS = ("host", "port")
LIVE = ("monitor", *ADDRESS)
COMMON = ("verbose", "log")


def held_in(place: str) -> tuple[Option, ...]:
    """Options that may hold in a place: `FILE`, `BOOK` or `PROFILE`."""
    return tuple(option for option in OPTIONS.values() if place in option.holds)


def knobs() -> tuple[StyleKnob, ...]:
    """Numbers of the style that a reader turns."""
    return tuple(option for option in OPTIONS.values() if isinstance(option, StyleKnob))
