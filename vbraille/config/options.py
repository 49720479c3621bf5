"""The schema of options: each once, with its value, its help, and where it holds.

The command line, the settings file and its checks, `vbraille settings`, what is kept with a book,
and the tables of `docs/settings.md` follow from it. It is quick to load: help needs it.
"""

from __future__ import annotations

from vbraille.config.option import BOOK, FILE, PROFILE, Names, Option, StyleKnob
from vbraille.config.readers import (
    checksum,
    duration,
    expected_shares,
    lines,
    marks,
    names,
    place,
    seed,
    sizes,
    switch_states,
    velocity,
)
from vbraille.scene.measures import LEAST_ZOOM, MOST_ZOOM

_MODELS = Names("vbraille.render.braille.models", "MODELS")
_CORRECTIONS = ("none", "bonferroni", "holm", "fdr")
HANDS = (
    "sweep:SPEED goes along each line at so many mm/s, slow reads as people do on such displays, "
    "fluent as on paper, wander:SPEED goes about without reading, wide goes round a picture and "
    "inward, spot:X,Y swings about a place of it, recorded:FILE.csv moves as recorded, and still "
    "moves only in the live view of --monitor"
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
            "Give signals that are heard, such as at a limit, at the end of a page, or before a "
            "trial: by tones, by the terminal's bell, or not.",
            ("tones", "bell", "none"),
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
            "Take this display: the STReSS² of 10 × 6 or of 8 × 8 actuators, that on the "
            "Pantograph, the Latero, or the VBD; a device that is another one is refused.",
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
            "Let the carriage go so far across the lines, in mm, too: the hand reads pages of "
            "lines, or one line for 0.",
            float,
            "MM",
            usual="what the device has",
            unit="mm",
            low=0,
            high=10_000,
        ),
        Option(
            "cells",
            "Lay out lines of so many cells; a hand goes along a longer one part by part.",
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
        Option("seed", "Draw chances, such as those of a hand, from this.", seed, "N", default=1),
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
        Option("json", "Print the same as JSON, for another program.", bool),
        Option("csv", "Print the numbers as CSV, for another program.", bool),
        Option("out", "Write to this file, or this new directory.", str, "FILE"),
        Option("forget", "Delete all that is kept of it, but for files of the user's own.", bool),
        Option(
            "workers",
            "Let so many processes share the work, which gives the same numbers.",
            int,
            "N",
            default=1,
        ),
        Option(
            "resolution",
            "Draw so many pixels a mm.",
            float,
            "N",
            usual="4, or 12 of an outline",
        ),
        Option("where", "Print where the settings file is, and nothing else.", bool),
        Option("again", "Begin anew, and forget the choices made so far.", bool),
        Option(
            "format",
            "Write Unicode braille, ASCII braille (BRF), dot numbers, the text of each line, or "
            "PEF.",
            ("unicode", "brf", "dots", "text", "pef"),
            default="unicode",
        ),
        Option(
            "x",
            "Of a page: put the array's left column at this place, in mm.",
            float,
            "MM",
            default=20.0,
        ),
        Option(
            "letter",
            "Of a mapping: show this letter.",
            str,
            "LETTER",
            usual="z",
        ),
        # Pictures, and ways over them.
        Option(
            "y",
            "On a device of one axis: feel the picture at this height, in mm from its top.",
            float,
            "MM",
            usual="where it is felt, near its middle",
        ),
        Option(
            "zoom",
            "Begin with the picture so many times as near.",
            float,
            "N",
            default=1.0,
            low=LEAST_ZOOM,
            high=MOST_ZOOM,
        ),
        Option("say_entering", "Say the name of each element when the finger comes to it.", bool),
        Option(
            "sounds",
            "Say each element of a picture when the finger comes to it, and play its sound.",
            bool,
        ),
        Option(
            "deck",
            "Play with the scenes of this folder, two cards of each.",
            str,
            "FOLDER",
            usual="twelve that come with the program",
        ),
        Option("players", "Deal for so many players.", int, "1|2", default=1, low=1, high=2),
        Option("radius", "Of the hand spot: swing so far, in mm.", float, "MM", usual="5"),
        Option("seconds", "Of the hand spot: swing for so long.", float, "S", usual="10"),
        Option("speed", "Of wide and spot: go so fast, in mm/s.", float, "MM_S", usual="60"),
        Option("sway", "Of wide: sway so far to either side, in mm.", float, "MM", usual="0"),
        Option("unsteady", "Of wide: change the speed by this share.", float, "0…0.9", usual="0"),
        Option("back", "Of wide: go back so far every 50 mm, in mm.", float, "MM", usual="0"),
        Option(
            "elements",
            "Say, too, how much longer a frame takes with each element than without it.",
            bool,
        ),
        Option("map", "Draw the map of the cost as PNG or SVG.", str, "FILE.png", usual="none"),
        Option(
            "as_shown",
            "Convert what OpenLatero shows, where that is not what its file says.",
            bool,
        ),
        Option(
            "vibration",
            "Show what vibrates as noise of the same range, or as a sequence of maps at times of "
            "one swing: an animation in F.gif, and numbered files otherwise, such as F-001.png to "
            "F-008.png.",
            ("noise", "sequence"),
            default="noise",
        ),
        Option(
            "frames",
            "Give a sequence so many maps, evenly over the slowest swing.",
            int,
            "N",
            usual="8",
        ),
        Option(
            "parity",
            "Show a sequence as these actuators swing: 0 those whose row and column are both even "
            "or both odd, 1 the others.",
            int,
            "0|1",
            usual="0",
            low=0,
            high=1,
        ),
        Option(
            "velocity",
            "Draw what is felt by a hand that goes on so, right and down in mm/s, where signals of "
            "the picture depend on that.",
            velocity,
            "X,Y",
            usual="a hand that stands still",
        ),
        Option(
            "switch",
            "Draw the picture with the switch of key K in its state N, from 1, such as 1=2.",
            switch_states,
            "K=N[,…]",
            usual="each in its first",
        ),
        Option(
            "signal",
            "Draw instead how this signal of the picture answers to the velocity of the hand, as a "
            "polar plot: a hand at rest in the middle, one that goes to the right at the right.",
            str,
            "NAME",
            usual="the picture",
        ),
        Option(
            "arrows",
            "Draw arrows for what moves, and hollow ones for the directions of the hand that "
            "signals answer.",
            bool,
        ),
        Option(
            "array",
            "Draw the array over the picture with its centre at this place, in mm, turned by θ "
            "degrees against the clock: a bar for each contactor, shifted by its deflection.",
            place,
            "X,Y[,θ]",
            usual="no array",
        ),
        Option("rulers", "Draw rulers in mm around the picture.", bool),
        Option(
            "outline",
            "Draw what is felt in black on white instead, true to scale, for eyes and for swell "
            "paper.",
            bool,
        ),
        # A simulated device.
        Option(
            "link",
            "Make a link to the port at this path, and remove it at the end.",
            str,
            "PATH",
            usual="no link",
        ),
        Option(
            "encoder",
            "Choose what the encoder knows of the carriage's place when it starts: the place, "
            "nothing before it has passed its mark, or nothing before it is told where the left "
            "stop is.",
            ("absolute", "index", "incremental"),
            default="absolute",
        ),
        Option(
            "axes",
            "Measure the carriage along the line only, or across the lines as well, or the angle "
            "of the array as well; the hand then reads a page.",
            ("x", "xy", "xyθ"),
            default="x",
        ),
        Option(
            "script",
            "Move buttons and knobs as this file says, with a time after the first greeting and an "
            "event in each line: 2.5s press 1, 3s release 1, 4s knob 1 0.8.",
            str,
            "FILE",
            usual="nothing",
        ),
        Option(
            "press",
            "Press button N, 1 to 8, so long after the first greeting, as in 1@2.5s,2@4s, or hold "
            "it for a while, as in 1@2.5s-4s.",
            str,
            "N@TIME,…",
            default="",
            usual="no button",
        ),
        Option("drop", "Lose this share of the messages, both ways.", float, "0…1", default=0.0),
        Option(
            "corrupt", "Damage this share of the messages, both ways.", float, "0…1", default=0.0
        ),
        Option(
            "stall",
            "Do nothing for so long every second, such as 200ms.",
            duration,
            "DURATION",
            default=0.0,
            usual="never",
        ),
        Option(
            "unplug_every",
            "Be unplugged so long after each greeting, such as 5s; this needs --link.",
            duration,
            "DURATION",
            default=0.0,
            usual="never",
        ),
        Option(
            "defect",
            "Be built wrong in this way, which vbraille device check finds.",
            (
                "no-acknowledgement",
                "no-actuators",
                "off-place",
                "slow-clock",
                "no-watchdog",
                "late-watchdog",
            ),
            usual="none",
        ),
        Option(
            "udp_port",
            "A Latero: listen at this UDP port, 0 for any that is free.",
            int,
            "N",
            usual="8900",
        ),
        Option(
            "page_lines",
            "A Latero: have the hand read so many lines of a page, 10 mm apart.",
            int,
            "N",
            usual="1",
        ),
        Option(
            "wait",
            "A Latero: have the hand wait so long at the lower left when a program comes, such as "
            "5s.",
            duration,
            "DURATION",
            usual="1s",
        ),
        Option(
            "late",
            "A Latero: send this share of the answers 20 ms late.",
            float,
            "0…1",
            usual="0",
        ),
        Option(
            "double",
            "A Latero: have this share of the datagrams come twice, both ways.",
            float,
            "0…1",
            usual="0",
        ),
        Option(
            "stray",
            "A Latero: send a stranger's datagram along with this share of the answers.",
            float,
            "0…1",
            usual="0",
        ),
        Option("show", "Print what is kept of the device's actuators only.", bool),
        # A lab's.
        Option("participant", "Call the participant by this pseudonym.", str, "P07", required=True),
        Option(
            "participants",
            "Take so many participants, such as 4-40, 12 or 6,12,24.",
            sizes,
            "N-N",
            required=True,
        ),
        Option(
            "order",
            "Take this one of the balanced orders.",
            int,
            "N",
            usual="by the number in the pseudonym",
        ),
        Option(
            "group",
            "Put the participant into this group.",
            str,
            "NAME",
            usual="by the number in the pseudonym",
        ),
        Option("brf", "Print the strings as ASCII braille, to be embossed.", bool),
        Option(
            "answers",
            "Take answers that are typed, from a file with a line for each trial, or from a "
            "simulated reader, simulated[:NOISE][,lapses=SHARE][,false-alarms=SHARE].",
            str,
            "SOURCE",
            default="typed",
        ),
        Option("fast", "Run a simulated session as fast as the machine can.", bool),
        Option(
            "markers",
            "Send a marker of each event to another recorder: to a stream of the Lab Streaming "
            "Layer (pip install pylsl), or a byte to a serial port.",
            str,
            "lsl[:NAME]|serial:PORT[:BAUD]",
            usual="none",
        ),
        Option(
            "another",
            "Say that the participant is not the person of another session here whose pseudonym "
            "is nearly the same.",
            bool,
        ),
        Option(
            "field",
            "Answer what the protocol asks about the participant; this may be given again.",
            str,
            "NAME=VALUE",
            pairs=True,
        ),
        Option("bids", "Add the sessions to a BIDS dataset.", bool),
        Option(
            "session_by",
            "With --bids, name a participant's sessions by what the protocol asked as this field.",
            str,
            "FIELD",
            usual="by number, in the order of time",
        ),
        Option("anonymous", "Leave out times of day, paths and notes; elapsed times stay.", bool),
        Option(
            "codebook",
            "Write what each column holds, its unit and its values to this file.",
            str,
            "FILE.csv",
            usual="none",
        ),
        Option("salvage", "Of a damaged session, export also what is whole after it.", bool),
        Option(
            "exclude",
            "Leave a participant out, and say why; this may be given again.",
            str,
            "P07=REASON",
            pairs=True,
        ),
        Option("yes", "Remove all of it without asking before.", bool),
        Option(
            "expect",
            "See that nothing was changed since a stop, the end or an export said this SHA-256.",
            checksum,
            "SUM",
            usual="nothing is compared",
        ),
        Option(
            "scores",
            "Instead of trials, take a table of scores: participant, what was varied, score.",
            str,
            "FILE.csv",
            usual="trials",
        ),
        Option("protocol", "Take only trials of this protocol.", str, "NAME", usual="all"),
        Option(
            "factors",
            "Compare trials by these columns, such as texture,contrast.",
            names,
            "NAME,NAME",
            usual="as the protocol plans; condition without one",
        ),
        Option(
            "correction",
            "Correct p for the number of tests in this way.",
            _CORRECTIONS,
            usual="as the protocol plans; holm without one",
        ),
        Option(
            "marks",
            "Mark errors above these counts in confusion matrices.",
            marks,
            "N,N",
            usual="4,9",
        ),
        Option(
            "effect",
            "Assume these values of the planned measure, by condition, or GROUP:CONDITION: shares "
            "of right answers, durations, ratings and so on. Of shares also one of them, and "
            "odds-ratio=R for the odds in every other one. Without conditions: MEASURE=VALUE.",
            expected_shares,
            "NAME=VALUE,…",
            required=True,
        ),
        Option("studies", "Simulate so many studies of each size.", int, "N", default=1000),
        Option(
            "between",
            "Let participants differ by this standard deviation in all conditions alike: of shares "
            "in log odds, of durations, thresholds and magnitudes in logarithms, else in the unit.",
            float,
            "SD",
            default=0.5,
        ),
        Option(
            "differing",
            "Let each condition by itself differ between participants by this standard deviation "
            "beside; a difference of two then has √2 times as much.",
            float,
            "SD",
            default=0.0,
        ),
        Option(
            "noise",
            "Give the simulated reader this much noise, from 0 for none.",
            float,
            "NOISE",
            default=0.4,
        ),
        Option(
            "lapses",
            "Let simulated people answer this share of the trials by chance alone.",
            float,
            "0…1",
            default=0.0,
        ),
        Option(
            "false_alarms",
            'Let simulated people say "yes", or "different", in this share of the trials, whatever '
            "they feel.",
            float,
            "0…1",
            default=0.0,
        ),
        Option(
            "keep",
            "Keep what is done in this file; given again, the work goes on where it was ended.",
            str,
            "FILE",
            usual="nothing is kept",
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
# Options of the hands that go over a picture, beside their names.
PATH = ("radius", "seconds", "speed", "sway", "unsteady", "back")
LATERO = ("udp_port", "page_lines", "wait", "late", "double", "stray")


def held_in(place: str) -> tuple[Option, ...]:
    """Options that may hold in a place: `FILE`, `BOOK` or `PROFILE`."""
    return tuple(option for option in OPTIONS.values() if place in option.holds)


def knobs() -> tuple[StyleKnob, ...]:
    """Numbers of the style that a reader turns."""
    return tuple(option for option in OPTIONS.values() if isinstance(option, StyleKnob))
