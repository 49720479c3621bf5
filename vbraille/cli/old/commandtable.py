"""The table of commands: what each does, its options of the schema, and an example."""

from __future__ import annotations

from vbraille.config.option import FILE, Argument, Option
from vbraille.config.options import (
    ADDRESS,
    HAND,
    HEARD,
    LATERO,
    LAYOUT,
    LIVE,
    OPTIONS,
    PAGE,
    PATH,
    READING,
    SHOW,
    SOURCE,
    SPEC,
    TEXT,
    TRANSLATION,
    held_in,
)
from vbraille.config.readers import whole

TYPE_CHECKING = False  # as in vbraille.cli
if TYPE_CHECKING:
    from typing import Any

    # A row is an option of the schema by its name, an option of this command's own form, or
    # options of which at most one may be given.
    Row = str | Option | tuple[str, ...]


class CommandRow:
    """A command, or an action of one.

    Parameters
    ----------
    does
        Sentence on what it does.
    options
        Arguments and options, in the order of help.
    example
        Example, which works.
    values
        Values of what the command's module reads and no option of the command gives.
    """

    def __init__(self, does: str, options: tuple[Row, ...], example: str, **values: object) -> None:
        self.does, self.options, self.example, self.values = does, options, example, values


def _of(name: str, **changes: Any) -> Option:
    """Give an option of the schema in this command's own form."""
    return OPTIONS[name].of(**changes)


def _unset(*names: str) -> tuple[Option, ...]:
    """Options that have no value where they are not given."""
    return tuple(OPTIONS[name].unset() for name in names)


def _settled(*names: str) -> tuple[Option, ...]:
    """Options that a settings file may say where they are not given."""
    return tuple(
        OPTIONS[name].unset() if FILE in OPTIONS[name].holds else OPTIONS[name] for name in names
    )


_LEFT = {option.name: None for option in held_in(FILE)}
_SHAPES = "scene, SVG or file of OpenLatero's"
_DEVICES = "the STReSS² of 8 × 8 on the Tactograph"
_TEXT = Argument("file", "Take this text file, or standard input for -.", "FILE")
_BOOK = _TEXT.of(times="?")
_SPEC = Argument("spec", f"{SPEC}.", "SPEC")
_OWN = _of("model", usual="the device's own")
_FOLDER = Argument("folder", "Take the session in this directory.", "DIR")
_FOLDERS = Argument("paths", "Take the sessions in these directories.", "DIR", times="+")
_PROTOCOL = Argument(
    "protocol", "Take this protocol: a name, or a file such as mine.toml.", "PROTOCOL"
)
_DRAWN = "one that is drawn, and said"
_PLAN = (
    _PROTOCOL,
    "participant",
    _of("seed", default=None, usual=_DRAWN),
    "order",
    "group",
    _of("texture", usual="the protocol's, where no condition sets it"),
    _of("contrast", usual="the protocol's, where no condition sets it"),
)


def _conduct(*, begun: bool) -> tuple[Row, ...]:
    """Options of running a session; one that has begun goes on with what it has."""
    usual = {"default": None, "usual": "as the session began"} if begun else {}
    return (
        _of("device", **usual),
        _of("answers", **usual),
        _of("hand", default=None, usual="as the session began" if begun else "slow"),
        "fast",
        "speech",
        _of("cues", usual="tones, or the bell where there is no audio output"),
        _of("also", usual="BRLTTY's on this machine, where the protocol shows something on it"),
        "markers",
        *LIVE,
    )


COMMANDS = {
    "read": CommandRow(
        "Read a text on a device, line after line.",
        (
            *(_BOOK, *SOURCE, *_settled(*TEXT), "book", *_unset(*READING)),
            *("no_places", "sounds", *LIVE, *_unset("verbose")),
        ),
        "vbraille read book.txt --device serial:/dev/ttyACM0",
        **_LEFT,
    ),
    "feel": CommandRow(
        "Feel a tactile picture on a device, or with a simulated hand.",
        (
            Argument("file", f"Feel this {_SHAPES}.", "FILE"),
            *("device", _of("model", usual=_DEVICES), *_unset("hand", "seed")),
            *("rate", "y", "zoom", "say_entering", "sounds", *HEARD, *LIVE),
        ),
        "vbraille feel house.scene --device latero:192.168.1.10",
    ),
    "play": CommandRow(
        "Play memory with cards that only the finger tells apart.",
        (
            *("deck", "players", "device", _of("model", usual=_DEVICES), *_unset("hand"), "rate"),
            *(_of("seed", default=None, usual=_DRAWN), *HEARD, "also", *LIVE),
        ),
        "vbraille play --players 2 --device latero:192.168.1.10",
    ),
    "books": CommandRow(
        "List the books that were read, or read on in one of them.",
        (
            Argument(
                "number",
                "Read on in the book with this number in the list, as vbraille read --book N does "
                "(default: list the books).",
                "N",
                whole,
                times="?",
            ),
            *("forget", "json"),
        ),
        "vbraille books 2",
    ),
    "keys": CommandRow(
        "List the keys that are obeyed while reading.",
        (*_unset("keys", "settings"), "json"),
        "vbraille keys",
    ),
    "settings": CommandRow(
        "Print each setting of reading, and where it comes from.",
        (*_settled(*TEXT), *_unset(*READING), "where", "json", *_unset("verbose")),
        "vbraille settings --profile evening",
        **_LEFT,
    ),
    "tune": CommandRow(
        "Find out in five minutes how braille feels best, two ways at a time.",
        (
            Argument("file", "Practise on this text (default: a short one).", "TEXT", times="?"),
            *_unset("profile", "device"),
            _OWN,
            *_settled(*TRANSLATION),
            *_unset(*HAND),
            *("again", *_unset("verbose")),
        ),
        "vbraille tune --profile evening --device serial:/dev/ttyACM0",
        **_LEFT,
        monitor=False,
    ),
    "page": CommandRow(
        "Print the page as it is laid out, or write it for an embosser.",
        (
            *(_TEXT, *SOURCE, *TEXT, *LAYOUT, "format"),
            *(_of("out", usual="print"), "force"),
            _of("cells", usual="the display's, or 40 in PEF"),
        ),
        "vbraille page book.txt --cells 40 --format brf --out book.brf",
    ),
    "structure": CommandRow(
        "Print a book's outline, and what it has.",
        (_TEXT, *SOURCE, "json"),
        "vbraille structure book.epub",
        **{name: OPTIONS[name].default for name in TEXT},
        settled=frozenset(),
    ),
    "render": CommandRow(
        "Write every frame of a reading, or of a way over a picture, to an HDF5 file.",
        (
            *(_TEXT, *SOURCE, *TEXT, *SHOW),
            _of("hand", default=None, usual="sweep:60, or wide over a picture"),
            *("seed", "rate", _of("out", metavar="FILE.h5", required=True), "force"),
            *(*PAGE, *PATH),
        ),
        "vbraille render book.txt --lines 1-3 --hand slow --out reading.h5",
    ),
    "monitor": CommandRow(
        "Play back a recording or a session in a browser, until Ctrl-C.",
        (
            Argument(
                "file",
                "Play back what vbraille render wrote, the folder of a session, or one of its "
                "traces.",
                "FILE",
                times="?",
            ),
            *ADDRESS,
        ),
        "vbraille monitor reading.h5",
    ),
    "plot": CommandRow(
        "Draw a picture of what the display does, or print its numbers.",
        (
            Argument(
                "kind",
                "Choose the picture: deflection (how far an actuator leans along a dot), mapping "
                "(which row of actuators shows which row of dots), wave (the actuators as the "
                "array passes a dot), strain (between neighbouring actuators), page (lines with "
                "the array on one) or resolution (how finely the arms of the Tactograph measure, "
                "over its tray).",
                "KIND",
                ("deflection", "mapping", "wave", "strain", "page", "resolution"),
            ),
            *(_BOOK, *SOURCE, *TEXT, *SHOW),
            _of("out", metavar="F.png|F.svg", usual="a new vbraille-KIND.png"),
            *("force", "csv", "x", "letter"),
        ),
        "vbraille plot page book.txt --lines 1-4 --x 120 --out page.png",
    ),
    "map": CommandRow(
        "Draw a tactile picture: its deflections, what it is made of, or raised lines for paper.",
        (
            Argument("file", f"Draw this {_SHAPES}.", "FILE"),
            _of("out", metavar="F.png|F.svg|F.csv|F.pdf|F.gif", required=True),
            *("force", "resolution", "vibration", "frames", "parity", "seed"),
            *("velocity", "switch", "signal", "arrows", "array"),
            _of("model", default="stress2-8x8", usual=""),
            *("rulers", "outline"),
        ),
        "vbraille map texts/scenes/gallery/layers.scene --array 22,16 --out layers.png",
    ),
    "simulate": CommandRow(
        "Be a device, at a port that a program can read on, until Ctrl-C.",
        (
            Argument(
                "what",
                "Be a device at a serial port, or a Latero on the network (default: serial).",
                None,
                ("serial", "latero"),
                times="?",
                default="serial",
            ),
            _of("model", default="stress2", usual=""),
            *(*HAND, "link", "encoder"),
            *(_of("travel", usual="300"), "axes"),
            _of("height", usual="as the display's own does, or 200"),
            *("script", "press", "drop", "corrupt", "stall", "unplug_every", "defect", *LATERO),
        ),
        "vbraille simulate --link ./vb0 --hand slow",
    ),
    "device": CommandRow(
        "Say which devices there are, and try one.",
        (),
        "vbraille device check serial:/dev/ttyACM0",
    ),
    "session": CommandRow(
        "Run legibility sessions, and keep every answer.",
        (),
        "vbraille session run legibility --participant P07 --seed 42",
    ),
    "analyse": CommandRow(
        "Make tables, statistics and a report of sessions.",
        (
            Argument(
                "paths",
                "Take the sessions in these directories, or tables with the columns participant, "
                "condition, presented and answered.",
                "DIR|trials.csv",
                times="*",
            ),
            "scores",
            _of("out", metavar="DIR", usual="print the tables, a row a line"),
            *("json", "protocol", "exclude", "factors", "correction", "marks", "seed"),
        ),
        "vbraille analyse P01-letters-* P02-letters-* --out report",
    ),
    "power": CommandRow(
        "Say how often a study of a protocol would find an effect, by simulation.",
        (
            *(_PROTOCOL, "effect", "participants", "studies", "between", "differing"),
            *("lapses", "false_alarms"),
            *("correction", "seed", "workers", "keep", ("json", "csv")),
        ),
        "vbraille power letters --effect T0=0.5,T25=0.56,T100=0.64 --participants 4-40",
    ),
    "predict": CommandRow(
        "Say what the simulated reader would read, over a grid of styles, texts and speeds.",
        (
            Argument("grid", "Ask about the styles, texts and speeds of this file.", "GRID.toml"),
            _of("out", metavar="DIR", usual="print the table"),
            *("workers", "keep", ("json", "csv")),
        ),
        "vbraille predict grid.toml --out predicted --workers 2",
    ),
    "scene": CommandRow(
        "Look through tactile pictures, and convert those of others.",
        (),
        "vbraille scene check texts/scenes/house.scene",
    ),
    "tables": CommandRow(
        "List the braille tables that there are, and which a language takes.",
        (_of("language", usual="all languages"), "json"),
        "vbraille tables --language fr",
    ),
    "setup": CommandRow(
        "Compile what drives the actuators, so that the first reading does not wait for it.",
        (),
        "vbraille setup",
    ),
    "completion": CommandRow(
        "Print what makes a shell complete commands, options and values.",
        (
            Argument(
                "shell",
                "Print the script of this shell; words lists what may stand in the place of the "
                "last word of a line, which is how the scripts ask.",
                None,
                ("bash", "zsh", "fish", "words"),
            ),
            Argument(
                "words",
                "Complete a line of these words after the program's name, if the shell is words.",
                "WORD",
                times="...",
            ),
        ),
        "vbraille completion fish > ~/.config/fish/completions/vbraille.fish",
    ),
}

# Actions of the commands that have any.
ACTIONS = {
    "device": {
        "list": CommandRow(
            "List the serial ports, with their names and ids.", ("json",), "vbraille device list"
        ),
        "info": CommandRow(
            "Print what a device says of itself.",
            (_SPEC, _OWN, "json"),
            "vbraille device info serial:/dev/ttyACM0",
        ),
        "check": CommandRow(
            "Swing each actuator, hold the rate, measure the clock, the round trip and the "
            "watchdog, and judge whether a person can read on the device.",
            (_SPEC, _OWN, "json"),
            "vbraille device check serial:/dev/ttyACM0 --model stress2",
        ),
        "calibrate": CommandRow(
            "Feel or look at each actuator in turn, and keep which are dead, weak or inverted, and "
            "their gains; h says the keys.",
            (_SPEC, _OWN, ("show", "forget"), "json"),
            "vbraille device calibrate serial:/dev/ttyACM0",
        ),
    },
    "scene": {
        "check": CommandRow(
            "Say what a tactile picture holds, what is ignored of its file, what will vibrate "
            "against what, and what is hard to feel.",
            (Argument("file", f"Check this {_SHAPES}.", "FILE"), "json"),
            "vbraille scene check texts/scenes/house.scene",
        ),
        "cost": CommandRow(
            "Say what a frame of a tactile picture costs, place by place.",
            (
                Argument("file", f"Time the frames of this {_SHAPES}.", "FILE"),
                _of("model", default="stress2-8x8", usual=""),
                _of("hand", default="wide"),
                *PATH,
                "elements",
                _of("out", metavar="FILE.csv", usual="none"),
                *("map", "force", "json"),
            ),
            "vbraille scene cost house.scene --hand wide --out cost.csv",
        ),
        "convert": CommandRow(
            "Make a scene file of a file of OpenLatero's or a drawing, and say what differs.",
            (
                Argument("file", "File of OpenLatero's (.gen, .tx) or drawing in SVG.", "OLD"),
                _of("out", metavar="NEW", required=True),
                *("as_shown", "force"),
            ),
            "vbraille scene convert umbrella.gen --out umbrella.scene",
        ),
        "schema": CommandRow(
            "Print the form of scene files as a JSON Schema, for editors that complete and check.",
            (),
            "vbraille scene schema > scene.schema.json",
        ),
    },
    "session": {
        "protocols": CommandRow(
            "List the protocols that come with the program, or print one to be copied and edited.",
            (
                Argument("name", "Print the TOML file of this protocol.", "NAME", times="?"),
                "json",
            ),
            "vbraille session protocols letters > mine.toml",
        ),
        "plan": CommandRow(
            "Print the whole order of a session before anyone sits down.",
            (*_PLAN, ("brf", "json")),
            "vbraille session plan legibility --participant P07 --seed 42",
        ),
        "run": CommandRow(
            "Run a session; at its prompt, help says what can be typed.",
            (
                *_PLAN,
                _of("out", metavar="DIR", usual="PARTICIPANT-PROTOCOL-TIME here"),
                *_conduct(begun=False),
                *("rate", "another", "field"),
            ),
            "vbraille session run legibility --participant P07 --device serial:/dev/ttyACM0",
        ),
        "resume": CommandRow(
            "Go on with a session at the next trial of the same order.",
            (_FOLDER, *_conduct(begun=True)),
            "vbraille session resume P07-legibility-20261121-101500",
        ),
        "pilot": CommandRow(
            "Conduct a whole study with the simulated reader, its report and all.",
            (
                *(_PROTOCOL, _of("participants", kind=int, metavar="N")),
                *("noise", "lapses", "false_alarms"),
                _of("out", metavar="DIR", usual="pilot-PROTOCOL"),
                *("seed", "workers"),
            ),
            "vbraille session pilot letters --participants 20 --workers 2",
        ),
        "export": CommandRow(
            "Make tables of a session.",
            (
                _FOLDERS,
                _of(
                    "out",
                    metavar="FILE|DIR",
                    usual="print the trials; with --bids, the directory of the dataset is needed",
                ),
                *("force", "bids", "session_by", "anonymous", "codebook", "salvage"),
            ),
            "vbraille session export P07-legibility-20261121-101500 --out trials.csv",
        ),
        "methods": CommandRow(
            "Say in a paragraph what was done, made of the records of sessions.",
            (_FOLDERS, "exclude"),
            "vbraille session methods P01-letters-* P02-letters-*",
        ),
        "check": CommandRow(
            "See whether every file of a session is whole, and nothing was changed.",
            (_FOLDER, "expect", "json"),
            "vbraille session check P07-legibility-20261121-101500",
        ),
        "withdraw": CommandRow(
            "Remove all data of a participant: sessions, rows of tables, plans, reports.",
            (
                Argument("participant", "Remove the data of this participant.", "P07"),
                Argument("paths", "Look in these directories (default: here).", "DIR", times="*"),
                "yes",
            ),
            "vbraille session withdraw P07 study",
        ),
    },
}

# Commands as the overview has them.
GROUPS = {
    "reading": ("read", "books", "keys", "settings", "tune", "structure", "tables"),
    "pictures": ("feel", "play", "map", "scene"),
    "a page, its frames and drawings": ("page", "render", "plot", "monitor"),
    "devices": ("device", "simulate"),
    "for a lab": ("session", "analyse", "power", "predict"),
    "for the machine and its shell": ("setup", "completion"),
}
