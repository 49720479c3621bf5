"""The options of what is found out before anybody takes part, each with a sentence of its own."""

from __future__ import annotations

import argparse
import re

from vbraille.cli.options.lab import protocol
from vbraille.config.options import number, seed, whole

TYPE_CHECKING = False  # as in vbraille.cli
if TYPE_CHECKING:
    from vbraille.cli.options.commandparser import CommandParser

_MOST_SIZES = 1000


def power(parser: CommandParser) -> None:
    """Add the options of ``vbraille power``."""
    protocol(parser)
    parser.option(
        "--effect",
        "NAME=SHARE,…",
        "Assume these shares of right answers, by condition; or one of them, and odds-ratio=R for "
        "the odds in every other one. Where values are compared: VALUE=SHARE, how often it is "
        "chosen.",
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
        "Let participants differ by this standard deviation, in log odds of a right answer.",
        number,
        default=0.5,
    )
    parser.option(
        "--differing",
        "SD",
        "Let what a condition adds to the log odds differ between participants by this standard "
        "deviation.",
        number,
        default=0.0,
    )
    parser.choice(
        "--test",
        ("model", "paired"),
        "Test by the logistic model of trials, or by a paired t-test of shares (default: model).",
    )
    parser.choice(
        "--correction",
        ("none", "bonferroni", "holm", "fdr"),
        "Correct the p-values of several pairs in this way.",
        default="holm",
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
