"""The options of sessions and their analysis, each with a sentence that stands alone."""

from __future__ import annotations

import argparse
import re

from vbraille.config.options import HANDS, LIVE, SPEC, number, seed, whole

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


def checksum(text: str) -> str:
    """Read a SHA-256, or enough of its first digits to tell it from others."""
    if not re.fullmatch(r"[0-9a-fA-F]{16,64}", text):
        raise argparse.ArgumentTypeError(
            f"{text!r} is no SHA-256; give its 64 digits, 0 to 9 and a to f, or the first 16"
        )
    return text.lower()


def names(text: str) -> tuple[str, ...]:
    """Read names with commas between."""
    given = tuple(name.strip() for name in text.split(","))
    if not all(given) or len(set(given)) < len(given):
        raise argparse.ArgumentTypeError(f"{text!r} is no list of different names, such as a,b")
    return given


def marks(text: str) -> tuple[int, ...]:
    """Read counts with commas between, each larger than the one before."""
    counts = tuple(whole(count) for count in text.split(","))
    if list(counts) != sorted(set(counts)) or counts[0] < 0:
        raise argparse.ArgumentTypeError(f"{text!r} are no counts that grow, such as 4,9")
    return counts


def session_protocols(parser: CommandParser) -> None:
    """Add the options of ``vbraille session protocols``."""
    parser.add_argument(
        "name", nargs="?", metavar="NAME", help="Print the TOML file of this protocol."
    )


def session_plan(parser: CommandParser) -> None:
    """Add the options of ``vbraille session plan``."""
    _plan(parser)
    parser.flag("--brf", "Print the strings as ASCII braille, to be embossed.")


def session_run(parser: CommandParser) -> None:
    """Add the options of ``vbraille session run``."""
    _plan(parser)
    parser.option(
        "--out",
        "DIR",
        "Keep the session in this new directory (default: PARTICIPANT-PROTOCOL-TIME here).",
    )
    _conduct(parser)
    parser.set_defaults(device="sim", answers="typed")
    parser.option("--rate", "HZ", "Send so many frames a second.", number, default=1000.0)
    parser.flag(
        "--another",
        "Say that the participant is somebody else than the one of another session here whose "
        "pseudonym is nearly the same.",
    )
    parser.add_argument(
        "--field",
        action=Pairs,
        default={},
        metavar="NAME=VALUE",
        help="Answer what the protocol asks about the participant; this may be given again.",
    )


def session_resume(parser: CommandParser) -> None:
    """Add the options of ``vbraille session resume``."""
    _folder(parser)
    _conduct(parser)


def session_export(parser: CommandParser) -> None:
    """Add the options of ``vbraille session export``."""
    parser.add_argument(
        "paths", nargs="+", metavar="DIR", help="Take the sessions in these directories."
    )
    parser.option(
        "--out",
        "FILE|DIR",
        "Write the trials as CSV to this new file (default: print them); with --bids, the "
        "directory of the dataset.",
    )
    parser.flag("--bids", "Add the sessions to a BIDS dataset.")
    parser.option(
        "--session-by",
        "FIELD",
        "With --bids, name a participant's sessions by what the protocol asked as this field "
        "(default: by number, in the order of time).",
    )
    parser.flag("--anonymous", "Leave out times of day, paths and notes; elapsed times stay.")
    parser.option(
        "--codebook",
        "FILE.csv",
        "Write what each column holds, its unit and its values to this new file (default: none).",
    )
    parser.flag("--salvage", "Of a damaged session, export also what is whole after the damage.")


def session_methods(parser: CommandParser) -> None:
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


def session_check(parser: CommandParser) -> None:
    """Add the options of ``vbraille session check``."""
    _folder(parser)
    parser.option(
        "--expect",
        "SUM",
        "See that nothing was changed since a stop, the end or an export said this SHA-256.",
        checksum,
    )


def analyse(parser: CommandParser) -> None:
    """Add the options of ``vbraille analyse``."""
    parser.add_argument(
        "paths",
        nargs="*",
        metavar="DIR|trials.csv",
        help="Take the sessions in these directories, or tables with the columns participant, "
        "condition, presented and answered.",
    )
    parser.option(
        "--scores",
        "FILE.csv",
        "Instead of trials, take a table of scores: participant, what was varied, score.",
    )
    parser.option(
        "--out",
        "DIR",
        "Write a report to this new directory: report.html and .md, every table as CSV, and the "
        "figures (default: print the tables, a row a line).",
    )
    parser.flag("--json", "Print the results as JSON.")
    parser.option("--protocol", "NAME", "Take only trials of this protocol.")
    parser.add_argument(
        "--exclude",
        action=Pairs,
        default={},
        metavar="P07=REASON",
        help="Leave a participant out, and say why in the report; this may be given again.",
    )
    parser.option(
        "--factors",
        "NAME,NAME",
        "Compare trials by these columns, such as texture,contrast (default: condition).",
        names,
    )
    parser.choice(
        "--correction",
        ("none", "bonferroni", "holm", "fdr"),
        "Correct the p-values of t-tests for their number in this way.",
        default="holm",
    )
    parser.option(
        "--marks",
        "N,N",
        "Mark errors above these counts in confusion matrices (default: 4,9).",
        marks,
    )
    parser.option("--seed", "N", "Begin random draws with this (default: 20090618).", seed)


def _folder(parser: CommandParser) -> None:
    parser.add_argument("folder", metavar="DIR", help="Take the session in this directory.")


def _plan(parser: CommandParser) -> None:
    protocol(parser)
    parser.option("--participant", "P07", "Call the participant by this pseudonym.", required=True)
    parser.option(
        "--seed",
        "N",
        "Draw the order from this number (default: one that is drawn, and said).",
        seed,
    )
    parser.option(
        "--order",
        "N",
        "Take this one of the balanced orders (default: by the number in the pseudonym).",
        whole,
    )
    parser.option(
        "--group",
        "NAME",
        "Put the participant into this group (default: by the number in the pseudonym).",
    )
    parser.option(
        "--texture",
        "0…1",
        "Set the level of texture where no condition does (default: the protocol's).",
        number,
    )
    parser.option(
        "--contrast",
        "0…1",
        "Set the share of the full swing where no condition does (default: the protocol's).",
        number,
    )


def _conduct(parser: CommandParser) -> None:
    parser.option("--device", "SPEC", f"{SPEC} (default: sim, or as the session began).")
    parser.option(
        "--answers",
        "SOURCE",
        "Take answers that are typed, from a file with a line for each trial, or from a "
        "simulated reader, simulated[:NOISE] (default: typed, or as the session began).",
    )
    parser.option(
        "--hand", "HAND", f"Move the simulated device by this hand: {HANDS} (default: slow)."
    )
    parser.flag("--fast", "Run a simulated session as fast as the machine can.")
    parser.choice(
        "--sound",
        ("auto", "tones", "bell", "none"),
        "Choose how the participant hears signals; auto is tones if there is an audio output, "
        "otherwise the terminal's bell.",
        default="auto",
    )
    parser.option(
        "--also",
        "DISPLAY",
        "For a protocol that shows something on a conventional display: take this one, as "
        "brlapi:HOST:N for BRLTTY at another address (default: BRLTTY's on this machine).",
    )
    parser.option(
        "--markers",
        "lsl[:NAME]|serial:PORT[:BAUD]",
        "Send a marker of each event to another recorder: to a stream of the Lab Streaming Layer "
        "(pip install pylsl), or a byte to a serial port (default: none).",
    )
    parser.take(*LIVE)


def protocol(parser: CommandParser) -> None:
    """Add the protocol that a command is about."""
    parser.add_argument(
        "protocol",
        metavar="PROTOCOL",
        help="Take this protocol: a name, or a file such as mine.toml.",
    )
