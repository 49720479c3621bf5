"""The options of sessions and their analysis, each with a sentence that stands alone."""

from __future__ import annotations

from vbraille.cli.options.groups import (
    HANDS,
    SPEC,
    Pairs,
    checksum,
    marks,
    names,
    number,
    seed,
    whole,
)
from vbraille.cli.options.live import add_live_options

TYPE_CHECKING = False  # as in vbraille.cli
if TYPE_CHECKING:
    from argparse import ArgumentParser


def session_protocols(parser: ArgumentParser) -> None:
    """Add the options of ``vbraille session protocols``."""
    parser.add_argument(
        "name", nargs="?", metavar="NAME", help="Print the TOML file of this protocol."
    )


def session_plan(parser: ArgumentParser) -> None:
    """Add the options of ``vbraille session plan``."""
    _plan(parser)
    parser.add_argument(
        "--brf", action="store_true", help="Print the strings as ASCII braille, to be embossed."
    )


def session_run(parser: ArgumentParser) -> None:
    """Add the options of ``vbraille session run``."""
    _plan(parser)
    parser.add_argument(
        "--out",
        metavar="DIR",
        help="Keep the session in this new directory (default: PARTICIPANT-PROTOCOL-TIME here).",
    )
    _conduct(parser)
    parser.set_defaults(device="sim", answers="typed", rate=1000.0)
    parser.add_argument(
        "--rate", type=number, metavar="HZ", help="Send so many frames a second (default: 1000)."
    )
    parser.add_argument(
        "--another",
        action="store_true",
        help="Say that the participant is somebody else than the one of another session here "
        "whose pseudonym is nearly the same.",
    )
    parser.add_argument(
        "--field",
        action=Pairs,
        default={},
        metavar="NAME=VALUE",
        help="Answer what the protocol asks about the participant; this may be given again.",
    )


def session_resume(parser: ArgumentParser) -> None:
    """Add the options of ``vbraille session resume``."""
    _folder(parser)
    _conduct(parser)


def session_export(parser: ArgumentParser) -> None:
    """Add the options of ``vbraille session export``."""
    parser.add_argument(
        "paths", nargs="+", metavar="DIR", help="Take the sessions in these directories."
    )
    parser.add_argument(
        "--out",
        metavar="FILE|DIR",
        help="Write the trials as CSV to this new file (default: print them); with --bids, the "
        "directory of the dataset.",
    )
    parser.add_argument("--bids", action="store_true", help="Add the sessions to a BIDS dataset.")
    parser.add_argument(
        "--session-by",
        metavar="FIELD",
        help="With --bids, name a participant's sessions by what the protocol asked as this field "
        "(default: by number, in the order of time).",
    )
    parser.add_argument(
        "--anonymous",
        action="store_true",
        help="Leave out times of day, paths and notes; elapsed times stay.",
    )
    parser.add_argument(
        "--codebook",
        metavar="FILE.csv",
        help="Write what each column holds, its unit and its values to this new file (default: "
        "none).",
    )
    parser.add_argument(
        "--salvage",
        action="store_true",
        help="Of a damaged session, export also what is whole after the damage.",
    )


def session_methods(parser: ArgumentParser) -> None:
    """Add the options of ``vbraille session methods``."""
    parser.add_argument(
        "paths", nargs="+", metavar="DIR", help="Take the sessions in these directories."
    )
    parser.add_argument(
        "--exclude",
        action=Pairs,
        default={},
        metavar="P07=REASON",
        help="Leave a participant out, and say why; this may be given again.",
    )


def session_check(parser: ArgumentParser) -> None:
    """Add the options of ``vbraille session check``."""
    _folder(parser)
    parser.add_argument(
        "--expect",
        type=checksum,
        metavar="SUM",
        help="See that nothing was changed since a stop, the end or an export said this SHA-256.",
    )


def analyse(parser: ArgumentParser) -> None:
    """Add the options of ``vbraille analyse``."""
    parser.add_argument(
        "paths",
        nargs="*",
        metavar="DIR|trials.csv",
        help="Take the sessions in these directories, or tables with the columns participant, "
        "condition, presented and answered.",
    )
    parser.add_argument(
        "--scores",
        metavar="FILE.csv",
        help="Instead of trials, take a table of scores: participant, what was varied, score.",
    )
    parser.add_argument(
        "--out",
        metavar="DIR",
        help="Write a report to this new directory: report.html and .md, every table as CSV, and "
        "the figures (default: print the tables, a row a line).",
    )
    parser.add_argument("--json", action="store_true", help="Print the results as JSON.")
    parser.add_argument("--protocol", metavar="NAME", help="Take only trials of this protocol.")
    parser.add_argument(
        "--exclude",
        action=Pairs,
        default={},
        metavar="P07=REASON",
        help="Leave a participant out, and say why in the report; this may be given again.",
    )
    parser.add_argument(
        "--factors",
        type=names,
        metavar="NAME,NAME",
        help="Compare trials by these columns, such as texture,contrast (default: condition).",
    )
    parser.add_argument(
        "--correction",
        choices=("none", "bonferroni", "holm", "fdr"),
        default="holm",
        help="Correct the p-values of t-tests for their number in this way (default: holm).",
    )
    parser.add_argument(
        "--marks",
        type=marks,
        metavar="N,N",
        help="Mark errors above these counts in confusion matrices (default: 4,9).",
    )
    parser.add_argument(
        "--seed", type=seed, metavar="N", help="Begin random draws with this (default: 20090618)."
    )


def _folder(parser: ArgumentParser) -> None:
    parser.add_argument("folder", metavar="DIR", help="Take the session in this directory.")


def _plan(parser: ArgumentParser) -> None:
    parser.add_argument(
        "protocol",
        metavar="PROTOCOL",
        help="Take this protocol: a name, or a file such as mine.toml.",
    )
    parser.add_argument(
        "--participant",
        required=True,
        metavar="P07",
        help="Call the participant by this pseudonym.",
    )
    parser.add_argument(
        "--seed",
        type=seed,
        metavar="N",
        help="Draw the order from this number (default: one that is drawn, and said).",
    )
    parser.add_argument(
        "--order",
        type=whole,
        metavar="N",
        help="Take this one of the balanced orders (default: by the number in the pseudonym).",
    )
    parser.add_argument(
        "--group",
        metavar="NAME",
        help="Put the participant into this group (default: by the number in the pseudonym).",
    )
    parser.add_argument(
        "--texture",
        type=number,
        metavar="0…1",
        help="Set the level of texture where no condition does (default: the protocol's).",
    )
    parser.add_argument(
        "--contrast",
        type=number,
        metavar="0…1",
        help="Set the share of the full swing where no condition does (default: the protocol's).",
    )


def _conduct(parser: ArgumentParser) -> None:
    parser.add_argument(
        "--device", metavar="SPEC", help=f"{SPEC} (default: sim, or as the session began)."
    )
    parser.add_argument(
        "--answers",
        metavar="SOURCE",
        help="Take answers that are typed, from a file with a line for each trial, or from a "
        "simulated reader, simulated[:NOISE] (default: typed, or as the session began).",
    )
    parser.add_argument(
        "--hand",
        metavar="HAND",
        help=f"Move the simulated device by this hand: {HANDS} (default: slow).",
    )
    parser.add_argument(
        "--fast",
        action="store_true",
        help="Run a simulated session as fast as the machine can.",
    )
    parser.add_argument(
        "--sound",
        choices=("auto", "tones", "bell", "none"),
        default="auto",
        help="Choose how the participant hears signals; auto is tones if there is an audio "
        "output, otherwise the terminal's bell (default: auto).",
    )
    parser.add_argument(
        "--also",
        metavar="DISPLAY",
        help="For a protocol that shows something on a conventional display: take this one, as "
        "brlapi:HOST:N for BRLTTY at another address (default: BRLTTY's on this machine).",
    )
    parser.add_argument(
        "--markers",
        metavar="lsl[:NAME]|serial:PORT[:BAUD]",
        help="Send a marker of each event to another recorder: to a stream of the Lab Streaming "
        "Layer (pip install pylsl), or a byte to a serial port (default: none).",
    )
    add_live_options(parser)
