"""The options of what is found out before anybody takes part, each with a sentence of its own."""

from __future__ import annotations

import argparse
import re

from vbraille.cli.options.groups import number, seed, whole

TYPE_CHECKING = False  # as in vbraille.cli
if TYPE_CHECKING:
    from argparse import ArgumentParser
    from collections.abc import Sequence

_MOST_SIZES = 1000


def power(parser: ArgumentParser) -> None:
    """Add the options of ``vbraille power``."""
    _protocol(parser)
    parser.add_argument(
        "--effect",
        action=ExpectedShares,
        required=True,
        metavar="NAME=SHARE,…",
        help="Assume these shares of right answers, by condition; or one of them, and odds-ratio=R "
        "for the odds in every other one. Where values are compared: VALUE=SHARE, how often it is "
        "chosen.",
    )
    parser.add_argument(
        "--participants",
        type=sizes,
        required=True,
        metavar="N-N",
        help="Simulate studies of so many participants, such as 4-40, 12 or 6,12,24.",
    )
    parser.add_argument(
        "--studies",
        type=whole,
        default=1000,
        metavar="N",
        help="Simulate so many studies of each size (default: 1000).",
    )
    parser.add_argument(
        "--between",
        type=number,
        default=0.5,
        metavar="SD",
        help="Let participants differ by this standard deviation, in log odds of a right answer "
        "(default: 0.5).",
    )
    parser.add_argument(
        "--differing",
        type=number,
        default=0.0,
        metavar="SD",
        help="Let what a condition adds to the log odds differ between participants by this "
        "standard deviation (default: 0).",
    )
    parser.add_argument(
        "--test",
        choices=("model", "paired"),
        help="Test by the logistic model of trials, or by a paired t-test of shares (default: "
        "model).",
    )
    parser.add_argument(
        "--correction",
        choices=("none", "bonferroni", "holm", "fdr"),
        default="holm",
        help="Correct the p-values of several pairs in this way (default: holm).",
    )
    parser.add_argument(
        "--seed", type=seed, metavar="N", help="Begin random draws with this (default: 20090618)."
    )
    _workers(parser)
    _printed(parser)


def predict(parser: ArgumentParser) -> None:
    """Add the options of ``vbraille predict``."""
    parser.add_argument(
        "grid",
        metavar="GRID.toml",
        help="Ask about the styles, texts and speeds of this file.",
    )
    parser.add_argument(
        "--out",
        metavar="DIR",
        help="Write the table to this new directory (default: print the table).",
    )
    _workers(parser)
    _printed(parser)


def session_pilot(parser: ArgumentParser) -> None:
    """Add the options of ``vbraille session pilot``."""
    _protocol(parser)
    parser.add_argument(
        "--participants",
        type=whole,
        required=True,
        metavar="N",
        help="Conduct the session with so many simulated participants.",
    )
    parser.add_argument(
        "--noise",
        type=number,
        default=0.4,
        metavar="NOISE",
        help="Give the simulated reader this much noise, from 0 for none (default: 0.4).",
    )
    parser.add_argument(
        "--out",
        metavar="DIR",
        help="Keep the sessions and the report in this new directory (default: pilot-PROTOCOL).",
    )
    parser.add_argument(
        "--seed",
        type=seed,
        default=1,
        metavar="N",
        help="Draw the orders, the hands and the noise from this (default: 1).",
    )
    _number_of_workers(parser)


def _protocol(parser: ArgumentParser) -> None:
    parser.add_argument(
        "protocol",
        metavar="PROTOCOL",
        help="Take this protocol: a name, or a file such as mine.toml.",
    )


def _workers(parser: ArgumentParser) -> None:
    _number_of_workers(parser)
    parser.add_argument(
        "--keep",
        metavar="FILE",
        help="Keep what is done in this file; given again, the work goes on where it was ended "
        "(default: nothing is kept).",
    )


def _number_of_workers(parser: ArgumentParser) -> None:
    parser.add_argument(
        "--workers",
        type=whole,
        default=1,
        metavar="N",
        help="Let so many processes share the work, which gives the same numbers (default: 1).",
    )


def _printed(parser: ArgumentParser) -> None:
    how = parser.add_mutually_exclusive_group()
    how.add_argument("--json", action="store_true", help="Print the results as JSON.")
    how.add_argument("--csv", action="store_true", help="Print the table as CSV.")


class ExpectedShares(argparse.Action):
    """Pairs NAME=SHARE with commas between, gathered in a dictionary."""

    def __call__(
        self,
        _parser: argparse.ArgumentParser,
        namespace: argparse.Namespace,
        values: str | Sequence[object] | None,
        _option: str | None = None,
    ) -> None:
        """Read the pairs."""
        pairs = {}
        for part in str(values).split(","):
            name, equals, value = (text.strip() for text in part.partition("="))
            if not equals or not name or not value:
                raise argparse.ArgumentError(self, f"{part!r} is not NAME=SHARE, such as T0=0.5")
            if name in pairs:
                raise argparse.ArgumentError(self, f"{name} stands there twice")
            pairs[name] = value
        setattr(namespace, self.dest, pairs)


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
