"""Options of sessions, of their analysis, and of forecasts."""

from __future__ import annotations

import argparse
import re

from vbraille.config.options import HANDS, LIVE, SPEC, number, seed, whole

TYPE_CHECKING = False  # as in vbraille.cli
if TYPE_CHECKING:
    from collections.abc import Sequence

    from vbraille.cli.parser import CommandParser


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
        "Say that the participant is not the person of another session here whose "
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


def session_withdraw(parser: CommandParser) -> None:
    """Add the options of ``vbraille session withdraw``."""
    parser.add_argument("participant", metavar="P07", help="Remove the data of this participant.")
    parser.add_argument(
        "paths", nargs="*", metavar="DIR", help="Look in these directories (default: here)."
    )
    parser.flag("--yes", "Remove all of it without asking before.")


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
        "Compare trials by these columns, such as texture,contrast (default: as the protocol "
        "plans; condition without one).",
        names,
    )
    parser.choice(
        "--correction",
        ("none", "bonferroni", "holm", "fdr"),
        "Correct p for the number of tests in this way (default: as the protocol plans; holm "
        "without one).",
        default=None,
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


_MOST_SIZES = 1000


def power(parser: CommandParser) -> None:
    """Add the options of ``vbraille power``."""
    protocol(parser)
    parser.option(
        "--effect",
        "NAME=VALUE,…",
        "Assume these values of the planned measure, by condition, or GROUP:CONDITION: shares of "
        "right answers, durations, ratings and so on. Of shares also one of them, and odds-ratio=R "
        "for the odds in every other one. Without conditions: MEASURE=VALUE.",
        expected_shares,
        required=True,
    )
    parser.option(
        "--participants",
        "N-N",
        "Simulate studies of so many participants, such as 4-40, 12 or 6,12,24.",
        sizes,
        required=True,
    )
    parser.option("--studies", "N", "Simulate so many studies of each size.", whole, default=1000)
    parser.option(
        "--between",
        "SD",
        "Let participants differ by this standard deviation in all conditions alike: of shares in "
        "log odds, of durations, thresholds and magnitudes in logarithms, else in the unit.",
        number,
        default=0.5,
    )
    parser.option(
        "--differing",
        "SD",
        "Let each condition by itself differ between participants by this standard deviation "
        "beside; a difference of two then has √2 times as much.",
        number,
        default=0.0,
    )
    parser.choice(
        "--correction",
        ("none", "bonferroni", "holm", "fdr"),
        "Correct p in this way (default: as the protocol plans).",
    )
    parser.option("--seed", "N", "Begin random draws with this (default: 20090618).", seed)
    _workers(parser)
    _printed(parser)


def predict(parser: CommandParser) -> None:
    """Add the options of ``vbraille predict``."""
    parser.add_argument(
        "grid",
        metavar="GRID.toml",
        help="Ask about the styles, texts and speeds of this file.",
    )
    parser.option(
        "--out", "DIR", "Write the table to this new directory (default: print the table)."
    )
    _workers(parser)
    _printed(parser)


def session_pilot(parser: CommandParser) -> None:
    """Add the options of ``vbraille session pilot``."""
    protocol(parser)
    parser.option(
        "--participants",
        "N",
        "Conduct the session with so many simulated participants.",
        whole,
        required=True,
    )
    parser.option(
        "--noise",
        "NOISE",
        "Give the simulated reader this much noise, from 0 for none.",
        number,
        default=0.4,
    )
    parser.option(
        "--out",
        "DIR",
        "Keep the sessions and the report in this new directory (default: pilot-PROTOCOL).",
    )
    parser.option(
        "--seed", "N", "Draw the orders, the hands and the noise from this.", seed, default=1
    )
    _number_of_workers(parser)


def _workers(parser: CommandParser) -> None:
    _number_of_workers(parser)
    parser.option(
        "--keep",
        "FILE",
        "Keep what is done in this file; given again, the work goes on where it was ended "
        "(default: nothing is kept).",
    )


def _number_of_workers(parser: CommandParser) -> None:
    parser.option(
        "--workers",
        "N",
        "Let so many processes share the work, which gives the same numbers.",
        whole,
        default=1,
    )


def _printed(parser: CommandParser) -> None:
    how = parser.add_mutually_exclusive_group()
    how.add_argument("--json", action="store_true", help="Print the results as JSON.")
    how.add_argument("--csv", action="store_true", help="Print the table as CSV.")


def expected_shares(text: str) -> dict[str, str]:
    """Pairs NAME=SHARE with commas between."""
    pairs = {}
    for part in text.split(","):
        name, equals, value = (side.strip() for side in part.partition("="))
        if not equals or not name or not value:
            raise argparse.ArgumentTypeError(f"{part!r} is not NAME=SHARE, such as T0=0.5")
        if name in pairs:
            raise argparse.ArgumentTypeError(f"{name} stands there twice")
        pairs[name] = value
    return pairs


def sizes(text: str) -> tuple[int, ...]:
    """Numbers of participants: a range such as 4-40, or numbers that grow, such as 6,12."""
    found = re.fullmatch(r"([0-9]{1,6})-([0-9]{1,6})", text)
    if found is not None:
        low, high = int(found[1]), int(found[2])
        if low > high:
            raise argparse.ArgumentTypeError(
                f"{text!r} is a range backwards; give the smaller number first, such as "
                f"{high}-{low}"
            )
        if high - low >= _MOST_SIZES:
            raise argparse.ArgumentTypeError(
                f"{text!r} are {high - low + 1} sizes; give at most {_MOST_SIZES}"
            )
        return tuple(range(low, high + 1))
    if not re.fullmatch(r"[0-9]{1,6}(,[0-9]{1,6})*", text):
        raise argparse.ArgumentTypeError(
            f"{text!r} is no number of participants, such as 12, 6,12 or 4-40"
        )
    given = tuple(int(part) for part in text.split(","))
    if list(given) != sorted(set(given)):
        raise argparse.ArgumentTypeError(f"{text!r} are no numbers that grow, such as 6,12")
    return given
